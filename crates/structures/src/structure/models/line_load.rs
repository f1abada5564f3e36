//! Nodal forces of loads along a line of nodes.

use crate::error::{Result, at_least, in_bounds, positive, require_part};
use crate::fem::Direction;
use crate::structure::{DofCombination, FemModel};

/// A node of a loaded line, and its part of a segment as a vector, m.
struct WeightedNode {
    node: usize,
    segment: [f64; 3],
}

impl FemModel {
    /// Nodal forces of a pressure along a line, for a `Load` in Pa.
    ///
    /// The pressure is 1 Pa along the line through `nodes`. It acts to the left of the direction from the first to the
    /// last node, which is into a body with nodes counter-clockwise along its boundary.
    ///
    /// The forces do the same work as the pressure on the elements' edges: one half at each end of a segment, or
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
    /// [`Error::Part`](crate::Error::Part) for a node without a degree of freedom in a direction of the pressure,
    /// [`Error::Scene`](crate::Error::Scene) for a mesh in space, where pressures act on faces:
    /// [`Shell::pressure_forces`](crate::fem::Shell::pressure_forces) times the rows of the nodes.
    pub fn pressure_row(&self, nodes: &[usize]) -> Result<DofCombination> {
        self.mesh().require_plane("pressure along a line")?;
        let mut row = DofCombination::default();
        for WeightedNode { node, segment: [x, y, _] } in self.weighted_nodes(nodes)? {
            // The normal to the left, times the length.
            for (direction, force) in [(Direction::X, -y), (Direction::Y, x)] {
                if force != 0.0 {
                    row += force * self.row(node, direction)?;
                }
            }
        }
        Ok(row)
    }

    /// Nodal forces of a unit force (1 N/m) in `direction`, for a `Load` in N/m.
    ///
    /// The force is distributed uniformly along the line through `nodes`.
    ///
    /// # Errors
    /// As for [`FemModel::pressure_row`]; [`Error::Scene`](crate::Error::Scene) for a rotation.
    pub fn resultant_row(&self, nodes: &[usize], direction: Direction) -> Result<DofCombination> {
        let needed = "a displacement, not a rotation";
        require_part("resultant along a line", !direction.is_rotation(), needed)?;
        let weighted_nodes = self.weighted_nodes(nodes)?;
        let lengths: Vec<f64> = weighted_nodes
            .iter()
            .map(|weighted_node| {
                let [x, y, z] = weighted_node.segment;
                x.hypot(y).hypot(z)
            })
            .collect();
        let total_length: f64 = lengths.iter().sum();
        let mut row = DofCombination::default();
        for (weighted_node, length) in weighted_nodes.iter().zip(&lengths) {
            row += (length / total_length) * self.row(weighted_node.node, direction)?;
        }
        Ok(row)
    }

    /// Nodes of a line with their parts of its segments.
    ///
    /// A node may occur more than once.
    fn weighted_nodes(&self, nodes: &[usize]) -> Result<Vec<WeightedNode>> {
        at_least("nodes of a loaded line", nodes.len(), 2)?;
        let mesh_nodes = self.mesh().nodes();
        let mut weighted_nodes = Vec::with_capacity(2 * nodes.len());
        let mut start = 0;
        while start + 1 < nodes.len() {
            let is_quadratic = nodes
                .get(start..start + 3)
                .is_some_and(|edge_nodes| self.is_quadratic_edge(edge_nodes));
            let fractions: &[f64] =
                if is_quadratic { &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0] } else { &[0.5, 0.5] };
            let segment_count = fractions.len() - 1;
            let start_point = mesh_nodes[in_bounds("node", nodes[start], mesh_nodes.len())?];
            let end_point =
                mesh_nodes[in_bounds("node", nodes[start + segment_count], mesh_nodes.len())?];
            let edge_vector = [0, 1, 2].map(|axis| end_point[axis] - start_point[axis]);
            positive(
                "distance between nodes of a loaded line",
                edge_vector[0].hypot(edge_vector[1]).hypot(edge_vector[2]),
            )?;
            let edge_nodes = nodes[start..=start + segment_count].iter().zip(fractions);
            weighted_nodes.extend(edge_nodes.map(|(&node, fraction)| WeightedNode {
                node,
                segment: edge_vector.map(|component| fraction * component),
            }));
            start += segment_count;
        }
        Ok(weighted_nodes)
    }

    /// Whether three nodes are an edge of an eight-node element, with the middle node second.
    fn is_quadratic_edge(&self, edge: &[usize]) -> bool {
        self.mesh().elements().any(|element| {
            // The four corners come first, then the nodes of the edges.
            let nodes = element.nodes();
            nodes.len() == 8
                && nodes[..4].contains(&edge[0])
                && nodes[4..].contains(&edge[1])
                && nodes[..4].contains(&edge[2])
        })
    }
}
