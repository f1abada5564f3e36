//! Forcing of one step, and the increment in response to it.

pub(crate) mod advance;
pub(crate) mod energy_accumulator;
mod linear;
mod modal_loops;
pub(crate) mod newton;

use crate::bem::Ground;
use crate::contact::SearchMethod;
use crate::coupled::model::kinematics::{Kinematics, Translation};
use crate::coupled::scene::Scene;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::state::State;
use crate::error::{LawError, StepError};
use crate::interface::{ContactState, Mode};
use crate::motion::FreeField;
use crate::structure::Structure;

// Actions on structure and base during a step, known before it is solved.
//
// | symbol | meaning |
// |---|---|
// | `s_ff` | free field: motion of the soil without structure |
// | y | its mean translation under each connected part of the structure |
// | h | soil displacement by all earlier tractions |
// | R | influence vectors |

/// External load, free field and convolution history of one step.
pub(crate) struct Forcing {
    /// External load at t*, minus the static load, in stepping coordinates.
    pub(crate) load: Vec<f64>,
    /// Whether there is any load.
    pub(crate) loaded: bool,
    /// Free field at the end of the step, minus its value at t = 0, 2Q or 3Q.
    pub(crate) free_field: Vec<f64>,
    /// Free field minus the translation y of the part above, 2Q or 3Q.
    pub(crate) distortion: Vec<f64>,
    /// Convolution history of the soil at the end of the step, 2Q or 3Q.
    pub(crate) history: Vec<f64>,
    /// Translation of the free field under each part.
    pub(crate) translations: Vec<Translation>,
    /// R Δy, in stepping coordinates.
    pub(crate) carried: Vec<f64>,
    /// R ẏ at v*, in stepping coordinates; zero without damping.
    pub(crate) dragged: Vec<f64>,
    dofs: Vec<f64>,
}

impl Forcing {
    pub(crate) fn new(scene: &Scene) -> Self {
        let contact = || vec![0.0; scene.layout().len()];
        let structure = || vec![0.0; scene.model.coordinates];
        Self {
            load: structure(),
            loaded: false,
            free_field: contact(),
            distortion: contact(),
            history: contact(),
            translations: vec![Translation::default(); scene.model.influence.parts().len()],
            carried: structure(),
            dragged: structure(),
            dofs: vec![0.0; scene.model.dofs],
        }
    }

    /// Computes free field and history at `time`, the end of the step after `state`, and the load within it.
    pub(crate) fn observe(
        &mut self,
        scene: &Scene,
        state: &State,
        structure: &dyn Structure,
        ground: &mut dyn Ground,
        motion: &dyn FreeField,
        time: f64,
    ) -> Result<(), StepError> {
        ground.free_field(motion, time, &mut self.free_field);
        for (value, start) in self.free_field.iter_mut().zip(&scene.start_motion) {
            *value -= start;
        }
        // An error of the ground ends the step.
        ground.history(&mut self.history).map_err(StepError::part("history of the ground"))?;
        for (values, quantity) in
            [(&self.free_field, "free field"), (&self.history, "history of the ground")]
        {
            StepError::check_finite(quantity, values)?;
        }
        self.distortion.copy_from_slice(&self.free_field);
        let influence = &scene.model.influence;
        let last = &state.kinematics.translations;
        for ((part, now), last) in influence.parts().iter().zip(&mut self.translations).zip(last) {
            let displacement = part.mean(&scene.base, &self.free_field);
            *now = last.next(displacement, &scene.coefficients);
            part.subtract(scene.layout(), displacement, &mut self.distortion);
        }
        self.carried.fill(0.0);
        let increments = self.translations.iter().map(|translation| translation.increment);
        influence.translate(1.0, increments, &mut self.carried);
        if scene.model.damped {
            self.dragged.fill(0.0);
            let velocities = self.translations.iter().map(|translation| translation.velocity);
            influence.translate(1.0, velocities, &mut self.dragged);
        }
        if self.loaded {
            self.load.fill(0.0);
        }
        let within = state.time + scene.coefficients.load_fraction * scene.time_step;
        let at_start = &scene.static_state.load;
        let own = scene
            .model
            .load(structure, within, at_start, &mut self.dofs, &mut self.load)
            .map_err(StepError::part("load of the structure"))?;
        if own {
            StepError::check_finite("load of the structure", &self.dofs)?;
        }
        self.loaded = own || scene.has_loads();
        match scene.add_loads(within, &mut self.load) {
            None => Ok(()),
            Some((index, value)) => {
                Err(StepError::NotFinite { quantity: "external load", index, value })
            }
        }
    }
}

/// Data from which a step after `state` is solved.
#[derive(Clone, Copy)]
pub(crate) struct StepData<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) structure: &'a dyn Structure,
    pub(crate) state: &'a State,
    pub(crate) forcing: &'a Forcing,
}

// Changes of one step.

/// Response to a [`Forcing`], not yet committed.
pub(crate) struct Increment {
    /// Δu relative to the free field's translation, in stepping coordinates.
    pub(crate) displacement: Vec<f64>,
    /// Displacement at the end of the step, relative to the free field's translation.
    pub(crate) end: Vec<f64>,
    /// Total Δu, including R Δy.
    pub(crate) total: Vec<f64>,
    /// Total velocity and acceleration at the end of the step.
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    /// Change of traction against the static state, 2Q or 3Q.
    pub(crate) traction: Vec<f64>,
    /// Change of traction spread over whole elements, for the ground.
    pub(crate) spread: Vec<f64>,
    /// Openings and total tractions at the end, per element.
    pub(crate) contact: Vec<ContactState>,
    /// Mode of each element.
    pub(crate) modes: Vec<Mode>,
    /// Compliance of each element at the end; empty if all laws are hard or there is no energy balance.
    pub(crate) compliance: Vec<[f64; 2]>,
    /// State variables of the laws at the end.
    pub(crate) state_variables: Vec<f64>,
    /// Number of linear solutions of the mode search, and the last method used.
    pub(crate) trials: usize,
    pub(crate) method: SearchMethod,
    /// Friction used instead of a larger one on a sliding element; `None` if there was none.
    pub(crate) stand_in: Option<f64>,
    /// f(u*) minus f at the static state, and the displacement at the end of the step that f receives.
    ///
    /// Empty for a linear structure.
    pub(crate) force: Vec<f64>,
    pub(crate) seen: Vec<f64>,
}

impl Increment {
    /// Memory for a step, and for compliances if `compliant`.
    pub(crate) fn new(scene: &Scene, state: &State, compliant: bool) -> Self {
        let (n, count) = (scene.model.coordinates, scene.count());
        let compliant = if compliant { count } else { 0 };
        let nonlinear = if scene.model.linear { 0 } else { n };
        Self {
            displacement: vec![0.0; n],
            end: vec![0.0; n],
            total: vec![0.0; n],
            velocity: vec![0.0; n],
            acceleration: vec![0.0; n],
            traction: vec![0.0; scene.layout().len()],
            spread: vec![0.0; scene.layout().len()],
            contact: vec![ContactState::default(); count],
            modes: vec![Mode::Stick; count],
            compliance: vec![[0.0; 2]; compliant],
            state_variables: state.start.state_variables().to_vec(),
            trials: 0,
            method: SearchMethod::ActiveSet,
            stand_in: None,
            force: vec![0.0; nonlinear],
            seen: vec![0.0; nonlinear],
        }
    }

    /// Computes the displacement at the end of the step from Δu.
    pub(crate) fn reach(&mut self, state: &State) {
        let increments = state.kinematics.displacement.iter().zip(&self.displacement);
        self.end.iter_mut().zip(increments).for_each(|(end, (u, du))| *end = u + du);
    }

    /// Computes displacement, velocity and acceleration at the end, and the total Δu.
    pub(crate) fn follow(&mut self, StepData { scene, state, forcing, .. }: StepData<'_>) {
        self.reach(state);
        let increments = self.displacement.iter().zip(&forcing.carried);
        self.total.iter_mut().zip(increments).for_each(|(total, (du, y))| *total = du + y);
        let Kinematics { velocity, acceleration, .. } = &state.kinematics;
        let (c, total) = (&scene.coefficients, &self.total);
        let [new_velocity, new_acceleration] = [&mut self.velocity, &mut self.acceleration];
        SchemeCoefficients::combine(c.new_velocity, total, velocity, acceleration, new_velocity);
        let coefficients = c.new_acceleration;
        SchemeCoefficients::combine(coefficients, total, velocity, acceleration, new_acceleration);
    }

    /// Evaluates the laws' compliances at the end of the step after `state`, and their state variables.
    pub(crate) fn ask_laws(&mut self, scene: &Scene, state: &State) -> Result<(), LawError> {
        for (e, compliance) in self.compliance.iter_mut().enumerate() {
            *compliance = scene.compliance(e, self.modes[e], &state.start)?;
        }
        state.start.update_state_variables(
            &scene.laws,
            &self.contact,
            &self.modes,
            &mut self.state_variables,
        )
    }
}
