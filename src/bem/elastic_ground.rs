//! Elastic or viscoelastic soil under strips and mats.

use std::path::PathBuf;
use std::sync::Arc;

use super::elastic_source::ElasticSource;
use super::layered::Stages;
use super::plan::{Plan, passivity_sample, static_compliance};
use super::{
    Grading, Ground, GroundDescription, SharedKernels, Strip, WeightsGround, WeightsSource,
};
use crate::error::{Observer, Result, require};
use crate::geometry::{COMPONENTS_IN_SPACE, check_count, check_order};
use crate::history::{ConvolutionHistory, ConvolutionWeights, HistoryChoice, HistoryOptions};
use crate::soil::SoilProfile;
use crate::structure::Structure;

/// Elastic half-plane or damped layers under strips or mats.
///
/// For a [`Soil`](crate::Soil) the ground is a homogeneous half-plane. Its weights follow from the energetic space–time
/// Galerkin method and the closed-form half-plane kernel ([`PatchKernel`](super::PatchKernel)): they are element means of
/// the displacement at step ends, due to tractions that are constant over element and step. Radiation is exact.
///
/// The weights of a [`SoilProfile`] with layers or damping come from Runge–Kutta convolution quadrature of its mobility
/// (Radau IIA), with the same tractions. [`Stages::for_profile`] chooses the number of stages, and
/// [`Ground::description`] reports it.
///
/// Both kinds of weights are passive for every time step, mesh, Poisson's ratio, profile and passive damping law. The
/// free field is the motion of the surface; [`site::SoilColumn`](crate::site::SoilColumn) computes it from a motion at
/// depth in the same profile.
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::{ElasticGround, Ground, Strip};
/// let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
/// let mut ground = ElasticGround::new(soil, Strip::graded(-5.0..5.0, 20)?)?;
/// ground.prepare(1.0e-4, None, &mut basemat::unobserved)?;
/// let mut matrix = vec![0.0; 40 * 40];
/// ground.step_compliance(&mut matrix)?;
/// // Before waves reach the edges of an element, a pressure displaces its surface by p·t/(ρ c₁). After a step of
/// // 0.1 ms waves have reached only the outer few per cent of an element of 0.8 m.
/// let plane_wave = 1.0e-4 / (1900.0 * soil.pressure_wave_speed());
/// assert!((matrix[10 * 40 + 10] / plane_wave - 1.0).abs() < 0.05);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// ```
/// use basemat::bem::ElasticGround;
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::soil::{GeneralizedMaxwell, SoilProfile};
/// use basemat::structure::RigidBlock;
/// use basemat::{Simulation, Soil};
///
/// // Six metres of soft soil with 5 % damping on rock with 1 %.
/// let damping = |ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0);
/// let profile = SoilProfile::on_half_plane(Soil::from_shear_wave_speed(500.0, 0.3, 2100.0)?)
///     .with_bedrock_damping(damping(0.01)?)
///     .with_layer(Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?, 6.0)?
///     .with_damping(damping(0.05)?);
/// let block = RigidBlock::new(6.0, 9.0, 2000.0)?;
/// let mut simulation = Simulation::builder(0.005)
///     .ground(ElasticGround::under(profile, &block, 8)?)
///     .structure(block)
///     .interface(Coulomb::new(0.5)?)
///     .motion(el_centro_1940())
///     .build()?;
/// let run = simulation.run(400, |_| {})?;
/// assert!(run.energy_error < 1e-9);
/// assert!(simulation.ground().description().history.unwrap().to_string().contains("3 stages"));
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct ElasticGround {
    /// Profile, plan and accuracy, from which the weights are computed.
    source: ElasticSource,
    /// Runge–Kutta stages since the last [`Ground::prepare`]; `None` for the closed form.
    prepared_stages: Option<Stages>,
    /// Ground of the weights of `source`.
    ground: WeightsGround,
}

short_debug! { ElasticGround; self; source: self.source, ground: self.ground }

/// Relative tolerances of element compliances: below the range rounding errors are larger, above it passivity is lost.
const TOLERANCE_RANGE: std::ops::RangeInclusive<f64> = 1e-13..=1e-4;

impl ElasticGround {
    /// Ground of a [`Soil`](crate::Soil) or a [`SoilProfile`] under one [`Strip`], or several from left to right.
    ///
    /// Strips are coupled through the soil.
    ///
    /// With damping that is not causal the ground can only compute [`impedances`](ElasticGround::impedances): a
    /// simulation returns [`SoilError::NotCausal`](crate::soil::SoilError::NotCausal).
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for no strips or rigid bedrock without layers,
    /// [`Error::Input`](crate::Error::Input) for strips that overlap or are out of order,
    /// [`Error::Memory`](crate::Error::Memory) for more elements than their matrices allow.
    pub fn new(profile: impl Into<SoilProfile>, strips: impl AsRef<[Strip]>) -> Result<Self> {
        let elements: Vec<_> = strips.as_ref().iter().flat_map(Strip::elements).collect();
        check_order(&elements)?;
        let source = ElasticSource::new(profile.into(), None)?;
        let ground = WeightsGround::new(source.clone(), elements)?;
        Ok(Self { source, prepared_stages: None, ground })
    }

    /// Ground of a [`Soil`](crate::Soil) or a [`SoilProfile`] in three dimensions, under the cells of a [`Plan`].
    ///
    /// Each cell is a contact element with three directions. The half-plane of a profile is then a half-space. All
    /// cells are coupled through the soil, also cells of different mats.
    ///
    /// ```
    /// use basemat::Soil;
    /// use basemat::bem::plan::Plan;
    /// use basemat::bem::{ElasticGround, Ground};
    /// let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
    /// let mut ground = ElasticGround::in_plan(soil, Plan::rectangle(-5.0..5.0, -5.0..5.0, 4)?)?;
    /// ground.prepare(1.0e-3, None, &mut basemat::unobserved)?;
    /// let mut matrix = vec![0.0; 48 * 48];
    /// ground.step_compliance(&mut matrix)?;
    /// // Before waves reach the next cell, a pressure displaces the surface by p·t/(ρ c₁), except near the edges.
    /// let plane_wave = 1.0e-3 / (1900.0 * soil.pressure_wave_speed());
    /// assert!((matrix[0] / plane_wave - 1.0).abs() < 0.5);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for rigid bedrock without layers; [`Error::Memory`](crate::Error::Memory) for
    /// more cells than their matrices allow.
    pub fn in_plan(profile: impl Into<SoilProfile>, plan: Plan) -> Result<Self> {
        let elements = plan.elements();
        check_count(elements.len(), COMPONENTS_IN_SPACE)?;
        let source = ElasticSource::new(profile.into(), Some(plan))?;
        // Contact elements of several cells or of a part of a cell; `None` if each element is one whole cell.
        let unions = match &source.plan {
            Some(plan) => plan.unions(&source.profile, source.tolerance)?,
            None => None,
        };
        let ground = WeightsGround::with_unions(source.clone(), elements, unions);
        Ok(Self { source, prepared_stages: None, ground })
    }

    /// Ground with `count` elements under each foundation of `structure`.
    ///
    /// A strip is as wide as its foundation, and its elements are graded towards the edges, where tractions are
    /// singular: [`Strip::under`] with [`Grading::Cosine`]. Under a structure with [faces](crate::structure::Base::Faces)
    /// the result is a ground [in plan](ElasticGround::in_plan), with `count` cells along the shorter side of all faces
    /// together: [`Plan::on_faces`].
    ///
    /// Cells under a flexible base in plan extend beyond its outline by a fraction of the overhang under a rigid base
    /// (see [`Plan`]).
    /// The fraction is one under a stiff base, and zero under a soft base, which settles with the soil beyond its edge. It
    /// is x²/(1 + x²), in steps of a seventh, with x = (D/G)^(1/3)/h. D is the bending stiffness (N·m) in the structure's
    /// stiffness matrix, G the shear modulus at the surface, and h the side of a cell. The fraction is zero below x = 0.28
    /// and half at x = 1. At edges oblique to the cells the overhang is the smallest of three: twice the overhang of the
    /// other edges, 0.12 of a cell, and 0.03 + 0.15/√n + 0.06/(1 + d/0.15) of a cell. Here n is the number of cells along
    /// the shorter side, and d = D/(G R³) on a base of the area π R².
    ///
    /// Under loads on the edge, moments of round bases need more cells than moments of square bases. In a circular plate
    /// with D/(G R³) = 0.02 their errors are 38, 16 and 7 % of the largest moment with 8, 13 and 21 cells along the
    /// diameter, and 6, 3 and 2 % under a uniform load.
    ///
    /// A flexible base gets at least one element for each of its segments, or as many cells as it has faces (two
    /// triangles count as one). The soil acts on means of the displacement over elements, so that only the structure
    /// resists deformation within an element. A user's strips or plan may have fewer elements; `build` then checks that
    /// their number is sufficient.
    ///
    /// # Errors
    /// As for [`ElasticGround::new`] and [`Strip::under`], or [`ElasticGround::in_plan`] and [`Plan::on_faces`]; for a
    /// flexible base in plan also errors of its stiffness matrix.
    pub fn under(
        profile: impl Into<SoilProfile>,
        structure: &dyn Structure,
        count: usize,
    ) -> Result<Self> {
        let profile = profile.into();
        match Plan::of_base(structure, count, profile.surface().as_ref())? {
            Some(plan) => Self::in_plan(profile, plan),
            None => Self::new(profile, Strip::under(structure, count, Grading::Cosine)?),
        }
    }

    /// Replaces the source by a changed copy, for the `with_…` methods.
    fn with_changed_source(mut self, change: impl FnOnce(&mut ElasticSource)) -> Self {
        change(&mut self.source);
        let ground = self.ground.with_source(self.source.clone());
        Self { ground, prepared_stages: None, ..self }
    }

    /// Sets the number of Runge–Kutta stages, in place of the automatic choice and of the closed form.
    #[must_use]
    pub fn with_stages(self, stages: Stages) -> Self {
        self.with_changed_source(|source| source.stages = Some(stages))
    }

    /// Sets the relative `tolerance` (1e-13 to 1e-4) of element compliances in the Laplace domain.
    ///
    /// The default is 1e-10. Weights are computed in blocks of lags. The relative error of a weight is about the tolerance
    /// to the power 2/3 at the last lag of its block, and smaller at earlier lags. The closed form is exact.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a tolerance not from 1e-13 to 1e-4.
    pub fn with_tolerance(self, tolerance: f64) -> Result<Self> {
        let is_in_range = TOLERANCE_RANGE.contains(&tolerance);
        require("tolerance of a layered ground", tolerance, is_in_range, "from 1e-13 to 1e-4")?;
        Ok(self.with_changed_source(|source| source.tolerance = tolerance))
    }

    /// Reads convolution weights from the file `path`, and adds missing weights to it.
    ///
    /// The closed form of the half-plane needs no file. The weights of a half-space in plan are stored as those of
    /// layers are. In plan the table of form factors and the passivity check are computed again.
    ///
    /// Weights from a file equal computed weights to the last bit. A file of another profile, mesh, step, accuracy,
    /// machine or format is replaced. A damaged file, or a file with other content, stays unchanged and causes an
    /// error.
    ///
    /// ```
    /// use basemat::Soil;
    /// use basemat::bem::{ElasticGround, Strip};
    /// use basemat::soil::SoilProfile;
    /// let path = std::env::temp_dir().join("basemat-doctest.kernel");
    /// let soil = Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?;
    /// let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, 6.0)?;
    /// let ground = ElasticGround::new(profile, Strip::uniform(-5.0..5.0, 4)?)?;
    /// ground.with_kernel_file(&path).weights(0.01)?.prepare(100, &mut basemat::unobserved)?;
    /// // Four distances, three components and 128 lags, with six further words of eight bytes.
    /// assert_eq!(std::fs::metadata(&path).unwrap().len(), 8 * (4 * 3 * 128 + 6));
    /// # std::fs::remove_file(path).unwrap();
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// The methods of the weights can then also return [`Error::File`](crate::Error::File).
    #[must_use]
    pub fn with_kernel_file(self, path: impl Into<PathBuf>) -> Self {
        self.with_changed_source(|source| source.file = Some(path.into()))
    }

    /// Sets the options of the ground's history, or its method alone.
    ///
    /// A history by [exponentials](crate::history::HistoryMethod::Exponentials) exists only for the closed form.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a tolerance not from 1e-12 to 1e-2.
    pub fn with_history(self, options: impl Into<HistoryOptions>) -> Result<Self> {
        Ok(Self { ground: self.ground.with_history(options)?, ..self })
    }

    /// Sets a user's history: see [`WeightsGround::with_own_history`].
    #[must_use]
    pub fn with_own_history(
        self,
        make: impl Fn(Arc<dyn ConvolutionWeights>) -> Box<dyn ConvolutionHistory> + Send + 'static,
    ) -> Self {
        Self { ground: self.ground.with_own_history(make), ..self }
    }

    /// Uses weights from a store shared with other grounds: see [`WeightsGround::with_shared_kernels`].
    #[must_use]
    pub fn with_shared_kernels(self, kernels: &SharedKernels) -> Self {
        Self { ground: self.ground.with_shared_kernels(kernels), ..self }
    }

    /// Convolution weights for steps of `time_step` seconds, not yet computed.
    ///
    /// The ground's history uses the same weights, of its contact elements or of the cells of its plan. Shared kernels
    /// are not used here.
    ///
    /// ```
    /// use basemat::Soil;
    /// use basemat::bem::{ElasticGround, Strip};
    /// use basemat::soil::{GeneralizedMaxwell, SoilProfile};
    /// let soil = Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?;
    /// let profile = SoilProfile::on_rigid_bedrock()
    ///     .with_layer(soil, 6.0)?
    ///     .with_damping(GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0)?);
    /// let ground = ElasticGround::new(profile, Strip::uniform(-5.0..5.0, 4)?)?;
    /// let weights = ground.weights(0.01)?;
    /// let [mut normal, mut tangential, mut coupling] = [[0.0; 20]; 3];
    /// weights.coefficients(0, 1, &mut [&mut normal, &mut tangential, &mut coupling])?;
    /// assert!(normal[0] > 0.0 && coupling[0].abs() < 1e-12 * normal[0]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// In layered ground [`prepare`](ConvolutionWeights::prepare) computes the blocks of lags up to the requested lag,
    /// after a check of passivity: the smallest eigenvalue of Herm[(1−z) Ĝ(z)] on |z| = 0.99. The observer counts
    /// samples of the mobility, with their expected number as the total.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a time step that is not positive,
    /// [`SoilError::NotCausal`](crate::soil::SoilError::NotCausal) for damping that exists in the frequency domain
    /// only. `prepare` and [`coefficients`](ConvolutionWeights::coefficients) return
    /// [`Error::Memory`](crate::Error::Memory) beyond the [limit](crate::memory_limit), before anything is computed,
    /// and [`Error::NotPassive`](crate::Error::NotPassive) or
    /// [`SoilError::Modulus`](crate::soil::SoilError::Modulus) for a damping law that is not passive.
    pub fn weights(&self, time_step: f64) -> Result<Arc<dyn ConvolutionWeights>> {
        self.source.kernel(self.elements(), time_step)
    }

    /// Soil profile of the ground.
    pub fn profile(&self) -> &SoilProfile {
        &self.source.profile
    }
}

impl Ground for ElasticGround {
    forward_weights_ground! { self.ground }

    fn prepare(
        &mut self,
        time_step: f64,
        steps: Option<usize>,
        observer: &mut Observer<'_>,
    ) -> Result<()> {
        self.source.profile.check_causal()?;
        self.ground.prepare(time_step, steps, observer)?;
        self.prepared_stages = self.source.stages(time_step);
        Ok(())
    }

    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        let Some(plan) = &self.source.plan else {
            return self.ground.finer_compliance();
        };
        let ElasticSource { profile, tolerance, .. } = &self.source;
        let quartered_plan = plan.quartered();
        let mut matrix = vec![0.0; (4 * COMPONENTS_IN_SPACE * self.elements().len()).pow(2)];
        match quartered_plan.unions(profile, *tolerance)? {
            // The factor 1.0: springs of cut cells have their static compliance.
            Some(unions) => unions.reduce(&mut matrix, 1.0, |cells| {
                static_compliance(profile, &quartered_plan, *tolerance, cells)
            })?,
            None => static_compliance(profile, &quartered_plan, *tolerance, &mut matrix)?,
        }
        Ok(Some(matrix))
    }

    fn description(&self) -> GroundDescription {
        let description = self.ground.description();
        let stages = self.prepared_stages.map(Stages::count);
        GroundDescription {
            soils: self.profile().soils().map(|(soil, _)| soil).collect(),
            sampled_cells: self.source.plan.as_ref().and_then(passivity_sample),
            history: description.history.map(|history| HistoryChoice { stages, ..history }),
            ..description
        }
    }
}
