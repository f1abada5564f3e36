//! Preparation of the ground for the steps of a run.

use crate::Simulation;
use crate::coupled::builder::MIN_ENDLESS_STEPS;
use crate::error::{Error, Observer, Result, unobserved};

impl Simulation {
    /// Prepares the ground for `steps` further steps, with an observer.
    ///
    /// The ground computes its convolution weights and allocates memory. A run of as many steps then begins at once,
    /// with unchanged results. [`Observer`] has an example. 2⁴⁰ steps or more have no known end: nothing is done.
    ///
    /// # Errors
    /// [`Error::Stopped`] by the observer, and the simulation stays unchanged; [`Error::Memory`] for more steps than fit
    /// into the memory of the ground's history; as for [`Ground::prepare`](crate::bem::Ground::prepare).
    pub fn prepare(&mut self, steps: usize, observer: &mut Observer<'_>) -> Result<()> {
        let made = self.state.step;
        let end = made.saturating_add(steps);
        if end <= self.prepared || end >= MIN_ENDLESS_STEPS {
            return Ok(());
        }
        let time_step = self.scene.time_step;
        if made == 0 {
            self.ground.prepare(time_step, Some(end), observer)?;
            self.prepared = end;
            return Ok(());
        }
        // A ground that cannot be saved grows step by step.
        let Ok(saved) = self.ground.save() else { return Ok(()) };
        // Doubled, so that many short runs prepare seldom; histories grow by powers of two.
        let mut prepared = end.next_power_of_two();
        match self.ground.prepare(time_step, Some(prepared), observer) {
            Err(error) if matches!(error, Error::Stopped(_)) || prepared == end => {
                return Err(error);
            }
            Err(_) => {
                prepared = end;
                self.ground.prepare(time_step, Some(end), observer)?;
            }
            Ok(()) => {}
        }
        if let Err(error) = self.ground.restore(made, &saved) {
            // Restores the ground's earlier state.
            let before = Some(self.prepared).filter(|steps| *steps > 0);
            self.ground.prepare(time_step, before, &mut unobserved)?;
            self.ground.restore(made, &saved)?;
            return Err(error);
        }
        self.prepared = prepared;
        Ok(())
    }
}
