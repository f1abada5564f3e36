//! Structures of scenes in any view.

use basemat::Result;
use basemat::structure::{
    Base, BaseNode, Bilinear, CraigBampton, DofCombination, MatrixModel, ModalDamping, PlanStorey,
    RigidBlock, RigidBody, ShearBuilding, Storey, StoreyBuilding, Structure, StructureGroup,
    Triplets, WithSprings, WithWalls,
};
use basemat_problems::scenes::GRAVITY;

use super::blueprint::Blueprint;
use super::gmsh;
use super::models;
use super::numbers::Numbers;
use super::parts::{Body, Choice, Space};
use super::view::View;

/// A structure, and displacements of its top along the axes of the view.
pub(crate) struct Made {
    pub(crate) structure: Box<dyn Structure>,
    pub(crate) top: [DofCombination; 3],
}

fn made(structure: impl Structure + 'static, top: [DofCombination; 3]) -> Made {
    Made { structure: Box::new(structure), top }
}

/// The structure of a choice in the plane or in plan; with walls for a trench.
pub(crate) fn structure(choice: &Choice, numbers: &Numbers, view: &View) -> Result<Made> {
    let Made { structure, top } = match choice.space {
        Space::Plan => in_plan(choice.body, numbers, view)?,
        Space::Plane | Space::Trench => in_the_plane(choice.body, numbers, view)?,
    };
    if choice.space != Space::Trench {
        return Ok(Made { structure, top });
    }
    let depth = trench_depth(numbers) * view.frame.length;
    Ok(Made { structure: Box::new(WithWalls::new(structure, depth)?), top })
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
    let [center, _] = view.place([0.0; 2]);
    let building = ShearBuilding::new(width, 1.3 * mass, mass * width * width / 12.0, &storeys)?;
    building.centered_at(center)
}

fn block(numbers: &Numbers, view: &View) -> Result<RigidBlock> {
    let length = view.frame.length;
    let [center, _] = view.place([0.0; 2]);
    let (width, height) = (numbers.sides[0] * length, numbers.height * length);
    RigidBlock::new(width, height, numbers.density * view.frame.density())?.centered_at(center)
}

/// Displacements of a point of degrees of freedom along x and up.
fn top(along: impl Into<DofCombination>, up: impl Into<DofCombination>) -> [DofCombination; 3] {
    [along.into(), DofCombination::default(), up.into()]
}

fn in_the_plane(body: Body, numbers: &Numbers, view: &View) -> Result<Made> {
    let frame = &view.frame;
    let gravity = GRAVITY * frame.acceleration();
    let roof = 5;
    Ok(match body {
        Body::Block => {
            let block = block(numbers, view)?;
            let along = block.horizontal_at(numbers.height * frame.length);
            made(block, top(along, 1))
        }
        Body::Storeys => made(building(numbers, view)?.with_stiffness_damping(0.03)?, top(roof, 1)),
        Body::Slender => {
            let building = building(numbers, view)?.with_stiffness_damping(0.03)?;
            made(building.with_p_delta(gravity)?, top(roof, 1))
        }
        Body::Hysteretic => {
            let building = building(numbers, view)?.with_stiffness_damping(0.02)?;
            made(building.with_law(0, yielding_spring(numbers, view)?)?, top(roof, 1))
        }
        Body::Damped => {
            let damping = ModalDamping::new(&[0.05, 0.03])?;
            made(damping.on_fixed_base(building(numbers, view)?)?, top(roof, 1))
        }
        Body::Sprung => {
            let building = building(numbers, view)?;
            let drift = building.drift(1)?;
            let sprung =
                WithSprings::new(building).spring(drift, yielding_spring(numbers, view)?)?;
            made(sprung, top(roof, 1))
        }
        Body::Pair => {
            let parts = Numbers { sides: numbers.sides.map(|side| 0.5 * side), ..*numbers };
            let single = View { shift: [0.0; 2], ..*view };
            let distance = 0.5 * numbers.sides[0];
            let [left, right] = [-distance, distance].map(|x| view.place([x, 0.0])[0]);
            // From the left.
            let group = StructureGroup::new();
            let (block, building) = (block(&parts, &single)?, building(&parts, &single)?);
            let (group, member) = if frame.mirrored {
                (group.with(building, right)?.with(block, left)?, 0)
            } else {
                (group.with(block, left)?.with(building, right)?, 1)
            };
            let rows = [group.row(member, roof)?, group.row(member, 1)?];
            let [along, up] = rows;
            made(group, top(along, up))
        }
        Body::Matrices => matrices(numbers, view)?,
        Body::Frame => {
            let (plan, node) = models::frame(numbers);
            of_blueprint(&plan, node, view)?
        }
        Body::Quads | Body::Quads8 => {
            let (plan, node) = models::quads(numbers, body == Body::Quads8);
            of_blueprint(&plan, node, view)?
        }
        Body::Reduced => reduced(&models::quads(numbers, false).0, view)?,
        _ => unreachable!("{} is no structure in the plane", body.word()),
    })
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
fn matrices(numbers: &Numbers, view: &View) -> Result<Made> {
    let frame = &view.frame;
    let length = frame.length;
    let mass = 0.5 * numbers.mass(false) * frame.mass / length;
    let rate = std::f64::consts::TAU * numbers.frequency / frame.time;
    let aside = frame.sign() * numbers.eccentricity[0] * numbers.sides[0] * length;
    let height = numbers.height * length;
    let inertia = mass * (numbers.sides[0] * length).powi(2) / 12.0;
    let [x, up, turn, column] = if view.renumbered { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
    let mut inertias = Triplets::new(4);
    inertias.add(x, x, mass);
    inertias.add(column, column, mass);
    inertias.add_outer([(up, 1.0), (turn, aside)], mass);
    inertias.add(up, up, mass);
    inertias.add(turn, turn, 2.0 * inertia);
    let drift = [(column, 1.0), (x, -1.0), (turn, height)];
    let stiffness = mass * rate * rate;
    let mut springs = Triplets::new(4);
    springs.add_outer(drift, stiffness);
    let mut dashpots = Triplets::new(4);
    dashpots.add_outer(drift, 0.06 * stiffness / rate);
    let ends =
        [-0.5, 0.5].map(|part| view.frame.length * (part * numbers.sides[0] + view.shift[0]));
    let base = BaseNode::rigid_base(ends[0], ends[1], [x, up, turn]);
    let model = MatrixModel::new(inertias, springs, base)?.with_damping(dashpots)?;
    Ok(made(model, top(column, up)))
}

fn of_blueprint(plan: &Blueprint, node: usize, view: &View) -> Result<Made> {
    let model = if view.read_from_gmsh { gmsh::model(plan)? } else { plan.model(view)? };
    let rows = plan.rows(&model, node, view)?;
    Ok(made(model, rows))
}

/// A reduced model; its top is the base's first corner of the scene.
fn reduced(plan: &Blueprint, view: &View) -> Result<Made> {
    let model = CraigBampton::new(6).reduce(plan.model(view)?)?;
    let corner = view.point(plan.points[0]);
    let base = model.base();
    let near = |node: &&BaseNode| {
        let across = if plan.in_space { node.y - corner[1] } else { 0.0 };
        (node.x - corner[0]).hypot(across) < 1e-6 * view.frame.length
    };
    let node = base.nodes().find(near).expect("the corner is a node of the base").clone();
    Ok(made(model, [node.horizontal, node.across, node.vertical]))
}

/// The rigid body of the numbers, with an eccentric centre of gravity.
pub(crate) fn body(numbers: &Numbers, height: f64, view: &View) -> Result<RigidBody> {
    let frame = &view.frame;
    let length = frame.length;
    let [a, b] = numbers.sides;
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let unmoved = View { shift: [0.0; 2], ..*view };
    let outline = corners.map(|[x, y]| unmoved.place([x * a, y * b]));
    let outline = view.ordered(outline.to_vec());
    let mass = numbers.density * a * b * height;
    let about = |one: f64, other: f64| mass * (one * one + other * other) / 12.0;
    let [about_x, about_y] = view.along_axes([about(b, height), about(a, height)]);
    let inertia = [[about_x, 0.0, 0.0], [0.0, about_y, 0.0], [0.0, 0.0, about(a, b)]];
    let inertia = inertia.map(|row| row.map(|part| part * frame.mass * length * length));
    let [x, y] = numbers.eccentricity;
    let gravity_center = unmoved.point([x * a, y * b, 0.5 * height]);
    let body = RigidBody::from_mass(outline, mass * frame.mass, inertia, gravity_center)?;
    body.centered_at(view.place([0.0; 2]))
}

/// Faces of a rigid base in SI units, from its middle.
pub(crate) type Faces = Vec<Vec<[f64; 2]>>;

/// Matrices of the rigid body on any faces.
pub(crate) fn on_faces(
    numbers: &Numbers,
    faces: &Faces,
    view: &View,
) -> Result<(MatrixModel, [DofCombination; 3])> {
    let body = body(numbers, numbers.height, view)?;
    let top = body.displacement_at([0.0, 0.0, numbers.height * view.frame.length]);
    let mut mass = Triplets::new(6);
    body.mass(&mut mass)?;
    let center = view.place([0.0; 2]);
    let unmoved = View { shift: [0.0; 2], ..*view };
    let face = |corners: &Vec<[f64; 2]>| {
        let corners: Vec<_> = corners.iter().map(|corner| unmoved.place(*corner)).collect();
        BaseNode::rigid_face(&view.ordered(corners), center, [0, 1, 2, 3, 4, 5])
    };
    let faces = view.ordered(faces.iter().map(face).collect());
    Ok((MatrixModel::new(mass, Triplets::new(6), Base::Faces(faces))?, top))
}

fn in_plan(kind: Body, numbers: &Numbers, view: &View) -> Result<Made> {
    let frame = &view.frame;
    let [a, b] = numbers.sides;
    Ok(match kind {
        Body::Rigid => {
            let body = body(numbers, numbers.height, view)?;
            let top = body.displacement_at([0.0, 0.0, numbers.height * frame.length]);
            made(body, top)
        }
        Body::Matrices => {
            let face = |from: f64, to: f64| {
                let [from, to] = [from, to].map(|part| part * a);
                vec![[from, -0.5 * b], [to, -0.5 * b], [to, 0.5 * b], [from, 0.5 * b]]
            };
            let (model, top) = on_faces(numbers, &vec![face(-0.5, 0.1), face(0.1, 0.5)], view)?;
            made(model, top)
        }
        Body::Floors | Body::SlenderFloors => floors(kind == Body::SlenderFloors, numbers, view)?,
        Body::Shells | Body::SlenderFrame => {
            let (mut plan, node) = models::raft(numbers);
            plan.p_delta = kind == Body::SlenderFrame;
            plan.damping = if plan.p_delta { 0.0 } else { 0.03 };
            of_blueprint(&plan, node, view)?
        }
        Body::Bricks => {
            let (plan, node) = models::bricks(numbers);
            of_blueprint(&plan, node, view)?
        }
        Body::Linked => {
            let (plan, node) = models::linked(numbers);
            of_blueprint(&plan, node, view)?
        }
        Body::Reduced => reduced(&models::bricks(numbers).0, view)?,
        _ => unreachable!("{} is no structure in plan", kind.word()),
    })
}

fn floors(slender: bool, numbers: &Numbers, view: &View) -> Result<Made> {
    let frame = &view.frame;
    let length = frame.length;
    let mat = body(numbers, 0.3 * numbers.height, view)?;
    let mass = 0.3 * numbers.mass(true) * frame.mass;
    let rate = std::f64::consts::TAU * numbers.frequency / frame.time;
    let [kx, ky] = view.along_axes([5.0 * mass * rate * rate, 4.0 * mass * rate * rate]);
    let sides = view.along_axes(numbers.sides.map(|side| side * length));
    let twist = 0.3 * (kx + ky) * sides[0] * sides[1];
    let [x, y] = numbers.eccentricity;
    let unmoved = View { shift: [0.0; 2], ..*view };
    let place = |x: f64, y: f64| unmoved.place([x * numbers.sides[0], y * numbers.sides[1]]);
    let storey = PlanStorey::new(0.5 * numbers.height * length, mass, sides, [kx, ky, twist]);
    let damping = [kx, ky, twist].map(|k| 0.06 * k / rate);
    let storey =
        PlanStorey { mass_center: place(x, y), stiffness_center: place(-y, x), damping, ..storey };
    let mut building = StoreyBuilding::new(mat, &[storey; 2])?;
    if slender {
        building = building.with_p_delta(GRAVITY * frame.acceleration())?;
    }
    let [along, across, _] = building.floor(1, [0.0; 2])?;
    Ok(made(building, [along, across, 2.into()]))
}
