//! Putting a simulation together.

use super::base::Base;
use super::coordinates::{Coordinates, Modes};
use super::model::Model;
use super::modes::ContactSearch;
use super::operators::Operators;
use super::preload::{Placement, StaticState};
use super::probe::Probe;
use super::scheme::{Midpoint, TimeScheme};
use super::simulation::Simulation;
use crate::bem::Ground;
use crate::error::{Error, Result, finite, not_negative, positive};
use crate::interface::{ContactScene, InterfaceLaw};
use crate::motion::{AtRest, FreeField, STANDARD_GRAVITY};
use crate::structure::Structure;

/// Steps that modes have to pay for themselves in, if not told otherwise.
const STEPS: usize = 10_000;

/// More unknowns than this are a mistake, or would not fit in memory.
const MOST_UNKNOWNS: usize = 10_000_000;

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
    gravity: f64,
    placement: Placement,
    probes: Vec<Probe>,
    moment_center: Option<f64>,
    steps: usize,
    coordinates: Coordinates,
}

short_debug! {
    SimulationBuilder;
    self;
    time_step: self.time_step,
    structure: self.structure.is_some(),
    ground: self.ground.is_some(),
    laws: self.laws.len(),
    gravity: self.gravity,
    placement: self.placement,
    search: self.search,
    coordinates: self.coordinates,
}

impl SimulationBuilder {
    pub(super) fn new(time_step: f64) -> Self {
        Self {
            time_step,
            structure: None,
            ground: None,
            laws: Vec::new(),
            motion: Box::new(AtRest),
            scheme: Box::new(Midpoint),
            search: ContactSearch::default(),
            gravity: STANDARD_GRAVITY,
            placement: Placement::default(),
            probes: Vec::new(),
            moment_center: None,
            steps: 0,
            coordinates: Coordinates::default(),
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

    /// How the contact modes of a step are searched for.
    #[must_use]
    pub fn contact_search(mut self, search: ContactSearch) -> Self {
        self.search = search;
        self
    }

    /// Gravity g (m/s²), which gives the structure its weight; [`STANDARD_GRAVITY`] unless given. The
    /// run starts from the static state under weight and the load at t = 0. Zero: the base starts
    /// unpressed, and uplift and sliding have nothing to hold against.
    #[must_use]
    pub fn gravity(mut self, gravity: f64) -> Self {
        self.gravity = gravity;
        self
    }

    /// What friction does while the weight comes on.
    #[must_use]
    pub fn placement(mut self, placement: Placement) -> Self {
        self.placement = placement;
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

    /// Checks the parts against each other, finds the static state and factors what stays constant.
    ///
    /// # Errors
    /// [`Error::Scene`] for a missing part, the typed error of whatever is wrong with a given one.
    /// [`Error::Supported`] for a structure that is held by more than the ground,
    /// [`Error::Indefinite`] for a negative mass, or a stiffness that is negative with the base held.
    /// [`Error::Probe`] and [`Error::DuplicateName`] for a probe of an unknown that is not there or a
    /// name that comes twice. [`Error::Preload`] if the structure cannot stand,
    /// [`Error::IllConditioned`] if double precision cannot carry the scene.
    pub fn build(self) -> Result<Simulation> {
        let time_step = positive("time step", self.time_step)?;
        not_negative("gravity", self.gravity)?;
        let missing = |quantity, needed| Error::Scene { quantity, needed };
        let structure = self
            .structure
            .ok_or(missing("structure", "give one to the builder with `structure`"))?;
        let mut ground =
            self.ground.ok_or(missing("ground", "give one to the builder with `ground`"))?;
        let elements = ground.elements().to_vec();
        crate::contact_element::check_order(&elements)?;
        let count = elements.len();
        let scene = ContactScene { gravity: self.gravity, time_step };
        check_contact(&self.laws, self.search, &scene, count)?;
        let unknowns = structure.unknowns();
        if unknowns > MOST_UNKNOWNS {
            return Err(Error::Input {
                quantity: "number of unknowns of the structure",
                value: unknowns as f64,
                needed: "ten million or fewer",
            });
        }
        let mut base = Base::of(structure.as_ref(), &elements)?;
        let mut model = Model::new(structure, &base)?;
        super::probe::check(&self.probes, unknowns)?;
        ground.prepare(time_step)?;
        if self.steps > 0 {
            ground.reserve(self.steps)?;
        }

        let mut static_load = vec![0.0; unknowns];
        let static_state = if self.gravity > 0.0 {
            model.structure.load(0.0, &mut static_load);
            let mut load = static_load.clone();
            model.mass.multiply_add(-self.gravity, &model.ride[1], &mut load);
            if let Some(bad) = load.iter().find(|f| !f.is_finite()) {
                finite("load at t = 0", *bad)?;
            }
            let (ground, laws) = (ground.as_ref(), &self.laws);
            super::preload::solve(&mut model, ground, &base, laws, self.placement, &load)?
        } else {
            StaticState::weightless(count, unknowns)
        };

        let coefficients = self.scheme.coefficients(time_step);
        let mut soil = vec![0.0; 4 * count * count];
        ground.instantaneous(&mut soil)?;
        if let Some(bad) = soil.iter().find(|g| !g.is_finite()) {
            finite("instantaneous operator of the ground", *bad)?;
        }
        let tangent = model.tangent(&static_state.displacement)?;
        let mut operators = Operators::new(&model, &base, &soil, &coefficients, tangent)?;
        let modes = choose_modes(self.coordinates, self.steps, &model, &operators, 2 * count)?;
        if let Some(modes) = modes {
            base.decouple(&modes);
            model.decouple(std::sync::Arc::new(modes));
            let tangent = std::mem::take(&mut operators.tangent);
            operators = Operators::new(&model, &base, &soil, &coefficients, tangent)?;
        }
        let middle = 0.5 * (elements[0].left + elements[count - 1].right);
        let moment_center = finite("moment center", self.moment_center.unwrap_or(middle))?;
        let arms = elements.iter().map(|e| e.center() - moment_center).collect();
        let start_motion = motion_at_start(ground.as_ref(), self.motion.as_ref(), count)?;
        let mut simulation = Simulation::assemble(super::simulation::Parts {
            time_step,
            model,
            ground,
            base,
            laws: self.laws,
            search: self.search,
            motion: self.motion,
            coefficients,
            static_state,
            static_load,
            soil,
            operators,
            probes: self.probes,
            arms,
            start_motion,
        });
        simulation.assess()?;
        Ok(simulation)
    }
}

/// Whether the laws fit the ground's `count` elements, and laws and contact search the scene.
fn check_contact(
    laws: &[Box<dyn InterfaceLaw>],
    search: ContactSearch,
    scene: &ContactScene,
    count: usize,
) -> Result<()> {
    let refuse = |quantity, needed| Err(Error::Scene { quantity, needed });
    if laws.is_empty() {
        return refuse("interface law", "give one to the builder with `interface`");
    }
    if laws.len() != 1 && laws.len() != count {
        let quantity = "list of interface laws";
        return Err(Error::Size { quantity, found: laws.len(), needed: count });
    }
    if laws.iter().any(|law| law.modes().is_empty()) {
        return refuse("interface law", "`modes` must name at least one mode");
    }
    if search == (ContactSearch::FlowChart { iterations: 0 }) {
        return refuse("contact search", "the flow chart needs one iteration or more");
    }
    laws.iter().try_for_each(|law| law.check(scene))
}

/// The modes, if the structure is to be stepped in them.
fn choose_modes(
    coordinates: Coordinates,
    steps: usize,
    model: &Model,
    operators: &Operators,
    contact: usize,
) -> Result<Option<Modes>> {
    let steps = if steps > 0 { steps } else { STEPS };
    match coordinates {
        Coordinates::Auto if model.modes_save_time(operators.stored(), contact, steps) => {
            Ok(Modes::of(model))
        }
        Coordinates::Auto | Coordinates::Unknowns => Ok(None),
        Coordinates::Modes => Modes::of(model).map(Some).ok_or(Error::Scene {
            quantity: "modal coordinates",
            needed: "a linear structure with symmetric matrices, a positive definite mass \
                     and a damping that the modes decouple",
        }),
    }
}

/// The free field at t = 0, from which it is measured.
fn motion_at_start(ground: &dyn Ground, motion: &dyn FreeField, count: usize) -> Result<Vec<f64>> {
    let mut start = vec![0.0; 2 * count];
    ground.free_field(motion, 0.0, &mut start);
    match start.iter().find(|u| !u.is_finite()) {
        Some(bad) => finite("free field at t = 0", *bad).map(|_| start),
        None => Ok(start),
    }
}
