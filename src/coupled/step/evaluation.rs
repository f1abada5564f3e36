//! Nonlinear force of an iterate of Newton's method, and operators with its tangent.

use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::scene::Scene;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::step::forcing::StepData;
use crate::coupled::step::linear::LinearStep;
use crate::error::StepError;
use crate::linalg::SparseMatrix;

/// Computes the operators with a tangent, if it differs from the last one.
pub(super) fn change_tangent(
    linear: &mut LinearStep,
    data: StepData<'_>,
    tangent: &SparseMatrix,
) -> Result<(), StepError> {
    if tangent.differs_from(&linear.operators.tangent) {
        let Scene { model, base, step_compliance, coefficients, .. } = data.scene;
        linear
            .operators
            .change_tangent(model, base, step_compliance, coefficients, tangent)
            .map_err(StepError::part("tangent of the structure"))?;
        linear.contact.invalidate();
    }
    Ok(())
}

/// Evaluates f at u* for an iterate of Δu, minus f at the static state.
///
/// `displacement` becomes u*.
pub(super) fn evaluate_force(
    linear: &mut LinearStep,
    data: StepData<'_>,
    guess: &[f64],
    displacement: &mut [f64],
    force: &mut [f64],
) -> Result<(), StepError> {
    let StepData { scene, structure, state, forcing } = data;
    let c = scene.coefficients.displacement;
    let Kinematics { displacement: u, velocity: v, acceleration: a, .. } = &state.kinematics;
    for (i, entry) in displacement.iter_mut().enumerate() {
        *entry = u[i] + SchemeCoefficients::apply(c, guess[i], v[i], a[i]);
    }
    let translations = forcing
        .translations
        .iter()
        .map(|y| [0, 1, 2].map(|k| y.displacement[k] - (1.0 - c[0]) * y.increment[k]));
    scene.convert_to_force_displacement(displacement, &mut linear.base_means, translations);
    force.fill(0.0);
    if let Some(nonlinear_force) = structure.nonlinear() {
        nonlinear_force
            .force(displacement, force)
            .map_err(StepError::part("nonlinear force of the structure"))?;
    }
    for (force, static_force) in force.iter_mut().zip(&scene.static_state.force) {
        *force -= static_force;
    }
    StepError::check_finite("nonlinear force of the structure", force)
}
