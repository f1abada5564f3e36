//! Forces across a horizontal cut of a finite-element model.

use crate::error::{Error, Result, finite, require_part};
use crate::fem::{Direction, MatrixKind, assemble};
use crate::structure::{FemModel, SectionRows, Triplets};

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
    /// or when an element crosses it; [`Error::Scene`] for a mesh in space.
    pub fn section(&self, height: f64, reference: f64) -> Result<Section> {
        require_part("section at a height", !self.mesh.has_depth(), "a mesh in the plane")?;
        finite("height of the section", height)?;
        finite("reference point of the section", reference)?;
        let tolerance = self.mesh.tolerance();
        let cut = self.mesh.nodes_at_height(height, tolerance)?;
        let sides = |points: &[[f64; 3]]| {
            let above = points.iter().any(|point| point[1] > height + tolerance);
            let below = points.iter().any(|point| point[1] < height - tolerance);
            (above, below)
        };
        let is_above = |points: &[[f64; 3]]| sides(points) == (true, false);
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
            self.fill_rigid_motion(direction, [reference, height, 0.0], &mut motion, number);
            let mut weights = vec![0.0; motion.len()];
            for &node in &cut {
                for dof in self.mesh.directions().iter().filter_map(|&d| number(node, d)) {
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
