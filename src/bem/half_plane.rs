//! The elastic half-plane as a ground.

use std::ops::Range;
use std::sync::Arc;

use super::layered::{StripContact, StripImpedance, rigid_strip_impedances};
use super::strip::strips_under;
use super::{
    Grading, Ground, KernelGround, KernelSource, PatchKernel, SharedKernels, StaticKernel, Strip,
};
use crate::error::Result;
use crate::geometry::{ContactElement, check_order};
use crate::history::{ConvolutionHistory, History, HistoryChoice, LagKernel};
use crate::motion::FreeField;
use crate::soil::{Soil, SoilProfile};
use crate::structure::Structure;

/// Homogeneous elastic half-plane with one or several strips on its surface.
///
/// The soil operator is the energetic space–time Galerkin one: element means of the displacement
/// at step ends under tractions constant over element and step, from the closed-form half-plane
/// kernel. It is passive for every step, mesh and Poisson's ratio, and radiation is exact.
///
/// ```
/// use basemat::{Soil, bem::{Ground, HalfPlaneGround}};
/// let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
/// let mut ground = HalfPlaneGround::strip(soil, -5.0..5.0, 20)?;
/// ground.prepare(1.0e-4)?;
/// let mut matrix = vec![0.0; 40 * 40];
/// ground.instantaneous(&mut matrix)?;
/// // Before waves reach the edges, a pressure moves the surface by p·t/(ρ c₁); a step of 0.1 ms
/// // leaves all but the outer few percent of an element of 0.8 m, at the middle, in that state.
/// let plane_wave = 1.0e-4 / (1900.0 * soil.pressure_wave_speed());
/// assert!((matrix[10 * 40 + 10] / plane_wave - 1.0).abs() < 0.05);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct HalfPlaneGround {
    soil: Soil,
    ground: KernelGround,
}

short_debug! { HalfPlaneGround; self; soil: self.soil, ground: self.ground }

/// The closed forms of a soil.
struct HalfPlane {
    soil: Soil,
    statics: StaticKernel,
}

impl KernelSource for HalfPlane {
    fn kernel(&self, elements: &[ContactElement], time_step: f64) -> Result<Arc<dyn LagKernel>> {
        Ok(Arc::new(PatchKernel::new(self.soil, elements.to_vec(), time_step)?))
    }

    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        self.statics.compliance(elements, matrix)
    }

    fn shear_wave_speed(&self) -> Option<f64> {
        Some(self.soil.shear_wave_speed())
    }

    fn identity(&self) -> Option<Vec<f64>> {
        Some(vec![self.soil.shear_modulus(), self.soil.poisson(), self.soil.density()])
    }
}

impl HalfPlaneGround {
    /// One strip over `range` (m) of `count` elements, graded towards its edges, where tractions are
    /// singular ([`Grading::Cosine`]).
    ///
    /// # Errors
    /// As for [`Strip::new`].
    pub fn strip(soil: Soil, range: Range<f64>, count: usize) -> Result<Self> {
        Self::new(soil, &[Strip::graded(range, count)?])
    }

    /// One strip over `range` (m) of `count` equal elements.
    ///
    /// # Errors
    /// As for [`Strip::new`].
    pub fn uniform_strip(soil: Soil, range: Range<f64>, count: usize) -> Result<Self> {
        Self::new(soil, &[Strip::uniform(range, count)?])
    }

    /// Strips of `count` elements under each foundation of `structure`, as wide as that is, graded
    /// as in [`HalfPlaneGround::strip`].
    ///
    /// ```
    /// use basemat::{Soil, bem::{Ground, HalfPlaneGround}, structure::RigidBlock};
    /// let block = RigidBlock::new(6.0, 4.0, 2400.0)?;
    /// let ground = HalfPlaneGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &block, 12)?;
    /// let (edge, middle) = (ground.elements()[0], ground.elements()[6]);
    /// assert_eq!((edge.left, ground.elements()[11].right), (-3.0, 3.0));
    /// assert!(edge.length() < 0.15 * middle.length());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`HalfPlaneGround::new`] and [`Strip::new`]; [`Error::Size`](crate::Error::Size) or
    /// [`Error::Index`](crate::Error::Index) for a
    /// structure without foundations.
    pub fn under(soil: Soil, structure: &dyn Structure, count: usize) -> Result<Self> {
        Self::new(soil, &strips_under(structure, count, Grading::Cosine)?)
    }

    /// The same of `count` equal elements each.
    ///
    /// # Errors
    /// As for [`HalfPlaneGround::under`].
    pub fn uniform_under(soil: Soil, structure: &dyn Structure, count: usize) -> Result<Self> {
        Self::new(soil, &strips_under(structure, count, Grading::Uniform)?)
    }

    /// Several strips from left to right, which talk through the soil.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for no strips, [`Error::Input`](crate::Error::Input) for
    /// strips that overlap or are out of order.
    pub fn new(soil: Soil, strips: &[Strip]) -> Result<Self> {
        let elements: Vec<_> = strips.iter().flat_map(Strip::elements).collect();
        check_order(&elements)?;
        let statics = StaticKernel::under(soil, &elements)?;
        let ground = KernelGround::new(HalfPlane { soil, statics }, elements)?;
        Ok(Self { soil, ground })
    }

    /// As [`KernelGround::with_history_kind`].
    #[must_use]
    pub fn with_history_kind(self, history: History) -> Self {
        Self { ground: self.ground.with_history_kind(history), ..self }
    }

    /// As [`KernelGround::with_history_tolerance`].
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a tolerance not from 1e-12 to 1e-2.
    pub fn with_history_tolerance(self, tolerance: f64) -> Result<Self> {
        Ok(Self { ground: self.ground.with_history_tolerance(tolerance)?, ..self })
    }

    /// As [`KernelGround::with_history_memory`].
    #[must_use]
    pub fn with_history_memory(self, bytes: usize) -> Self {
        Self { ground: self.ground.with_history_memory(bytes), ..self }
    }

    /// As [`KernelGround::with_history`].
    #[must_use]
    pub fn with_history(
        self,
        make: impl Fn(Arc<dyn LagKernel>) -> Box<dyn ConvolutionHistory> + Send + 'static,
    ) -> Self {
        Self { ground: self.ground.with_history(make), ..self }
    }

    /// As [`KernelGround::with_shared_kernels`].
    #[must_use]
    pub fn with_shared_kernels(self, kernels: &SharedKernels) -> Self {
        Self { ground: self.ground.with_shared_kernels(kernels), ..self }
    }

    /// Dynamic stiffness of all strips together, as one rigid body, at each of `frequencies` (Hz):
    /// [`rigid_strip_impedances`].
    ///
    /// ```
    /// use basemat::bem::HalfPlaneGround;
    /// use basemat::bem::layered::StripContact;
    /// use basemat::Soil;
    /// let ground = HalfPlaneGround::strip(Soil::new(80.0e6, 0.33, 1900.0)?, -3.0..3.0, 16)?;
    /// let found = ground.impedances(&[2.0, 8.0], StripContact::Bonded)?;
    /// // Vertical dashpots come near that of plane waves, ρ c₁ per area.
    /// let plane = 1900.0 * ground.soil().pressure_wave_speed() * 6.0;
    /// assert!((found[1].dashpots()[1] / plane - 1.0).abs() < 0.1);
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
        let profile = SoilProfile::on_half_plane(self.soil);
        rigid_strip_impedances(&profile, self.ground.elements(), frequencies, contact)
    }

    /// The soil.
    pub fn soil(&self) -> Soil {
        self.soil
    }
}

impl Ground for HalfPlaneGround {
    forward! {
        self.ground;
        fn elements(&self) -> &[ContactElement];
        fn prepare(&mut self, time_step: f64) -> Result<()>;
        fn announce(&mut self, steps: usize) -> Result<()>;
        fn reserve(&mut self, steps: usize) -> Result<()>;
        fn instantaneous(&self, matrix: &mut [f64]) -> Result<()>;
        fn history(&mut self, displacement: &mut [f64]) -> Result<()>;
        fn commit(&mut self, traction: &[f64]);
        fn static_compliance(&self, matrix: &mut [f64]) -> Result<()>;
        fn shear_wave_speed(&self) -> Option<f64>;
        fn history_choice(&self) -> Option<HistoryChoice>;
        fn increment_error_bound(&self) -> f64;
        fn save(&self) -> Result<Vec<f64>>;
        fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()>;
        fn free_field(&self, motion: &dyn FreeField, time: f64, displacement: &mut [f64]);
    }

    fn soils(&self) -> Vec<Soil> {
        vec![self.soil]
    }
}
