//! Sweeps over the elements (Gauss–Seidel), each solved with the forces of all others fixed.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::acceleration::Acceleration;
use super::compliance::ComplianceForm;
use super::low_rank::LowRankCompliance;
use super::problem::{
    Bounds, ConeProblem, SWEEP_TOLERANCE_FACTOR, SolveOutcome, is_too_slow, max_or_nan,
};
use crate::linalg::transposed_multiply_add;

/// Largest number of projections of an element in a sweep.
const MAX_LOCAL_PROJECTIONS: usize = 40;
/// Largest change of an element's last projection, as a fraction of the change at which sweeps end.
const LOCAL_TOLERANCE_FACTOR: f64 = 0.1;
/// Largest change of an element's last projection, as a fraction of its first change.
///
/// More exact solutions gain nothing while the other elements still move.
const FIRST_CHANGE_FRACTION: f64 = 0.1;
/// Factor of the number of near-field sweeps: they take much less time than a factorization.
const NEAR_FIELD_SWEEP_FACTOR: usize = 4;

/// Largest number of accelerated sweeps.
const MAX_ACCELERATED_SWEEPS: usize = 200;
/// Change at which accelerated sweeps end, as a fraction of the residual tolerance.
const ACCELERATED_CHANGE: f64 = 0.3;
/// Factor by which accelerated sweeps must reduce the change.
const REQUIRED_REDUCTION: f64 = 0.5;
/// Largest number of accelerated sweeps without this reduction.
const MAX_SWEEPS_WITHOUT_REDUCTION: usize = 30;

impl ConeProblem {
    /// Makes up to `max_sweep_count` sweeps; those that will not converge end early.
    pub(super) fn sweep(&mut self, max_sweep_count: usize) -> SolveOutcome {
        if self.form.near_field().is_some() {
            return self.sweep_near_field(NEAR_FIELD_SWEEP_FACTOR * max_sweep_count);
        }
        self.update_displacements();
        let mut previous_change = f64::INFINITY;
        for sweep in 1..=max_sweep_count {
            let tolerance = SWEEP_TOLERANCE_FACTOR * self.tolerance();
            let largest_change = self.relax_all(LOCAL_TOLERANCE_FACTOR * tolerance);
            if largest_change.is_nan() {
                return SolveOutcome::new(sweep, false);
            }
            if largest_change <= tolerance && self.is_solved() {
                return SolveOutcome::new(sweep, true);
            }
            // Factor by which a sweep reduces the change.
            let rate = largest_change / previous_change;
            let remaining_sweeps = (tolerance / largest_change).ln() / rate.ln();
            if is_too_slow(rate, remaining_sweeps, sweep, max_sweep_count) {
                return SolveOutcome::new(sweep, self.is_solved());
            }
            previous_change = largest_change;
        }
        SolveOutcome::new(max_sweep_count, self.is_solved())
    }

    /// Makes accelerated sweeps until the largest change is below `relative_change` times the largest force.
    ///
    /// Sweeps that hardly reduce the change end early.
    pub(super) fn sweep_accelerated(&mut self, relative_change: f64) -> SolveOutcome {
        let Some(mut acceleration) = self.acceleration.take() else {
            return SolveOutcome::new(0, false);
        };
        let outcome = self.sweep_with_acceleration(&mut acceleration, relative_change);
        self.acceleration = Some(acceleration);
        outcome
    }

    fn sweep_with_acceleration(
        &mut self,
        acceleration: &mut Acceleration,
        relative_change: f64,
    ) -> SolveOutcome {
        acceleration.restart();
        self.update_displacements();
        let mut smallest_change = f64::INFINITY;
        let mut last_reduction = 0;
        for sweep in 1..=MAX_ACCELERATED_SWEEPS {
            let tolerance = ACCELERATED_CHANGE * self.tolerance();
            let sufficient_change = tolerance.max(relative_change * self.largest_force());
            acceleration.begin_sweep(&self.force_change);
            let largest_change = self.relax_all(LOCAL_TOLERANCE_FACTOR * tolerance);
            if largest_change.is_nan() {
                return SolveOutcome::new(sweep, false);
            }
            if largest_change <= sufficient_change {
                let is_solved = self.is_solved();
                if is_solved || largest_change > tolerance {
                    return SolveOutcome::new(sweep, is_solved);
                }
            }
            if largest_change <= REQUIRED_REDUCTION * smallest_change {
                smallest_change = largest_change;
                last_reduction = sweep;
            }
            if sweep - last_reduction == MAX_SWEEPS_WITHOUT_REDUCTION {
                return SolveOutcome::new(sweep, self.is_solved());
            }
            acceleration.end_sweep(&mut self.force_change, &mut self.y);
        }
        SolveOutcome::new(MAX_ACCELERATED_SWEEPS, self.is_solved())
    }

    /// Relaxes all elements in turn, as [`ConeProblem::relax`]; returns the largest change (N), or NaN.
    pub(super) fn relax_all(&mut self, tolerance: f64) -> f64 {
        let mut form = std::mem::take(&mut self.form);
        let largest_change = match &mut form {
            ComplianceForm::LowRank(low_rank) => self.relax_all_by_modes(low_rank, tolerance),
            ComplianceForm::Entries | ComplianceForm::Lattice(_) | ComplianceForm::NearField(_) => {
                (0..self.element_count).map(|e| self.relax(e, tolerance)).fold(0.0, max_or_nan)
            }
        };
        self.form = form;
        largest_change
    }

    /// Relaxes all elements in turn, with W of low rank.
    fn relax_all_by_modes(&mut self, low_rank: &mut LowRankCompliance, tolerance: f64) -> f64 {
        let mut largest_change = 0.0;
        for e in 0..self.element_count {
            let indices = self.component_indices(e);
            let displacement = low_rank.displacement(e, indices.map(|i| self.force_change[i]));
            let r = self.relaxed_force_at(e, displacement, tolerance);
            let increment = [0, 1, 2].map(|k| r[k] - self.force(indices[k]));
            if increment != [0.0; 3] {
                (0..3).for_each(|k| self.set_force(indices[k], r[k]));
                low_rank.add_force(e, increment);
            }
            largest_change = max_or_nan(largest_change, magnitude_sum(increment));
        }
        largest_change
    }

    /// Force of an element with all other forces fixed.
    ///
    /// `displacement`: W (r − r₀) of the element, without the added diagonal.
    #[inline(always)]
    fn relaxed_force_at(&self, e: usize, displacement: [f64; 3], tolerance: f64) -> [f64; 3] {
        let indices = self.component_indices(e);
        let mut start = [0.0; 3];
        let mut y = displacement;
        for k in 0..3 {
            start[k] = self.force(indices[k]);
            y[k] += self.q[indices[k]] + self.added_diagonal * self.force_change[indices[k]];
        }
        relaxed_force(&self.bounds[e], self.rho[e], &self.element_blocks[e], start, y, tolerance)
    }

    /// Relaxes one element with all other forces fixed.
    ///
    /// Returns the change of its force (N).
    ///
    /// It uses the entries of W. It ends when the force changes by less than `tolerance` or a tenth of the first
    /// change.
    fn relax(&mut self, e: usize, tolerance: f64) -> f64 {
        let indices = self.component_indices(e);
        let start = indices.map(|i| self.force(i));
        let y = indices.map(|i| self.y[i]);
        let block = &self.element_blocks[e];
        let r = relaxed_force(&self.bounds[e], self.rho[e], block, start, y, tolerance);
        let increment = [0, 1, 2].map(|k| r[k] - start[k]);
        for (k, &i) in indices.iter().enumerate() {
            if increment[k] != 0.0 {
                // W is symmetric: its rows are its columns.
                let size = self.component_count();
                let row = &self.w[i * size..][..size];
                transposed_multiply_add(row, 1.0, &[increment[k]], &mut self.y);
                self.set_force(i, r[k]);
            }
        }
        magnitude_sum(increment)
    }
}

/// Sum of the magnitudes of a force's components.
#[inline(always)]
fn magnitude_sum(force: [f64; 3]) -> f64 {
    force[0].abs() + force[1].abs() + force[2].abs()
}

/// Force of an element with the forces of others fixed.
///
/// It begins with the force `start` and the displacement `y`. The force is projected until it changes by at most
/// `tolerance`, or by little compared with the first projection.
#[inline(always)]
fn relaxed_force(
    bounds: &Bounds,
    [normal_rho, tangential_rho]: [f64; 2],
    block: &[[f64; 3]; 3],
    start: [f64; 3],
    mut y: [f64; 3],
    mut tolerance: f64,
) -> [f64; 3] {
    let mut r = start;
    for projection in 0..MAX_LOCAL_PROJECTIONS {
        let trial = r[0] - normal_rho * (y[0] - bounds.closed_gap);
        let p = bounds.project_pressure(trial, normal_rho);
        let p_change = p - r[0];
        if p_change != 0.0 {
            (0..3).for_each(|k| y[k] += block[k][0] * p_change);
        }
        let trial = [r[1] - tangential_rho * y[1], r[2] - tangential_rho * y[2]];
        let shear = bounds.project_shear(p, trial, trial[0].hypot(trial[1]));
        let shear_change = [shear[0] - r[1], shear[1] - r[2]];
        if shear_change != [0.0; 2] {
            for k in 0..3 {
                y[k] += block[k][1] * shear_change[0] + block[k][2] * shear_change[1];
            }
        }
        r = [p, shear[0], shear[1]];
        let change = magnitude_sum([p_change, shear_change[0], shear_change[1]]);
        if change.is_nan() || change <= tolerance {
            break;
        }
        if projection == 0 {
            tolerance = tolerance.max(FIRST_CHANGE_FRACTION * change);
        }
    }
    r
}
