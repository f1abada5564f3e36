//! Check whether a user's ground is of first order in the time step.

use std::any::Any;

use crate::bem::{Ground, GroundDescription, SpringGround, WeightsGround};
use crate::error::{Result, same_length, unobserved};
use crate::geometry::ContactLayout;

/// Time step over the trial step.
///
/// In the trial step waves cross few elements and dashpots hardly move. Only an elastic part then has a compliance.
const TRIAL_STEP_DIVISOR: f64 = 64.0;
/// Smallest ratio of the step compliances of trial step and time step of a ground with an elastic part.
const ELASTIC_COMPLIANCE_RATIO: f64 = 0.8;
/// Ratio of the displacements due to past and present tractions, up to which tractions act in mid-step.
///
/// An elastic part whose tractions act in mid-step has the ratio −1; without history it has 0. A bed of springs k and
/// dashpots c with tractions in mid-step has (c/δ − k/2)/(c/δ + k/2) in a trial step δ. Above −¼ this means c/δ > 0.3 k.
/// The bed's ratio of step compliances is then below 0.63, so that the bed never counts as first order.
const PAST_DISPLACEMENT_RATIO: f64 = -0.25;

/// Response of a user's ground in a trial step, which may belong to an elastic part of first order.
///
/// A ground of first order applies each traction at the end of its step: without waves and dashpots, its displacement
/// there is s₁ = C τ.
pub(crate) struct TrialResponse {
    /// For each component of the contact, the sum of the displacements at the end of a first step, m.
    ///
    /// Zero for a component whose tractions act in mid-step.
    displacements: Vec<f64>,
}

impl TrialResponse {
    /// Prepares the ground for a trial step; it must be prepared again afterwards.
    ///
    /// `None` for a ground that is not of first order: grounds of the crate and with waves, which need no trial, and
    /// grounds whose tractions act in mid-step. Also `None` for a ground that is not defined for the trial step.
    pub(crate) fn of(
        ground: &mut (dyn Ground + 'static),
        description: &GroundDescription,
        time_step: f64,
        layout: ContactLayout,
    ) -> Option<Self> {
        if is_crate_ground(ground) || description.shear_wave_speed.is_some() {
            return None;
        }
        // A ground may return an error for steps other than the run's.
        ground.prepare(time_step / TRIAL_STEP_DIVISOR, Some(2), &mut unobserved).ok()?;
        let mut displacements = uniform_response(ground, layout).ok()?;
        ground.commit(&vec![1.0; layout.len()]);
        let mut history = vec![0.0; layout.len()];
        ground.history(&mut history).ok()?;
        let past_displacements = component_sums(&history, layout);
        for (displacement, past) in displacements.iter_mut().zip(past_displacements) {
            let acts_at_end = past > PAST_DISPLACEMENT_RATIO * *displacement;
            if !acts_at_end {
                *displacement = 0.0;
            }
        }
        displacements
            .iter()
            .any(|displacement| *displacement > 0.0)
            .then_some(Self { displacements })
    }

    /// Whether the ground, prepared for its time step, has an elastic part of first order.
    ///
    /// # Errors
    /// If the ground has no step compliance.
    pub(crate) fn is_first_order(
        &self,
        ground: &dyn Ground,
        layout: ContactLayout,
    ) -> Result<bool> {
        let step_displacements = uniform_response(ground, layout)?;
        let mut pairs = step_displacements.iter().zip(&self.displacements);
        Ok(pairs.any(|(step, trial)| *step > 0.0 && *trial >= ELASTIC_COMPLIANCE_RATIO * step))
    }
}

/// Sum over the elements of each displacement component (m) at the end of a first step with tractions of 1 Pa.
fn uniform_response(ground: &dyn Ground, layout: ContactLayout) -> Result<Vec<f64>> {
    if let Some(diagonal) = ground.diagonal_compliance()? {
        same_length(
            "diagonal step compliance of the ground",
            diagonal.in_step.len(),
            layout.len(),
        )?;
        return Ok(component_sums(&diagonal.in_step, layout));
    }
    let mut matrix = vec![0.0; layout.square()];
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
