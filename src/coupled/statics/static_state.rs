//! State of structure and contact before the first step.

use crate::error::Result;
use crate::geometry::ContactLayout;
use crate::interface::{ContactState, InterfaceLaw, LawForm, Mode, PreviousContacts, law_of};
use crate::structure::InternalEnergy;

/// Static state under weight and loads at t = 0, with its contact.
#[derive(Debug, Clone)]
pub(crate) struct StaticState {
    layout: ContactLayout,
    /// Tractions of all contact components, Pa.
    pub(crate) traction: Vec<f64>,
    /// Gap of each element, m.
    ///
    /// Positive if uplifted, negative for a compressed layer, zero in hard contact.
    pub(crate) gap: Vec<f64>,
    /// Displacement of the degrees of freedom, m and rad.
    pub(crate) displacement: Vec<f64>,
    /// Contact mode of each element.
    pub(crate) modes: Vec<Mode>,
    /// Load that the structure defines at t = 0, N.
    pub(crate) load: Vec<f64>,
    /// State variables of each element's law.
    ///
    /// Empty where the law starts with its initial state variables.
    pub(crate) state_variables: Vec<Vec<f64>>,
    /// Nonlinear force f(u), N; empty for a linear structure.
    pub(crate) force: Vec<f64>,
    /// Energies of the nonlinear force, if the structure returns them.
    pub(crate) energy: Option<InternalEnergy>,
    /// Friction coefficient that replaced a larger coefficient on a sliding element.
    ///
    /// `None` if no coefficient was replaced.
    pub(crate) substituted_friction: Option<f64>,
    /// Factor of the load pattern of a prescribed displacement; zero without one.
    pub(crate) load_factor: f64,
}

impl StaticState {
    /// State without weight: all elements are closed, without pressure.
    pub(crate) fn weightless(layout: ContactLayout, dof_count: usize) -> Self {
        let element_count = layout.elements();
        Self {
            layout,
            traction: vec![0.0; layout.len()],
            gap: vec![0.0; element_count],
            displacement: vec![0.0; dof_count],
            modes: vec![Mode::Stick; element_count],
            load: vec![0.0; dof_count],
            state_variables: Vec::new(),
            force: Vec::new(),
            energy: None,
            substituted_friction: None,
            load_factor: 0.0,
        }
    }

    /// Contact modes at the start of the next static stage or of the run.
    ///
    /// Closed elements stick.
    pub(crate) fn initial_modes(&self, laws: &[Box<dyn InterfaceLaw>]) -> Vec<Mode> {
        let form = LawForm::of(self.layout);
        let modes = self.modes.iter().enumerate().map(|(e, mode)| {
            let law_modes = law_of(laws, e).modes();
            if law_modes.contains(mode) && !mode.is_closed() {
                return *mode;
            }
            match form {
                LawForm::Modes => law_modes[0],
                LawForm::Limits => law_modes[0].in_any_direction(),
            }
        });
        modes.collect()
    }

    /// Sets the gaps: exactly as a law prescribes them, otherwise as the contact solver computed them.
    pub(crate) fn set_gaps(
        &mut self,
        laws: &[Box<dyn InterfaceLaw>],
        previous_contacts: &PreviousContacts,
        states: &[ContactState],
    ) -> Result<()> {
        let form = LawForm::of(self.layout);
        for (e, gap) in self.gap.iter_mut().enumerate() {
            let law = law_of(laws, e);
            let previous = previous_contacts.element(e);
            let mode = self.modes[e];
            let pressure = self.traction[e];
            let prescribed = match form {
                LawForm::Modes => {
                    let conditions = law.conditions(mode, &previous);
                    conditions.iter().find_map(|condition| condition.gap_at(pressure))
                }
                LawForm::Limits if mode.is_closed() && !mode.is_yield() => {
                    let compliance = law.compliance(Mode::Stick, &previous)[0];
                    Some(law.limits(&previous)?.gap_offset - compliance * pressure)
                }
                LawForm::Limits => None,
            };
            *gap = prescribed.unwrap_or(states[e].gap);
        }
        Ok(())
    }
}
