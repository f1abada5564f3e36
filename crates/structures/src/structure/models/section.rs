//! Forces at a horizontal section of a finite-element model in the plane.

use super::cut::SectionCut;
use crate::error::{Result, require_part};
use crate::fem::Direction;
use crate::structure::{FemModel, SectionRows};

/// Forces that the part above a horizontal section exerts on the part below, per metre.
///
/// They consist of elastic forces, of damping forces without mass-proportional damping, and of the inertia of the
/// elements above at the nodes of the section. To include the weight of the elements above, add the acceleration of
/// gravity to the vertical accelerations.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Height of the section, m.
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
    /// The section consists of the nodes at this height; elements at this height belong to the part below. The rows are
    /// −K, −C and −M of the elements above, summed over the nodes of the section. A rigid body of linked nodes with a
    /// node at or below the section belongs to the part below with all its nodes.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) when a number is not finite, when no node lies at `height`, when no
    /// element lies above it, or when an element crosses it; [`Error::Part`](crate::Error::Part) when an element above
    /// it has internal variables; [`Error::Scene`](crate::Error::Scene) for a mesh in
    /// space, for which [`section_in_space`](FemModel::section_in_space) exists.
    pub fn section(&self, height: f64, reference: f64) -> Result<Section> {
        require_part(
            "section of three resultants",
            !self.mesh.has_depth(),
            "must be in a mesh in the plane, but this one is in space",
        )?;
        let cut = SectionCut::new(self, height, [reference, 0.0])?;
        Ok(Section {
            height,
            shear: cut.rows(Direction::X, 1.0),
            compression: cut.rows(Direction::Y, -1.0),
            moment: cut.rows(Direction::Rotation, 1.0),
        })
    }
}
