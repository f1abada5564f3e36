//! Rows for loads along a line of nodes: pressures, tractions, resultants.

use crate::error::{Result, at_least, in_bounds, positive, require_part};
use crate::fem::Direction;
use crate::structure::{DofCombination, FemModel};

impl FemModel {
    /// Row of nodal forces for a pressure of 1 Pa along the line through `nodes`.
    ///
    /// For a `Load` in Pa. The pressure pushes to the left of the direction from the first
    /// to the last node, which is into a body whose boundary is followed counter-clockwise.
    ///
    /// The forces do the same work as the pressure on the elements' edges: halves at the ends of a segment,
    /// Simpson's weights along the edge of an eight-node element whose middle node is in the list.
    ///
    /// ```
    /// use basemat::coupled::Load;
    /// use basemat::fem::{Direction, Layer, Material, Mesh};
    /// use basemat::structure::FemModel;
    ///
    /// let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
    /// let mesh = Mesh::layered_block(-2.0..2.0, 4, &[Layer::new(10.0, 5, concrete)])?;
    /// let tower = FemModel::on_base(mesh)?;
    /// // Wind on the left side, from the roof to the base: 1 kPa × 10 m to the right.
    /// let side: Vec<usize> = [10.0, 8.0, 6.0, 4.0, 2.0, 0.0]
    ///     .into_iter()
    ///     .map(|y| tower.mesh().node_at(-2.0, y))
    ///     .collect::<Result<_, _>>()?;
    /// let row = tower.pressure_row(&side)?;
    /// let force = row.value(&tower.rigid_motion(Direction::X, [0.0; 3]));
    /// assert!((force - 10.0).abs() < 1e-12);
    /// let wind = Load::new(row, |t: f64| 1.0e3 * (0.5 * t).sin().powi(2));
    /// # let _ = wind;
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for fewer than two nodes, [`Error::Index`](crate::Error::Index) for a node
    /// that does not exist, [`Error::Input`](crate::Error::Input) for two successive nodes at one place,
    /// [`Error::Part`](crate::Error::Part) for a node that no element moves in a direction of the pressure,
    /// [`Error::Scene`](crate::Error::Scene) for a mesh in space, where pressures act on faces:
    /// [`Shell::pressure_forces`](crate::fem::Shell::pressure_forces) times the rows of the nodes.
    pub fn pressure_row(&self, nodes: &[usize]) -> Result<DofCombination> {
        require_part(
            "pressure along a line",
            !self.mesh().has_depth(),
            "must be in a mesh in the plane, but this one is in space",
        )?;
        let mut row = DofCombination::default();
        for (node, [x, y, _]) in self.line_weights(nodes)? {
            // The normal to the left, times the length.
            for (direction, force) in [(Direction::X, -y), (Direction::Y, x)] {
                if force != 0.0 {
                    row += force * self.row(node, direction)?;
                }
            }
        }
        Ok(row)
    }

    /// Row of nodal forces for a unit force (1 N/m) in `direction`.
    ///
    /// It is spread evenly along the line through `nodes`, for a `Load` in N/m.
    ///
    /// # Errors
    /// As for [`FemModel::pressure_row`]; [`Error::Scene`](crate::Error::Scene) for a rotation.
    pub fn resultant_row(&self, nodes: &[usize], direction: Direction) -> Result<DofCombination> {
        let needed = "a displacement, not a rotation";
        require_part("resultant along a line", !direction.is_rotation(), needed)?;
        let weights = self.line_weights(nodes)?;
        let lengths: Vec<f64> =
            weights.iter().map(|(_, [x, y, z])| x.hypot(*y).hypot(*z)).collect();
        let whole: f64 = lengths.iter().sum();
        let mut row = DofCombination::default();
        for ((node, _), length) in weights.iter().zip(&lengths) {
            row += (length / whole) * self.row(*node, direction)?;
        }
        Ok(row)
    }

    /// The nodes of a line with their parts of its length, `[x, y, z]` in m; a node may occur more than once.
    fn line_weights(&self, nodes: &[usize]) -> Result<Vec<(usize, [f64; 3])>> {
        at_least("nodes of a loaded line", nodes.len(), 2)?;
        let all = self.mesh().nodes();
        let mut weights = Vec::with_capacity(2 * nodes.len());
        let mut k = 0;
        while k + 1 < nodes.len() {
            let is_quadratic = nodes.get(k..k + 3).is_some_and(|edge| self.is_quadratic_edge(edge));
            let fractions: &[f64] =
                if is_quadratic { &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0] } else { &[0.5, 0.5] };
            let count = fractions.len() - 1;
            let from = all[in_bounds("node", nodes[k], all.len())?];
            let to = all[in_bounds("node", nodes[k + count], all.len())?];
            let way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
            positive(
                "distance between nodes of a loaded line",
                way[0].hypot(way[1]).hypot(way[2]),
            )?;
            let edge = nodes[k..=k + count].iter().zip(fractions);
            weights.extend(edge.map(|(&node, fraction)| (node, way.map(|w| fraction * w))));
            k += count;
        }
        Ok(weights)
    }

    /// Whether three nodes are an edge of an eight-node element, with the middle node second.
    fn is_quadratic_edge(&self, edge: &[usize]) -> bool {
        self.mesh().elements().any(|element| {
            // Corners come first, nodes of edges then.
            let nodes = element.nodes();
            nodes.len() == 8
                && nodes[..4].contains(&edge[0])
                && nodes[4..].contains(&edge[1])
                && nodes[..4].contains(&edge[2])
        })
    }
}
