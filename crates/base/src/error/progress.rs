//! Progress of long calls, and its observers.

use std::fmt;
use std::ops::ControlFlow;

use super::{Error, Result};

/// Progress of a long call: the number of finished parts, and of all parts.
///
/// `done` never decreases, and ends at `total`, which does not change during a call. All parts take about the same
/// time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// Name of the computation.
    pub task: &'static str,
    /// Number of finished parts.
    pub done: usize,
    /// Number of all parts.
    pub total: usize,
}

impl Progress {
    /// Progress of a computation of the library.
    #[doc(hidden)]
    pub fn new(task: &'static str, done: usize, total: usize) -> Self {
        Self { task, done, total }
    }
}

impl fmt::Display for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { task, done, total } = self;
        write!(f, "{task}, {done} of {total} parts done")
    }
}

/// Observer of a long call: a closure that receives its [`Progress`] and may stop it.
///
/// It is called on the calling thread, at least every half second on meshes of up to some hundred elements, and
/// more often if parts are short: an observer that draws should check the time. After [`ControlFlow::Break`] the
/// call returns [`Error::Stopped`], and the state is as before the call; later calls return the same results to the
/// last bit.
///
/// ```
/// use std::ops::ControlFlow::{Break, Continue};
///
/// use basemat::bem::{ElasticGround, Strip};
/// use basemat::soil::SoilProfile;
/// use basemat::{Error, Progress, Soil};
///
/// let soil = Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?;
/// let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, 6.0)?;
/// let weights = ElasticGround::new(profile, Strip::uniform(-5.0..5.0, 4)?)?.weights(0.01)?;
/// let stopped = weights.prepare(500, &mut |progress: Progress| {
///     if 2 * progress.done > progress.total { Break(()) } else { Continue(()) }
/// });
/// assert!(matches!(stopped, Err(Error::Stopped(progress)) if progress.done < progress.total));
/// weights.prepare(500, &mut |progress| {
///     println!("{progress}");
///     Continue(())
/// })?;
/// # Ok::<(), Error>(())
/// ```
///
/// Before a run, the computation of its convolution weights can be observed:
///
/// ```
/// use std::ops::ControlFlow::{Break, Continue};
///
/// use basemat::bem::ElasticGround;
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::soil::SoilProfile;
/// use basemat::structure::RigidBlock;
/// use basemat::{Error, Simulation, Soil};
///
/// let rock = Soil::from_shear_wave_speed(500.0, 0.3, 2200.0)?;
/// let clay = Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?;
/// let profile = SoilProfile::on_half_plane(rock).with_layer(clay, 6.0)?;
/// let block = RigidBlock::new(4.0, 6.0, 2000.0)?;
/// let mut simulation = Simulation::builder(0.02)
///     .ground(ElasticGround::under(profile, &block, 4)?)
///     .structure(block)
///     .interface(Coulomb::new(0.4)?)
///     .motion(el_centro_1940())
///     .build()?;
/// // Stopped halfway: the simulation is unchanged, and the weights computed so far are kept.
/// let stopped = simulation.prepare(300, &mut |progress| {
///     if 2 * progress.done > progress.total { Break(()) } else { Continue(()) }
/// });
/// assert!(matches!(stopped, Err(Error::Stopped(_))));
/// simulation.prepare(300, &mut |progress| {
///     eprint!("\r{progress}");
///     Continue(())
/// })?;
/// simulation.run(300, |_| ())?; // All weights are already computed.
/// # Ok::<(), Error>(())
/// ```
pub type Observer<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// No-op [`Observer`]: the default of long calls.
///
/// ```
/// let record = basemat::motion::el_centro_1940();
/// assert_eq!(record.response_spectrum(&[1.0], 0.05, &mut basemat::unobserved)?.len(), 1);
/// # Ok::<(), basemat::Error>(())
/// ```
pub fn unobserved(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Reports the progress of a call to its observer, if any.
pub struct ProgressReporter<'a> {
    observer: Option<&'a mut Observer<'a>>,
    progress: Progress,
}

impl<'a> ProgressReporter<'a> {
    /// Reporter for a call that nobody observes.
    #[doc(hidden)]
    pub fn unobserved() -> Self {
        Self { observer: None, progress: Progress { task: "", done: 0, total: 0 } }
    }

    /// Reporter for a computation of `total` parts, called `task` in its progress.
    #[doc(hidden)]
    pub fn new(task: &'static str, total: usize, observer: &'a mut Observer<'_>) -> Self {
        Self { observer: Some(observer), progress: Progress { task, done: 0, total } }
    }

    /// Whether there is an observer.
    #[doc(hidden)]
    pub fn has_observer(&self) -> bool {
        self.observer.is_some()
    }

    /// Reports that `done` parts are finished; `done` never decreases.
    ///
    /// # Errors
    /// [`Error::Stopped`] if the observer stops the call.
    #[doc(hidden)]
    pub fn reach(&mut self, done: usize) -> Result<()> {
        let Some(observer) = &mut self.observer else { return Ok(()) };
        let progress = &mut self.progress;
        progress.done = done.clamp(progress.done, progress.total);
        match observer(*progress) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Error::Stopped(*progress)),
        }
    }
}
