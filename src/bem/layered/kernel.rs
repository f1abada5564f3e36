//! Step coefficients of a layered ground under a patch of elements.

use std::ops::Range;
use std::path::PathBuf;

use super::coefficients::{Block, Quadrature, Samples};
use super::cost::{Cost, Outlook};
use super::kept::{KeptBlocks, copy_lags, last_block, threads};
use super::passivity;
use super::runge_kutta::Stages;
use super::wavenumber::Workspace;
use crate::error::{Error, Observer, Result, Watch, memory, positive};
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
    kept: KeptBlocks,
    spectra: SharedSpectra,
    /// Most processor time that coefficients may take, s.
    limit: f64,
}

/// Default tolerance of the wavenumber integrals.
pub(crate) const TOLERANCE: f64 = 1e-10;
/// Default limit on processor time, s.
pub(crate) const LIMIT: f64 = 600.0;

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
        Ok(Self::made(profile, classes, time_step, Stages::default(), TOLERANCE, None))
    }

    fn made(
        profile: SoilProfile,
        classes: PairClasses,
        time_step: f64,
        stages: Stages,
        tolerance: f64,
        file: Option<PathBuf>,
    ) -> Self {
        let quadrature = Quadrature::new(profile, &classes, stages, time_step, tolerance);
        let kept = KeptBlocks::new([classes.count(), KINDS], file);
        Self { classes, quadrature, kept, spectra: SharedSpectra::default(), limit: LIMIT }
    }

    /// With another number of stages.
    #[must_use]
    pub fn with_stages(self, stages: Stages) -> Self {
        let Quadrature { profile, time_step, tolerance, .. } = self.quadrature;
        let (limit, file) = (self.limit, self.kept.file);
        Self { limit, ..Self::made(profile, self.classes, time_step, stages, tolerance, file) }
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
        let (limit, file) = (self.limit, self.kept.file);
        let made = Self::made(profile, self.classes, time_step, stages, tolerance, file);
        Ok(Self { limit, ..made })
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
    pub fn with_file(mut self, path: impl Into<PathBuf>) -> Self {
        self.kept.file = Some(path.into());
        self
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
        self.kept.block(number, watch, |watch| {
            self.quadrature.block(number, threads(), Samples::new(watch, expected))
        })
    }

    /// Passes the gate, and refuses what is missing of the blocks of `wanted` if it costs too much; `outlook` are the
    /// samples of these.
    fn admit(
        &self,
        wanted: Range<usize>,
        outlook: Option<&Outlook>,
        watch: &mut Watch,
    ) -> Result<u64> {
        let missing = self.kept.missing(wanted.clone());
        let open = !self.kept.is_checked();
        // A file may hold all that is wanted.
        let late = open && self.kept.file.is_some();
        let first = if late { 0..0 } else { missing };
        if open || !first.is_empty() {
            self.quadrature.afford(first, open, self.limit, outlook.filter(|_| !late))?;
        }
        let elements = self.classes.elements().iter();
        let ends = elements.flat_map(|element| [element.left, element.right]);
        let check =
            |watch: &mut Watch| passivity::check(&self.quadrature, &self.classes, ends, watch);
        let fingerprint = self.kept.gate(watch, check)?;
        let rest = self.kept.missing(wanted);
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

    /// Computes the blocks of lags up to `lags`; without an observer, nobody counts beforehand.
    fn make_ready(&self, lags: usize, observer: Option<&mut Observer<'_>>) -> Result<()> {
        let last = last_block(lags.max(1))?;
        self.fits(&self.kept.missing(0..last + 1))?;
        let mut expected = vec![0; last + 1];
        let mut watch = Watch::nobody();
        let mut outlook = None;
        if let Some(observer) = observer {
            let missing = self.kept.missing(0..last + 1);
            // What cannot be counted beforehand fails as it does without an observer.
            outlook = self.quadrature.outlook(missing.clone(), &mut Workspace::default()).ok();
            let counts = outlook.iter().flat_map(Outlook::counts);
            expected[missing].iter_mut().zip(counts).for_each(|(own, count)| *own = count);
            let total = passivity::POINTS + expected.iter().sum::<usize>();
            watch = Watch::new("step coefficients of layered ground", total, observer);
        }
        let fingerprint = self.admit(0..last + 1, outlook.as_ref(), &mut watch)?;
        let complete = self.kept.missing(0..last + 1).is_empty();
        let mut done = passivity::POINTS;
        watch.reach(done)?;
        for (number, count) in expected.into_iter().enumerate() {
            self.block(number, &mut watch, done..done + count)?;
            done += count;
        }
        watch.reach(done)?;
        if complete { Ok(()) } else { self.kept.write(fingerprint) }
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
        values: [&mut [f64]; KINDS],
    ) -> Result<()> {
        self.classes.representative(class)?;
        copy_lags(class, first_lag, values, |number| {
            if !self.kept.has(number) {
                self.fits(&(number..number + 1))?;
                self.admit(number..number + 1, None, &mut Watch::nobody())?;
            }
            self.block(number, &mut Watch::nobody(), 0..0)
        })
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
