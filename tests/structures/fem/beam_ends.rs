//! GOAL: forces at the ends of beams.
//! SCENE: cantilevers in any direction, a portal, columns with P–Δ, random frames with offsets, releases and links.
//! REFERENCE: statics by vectors, Kleinlogel's portal, the beam-column's closed form, the assembled stiffness, cuts.

use basemat::Error;
use basemat::fem::{Beam, BeamSection, Direction, Material, Mesh, SpaceBeam, Spring};
use basemat::structure::{BeamRows, FemModel, SectionRows, Structure};
use basemat_problems::dense::{multiply, noise, solve_held, stiffness};

const E: f64 = 30.0e9;

fn value(rows: &SectionRows, displacement: &[f64]) -> f64 {
    assert!(rows.velocity.is_empty() && rows.acceleration.is_empty());
    rows.displacement.value(displacement)
}

/// Force and moment vectors in x, y, z that a section with the outward normal along the beam has at an end.
fn vectors(rows: &BeamRows, end: usize, displacement: &[f64]) -> [[f64; 3]; 2] {
    let own = &rows.ends[end];
    let forces = [&own.axial, &own.shears[0], &own.shears[1]];
    let moments = [&own.torque, &own.moments[0], &own.moments[1]];
    [forces, moments].map(|parts| {
        let parts = parts.map(|row| value(row, displacement));
        [0, 1, 2].map(|axis| (0..3).map(|k| rows.axes[k][axis] * parts[k]).sum())
    })
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[track_caller]
fn near(found: f64, wanted: f64, scale: f64) {
    assert!((found - wanted).abs() < 1e-8 * scale, "{found} {wanted}");
}

#[test]
fn a_cantilever_in_the_plane_has_its_loads_moments() {
    for angle in [0.0, 0.4, 1.57, 2.9, -1.1_f64] {
        let tip = [5.0 * angle.cos(), 5.0 * angle.sin()];
        let mut mesh = Mesh::new();
        let [foot, other] = [[0.0, 0.0], [0.1, 0.0]].map(|[x, y]| mesh.add_node(x, y).unwrap());
        let end = mesh.add_node(tip[0], tip[1]).unwrap();
        let stub = Beam::new([foot, other], E, 0.4, 0.02, 0.0).unwrap();
        mesh.add(stub).unwrap();
        let beam = mesh.add(Beam::new([foot, end], E, 0.4, 0.02, 0.0).unwrap()).unwrap();
        let model = FemModel::new(mesh, &[foot, other]).unwrap();
        let mut load = vec![0.0; model.dofs()];
        let [x, y, turn] = [700.0, -300.0, 50.0];
        for (direction, value) in
            [(Direction::X, x), (Direction::Y, y), (Direction::Rotation, turn)]
        {
            load[model.dof(end, direction).unwrap()] = value;
        }
        let held: Vec<(usize, f64)> = (0..6).map(|index| (index, 0.0)).collect();
        let u = solve_held(&stiffness(&model), &load, &held);
        let rows = model.beam_rows(beam).unwrap();
        let (c, s) = (angle.cos(), angle.sin());
        for own in &rows.ends {
            near(value(&own.axial, &u), c * x + s * y, 1e3);
            near(value(&own.shears[0], &u), c * y - s * x, 1e3);
            assert!(own.shears[1].displacement.is_empty() && own.torque.displacement.is_empty());
            assert_eq!((own.axial.unit, own.moments[1].unit), ("N/m", "N·m/m"));
        }
        near(value(&rows.ends[1].moments[1], &u), turn, 1e3);
        near(value(&rows.ends[0].moments[1], &u), turn + tip[0] * y - tip[1] * x, 1e4);
    }
}

/// Kleinlogel, *Rahmenformeln*, frame 38: clamped feet, a force H at the beam's height.
#[test]
fn a_clamped_portal_has_kleinlogels_moments() {
    let (height, span, force) = (4.0, 6.0, 1000.0);
    let [column, girder] = [0.02, 0.05];
    let mut mesh = Mesh::new();
    let places = [[0.0, 0.0], [span, 0.0], [0.0, height], [span, height]];
    let nodes = places.map(|[x, y]| mesh.add_node(x, y).unwrap());
    // Hardly extensible.
    let mut add = |ends: [usize; 2], inertia| {
        mesh.add(Beam::new(ends, E, 1.0e6, inertia, 0.0).unwrap()).unwrap()
    };
    let left = add([nodes[0], nodes[2]], column);
    let right = add([nodes[1], nodes[3]], column);
    let top = add([nodes[2], nodes[3]], girder);
    let model = FemModel::new(mesh, &nodes[..2]).unwrap();
    let mut load = vec![0.0; model.dofs()];
    load[model.dof(nodes[2], Direction::X).unwrap()] = force;
    let held: Vec<(usize, f64)> = (0..6).map(|index| (index, 0.0)).collect();
    let u = solve_held(&stiffness(&model), &load, &held);
    let k = girder / column * height / span;
    let [foot, corner] =
        [3.0 * k + 1.0, 3.0 * k].map(|part| 0.5 * force * height * part / (6.0 * k + 1.0));
    let close = |found: f64, wanted: f64| {
        assert!((found / wanted - 1.0).abs() < 1e-4, "{found} {wanted}");
    };
    for element in [left, right] {
        let rows = model.beam_rows(element).unwrap();
        // x of a column is up, so that its y is to the left.
        close(value(&rows.ends[0].moments[1], &u), -foot);
        close(value(&rows.ends[1].moments[1], &u), corner);
        close(value(&rows.ends[0].shears[0], &u), -0.5 * force);
    }
    let rows = model.beam_rows(top).unwrap();
    close(value(&rows.ends[0].moments[1], &u), corner);
    close(value(&rows.ends[1].moments[1], &u), -corner);
    // The slope of the moment is minus the shear force.
    close(value(&rows.ends[0].shears[0], &u), 2.0 * corner / span);
    close(value(&model.beam_rows(left).unwrap().ends[0].axial, &u), 2.0 * corner / span);
}

/// Moment at the foot H tan(kL)/k with k² = P/EI; the force across the undeformed axis stays H.
#[test]
fn a_beam_column_has_the_moment_of_its_deformed_state() {
    let (length, inertia, load) = (8.0, 0.02, 1000.0);
    for compression in [2.0e7, -2.0e7_f64] {
        let mut mesh = Mesh::new();
        let count: usize = 20;
        for k in 0..=count {
            mesh.add_node(0.0, length * k as f64 / count as f64).unwrap();
        }
        for k in 0..count {
            let beam = Beam::new([k, k + 1], E, 0.4, inertia, 0.0).unwrap();
            mesh.add(beam.with_compression(compression).unwrap()).unwrap();
        }
        let other = mesh.add_node(1.0, 0.0).unwrap();
        mesh.add(Beam::new([0, other], E, 0.4, inertia, 0.0).unwrap()).unwrap();
        let model = FemModel::new(mesh, &[0, other]).unwrap();
        let n = model.dofs();
        let mut force = vec![0.0; n];
        force[model.dof(count, Direction::X).unwrap()] = load;
        let held = [0, 1, 2, n - 3, n - 2, n - 1].map(|k| (k, 0.0));
        let u = solve_held(&stiffness(&model), &force, &held);
        let k = (compression.abs() / (E * inertia)).sqrt();
        let curve = if compression > 0.0 { (k * length).tan() } else { (k * length).tanh() };
        let found = value(&model.beam_rows(0).unwrap().ends[0].moments[1], &u);
        assert!((found / (-load * curve / k) - 1.0).abs() < 1e-6, "{compression}: {found}");
        for element in 0..count {
            for own in model.beam_rows(element).unwrap().ends {
                near(value(&own.shears[0], &u), -load, 1e4);
            }
        }
    }
}

fn member(nodes: [usize; 2], orientation: [f64; 3]) -> SpaceBeam {
    let concrete = Material::new(E, 0.2, 2400.0).unwrap();
    let section = BeamSection::new(0.12, [1.6e-3, 0.9e-3], 1.94e-3).unwrap();
    SpaceBeam::new(nodes, concrete, section.with_shear_areas([0.1, 0.09]).unwrap(), orientation)
        .unwrap()
}

/// A square base on the ground that holds a mesh in space.
fn base(mesh: &mut Mesh) -> Vec<usize> {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let nodes: Vec<usize> =
        corners.iter().map(|&[x, y]| mesh.add_node_at([x, y, 0.0]).unwrap()).collect();
    for k in 0..4 {
        mesh.add(member([nodes[k], nodes[(k + 1) % 4]], [0.0, 0.0, 1.0])).unwrap();
    }
    nodes
}

#[test]
fn a_cantilever_in_space_has_its_loads_moments() {
    let offsets = [[0.2, -0.1, 0.3], [-0.3, 0.15, 0.1]];
    for (tip, orientation) in [
        ([0.0, 0.0, 4.0], [1.0, 0.0, 0.0]),
        ([3.0, -1.0, 2.5], [0.1, 0.2, 1.0]),
        ([-2.0, 1.5, 3.0], [0.0, 1.0, -0.4]),
    ] {
        let mut mesh = Mesh::in_space();
        let nodes = base(&mut mesh);
        let end = mesh.add_node_at(tip).unwrap();
        let beam = member([nodes[0], end], orientation).with_offsets(offsets).unwrap();
        let beam = mesh.add(beam).unwrap();
        let model = FemModel::on_faces(mesh, &[nodes]).unwrap();
        let [force, moment] = [[700.0, -300.0, 150.0], [50.0, 400.0, -250.0]];
        let mut load = vec![0.0; model.dofs()];
        for (k, &direction) in model.mesh().directions().iter().enumerate() {
            load[model.dof(end, direction).unwrap()] = [force, moment].concat()[k];
        }
        let held: Vec<(usize, f64)> = (0..24).map(|index| (index, 0.0)).collect();
        let u = solve_held(&stiffness(&model), &load, &held);
        let rows = model.beam_rows(beam).unwrap();
        for (index, from) in [[0.0; 3], tip].iter().enumerate() {
            let arm = [0, 1, 2].map(|k| tip[k] - from[k] - offsets[index][k]);
            let [found_force, found_moment] = vectors(&rows, index, &u);
            let about = cross(arm, force);
            for k in 0..3 {
                near(found_force[k], force[k], 1e4);
                near(found_moment[k], moment[k] + about[k], 1e4);
            }
        }
        assert_eq!((rows.ends[0].axial.unit, rows.ends[1].torque.unit), ("N", "N·m"));
    }
}

/// A frame of two storeys with offsets, a hinge, compressions, a diaphragm, a rigid body and a spring.
fn frame() -> FemModel {
    let mut mesh = Mesh::in_space();
    let feet = base(&mut mesh);
    let mut below = feet.clone();
    let mut floors = Vec::new();
    for (storey, height) in [3.0, 5.5].into_iter().enumerate() {
        let mut floor = Vec::new();
        for (k, &node) in below.iter().enumerate() {
            let [x, y, _] = mesh.nodes()[node];
            let top = mesh.add_node_at([x + 0.05 * k as f64, y, height]).unwrap();
            let mut beam = member([node, top], [1.0, 0.3, 0.0]);
            if k == 1 {
                beam = beam.with_offsets([[0.0, 0.1, 0.2], [0.1, 0.0, -0.3]]).unwrap();
            }
            if k == 2 {
                beam =
                    beam.with_releases(1, &[Direction::RotationY, Direction::RotationX]).unwrap();
            }
            beam = beam.with_compression(1.0e5 * (k as f64 + storey as f64)).unwrap();
            mesh.add(beam).unwrap();
            floor.push(top);
        }
        for k in 0..4 {
            mesh.add(member([floor[k], floor[(k + 1) % 4]], [0.0, 0.0, 1.0])).unwrap();
        }
        below.clone_from(&floor);
        floors.push(floor);
    }
    mesh.add(Spring::new([feet[0], floors[0][1]], Direction::Y, 3.0e6).unwrap()).unwrap();
    let model = FemModel::on_faces(mesh, &[feet]).unwrap();
    let model = model.with_rigid_diaphragm(floors[0][0], &floors[0][1..]).unwrap();
    model.with_rigid_link(floors[1][0], &floors[1][1..3]).unwrap()
}

/// Beams and springs hold every free node in equilibrium: their sum is the assembled stiffness times u.
#[test]
fn end_forces_add_up_to_the_stiffness_of_a_linked_frame() {
    let model = frame();
    let u: Vec<f64> = noise(model.dofs(), 7).iter().map(|value| 1e-3 * value).collect();
    let mut sum = vec![0.0; model.dofs()];
    let mut add = |node: usize, direction: Direction, force: f64| {
        for (dof, weight) in model.row(node, direction).unwrap() {
            sum[dof] += weight * force;
        }
    };
    let directions = model.mesh().directions();
    let mut beams = 0;
    for (element, own) in model.mesh().elements().enumerate() {
        let Ok(rows) = model.beam_rows(element) else { continue };
        beams += 1;
        let is_offset = element == 4 + 1 || element == 12 + 1;
        for end in 0..2 {
            let sign = [-1.0, 1.0][end];
            let [force, moment] = vectors(&rows, end, &u);
            let arm = [[[0.0, 0.1, 0.2], [0.1, 0.0, -0.3]][end], [0.0; 3]][usize::from(!is_offset)];
            let about = cross(arm, force);
            for k in 0..3 {
                add(own.nodes()[end], directions[k], sign * force[k]);
                add(own.nodes()[end], directions[k + 3], sign * (moment[k] + about[k]));
            }
        }
    }
    assert_eq!(beams, 20);
    let spring = model.mesh().elements().last().unwrap();
    let stretch = |k: usize| model.row(spring.nodes()[k], Direction::Y).unwrap().value(&u);
    let force = 3.0e6 * (stretch(1) - stretch(0));
    add(spring.nodes()[1], Direction::Y, force);
    add(spring.nodes()[0], Direction::Y, -force);
    let wanted = multiply(&stiffness(&model), &u);
    let scale = wanted.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    for (found, wanted) in sum.iter().zip(&wanted) {
        assert!((found - wanted).abs() < 1e-11 * scale, "{found} {wanted}");
    }
    // A hinged end has no moment; the forces of P–Δ act in the directions of the frame.
    let hinged = &model.beam_rows(4 + 2).unwrap().ends[1];
    for rows in [&hinged.torque, &hinged.moments[0]] {
        assert!(value(rows, &u).abs() < 1e-9 * scale);
    }
}

/// The ends at a height add up to the section of the model there.
#[test]
fn ends_add_up_to_the_section() {
    let model = frame();
    let u: Vec<f64> = noise(model.dofs(), 3).iter().map(|value| 1e-3 * value).collect();
    let section = model.section_in_space(0.0, [0.7, 0.4]).unwrap();
    let [mut force, mut moment] = [[0.0; 3]; 2];
    for element in 4..8 {
        let node = model.mesh().elements().nth(element).unwrap().nodes()[0];
        let offset = if element == 5 { [0.0, 0.1, 0.2] } else { [0.0; 3] };
        let place = model.mesh().nodes()[node];
        let arm = [place[0] - 0.7 + offset[0], place[1] - 0.4 + offset[1], offset[2]];
        let [own_force, own_moment] = vectors(&model.beam_rows(element).unwrap(), 0, &u);
        let about = cross(arm, own_force);
        for k in 0..3 {
            force[k] += own_force[k];
            moment[k] += own_moment[k] + about[k];
        }
    }
    // The spring stands on the foot, too.
    let spring = model.mesh().elements().last().unwrap().nodes();
    let stretch: Vec<f64> =
        spring.iter().map(|&node| model.row(node, Direction::Y).unwrap().value(&u)).collect();
    let pull = 3.0e6 * (stretch[1] - stretch[0]);
    force[1] += pull;
    moment[2] += pull * (0.0 - 0.7);
    let scale = moment.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let found = [
        &section.shear[0],
        &section.shear[1],
        &section.compression,
        &section.moments[0],
        &section.moments[1],
        &section.torque,
    ]
    .map(|rows| rows.displacement.value(&u));
    let wanted = [force[0], force[1], -force[2], moment[0], moment[1], moment[2]];
    for (found, wanted) in found.iter().zip(wanted) {
        assert!((found - wanted).abs() < 1e-10 * scale, "{found} {wanted}");
    }
}

#[test]
fn other_elements_are_refused() {
    let model = frame();
    let spring = model.mesh().elements().len() - 1;
    assert!(matches!(model.beam_rows(spring), Err(Error::Part { .. } | Error::Item { .. })));
    assert!(matches!(model.beam_rows(99), Err(Error::Index { .. })));
}
