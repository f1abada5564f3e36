//! Parts of a simulation, each checked separately.

use std::sync::Arc;

use crate::bem::{Ground, GroundDescription, fill_free_field};
use crate::contact::ContactSearch;
use crate::coupled::base::PlacedBase;
use crate::coupled::base::fixed_base::on_fixed_base;
use crate::coupled::base::joint_line::JointLine;
use crate::coupled::builder::SimulationBuilder;
use crate::coupled::ground_order::is_first_order;
use crate::coupled::joint::Joint;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::step_compliance::step_compliance;
use crate::error::{
    Error, Result, all_finite, finite, memory, not_negative, positive, require, require_part,
    same_length,
};
use crate::geometry::{Patch, check_count};
use crate::interface::{
    Bonded, ContactScene, ContactState, InterfaceLaw, LawForm, Mode, PreviousContact, SharedLaw,
    check_list,
};
use crate::linalg::CompressedMatrix;
use crate::linalg::matrix;
use crate::motion::FreeField;
use crate::soil::WaterTable;
use crate::structure::{Structure, check_nonlinear_force, check_probes};

/// All parts of a simulation, and the operators of ground and time scheme.
pub(crate) struct Parts {
    pub(crate) structure: Box<dyn Structure>,
    /// The ground, prepared for time stepping.
    pub(crate) ground: Box<dyn Ground>,
    /// Description of the ground, from before its preparation.
    ///
    /// Around soil at rest it has no pressures at rest.
    pub(crate) description: GroundDescription,
    /// Mass of soil at rest on each degree of freedom, kg.
    ///
    /// `None` without such soil.
    ///
    /// The weight of this soil does not act on the structure.
    pub(crate) mass_at_rest: Option<Vec<f64>>,
    /// The builder; its structure and ground have moved to the fields above.
    pub(crate) builder: SimulationBuilder,
    pub(crate) elements: Patch,
    /// Lines of the joints; their laws follow those of the ground's elements.
    pub(crate) joints: Vec<JointLine>,
    /// Laws of the elements of floor and joints; empty without joints.
    pub(crate) bearing_laws: Vec<Box<dyn InterfaceLaw>>,
    pub(crate) coefficients: SchemeCoefficients,
    /// Step compliance of the ground, 2Q × 2Q, or 3Q × 3Q in plan.
    pub(crate) step_compliance: Arc<CompressedMatrix>,
    /// Whether an elastic part of the ground is of first order in the time step.
    pub(crate) is_first_order_ground: bool,
    /// Free-field displacement at t = 0 (m); 2Q entries, 3Q in plan, for Q elements.
    pub(crate) initial_free_field: Vec<f64>,
    /// Water table of builder or ground.
    pub(crate) water_table: Option<WaterTable>,
    /// Force of the water on each degree of freedom, N; empty without water above the base.
    pub(crate) water_force: Vec<f64>,
    /// Upward force of the water on the structure, N.
    pub(crate) buoyancy: f64,
    /// Weight of a structure in water, N; zero without water above the base.
    pub(crate) weight_in_water: f64,
    /// Point `[x, y]` to which the base moment refers, m.
    pub(crate) moment_center: [f64; 2],
}

impl Parts {
    /// Checks each part separately, and prepares the ground for time stepping.
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
        check_nonlinear_force(structure.as_mut())?;
        let needed = "give one to the builder with `ground`";
        let missing_ground = Error::Scene { quantity: "ground", needed };
        let mut ground = builder.ground.take().ok_or(missing_ground)?;
        let elements = Patch::of_any_count(ground.elements().to_vec())?;
        let components = elements.layout().components();
        // A dense step compliance limits the number of elements. A ground that returns an error here is checked after
        // its preparation.
        if matches!(ground.diagonal_compliance(), Ok(None)) {
            check_count(elements.len(), components)?;
        }
        if builder.has_fixed_base {
            builder.laws = vec![Box::new(Bonded)];
            (structure, ground) =
                on_fixed_base(structure, &elements, &lines(&builder.joints), time_step)?;
        }
        let needed =
            "one with a static state for a base with walls, on which the soil at rest presses";
        let is_valid_stage =
            builder.has_fixed_base || !(elements.has_walls() && builder.starts_unloaded());
        require_part("gravity stage", is_valid_stage, needed)?;
        let layout = elements.layout();
        let element_count = elements.len();
        // The laws may rely on gravity only if there is pressure at the start.
        let initial_gravity = if builder.has_static_loads() { builder.gravity } else { 0.0 };
        let contact_scene = ContactScene { gravity: initial_gravity, time_step };
        check_laws(&builder.laws, builder.search, &contact_scene, element_count)?;
        if LawForm::of(layout) == LawForm::Limits {
            check_limits(&builder)?;
        }
        builder.safety_friction_coefficients = safety_friction_coefficients(
            &builder.laws,
            builder.safety_friction_coefficients,
            element_count,
        )?;
        // Before the laws of joints: between bodies any law may act.
        let mass_at_rest = structure.mass_at_rest()?;
        if let Some(masses) = &mass_at_rest {
            same_length("mass at rest", masses.len(), structure.dofs())?;
            all_finite("mass at rest", masses)?;
            check_soil_at_rest(&builder)?;
        }
        let joints = lines(&builder.joints);
        let bearing_laws = add_joint_laws(&mut builder, &elements, &contact_scene)?;
        let joint_element_count: usize = joints.iter().map(|joint| joint.elements().len()).sum();
        let dofs = structure.dofs();
        check_response_memory(dofs, layout.len() + layout.components() * joint_element_count)?;
        check_probes(&builder.probes, dofs)?;
        check_loads_and_initial_motion(&builder, dofs)?;
        let coefficients = builder.scheme.coefficients(time_step);
        coefficients.check()?;
        let center = elements.center();
        let moment_x = finite("moment center", builder.moment_center.unwrap_or(center[0]))?;
        let moment_center = [moment_x, center[1]];
        // These checks precede the preparation of the ground, which can take long.
        let mut description = ground.description();
        let has_soil_at_rest = mass_at_rest.is_some();
        let water_table =
            water_table(&builder, &description, elements.has_walls(), has_soil_at_rest)?;
        if has_soil_at_rest {
            // Tractions on soil at rest are changes from the pressures at rest.
            description.pressure_at_rest.clear();
            description.depth_of_pressure_at_rest.clear();
            description.mass_above.clear();
        }
        let motion = builder.motion.as_ref();
        let initial_free_field =
            free_field_at_start(ground.as_ref(), &description, motion, &elements)?;
        let is_first_order_ground = !builder.has_fixed_base
            && is_first_order(ground.as_mut(), &description, time_step, layout)?;
        let expected_steps = Some(builder.expected_steps).filter(|steps| *steps > 0);
        ground.prepare(time_step, expected_steps, &mut builder.observer)?;
        let step_compliance =
            Arc::new(step_compliance(ground.as_ref(), structure.as_ref(), &elements)?);
        Ok(Self {
            structure,
            ground,
            description,
            mass_at_rest,
            builder,
            elements,
            joints,
            bearing_laws,
            coefficients,
            step_compliance,
            is_first_order_ground,
            initial_free_field,
            water_table,
            water_force: Vec::new(),
            buoyancy: 0.0,
            weight_in_water: 0.0,
            moment_center,
        })
    }

    /// Adds rows of zeros for the elements of joints to the step compliance.
    pub(crate) fn spread_over_joints(&mut self, base: &PlacedBase) {
        if !self.joints.is_empty() {
            let ground = self.step_compliance.filled(self.elements.layout().len());
            let order = base.layout().len();
            let matrix = CompressedMatrix::new(base.spread_ground_matrix(ground), order);
            self.step_compliance = Arc::new(matrix);
        }
    }
}

/// Water table of the builder, or of a ground with walls.
///
/// On a fixed base the `description` is that of the support, which has none.
fn water_table(
    builder: &SimulationBuilder,
    description: &GroundDescription,
    has_walls: bool,
    has_soil_at_rest: bool,
) -> Result<Option<WaterTable>> {
    let needed = "that of the ground (`TrenchGround::with_water_table`): it also acts on the soil beside the walls";
    require_part("water table", builder.water_table.is_none() || !has_walls, needed)?;
    let water_table = builder.water_table.or(description.water_table);
    let needed = "none with soil at rest, whose stresses are those of the grains";
    require_part("water table", !has_soil_at_rest || water_table.is_none(), needed)?;
    Ok(water_table)
}

/// Lines of joints.
fn lines(joints: &[Joint]) -> Vec<JointLine> {
    joints.iter().map(|joint| joint.line().clone()).collect()
}

/// Appends the laws of the joints to those of the ground's elements; only in the plane.
///
/// The ground's elements then have one law each. Returns the laws of the elements of floor and joints.
fn add_joint_laws(
    builder: &mut SimulationBuilder,
    elements: &Patch,
    scene: &ContactScene,
) -> Result<Vec<Box<dyn InterfaceLaw>>> {
    if builder.joints.is_empty() {
        return Ok(Vec::new());
    }
    let needed = "only on a ground in the plane: a base in plan has no joints";
    require_part("joint", !elements.is_plan(), needed)?;
    let mut laws = SharedLaw::for_each(std::mem::take(&mut builder.laws), elements.len());
    for joint in std::mem::take(&mut builder.joints) {
        laws.extend(joint.element_laws(scene)?);
    }
    builder.laws = SharedLaw::boxed(&laws);
    laws.drain(elements.floor().end..elements.len());
    laws.drain(..elements.floor().start);
    Ok(SharedLaw::boxed(&laws))
}

/// Checks that gravity stage and laws suit soil at rest.
fn check_soil_at_rest(builder: &SimulationBuilder) -> Result<()> {
    require_part(
        "gravity stage of soil at rest",
        !builder.starts_unloaded(),
        "one with a static state, from which the soil starts",
    )?;
    require_part(
        "interface law of soil at rest",
        builder.laws.iter().all(|law| law.modes() == [Mode::Stick]),
        "one that sticks always, such as `Bonded`: tractions are changes from the state at rest",
    )
}

/// Free-field displacement at t = 0.
fn free_field_at_start(
    ground: &dyn Ground,
    description: &GroundDescription,
    motion: &dyn FreeField,
    elements: &Patch,
) -> Result<Vec<f64>> {
    let has_same_elements = motion.elements().is_none_or(|places| places == &elements[..]);
    let needed = "one that is defined at the elements of this ground: made for `Ground::elements`";
    require_part("free field", has_same_elements, needed)?;
    let mut displacement = vec![0.0; elements.layout().len()];
    let mut impulse = displacement.clone();
    let is_defined =
        fill_free_field(ground, motion, elements, 0.0, &mut displacement, &mut impulse);
    if elements.has_walls() {
        let soil_identities = motion.soils().zip(description.identity.as_ref());
        let has_same_soil = soil_identities
            .is_none_or(|(motion_soil, ground_soil)| *motion_soil == ground_soil[..]);
        let needed =
            "one that is defined at the walls of this ground: a `TrenchMotion` made for it";
        require_part("free field", is_defined && has_same_soil, needed)?;
    }
    for value in &displacement {
        finite("free field at t = 0", *value)?;
    }
    Ok(displacement)
}

/// Checks that loads and initial motion fit the structure and are finite.
fn check_loads_and_initial_motion(builder: &SimulationBuilder, dofs: usize) -> Result<()> {
    for (index, load) in builder.loads.iter().enumerate() {
        load.check(index, dofs)?;
    }
    for (values, quantity) in [
        (&builder.initial_displacement, "initial displacement"),
        (&builder.initial_velocity, "initial velocity"),
    ] {
        if !values.is_empty() {
            same_length(quantity, values.len(), dofs)?;
            all_finite(quantity, values)?;
        }
    }
    Ok(())
}

/// Bytes per response entry: two `f64`, the response and its working copy.
const BYTES_PER_RESPONSE_ENTRY: f64 = 16.0;

/// Checks that the responses to unit tractions fit into memory.
///
/// All degrees of freedom respond to each of `traction_count` unit tractions. The responses need twice as much memory
/// during their computation as afterwards.
fn check_response_memory(dofs: usize, traction_count: usize) -> Result<()> {
    matrix::check_order("degrees of freedom of the structure", dofs)?;
    let bytes = BYTES_PER_RESPONSE_ENTRY * dofs as f64 * traction_count as f64;
    let quantity = "degrees of freedom of the structure on its contact elements";
    Ok(memory::check(quantity, dofs as f64, bytes)?)
}

/// Checks the interface laws and the contact search.
fn check_laws(
    laws: &[Box<dyn InterfaceLaw>],
    search: ContactSearch,
    scene: &ContactScene,
    element_count: usize,
) -> Result<()> {
    let needed = "give one to the builder with `interface`";
    require_part("interface law", !laws.is_empty(), needed)?;
    check_list(laws, element_count)?;
    let is_valid_search = search != ContactSearch::FlowChart { iterations: 0 };
    require_part("contact search", is_valid_search, "the flow chart needs one iteration or more")?;
    laws.iter().try_for_each(|law| law.check(scene))
}

/// Checks that laws and contact search suit a ground in plan, where laws consist of limits.
fn check_limits(builder: &SimulationBuilder) -> Result<()> {
    let needed =
        "must be the robust one on a ground in plan: the flow chart exists only in the plane";
    require_part("contact search", builder.search == ContactSearch::Robust, needed)?;
    let initial_contact =
        PreviousContact::new(ContactState::default(), Mode::Stick, builder.time_step);
    builder.laws.iter().try_for_each(|law| {
        let state_variables = initial_contact.first_state_variables(law);
        law.limits(&initial_contact.with_state_variables(&state_variables)).map(|_| ())
    })
}

/// Friction coefficients for the factor of safety against sliding.
///
/// The builder's coefficients replace the coefficients of the laws. The list has one coefficient for all elements, or one for
/// each. It is empty if the builder has none and a law has none.
fn safety_friction_coefficients(
    laws: &[Box<dyn InterfaceLaw>],
    builder_coefficients: Vec<f64>,
    element_count: usize,
) -> Result<Vec<f64>> {
    let coefficients = if builder_coefficients.is_empty() {
        let law_coefficients: Option<_> =
            laws.iter().map(InterfaceLaw::friction_coefficient).collect();
        law_coefficients.unwrap_or_default()
    } else {
        builder_coefficients
    };
    if coefficients.len() > 1 {
        same_length("list of friction coefficients", coefficients.len(), element_count)?;
    }
    for &value in &coefficients {
        // Infinity is a valid coefficient.
        require("friction coefficient", value, value >= 0.0, "zero or more")?;
    }
    Ok(coefficients)
}
