//! Identity of a scene: numbers that distinguish checkpoints of different scenes.

use crate::Simulation;
use crate::bem::free_field;
use crate::coupled::scene::Scene;
use crate::error::{CheckpointError, Result};
use crate::geometry::ContactElement;
use crate::interface::{Condition, ContactState, InterfaceLaw, Limits, Mode, PreviousContact};
use crate::linalg::{largest, mixed, mixing_weight};
use crate::text::check_sum::CheckSum;

/// Allowed difference of numbers of the same scene, since other processors round differently.
const IDENTITY_TOLERANCE: f64 = 1e-9;
/// Number of parts of the run in which ground motion and loads are compared.
const SAMPLED_PARTS: usize = 64;
/// Largest number of steps whose loads and motion are compared; a longer run is sampled.
const MAX_COMPARED_STEPS: usize = 100_000;
/// Largest number of evaluated entries of the structure's load; larger structures are sampled at fewer steps.
const MAX_LOAD_ENTRIES: usize = 10_000_000;
/// Slip rates of sample states, m/s.
const SAMPLE_SLIP_RATES: [f64; 4] = [1e-3, 1e-2, 0.1, 1.0];
/// Slip of sample states, m.
const SAMPLE_SLIP: f64 = 1e-4;
/// Pressure of a sample state if there is no weight, Pa.
const SAMPLE_PRESSURE: f64 = 1e5;
/// Number that replaces one that is not finite.
const NOT_FINITE_SUBSTITUTE: f64 = -7.25;

/// An intended difference from the scene of a checkpoint: see [`Simulation::resume_changed`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Change {
    /// Other parameters of the interface laws; the number of their state variables must be the same.
    InterfaceLaw,
    /// Another ground motion.
    GroundMotion,
    /// Other loads.
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

/// Numbers that distinguish a scene from others.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(crate) struct Identity {
    dofs: usize,
    /// Whether an energy balance is kept.
    energy_balance: bool,
    probes: Vec<String>,
    /// Ends of the state variables of each element's law; empty if no law has any.
    laws: Vec<usize>,
    /// Time step and coefficients of the scheme.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    steps: Vec<f64>,
    /// Ends of the elements.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    elements: Vec<f64>,
    /// Sums over the structure's matrices, and one that depends on the signs of its modes.
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
    /// Numbers of the laws for sample states, averaged over the elements.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    law_numbers: Vec<f64>,
    /// Sums over the free field and over the loads, in parts of the steps so far.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    free_field: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    loads: Vec<f64>,
}

/// Whether two lists agree within rounding, relative to `scale` or to each number of the second.
fn close(saved: &[f64], present: &[f64], scale: f64) -> bool {
    saved.len() == present.len()
        && saved
            .iter()
            .zip(present)
            .all(|(a, b)| a == b || (a - b).abs() <= IDENTITY_TOLERANCE * scale.max(b.abs()))
}

/// Sum of the magnitudes of a list.
fn sum_of_magnitudes(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).sum()
}

impl Identity {
    /// Number of the gravity stage; lists of a file may be of any length.
    fn gravity_stage(&self) -> &[f64] {
        self.start.get(..1).unwrap_or_default()
    }

    /// Sums over the initial displacement and velocity.
    fn initial_motion(&self) -> &[f64] {
        self.start.get(1..).unwrap_or_default()
    }

    pub(crate) fn add_to(&self, sum: &mut CheckSum) {
        let Self {
            dofs,
            energy_balance,
            probes,
            laws,
            steps,
            elements,
            structure,
            ground,
            static_contact,
            start,
            law_numbers,
            free_field,
            loads,
        } = self;
        sum.add(*dofs as u64);
        sum.add(u64::from(*energy_balance));
        sum.add(probes.len() as u64);
        for name in probes {
            sum.add_text(name);
        }
        sum.add_list(laws.iter().map(|end| *end as u64));
        for list in [
            steps,
            elements,
            structure,
            ground,
            static_contact,
            start,
            law_numbers,
            free_field,
            loads,
        ] {
            sum.add_numbers(list);
        }
    }

    /// Error that names the first difference that is not among the `changes`.
    pub(crate) fn check(
        &self,
        scene: &Self,
        changes: &[Change],
    ) -> std::result::Result<(), CheckpointError> {
        let unless = |change: Change, same: bool| changes.contains(&change) || same;
        let span = largest(&scene.elements);
        let largest_motion = largest(&scene.free_field);
        let largest_load = largest(&scene.loads);
        for (same, quantity) in [
            (self.dofs == scene.dofs, "number of degrees of freedom"),
            (close(&self.steps, &scene.steps, 0.0), "time step or scheme"),
            (close(&self.elements, &scene.elements, span), "list of contact elements"),
            (self.energy_balance == scene.energy_balance, "energy balance"),
            (self.probes == scene.probes, "list of probes"),
            (self.laws == scene.laws, "state variables of the interface laws"),
            (close(&self.structure, &scene.structure, 0.0), "structure"),
            (close(&self.ground, &scene.ground, 0.0), "ground"),
            (
                unless(
                    Change::GravityStage,
                    close(self.gravity_stage(), scene.gravity_stage(), 0.0),
                ),
                "gravity stage",
            ),
            (close(&self.static_contact, &scene.static_contact, 0.0), "static state"),
            (
                unless(
                    Change::InitialMotion,
                    close(self.initial_motion(), scene.initial_motion(), 0.0),
                ),
                "initial motion",
            ),
            (
                unless(Change::InterfaceLaw, close(&self.law_numbers, &scene.law_numbers, 0.0)),
                "interface law",
            ),
            (
                unless(
                    Change::GroundMotion,
                    close(&self.free_field, &scene.free_field, largest_motion),
                ),
                "ground motion",
            ),
            (unless(Change::Load, close(&self.loads, &scene.loads, largest_load)), "load"),
        ] {
            if !same {
                return Err(CheckpointError::OtherScene { quantity });
            }
        }
        Ok(())
    }
}

impl Simulation {
    /// Numbers that are equal for simulations of the same scene, with samples of these first `steps`.
    pub(crate) fn identity(&self, steps: usize) -> Result<Identity> {
        let Self { scene, state, .. } = self;
        let model = &scene.model;
        // Modes may have either sign. A nonlinear structure has no modes, and its columns change.
        let columns = self.solver.operators().columns.iter().enumerate().filter(|_| model.linear);
        let signed = columns.map(|(k, value)| (k as f64).cos() * value).sum();
        let c = scene.coefficients;
        let mut scheme = vec![scene.time_step];
        for row in [c.acceleration, c.velocity, c.displacement] {
            scheme.extend(row);
        }
        let elements = scene.base.elements().iter();
        let elements = elements.flat_map(ContactElement::ends).flatten().collect();
        let (free_field, loads) = self.samples(steps)?;
        let structure = vec![
            sum_of_magnitudes(model.mass.values()),
            sum_of_magnitudes(model.damping.values()),
            sum_of_magnitudes(model.stiffness.values()),
            signed,
        ];
        Ok(Identity {
            dofs: model.dofs,
            energy_balance: self.books.is_some(),
            probes: scene.context.probes.iter().map(|probe| probe.name.clone()).collect(),
            laws: state.start.state_variable_ends().to_vec(),
            steps: scheme,
            elements,
            structure,
            ground: vec![sum_of_magnitudes(&scene.soil)],
            // A weight that acts as a load is not part of the static state.
            static_contact: [&scene.static_state.traction, &scene.weight]
                .map(|values| sum_of_magnitudes(values))
                .to_vec(),
            start: scene.start.to_vec(),
            law_numbers: law_numbers(scene),
            free_field,
            loads,
        })
    }

    /// Sums over the free field and over all loads in [`SAMPLED_PARTS`] parts of the first `steps`.
    ///
    /// A pulse may be as short as a step: external loads and the motion of one element count at every step of a usual
    /// run.
    fn samples(&self, steps: usize) -> Result<(Vec<f64>, Vec<f64>)> {
        let Self { scene, structure, ground, motion, .. } = self;
        let count = steps.max(SAMPLED_PARTS);
        let mut motion_sums = vec![0.0; SAMPLED_PARTS];
        let mut load_sums = vec![0.0; SAMPLED_PARTS];
        let elements = scene.base.elements();
        let mut displacement = vec![0.0; scene.layout().len()];
        let mut impulse = displacement.clone();
        for (sample, sum) in motion_sums.iter_mut().enumerate() {
            let step = (sample + 1) as f64 * (count as f64 / SAMPLED_PARTS as f64);
            let time = step.round() * scene.time_step;
            let values = [&mut displacement[..], &mut impulse];
            free_field(ground.as_ref(), motion.as_ref(), elements, time, values);
            *sum = mixed(&impulse) + mixed(&displacement);
        }
        let rows = scene.loads.iter().enumerate();
        let rows: Vec<f64> = rows.map(|(k, load)| mixing_weight(k) * load.mixed_row()).collect();
        let mut force = vec![0.0; scene.model.dofs];
        let instants = count.min(MAX_COMPARED_STEPS);
        let stride = instants.div_ceil((MAX_LOAD_ENTRIES / force.len().max(1)).max(SAMPLED_PARTS));
        let [x, y, _] = scene.base.elements()[0].center();
        for instant in 0..instants {
            let part = instant * SAMPLED_PARTS / instants;
            let weight = mixing_weight(instant);
            let step = (instant as f64 * (count as f64 / instants as f64)).round();
            let end = (step + 1.0) * scene.time_step;
            motion_sums[part] += weight * mixed(&motion.displacement_at([x, y], end));
            let time = (step + scene.coefficients.load_fraction) * scene.time_step;
            let external = scene.loads.iter().zip(&rows);
            let external = external.map(|(load, row)| row * load.own_value(time));
            load_sums[part] += weight * external.sum::<f64>();
            if instant % stride == 0 {
                force.fill(0.0);
                structure.load(time, &mut force)?;
                load_sums[part] += weight * mixed(&force);
            }
        }
        Ok((motion_sums, load_sums))
    }
}

/// Numbers that the laws return for sample states, as weighted means over the elements.
fn law_numbers(scene: &Scene) -> Vec<f64> {
    let count = scene.count();
    let plan = scene.layout().is_plan();
    let pressures = &scene.static_state.traction[..count];
    let mean = pressures.iter().sum::<f64>() / count as f64;
    let pressure = if mean > 0.0 { mean } else { SAMPLE_PRESSURE };
    let mut all: Vec<f64> = Vec::new();
    let elements = if scene.laws.len() == 1 { 1 } else { count };
    let sum: f64 = (0..elements).map(mixing_weight).sum();
    for element in 0..elements {
        let numbers = numbers_of(scene.law(element), pressure, scene.time_step, plan);
        all.resize(all.len().max(numbers.len()), 0.0);
        for (mean, number) in all.iter_mut().zip(numbers) {
            // Numbers that are not finite would hide the others.
            let number = if number.is_finite() { number } else { NOT_FINITE_SUBSTITUTE };
            *mean += mixing_weight(element) / sum * number;
        }
    }
    all
}

/// Numbers that a law returns under this pressure, Pa.
///
/// At rest, and at each of [`SAMPLE_SLIP_RATES`] after [`SAMPLE_SLIP`], with the first state variables: a user's law may refuse
/// other ones.
fn numbers_of(law: &dyn InterfaceLaw, pressure: f64, time_step: f64, plan: bool) -> Vec<f64> {
    let rest = ContactState { pressure, ..ContactState::default() };
    let slipped = ContactState { slip: SAMPLE_SLIP, ..rest };
    let at_rest = PreviousContact::new(rest, law.modes()[0], time_step);
    let variables = at_rest.first_state_variables(law);
    let mut all = vec![law.state_variables() as f64, law.friction_coefficient().unwrap_or(-1.0)];
    all.extend(&variables);
    add_numbers(law, &at_rest.with_state_variables(&variables), pressure, plan, &mut all);
    let slip_mode = law.modes().iter().copied().find(|mode| mode.is_slip());
    let mut slid = PreviousContact::new(slipped, slip_mode.unwrap_or(law.modes()[0]), time_step);
    slid.static_pressure = pressure;
    for rate in SAMPLE_SLIP_RATES {
        slid.slip_rate = rate;
        add_numbers(law, &slid.with_state_variables(&variables), pressure, plan, &mut all);
    }
    all
}

/// Adds the numbers that a law returns for a step from this start.
fn add_numbers(
    law: &dyn InterfaceLaw,
    start: &PreviousContact<'_>,
    pressure: f64,
    plan: bool,
    all: &mut Vec<f64>,
) {
    if plan {
        all.extend(law.compliance(Mode::Stick, start));
        if let Ok(limits) = law.limits(start) {
            let Limits { friction, attraction, shear_strength, .. } = limits;
            let Limits { tension, pressure_cap, gap_offset, bonded, .. } = limits;
            all.extend([friction, attraction, shear_strength, tension, pressure_cap]);
            all.extend([gap_offset, f64::from(u8::from(bonded))]);
        }
        return;
    }
    for &mode in law.modes() {
        all.push(mode as usize as f64);
        all.extend(law.compliance(mode, start));
        for Condition { gap, slip, pressure, shear, value } in law.conditions(mode, start) {
            all.extend([gap, slip, pressure, shear, value]);
        }
    }
    for (pressure, shear) in [(-pressure, 0.0), (0.0, pressure), (pressure, 3.0 * pressure)] {
        let trial = ContactState { pressure, shear, ..start.state };
        all.push(law.bond_overload(start, &trial).unwrap_or(0.0));
    }
}

/// Floating-point numbers as their bits.
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
