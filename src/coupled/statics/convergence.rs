//! Convergence of the search for a static state, judged by the change of its iterates.

use crate::coupled::model::assembled::Assembled;
use crate::coupled::statics::compliance::Compliance;
use crate::linalg::{SparseMatrix, largest};

/// Iterations after which a change of up to [`LATE_CHANGE`] is accepted if the condition explains it: rounding
/// lets a very stiff structure converge no further.
const LATE_ITERATION_COUNT: usize = 100;
const LATE_CHANGE: f64 = 1e-8;
/// Largest unbalanced force of a steady drift, relative to the load.
const STEADY_DRIFT_TOLERANCE: f64 = 1e-8;
/// Force of the springs, relative to the load, below which rounding may stop its decrease.
const SPRING_FORCE_ROUNDING: f64 = 1e-6;
/// Iterations after which only a slow decrease that the condition explains counts as rounding. Even a force below
/// [`SPRING_FORCE_ROUNDING`] can make an element of little pressure switch its mode back and forth, and with it a large shear.
const ROUNDING_CHECK_ITERATION: usize = 20;
/// Smallest ratio of two successive steps from which they are extrapolated; with a smaller one they converge soon.
const MIN_EXTRAPOLATED_RATIO: f64 = 0.5;
/// Smallest squared cosine between two successive steps that are extrapolated.
const COLLINEARITY_THRESHOLD: f64 = 0.9999;

/// Whether the last two forces of the springs show convergence.
pub(super) fn has_converged(
    previous: f64,
    change: f64,
    iterations: usize,
    current: &Compliance,
) -> bool {
    // The force of the springs has the accuracy of the solution.
    let has_stalled = change <= 1e-10 && change >= 0.5 * previous;
    // A motion that nothing resists (a frictionless base along the ground) drifts for ever by the same amount under
    // the rounding of the sums of K, a fraction that grows with its size.
    let drifts = change <= STEADY_DRIFT_TOLERANCE && (change - previous).abs() <= 1e-3 * change;
    if change <= 1e-13 || has_stalled || drifts {
        return true;
    }
    iterations > LATE_ITERATION_COUNT
        && change <= LATE_CHANGE
        && change <= current.floating.condition() * f64::EPSILON
}

/// Force of the springs, relative to the load, that counts as rounding after a number of iterations.
pub(super) fn rounding(iterations: usize, current: &Compliance) -> f64 {
    match iterations {
        0..ROUNDING_CHECK_ITERATION => SPRING_FORCE_ROUNDING,
        _ => SPRING_FORCE_ROUNDING.min(current.floating.condition() * f64::EPSILON),
    }
}

/// Further steps to the limit of a geometric series with these two steps, in multiples of the last one (Aitken 1926).
///
/// Zero for steps that are no such series yet, grow, or become small quickly. Contact that opens on the way moves the limit
/// further away, so that the series does not pass an equilibrium from which the structure falls over.
pub(super) fn extrapolation(mass: &SparseMatrix, before: &[f64], last: &[f64]) -> f64 {
    if before.len() != last.len() {
        return 0.0;
    }
    let square_before = mass.form(before, before);
    let square_last = mass.form(last, last);
    let product = mass.form(before, last);
    let ratio = product / square_before;
    let is_collinear = product * product > COLLINEARITY_THRESHOLD * square_before * square_last;
    let is_series = product > 0.0 && is_collinear;
    let is_slow = ratio > MIN_EXTRAPOLATED_RATIO && ratio < 1.0 - f64::EPSILON.sqrt();
    if is_series && is_slow { ratio / (1.0 - ratio) } else { 0.0 }
}

/// Size of a force relative to the load: each component over the square root of its mass, so that forces and
/// moments compare in any units.
pub(super) struct Measure {
    weights: Vec<f64>,
    scale: f64,
}

impl Measure {
    pub(super) fn new(assembled: &Assembled, load: &[f64]) -> Self {
        let mut weights = assembled.mass.diagonal();
        for weight in &mut weights {
            *weight = if *weight > 0.0 { weight.sqrt().recip() } else { 0.0 };
        }
        let weighted = weights.iter().zip(load).map(|(w, f)| w * f.abs());
        let scale = weighted.fold(0.0_f64, f64::max);
        if scale > 0.0 && scale.is_finite() {
            return Self { weights, scale };
        }
        // Only massless degrees of freedom are loaded.
        let weights = vec![1.0; load.len()];
        Self { scale: largest(load).max(f64::MIN_POSITIVE), weights }
    }

    pub(super) fn norm(&self, force: &[f64]) -> f64 {
        let weighted = self.weights.iter().zip(force).map(|(w, f)| w * f.abs());
        // Unlike `max`, the sum keeps NaN.
        let sum: f64 = force.iter().sum();
        if sum.is_finite() {
            weighted.fold(0.0, f64::max) / self.scale
        } else {
            f64::INFINITY
        }
    }
}
