//! State of structure and contact before the first step.

use crate::error::Result;
use crate::geometry::ContactLayout;
use crate::interface::{ContactState, InterfaceLaw, LawForm, Mode, PreviousContacts, law_of};
use crate::structure::InternalEnergy;

/// Static state under weight and loads at t = 0, contact conditions included.
#[derive(Debug, Clone)]
pub(crate) struct StaticState {
    layout: ContactLayout,
    pub(crate) traction: Vec<f64>,
    /// Gaps: of uplifted elements, and (negative) of compressed layers; hard contact has zero.
    pub(crate) gap: Vec<f64>,
    pub(crate) displacement: Vec<f64>,
    pub(crate) modes: Vec<Mode>,
    /// Load that the structure brings at t = 0.
    pub(crate) load: Vec<f64>,
    /// State variables of each element's law where it acted; empty where the law starts anew.
    pub(crate) state_variables: Vec<Vec<f64>>,
    /// f(u) of a nonlinear structure, and its energies if it returns them.
    pub(crate) force: Vec<f64>,
    pub(crate) energy: Option<InternalEnergy>,
    /// Friction coefficient used instead of a larger one where an element slides; `None` if there was none.
    pub(crate) substituted_friction: Option<f64>,
}

impl StaticState {
    /// State without weight: all elements touch, without pressure.
    pub(crate) fn weightless(layout: ContactLayout, dofs: usize) -> Self {
        let elements = layout.elements();
        Self {
            layout,
            traction: vec![0.0; layout.len()],
            gap: vec![0.0; elements],
            displacement: vec![0.0; dofs],
            modes: vec![Mode::Stick; elements],
            load: vec![0.0; dofs],
            state_variables: Vec::new(),
            force: Vec::new(),
            energy: None,
            substituted_friction: None,
        }
    }

    /// Modes with which a base continues under `laws`: closed elements stick, whatever placed them.
    pub(crate) fn modes_with(&self, laws: &[Box<dyn InterfaceLaw>]) -> Vec<Mode> {
        let form = LawForm::of(self.layout);
        let modes = self.modes.iter().enumerate().map(|(e, mode)| {
            let modes = law_of(laws, e).modes();
            if modes.contains(mode) && !mode.is_closed() {
                return *mode;
            }
            match form {
                LawForm::Modes => modes[0],
                LawForm::Limits => modes[0].in_any_direction(),
            }
        });
        modes.collect()
    }

    /// Sets gaps from the states of the contact solver, exactly where a law prescribes them.
    pub(crate) fn close_gaps(
        &mut self,
        laws: &[Box<dyn InterfaceLaw>],
        start: &PreviousContacts,
        states: &[ContactState],
    ) -> Result<()> {
        let form = LawForm::of(self.layout);
        for (e, gap) in self.gap.iter_mut().enumerate() {
            let law = law_of(laws, e);
            let start = start.element(e);
            let mode = self.modes[e];
            let pressure = self.traction[e];
            let prescribed = match form {
                LawForm::Modes => {
                    let conditions = law.conditions(mode, &start);
                    conditions.iter().find_map(|condition| condition.gap_at(pressure))
                }
                LawForm::Limits if mode.is_closed() && !mode.is_yield() => {
                    let compliance = law.compliance(Mode::Stick, &start)[0];
                    Some(law.limits(&start)?.gap_offset - compliance * pressure)
                }
                LawForm::Limits => None,
            };
            *gap = prescribed.unwrap_or(states[e].gap);
        }
        Ok(())
    }
}
