//! Whether time step and elements resolve the motion of a run.
//!
//! A series x sampled every Δt that vibrates with ω changes from step to step by
//!
//! ```text
//! r = (Σ (xₙ₊₁ − xₙ)² / Σ (xₙ₊₁ + xₙ)²)^½ = tan(ω' Δt/2)
//! ```
//!
//! where ω' is the frequency in the samples. The midpoint rule turns a free vibration of frequency ω into one with
//! tan(ω' Δt/2) = ωΔt/2. So r of the base shear gives the true period, π Δt/r, however coarse the step. Two cases
//! differ in their limits:
//!
//! | base shear | because | needs |
//! |---|---|---|
//! | varies more slowly than the ground's acceleration | the structure vibrates freely, and the step lengthens its period | r ≤ 0.25: 12 steps per period |
//! | follows the ground's acceleration | peaks fall between steps | r ≤ 0.6: 5 steps per period |
//!
//! Damping and phase of other frequencies err with the square of the ground's r: it must be at most 0.24, 13 steps per
//! period, or 0.41, 8 steps, if the base shear varies as the ground does (its r within 0.95 and 1.1 of the ground's). At
//! these limits the largest base shear errs by about 5 %.
//!
//! A base shear that varies more than twice as fast as a resolved ground motion contains vibrations of the contact
//! with little mass; they do not count. Without ground motion nothing distinguishes them from others, and the time
//! step is not judged.
//!
//! One element under a foundation has no stiffness in rocking. Two are enough if the base moment is below a tenth of base
//! shear times width, three if it is below half. Waves that run along the base need four elements per wavelength of the
//! shear wave; where the free field is the same everywhere, long elements cause no error. In plan the edge of a rigid
//! mat needs twelve cells per wavelength for any free field, so the narrowest cells of unions count. Steps there also
//! damp rocking that only radiation damps, unless shear waves take four of them across the base. `docs/validation.md`
//! has the runs behind these limits.

use std::f64::consts::PI;
use std::ops::Range;

use crate::bem::Ground;
use crate::coupled::run::foundation_axis::{
    FoundationAxis, MIN_FOUNDATION_ELEMENTS, axes_of, cell_side, longest_side,
};
use crate::coupled::run::variation::{MAX_FREE_VIBRATION_RATIO, Sampler, Variation};
use crate::coupled::run::warning::Warning;
use crate::coupled::state::State;
use crate::geometry::{COMPONENTS_IN_SPACE, axis_name};
use crate::motion::FreeField;

/// Largest r if the base shear follows the ground.
const MAX_FOLLOWING_RATIO: f64 = 0.6;
/// Fraction of the ground's r below which the base shear does not follow it.
const FREE_VIBRATION_FRACTION: f64 = 0.85;
/// Multiple of the ground's r above which vibrations of the contact prevail.
const CONTACT_VIBRATION_FACTOR: f64 = 2.0;
/// Steps per period that a warning recommends for a free vibration.
const FREE_VIBRATION_STEPS: f64 = 30.0;
/// Steps per period that a warning recommends for a base shear that follows the ground.
const FOLLOWING_STEPS: f64 = 15.0;
/// Largest r of the ground, and the recommended one: the largest base shear errs by about 0.9 r².
const MAX_GROUND_RATIO: f64 = 0.236;
const RECOMMENDED_GROUND_RATIO: f64 = 0.183;
/// The same where the base shear varies as the ground does: it errs by about 0.3 r².
const MAX_FOLLOWED_GROUND_RATIO: f64 = 0.408;
const RECOMMENDED_FOLLOWED_GROUND_RATIO: f64 = 0.316;
/// Multiples of the ground's r between which the base shear varies as the ground does.
const FOLLOWING_RATIO_RANGE: [f64; 2] = [0.95, 1.1];
/// Smallest number of steps for an estimate of a frequency.
const MIN_STEPS: usize = 8;
/// Time step above which steps may miss the whole motion of an earthquake, s.
const LONG_TIME_STEP: f64 = 0.1;
/// Base shear, relative to the normal force, that counts as rounding.
const SHEAR_ROUNDING: f64 = 1e-9;
/// Second difference of the free field that counts as rounding, relative to the largest free field so far.
const FREE_FIELD_ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Fineness of strips.
const STRIP_FINENESS: Fineness =
    Fineness { per_wavelength: [4.0, 8.0], without_running: false, crossing_steps: [0.0; 2] };
/// Fineness of cells in plan.
const CELL_FINENESS: Fineness =
    Fineness { per_wavelength: [12.0, 12.0], without_running: true, crossing_steps: [4.0, 8.0] };
/// Numbers of elements and steps that resolve waves: the smallest, and the recommended ones.
#[derive(Debug, Clone, Copy, Default)]
struct Fineness {
    /// Elements per wavelength of the shear wave.
    per_wavelength: [f64; 2],
    /// Whether they are needed also if no wave runs along the base.
    without_running: bool,
    /// Steps in which waves cross a base; zero without a limit.
    crossing_steps: [f64; 2],
}

/// Time step and elements that a run's base shear, ground and foundations require.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(Default))]
pub(crate) struct Resolution {
    /// The time step, s.
    pub(crate) time_step: f64,
    in_plan: bool,
    fineness: Fineness,
    /// Length of the longest element, m. In plan the longer side of a cell.
    longest: f64,
    shear_wave_speed: Option<f64>,
    /// Number of the foundation with the fewest elements, from 0.
    foundation: usize,
    /// Elements, shear and moment of the foundation along x, and in plan along y.
    axes: [FoundationAxis; 2],
    steps: usize,
    last_step: usize,
    last_shear: [f64; 2],
    /// Mean free field at the last two steps, and its last second difference.
    free_field: [[f64; COMPONENTS_IN_SPACE]; 2],
    acceleration: [f64; COMPONENTS_IN_SPACE],
    /// Largest component of the free field's second difference, m, after the first steps.
    peak: f64,
    /// Largest |free field| so far.
    largest: [f64; COMPONENTS_IN_SPACE],
    /// Number of consecutive steps so far.
    in_a_row: usize,
    base_shear: Variation,
    ground: Variation,
    normal_force: f64,
    samples: GroundSamples,
    /// Whether the ground's motion between the steps decides, whatever it is at the steps.
    is_judged_by_ground: bool,
}

/// Mean free field along x, upwards and along y.
fn free_field(state: &State) -> [f64; COMPONENTS_IN_SPACE] {
    [state.free_field[0], state.free_field[1], state.free_field_across]
}

/// Properties of the ground motion, from samples between the steps.
#[derive(Debug, Clone, Copy, Default)]
struct GroundSamples {
    /// Frequency of the acceleration, Hz.
    frequency: Option<f64>,
    /// Whether waves run along the base.
    running: bool,
}

impl Resolution {
    pub(crate) fn new(time_step: f64, shear_wave_speed: Option<f64>, state: &State) -> Self {
        let elements = &state.context.elements;
        let in_plan = elements.is_plan();
        let longest = if in_plan {
            cell_side(elements, 0).max(cell_side(elements, 1))
        } else {
            longest_side(elements, 0)
        };
        let fineness = if in_plan { CELL_FINENESS } else { STRIP_FINENESS };
        let foundations = state.foundations.iter().map(|shape| axes_of(shape, elements));
        let coarsest = foundations
            .enumerate()
            .min_by_key(|(_, axes)| axes[0].elements.min(axes[1].elements));
        let (foundation, axes) = coarsest.unwrap_or_default();
        Self {
            time_step,
            in_plan,
            fineness,
            longest,
            shear_wave_speed,
            foundation,
            axes,
            steps: 0,
            last_step: state.step,
            last_shear: [0.0; 2],
            free_field: [free_field(state); 2],
            acceleration: [0.0; COMPONENTS_IN_SPACE],
            peak: 0.0,
            largest: free_field(state).map(f64::abs),
            in_a_row: 0,
            base_shear: Variation::default(),
            ground: Variation::default(),
            normal_force: state.normal_force.abs(),
            samples: GroundSamples::default(),
            is_judged_by_ground: false,
        }
    }

    /// Adds the next step to the statistics.
    pub(crate) fn update(&mut self, state: &State) {
        self.in_a_row = if state.step == self.last_step + 1 { self.in_a_row + 1 } else { 0 };
        self.last_step = state.step;
        self.steps += 1;
        self.normal_force = self.normal_force.max(state.normal_force.abs());
        if let Some(foundation) = state.foundations.get(self.foundation) {
            self.axes[0].update(foundation.base_shear, foundation.base_moment);
            self.axes[1].update(foundation.shear_across, foundation.moment_across);
        }
        let across = state.foundations.iter().map(|foundation| foundation.shear_across).sum();
        let shear = [state.base_shear, across];
        if self.in_a_row > 1 {
            for (before, after) in self.last_shear.into_iter().zip(shear) {
                self.base_shear.update(before, after);
            }
        }
        let now = free_field(state);
        let [before, last] = self.free_field;
        for k in 0..COMPONENTS_IN_SPACE {
            let mut acceleration = now[k] - 2.0 * last[k] + before[k];
            self.largest[k] = self.largest[k].max(now[k].abs());
            if acceleration.abs() <= FREE_FIELD_ROUNDING * self.largest[k] {
                acceleration = 0.0;
            }
            if self.in_a_row > 2 {
                self.ground.update(self.acceleration[k], acceleration);
                self.peak = self.peak.max(acceleration.abs());
            }
            self.acceleration[k] = acceleration;
        }
        self.free_field = [last, now];
        self.last_shear = shear;
    }

    /// Largest component of the ground's acceleration, m/s².
    pub(crate) fn largest_acceleration(&self) -> f64 {
        self.peak / self.time_step.powi(2)
    }

    /// Whether the base shear is more than rounding, in enough steps.
    fn has_response(&self) -> bool {
        let rounding = SHEAR_ROUNDING * self.normal_force;
        self.steps >= MIN_STEPS
            && self.base_shear.sums + self.base_shear.changes
                > self.steps as f64 * rounding * rounding
    }

    /// Whether the base shear varies more slowly than the ground.
    fn is_free_vibration(&self) -> bool {
        self.base_shear.ratio() < FREE_VIBRATION_FRACTION * self.ground.ratio()
    }

    /// Whether the time step may not resolve the base shear.
    fn is_coarse(&self) -> bool {
        let limit =
            if self.is_free_vibration() { MAX_FREE_VIBRATION_RATIO } else { MAX_FOLLOWING_RATIO };
        self.has_response() && self.base_shear.ratio() > limit
    }

    /// Whether the time step is too long for the ground's acceleration.
    fn is_coarse_for_ground(&self) -> bool {
        let limit = if self.follows() { MAX_FOLLOWED_GROUND_RATIO } else { MAX_GROUND_RATIO };
        self.ground.ratio() > limit
    }

    /// Whether the base shear varies as the ground does.
    fn follows(&self) -> bool {
        let ground = self.ground.ratio();
        let range = FOLLOWING_RATIO_RANGE.map(|multiple| multiple * ground);
        (range[0]..range[1]).contains(&self.base_shear.ratio())
    }

    /// Wavelength of shear waves at the frequency of the base shear, without vibrations of the contact, m.
    ///
    /// `None` if the steps do not resolve the motion.
    fn wavelength(&self) -> Option<f64> {
        let ratio = self.base_shear.ratio().min(self.ground.ratio());
        let wavelength = self.shear_wave_speed? * PI * self.time_step / ratio;
        (self.has_response() && ratio <= MAX_FOLLOWING_RATIO).then_some(wavelength)
    }

    /// Wavelength of the base shear if elements are too long for it, m.
    fn short_waves(&self) -> Option<f64> {
        self.wavelength()
            .filter(|length| *length < self.fineness.per_wavelength[0] * self.longest)
    }

    /// Adds warnings of motion that time step and elements do not resolve.
    pub(crate) fn warn(&self, warnings: &mut Vec<Warning>) {
        // At the steps a motion of about one period a step appears as a slow one.
        if self.is_judged_by_ground
            && !self.is_coarse()
            && let Some(frequency) = self.samples.frequency
        {
            warnings.extend(self.unresolved_motion(frequency));
        }
        if !self.has_response() {
            return;
        }
        if self.is_coarse() || self.is_coarse_for_ground() {
            self.warn_of_step(warnings);
        }
        let time_step = self.time_step;
        let width = self.axes[0].width.min(self.axes[1].width);
        let crossing = self.shear_wave_speed.map_or(f64::INFINITY, |speed| width / speed);
        let [fewest, recommended] = self.fineness.crossing_steps;
        if crossing < fewest * time_step && !self.follows() {
            let needed = crossing / recommended;
            warnings.push(Warning::UnresolvedRadiation { crossing, time_step, needed });
        }
        self.warn_of_elements(warnings);
    }

    /// Warning of a ground motion of this frequency (Hz) if the time step does not resolve it.
    fn unresolved_motion(&self, frequency: f64) -> Option<Warning> {
        let time_step = self.time_step;
        let needed = 1.0 / (FOLLOWING_STEPS * frequency);
        let is_missed = PI * frequency * time_step > MAX_FOLLOWING_RATIO;
        is_missed.then_some(Warning::UnresolvedMotion { frequency, time_step, needed })
    }

    /// Adds warnings of a time step that does not resolve the base shear.
    fn warn_of_step(&self, warnings: &mut Vec<Warning>) {
        let time_step = self.time_step;
        let response = self.base_shear.ratio();
        let ground = self.ground.ratio();
        let frequency = self.samples.frequency.unwrap_or(ground / (PI * time_step));
        let is_coarse = self.is_coarse();
        let missed_motion = self.unresolved_motion(frequency).filter(|_| is_coarse);
        let is_free = self.is_free_vibration();
        if is_free || missed_motion.is_none() && response < CONTACT_VIBRATION_FACTOR * ground {
            let period = PI * time_step / response;
            let needed = match (is_coarse, is_free, self.follows()) {
                (true, true, _) => period / FREE_VIBRATION_STEPS,
                (true, false, _) => period / FOLLOWING_STEPS,
                (false, _, true) => time_step * RECOMMENDED_FOLLOWED_GROUND_RATIO / ground,
                (false, _, false) => time_step * RECOMMENDED_GROUND_RATIO / ground,
            };
            warnings.push(Warning::UnresolvedPeriod { period, time_step, needed });
        }
        warnings.extend(missed_motion);
    }

    /// Adds warnings of too few or too long elements.
    fn warn_of_elements(&self, warnings: &mut Vec<Warning>) {
        // A foundation on springs needs two elements at most.
        let is_on_springs = self.shear_wave_speed.is_none();
        for (number, axis) in self.axes.iter().enumerate() {
            let needed =
                if is_on_springs { MIN_FOUNDATION_ELEMENTS } else { axis.needed_elements() };
            if axis.elements < needed {
                warnings.push(Warning::FewElements {
                    foundation: self.foundation,
                    elements: axis.elements,
                    needed,
                    axis: axis_name(self.in_plan, number),
                });
                break;
            }
        }
        let wavelength_counts = self.fineness.without_running || self.samples.running;
        if let Some(wavelength) = self.short_waves().filter(|_| wavelength_counts) {
            let element_length = self.longest;
            let needed = wavelength / self.fineness.per_wavelength[1];
            warnings.push(Warning::LongElements { element_length, wavelength, needed });
        }
    }

    /// Samples the ground between the steps in `times` (s) if the steps may have missed a faster motion.
    ///
    /// At the steps a faster motion appears as a slower one.
    pub(crate) fn resolve_ground(
        &mut self,
        ground: &dyn Ground,
        motion: &dyn FreeField,
        times: Range<f64>,
    ) {
        let is_short_run =
            times.start == 0.0 && self.steps < MIN_STEPS && motion.records().is_empty();
        self.is_judged_by_ground = is_short_run || self.time_step > LONG_TIME_STEP;
        if self.is_judged_by_ground || self.is_coarse() || self.short_waves().is_some() {
            let sampler = Sampler { ground, motion, times, time_step: self.time_step };
            self.samples =
                GroundSamples { frequency: sampler.frequency(), running: sampler.is_running() };
        }
    }
}
