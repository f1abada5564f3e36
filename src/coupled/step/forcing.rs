//! Actions on structure and base during a step, known before its solution.
//!
//! | symbol | meaning |
//! |---|---|
//! | `s_ff` | free field: motion of the soil without structure |
//! | y | its mean translation under each connected part of the structure |
//! | τ_ff | tractions of the free field on faces below the surface |
//! | h | soil displacement by all earlier tractions, less the effect of tractions of the free field |
//! | R | influence vectors |

use crate::bem::{Ground, free_field};
use crate::coupled::model::kinematics::Translation;
use crate::coupled::scene::Scene;
use crate::coupled::state::State;
use crate::error::StepError;
use crate::motion::FreeField;
use crate::structure::Structure;

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
    /// Soil displacement minus free field, before the contact tractions of this step act, 2Q or 3Q.
    pub(crate) history: Vec<f64>,
    /// Mean tractions τ_ff of the free field in this step, 2Q; empty on the surface.
    pub(crate) free_traction: Vec<f64>,
    /// Translation of the free field under each part.
    pub(crate) translations: Vec<Translation>,
    /// R Δy, in stepping coordinates.
    pub(crate) carried: Vec<f64>,
    /// R ẏ at v*, in stepping coordinates; zero without damping.
    pub(crate) dragged: Vec<f64>,
    dofs: Vec<f64>,
    /// Time integral of the free field's tractions; empty on the surface.
    impulse: Vec<f64>,
}

impl Forcing {
    pub(crate) fn new(scene: &Scene) -> Self {
        let contact_zeros = vec![0.0; scene.layout().len()];
        let structure_zeros = vec![0.0; scene.model.coordinates];
        let walls =
            if scene.base.elements().has_walls() { contact_zeros.clone() } else { Vec::new() };
        Self {
            load: structure_zeros.clone(),
            loaded: false,
            free_field: contact_zeros.clone(),
            distortion: contact_zeros.clone(),
            history: contact_zeros,
            free_traction: walls.clone(),
            impulse: walls,
            translations: vec![Translation::default(); scene.model.influence.parts().len()],
            carried: structure_zeros.clone(),
            dragged: structure_zeros,
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
        self.observe_free_field(scene, state, ground, motion, time);
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
        self.subtract_free_traction(scene)?;
        self.distortion.copy_from_slice(&self.free_field);
        let influence = &scene.model.influence;
        let last = &state.kinematics.translations;
        for ((part, now), last) in influence.parts().iter().zip(&mut self.translations).zip(last) {
            let displacement = part.mean(&scene.base, &self.free_field);
            *now = last.next(displacement, &scene.coefficients);
            part.subtract(&scene.base, displacement, &mut self.distortion);
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
        let has_structure_load = scene
            .model
            .load(structure, within, at_start, &mut self.dofs, &mut self.load)
            .map_err(StepError::part("load of the structure"))?;
        if has_structure_load {
            StepError::check_finite("load of the structure", &self.dofs)?;
        }
        self.loaded = has_structure_load || scene.has_loads();
        match scene.add_loads(within, &mut self.load) {
            None => Ok(()),
            Some((index, value)) => {
                Err(StepError::NotFinite { quantity: "external load", index, value })
            }
        }
    }
}

impl Forcing {
    /// Subtracts the effect of the free field's tractions in this step from the history.
    fn subtract_free_traction(&mut self, scene: &Scene) -> Result<(), StepError> {
        for (opposite, traction) in self.impulse.iter_mut().zip(&self.free_traction) {
            *opposite = -traction;
        }
        if !self.free_traction.is_empty() {
            StepError::check_finite("tractions of the free field", &self.free_traction)?;
            scene.soil.multiply_add(&self.impulse, &mut self.history);
        }
        Ok(())
    }

    /// Computes displacements of the free field at `time`, and its mean tractions since the last step.
    fn observe_free_field(
        &mut self,
        scene: &Scene,
        state: &State,
        ground: &dyn Ground,
        motion: &dyn FreeField,
        time: f64,
    ) {
        let elements = scene.base.elements();
        // The motion is known at the faces: the build has checked it.
        if elements.has_walls() {
            let values = [&mut self.free_field[..], &mut self.free_traction];
            free_field(ground, motion, elements, state.time, values);
        }
        free_field(ground, motion, elements, time, [&mut self.free_field, &mut self.impulse]);
        for (traction, impulse) in self.free_traction.iter_mut().zip(&self.impulse) {
            *traction = (*impulse - *traction) / scene.time_step;
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
