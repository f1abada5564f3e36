//! State of each element at the start of a step, as its law receives it.

use super::{ContactState, InterfaceLaw, Mode, law_of};
use crate::error::{LawError, Result, finite, memory, same_length};

/// State of an element at the beginning of a step, as passed to its law.
///
/// In the signatures of a user's law it is `&PreviousContact`; the lifetime belongs to
/// `state_variables`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PreviousContact<'a> {
    /// Opening and traction at the end of the previous step.
    pub state: ContactState,
    /// Mode of the previous step.
    pub mode: Mode,
    /// Whether the element has been open at any time since the start of the run.
    ///
    /// Also true if its bond ([`InterfaceLaw::bond_overload`]) has broken in this step.
    pub has_opened: bool,
    /// Slip velocity of the previous step, m/s; in plan its magnitude.
    ///
    /// It is the change of slip in the step, divided by the time step.
    pub slip_rate: f64,
    /// Pressure of the static state, Pa.
    pub static_pressure: f64,
    /// Time step, s.
    pub time_step: f64,
    /// Settlement of the yielding soil in the present trial of the step, m.
    ///
    /// It is zero in the first trial of a step.
    ///
    /// A law whose pressure is a curve over the settlement returns the curve's tangent at this settlement, as
    /// [`Limits::pressure_cap`](super::Limits::pressure_cap) and [`Limits::hardening`](super::Limits::hardening). The step
    /// is solved again until the pressure is on the curve. The curve must rise, and its slope must decrease. Other laws
    /// ignore this field: with a hardening of zero at a settlement of zero the step has one trial.
    pub trial_settlement: f64,
    /// State variables of the law for this element ([`InterfaceLaw::state_variables`]); empty for a
    /// law without state variables.
    pub state_variables: &'a [f64],
}

impl<'a> PreviousContact<'a> {
    /// Start of a step of `time_step` seconds from `state`, to test a law without a simulation.
    ///
    /// `has_opened` is true if the mode is open. The slip rate is zero, the static pressure is the pressure of
    /// `state`, and there are no state variables. All fields can then be changed.
    ///
    /// ```
    /// use basemat::interface::{ContactState, Coulomb, InterfaceLaw, Mode, PreviousContact, Tolerance};
    /// let law = Coulomb::new(0.5)?;
    /// let pressed = ContactState { pressure: 10.0e3, ..ContactState::default() };
    /// let mut start = PreviousContact::new(pressed, Mode::Stick, 0.01);
    /// start.slip_rate = 0.2;
    /// let trial = ContactState { shear: 6.0e3, ..pressed };
    /// let next = law.next_mode(Mode::Stick, &start, &trial, Tolerance::new(1e-9, 1.0));
    /// assert_eq!(next, Mode::SlipRight);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn new(state: ContactState, mode: Mode, time_step: f64) -> Self {
        Self {
            state,
            mode,
            has_opened: !mode.is_closed(),
            slip_rate: 0.0,
            static_pressure: state.pressure,
            time_step,
            trial_settlement: 0.0,
            state_variables: &[],
        }
    }

    /// Initial state variables of `law` after this contact.
    pub(crate) fn first_state_variables(&self, law: &dyn InterfaceLaw) -> Vec<f64> {
        let mut state_variables = vec![0.0; law.state_variables()];
        if !state_variables.is_empty() {
            law.initial_state_variables(self, &mut state_variables);
        }
        state_variables
    }

    /// Copy of this contact without state variables, in its first trial.
    fn without_state_variables(&self) -> PreviousContact<'static> {
        let Self { state, mode, has_opened, slip_rate, static_pressure, time_step, .. } = *self;
        PreviousContact {
            state,
            mode,
            has_opened,
            slip_rate,
            static_pressure,
            time_step,
            trial_settlement: 0.0,
            state_variables: &[],
        }
    }

    /// This contact with other state variables, such as those of one of several combined laws.
    #[must_use]
    pub(crate) fn with_state_variables<'b>(self, state_variables: &'b [f64]) -> PreviousContact<'b>
    where
        'a: 'b,
    {
        PreviousContact { state_variables, ..self }
    }
}

/// The start of a step for all elements, with their state variables.
///
/// Elements of a strip are in order from left to right. Code with another integrator obtains this value from
/// [`ContactProblem::start`](crate::contact::ContactProblem::start), and may store a clone from which it repeats steps.
/// [`ContactSolution::commit`](crate::contact::ContactSolution::commit) advances it.
#[derive(Debug, Clone, PartialEq)]
pub struct PreviousContacts {
    /// Contact of each element at the start of the step, without its state variables.
    contacts: Vec<PreviousContact<'static>>,
    /// State variables of all elements, one after the other.
    state_variables: Vec<f64>,
    /// End of each element's range in `state_variables`; empty without state variables.
    variable_ends: Vec<usize>,
}

/// Bytes of a state variable: its value, its increment, and a copy of both.
const BYTES_PER_STATE_VARIABLE: f64 = 32.0;

/// End of each element's range in the list of all state variables.
///
/// The list is empty if no law has state variables.
pub(crate) fn state_variable_ends(
    laws: &[Box<dyn InterfaceLaw>],
    element_count: usize,
) -> Result<Vec<usize>> {
    if laws.iter().all(|law| law.state_variables() == 0) {
        return Ok(Vec::new());
    }
    let mut end = 0_usize;
    let mut ends = Vec::with_capacity(element_count);
    for element in 0..element_count {
        end = end.saturating_add(law_of(laws, element).state_variables());
        ends.push(end);
    }
    let variable_bytes = BYTES_PER_STATE_VARIABLE * end as f64;
    memory::check("state variables of the interface laws", end as f64, variable_bytes)?;
    Ok(ends)
}

impl PreviousContacts {
    /// Collects the previous contacts of all elements.
    ///
    /// If an element has no state variables, its law sets their initial values.
    pub(crate) fn new(
        laws: &[Box<dyn InterfaceLaw>],
        elements: &[PreviousContact<'_>],
    ) -> Result<Self> {
        let variable_ends = state_variable_ends(laws, elements.len())?;
        let contacts = elements.iter().map(PreviousContact::without_state_variables).collect();
        let state_variables = vec![0.0; variable_ends.last().copied().unwrap_or(0)];
        let mut starts = Self { contacts, state_variables, variable_ends };
        for (e, start) in elements.iter().enumerate() {
            let range = starts.state_variable_range(e);
            if start.state_variables.is_empty() && !range.is_empty() {
                let state_variables = starts.element(e).first_state_variables(law_of(laws, e));
                check_state_variables(e, start.mode, &state_variables)?;
                starts.state_variables[range].copy_from_slice(&state_variables);
            } else {
                let quantity = "state variables of an interface law";
                same_length(quantity, start.state_variables.len(), range.len())?;
                start
                    .state_variables
                    .iter()
                    .try_for_each(|value| finite(quantity, *value).map(|_| ()))?;
                starts.state_variables[range].copy_from_slice(start.state_variables);
            }
        }
        Ok(starts)
    }

    /// Number of elements.
    pub(crate) fn len(&self) -> usize {
        self.contacts.len()
    }

    /// The start of each element, as passed to its law.
    ///
    /// [`ContactProblem::start`](crate::contact::ContactProblem::start) accepts the collected items.
    pub fn iter(&self) -> impl Iterator<Item = PreviousContact<'_>> {
        (0..self.len()).map(|e| self.element(e))
    }

    /// Duration of the next step, s.
    pub(crate) fn time_step(&self) -> f64 {
        self.contacts.first().map_or(1.0, |start| start.time_step)
    }

    /// The start of an element; the element must exist.
    #[inline]
    pub(crate) fn element(&self, element: usize) -> PreviousContact<'_> {
        self.contacts[element].with_state_variables(self.state_variables_of(element))
    }

    /// Opening and traction of an element at the end of the previous step.
    pub(crate) fn state(&self, element: usize) -> &ContactState {
        &self.contacts[element].state
    }

    /// State variables of an element's law.
    pub(crate) fn state_variables_of(&self, element: usize) -> &[f64] {
        if self.variable_ends.is_empty() {
            &[]
        } else {
            &self.state_variables[self.state_variable_range(element)]
        }
    }

    fn state_variable_range(&self, element: usize) -> std::ops::Range<usize> {
        let begin_index = if element == 0 { 0 } else { self.variable_end(element - 1) };
        begin_index..self.variable_end(element)
    }

    fn variable_end(&self, element: usize) -> usize {
        self.variable_ends.get(element).copied().unwrap_or(0)
    }

    /// End of each element's range in the list of all state variables.
    ///
    /// The list is empty if no law has state variables.
    pub(crate) fn state_variable_ends(&self) -> &[usize] {
        &self.variable_ends
    }

    /// State variables of all elements.
    pub(crate) fn state_variables(&self) -> &[f64] {
        &self.state_variables
    }

    /// Mutable access to the state variables of all elements.
    pub(crate) fn state_variables_mut(&mut self) -> &mut [f64] {
        &mut self.state_variables
    }

    /// Mutable access to the slip velocities of the previous step.
    pub(crate) fn slip_rates_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        self.contacts.iter_mut().map(|contact| &mut contact.slip_rate)
    }

    /// Sets an element's opening and traction, its mode, and whether it has been open.
    pub(crate) fn restore(&mut self, e: usize, state: ContactState, mode: Mode, has_opened: bool) {
        self.contacts[e] = PreviousContact { state, mode, has_opened, ..self.contacts[e] };
    }

    /// Computes the state variables at the end of a step, and overwrites `state_variables`.
    ///
    /// The step ended in `states` and `modes`. `state_variables` has the length of
    /// [`PreviousContacts::state_variables`]; `self` does not change.
    pub(crate) fn update_state_variables(
        &self,
        laws: &[Box<dyn InterfaceLaw>],
        states: &[ContactState],
        modes: &[Mode],
        state_variables: &mut [f64],
    ) -> std::result::Result<(), LawError> {
        if state_variables.is_empty() {
            return Ok(());
        }
        state_variables.copy_from_slice(&self.state_variables);
        for (e, (state, &mode)) in states.iter().zip(modes).enumerate() {
            let element_variables = &mut state_variables[self.state_variable_range(e)];
            if !element_variables.is_empty() {
                law_of(laws, e).commit(&self.element(e), state, mode, element_variables);
                check_state_variables(e, mode, element_variables)?;
            }
        }
        Ok(())
    }

    /// Advances to the start of the next step.
    ///
    /// The present step ended in `states`, `modes` and `state_variables`.
    pub(crate) fn advance(
        &mut self,
        states: &[ContactState],
        modes: &[Mode],
        state_variables: &[f64],
    ) {
        for ((contact, state), mode) in self.contacts.iter_mut().zip(states).zip(modes) {
            let slip_x = state.slip - contact.state.slip;
            let slip_y = state.slip_across - contact.state.slip_across;
            let is_in_plan = slip_y != 0.0 || matches!(mode, Mode::Slip | Mode::YieldSlip);
            let slip_increment = if is_in_plan { slip_x.hypot(slip_y) } else { slip_x };
            contact.slip_rate = slip_increment / contact.time_step;
            contact.has_opened |= !mode.is_closed();
            contact.state = *state;
            contact.mode = *mode;
        }
        if !state_variables.is_empty() {
            self.state_variables.copy_from_slice(state_variables);
        }
    }
}

/// Returns an error if a state variable of an element is not finite.
fn check_state_variables(
    element: usize,
    mode: Mode,
    state_variables: &[f64],
) -> std::result::Result<(), LawError> {
    let quantity = "state variable";
    match state_variables.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(LawError::not_finite(element, mode.word(), quantity, value)),
        None => Ok(()),
    }
}
