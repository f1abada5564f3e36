//! Rigid block that slides on shaken rigid ground: exact solution.

use super::sliding_history::{SlidingEvent, SlidingHistory, SlidingInterval};
use crate::error::{Result, positive};
use crate::motion::{Record, quadratic_roots_within};

/// Rigid block that slides in both directions on shaken rigid ground with Coulomb friction.
///
/// Newmark, "Effects of earthquakes on dams and embankments", Géotechnique 15 (1965), 139–160, with the same
/// resistance in both directions. A block at rest stays at rest while |a| ≤ f g; a sliding block has v′ = −a − f g sgn v.
/// Here a is the horizontal acceleration of the ground, v the slip velocity, and f both the static and the kinetic
/// friction coefficient. For a record that is linear between samples, every start and stop is a root of a linear or
/// quadratic equation, so the solution has only rounding errors.
///
/// After a pulse of 2 f g for one second, the slip is −f g (1 s)²; half of it occurs after the pulse:
/// ```
/// use basemat::{motion::Record, reference::SlidingBlock};
/// let pulse = Record::new(1.0, vec![2.0, 2.0])?;
/// let history = SlidingBlock::new(0.1, 10.0)?.slide(&pulse);
/// assert!((history.slip(1.0) + 0.5).abs() < 1e-15);
/// assert!((history.residual() + 1.0).abs() < 1e-15);
/// assert_eq!(history.events().len(), 2);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingBlock {
    yield_acceleration: f64,
}

impl SlidingBlock {
    /// Block with a friction coefficient f under `gravity` (m/s²).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both, and their product, are finite and above
    /// zero.
    pub fn new(friction: f64, gravity: f64) -> Result<Self> {
        positive("friction of the block", friction)?;
        positive("gravity", gravity)?;
        let yield_acceleration = positive("yield acceleration of the block", friction * gravity)?;
        Ok(Self { yield_acceleration })
    }

    /// Ground acceleration f g at which the block slides, m/s².
    pub fn yield_acceleration(&self) -> f64 {
        self.yield_acceleration
    }

    /// Slip during the record, and after the record until the block is at rest.
    pub fn slide(&self, record: &Record) -> SlidingHistory {
        let mut run = SlidingRun::new(self.yield_acceleration);
        let time_step = record.time_step();
        for (index, pair) in record.accelerations().windows(2).enumerate() {
            let end = (index + 1) as f64 * time_step;
            run.advance(index as f64 * time_step, end, pair[0], (pair[1] - pair[0]) / time_step);
        }
        let record_end = record.duration();
        let stopping_time = run.velocity.abs() / self.yield_acceleration;
        // The interval is longer than the stopping time, so that the block stops inside the interval.
        let end = record_end + 2.0 * stopping_time + time_step;
        run.advance(record_end, end, 0.0, 0.0);
        run.finish(end)
    }
}

/// State of the block while the record is processed.
struct SlidingRun {
    yield_acceleration: f64,
    /// Slip, m.
    slip: f64,
    /// Slip velocity, m/s.
    velocity: f64,
    /// +1 or −1 while sliding, 0 at rest.
    direction: f64,
    intervals: Vec<SlidingInterval>,
    events: Vec<SlidingEvent>,
    /// Smallest and largest slip, m.
    extremes: [f64; 2],
}

impl SlidingRun {
    /// A block at rest.
    fn new(yield_acceleration: f64) -> Self {
        Self {
            yield_acceleration,
            slip: 0.0,
            velocity: 0.0,
            direction: 0.0,
            intervals: Vec::new(),
            events: Vec::new(),
            extremes: [0.0; 2],
        }
    }

    /// Processes an interval with the ground acceleration `start_acceleration` + `jerk`·(t − `start`).
    fn advance(&mut self, start: f64, end: f64, start_acceleration: f64, jerk: f64) {
        let mut time = start;
        let mut ground_acceleration = start_acceleration;
        while time < end {
            let remaining_time = end - time;
            let time_to_event = if self.direction == 0.0 {
                self.time_to_slip(time, remaining_time, &mut ground_acceleration, jerk)
            } else {
                self.time_to_stop(time, remaining_time, &mut ground_acceleration, jerk)
            };
            match time_to_event {
                Some(duration) => time += duration,
                None => return,
            }
        }
    }

    /// Time (s) from rest to the start of slip, if within the remaining time.
    ///
    /// Updates `ground_acceleration` to its value at the start of slip.
    fn time_to_slip(
        &mut self,
        time: f64,
        remaining_time: f64,
        ground_acceleration: &mut f64,
        jerk: f64,
    ) -> Option<f64> {
        let limit = self.yield_acceleration;
        let magnitude = ground_acceleration.abs();
        let is_growing = *ground_acceleration * jerk > 0.0;
        let duration = if magnitude > limit || (magnitude == limit && is_growing) {
            0.0
        } else {
            self.intervals.push(SlidingInterval::at_rest(time, self.slip));
            // The acceleration reaches +limit with a positive jerk, and −limit with a negative jerk.
            let duration = (limit.copysign(jerk) - *ground_acceleration) / jerk;
            if jerk == 0.0 || duration >= remaining_time {
                return None;
            }
            // The exact limit gives a slip acceleration of exactly zero: a rounding error could have the wrong sign.
            *ground_acceleration = limit.copysign(jerk);
            duration
        };
        self.direction = -ground_acceleration.signum();
        self.events.push(SlidingEvent::Slip { time: time + duration });
        Some(duration)
    }

    /// Time (s) to the end of slip in the current direction, if within the remaining time.
    ///
    /// Updates `ground_acceleration` to its value at the end of slip.
    fn time_to_stop(
        &mut self,
        time: f64,
        remaining_time: f64,
        ground_acceleration: &mut f64,
        jerk: f64,
    ) -> Option<f64> {
        let acceleration = -*ground_acceleration - self.direction * self.yield_acceleration;
        let is_accelerating = self.direction * acceleration > 0.0
            || (acceleration == 0.0 && self.direction * jerk < 0.0);
        // The block may have stopped exactly at the end of the previous interval, where a rounding error hid the stop.
        let has_stopped = self.direction * self.velocity <= 0.0;
        if has_stopped {
            self.velocity = 0.0;
        }
        let interval = SlidingInterval {
            time,
            slip: self.slip,
            velocity: self.velocity,
            acceleration,
            jerk: -jerk,
        };
        let duration = if has_stopped && !is_accelerating {
            0.0
        } else {
            self.intervals.push(interval);
            let stopping_times =
                quadratic_roots_within(self.velocity, acceleration, -jerk / 2.0, remaining_time);
            let Some(duration) = stopping_times[0] else {
                let state = interval.state_after(remaining_time);
                self.slip = state.slip;
                self.velocity = state.velocity;
                return None;
            };
            duration
        };
        self.slip = interval.state_after(duration).slip;
        self.velocity = 0.0;
        self.update_extremes();
        *ground_acceleration += jerk * duration;
        let stop_time = time + duration;
        if ground_acceleration.abs() > self.yield_acceleration {
            self.direction = -ground_acceleration.signum();
            self.events.push(SlidingEvent::Reversal { time: stop_time });
        } else {
            self.direction = 0.0;
            self.events.push(SlidingEvent::Stop { time: stop_time });
        }
        Some(duration)
    }

    /// Includes the current slip in the extremes.
    fn update_extremes(&mut self) {
        self.extremes = [self.extremes[0].min(self.slip), self.extremes[1].max(self.slip)];
    }

    /// History of the run, which ends at rest at `time`.
    fn finish(mut self, time: f64) -> SlidingHistory {
        self.update_extremes();
        self.intervals.push(SlidingInterval::at_rest(time, self.slip));
        SlidingHistory {
            intervals: self.intervals,
            events: self.events,
            extremes: self.extremes,
            residual: self.slip,
        }
    }
}
