//! Whether time step and elements resolve what a run has seen.
//!
//! A series x sampled every Δt that vibrates with ω changes from step to step by
//!
//! ```text
//! r = (Σ (xₙ₊₁ − xₙ)² / Σ (xₙ₊₁ + xₙ)²)^½ = tan(ω' Δt/2)
//! ```
//!
//! where ω' is the frequency in the samples. The midpoint rule turns a free vibration of frequency ω
//! into one with tan(ω' Δt/2) = ωΔt/2, so that r of the base shear gives back the true period, π Δt/r,
//! however coarse the step. Two cases differ in what they need:
//!
//! | base shear | because | needs |
//! |---|---|---|
//! | varies more slowly than the ground's acceleration | the structure vibrates with a period of its own, which the step lengthens | r ≤ 0.25: 12 steps per period |
//! | follows the ground's acceleration | peaks fall between steps | r ≤ 0.6: 5 steps per period |
//!
//! A base shear that varies more than twice as fast as a ground that is resolved rings with vibrations
//! of the contact that carry little mass; they do not count. Without ground motion nothing tells them
//! from others, and the time step is not judged.
//!
//! The largest base shear errs by the square of the step. With r of the ground's acceleration for a
//! measure of the step, the error is estimated as 0.3 r² where the base shear varies as the ground does
//! (its r within 0.95 and 1.1 of the ground's) and 0.9 r² elsewhere, and runs warn from 5 % on even
//! within the limits above.
//!
//! Measured with 108 scenes at six steps from 3 to 100 ms (rigid blocks, shear buildings, walls of finite
//! elements; c_S 120 to 600 m/s; bonded and with friction 0.5; El Centro and Ricker pulses of 1 and 3 Hz), against
//! halved steps down to 1.6 ms, extrapolated (Richardson). Where it is more than 3 %, the estimate is half
//! the error or more in nine cases of ten, within a factor of three in three of four; at the worst the error is 7.5 times as
//! large: in lightly damped rocking, whose radiation the steps overestimate. Of 579 runs with r below one 213 warn
//! (13 of them err by less than 2 %, 42 by less than 5 %), 13 that err by more than 10 % do not, nor 6 beyond
//! 15 %. Half the step tells what no estimate does.
//!
//! For elements, on the half-plane with 1 to 24 elements: one under a foundation has no stiffness in
//! rocking (series off by 28 to 104 %), two are off by 16 to 123 %, three by 16 to 97 % where the base
//! moment exceeds half of base shear times width. Waves that run along the base need four elements per
//! wavelength of the shear wave; where the free field is the same everywhere, long elements do no harm.

use std::f64::consts::PI;
use std::ops::Range;

use super::state::State;
use super::warning::Warning;
use crate::bem::{ContactElement, Ground};
use crate::geometry::{ContactLayout, SPACE};
use crate::motion::FreeField;

/// Largest r where the structure vibrates with a period of its own.
const OWN: f64 = 0.25;
/// Largest r where the base shear follows the ground.
const FOLLOWING: f64 = 0.6;
/// Share of the ground's r below which the base shear does not follow it.
const SLOWER: f64 = 0.85;
/// Multiple of the ground's r above which the base shear rings.
const RINGING: f64 = 2.0;
/// Steps per period that are asked for, in the two cases.
const OWN_STEPS: f64 = 30.0;
const FOLLOWING_STEPS: f64 = 15.0;
/// Error of the largest base shear over r² of the ground: of one that varies as the ground does,
/// within these multiples of its r, and of others.
const ERROR_FOLLOWING: f64 = 0.3;
const AS_THE_GROUND: [f64; 2] = [0.95, 1.1];
const ERROR: f64 = 0.9;
/// Estimated error that calls for a warning, and the one that is asked for.
const ERRORS: [f64; 2] = [0.05, 0.03];
/// Fewest steps that tell a frequency.
const LEAST_STEPS: usize = 8;
/// Base shear that is rounding, relative to the normal force.
const ROUNDING: f64 = 1e-9;
/// Elements per wavelength of the shear wave: fewest, and those that are asked for.
const PER_WAVELENGTH: [f64; 2] = [4.0, 8.0];
/// Fewest elements under a foundation by its base moment over base shear times width; below the
/// last, rocking does not matter.
const ELEMENTS: [(f64, usize); 2] = [(0.5, 4), (0.1, 3)];
/// Elements that any foundation needs: one takes no moment, so that none is seen.
const TWO: usize = 2;
/// Square of the free field's difference between the ends of the base, relative to its own, of waves
/// that run along it.
const RUNNING: f64 = 0.1;
/// Instants at which the ground is asked again, and how often their distance is halved.
const INSTANTS: usize = 256;
const HALVINGS: usize = 12;

/// Sums of squares of the changes and of the sums of neighbouring samples.
#[derive(Debug, Clone, Copy, Default)]
struct Variation {
    changes: f64,
    sums: f64,
}

impl Variation {
    fn see(&mut self, before: f64, after: f64) {
        self.changes += (after - before).powi(2);
        self.sums += (after + before).powi(2);
    }

    /// r; NaN for a series of zeros.
    fn ratio(self) -> f64 {
        (self.changes / self.sums).sqrt()
    }
}

/// Time step and elements that base shear, ground and foundations of a run require.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(Default))]
pub(crate) struct Resolution {
    time_step: f64,
    /// Longest element, m.
    longest: f64,
    shear_wave_speed: Option<f64>,
    /// The foundation with the fewest elements.
    foundation: usize,
    elements: usize,
    width: f64,
    static_moment: f64,
    /// Its largest shear and change of moment.
    shear: f64,
    moment: f64,
    steps: usize,
    last_step: usize,
    last_shear: f64,
    /// Mean free field at the last two steps, and its last second difference.
    free_field: [[f64; 2]; 2],
    acceleration: [f64; 2],
    /// Steps seen without a gap.
    in_a_row: usize,
    base_shear: Variation,
    ground: Variation,
    normal_force: f64,
    samples: GroundSamples,
}

/// Findings from samples of the ground between the steps.
#[derive(Debug, Clone, Copy, Default)]
struct GroundSamples {
    /// Frequency of its acceleration, Hz.
    frequency: Option<f64>,
    /// Whether waves run along the base.
    running: bool,
}

impl Resolution {
    pub(crate) fn new(
        time_step: f64,
        elements: &[ContactElement],
        shear_wave_speed: Option<f64>,
        state: &State,
    ) -> Self {
        let mut resolution = Self {
            time_step,
            longest: elements.iter().map(ContactElement::length).fold(0.0, f64::max),
            shear_wave_speed,
            foundation: 0,
            elements: usize::MAX,
            width: 0.0,
            static_moment: 0.0,
            shear: 0.0,
            moment: 0.0,
            steps: 0,
            last_step: state.step,
            last_shear: 0.0,
            free_field: [state.free_field; 2],
            acceleration: [0.0; 2],
            in_a_row: 0,
            base_shear: Variation::default(),
            ground: Variation::default(),
            normal_force: state.normal_force.abs(),
            samples: GroundSamples::default(),
        };
        for (k, foundation) in state.foundations.iter().enumerate() {
            let own = &elements[foundation.elements.clone()];
            if own.len() < resolution.elements {
                resolution.foundation = k;
                resolution.elements = own.len();
                resolution.width = own.iter().map(ContactElement::length).sum();
                resolution.static_moment = foundation.base_moment;
            }
        }
        resolution
    }

    /// Takes in the next step.
    pub(crate) fn see(&mut self, state: &State) {
        self.in_a_row = if state.step == self.last_step + 1 { self.in_a_row + 1 } else { 0 };
        self.last_step = state.step;
        self.steps += 1;
        self.normal_force = self.normal_force.max(state.normal_force.abs());
        if let Some(foundation) = state.foundations.get(self.foundation) {
            self.shear = self.shear.max(foundation.base_shear.abs());
            self.moment = self.moment.max((foundation.base_moment - self.static_moment).abs());
        }
        if self.in_a_row > 1 {
            self.base_shear.see(self.last_shear, state.base_shear);
        }
        let [before, last] = self.free_field;
        for k in 0..2 {
            let acceleration = state.free_field[k] - 2.0 * last[k] + before[k];
            if self.in_a_row > 2 {
                self.ground.see(self.acceleration[k], acceleration);
            }
            self.acceleration[k] = acceleration;
        }
        self.free_field = [last, state.free_field];
        self.last_shear = state.base_shear;
    }

    /// Whether a base shear that means anything was seen.
    fn has_response(&self) -> bool {
        let rounding = ROUNDING * self.normal_force;
        self.steps >= LEAST_STEPS
            && self.base_shear.sums + self.base_shear.changes
                > self.steps as f64 * rounding * rounding
    }

    /// Whether the base shear varies more slowly than the ground.
    fn is_own_vibration(&self) -> bool {
        self.base_shear.ratio() < SLOWER * self.ground.ratio()
    }

    /// Whether the time step may miss what the base shear does.
    fn is_coarse(&self) -> bool {
        let limit = if self.is_own_vibration() { OWN } else { FOLLOWING };
        self.has_response() && self.base_shear.ratio() > limit
    }

    /// Estimated relative error of the largest base shear by the time step, one at most.
    fn error(&self) -> f64 {
        let [response, ground] = [self.base_shear, self.ground].map(Variation::ratio);
        let [low, high] = AS_THE_GROUND.map(|share| share * ground);
        let follows = (low..high).contains(&response);
        let factor = if follows { ERROR_FOLLOWING } else { ERROR };
        (factor * ground * ground).min(1.0)
    }

    /// Wavelength of shear waves at the frequency of the base shear, its ringing left out, m. Steps
    /// that miss the motion leave no frequency to go by.
    fn wavelength(&self) -> Option<f64> {
        let ratio = self.base_shear.ratio().min(self.ground.ratio());
        let wavelength = self.shear_wave_speed? * PI * self.time_step / ratio;
        (self.has_response() && ratio <= FOLLOWING).then_some(wavelength)
    }

    /// That wavelength where elements are too long for it.
    fn short_waves(&self) -> Option<f64> {
        self.wavelength().filter(|length| *length < PER_WAVELENGTH[0] * self.longest)
    }

    /// Adds what steps and elements have missed.
    pub(crate) fn warn(&self, warnings: &mut Vec<Warning>) {
        if !self.has_response() {
            return;
        }
        let time_step = self.time_step;
        let (is_coarse, error) = (self.is_coarse(), self.error());
        if is_coarse || error > ERRORS[0] {
            let [response, ground] = [self.base_shear, self.ground].map(Variation::ratio);
            let frequency = self.samples.frequency.unwrap_or(ground / (PI * time_step));
            let misses_motion = is_coarse && PI * frequency * time_step > FOLLOWING;
            let is_own = self.is_own_vibration();
            if is_own || !misses_motion && response < RINGING * ground {
                let period = PI * time_step / response;
                let needed = match (is_coarse, is_own) {
                    (true, true) => period / OWN_STEPS,
                    (true, false) => period / FOLLOWING_STEPS,
                    (false, _) => time_step * (ERRORS[1] / error).sqrt(),
                };
                warnings.push(Warning::UnresolvedPeriod { period, time_step, needed, error });
            }
            if misses_motion {
                let needed = 1.0 / (FOLLOWING_STEPS * frequency);
                warnings.push(Warning::UnresolvedMotion { frequency, time_step, needed, error });
            }
        }
        if self.shear_wave_speed.is_none() {
            return;
        }
        let arm = self.moment / (self.shear * self.width);
        let rocking = ELEMENTS.iter().find(|(least, _)| self.elements < TWO || arm > *least);
        let needed = rocking.map_or(TWO, |(_, needed)| *needed);
        if self.elements < needed {
            let (foundation, elements) = (self.foundation, self.elements);
            warnings.push(Warning::FewElements { foundation, elements, needed });
        }
        if let Some(wavelength) = self.short_waves().filter(|_| self.samples.running) {
            let (element_length, needed) = (self.longest, wavelength / PER_WAVELENGTH[1]);
            warnings.push(Warning::LongElements { element_length, wavelength, needed });
        }
    }

    /// Samples the ground between steps that may have missed something in `times` (s): what they
    /// see of a faster motion is aliased.
    pub(crate) fn resolve_ground(
        &mut self,
        ground: &dyn Ground,
        motion: &dyn FreeField,
        times: Range<f64>,
    ) {
        if self.is_coarse() || self.short_waves().is_some() {
            let sampler = Sampler { ground, motion, times, time_step: self.time_step };
            let (frequency, running) = (sampler.frequency(), sampler.is_running());
            self.samples = GroundSamples { frequency, running };
        }
    }
}

/// The ground's motion at instants spread over a run.
struct Sampler<'a> {
    ground: &'a dyn Ground,
    motion: &'a dyn FreeField,
    times: Range<f64>,
    time_step: f64,
}

impl Sampler<'_> {
    /// Instants spread over the run, whatever its steps.
    fn instants(&self) -> impl Iterator<Item = f64> {
        let start = self.times.start;
        let interval = (self.times.end - start) / INSTANTS as f64;
        (0..INSTANTS).map(move |instant| start + (instant as f64 + 0.5) * interval)
    }

    /// Whether the free field differs between the first element and the last.
    fn is_running(&self) -> bool {
        let count = self.ground.elements().len();
        let layout = ContactLayout::new(self.ground.directions(), count);
        let mut field = vec![0.0; layout.len()];
        let [mut difference, mut sum] = [0.0; 2];
        for time in self.instants() {
            self.ground.free_field(self.motion, time, &mut field);
            for component in field.chunks_exact(count) {
                let (first, last) = (component[0], component[count - 1]);
                difference += (last - first).powi(2);
                sum += 0.5 * (first * first + last * last);
            }
        }
        difference > RUNNING * sum
    }

    /// Frequency of the ground's acceleration under the middle element, Hz.
    fn frequency(&self) -> Option<f64> {
        let count = self.ground.elements().len();
        let layout = ContactLayout::new(self.ground.directions(), count);
        let mut field = vec![0.0; layout.len()];
        let mut distance = self.time_step;
        for _ in 0..HALVINGS {
            distance *= 0.5;
            let mut variation = Variation::default();
            for time in self.instants() {
                let mut at = |k: f64| {
                    self.ground.free_field(self.motion, time + k * distance, &mut field);
                    std::array::from_fn(|k| field.get(layout.place(k, count / 2)).copied())
                        .map(|value| value.unwrap_or(0.0))
                };
                let samples: [[f64; SPACE]; 4] = [at(-1.5), at(-0.5), at(0.5), at(1.5)];
                for k in 0..layout.components() {
                    let [before, after] =
                        [0, 1].map(|j| samples[j + 2][k] - 2.0 * samples[j + 1][k] + samples[j][k]);
                    variation.see(before, after);
                }
            }
            let ratio = variation.ratio();
            if ratio <= OWN {
                return Some(ratio / (PI * distance));
            }
        }
        None
    }
}
