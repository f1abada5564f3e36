//! Structures of scenes in any view.

use basemat::Result;
use basemat::structure::{
    Base, BaseNode, Bilinear, CraigBampton, DofCombination, MatrixModel, ModalDamping, PlanStorey,
    RigidBlock, RigidBody, ShearBuilding, Storey, StoreyBuilding, Structure, StructureGroup,
    Triplets, WithSprings, WithWalls,
};
use basemat_problems::scenes::SCENE_GRAVITY;

use super::blueprint::Blueprint;
use super::gmsh;
use super::models;
use super::numbers::Numbers;
use super::parts::{BodyPart, Choice, Space};
use super::view::View;

/// A structure, and displacements of its top along the axes of the view.
pub(crate) struct ProbedStructure {
    pub(crate) structure: Box<dyn Structure>,
    pub(crate) top: [DofCombination; 3],
}

impl ProbedStructure {
    pub(crate) fn new(structure: impl Structure + 'static, top: [DofCombination; 3]) -> Self {
        Self { structure: Box::new(structure), top }
    }
}

/// Moment of inertia of a cuboid about the axis across two of its sides.
pub(crate) fn cuboid_inertia(mass: f64, one: f64, other: f64) -> f64 {
    mass * (one * one + other * other) / 12.0
}

/// The structure of a choice in the plane or in plan; with walls for a trench.
pub(crate) fn structure(
    choice: &Choice,
    numbers: &Numbers,
    view: &View,
) -> Result<ProbedStructure> {
    let ProbedStructure { structure, top } = match choice.space {
        Space::Plan => in_plan(choice.body, numbers, view)?,
        Space::Plane | Space::Trench => in_the_plane(choice.body, numbers, view)?,
    };
    if choice.space != Space::Trench {
        return Ok(ProbedStructure { structure, top });
    }
    let depth = trench_depth(numbers) * view.frame.length;
    Ok(ProbedStructure { structure: Box::new(WithWalls::new(structure, depth)?), top })
}

/// Depth of a trench, m.
pub(crate) fn trench_depth(numbers: &Numbers) -> f64 {
    0.5 * numbers.depth * numbers.sides[0]
}

/// Storeys in the plane, in the view's units.
fn building(numbers: &Numbers, view: &View) -> Result<ShearBuilding> {
    let frame = &view.frame;
    let unit = frame.mass / frame.length;
    let length = frame.length;
    let mass = 0.25 * numbers.mass(false) * unit;
    let rate = std::f64::consts::TAU * numbers.frequency / frame.time;
    let storey = Storey::new(numbers.height / 3.0 * length, mass, 5.0 * mass * rate * rate);
    let width = numbers.sides[0] * length;
    let storeys = [storey, storey, Storey { mass: 0.7 * mass, ..storey }];
    let center = view.surface_point([0.0; 2])[0];
    let building = ShearBuilding::new(width, 1.3 * mass, mass * width * width / 12.0, &storeys)?;
    building.centered_at(center)
}

fn block(numbers: &Numbers, view: &View) -> Result<RigidBlock> {
    let length = view.frame.length;
    let center = view.surface_point([0.0; 2])[0];
    let width = numbers.sides[0] * length;
    let height = numbers.height * length;
    RigidBlock::new(width, height, numbers.density * view.frame.density())?.centered_at(center)
}

/// Displacements of a point of degrees of freedom along x and up.
fn top(along: impl Into<DofCombination>, up: impl Into<DofCombination>) -> [DofCombination; 3] {
    [along.into(), DofCombination::default(), up.into()]
}

/// Horizontal degree of freedom of the highest storey of `building`.
const ROOF_DOF: usize = 5;

fn in_the_plane(body: BodyPart, numbers: &Numbers, view: &View) -> Result<ProbedStructure> {
    let frame = &view.frame;
    let gravity = SCENE_GRAVITY * frame.acceleration();
    Ok(match body {
        BodyPart::Block => {
            let block = block(numbers, view)?;
            let along = block.horizontal_at(numbers.height * frame.length);
            ProbedStructure::new(block, top(along, 1))
        }
        BodyPart::Storeys => ProbedStructure::new(
            building(numbers, view)?.with_stiffness_damping(0.03)?,
            top(ROOF_DOF, 1),
        ),
        BodyPart::Slender => {
            let building = building(numbers, view)?.with_stiffness_damping(0.03)?;
            ProbedStructure::new(building.with_p_delta(gravity)?, top(ROOF_DOF, 1))
        }
        BodyPart::Hysteretic => {
            let building = building(numbers, view)?.with_stiffness_damping(0.02)?;
            ProbedStructure::new(
                building.with_law(0, yielding_spring(numbers, view)?)?,
                top(ROOF_DOF, 1),
            )
        }
        BodyPart::Damped => {
            let damping = ModalDamping::new(&[0.05, 0.03])?;
            ProbedStructure::new(damping.on_fixed_base(building(numbers, view)?)?, top(ROOF_DOF, 1))
        }
        BodyPart::Sprung => {
            let building = building(numbers, view)?;
            let drift = building.drift(1)?;
            let building_with_springs =
                WithSprings::new(building).spring(drift, yielding_spring(numbers, view)?)?;
            ProbedStructure::new(building_with_springs, top(ROOF_DOF, 1))
        }
        BodyPart::Pair | BodyPart::ClayPair => pair(body == BodyPart::ClayPair, numbers, view)?,
        BodyPart::Matrices => matrices(numbers, view)?,
        BodyPart::Frame => of_blueprint(&models::frame(numbers), view)?,
        BodyPart::Quads | BodyPart::Quads8 => {
            of_blueprint(&models::quads(numbers, body == BodyPart::Quads8), view)?
        }
        BodyPart::Clay => of_blueprint(&models::clay(numbers), view)?,
        BodyPart::Sand => of_blueprint(&models::sand(numbers), view)?,
        BodyPart::Reduced => reduced(&models::quads(numbers, false), view)?,
        _ => unreachable!("{} is no structure in the plane", body.word()),
    })
}

/// A block and storeys side by side, in the order from the left.
fn pair(has_clay_block: bool, numbers: &Numbers, view: &View) -> Result<ProbedStructure> {
    let half_size = Numbers { sides: numbers.sides.map(|side| 0.5 * side), ..*numbers };
    let view_without_shift = View { shift: [0.0; 2], ..*view };
    let distance = 0.5 * numbers.sides[0];
    let block_center = view.surface_point([-distance, 0.0])[0];
    let building_center = view.surface_point([distance, 0.0])[0];
    let block: Box<dyn Structure> = if has_clay_block {
        of_blueprint(&models::clay(&half_size), &view_without_shift)?.structure
    } else {
        Box::new(block(&half_size, &view_without_shift)?)
    };
    let building = building(&half_size, &view_without_shift)?;
    let is_mirrored = view.frame.mirrored;
    let group = if is_mirrored {
        StructureGroup::new().with(building, building_center)?.with(block, block_center)?
    } else {
        StructureGroup::new().with(block, block_center)?.with(building, building_center)?
    };
    let building_index = usize::from(!is_mirrored);
    let along = group.row(building_index, ROOF_DOF)?;
    let up = group.row(building_index, 1)?;
    Ok(ProbedStructure::new(group, top(along, up)))
}

fn yielding_spring(numbers: &Numbers, view: &View) -> Result<Bilinear> {
    let frame = &view.frame;
    let mass = 0.25 * numbers.mass(false);
    let rate = std::f64::consts::TAU * numbers.frequency;
    let force = 0.3 * numbers.peaks[0] * mass;
    let stiffness = 5.0 * mass * rate * rate * frame.pressure();
    Bilinear::new(stiffness, force * frame.pressure() * frame.length, 0.1)
}

/// A rigid base that carries a mass on a column, beside the middle.
fn matrices(numbers: &Numbers, view: &View) -> Result<ProbedStructure> {
    let frame = &view.frame;
    let length = frame.length;
    let mass = 0.5 * numbers.mass(false) * frame.mass / length;
    let rate = std::f64::consts::TAU * numbers.frequency / frame.time;
    let eccentricity = frame.sign() * numbers.eccentricity[0] * numbers.sides[0] * length;
    let height = numbers.height * length;
    let inertia = mass * (numbers.sides[0] * length).powi(2) / 12.0;
    let [x, up, rotation, column] = if view.renumbered { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
    let mut inertias = Triplets::new(4);
    inertias.add(x, x, mass);
    inertias.add(column, column, mass);
    inertias.add_outer([(up, 1.0), (rotation, eccentricity)], mass);
    inertias.add(up, up, mass);
    inertias.add(rotation, rotation, 2.0 * inertia);
    let drift = [(column, 1.0), (x, -1.0), (rotation, height)];
    let stiffness = mass * rate * rate;
    let mut springs = Triplets::new(4);
    springs.add_outer(drift, stiffness);
    let mut dashpots = Triplets::new(4);
    dashpots.add_outer(drift, 0.06 * stiffness / rate);
    let ends =
        [-0.5, 0.5].map(|part| view.frame.length * (part * numbers.sides[0] + view.shift[0]));
    let base = BaseNode::rigid_base(ends[0], ends[1], [x, up, rotation]);
    let model = MatrixModel::new(inertias, springs, base)?.with_damping(dashpots)?;
    Ok(ProbedStructure::new(model, top(column, up)))
}

/// The model of a blueprint.
pub(crate) fn of_blueprint(plan: &Blueprint, view: &View) -> Result<ProbedStructure> {
    let model = if view.read_from_gmsh { gmsh::model(plan)? } else { plan.model(view)? };
    let top = plan.rows(&model, plan.top, view)?;
    Ok(ProbedStructure::new(model, top))
}

/// A reduced model; its top is the base's first corner of the scene.
fn reduced(plan: &Blueprint, view: &View) -> Result<ProbedStructure> {
    let model = CraigBampton::new(6).reduce(plan.model(view)?)?;
    let corner = view.point(plan.points[0]);
    let base = model.base();
    let node = base.nodes().find(|node| {
        let across = if plan.in_space { node.y - corner[1] } else { 0.0 };
        (node.x - corner[0]).hypot(across) < 1e-6 * view.frame.length
    });
    let node = node.expect("the corner is a node of the base").clone();
    Ok(ProbedStructure::new(model, [node.horizontal, node.across, node.vertical]))
}

/// The rigid body of the numbers, with an eccentric centre of gravity.
pub(crate) fn body(numbers: &Numbers, height: f64, view: &View) -> Result<RigidBody> {
    let frame = &view.frame;
    let length = frame.length;
    let [a, b] = numbers.sides;
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let view_without_shift = View { shift: [0.0; 2], ..*view };
    let outline = corners.map(|[x, y]| view_without_shift.surface_point([x * a, y * b]));
    let outline = view.ordered(outline.to_vec());
    let mass = numbers.density * a * b * height;
    let about_axes =
        view.along_axes([cuboid_inertia(mass, b, height), cuboid_inertia(mass, a, height)]);
    let about_vertical = cuboid_inertia(mass, a, b);
    let inertia =
        [[about_axes[0], 0.0, 0.0], [0.0, about_axes[1], 0.0], [0.0, 0.0, about_vertical]]
            .map(|row| row.map(|part| part * frame.mass * length * length));
    let eccentricity = numbers.eccentricity;
    let gravity_center =
        view_without_shift.point([eccentricity[0] * a, eccentricity[1] * b, 0.5 * height]);
    let body = RigidBody::from_mass(outline, mass * frame.mass, inertia, gravity_center)?;
    body.centered_at(view.surface_point([0.0; 2]))
}

/// Faces of a rigid base in SI units, from its middle.
pub(crate) type BaseFaces = Vec<Vec<[f64; 2]>>;

/// Matrices of the rigid body on any faces.
pub(crate) fn on_faces(
    numbers: &Numbers,
    faces: &BaseFaces,
    view: &View,
) -> Result<ProbedStructure> {
    let body = body(numbers, numbers.height, view)?;
    let top = body.displacement_at([0.0, 0.0, numbers.height * view.frame.length]);
    let mut mass = Triplets::new(6);
    body.mass(&mut mass)?;
    let center = view.surface_point([0.0; 2]);
    let view_without_shift = View { shift: [0.0; 2], ..*view };
    let mut base_faces = Vec::new();
    for face in faces {
        let corners: Vec<_> =
            face.iter().map(|corner| view_without_shift.surface_point(*corner)).collect();
        let corners = view.ordered(corners);
        base_faces.push(BaseNode::rigid_face(&corners, center, [0, 1, 2, 3, 4, 5]));
    }
    let base = Base::Faces(view.ordered(base_faces));
    Ok(ProbedStructure::new(MatrixModel::new(mass, Triplets::new(6), base)?, top))
}

fn in_plan(kind: BodyPart, numbers: &Numbers, view: &View) -> Result<ProbedStructure> {
    let frame = &view.frame;
    Ok(match kind {
        BodyPart::Rigid => {
            let body = body(numbers, numbers.height, view)?;
            let top = body.displacement_at([0.0, 0.0, numbers.height * frame.length]);
            ProbedStructure::new(body, top)
        }
        BodyPart::Matrices => {
            let half = 0.5 * numbers.sides[1];
            let faces = [[-0.5, 0.1], [0.1, 0.5]].map(|part| {
                let from = part[0] * numbers.sides[0];
                let to = part[1] * numbers.sides[0];
                vec![[from, -half], [to, -half], [to, half], [from, half]]
            });
            on_faces(numbers, &faces.to_vec(), view)?
        }
        BodyPart::Floors | BodyPart::SlenderFloors => {
            floors(kind == BodyPart::SlenderFloors, numbers, view)?
        }
        BodyPart::Shells | BodyPart::SlenderFrame => {
            let mut plan = models::raft(numbers);
            plan.p_delta = kind == BodyPart::SlenderFrame;
            plan.damping = if plan.p_delta { 0.0 } else { 0.03 };
            of_blueprint(&plan, view)?
        }
        BodyPart::Bricks => of_blueprint(&models::bricks(numbers), view)?,
        BodyPart::Linked => of_blueprint(&models::linked(numbers), view)?,
        BodyPart::Reduced => reduced(&models::bricks(numbers), view)?,
        _ => unreachable!("{} is no structure in plan", kind.word()),
    })
}

/// Two floors on a rigid body, with eccentric masses and stiffnesses.
fn floors(has_p_delta: bool, numbers: &Numbers, view: &View) -> Result<ProbedStructure> {
    let frame = &view.frame;
    let length = frame.length;
    let mat = body(numbers, 0.3 * numbers.height, view)?;
    let mass = 0.3 * numbers.mass(true) * frame.mass;
    let rate = std::f64::consts::TAU * numbers.frequency / frame.time;
    let [kx, ky] = view.along_axes([5.0 * mass * rate * rate, 4.0 * mass * rate * rate]);
    let sides = view.along_axes(numbers.sides.map(|side| side * length));
    let twist = 0.3 * (kx + ky) * sides[0] * sides[1];
    let view_without_shift = View { shift: [0.0; 2], ..*view };
    let eccentricity = numbers.eccentricity;
    let [mass_center, stiffness_center] =
        [eccentricity, [-eccentricity[1], eccentricity[0]]].map(|[x, y]| {
            view_without_shift.surface_point([x * numbers.sides[0], y * numbers.sides[1]])
        });
    let storey = PlanStorey::new(0.5 * numbers.height * length, mass, sides, [kx, ky, twist]);
    let damping = [kx, ky, twist].map(|k| 0.06 * k / rate);
    let storey = PlanStorey { mass_center, stiffness_center, damping, ..storey };
    let mut building = StoreyBuilding::new(mat, &[storey; 2])?;
    if has_p_delta {
        building = building.with_p_delta(SCENE_GRAVITY * frame.acceleration())?;
    }
    let mut top = building.floor(1, [0.0; 2])?;
    // The floors do not move vertically relative to the base.
    top[2] = 2.into();
    Ok(ProbedStructure::new(building, top))
}
