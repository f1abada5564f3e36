//! Sweeps over the elements (Gauss–Seidel), each solved with the forces of all others fixed.

use super::problem::Problem;
use crate::linalg::transposed_multiply_add;

/// Largest number of projections of an element in a sweep.
const LOCAL: usize = 40;
/// Number of sweeps after which the rate of convergence is known.
const KNOWN: usize = 4;
/// Change at which sweeps end, as a fraction of the residual of a solution.
const GOAL: f64 = 1e-2;

impl Problem {
    /// Makes up to `most` sweeps; returns their number, and whether they found a solution.
    ///
    /// Sweeps that will not converge end early.
    pub(super) fn sweep(&mut self, most: usize) -> (usize, bool) {
        self.respond();
        let mut before = f64::INFINITY;
        for sweep in 1..=most {
            let (mut largest, tolerance) = (0.0_f64, GOAL * self.tolerance());
            for e in 0..self.count {
                let change = self.relax(e, 0.1 * tolerance);
                largest = if change <= largest { largest } else { change };
            }
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

    /// Solves an element with the others fixed until its force changes by no more than `least`; returns its change, N.
    fn relax(&mut self, e: usize, least: f64) -> f64 {
        let places = self.places(e);
        let bounds = self.bounds[e];
        let [normal, tangential] = self.rho[e];
        let start = places.map(|i| self.force(i));
        let (mut r, mut y) = (start, places.map(|i| self.y[i]));
        let mut block = None;
        for _ in 0..LOCAL {
            let p = bounds.press(r[0] - normal * (y[0] - bounds.offset));
            let pressed = p - r[0];
            if pressed != 0.0 {
                let block = block.get_or_insert_with(|| self.block(e));
                (0..3).for_each(|k| y[k] += block[k][0] * pressed);
            }
            let [tx, ty] = bounds.shear(p, [r[1] - tangential * y[1], r[2] - tangential * y[2]]);
            let sheared = [tx - r[1], ty - r[2]];
            if sheared != [0.0; 2] {
                let block = block.get_or_insert_with(|| self.block(e));
                for k in 0..3 {
                    y[k] += block[k][1] * sheared[0] + block[k][2] * sheared[1];
                }
            }
            r = [p, tx, ty];
            let change = pressed.abs() + sheared[0].abs() + sheared[1].abs();
            if change.is_nan() || change <= least {
                break;
            }
        }
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
