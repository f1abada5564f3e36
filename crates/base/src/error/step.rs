//! Errors of steps and of interface laws.

use crate::error::{Error, first_not_finite};

/// Reason why a time step failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// No set of contact modes satisfied the interface laws.
    #[error(
        "contact modes not found in {iterations} trials{}, residual {residual:.2e}, modes {} \
         (`analyses::largest_convergent_step` finds a time step that converges)",
        no_solution_text(*sets), modes.join(" ")
    )]
    Contact {
        /// Number of trials, fallbacks included.
        iterations: usize,
        /// Relative difference between the tractions of the last two sets of modes.
        ///
        /// The laws require the second set after the first. The value is 1 if either set is singular.
        residual: f64,
        /// Words (`Mode`'s `Display`) of the modes of the last trial, left to right.
        modes: Vec<&'static str>,
        /// Number of all sets of modes, if all were tried.
        ///
        /// The step then has no solution. `None` if not all were tried, as for more than 65 536 sets.
        sets: Option<usize>,
    },
    /// No contact forces satisfied the interface laws, in plan or on soil that hardens.
    #[error(
        "contact forces not found in {iterations} iterations, residual {residual:.2e}, elements {} \
         (`analyses::largest_convergent_step` finds a time step that converges)",
        elements.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
    )]
    Cone {
        /// Number of sweeps and Newton iterations, including the proximal method's.
        ///
        /// On soil that hardens, the number of linearisations of its law.
        iterations: usize,
        /// Largest difference of an element's force from its law, relative to the largest force.
        residual: f64,
        /// Elements with too large a difference of forces.
        elements: Vec<usize>,
    },
    /// Newton's iteration for a nonlinear structure did not converge.
    #[error(
        "Newton's iteration did not converge in {iterations} iterations, residual {residual:.2e}, \
         {}modes {} (`analyses::largest_convergent_step` finds a time step that converges)",
        state.as_ref().map(|state| format!("{state}, ")).unwrap_or_default(), modes.join(" ")
    )]
    Newton {
        /// Number of iterations.
        iterations: usize,
        /// Last out-of-balance force relative to the largest force.
        residual: f64,
        /// Words (`Mode`'s `Display`) of the contact modes of the last iteration, left to
        /// right.
        modes: Vec<&'static str>,
        /// Where the force is out of balance, with the state of the structure there.
        ///
        /// `None` unless the structure describes its state (`NonlinearForce::describe_state`).
        state: Option<String>,
    },
    /// A part of the scene returned an error.
    ///
    /// The part is the structure (load, nonlinear force, tangent) or the ground (history).
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
        /// Index from 0.
        ///
        /// For a structure it is the degree of freedom, or the mode in modal coordinates. For a base it is the contact
        /// component, normal components first, then tangential ones. For loads it is the number of the load.
        index: usize,
        /// The value.
        value: f64,
    },
    /// The structure is unstable: its motion grows without limit.
    ///
    /// Causes are the weight on yielding columns (P–Δ), negative damping or an unstable ground. The energy balance
    /// still closes.
    #[error("the structure is unstable: its displacement grows by {increment:e} in one step")]
    Runaway {
        /// Largest change of a degree of freedom in the step, m or rad.
        ///
        /// In modal coordinates its unit is m √kg.
        increment: f64,
    },
}

/// Text for a step without a solution; empty otherwise.
///
/// `set_count`: number of all sets of modes, if all were tried.
fn no_solution_text(set_count: Option<usize>) -> String {
    set_count.map_or_else(String::new, |count| {
        format!(": the step has no solution: none of all {count} sets of modes satisfies the laws")
    })
}

impl StepError {
    /// Returns an error if one of `values` is not finite.
    #[doc(hidden)]
    pub fn check_finite(quantity: &'static str, values: &[f64]) -> std::result::Result<(), Self> {
        match first_not_finite(values) {
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
    /// Word (`Mode`'s `Display`) of the mode for which the law was evaluated.
    ///
    /// For the state variables of the law, it is the mode at the end of the step.
    pub mode: &'static str,
    /// The error of the law.
    ///
    /// [`Error::Input`] for a number that is not finite, [`Error::Name`] for a next mode that the law does not list, or
    /// the error of `InterfaceLaw::check_start` or of the law's limits.
    pub reason: Box<Error>,
}

impl LawError {
    /// The error for a number of a law that is not finite.
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
