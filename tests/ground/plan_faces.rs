//! GOAL: the outline of a mat determines its cells; the faces that fill it do not.
//! SCENE: rectangles, an L, a triangle, a ring, rafts of sectors and two separate mats, each divided at random into
//! triangles and other convex faces, with corners on edges of neighbours, in any order; turned and mirrored copies.
//! REFERENCE: the mat as one face, or as a few; areas and centres by hand; symmetry.

use std::f64::consts::TAU;

use basemat::Soil;
use basemat::bem::ContactElement;
use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::soil::SoilProfile;
use basemat::unobserved;

use basemat_problems::heavy;
use basemat_problems::random::Random;

type FaceCorners = Vec<[f64; 2]>;

fn rectangle(x: [f64; 2], y: [f64; 2]) -> FaceCorners {
    vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}

/// A random number below `count`.
fn random_below(random: &mut Random, count: usize) -> usize {
    let numbers: Vec<usize> = (0..count).collect();
    random.pick(&numbers)
}

/// Point between two others, at a fraction of their distance.
fn point_between(a: [f64; 2], b: [f64; 2], fraction: f64) -> [f64; 2] {
    [0, 1].map(|k| a[k] + fraction * (b[k] - a[k]))
}

/// Two parts of a face, by a random cut from edge to edge.
fn cut_from_edge_to_edge(face: &FaceCorners, random: &mut Random) -> Vec<FaceCorners> {
    let count = face.len();
    let first_edge = random_below(random, count);
    let second_edge = random_below(random, count - 1);
    let edges = if second_edge < first_edge {
        [second_edge, first_edge]
    } else {
        [first_edge, second_edge + 1]
    };
    let ends =
        edges.map(|k| point_between(face[k], face[(k + 1) % count], random.within(0.1, 0.9)));
    let mut left = vec![ends[0]];
    left.extend(&face[edges[0] + 1..=edges[1]]);
    left.push(ends[1]);
    let mut right = vec![ends[1]];
    right.extend(face[edges[1] + 1..].iter().chain(&face[..=edges[0]]));
    right.push(ends[0]);
    vec![left, right]
}

/// Triangles from a random point inside a face to its edges.
fn cut_into_triangles(face: &FaceCorners, random: &mut Random) -> Vec<FaceCorners> {
    let count = face.len();
    let weights: Vec<f64> = (0..count).map(|_| random.within(0.1, 1.0)).collect();
    let sum: f64 = weights.iter().sum();
    let point = [0, 1].map(|axis| {
        face.iter().zip(&weights).map(|(p, weight)| p[axis] * weight / sum).sum::<f64>()
    });
    (0..count).map(|k| vec![face[k], face[(k + 1) % count], point]).collect()
}

/// The same area, cut at random into other faces; faces and their corners are in random order.
fn divided(faces: &[FaceCorners], cuts: usize, random: &mut Random) -> Vec<FaceCorners> {
    let mut faces = faces.to_vec();
    for _ in 0..cuts {
        let face = faces.swap_remove(random_below(random, faces.len()));
        if random.chance(0.5) {
            faces.extend(cut_from_edge_to_edge(&face, random));
        } else {
            faces.extend(cut_into_triangles(&face, random));
        }
    }
    for k in (1..faces.len()).rev() {
        faces.swap(k, random_below(random, k + 1));
    }
    for face in &mut faces {
        let first = random_below(random, face.len());
        face.rotate_left(first);
        if random.chance(0.5) {
            face.reverse();
        }
    }
    faces
}

fn elements(faces: &[FaceCorners], cells: usize) -> Vec<ContactElement> {
    let plan = Plan::on_faces(faces, cells).unwrap();
    assert!(plan.area_error().abs() < 1e-9);
    plan.elements()
}

/// Center (x, y) and sides (along x, along y) of an element.
fn center_and_sides(element: &ContactElement) -> [f64; 4] {
    let center = element.center();
    let sides = element.sides();
    [center[0], center[1], sides[0], sides[1]]
}

/// A map of the plane that exchanges the axes or not.
#[derive(Clone, Copy)]
struct AxisMap {
    map: fn([f64; 2]) -> [f64; 2],
    exchanges_axes: bool,
}

impl AxisMap {
    /// Center and sides of the image of an element.
    fn center_and_sides(self, element: &ContactElement) -> [f64; 4] {
        let center = element.center();
        let image = (self.map)([center[0], center[1]]);
        let sides = element.sides();
        if self.exchanges_axes {
            [image[0], image[1], sides[1], sides[0]]
        } else {
            [image[0], image[1], sides[0], sides[1]]
        }
    }
}

/// Whether all numbers differ by less than the tolerance.
fn are_close(a: [f64; 4], b: [f64; 4], tolerance: f64) -> bool {
    a.iter().zip(&b).all(|(a, b)| (a - b).abs() < tolerance)
}

/// Scale of differences between elements, m.
const MAT_SIZE: f64 = 20.0;

/// Largest difference of centres, sides and areas, relative to the size of the mats.
fn largest_difference(one: &[ContactElement], other: &[ContactElement]) -> f64 {
    assert_eq!(one.len(), other.len());
    let mut max_difference = 0.0_f64;
    for (one, other) in one.iter().zip(other) {
        for (a, b) in center_and_sides(one).into_iter().zip(center_and_sides(other)) {
            max_difference = max_difference.max((a / MAT_SIZE - b / MAT_SIZE).abs());
        }
        let square = MAT_SIZE * MAT_SIZE;
        max_difference = max_difference.max((one.area() / square - other.area() / square).abs());
    }
    max_difference
}

/// Corners of a regular polygon about (3, 0), the first at an angle `turn`.
fn regular_polygon(corners: usize, turn: f64) -> FaceCorners {
    (0..corners)
        .map(|k| {
            let angle = TAU * k as f64 / corners as f64 + turn;
            [3.0 + 5.0 * angle.cos(), 5.0 * angle.sin()]
        })
        .collect()
}

/// Name, faces and area of each mat.
fn shapes() -> Vec<(&'static str, Vec<FaceCorners>, f64)> {
    vec![
        ("rectangle", vec![rectangle([-20.0, 20.0], [-6.0, 6.0])], 480.0),
        ("square at 20 degrees", vec![regular_polygon(4, 0.35)], 50.0),
        ("hexagon", vec![regular_polygon(6, 0.1)], 75.0 * f64::sqrt(0.75)),
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

/// GOAL: random faces that fill an outline have the cells and the area of the outline.
#[test]
fn random_faces_of_an_outline_have_the_cells_of_the_outline() {
    let mut random = Random(7);
    let trials = if heavy() { 60 } else { 8 };
    for (name, faces, area) in shapes() {
        for trial in 0..trials {
            let cells = 3 + random_below(&mut random, 9);
            // The two mats are too close for large cells.
            let cells = if name == "two mats" { cells + 8 } else { cells };
            let cuts = 1 + random_below(&mut random, 20);
            let divided_faces = divided(&faces, cuts, &mut random);
            let expected = elements(&faces, cells);
            let computed = elements(&divided_faces, cells);
            let difference = largest_difference(&expected, &computed);
            assert!(difference < 1e-9, "{name} {trial} {cells} {difference}");
            let sum: f64 = computed.iter().map(ContactElement::area).sum();
            assert!((sum / area - 1.0).abs() < 1e-9, "{name} {sum} {area}");
            let without_overhang = [&faces, &divided_faces].map(|faces| {
                Plan::on_faces(faces, cells).unwrap().without_overhang().unwrap().elements()
            });
            let difference = largest_difference(&without_overhang[0], &without_overhang[1]);
            assert!(difference < 1e-9, "{name} {trial}");
        }
    }
}

/// Static stiffness of a rigid mat: three translations and three rotations.
fn mat_stiffness(faces: &[FaceCorners]) -> [f64; 6] {
    let profile = SoilProfile::from(Soil::new(80e6, 0.33, 1900.0).unwrap());
    let plan = Plan::on_faces(faces, 4).unwrap();
    let contact = StripContact::Bonded;
    let impedance =
        impedances_in_plan(&profile, &plan, &[0.0], contact, &mut unobserved).unwrap()[0];
    [0, 1, 2, 3, 4, 5].map(|k| impedance.matrix[k][k].re)
}

/// Rectangles in triangles are as stiff as one face.
#[test]
fn rigid_mats_of_triangles_are_as_stiff_as_one_face() {
    for sides in [[40.0, 12.0], [60.0, 10.0]] {
        let [x, y] = sides.map(|side| 0.5 * side);
        let corners = rectangle([-x, x], [-y, y]);
        let expected = mat_stiffness(std::slice::from_ref(&corners));
        let halves = vec![corners[..3].to_vec(), vec![corners[0], corners[2], corners[3]]];
        let quarters = (0..4).map(|k| vec![corners[k], corners[(k + 1) % 4], [0.5, 0.3]]).collect();
        for (name, faces) in [("two", halves), ("four", quarters)] {
            let computed = mat_stiffness(&faces);
            for axis in 0..6 {
                let ratio = computed[axis] / expected[axis] - 1.0;
                assert!(ratio.abs() < 1e-9, "{sides:?} {name} {axis}: {ratio:e}");
            }
        }
    }
}

/// Radius of the round mats, m.
const RAFT_RADIUS: f64 = 23.0;

/// A round raft: rings of sectors about a pole, where they are triangles.
fn raft(sectors: usize) -> Vec<FaceCorners> {
    let radii = [0.0, 5.0, 10.0, 15.0, 20.0, RAFT_RADIUS];
    let mut faces = vec![];
    for ring in radii.windows(2) {
        for k in 0..sectors {
            let mut face = vec![
                polar_point(ring[1], k, sectors),
                polar_point(ring[1], k + 1, sectors),
                polar_point(ring[0], k + 1, sectors),
            ];
            if ring[0] > 0.0 {
                face.push(polar_point(ring[0], k, sectors));
            }
            faces.push(face);
        }
    }
    faces
}

/// Point at a radius and the k-th of `count` equal angles.
fn polar_point(radius: f64, k: usize, count: usize) -> [f64; 2] {
    let angle = TAU * k as f64 / count as f64;
    [radius * angle.cos(), radius * angle.sin()]
}

/// GOAL: rafts of sectors, discs and a square on an edge have cells with the symmetry of the mat.
#[test]
fn symmetric_mats_have_symmetric_cells() {
    let square = vec![vec![
        [RAFT_RADIUS, 0.0],
        [0.0, RAFT_RADIUS],
        [-RAFT_RADIUS, 0.0],
        [0.0, -RAFT_RADIUS],
    ]];
    let mut plans = vec![("square", Plan::on_faces(&square, 7).unwrap())];
    for cells in [4, 5, 8, 11, 16] {
        plans.push(("disc", Plan::disc([0.0; 2], RAFT_RADIUS, cells).unwrap()));
        for sectors in [8, 20, 40] {
            plans.push(("raft", Plan::on_faces(&raft(sectors), cells).unwrap()));
        }
    }
    for (name, plan) in plans {
        let elements = plan.elements();
        for (map, kind) in [
            (AxisMap { map: |[x, y]| [-x, y], exchanges_axes: false }, "left and right"),
            (AxisMap { map: |[x, y]| [x, -y], exchanges_axes: false }, "front and back"),
            (AxisMap { map: |[x, y]| [y, x], exchanges_axes: true }, "x and y"),
        ] {
            for element in &elements {
                let image = map.center_and_sides(element);
                let has_partner = elements
                    .iter()
                    .any(|other| are_close(image, center_and_sides(other), 1e-9 * RAFT_RADIUS));
                assert!(has_partner, "{name} of {} cells: {kind}", elements.len());
            }
        }
    }
}

/// GOAL: cells of a mat turned by 90 degrees or mirrored are its cells turned or mirrored.
#[test]
fn turned_and_mirrored_mats_have_turned_and_mirrored_cells() {
    let mut random = Random(11);
    for (name, faces, _) in shapes() {
        let divided_faces = divided(&faces, 12, &mut random);
        for map in [
            AxisMap { map: |[x, y]| [-y, x], exchanges_axes: true },
            AxisMap { map: |[x, y]| [-x, y], exchanges_axes: false },
            AxisMap { map: |[x, y]| [y, x], exchanges_axes: true },
        ] {
            let mapped_faces: Vec<FaceCorners> = divided_faces
                .iter()
                .map(|face| face.iter().map(|point| (map.map)(*point)).collect())
                .collect();
            let cells = if name == "two mats" { 16 } else { 9 };
            let mut partners = elements(&mapped_faces, cells);
            for element in &elements(&divided_faces, cells) {
                let image = map.center_and_sides(element);
                let partner = partners
                    .iter()
                    .position(|other| are_close(image, center_and_sides(other), 2e-8));
                partners.swap_remove(partner.unwrap_or_else(|| panic!("{name} {element:?}")));
            }
            assert!(partners.is_empty(), "{name}");
        }
    }
}
