//! Forces across a horizontal cut of a finite-element model, and rows for loads along a line of nodes.

use crate::error::{Error, Result, at_least, finite, in_bounds, positive, require_part};
use crate::fem::{Direction, MatrixKind, assemble};
use crate::structure::{DofCombination, FemModel, SectionRows, Triplets};

/// Forces that the part above a horizontal cut exerts on the part below, per metre.
///
/// They contain the elastic forces, the damping forces except mass-proportional ones, and the inertia that the
/// elements above have at the nodes of the cut. To include the weight of the elements above, add the acceleration
/// of gravity to the vertical accelerations.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Height of the cut, m.
    pub height: f64,
    /// Horizontal force on the part below, N, positive to the right; at the base, the base shear.
    pub shear: SectionRows,
    /// Vertical force on the part below, N, positive downwards (compression).
    pub compression: SectionRows,
    /// Moment on the part below about the reference point, N m, counter-clockwise.
    pub moment: SectionRows,
}

impl FemModel {
    /// Forces that the part above `height` (m) exerts on the part below.
    ///
    /// Moments refer to the point (`reference`, `height`).
    ///
    /// The nodes at this height are the cut; elements that lie in it count as below. The rows are
    /// −K, −C and −M of the elements above, summed over the nodes of the cut.
    ///
    /// # Errors
    /// [`Error::Input`] when a number is not finite, when no node lies at `height`, when no element lies above it,
    /// or when an element crosses it.
    pub fn section(&self, height: f64, reference: f64) -> Result<Section> {
        finite("height of the section", height)?;
        finite("reference point of the section", reference)?;
        let tolerance = self.mesh.tolerance();
        let cut = self.mesh.nodes_at_height(height, tolerance)?;
        let sides = |points: &[[f64; 2]]| {
            let above = points.iter().any(|point| point[1] > height + tolerance);
            let below = points.iter().any(|point| point[1] < height - tolerance);
            (above, below)
        };
        let is_above = |points: &[[f64; 2]]| sides(points) == (true, false);
        let fault =
            |needed| Error::Input { quantity: "height of the section", value: height, needed };
        let elements = self.mesh.elements();
        let mut all = elements.map(|element| sides(&self.mesh.coordinates(element.nodes())));
        if all.clone().any(|side| side == (true, true)) {
            return Err(fault("a height that no element crosses"));
        }
        if cut.is_empty() || !all.any(|side| side == (true, false)) {
            return Err(fault("the height of a row of nodes with elements above it"));
        }
        let sum = |quantity, factor: f64| {
            let mut matrix = Triplets::new(self.numbering.dofs());
            assemble(&self.mesh, &self.numbering, quantity, -factor, is_above, &mut matrix);
            matrix
        };
        let matrices = [
            vec![sum(MatrixKind::Stiffness, 1.0), sum(MatrixKind::GeometricStiffness, 1.0)],
            vec![
                sum(MatrixKind::Stiffness, self.damping.stiffness()),
                sum(MatrixKind::Damping, 1.0),
            ],
            vec![sum(MatrixKind::Mass(self.mass_kind), 1.0)],
        ];
        // The work of the cut's forces on a rigid motion is their resultant.
        let rows = |direction: Direction, sign: f64| {
            let number = |node, own| self.numbering.dof(node, own);
            let mut motion = vec![0.0; self.numbering.dofs()];
            self.fill_rigid_motion(direction, [reference, height], &mut motion, number);
            let mut weights = vec![0.0; motion.len()];
            for &node in &cut {
                for dof in Direction::ALL.iter().filter_map(|&d| number(node, d)) {
                    weights[dof] = sign * motion[dof];
                }
            }
            let [displacement, velocity, acceleration] = [0, 1, 2].map(|order| {
                let row = weighted_rows(&weights, &matrices[order]);
                self.links.as_ref().map_or_else(|| row.clone(), |links| links.row(&row)).into()
            });
            let unit = if direction == Direction::Rotation { "N·m/m" } else { "N/m" };
            SectionRows { unit, displacement, velocity, acceleration }
        };
        Ok(Section {
            height,
            shear: rows(Direction::X, 1.0),
            compression: rows(Direction::Y, -1.0),
            moment: rows(Direction::Rotation, 1.0),
        })
    }
}

/// wᵀ A for the sum A of `matrices`, without zeros.
fn weighted_rows(weights: &[f64], matrices: &[Triplets]) -> Vec<(usize, f64)> {
    let mut sums = vec![0.0; weights.len()];
    for &(row, column, value) in matrices.iter().flat_map(Triplets::entries) {
        if let (Some(weight), Some(sum)) = (weights.get(row), sums.get_mut(column)) {
            *sum += weight * value;
        }
    }
    sums.into_iter().enumerate().filter(|&(_, value)| value != 0.0).collect()
}

// Rows for loads along a line of nodes: pressures, tractions, resultants.

impl FemModel {
    /// Row of nodal forces for a pressure of 1 Pa along the line through `nodes`.
    ///
    /// For a [`Load`](crate::coupled::Load) in Pa. The pressure pushes to the left of the direction from the first
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
    /// let force = row.value(&tower.rigid_motion(Direction::X, [0.0, 0.0]));
    /// assert!((force - 10.0).abs() < 1e-12);
    /// let wind = Load::new(row, |t: f64| 1.0e3 * (0.5 * t).sin().powi(2));
    /// # let _ = wind;
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than two nodes, [`Error::Index`] for a node that does not exist, [`Error::Input`]
    /// for two successive nodes at one place, [`Error::NoDof`] for a node that no element moves in a direction of
    /// the pressure.
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

    /// Row of nodal forces for a unit force (1 N/m) in `direction`.
    ///
    /// It is spread evenly along the line through `nodes`, for a [`Load`](crate::coupled::Load) in N/m.
    ///
    /// # Errors
    /// As for [`FemModel::pressure_row`]; [`Error::Scene`] for [`Direction::Rotation`].
    pub fn resultant_row(&self, nodes: &[usize], direction: Direction) -> Result<DofCombination> {
        let needed = "a direction along x or y";
        require_part("resultant along a line", direction != Direction::Rotation, needed)?;
        let weights = self.line_weights(nodes)?;
        let lengths = || weights.iter().map(|(_, [x, y])| x.hypot(*y));
        let whole: f64 = lengths().sum();
        let mut row = DofCombination::default();
        for ((node, _), length) in weights.iter().zip(lengths()) {
            row += (length / whole) * self.row(*node, direction)?;
        }
        Ok(row)
    }

    /// The nodes of a line with their parts of its length, `[x, y]` in m; a node may occur more than once.
    fn line_weights(&self, nodes: &[usize]) -> Result<Vec<(usize, [f64; 2])>> {
        at_least("nodes of a loaded line", nodes.len(), 2)?;
        let all = self.mesh().nodes();
        let at = |index: usize| in_bounds("node", index, all.len()).map(|index| all[index]);
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

    /// Whether three nodes are an edge of an eight-node element, with the middle node second.
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
