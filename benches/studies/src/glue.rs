//! A thin layer that never lets go: what "bonded" is with the paper's interface elements.

use basemat::interface::{
    Condition, ContactState, InterfaceLaw, Mode, StepStart, ThinLayer, Tolerance,
};

/// The stick mode of a thin layer, for good.
pub(crate) struct Glue(pub(crate) ThinLayer);

impl InterfaceLaw for Glue {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn conditions(&self, mode: Mode, start: &StepStart) -> [Condition; 2] {
        self.0.conditions(mode, start)
    }

    fn next_mode(&self, _: Mode, _: &StepStart, _: &ContactState, _: Tolerance) -> Mode {
        Mode::Stick
    }

    fn compliance(&self, mode: Mode, start: &StepStart) -> [f64; 2] {
        self.0.compliance(mode, start)
    }
}
