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
//! with elastic layers in W's diagonal. On soil that hardens by k per settlement, a trial above the cap is projected on cap +
//! (trial − cap) k/(k + ρ), where p = cap + k (offset − y).
//!
//! Infinite friction is the limit: y = 0 where there is pressure; elsewhere no force, or a closed gap with a shear
//! against the slip, which needs no pressure.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::acceleration::Acceleration;
use super::blocks::NearFieldBlocks;
pub(super) use super::bounds::{Bounds, SUBSTITUTED_FRICTION};
use super::group::{Group, LANE_COUNT};
use super::low_rank::LowRank;
use super::status::{Status, Tangential};
use super::wide::DenseLattice;
use crate::linalg::{Simd, WithSimd, dense_multiply_add, vectorized};

/// Residual at which a solution is accepted, relative to the largest force.
pub(super) const RELATIVE_RESIDUAL_TOLERANCE: f64 = 1e-11;
/// Number of elements from which a factorization takes longer than several sweeps.
const MANY_ELEMENTS: usize = 64;

/// Contact status of an element with infinite friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum InfiniteFriction {
    Open,
    Stick,
    /// No pressure, and shear in this direction.
    Slip([f64; 2]),
}

/// Number of iterations of a method, and whether they found a solution.
#[derive(Debug, Clone, Copy)]
pub(super) struct SolveOutcome {
    pub(super) iterations: usize,
    pub(super) is_solved: bool,
}

impl SolveOutcome {
    pub(super) fn new(iterations: usize, is_solved: bool) -> Self {
        Self { iterations, is_solved }
    }
}

/// Contact problem of a step: W, q and bounds, and the present r and y.
pub(super) struct ConeProblem {
    pub(super) count: usize,
    /// Row-major, component by component as in contact vectors; empty if W is of low rank.
    pub(super) w: Vec<f64>,
    /// W without `added`, on a bed of many springs.
    pub(super) low_rank: Option<LowRank>,
    /// W without `added`, if there are many elements on a lattice.
    pub(super) near_field: Option<NearFieldBlocks>,
    /// The same where each element moves largest others.
    pub(super) dense_lattice: Option<DenseLattice>,
    /// Acceleration of sweeps, for many elements without `near_field`.
    pub(super) acceleration: Option<Acceleration>,
    /// Number that the proximal point method has added to W's diagonal.
    pub(super) added: f64,
    /// NearFieldBlocks of W between the components of each element.
    pub(super) element_blocks: Vec<[[f64; 3]; 3]>,
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
    /// Residual at which a solution is accepted, relative to the largest force.
    pub(super) relative_tolerance: f64,
    /// Smallest force used to normalise residuals, N; in `rounding_residual` the residual at rounding level, N.
    pub(super) min_force_scale: f64,
    pub(super) rounding_residual: f64,
}

impl ConeProblem {
    pub(super) fn new(count: usize) -> Self {
        Self { w: vec![0.0; 9 * count * count], low_rank: None, ..Self::on_bed(count) }
    }

    /// A problem whose W is of low rank.
    pub(super) fn on_bed(count: usize) -> Self {
        let zero = vec![0.0; 3 * count];
        Self {
            count,
            w: vec![],
            low_rank: Some(LowRank::new(count)),
            near_field: None,
            dense_lattice: None,
            acceleration: None,
            added: 0.0,
            element_blocks: vec![[[0.0; 3]; 3]; count],
            groups: vec![],
            applied: zero.clone(),
            q: zero.clone(),
            anchor: zero.clone(),
            bounds: vec![Bounds::WITHOUT_FRICTION; count],
            change: zero.clone(),
            y: zero.clone(),
            rho: vec![[0.0; 2]; count],
            relative_tolerance: RELATIVE_RESIDUAL_TOLERANCE,
            min_force_scale: 0.0,
            rounding_residual: 0.0,
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

    /// Values of a group of elements, one in each lane.
    pub(super) fn group(&self, elements: [usize; LANE_COUNT]) -> Group {
        let mut all = Group::WITHOUT_ELEMENTS;
        for (lane, e) in elements.into_iter().enumerate().filter(|(_, e)| *e < self.count) {
            let bounds = &self.bounds[e];
            for (k, i) in self.places(e).into_iter().enumerate() {
                all.q[k][lane] = self.q[i];
                all.anchor[k][lane] = self.anchor[i];
                all.change[k][lane] = self.change[i];
            }
            (0..2).for_each(|k| all.turned[k][lane] = self.element_blocks[e][k + 1][0]);
            (0..2).for_each(|k| all.rho[k][lane] = self.rho[e][k]);
            let free = [f64::NEG_INFINITY, f64::INFINITY];
            let interval = if bounds.bonded { free } else { bounds.interval };
            (0..2).for_each(|k| all.interval[k][lane] = interval[k]);
            if bounds.hardening > 0.0 && !bounds.bonded {
                all.hardening_fraction[lane] = bounds.hardening_fraction(self.rho[e][0]);
                all.hardens = true;
            }
            all.offset[lane] = bounds.offset;
            all.friction[lane] = if bounds.bonded { 0.0 } else { bounds.effective_friction() };
            all.attraction[lane] = bounds.attraction;
            all.strength[lane] = if bounds.bonded { f64::INFINITY } else { bounds.strength };
        }
        all
    }

    /// Sets the near-field blocks of W, if there are any.
    pub(super) fn set_near_field(&mut self, near_field: Option<NearFieldBlocks>) {
        self.groups = vec![
            Group::WITHOUT_ELEMENTS;
            near_field.as_ref().map_or(0, |near_field| near_field.groups.len())
        ];
        self.near_field = near_field;
    }

    /// Allocates the acceleration of sweeps, for many elements without blocks.
    pub(super) fn prepare_acceleration(&mut self) {
        let motion_count =
            self.dense_lattice.as_ref().map_or(self.size(), DenseLattice::response_count);
        if self.near_field.is_some() || self.count < MANY_ELEMENTS {
            self.acceleration = None;
        } else if self.acceleration.as_ref().is_none_or(|a| a.motion_count() != motion_count) {
            self.acceleration = Some(Acceleration::new(self.size(), motion_count));
        }
    }

    /// Computes ρ and the blocks of elements; call it when the diagonal of W has changed.
    pub(super) fn update_scales(&mut self) {
        for e in 0..self.count {
            self.element_blocks[e] = self.block(e);
            let [[n, ..], [_, xx, xy], [_, _, yy]] = self.element_blocks[e];
            self.rho[e] = [1.0 / n, 1.0 / (xx.max(yy) + xy.abs())];
        }
    }

    /// Sets r to r₀, and y accordingly.
    pub(super) fn reset_forces(&mut self) {
        self.change.fill(0.0);
        self.y.copy_from_slice(&self.q);
    }

    /// Computes y for the present r.
    pub(super) fn update_motions(&mut self) {
        if let Some(near_field) = &mut self.near_field {
            near_field.update_motions(&self.change);
            return self.copy_near_field_motions();
        }
        let Self { w, q, change, y, dense_lattice, low_rank, added, count, .. } = self;
        if let Some(low_rank) = low_rank {
            return low_rank.update_motions(change, q, *added, y);
        }
        let Some(dense_lattice) = dense_lattice else {
            y.copy_from_slice(q);
            return dense_multiply_add(w, 1.0, change, y);
        };
        dense_lattice.update_motions(change);
        for e in 0..*count {
            let places = [e, *count + e, 2 * *count + e];
            let motion = dense_lattice.motion(e, places.map(|i| change[i]));
            for (i, motion) in places.into_iter().zip(motion) {
                y[i] = q[i] + *added * change[i] + motion;
            }
        }
    }

    /// Copies the motion of all blocks to y.
    fn copy_near_field_motions(&mut self) {
        vectorized(CopyMotions(self));
    }

    /// p and t before they are projected.
    pub(super) fn trial(&self, e: usize) -> [f64; 3] {
        let places = self.places(e);
        let rho = self.rho[e];
        [
            self.force(places[0]) - rho[0] * (self.y[places[0]] - self.bounds[e].offset),
            self.force(places[1]) - rho[1] * self.y[places[1]],
            self.force(places[2]) - rho[1] * self.y[places[2]],
        ]
    }

    /// Contact status of an element with infinite friction.
    ///
    /// Pressure excludes slip, and a gap excludes a shear against the slip. The trial keeps the larger of each
    /// pair.
    pub(super) fn infinite_friction_status(&self, e: usize) -> InfiniteFriction {
        let bounds = &self.bounds[e];
        let trial = self.trial(e);
        let places = self.places(e);
        let rho = self.rho[e];
        let size = trial[1].hypot(trial[2]);
        let direction = if size > 0.0 { [trial[1] / size, trial[2] / size] } else { [0.0; 2] };
        let slip = direction[0] * self.y[places[1]] + direction[1] * self.y[places[2]];
        let shear = direction[0] * self.force(places[1]) + direction[1] * self.force(places[2]);
        if trial[0] + bounds.attraction > -rho[1] * slip {
            InfiniteFriction::Stick
        } else if shear > rho[0] * (self.y[e] - bounds.offset) {
            InfiniteFriction::Slip(direction)
        } else {
            InfiniteFriction::Open
        }
    }

    /// Residual of an element with infinite friction: difference from the conditions of its status, N.
    fn infinite_friction_residual(&self, e: usize) -> f64 {
        let bounds = &self.bounds[e];
        let trial = self.trial(e);
        let force = self.places(e).map(|i| self.force(i));
        let [p, tx, ty]: [f64; 3] = std::array::from_fn(|k| trial[k] - force[k]);
        let open = (force[0] - bounds.interval[0]).abs();
        match self.infinite_friction_status(e) {
            InfiniteFriction::Stick => {
                let pressure = bounds.project_pressure(trial[0], self.rho[e][0]);
                (pressure - force[0]).abs() + tx.abs() + ty.abs()
            }
            InfiniteFriction::Open => open + p.max(0.0) + force[1].abs() + force[2].abs(),
            InfiniteFriction::Slip([c, s]) => {
                let across = (c * force[2] - s * force[1]).abs() + (c * ty - s * tx).abs();
                let along = c * force[1] + s * force[2];
                let slip = c * tx + s * ty;
                open + p.abs() + across + (-along).max(0.0) + (-slip).max(0.0)
            }
        }
    }

    /// Residual of an element: difference of its force from its fixed point for the present y, N.
    pub(super) fn element_residual(&self, e: usize) -> f64 {
        if self.bounds[e].has_infinite_friction() {
            return self.infinite_friction_residual(e);
        }
        let bounds = &self.bounds[e];
        let trial = self.trial(e);
        let force = self.places(e).map(|i| self.force(i));
        let p = bounds.project_pressure(trial[0], self.rho[e][0]);
        let shear = bounds.project_shear(p, [trial[1], trial[2]], trial[1].hypot(trial[2]));
        let differences = [p - force[0], shear[0] - force[1], shear[1] - force[2]];
        // A sum of magnitudes preserves NaN.
        differences.iter().map(|difference| difference.abs()).sum()
    }

    /// Largest residual of all elements, N; NaN if one is NaN.
    pub(super) fn residual(&mut self) -> f64 {
        self.update_motions();
        self.largest_residual()
    }

    /// Largest residual of all elements for the present y, N; NaN if one is NaN.
    fn largest_residual(&self) -> f64 {
        (0..self.count).map(|e| self.element_residual(e)).fold(0.0, max_or_nan)
    }

    /// Limits the friction of all elements to `friction_limit`.
    pub(super) fn limit_friction(&mut self, friction_limit: f64) {
        self.bounds.iter_mut().for_each(|bounds| bounds.friction_limit = friction_limit);
    }

    /// Component of r.
    pub(super) fn force(&self, i: usize) -> f64 {
        self.anchor[i] + self.change[i]
    }

    /// Sets a component of r.
    pub(super) fn set_force(&mut self, i: usize, force: f64) {
        self.change[i] = force - self.anchor[i];
    }

    /// Sets the forces that statuses prescribe, to the last bit.
    pub(super) fn prescribe(&mut self, statuses: &[Status]) {
        for (e, status) in statuses.iter().enumerate() {
            let places = self.places(e);
            if let Some(bound) = status.bound(self.bounds[e].interval) {
                self.set_force(places[0], bound);
            }
            if status.tangential == Tangential::Free {
                self.set_force(places[1], 0.0);
                self.set_force(places[2], 0.0);
            }
        }
    }

    /// Force that normalises residuals, N.
    pub(super) fn largest_force(&self) -> f64 {
        (0..self.size()).fold(self.min_force_scale, |largest, i| largest.max(self.force(i).abs()))
    }

    /// Residual below which r is a solution, N.
    pub(super) fn tolerance(&self) -> f64 {
        (self.relative_tolerance * self.largest_force()).max(self.rounding_residual)
    }

    /// Whether the present r is a solution of the problem, by the motions of blocks as they are.
    pub(super) fn near_field_is_solved(&mut self) -> bool {
        self.copy_near_field_motions();
        self.largest_residual() <= self.tolerance()
    }

    /// Whether the present r is a solution of the problem.
    pub(super) fn is_solved(&mut self) -> bool {
        self.residual() <= self.tolerance()
    }
}

/// The larger of two changes or residuals, or NaN.
#[inline(always)]
pub(super) fn max_or_nan(largest: f64, value: f64) -> f64 {
    if value <= largest { largest } else { value }
}

/// Copies the motions of all elements from their groups to y.
struct CopyMotions<'a>(&'a mut ConeProblem);

impl WithSimd for CopyMotions<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let ConeProblem { near_field, count, q, change, added, y, .. } = self.0;
        let Some(near_field) = near_field else { return };
        for (g, elements) in near_field.groups.iter().enumerate() {
            let motion = near_field.motion(simd, g);
            for (lane, e) in elements.iter().enumerate().filter(|(_, e)| **e < *count) {
                for (k, motion) in motion.iter().enumerate() {
                    let i = k * *count + e;
                    y[i] = q[i] + *added * change[i] + motion[lane];
                }
            }
        }
    }
}
