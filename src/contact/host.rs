//! The contact problem for codes with a time integrator of their own.

use super::problem::{ContactInput, ContactSolver};
use super::search::{ContactSearch, ModeSearch, SearchMethod};
use crate::error::{Error, Result, StepError, finite, positive, same_length};
use crate::interface::{ContactState, InterfaceLaw, Mode, StepStart};
use crate::linalg::largest;

/// The contact problem of one step after another, condensed to the tractions of Q elements.
///
/// Jumps (soil minus structure, 2Q numbers as in [`crate::bem`]: Q normal components down, then Q
/// tangential ones) at the end of a step answer to changes of traction τ against the static state by
///
/// ```text
/// jump = j_free + W τ,        W = G¹ + B K_eff⁻¹ Bᵀ A
/// ```
///
/// with W the Delassus operator: the ground's instantaneous operator
/// ([`Ground::instantaneous`](crate::bem::Ground::instantaneous)) and what unit tractions on the
/// structure move its base by, within the step of the host's scheme. `j_free` is the free field, plus
/// the convolution history of the ground, less the base displacement without changes of traction.
///
/// The example `host_integrator` marches a structure by central differences with it.
///
/// ```
/// use basemat::contact::ContactProblem;
/// use basemat::interface::{ContactState, Coulomb, Mode, StepStart};
///
/// // One element, pressed by 10 kPa, on a ground that yields by 1 mm per 10 kPa both ways.
/// let law = Coulomb::new(0.5)?;
/// let mut problem = ContactProblem::new(vec![1e-7, 0.0, 0.0, 1e-7], vec![Box::new(law)])?
///     .with_static_tractions(vec![10.0e3, 0.0])?;
/// let pressed = ContactState { pressure: 10.0e3, ..ContactState::default() };
/// let mut start = [StepStart::new(pressed, Mode::Stick, 0.01)];
/// // The structure moves to the right by 2 mm: it sticks up to 5 kPa, and slips the rest.
/// let solution = problem.solve(&[0.0, -2.0e-3], &start)?;
/// assert_eq!(solution.modes, [Mode::SlipRight]);
/// assert!((solution.states[0].shear - 5.0e3).abs() < 1e-6);
/// assert!((solution.states[0].slip - 1.5e-3).abs() < 1e-12);
/// solution.advance(&mut start);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct ContactProblem {
    delassus: Vec<f64>,
    laws: Vec<Box<dyn InterfaceLaw>>,
    static_traction: Vec<f64>,
    solver: ContactSolver,
    search: ModeSearch,
    modes: Vec<Mode>,
    steps: usize,
}

short_debug! {
    ContactProblem; self; elements: self.modes.len(), laws: self.laws.len(), steps: self.steps
}

/// Solution of the contact problem of a step.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct ContactSolution<'a> {
    /// Change of traction against the static state, 2Q, Pa: what the ground is to be given.
    pub traction: &'a [f64],
    /// Opening and total traction of each element.
    pub states: &'a [ContactState],
    /// Mode of each element.
    pub modes: &'a [Mode],
    /// Linear solves of the mode search.
    pub trials: usize,
    /// How the modes were found.
    pub method: SearchMethod,
}

impl ContactSolution<'_> {
    /// Moves what the laws see to the start of the next step.
    pub fn advance(&self, start: &mut [StepStart]) {
        for ((start, state), mode) in start.iter_mut().zip(self.states).zip(self.modes) {
            start.advance(*state, *mode);
        }
    }
}

impl ContactProblem {
    /// The problem with this Delassus operator (2Q × 2Q, row-major, m/Pa), and one law for all
    /// elements or one each; unpressed at first. The laws' own
    /// [`check`](InterfaceLaw::check) is not called.
    ///
    /// # Errors
    /// [`Error::Size`] unless the operator is that of one element or more and the laws fit,
    /// [`Error::Scene`] for a law without modes, [`Error::Input`] for entries that are not finite.
    pub fn new(delassus: Vec<f64>, laws: Vec<Box<dyn InterfaceLaw>>) -> Result<Self> {
        let size = delassus.len().isqrt();
        let count = size / 2;
        if count == 0 || 4 * count * count != delassus.len() {
            let (quantity, needed) = ("Delassus operator", 4 * count.max(1).pow(2));
            return Err(Error::Size { quantity, found: delassus.len(), needed });
        }
        if laws.len() != 1 && laws.len() != count {
            let quantity = "list of interface laws";
            return Err(Error::Size { quantity, found: laws.len(), needed: count });
        }
        if laws.iter().any(|law| law.modes().is_empty()) {
            let needed = "`modes` must name at least one mode";
            return Err(Error::Scene { quantity: "interface law", needed });
        }
        check_finite("Delassus operator", &delassus)?;
        Ok(Self {
            delassus,
            laws,
            static_traction: vec![0.0; 2 * count],
            solver: ContactSolver::new(count),
            search: ModeSearch::new(count, ContactSearch::default()),
            modes: vec![Mode::Stick; count],
            steps: 0,
        })
    }

    /// With tractions (2Q, Pa) in the static state, against which changes count.
    ///
    /// # Errors
    /// [`Error::Size`] for a list of another length, [`Error::Input`] for values not finite.
    pub fn with_static_tractions(mut self, traction: Vec<f64>) -> Result<Self> {
        same_length("static tractions", traction.len(), self.static_traction.len())?;
        check_finite("static traction", &traction)?;
        self.static_traction = traction;
        Ok(self)
    }

    /// Another Delassus operator from now on, for a structure whose tangent has changed.
    ///
    /// # Errors
    /// As [`ContactProblem::new`]; the operator is then the one before.
    pub fn set_delassus(&mut self, delassus: &[f64]) -> Result<()> {
        same_length("Delassus operator", delassus.len(), self.delassus.len())?;
        check_finite("Delassus operator", delassus)?;
        self.delassus.copy_from_slice(delassus);
        self.solver.invalidate();
        Ok(())
    }

    /// Solves the step whose jump without changes of traction is `free_jump` (2Q, m), for laws that
    /// see `start` (one each element). Allocates nothing.
    ///
    /// # Errors
    /// [`Error::Size`] and [`Error::Input`] for slices that do not fit or are not finite;
    /// [`Error::Step`] if no modes satisfy the laws, numbered by the problems solved so far and with
    /// the time of as many steps.
    pub fn solve(&mut self, free_jump: &[f64], start: &[StepStart]) -> Result<ContactSolution<'_>> {
        same_length("free jump", free_jump.len(), 2 * self.modes.len())?;
        same_length("starts of the step", start.len(), self.modes.len())?;
        check_finite("free jump", free_jump)?;
        for start in start {
            positive("time step", start.time_step)?;
            let ContactState { gap, slip, pressure, shear } = start.state;
            check_finite("state of an element", &[gap, slip, pressure, shear, start.slip_rate])?;
        }
        for (mode, start) in self.modes.iter_mut().zip(start) {
            *mode = start.mode;
        }
        let input = ContactInput {
            delassus: &self.delassus,
            free_jump,
            static_traction: &self.static_traction,
            start,
            laws: &self.laws,
            length_scale: largest(free_jump),
        };
        let step = self.steps + 1;
        let time = step as f64 * start[0].time_step;
        let failed = |source: StepError| Error::Step { step, time, source };
        let found = self.search.solve(&mut self.solver, &input, &mut self.modes);
        let (trials, method) = found.map_err(failed)?;
        self.steps = step;
        Ok(ContactSolution {
            traction: &self.solver.traction,
            states: &self.solver.states,
            modes: &self.modes,
            trials,
            method,
        })
    }
}

fn check_finite(quantity: &'static str, values: &[f64]) -> Result<()> {
    values.iter().try_for_each(|value| finite(quantity, *value).map(|_| ()))
}
