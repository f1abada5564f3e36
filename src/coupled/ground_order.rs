//! Whether a ground is of first order in the time step.

use std::any::Any;

use crate::bem::{Ground, GroundDescription, SpringGround, WeightsGround};
use crate::error::{Result, same_length, unobserved};
use crate::geometry::ContactLayout;

/// Time step over the trial step.
///
/// Waves cross few elements in the trial step, and dashpots hardly move: only an elastic part has a compliance left.
const TRIAL_STEP_DIVISOR: f64 = 64.0;
/// Smallest step compliance for the trial step, over that for the time step, of a ground with an elastic part.
const ELASTIC_COMPLIANCE_RATIO: f64 = 0.8;
/// Largest displacement by past tractions, over the displacement at the end of a first step, in the mid-step form.
///
/// An elastic part in the mid-step form has −1; without history it has 0. A bed of springs k and dashpots c in the mid-step
/// form has (c/δ − k/2)/(c/δ + k/2) in a trial step δ. Above −¼ this means c/δ > 0.3 k, and the bed's ratio of step
/// compliances is then below 0.63: it never counts as first order.
const PAST_DISPLACEMENT_RATIO: f64 = -0.25;

/// Whether an elastic part of the ground takes the traction of a step as the traction at its end, s₁ = C τ.
///
/// Grounds of the crate and grounds with waves are not asked. The ground must be prepared again.
///
/// # Errors
/// If the ground cannot be prepared for the time step.
pub(crate) fn is_first_order(
    ground: &mut (dyn Ground + 'static),
    description: &GroundDescription,
    time_step: f64,
    layout: ContactLayout,
) -> Result<bool> {
    if is_of_the_crate(ground) || description.shear_wave_speed.is_some() {
        return Ok(false);
    }
    let in_step = uniform_response(ground, time_step, layout)?;
    // A ground may refuse steps other than the run's.
    let Ok(in_trial) = uniform_response(ground, time_step / TRIAL_STEP_DIVISOR, layout) else {
        return Ok(false);
    };
    let is_elastic: Vec<bool> = in_step
        .iter()
        .zip(&in_trial)
        .map(|(step, trial)| *step > 0.0 && *trial >= ELASTIC_COMPLIANCE_RATIO * step)
        .collect();
    if !is_elastic.contains(&true) {
        return Ok(false);
    }
    ground.commit(&vec![1.0; layout.len()]);
    let mut past = vec![0.0; layout.len()];
    if ground.history(&mut past).is_err() {
        return Ok(false);
    }
    let past = sums(&past, layout);
    Ok((0..layout.components())
        .any(|k| is_elastic[k] && past[k] > PAST_DISPLACEMENT_RATIO * in_trial[k]))
}

/// Sum of the displacements of each component, m, at the end of a first step with tractions of 1 Pa.
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
        return Ok(sums(&diagonal.in_step, layout));
    }
    let mut matrix = vec![0.0; layout.square()];
    ground.step_compliance(&mut matrix)?;
    let rows: Vec<f64> = matrix.chunks(layout.len()).map(|row| row.iter().sum()).collect();
    Ok(sums(&rows, layout))
}

/// Sums over the elements of each component of a contact vector.
fn sums(vector: &[f64], layout: ContactLayout) -> Vec<f64> {
    vector.chunks(layout.elements()).map(|component| component.iter().sum()).collect()
}

/// Whether the ground, in any boxes, is a spring bed, whose θ may damp by choice, or has convolution weights.
fn is_of_the_crate(mut ground: &(dyn Ground + 'static)) -> bool {
    while let Some(inner) = (ground as &dyn Any).downcast_ref::<Box<dyn Ground>>() {
        ground = inner.as_ref();
    }
    let ground: &dyn Any = ground;
    ground.is::<SpringGround>() || ground.is::<WeightsGround>()
}
