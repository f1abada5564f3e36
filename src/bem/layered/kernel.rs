//! Step coefficients of a layered ground under a patch of elements.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError, TryLockError};
use std::time::Duration;

use super::coefficients::{BLOCKS, Block, FIRST, Quadrature, Samples};
use super::cost::{Cost, Outlook};
use super::runge_kutta::Stages;
use super::wavenumber::Workspace;
use super::{file, passivity};
use crate::error::{Error, Observer, Result, Watch, memory, positive, same_length};
use crate::geometry::ContactElement;
use crate::history::{ConvolutionWeights, KINDS, PairClasses, SharedSpectra};
use crate::soil::SoilProfile;

/// The [`ConvolutionWeights`] of a layered ground: coefficients Gⁿ by Runge–Kutta convolution quadrature,
/// in blocks of lags that are computed when they are needed first.
///
/// ```
/// use basemat::bem::layered::LayeredKernel;
/// use basemat::bem::Strip;
/// use basemat::history::ConvolutionWeights;
/// use basemat::soil::{GeneralizedMaxwell, SoilProfile};
/// use basemat::Soil;
/// let soil = Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?;
/// let profile = SoilProfile::on_rigid_base()
///     .with_layer(soil, 6.0)?
///     .with_damping(GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0)?);
/// let kernel = LayeredKernel::new(profile, Strip::uniform(-5.0..5.0, 4)?.elements(), 0.01)?;
/// let [mut normal, mut tangential, mut coupling] = [[0.0; 20]; 3];
/// kernel.coefficients(0, 1, [&mut normal, &mut tangential, &mut coupling])?;
/// assert!(normal[0] > 0.0 && coupling[0].abs() < 1e-12 * normal[0]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug)]
pub struct LayeredKernel {
    classes: PairClasses,
    quadrature: Quadrature,
    /// Fingerprint of what has passed the gate.
    checked: OnceLock<Result<u64>>,
    blocks: [OnceLock<Result<Block>>; BLOCKS],
    /// Held by the thread that computes.
    making: Mutex<()>,
    spectra: SharedSpectra,
    file: Option<PathBuf>,
    /// Most processor time that coefficients may take, s.
    limit: f64,
}

/// Default tolerance of the wavenumber integrals.
pub(crate) const TOLERANCE: f64 = 1e-10;
/// Default limit on processor time, s.
pub(crate) const LIMIT: f64 = 600.0;

/// Between two looks whether another thread has ended.
const WAIT: Duration = Duration::from_millis(20);

impl LayeredKernel {
    /// Kernel of `profile` under `elements` (left to right, not overlapping) for steps of `time_step`
    /// seconds, with two stages.
    ///
    /// # Errors
    /// [`Error::Input`] for a bad time step, [`LayeredError::NotCausal`](crate::LayeredError::NotCausal)
    /// for damping that exists in the frequency domain only; as for [`PairClasses::new`].
    pub fn new(
        profile: SoilProfile,
        elements: Vec<ContactElement>,
        time_step: f64,
    ) -> Result<Self> {
        positive("time step", time_step)?;
        profile.check()?;
        profile.check_causal()?;
        let classes = PairClasses::new(elements)?;
        Ok(Self::made(profile, classes, time_step, Stages::default(), TOLERANCE))
    }

    fn made(
        profile: SoilProfile,
        classes: PairClasses,
        time_step: f64,
        stages: Stages,
        tolerance: f64,
    ) -> Self {
        let quadrature = Quadrature::new(profile, &classes, stages, time_step, tolerance);
        let blocks = std::array::from_fn(|_| OnceLock::new());
        let (checked, spectra) = (OnceLock::new(), SharedSpectra::default());
        let making = Mutex::default();
        Self { classes, quadrature, checked, blocks, making, spectra, file: None, limit: LIMIT }
    }

    /// With another number of stages.
    #[must_use]
    pub fn with_stages(self, stages: Stages) -> Self {
        let Quadrature { profile, time_step, tolerance, .. } = self.quadrature;
        let made = Self::made(profile, self.classes, time_step, stages, tolerance);
        Self { file: self.file, limit: self.limit, ..made }
    }

    /// With the relative `tolerance` (1e-13 to 1e-4) of the element compliances in the Laplace
    /// domain; 1e-10 unless called. Coefficients are then good to about its power 2/3 at the last lag of a
    /// block, and better before.
    ///
    /// # Errors
    /// [`Error::Input`] for a tolerance outside this range.
    pub fn with_tolerance(self, tolerance: f64) -> Result<Self> {
        check_tolerance(tolerance)?;
        let Quadrature { profile, time_step, stages, .. } = self.quadrature;
        let made = Self::made(profile, self.classes, time_step, stages, tolerance);
        Ok(Self { file: self.file, limit: self.limit, ..made })
    }

    /// With coefficients from the file `path`, and those that it lacks written to it by
    /// [`prepare`](ConvolutionWeights::prepare).
    ///
    /// They are the same to the last bit. A file of another profile, mesh, step, accuracy, machine or
    /// format is made anew; one that is damaged, or no such file at all, is refused and left as it is.
    ///
    /// ```
    /// use basemat::bem::layered::LayeredKernel;
    /// use basemat::bem::Strip;
    /// use basemat::history::ConvolutionWeights;
    /// use basemat::soil::SoilProfile;
    /// use basemat::Soil;
    /// let path = std::env::temp_dir().join("basemat-doctest.kernel");
    /// let soil = Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?;
    /// let profile = SoilProfile::on_rigid_base().with_layer(soil, 6.0)?;
    /// let elements = Strip::uniform(-5.0..5.0, 4)?.elements();
    /// LayeredKernel::new(profile, elements, 0.01)?.with_file(&path).prepare(100)?;
    /// // Four distances, three components, 128 lags, and six words around them.
    /// assert_eq!(std::fs::metadata(&path).unwrap().len(), 8 * (4 * 3 * 128 + 6));
    /// # std::fs::remove_file(path).unwrap();
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// `prepare` and [`coefficients`](ConvolutionWeights::coefficients) then also return
    /// [`LayeredError::File`](crate::LayeredError::File) and [`Error::Write`].
    #[must_use]
    pub fn with_file(self, path: impl Into<PathBuf>) -> Self {
        Self { file: Some(path.into()), ..self }
    }

    /// With at most so many `seconds` of a processor for coefficients, by [`LayeredKernel::cost`] and not by
    /// the clock, so that what is refused is the same everywhere; 600 unless called, and no limit if it is
    /// infinite.
    ///
    /// `prepare` and [`coefficients`](ConvolutionWeights::coefficients) refuse more
    /// ([`LayeredError::TooCostly`](crate::LayeredError::TooCostly)) before anything of it is computed.
    ///
    /// # Errors
    /// [`Error::Input`] for a number that is negative or NaN.
    pub fn with_time_limit(self, seconds: f64) -> Result<Self> {
        Ok(Self { limit: check_limit(seconds)?, ..self })
    }

    /// What the coefficients up to lag `lags` cost, to a factor of about two, files left out. It takes
    /// some hundredths of that itself.
    ///
    /// # Errors
    /// [`LayeredError::TooFine`](crate::LayeredError::TooFine) and
    /// [`LayeredError::Unresolved`](crate::LayeredError::Unresolved) where they could not be computed at
    /// all; for bad damping laws as [`prepare`](ConvolutionWeights::prepare).
    pub fn cost(&self, lags: usize) -> Result<Cost> {
        self.quadrature.cost(0..last_block(lags.max(1))? + 1, true)
    }

    /// The profile.
    pub fn profile(&self) -> &SoilProfile {
        &self.quadrature.profile
    }

    /// Block `number`, computed now if it has not been.
    fn block(&self, number: usize, watch: &mut Watch, expected: Range<usize>) -> Result<&Block> {
        self.once(&self.blocks[number], watch, |watch| {
            self.quadrature.block(number, threads(), Samples::new(watch, expected))
        })
    }

    /// What is in `place`, made now if nothing is; what was stopped leaves nothing.
    fn once<'a, T>(
        &self,
        place: &'a OnceLock<Result<T>>,
        watch: &mut Watch,
        make: impl FnOnce(&mut Watch) -> Result<T>,
    ) -> Result<&'a T> {
        let found = |made: &'a Result<T>| made.as_ref().map_err(Clone::clone);
        if let Some(made) = place.get() {
            return found(made);
        }
        let _making = self.enter(watch)?;
        if let Some(made) = place.get() {
            return found(made);
        }
        match make(watch) {
            Err(stopped @ Error::Stopped(_)) => Err(stopped),
            made => found(place.get_or_init(|| made)),
        }
    }

    /// Waits until no other thread computes, with an open ear for the observer.
    fn enter(&self, watch: &mut Watch) -> Result<MutexGuard<'_, ()>> {
        while watch.is_observed() {
            match self.making.try_lock() {
                Ok(making) => return Ok(making),
                Err(TryLockError::Poisoned(poisoned)) => return Ok(poisoned.into_inner()),
                Err(TryLockError::WouldBlock) => {
                    watch.reach(0)?;
                    std::thread::sleep(WAIT);
                }
            }
        }
        Ok(self.making.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Passes the gate, and refuses what is missing of the blocks of `wanted` if it costs too much; `outlook` are the
    /// samples of these.
    fn admit(
        &self,
        wanted: Range<usize>,
        outlook: Option<&Outlook>,
        watch: &mut Watch,
    ) -> Result<u64> {
        let missing = self.missing(wanted.clone());
        let open = self.checked.get().is_none();
        // A file may hold all that is wanted.
        let late = open && self.file.is_some();
        let first = if late { 0..0 } else { missing };
        if open || !first.is_empty() {
            self.quadrature.afford(first, open, self.limit, outlook.filter(|_| !late))?;
        }
        let fingerprint = *self.once(&self.checked, watch, |watch| self.check(watch))?;
        let rest = self.missing(wanted);
        if late && !rest.is_empty() {
            self.quadrature.afford(rest, false, self.limit, None)?;
        }
        Ok(fingerprint)
    }

    /// Error unless the blocks up to the last of `missing` may be in memory.
    fn fits(&self, missing: &Range<usize>) -> Result<()> {
        if missing.is_empty() {
            return Ok(());
        }
        let lags = Block::last(missing.end - 1) as f64;
        Ok(memory::check("lags of a layered ground", lags, self.quadrature.memory(missing.end))?)
    }

    /// Those of the blocks of `wanted` from the first on that is not there.
    fn missing(&self, wanted: Range<usize>) -> Range<usize> {
        let there = |number: &usize| self.blocks[*number].get().is_some();
        wanted.start + wanted.clone().take_while(there).count()..wanted.end
    }

    /// Whether it is passive; if so, its fingerprint, and the blocks of the file are in place.
    fn check(&self, watch: &mut Watch) -> Result<u64> {
        let fingerprint = passivity::check(&self.quadrature, &self.classes, watch)?;
        if let Some(path) = &self.file {
            let blocks = file::read(path, fingerprint, [self.classes.count(), KINDS])?;
            for (place, block) in self.blocks.iter().zip(blocks) {
                let _ = place.set(Ok(block));
            }
        }
        Ok(fingerprint)
    }

    /// Computes the blocks of lags up to `lags`; without an observer, nobody counts beforehand.
    fn make_ready(&self, lags: usize, observer: Option<&mut Observer<'_>>) -> Result<()> {
        let last = last_block(lags.max(1))?;
        self.fits(&self.missing(0..last + 1))?;
        let mut expected = vec![0; last + 1];
        let mut watch = Watch::nobody();
        let mut outlook = None;
        if let Some(observer) = observer {
            let missing = self.missing(0..last + 1);
            // What cannot be counted beforehand fails as it does without an observer.
            outlook = self.quadrature.outlook(missing.clone(), &mut Workspace::default()).ok();
            let counts = outlook.iter().flat_map(Outlook::counts);
            expected[missing].iter_mut().zip(counts).for_each(|(own, count)| *own = count);
            let total = passivity::POINTS + expected.iter().sum::<usize>();
            watch = Watch::new("step coefficients of layered ground", total, observer);
        }
        let fingerprint = self.admit(0..last + 1, outlook.as_ref(), &mut watch)?;
        let complete = self.blocks[..=last].iter().all(|block| block.get().is_some());
        let mut done = passivity::POINTS;
        watch.reach(done)?;
        for (number, count) in expected.into_iter().enumerate() {
            self.block(number, &mut watch, done..done + count)?;
            done += count;
        }
        watch.reach(done)?;
        let Some(path) = self.file.as_ref().filter(|_| !complete) else { return Ok(()) };
        let blocks = self.blocks.iter().map_while(|block| block.get()?.as_ref().ok());
        file::write(path, fingerprint, self.classes.count(), &blocks.collect::<Vec<_>>())
    }
}

impl ConvolutionWeights for LayeredKernel {
    fn classes(&self) -> &PairClasses {
        &self.classes
    }

    /// Computes the blocks of lags up to `lags`, after a check of passivity: the least eigenvalue of
    /// Herm[(1−z) Ĝ(z)] on |z| = 0.99.
    ///
    /// # Errors
    /// [`Error::Memory`] beyond the [limit](crate::memory_limit), before anything is computed;
    /// [`LayeredError::TooCostly`](crate::LayeredError::TooCostly) beyond the
    /// [limit](LayeredKernel::with_time_limit); [`LayeredError::NotPassive`](crate::LayeredError::NotPassive),
    /// [`LayeredError::ActiveDamping`](crate::LayeredError::ActiveDamping) and
    /// [`LayeredError::Modulus`](crate::LayeredError::Modulus) for a damping law that is not passive.
    fn prepare(&self, lags: usize) -> Result<()> {
        self.make_ready(lags, None)
    }

    /// The same, with an observer; parts are samples of the mobility, as many as are expected.
    fn prepare_observed(&self, lags: usize, observer: &mut Observer<'_>) -> Result<()> {
        self.make_ready(lags, Some(observer))
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        mut values: [&mut [f64]; KINDS],
    ) -> Result<()> {
        self.classes.representative(class)?;
        let lags = values[0].len();
        same_length("tangential coefficients", values[1].len(), lags)?;
        same_length("coupling coefficients", values[2].len(), lags)?;
        if first_lag == 0 {
            return Err(Error::Input { quantity: "lag", value: 0.0, needed: "at least 1" });
        }
        last_block(first_lag.saturating_add(lags))?;
        let mut done = 0;
        while done < lags {
            let (number, place) = Block::place(first_lag + done);
            if self.blocks[number].get().is_none() {
                self.fits(&(number..number + 1))?;
                self.admit(number..number + 1, None, &mut Watch::nobody())?;
            }
            let found = self.block(number, &mut Watch::nobody(), 0..0)?.from::<KINDS>(class, place);
            let count = found[0].len().min(lags - done);
            for (values, found) in values.iter_mut().zip(found) {
                values[done..done + count].copy_from_slice(&found[..count]);
            }
            done += count;
        }
        Ok(())
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        Some(&self.spectra)
    }
}

/// Error unless `tolerance` can be reached and is worth the name.
pub(crate) fn check_tolerance(tolerance: f64) -> Result<f64> {
    if (1e-13..=1e-4).contains(&tolerance) {
        return Ok(tolerance);
    }
    Err(Error::Input {
        quantity: "tolerance of a layered ground",
        value: tolerance,
        needed: "from 1e-13 to 1e-4",
    })
}

/// Error unless `seconds` can be a limit.
pub(crate) fn check_limit(seconds: f64) -> Result<f64> {
    if seconds >= 0.0 {
        return Ok(seconds);
    }
    Err(Error::Input {
        quantity: "time limit of a layered ground",
        value: seconds,
        needed: "not negative",
    })
}

/// Number of the block with lag `lag`.
fn last_block(lag: usize) -> Result<usize> {
    let most = FIRST << (BLOCKS - 1);
    if lag > most {
        return Err(Error::Input {
            quantity: "lag of a layered ground",
            value: lag as f64,
            needed: "at most 2147483648",
        });
    }
    Ok(Block::place(lag).0)
}

/// Threads for one block.
fn threads() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    1
}
