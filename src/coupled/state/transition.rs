//! Changes of contact modes.

use crate::interface::Mode;

/// Change of an element's contact mode.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Transition {
    /// Number of the step of the change, from 1.
    pub step: usize,
    /// Time at the end of that step, s.
    pub time: f64,
    /// Index of the element from the left, from 0.
    pub element: usize,
    /// Mode before the change.
    pub from: Mode,
    /// Mode after the change.
    pub to: Mode,
}

impl Transition {
    /// Whether the element opened.
    pub(crate) fn is_debonding(&self) -> bool {
        self.from.is_closed() && !self.to.is_closed()
    }

    /// Whether the element closed again.
    pub(crate) fn is_rebonding(&self) -> bool {
        !self.from.is_closed() && self.to.is_closed()
    }
}
