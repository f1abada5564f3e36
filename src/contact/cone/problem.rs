//! The contact problem of a step in plan, in total forces of its elements.
//!
//! | symbol | meaning |
//! |---|---|
//! | r = (p, t) | force of the structure on the soil: down, along x and y, N |
//! | y = q + W (r − r₀) | mean gap at the end of the step; minus the slip of the step; m |
//! | R | radius of the disc of admissible t: friction (p + attraction) + strength |
//! | ρ | reciprocals of W's diagonal, N/m |
//!
//! Solutions are fixed points of r ← P(r − ρ y): p on the interval from −tension to the cap against y less the
//! offset of a closed gap, then t on the disc. That is Signorini's and Coulomb's law at the level of displacements, with
//! elastic layers in W's diagonal.

use crate::linalg::{dense_multiply_add, largest};

/// Friction coefficient that stands for an infinite one: an element that opens under shear needs a pressure, however
/// small, until it is open.
const GRIP: f64 = 1e3;
/// Residual of a solution, relative to the largest force.
const TOLERANCE: f64 = 1e-11;

/// What the force of an element is bounded by, in forces and lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub(super) friction: f64,
    /// Force that friction acts on beside p, N.
    pub(super) attraction: f64,
    /// Shear force beside friction, N.
    pub(super) strength: f64,
    /// Least and greatest p, N.
    pub(super) interval: [f64; 2],
    /// Gap when closed, m.
    pub(super) offset: f64,
    /// Whether nothing slides or opens.
    pub(super) bonded: bool,
}

impl Bounds {
    pub(super) const NONE: Self = Self {
        friction: 0.0,
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
            self.slope() * (p + self.attraction).max(0.0) + self.strength
        }
    }

    /// Growth of the radius with p.
    pub(super) fn slope(&self) -> f64 {
        self.friction.min(GRIP)
    }

    /// Whether the element bears tension, or shear without pressure.
    pub(super) fn has_bond(&self) -> bool {
        !self.bonded && (self.interval[0] < 0.0 || self.attraction > 0.0 || self.strength > 0.0)
    }

    /// The same once the bond is gone.
    pub(super) fn broken(self) -> Self {
        let interval = [0.0, self.interval[1]];
        Self { attraction: 0.0, strength: 0.0, interval, ..self }
    }

    /// p of P(r − ρ y), for the gap y less the offset.
    pub(super) fn press(&self, p: f64) -> f64 {
        if self.bonded { p } else { p.max(self.interval[0]).min(self.interval[1]) }
    }

    /// t of P(r − ρ y), with the projected p.
    pub(super) fn shear(&self, p: f64, [x, y]: [f64; 2]) -> [f64; 2] {
        let (radius, size) = (self.radius(p), x.hypot(y));
        if size <= radius {
            return [x, y];
        }
        [x, y].map(|t| t * (radius / size))
    }
}

/// W, q and bounds; the present r and y.
pub(super) struct Problem {
    pub(super) count: usize,
    /// Row-major, component by component as contact vectors are.
    pub(super) w: Vec<f64>,
    pub(super) q: Vec<f64>,
    /// r₀.
    pub(super) anchor: Vec<f64>,
    pub(super) bounds: Vec<Bounds>,
    pub(super) r: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// ρ of each element: normal, tangential.
    pub(super) rho: Vec<[f64; 2]>,
    /// Force to which the residual is relative beside r, N, and the least residual that can be told.
    pub(super) scale: f64,
    pub(super) finest: f64,
    difference: Vec<f64>,
}

impl Problem {
    pub(super) fn new(count: usize) -> Self {
        let zero = || vec![0.0; 3 * count];
        Self {
            count,
            w: vec![0.0; 9 * count * count],
            q: zero(),
            anchor: zero(),
            bounds: vec![Bounds::NONE; count],
            r: zero(),
            y: zero(),
            rho: vec![[0.0; 2]; count],
            scale: 0.0,
            finest: 0.0,
            difference: zero(),
        }
    }

    /// Places of the components of an element.
    pub(super) fn places(&self, e: usize) -> [usize; 3] {
        [e, self.count + e, 2 * self.count + e]
    }

    pub(super) fn size(&self) -> usize {
        3 * self.count
    }

    pub(super) fn row(&self, i: usize) -> &[f64] {
        let size = self.size();
        &self.w[i * size..][..size]
    }

    /// Block of W between the components of an element.
    pub(super) fn block(&self, e: usize) -> [[f64; 3]; 3] {
        let places = self.places(e);
        places.map(|i| places.map(|j| self.w[i * self.size() + j]))
    }

    /// Finds ρ: to be called when the diagonal of W has changed.
    pub(super) fn find_scales(&mut self) {
        for e in 0..self.count {
            let [[n, ..], [_, xx, xy], [_, _, yy]] = self.block(e);
            self.rho[e] = [1.0 / n, 1.0 / (xx.max(yy) + xy.abs())];
        }
    }

    /// y of the present r.
    pub(super) fn respond(&mut self) {
        let Self { w, q, anchor, r, y, difference, .. } = self;
        for ((d, r), anchor) in difference.iter_mut().zip(&*r).zip(&*anchor) {
            *d = r - anchor;
        }
        y.copy_from_slice(q);
        dense_multiply_add(w, 1.0, difference, y);
    }

    /// p and t before they are projected.
    pub(super) fn trial(&self, e: usize) -> [f64; 3] {
        let ([n, x, y], [normal, tangential]) = (self.places(e), self.rho[e]);
        [
            self.r[n] - normal * (self.y[n] - self.bounds[e].offset),
            self.r[x] - tangential * self.y[x],
            self.r[y] - tangential * self.y[y],
        ]
    }

    /// Distance of an element's force from its fixed point, N, for the present y.
    pub(super) fn miss(&self, e: usize) -> f64 {
        let (bounds, [p, tx, ty]) = (&self.bounds[e], self.trial(e));
        let [n, x, y] = self.places(e);
        let p = bounds.press(p);
        let [tx, ty] = bounds.shear(p, [tx, ty]);
        let parts = [p - self.r[n], tx - self.r[x], ty - self.r[y]];
        // A sum of magnitudes does not lose NaN.
        parts.iter().map(|part| part.abs()).sum()
    }

    /// Largest distance of all, which is NaN if one is.
    pub(super) fn residual(&mut self) -> f64 {
        self.respond();
        let larger = |most: f64, miss: f64| if miss <= most { most } else { miss };
        (0..self.count).map(|e| self.miss(e)).fold(0.0, larger)
    }

    /// Residual at which r is a solution, N.
    pub(super) fn tolerance(&self) -> f64 {
        (TOLERANCE * largest(&self.r).max(self.scale)).max(self.finest)
    }

    /// Whether the present r is a solution.
    pub(super) fn is_solved(&mut self) -> bool {
        self.residual() <= self.tolerance()
    }
}
