//! Errors of parts: a user's own, interface laws, reduced structures.

use super::Error;

impl Error {
    /// Makes an [`Error::Part`], for a user's own part when no other error fits.
    ///
    /// ```
    /// use basemat::bem::SpringGround;
    /// use basemat::interface::{
    ///     Condition, ContactScene, ContactState, Coulomb, InterfaceLaw, Mode, PreviousContact, Tolerance,
    /// };
    /// use basemat::structure::RigidBlock;
    /// use basemat::{Error, Result, Simulation};
    ///
    /// /// Friction of a bearing that was tested for steps of up to 5 ms.
    /// struct Bearing(Coulomb);
    ///
    /// impl InterfaceLaw for Bearing {
    ///     fn check(&self, scene: &ContactScene) -> Result<()> {
    ///         if scene.time_step <= 0.005 {
    ///             return Ok(());
    ///         }
    ///         Err(Error::part("bearing", format!("a step of {} s is too long", scene.time_step)))
    ///     }
    ///     // The rest is Coulomb's.
    ///     # fn modes(&self) -> &[Mode] { self.0.modes() }
    ///     # fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
    ///     #     self.0.conditions(mode, start)
    ///     # }
    ///     # fn next_mode(
    ///     #     &self, mode: Mode, start: &PreviousContact, trial: &ContactState, tolerance: Tolerance,
    ///     # ) -> Mode {
    ///     #     self.0.next_mode(mode, start, trial, tolerance)
    ///     # }
    /// }
    ///
    /// let refused = Simulation::builder(0.01)
    ///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
    ///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
    ///     .interface(Bearing(Coulomb::new(0.1)?))
    ///     .build()
    ///     .unwrap_err();
    /// assert_eq!(refused.to_string(), "bearing: a step of 0.01 s is too long");
    /// # Ok::<(), Error>(())
    /// ```
    pub fn part(part: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Part { part: part.into(), reason: reason.into() }
    }
}

// Values that an interface law must not return.

/// Invalid value that an interface law returned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawError {
    /// A number that is not finite.
    #[error(
        "interface law of element {element}, mode {mode}: {quantity} is {value}, but must be finite"
    )]
    NotFinite {
        /// Element, from the left, from 0.
        element: usize,
        /// Word ([`Mode`](crate::interface::Mode)'s `Display`) of the mode for which the law was evaluated; for
        /// its state variables, the mode at the end of the step.
        mode: &'static str,
        /// Name of the quantity.
        quantity: &'static str,
        /// Value of the quantity.
        value: f64,
    },
    /// Limits or a start that the law rejects
    /// ([`InterfaceLaw::check_start`](crate::interface::InterfaceLaw::check_start)).
    #[error("interface law of element {element}, mode {mode}: {reason}")]
    Refused {
        /// Element, from the left, from 0.
        element: usize,
        /// Word ([`Mode`](crate::interface::Mode)'s `Display`) of the mode for which the law was evaluated.
        mode: &'static str,
        /// The law's reason.
        reason: Box<Error>,
    },
    /// A next mode that the law does not list.
    #[error(
        "interface law of element {element}, mode {mode}: the next mode is {next}, but must be one of \
         the law's `modes`"
    )]
    UnknownMode {
        /// Element, from the left, from 0.
        element: usize,
        /// Word of the mode that was tried.
        mode: &'static str,
        /// Word of the law's next mode.
        next: &'static str,
    },
}

// Why a structure cannot be stepped in reduced coordinates.

/// Reasons against [`Coordinates::Reduced`](crate::coupled::Coordinates::Reduced).
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
    /// Responses do not reach the given accuracy.
    ///
    /// The structure has too little damping at frequencies that a step cannot follow, or rounding is too large.
    #[error(
        "responses to sudden tractions still err by {reached:.1e} with {vectors} vectors, but \
         {tolerance:.1e} was asked for (undamped structures cannot be reduced: damping in proportion \
         to stiffness helps)"
    )]
    Accuracy {
        /// Given tolerance.
        tolerance: f64,
        /// Error reached.
        reached: f64,
        /// Number of vectors used.
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
        /// Smallest accepted ratio.
        least: f64,
    },
}
