//! Errors of interface laws.

use crate::error::Error;

/// Value that an interface law returned and that is invalid, or the law's own reason against a state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("interface law of element {element}, mode {mode}: {reason}")]
pub struct LawError {
    /// Element, from the left, from 0.
    pub element: usize,
    /// Word ([`Mode`](crate::interface::Mode)'s `Display`) of the mode for which the law was evaluated; for its state
    /// variables, the mode at the end of the step.
    pub mode: &'static str,
    /// [`Error::Input`] for a number that is not finite, [`Error::Name`] for a next mode that the law does not list, or
    /// the error of [`InterfaceLaw::check_start`](crate::interface::InterfaceLaw::check_start) or of the law's limits.
    pub reason: Box<Error>,
}

impl LawError {
    /// A number of a law that is not finite.
    #[cold]
    pub(crate) fn not_finite(
        element: usize,
        mode: &'static str,
        quantity: &'static str,
        value: f64,
    ) -> Self {
        let reason = Box::new(Error::Input { quantity, value, needed: "finite" });
        Self { element, mode, reason }
    }
}
