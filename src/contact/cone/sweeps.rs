//! Sweeps over the elements (Gauss–Seidel), each solved with the forces of all others fixed.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::acceleration::Acceleration;
use super::group::LANE_COUNT;
use super::problem::{Bounds, ConeProblem, SolveOutcome, max_or_nan};
use crate::linalg::{Simd, WithSimd, transposed_multiply_add, vectorized};

/// Largest number of projections of an element in a sweep.
const MAX_LOCAL_PROJECTIONS: usize = 40;
/// Number of sweeps after which the rate of convergence is known.
const MIN_SWEEPS_FOR_RATE: usize = 4;
/// Largest change of the last sweep, as a fraction of the residual tolerance.
const SWEEP_TOLERANCE_FACTOR: f64 = 1e-2;
/// Largest change of an element's last projection, as a fraction of the change at which sweeps end.
const LOCAL_TOLERANCE_FACTOR: f64 = 0.1;
/// The same, as a fraction of its first projection's change: the other elements still move.
const FIRST_CHANGE_FRACTION: f64 = 0.1;
/// With blocks: change in a sweep after which all elements move, as a fraction of the changes since they last did; and
/// the largest number of sweeps between.
const FAR_FIELD_UPDATE_FRACTION: f64 = 3e-2;
const FAR_FIELD_UPDATE_INTERVAL: usize = 12;
/// With blocks: change up to a motion of all elements that needs no other sweep, as a fraction of the change at which
/// sweeps end.
const FAR_FIELD_TOLERANCE_FACTOR: f64 = 10.0;
/// With blocks: factor of the number of sweeps, which then are cheap beside a factorization.
const NEAR_FIELD_SWEEP_FACTOR: usize = 4;

/// Accelerated sweeps: their largest number, change at which they end as a fraction of the residual of a solution,
/// and the number of sweeps that may pass before the change falls by this factor.
const MAX_ACCELERATED_SWEEPS: usize = 200;
const ACCELERATED_CHANGE: f64 = 0.3;
const MIN_REDUCTION: f64 = 0.5;
const MAX_SWEEPS_WITHOUT_REDUCTION: usize = 30;

impl ConeProblem {
    /// Makes up to `max_count` sweeps; returns their number, and whether they found a solution.
    ///
    /// Sweeps that will not converge end early.
    pub(super) fn sweep(&mut self, max_count: usize) -> SolveOutcome {
        if self.near_field.is_some() {
            return self.sweep_near_field(NEAR_FIELD_SWEEP_FACTOR * max_count);
        }
        self.update_motions();
        let mut before = f64::INFINITY;
        for sweep in 1..=max_count {
            let tolerance = SWEEP_TOLERANCE_FACTOR * self.tolerance();
            let largest = self.relax_all(LOCAL_TOLERANCE_FACTOR * tolerance);
            if largest.is_nan() {
                return SolveOutcome::new(sweep, false);
            }
            if largest <= tolerance && self.is_solved() {
                return SolveOutcome::new(sweep, true);
            }
            // Factor by which a sweep reduces the change.
            let rate = largest / before;
            let remaining_sweeps = (tolerance / largest).ln() / rate.ln();
            if sweep > MIN_SWEEPS_FOR_RATE
                && (rate >= 1.0 || remaining_sweeps > 2.0 * (max_count - sweep) as f64)
            {
                return SolveOutcome::new(sweep, self.is_solved());
            }
            before = largest;
        }
        SolveOutcome::new(max_count, self.is_solved())
    }

    /// Makes accelerated sweeps until the largest change is below `relative_change` times the largest force.
    ///
    /// Returns their number, and whether they found a solution. Sweeps that hardly reduce the change end early.
    pub(super) fn sweep_accelerated(&mut self, relative_change: f64) -> SolveOutcome {
        let Some(mut acceleration) = self.acceleration.take() else {
            return SolveOutcome::new(0, false);
        };
        let result = self.sweep_with_acceleration(&mut acceleration, relative_change);
        self.acceleration = Some(acceleration);
        result
    }

    fn sweep_with_acceleration(
        &mut self,
        acceleration: &mut Acceleration,
        relative_change: f64,
    ) -> SolveOutcome {
        acceleration.restart();
        self.update_motions();
        let mut smallest_change = f64::INFINITY;
        let mut last_reduction = 0;
        for sweep in 1..=MAX_ACCELERATED_SWEEPS {
            let tolerance = ACCELERATED_CHANGE * self.tolerance();
            let sufficient_change = tolerance.max(relative_change * self.largest_force());
            acceleration.begin_sweep(&self.change);
            let largest = self.relax_all(LOCAL_TOLERANCE_FACTOR * tolerance);
            if largest.is_nan() {
                return SolveOutcome::new(sweep, false);
            }
            if largest <= sufficient_change {
                let is_solved = self.is_solved();
                if is_solved || largest > tolerance {
                    return SolveOutcome::new(sweep, is_solved);
                }
            }
            if largest <= MIN_REDUCTION * smallest_change {
                smallest_change = largest;
                last_reduction = sweep;
            }
            if sweep - last_reduction == MAX_SWEEPS_WITHOUT_REDUCTION {
                return SolveOutcome::new(sweep, self.is_solved());
            }
            let Self { change, y, dense_lattice, .. } = self;
            if let Some(dense_lattice) = dense_lattice {
                let [normal, along_x, along_y, amplitudes] = dense_lattice.response_mut();
                acceleration.end_sweep(&mut [change, normal, along_x, along_y, amplitudes]);
            } else {
                acceleration.end_sweep(&mut [change, y]);
            }
        }
        SolveOutcome::new(MAX_ACCELERATED_SWEEPS, self.is_solved())
    }

    /// Sweeps over groups, with a far-field correction after several sweeps.
    ///
    /// A sweep moves near elements at once; the sum of several sweeps moves all others.
    fn sweep_near_field(&mut self, max_count: usize) -> SolveOutcome {
        self.update_motions();
        self.applied.copy_from_slice(&self.change);
        self.read_groups();
        let mut previous_far_change = f64::INFINITY;
        // Changes in the first and in the last sweep since the last far-field correction, and number of these sweeps.
        let mut first_change = 0.0;
        let mut last_change = f64::INFINITY;
        let mut sweeps = 0;
        let tolerance = SWEEP_TOLERANCE_FACTOR * self.tolerance();
        for sweep in 1..=max_count {
            let largest = vectorized(NearFieldSweep(self));
            if largest.is_nan() {
                self.write_groups();
                return SolveOutcome::new(sweep, false);
            }
            sweeps += 1;
            if sweeps == 1 {
                first_change = largest;
            }
            if largest > tolerance.max(FAR_FIELD_UPDATE_FRACTION * first_change)
                && sweeps < FAR_FIELD_UPDATE_INTERVAL
            {
                if sweeps > MIN_SWEEPS_FOR_RATE && largest >= last_change {
                    self.write_groups();
                    return SolveOutcome::new(sweep, self.is_solved());
                }
                last_change = largest;
                continue;
            }
            let far_change = self.move_far();
            if largest <= tolerance
                && far_change <= FAR_FIELD_TOLERANCE_FACTOR * tolerance
                && self.near_field_is_solved()
            {
                return SolveOutcome::new(sweep, true);
            }
            // Factor by which these sweeps reduce the change.
            let rate = far_change / previous_far_change;
            let remaining_sweeps = (tolerance / far_change).ln() / rate.ln() * sweeps as f64;
            if sweep > MIN_SWEEPS_FOR_RATE
                && (rate >= 1.0 || remaining_sweeps > 2.0 * (max_count - sweep) as f64)
            {
                return SolveOutcome::new(sweep, self.near_field_is_solved());
            }
            previous_far_change = far_change;
            last_change = f64::INFINITY;
            sweeps = 0;
        }
        self.write_groups();
        SolveOutcome::new(max_count, self.is_solved())
    }

    /// Copies the numbers of all elements to their groups.
    fn read_groups(&mut self) {
        let mut groups = std::mem::take(&mut self.groups);
        let elements = self.near_field.iter().flat_map(|near_field| &near_field.groups);
        for (group, elements) in groups.iter_mut().zip(elements) {
            *group = self.group(*elements);
        }
        self.groups = groups;
    }

    /// Copies the forces of all groups to their elements.
    fn write_groups(&mut self) {
        let Self { near_field, groups, change, count, .. } = self;
        let Some(near_field) = near_field else { return };
        for (elements, group) in near_field.groups.iter().zip(groups) {
            for (lane, e) in elements.iter().enumerate().filter(|(_, e)| **e < *count) {
                (0..3).for_each(|k| change[k * *count + e] = group.change[k][lane]);
            }
        }
    }

    /// Far-field correction: adds the motions by changes of force on distant elements.
    ///
    /// Returns the largest change of force since the last correction, N.
    fn move_far(&mut self) -> f64 {
        self.write_groups();
        let Self { near_field, change, applied, .. } = self;
        let mut largest_change = 0.0_f64;
        for (applied, change) in applied.iter_mut().zip(&*change) {
            *applied = change - *applied;
            largest_change = largest_change.max(applied.abs());
        }
        if let Some(near_field) = near_field {
            near_field.move_far(applied);
        }
        applied.copy_from_slice(change);
        largest_change
    }

    /// Relaxes all elements in turn, as [`ConeProblem::relax`]; returns the largest change (N), or NaN.
    pub(super) fn relax_all(&mut self, tolerance: f64) -> f64 {
        if self.dense_lattice.is_some() {
            return vectorized(DenseLatticeSweep { problem: self, tolerance });
        }
        if self.low_rank.is_some() {
            return self.relax_all_by_modes(tolerance);
        }
        (0..self.count).map(|e| self.relax(e, tolerance)).fold(0.0, max_or_nan)
    }

    /// Relaxes all elements in turn, with W of low rank.
    fn relax_all_by_modes(&mut self, tolerance: f64) -> f64 {
        let Some(mut low_rank) = self.low_rank.take() else { return f64::NAN };
        let mut largest_change = 0.0;
        for e in 0..self.count {
            let places = self.places(e);
            let motion = low_rank.motion(e, places.map(|i| self.change[i]));
            let r = self.relaxed_with_motion(e, motion, tolerance);
            let moved = [0, 1, 2].map(|k| r[k] - self.force(places[k]));
            if moved != [0.0; 3] {
                (0..3).for_each(|k| self.set_force(places[k], r[k]));
                low_rank.push(e, moved);
            }
            largest_change =
                max_or_nan(largest_change, moved[0].abs() + moved[1].abs() + moved[2].abs());
        }
        self.low_rank = Some(low_rank);
        largest_change
    }

    /// Force of an element with all other forces fixed, for its present motion by W without `added`.
    #[inline(always)]
    fn relaxed_with_motion(&self, e: usize, motion: [f64; 3], tolerance: f64) -> [f64; 3] {
        let places = self.places(e);
        let mut start = [0.0; 3];
        let mut y = motion;
        for k in 0..3 {
            start[k] = self.force(places[k]);
            y[k] += self.q[places[k]] + self.added * self.change[places[k]];
        }
        relaxed_force(&self.bounds[e], self.rho[e], &self.element_blocks[e], start, y, tolerance)
    }

    /// Relaxes one element with all other forces fixed; returns the change of its force (N).
    ///
    /// It ends when the force changes by less than `tolerance` or a tenth of the first change.
    fn relax(&mut self, e: usize, tolerance: f64) -> f64 {
        let places = self.places(e);
        let start = places.map(|i| self.force(i));
        let rho = self.rho[e];
        let y = places.map(|i| self.y[i]);
        let r = relaxed_force(&self.bounds[e], rho, &self.element_blocks[e], start, y, tolerance);
        let mut change = 0.0;
        for (k, &i) in places.iter().enumerate() {
            let moved = r[k] - start[k];
            if moved != 0.0 {
                // W is symmetric: its rows are its columns.
                let size = self.size();
                transposed_multiply_add(&self.w[i * size..][..size], 1.0, &[moved], &mut self.y);
                self.set_force(i, r[k]);
            }
            change += moved.abs();
        }
        change
    }
}

/// Force of an element with the forces of others fixed, for its present force and motion.
///
/// It is projected until it changes by at most `tolerance`, or by little compared with the first projection.
#[inline(always)]
fn relaxed_force(
    bounds: &Bounds,
    [normal, tangential]: [f64; 2],
    block: &[[f64; 3]; 3],
    start: [f64; 3],
    mut y: [f64; 3],
    mut tolerance: f64,
) -> [f64; 3] {
    let mut r = start;
    for projection in 0..MAX_LOCAL_PROJECTIONS {
        let p = bounds.project_pressure(r[0] - normal * (y[0] - bounds.offset), normal);
        let pressed = p - r[0];
        if pressed != 0.0 {
            (0..3).for_each(|k| y[k] += block[k][0] * pressed);
        }
        let trial = [r[1] - tangential * y[1], r[2] - tangential * y[2]];
        let shear = bounds.project_shear(p, trial, trial[0].hypot(trial[1]));
        let sheared = [shear[0] - r[1], shear[1] - r[2]];
        if sheared != [0.0; 2] {
            for k in 0..3 {
                y[k] += block[k][1] * sheared[0] + block[k][2] * sheared[1];
            }
        }
        r = [p, shear[0], shear[1]];
        let change = pressed.abs() + sheared[0].abs() + sheared[1].abs();
        if change.is_nan() || change <= tolerance {
            break;
        }
        if projection == 0 {
            tolerance = tolerance.max(FIRST_CHANGE_FRACTION * change);
        }
    }
    r
}

/// A sweep over groups that moves near elements, and all by the structure.
struct NearFieldSweep<'a>(&'a mut ConeProblem);

impl WithSimd for NearFieldSweep<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let ConeProblem { near_field, groups, added, .. } = self.0;
        let Some(near_field) = near_field else { return f64::NAN };
        let mut largest_change = 0.0;
        let mut moved = [[0.0; LANE_COUNT]; 3];
        for (g, group) in groups.iter_mut().enumerate() {
            let largest = group.solve(simd, &near_field.motion(simd, g), *added, &mut moved);
            near_field.push(simd, g, &moved);
            largest_change = max_or_nan(largest_change, largest);
        }
        largest_change
    }
}

/// A sweep by tables over the offset: all elements in turn.
struct DenseLatticeSweep<'a> {
    problem: &'a mut ConeProblem,
    tolerance: f64,
}

impl WithSimd for DenseLatticeSweep<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { problem, tolerance } = self;
        let mut largest_change = 0.0;
        for e in 0..problem.count {
            let places = problem.places(e);
            let mut change = [0.0; 3];
            for k in 0..3 {
                change[k] = problem.change[places[k]];
            }
            let Some(dense_lattice) = &problem.dense_lattice else { return f64::NAN };
            let r = problem.relaxed_with_motion(e, dense_lattice.motion(e, change), tolerance);
            let mut moved = [0.0; 3];
            for k in 0..3 {
                moved[k] = r[k] - problem.force(places[k]);
                problem.change[places[k]] = r[k] - problem.anchor[places[k]];
            }
            if moved != [0.0; 3]
                && let Some(dense_lattice) = &mut problem.dense_lattice
            {
                dense_lattice.push(simd, e, moved);
            }
            largest_change =
                max_or_nan(largest_change, moved[0].abs() + moved[1].abs() + moved[2].abs());
        }
        largest_change
    }
}
