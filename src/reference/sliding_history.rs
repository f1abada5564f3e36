//! Slip of a sliding block over time.

/// Motion after an event, up to the next one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    /// Time at the start of the motion, s.
    pub(super) time: f64,
    /// Slip (m), slip velocity, slip acceleration and its rate at the start.
    pub(super) state: [f64; 4],
}

impl Piece {
    /// Slip and slip velocity at the time `s` after the start.
    pub(super) fn after(&self, s: f64) -> [f64; 2] {
        let [slip, velocity, acceleration, jerk] = self.state;
        [
            slip + s * (velocity + s * (acceleration / 2.0 + s * jerk / 6.0)),
            velocity + s * (acceleration + s * jerk / 2.0),
        ]
    }
}

/// A change between rest and slip.
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
    /// The slip velocity passes through zero without rest.
    Reversal {
        /// Time, s.
        time: f64,
    },
}

/// Slip of the block relative to the ground, positive to the right, exact at any time.
#[derive(Debug, Clone, PartialEq)]
pub struct SlidingHistory {
    pub(super) pieces: Vec<Piece>,
    pub(super) events: Vec<SlidingEvent>,
    pub(super) extremes: [f64; 2],
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
        self.at(time)[0]
    }

    /// Slip velocity (m/s) at `time` (s).
    pub fn slip_velocity(&self, time: f64) -> f64 {
        self.at(time)[1]
    }

    fn at(&self, time: f64) -> [f64; 2] {
        let next = self.pieces.partition_point(|piece| piece.time <= time);
        match next.checked_sub(1) {
            Some(index) => self.pieces[index].after(time - self.pieces[index].time),
            None => [0.0; 2],
        }
    }
}
