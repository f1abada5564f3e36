//! Convergence of the search for a static state, from the change of its iterates.

use crate::coupled::model::assembled::Assembled;
use crate::coupled::statics::compliance::Compliance;
use crate::linalg::{SparseMatrix, largest};

/// Number of iterations after which a change of up to [`LATE_CHANGE_TOLERANCE`] is accepted.
///
/// The condition number must explain the change: rounding limits the convergence of a very stiff structure.
const LATE_ITERATION_COUNT: usize = 100;
/// Largest change that is accepted after [`LATE_ITERATION_COUNT`] iterations.
///
/// Its error is far below the errors of the steps.
const LATE_CHANGE_TOLERANCE: f64 = 1e-8;
/// Change at which the search has converged: near rounding of the sum of all forces.
const CHANGE_TOLERANCE: f64 = 1e-13;
/// Largest change of an iteration that does not converge any further.
const STALLED_CHANGE_TOLERANCE: f64 = 1e-10;
/// Smallest ratio of two successive changes of an iteration that does not converge any further.
const STALLED_CHANGE_RATIO: f64 = 0.5;
/// Largest relative difference of two successive changes of a steady drift.
const STEADY_DRIFT_RATIO: f64 = 1e-3;
/// Largest unbalanced force of a steady drift, relative to the load.
const STEADY_DRIFT_TOLERANCE: f64 = 1e-8;
/// Force of the springs, relative to the load, below which rounding may stop its decrease.
const SPRING_FORCE_TOLERANCE: f64 = 1e-6;
/// Number of iterations after which only rounding explains a force of the springs.
///
/// The condition number must then explain it. Even a force below [`SPRING_FORCE_TOLERANCE`] can make an element with a
/// small pressure alternate between two modes, with a large change of shear.
const ROUNDING_CHECK_ITERATION: usize = 20;
/// Smallest ratio of two successive steps that are extrapolated; with a smaller ratio they converge soon.
const MIN_EXTRAPOLATED_RATIO: f64 = 0.5;
/// Smallest squared cosine between two successive steps that are extrapolated.
const COLLINEARITY_THRESHOLD: f64 = 0.9999;

/// Whether the search has converged.
///
/// `previous_change` and `change` are the forces of the springs in the last two iterations, relative to the load.
pub(super) fn has_converged(
    previous_change: f64,
    change: f64,
    iterations: usize,
    compliance: &Compliance,
) -> bool {
    // The force of the springs has reached the accuracy of the solution.
    let has_stalled =
        change <= STALLED_CHANGE_TOLERANCE && change >= STALLED_CHANGE_RATIO * previous_change;
    // A motion without resistance, for example of a frictionless base along the ground, drifts by the same amount in each
    // iteration, because of rounding in the row sums of K.
    let has_steady_drift = change <= STEADY_DRIFT_TOLERANCE
        && (change - previous_change).abs() <= STEADY_DRIFT_RATIO * change;
    if change <= CHANGE_TOLERANCE || has_stalled || has_steady_drift {
        return true;
    }
    iterations > LATE_ITERATION_COUNT
        && change <= LATE_CHANGE_TOLERANCE
        && change <= compliance.factor.condition() * f64::EPSILON
}

/// Force of the springs that counts as rounding, relative to the load.
pub(super) fn spring_force_rounding(iterations: usize, compliance: &Compliance) -> f64 {
    match iterations {
        0..ROUNDING_CHECK_ITERATION => SPRING_FORCE_TOLERANCE,
        _ => SPRING_FORCE_TOLERANCE.min(compliance.factor.condition() * f64::EPSILON),
    }
}

/// Factor of the last step that extrapolates a geometric series of steps.
///
/// The extrapolation ends at the limit of the series (Aitken 1926). The factor is zero unless the two steps are
/// collinear, decrease, and decrease slowly. Elements that open increase the distance to the limit. The extrapolation
/// therefore does not pass an unstable equilibrium.
pub(super) fn extrapolation_factor(
    mass: &SparseMatrix,
    previous_step: &[f64],
    last_step: &[f64],
) -> f64 {
    if previous_step.len() != last_step.len() {
        return 0.0;
    }
    let previous_square = mass.form(previous_step, previous_step);
    let last_square = mass.form(last_step, last_step);
    let product = mass.form(previous_step, last_step);
    let ratio = product / previous_square;
    let is_collinear = product * product > COLLINEARITY_THRESHOLD * previous_square * last_square;
    let is_series = product > 0.0 && is_collinear;
    let is_slow = ratio > MIN_EXTRAPOLATED_RATIO && ratio < 1.0 - f64::EPSILON.sqrt();
    if is_series && is_slow { ratio / (1.0 - ratio) } else { 0.0 }
}

/// Norm of forces relative to the load.
///
/// Each component is divided by the square root of its mass, so that forces and moments are comparable in any units.
pub(super) struct RelativeForceNorm {
    /// Weight of each component.
    weights: Vec<f64>,
    /// Weighted norm of the load.
    load_norm: f64,
}

impl RelativeForceNorm {
    /// Norm relative to a load on the degrees of freedom.
    pub(super) fn new(assembled: &Assembled, load: &[f64]) -> Self {
        let mut weights = assembled.mass.diagonal();
        for weight in &mut weights {
            *weight = if *weight > 0.0 { weight.sqrt().recip() } else { 0.0 };
        }
        let weighted_loads = weights.iter().zip(load).map(|(w, f)| w * f.abs());
        let load_norm = weighted_loads.fold(0.0_f64, f64::max);
        if load_norm > 0.0 && load_norm.is_finite() {
            return Self { weights, load_norm };
        }
        // The load acts on massless degrees of freedom only.
        let weights = vec![1.0; load.len()];
        Self { load_norm: largest(load).max(f64::MIN_POSITIVE), weights }
    }

    /// Norm of a force; infinite if a component is not finite.
    pub(super) fn of(&self, force: &[f64]) -> f64 {
        let weighted_forces = self.weights.iter().zip(force).map(|(w, f)| w * f.abs());
        // `max` ignores NaN, but a sum does not.
        let sum: f64 = force.iter().sum();
        if sum.is_finite() {
            weighted_forces.fold(0.0, f64::max) / self.load_norm
        } else {
            f64::INFINITY
        }
    }
}
