//! Solving a step: the increment of the structure's unknowns and the contact tractions.

use super::forcing::Forcing;
use super::increment::Increment;
use super::linear::LinearStep;
use super::newton::{Newton, StepData};
use crate::contact::{ContactSolver, ModeSearch};
use crate::coupled::motion::Motion;
use crate::coupled::scene::Scene;
use crate::coupled::scene::operators::Operators;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::state::State;
use crate::error::StepError;
use crate::linalg::largest;
use crate::structure::Structure;

/// Change of an unknown in a step, in any units that somebody may use, beyond which no structure is
/// left.
const RUNAWAY: f64 = 1e15;

/// The linear step, and Newton's method around it for a nonlinear structure.
pub(crate) struct Solver {
    linear: LinearStep,
    newton: Option<Newton>,
    /// Δu with the share R Δy of the free field's translation.
    total: Vec<f64>,
}

impl Solver {
    pub(crate) fn new(scene: &Scene, operators: Operators, search: ModeSearch) -> Self {
        Self {
            linear: LinearStep::new(scene, operators, search),
            total: vec![0.0; scene.model.coordinates],
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
        let Self { linear, newton, total } = self;
        linear.predict(scene, state, forcing);
        if let Some(newton) = newton {
            let data = StepData { scene, structure, state, forcing };
            newton.solve(linear, data, increment)?;
        } else {
            increment.displacement.copy_from_slice(&linear.known);
            linear.solve_contact(scene, state, forcing, increment)?;
        }
        if increment.displacement.iter().any(|x| !x.is_finite()) {
            let quantity = "displacement of the structure";
            return Err(StepError::NotFinite { quantity });
        }
        let change = largest(&increment.displacement);
        if change > RUNAWAY {
            return Err(StepError::Runaway { increment: change });
        }
        let c = &scene.coefficients;
        let Motion { velocity, acceleration, .. } = &state.motion;
        let Increment { displacement, velocity: new_velocity, acceleration: new, .. } = increment;
        total.copy_from_slice(displacement);
        total.iter_mut().zip(&forcing.carried).for_each(|(du, carried)| *du += carried);
        SchemeCoefficients::combine(c.new_velocity, total, velocity, acceleration, new_velocity);
        SchemeCoefficients::combine(c.new_acceleration, total, velocity, acceleration, new);
        Ok(())
    }
}
