//! Weights of a section resultant on displacements, velocities and accelerations.

use super::DofCombination;

/// A force or moment as weighted sums of displacements, velocities and accelerations.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionRows {
    /// Unit of the resultant: "N/m" for a force, "N·m/m" for a moment.
    pub unit: &'static str,
    /// Weights of the displacements.
    pub displacement: DofCombination,
    /// Weights of the velocities: dashpots and stiffness-proportional damping.
    pub velocity: DofCombination,
    /// Weights of the accelerations: inertia of the part above the section.
    pub acceleration: DofCombination,
}

impl Default for SectionRows {
    /// Zero force per metre.
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
    /// Value of the resultant, by the motion of all degrees of freedom.
    ///
    /// Degrees of freedom beyond the end of a slice count as zero.
    pub fn value(&self, displacement: &[f64], velocity: &[f64], acceleration: &[f64]) -> f64 {
        self.displacement.value(displacement)
            + self.velocity.value(velocity)
            + self.acceleration.value(acceleration)
    }
}
