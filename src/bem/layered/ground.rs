//! Layered, damped ground under strips.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use super::kernel::{LIMIT, TOLERANCE, check_limit, check_tolerance};
use super::{
    Cost, LayeredKernel, Stages, StripContact, StripImpedance, rigid_strip_impedances,
    static_compliance,
};
use crate::bem::strip::strips_under;
use crate::bem::{
    Grading, Ground, KernelGround, KernelSource, PatchKernel, SharedKernels, StaticKernel, Strip,
};
use crate::error::{Result, positive};
use crate::geometry::{ContactElement, check_order};
use crate::history::{ConvolutionHistory, History, HistoryChoice, LagKernel};
use crate::motion::FreeField;
use crate::soil::{Base, Soil, SoilProfile};
use crate::structure::Structure;

/// Horizontal layers, damped or not, on a half-plane or a rigid base, with one or several strips on
/// the surface.
///
/// The soil operator is Runge–Kutta convolution quadrature of the mobility (Radau IIA) with tractions
/// constant over element and step: passive for every step, mesh, profile and passive damping law. The
/// number of stages follows [`Stages::for_profile`] and is said in [`Ground::history_choice`]. A
/// profile of one undamped half-plane takes the closed form, bit for bit that of
/// [`HalfPlaneGround`](crate::bem::HalfPlaneGround), unless stages are asked for.
///
/// The free field is that of the surface. [`site::Column`](crate::site::Column) makes it of a motion at
/// depth in the same profile.
///
/// ```
/// use basemat::bem::layered::LayeredGround;
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::soil::{GeneralizedMaxwell, SoilProfile};
/// use basemat::structure::RigidBlock;
/// use basemat::{Simulation, Soil};
///
/// // Six metres of soft soil with 5 % damping on rock with 1 %.
/// let damping = |ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0);
/// let profile = SoilProfile::on_half_plane(Soil::from_shear_wave_speed(500.0, 0.3, 2100.0)?)
///     .with_base_damping(damping(0.01)?)
///     .with_layer(Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?, 6.0)?
///     .with_damping(damping(0.05)?);
/// let block = RigidBlock::new(6.0, 9.0, 2000.0)?;
/// let mut simulation = Simulation::builder(0.005)
///     .ground(LayeredGround::under(profile, &block, 8)?)
///     .structure(block)
///     .interface(Coulomb::new(0.5)?)
///     .motion(el_centro_1940())
///     .build()?;
/// let run = simulation.run(400, |_| {})?;
/// assert!(run.ledger_residual < 1e-9);
/// assert!(simulation.history_choice().unwrap().to_string().contains("3 stages"));
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct LayeredGround {
    layered: Layered,
    /// Stages of the last [`Ground::prepare`].
    used: Option<Stages>,
    ground: KernelGround,
}

short_debug! { LayeredGround; self; layered: self.layered, ground: self.ground }

/// A profile and how accurately it marches.
#[derive(Debug, Clone)]
struct Layered {
    profile: SoilProfile,
    stages: Option<Stages>,
    tolerance: f64,
    file: Option<PathBuf>,
    limit: f64,
}

impl Layered {
    /// The stages for steps of `time_step` seconds; `None` for the closed form.
    fn stages(&self, time_step: f64) -> Option<Stages> {
        let by_rule = || Stages::for_profile(&self.profile, time_step);
        let closed = self.stages.is_none() && self.profile.is_elastic_half_plane();
        (!closed).then(|| self.stages.unwrap_or_else(by_rule))
    }
}

impl KernelSource for Layered {
    fn kernel(&self, elements: &[ContactElement], time_step: f64) -> Result<Arc<dyn LagKernel>> {
        let (profile, elements) = (self.profile.clone(), elements.to_vec());
        match (self.stages(time_step), self.profile.base()) {
            (None, Base::HalfPlane { soil, .. }) => {
                Ok(Arc::new(PatchKernel::new(*soil, elements, time_step)?))
            }
            (stages, _) => {
                let kernel = LayeredKernel::new(profile, elements, time_step)?;
                let kernel = kernel.with_stages(stages.unwrap_or_default());
                let kernel = kernel.with_tolerance(self.tolerance)?.with_time_limit(self.limit)?;
                Ok(Arc::new(match &self.file {
                    Some(file) => kernel.with_file(file),
                    None => kernel,
                }))
            }
        }
    }

    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        match self.profile.base() {
            Base::HalfPlane { soil, .. } if self.profile.is_elastic_half_plane() => {
                StaticKernel::under(*soil, elements)?.compliance(elements, matrix)
            }
            _ => static_compliance(&self.profile, elements, matrix),
        }
    }

    fn shear_wave_speed(&self) -> Option<f64> {
        self.profile.surface().map(|soil| soil.shear_wave_speed())
    }

    fn identity(&self) -> Option<Vec<f64>> {
        let stages = self.stages.map_or(0.0, |stages| stages.count() as f64);
        let mut numbers = vec![stages, self.tolerance, self.limit];
        // Grounds with a file do not take their kernel from one without.
        let file = self.file.as_ref().map(|file| file.as_os_str().as_encoded_bytes());
        numbers.push(file.map_or(-1.0, |bytes| bytes.len() as f64));
        numbers.extend(file.unwrap_or_default().iter().map(|byte| f64::from(*byte)));
        numbers.extend(self.profile.identity()?);
        Some(numbers)
    }
}

impl LayeredGround {
    /// One strip over `range` (m) of `count` elements, graded towards its edges, where tractions are
    /// singular ([`Grading::Cosine`]).
    ///
    /// # Errors
    /// As for [`LayeredGround::new`] and [`Strip::new`].
    pub fn strip(profile: SoilProfile, range: Range<f64>, count: usize) -> Result<Self> {
        Self::new(profile, &[Strip::graded(range, count)?])
    }

    /// One strip over `range` (m) of `count` equal elements.
    ///
    /// # Errors
    /// As for [`LayeredGround::strip`].
    pub fn uniform_strip(profile: SoilProfile, range: Range<f64>, count: usize) -> Result<Self> {
        Self::new(profile, &[Strip::uniform(range, count)?])
    }

    /// Strips of `count` elements under each foundation of `structure`, as wide as that is, graded
    /// as in [`LayeredGround::strip`].
    ///
    /// # Errors
    /// As for [`LayeredGround::strip`]; [`Error::Size`](crate::Error::Size) or
    /// [`Error::Index`](crate::Error::Index) for a structure without foundations.
    pub fn under(profile: SoilProfile, structure: &dyn Structure, count: usize) -> Result<Self> {
        Self::new(profile, &strips_under(structure, count, Grading::Cosine)?)
    }

    /// The same of `count` equal elements each.
    ///
    /// # Errors
    /// As for [`LayeredGround::under`].
    pub fn uniform_under(
        profile: SoilProfile,
        structure: &dyn Structure,
        count: usize,
    ) -> Result<Self> {
        Self::new(profile, &strips_under(structure, count, Grading::Uniform)?)
    }

    /// Several strips from left to right, coupled through the ground.
    ///
    /// Damping that is not causal serves [`impedances`](LayeredGround::impedances) only: a simulation
    /// refuses it with [`LayeredError::NotCausal`](crate::LayeredError::NotCausal).
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for no strips or a rigid base without layers,
    /// [`Error::Input`](crate::Error::Input) for strips that overlap or are out of order.
    pub fn new(profile: SoilProfile, strips: &[Strip]) -> Result<Self> {
        let elements: Vec<_> = strips.iter().flat_map(Strip::elements).collect();
        check_order(&elements)?;
        profile.check()?;
        let layered =
            Layered { profile, stages: None, tolerance: TOLERANCE, file: None, limit: LIMIT };
        let ground = KernelGround::new(layered.clone(), elements)?;
        Ok(Self { layered, used: None, ground })
    }

    fn with(self, layered: Layered) -> Self {
        let ground = self.ground.with_source(layered.clone());
        Self { layered, used: None, ground }
    }

    /// With this number of stages instead of the rule's.
    #[must_use]
    pub fn with_stages(self, stages: Stages) -> Self {
        let layered = Layered { stages: Some(stages), ..self.layered.clone() };
        self.with(layered)
    }

    /// With the `tolerance` of [`LayeredKernel::with_tolerance`].
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a tolerance not from 1e-13 to 1e-4.
    pub fn with_tolerance(self, tolerance: f64) -> Result<Self> {
        let layered = Layered { tolerance: check_tolerance(tolerance)?, ..self.layered.clone() };
        Ok(self.with(layered))
    }

    /// As [`KernelGround::with_history_kind`]; there are no exponentials for layered ground.
    #[must_use]
    pub fn with_history_kind(self, history: History) -> Self {
        Self { ground: self.ground.with_history_kind(history), ..self }
    }

    /// As [`KernelGround::with_history`].
    #[must_use]
    pub fn with_history(
        self,
        make: impl Fn(Arc<dyn LagKernel>) -> Box<dyn ConvolutionHistory> + Send + 'static,
    ) -> Self {
        Self { ground: self.ground.with_history(make), ..self }
    }

    /// As [`KernelGround::with_history_memory`].
    #[must_use]
    pub fn with_history_memory(self, bytes: usize) -> Self {
        Self { ground: self.ground.with_history_memory(bytes), ..self }
    }

    /// As [`KernelGround::with_shared_kernels`].
    #[must_use]
    pub fn with_shared_kernels(self, kernels: &SharedKernels) -> Self {
        Self { ground: self.ground.with_shared_kernels(kernels), ..self }
    }

    /// With step coefficients from the file `path`, which is made, or made anew, if it does not have
    /// them: [`LayeredKernel::with_file`]. The closed form needs none.
    #[must_use]
    pub fn with_kernel_file(self, path: impl Into<PathBuf>) -> Self {
        let layered = Layered { file: Some(path.into()), ..self.layered.clone() };
        self.with(layered)
    }

    /// With at most so many `seconds` of a processor for step coefficients, 600 unless called:
    /// [`LayeredKernel::with_time_limit`].
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a number that is negative or NaN.
    pub fn with_time_limit(self, seconds: f64) -> Result<Self> {
        let layered = Layered { limit: check_limit(seconds)?, ..self.layered.clone() };
        Ok(self.with(layered))
    }

    /// What the step coefficients of `steps` steps of `time_step` seconds cost before the first of them, to a
    /// factor of about two; files and shared kernels, which may have them, left out. Nothing for the
    /// closed form.
    ///
    /// ```
    /// use basemat::bem::layered::LayeredGround;
    /// use basemat::soil::SoilProfile;
    /// use basemat::Soil;
    /// let clay = Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?;
    /// let cost = |thickness: f64| {
    ///     let profile = SoilProfile::on_rigid_base().with_layer(clay, thickness)?;
    ///     LayeredGround::strip(profile, -3.0..3.0, 8)?.cost(0.005, 2000)
    /// };
    /// println!("{}", cost(6.0)?);
    /// // A skin of a millimetre asks for wavenumbers of its own size.
    /// assert!(cost(0.001)?.seconds > 10.0 * cost(6.0)?.seconds);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`LayeredKernel::cost`]; [`Error::Input`](crate::Error::Input) for a bad time step.
    pub fn cost(&self, time_step: f64, steps: usize) -> Result<Cost> {
        positive("time step", time_step)?;
        let Some(stages) = self.layered.stages(time_step) else { return Ok(Cost::default()) };
        let (profile, elements) = (self.profile().clone(), self.ground.elements().to_vec());
        let kernel = LayeredKernel::new(profile, elements, time_step)?.with_stages(stages);
        let kernel = kernel.with_tolerance(self.layered.tolerance)?;
        // Histories take lags by powers of two.
        kernel.cost(steps.checked_next_power_of_two().unwrap_or(usize::MAX))
    }

    /// Dynamic stiffness of all strips together, as one rigid body, at each of `frequencies` (Hz):
    /// [`rigid_strip_impedances`].
    ///
    /// ```
    /// use basemat::bem::layered::{LayeredGround, StripContact};
    /// use basemat::soil::SoilProfile;
    /// use basemat::Soil;
    /// let soil = Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?;
    /// let profile = SoilProfile::on_rigid_base().with_layer(soil, 6.0)?;
    /// let found = LayeredGround::strip(profile, -3.0..3.0, 16)?
    ///     .impedances(&[1.0, 9.0], StripContact::Bonded)?;
    /// // Nothing radiates below the layer's first frequency, 6.25 Hz; above it does.
    /// assert!(found[0].horizontal.im < 1e-6 * found[0].horizontal.re);
    /// assert!(found[1].horizontal.im > 0.5 * found[1].horizontal.re);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`rigid_strip_impedances`].
    pub fn impedances(
        &self,
        frequencies: &[f64],
        contact: StripContact,
    ) -> Result<Vec<StripImpedance>> {
        rigid_strip_impedances(self.profile(), self.ground.elements(), frequencies, contact)
    }

    /// The profile.
    pub fn profile(&self) -> &SoilProfile {
        &self.layered.profile
    }
}

impl Ground for LayeredGround {
    forward! {
        self.ground;
        fn elements(&self) -> &[ContactElement];
        fn announce(&mut self, steps: usize) -> Result<()>;
        fn reserve(&mut self, steps: usize) -> Result<()>;
        fn instantaneous(&self, matrix: &mut [f64]) -> Result<()>;
        fn history(&mut self, displacement: &mut [f64]) -> Result<()>;
        fn commit(&mut self, traction: &[f64]);
        fn static_compliance(&self, matrix: &mut [f64]) -> Result<()>;
        fn shear_wave_speed(&self) -> Option<f64>;
        fn increment_error_bound(&self) -> f64;
        fn save(&self) -> Result<Vec<f64>>;
        fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()>;
        fn free_field(&self, motion: &dyn FreeField, time: f64, displacement: &mut [f64]);
    }

    fn prepare(&mut self, time_step: f64) -> Result<()> {
        self.layered.profile.check_causal()?;
        self.ground.prepare(time_step)?;
        self.used = self.layered.stages(time_step);
        Ok(())
    }

    fn soils(&self) -> Vec<Soil> {
        self.profile().soils().map(|(soil, _)| soil).collect()
    }

    fn history_choice(&self) -> Option<HistoryChoice> {
        let stages = self.used.map(Stages::count);
        self.ground.history_choice().map(|choice| HistoryChoice { stages, ..choice })
    }
}
