//! Preparation of the ground for the steps of a run: convolution weights and memory.

use crate::Simulation;
use crate::coupled::builder::MIN_ENDLESS_STEP_COUNT;
use crate::error::{Error, Observer, Result, unobserved};

impl Simulation {
    /// Prepares the ground for `steps` further steps, with an observer.
    ///
    /// The ground computes its convolution weights and allocates memory. A run of `steps` steps then begins without
    /// delay and has the same results. [`Observer`] has an example. For 2⁴⁰ steps or more, which stand for a run
    /// without a known end, nothing is prepared.
    ///
    /// # Errors
    /// [`Error::Stopped`] by the observer, and the simulation stays unchanged; [`Error::Memory`] for more steps than fit
    /// into the memory of the ground's history; as for [`Ground::prepare`](crate::bem::Ground::prepare).
    pub fn prepare(&mut self, steps: usize, observer: &mut Observer<'_>) -> Result<()> {
        let completed_steps = self.state.step;
        let last_step = completed_steps.saturating_add(steps);
        if last_step <= self.prepared_steps || last_step >= MIN_ENDLESS_STEP_COUNT {
            return Ok(());
        }
        let time_step = self.scene.time_step;
        if completed_steps == 0 {
            self.ground.prepare(time_step, Some(last_step), observer)?;
            self.prepared_steps = last_step;
            return Ok(());
        }
        // A ground that cannot be saved extends its history in each step.
        let Ok(saved_ground) = self.ground.save() else { return Ok(()) };
        // The next power of two limits the number of preparations in many short runs. Histories grow by powers of two.
        let mut prepared_steps = last_step.next_power_of_two();
        match self.ground.prepare(time_step, Some(prepared_steps), observer) {
            Err(error) if matches!(error, Error::Stopped(_)) || prepared_steps == last_step => {
                return Err(error);
            }
            Err(_) => {
                prepared_steps = last_step;
                self.ground.prepare(time_step, Some(last_step), observer)?;
            }
            Ok(()) => {}
        }
        if let Err(error) = self.ground.restore(completed_steps, &saved_ground) {
            // Returns the ground to its state before the call.
            let previous_steps = Some(self.prepared_steps).filter(|steps| *steps > 0);
            self.ground.prepare(time_step, previous_steps, &mut unobserved)?;
            self.ground.restore(completed_steps, &saved_ground)?;
            return Err(error);
        }
        self.prepared_steps = prepared_steps;
        Ok(())
    }
}
