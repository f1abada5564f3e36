//! Rows for loads along a line of nodes: pressures, tractions, resultants.

use super::fem_model::FemModel;
use crate::error::{Error, Result, positive};
use crate::fem::Direction;
use crate::structure::DofCombination;

impl FemModel {
    /// A pressure of 1 Pa along the line through `nodes`, for a [`Load`](crate::coupled::Load) in Pa: it
    /// pushes to the left of the way from the first to the last (into a body whose boundary is walked
    /// counter-clockwise).
    ///
    /// Forces do the work of the pressure on the elements' edges: halves at the ends of a segment,
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
    ///     .map(|y| tower.node_at(-2.0, y))
    ///     .collect::<Result<_, _>>()?;
    /// let row = tower.pressure_row(&side)?;
    /// let force = row.value(&tower.rigid_motion(Direction::X, [0.0, 0.0]));
    /// assert!((force - 10.0).abs() < 1e-12);
    /// let wind = Load::new(row, |t: f64| 1.0e3 * (0.5 * t).sin().powi(2));
    /// # let _ = wind;
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than two nodes, [`Error::Index`] for one that does not exist,
    /// [`Error::Input`] for two in a row at one place, [`Error::NoUnknown`] for one that no element
    /// moves in a direction that is pushed.
    pub fn pressure_row(&self, nodes: &[usize]) -> Result<DofCombination> {
        let mut row = DofCombination::default();
        for (node, [x, y]) in self.line_weights(nodes)? {
            // The normal to the left, times the length.
            for (direction, force) in [(Direction::X, -y), (Direction::Y, x)] {
                if force != 0.0 {
                    row += force * self.row(node, direction)?;
                }
            }
        }
        Ok(row)
    }

    /// A force of 1 N per metre of thickness in `direction`, spread evenly along the line through
    /// `nodes`, for a [`Load`](crate::coupled::Load) in N/m.
    ///
    /// # Errors
    /// As for [`FemModel::pressure_row`]; [`Error::Scene`] for [`Direction::Rotation`].
    pub fn resultant_row(&self, nodes: &[usize], direction: Direction) -> Result<DofCombination> {
        if direction == Direction::Rotation {
            let needed = "a direction along x or y";
            return Err(Error::Scene { quantity: "resultant along a line", needed });
        }
        let weights = self.line_weights(nodes)?;
        let lengths = || weights.iter().map(|(_, [x, y])| x.hypot(*y));
        let whole: f64 = lengths().sum();
        let mut row = DofCombination::default();
        for ((node, _), length) in weights.iter().zip(lengths()) {
            row += (length / whole) * self.row(*node, direction)?;
        }
        Ok(row)
    }

    /// The nodes of a line with their shares of its way, `[x, y]` in m; one may come more than once.
    fn line_weights(&self, nodes: &[usize]) -> Result<Vec<(usize, [f64; 2])>> {
        if nodes.len() < 2 {
            let quantity = "nodes of a loaded line";
            return Err(Error::Size { quantity, found: nodes.len(), needed: 2 });
        }
        let all = self.mesh().nodes();
        let at = |index: usize| {
            let bound = all.len();
            all.get(index).copied().ok_or(Error::Index { quantity: "node", index, bound })
        };
        let mut weights = Vec::with_capacity(2 * nodes.len());
        let mut k = 0;
        while k + 1 < nodes.len() {
            let middle = nodes.get(k..k + 3).filter(|edge| self.is_quadratic_edge(edge));
            let (count, shares): (usize, &[f64]) = match middle {
                Some(_) => (2, &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]),
                None => (1, &[0.5, 0.5]),
            };
            let [from, to] = [at(nodes[k])?, at(nodes[k + count])?];
            let way = [to[0] - from[0], to[1] - from[1]];
            positive("distance between nodes of a loaded line", way[0].hypot(way[1]))?;
            let own = nodes[k..=k + count].iter().zip(shares);
            weights.extend(own.map(|(&node, share)| (node, way.map(|w| share * w))));
            k += count;
        }
        Ok(weights)
    }

    /// Whether three nodes are an edge of an eight-node element, its middle node between the others.
    fn is_quadratic_edge(&self, edge: &[usize]) -> bool {
        self.mesh().elements().any(|element| {
            let own = element.nodes();
            let place = |node| own.iter().position(|n| *n == node);
            let [Some(a), Some(middle), Some(b)] = [place(edge[0]), place(edge[1]), place(edge[2])]
            else {
                return false;
            };
            own.len() == 8 && a < 4 && b < 4 && middle >= 4
        })
    }
}
