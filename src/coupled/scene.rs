//! Scene: all data that stay constant during a run.

use std::sync::Arc;

use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::{ConnectedPart, UPWARD_DIRECTION};
use crate::coupled::base::transformation::{Transformation, Weights};
use crate::coupled::model::Model;
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::model::load::SteppedLoad;
use crate::coupled::parts::Parts;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::serviceability::Serviceability;
use crate::coupled::state::ResultContext;
use crate::coupled::statics::static_state::StaticState;
use crate::error::LawError;
use crate::geometry::{ContactLayout, Footing};
use crate::interface::{InterfaceLaw, Mode, PreviousContacts, law_of};
use crate::linalg::matrix::dense_vector;
use crate::linalg::{CompressedMatrix, mixing_sum};
use crate::structure::Probe;

/// Constant data of a run: matrices, base, laws, loads and static state.
///
/// The structure, the ground and the motion change during a run and are stored separately.
pub(crate) struct Scene {
    pub(crate) time_step: f64,
    pub(crate) coefficients: SchemeCoefficients,
    /// Whether the scheme conserves energy.
    pub(crate) conserves_energy: bool,
    pub(crate) model: Model,
    pub(crate) base: PlacedBase,
    pub(crate) laws: Vec<Box<dyn InterfaceLaw>>,
    /// Serviceability limits with which runs are compared.
    pub(crate) serviceability: Serviceability,
    pub(crate) static_state: StaticState,
    /// External loads in addition to the load of the structure.
    pub(crate) loads: Vec<SteppedLoad>,
    /// Weight as a load, in stepping coordinates.
    ///
    /// Empty if the run starts from a static state.
    pub(crate) weight: Vec<f64>,
    /// For each part, whether the nonlinear force connects it with other parts.
    pub(crate) is_connected_by_force: Vec<bool>,
    /// Step compliance of the ground, 2Q × 2Q, or 3Q × 3Q in plan.
    pub(crate) step_compliance: Arc<CompressedMatrix>,
    /// Displacement of the free field at t = 0, m.
    ///
    /// It is subtracted from the free field of every step. It has 2Q entries, or 3Q in plan.
    pub(crate) initial_free_field: Vec<f64>,
    /// The probes in stepping coordinates.
    pub(crate) stepped_probes: Vec<SteppedProbe>,
    /// Number of the gravity stage, for comparison with a checkpoint.
    pub(crate) gravity_stage: f64,
    /// Sums over the initial displacement and velocity, for comparison with a checkpoint.
    pub(crate) initial_motion_sums: [f64; 2],
    /// The builder's label, for comparison with a checkpoint.
    pub(crate) label: String,
    /// Data that results of all states of this scene share.
    pub(crate) context: Arc<ResultContext>,
}

/// A probe in stepping coordinates.
pub(crate) struct SteppedProbe {
    /// Weights of displacement, velocity and acceleration.
    pub(crate) weights: [Weights; 3],
    /// Displacements of an absolute probe for translations of each part by 1 m.
    ///
    /// For each part `[right, up, along_y]`; empty for other probes.
    pub(crate) rigid_displacements: Vec<[f64; 3]>,
}

impl SteppedProbe {
    pub(crate) fn new(probe: &Probe, model: &Model) -> Self {
        let weights = probe.rows().map(|row| model.transformation.weights(row));
        let mut rigid_displacements = Vec::new();
        if probe.absolute {
            for part in model.influence.parts() {
                rigid_displacements.push(
                    part.vectors.each_ref().map(|vector| {
                        weights[0].value(&dense_vector(vector, model.coordinate_count))
                    }),
                );
            }
        }
        Self { weights, rigid_displacements }
    }
}

impl Scene {
    /// Collects the data that steps need from the parts.
    pub(crate) fn new(
        parts: &mut Parts,
        model: Model,
        base: PlacedBase,
        static_state: StaticState,
        is_connected_by_force: Vec<bool>,
    ) -> Self {
        let Parts { builder, coefficients, .. } = parts;
        let time_step = builder.time_step;
        let coefficients = *coefficients;
        let is_static = builder.has_static_loads();
        let mut loads = Vec::with_capacity(builder.loads.len());
        for load in std::mem::take(&mut builder.loads) {
            loads.push(SteppedLoad::new(load, &model.transformation, is_static));
        }
        let mut weight = Vec::new();
        if builder.starts_unloaded() {
            weight.resize(model.coordinate_count, 0.0);
            let up = model.influence.whole_vector(UPWARD_DIRECTION, model.coordinate_count);
            model.mass.multiply_add(-builder.gravity, &up, &mut weight);
            if !parts.water_force.is_empty() {
                model.transformation.add_forces(&parts.water_force, &mut weight);
            }
        }
        let elements = &parts.elements;
        let mut footings = Vec::new();
        for ((_, range), outline) in base.foundations().zip(base.outlines()) {
            footings.push(Footing::new(elements, range, outline, parts.moment_center));
        }
        let stepped_probes =
            builder.probes.iter().map(|probe| SteppedProbe::new(probe, &model)).collect();
        let context = ResultContext {
            probes: std::mem::take(&mut builder.probes),
            elements: elements.clone(),
            pressure_depths: std::mem::take(&mut parts.description.depth_of_pressure_at_rest),
            friction: std::mem::take(&mut builder.safety_friction_coefficients),
            footings,
            joint_elements: base
                .joints()
                .iter()
                .map(|joint| joint.line.elements().to_vec())
                .collect(),
            buoyancy: parts.buoyancy,
            weight_in_water: parts.weight_in_water,
        };
        Self {
            time_step,
            coefficients,
            conserves_energy: coefficients.conserves_energy(time_step),
            laws: std::mem::take(&mut builder.laws),
            serviceability: builder.serviceability,
            static_state,
            loads,
            weight,
            is_connected_by_force,
            step_compliance: parts.step_compliance.clone(),
            initial_free_field: base.with_zero_joints(&parts.initial_free_field),
            stepped_probes,
            gravity_stage: builder.gravity_stage as usize as f64,
            initial_motion_sums: [
                mixing_sum(&builder.initial_displacement),
                mixing_sum(&builder.initial_velocity),
            ],
            label: std::mem::take(&mut builder.label),
            context: Arc::new(context),
            model,
            base,
        }
    }

    /// Number of contact elements Q, of the ground and the joints.
    pub(crate) fn element_count(&self) -> usize {
        self.layout().elements()
    }

    /// Order of the numbers of a contact vector.
    pub(crate) fn layout(&self) -> ContactLayout {
        self.base.layout()
    }

    /// The law of an element.
    pub(crate) fn law(&self, element: usize) -> &dyn InterfaceLaw {
        law_of(&self.laws, element)
    }

    /// Subtracts the mean translation of each part's base from a displacement, before K multiplies it.
    ///
    /// A translation causes no strain. In degrees of freedom, K times a translation is zero only by cancellation, with
    /// an error that grows with stiffness times displacement. In modal coordinates a translation has no stiffness.
    pub(crate) fn subtract_base_translation(&self, displacement: &mut [f64], means: &mut [f64]) {
        if let Transformation::Identity = self.model.transformation {
            self.base.means(displacement, means);
            let influence = &self.model.influence;
            let translations = influence.base_translations(&self.base, means);
            influence.translate(-1.0, translations, displacement);
        }
    }

    /// Converts a displacement to the one that the nonlinear force receives.
    ///
    /// The mean translation of each part's base is subtracted, so that the displacement stays small. From all parts that
    /// the force connects, the translation of the first of these parts is subtracted, so that their distances do not
    /// change. The static displacement is added. `translations` are the translations of the free fields under the parts, m.
    pub(crate) fn convert_to_force_displacement(
        &self,
        displacement: &mut [f64],
        means: &mut [f64],
        translations: impl Iterator<Item = [f64; 3]> + Clone,
    ) {
        self.base.means(displacement, means);
        let influence = &self.model.influence;
        let base_translation =
            |part: &ConnectedPart| influence.base_translation(part, &self.base, means);
        let parts = || influence.parts().iter().zip(&self.is_connected_by_force);
        let first_connected = parts()
            .zip(translations.clone())
            .find(|((_, is_connected), _)| **is_connected)
            .map(|((part, _), y)| (base_translation(part), y));
        let shifts =
            parts().zip(translations).map(|((part, is_connected), y)| match first_connected {
                Some((first_translation, first_y)) if *is_connected => {
                    [0, 1, 2].map(|k| (y[k] - first_y[k]) - first_translation[k])
                }
                _ => base_translation(part).map(|component| -component),
            });
        influence.translate(1.0, shifts, displacement);
        for (entry, static_entry) in displacement.iter_mut().zip(&self.static_state.displacement) {
            *entry += static_entry;
        }
    }

    /// Displacement of a motion that the nonlinear force receives.
    pub(crate) fn force_displacement_of(&self, motion: &Kinematics) -> Vec<f64> {
        let mut displacement = motion.displacement.clone();
        let translations = motion.translations.iter().map(|y| y.displacement);
        self.convert_to_force_displacement(
            &mut displacement,
            &mut vec![0.0; self.layout().len()],
            translations,
        );
        displacement
    }

    /// Whether [`Scene::add_loads`] adds anything.
    pub(crate) fn has_loads(&self) -> bool {
        !(self.weight.is_empty() && self.loads.is_empty())
    }

    /// Adds weight and external loads at `time`, minus the loads of the static state, to `force`.
    ///
    /// Returns the number and the value of the first load that is not finite.
    pub(crate) fn add_loads(&self, time: f64, force: &mut [f64]) -> Option<(usize, f64)> {
        force.iter_mut().zip(&self.weight).for_each(|(force, weight)| *force += weight);
        for (index, load) in self.loads.iter().enumerate() {
            let value = load.add(time, force);
            if !value.is_finite() {
                return Some((index, value));
            }
        }
        None
    }

    /// Whether any law stores elastic energy, now or with other state variables.
    pub(crate) fn is_compliant(&self, previous: &PreviousContacts) -> Result<bool, LawError> {
        let mut is_compliant = false;
        for element in 0..self.element_count() {
            for &mode in self.law(element).modes() {
                is_compliant |= self.compliance(element, mode, previous)? != [0.0; 2];
            }
        }
        Ok(is_compliant || !previous.state_variables().is_empty())
    }

    /// Normal and shear compliance of an element whose step ends in `mode`, m/Pa.
    pub(crate) fn compliance(
        &self,
        element: usize,
        mode: Mode,
        previous: &PreviousContacts,
    ) -> Result<[f64; 2], LawError> {
        let compliance = self.law(element).compliance(mode, &previous.element(element));
        let named_values =
            [("normal compliance", compliance[0]), ("shear compliance", compliance[1])];
        match named_values.into_iter().find(|(_, value)| !value.is_finite()) {
            None => Ok(compliance),
            Some((quantity, value)) => {
                Err(LawError::not_finite(element, mode.word(), quantity, value))
            }
        }
    }
}
