//! Build of a simulation, in the order of [`SimulationBuilder::build`].
//!
//! 1. `parts.rs`: the given parts, each checked alone;
//! 2. `model/assembled.rs`: matrices, base and influence vectors of the structure, in its own degrees of freedom;
//! 3. `at_rest.rs`, `static_stages.rs`: weight first, then the loads at t = 0, by the search of `statics/equilibrium.rs`;
//!    `flexible_base.rs` compares the result with the static state on twice the elements if these may be too few;
//! 4. `stepped.rs`: choice of the coordinates; matrices, base and operators in them; `vibration_modes.rs` computes
//!    all modes, `krylov.rs` and `many_forces.rs` Ritz modes;
//! 5. `scene.rs`: the scene; `initial_motion.rs`: the motion at t = 0.

mod at_rest;
mod backfilled;
mod flexible_base;
mod growing_weight;
mod held_responses;
mod initial_motion;
mod krylov;
mod many_forces;
mod p_delta_damping;
mod settled;
mod static_stages;
mod step_response;
mod stepped;
mod subspace;
mod unseen_shape;
mod vibration_modes;

use std::cell::RefCell;
use std::ops::ControlFlow;

use crate::bem::Ground;
use crate::contact::ContactSearch;
use crate::coupled::assembly::held_responses::OfHeldBase;
use crate::coupled::assembly::stepped::Stepped;
use crate::coupled::base::tears;
use crate::coupled::conditioning::conditioning;
use crate::coupled::coordinates::Coordinates;
use crate::coupled::gravity_stage::GravityStage;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::load::Load;
use crate::coupled::model::supports;
use crate::coupled::parts::{ENDLESS_STEPS, Parts, SimulationBuilder};
use crate::coupled::run::mistake::Mistake;
use crate::coupled::run::warning::Warning;
use crate::coupled::run::{Weight, wall_pressure};
use crate::coupled::scene::Scene;
use crate::coupled::scheme::TimeScheme;
use crate::coupled::serviceability::Serviceability;
use crate::coupled::simulation::Simulation;
use crate::coupled::state::State;
use crate::coupled::state::energy_balance::EnergyBalance;
use crate::coupled::statics::compliance::Compliance;
use crate::coupled::step::energy_accumulator::EnergyAccumulator;
use crate::coupled::step::forcing::Forcing;
use crate::coupled::step::increment::Increment;
use crate::coupled::step::solver::Solver;
use crate::error::{Progress, Result};
use crate::interface::InterfaceLaw;
use crate::motion::FreeField;
use crate::structure::Probe;
use crate::structure::Structure;

impl Simulation {
    /// Starts a simulation with steps of `time_step` seconds.
    pub fn builder(time_step: f64) -> SimulationBuilder {
        SimulationBuilder::new(time_step)
    }
}

impl SimulationBuilder {
    /// Sets the structure.
    #[must_use]
    pub fn structure(mut self, structure: impl Structure + 'static) -> Self {
        self.structure = Some(Box::new(structure));
        self
    }

    /// Sets the ground.
    ///
    /// Its elements define the contact area: a part of the base beyond them is not in contact, and elements beyond
    /// the base are an error. [`ElasticGround::under`](crate::bem::ElasticGround::under) avoids both.
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

    /// Sets gravity g (m/s²), which gives the structure its weight.
    ///
    /// Default: [`STANDARD_GRAVITY`](crate::motion::STANDARD_GRAVITY). The run starts from the static state under weight
    /// and the loads at t = 0 ([`GravityStage`] has the rule). With zero there is no static state: the base
    /// starts without pressure, so nothing resists uplift and sliding.
    #[must_use]
    pub fn gravity(mut self, gravity: f64) -> Self {
        self.gravity = gravity;
        self
    }

    /// Adds an external load to the previous ones and the structure's own.
    #[must_use]
    pub fn load(mut self, load: Load) -> Self {
        self.loads.push(load);
        self
    }

    /// Sets the initial displacement of the degrees of freedom, relative to the static state.
    ///
    /// It may move the base only with [`GravityStage::Unloaded`] (see the example there), and not into the ground.
    #[must_use]
    pub fn initial_displacement(mut self, displacement: impl Into<Vec<f64>>) -> Self {
        self.displacement = displacement.into();
        self
    }

    /// Sets the velocity of the degrees of freedom at t = 0.
    #[must_use]
    pub fn initial_velocity(mut self, velocity: impl Into<Vec<f64>>) -> Self {
        self.velocity = velocity.into();
        self
    }

    /// Sets the friction while the weight comes on; the rule for weight and loads is in [`GravityStage`].
    #[must_use]
    pub fn gravity_stage(mut self, gravity_stage: GravityStage) -> Self {
        self.gravity_stage = gravity_stage;
        self
    }

    /// Adds a quantity recorded at every step, see [`super::State::probes`]. Names must differ.
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

    /// Sets the point (m) along x for base moment and torque.
    ///
    /// Default: the middle of the base. Along y it is always the middle.
    #[must_use]
    pub fn moment_center(mut self, x: f64) -> Self {
        self.moment_center = Some(x);
        self
    }

    /// Sets the number of steps that will follow.
    ///
    /// Weights and memory of the ground are then ready after [`build`](SimulationBuilder::build), and the structure's
    /// coordinates are chosen for this number; by default, for 4 000. A run that ends before the last of these steps
    /// does not warn of an early end.
    #[must_use]
    pub fn expected_steps(mut self, steps: usize) -> Self {
        self.steps = if steps < ENDLESS_STEPS { steps } else { 0 };
        self
    }

    /// Sets the observer of [`build`](SimulationBuilder::build); default [`unobserved`](crate::unobserved).
    ///
    /// The observer follows the computation of the ground's convolution weights: of the expected steps, or those that
    /// the build needs.
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

    /// Omits the energy balance, so that a step takes less time.
    ///
    /// Its terms and the energy error are then NaN.
    #[must_use]
    pub fn without_energy_balance(mut self) -> Self {
        self.energy_balance = false;
        self
    }

    /// Sets friction coefficients for the factor of safety against sliding.
    ///
    /// One for all elements or one each from left to right. They replace the coefficients of the interface laws
    /// ([`InterfaceLaw::friction_coefficient`]), for example for a bonded base, which has none. They change
    /// nothing else.
    #[must_use]
    pub fn safety_friction(mut self, coefficients: impl Into<Vec<f64>>) -> Self {
        self.safety_friction = coefficients.into();
        self
    }

    /// Sets limits of slip, gap, uplifted part and rotation.
    ///
    /// Each [`Run`](crate::results::Run) is checked against them.
    ///
    /// Default: none. They change nothing else.
    #[must_use]
    pub fn serviceability(mut self, limits: Serviceability) -> Self {
        self.serviceability = limits;
        self
    }

    /// Sets the rotation of a base (rad, about a horizontal axis) at which a run ends; default 1.
    ///
    /// The geometry is valid for small rotations only, and an overturned base would rotate for ever. If infinite,
    /// runs end by their number of steps only.
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
    /// // A further call goes on.
    /// assert_eq!(simulation.run(10, |_| {})?.steps, 10);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    #[must_use]
    pub fn rotation_limit(mut self, limit: f64) -> Self {
        self.rotation_limit = limit;
        self
    }

    /// Sets a label that a [`Checkpoint`](crate::coupled::Checkpoint) keeps; default: empty.
    ///
    /// [`Simulation::resume`] compares it. Let it name interface laws, ground motion and loads, which are not compared.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Holds the base: each foundation moves rigidly with its free field.
    ///
    /// Codes and fixed-base models assume this. Ground and interface law are ignored, except for the places of the
    /// contact elements; base shear, moment and tractions then act on the support.
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
        self.held = true;
        self
    }

    /// Checks the parts against each other, finds the static state and factors constant matrices.
    ///
    /// # Errors
    /// * the typed error of a part that is wrong, [`crate::Error::Scene`] for a missing part;
    /// * [`StructureError::Restrained`](crate::structure::StructureError::Restrained) for a structure held by more than the ground, [`StructureError::Detached`](crate::structure::StructureError::Detached) for
    ///   one with a part that is not connected to its base, [`crate::Error::Indefinite`] for a negative mass or
    ///   damping, or a stiffness that is negative with the base held;
    /// * [`crate::Error::Item`] and [`crate::Error::DuplicateName`] for a probe of a degree of freedom that does
    ///   not exist or a name that occurs twice;
    /// * [`crate::Error::Stability`] if the structure cannot stand under weight and the loads at t = 0, or buckles on its
    ///   ground (P–Δ), without gravity and without a static state too;
    ///   [`crate::Error::Preload`] if no equilibrium was found for another reason;
    /// * [`crate::Error::CoarseBase`] for a flexible base on so few contact elements that twice as many change its
    ///   static shape by more than 30 %;
    /// * [`crate::Error::IllConditioned`] if double precision is insufficient for the scene;
    /// * [`crate::Error::Law`] for an interface law that returns numbers which are not finite;
    /// * [`crate::Error::Memory`] for more expected steps than fit into the memory of the ground's history;
    /// * [`crate::Error::Stopped`] by the observer.
    pub fn build(self) -> Result<Simulation> {
        let mut parts = Parts::new(self)?;
        let (assembled, held) = Assembled::new(parts.structure.as_ref(), &parts.elements)?;
        let mut held = OfHeldBase::new(&parts, &assembled, held)?;
        let shared = RefCell::default();
        let at_rest = at_rest::solve(&mut parts, &assembled, &mut held.condensed, &shared)?;
        let models = (&assembled, held.condensed.as_ref());
        let coarse = flexible_base::check(&parts, models, &at_rest, &shared)?;
        let floating = shared.take().map(|compliance: Compliance| compliance.floating);
        let structure = parts.structure.as_ref();
        let positive_definite = held.positive_definite(&assembled, floating.as_deref());
        assembled.check_damping(structure, positive_definite)?;
        let reduction = held.take_for_reduction(&assembled, floating);
        let Assembled { stiffness, influence, .. } = &assembled;
        let motion: [&[f64]; 2] = [&at_rest.displacement, &at_rest.force];
        let joined = supports::joined_by_force(structure, stiffness, influence, motion)?;
        let Stepped { model, base, operators } =
            Stepped::choose(&parts, &assembled, reduction, &at_rest)?;
        let scene = Scene::new(&mut parts, model, base, at_rest, joined);

        let Parts { mut structure, ground, description, given, first_order_ground, .. } = parts;
        let mut solver = Solver::new(&scene, operators, given.search);
        let mut state = State::at_rest(&scene)?;
        let compliant = scene.is_compliant(&state.start)?;
        let mass = &assembled.mass;
        initial_motion::set_in_motion(&given, mass, &scene, structure.as_mut(), &mut state)?;
        let mut energy = None;
        if given.energy_balance {
            energy = Some(EnergyAccumulator::new(&scene, structure.as_ref(), &state, compliant)?);
        }
        state.energy_balance =
            energy.as_ref().map_or(EnergyBalance::LEFT_OUT, |energy| energy.energy_balance);
        let mut warnings =
            Warning::of_scene(&scene, &description, given.motion.as_ref(), held.period);
        warnings.extend(first_order_ground.then_some(Warning::Mistake(Mistake::FirstOrderGround)));
        let weight = Weight::new(given.gravity, &assembled);
        let soils = &description.soils;
        Warning::add_mistakes(&mut warnings, &scene, soils, structure.as_ref(), &weight);
        warnings.extend(Warning::of_tears(tears(&structure.base())?));
        warnings.extend(coarse);
        let pressures_above =
            wall_pressure::pressures_above(&scene, &description.mass_above, given.gravity);
        let conditioning = conditioning(&scene, &mut solver, &state.start)?;
        // Checked last: stiffnesses too far apart for double precision look like a mechanism.
        held.is_firm?;
        Ok(Simulation {
            forcing: Forcing::new(&scene),
            increment: Increment::new(&scene, &state, compliant && given.energy_balance),
            books: energy,
            motion: given.motion,
            structure,
            ground,
            scene,
            solver,
            state,
            conditioning,
            warnings,
            pressures_above,
            drag: assembled.drag(),
            rotation_limit: given.rotation_limit,
            expected_steps: given.steps,
            prepared: given.steps,
        })
    }
}
