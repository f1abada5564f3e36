//! Step coefficients of a layered ground under a patch of elements.

use std::path::PathBuf;

use super::coefficients::Quadrature;
use super::cost::Cost;
use super::runge_kutta::Stages;
use super::wavenumber::Wavenumbers;
use super::weights::QuadratureWeights;
use crate::error::{Observer, Result, positive, require};
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
///
/// [`prepare`](ConvolutionWeights::prepare) computes the blocks of lags up to the one that it is given, after a check
/// of passivity: the least eigenvalue of Herm[(1−z) Ĝ(z)] on |z| = 0.99. With an observer, parts are samples of the
/// mobility, as many as are expected.
///
/// # Errors
/// `prepare` and [`coefficients`](ConvolutionWeights::coefficients) return
/// [`Error::Memory`](crate::Error::Memory) beyond the [limit](crate::memory_limit), before anything is computed;
/// [`LayeredError::TooCostly`](crate::LayeredError::TooCostly) beyond the
/// [limit](LayeredKernel::with_time_limit); [`LayeredError::NotPassive`](crate::LayeredError::NotPassive),
/// [`LayeredError::ActiveDamping`](crate::LayeredError::ActiveDamping) and
/// [`LayeredError::Modulus`](crate::LayeredError::Modulus) for a damping law that is not passive.
#[derive(Debug)]
pub struct LayeredKernel {
    weights: QuadratureWeights<Wavenumbers, KINDS>,
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
    /// [`Error::Input`](crate::Error::Input) for a bad time step,
    /// [`LayeredError::NotCausal`](crate::LayeredError::NotCausal) for damping that exists in the frequency domain
    /// only; as for [`PairClasses::new`].
    pub fn new(
        profile: SoilProfile,
        elements: Vec<ContactElement>,
        time_step: f64,
    ) -> Result<Self> {
        Self::made(profile, elements, Stages::default(), [time_step, TOLERANCE, LIMIT], None)
    }

    /// Kernel with this number of stages, tolerance, limit on processor time and file.
    pub(in crate::bem) fn made(
        profile: SoilProfile,
        elements: Vec<ContactElement>,
        stages: Stages,
        [time_step, tolerance, limit]: [f64; 3],
        file: Option<PathBuf>,
    ) -> Result<Self> {
        positive("time step", time_step)?;
        profile.check()?;
        profile.check_causal()?;
        let sizes = [time_step, tolerance, limit];
        Ok(Self::of(profile, PairClasses::new(elements)?, stages, sizes, file))
    }

    fn of(
        profile: SoilProfile,
        classes: PairClasses,
        stages: Stages,
        [time_step, tolerance, limit]: [f64; 3],
        file: Option<PathBuf>,
    ) -> Self {
        let quadrature = Quadrature::new(profile, &classes, stages, time_step, tolerance);
        let ends = classes.elements().iter().flat_map(|element| [element.left, element.right]);
        let mesh = ends.collect();
        Self { weights: QuadratureWeights::new(quadrature, classes, None, mesh, limit, file) }
    }

    fn remade(self, stages: Stages, tolerance: f64) -> Self {
        let QuadratureWeights { quadrature, classes, limit, kept, .. } = self.weights;
        let sizes = [quadrature.time_step, tolerance, limit];
        Self::of(quadrature.profile, classes, stages, sizes, kept.file)
    }

    /// With another number of stages.
    #[must_use]
    pub fn with_stages(self, stages: Stages) -> Self {
        let tolerance = self.weights.quadrature.tolerance;
        self.remade(stages, tolerance)
    }

    /// With the relative `tolerance` (1e-13 to 1e-4) of the element compliances in the Laplace
    /// domain; 1e-10 unless called. Coefficients are then good to about its power 2/3 at the last lag of a
    /// block, and better before.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a tolerance outside this range.
    pub fn with_tolerance(self, tolerance: f64) -> Result<Self> {
        let stages = self.weights.quadrature.stages;
        Ok(self.remade(stages, check_tolerance(tolerance)?))
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
    /// [`LayeredError::File`](crate::LayeredError::File) and [`Error::Write`](crate::Error::Write).
    #[must_use]
    pub fn with_file(mut self, path: impl Into<PathBuf>) -> Self {
        self.weights.kept.file = Some(path.into());
        self
    }

    /// With at most so many `seconds` of a processor for coefficients, by [`LayeredKernel::cost`] and not by
    /// the clock, so that the limit is the same everywhere; 600 unless called, and no limit if it is
    /// infinite.
    ///
    /// Beyond it, `prepare` and [`coefficients`](ConvolutionWeights::coefficients) return
    /// [`LayeredError::TooCostly`](crate::LayeredError::TooCostly) before anything is computed.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a number that is negative or NaN.
    pub fn with_time_limit(mut self, seconds: f64) -> Result<Self> {
        self.weights.limit = check_limit(seconds)?;
        Ok(self)
    }

    /// Cost of the coefficients up to lag `lags`, to a factor of about two, files left out. The estimate takes
    /// some hundredths of that itself.
    ///
    /// # Errors
    /// [`LayeredError::TooFine`](crate::LayeredError::TooFine) and
    /// [`LayeredError::Unresolved`](crate::LayeredError::Unresolved) where they could not be computed at
    /// all; for bad damping laws as [`prepare`](ConvolutionWeights::prepare).
    pub fn cost(&self, lags: usize) -> Result<Cost> {
        self.weights.cost(lags)
    }

    /// The profile.
    pub fn profile(&self) -> &SoilProfile {
        &self.weights.quadrature.profile
    }
}

impl ConvolutionWeights for LayeredKernel {
    forward! {
        self.weights;
        fn classes(&self) -> &PairClasses;
        fn prepare(&self, lags: usize) -> Result<()>;
        fn prepare_observed(&self, lags: usize, observer: &mut Observer<'_>) -> Result<()>;
        fn coefficients(
            &self,
            class: usize,
            first_lag: usize,
            values: [&mut [f64]; KINDS]
        ) -> Result<()>;
        fn spectra(&self) -> Option<&SharedSpectra>;
    }
}

/// Error unless `tolerance` can be reached and is worth the name.
pub(crate) fn check_tolerance(tolerance: f64) -> Result<f64> {
    let fits = (1e-13..=1e-4).contains(&tolerance);
    require("tolerance of a layered ground", tolerance, fits, "from 1e-13 to 1e-4")
}

/// Error unless `seconds` can be a limit.
pub(crate) fn check_limit(seconds: f64) -> Result<f64> {
    require("time limit of a layered ground", seconds, seconds >= 0.0, "not negative")
}
