//! Contact problem of successive steps, for codes with another time integrator.

use super::search::ModeSearch;
use super::{ContactInput, ContactSearch, Delassus, SearchMethod};
use crate::error::{Error, Result, finite, positive, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::interface::{
    ContactState, InterfaceLaw, Mode, PreviousContact, PreviousContacts, check_list,
    state_variable_ends,
};
use crate::linalg::largest;

/// The contact problem of successive steps, condensed to the tractions of Q elements.
///
/// The jump is the displacement of the soil minus that of the structure at the end of a step: 2Q numbers as in
/// [`crate::bem`], Q normal components (down), then Q tangential components. Due to changes of traction τ from the
/// static state it is
///
/// ```text
/// jump = j_free + W τ,        W = G¹ + B K_eff⁻¹ Bᵀ A
/// ```
///
/// with W the Delassus operator, the sum of the ground's step compliance
/// ([`Ground::step_compliance`](crate::bem::Ground::step_compliance)) and the displacement of the structure's
/// base due to unit tractions, within a step of the host's scheme: A τ are the forces of the tractions on the
/// elements, Bᵀ distributes them to the structure's degrees of freedom, K_eff is the effective stiffness of the
/// scheme, and B returns the displacements of the base. `j_free` is the free field, plus the
/// convolution history of the ground, minus the base displacement without changes of traction.
///
/// The example `host_integrator` uses it with a structure integrated by central differences.
///
/// ```
/// use basemat::contact::ContactProblem;
/// use basemat::interface::{ContactState, Coulomb, Mode, PreviousContact};
///
/// // One element under 10 kPa, on a ground that moves by 1 mm per 10 kPa in both directions.
/// let law = Coulomb::new(0.5)?;
/// let mut problem = ContactProblem::new(vec![1e-7, 0.0, 0.0, 1e-7], vec![Box::new(law)])?
///     .with_static_tractions(vec![10.0e3, 0.0])?;
/// let static_state = ContactState { pressure: 10.0e3, ..ContactState::default() };
/// let mut start = problem.start(&[PreviousContact::new(static_state, Mode::Stick, 0.01)])?;
/// // The structure moves to the right by 2 mm: it sticks up to a shear of 5 kPa, then slips by 1.5 mm.
/// let solution = problem.solve(&[0.0, -2.0e-3], &start)?;
/// assert_eq!(solution.modes, [Mode::SlipRight]);
/// assert!((solution.states[0].shear - 5.0e3).abs() < 1e-6);
/// assert!((solution.states[0].slip - 1.5e-3).abs() < 1e-12);
/// solution.commit(&mut start)?;
/// assert_eq!(start.iter().next().map(|element| element.mode), Some(Mode::SlipRight));
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct ContactProblem {
    delassus: Delassus,
    laws: Vec<Box<dyn InterfaceLaw>>,
    static_traction: Vec<f64>,
    search: ModeSearch,
    modes: Vec<Mode>,
    /// End of each element's state variables in `state_variables`; empty if no law has any.
    state_variable_ends: Vec<usize>,
    /// State variables at the end of a step that has not been committed.
    state_variables: Vec<f64>,
    step_count: usize,
}

short_debug! {
    ContactProblem; self; elements: self.modes.len(), laws: self.laws.len(), steps: self.step_count
}

/// Solution of the contact problem of a step.
#[non_exhaustive]
pub struct ContactSolution<'a> {
    /// Change of traction from the static state, 2Q, Pa: the input of the ground.
    pub traction: &'a [f64],
    /// Gap, slip and total traction of each element.
    pub states: &'a [ContactState],
    /// Mode of each element.
    pub modes: &'a [Mode],
    /// Number of trials of the mode search: linear solutions, and sweeps over the elements.
    pub trials: usize,
    /// Method that found the modes.
    pub method: SearchMethod,
    laws: &'a [Box<dyn InterfaceLaw>],
    state_variable_ends: &'a [usize],
    state_variables: &'a mut [f64],
    step: usize,
    time: f64,
}

short_debug! {
    ContactSolution<'_>;
    self;
    traction: self.traction,
    states: self.states,
    modes: self.modes,
    trials: self.trials,
    method: self.method,
}

impl ContactSolution<'_> {
    /// Accepts the step: `start`, from which it was solved, becomes the start of the next step.
    ///
    /// The laws update their state variables. Do not commit a step that is to be solved again.
    ///
    /// # Errors
    /// [`Error::Size`] or [`Error::Scene`] if `start` belongs to another problem, [`Error::Step`] if a state
    /// variable of a law is not finite. `start` is then unchanged.
    pub fn commit(self, start: &mut PreviousContacts) -> Result<()> {
        check_start(start, self.states.len(), self.state_variable_ends)?;
        let Self { laws, states, modes, state_variables, step, time, .. } = self;
        start
            .update_state_variables(laws, states, modes, state_variables)
            .map_err(|error| Error::Step { step, time, source: error.into() })?;
        start.advance(states, modes, state_variables);
        Ok(())
    }
}

impl ContactProblem {
    /// Makes a contact problem from a Delassus operator and laws.
    ///
    /// The operator is 2Q × 2Q, row-major, m/Pa. There is one law for all elements or one for each. The static tractions
    /// are zero at first. This function does not call the method [`check`](InterfaceLaw::check) of the laws.
    ///
    /// # Errors
    /// [`Error::Size`] unless the operator belongs to at least one element and the number of laws fits,
    /// [`Error::Scene`] for a law without modes, [`Error::Input`] for entries that are not finite or laws
    /// with more than ten million state variables.
    pub fn new(delassus: Vec<f64>, laws: Vec<Box<dyn InterfaceLaw>>) -> Result<Self> {
        let count = delassus.len().isqrt() / COMPONENTS_IN_PLANE;
        let layout = ContactLayout::new(COMPONENTS_IN_PLANE, count);
        if count == 0 || layout.matrix_len() != delassus.len() {
            let quantity = "Delassus operator";
            let needed = ContactLayout::new(COMPONENTS_IN_PLANE, count.max(1)).matrix_len();
            return Err(Error::Size { quantity, found: delassus.len(), needed });
        }
        check_list(&laws, count)?;
        check_finite("Delassus operator", &delassus)?;
        let state_variable_ends = state_variable_ends(&laws, count)?;
        Ok(Self {
            state_variables: vec![0.0; state_variable_ends.last().copied().unwrap_or(0)],
            state_variable_ends,
            delassus: delassus.into(),
            laws,
            static_traction: vec![0.0; layout.len()],
            search: ModeSearch::new(count, ContactSearch::default()),
            modes: vec![Mode::Stick; count],
            step_count: 0,
        })
    }

    /// Sets the tractions of the static state (2Q, Pa), from which changes of traction are measured.
    ///
    /// # Errors
    /// [`Error::Size`] for a list of another length, [`Error::Input`] for values that are not finite.
    pub fn with_static_tractions(mut self, traction: Vec<f64>) -> Result<Self> {
        same_length("static tractions", traction.len(), self.static_traction.len())?;
        check_finite("static traction", &traction)?;
        self.static_traction = traction;
        Ok(self)
    }

    /// Replaces the Delassus operator, for a structure whose tangent has changed.
    ///
    /// # Errors
    /// As [`ContactProblem::new`]; the previous operator is then kept.
    pub fn set_delassus(&mut self, delassus: &[f64]) -> Result<()> {
        same_length("Delassus operator", delassus.len(), self.delassus.len())?;
        check_finite("Delassus operator", delassus)?;
        self.delassus.set(delassus);
        self.search.solver.invalidate();
        Ok(())
    }

    /// The start of the first step, from the start of each element ([`PreviousContact::new`]).
    ///
    /// If the `state_variables` of an element are empty, its law sets their initial values.
    ///
    /// # Errors
    /// [`Error::Size`] for a list or state variables of another length, [`Error::Input`] for time steps that
    /// are not above zero or not all the same, and for numbers that are not finite; [`Error::Law`] if a law
    /// returned these numbers.
    pub fn start(&self, elements: &[PreviousContact<'_>]) -> Result<PreviousContacts> {
        same_length("starts of the step", elements.len(), self.modes.len())?;
        for element_start in elements {
            let value = positive("time step", element_start.time_step)?;
            if value != elements[0].time_step {
                let needed = "the same for all elements";
                return Err(Error::Input { quantity: "time step", value, needed });
            }
            finite("static pressure", element_start.static_pressure)?;
            check_element(element_start)?;
        }
        PreviousContacts::new(&self.laws, elements)
    }

    /// Solves the step with the jump `free_jump` without changes of traction (2Q, m).
    ///
    /// The laws read `start`. Nothing is allocated. [`ContactSolution::commit`] advances the start; until then
    /// the same step can be solved again.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::Scene`] and [`Error::Input`] for a jump or a start that does not fit or is
    /// not finite; [`Error::Step`] if no modes satisfy the laws, or if a law returns a number that is not
    /// finite. Its step number is one more than the number of problems solved before, and its time is the time of as
    /// many steps.
    pub fn solve(
        &mut self,
        free_jump: &[f64],
        start: &PreviousContacts,
    ) -> Result<ContactSolution<'_>> {
        same_length("free jump", free_jump.len(), self.static_traction.len())?;
        check_start(start, self.modes.len(), &self.state_variable_ends)?;
        check_finite("free jump", free_jump)?;
        for (mode, element_start) in self.modes.iter_mut().zip(start.iter()) {
            check_element(&element_start)?;
            *mode = element_start.mode;
        }
        let input = ContactInput {
            delassus: &self.delassus,
            free_jump,
            static_traction: &self.static_traction,
            start,
            laws: &self.laws,
            length_scale: largest(free_jump),
            bonds: &[],
            trial_lines: &[],
            frictionless: false,
        };
        let step = self.step_count + 1;
        let time = step as f64 * start.time_step();
        let (trials, method) = self
            .search
            .solve(&input, &mut self.modes)
            .map_err(|source| Error::Step { step, time, source })?;
        self.step_count = step;
        let response = &self.search.solver.response;
        Ok(ContactSolution {
            traction: &response.traction,
            states: &response.states,
            modes: &self.modes,
            trials,
            method,
            laws: &self.laws,
            state_variable_ends: &self.state_variable_ends,
            state_variables: &mut self.state_variables,
            step,
            time,
        })
    }
}

/// Returns an error unless the start has these elements and state variables.
fn check_start(
    start: &PreviousContacts,
    element_count: usize,
    state_variable_ends: &[usize],
) -> Result<()> {
    same_length("starts of the step", start.len(), element_count)?;
    if start.state_variable_ends() == state_variable_ends {
        return Ok(());
    }
    let needed = "that of a problem with the same laws: these laws have other state variables";
    Err(Error::Scene { quantity: "start of the step", needed })
}

/// Returns an error unless the numbers of an element's start are finite.
fn check_element(start: &PreviousContact<'_>) -> Result<()> {
    check_finite("state of an element", &start.state.jump())?;
    check_finite("state of an element", &start.state.traction())?;
    check_finite("state of an element", &[start.slip_rate])
}

/// Returns an error unless all values of this quantity are finite.
fn check_finite(quantity: &'static str, values: &[f64]) -> Result<()> {
    values.iter().try_for_each(|value| finite(quantity, *value).map(|_| ()))
}
