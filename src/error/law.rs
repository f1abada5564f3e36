//! Answers that an interface law must not give.

use super::Error;

/// An interface law answered what it must not.
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
        /// [Word](crate::interface::Mode::word) of the mode that the law was asked about; for its memory, the mode that the step ends in.
        mode: &'static str,
        /// Name of the quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number that is not finite, for a reason that the law knows
    /// ([`InterfaceLaw::check_start`](crate::interface::InterfaceLaw::check_start)).
    #[error("interface law of element {element}, mode {mode}: {reason}")]
    Refused {
        /// Element, from the left, from 0.
        element: usize,
        /// [Word](crate::interface::Mode::word) of the mode that the law was asked about.
        mode: &'static str,
        /// The law's reason.
        reason: Box<Error>,
    },
    /// A next mode that is none of the law's modes.
    #[error(
        "interface law of element {element}, mode {mode}: the next mode is {next}, but must be one of \
         the law's `modes`"
    )]
    UnknownMode {
        /// Element, from the left, from 0.
        element: usize,
        /// Word of the mode that was tried.
        mode: &'static str,
        /// Word of the mode that the law asked for.
        next: &'static str,
    },
}
