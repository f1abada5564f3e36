//! The contact problem of a step in plan, in total forces of its elements.
//!
//! | symbol | meaning |
//! |---|---|
//! | r = (p, t) | force of the structure on the soil: down, along x and y, N |
//! | y = q + W (r − r₀) | mean gap at the end of the step; minus the slip of the step; m |
//! | R | radius of the disc of admissible t: friction (p + attraction) + strength |
//! | ρ | reciprocals of W's diagonal, N/m |
//!
//! Solutions are fixed points of r ← P(r − ρ y): p on the interval from −tension to the cap against y minus the
//! offset of a closed gap, then t on the disc. This is Signorini's and Coulomb's law in terms of displacements,
//! with elastic layers in W's diagonal.
//!
//! Infinite friction is the limit: y = 0 where there is pressure; elsewhere no force, or a closed gap with a shear
//! against the slip, which needs no pressure.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::acceleration::Acceleration;
use super::blocks::Blocks;
pub(super) use super::bounds::{Bounds, STAND_IN};
use super::group::{Group, LANES};
use super::low_rank::LowRank;
use super::newton::MANY_ELEMENTS;
use super::wide::Wide;
use crate::linalg::{Simd, WithSimd, dense_multiply_add, vectorized};

/// Residual at which a solution is accepted, relative to the largest force.
const TOLERANCE: f64 = 1e-11;

/// Status of an element with infinite friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Endless {
    Open,
    Stick,
    /// No pressure, and shear in this direction.
    Slip([f64; 2]),
}

/// W, q and bounds, and the present r and y.
pub(super) struct Problem {
    pub(super) count: usize,
    /// Row-major, component by component as in contact vectors; empty if W is of low rank.
    pub(super) w: Vec<f64>,
    /// W without `added`, on a bed of many springs.
    pub(super) low_rank: Option<LowRank>,
    /// W without `added`, if there are many elements on a lattice.
    pub(super) blocks: Option<Blocks>,
    /// The same where each element moves most others.
    pub(super) wide: Option<Wide>,
    /// Acceleration of sweeps, for many elements without `blocks`.
    pub(super) acceleration: Option<Acceleration>,
    /// Number that the proximal point method has added to W's diagonal.
    pub(super) added: f64,
    /// Blocks of W between the components of each element.
    pub(super) own: Vec<[[f64; 3]; 3]>,
    /// Numbers of all groups, in sweeps.
    pub(super) groups: Vec<Group>,
    /// Changes of force that have moved all elements, in sweeps.
    pub(super) applied: Vec<f64>,
    pub(super) q: Vec<f64>,
    /// r₀.
    pub(super) anchor: Vec<f64>,
    pub(super) bounds: Vec<Bounds>,
    /// r − r₀, so that a small change of a large force is not lost.
    pub(super) change: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// ρ of each element: normal, tangential.
    pub(super) rho: Vec<[f64; 2]>,
    /// Smallest force used to normalise residuals, N; in `finest` the residual at rounding level, N.
    pub(super) scale: f64,
    pub(super) finest: f64,
}

impl Problem {
    pub(super) fn new(count: usize) -> Self {
        Self { w: vec![0.0; 9 * count * count], low_rank: None, ..Self::on_bed(count) }
    }

    /// A problem whose W is of low rank.
    pub(super) fn on_bed(count: usize) -> Self {
        let zero = || vec![0.0; 3 * count];
        Self {
            count,
            w: vec![],
            low_rank: Some(LowRank::new(count)),
            blocks: None,
            wide: None,
            acceleration: None,
            added: 0.0,
            own: vec![[[0.0; 3]; 3]; count],
            groups: vec![],
            applied: zero(),
            q: zero(),
            anchor: zero(),
            bounds: vec![Bounds::NONE; count],
            change: zero(),
            y: zero(),
            rho: vec![[0.0; 2]; count],
            scale: 0.0,
            finest: 0.0,
        }
    }

    /// Places of the components of an element.
    #[inline]
    pub(super) fn places(&self, e: usize) -> [usize; 3] {
        [e, self.count + e, 2 * self.count + e]
    }

    pub(super) fn size(&self) -> usize {
        3 * self.count
    }

    /// Block of W between the components of an element.
    fn block(&self, e: usize) -> [[f64; 3]; 3] {
        if let Some(low_rank) = &self.low_rank {
            let mut block = low_rank.block(e);
            (0..3).for_each(|k| block[k][k] += self.added);
            return block;
        }
        let places = self.places(e);
        places.map(|i| places.map(|j| self.w[i * self.size() + j]))
    }

    /// Numbers of these elements.
    pub(super) fn group(&self, elements: [usize; LANES]) -> Group {
        let mut all = Group::NONE;
        for (lane, e) in elements.into_iter().enumerate().filter(|(_, e)| *e < self.count) {
            let bounds = &self.bounds[e];
            for (k, i) in self.places(e).into_iter().enumerate() {
                all.q[k][lane] = self.q[i];
                all.anchor[k][lane] = self.anchor[i];
                all.change[k][lane] = self.change[i];
            }
            (0..2).for_each(|k| all.turned[k][lane] = self.own[e][k + 1][0]);
            (0..2).for_each(|k| all.rho[k][lane] = self.rho[e][k]);
            let free = [f64::NEG_INFINITY, f64::INFINITY];
            let interval = if bounds.bonded { free } else { bounds.interval };
            (0..2).for_each(|k| all.interval[k][lane] = interval[k]);
            all.offset[lane] = bounds.offset;
            all.friction[lane] = if bounds.bonded { 0.0 } else { bounds.taken() };
            all.attraction[lane] = bounds.attraction;
            all.strength[lane] = if bounds.bonded { f64::INFINITY } else { bounds.strength };
        }
        all
    }

    /// Takes the blocks of W, if there are any.
    pub(super) fn take_blocks(&mut self, blocks: Option<Blocks>) {
        self.groups = vec![Group::NONE; blocks.as_ref().map_or(0, |blocks| blocks.groups.len())];
        self.blocks = blocks;
    }

    /// Allocates the acceleration of sweeps, for many elements without blocks.
    pub(super) fn prepare_acceleration(&mut self) {
        let motion_count = self.wide.as_ref().map_or(self.size(), Wide::response_count);
        if self.blocks.is_some() || self.count < MANY_ELEMENTS {
            self.acceleration = None;
        } else if self.acceleration.as_ref().is_none_or(|a| a.motion_count() != motion_count) {
            self.acceleration = Some(Acceleration::new(self.size(), motion_count));
        }
    }

    /// Computes ρ and the blocks of elements; call it when the diagonal of W has changed.
    pub(super) fn find_scales(&mut self) {
        for e in 0..self.count {
            self.own[e] = self.block(e);
            let [[n, ..], [_, xx, xy], [_, _, yy]] = self.own[e];
            self.rho[e] = [1.0 / n, 1.0 / (xx.max(yy) + xy.abs())];
        }
    }

    /// Sets r to r₀, and y accordingly.
    pub(super) fn rest(&mut self) {
        self.change.fill(0.0);
        self.y.copy_from_slice(&self.q);
    }

    /// Computes y for the present r.
    pub(super) fn respond(&mut self) {
        if let Some(blocks) = &mut self.blocks {
            blocks.respond(&self.change);
            return self.read_blocks();
        }
        let Self { w, q, change, y, wide, low_rank, added, count, .. } = self;
        if let Some(low_rank) = low_rank {
            return low_rank.respond(change, q, *added, y);
        }
        let Some(wide) = wide else {
            y.copy_from_slice(q);
            return dense_multiply_add(w, 1.0, change, y);
        };
        wide.respond(change);
        for e in 0..*count {
            let places = [e, *count + e, 2 * *count + e];
            let motion = wide.motion(e, places.map(|i| change[i]));
            for (i, motion) in places.into_iter().zip(motion) {
                y[i] = q[i] + *added * change[i] + motion;
            }
        }
    }

    /// Copies the motion of all blocks to y.
    fn read_blocks(&mut self) {
        vectorized(Read(self));
    }

    /// p and t before they are projected.
    pub(super) fn trial(&self, e: usize) -> [f64; 3] {
        let ([n, x, y], [normal, tangential]) = (self.places(e), self.rho[e]);
        [
            self.force(n) - normal * (self.y[n] - self.bounds[e].offset),
            self.force(x) - tangential * self.y[x],
            self.force(y) - tangential * self.y[y],
        ]
    }

    /// Status of an element with infinite friction.
    ///
    /// Pressure excludes slip, and a gap excludes a shear against the slip. The trial keeps the larger of each
    /// pair.
    pub(super) fn endless(&self, e: usize) -> Endless {
        let (bounds, [p, tx, ty]) = (&self.bounds[e], self.trial(e));
        let ([_, x, y], [normal, tangential]) = (self.places(e), self.rho[e]);
        let size = tx.hypot(ty);
        let direction = if size > 0.0 { [tx / size, ty / size] } else { [0.0; 2] };
        let along = |tx: f64, ty: f64| direction[0] * tx + direction[1] * ty;
        if p + bounds.attraction > -tangential * along(self.y[x], self.y[y]) {
            Endless::Stick
        } else if along(self.force(x), self.force(y)) > normal * (self.y[e] - bounds.offset) {
            Endless::Slip(direction)
        } else {
            Endless::Open
        }
    }

    /// Difference of an element's force from the conditions of its status, with infinite friction, N.
    fn miss_endless(&self, e: usize) -> f64 {
        let (bounds, trial, [n, x, y]) = (&self.bounds[e], self.trial(e), self.places(e));
        let force = [n, x, y].map(|i| self.force(i));
        let [p, tx, ty]: [f64; 3] = std::array::from_fn(|k| trial[k] - force[k]);
        let open = (force[0] - bounds.interval[0]).abs();
        match self.endless(e) {
            Endless::Stick => (bounds.press(trial[0]) - force[0]).abs() + tx.abs() + ty.abs(),
            Endless::Open => open + p.max(0.0) + force[1].abs() + force[2].abs(),
            Endless::Slip([c, s]) => {
                let across = (c * force[2] - s * force[1]).abs() + (c * ty - s * tx).abs();
                let [along, slip] = [c * force[1] + s * force[2], c * tx + s * ty];
                open + p.abs() + across + (-along).max(0.0) + (-slip).max(0.0)
            }
        }
    }

    /// Difference of an element's force from its fixed point for the present y, N.
    pub(super) fn miss(&self, e: usize) -> f64 {
        if self.bounds[e].is_endless() {
            return self.miss_endless(e);
        }
        let (bounds, [p, tx, ty]) = (&self.bounds[e], self.trial(e));
        let [n, x, y] = self.places(e);
        let p = bounds.press(p);
        let [tx, ty] = bounds.shear(p, [tx, ty], tx.hypot(ty));
        let parts = [p - self.force(n), tx - self.force(x), ty - self.force(y)];
        // A sum of magnitudes preserves NaN.
        parts.iter().map(|part| part.abs()).sum()
    }

    /// Largest difference of all elements; NaN if one is NaN.
    pub(super) fn residual(&mut self) -> f64 {
        self.respond();
        self.largest_miss()
    }

    /// Largest difference of all elements for the present y; NaN if one is NaN.
    fn largest_miss(&self) -> f64 {
        let larger = |most: f64, miss: f64| if miss <= most { most } else { miss };
        (0..self.count).map(|e| self.miss(e)).fold(0.0, larger)
    }

    /// Limits the friction of all elements to `grip`.
    pub(super) fn hold(&mut self, grip: f64) {
        self.bounds.iter_mut().for_each(|bounds| bounds.grip = grip);
    }

    /// Component of r.
    pub(super) fn force(&self, i: usize) -> f64 {
        self.anchor[i] + self.change[i]
    }

    /// Sets a component of r.
    pub(super) fn set(&mut self, i: usize, force: f64) {
        self.change[i] = force - self.anchor[i];
    }

    /// Force that normalises residuals, N.
    pub(super) fn largest(&self) -> f64 {
        (0..self.size()).fold(self.scale, |most, i| most.max(self.force(i).abs()))
    }

    /// Residual below which r is a solution, N.
    pub(super) fn tolerance(&self) -> f64 {
        (TOLERANCE * self.largest()).max(self.finest)
    }

    /// Whether the present r is a solution of the problem, by the motions of blocks as they are.
    pub(super) fn blocks_are_solved(&mut self) -> bool {
        self.read_blocks();
        self.largest_miss() <= self.tolerance()
    }

    /// Whether the present r is a solution of the problem.
    pub(super) fn is_solved(&mut self) -> bool {
        self.residual() <= self.tolerance()
    }
}

struct Read<'a>(&'a mut Problem);

impl WithSimd for Read<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Problem { blocks, count, q, change, added, y, .. } = self.0;
        let Some(blocks) = blocks else { return };
        for (g, elements) in blocks.groups.iter().enumerate() {
            let motion = blocks.motion(simd, g);
            for (lane, e) in elements.iter().enumerate().filter(|(_, e)| **e < *count) {
                for (k, motion) in motion.iter().enumerate() {
                    let i = k * *count + e;
                    y[i] = q[i] + *added * change[i] + motion[lane];
                }
            }
        }
    }
}
