//! GOAL: a rigid body is the same whatever its base consists of.
//! SCENE: one face, quadrilaterals, triangles, bricks and shells that hardly bend, nodes on a rigid link; under weight,
//! loads and shaking, for all laws.
//! REFERENCE: the body with its base as one face.

use basemat::Result;
use basemat::fem::{Direction, LumpedMass, Material, Mesh, Shell};
use basemat::structure::{FemModel, RigidBody};
use basemat_problems::random::Random;

use super::blueprint::{Blueprint, Piece};
use super::compare::largest_difference;
use super::grounds;
use super::models::brick_points;
use super::numbers::Numbers;
use super::parts::{Choice, CoordinatePart, GroundPart, MotionPart, Space, covering};
use super::scene::{SceneResponse, run_with};
use super::structures::{BaseFaces, ProbedStructure, cuboid_inertia, of_blueprint, on_faces};
use super::tally::{IdentityTally, scenes};
use super::view::PLAIN_VIEW;

/// Largest relative difference of rigid bases; static states are accurate to 1e-10.
const RIGID_LIMIT: f64 = 1e-7;
/// Largest relative difference of bricks and shells whose modulus is 1e6 times the soil's.
const BENDING_LIMIT: f64 = 2e-3;

/// A division of the base into faces.
#[derive(Debug, Clone, Copy, PartialEq)]
enum BaseDivision {
    OneFace,
    Strips,
    Grid,
    TwoTriangles,
    Fan,
    UnevenTriangles,
    SkewQuads,
}

const BASE_DIVISIONS: [BaseDivision; 7] = [
    BaseDivision::OneFace,
    BaseDivision::Strips,
    BaseDivision::Grid,
    BaseDivision::TwoTriangles,
    BaseDivision::Fan,
    BaseDivision::UnevenTriangles,
    BaseDivision::SkewQuads,
];

/// Corners of a rectangle, counter-clockwise.
fn rectangle(x: [f64; 2], y: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}

/// A quadrilateral as two triangles.
fn two_triangles(corners: &[[f64; 2]]) -> [Vec<[f64; 2]>; 2] {
    [vec![corners[0], corners[1], corners[2]], vec![corners[0], corners[2], corners[3]]]
}

/// Cells along a side of an irregular grid.
const GRID_CELLS: usize = 3;

/// Quadrilaterals of a grid over the unit square whose nodes are moved at random.
fn irregular_quadrilaterals(random: &mut Random) -> BaseFaces {
    let is_inside = |k: usize| k > 0 && k < GRID_CELLS;
    let mut nodes = [[[0.0; 2]; GRID_CELLS + 1]; GRID_CELLS + 1];
    for row in 0..=GRID_CELLS {
        for column in 0..=GRID_CELLS {
            let [dx, dy] = [(); 2].map(|()| 0.25 / GRID_CELLS as f64 * random.within(-1.0, 1.0));
            let x = column as f64 / GRID_CELLS as f64 - 0.5;
            let y = row as f64 / GRID_CELLS as f64 - 0.5;
            nodes[row][column] = [
                x + if is_inside(column) { dx } else { 0.0 },
                y + if is_inside(row) { dy } else { 0.0 },
            ];
        }
    }
    let mut faces = Vec::new();
    for row in 0..GRID_CELLS {
        for column in 0..GRID_CELLS {
            faces.push(vec![
                nodes[row][column],
                nodes[row][column + 1],
                nodes[row + 1][column + 1],
                nodes[row + 1][column],
            ]);
        }
    }
    faces
}

/// Faces of the unit square about the origin.
fn unit_faces(division: BaseDivision, random: &mut Random) -> BaseFaces {
    let side = [-0.5, 0.5];
    let corners = rectangle(side, side);
    let cut = random.within(-0.3, 0.3);
    let inner_point = [random.within(-0.3, 0.3), random.within(-0.3, 0.3)];
    let parts = [[-0.5, cut], [cut, 0.5]];
    match division {
        BaseDivision::OneFace => vec![corners],
        BaseDivision::Strips => parts.map(|x| rectangle(x, side)).to_vec(),
        BaseDivision::Grid => {
            let cut = random.within(-0.3, 0.3);
            let mut faces = Vec::new();
            for x in parts {
                faces.extend([[-0.5, cut], [cut, 0.5]].map(|y| rectangle(x, y)));
            }
            faces
        }
        BaseDivision::TwoTriangles => two_triangles(&corners).to_vec(),
        BaseDivision::Fan => {
            (0..4).map(|k| vec![corners[k], corners[(k + 1) % 4], inner_point]).collect()
        }
        BaseDivision::SkewQuads => irregular_quadrilaterals(random),
        BaseDivision::UnevenTriangles => {
            let quadrilaterals = irregular_quadrilaterals(random);
            quadrilaterals.iter().flat_map(|corners| two_triangles(corners)).collect()
        }
    }
}

/// Faces of a rectangle with these sides.
fn faces(division: BaseDivision, [a, b]: [f64; 2], random: &mut Random) -> BaseFaces {
    let mut faces = unit_faces(division, random);
    for [x, y] in faces.iter_mut().flatten() {
        *x *= a;
        *y *= b;
    }
    faces
}

/// Choices of law, ground, motion and scheme for a rigid body, and numbers with any ratio of sides.
fn choices(seed: u64, count: usize) -> impl Iterator<Item = (Choice, Numbers, Random)> {
    covering(Space::Plan, seed, count).into_iter().map(|choice| {
        let choice = Choice { coordinate: CoordinatePart::Physical, ..choice };
        let mut random = Random(choice.seed ^ 7);
        let numbers = Numbers::draw(choice.seed);
        let width = numbers.sides[0] * random.within(0.3, 1.0);
        let numbers = Numbers { sides: [numbers.sides[0], width], ..numbers };
        (choice, numbers, random)
    })
}

fn run(
    choice: &Choice,
    numbers: &Numbers,
    probed_structure: ProbedStructure,
) -> Result<SceneResponse> {
    run_with(choice, numbers, &PLAIN_VIEW, probed_structure)
}

fn words(choice: &Choice, form: &'static str) -> [&'static str; 5] {
    let Choice { ground, law, motion, scheme, .. } = choice;
    [form, ground.word(), law.word(), motion.word(), scheme.word()]
}

/// GOAL: any division of the base into faces gives the response of one face.
#[test]
fn any_division_of_the_base_is_one_face() {
    let mut tally = IdentityTally::new("one body: faces");
    for (number, (choice, numbers, mut random)) in choices(91, scenes(21, 300)).enumerate() {
        let division = BASE_DIVISIONS[1 + number % (BASE_DIVISIONS.len() - 1)];
        let form = match division {
            BaseDivision::TwoTriangles | BaseDivision::Fan | BaseDivision::UnevenTriangles => {
                "triangles"
            }
            _ => "quadrilateral faces",
        };
        grounds::clear_shared_kernels();
        tally.scene(&words(&choice, form));
        let results = [BaseDivision::OneFace, division].map(|division| {
            let faces = faces(division, numbers.sides, &mut random);
            run(&choice, &numbers, on_faces(&numbers, &faces, &PLAIN_VIEW)?)
        });
        let place = format!("{division:?}, {:.2?} m, {}", numbers.sides, choice.name());
        tally.compare(&place, results, |tally, expected, computed| {
            let difference = expected.difference(&computed);
            let place = format!("{}, {place}", difference.group);
            tally.within(&place, difference.value, RIGID_LIMIT);
        });
    }
    tally.close(0.8);
}

/// A cuboid of bricks with a modulus of 1e6 times the soil's.
fn bricks(numbers: &Numbers) -> Result<ProbedStructure> {
    let mut plan = Blueprint::new(true, 1e6 * numbers.modulus, numbers.density);
    let levels = [0.0, numbers.height].map(|z| plan.grid(numbers.sides, [2, 2], z));
    for (below, above) in Blueprint::cells(&levels[0]).into_iter().zip(Blueprint::cells(&levels[1]))
    {
        plan.pieces.push(Piece::Brick(brick_points(below, above)));
    }
    plan.top = levels[1][1][1];
    of_blueprint(&plan, &PLAIN_VIEW)
}

/// The cuboid as a mass on the middle of massless shells, rigid by their thickness or by a link.
fn on_shells(numbers: &Numbers, triangles: bool, is_linked: bool) -> Result<ProbedStructure> {
    let [a, b] = numbers.sides;
    let young = if is_linked { 10.0 } else { 1e6 } * numbers.modulus;
    let material = Material::new(young, 0.2, 0.0)?;
    let mut mesh = Mesh::in_space();
    let fractions = [-0.5, 0.0, 0.5];
    let floor =
        mesh.add_grid(3, 3, |row, column| [fractions[column] * a, fractions[row] * b, 0.0])?;
    // The base is the underside of the shells.
    let thickness = 0.2 * a;
    let mut faces = Vec::new();
    for (_, nodes) in floor.cells() {
        if triangles {
            faces.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|k| nodes[k]).to_vec()));
        } else {
            faces.push(nodes);
        }
    }
    for face in &faces {
        mesh.add(Shell::new(face, material, thickness)?)?;
    }
    // The centre of gravity is a separate node, which follows the middle of the base.
    let middle = floor.row(1)[1];
    let h = numbers.height;
    let center = mesh.add_node_at([0.0, 0.0, 0.5 * h - 0.5 * thickness])?;
    let top = mesh.add_node_at([0.0, 0.0, h - 0.5 * thickness])?;
    let mass = numbers.mass(true);
    let inertia = [[b, h], [a, h], [a, b]].map(|[one, other]| cuboid_inertia(mass, one, other));
    mesh.add(LumpedMass::in_space(center, mass, inertia)?)?;
    mesh.add(LumpedMass::in_space(top, 1e-9 * mass, [0.0; 3])?)?;
    let mut followers = vec![center, top];
    if is_linked {
        followers.extend((0..3).flat_map(|row| floor.row(row)).filter(|node| **node != middle));
    }
    let model = FemModel::on_faces(mesh, &faces)?.with_rigid_link(middle, &followers)?;
    let displacements = [
        model.row(top, Direction::X)?,
        model.row(top, Direction::Y)?,
        model.row(top, Direction::Z)?,
    ];
    Ok(ProbedStructure::new(model, displacements))
}

/// The rigid body itself.
fn cuboid(numbers: &Numbers) -> Result<ProbedStructure> {
    let [a, b] = numbers.sides;
    let body = RigidBody::cuboid([a, b, numbers.height], numbers.density)?;
    let top = body.displacement_at([0.0, 0.0, numbers.height]);
    Ok(ProbedStructure::new(body, top))
}

/// GOAL: bricks, shells and rigid links give the response of the rigid body.
#[test]
fn bricks_shells_and_rigid_links_are_the_rigid_body() {
    let mut tally = IdentityTally::new("one body: bricks, shells, rigid links");
    let forms =
        ["bricks", "shells", "shells of triangles", "rigid link", "rigid link of triangles"];
    for (number, (choice, numbers, _)) in choices(92, scenes(15, 200)).enumerate() {
        let form = forms[number % forms.len()];
        grounds::clear_shared_kernels();
        tally.scene(&words(&choice, form));
        let divided_body = match form {
            "bricks" => bricks(&numbers),
            _ => on_shells(&numbers, form.contains("triangles"), form.contains("link")),
        };
        let results =
            [cuboid(&numbers), divided_body].map(|structure| run(&choice, &numbers, structure?));
        let limit = if form.contains("link") { RIGID_LIMIT } else { BENDING_LIMIT };
        let place = format!("{form}, {:.2?} m, {}", numbers.sides, choice.name());
        tally.compare(&place, results, |tally, expected, computed| {
            let groups = ["forces", "moments", "rotations", "top"];
            let difference = expected.difference_in(&computed, &groups);
            tally.within(&format!("{}, {place}", difference.group), difference.value, limit);
        });
    }
    tally.close(0.8);
}

/// Ends of the cells under a rigid body on faces, and their areas inside the outline.
fn cell_numbers(choice: &Choice, numbers: &Numbers, faces: &BaseFaces) -> Result<Vec<f64>> {
    let body = on_faces(numbers, faces, &PLAIN_VIEW)?;
    let ground = grounds::ground(choice, numbers, body.structure.as_ref(), &PLAIN_VIEW)?;
    let mut list = Vec::new();
    for cell in ground.elements() {
        list.extend([cell.left(), cell.right()]);
        list.extend(cell.depth());
        list.push(cell.area());
    }
    Ok(list)
}

/// GOAL: cells under long mats do not depend on the faces, whose corners become sharp.
#[test]
fn sharp_triangles_keep_the_outline() {
    let mut tally = IdentityTally::new("one body: static stiffness of long mats");
    let mut random = Random(93);
    for (number, division) in
        BASE_DIVISIONS.iter().cycle().skip(1).take(scenes(12, 120)).enumerate()
    {
        if *division == BaseDivision::OneFace {
            continue;
        }
        let seed = random.bits();
        let numbers = Numbers::draw(seed);
        let ratio = random.within(1.0, 6.0);
        let sides = if number % 2 == 0 {
            [numbers.sides[0], numbers.sides[0] / ratio]
        } else {
            [numbers.sides[0] / ratio, numbers.sides[0]]
        };
        tally.scene(&["half-plane", "triangles", "loads"]);
        let numbers = Numbers { sides, ..numbers };
        let choice = Choice {
            ground: GroundPart::HalfPlane,
            motion: MotionPart::Loads,
            ..covering(Space::Plan, seed, 1)[0]
        };
        let cells = [BaseDivision::OneFace, *division]
            .map(|division| cell_numbers(&choice, &numbers, &faces(division, sides, &mut random)));
        let place = format!("{number}: {division:?}, {sides:.2?} m");
        match cells {
            [Ok(expected), Ok(computed)] if expected.len() == computed.len() => {
                let difference = largest_difference(&expected, &computed);
                tally.within(&place, difference / sides[0], 1e-9);
            }
            [Ok(expected), Ok(computed)] => {
                let counts = [expected.len() / 5, computed.len() / 5];
                tally.fail(format!("{place}: {counts:?} cells"));
            }
            [expected, computed] => {
                tally.fail(format!("{place}: {expected:?} but {computed:?}"));
            }
        }
    }
    tally.close(0.8);
}
