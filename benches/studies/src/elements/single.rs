//! Single elements and patches: uniform states, rigid motions, renumbered nodes, the beam of the plane.

use basemat::fem::{Beam, Element, Hex8, MassKind, Material, Shell, SpaceBeam};
use basemat_problems::bricks::DISTORTED_BRICK;
use basemat_problems::dense::{eigenpairs, largest};
use basemat_problems::patch::{PATCH_NODES, PATCH_QUADS, SHELL_STATES, bricks, field};
use basemat_problems::space_beams::{concrete, section_with_shear};
use basemat_problems::supported::{
    CLAMPED_DIRECTIONS, ElementMatrix, RZ, SupportedMesh, X, Y, Z, rigid_motion, values,
};

use super::row::BenchmarkRows;
use super::surface::{ShellPattern, ShellSurface};
use crate::AnyError;

/// Largest displacement of inner nodes from a uniform `state`, relative to the largest displacement of all.
///
/// The nodes before `inner` are restrained in this state.
fn patch_error(mut scene: SupportedMesh, inner_node: usize, state: &[[f64; 6]]) -> f64 {
    let mut loads = Vec::new();
    let mut forces = vec![[0.0; 6]; state.len()];
    for element in scene.mesh.elements() {
        let displacement = values(element, state);
        let matrix = ElementMatrix::Stiffness.of(element, &scene.points(element.nodes()));
        let places = element
            .nodes()
            .iter()
            .flat_map(|&node| element.directions().iter().map(move |&direction| (node, direction)));
        for ((node, direction), row) in places.zip(matrix.chunks(displacement.len())) {
            let place =
                CLAMPED_DIRECTIONS.iter().position(|&other| other == direction).unwrap_or(0);
            forces[node][place] -= row.iter().zip(&displacement).map(|(k, u)| k * u).sum::<f64>();
        }
    }
    for (node, forces) in forces.iter().enumerate() {
        if node < inner_node {
            scene.fix(node, &CLAMPED_DIRECTIONS);
        }
        loads.extend(
            CLAMPED_DIRECTIONS
                .into_iter()
                .zip(forces)
                .map(|(direction, &f)| (node, direction, f)),
        );
    }
    let displacements = scene.displacements(&loads);
    largest(displacements.as_flattened()) / largest(state.as_flattened())
}

fn patches(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    for pattern in [ShellPattern::Quadrilaterals, ShellPattern::Rising] {
        for thickness in [0.001, 0.05] {
            for name in SHELL_STATES {
                let mut patch = ShellSurface::new(Material::new(1.0e6, 0.25, 1.0)?, thickness);
                for [x, y] in PATCH_NODES {
                    patch.scene.node([x, y, 0.0]);
                }
                for corners in PATCH_QUADS.into_iter().flat_map(|cell| pattern.split(cell)) {
                    patch.shell(&corners, thickness)?;
                }
                let state = PATCH_NODES.map(|[x, y]| field(name, x, y));
                let error = patch_error(patch.scene, 4, &state);
                let case = format!("t/size={:.3}", thickness / 0.24);
                rows.bound(&format!("patch {name} {} {case}", pattern.element()), error, 1e-9);
            }
        }
    }
    let material = Material::new(1.0e6, 0.25, 1.0)?;
    let scene = bricks(material);
    let mut state: Vec<[f64; 6]> = Vec::new();
    for [x, y, z] in scene.mesh.nodes() {
        state.push([x + 0.5 * (y + z), y + 0.5 * (x + z), z + 0.5 * (x + y), 0.0, 0.0, 0.0]);
    }
    let error = patch_error(scene, 8, &state);
    rows.bound("patch of seven distorted bricks", error, 1e-9);
    Ok(())
}

/// Name of an element, the element, and the coordinates of its nodes.
type ElementSample = (&'static str, Box<dyn Element>, Vec<[f64; 3]>);

fn samples() -> Result<Vec<ElementSample>, AnyError> {
    let concrete = concrete();
    let quads = [
        ("Shell4 flat", [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], [0.0; 4]),
        ("Shell4 distorted", [[0.0, 0.0], [2.0, 0.1], [2.2, 1.5], [-0.2, 1.3]], [0.0; 4]),
        ("Shell4 warped", [[0.0, 0.0], [2.0, 0.1], [2.2, 1.5], [-0.2, 1.3]], [0.0, 0.2, -0.1, 0.3]),
    ];
    let mut samples: Vec<ElementSample> = Vec::new();
    for (name, plan, heights) in quads {
        let points = plan.iter().zip(heights).map(|(&[x, y], z)| [x, y, z]).collect();
        samples.push((name, Box::new(Shell::new([0, 1, 2, 3], concrete, 0.2)?), points));
    }
    let triangle = vec![[5.0, 1.0, 2.0], [5.0, 3.0, 2.0], [4.2, 2.4, 3.6]];
    samples.push(("Shell3", Box::new(Shell::new([0, 1, 2], concrete, 0.2)?), triangle));
    let brick = DISTORTED_BRICK.to_vec();
    samples.push((
        "Hex8 distorted",
        Box::new(Hex8::new([0, 1, 2, 3, 4, 5, 6, 7], concrete)),
        brick,
    ));
    let beam = SpaceBeam::new([0, 1], concrete, section_with_shear(), [1.0, 1.0, 0.2])?
        .with_offsets([[0.3, -0.2, 0.4], [0.1, 0.5, -0.3]])?;
    samples.push((
        "SpaceBeam with offsets",
        Box::new(beam),
        vec![[1.0, 2.0, 0.0], [2.5, 1.0, 3.0]],
    ));
    Ok(samples)
}

fn rigid_motions(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    for (name, element, points) in samples()? {
        let order = element.order();
        let matrix = ElementMatrix::Stiffness.of(&*element, &points);
        let scale = largest(&matrix);
        for motion in 0..6 {
            let state: Vec<[f64; 6]> =
                points.iter().map(|&point| rigid_motion(motion, point)).collect();
            let displacement = values(&*element, &state);
            let mut largest_force = 0.0_f64;
            for row in matrix.chunks(order) {
                let force: f64 = row.iter().zip(&displacement).map(|(k, u)| k * u).sum();
                largest_force = largest_force.max(force.abs());
            }
            rows.bound(&format!("rigid motion {motion}, {name}"), largest_force / scale, 1e-12);
        }
        let square: Vec<Vec<f64>> = matrix.chunks(order).map(<[f64]>::to_vec).collect();
        let eigenvalues = eigenpairs(&square).0;
        let greatest = eigenvalues[order - 1];
        let sixth = largest(&eigenvalues[..6]);
        rows.bound(&format!("sixth eigenvalue, {name}"), sixth / greatest, 1e-13);
        // The other eigenvalues are not near zero.
        let condition = greatest / eigenvalues[6];
        rows.bound(&format!("largest over seventh eigenvalue, {name}"), condition, 1e6);
    }
    Ok(())
}

fn renumbered(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
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
        let matrix = ElementMatrix::Stiffness.of(&*element, &points);
        for &places in orders {
            let listed_places: Vec<[f64; 3]> = places.iter().map(|&place| points[place]).collect();
            let computed = ElementMatrix::Stiffness.of(&*element, &listed_places);
            let dofs: Vec<usize> =
                (0..order).map(|dof| size * places[dof / size] + dof % size).collect();
            let mut difference = 0.0_f64;
            for row in 0..order {
                for column in 0..order {
                    let reference = matrix[dofs[row] * order + dofs[column]];
                    difference = difference.max((computed[row * order + column] - reference).abs());
                }
            }
            let error = difference / largest(&matrix);
            rows.bound(&format!("renumbered {places:?}, {name}"), error, 1e-12);
        }
    }
    Ok(())
}

/// Bounds the largest difference of beams in the plane x–z from the beam of the plane, relative to the largest entry.
fn in_the_plane(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    const PLANE_DOFS: [usize; 6] = [0, 2, 4, 6, 8, 10];
    const PLANE_SIGNS: [f64; 6] = [1.0, 1.0, -1.0, 1.0, 1.0, -1.0];
    for ends in [[[0.0, 0.0], [0.0, 4.0]], [[1.0, -2.0], [4.5, 1.0]], [[0.0, 0.0], [3.0, -0.7]]] {
        let plane_beam = Beam::new([0, 1], 30.0e9, 0.12, 1.6e-3, 2500.0)?
            .with_shear_stiffness(12.5e9 * 0.1)?
            .with_rotary_inertia();
        let beam = SpaceBeam::new([0, 1], concrete(), section_with_shear(), [0.0, 1.0, 0.0])?
            .with_rotary_inertia();
        let displacement = [1e-3, 2e-3, 1e-3, -2e-3, -1e-3, 3e-3];
        let mut in_space = [0.0; 12];
        for k in 0..6 {
            in_space[PLANE_DOFS[k]] = PLANE_SIGNS[k] * displacement[k];
        }
        let flat_points = ends.map(|[x, z]| [x, z, 0.0]);
        let points = ends.map(|[x, z]| [x, 0.0, z]);
        let missing_beam = "a beam with an axial force";
        let plane_beam =
            plane_beam.in_static_state(&flat_points, &displacement, 50.0).ok_or(missing_beam)?;
        let beam = beam.in_static_state(&points, &in_space, 50.0).ok_or(missing_beam)?;
        for (name, part) in [
            ("stiffness", ElementMatrix::Stiffness),
            ("geometric stiffness", ElementMatrix::GeometricStiffness),
            ("mass", ElementMatrix::Mass(MassKind::Consistent)),
            ("lumped mass", ElementMatrix::Mass(MassKind::Lumped)),
        ] {
            let plane_matrix = part.of(&*plane_beam, &flat_points);
            let space_matrix = part.of(&*beam, &points);
            let mut difference = 0.0_f64;
            for i in 0..6 {
                for j in 0..6 {
                    let row = 12 * PLANE_DOFS[i];
                    let value = PLANE_SIGNS[i] * PLANE_SIGNS[j] * space_matrix[row + PLANE_DOFS[j]];
                    let out_of_plane = space_matrix[row + 2 * j + 1];
                    difference = difference.max((value - plane_matrix[6 * i + j]).abs());
                    difference = difference.max(out_of_plane.abs());
                }
            }
            let name = format!("beam in the plane, {ends:?}: {name}");
            rows.bound(&name, difference / largest(&plane_matrix), 1e-12);
        }
    }
    Ok(())
}

fn clamped_squares(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    for pattern in [ShellPattern::Quadrilaterals, ShellPattern::Rising] {
        for (slenderness, name) in [(1e-2, "0.01"), (1e-4, "0.0001"), (1e-6, "1e-06")] {
            let thickness = 10.0 * slenderness;
            let mut plate = ShellSurface::new(Material::new(200.0e9, 0.3, 8000.0)?, thickness);
            let nodes = plate.grid([8, 8], pattern, |x, y| [10.0 * x, 10.0 * y, 0.0])?;
            for (i, row) in nodes.iter().enumerate() {
                for (j, &node) in row.iter().enumerate() {
                    let is_edge = [i, j].iter().any(|&k| k == 0 || k == 8);
                    plate.scene.fix(node, if is_edge { &CLAMPED_DIRECTIONS } else { &[X, Y, RZ] });
                }
            }
            let mut loads = Vec::new();
            for shell in &plate.shells {
                let forces = shell.pressure_forces(&plate.scene.points(shell.nodes()), 1.0)?;
                let nodes_and_forces = shell.nodes().iter().zip(forces);
                loads.extend(nodes_and_forces.map(|(&node, [.., force])| (node, Z, force)));
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

pub(super) fn run(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    patches(rows)?;
    rigid_motions(rows)?;
    renumbered(rows)?;
    in_the_plane(rows)?;
    clamped_squares(rows)
}
