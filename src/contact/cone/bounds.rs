//! Bounds of an element's force: pressure, friction, strength.

/// Friction coefficient that replaces infinite friction on an element with a bond, and in methods that need a disc.
pub(super) const SUBSTITUTED_FRICTION: f64 = 1e4;

/// Bounds of an element's force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// Friction coefficient of the law.
    pub(super) friction: f64,
    /// Present upper limit of the friction coefficient.
    pub(super) friction_limit: f64,
    /// Force that adds to p in friction, N.
    pub(super) attraction: f64,
    /// Shear force that adds to friction, N.
    pub(super) strength: f64,
    /// Smallest and largest p, N.
    pub(super) interval: [f64; 2],
    /// Gap when closed, m.
    pub(super) offset: f64,
    /// Whether the element neither slides nor opens.
    pub(super) bonded: bool,
}

impl Bounds {
    pub(super) const WITHOUT_FRICTION: Self = Self {
        friction: 0.0,
        friction_limit: f64::INFINITY,
        attraction: 0.0,
        strength: 0.0,
        interval: [0.0, f64::INFINITY],
        offset: 0.0,
        bonded: false,
    };

    /// Radius of the disc under a force p.
    pub(super) fn radius(&self, p: f64) -> f64 {
        if self.bonded {
            f64::INFINITY
        } else {
            self.effective_friction() * (p + self.attraction).max(0.0) + self.strength
        }
    }

    /// Present friction coefficient.
    pub(super) fn effective_friction(&self) -> f64 {
        let is_plain = self.strength == 0.0 && self.interval[0] == -self.attraction;
        self.friction.min(if is_plain {
            self.friction_limit
        } else {
            self.friction_limit.min(SUBSTITUTED_FRICTION)
        })
    }

    /// Whether the present friction is infinite.
    pub(super) fn has_infinite_friction(&self) -> bool {
        self.effective_friction() == f64::INFINITY && !self.bonded
    }

    /// Whether the element bears tension, or shear without pressure.
    pub(super) fn has_bond(&self) -> bool {
        !self.bonded && (self.interval[0] < 0.0 || self.attraction > 0.0 || self.strength > 0.0)
    }

    /// Bounds of the element after its bond has broken.
    pub(super) fn broken(self) -> Self {
        let interval = [0.0, self.interval[1]];
        Self { attraction: 0.0, strength: 0.0, interval, ..self }
    }

    /// Projects a trial p on its interval.
    pub(super) fn project_pressure(&self, p: f64) -> f64 {
        if self.bonded { p } else { p.max(self.interval[0]).min(self.interval[1]) }
    }

    /// Projects a trial t of this `size` on the disc of the projected p.
    pub(super) fn project_shear(&self, p: f64, trial: [f64; 2], size: f64) -> [f64; 2] {
        let radius = self.radius(p);
        if size <= radius {
            return trial;
        }
        trial.map(|t| t * (radius / size))
    }
}
