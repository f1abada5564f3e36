//! Builder of a simulation: parts with their defaults, and the methods that set them.

use std::ops::ControlFlow;

use crate::bem::Ground;
use crate::contact::ContactSearch;
use crate::coupled::coordinates::Coordinates;
use crate::coupled::gravity_stage::GravityStage;
use crate::coupled::joint::Joint;
use crate::coupled::model::load::Load;
use crate::coupled::scheme::{Midpoint, TimeScheme};
use crate::coupled::serviceability::Serviceability;
use crate::error::{Progress, unobserved};
use crate::interface::InterfaceLaw;
use crate::motion::{AtRest, FreeField, STANDARD_GRAVITY};
use crate::soil::WaterTable;
use crate::structure::Probe;
use crate::structure::Structure;

/// Smallest number of steps that stands for a run without a known end.
pub(crate) const MIN_ENDLESS_STEP_COUNT: usize = match 1_usize.checked_shl(40) {
    Some(steps) => steps,
    None => usize::MAX >> 4,
};

/// Default rotation of a base at which a run ends, rad: the base has then overturned.
const DEFAULT_ROTATION_LIMIT: f64 = 1.0;

/// Parts of a [`Simulation`](crate::Simulation).
///
/// A structure, a ground and an interface law are needed. All other settings have defaults: no motion, standard
/// gravity, the midpoint rule, no probes.
pub struct SimulationBuilder {
    pub(crate) structure: Option<Box<dyn Structure>>,
    pub(crate) ground: Option<Box<dyn Ground>>,
    pub(crate) time_step: f64,
    pub(crate) laws: Vec<Box<dyn InterfaceLaw>>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) motion: Box<dyn FreeField>,
    pub(crate) scheme: Box<dyn TimeScheme>,
    pub(crate) search: ContactSearch,
    pub(crate) gravity: f64,
    pub(crate) gravity_stage: GravityStage,
    pub(crate) loads: Vec<Load>,
    pub(crate) water_table: Option<WaterTable>,
    /// Displacement of the degrees of freedom at t = 0; empty for zero.
    pub(crate) initial_displacement: Vec<f64>,
    /// Velocity of the degrees of freedom at t = 0; empty for zero.
    pub(crate) initial_velocity: Vec<f64>,
    pub(crate) probes: Vec<Probe>,
    pub(crate) moment_center: Option<f64>,
    /// Expected number of steps; 0 if unknown.
    pub(crate) expected_steps: usize,
    pub(crate) coordinates: Coordinates,
    pub(crate) has_energy_balance: bool,
    pub(crate) safety_friction_coefficients: Vec<f64>,
    pub(crate) serviceability: Serviceability,
    /// Rotation of a base at which a run ends, rad.
    pub(crate) rotation_limit: f64,
    /// Whether the base is fixed instead of standing on the ground.
    pub(crate) has_fixed_base: bool,
    pub(crate) label: String,
    pub(crate) observer: Box<dyn FnMut(Progress) -> ControlFlow<()> + Send>,
}

short_debug! {
    SimulationBuilder;
    self;
    time_step: self.time_step,
    structure: self.structure.is_some(),
    ground: self.ground.is_some(),
    laws: self.laws.len(),
    gravity: self.gravity,
    gravity_stage: self.gravity_stage,
    search: self.search,
    coordinates: self.coordinates,
}

impl SimulationBuilder {
    /// Settings with this time step; all others have defaults.
    pub(crate) fn new(time_step: f64) -> Self {
        Self {
            structure: None,
            ground: None,
            time_step,
            laws: Vec::new(),
            joints: Vec::new(),
            motion: Box::new(AtRest),
            scheme: Box::new(Midpoint),
            search: ContactSearch::default(),
            gravity: STANDARD_GRAVITY,
            gravity_stage: GravityStage::default(),
            loads: Vec::new(),
            water_table: None,
            initial_displacement: Vec::new(),
            initial_velocity: Vec::new(),
            probes: Vec::new(),
            moment_center: None,
            expected_steps: 0,
            coordinates: Coordinates::default(),
            has_energy_balance: true,
            safety_friction_coefficients: Vec::new(),
            serviceability: Serviceability::default(),
            rotation_limit: DEFAULT_ROTATION_LIMIT,
            has_fixed_base: false,
            label: String::new(),
            observer: Box::new(unobserved),
        }
    }

    /// Whether weight and loads act before the run begins.
    pub(crate) fn has_static_loads(&self) -> bool {
        self.gravity > 0.0 && self.gravity_stage != GravityStage::Unloaded
    }

    /// Whether weight acts as a load from t = 0 on.
    pub(crate) fn starts_unloaded(&self) -> bool {
        self.gravity > 0.0 && self.gravity_stage == GravityStage::Unloaded
    }

    /// Sets the structure.
    #[must_use]
    pub fn structure(mut self, structure: impl Structure + 'static) -> Self {
        self.structure = Some(Box::new(structure));
        self
    }

    /// Sets the ground.
    ///
    /// Its elements define the contact area. A part of the base beyond the elements is not in contact, and elements
    /// beyond the base are an error. [`ElasticGround::under`](crate::bem::ElasticGround::under) avoids both.
    #[must_use]
    pub fn ground(mut self, ground: impl Ground + 'static) -> Self {
        self.ground = Some(Box::new(ground));
        self
    }

    /// Sets one interface law for all elements.
    #[must_use]
    pub fn interface(mut self, law: impl InterfaceLaw + 'static) -> Self {
        self.laws = vec![Box::new(law)];
        self
    }

    /// Sets an interface law for each element, from left to right.
    #[must_use]
    pub fn interfaces(mut self, laws: Vec<Box<dyn InterfaceLaw>>) -> Self {
        self.laws = laws;
        self
    }

    /// Adds a joint: contact between two lines of nodes of the structure.
    ///
    /// Joints exist only in the plane. [`State::joints`](crate::coupled::State::joints) has its results.
    #[must_use]
    pub fn joint(mut self, joint: Joint) -> Self {
        self.joints.push(joint);
        self
    }

    /// Sets the ground motion.
    #[must_use]
    pub fn motion(mut self, motion: impl FreeField + 'static) -> Self {
        self.motion = Box::new(motion);
        self
    }

    /// Sets the structure's time scheme; default [`Midpoint`](crate::coupled::Midpoint).
    #[must_use]
    pub fn scheme(mut self, scheme: impl TimeScheme + 'static) -> Self {
        self.scheme = Box::new(scheme);
        self
    }

    /// Sets the search for the contact modes of a step.
    #[must_use]
    pub fn contact_search(mut self, search: ContactSearch) -> Self {
        self.search = search;
        self
    }

    /// Sets gravity g (m/s²), which determines the structure's weight.
    ///
    /// Default: [`STANDARD_GRAVITY`](crate::motion::STANDARD_GRAVITY). The run starts from the static state under the
    /// weight and the loads at t = 0, as [`GravityStage`] defines. Without gravity there is no static state. The base
    /// then starts without pressure and without resistance to uplift and sliding.
    #[must_use]
    pub fn gravity(mut self, gravity: f64) -> Self {
        self.gravity = gravity;
        self
    }

    /// Adds an external load to the previous loads and to the load of the structure.
    #[must_use]
    pub fn load(mut self, load: Load) -> Self {
        self.loads.push(load);
        self
    }

    /// Sets the water table, of a base on the surface.
    ///
    /// Its pressure acts up on the base, with the weight and during the whole run. Pressures, resultants, factors of safety
    /// and friction are then effective; [`Run::buoyancy`](crate::results::Run::buoyancy) has the force of the water. In a
    /// trench the water also acts on the soil beside the walls: give it to
    /// [`TrenchGround::with_water_table`](crate::bem::embedded::TrenchGround::with_water_table).
    #[must_use]
    pub fn water_table(mut self, water: WaterTable) -> Self {
        self.water_table = Some(water);
        self
    }

    /// Sets the initial displacement of the degrees of freedom, relative to the static state.
    ///
    /// A displacement of the base needs [`GravityStage::Unloaded`] (see the example there) and must not press it into
    /// the ground.
    #[must_use]
    pub fn initial_displacement(mut self, displacement: impl Into<Vec<f64>>) -> Self {
        self.initial_displacement = displacement.into();
        self
    }

    /// Sets the velocity of the degrees of freedom at t = 0.
    #[must_use]
    pub fn initial_velocity(mut self, velocity: impl Into<Vec<f64>>) -> Self {
        self.initial_velocity = velocity.into();
        self
    }

    /// Sets the friction while the weight is applied, as [`GravityStage`] defines.
    #[must_use]
    pub fn gravity_stage(mut self, gravity_stage: GravityStage) -> Self {
        self.gravity_stage = gravity_stage;
        self
    }

    /// Adds a quantity that is recorded at every step.
    ///
    /// [`State::probes`](crate::coupled::State::probes) has its value. Names of probes must differ.
    #[must_use]
    pub fn probe(mut self, probe: Probe) -> Self {
        self.probes.push(probe);
        self
    }

    /// Adds probes.
    #[must_use]
    pub fn probes(mut self, probes: impl IntoIterator<Item = Probe>) -> Self {
        self.probes.extend(probes);
        self
    }

    /// Sets the x coordinate (m) of the point to which base moment and torque refer.
    ///
    /// Default: the middle of the base. The y coordinate is always that of the middle.
    #[must_use]
    pub fn moment_center(mut self, x: f64) -> Self {
        self.moment_center = Some(x);
        self
    }

    /// Sets the number of steps that will follow.
    ///
    /// [`build`](SimulationBuilder::build) then computes the ground's convolution weights and allocates its memory for
    /// this number, and chooses the structure's coordinates for it. By default the coordinates are chosen for 4 000
    /// steps. A run that ends before the last of the expected steps does not warn of an early end.
    #[must_use]
    pub fn expected_steps(mut self, steps: usize) -> Self {
        self.expected_steps = if steps < MIN_ENDLESS_STEP_COUNT { steps } else { 0 };
        self
    }

    /// Sets the observer of [`build`](SimulationBuilder::build); default [`unobserved`](crate::unobserved).
    ///
    /// The build reports to the observer how many convolution weights of the ground it has computed. It computes the
    /// weights of all expected steps, or only those that it needs itself if no number is expected.
    #[must_use]
    pub fn observer(
        mut self,
        observer: impl FnMut(Progress) -> ControlFlow<()> + Send + 'static,
    ) -> Self {
        self.observer = Box::new(observer);
        self
    }

    /// Sets the coordinates in which a linear structure is stepped; default [`Coordinates::Auto`].
    #[must_use]
    pub fn coordinates(mut self, coordinates: Coordinates) -> Self {
        self.coordinates = coordinates;
        self
    }

    /// Omits the energy balance, which saves time in each step.
    ///
    /// Its terms and the energy error are then NaN.
    #[must_use]
    pub fn without_energy_balance(mut self) -> Self {
        self.has_energy_balance = false;
        self
    }

    /// Sets friction coefficients for the factor of safety against sliding.
    ///
    /// Pass one coefficient for all elements, or one for each from left to right. They replace the coefficients of the
    /// interface laws ([`InterfaceLaw::friction_coefficient`]), for example for a bonded base, which has none. Only the
    /// factor of safety depends on them.
    #[must_use]
    pub fn safety_friction(mut self, coefficients: impl Into<Vec<f64>>) -> Self {
        self.safety_friction_coefficients = coefficients.into();
        self
    }

    /// Sets limits of slip, gap, uplifted fraction, rotation and settlement.
    ///
    /// Each [`Run`](crate::results::Run) is compared with the limits, which change no other result. Default: no limits.
    #[must_use]
    pub fn serviceability(mut self, limits: Serviceability) -> Self {
        self.serviceability = limits;
        self
    }

    /// Sets the rotation of a base at which a run ends, rad; default 1.
    ///
    /// The rotation is about a horizontal axis. The geometry is valid for small rotations only, and an overturned base
    /// would rotate without end. With an infinite limit, runs end by their number of steps only.
    ///
    /// ```
    /// use basemat::Simulation;
    /// use basemat::bem::SpringGround;
    /// use basemat::coupled::Warning;
    /// use basemat::interface::Coulomb;
    /// use basemat::motion::el_centro_1940;
    /// use basemat::structure::RigidBlock;
    ///
    /// let slender = RigidBlock::new(1.0, 10.0, 2000.0)?.with_p_delta(9.81)?;
    /// let mut simulation = Simulation::builder(0.01)
    ///     .structure(slender)
    ///     .ground(SpringGround::new(-0.5..0.5, 8, 2e9, 1e9)?.with_dashpots(1e6, 1e6)?)
    ///     .interface(Coulomb::new(0.6)?)
    ///     .motion(el_centro_1940().scaled(2.0)?)
    ///     .build()?;
    /// let run = simulation.run(2000, |_| {})?;
    /// assert!(run.is_overturned && run.steps < 2000);
    /// assert!(run.warnings.iter().any(|warning| matches!(warning, Warning::Overturned { .. })));
    /// // A further call continues the run.
    /// assert_eq!(simulation.run(10, |_| {})?.steps, 10);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    #[must_use]
    pub fn rotation_limit(mut self, limit: f64) -> Self {
        self.rotation_limit = limit;
        self
    }

    /// Sets a label that a [`Checkpoint`](crate::coupled::Checkpoint) stores; default: empty.
    ///
    /// [`Simulation::resume`](crate::Simulation::resume) compares the label. It does not compare interface laws, ground
    /// motion and loads: name them in the label.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Fixes the base: each foundation moves rigidly with its free field.
    ///
    /// Design codes and fixed-base models assume this. Of the ground only the positions of the contact elements are
    /// used, and of the interface law nothing. Base shear, moment and tractions then act on the support.
    /// [`interaction`](crate::analyses::interaction()) compares the run with the run on the ground.
    ///
    /// ```
    /// use basemat::bem::ElasticGround;
    /// use basemat::interface::Coulomb;
    /// use basemat::motion::el_centro_1940;
    /// use basemat::structure::{ShearBuilding, Storey};
    /// use basemat::{Simulation, Soil};
    ///
    /// let building = ShearBuilding::new(8.0, 50.0e3, 4.0e5, &[Storey::new(3.0, 20.0e3, 20.0e6); 4])?;
    /// let mut simulation = Simulation::builder(0.01)
    ///     .ground(ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &building, 8)?)
    ///     .structure(building)
    ///     .interface(Coulomb::new(0.5)?)
    ///     .motion(el_centro_1940())
    ///     .on_fixed_base()
    ///     .build()?;
    /// let run = simulation.run(500, |_| {})?;
    /// assert!(run.whole.base_rotation.magnitude() < 1e-7);
    /// assert!(run.whole.base_shear.magnitude() > 0.0);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    #[must_use]
    pub fn on_fixed_base(mut self) -> Self {
        self.has_fixed_base = true;
        self
    }
}
