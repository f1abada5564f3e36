//! Parts of a simulation, each checked alone.

use std::sync::Arc;

use crate::bem::{Ground, GroundDescription, free_field};
use crate::contact::ContactSearch;
use crate::coupled::base::fixed_base::on_fixed_base;
use crate::coupled::bed_compliance::{self, STEP_COMPLIANCE};
use crate::coupled::builder::SimulationBuilder;
use crate::coupled::ground_order::is_first_order;
use crate::coupled::scheme::SchemeCoefficients;
use crate::error::{
    Error, Result, all_finite, finite, memory, not_negative, positive, require, require_part,
    same_length,
};
use crate::geometry::{Patch, check_count, lattice_cells};
use crate::interface::{
    Bonded, ContactScene, ContactState, InterfaceLaw, LawForm, Mode, PreviousContact, check_list,
};
use crate::linalg::CompressedMatrix;
use crate::linalg::{indefinite_pivot, matrix};
use crate::motion::FreeField;
use crate::structure::{Structure, check_probes, is_nonlinear};

/// Tolerance below which a negative eigenvalue of the ground's matrix counts as rounding.
///
/// The matrix is scaled to a diagonal of one.
const NEGATIVE_EIGENVALUE_TOLERANCE: f64 = 1e-9;

/// All parts of a simulation, and operators that depend only on the ground and the time scheme.
pub(crate) struct Parts {
    pub(crate) structure: Box<dyn Structure>,
    /// The ground, prepared for steps.
    pub(crate) ground: Box<dyn Ground>,
    /// Soil of the ground, as it was before the preparation.
    pub(crate) description: GroundDescription,
    /// The builder; its structure and ground have moved to the fields above.
    pub(crate) builder: SimulationBuilder,
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
    pub(crate) fn new(mut builder: SimulationBuilder) -> Result<Self> {
        let time_step = positive("time step", builder.time_step)?;
        positive("square of the time step", time_step * time_step)?;
        not_negative("gravity", builder.gravity)?;
        builder.serviceability = builder.serviceability.checked()?;
        let limit = builder.rotation_limit;
        require("rotation limit", limit, limit > 0.0, "above zero (infinite: none)")?;
        let needed = "give one to the builder with `structure`";
        let missing_structure = Error::Scene { quantity: "structure", needed };
        let mut structure = builder.structure.take().ok_or(missing_structure)?;
        is_nonlinear(structure.as_mut())?;
        let needed = "give one to the builder with `ground`";
        let missing_ground = Error::Scene { quantity: "ground", needed };
        let mut ground = builder.ground.take().ok_or(missing_ground)?;
        let elements = Patch::of_any_count(ground.elements().to_vec())?;
        let components = elements.layout().components();
        // A bed may be known only once it is prepared.
        if matches!(ground.diagonal_compliance(), Ok(None)) {
            check_count(elements.len(), components)?;
        }
        if builder.on_fixed_base {
            builder.laws = vec![Box::new(Bonded)];
            (structure, ground) = on_fixed_base(structure, &elements, time_step)?;
        }
        let needed = "one with a static state for a base with walls, on which soil at rest presses";
        let starts = builder.on_fixed_base || !(elements.has_walls() && builder.falls());
        require_part("gravity stage", starts, needed)?;
        let layout = elements.layout();
        let count = elements.len();
        // The laws may assume gravity only if there is pressure at the start.
        let gravity = if builder.is_static() { builder.gravity } else { 0.0 };
        check_laws(&builder.laws, builder.search, &ContactScene { gravity, time_step }, count)?;
        if LawForm::of(layout) == LawForm::Limits {
            check_limits(&builder)?;
        }
        builder.safety_friction = safety_friction(&builder.laws, builder.safety_friction, count)?;
        let dofs = structure.dofs();
        check_dofs(dofs, layout.len())?;
        check_probes(&builder.probes, dofs)?;
        check_motion(&builder, dofs)?;
        let coefficients = builder.scheme.coefficients(time_step);
        coefficients.check()?;
        let center = elements.center();
        let moment_x = finite("moment center", builder.moment_center.unwrap_or(center[0]))?;
        let moment_center = [moment_x, center[1]];
        // Before the ground is prepared, which can take long.
        let description = ground.description();
        let motion = builder.motion.as_ref();
        let start_motion = start_motion(ground.as_ref(), &description, motion, &elements)?;
        let first_order_ground = !builder.on_fixed_base
            && is_first_order(ground.as_mut(), &description, time_step, layout)?;
        let steps = Some(builder.steps).filter(|steps| *steps > 0);
        ground.prepare(time_step, steps, &mut builder.observer)?;
        let soil = Arc::new(step_compliance(ground.as_ref(), structure.as_ref(), &elements)?);
        Ok(Self {
            structure,
            ground,
            description,
            builder,
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
fn check_motion(builder: &SimulationBuilder, dofs: usize) -> Result<()> {
    let mut loads = builder.loads.iter().enumerate();
    loads.try_for_each(|(index, load)| load.check(index, dofs))?;
    for (values, quantity) in
        [(&builder.displacement, "initial displacement"), (&builder.velocity, "initial velocity")]
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
    let bytes = 16.0 * dofs as f64 * tractions as f64;
    let quantity = "degrees of freedom of the structure on its contact elements";
    Ok(memory::check(quantity, dofs as f64, bytes)?)
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
    checked_step_compliance(ground, elements)
}

/// Step compliance of the ground; an error if it could generate energy.
///
/// With rows weighted by the elements' areas, its symmetric part must not be negative.
fn checked_step_compliance(ground: &dyn Ground, elements: &Patch) -> Result<CompressedMatrix> {
    let layout = elements.layout();
    let areas = elements.areas();
    let size = layout.len();
    let mut operator = vec![0.0; layout.square()];
    ground.step_compliance(&mut operator)?;
    elements.refer_inside(&mut operator);
    all_finite(STEP_COMPLIANCE, &operator)?;
    let row_areas: Vec<f64> = (0..size).map(|row| areas[layout.origin(row)[1]]).collect();
    let mut scale = vec![1.0; size];
    for row in 0..size {
        let root = (row_areas[row] * operator[row * (size + 1)].abs()).sqrt();
        if root > 0.0 {
            scale[row] = root.recip();
        }
    }
    let mut symmetric = vec![0.0; size * size];
    for i in 0..size {
        for j in 0..size {
            let both =
                row_areas[i] * operator[i * size + j] + row_areas[j] * operator[j * size + i];
            symmetric[i * size + j] = 0.5 * scale[i] * scale[j] * both;
        }
        symmetric[i * (size + 1)] += NEGATIVE_EIGENVALUE_TOLERANCE;
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
fn check_limits(builder: &SimulationBuilder) -> Result<()> {
    let needed = "must be the robust one on a ground in plan: the flow chart is of the plane";
    require_part("contact search", builder.search == ContactSearch::Robust, needed)?;
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, builder.time_step);
    builder.laws.iter().try_for_each(|law| {
        law.limits(&start.with_state_variables(&start.first_state_variables(law)))
            .map(|_| ())
    })
}

/// Coefficients for the factor of safety against sliding, of the builder or of the laws.
///
/// One for all elements, or one each; empty unless all laws have one.
fn safety_friction(
    laws: &[Box<dyn InterfaceLaw>],
    of_builder: Vec<f64>,
    count: usize,
) -> Result<Vec<f64>> {
    let coefficients = if of_builder.is_empty() {
        let each: Option<_> = laws.iter().map(InterfaceLaw::friction_coefficient).collect();
        each.unwrap_or_default()
    } else {
        of_builder
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
