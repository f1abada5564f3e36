//! Forcing of a step: loads, free field and history, which do not depend on its solution.
//!
//! | symbol | meaning |
//! |---|---|
//! | `s_ff` | free field: motion of the soil without structure |
//! | y | its mean translation under each connected part of the structure |
//! | τ_ff | tractions of the free field on faces below the surface |
//! | h | soil displacement due to all earlier tractions, without the effect of τ_ff |
//! | R | influence vectors |

use crate::bem::{Ground, fill_free_field};
use crate::coupled::model::kinematics::Translation;
use crate::coupled::scene::Scene;
use crate::coupled::state::State;
use crate::error::StepError;
use crate::motion::FreeField;
use crate::structure::Structure;

/// External load, free field and convolution history of one step.
pub(crate) struct Forcing {
    /// External load at t* minus the static load, in stepping coordinates.
    pub(crate) load: Vec<f64>,
    /// Whether the load may have an entry.
    pub(crate) has_load: bool,
    /// Displacement of the free field at the end of the step, m, 2Q or 3Q.
    ///
    /// It is relative to the value at t = 0.
    pub(crate) free_field: Vec<f64>,
    /// Free field minus its translation y under each part, m, 2Q or 3Q.
    pub(crate) distortion: Vec<f64>,
    /// Soil displacement minus free field without the contact tractions of this step, m, 2Q or 3Q.
    pub(crate) history: Vec<f64>,
    /// Mean tractions τ_ff of the free field in this step, Pa, 2Q.
    ///
    /// Empty on the surface.
    pub(crate) free_traction: Vec<f64>,
    /// Translation of the free field under each part.
    pub(crate) translations: Vec<Translation>,
    /// Increment R Δy of the translation, in stepping coordinates.
    pub(crate) translation_increment: Vec<f64>,
    /// Velocity R ẏ of the translation at the time of v*; zero without damping.
    ///
    /// In stepping coordinates.
    pub(crate) translation_velocity: Vec<f64>,
    /// Load of the structure in degrees of freedom.
    dof_load: Vec<f64>,
    /// Time integral of the free field's tractions, Pa s; empty on the surface.
    impulse: Vec<f64>,
    /// Displacements of the ground's elements, m; empty without joints.
    ground_displacement: Vec<f64>,
    /// Time integral of the free field's tractions on the ground's elements, Pa s.
    ///
    /// Empty without joints.
    ground_impulse: Vec<f64>,
}

impl Forcing {
    /// Buffers for the forcing of a scene's steps.
    pub(crate) fn new(scene: &Scene) -> Self {
        let contact_zeros = vec![0.0; scene.layout().len()];
        let structure_zeros = vec![0.0; scene.model.coordinate_count];
        let wall_zeros =
            if scene.base.elements().has_walls() { contact_zeros.clone() } else { Vec::new() };
        let has_joints = !scene.base.joints().is_empty();
        let ground_count = if has_joints { scene.base.elements().layout().len() } else { 0 };
        Self {
            load: structure_zeros.clone(),
            has_load: false,
            free_field: contact_zeros.clone(),
            distortion: contact_zeros.clone(),
            history: contact_zeros,
            free_traction: wall_zeros.clone(),
            ground_impulse: if wall_zeros.is_empty() { vec![] } else { vec![0.0; ground_count] },
            impulse: wall_zeros,
            ground_displacement: vec![0.0; ground_count],
            translations: vec![Translation::default(); scene.model.influence.parts().len()],
            translation_increment: structure_zeros.clone(),
            translation_velocity: structure_zeros,
            dof_load: vec![0.0; scene.model.dofs],
        }
    }

    /// Computes the forcing of the step after `state`, which ends at `time` (s).
    pub(crate) fn update(
        &mut self,
        scene: &Scene,
        state: &State,
        structure: &dyn Structure,
        ground: &mut dyn Ground,
        motion: &dyn FreeField,
        time: f64,
    ) -> Result<(), StepError> {
        self.update_free_field(scene, state, ground, motion, time);
        for (value, initial) in self.free_field.iter_mut().zip(&scene.initial_free_field) {
            *value -= initial;
        }
        self.update_history(scene, ground)?;
        for (values, quantity) in
            [(&self.free_field, "free field"), (&self.history, "history of the ground")]
        {
            StepError::check_finite(quantity, values)?;
        }
        self.subtract_free_traction(scene)?;
        self.distortion.copy_from_slice(&self.free_field);
        let influence = &scene.model.influence;
        let previous_translations = &state.kinematics.translations;
        let parts = influence.parts().iter().zip(&mut self.translations);
        for ((part, translation), previous) in parts.zip(previous_translations) {
            let displacement = part.mean_translation(&scene.base, &self.free_field);
            *translation = previous.next(displacement, &scene.coefficients);
            part.subtract_translation(&scene.base, displacement, &mut self.distortion);
        }
        let Self { translations, distortion, .. } = self;
        influence.set_joint_distortion(
            &scene.base,
            |part| translations[part].displacement,
            distortion,
        );
        self.translation_increment.fill(0.0);
        let increments = self.translations.iter().map(|translation| translation.increment);
        influence.translate(1.0, increments, &mut self.translation_increment);
        if scene.model.is_damped {
            self.translation_velocity.fill(0.0);
            let velocities = self.translations.iter().map(|translation| translation.velocity);
            influence.translate(1.0, velocities, &mut self.translation_velocity);
        }
        if self.has_load {
            self.load.fill(0.0);
        }
        let load_time = state.time + scene.coefficients.load_fraction * scene.time_step;
        let static_load = &scene.static_state.load;
        let has_structure_load = scene
            .model
            .add_load(structure, load_time, static_load, &mut self.dof_load, &mut self.load)
            .map_err(StepError::part("load of the structure"))?;
        if has_structure_load {
            StepError::check_finite("load of the structure", &self.dof_load)?;
        }
        self.has_load = has_structure_load || scene.has_loads();
        match scene.add_loads(load_time, &mut self.load) {
            None => Ok(()),
            Some((index, value)) => {
                Err(StepError::NotFinite { quantity: "external load", index, value })
            }
        }
    }
}

impl Forcing {
    /// Computes the convolution history of the ground; zero at joints.
    ///
    /// An error of the ground ends the step.
    fn update_history(&mut self, scene: &Scene, ground: &mut dyn Ground) -> Result<(), StepError> {
        let part_error = StepError::part("history of the ground");
        if self.ground_displacement.is_empty() {
            return ground.history(&mut self.history).map_err(part_error);
        }
        ground.history(&mut self.ground_displacement).map_err(part_error)?;
        scene.base.set_ground_part(&self.ground_displacement, &mut self.history);
        Ok(())
    }

    /// Subtracts the effect of the free field's tractions in this step from the history.
    fn subtract_free_traction(&mut self, scene: &Scene) -> Result<(), StepError> {
        // The buffer of the impulse now contains −τ_ff.
        for (negative, traction) in self.impulse.iter_mut().zip(&self.free_traction) {
            *negative = -traction;
        }
        if !self.free_traction.is_empty() {
            StepError::check_finite("tractions of the free field", &self.free_traction)?;
            scene.step_compliance.multiply_add(&self.impulse, &mut self.history);
        }
        Ok(())
    }

    /// Computes displacements of the free field, and its mean tractions in the step.
    ///
    /// `time`: end of the step, s.
    fn update_free_field(
        &mut self,
        scene: &Scene,
        state: &State,
        ground: &dyn Ground,
        motion: &dyn FreeField,
        time: f64,
    ) {
        // The build has checked that the motion is defined on the walls.
        if scene.base.elements().has_walls() {
            self.fill_free_field(scene, ground, motion, state.time);
            self.free_traction.copy_from_slice(&self.impulse);
        }
        self.fill_free_field(scene, ground, motion, time);
        for (traction, impulse) in self.free_traction.iter_mut().zip(&self.impulse) {
            *traction = (*impulse - *traction) / scene.time_step;
        }
    }

    /// Computes displacements of the free field, and the integral of its tractions.
    ///
    /// Both are those at `time` (s), and zero at joints.
    fn fill_free_field(
        &mut self,
        scene: &Scene,
        ground: &dyn Ground,
        motion: &dyn FreeField,
        time: f64,
    ) {
        let Self { free_field, impulse, ground_displacement, ground_impulse, .. } = self;
        let elements = scene.base.elements();
        if ground_displacement.is_empty() {
            fill_free_field(ground, motion, elements, time, free_field, impulse);
            return;
        }
        fill_free_field(ground, motion, elements, time, ground_displacement, ground_impulse);
        scene.base.set_ground_part(ground_displacement, free_field);
        if !ground_impulse.is_empty() {
            scene.base.set_ground_part(ground_impulse, impulse);
        }
    }
}

/// Input of the solution of a step.
#[derive(Clone, Copy)]
pub(crate) struct StepData<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) structure: &'a dyn Structure,
    /// State at the start of the step.
    pub(crate) state: &'a State,
    pub(crate) forcing: &'a Forcing,
}
