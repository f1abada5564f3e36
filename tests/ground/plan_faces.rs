//! GOAL: the outline of a mat decides about its cells, and the faces that fill it do not.
//! SCENE: rectangles, an L, a triangle, a ring, rafts of sectors and two separate mats, each divided at random into
//! triangles and other convex faces, with corners on edges of neighbours, in any order; turned and mirrored copies.
//! REFERENCE: the mat as one face, or as a few; areas and centres by hand; symmetry.

use basemat::Soil;
use basemat::bem::ContactElement;
use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::soil::SoilProfile;
use basemat::unobserved;

use basemat_problems::heavy;
use basemat_problems::random::Random;

type Face = Vec<[f64; 2]>;

fn rectangle(x: [f64; 2], y: [f64; 2]) -> Face {
    vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}

/// A number below `count`.
fn below(random: &mut Random, count: usize) -> usize {
    let all: Vec<usize> = (0..count).collect();
    random.pick(&all)
}

/// Point between two others.
fn between(a: [f64; 2], b: [f64; 2], part: f64) -> [f64; 2] {
    [0, 1].map(|k| a[k] + part * (b[k] - a[k]))
}

/// The same area in other faces: some cut from edge to edge, some into triangles about a point inside.
fn divided(faces: &[Face], cuts: usize, random: &mut Random) -> Vec<Face> {
    let mut faces = faces.to_vec();
    for _ in 0..cuts {
        let face = faces.swap_remove(below(random, faces.len()));
        let count = face.len();
        let next = |k: usize| face[(k + 1) % count];
        if random.chance(0.5) {
            let [one, other] = [below(random, count), below(random, count - 1)];
            let [first, last] = if other < one { [other, one] } else { [one, other + 1] };
            let ends = [first, last].map(|k| between(face[k], next(k), random.within(0.1, 0.9)));
            let mut left = vec![ends[0]];
            left.extend(&face[first + 1..=last]);
            left.push(ends[1]);
            let mut right = vec![ends[1]];
            right.extend(face[last + 1..].iter().chain(&face[..=first]));
            right.push(ends[0]);
            faces.extend([left, right]);
        } else {
            let weights: Vec<f64> = (0..count).map(|_| random.within(0.1, 1.0)).collect();
            let sum: f64 = weights.iter().sum();
            let point = [0, 1].map(|axis| {
                face.iter().zip(&weights).map(|(p, weight)| p[axis] * weight / sum).sum::<f64>()
            });
            faces.extend((0..count).map(|k| vec![face[k], next(k), point]));
        }
    }
    for k in (1..faces.len()).rev() {
        faces.swap(k, below(random, k + 1));
    }
    for face in &mut faces {
        let first = below(random, face.len());
        face.rotate_left(first);
        if random.chance(0.5) {
            face.reverse();
        }
    }
    faces
}

fn elements(faces: &[Face], cells: usize) -> Vec<ContactElement> {
    let plan = Plan::on_faces(faces, cells).unwrap();
    assert!(plan.area_error().abs() < 1e-9);
    plan.elements()
}

/// Largest difference of centres, sides and areas, relative to the size of the mats.
fn difference(one: &[ContactElement], other: &[ContactElement], size: f64) -> f64 {
    assert_eq!(one.len(), other.len());
    let pairs = one.iter().zip(other);
    let differences = pairs.flat_map(|(one, other)| {
        let numbers = |own: &ContactElement| {
            let ([x, y, _], [a, b]) = (own.center(), own.sides());
            [x / size, y / size, a / size, b / size, own.area() / (size * size)]
        };
        let (one, other) = (numbers(one), numbers(other));
        (0..5).map(move |k| (one[k] - other[k]).abs())
    });
    differences.fold(0.0, f64::max)
}

fn shapes() -> Vec<(&'static str, Vec<Face>, f64)> {
    let polygon = |corners: usize, turn: f64| -> Face {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / corners as f64 + turn;
        (0..corners).map(|k| [3.0 + 5.0 * angle(k).cos(), 5.0 * angle(k).sin()]).collect()
    };
    vec![
        ("rectangle", vec![rectangle([-20.0, 20.0], [-6.0, 6.0])], 480.0),
        ("square at 20 degrees", vec![polygon(4, 0.35)], 50.0),
        ("hexagon", vec![polygon(6, 0.1)], 75.0 * f64::sqrt(0.75)),
        ("triangle", vec![vec![[0.0, 0.0], [30.0, 4.0], [8.0, 20.0]]], 284.0),
        ("sharp triangle", vec![vec![[0.0, 0.0], [30.0, 1.0], [29.0, 9.0]]], 120.5),
        (
            "L",
            vec![rectangle([0.0, 30.0], [0.0, 10.0]), rectangle([0.0, 17.0], [10.0, 21.0])],
            487.0,
        ),
        (
            "ring",
            vec![
                rectangle([0.0, 30.0], [0.0, 8.0]),
                rectangle([0.0, 9.0], [8.0, 15.0]),
                rectangle([21.0, 30.0], [8.0, 15.0]),
                rectangle([0.0, 30.0], [15.0, 24.0]),
            ],
            636.0,
        ),
        (
            "two mats",
            vec![rectangle([0.0, 8.0], [0.0, 9.0]), vec![[15.0, 1.0], [26.0, 2.0], [17.0, 11.0]]],
            72.0 + 54.0,
        ),
    ]
}

#[test]
fn random_faces_of_an_outline_have_the_cells_of_the_outline() {
    let mut random = Random(7);
    let most = if heavy() { 60 } else { 8 };
    for (name, faces, area) in shapes() {
        for trial in 0..most {
            let cells = 3 + below(&mut random, 9);
            // Mats that are too close for large cells.
            let cells = if name == "two mats" { cells + 8 } else { cells };
            let cuts = 1 + below(&mut random, 20);
            let own = divided(&faces, cuts, &mut random);
            let [wanted, found] = [&faces, &own].map(|faces| elements(faces, cells));
            let worst = difference(&wanted, &found, 20.0);
            assert!(worst < 1e-9, "{name} {trial} {cells} {worst}");
            let sum: f64 = found.iter().map(ContactElement::area).sum();
            assert!((sum / area - 1.0).abs() < 1e-9, "{name} {sum} {area}");
            let without = [&faces, &own].map(|faces| {
                Plan::on_faces(faces, cells).unwrap().without_overhang().unwrap().elements()
            });
            assert!(difference(&without[0], &without[1], 20.0) < 1e-9, "{name} {trial}");
        }
    }
}

/// Static stiffnesses of a rigid mat of 40 m x 12 m on 4 cells as triangles.
#[test]
fn rigid_mats_of_triangles_are_as_stiff_as_one_face() {
    let soil = || SoilProfile::from(Soil::new(80e6, 0.33, 1900.0).unwrap());
    let stiffness = |faces: &[Face]| {
        let plan = Plan::on_faces(faces, 4).unwrap();
        let contact = StripContact::Bonded;
        let found = impedances_in_plan(&soil(), &plan, &[0.0], contact, &mut unobserved).unwrap();
        [0, 1, 2, 3, 4, 5].map(|k| found[0].matrix[k][k].re)
    };
    for sides in [[40.0, 12.0], [60.0, 10.0]] {
        let [x, y] = sides.map(|side| 0.5 * side);
        let corners = rectangle([-x, x], [-y, y]);
        let about = |point: [f64; 2]| -> Vec<Face> {
            (0..4).map(|k| vec![corners[k], corners[(k + 1) % 4], point]).collect()
        };
        let wanted = stiffness(std::slice::from_ref(&corners));
        let halves = vec![corners[..3].to_vec(), vec![corners[0], corners[2], corners[3]]];
        for (name, faces) in [("two", halves), ("four", about([0.5, 0.3]))] {
            let found = stiffness(&faces);
            for axis in 0..6 {
                let ratio = found[axis] / wanted[axis] - 1.0;
                assert!(ratio.abs() < 1e-9, "{sides:?} {name} {axis}: {ratio:e}");
            }
        }
    }
}

/// Number of elements that have no partner among the mapped ones.
fn without_partner(
    found: &[ContactElement],
    map: impl Fn([f64; 2]) -> [f64; 2],
    size: f64,
) -> usize {
    let turns = map([1.0, 0.0])[0] == 0.0;
    let is_partner = |one: &ContactElement, other: &ContactElement| {
        let ([x, y, _], [u, v, _]) = (one.center(), other.center());
        let [x, y] = map([x, y]);
        let [a, b] = one.sides();
        let [a, b] = if turns { [b, a] } else { [a, b] };
        let apart = [x - u, y - v, a - other.sides()[0], b - other.sides()[1]];
        apart.iter().all(|part| part.abs() < 1e-9 * size)
    };
    found.iter().filter(|one| !found.iter().any(|other| is_partner(one, other))).count()
}

/// Rafts of sectors about a pole, discs and squares on an edge have cells as symmetric as they are.
#[test]
fn symmetric_mats_have_symmetric_cells() {
    let raft = |sectors: usize| -> Vec<Face> {
        let place = |radius: f64, k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / sectors as f64;
            [radius * angle.cos(), radius * angle.sin()]
        };
        let radii = [0.0, 5.0, 10.0, 15.0, 20.0, 23.0];
        let face = |ring: usize, k: usize| {
            let [inner, outer] = [radii[ring], radii[ring + 1]];
            let mut face = vec![place(outer, k), place(outer, k + 1), place(inner, k + 1)];
            face.extend((ring > 0).then(|| place(inner, k)));
            face
        };
        (0..5).flat_map(|ring| (0..sectors).map(move |k| face(ring, k))).collect()
    };
    let square = vec![vec![[23.0, 0.0], [0.0, 23.0], [-23.0, 0.0], [0.0, -23.0]]];
    let mut plans = vec![("square", Plan::on_faces(&square, 7).unwrap())];
    for cells in [4, 5, 8, 11, 16] {
        plans.push(("disc", Plan::disc([0.0; 2], 23.0, cells).unwrap()));
        for sectors in [8, 20, 40] {
            plans.push(("raft", Plan::on_faces(&raft(sectors), cells).unwrap()));
        }
    }
    for (name, plan) in plans {
        let found = plan.elements();
        for (map, kind) in [
            ((|[x, y]| [-x, y]) as fn([f64; 2]) -> [f64; 2], "left and right"),
            (|[x, y]| [x, -y], "front and back"),
            (|[x, y]| [y, x], "x and y"),
        ] {
            let alone = without_partner(&found, map, 23.0);
            assert_eq!(alone, 0, "{name} of {} cells: {kind}", found.len());
        }
    }
}

/// Cells under a mat that is turned by 90 degrees or mirrored are the cells turned or mirrored.
#[test]
fn turned_and_mirrored_mats_have_turned_and_mirrored_cells() {
    let mut random = Random(11);
    for (name, faces, _) in shapes() {
        let own = divided(&faces, 12, &mut random);
        for (map, turns) in [
            ((|[x, y]| [-y, x]) as fn([f64; 2]) -> [f64; 2], true),
            (|[x, y]| [-x, y], false),
            (|[x, y]| [y, x], true),
        ] {
            let copy: Vec<Face> =
                own.iter().map(|face| face.iter().map(|p| map(*p)).collect()).collect();
            let cells = if name == "two mats" { 16 } else { 9 };
            let [one, mut other] = [&own, &copy].map(|faces| elements(faces, cells));
            for element in &one {
                let ([x, y, _], [a, b]) = (element.center(), element.sides());
                let [x, y] = map([x, y]);
                let [a, b] = if turns { [b, a] } else { [a, b] };
                let near = |other: &ContactElement| {
                    let ([u, v, _], [c, d]) = (other.center(), other.sides());
                    [x - u, y - v, a - c, b - d].iter().all(|part| part.abs() < 2e-8)
                };
                let place = other.iter().position(near);
                other.swap_remove(place.unwrap_or_else(|| panic!("{name} {element:?}")));
            }
            assert!(other.is_empty(), "{name}");
        }
    }
}
