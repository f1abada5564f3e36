//! Parts of a simulation, each checked alone.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::bem::{Ground, GroundDescription, free_field};
use crate::contact::ContactSearch;
use crate::coupled::base::held::held;
use crate::coupled::bed_compliance::{self, STEP_COMPLIANCE};
use crate::coupled::coordinates::Coordinates;
use crate::coupled::gravity_stage::GravityStage;
use crate::coupled::ground_order::is_first_order;
use crate::coupled::model::load::Load;
use crate::coupled::scheme::{Midpoint, SchemeCoefficients, TimeScheme};
use crate::coupled::serviceability::Serviceability;
use crate::error::{
    Error, Progress, Result, all_finite, finite, memory, not_negative, positive, require,
    require_part, same_length, unobserved,
};
use crate::geometry::{Patch, check_count, lattice_cells};
use crate::interface::{
    Bonded, ContactScene, ContactState, InterfaceLaw, LawForm, Mode, PreviousContact, check_list,
};
use crate::linalg::CompressedMatrix;
use crate::linalg::{indefinite_pivot, matrix};
use crate::motion::{AtRest, FreeField, STANDARD_GRAVITY};
use crate::structure::Probe;
use crate::structure::{Structure, check_probes, is_nonlinear};

/// Tolerance below which a negative eigenvalue of the ground's matrix counts as rounding.
///
/// The matrix is scaled to a diagonal of one.
const STEP_COMPLIANCE_ROUNDING: f64 = 1e-9;

/// From this number of steps on, a run counts as a run without a known end.
pub(crate) const ENDLESS_STEPS: usize = match 1_usize.checked_shl(40) {
    Some(steps) => steps,
    None => usize::MAX >> 4,
};

/// Default rotation of a base at which a run ends, rad.
const ROTATION_LIMIT: f64 = 1.0;

/// Parts of a [`Simulation`](crate::Simulation).
///
/// A structure, a ground and an interface law are needed; the rest has defaults (no motion, standard gravity,
/// midpoint rule, no probes).
pub struct SimulationBuilder {
    pub(crate) structure: Option<Box<dyn Structure>>,
    pub(crate) ground: Option<Box<dyn Ground>>,
    pub(crate) time_step: f64,
    pub(crate) laws: Vec<Box<dyn InterfaceLaw>>,
    pub(crate) motion: Box<dyn FreeField>,
    pub(crate) scheme: Box<dyn TimeScheme>,
    pub(crate) search: ContactSearch,
    pub(crate) gravity: f64,
    pub(crate) gravity_stage: GravityStage,
    pub(crate) loads: Vec<Load>,
    /// Displacement and velocity of the degrees of freedom at t = 0; empty for zero.
    pub(crate) displacement: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) probes: Vec<Probe>,
    pub(crate) moment_center: Option<f64>,
    /// Expected number of steps, 0 if unknown.
    pub(crate) steps: usize,
    pub(crate) coordinates: Coordinates,
    pub(crate) energy_balance: bool,
    pub(crate) safety_friction: Vec<f64>,
    pub(crate) serviceability: Serviceability,
    /// Rotation of a base at which a run ends, rad.
    pub(crate) rotation_limit: f64,
    /// Whether the base is held instead of standing on the ground.
    pub(crate) held: bool,
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
            motion: Box::new(AtRest),
            scheme: Box::new(Midpoint),
            search: ContactSearch::default(),
            gravity: STANDARD_GRAVITY,
            gravity_stage: GravityStage::default(),
            loads: Vec::new(),
            displacement: Vec::new(),
            velocity: Vec::new(),
            probes: Vec::new(),
            moment_center: None,
            steps: 0,
            coordinates: Coordinates::default(),
            energy_balance: true,
            safety_friction: Vec::new(),
            serviceability: Serviceability::default(),
            rotation_limit: ROTATION_LIMIT,
            held: false,
            label: String::new(),
            observer: Box::new(unobserved),
        }
    }

    /// Whether weight and loads act before the run begins.
    pub(crate) fn is_static(&self) -> bool {
        self.gravity > 0.0 && self.gravity_stage != GravityStage::Unloaded
    }

    /// Whether weight acts as a load from t = 0 on.
    pub(crate) fn falls(&self) -> bool {
        self.gravity > 0.0 && self.gravity_stage == GravityStage::Unloaded
    }
}

/// All parts of a simulation, and operators that depend only on the ground and the time scheme.
pub(crate) struct Parts {
    pub(crate) structure: Box<dyn Structure>,
    /// The ground, prepared for steps.
    pub(crate) ground: Box<dyn Ground>,
    /// Soil of the ground, as it was before the preparation.
    pub(crate) description: GroundDescription,
    /// The builder; its structure and ground have moved to the fields above.
    pub(crate) given: SimulationBuilder,
    pub(crate) elements: Patch,
    pub(crate) coefficients: SchemeCoefficients,
    /// Step compliance of the ground, 2Q × 2Q, or 3Q × 3Q in plan.
    pub(crate) soil: Arc<CompressedMatrix>,
    /// Whether the ground damps at first order in the time step.
    pub(crate) first_order_ground: bool,
    /// Free field at t = 0, 2Q or 3Q.
    pub(crate) start_motion: Vec<f64>,
    /// Point `[x, y]` of the base moment.
    pub(crate) moment_center: [f64; 2],
}

impl Parts {
    /// Checks each part alone, and prepares the ground for steps.
    pub(crate) fn new(mut given: SimulationBuilder) -> Result<Self> {
        let time_step = positive("time step", given.time_step)?;
        positive("square of the time step", time_step * time_step)?;
        not_negative("gravity", given.gravity)?;
        given.serviceability = given.serviceability.checked()?;
        let limit = given.rotation_limit;
        require("rotation limit", limit, limit > 0.0, "above zero (infinite: none)")?;
        let needed = "give one to the builder with `structure`";
        let missing_structure = Error::Scene { quantity: "structure", needed };
        let mut structure = given.structure.take().ok_or(missing_structure)?;
        is_nonlinear(structure.as_mut())?;
        let needed = "give one to the builder with `ground`";
        let missing_ground = Error::Scene { quantity: "ground", needed };
        let mut ground = given.ground.take().ok_or(missing_ground)?;
        let elements = Patch::of_any_count(ground.elements().to_vec())?;
        let components = elements.layout().components();
        // A bed may be known only once it is prepared.
        if matches!(ground.diagonal_compliance(), Ok(None)) {
            check_count(elements.len(), components)?;
        }
        if given.held {
            given.laws = vec![Box::new(Bonded)];
            (structure, ground) = held(structure, &elements, time_step)?;
        }
        let needed = "one with a static state for a base with walls, on which soil at rest presses";
        let starts = given.held || !(elements.has_walls() && given.falls());
        require_part("gravity stage", starts, needed)?;
        let (layout, count) = (elements.layout(), elements.len());
        // The laws may assume gravity only if there is pressure at the start.
        let gravity = if given.is_static() { given.gravity } else { 0.0 };
        check_laws(&given.laws, given.search, &ContactScene { gravity, time_step }, count)?;
        if LawForm::of(layout) == LawForm::Limits {
            check_limits(&given)?;
        }
        given.safety_friction = safety_friction(&given.laws, given.safety_friction, count)?;
        let dofs = structure.dofs();
        check_dofs(dofs, layout.len())?;
        check_probes(&given.probes, dofs)?;
        check_motion(&given, dofs)?;
        let coefficients = given.scheme.coefficients(time_step);
        coefficients.check()?;
        let [x, y] = elements.center();
        let moment_center = [finite("moment center", given.moment_center.unwrap_or(x))?, y];
        // Before the ground is prepared, which can take long.
        let description = ground.description();
        let motion = given.motion.as_ref();
        let start_motion = start_motion(ground.as_ref(), &description, motion, &elements)?;
        let first_order_ground =
            !given.held && is_first_order(ground.as_mut(), &description, time_step, layout)?;
        let steps = Some(given.steps).filter(|steps| *steps > 0);
        ground.prepare(time_step, steps, &mut given.observer)?;
        let soil = Arc::new(step_compliance(ground.as_ref(), structure.as_ref(), &elements)?);
        Ok(Self {
            structure,
            ground,
            description,
            given,
            elements,
            coefficients,
            soil,
            first_order_ground,
            start_motion,
            moment_center,
        })
    }
}

/// Displacement of the free field at t = 0.
fn start_motion(
    ground: &dyn Ground,
    description: &GroundDescription,
    motion: &dyn FreeField,
    elements: &Patch,
) -> Result<Vec<f64>> {
    let mut displacement = vec![0.0; elements.layout().len()];
    let mut impulse = displacement.clone();
    let known = free_field(ground, motion, elements, 0.0, [&mut displacement, &mut impulse]);
    if elements.has_walls() {
        let soils = motion.soils().zip(description.identity.as_ref());
        let fits = soils.is_none_or(|(of_motion, of_ground)| *of_motion == of_ground[..]);
        let needed = "one that is known at the walls of this ground: a `TrenchMotion` made for it";
        require_part("free field", known && fits, needed)?;
    }
    for displacement in &displacement {
        finite("free field at t = 0", *displacement)?;
    }
    Ok(displacement)
}

/// Error for loads and motions with degrees of freedom that the structure lacks, and for numbers that are not
/// finite.
fn check_motion(given: &SimulationBuilder, dofs: usize) -> Result<()> {
    let mut loads = given.loads.iter().enumerate();
    loads.try_for_each(|(index, load)| load.check(index, dofs))?;
    for (values, quantity) in
        [(&given.displacement, "initial displacement"), (&given.velocity, "initial velocity")]
    {
        if !values.is_empty() {
            same_length(quantity, values.len(), dofs)?;
            all_finite(quantity, values)?;
        }
    }
    Ok(())
}

/// Error for more degrees of freedom than fit into memory.
///
/// Alone, or with a response to each of the `tractions` contact tractions, which takes twice its memory during
/// computation.
fn check_dofs(dofs: usize, tractions: usize) -> Result<()> {
    matrix::check_order("degrees of freedom of the structure", dofs)?;
    let (responses, dofs) = (16.0 * dofs as f64 * tractions as f64, dofs as f64);
    let quantity = "degrees of freedom of the structure on its contact elements";
    Ok(memory::check(quantity, dofs, responses)?)
}

/// Step compliance of a ground: one diagonal for a bed, otherwise all pairs of elements.
fn step_compliance(
    ground: &dyn Ground,
    structure: &dyn Structure,
    elements: &Patch,
) -> Result<CompressedMatrix> {
    if let Some(diagonal) = bed_compliance::of_bed(ground, structure, elements)? {
        return Ok(CompressedMatrix::of_diagonal(diagonal));
    }
    check_count(elements.len(), elements.layout().components())?;
    step_compliance_of_pairs(ground, elements)
}

/// Step compliance of the ground; an error if it could generate energy.
///
/// With rows weighted by the elements' areas, its symmetric part must not be negative.
fn step_compliance_of_pairs(ground: &dyn Ground, elements: &Patch) -> Result<CompressedMatrix> {
    let (layout, areas) = (elements.layout(), elements.areas());
    let size = layout.len();
    let mut operator = vec![0.0; layout.square()];
    ground.step_compliance(&mut operator)?;
    elements.refer_inside(&mut operator);
    all_finite(STEP_COMPLIANCE, &operator)?;
    let area = |i: usize| areas[layout.origin(i)[1]];
    let scale: Vec<f64> = (0..size)
        .map(|i| (area(i) * operator[i * (size + 1)].abs()).sqrt())
        .map(|root| if root > 0.0 { root.recip() } else { 1.0 })
        .collect();
    let weighted = |i: usize, j: usize| {
        let both = area(i) * operator[i * size + j] + area(j) * operator[j * size + i];
        0.5 * scale[i] * scale[j] * both
    };
    let mut symmetric: Vec<f64> = (0..size * size).map(|k| weighted(k / size, k % size)).collect();
    for row in 0..size {
        symmetric[row * (size + 1)] += STEP_COMPLIANCE_ROUNDING;
    }
    match indefinite_pivot(&symmetric, size) {
        None => Ok(match lattice_cells(elements) {
            Some(cells) => CompressedMatrix::on_lattice(operator, &cells, areas),
            None => CompressedMatrix::new(operator, size),
        }),
        Some(row) => {
            let diagonal = operator[row * (size + 1)];
            Err(Error::Indefinite { matrix: STEP_COMPLIANCE, row, diagonal })
        }
    }
}

/// Error unless the laws fit the ground's `count` elements, and laws and contact search the scene.
fn check_laws(
    laws: &[Box<dyn InterfaceLaw>],
    search: ContactSearch,
    scene: &ContactScene,
    count: usize,
) -> Result<()> {
    let needed = "give one to the builder with `interface`";
    require_part("interface law", !laws.is_empty(), needed)?;
    check_list(laws, count)?;
    let iterates = search != ContactSearch::FlowChart { iterations: 0 };
    require_part("contact search", iterates, "the flow chart needs one iteration or more")?;
    laws.iter().try_for_each(|law| law.check(scene))
}

/// Error for laws without limits on a ground in plan, and for the search of the plane.
fn check_limits(given: &SimulationBuilder) -> Result<()> {
    let needed = "must be the robust one on a ground in plan: the flow chart is of the plane";
    require_part("contact search", given.search == ContactSearch::Robust, needed)?;
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, given.time_step);
    given.laws.iter().try_for_each(|law| {
        law.limits(&start.with_state_variables(&start.first_state_variables(law))).map(|_| ())
    })
}

/// Coefficients for the factor of safety against sliding: `given` ones or the laws' own.
///
/// One for all elements, or one each; empty unless all laws have one.
fn safety_friction(
    laws: &[Box<dyn InterfaceLaw>],
    given: Vec<f64>,
    count: usize,
) -> Result<Vec<f64>> {
    let coefficients = if given.is_empty() {
        let each: Option<_> = laws.iter().map(InterfaceLaw::friction_coefficient).collect();
        each.unwrap_or_default()
    } else {
        given
    };
    if coefficients.len() > 1 {
        same_length("list of friction coefficients", coefficients.len(), count)?;
    }
    for &value in &coefficients {
        // Infinity is a valid coefficient.
        require("friction coefficient", value, value >= 0.0, "zero or more")?;
    }
    Ok(coefficients)
}
