//! Bounds of an element's force: pressure, friction, strength.
//!
//! The table of [`problem`](super::problem) explains p, t, y, ρ and the disc.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::status::Normal;

/// Friction coefficient that replaces infinite friction.
///
/// On an element with a bond, and in methods that need a finite disc.
pub(super) const SUBSTITUTED_FRICTION: f64 = 1e4;

/// Bounds of an element's force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// Friction coefficient of the law.
    pub(super) friction: f64,
    /// Upper limit that a search sets on the friction coefficient.
    pub(super) friction_limit: f64,
    /// Force that adds to p in friction, N.
    pub(super) attraction: f64,
    /// Shear force that adds to friction, N.
    pub(super) shear_strength: f64,
    /// Smallest and largest p, N; on soil that hardens, the largest p before it settles.
    pub(super) interval: [f64; 2],
    /// Growth of the largest p with the settlement, N/m.
    pub(super) hardening: f64,
    /// Normal displacement y of a closed element, m.
    pub(super) closed_gap: f64,
    /// Whether the element neither slides nor opens.
    pub(super) is_bonded: bool,
}

impl Bounds {
    /// Bounds of an element that bears pressure only.
    pub(super) const WITHOUT_FRICTION: Self = Self {
        friction: 0.0,
        friction_limit: f64::INFINITY,
        attraction: 0.0,
        shear_strength: 0.0,
        interval: [0.0, f64::INFINITY],
        hardening: 0.0,
        closed_gap: 0.0,
        is_bonded: false,
    };

    /// Radius of the disc under a force p.
    pub(super) fn radius(&self, p: f64) -> f64 {
        if self.is_bonded {
            f64::INFINITY
        } else {
            self.effective_friction() * (p + self.attraction).max(0.0) + self.shear_strength
        }
    }

    /// Present friction coefficient.
    pub(super) fn effective_friction(&self) -> f64 {
        // Without shear at the smallest p, infinite friction has a limit that methods solve.
        let has_limit = self.shear_strength == 0.0 && self.interval[0] == -self.attraction;
        self.friction.min(if has_limit {
            self.friction_limit
        } else {
            self.friction_limit.min(SUBSTITUTED_FRICTION)
        })
    }

    /// Whether the present friction is infinite.
    pub(super) fn has_infinite_friction(&self) -> bool {
        self.effective_friction() == f64::INFINITY && !self.is_bonded
    }

    /// Whether the element bears tension, or shear without pressure.
    pub(super) fn has_bond(&self) -> bool {
        !self.is_bonded
            && (self.interval[0] < 0.0 || self.attraction > 0.0 || self.shear_strength > 0.0)
    }

    /// Bounds of the element after its bond has broken.
    pub(super) fn with_broken_bond(self) -> Self {
        let interval = [0.0, self.interval[1]];
        Self { attraction: 0.0, shear_strength: 0.0, interval, ..self }
    }

    /// Projects a trial p with the stiffness ρ on its interval, which grows with the settlement.
    #[inline(always)]
    pub(super) fn project_pressure(&self, p: f64, stiffness: f64) -> f64 {
        if self.is_bonded {
            return p;
        }
        let projected = p.max(self.interval[0]).min(self.interval[1]);
        let excess = p - self.interval[1];
        if self.hardening > 0.0 && excess > 0.0 {
            projected + excess * self.hardening_fraction(stiffness)
        } else {
            projected
        }
    }

    /// Fraction of the excess over the largest p that hardening soil bears.
    ///
    /// The excess is that of a trial p; `stiffness` is ρ.
    pub(super) fn hardening_fraction(&self, stiffness: f64) -> f64 {
        if self.hardening > 0.0 { 1.0 / (1.0 + stiffness / self.hardening) } else { 0.0 }
    }

    /// Normal status of an element at its largest p.
    pub(super) fn status_at_cap(&self) -> Normal {
        if self.hardening > 0.0 { Normal::Hardening(self.hardening) } else { Normal::Capped }
    }

    /// Projects a trial t of this `magnitude` on the disc of `p`, which is already projected.
    pub(super) fn project_shear(&self, p: f64, trial: [f64; 2], magnitude: f64) -> [f64; 2] {
        let radius = self.radius(p);
        if magnitude <= radius {
            return trial;
        }
        trial.map(|t| t * (radius / magnitude))
    }
}
