//! Boundary conditions of an element.

/// Boundary condition of an element: the quantity that is prescribed there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundaryCondition {
    /// The traction is known (zero on a free surface), the displacement is sought.
    TractionFree,
    /// The displacement is known (contact that sticks), the traction is sought.
    PrescribedDisplacement,
}
