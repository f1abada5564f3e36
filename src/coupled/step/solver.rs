//! Solution of a step: displacement increment and contact tractions.

use super::newton::NewtonIteration;
use crate::contact::{ContactSearch, ContactSolver};
use crate::coupled::model::operators::Operators;
use crate::coupled::scene::Scene;
use crate::coupled::step::forcing::StepData;
use crate::coupled::step::increment::Increment;
use crate::coupled::step::linear::LinearStep;
use crate::error::StepError;
use crate::linalg::{SparseMatrix, largest, magnitude_sum};

/// Largest change of a degree of freedom in a step, in any units; beyond it a run has diverged.
const MAX_STEP_CHANGE: f64 = 1e15;

/// Solver of a step: a linear step, with Newton's method around it for a nonlinear structure.
pub(crate) struct StepSolver {
    linear: LinearStep,
    newton: Option<NewtonIteration>,
}

impl StepSolver {
    /// Solver for the steps of `scene`.
    pub(crate) fn new(scene: &Scene, operators: Operators, search: ContactSearch) -> Self {
        Self {
            linear: LinearStep::new(scene, operators, search),
            newton: (!scene.model.is_linear)
                .then(|| NewtonIteration::new(scene.model.coordinate_count)),
        }
    }

    /// The operators of the last solution.
    pub(crate) fn operators(&self) -> &Operators {
        &self.linear.operators
    }

    /// Operators and contact solver, for estimates of condition numbers.
    pub(crate) fn operators_and_contact_mut(&mut self) -> (&mut Operators, &mut ContactSolver) {
        (&mut self.linear.operators, &mut self.linear.contact)
    }

    /// Values of the tangent with which the next step begins, for a checkpoint; empty for none.
    pub(crate) fn first_tangent(&self, step: usize) -> &[f64] {
        let last_tangent = &self.linear.operators.tangent;
        self.newton.as_ref().map_or(&[], |newton| newton.first_tangent(step, last_tangent))
    }

    /// Sets the tangent with which the next step begins; an empty matrix for none.
    pub(crate) fn set_first_tangent(&mut self, step: usize, tangent: SparseMatrix) {
        if let Some(newton) = &mut self.newton {
            newton.set_first_tangent(step, tangent);
        }
    }

    /// Computes the increment of the step.
    pub(crate) fn solve(
        &mut self,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let Self { linear, newton } = self;
        if let Some(newton) = newton {
            linear.predict(data);
            newton.solve(linear, data, increment)?;
            increment.set_end_motion(data);
        } else {
            linear.solve(data, increment)?;
        }
        check_increment(&increment.displacement)
    }
}

/// Returns an error for an increment that is not finite or too large.
fn check_increment(increment: &[f64]) -> Result<(), StepError> {
    // A sum of magnitudes is not finite if one of them is not.
    if magnitude_sum(increment) <= MAX_STEP_CHANGE {
        return Ok(());
    }
    StepError::check_finite("displacement of the structure", increment)?;
    let max_change = largest(increment);
    if max_change > MAX_STEP_CHANGE {
        Err(StepError::Runaway { increment: max_change })
    } else {
        Ok(())
    }
}
