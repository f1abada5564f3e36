//! Contact status of an element: normal and tangential.

use std::mem::{Discriminant, discriminant};

/// Contact status of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Status {
    pub(super) normal: Normal,
    pub(super) tangential: Tangential,
}

/// Status of the gap and the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Normal {
    /// No pressure, or a bond at its strength.
    Open,
    /// Closed gap, with a pressure below its cap.
    Closed,
    /// The pressure is at its cap.
    Capped,
    /// The pressure is above its cap, and grows with the settlement by this stiffness, N/m.
    Hardening(f64),
}

/// Status of the shear and the slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Tangential {
    /// No shear.
    Free,
    /// No slip.
    Stick,
    Slip {
        /// Direction of the shear on the soil.
        direction: [f64; 2],
        /// κ: radius of the disc, relative to the trial shear.
        radius_ratio: f64,
        /// Growth of the radius with p.
        radius_slope: f64,
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

    /// Whether the element slips with friction below `friction`.
    pub(super) fn slips_below(&self, friction: f64) -> bool {
        matches!(self.tangential, Tangential::Slip { radius_slope, .. } if radius_slope > 0.0 && radius_slope < friction)
    }

    /// Closed gap without slip.
    pub(super) const CLOSED_STICKING: Self =
        Self { normal: Normal::Closed, tangential: Tangential::Stick };
    /// Open, without any force.
    pub(super) const OPEN_FREE: Self = Self { normal: Normal::Open, tangential: Tangential::Free };

    /// Prescribed p of an open or capped element.
    ///
    /// `None` if closed or on soil that hardens.
    pub(super) fn bound(&self, interval: [f64; 2]) -> Option<f64> {
        match self.normal {
            Normal::Open => Some(interval[0]),
            Normal::Closed | Normal::Hardening(_) => None,
            Normal::Capped => Some(interval[1]),
        }
    }

    /// Number of unknown forces.
    pub(super) fn unknown_force_count(&self) -> usize {
        let tangential_count = match self.tangential {
            Tangential::Free => 0,
            Tangential::Slip { .. } => 1,
            Tangential::Stick => 2,
        };
        tangential_count + usize::from(!matches!(self.normal, Normal::Open | Normal::Capped))
    }

    /// Number of unknown displacements.
    pub(super) fn unknown_displacement_count(&self) -> usize {
        let tangential_count = if self.tangential == Tangential::Stick { 0 } else { 2 };
        tangential_count + usize::from(self.normal != Normal::Closed)
    }
}
