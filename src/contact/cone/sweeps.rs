//! Sweeps over the elements (Gauss–Seidel), each solved with the forces of all others fixed.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::acceleration::Acceleration;
use super::group::LANES;
use super::problem::{Bounds, Problem};
use crate::linalg::{Simd, WithSimd, transposed_multiply_add, vectorized};

/// Largest number of projections of an element in a sweep.
const LOCAL: usize = 40;
/// Number of sweeps after which the rate of convergence is known.
const KNOWN: usize = 4;
/// Change at which sweeps end, as a fraction of the residual of a solution.
const GOAL: f64 = 1e-2;
/// Change at which projections of an element end, as a fraction of a change at which sweeps end.
const LEAST: f64 = 0.1;
/// The same, as a fraction of the first projection's change: other elements have not moved yet.
const PART: f64 = 0.1;
/// With blocks: change in a sweep after which all elements move, as a fraction of the changes since they last did; and
/// the largest number of sweeps between.
const SHARE: f64 = 3e-2;
const BETWEEN: usize = 12;
/// With blocks: change up to a motion of all elements that needs no other sweep, as a fraction of the change at which
/// sweeps end.
const FAR: f64 = 10.0;
/// With blocks: factor of the number of sweeps, which then are cheap beside a factorization.
const PATIENCE: usize = 4;

/// Accelerated sweeps: their largest number, change at which they end as a fraction of the residual of a solution,
/// and the number of sweeps that may pass before the change falls by this factor.
const MAX_ACCELERATED_SWEEPS: usize = 200;
const ACCELERATED_CHANGE: f64 = 0.3;
const MIN_REDUCTION: f64 = 0.5;
const MAX_SWEEPS_WITHOUT_REDUCTION: usize = 30;

impl Problem {
    /// Makes up to `max_count` sweeps; returns their number, and whether they found a solution.
    ///
    /// Sweeps that will not converge end early.
    pub(super) fn sweep(&mut self, max_count: usize) -> (usize, bool) {
        if self.blocks.is_some() {
            return self.sweep_blocks(PATIENCE * max_count);
        }
        self.respond();
        let mut before = f64::INFINITY;
        for sweep in 1..=max_count {
            let tolerance = GOAL * self.tolerance();
            let largest = self.relax_all(LEAST * tolerance);
            if largest.is_nan() {
                return (sweep, false);
            }
            if largest <= tolerance && self.is_solved() {
                return (sweep, true);
            }
            // Factor by which a sweep reduces the change.
            let rate = largest / before;
            let left = (tolerance / largest).ln() / rate.ln();
            if sweep > KNOWN && (rate >= 1.0 || left > 2.0 * (max_count - sweep) as f64) {
                return (sweep, self.is_solved());
            }
            before = largest;
        }
        (max_count, self.is_solved())
    }

    /// Makes accelerated sweeps until the largest change is below `relative_change` times the largest force.
    ///
    /// Returns their number, and whether they found a solution. Sweeps that hardly reduce the change end early.
    pub(super) fn sweep_accelerated(&mut self, relative_change: f64) -> (usize, bool) {
        let Some(mut acceleration) = self.acceleration.take() else { return (0, false) };
        let result = self.sweep_with(&mut acceleration, relative_change);
        self.acceleration = Some(acceleration);
        result
    }

    fn sweep_with(
        &mut self,
        acceleration: &mut Acceleration,
        relative_change: f64,
    ) -> (usize, bool) {
        acceleration.restart();
        self.respond();
        let mut smallest_change = f64::INFINITY;
        let mut last_reduction = 0;
        for sweep in 1..=MAX_ACCELERATED_SWEEPS {
            let tolerance = ACCELERATED_CHANGE * self.tolerance();
            let sufficient_change = tolerance.max(relative_change * self.largest());
            acceleration.begin_sweep(&self.change);
            let largest = self.relax_all(LEAST * tolerance);
            if largest.is_nan() {
                return (sweep, false);
            }
            if largest <= sufficient_change && (self.is_solved() || largest > tolerance) {
                return (sweep, self.is_solved());
            }
            if largest <= MIN_REDUCTION * smallest_change {
                smallest_change = largest;
                last_reduction = sweep;
            }
            if sweep - last_reduction == MAX_SWEEPS_WITHOUT_REDUCTION {
                return (sweep, self.is_solved());
            }
            let Self { change, y, wide, .. } = self;
            if let Some(wide) = wide {
                let [normal, along_x, along_y, amplitudes] = wide.response_mut();
                acceleration.end_sweep(&mut [change, normal, along_x, along_y, amplitudes]);
            } else {
                acceleration.end_sweep(&mut [change, y]);
            }
        }
        (MAX_ACCELERATED_SWEEPS, self.is_solved())
    }

    /// Sweeps over groups that move near elements at once, and all others by the sum of several sweeps.
    fn sweep_blocks(&mut self, most: usize) -> (usize, bool) {
        self.respond();
        self.applied.copy_from_slice(&self.change);
        self.read_groups();
        // Changes up to the last motion of all elements; in the first sweep since, and in the last; number of sweeps since.
        let (mut before, mut first, mut last, mut sweeps) = (f64::INFINITY, 0.0, f64::INFINITY, 0);
        let tolerance = GOAL * self.tolerance();
        for sweep in 1..=most {
            let largest = vectorized(Sweep(self));
            if largest.is_nan() {
                self.write_groups();
                return (sweep, false);
            }
            sweeps += 1;
            if sweeps == 1 {
                first = largest;
            }
            if largest > tolerance.max(SHARE * first) && sweeps < BETWEEN {
                if sweeps > KNOWN && largest >= last {
                    self.write_groups();
                    return (sweep, self.is_solved());
                }
                last = largest;
                continue;
            }
            let moved = self.move_far();
            if largest <= tolerance && moved <= FAR * tolerance && self.blocks_are_solved() {
                return (sweep, true);
            }
            // Factor by which these sweeps reduce the change.
            let rate = moved / before;
            let left = (tolerance / moved).ln() / rate.ln() * sweeps as f64;
            if sweep > KNOWN && (rate >= 1.0 || left > 2.0 * (most - sweep) as f64) {
                return (sweep, self.blocks_are_solved());
            }
            (before, last, sweeps) = (moved, f64::INFINITY, 0);
        }
        self.write_groups();
        (most, self.is_solved())
    }

    /// Copies the numbers of all elements to their groups.
    fn read_groups(&mut self) {
        let mut groups = std::mem::take(&mut self.groups);
        let elements = self.blocks.iter().flat_map(|blocks| &blocks.groups);
        for (group, elements) in groups.iter_mut().zip(elements) {
            *group = self.group(*elements);
        }
        self.groups = groups;
    }

    /// Copies the forces of all groups to their elements.
    fn write_groups(&mut self) {
        let Self { blocks, groups, change, count, .. } = self;
        let Some(blocks) = blocks else { return };
        for (elements, group) in blocks.groups.iter().zip(groups) {
            for (lane, e) in elements.iter().enumerate().filter(|(_, e)| **e < *count) {
                (0..3).for_each(|k| change[k * *count + e] = group.change[k][lane]);
            }
        }
    }

    /// Moves elements by changes of force on others that are not near; returns the largest change, N.
    fn move_far(&mut self) -> f64 {
        self.write_groups();
        let Self { blocks, change, applied, .. } = self;
        let mut most = 0.0_f64;
        for (applied, change) in applied.iter_mut().zip(&*change) {
            *applied = change - *applied;
            most = most.max(applied.abs());
        }
        if let Some(blocks) = blocks {
            blocks.move_far(applied);
        }
        applied.copy_from_slice(change);
        most
    }

    /// Solves all elements in turn, as [`Problem::relax`]; returns the largest change, N, or NaN.
    pub(super) fn relax_all(&mut self, least: f64) -> f64 {
        if self.wide.is_some() {
            return vectorized(WideSweep { problem: self, least });
        }
        if self.low_rank.is_some() {
            return self.relax_by_modes(least);
        }
        (0..self.count).map(|e| self.relax(e, least)).fold(0.0, larger)
    }

    /// The same with W of low rank, element by element.
    fn relax_by_modes(&mut self, least: f64) -> f64 {
        let Some(mut low_rank) = self.low_rank.take() else { return f64::NAN };
        let mut most = 0.0;
        for e in 0..self.count {
            let places = self.places(e);
            let (start, change) = (places.map(|i| self.force(i)), places.map(|i| self.change[i]));
            let mut y = low_rank.motion(e, change);
            for k in 0..3 {
                y[k] += self.q[places[k]] + self.added * change[k];
            }
            let r = alone(&self.bounds[e], self.rho[e], &self.own[e], start, y, least);
            let moved = [0, 1, 2].map(|k| r[k] - start[k]);
            if moved != [0.0; 3] {
                (0..3).for_each(|k| self.set(places[k], r[k]));
                low_rank.push(e, moved);
            }
            most = larger(most, moved[0].abs() + moved[1].abs() + moved[2].abs());
        }
        self.low_rank = Some(low_rank);
        most
    }

    /// Solves an element with the others fixed, to `least` or a part of its change; returns its change, N.
    fn relax(&mut self, e: usize, least: f64) -> f64 {
        let places = self.places(e);
        let start = places.map(|i| self.force(i));
        let (rho, y) = (self.rho[e], places.map(|i| self.y[i]));
        let r = alone(&self.bounds[e], rho, &self.own[e], start, y, least);
        let mut change = 0.0;
        for (k, &i) in places.iter().enumerate() {
            let moved = r[k] - start[k];
            if moved != 0.0 {
                // W is symmetric: its rows are its columns.
                let size = self.size();
                transposed_multiply_add(&self.w[i * size..][..size], 1.0, &[moved], &mut self.y);
                self.set(i, r[k]);
            }
            change += moved.abs();
        }
        change
    }
}

/// Force of an element with the forces of others fixed, for its present force and motion.
///
/// It is projected until it changes by no more than `least`, or by little beside the first projection.
#[inline(always)]
fn alone(
    bounds: &Bounds,
    [normal, tangential]: [f64; 2],
    block: &[[f64; 3]; 3],
    start: [f64; 3],
    mut y: [f64; 3],
    least: f64,
) -> [f64; 3] {
    let (mut r, mut least) = (start, least);
    for projection in 0..LOCAL {
        let p = bounds.press(r[0] - normal * (y[0] - bounds.offset));
        let pressed = p - r[0];
        if pressed != 0.0 {
            (0..3).for_each(|k| y[k] += block[k][0] * pressed);
        }
        let trial = [r[1] - tangential * y[1], r[2] - tangential * y[2]];
        let [tx, ty] = bounds.shear(p, trial, trial[0].hypot(trial[1]));
        let sheared = [tx - r[1], ty - r[2]];
        if sheared != [0.0; 2] {
            for k in 0..3 {
                y[k] += block[k][1] * sheared[0] + block[k][2] * sheared[1];
            }
        }
        r = [p, tx, ty];
        let change = pressed.abs() + sheared[0].abs() + sheared[1].abs();
        if change.is_nan() || change <= least {
            break;
        }
        if projection == 0 {
            least = least.max(PART * change);
        }
    }
    r
}

/// The larger of two changes, or NaN.
#[inline(always)]
fn larger(most: f64, change: f64) -> f64 {
    if change <= most { most } else { change }
}

/// A sweep over groups that moves near elements, and all by the structure.
struct Sweep<'a>(&'a mut Problem);

impl WithSimd for Sweep<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Problem { blocks, groups, added, .. } = self.0;
        let Some(blocks) = blocks else { return f64::NAN };
        let (mut most, mut moved) = (0.0, [[0.0; LANES]; 3]);
        for (g, group) in groups.iter_mut().enumerate() {
            let largest = group.solve(simd, &blocks.motion(simd, g), *added, &mut moved);
            blocks.push(simd, g, &moved);
            most = larger(most, largest);
        }
        most
    }
}

/// A sweep by tables: all elements in turn, each to `least` or a part of its change.
struct WideSweep<'a> {
    problem: &'a mut Problem,
    least: f64,
}

impl WithSimd for WideSweep<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { problem, least } = self;
        let mut most = 0.0;
        for e in 0..problem.count {
            let places = problem.places(e);
            let (mut start, mut change) = ([0.0; 3], [0.0; 3]);
            for k in 0..3 {
                (start[k], change[k]) = (problem.force(places[k]), problem.change[places[k]]);
            }
            let Some(wide) = &mut problem.wide else { return f64::NAN };
            let mut y = wide.motion(e, change);
            for k in 0..3 {
                y[k] += problem.q[places[k]] + problem.added * change[k];
            }
            let r = alone(&problem.bounds[e], problem.rho[e], &problem.own[e], start, y, least);
            let mut moved = [0.0; 3];
            for k in 0..3 {
                moved[k] = r[k] - start[k];
                problem.change[places[k]] = r[k] - problem.anchor[places[k]];
            }
            if moved != [0.0; 3] {
                wide.push(simd, e, moved);
            }
            most = larger(most, moved[0].abs() + moved[1].abs() + moved[2].abs());
        }
        most
    }
}
