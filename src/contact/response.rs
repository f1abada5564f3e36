//! Tractions of the elements, and the jumps and states that follow from them.

use super::problem::ContactInput;
use crate::geometry::ContactLayout;
use crate::interface::ContactState;

/// Tractions of a trial or solution, with the jumps and states of the elements.
pub(crate) struct ContactResponse {
    pub(super) layout: ContactLayout,
    /// Change of traction from the static state, Pa, for each contact component.
    pub(crate) traction: Vec<f64>,
    /// Jump, m, for each contact component.
    pub(super) jump: Vec<f64>,
    /// Opening and total traction of each element.
    pub(crate) states: Vec<ContactState>,
}

impl ContactResponse {
    /// Response without tractions.
    pub(super) fn new(layout: ContactLayout) -> Self {
        Self {
            layout,
            traction: vec![0.0; layout.len()],
            jump: vec![0.0; layout.len()],
            states: vec![ContactState::default(); layout.elements()],
        }
    }

    /// Computes the jump and the states for the present tractions.
    pub(super) fn evaluate(&mut self, input: &ContactInput<'_>) {
        self.jump.copy_from_slice(input.free_jump);
        input.delassus.multiply_add(&self.traction, &mut self.jump);
        self.update_states(input);
    }

    /// Computes the states for the present tractions and jump.
    pub(super) fn update_states(&mut self, input: &ContactInput<'_>) {
        let Self { layout, traction, jump, states } = self;
        let is_plan = layout.is_plan();
        for (e, state) in states.iter_mut().enumerate() {
            let place = |component| layout.place(component, e);
            let total = |i: usize| input.static_traction[i] + traction[i];
            *state =
                ContactState::from_components(|k| jump[place(k)], |k| total(place(k)), is_plan);
        }
    }
}
