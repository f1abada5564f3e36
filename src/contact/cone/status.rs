//! Contact status of an element: along the normal, and along the base.

use std::mem::{Discriminant, discriminant};

/// Contact status of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Status {
    pub(super) normal: Normal,
    pub(super) tangential: Tangential,
}

/// Status along the normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Normal {
    /// No pressure, or a bond at its strength.
    Open,
    Closed,
    /// The pressure is at its cap.
    Capped,
    /// The pressure is above its cap, and grows with the settlement by this stiffness, N/m.
    Hardening(f64),
}

/// Status along the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Tangential {
    /// No friction.
    Free,
    Stick,
    /// Slip in this direction, with κ and the growth of the radius with p.
    Slip {
        direction: [f64; 2],
        turn: f64,
        slope: f64,
    },
}

impl Status {
    /// Kind of the status, without its numbers.
    pub(super) fn kind(&self) -> (Discriminant<Normal>, Discriminant<Tangential>) {
        (discriminant(&self.normal), discriminant(&self.tangential))
    }

    /// Whether the soil yields.
    pub(super) fn is_yield(&self) -> bool {
        matches!(self.normal, Normal::Capped | Normal::Hardening(_))
    }

    /// Whether the element slips and its friction is below `friction`.
    pub(super) fn slips_below(&self, friction: f64) -> bool {
        matches!(self.tangential, Tangential::Slip { slope, .. } if slope > 0.0 && slope < friction)
    }

    /// Closed without slip.
    pub(super) const CLOSED_STICKING: Self =
        Self { normal: Normal::Closed, tangential: Tangential::Stick };
    /// Open, without any force.
    pub(super) const OPEN_FREE: Self = Self { normal: Normal::Open, tangential: Tangential::Free };

    /// Prescribed p of an open or capped element; `None` if closed or on soil that hardens.
    pub(super) fn bound(&self, interval: [f64; 2]) -> Option<f64> {
        match self.normal {
            Normal::Open => Some(interval[0]),
            Normal::Closed | Normal::Hardening(_) => None,
            Normal::Capped => Some(interval[1]),
        }
    }

    /// Numbers of unknown forces and of unknown motions.
    pub(super) fn unknown_counts(&self) -> [usize; 2] {
        let tangential = match self.tangential {
            Tangential::Free => [0, 2],
            Tangential::Stick => [2, 0],
            Tangential::Slip { .. } => [1, 2],
        };
        let normal = match self.normal {
            Normal::Closed => [1, 0],
            Normal::Open | Normal::Capped => [0, 1],
            Normal::Hardening(_) => [1, 1],
        };
        [tangential[0] + normal[0], tangential[1] + normal[1]]
    }
}
