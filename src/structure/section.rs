//! Forces that pass through a horizontal cut.

use super::Row;

/// Linear function of displacement, velocity and acceleration, as sparse rows.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionRows {
    /// Unit of the resultant: "N/m" for a force, "N·m/m" for a moment.
    pub unit: &'static str,
    /// Weights of the displacements.
    pub displacement: Row,
    /// Weights of the velocities: dashpots and stiffness-proportional damping.
    pub velocity: Row,
    /// Weights of the accelerations: the share of the mass above that sits on the cut's nodes.
    pub acceleration: Row,
}

impl Default for SectionRows {
    /// A force that is zero.
    fn default() -> Self {
        Self {
            unit: "N/m",
            displacement: Row::default(),
            velocity: Row::default(),
            acceleration: Row::default(),
        }
    }
}

impl SectionRows {
    /// The resultant's value; slices of all unknowns, indices beyond their ends count as zero.
    pub fn value(&self, displacement: &[f64], velocity: &[f64], acceleration: &[f64]) -> f64 {
        self.displacement.value(displacement)
            + self.velocity.value(velocity)
            + self.acceleration.value(acceleration)
    }
}

/// Resultant of what the part above a horizontal cut exerts on the part below, per metre.
///
/// It holds the elastic forces, the damping forces except mass-proportional ones, and the inertia
/// of the elements above as far as it sits on the nodes of the cut. To count the weight of the
/// elements above too, add the acceleration of gravity to the vertical accelerations.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Height of the cut, m.
    pub height: f64,
    /// Horizontal force on the part below, N, positive to the right: the base shear when the cut
    /// is the base.
    pub shear: SectionRows,
    /// Vertical force on the part below, N, positive downwards (compression).
    pub compression: SectionRows,
    /// Moment on the part below about the reference point, N m, counter-clockwise.
    pub moment: SectionRows,
}
