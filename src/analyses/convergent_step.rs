//! Longest time step that converges, where longer steps have no solution.

use crate::Simulation;
use crate::error::{Error, Result, StepError, not_negative, positive};

/// Largest number of halvings.
const MAX_STEP_HALVINGS: usize = 10;

/// The longest step with which a scene runs without a failed step.
///
/// The function tries `time_step` (s) and up to ten halvings of it. It runs the simulation that `scene` builds with
/// each step for `duration` (s). A failed step is [`StepError::Contact`], [`StepError::Cone`] or
/// [`StepError::Newton`]. The result is `None` if the tenth halving fails too.
///
/// A simulation cannot change its step, since the soil's convolution weights and its history belong to one step.
/// This function therefore runs whole simulations, each with twice as many steps as the previous simulation. To
/// save run time, pass the time of the failed step as `duration`.
///
/// ```
/// use basemat::bem::{ElasticGround, Grading, Strip};
/// use basemat::analyses::largest_convergent_step;
/// use basemat::interface::ThinLayer;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
/// use basemat::{Simulation, Soil};
///
/// // An interface that keeps 1/1000 of its stiffness when open, as in the paper of Patel & Spyrakos.
/// // Waves cross five elements in one step.
/// let scene = |step: f64| {
///     let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
///     let block = RigidBlock::new(10.0, 15.0, 900.0)?;
///     Simulation::builder(step)
///         .ground(ElasticGround::new(soil, Strip::under(&block, 10, Grading::Uniform)?)?)
///         .structure(block)
///         .interface(ThinLayer::new(soil, 1.0, 0.4)?.with_thickness_ratio(1e-3)?)
///         .motion(el_centro_1940().scaled(3.0)?)
///         .build()
/// };
/// let step = largest_convergent_step(0.0125, 5.0, scene)?;
/// assert!(step.is_some_and(|step| step <= 0.0125));
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// Errors of `scene`, and errors of steps that fail for another reason; [`Error::Input`] unless `time_step` is finite and
/// above zero and `duration` finite and not negative.
pub fn largest_convergent_step(
    time_step: f64,
    duration: f64,
    mut scene: impl FnMut(f64) -> Result<Simulation>,
) -> Result<Option<f64>> {
    let mut trial_step = positive("time step", time_step)?;
    not_negative("duration", duration)?;
    for _ in 0..=MAX_STEP_HALVINGS {
        let mut simulation = scene(trial_step)?;
        match simulation.run(simulation.steps_for(duration), |_| {}) {
            Ok(_) => return Ok(Some(trial_step)),
            Err(Error::Step {
                source:
                    StepError::Contact { .. } | StepError::Cone { .. } | StepError::Newton { .. },
                ..
            }) => trial_step *= 0.5,
            Err(error) => return Err(error),
        }
    }
    Ok(None)
}
