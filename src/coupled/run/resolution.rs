//! Whether time step and elements resolve the motion in a run.
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
//! with little mass, which need not be resolved. Without ground motion they cannot be distinguished from other
//! vibrations, and the time step is not checked.
//!
//! One element under a foundation has no stiffness in rocking. Two are enough if the base moment is below a tenth of base
//! shear times width, three if it is below half. Waves that run along the base need four elements per wavelength of the
//! shear wave; where the free field is the same everywhere, long elements cause no error. In plan the edge of a rigid
//! mat needs twelve cells per wavelength for any free field, so the check uses the cells of which elements are unions.
//! In plan, time steps also add damping to rocking that only radiation damps, unless shear waves take at least four steps
//! to cross the base. `docs/validation.md` has the runs behind these limits.

use std::f64::consts::PI;
use std::ops::Range;

use crate::bem::Ground;
use crate::coupled::run::foundation_axis::{
    FoundationAxis, MIN_FOUNDATION_ELEMENTS, cell_side, foundation_axes, longest_side,
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
/// Recommended number of steps per period of a free vibration.
const FREE_VIBRATION_STEPS_PER_PERIOD: f64 = 30.0;
/// Recommended number of steps per period if the base shear follows the ground.
const FOLLOWING_STEPS_PER_PERIOD: f64 = 15.0;
/// Largest r of the ground.
///
/// The largest base shear then has an error of about 0.9 r² = 5 %.
const MAX_GROUND_RATIO: f64 = 0.236;
/// Recommended r of the ground, for an error of 3 %.
const RECOMMENDED_GROUND_RATIO: f64 = 0.183;
/// Largest r of the ground if the base shear varies as the ground does.
///
/// The error is then about 0.3 r² = 5 %.
const MAX_FOLLOWED_GROUND_RATIO: f64 = 0.408;
/// Recommended r of the ground if the base shear varies with it, for 3 % error.
const RECOMMENDED_FOLLOWED_GROUND_RATIO: f64 = 0.316;
/// Multiples of the ground's r between which the base shear varies as the ground does.
const FOLLOWING_RATIO_RANGE: [f64; 2] = [0.95, 1.1];
/// Smallest number of steps for an estimate of a frequency.
const MIN_SAMPLED_STEPS: usize = 8;
/// Time step above which steps may not sample the motion of an earthquake, s.
const LONG_TIME_STEP: f64 = 0.1;
/// Base shear that is due to rounding, relative to the normal force.
const SHEAR_ROUNDING: f64 = 1e-9;
/// Second difference of the free field that counts as rounding.
///
/// It is relative to the largest free field so far.
const FREE_FIELD_ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Fineness that elements in the plane need.
const STRIP_FINENESS: Fineness = Fineness {
    per_wavelength: [4.0, 8.0],
    is_needed_without_waves: false,
    crossing_steps: [0.0; 2],
};
/// Fineness that cells in plan need.
const CELL_FINENESS: Fineness = Fineness {
    per_wavelength: [12.0, 12.0],
    is_needed_without_waves: true,
    crossing_steps: [4.0, 8.0],
};

/// Numbers of elements and steps that resolve waves: the smallest, and the recommended ones.
#[derive(Debug, Clone, Copy, Default)]
struct Fineness {
    /// Elements per wavelength of the shear wave.
    per_wavelength: [f64; 2],
    /// Whether the elements are needed even if no wave runs along the base.
    is_needed_without_waves: bool,
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
    max_element_length: f64,
    shear_wave_speed: Option<f64>,
    /// Index of the foundation with the fewest elements.
    foundation_index: usize,
    /// Elements, shear and moment of the foundation along x, and in plan along y.
    axes: [FoundationAxis; 2],
    step_count: usize,
    /// Number of the previous step in the simulation.
    previous_step: usize,
    previous_shear: [f64; 2],
    /// Mean free field at the step before the previous one, and at the previous one, m.
    previous_fields: [[f64; COMPONENTS_IN_SPACE]; 2],
    /// Second difference of these fields and the field before them, m.
    second_difference: [f64; COMPONENTS_IN_SPACE],
    /// Largest component of the free field's second difference, m, after the first steps.
    max_second_difference: f64,
    /// Largest |free field| so far, m.
    max_free_field: [f64; COMPONENTS_IN_SPACE],
    /// Number of steps since the last step that was not recorded.
    consecutive_steps: usize,
    base_shear: Variation,
    ground: Variation,
    /// Largest normal force so far, N (in the plane N/m).
    max_normal_force: f64,
    samples: GroundSamples,
    /// Whether samples of the ground between the steps decide, instead of values at the steps.
    is_judged_by_samples: bool,
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
    has_running_waves: bool,
}

impl Resolution {
    pub(crate) fn new(time_step: f64, shear_wave_speed: Option<f64>, state: &State) -> Self {
        let elements = &state.context.elements;
        let in_plan = elements.is_plan();
        let max_element_length = if in_plan {
            cell_side(elements, 0).max(cell_side(elements, 1))
        } else {
            longest_side(elements, 0)
        };
        let fineness = if in_plan { CELL_FINENESS } else { STRIP_FINENESS };
        let axes_of_all =
            state.foundations.iter().map(|foundation| foundation_axes(foundation, elements));
        let coarsest = axes_of_all
            .enumerate()
            .min_by_key(|(_, axes)| axes[0].element_count.min(axes[1].element_count));
        let (foundation_index, axes) = coarsest.unwrap_or_default();
        Self {
            time_step,
            in_plan,
            fineness,
            max_element_length,
            shear_wave_speed,
            foundation_index,
            axes,
            step_count: 0,
            previous_step: state.step,
            previous_shear: [0.0; 2],
            previous_fields: [free_field(state); 2],
            second_difference: [0.0; COMPONENTS_IN_SPACE],
            max_second_difference: 0.0,
            max_free_field: free_field(state).map(f64::abs),
            consecutive_steps: 0,
            base_shear: Variation::default(),
            ground: Variation::default(),
            max_normal_force: state.normal_force.abs(),
            samples: GroundSamples::default(),
            is_judged_by_samples: false,
        }
    }

    /// Adds the next step to the statistics.
    pub(crate) fn update(&mut self, state: &State) {
        let is_consecutive = state.step == self.previous_step + 1;
        self.consecutive_steps = if is_consecutive { self.consecutive_steps + 1 } else { 0 };
        self.previous_step = state.step;
        self.step_count += 1;
        self.max_normal_force = self.max_normal_force.max(state.normal_force.abs());
        if let Some(foundation) = state.foundations.get(self.foundation_index) {
            self.axes[0].update(foundation.base_shear, foundation.base_moment);
            self.axes[1].update(foundation.shear_across, foundation.moment_across);
        }
        let shear_across = state.foundations.iter().map(|foundation| foundation.shear_across).sum();
        let shear = [state.base_shear, shear_across];
        if self.consecutive_steps > 1 {
            for (previous, current) in self.previous_shear.into_iter().zip(shear) {
                self.base_shear.update(previous, current);
            }
        }
        let current_field = free_field(state);
        let [earlier_field, previous_field] = self.previous_fields;
        for k in 0..COMPONENTS_IN_SPACE {
            let mut difference = current_field[k] - 2.0 * previous_field[k] + earlier_field[k];
            self.max_free_field[k] = self.max_free_field[k].max(current_field[k].abs());
            if difference.abs() <= FREE_FIELD_ROUNDING * self.max_free_field[k] {
                difference = 0.0;
            }
            if self.consecutive_steps > 2 {
                self.ground.update(self.second_difference[k], difference);
                self.max_second_difference = self.max_second_difference.max(difference.abs());
            }
            self.second_difference[k] = difference;
        }
        self.previous_fields = [previous_field, current_field];
        self.previous_shear = shear;
    }

    /// Largest component of the ground's acceleration, m/s².
    pub(crate) fn largest_acceleration(&self) -> f64 {
        self.max_second_difference / self.time_step.powi(2)
    }

    /// Whether the base shear exceeds rounding errors, in enough steps for an estimate.
    fn has_response(&self) -> bool {
        let rounding = SHEAR_ROUNDING * self.max_normal_force;
        self.step_count >= MIN_SAMPLED_STEPS
            && self.base_shear.sums + self.base_shear.changes
                > self.step_count as f64 * rounding * rounding
    }

    /// Whether the base shear varies more slowly than the ground.
    fn is_free_vibration(&self) -> bool {
        self.base_shear.ratio() < FREE_VIBRATION_FRACTION * self.ground.ratio()
    }

    /// Whether the time step may not resolve the base shear.
    fn is_coarse_for_shear(&self) -> bool {
        let limit =
            if self.is_free_vibration() { MAX_FREE_VIBRATION_RATIO } else { MAX_FOLLOWING_RATIO };
        self.has_response() && self.base_shear.ratio() > limit
    }

    /// Whether the time step is too long for the ground's acceleration.
    fn is_coarse_for_ground(&self) -> bool {
        let limit =
            if self.follows_ground() { MAX_FOLLOWED_GROUND_RATIO } else { MAX_GROUND_RATIO };
        self.ground.ratio() > limit
    }

    /// Whether the base shear varies as the ground does.
    fn follows_ground(&self) -> bool {
        let ground_ratio = self.ground.ratio();
        let [low, high] = FOLLOWING_RATIO_RANGE.map(|multiple| multiple * ground_ratio);
        (low..high).contains(&self.base_shear.ratio())
    }

    /// Wavelength of shear waves at the frequency of the base shear, m.
    ///
    /// Vibrations of the contact are excluded. `None` if the steps do not resolve the motion.
    fn wavelength(&self) -> Option<f64> {
        let ratio = self.base_shear.ratio().min(self.ground.ratio());
        let wavelength = self.shear_wave_speed? * PI * self.time_step / ratio;
        (self.has_response() && ratio <= MAX_FOLLOWING_RATIO).then_some(wavelength)
    }

    /// Wavelength of the base shear, m.
    ///
    /// `None` unless it is too short for the elements.
    fn short_wavelength(&self) -> Option<f64> {
        self.wavelength()
            .filter(|length| *length < self.fineness.per_wavelength[0] * self.max_element_length)
    }

    /// Adds warnings of motion that time step and elements do not resolve.
    pub(crate) fn add_warnings(&self, warnings: &mut Vec<Warning>) {
        // Aliasing: samples at steps of about one period show a slow motion.
        if self.is_judged_by_samples
            && !self.is_coarse_for_shear()
            && let Some(frequency) = self.samples.frequency
        {
            warnings.extend(self.unresolved_motion(frequency));
        }
        if !self.has_response() {
            return;
        }
        if self.is_coarse_for_shear() || self.is_coarse_for_ground() {
            self.add_step_warnings(warnings);
        }
        let time_step = self.time_step;
        let width = self.axes[0].width.min(self.axes[1].width);
        let crossing = self.shear_wave_speed.map_or(f64::INFINITY, |speed| width / speed);
        let [min_steps, recommended_steps] = self.fineness.crossing_steps;
        if crossing < min_steps * time_step && !self.follows_ground() {
            let needed = crossing / recommended_steps;
            warnings.push(Warning::UnresolvedRadiation { crossing, time_step, needed });
        }
        self.add_element_warnings(warnings);
    }

    /// Warning of a ground motion of this frequency (Hz) if the time step does not resolve it.
    fn unresolved_motion(&self, frequency: f64) -> Option<Warning> {
        let time_step = self.time_step;
        let needed = 1.0 / (FOLLOWING_STEPS_PER_PERIOD * frequency);
        let is_unresolved = PI * frequency * time_step > MAX_FOLLOWING_RATIO;
        is_unresolved.then_some(Warning::UnresolvedMotion { frequency, time_step, needed })
    }

    /// Adds warnings of a time step that does not resolve the base shear or the ground motion.
    fn add_step_warnings(&self, warnings: &mut Vec<Warning>) {
        let time_step = self.time_step;
        let shear_ratio = self.base_shear.ratio();
        let ground_ratio = self.ground.ratio();
        let frequency = self.samples.frequency.unwrap_or(ground_ratio / (PI * time_step));
        let is_coarse = self.is_coarse_for_shear();
        let motion_warning = self.unresolved_motion(frequency).filter(|_| is_coarse);
        let is_free = self.is_free_vibration();
        // NaN without ground motion: the comparison is then false.
        let is_below_contact_vibration = shear_ratio < CONTACT_VIBRATION_FACTOR * ground_ratio;
        if is_free || motion_warning.is_none() && is_below_contact_vibration {
            let period = PI * time_step / shear_ratio;
            let needed = match (is_coarse, is_free, self.follows_ground()) {
                (true, true, _) => period / FREE_VIBRATION_STEPS_PER_PERIOD,
                (true, false, _) => period / FOLLOWING_STEPS_PER_PERIOD,
                (false, _, true) => time_step * RECOMMENDED_FOLLOWED_GROUND_RATIO / ground_ratio,
                (false, _, false) => time_step * RECOMMENDED_GROUND_RATIO / ground_ratio,
            };
            warnings.push(Warning::UnresolvedPeriod { period, time_step, needed });
        }
        warnings.extend(motion_warning);
    }

    /// Adds warnings of too few or too long elements.
    fn add_element_warnings(&self, warnings: &mut Vec<Warning>) {
        // A foundation on springs needs two elements at most.
        let is_on_springs = self.shear_wave_speed.is_none();
        for (axis_index, axis) in self.axes.iter().enumerate() {
            let needed =
                if is_on_springs { MIN_FOUNDATION_ELEMENTS } else { axis.needed_elements() };
            if axis.element_count < needed {
                warnings.push(Warning::FewElements {
                    foundation: self.foundation_index,
                    elements: axis.element_count,
                    needed,
                    axis: axis_name(self.in_plan, axis_index),
                });
                break;
            }
        }
        let must_resolve_waves =
            self.fineness.is_needed_without_waves || self.samples.has_running_waves;
        if let Some(wavelength) = self.short_wavelength().filter(|_| must_resolve_waves) {
            let element_length = self.max_element_length;
            let needed = wavelength / self.fineness.per_wavelength[1];
            warnings.push(Warning::LongElements { element_length, wavelength, needed });
        }
    }

    /// Samples the ground motion between the steps if the steps may not resolve it.
    ///
    /// `times`: start and end of the run, s. Values at the steps alone show a fast motion as a slow one.
    pub(crate) fn sample_ground(
        &mut self,
        ground: &dyn Ground,
        motion: &dyn FreeField,
        times: Range<f64>,
    ) {
        let is_short_run = times.start == 0.0
            && self.step_count < MIN_SAMPLED_STEPS
            && motion.records().is_empty();
        self.is_judged_by_samples = is_short_run || self.time_step > LONG_TIME_STEP;
        if self.is_judged_by_samples
            || self.is_coarse_for_shear()
            || self.short_wavelength().is_some()
        {
            let sampler = Sampler { ground, motion, times, time_step: self.time_step };
            self.samples = GroundSamples {
                frequency: sampler.frequency(),
                has_running_waves: sampler.has_running_waves(),
            };
        }
    }
}
