//! Identity of a scene: numbers and a label that distinguish checkpoints of different scenes.

use crate::Simulation;
use crate::error::CheckpointError;
use crate::geometry::ContactElement;
use crate::linalg::largest;
use crate::text::check_sum::CheckSum;

/// Relative difference of numbers of the same scene; other processors round differently.
const IDENTITY_TOLERANCE: f64 = 1e-9;

/// Intended difference from the scene of a checkpoint, for [`Simulation::resume_changed`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Change {
    /// Other parameters of the interface laws, and another label.
    ///
    /// The number of state variables must be the same.
    InterfaceLaw,
    /// Another ground motion, and another label.
    GroundMotion,
    /// Other loads, and another label. Forces that were [set](Simulation::set_load) are not restored.
    Load,
    /// Another gravity stage that leads to the same static state.
    GravityStage,
    /// Another initial displacement or velocity.
    InitialMotion,
}

words! { pub Change, "change of a scene", {
    InterfaceLaw = "interface_law",
    GroundMotion = "ground_motion",
    Load = "load",
    GravityStage = "gravity_stage",
    InitialMotion = "initial_motion",
} }

/// Numbers and a label that distinguish a scene from others.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(crate) struct Identity {
    /// The builder's label.
    label: String,
    dofs: usize,
    /// Whether the scene has an energy balance.
    energy_balance: bool,
    probes: Vec<String>,
    /// Ends of the state variables of each element's law.
    ///
    /// Empty if no law has any.
    laws: Vec<usize>,
    /// Time step and coefficients of the scheme.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    steps: Vec<f64>,
    /// Coordinates of the ends of the elements, m.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    elements: Vec<f64>,
    /// Sums over the structure's matrices, and a sum that depends on the signs of its modes.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    structure: Vec<f64>,
    /// Sum over the ground's step compliance.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    ground: Vec<f64>,
    /// Sum over the static tractions.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    static_contact: Vec<f64>,
    /// Number of the gravity stage, and sums over the initial displacement and velocity.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    start: Vec<f64>,
}

/// Whether two lists agree to rounding.
///
/// The tolerance is relative to `scale` or to each number of the second list, whichever is larger.
fn are_close(saved_numbers: &[f64], present_numbers: &[f64], scale: f64) -> bool {
    saved_numbers.len() == present_numbers.len()
        && saved_numbers
            .iter()
            .zip(present_numbers)
            .all(|(a, b)| a == b || (a - b).abs() <= IDENTITY_TOLERANCE * scale.max(b.abs()))
}

/// Sum of the magnitudes of a list.
fn sum_of_magnitudes(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).sum()
}

impl Identity {
    /// Number of the gravity stage; empty if a damaged file has an empty list.
    fn gravity_stage(&self) -> &[f64] {
        self.start.get(..1).unwrap_or_default()
    }

    /// Sums over the initial displacement and velocity.
    fn initial_motion(&self) -> &[f64] {
        self.start.get(1..).unwrap_or_default()
    }

    /// Adds all contents to a check sum.
    pub(crate) fn add_to(&self, sum: &mut CheckSum) {
        let Self { label, dofs, energy_balance, probes, laws, .. } = self;
        let Self { steps, elements, structure, ground, static_contact, start, .. } = self;
        sum.add_text(label);
        sum.add(*dofs as u64);
        sum.add(u64::from(*energy_balance));
        sum.add(probes.len() as u64);
        for name in probes {
            sum.add_text(name);
        }
        sum.add_list(laws.iter().map(|end| *end as u64));
        for list in [steps, elements, structure, ground, static_contact, start] {
            sum.add_numbers(list);
        }
    }

    /// Returns an error that names the first difference outside the intended `changes`.
    pub(crate) fn check(
        &self,
        scene: &Self,
        changes: &[Change],
    ) -> std::result::Result<(), CheckpointError> {
        // The label names laws, motion and loads.
        let changes_label = |change: &Change| {
            matches!(change, Change::InterfaceLaw | Change::GroundMotion | Change::Load)
        };
        let is_same_label = self.label == scene.label || changes.iter().any(changes_label);
        let is_same_stage = changes.contains(&Change::GravityStage)
            || are_close(self.gravity_stage(), scene.gravity_stage(), 0.0);
        let is_same_motion = changes.contains(&Change::InitialMotion)
            || are_close(self.initial_motion(), scene.initial_motion(), 0.0);
        let length_scale = largest(&scene.elements);
        for (is_same, quantity) in [
            (self.dofs == scene.dofs, "number of degrees of freedom"),
            (are_close(&self.steps, &scene.steps, 0.0), "time step or scheme"),
            (are_close(&self.elements, &scene.elements, length_scale), "list of contact elements"),
            (self.energy_balance == scene.energy_balance, "energy balance"),
            (self.probes == scene.probes, "list of probes"),
            (self.laws == scene.laws, "state variables of the interface laws"),
            (are_close(&self.structure, &scene.structure, 0.0), "structure"),
            (are_close(&self.ground, &scene.ground, 0.0), "ground"),
            (is_same_stage, "gravity stage"),
            (are_close(&self.static_contact, &scene.static_contact, 0.0), "static state"),
            (is_same_motion, "initial motion"),
            (is_same_label, "label"),
        ] {
            if !is_same {
                return Err(CheckpointError::OtherScene { quantity });
            }
        }
        Ok(())
    }
}

impl Simulation {
    /// Numbers and label, which are equal for simulations of the same scene.
    pub(crate) fn identity(&self) -> Identity {
        let Self { scene, state, .. } = self;
        let model = &scene.model;
        // Modal coordinates of a checkpoint are wrong for modes of other signs, which are arbitrary. This sum depends
        // on the signs. The responses of a nonlinear structure have no modes and change with the tangent.
        let operators = self.solver.operators();
        let responses = operators.traction_responses.iter().enumerate().filter(|_| model.is_linear);
        let signed_sum = responses.map(|(k, value)| (k as f64).cos() * value).sum();
        let c = scene.coefficients;
        let mut scheme_numbers = vec![scene.time_step];
        for row in [c.acceleration, c.velocity, c.displacement] {
            scheme_numbers.extend(row);
        }
        let ground_elements = scene.base.elements().iter();
        let mut elements: Vec<f64> =
            ground_elements.flat_map(ContactElement::ends).flatten().collect();
        for joint in scene.base.joints() {
            let ends = joint.line.elements().iter().flat_map(ContactElement::ends);
            elements.extend(ends.flatten());
            elements.push(joint.line.gap);
        }
        let structure = vec![
            sum_of_magnitudes(model.mass.values()),
            sum_of_magnitudes(model.damping.values()),
            sum_of_magnitudes(model.stiffness.values()),
            signed_sum,
        ];
        Identity {
            label: scene.label.clone(),
            dofs: model.dofs,
            energy_balance: self.energies.is_some(),
            probes: scene.context.probes.iter().map(|probe| probe.name.clone()).collect(),
            laws: state.start.state_variable_ends().to_vec(),
            steps: scheme_numbers,
            elements,
            structure,
            ground: vec![sum_of_magnitudes(&scene.step_compliance)],
            // A weight that acts as a load is not part of the static state.
            static_contact: [&scene.static_state.traction, &scene.weight]
                .map(|values| sum_of_magnitudes(values))
                .to_vec(),
            start: [&[scene.gravity_stage][..], &scene.initial_motion_sums].concat(),
        }
    }
}

/// Serialization of floating-point numbers as their bits, without rounding.
#[cfg(feature = "serde")]
pub(crate) mod bits {
    use serde::{Deserialize, Deserializer, Serializer};

    pub(crate) fn serialize<S: Serializer>(values: &[f64], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(values.iter().map(|value| value.to_bits()))
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Vec<f64>, D::Error> {
        let bits = Vec::<u64>::deserialize(from)?;
        Ok(bits.into_iter().map(f64::from_bits).collect())
    }
}
