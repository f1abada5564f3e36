//! Rigid block that slides on shaken rigid ground, solved exactly.

use super::sliding_history::{SlidingEvent, SlidingHistory, SlidingInterval};
use crate::error::{Result, positive};
use crate::motion::{Record, quadratic_roots_within};

/// Rigid block that slides both ways on horizontally shaken rigid ground, with Coulomb friction.
///
/// Newmark, "Effects of earthquakes on dams and embankments", Géotechnique 15 (1965), 139–160, with the same
/// resistance both ways. The block is at rest while |a| ≤ f g. It slides with v′ = −a − f g sgn v otherwise.
/// a is the ground's acceleration, v the slip velocity, and f both the static and the kinetic friction. For a
/// record that is linear between samples, every start and stop is the root of a linear or quadratic equation,
/// so the solution is exact up to rounding.
///
/// A pulse of 2 f g for one second pushes the block back by f g (1 s)², half of it after the pulse:
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

    /// Slip during the record, and after its end until the block is at rest.
    pub fn slide(&self, record: &Record) -> SlidingHistory {
        let mut run = SlidingRun::new(self.yield_acceleration);
        let step = record.time_step();
        for (index, pair) in record.accelerations().windows(2).enumerate() {
            let end = (index + 1) as f64 * step;
            run.advance(index as f64 * step, end, pair[0], (pair[1] - pair[0]) / step);
        }
        let end = record.duration();
        let stop = run.velocity.abs() / self.yield_acceleration;
        // Longer than the block needs to stop, so that the stop falls inside the interval.
        run.advance(end, end + 2.0 * stop + step, 0.0, 0.0);
        run.finish(end + 2.0 * stop + step)
    }
}

/// State while the record is processed.
struct SlidingRun {
    yield_acceleration: f64,
    slip: f64,
    /// Slip velocity, m/s.
    velocity: f64,
    /// +1 or −1 while sliding, 0 at rest.
    direction: f64,
    intervals: Vec<SlidingInterval>,
    events: Vec<SlidingEvent>,
    extremes: [f64; 2],
}

impl SlidingRun {
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

    /// Processes one interval in which the ground's acceleration is `ground` + `jerk`·(t − `start`).
    fn advance(&mut self, start: f64, end: f64, ground: f64, jerk: f64) {
        let mut time = start;
        let mut ground = ground;
        while time < end {
            let remaining = end - time;
            let elapsed = if self.direction == 0.0 {
                self.time_to_slip(time, remaining, &mut ground, jerk)
            } else {
                self.time_to_stop(time, remaining, &mut ground, jerk)
            };
            match elapsed {
                Some(elapsed) => time += elapsed,
                None => return,
            }
        }
    }

    /// Time from rest to the start of slip, s, if within `remaining`.
    fn time_to_slip(
        &mut self,
        time: f64,
        remaining: f64,
        ground: &mut f64,
        jerk: f64,
    ) -> Option<f64> {
        let limit = self.yield_acceleration;
        let grows = *ground * jerk > 0.0;
        let elapsed = if ground.abs() > limit || (ground.abs() == limit && grows) {
            0.0
        } else {
            self.intervals.push(SlidingInterval::at_rest(time, self.slip));
            // To +limit with a positive jerk, to −limit with a negative one.
            let elapsed = (limit.copysign(jerk) - *ground) / jerk;
            if jerk == 0.0 || elapsed >= remaining {
                return None;
            }
            // Set exactly: the slip acceleration starts from zero, and rounding must not change its sign.
            *ground = limit.copysign(jerk);
            elapsed
        };
        self.direction = -ground.signum();
        self.events.push(SlidingEvent::Slip { time: time + elapsed });
        Some(elapsed)
    }

    /// Time to the end of slip in this direction, s, if within `remaining`.
    fn time_to_stop(
        &mut self,
        time: f64,
        remaining: f64,
        ground: &mut f64,
        jerk: f64,
    ) -> Option<f64> {
        let acceleration = -*ground - self.direction * self.yield_acceleration;
        let accelerates = self.direction * acceleration > 0.0
            || (acceleration == 0.0 && self.direction * jerk < 0.0);
        // A stop at the end of the last interval may have been rounded beyond that end.
        let rounded_past = self.direction * self.velocity <= 0.0;
        if rounded_past {
            self.velocity = 0.0;
        }
        let motion = SlidingInterval {
            time,
            slip: self.slip,
            velocity: self.velocity,
            acceleration,
            jerk: -jerk,
        };
        let elapsed = if rounded_past && !accelerates {
            0.0
        } else {
            self.intervals.push(motion);
            let roots = quadratic_roots_within(self.velocity, acceleration, -jerk / 2.0, remaining);
            let Some(elapsed) = roots[0] else {
                [self.slip, self.velocity] = motion.after(remaining);
                return None;
            };
            elapsed
        };
        self.slip = motion.after(elapsed)[0];
        self.velocity = 0.0;
        self.update_extremes();
        *ground += jerk * elapsed;
        let time = time + elapsed;
        if ground.abs() > self.yield_acceleration {
            self.direction = -ground.signum();
            self.events.push(SlidingEvent::Reversal { time });
        } else {
            self.direction = 0.0;
            self.events.push(SlidingEvent::Stop { time });
        }
        Some(elapsed)
    }

    fn update_extremes(&mut self) {
        self.extremes = [self.extremes[0].min(self.slip), self.extremes[1].max(self.slip)];
    }

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
