//! Solving a step: the increment of the structure's degrees of freedom and the contact tractions.

use super::forcing::Forcing;
use super::increment::Increment;
use super::linear::LinearStep;
use super::newton::{Newton, StepData};
use crate::contact::{ContactSolver, ModeSearch};
use crate::coupled::scene::Scene;
use crate::coupled::scene::operators::Operators;
use crate::coupled::state::State;
use crate::error::StepError;
use crate::linalg::{largest, magnitude};
use crate::structure::Structure;

/// Change of a degree of freedom in a step beyond which a run counts as lost, whatever the units.
const RUNAWAY: f64 = 1e15;

/// The linear step, and Newton's method around it for a nonlinear structure.
pub(crate) struct Solver {
    linear: LinearStep,
    newton: Option<Newton>,
}

impl Solver {
    pub(crate) fn new(scene: &Scene, operators: Operators, search: ModeSearch) -> Self {
        Self {
            linear: LinearStep::new(scene, operators, search),
            newton: (!scene.model.linear).then(|| Newton::new(scene.model.coordinates)),
        }
    }

    /// The operators of the last solve.
    pub(crate) fn operators(&self) -> &Operators {
        &self.linear.operators
    }

    /// Operators and contact problem, for the assessment of their condition.
    pub(crate) fn parts_mut(&mut self) -> (&mut Operators, &mut ContactSolver) {
        (&mut self.linear.operators, &mut self.linear.contact)
    }

    /// Finds the increment of the step after `state`.
    pub(crate) fn solve(
        &mut self,
        scene: &Scene,
        structure: &dyn Structure,
        state: &State,
        forcing: &Forcing,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let Self { linear, newton } = self;
        if let Some(newton) = newton {
            linear.predict(scene, state, forcing);
            let data = StepData { scene, structure, state, forcing };
            newton.solve(linear, data, increment)?;
            increment.follow(scene, state, forcing);
        } else {
            linear.solve(scene, state, forcing, increment)?;
        }
        check(&increment.displacement)
    }
}

/// Refuses an increment that is not finite or too large.
fn check(increment: &[f64]) -> Result<(), StepError> {
    // A sum of magnitudes is not finite if one of them is not.
    if magnitude(increment) <= RUNAWAY {
        return Ok(());
    }
    StepError::check_finite("displacement of the structure", increment)?;
    let change = largest(increment);
    if change > RUNAWAY { Err(StepError::Runaway { increment: change }) } else { Ok(()) }
}
