//! Forces across a horizontal cut of a finite-element model in the plane.

use super::cut::Cut;
use crate::error::{Result, require_part};
use crate::fem::Direction;
use crate::structure::{FemModel, SectionRows};

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
    /// −K, −C and −M of the elements above, summed over the nodes of the cut. A rigid body of linked nodes that
    /// reaches down to the cut counts as below with all its nodes.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) when a number is not finite, when no node lies at `height`, when no
    /// element lies above it, or when an element crosses it; [`Error::Scene`](crate::Error::Scene) for a mesh in
    /// space, whose cuts are made by [`section_in_space`](FemModel::section_in_space).
    pub fn section(&self, height: f64, reference: f64) -> Result<Section> {
        require_part(
            "section of three resultants",
            !self.mesh.has_depth(),
            "must be in a mesh in the plane, but this one is in space",
        )?;
        let cut = Cut::new(self, height, [reference, 0.0])?;
        Ok(Section {
            height,
            shear: cut.rows(Direction::X, 1.0),
            compression: cut.rows(Direction::Y, -1.0),
            moment: cut.rows(Direction::Rotation, 1.0),
        })
    }
}
