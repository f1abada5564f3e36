//! Putting a simulation together.

use std::sync::Arc;

use super::books::Books;
use super::builder_checks::{check_unknowns, instantaneous_operator, motion_at_start};
use super::coordinates::{Chooser, Coordinates};
use super::initial::Beginning;
use super::ledger::Ledger;
use super::load::Load;
use super::scene::base::Base;
use super::scene::conditioning;
use super::scene::laws;
use super::scene::model::{Model, Tangent};
use super::scene::operators::{Factor, Operators};
use super::scene::stages::Placement;
use super::scene::translation_check::joined_by_force;
use super::scene::{ProbeRows, Scene};
use super::scheme::{Midpoint, SchemeCoefficients, TimeScheme};
use super::simulation::Simulation;
use super::state::State;
use super::step::forcing::Forcing;
use super::step::increment::Increment;
use super::step::solver::Solver;
use crate::bem::{ContactElement, Ground};
use crate::contact::{ContactSearch, ModeSearch};
use crate::coupled::run::Serviceability;
use crate::error::{Error, Result, finite, not_negative, positive};
use crate::interface::{ContactScene, InterfaceLaw};
use crate::linalg::matrix::Thinned;
use crate::motion::{AtRest, FreeField};
use crate::structure::probe::Probe;
use crate::structure::{Structure, is_nonlinear};

/// Parts of a [`Simulation`]: a structure, a ground and an interface law are needed, the rest has
/// defaults (no motion, standard gravity, midpoint rule, no probes).
pub struct SimulationBuilder {
    time_step: f64,
    structure: Option<Box<dyn Structure>>,
    ground: Option<Box<dyn Ground>>,
    laws: Vec<Box<dyn InterfaceLaw>>,
    motion: Box<dyn FreeField>,
    scheme: Box<dyn TimeScheme>,
    search: ContactSearch,
    beginning: Beginning,
    probes: Vec<Probe>,
    moment_center: Option<f64>,
    steps: usize,
    coordinates: Coordinates,
    ledger: bool,
    safety_friction: Vec<f64>,
    serviceability: Serviceability,
}

short_debug! {
    SimulationBuilder;
    self;
    time_step: self.time_step,
    structure: self.structure.is_some(),
    ground: self.ground.is_some(),
    laws: self.laws.len(),
    gravity: self.beginning.gravity,
    placement: self.beginning.placement,
    search: self.search,
    coordinates: self.coordinates,
}

impl Simulation {
    /// Begins a simulation with steps of `time_step` seconds.
    pub fn builder(time_step: f64) -> SimulationBuilder {
        SimulationBuilder::new(time_step)
    }
}

impl SimulationBuilder {
    fn new(time_step: f64) -> Self {
        Self {
            time_step,
            structure: None,
            ground: None,
            laws: Vec::new(),
            motion: Box::new(AtRest),
            scheme: Box::new(Midpoint),
            search: ContactSearch::default(),
            beginning: Beginning::default(),
            probes: Vec::new(),
            moment_center: None,
            steps: 0,
            coordinates: Coordinates::default(),
            ledger: true,
            safety_friction: Vec::new(),
            serviceability: Serviceability::new(),
        }
    }

    /// The structure.
    #[must_use]
    pub fn structure(mut self, structure: impl Structure + 'static) -> Self {
        self.structure = Some(Box::new(structure));
        self
    }

    /// The ground. Contact is where its elements are: a part of the base beyond them hangs free, and
    /// elements beyond the base are refused. Neither happens with
    /// [`HalfPlaneGround::under`](crate::bem::HalfPlaneGround::under).
    #[must_use]
    pub fn ground(mut self, ground: impl Ground + 'static) -> Self {
        self.ground = Some(Box::new(ground));
        self
    }

    /// One interface law for all elements.
    #[must_use]
    pub fn interface(mut self, law: impl InterfaceLaw + 'static) -> Self {
        self.laws = vec![Box::new(law)];
        self
    }

    /// An interface law for each element, from left to right.
    #[must_use]
    pub fn interfaces(mut self, laws: Vec<Box<dyn InterfaceLaw>>) -> Self {
        self.laws = laws;
        self
    }

    /// The ground motion.
    #[must_use]
    pub fn motion(mut self, motion: impl FreeField + 'static) -> Self {
        self.motion = Box::new(motion);
        self
    }

    /// The structure's time scheme; [`Midpoint`] unless given.
    #[must_use]
    pub fn scheme(mut self, scheme: impl TimeScheme + 'static) -> Self {
        self.scheme = Box::new(scheme);
        self
    }

    /// Search for the contact modes of a step.
    #[must_use]
    pub fn contact_search(mut self, search: ContactSearch) -> Self {
        self.search = search;
        self
    }

    /// Gravity g (m/s²), which gives the structure its weight;
    /// [`STANDARD_GRAVITY`](crate::motion::STANDARD_GRAVITY) unless given. The run starts from the
    /// static state: weight first, then the loads at t = 0 with the interface law. Zero: there is no
    /// static state, the base starts unpressed, and uplift and sliding have nothing to hold against.
    #[must_use]
    pub fn gravity(mut self, gravity: f64) -> Self {
        self.beginning.gravity = gravity;
        self
    }

    /// An external load, beside those given before and the structure's own.
    #[must_use]
    pub fn load(mut self, load: Load) -> Self {
        self.beginning.loads.push(load);
        self
    }

    /// Displacement of the unknowns at t = 0 against the static state. It may move the base only with
    /// [`Placement::Unloaded`], which shows one, and not into the ground.
    #[must_use]
    pub fn initial_displacement(mut self, displacement: impl Into<Vec<f64>>) -> Self {
        self.beginning.displacement = displacement.into();
        self
    }

    /// Velocity of the unknowns at t = 0.
    #[must_use]
    pub fn initial_velocity(mut self, velocity: impl Into<Vec<f64>>) -> Self {
        self.beginning.velocity = velocity.into();
        self
    }

    /// Friction while the weight comes on.
    #[must_use]
    pub fn placement(mut self, placement: Placement) -> Self {
        self.beginning.placement = placement;
        self
    }

    /// A quantity to read off at every step, see [`super::State::probes`]. Names must differ.
    #[must_use]
    pub fn probe(mut self, probe: Probe) -> Self {
        self.probes.push(probe);
        self
    }

    /// Several of them, after those given before.
    #[must_use]
    pub fn probes(mut self, probes: impl IntoIterator<Item = Probe>) -> Self {
        self.probes.extend(probes);
        self
    }

    /// Point (m) about which the base moment is taken; the middle of the base unless given.
    #[must_use]
    pub fn moment_center(mut self, x: f64) -> Self {
        self.moment_center = Some(x);
        self
    }

    /// About how many steps will be made: kernels and memory are then ready before the first, and
    /// the ground's history and the structure's coordinates are chosen for this number (if not given,
    /// for that of the first run and for 10 000).
    #[must_use]
    pub fn expected_steps(mut self, steps: usize) -> Self {
        self.steps = steps;
        self
    }

    /// In which coordinates a linear structure is stepped; [`Coordinates::Auto`] unless given.
    #[must_use]
    pub fn coordinates(mut self, coordinates: Coordinates) -> Self {
        self.coordinates = coordinates;
        self
    }

    /// Keeps no energy ledger: its terms and its residual are then NaN, and a step takes less time.
    #[must_use]
    pub fn without_ledger(mut self) -> Self {
        self.ledger = false;
        self
    }

    /// Friction coefficient for the factor of safety against sliding, in place of that of the interface
    /// laws ([`InterfaceLaw::friction_coefficient`]): for a bonded base, say, which has none. It
    /// changes nothing else.
    #[must_use]
    pub fn safety_friction(mut self, coefficient: f64) -> Self {
        self.safety_friction = vec![coefficient];
        self
    }

    /// The same for each element, from left to right.
    #[must_use]
    pub fn safety_frictions(mut self, coefficients: Vec<f64>) -> Self {
        self.safety_friction = coefficients;
        self
    }

    /// Limits of slip, gap, uplifted part and rotation that each [`Run`](crate::results::Run) is
    /// held against; none unless given. They change nothing else.
    #[must_use]
    pub fn serviceability(mut self, limits: Serviceability) -> Self {
        self.serviceability = limits;
        self
    }

    /// Checks the parts against each other, finds the static state and factors what stays constant.
    ///
    /// # Errors
    /// [`Error::Scene`] for a missing part, the typed error of whatever is wrong with a given one.
    /// [`Error::Supported`] for a structure that is held by more than the ground,
    /// [`Error::Detached`] for one with a part that is not joined to its base,
    /// [`Error::Indefinite`] for a negative mass or damping, or a stiffness that is negative with the
    /// base held.
    /// [`Error::Probe`] and [`Error::DuplicateName`] for a probe of an unknown that is not there or a
    /// name that comes twice. [`Error::Standing`] if the structure cannot stand under weight and the loads at
    /// t = 0, [`Error::Preload`] if no equilibrium was found for another reason,
    /// [`Error::IllConditioned`] if double precision cannot carry the scene, [`Error::Law`] for an
    /// interface law that returns numbers which are not finite.
    pub fn build(mut self) -> Result<Simulation> {
        let time_step = positive("time step", self.time_step)?;
        positive("square of the time step", time_step * time_step)?;
        not_negative("gravity", self.beginning.gravity)?;
        let gravity = self.beginning.static_gravity();
        let missing = |quantity, needed| Error::Scene { quantity, needed };
        let structure = self.structure.take();
        let mut structure =
            structure.ok_or(missing("structure", "give one to the builder with `structure`"))?;
        let linear = !is_nonlinear(structure.as_mut())?;
        let ground = self.ground.take();
        let mut ground =
            ground.ok_or(missing("ground", "give one to the builder with `ground`"))?;
        let elements = ground.elements().to_vec();
        crate::geometry::check_order(&elements)?;
        let count = elements.len();
        let contact_scene = ContactScene { gravity, time_step };
        laws::check(&self.laws, self.search, &contact_scene, count)?;
        let safety_friction =
            laws::safety_friction(&self.laws, std::mem::take(&mut self.safety_friction), count)?;
        let unknowns = structure.unknowns();
        check_unknowns(unknowns, count)?;
        let mut base = Base::of(structure.as_ref(), &elements)?;
        let mut model = Model::new(structure.as_ref(), linear, &base)?;
        crate::structure::probe::check(&self.probes, unknowns)?;
        self.beginning.check(unknowns)?;
        ground.prepare(time_step)?;
        if self.steps > 0 {
            ground.reserve(self.steps)?;
        }
        let (laws, own, soil) = (&self.laws, structure.as_mut(), ground.as_ref());
        let static_state = self.beginning.static_state(laws, own, soil, &base, &model)?;
        let joined = joined_by_force(&model, structure.as_ref(), &static_state)?;

        let coefficients = self.scheme.coefficients(time_step);
        coefficients.check()?;
        let soil = instantaneous_operator(ground.as_ref(), base.lengths())?;
        let soil = Arc::new(Thinned::new(soil, 2 * count));
        let mut tangent = Tangent::new(unknowns);
        tangent.refill(structure.as_ref(), &static_state.displacement)?;
        let factor = Factor::new(&model, &coefficients, &tangent.matrix);
        let cause = |error| model.cause(structure.as_ref(), &tangent.matrix, error);
        let mut factor = factor.map_err(cause)?;
        let chooser = self.chooser(&coefficients, structure.as_ref(), &model, &base);
        if let Some(modes) = chooser.basis(&factor)? {
            base.decouple(&modes);
            model.decouple(Arc::new(modes));
            factor = Factor::new(&model, &coefficients, &tangent.matrix)?;
        }
        let operators = Operators::new(&model, &base, &soil, factor, tangent.matrix);
        let middle = 0.5 * (elements[0].left + elements[count - 1].right);
        let moment_center = finite("moment center", self.moment_center.unwrap_or(middle))?;
        let mut scene = Scene {
            time_step,
            coefficients,
            conserves_energy: coefficients.conserves_energy(time_step),
            compliant: false,
            laws: self.laws,
            safety_friction,
            serviceability: self.serviceability,
            static_state,
            loads: self.beginning.stepped_loads(&model),
            weight: self.beginning.stepped_weight(&model),
            joined,
            soil,
            start_motion: motion_at_start(ground.as_ref(), self.motion.as_ref(), count)?,
            probe_rows: self.probes.iter().map(|probe| ProbeRows::new(probe, &model)).collect(),
            probes: self.probes,
            arms: elements.iter().map(|e| ContactElement::center(e) - moment_center).collect(),
            elements,
            model,
            base,
        };
        let mut solver = Solver::new(&scene, operators, ModeSearch::new(count, self.search));
        let (operators, contact) = solver.parts_mut();
        let mut state = State::at_rest(&scene)?;
        scene.compliant = scene.is_compliant(&state.start)?;
        self.beginning.set_in_motion(&scene, structure.as_mut(), &mut state)?;
        let (own, books) = (structure.as_ref(), self.ledger);
        let books = books.then(|| Books::new(&scene, own, &state)).transpose()?;
        state.ledger = books.as_ref().map_or(Ledger::LEFT_OUT, |books| books.ledger);
        let conditioning = conditioning::assess(&scene, operators, contact, &state.start)?;
        scene.model.refuse_mechanism()?;
        Ok(Simulation {
            forcing: Forcing::new(&scene),
            increment: Increment::new(&scene, &state, self.ledger),
            books,
            motion: self.motion,
            structure,
            ground,
            scene,
            solver,
            state,
            conditioning,
        })
    }

    fn chooser<'a>(
        &'a self,
        coefficients: &'a SchemeCoefficients,
        structure: &'a dyn Structure,
        model: &'a Model,
        base: &'a Base,
    ) -> Chooser<'a> {
        Chooser {
            coordinates: self.coordinates,
            steps: self.steps,
            time_step: self.time_step,
            coefficients,
            structure,
            model,
            base,
            beginning: &self.beginning,
            probes: &self.probes,
        }
    }
}
