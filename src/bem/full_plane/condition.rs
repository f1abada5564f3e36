//! What is known on a boundary element.

/// What is known on a boundary element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundaryCondition {
    /// The traction is known (zero on a free surface), the displacement is sought.
    TractionFree,
    /// The displacement is known (contact that sticks), the traction is sought.
    PrescribedDisplacement,
}
