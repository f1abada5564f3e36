//! Errors of steps and of interface laws.

use crate::error::{Error, not_finite};

/// Why a step failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// No set of contact modes satisfied the interface laws.
    #[error(
        "contact modes not found in {iterations} trials{}, residual {residual:.2e}, modes {} \
         (`analyses::largest_convergent_step` finds a time step that gets through)",
        no_solution(*sets), modes.join(" ")
    )]
    Contact {
        /// Number of trials, fallbacks included.
        iterations: usize,
        /// Difference between the tractions of these modes and the tractions of the modes that the laws require
        /// next, relative to the largest; 1 if either set of modes is singular.
        residual: f64,
        /// Words (`Mode`'s `Display`) of the modes of the last trial, left to right.
        modes: Vec<&'static str>,
        /// Number of all sets of modes, if all were tried: the step has no solution. `None` if there are more than
        /// 65 536 sets.
        sets: Option<usize>,
    },
    /// In plan, or on soil that hardens: no contact forces were found that satisfy the interface laws.
    #[error(
        "contact forces not found in {iterations} iterations, residual {residual:.2e}, elements {} \
         (`analyses::largest_convergent_step` finds a time step that gets through)",
        elements.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
    )]
    Cone {
        /// Number of sweeps and Newton iterations, including the proximal method's; on soil that hardens, of its tangents.
        iterations: usize,
        /// Largest difference of an element's force from the force that its law allows at its displacement,
        /// relative to the largest force.
        residual: f64,
        /// Elements with too large a difference.
        elements: Vec<usize>,
    },
    /// Newton's iteration for a nonlinear structure did not converge.
    #[error(
        "Newton's iteration not converged in {iterations} iterations, residual {residual:.2e}, \
         modes {} (`analyses::largest_convergent_step` finds a time step that gets through)",
        modes.join(" ")
    )]
    Newton {
        /// Iterations made.
        iterations: usize,
        /// Last out-of-balance force relative to the largest force.
        residual: f64,
        /// Words (`Mode`'s `Display`) of the contact modes of the last iteration, left to
        /// right.
        modes: Vec<&'static str>,
    },
    /// A part of the scene returned an error.
    ///
    /// The structure for its load, nonlinear force or tangent, or the ground for its history.
    #[error("{quantity}: {source}")]
    Part {
        /// Name of the quantity.
        quantity: &'static str,
        /// Error of the part.
        r#source: Box<Error>,
    },
    /// An interface law returned an invalid value.
    #[error(transparent)]
    Law(#[from] LawError),
    /// A number became NaN or infinite.
    #[error("{quantity} is not finite: entry {index} is {value}")]
    NotFinite {
        /// Name of the quantity.
        quantity: &'static str,
        /// Index from 0: of a structure's quantity the degree of freedom (or mode, in modal coordinates); of a
        /// base's quantity the component (normal ones first, then tangential ones); of loads the number of the
        /// load.
        index: usize,
        /// The value.
        value: f64,
    },
    /// The structure has lost its stability: its motion grows without limit.
    ///
    /// By weight on yielding columns (P–Δ), negative damping or a growing ground. The energy balance still closes.
    #[error("the structure runs away: it moves by {increment:e} in one step")]
    Runaway {
        /// Largest change of a degree of freedom in the step, m or rad (in modes, times the root of a mass).
        increment: f64,
    },
}

/// Text for a step that has no solution, since all sets of modes were tried.
fn no_solution(sets: Option<usize>) -> String {
    sets.map_or_else(String::new, |sets| {
        format!(
            ": the step has no solution, as none of all {sets} sets of modes satisfies the laws"
        )
    })
}

impl StepError {
    /// Error if one of `values` is not finite.
    #[doc(hidden)]
    pub fn check_finite(quantity: &'static str, values: &[f64]) -> std::result::Result<(), Self> {
        match not_finite(values) {
            None => Ok(()),
            Some((index, value)) => Err(Self::NotFinite { quantity, index, value }),
        }
    }

    /// Wraps an error of a part of the scene as [`StepError::Part`].
    #[doc(hidden)]
    pub fn part(quantity: &'static str) -> impl FnOnce(Error) -> Self {
        move |source| Self::Part { quantity, source: Box::new(source) }
    }
}

/// Invalid value that an interface law returned, or the reason for which it rejects a state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("interface law of element {element}, mode {mode}: {reason}")]
pub struct LawError {
    /// Element, from the left, from 0.
    pub element: usize,
    /// Word (`Mode`'s `Display`) of the mode for which the law was evaluated; for its state
    /// variables, the mode at the end of the step.
    pub mode: &'static str,
    /// [`Error::Input`] for a number that is not finite, [`Error::Name`] for a next mode that the law does not list, or
    /// the error of `InterfaceLaw::check_start` or of the law's limits.
    pub reason: Box<Error>,
}

impl LawError {
    /// A number of a law that is not finite.
    #[cold]
    #[doc(hidden)]
    pub fn not_finite(
        element: usize,
        mode: &'static str,
        quantity: &'static str,
        value: f64,
    ) -> Self {
        let reason = Box::new(Error::Input { quantity, value, needed: "finite" });
        Self { element, mode, reason }
    }
}
