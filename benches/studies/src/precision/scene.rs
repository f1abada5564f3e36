//! A scene, apart from how it is computed; its runs.

use basemat::Simulation;
use basemat::Soil;
use basemat::coupled::SimulationBuilder;
use cpu_time::ThreadTime;

use super::force::Force;
use super::settings::Settings;
use crate::AnyError;

/// A scene: everything but mesh of the ground, time step, history and time scheme.
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    pub(crate) soil: Soil,
    /// Width of the base, m; its middle is at 0.
    pub(crate) width: f64,
    /// Time to compute, s.
    pub(crate) duration: f64,
    /// Gives the builder structure, interface law and motion.
    pub(crate) parts: Box<GiveParts>,
}

type GiveParts = dyn Fn(SimulationBuilder) -> basemat::Result<SimulationBuilder>;

/// A run, and what it took.
pub(crate) struct Outcome {
    pub(crate) force: Force,
    /// Processor time of building and running, s.
    pub(crate) seconds: f64,
}

impl Scene {
    /// Steps that cover the scene.
    pub(crate) fn steps(&self, time_step: f64) -> usize {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above zero")]
        let steps = (self.duration / time_step - 1e-6).ceil().max(1.0) as usize;
        steps
    }

    /// Base shear under these settings. Time is the processor's for this thread: kernel, factors
    /// and static state included, another process on the machine not.
    pub(crate) fn run(&self, settings: &Settings) -> Result<Outcome, AnyError> {
        let steps = self.steps(settings.time_step);
        let begin = ThreadTime::try_now()?;
        let builder = Simulation::builder(settings.time_step)
            .ground(settings.ground(self.soil, 0.5 * self.width)?)
            .expected_steps(steps);
        let mut simulation = settings.scheme.give((self.parts)(builder)?)?.build()?;
        let mut means = Vec::with_capacity(steps);
        let run = simulation.run(steps, |state| means.push(state.base_shear))?;
        let seconds = begin.try_elapsed()?.as_secs_f64();
        // A run whose energies do not add up is not worth a place in a table.
        if run.energy_error > 1e-6 {
            return Err(
                format!("{}: energy balance open by {:.1e}", self.name, run.energy_error).into()
            );
        }
        Ok(Outcome { force: Force::new(settings.time_step, means), seconds })
    }
}
