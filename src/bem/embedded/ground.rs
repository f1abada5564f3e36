//! Ground with a trench in it.

use std::path::PathBuf;

use super::earth_pressure::{self, SoilAndWater};
use super::soil::TrenchSoil;
use super::source::TrenchSource;
use super::trench::TrenchElements;
use crate::bem::layered::Stages;
use crate::bem::{Ground, GroundDescription, SharedKernels, WeightsGround, WeightsSource};
use crate::error::{Observer, Result, not_negative, positive, require, same_length};
use crate::geometry::ContactLayout;
use crate::history::{HistoryChoice, HistoryOptions};
use crate::interface::{EarthPressure, InterfaceLaw};
use crate::soil::{Relaxation, Soil, SoilProfile, SoilStrength, WaterTable};

/// Soil around a trench: profile, contact elements and backfill.
///
/// Computes the [impedances](TrenchGround::impedances) of a rigid body that is bonded to walls and base, and the
/// [motions of a body without mass](TrenchGround::kinematic_motions) under vertical waves. Plane strain, per metre of
/// length.
///
/// The soil around the trench is a mesh of finite elements of high degree. On both sides infinitely many columns of
/// elements follow. Below are rigid bedrock, or elements of complex height that absorb waves. The mesh is finer at the
/// corners of the trench and depends on the contact elements only.
///
/// As a [`Ground`] it has the elements of [`TrenchElements::elements`], along the outline. Its convolution weights follow
/// by Runge–Kutta convolution quadrature, as in layered ground, and are passive for every time step and mesh. The
/// number of stages follows [`Stages::for_profile`]. A half-plane's static compliance is determined up to two rigid
/// translations.
///
/// The mesh is as fine as the contact elements, and resolves waves of their length. Short steps on long elements excite
/// shorter waves. With two elements of the base, one of each wall, and steps in which shear waves cross a tenth of half
/// the width, the step compliance changes by 1 to 5 % with the mesh.
///
/// ```
/// use basemat::bem::embedded::{Trench, TrenchGround};
/// use basemat::bem::layered::StripContact;
/// use basemat::bem::{ElasticGround, Strip};
/// use basemat::{Soil, unobserved};
/// let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
/// let trench = Trench::new(-6.0..6.0, 6.0)?;
/// let ground = TrenchGround::new(soil, trench.elements(8, 6)?)?;
/// let embedded = ground.impedances(&[3.0], &mut unobserved)?[0];
/// let flat = ElasticGround::new(soil, Strip::graded(-6.0..6.0, 16)?)?
///     .impedances(&[3.0], StripContact::Bonded, &mut unobserved)?[0];
/// // As deep as half its width: more than twice the dashpots of the strip on the surface, horizontally and in rocking.
/// assert!(embedded.dashpots()[0] > 2.0 * flat.dashpots()[0]);
/// assert!(embedded.dashpots()[2] > 5.0 * flat.dashpots()[2]);
/// // The base moves less than the surface of the free field, and rotates.
/// let motion = ground.kinematic_motions(&[3.0], &mut unobserved)?[0];
/// assert!((motion.horizontal.abs() - 0.82).abs() < 0.01, "{motion:?}");
/// assert!((motion.rotation.abs() * 6.0 - 0.04).abs() < 0.01, "{motion:?}");
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct TrenchGround {
    source: TrenchSource,
    /// K₀ of all soils; `None`: ν/(1 − ν) of each soil.
    k0: Option<f64>,
    water: Option<WaterTable>,
    /// Runge–Kutta stages since the last [`Ground::prepare`].
    prepared_stages: Option<Stages>,
    ground: WeightsGround,
}

short_debug! { TrenchGround; self; source: self.source, ground: self.ground }

impl TrenchGround {
    /// Soil of `profile` around a trench with these `elements`.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a trench that reaches down to rigid bedrock;
    /// [`Error::Size`](crate::Error::Size) for rigid bedrock without layers.
    pub fn new(profile: impl Into<SoilProfile>, elements: TrenchElements) -> Result<Self> {
        let contact_elements = elements.elements();
        let soil = TrenchSoil::new(profile.into(), elements)?;
        let source = TrenchSource { soil, stages: None, file: None };
        let ground = WeightsGround::with_unions(source.clone(), contact_elements, None);
        Ok(Self { source, k0: None, water: None, prepared_stages: None, ground })
    }

    /// The ground with another source.
    fn with_source(self, source: TrenchSource) -> Self {
        let ground = self.ground.with_source(source.clone());
        Self { ground, source, prepared_stages: None, ..self }
    }

    /// Replaces the soil beside the walls by backfill of a `width`, m.
    ///
    /// The backfill reaches from the surface down to the base, and consists of `soil` with this `damping`.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a width that is not finite and above zero, and for a backfill that is lighter
    /// than the water of [`with_water_table`](Self::with_water_table).
    pub fn with_backfill(
        self,
        width: f64,
        soil: Soil,
        damping: impl Relaxation + 'static,
    ) -> Result<Self> {
        let source = self.source.clone();
        let soil = source.soil.with_backfill(width, soil, damping)?;
        let ground = self.with_source(TrenchSource { soil, ..source });
        ground.water.map_or(Ok(()), |water| ground.check_density(water))?;
        Ok(ground)
    }

    /// Sets K₀, the ratio of horizontal to vertical pressure at rest.
    ///
    /// The default is ν/(1 − ν) of each soil.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a ratio below zero or not finite.
    pub fn with_pressure_at_rest(self, ratio: f64) -> Result<Self> {
        let ratio = not_negative("pressure at rest over the vertical pressure", ratio)?;
        Ok(Self { k0: Some(ratio), ..self })
    }

    /// Adds a water table: the soil's pressures below it are effective.
    ///
    /// The water presses on base and walls of the structure during the whole run, also where these are open. Pressures at
    /// rest and limits of [`interfaces`](Self::interfaces), called afterwards, follow from the weight of the soil under buoyancy. Densities
    /// below the water table are those of saturated soil. Waves are those of the soil as given: water does not flow.
    ///
    /// ```
    /// use basemat::bem::embedded::{Trench, TrenchGround};
    /// use basemat::coupled::Face;
    /// use basemat::prelude::*;
    /// use basemat::soil::WaterTable;
    /// use basemat::structure::WithWalls;
    ///
    /// let elements = Trench::new(-6.0..6.0, 5.0)?.elements(2, 4)?;
    /// let soil = Soil::from_shear_wave_speed(200.0, 0.33, 2000.0)?;
    /// let ground = TrenchGround::new(soil, elements)?.with_pressure_at_rest(0.5)?;
    /// let simulation = Simulation::builder(0.01)
    ///     .structure(WithWalls::new(RigidBlock::new(12.0, 20.0, 900.0)?, 5.0)?)
    ///     .ground(ground.with_water_table(WaterTable::at_depth(0.0)?)?)
    ///     .interface(Coulomb::new(0.5)?)
    ///     .build()?;
    /// // On each wall K₀ (ρ − ρ_w) g d²/2, on the base the weight less the buoyancy.
    /// let wall = simulation.state().face(Face::LeftWall);
    /// assert!((wall.thrust / (0.5 * 1000.0 * STANDARD_GRAVITY * 12.5) - 1.0).abs() < 1e-12);
    /// let effective_weight = (900.0 * 20.0 - 1000.0 * 5.0) * STANDARD_GRAVITY * 12.0;
    /// assert!((simulation.state().normal_force / effective_weight - 1.0).abs() < 1e-9);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for water above the surface, and for a soil or backfill that is lighter than the
    /// water.
    pub fn with_water_table(self, water: WaterTable) -> Result<Self> {
        let quantity = "depth of a water table around a trench";
        require(quantity, water.depth(), water.depth() >= 0.0, "zero or more")?;
        self.check_density(water)?;
        Ok(Self { water: Some(water), ..self })
    }

    /// Returns an error for a soil or backfill that is not heavier than the water.
    fn check_density(&self, water: WaterTable) -> Result<()> {
        let quantity = "density of the soil under water";
        for soil in self.soil().soils() {
            let is_heavier = soil.density() > water.density();
            require(quantity, soil.density(), is_heavier, "above the water's")?;
        }
        Ok(())
    }

    /// Sets the number of Runge–Kutta stages.
    ///
    /// The default is [`Stages::for_profile`].
    #[must_use]
    pub fn with_stages(self, stages: Stages) -> Self {
        let source = TrenchSource { stages: Some(stages), ..self.source.clone() };
        self.with_source(source)
    }

    /// Reads convolution weights from the file `path`, and adds missing weights to it.
    ///
    /// As for [`ElasticGround::with_kernel_file`](crate::bem::ElasticGround::with_kernel_file).
    #[must_use]
    pub fn with_kernel_file(self, path: impl Into<PathBuf>) -> Self {
        let source = TrenchSource { file: Some(path.into()), ..self.source.clone() };
        self.with_source(source)
    }

    /// Replaces the options of the ground's history, or its method alone.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a tolerance not from 1e-12 to 1e-2.
    pub fn with_history(self, options: impl Into<HistoryOptions>) -> Result<Self> {
        Ok(Self { ground: self.ground.with_history(options)?, ..self })
    }

    /// Shares convolution weights with other grounds: see [`WeightsGround::with_shared_kernels`].
    #[must_use]
    pub fn with_shared_kernels(self, kernels: &SharedKernels) -> Self {
        Self { ground: self.ground.with_shared_kernels(kernels), ..self }
    }

    /// Interface laws of all elements, with earth pressure limits on the walls.
    ///
    /// The laws are for [`interfaces`](crate::coupled::SimulationBuilder::interfaces) of the builder. The pressure on
    /// each element of a wall is between the active and the passive pressure of the soil beside it ([`EarthPressure`]).
    /// These limits are means over the element; the limits of the thrust are exact.
    ///
    /// `base`: law of the base. `strengths`: one for all soils, or one for each soil from the surface down, the
    /// half-plane last. With backfill there is one strength, that of the backfill. `gravity`: as in the builder, m/s².
    ///
    /// ```
    /// use basemat::bem::embedded::{Trench, TrenchGround};
    /// use basemat::interface::{Coulomb, EarthPressure};
    /// use basemat::motion::STANDARD_GRAVITY;
    /// use basemat::soil::SoilStrength;
    /// use basemat::Soil;
    /// let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
    /// let elements = Trench::new(-6.0..6.0, 5.0)?.elements(4, 3)?;
    /// let ground = TrenchGround::new(soil, elements)?.with_pressure_at_rest(0.5)?;
    /// let sand = SoilStrength::new(30.0_f64.to_radians())?;
    /// let laws = ground.interfaces(Coulomb::new(0.5)?, &[sand], STANDARD_GRAVITY)?;
    /// assert_eq!(laws.len(), 10);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Item`](crate::Error::Item) for an element whose pressure at rest is below the active pressure or above the
    /// passive one; [`Error::Size`](crate::Error::Size) for another number of strengths;
    /// [`Error::Input`](crate::Error::Input) for a gravity that is not finite and above zero.
    pub fn interfaces(
        &self,
        base: impl InterfaceLaw + Clone + 'static,
        strengths: &[SoilStrength],
        gravity: f64,
    ) -> Result<Vec<Box<dyn InterfaceLaw>>> {
        let wall_laws = self.wall_laws(strengths, gravity)?;
        let elements = self.trench_elements().elements();
        let last_index = elements.len() - 1;
        let laws =
            elements.iter().enumerate().map(move |(index, element)| -> Box<dyn InterfaceLaw> {
                if element.faces_down() {
                    Box::new(base.clone())
                } else {
                    Box::new(wall_laws[index.min(last_index - index)])
                }
            });
        Ok(laws.collect())
    }

    /// Laws of the elements of a wall, from the surface down, as in [`interfaces`](Self::interfaces).
    ///
    /// # Errors
    /// As for [`interfaces`](Self::interfaces).
    pub fn wall_laws(
        &self,
        strengths: &[SoilStrength],
        gravity: f64,
    ) -> Result<Vec<EarthPressure>> {
        positive("gravity", gravity)?;
        if strengths.len() != 1 {
            let soil_count = if self.has_backfill() { 1 } else { self.profile().soils().count() };
            same_length("list of soil strengths", strengths.len(), soil_count)?;
        }
        earth_pressure::wall_laws(self.soil_and_water(), strengths, gravity, self.k0)
    }

    /// Soil beside and below the trench.
    pub fn profile(&self) -> &SoilProfile {
        self.soil().profile()
    }

    /// Trench, and the division of its faces into contact elements.
    pub fn trench_elements(&self) -> &TrenchElements {
        self.soil().elements()
    }

    /// Whether backfill replaces the soil beside the walls.
    pub(crate) fn has_backfill(&self) -> bool {
        self.soil().backfill_soil().is_some()
    }

    pub(super) fn soil(&self) -> &TrenchSoil {
        &self.source.soil
    }

    fn soil_and_water(&self) -> SoilAndWater<'_> {
        SoilAndWater { soil: self.soil(), water: self.water }
    }
}

impl Ground for TrenchGround {
    forward_weights_ground! { self.ground }

    fn prepare(
        &mut self,
        time_step: f64,
        steps: Option<usize>,
        observer: &mut Observer<'_>,
    ) -> Result<()> {
        self.ground.prepare(time_step, steps, observer)?;
        self.prepared_stages = Some(self.source.stages(time_step));
        Ok(())
    }

    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        let source = TrenchSource { soil: self.soil().halved(), ..self.source.clone() };
        let elements = source.soil.elements().elements();
        let mut matrix = vec![0.0; ContactLayout::for_elements(&elements).matrix_len()];
        source.static_compliance(&elements, &mut matrix)?;
        Ok(Some(matrix))
    }

    fn description(&self) -> GroundDescription {
        let description = self.ground.description();
        let stages = self.prepared_stages.map(Stages::count);
        GroundDescription {
            soils: self.soil().soils().collect(),
            identity: self.soil().identity(),
            pressure_at_rest: earth_pressure::pressures_at_rest(self.soil_and_water(), self.k0),
            depth_of_pressure_at_rest: earth_pressure::resultant_depths(
                self.soil_and_water(),
                self.k0,
            ),
            mass_above: earth_pressure::masses_above(self.soil_and_water()),
            water_table: self.water,
            history: description.history.map(|history| HistoryChoice { stages, ..history }),
            ..description
        }
    }
}
