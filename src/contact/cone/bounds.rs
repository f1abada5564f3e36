//! Bounds of an element's force: pressure, friction, strength.

/// Friction coefficient that replaces infinite friction on an element with a bond, and in methods that need a disc.
pub(super) const STAND_IN: f64 = 1e4;

/// Bounds of an element's force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// Friction coefficient of the law.
    pub(super) friction: f64,
    /// Present upper limit of the friction coefficient.
    pub(super) grip: f64,
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
    pub(super) const NONE: Self = Self {
        friction: 0.0,
        grip: f64::INFINITY,
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
            self.taken() * (p + self.attraction).max(0.0) + self.strength
        }
    }

    /// Present friction coefficient.
    pub(super) fn taken(&self) -> f64 {
        let is_plain = self.strength == 0.0 && self.interval[0] == -self.attraction;
        self.friction.min(if is_plain { self.grip } else { self.grip.min(STAND_IN) })
    }

    /// Whether the present friction is infinite.
    pub(super) fn is_endless(&self) -> bool {
        self.taken() == f64::INFINITY && !self.bonded
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

    /// p of P(r − ρ y), for the gap y minus the offset.
    pub(super) fn press(&self, p: f64) -> f64 {
        if self.bonded { p } else { p.max(self.interval[0]).min(self.interval[1]) }
    }

    /// t of P(r − ρ y), with the projected p and the magnitude before.
    pub(super) fn shear(&self, p: f64, [x, y]: [f64; 2], size: f64) -> [f64; 2] {
        let radius = self.radius(p);
        if size <= radius {
            return [x, y];
        }
        [x, y].map(|t| t * (radius / size))
    }
}
