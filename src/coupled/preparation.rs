//! Preparation of the ground for the steps of a run.

use crate::Simulation;
use crate::error::{Observer, Result};

/// Number of steps, and more, that stands for a run without a known end.
const ENDLESS: usize = match 1_usize.checked_shl(40) {
    Some(steps) => steps,
    None => usize::MAX >> 4,
};

impl Simulation {
    /// Prepares the ground for `steps` further steps, with an observer.
    ///
    /// The ground computes its convolution weights and allocates memory. A run of as many steps then begins at once,
    /// with unchanged results. [`Observer`] has an example. 2⁴⁰ steps or more have no known end: nothing is done.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped) by the observer, and the simulation stays unchanged; [`Error::Memory`](crate::Error::Memory) for more steps than
    /// fit into the memory of the ground's history; as for [`Ground::prepare`](crate::bem::Ground::prepare).
    pub fn prepare(&mut self, steps: usize, observer: &mut Observer<'_>) -> Result<()> {
        let made = self.state.step;
        let end = made.saturating_add(steps);
        if end <= self.prepared || end >= ENDLESS {
            return Ok(());
        }
        // Doubled, so that many short runs prepare seldom; histories grow by powers of two.
        let end = if made > 0 { end.next_power_of_two() } else { end };
        let mut saved = None;
        if made > 0 {
            // A ground that cannot be saved grows step by step.
            let Ok(values) = self.ground.save() else { return Ok(()) };
            saved = Some(values);
        }
        self.ground.prepare(self.scene.time_step, Some(end), observer)?;
        if let Some(saved) = saved {
            self.ground.restore(made, &saved)?;
        }
        self.prepared = end;
        Ok(())
    }
}
