//! Slip of a sliding block over time.

/// Motion of the block between two events.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SlidingInterval {
    /// Time at the start of the motion, s.
    pub(super) time: f64,
    /// Slip at the start, m.
    pub(super) slip: f64,
    /// Slip velocity at the start, m/s.
    pub(super) velocity: f64,
    /// Slip acceleration at the start, m/s².
    pub(super) acceleration: f64,
    /// Rate of the slip acceleration, m/s³.
    pub(super) jerk: f64,
}

impl SlidingInterval {
    /// Rest from `time` on.
    pub(super) fn at_rest(time: f64, slip: f64) -> Self {
        Self { time, slip, velocity: 0.0, acceleration: 0.0, jerk: 0.0 }
    }

    /// Slip and slip velocity at the time `s` (s) after the start.
    pub(super) fn state_after(&self, s: f64) -> SlidingState {
        let Self { slip, velocity, acceleration, jerk, .. } = *self;
        SlidingState {
            slip: slip + s * (velocity + s * (acceleration / 2.0 + s * jerk / 6.0)),
            velocity: velocity + s * (acceleration + s * jerk / 2.0),
        }
    }
}

/// State of the block at one time.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SlidingState {
    /// Slip, m.
    pub(super) slip: f64,
    /// Slip velocity, m/s.
    pub(super) velocity: f64,
}

/// Start, stop or reversal of the slip, and its time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum SlidingEvent {
    /// The block starts to slide.
    Slip {
        /// Time, s.
        time: f64,
    },
    /// The block comes to rest on the ground.
    Stop {
        /// Time, s.
        time: f64,
    },
    /// The slip velocity changes its sign without rest.
    Reversal {
        /// Time, s.
        time: f64,
    },
}

/// Slip of the block relative to the ground, positive to the right, at any time.
#[derive(Debug, Clone, PartialEq)]
pub struct SlidingHistory {
    pub(super) intervals: Vec<SlidingInterval>,
    pub(super) events: Vec<SlidingEvent>,
    /// Smallest and largest slip, m.
    pub(super) extremes: [f64; 2],
    /// Slip at the end, m.
    pub(super) residual: f64,
}

impl SlidingHistory {
    /// Largest slip to the right, m; not below zero.
    pub fn maximum(&self) -> f64 {
        self.extremes[1]
    }

    /// Largest slip to the left, m; zero or negative.
    pub fn minimum(&self) -> f64 {
        self.extremes[0]
    }

    /// Slip after the block has come to rest, m.
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// Starts, stops and reversals, in order of time.
    pub fn events(&self) -> &[SlidingEvent] {
        &self.events
    }

    /// Slip (m) at `time` (s): zero before t = 0, the residual after the end.
    pub fn slip(&self, time: f64) -> f64 {
        self.state_at(time).slip
    }

    /// Slip velocity (m/s) at `time` (s).
    pub fn slip_velocity(&self, time: f64) -> f64 {
        self.state_at(time).velocity
    }

    /// State at `time` (s): at rest without slip before t = 0.
    fn state_at(&self, time: f64) -> SlidingState {
        let next_index = self.intervals.partition_point(|interval| interval.time <= time);
        match next_index.checked_sub(1) {
            Some(index) => self.intervals[index].state_after(time - self.intervals[index].time),
            None => SlidingState::default(),
        }
    }
}
