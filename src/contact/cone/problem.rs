//! The contact problem of a step in space, in total forces of its elements.
//!
//! | symbol | meaning |
//! |---|---|
//! | r = (p, t) | force of the structure on the soil: down, along x and y, N |
//! | r₀ | static force, N |
//! | y = q + W (r − r₀) | relative displacement: mean gap at the end of the step; minus the slip of the step; m |
//! | R | radius of the disc of admissible t: friction (p + attraction) + shear strength |
//! | ρ | reciprocals of W's diagonal, N/m |
//!
//! A solution is a fixed point of r ← P(r − ρ y). P projects p on the interval from −tension to the cap, with the
//! closed gap subtracted from y; then it projects t on the disc. The fixed point satisfies Signorini's and Coulomb's
//! law in terms of displacements. W's diagonal contains elastic layers. On soil that hardens by k per settlement, a
//! trial above the cap is projected on cap + (trial − cap) k/(k + ρ), where p = cap + k (closed gap − y).
//!
//! Infinite friction is a limit. An element with pressure has y = 0. An element without pressure has no force, or it
//! has a closed gap and a shear against the slip.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::acceleration::Acceleration;
pub(super) use super::bounds::{Bounds, SUBSTITUTED_FRICTION};
use super::compliance::ComplianceForm;
use super::low_rank::LowRankCompliance;
use super::status::{Status, Tangential};
use crate::linalg::{Simd, WithSimd, dense_multiply_add, vectorized};

/// Residual at which a solution is accepted, relative to the largest force.
pub(super) const RELATIVE_RESIDUAL_TOLERANCE: f64 = 1e-11;
/// Number of elements from which a factorization takes longer than several accelerated sweeps.
pub(super) const MIN_ELEMENTS_FOR_ACCELERATION: usize = 64;

/// Largest change of the last sweep, as a fraction of the residual tolerance.
pub(super) const SWEEP_TOLERANCE_FACTOR: f64 = 1e-2;
/// Number of sweeps that the rate of convergence needs to settle.
pub(super) const MIN_SWEEPS_FOR_RATE: usize = 4;
/// Sweeps end early if they would need this many times the remaining number.
///
/// The factor is above one since the rate of convergence is an estimate.
const REMAINING_SWEEPS_FACTOR: f64 = 2.0;

/// Contact status of an element with infinite friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum InfiniteFriction {
    Open,
    Stick,
    /// No pressure, and shear in this direction.
    Slip([f64; 2]),
}

/// Outcome of a method: its number of iterations, and whether they found a solution.
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
    pub(super) element_count: usize,
    /// Entries of W, row-major; empty if W is of low rank.
    ///
    /// Rows are in the order of contact vectors, component by component.
    pub(super) w: Vec<f64>,
    /// W for products and sweeps.
    pub(super) form: ComplianceForm,
    /// Acceleration of sweeps, for many elements without a near field.
    pub(super) acceleration: Option<Acceleration>,
    /// Number that the proximal point method has added to W's diagonal, m/N.
    pub(super) added_diagonal: f64,
    /// Blocks of W between the components of each element.
    pub(super) element_blocks: Vec<[[f64; 3]; 3]>,
    pub(super) q: Vec<f64>,
    /// r₀.
    pub(super) static_force: Vec<f64>,
    pub(super) bounds: Vec<Bounds>,
    /// r − r₀; stored so that a small change of a large force keeps its digits.
    pub(super) force_change: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// ρ of each element: normal, tangential.
    pub(super) rho: Vec<[f64; 2]>,
    /// Residual at which a solution is accepted, relative to the largest force.
    pub(super) relative_tolerance: f64,
    /// Smallest force by which residuals are divided, N.
    pub(super) min_force_scale: f64,
    /// Residual due to rounding, N.
    pub(super) rounding_residual: f64,
}

impl ConeProblem {
    /// A problem whose W has stored entries, zero at first.
    pub(super) fn new(element_count: usize) -> Self {
        Self {
            w: vec![0.0; 9 * element_count * element_count],
            form: ComplianceForm::Entries,
            ..Self::on_bed(element_count)
        }
    }

    /// A problem whose W is of low rank.
    pub(super) fn on_bed(element_count: usize) -> Self {
        let zero = vec![0.0; 3 * element_count];
        Self {
            element_count,
            w: vec![],
            form: ComplianceForm::LowRank(Box::new(LowRankCompliance::new(element_count))),
            acceleration: None,
            added_diagonal: 0.0,
            element_blocks: vec![[[0.0; 3]; 3]; element_count],
            q: zero.clone(),
            static_force: zero.clone(),
            bounds: vec![Bounds::WITHOUT_FRICTION; element_count],
            force_change: zero.clone(),
            y: zero,
            rho: vec![[0.0; 2]; element_count],
            relative_tolerance: RELATIVE_RESIDUAL_TOLERANCE,
            min_force_scale: 0.0,
            rounding_residual: 0.0,
        }
    }

    /// Indices of an element's components in contact vectors.
    #[inline]
    pub(super) fn component_indices(&self, e: usize) -> [usize; 3] {
        [e, self.element_count + e, 2 * self.element_count + e]
    }

    /// Number of components of all elements.
    pub(super) fn component_count(&self) -> usize {
        3 * self.element_count
    }

    /// Block of W between the components of an element.
    fn block(&self, e: usize) -> [[f64; 3]; 3] {
        if let Some(low_rank) = self.form.low_rank() {
            let mut block = low_rank.block(e);
            (0..3).for_each(|k| block[k][k] += self.added_diagonal);
            return block;
        }
        let indices = self.component_indices(e);
        indices.map(|i| indices.map(|j| self.w[i * self.component_count() + j]))
    }

    /// Allocates the acceleration of sweeps, for many elements without a near field.
    pub(super) fn prepare_acceleration(&mut self) {
        let has_near_field = self.form.near_field().is_some();
        if has_near_field || self.element_count < MIN_ELEMENTS_FOR_ACCELERATION {
            self.acceleration = None;
        } else if self.acceleration.is_none() {
            self.acceleration = Some(Acceleration::new(self.component_count()));
        }
    }

    /// Computes ρ and the blocks of elements; call it when the diagonal of W has changed.
    pub(super) fn update_scales(&mut self) {
        for e in 0..self.element_count {
            self.element_blocks[e] = self.block(e);
            let [[n, ..], [_, xx, xy], [_, _, yy]] = self.element_blocks[e];
            self.rho[e] = [1.0 / n, 1.0 / (xx.max(yy) + xy.abs())];
        }
    }

    /// Sets r to r₀, and y to q.
    pub(super) fn reset_forces(&mut self) {
        self.force_change.fill(0.0);
        self.y.copy_from_slice(&self.q);
    }

    /// Computes y for the present r.
    pub(super) fn update_displacements(&mut self) {
        let Self { w, form, added_diagonal, q, force_change, y, .. } = self;
        match form {
            ComplianceForm::Entries => {
                y.copy_from_slice(q);
                dense_multiply_add(w, 1.0, force_change, y);
            }
            ComplianceForm::NearField(blocks) => {
                blocks.update_displacements(force_change);
                self.copy_near_field_displacements();
            }
            ComplianceForm::Lattice(lattice) => {
                lattice.update_displacements(force_change, q, *added_diagonal, y);
            }
            ComplianceForm::LowRank(low_rank) => {
                low_rank.update_displacements(force_change, q, *added_diagonal, y);
            }
        }
    }

    /// Copies the displacements of the near-field blocks to y.
    fn copy_near_field_displacements(&mut self) {
        vectorized(CopyDisplacements(self));
    }

    /// Trial force r − ρ y of an element, before its projection.
    pub(super) fn trial_force(&self, e: usize) -> [f64; 3] {
        let indices = self.component_indices(e);
        let rho = self.rho[e];
        [
            self.force(indices[0]) - rho[0] * (self.y[indices[0]] - self.bounds[e].closed_gap),
            self.force(indices[1]) - rho[1] * self.y[indices[1]],
            self.force(indices[2]) - rho[1] * self.y[indices[2]],
        ]
    }

    /// Contact status of an element with infinite friction.
    ///
    /// Pressure excludes slip, and a gap excludes a shear against the slip. Of each such pair, the larger quantity
    /// decides.
    pub(super) fn infinite_friction_status(&self, e: usize) -> InfiniteFriction {
        let bounds = &self.bounds[e];
        let trial = self.trial_force(e);
        let indices = self.component_indices(e);
        let rho = self.rho[e];
        let norm = trial[1].hypot(trial[2]);
        let direction = if norm > 0.0 { [trial[1] / norm, trial[2] / norm] } else { [0.0; 2] };
        let slip = direction[0] * self.y[indices[1]] + direction[1] * self.y[indices[2]];
        let shear = direction[0] * self.force(indices[1]) + direction[1] * self.force(indices[2]);
        if trial[0] + bounds.attraction > -rho[1] * slip {
            InfiniteFriction::Stick
        } else if shear > rho[0] * (self.y[e] - bounds.closed_gap) {
            InfiniteFriction::Slip(direction)
        } else {
            InfiniteFriction::Open
        }
    }

    /// Residual of an element with infinite friction: difference from the conditions of its status, N.
    fn infinite_friction_residual(&self, e: usize) -> f64 {
        let bounds = &self.bounds[e];
        let trial = self.trial_force(e);
        let force = self.component_indices(e).map(|i| self.force(i));
        let [dp, dx, dy] = [0, 1, 2].map(|k| trial[k] - force[k]);
        let open_residual = (force[0] - bounds.interval[0]).abs();
        match self.infinite_friction_status(e) {
            InfiniteFriction::Stick => {
                let pressure = bounds.project_pressure(trial[0], self.rho[e][0]);
                (pressure - force[0]).abs() + dx.abs() + dy.abs()
            }
            InfiniteFriction::Open => open_residual + dp.max(0.0) + force[1].abs() + force[2].abs(),
            InfiniteFriction::Slip([c, s]) => {
                let cross_residual = (c * force[2] - s * force[1]).abs() + (c * dy - s * dx).abs();
                let reversed_shear = (-(c * force[1] + s * force[2])).max(0.0);
                let reversed_slip = (-(c * dx + s * dy)).max(0.0);
                open_residual + dp.abs() + cross_residual + reversed_shear + reversed_slip
            }
        }
    }

    /// Residual of an element for the present y, N.
    ///
    /// It is the difference of its force from its projected trial force.
    pub(super) fn element_residual(&self, e: usize) -> f64 {
        if self.bounds[e].has_infinite_friction() {
            return self.infinite_friction_residual(e);
        }
        let bounds = &self.bounds[e];
        let trial = self.trial_force(e);
        let force = self.component_indices(e).map(|i| self.force(i));
        let p = bounds.project_pressure(trial[0], self.rho[e][0]);
        let shear = bounds.project_shear(p, [trial[1], trial[2]], trial[1].hypot(trial[2]));
        let differences = [p - force[0], shear[0] - force[1], shear[1] - force[2]];
        // A sum of magnitudes preserves NaN.
        differences.iter().map(|difference| difference.abs()).sum()
    }

    /// Whether a largest p grows with the settlement.
    pub(super) fn has_hardening(&self) -> bool {
        self.bounds.iter().any(|bounds| bounds.hardening > 0.0)
    }

    /// Largest residual of all elements, N; NaN if one is NaN.
    pub(super) fn residual(&mut self) -> f64 {
        self.update_displacements();
        self.max_residual()
    }

    /// Largest residual of all elements for the present y, N; NaN if one is NaN.
    pub(super) fn max_residual(&self) -> f64 {
        (0..self.element_count).map(|e| self.element_residual(e)).fold(0.0, max_or_nan)
    }

    /// Limits the friction of all elements to `friction_limit`.
    pub(super) fn limit_friction(&mut self, friction_limit: f64) {
        self.bounds.iter_mut().for_each(|bounds| bounds.friction_limit = friction_limit);
    }

    /// Component of r.
    pub(super) fn force(&self, i: usize) -> f64 {
        self.static_force[i] + self.force_change[i]
    }

    /// Sets a component of r.
    pub(super) fn set_force(&mut self, i: usize, force: f64) {
        self.force_change[i] = force - self.static_force[i];
    }

    /// Sets the forces that statuses prescribe, to the last bit.
    pub(super) fn set_prescribed_forces(&mut self, statuses: &[Status]) {
        for (e, status) in statuses.iter().enumerate() {
            if let Some(bound) = status.bound(self.bounds[e].interval) {
                self.set_force(e, bound);
            }
            if status.tangential == Tangential::Free {
                self.set_force(self.element_count + e, 0.0);
                self.set_force(2 * self.element_count + e, 0.0);
            }
        }
    }

    /// Largest component of r, by which residuals are divided, N.
    pub(super) fn largest_force(&self) -> f64 {
        (0..self.component_count())
            .fold(self.min_force_scale, |largest, i| largest.max(self.force(i).abs()))
    }

    /// Residual below which r is a solution, N.
    pub(super) fn tolerance(&self) -> f64 {
        (self.relative_tolerance * self.largest_force()).max(self.rounding_residual)
    }

    /// Whether the present r is a solution, with the displacements that near-field sweeps have computed.
    pub(super) fn near_field_is_solved(&mut self) -> bool {
        self.copy_near_field_displacements();
        self.max_residual() <= self.tolerance()
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

/// Whether sweeps with this rate of convergence will not reach the tolerance within the allowed number.
pub(super) fn is_too_slow(rate: f64, remaining: f64, sweep: usize, max_sweep_count: usize) -> bool {
    let max_remaining = REMAINING_SWEEPS_FACTOR * (max_sweep_count - sweep) as f64;
    sweep > MIN_SWEEPS_FOR_RATE && (rate >= 1.0 || remaining > max_remaining)
}

/// Copies the displacements of all elements from their groups to y.
struct CopyDisplacements<'a>(&'a mut ConeProblem);

impl WithSimd for CopyDisplacements<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let ConeProblem { form, element_count, q, force_change, added_diagonal, y, .. } = self.0;
        let Some(near_field) = form.near_field() else { return };
        for (g, elements) in near_field.groups.iter().enumerate() {
            let displacement = near_field.displacement(simd, g);
            for (lane, e) in elements.iter().enumerate().filter(|(_, e)| **e < *element_count) {
                for (k, displacement) in displacement.iter().enumerate() {
                    let i = k * *element_count + e;
                    y[i] = q[i] + *added_diagonal * force_change[i] + displacement[lane];
                }
            }
        }
    }
}
