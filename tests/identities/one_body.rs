//! A rigid body is the same body with its base as one face, as quadrilaterals, as triangles, as bricks and shells that
//! hardly bend, and as nodes on a rigid link: under its weight, loads and shaking, for all laws.

use basemat::Result;
use basemat::fem::{Direction, LumpedMass, Material, Mesh, Shell};
use basemat::structure::{DofCombination, FemModel, RigidBody, Structure};
use basemat_problems::random::Random;

use super::blueprint::{Blueprint, Piece};
use super::grounds;
use super::numbers::Numbers;
use super::parts::{Choice, Coordinate, Ground, Motion, Space, covering};
use super::scene::{Response, run_with};
use super::structures::{Faces, Made, on_faces};
use super::tally::{Tally, scenes};
use super::view::PLAIN;

/// Static states are known to 1e-10.
const LIMIT: f64 = 1e-7;
/// Bricks and shells whose modulus is 1e6 times the soil's.
const BENT_LIMIT: f64 = 2e-3;

/// A way to divide the base.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Division {
    OneFace,
    Strips,
    Grid,
    TwoTriangles,
    Fan,
    UnevenTriangles,
    SkewQuads,
}

const DIVISIONS: [Division; 7] = [
    Division::OneFace,
    Division::Strips,
    Division::Grid,
    Division::TwoTriangles,
    Division::Fan,
    Division::UnevenTriangles,
    Division::SkewQuads,
];

/// Faces of a rectangle with these sides.
fn faces(division: Division, [a, b]: [f64; 2], random: &mut Random) -> Faces {
    let at = |x: f64, y: f64| [x * a, y * b];
    let corners = [at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)];
    let cell = |x: [f64; 2], y: [f64; 2]| {
        vec![at(x[0], y[0]), at(x[1], y[0]), at(x[1], y[1]), at(x[0], y[1])]
    };
    let cut = random.within(-0.3, 0.3);
    let inner = at(random.within(-0.3, 0.3), random.within(-0.3, 0.3));
    match division {
        Division::OneFace => vec![corners.to_vec()],
        Division::Strips => vec![cell([-0.5, cut], [-0.5, 0.5]), cell([cut, 0.5], [-0.5, 0.5])],
        Division::Grid => {
            let across = random.within(-0.3, 0.3);
            let mut all = Vec::new();
            for x in [[-0.5, cut], [cut, 0.5]] {
                all.extend([[-0.5, across], [across, 0.5]].map(|y| cell(x, y)));
            }
            all
        }
        Division::TwoTriangles => {
            vec![vec![corners[0], corners[1], corners[2]], vec![corners[0], corners[2], corners[3]]]
        }
        Division::Fan => (0..4).map(|k| vec![corners[k], corners[(k + 1) % 4], inner]).collect(),
        Division::UnevenTriangles | Division::SkewQuads => {
            let count = 3;
            let mut nodes = Vec::new();
            for row in 0..=count {
                for column in 0..=count {
                    let inside = |k: usize| k > 0 && k < count;
                    let mut moved = || 0.25 / count as f64 * random.within(-1.0, 1.0);
                    let [x, y] = [moved(), moved()];
                    let part = |k: usize| k as f64 / count as f64 - 0.5;
                    let x = part(column) + if inside(column) { x } else { 0.0 };
                    let y = part(row) + if inside(row) { y } else { 0.0 };
                    nodes.push(at(x, y));
                }
            }
            let mut all = Vec::new();
            for row in 0..count {
                for column in 0..count {
                    let node = |i: usize, j: usize| nodes[(row + i) * (count + 1) + column + j];
                    let around = [node(0, 0), node(0, 1), node(1, 1), node(1, 0)];
                    if division == Division::SkewQuads {
                        all.push(around.to_vec());
                    } else {
                        all.push(vec![around[0], around[1], around[2]]);
                        all.push(vec![around[0], around[2], around[3]]);
                    }
                }
            }
            all
        }
    }
}

/// Numbers of a longer base, and choices of law, ground, motion and scheme for a rigid body.
fn choices(seed: u64, count: usize) -> impl Iterator<Item = (Choice, Numbers, Random)> {
    covering(Space::Plan, seed, count).into_iter().map(|choice| {
        let choice = Choice { coordinate: Coordinate::Physical, ..choice };
        let mut random = Random(choice.seed ^ 7);
        let numbers = Numbers::draw(choice.seed);
        let width = numbers.sides[0] * random.within(0.3, 1.0);
        let numbers = Numbers { sides: [numbers.sides[0], width], ..numbers };
        (choice, numbers, random)
    })
}

fn run(choice: &Choice, numbers: &Numbers, made: Made) -> Result<Response> {
    run_with(choice, numbers, &PLAIN, made)
}

fn words(choice: &Choice, form: &'static str) -> [&'static str; 5] {
    let Choice { ground, law, motion, scheme, .. } = choice;
    [form, ground.word(), law.word(), motion.word(), scheme.word()]
}

#[test]
fn any_division_of_the_base_is_one_face() {
    let mut tally = Tally::new("one body: faces");
    for (number, (choice, numbers, mut random)) in choices(91, scenes(21, 300)).enumerate() {
        let division = DIVISIONS[1 + number % (DIVISIONS.len() - 1)];
        let form = match division {
            Division::TwoTriangles | Division::Fan | Division::UnevenTriangles => "triangles",
            _ => "quadrilateral faces",
        };
        grounds::next_scene();
        tally.scene(&words(&choice, form));
        let mut respond = |division: Division| {
            let faces = faces(division, numbers.sides, &mut random);
            let (model, top) = on_faces(&numbers, &faces, &PLAIN)?;
            run(&choice, &numbers, Made { structure: Box::new(model), top })
        };
        let place = format!("{division:?}, {:.2?} m, {}", numbers.sides, choice.name());
        match [respond(Division::OneFace), respond(division)] {
            [Ok(one), Ok(other)] => {
                let (value, group) = one.apart(&other);
                tally.within(&format!("{group}, {place}"), value, LIMIT);
            }
            [Err(error), Err(_)] => tally.refuse(format!("{place}: {error}")),
            [one, other] => {
                let [one, other] = [one, other].map(|found| found.err().map(|own| own.to_string()));
                tally.fail(format!("{place}: {one:?} but {other:?}"));
            }
        }
    }
    tally.close(0.8);
}

/// A cuboid of bricks with a modulus of 1e6 times the soil's.
fn bricks(numbers: &Numbers) -> Result<Made> {
    let mut plan = Blueprint::new(true, 1e6 * numbers.modulus, numbers.density);
    let levels = [0.0, numbers.height].map(|z| plan.grid(numbers.sides, [2, 2], z));
    let cells = levels.each_ref().map(|rows| Blueprint::cells(rows));
    for ([a, b, c, d], [e, f, g, h]) in cells[0].iter().zip(&cells[1]) {
        plan.pieces.push(Piece::Brick([*a, *b, *c, *d, *e, *f, *g, *h]));
    }
    let top = levels[1][1][1];
    let model = plan.model(&PLAIN)?;
    let top = plan.rows(&model, top, &PLAIN)?;
    Ok(Made { structure: Box::new(model), top })
}

/// The cuboid as a mass on the middle of massless shells, rigid by their thickness or by a link.
fn on_shells(numbers: &Numbers, triangles: bool, is_linked: bool) -> Result<Made> {
    let [a, b] = numbers.sides;
    let young = if is_linked { 10.0 } else { 1e6 } * numbers.modulus;
    let material = Material::new(young, 0.2, 0.0)?;
    let mut mesh = Mesh::in_space();
    let part = |k: usize| 0.5 * k as f64 - 0.5;
    let floor = mesh.add_grid(3, 3, |row, column| [part(column) * a, part(row) * b, 0.0])?;
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
    // The centre of gravity is a node of its own, which follows the middle of the base.
    let middle = floor.row(1)[1];
    let above = |height: f64| [0.0, 0.0, height - 0.5 * thickness];
    let center = mesh.add_node_at(above(0.5 * numbers.height))?;
    let top = mesh.add_node_at(above(numbers.height))?;
    let mass = numbers.mass(true);
    let about = |one: f64, other: f64| mass * (one * one + other * other) / 12.0;
    let h = numbers.height;
    mesh.add(LumpedMass::in_space(center, mass, [about(b, h), about(a, h), about(a, b)])?)?;
    mesh.add(LumpedMass::in_space(top, 1e-9 * mass, [0.0; 3])?)?;
    let mut followers = vec![center, top];
    if is_linked {
        followers.extend((0..3).flat_map(|row| floor.row(row)).filter(|node| **node != middle));
    }
    let model = FemModel::on_faces(mesh, &faces)?.with_rigid_link(middle, &followers)?;
    let row = |direction| -> Result<DofCombination> { model.row(top, direction) };
    let top = [row(Direction::X)?, row(Direction::Y)?, row(Direction::Z)?];
    Ok(Made { structure: Box::new(model), top })
}

#[test]
fn bricks_shells_and_rigid_links_are_the_rigid_body() {
    let mut tally = Tally::new("one body: bricks, shells, rigid links");
    let forms =
        ["bricks", "shells", "shells of triangles", "rigid link", "rigid link of triangles"];
    for (number, (choice, numbers, _)) in choices(92, scenes(15, 200)).enumerate() {
        let form = forms[number % forms.len()];
        grounds::next_scene();
        tally.scene(&words(&choice, form));
        let [a, b] = numbers.sides;
        let whole = || -> Result<Response> {
            let body = RigidBody::cuboid([a, b, numbers.height], numbers.density)?;
            let top = body.displacement_at([0.0, 0.0, numbers.height]);
            run(&choice, &numbers, Made { structure: Box::new(body), top })
        };
        let divided = || -> Result<Response> {
            let made = match form {
                "bricks" => bricks(&numbers)?,
                _ => on_shells(&numbers, form.contains("triangles"), form.contains("link"))?,
            };
            run(&choice, &numbers, made)
        };
        let limit = if form.contains("link") { LIMIT } else { BENT_LIMIT };
        let place = format!("{form}, {:.2?} m, {}", numbers.sides, choice.name());
        match [whole(), divided()] {
            [Ok(one), Ok(other)] => {
                let (value, group) =
                    one.apart_in(&other, &["forces", "moments", "rotations", "top"]);
                tally.within(&format!("{group}, {place}"), value, limit);
            }
            [Err(error), Err(_)] => tally.refuse(format!("{place}: {error}")),
            [one, other] => {
                let [one, other] = [one, other].map(|found| found.err().map(|own| own.to_string()));
                tally.fail(format!("{place}: {one:?} but {other:?}"));
            }
        }
    }
    tally.close(0.8);
}

/// Static stiffness of long mats: the fault of sharp corners grows with the ratio of the sides.
#[test]
fn sharp_triangles_keep_the_outline() {
    let mut tally = Tally::new("one body: static stiffness of long mats");
    let mut random = Random(93);
    for (number, division) in DIVISIONS.iter().cycle().skip(1).take(scenes(12, 120)).enumerate() {
        if *division == Division::OneFace {
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
            ground: Ground::HalfPlane,
            motion: Motion::Loads,
            ..covering(Space::Plan, seed, 1)[0]
        };
        let mut cells = |division: Division| -> Result<Vec<f64>> {
            let faces = faces(division, sides, &mut random);
            let (model, _) = on_faces(&numbers, &faces, &PLAIN)?;
            let structure: Box<dyn Structure> = Box::new(model);
            let ground = grounds::ground(&choice, &numbers, structure.as_ref(), &PLAIN)?;
            // Ends of the cells, and what they carry inside the outline.
            let numbers = |own: &basemat::bem::ContactElement| {
                let [[left, right], [front, back]] = [[own.left(), own.right()], own.depth()];
                [left, right, front, back, own.area()]
            };
            Ok(ground.elements().iter().flat_map(numbers).collect())
        };
        let place = format!("{number}: {division:?}, {sides:.2?} m");
        match [cells(Division::OneFace), cells(*division)] {
            [Ok(one), Ok(other)] if one.len() == other.len() => {
                let pairs = one.iter().zip(&other);
                let apart = pairs.fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()));
                tally.within(&place, apart / sides[0], 1e-9);
            }
            [Ok(one), Ok(other)] => {
                let counts = [one.len() / 5, other.len() / 5];
                tally.fail(format!("{place}: {counts:?} cells"));
            }
            [one, other] => tally.fail(format!("{place}: {one:?} but {other:?}")),
        }
    }
    tally.close(0.8);
}
