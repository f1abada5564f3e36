//! Single elements and patches: uniform states, rigid motions, renumbered nodes, the beam of the plane.

use basemat::fem::{Beam, Element, Hex8, MassKind, Material, Shell, SpaceBeam};
use basemat_problems::bricks::DISTORTED;
use basemat_problems::dense::{eigenpairs, largest};
use basemat_problems::patch::{POINTS, QUADS, STATES, bricks, field};
use basemat_problems::space_beams::{concrete, sheared};
use basemat_problems::supported::{CLAMPED, Part, RZ, Supported, X, Y, Z, rigid, values};

use super::row::Rows;
use super::surface::{Pattern, Surface};
use crate::AnyError;

/// Largest displacement of inner nodes from a uniform `state` while the nodes before `inner` are held in it, relative
/// to the largest of all.
fn error(mut scene: Supported, inner: usize, state: &[[f64; 6]]) -> f64 {
    let mut loads = Vec::new();
    let mut forces = vec![[0.0; 6]; state.len()];
    for element in scene.mesh.elements() {
        let own = values(element, state);
        let matrix = Part::Stiffness.of(element, &scene.points(element.nodes()));
        let places = element
            .nodes()
            .iter()
            .flat_map(|&node| element.directions().iter().map(move |&direction| (node, direction)));
        for ((node, direction), row) in places.zip(matrix.chunks(own.len())) {
            let place = CLAMPED.iter().position(|&other| other == direction).unwrap_or(0);
            forces[node][place] -= row.iter().zip(&own).map(|(k, u)| k * u).sum::<f64>();
        }
    }
    for (node, forces) in forces.iter().enumerate() {
        if node < inner {
            scene.hold(node, &CLAMPED);
        }
        loads.extend(CLAMPED.into_iter().zip(forces).map(|(direction, &f)| (node, direction, f)));
    }
    let found = scene.displacements(&loads);
    largest(found.as_flattened()) / largest(state.as_flattened())
}

fn patches(rows: &mut Rows) -> Result<(), AnyError> {
    for pattern in [Pattern::Quadrilaterals, Pattern::Rising] {
        for thickness in [0.001, 0.05] {
            for name in STATES {
                let mut patch = Surface::new(Material::new(1.0e6, 0.25, 1.0)?, thickness);
                for [x, y] in POINTS {
                    patch.scene.node([x, y, 0.0]);
                }
                for corners in QUADS.into_iter().flat_map(|cell| pattern.split(cell)) {
                    patch.shell(&corners, thickness)?;
                }
                let state = POINTS.map(|[x, y]| field(name, x, y));
                let error = error(patch.scene, 4, &state);
                let case = format!("t/size={:.3}", thickness / 0.24);
                rows.bound(&format!("patch {name} {} {case}", pattern.element()), error, 1e-9);
            }
        }
    }
    let material = Material::new(1.0e6, 0.25, 1.0)?;
    let scene = bricks(material);
    let uniform = |&[x, y, z]: &[f64; 3]| {
        [x + 0.5 * (y + z), y + 0.5 * (x + z), z + 0.5 * (x + y), 0.0, 0.0, 0.0]
    };
    let state: Vec<[f64; 6]> = scene.mesh.nodes().iter().map(uniform).collect();
    let error = error(scene, 8, &state);
    rows.bound("patch of seven distorted bricks", error, 1e-9);
    Ok(())
}

/// An element, its name and the places of its nodes.
type Sample = (&'static str, Box<dyn Element>, Vec<[f64; 3]>);

fn samples() -> Result<Vec<Sample>, AnyError> {
    let concrete = concrete();
    let quads = [
        ("Shell4 flat", [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], [0.0; 4]),
        ("Shell4 distorted", [[0.0, 0.0], [2.0, 0.1], [2.2, 1.5], [-0.2, 1.3]], [0.0; 4]),
        ("Shell4 warped", [[0.0, 0.0], [2.0, 0.1], [2.2, 1.5], [-0.2, 1.3]], [0.0, 0.2, -0.1, 0.3]),
    ];
    let mut all: Vec<Sample> = Vec::new();
    for (name, plan, heights) in quads {
        let points = plan.iter().zip(heights).map(|(&[x, y], z)| [x, y, z]).collect();
        all.push((name, Box::new(Shell::new([0, 1, 2, 3], concrete, 0.2)?), points));
    }
    let triangle = vec![[5.0, 1.0, 2.0], [5.0, 3.0, 2.0], [4.2, 2.4, 3.6]];
    all.push(("Shell3", Box::new(Shell::new([0, 1, 2], concrete, 0.2)?), triangle));
    let brick = DISTORTED.to_vec();
    all.push(("Hex8 distorted", Box::new(Hex8::new([0, 1, 2, 3, 4, 5, 6, 7], concrete)), brick));
    let beam = SpaceBeam::new([0, 1], concrete, sheared(), [1.0, 1.0, 0.2])?
        .with_offsets([[0.3, -0.2, 0.4], [0.1, 0.5, -0.3]])?;
    all.push(("SpaceBeam with offsets", Box::new(beam), vec![[1.0, 2.0, 0.0], [2.5, 1.0, 3.0]]));
    Ok(all)
}

fn rigid_motions(rows: &mut Rows) -> Result<(), AnyError> {
    for (name, element, points) in samples()? {
        let order = element.order();
        let matrix = Part::Stiffness.of(&*element, &points);
        let scale = largest(&matrix);
        for motion in 0..6 {
            let state: Vec<[f64; 6]> = points.iter().map(|&point| rigid(motion, point)).collect();
            let own = values(&*element, &state);
            let force = |row: &[f64]| row.iter().zip(&own).map(|(k, u)| k * u).sum::<f64>().abs();
            let most = matrix.chunks(order).map(force).fold(0.0, f64::max);
            rows.bound(&format!("rigid motion {motion}, {name}"), most / scale, 1e-12);
        }
        let square: Vec<Vec<f64>> = matrix.chunks(order).map(<[f64]>::to_vec).collect();
        let (found, _) = eigenpairs(&square);
        let most = found[order - 1];
        rows.bound(&format!("sixth eigenvalue, {name}"), largest(&found[..6]) / most, 1e-13);
        // Of its inverse: none of the others is near zero.
        rows.bound(&format!("largest over seventh eigenvalue, {name}"), most / found[6], 1e6);
    }
    Ok(())
}

fn renumbered(rows: &mut Rows) -> Result<(), AnyError> {
    for (name, element, points) in samples()? {
        let orders: &[&[usize]] = match points.len() {
            4 => &[&[1, 2, 3, 0], &[0, 3, 2, 1]],
            3 => &[&[1, 2, 0], &[0, 2, 1]],
            // A quarter turn about the vertical axis, and about the first.
            8 => &[&[1, 2, 3, 0, 5, 6, 7, 4], &[3, 2, 6, 7, 0, 1, 5, 4]],
            _ => continue,
        };
        let order = element.order();
        let size = order / points.len();
        let matrix = Part::Stiffness.of(&*element, &points);
        for &places in orders {
            let moved: Vec<[f64; 3]> = places.iter().map(|&place| points[place]).collect();
            let found = Part::Stiffness.of(&*element, &moved);
            let place = |k: usize| size * places[k / size] + k % size;
            let apart =
                |k: usize| (found[k] - matrix[place(k / order) * order + place(k % order)]).abs();
            let most = (0..order * order).map(apart).fold(0.0, f64::max) / largest(&matrix);
            rows.bound(&format!("renumbered {places:?}, {name}"), most, 1e-12);
        }
    }
    Ok(())
}

/// Beams of the plane x–z: largest difference from the beam of the plane, of the largest entry.
fn in_the_plane(rows: &mut Rows) -> Result<(), AnyError> {
    const PLACES: [usize; 6] = [0, 2, 4, 6, 8, 10];
    const SIGNS: [f64; 6] = [1.0, 1.0, -1.0, 1.0, 1.0, -1.0];
    for ends in [[[0.0, 0.0], [0.0, 4.0]], [[1.0, -2.0], [4.5, 1.0]], [[0.0, 0.0], [3.0, -0.7]]] {
        let flat = Beam::new([0, 1], 30.0e9, 0.12, 1.6e-3, 2500.0)?
            .with_shear_stiffness(12.5e9 * 0.1)?
            .with_rotary_inertia();
        let beam =
            SpaceBeam::new([0, 1], concrete(), sheared(), [0.0, 1.0, 0.0])?.with_rotary_inertia();
        let displacement = [1e-3, 2e-3, 1e-3, -2e-3, -1e-3, 3e-3];
        let mut in_space = [0.0; 12];
        for k in 0..6 {
            in_space[PLACES[k]] = SIGNS[k] * displacement[k];
        }
        let flat_points = ends.map(|[x, z]| [x, z, 0.0]);
        let points = ends.map(|[x, z]| [x, 0.0, z]);
        let none = "a beam with an axial force";
        let flat = flat.in_static_state(&flat_points, &displacement, 50.0).ok_or(none)?;
        let beam = beam.in_static_state(&points, &in_space, 50.0).ok_or(none)?;
        for (name, part) in [
            ("stiffness", Part::Stiffness),
            ("geometric stiffness", Part::GeometricStiffness),
            ("mass", Part::Mass(MassKind::Consistent)),
            ("lumped mass", Part::Mass(MassKind::Lumped)),
        ] {
            let [flat, own] = [part.of(&*flat, &flat_points), part.of(&*beam, &points)];
            let mut most = 0.0_f64;
            for i in 0..6 {
                for j in 0..6 {
                    let row = 12 * PLACES[i];
                    let value = SIGNS[i] * SIGNS[j] * own[row + PLACES[j]];
                    most =
                        most.max((value - flat[6 * i + j]).abs()).max(own[row + 2 * j + 1].abs());
                }
            }
            let name = format!("beam in the plane, {ends:?}: {name}");
            rows.bound(&name, most / largest(&flat), 1e-12);
        }
    }
    Ok(())
}

fn clamped_squares(rows: &mut Rows) -> Result<(), AnyError> {
    for pattern in [Pattern::Quadrilaterals, Pattern::Rising] {
        for (slenderness, name) in [(1e-2, "0.01"), (1e-4, "0.0001"), (1e-6, "1e-06")] {
            let thickness = 10.0 * slenderness;
            let mut plate = Surface::new(Material::new(200.0e9, 0.3, 8000.0)?, thickness);
            let nodes = plate.grid([8, 8], pattern, |x, y| [10.0 * x, 10.0 * y, 0.0])?;
            for (i, row) in nodes.iter().enumerate() {
                for (j, &node) in row.iter().enumerate() {
                    let is_edge = [i, j].iter().any(|&k| k == 0 || k == 8);
                    plate.scene.hold(node, if is_edge { &CLAMPED } else { &[X, Y, RZ] });
                }
            }
            let mut loads = Vec::new();
            for shell in &plate.shells {
                let forces = shell.pressure_forces(&plate.scene.points(shell.nodes()), 1.0)?;
                let own = shell.nodes().iter().zip(forces);
                loads.extend(own.map(|(&node, [.., force])| (node, Z, force)));
            }
            let rigidity = 200.0e9 * thickness.powi(3) / 12.0 / 0.91;
            let ratio = plate.scene.solve(&loads)(nodes[4][4], Z) * rigidity / (0.001_265_32 * 1e4);
            let test =
                format!("clamped square 8x8, t/L = {name}: w / thin closed form .00126532 q L^4/D");
            rows.put(&test, "", pattern.element(), ratio);
        }
    }
    Ok(())
}

pub(super) fn run(rows: &mut Rows) -> Result<(), AnyError> {
    patches(rows)?;
    rigid_motions(rows)?;
    renumbered(rows)?;
    in_the_plane(rows)?;
    clamped_squares(rows)
}
