//! Rows of a section resultant over displacements, velocities and accelerations.

use super::DofCombination;

/// Linear function of displacement, velocity and acceleration, as sparse rows.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionRows {
    /// Unit of the resultant: "N/m" for a force, "N·m/m" for a moment.
    pub unit: &'static str,
    /// Weights of the displacements.
    pub displacement: DofCombination,
    /// Weights of the velocities: dashpots and stiffness-proportional damping.
    pub velocity: DofCombination,
    /// Weights of the accelerations: the part of the mass above that acts on the cut's nodes.
    pub acceleration: DofCombination,
}

impl Default for SectionRows {
    /// A force that is zero.
    fn default() -> Self {
        Self {
            unit: "N/m",
            displacement: DofCombination::default(),
            velocity: DofCombination::default(),
            acceleration: DofCombination::default(),
        }
    }
}

impl SectionRows {
    /// The resultant's value.
    ///
    /// The slices hold all degrees of freedom; indices beyond their ends count as zero.
    pub fn value(&self, displacement: &[f64], velocity: &[f64], acceleration: &[f64]) -> f64 {
        self.displacement.value(displacement)
            + self.velocity.value(velocity)
            + self.acceleration.value(acceleration)
    }
}
