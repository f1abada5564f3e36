//! Why a structure cannot be stepped in reduced coordinates.

/// The reason for which [`Coordinates::Reduced`](crate::coupled::Coordinates::Reduced) is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReducedError {
    /// The structure is nonlinear.
    #[error("they need a linear structure")]
    Nonlinear,
    /// A matrix of the structure lacks a property.
    #[error("the {matrix} must be {needed}")]
    Matrix {
        /// Name of the matrix.
        matrix: &'static str,
        /// Property that it lacks.
        needed: &'static str,
    },
    /// Damping that couples the modes.
    #[error(
        "the damping couples the modes: {coupling:.1e} beside its largest modal coefficient, where \
         proportional damping has rounding"
    )]
    Damping {
        /// Largest coefficient between two modes over the largest of one.
        coupling: f64,
    },
    /// Responses are not as accurate as was asked for: of structures with too little damping of the
    /// frequencies that a step cannot follow, and where rounding gets in the way.
    #[error(
        "responses to sudden tractions still err by {reached:.1e} with {vectors} vectors, but \
         {tolerance:.1e} was asked for (undamped structures cannot be reduced: damping in proportion \
         to stiffness helps)"
    )]
    Accuracy {
        /// Error that was asked for.
        tolerance: f64,
        /// Error that was reached.
        reached: f64,
        /// Number of vectors then.
        vectors: usize,
    },
    /// The lowest modes are lost in the rounding of the highest.
    #[error(
        "the lowest eigenvalue besides zero is {ratio:.1e} of the highest, and double precision \
         tells it from zero only above {least:.0e}"
    )]
    Spectrum {
        /// Lowest over highest eigenvalue.
        ratio: f64,
        /// Least ratio that is accepted.
        least: f64,
    },
}
