//! Summary of a run: peaks, envelopes, energies and warnings.

use std::ops::Range;
use std::time::{Duration, Instant};

mod base_view;
mod envelope;
mod foundation_axis;
mod ground_motion;
pub(crate) mod mistake;
pub(crate) mod page;
pub(crate) mod peak;
pub(crate) mod quantity;
pub(crate) mod quantity_row;
pub(crate) mod resolution;
mod service_check;
mod sliding;
mod unusual_numbers;
mod uplift;
mod variation;
mod vectors;
pub(crate) mod wall_pressure;
pub(crate) mod warning;
mod warning_rules;
mod warning_text;
mod weight;

pub use envelope::ElementEnvelope;
pub use ground_motion::GroundMotion;
pub use peak::{Extremes, Peak, ProbeExtremes};
pub use quantity::{Quantity, Summary};
use resolution::Resolution;
pub use service_check::ServiceCheck;
pub use sliding::{Sliding, SlipEvent};
pub(crate) use unusual_numbers::Weight;
pub use uplift::Uplift;

use crate::bem::{ContactElement, Ground};
use crate::contact::SearchMethod;
use crate::coupled::serviceability::Serviceability;
use crate::coupled::state::ResultContext;
use crate::coupled::state::sequence::StateSequence;
use crate::coupled::{EnergyBalance, Mistake, State, Warning};
use crate::error::Result;
use crate::motion::FreeField;
use crate::structure::probe_index;

/// Steps whose contact modes the first search did not find, by method.
///
/// See [`SearchMethod`](crate::contact::SearchMethod).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Fallbacks {
    /// Steps solved by Gauss–Seidel over the elements.
    pub gauss_seidel: usize,
    /// Steps solved by path following.
    pub path: usize,
    /// In plan: steps solved by Newton's method.
    #[cfg_attr(feature = "serde", serde(default))]
    pub newton: usize,
    /// In plan: steps solved by the proximal point method.
    #[cfg_attr(feature = "serde", serde(default))]
    pub proximal: usize,
}

impl Fallbacks {
    /// Steps solved by any of these methods.
    pub fn total(&self) -> usize {
        self.gauss_seidel + self.path + self.newton + self.proximal
    }
}

/// Summary of a run: peaks with their times, envelopes, uplift, slip, energies, warnings.
///
/// It prints as a page for a report. Quantities are named and signed as in [`State`]: forces per metre of
/// thickness (in plan, of the whole body), on the soil. Extremes include the initial state of the run.
///
/// With the feature `serde` all its fields are written, including
/// [numbers](crate#settings-and-results-in-serdes-formats) that are not finite. A run read from a file ignores
/// further steps.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Run {
    /// Number of steps of the run.
    pub steps: usize,
    /// Time at the beginning of the run, s.
    pub start: f64,
    /// Time at the end of the run, s.
    pub end: f64,
    /// The ground motion; zeros until the run is closed.
    #[cfg_attr(feature = "serde", serde(default))]
    pub ground_motion: GroundMotion,
    /// The time step, s.
    #[cfg_attr(feature = "serde", serde(default))]
    pub time_step: f64,
    /// Whether the run ended because a base turned beyond the rotation limit
    /// ([`SimulationBuilder::rotation_limit`](crate::coupled::SimulationBuilder::rotation_limit)).
    #[cfg_attr(feature = "serde", serde(default))]
    pub is_overturned: bool,
    /// Upward force of the water on the structure, N/m (in plan N): see [`WaterTable`](crate::soil::WaterTable).
    ///
    /// Normal forces and pressures are effective: the weight is their sum at rest plus this force.
    #[cfg_attr(feature = "serde", serde(default))]
    pub buoyancy: f64,
    /// Weight of a structure in water, of masses and [`Load::weight`](crate::coupled::Load::weight), N/m (in plan N).
    ///
    /// Zero without water above the base.
    #[cfg_attr(feature = "serde", serde(default))]
    pub weight_in_water: f64,
    /// The base as a whole.
    pub whole: Summary,
    /// The probes, in the order of the builder.
    pub probes: Vec<ProbeExtremes>,
    /// Each foundation, from left to right, in plan in the order of the structure's faces.
    pub foundations: Vec<Summary>,
    /// A check for each limit of the builder.
    ///
    /// See [`SimulationBuilder::serviceability`](crate::coupled::SimulationBuilder::serviceability).
    pub serviceability: Vec<ServiceCheck>,
    /// Envelopes of the contact elements, from left to right.
    pub envelope: Vec<ElementEnvelope>,
    /// Envelopes of the contact elements of each joint, in the order of the builder.
    #[cfg_attr(feature = "serde", serde(default))]
    pub joint_envelopes: Vec<Vec<ElementEnvelope>>,
    /// Changes of contact mode; each is in [`State::transitions`] of its step.
    pub mode_changes: usize,
    /// Changes by which an element opened.
    pub debondings: usize,
    /// Changes by which an element closed again.
    pub rebondings: usize,
    /// The energy balance at the end.
    pub energy_balance: EnergyBalance,
    /// Largest energy error of the run; NaN without an energy balance.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub energy_error: f64,
    /// Total number of trials of the search for contact modes, as in [`State::trials`].
    pub trials: usize,
    /// Steps that the first search for contact modes did not solve.
    pub fallbacks: Fallbacks,
    /// Warnings; empty until the run is closed.
    pub warnings: Vec<Warning>,
    /// Wall time, observers included; zero without a clock (WebAssembly).
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::seconds"))]
    pub wall: Duration,
    /// Whether the ground is one in plan: forces and energies are then of the whole body.
    pub in_plan: bool,
    #[cfg_attr(feature = "serde", serde(skip))]
    elements: Vec<ContactElement>,
    #[cfg_attr(feature = "serde", serde(skip, default = "StateSequence::closed"))]
    sequence: StateSequence,
    /// Whether the run completed the requested number of steps.
    ///
    /// `false` if an observer ended the run, or if the caller's loop made the steps.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) ends_by_steps: bool,
    /// Values of [`Warning::RESPONSES_CHECKED_AT_END`] after the last step, and after the step before it.
    #[cfg_attr(feature = "serde", serde(skip))]
    final_responses: [[f64; 4]; 2],
    #[cfg_attr(feature = "serde", serde(skip))]
    resolution: Resolution,
    /// Smallest algorithmic energy of the energy balance at any time.
    #[cfg_attr(feature = "serde", serde(skip))]
    smallest_algorithmic_energy: f64,
    #[cfg_attr(feature = "serde", serde(skip))]
    wall_start: Option<Instant>,
}

/// The present time; `None` without a clock (WebAssembly).
pub(crate) fn clock() -> Option<Instant> {
    (!cfg!(target_family = "wasm")).then(Instant::now)
}

impl Run {
    /// Run before its first step, at `state`, with these limits of serviceability.
    pub(crate) fn start(state: &State, limits: &Serviceability, resolution: Resolution) -> Self {
        let time = state.time;
        let ResultContext { elements, probes, .. } = state.context.as_ref();
        let mut probe_extremes = Vec::with_capacity(probes.len());
        for (probe, value) in probes.iter().zip(&state.probes) {
            probe_extremes.push(ProbeExtremes {
                name: probe.name.clone(),
                unit: probe.unit.clone(),
                extremes: Extremes::single(*value, time),
            });
        }
        let (envelope, joint_envelopes) = envelope::start(state);
        Self {
            steps: 0,
            start: time,
            end: time,
            ground_motion: GroundMotion::default(),
            time_step: resolution.time_step,
            is_overturned: false,
            buoyancy: state.context.buoyancy,
            weight_in_water: state.context.weight_in_water,
            whole: Summary::start(state, None),
            probes: probe_extremes,
            foundations: (0..state.foundations.len())
                .map(|k| Summary::start(state, Some(k)))
                .collect(),
            serviceability: ServiceCheck::all(limits, state),
            envelope,
            joint_envelopes,
            mode_changes: 0,
            debondings: 0,
            rebondings: 0,
            energy_balance: state.energy_balance,
            energy_error: state.energy_balance.residual(),
            trials: 0,
            fallbacks: Fallbacks::default(),
            warnings: Vec::new(),
            wall: Duration::ZERO,
            in_plan: elements.is_plan(),
            elements: elements.to_vec(),
            sequence: StateSequence::new(state),
            ends_by_steps: false,
            final_responses: [Warning::RESPONSES_CHECKED_AT_END
                .map(|quantity| state.value(quantity)); 2],
            resolution,
            smallest_algorithmic_energy: state.energy_balance.algorithmic,
            wall_start: clock(),
        }
    }

    /// Records the next step; [`Simulation::run`](crate::Simulation::run) calls it for every step.
    ///
    /// States of another simulation, and states that are not later than the last one, are ignored.
    pub fn record(&mut self, state: &State) {
        if !self.sequence.accept(state) {
            return;
        }
        let step_start = self.end;
        let time = state.time;
        self.steps += 1;
        self.end = time;
        self.final_responses = [
            Warning::RESPONSES_CHECKED_AT_END.map(|quantity| state.value(quantity)),
            self.final_responses[0],
        ];
        self.resolution.update(state);
        self.whole.update(state, step_start, None);
        for (k, summary) in self.foundations.iter_mut().enumerate() {
            summary.update(state, step_start, Some(k));
        }
        for (probe, value) in self.probes.iter_mut().zip(&state.probes) {
            probe.extremes.update(*value, time);
        }
        self.serviceability.iter_mut().for_each(|check| check.update(state));
        let duration = time - step_start;
        envelope::update(&mut self.envelope, (&state.contact, &state.modes), time, duration);
        for (envelopes, joint) in self.joint_envelopes.iter_mut().zip(&state.joints) {
            envelope::update(envelopes, (&joint.contact, &joint.modes), time, duration);
        }
        self.mode_changes += state.transitions.len();
        self.debondings += state.transitions.iter().filter(|change| change.is_debonding()).count();
        self.rebondings += state.transitions.iter().filter(|change| change.is_rebonding()).count();
        self.energy_balance = state.energy_balance;
        self.smallest_algorithmic_energy =
            self.smallest_algorithmic_energy.min(state.energy_balance.algorithmic);
        let residual = state.energy_balance.residual();
        if residual.is_nan() || residual > self.energy_error {
            self.energy_error = residual;
        }
        self.trials += state.trials;
        match state.method {
            SearchMethod::ActiveSet => {}
            SearchMethod::GaussSeidel => self.fallbacks.gauss_seidel += 1,
            SearchMethod::Path => self.fallbacks.path += 1,
            SearchMethod::Newton => self.fallbacks.newton += 1,
            SearchMethod::Proximal => self.fallbacks.proximal += 1,
        }
    }

    /// Closes the run and collects its warnings.
    ///
    /// The ground motion is sampled between the steps if the steps may not resolve it. `can_open`: whether an element can
    /// open. `pressures_above`: pressure of the soil above each element of a wall, Pa, as returned by
    /// [`wall_pressure::pressures_above`]. `damping_rate`: damping of a rigid translation over its mass, 1/s.
    /// `rotation_limit`: rotation that ends a run, rad.
    #[allow(clippy::too_many_arguments, reason = "data of the scene, which a run does not store")]
    pub(crate) fn finish(
        &mut self,
        ground: &dyn Ground,
        motion: &dyn FreeField,
        can_open: impl Fn(usize) -> bool,
        scene_warnings: &[Warning],
        pressures_above: &[f64],
        damping_rate: f64,
        rotation_limit: f64,
    ) {
        // A run read from a file is closed and has no elements.
        if self.elements.is_empty() {
            return;
        }
        self.wall = self.wall_start.map_or(Duration::ZERO, |start| start.elapsed());
        self.resolution.sample_ground(ground, motion, self.start..self.end);
        let side_sum: f64 = self.envelope.iter().map(ElementEnvelope::shortest_side).sum();
        let Summary { base_rotation, rotation_across, twist, .. } = &self.whole;
        let rotations = [base_rotation, rotation_across, twist].map(Extremes::magnitude);
        self.warnings = Warning::of_results(
            self.whole.largest_slip.highest.value,
            side_sum / self.envelope.len() as f64,
            rotations.into_iter().fold(0.0, f64::max),
            &self.energy_balance,
            self.smallest_algorithmic_energy,
        );
        for (k, summary) in self.foundations.iter().enumerate() {
            let settlement = summary.settlement.highest.value;
            let ends = self.axes().map(|axis| [summary.ends, summary.depth][axis]);
            let width = ends.fold(f64::INFINITY, |width, [low, high]| width.min(high - low));
            self.warnings.extend(Warning::of_settlement(k, settlement, width));
        }
        self.warnings
            .extend(envelope::tension_warning(&self.envelope, self.in_plan, can_open));
        self.warnings.extend(Warning::of_water(self));
        self.warnings.extend(wall_pressure::wall_warning(&self.envelope, pressures_above));
        self.warnings.extend_from_slice(scene_warnings);
        let is_to_scale = !scene_warnings
            .iter()
            .any(|warning| matches!(warning, Warning::Mistake(Mistake::UnusualSoil { .. })));
        let acceleration = self.resolution.largest_acceleration();
        self.ground_motion = GroundMotion::new(motion, self.end, acceleration);
        if is_to_scale {
            self.warnings.extend(Warning::of_motion(acceleration, &self.ground_motion, motion));
        }
        self.warnings.extend(Warning::of_end(self, acceleration, rotation_limit));
        let mut longest_slip_event: f64 = 0.0;
        for summary in self.foundations.iter().chain([&self.whole]) {
            longest_slip_event = longest_slip_event.max(summary.sliding.longest_duration());
        }
        self.warnings
            .extend(Warning::of_translation_damping(damping_rate, longest_slip_event));
        self.resolution.add_warnings(&mut self.warnings);
        Warning::drop_superseded(&mut self.warnings);
    }

    /// Smallest and largest value of the probe called `name`.
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if no probe has this name.
    pub fn probe(&self, name: &str) -> Result<Extremes> {
        probe_index(&self.probes, name, |probe| &probe.name).map(|k| self.probes[k].extremes)
    }

    /// Axes along the surface: x (0), and in plan y (1).
    pub(crate) fn axes(&self) -> Range<usize> {
        0..1 + usize::from(self.in_plan)
    }

    /// Whether any element of the base belongs to a wall.
    pub(crate) fn has_walls(&self) -> bool {
        ContactElement::any_wall(self.envelope.iter().map(|envelope| &envelope.element))
    }

    /// Relative growth in the last step of a response of [`Warning::RESPONSES_CHECKED_AT_END`].
    pub(crate) fn growth_in_last_step(&self, response_index: usize) -> f64 {
        let final_value = self.final_responses[0][response_index].abs();
        let previous_value = self.final_responses[1][response_index].abs();
        1.0 - previous_value / final_value
    }

    /// Number of slip events of all foundations.
    pub(crate) fn slip_events(&self) -> usize {
        self.foundations.iter().map(|summary| summary.sliding.events.len()).sum()
    }

    /// Whether all limits of serviceability are met; `None` without limits.
    pub fn is_serviceable(&self) -> Option<bool> {
        let checks = &self.serviceability;
        (!checks.is_empty()).then(|| checks.iter().all(ServiceCheck::is_met))
    }

    /// The criterion with the smallest margin; `None` without limits.
    pub(crate) fn check_with_smallest_margin(&self) -> Option<&ServiceCheck> {
        self.serviceability.iter().min_by(|a, b| a.margin().total_cmp(&b.margin()))
    }

    /// The element with the largest pressure, and its pressure, Pa.
    pub fn largest_pressure(&self) -> Option<(&ElementEnvelope, Peak)> {
        self.envelope
            .iter()
            .map(|envelope| (envelope, envelope.pressure.highest))
            .max_by(|a, b| a.1.value.total_cmp(&b.1.value))
    }

    /// Largest gap of any element, m.
    pub fn largest_gap(&self) -> Peak {
        let gaps = self.envelope.iter().map(|envelope| envelope.gap);
        gaps.max_by(|a, b| a.value.total_cmp(&b.value)).unwrap_or_default()
    }
}
