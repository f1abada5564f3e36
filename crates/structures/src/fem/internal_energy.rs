//! Energies of internal forces.

/// Stored and dissipated energy of internal forces, J.
///
/// In the plane it is per metre of thickness; that of a [`SolidMaterial`](crate::fem::SolidMaterial) is per m³.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InternalEnergy {
    /// Energy that unloading recovers.
    pub stored: f64,
    /// Energy turned into heat since the initial state; it never decreases.
    pub dissipated: f64,
}

impl std::ops::Add for InternalEnergy {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            stored: self.stored + other.stored,
            dissipated: self.dissipated + other.dissipated,
        }
    }
}
