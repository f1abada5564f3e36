//! Numbers that an interface law must not return.

use crate::interface::Mode;

/// An interface law returned a number that is not finite.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "interface law of element {element}, mode {mode:?}: {quantity} is {value}, but must be finite"
)]
#[non_exhaustive]
pub struct LawError {
    /// Element, from the left, from 0.
    pub element: usize,
    /// Mode that the law was asked about; for its memory, the mode that the step ends in.
    pub mode: Mode,
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Its value.
    pub value: f64,
}
