//! Base and soil glued together.

use super::{Condition, ContactState, InterfaceLaw, Mode, StepStart, Tolerance};

/// Base and soil never separate or slide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bonded;

impl InterfaceLaw for Bonded {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn conditions(&self, _mode: Mode, start: &StepStart) -> [Condition; 2] {
        [Condition::gap_is(start.state.gap), Condition::slip_is(start.state.slip)]
    }

    fn next_mode(&self, _: Mode, _: &StepStart, _: &ContactState, _: Tolerance) -> Mode {
        Mode::Stick
    }
}
