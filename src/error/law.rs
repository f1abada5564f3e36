//! Answers that an interface law must not give.

use super::Error;
use crate::interface::Mode;

/// An interface law answered what it must not.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawError {
    /// A number that is not finite.
    #[error(
        "interface law of element {element}, mode {mode:?}: {quantity} is {value}, but must be finite"
    )]
    NotFinite {
        /// Element, from the left, from 0.
        element: usize,
        /// Mode that the law was asked about; for its memory, the mode that the step ends in.
        mode: Mode,
        /// Name of the quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number that is not finite, for a reason that the law knows
    /// ([`InterfaceLaw::check_start`](crate::interface::InterfaceLaw::check_start)).
    #[error("interface law of element {element}, mode {mode:?}: {reason}")]
    Refused {
        /// Element, from the left, from 0.
        element: usize,
        /// Mode that the law was asked about.
        mode: Mode,
        /// The law's reason.
        reason: Box<Error>,
    },
    /// A next mode that is none of the law's modes.
    #[error(
        "interface law of element {element}, mode {mode:?}: the next mode is {next:?}, but must be one of \
         the law's `modes`"
    )]
    UnknownMode {
        /// Element, from the left, from 0.
        element: usize,
        /// Mode that was tried.
        mode: Mode,
        /// Mode that the law asked for.
        next: Mode,
    },
}
