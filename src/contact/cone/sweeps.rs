//! Sweeps over the elements (Gauss–Seidel), each solved with the forces of all others fixed.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

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
/// With blocks: change of an element's projections at which they end, as a fraction of the first.
const LOCAL_SHARE: f64 = 0.3;
/// With blocks: change in a sweep after which all elements move, as a fraction of the changes since they last did; and
/// the largest number of sweeps between.
const SHARE: f64 = 3e-2;
const BETWEEN: usize = 12;
/// With blocks: factor of the number of sweeps, which then are cheap beside a factorization.
const PATIENCE: usize = 4;

impl Problem {
    /// Makes up to `most` sweeps; returns their number, and whether they found a solution.
    ///
    /// Sweeps that will not converge end early.
    pub(super) fn sweep(&mut self, most: usize) -> (usize, bool) {
        if self.blocks.is_some() {
            return self.sweep_blocks(PATIENCE * most);
        }
        self.respond();
        let mut before = f64::INFINITY;
        for sweep in 1..=most {
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
            if sweep > KNOWN && (rate >= 1.0 || left > 2.0 * (most - sweep) as f64) {
                return (sweep, self.is_solved());
            }
            before = largest;
        }
        (most, self.is_solved())
    }

    /// Sweeps that move near elements at once, and all others by the sum of several sweeps.
    fn sweep_blocks(&mut self, most: usize) -> (usize, bool) {
        self.respond();
        self.applied.copy_from_slice(&self.change);
        // Changes up to the last motion of all elements, and in the last sweep; number of sweeps since that motion.
        let (mut before, mut last, mut sweeps) = (f64::INFINITY, f64::INFINITY, 0);
        for sweep in 1..=most {
            let tolerance = GOAL * self.tolerance();
            let largest = vectorized(Sweep { problem: self, least: LEAST * tolerance });
            if largest.is_nan() {
                return (sweep, false);
            }
            sweeps += 1;
            let changes = self.change.iter().zip(&self.applied).map(|(a, b)| (a - b).abs());
            let moved = changes.fold(0.0, f64::max);
            if largest > tolerance.max(SHARE * moved) && sweeps < BETWEEN {
                if sweeps > KNOWN && largest >= last {
                    return (sweep, self.is_solved());
                }
                last = largest;
                continue;
            }
            let reached = vectorized(Far { problem: self, least: LEAST * tolerance });
            if largest <= tolerance && (!reached || moved <= tolerance) && self.blocks_are_solved()
            {
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
        (most, self.is_solved())
    }

    /// Solves all elements in turn, as [`Problem::relax`]; returns the largest change, N, or NaN.
    fn relax_all(&mut self, least: f64) -> f64 {
        (0..self.count).map(|e| self.relax(e, least)).fold(0.0, larger)
    }

    /// Solves an element with the others fixed until its force changes by no more than `least`; returns its change, N.
    fn relax(&mut self, e: usize, least: f64) -> f64 {
        let places = self.places(e);
        let start = places.map(|i| self.force(i));
        let (rho, y) = (self.rho[e], places.map(|i| self.y[i]));
        let r = alone(&self.bounds[e], rho, &self.own[e], start, y, [least, 0.0], f64::hypot);
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
/// It is projected until it changes by no more than `least`, or by no more than a `share` of its first change.
#[inline(always)]
fn alone(
    bounds: &Bounds,
    [normal, tangential]: [f64; 2],
    block: &[[f64; 3]; 3],
    start: [f64; 3],
    mut y: [f64; 3],
    [mut least, share]: [f64; 2],
    magnitude: impl Fn(f64, f64) -> f64,
) -> [f64; 3] {
    let mut r = start;
    for local in 0..LOCAL {
        let p = bounds.press(r[0] - normal * (y[0] - bounds.offset));
        let pressed = p - r[0];
        if pressed != 0.0 {
            (0..3).for_each(|k| y[k] += block[k][0] * pressed);
        }
        let trial = [r[1] - tangential * y[1], r[2] - tangential * y[2]];
        let [tx, ty] = bounds.shear(p, trial, magnitude(trial[0], trial[1]));
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
        if local == 0 {
            least = least.max(share * change);
        }
    }
    r
}

/// The larger of two changes, or NaN.
fn larger(most: f64, change: f64) -> f64 {
    if change <= most { most } else { change }
}

/// A sweep over blocks that moves near elements, and all by the structure.
struct Sweep<'a> {
    problem: &'a mut Problem,
    least: f64,
}

impl WithSimd for Sweep<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { problem, least } = self;
        let mut most = 0.0;
        for e in 0..problem.count {
            let places = problem.places(e);
            let start = places.map(|i| problem.force(i));
            let (y, bounds, rho) = (problem.motion(simd, e), &problem.bounds[e], problem.rho[e]);
            let magnitude = |x: f64, y: f64| (x * x + y * y).sqrt();
            let r = alone(bounds, rho, &problem.own[e], start, y, [least, LOCAL_SHARE], magnitude);
            let moved: [f64; 3] = std::array::from_fn(|k| r[k] - start[k]);
            if moved != [0.0; 3] {
                places.into_iter().zip(r).for_each(|(i, r)| problem.set(i, r));
                if let Some(blocks) = &mut problem.blocks {
                    blocks.push_near(simd, e, moved);
                }
            }
            most = larger(most, moved.iter().map(|moved| moved.abs()).sum());
        }
        most
    }
}

/// Moves elements by changes of force on others that are not near; returns whether any added more than `least`, N.
struct Far<'a> {
    problem: &'a mut Problem,
    least: f64,
}

impl WithSimd for Far<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self { problem, least } = self;
        let mut reached = false;
        for e in 0..problem.count {
            let moved = problem.places(e).map(|i| problem.change[i] - problem.applied[i]);
            if let Some(blocks) = &mut problem.blocks {
                reached |= blocks.push_far(simd, e, moved, least);
            }
        }
        problem.applied.copy_from_slice(&problem.change);
        reached
    }
}
