//! A scene without its numerical settings, and its runs.

use basemat::Simulation;
use basemat::Soil;
use basemat::coupled::SimulationBuilder;
use cpu_time::ThreadTime;

use super::force::ForceSeries;
use super::settings::Settings;
use crate::AnyError;

/// A scene but for mesh of the ground, time step, history and time scheme.
pub(crate) struct PrecisionScene {
    pub(crate) name: &'static str,
    pub(crate) soil: Soil,
    /// Width of the base, m; its middle is at 0.
    pub(crate) width: f64,
    /// Time to compute, s.
    pub(crate) duration: f64,
    /// Adds structure, interface law and motion to the builder.
    pub(crate) parts: Box<AddParts>,
}

type AddParts = dyn Fn(SimulationBuilder) -> basemat::Result<SimulationBuilder>;

/// Base shear of a run, and its time.
pub(crate) struct SceneRun {
    pub(crate) force: ForceSeries,
    /// Processor time of build and run, s.
    pub(crate) seconds: f64,
}

impl PrecisionScene {
    /// Steps that cover the scene.
    pub(crate) fn steps(&self, time_step: f64) -> usize {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above zero")]
        let steps = (self.duration / time_step - 1e-6).ceil().max(1.0) as usize;
        steps
    }

    /// Runs the scene with these settings.
    ///
    /// Time is processor time of this thread, which includes convolution weights, factors and static state.
    pub(crate) fn run(&self, settings: &Settings) -> Result<SceneRun, AnyError> {
        let steps = self.steps(settings.time_step);
        let start_time = ThreadTime::try_now()?;
        let builder = Simulation::builder(settings.time_step)
            .ground(settings.ground(self.soil, 0.5 * self.width)?)
            .expected_steps(steps);
        let mut simulation = settings.scheme.add_to((self.parts)(builder)?)?.build()?;
        let mut mean_shears = Vec::with_capacity(steps);
        let run = simulation.run(steps, |state| mean_shears.push(state.base_shear))?;
        let seconds = start_time.try_elapsed()?.as_secs_f64();
        // A run without energy balance is an error.
        if run.energy_error > 1e-6 {
            return Err(
                format!("{}: energy balance open by {:.1e}", self.name, run.energy_error).into()
            );
        }
        Ok(SceneRun { force: ForceSeries::new(settings.time_step, mean_shears), seconds })
    }
}
