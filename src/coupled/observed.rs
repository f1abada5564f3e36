//! Answers of the observer of a run: go on, stop, or fail.

use std::ops::ControlFlow;

use crate::error::{Error, Result};

/// Answer of an observer of [`Simulation::run`](crate::Simulation::run): nothing,
/// [`ControlFlow`] to stop after a step, or a [`Result`] of either, whose error ends the run.
///
/// ```
/// use std::ops::ControlFlow::{Break, Continue};
///
/// use basemat::bem::SpringGround;
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
/// use basemat::{Error, Simulation};
///
/// let mut simulation = Simulation::builder(0.01)
///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
///     .interface(Coulomb::new(0.4)?)
///     .motion(el_centro_1940())
///     .build()?;
/// let run = simulation.run(500, |state| {
///     if state.uplifted_fraction > 0.2 { Break(()) } else { Continue(()) }
/// })?;
/// assert!(run.steps < 500);
/// let refused = simulation.run(500, |_| Err::<(), _>(Error::part("observer", "has seen enough")));
/// assert!(refused.is_err());
/// # Ok::<(), Error>(())
/// ```
pub trait Observed {
    /// Whether the run goes on.
    ///
    /// # Errors
    /// The observer's own.
    fn flow(self) -> Result<ControlFlow<()>>;
}

impl Observed for () {
    fn flow(self) -> Result<ControlFlow<()>> {
        Ok(ControlFlow::Continue(()))
    }
}

impl Observed for ControlFlow<()> {
    fn flow(self) -> Result<ControlFlow<()>> {
        Ok(self)
    }
}

impl<T: Observed> Observed for std::result::Result<T, Error> {
    fn flow(self) -> Result<ControlFlow<()>> {
        self.and_then(Observed::flow)
    }
}
