//! Check whether a user's ground is of first order in the time step.

use std::any::Any;

use crate::bem::{Ground, GroundDescription, SpringGround, WeightsGround};
use crate::error::{Result, same_length, unobserved};
use crate::geometry::ContactLayout;

/// Ratio of the time step to the trial step.
///
/// In the trial step waves cross few elements and dashpots hardly move. Only an elastic part then has a compliance.
const TRIAL_STEP_DIVISOR: f64 = 64.0;
/// Smallest ratio of the trial step's to the time step's compliance of an elastic part.
const ELASTIC_COMPLIANCE_RATIO: f64 = 0.8;
/// Largest ratio of displacements due to past and present tractions in mid-step.
///
/// Up to this ratio tractions act in mid-step. An elastic part whose tractions act in mid-step has the ratio −1;
/// without history it has 0. A bed of springs k and dashpots c with tractions in mid-step has (c/δ − k/2)/(c/δ + k/2)
/// in a trial step δ. Above −¼ this means c/δ > 0.3 k. The bed's ratio of step compliances is then below 0.64, so that
/// the bed never counts as first order.
const PAST_DISPLACEMENT_RATIO: f64 = -0.25;

/// Whether an elastic part of the ground applies each traction at the end of its step.
///
/// The displacement of the part at the end of a first step is then s₁ = C τ. Grounds of the crate and grounds with
/// waves return `false` without a trial. The ground must be prepared again after this function.
///
/// # Errors
/// If the ground cannot be prepared for the time step.
pub(crate) fn is_first_order(
    ground: &mut (dyn Ground + 'static),
    description: &GroundDescription,
    time_step: f64,
    layout: ContactLayout,
) -> Result<bool> {
    if is_crate_ground(ground) || description.shear_wave_speed.is_some() {
        return Ok(false);
    }
    let step_response = uniform_response(ground, time_step, layout)?;
    // A ground may return an error for steps other than the run's.
    let Ok(trial_response) = uniform_response(ground, time_step / TRIAL_STEP_DIVISOR, layout)
    else {
        return Ok(false);
    };
    let is_elastic: Vec<bool> = step_response
        .iter()
        .zip(&trial_response)
        .map(|(step, trial)| *step > 0.0 && *trial >= ELASTIC_COMPLIANCE_RATIO * step)
        .collect();
    if !is_elastic.contains(&true) {
        return Ok(false);
    }
    ground.commit(&vec![1.0; layout.len()]);
    let mut history = vec![0.0; layout.len()];
    if ground.history(&mut history).is_err() {
        return Ok(false);
    }
    let past_response = component_sums(&history, layout);
    Ok((0..layout.components())
        .any(|k| is_elastic[k] && past_response[k] > PAST_DISPLACEMENT_RATIO * trial_response[k]))
}

/// Displacements at the end of a first step with tractions of 1 Pa, m.
///
/// Each component is summed over the elements.
fn uniform_response(
    ground: &mut dyn Ground,
    time_step: f64,
    layout: ContactLayout,
) -> Result<Vec<f64>> {
    ground.prepare(time_step, Some(2), &mut unobserved)?;
    if let Some(diagonal) = ground.diagonal_compliance()? {
        same_length(
            "diagonal step compliance of the ground",
            diagonal.in_step.len(),
            layout.len(),
        )?;
        return Ok(component_sums(&diagonal.in_step, layout));
    }
    let mut matrix = vec![0.0; layout.matrix_len()];
    ground.step_compliance(&mut matrix)?;
    let row_sums: Vec<f64> = matrix.chunks(layout.len()).map(|row| row.iter().sum()).collect();
    Ok(component_sums(&row_sums, layout))
}

/// Sums over the elements of each component of a contact vector.
fn component_sums(vector: &[f64], layout: ContactLayout) -> Vec<f64> {
    vector.chunks(layout.elements()).map(|component| component.iter().sum()).collect()
}

/// Whether the ground, possibly in boxes, is a spring bed or has convolution weights.
///
/// The user chooses the algorithmic damping θ of a spring bed.
fn is_crate_ground(mut ground: &(dyn Ground + 'static)) -> bool {
    while let Some(inner) = (ground as &dyn Any).downcast_ref::<Box<dyn Ground>>() {
        ground = inner.as_ref();
    }
    let ground: &dyn Any = ground;
    ground.is::<SpringGround>() || ground.is::<WeightsGround>()
}
