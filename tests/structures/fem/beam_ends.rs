//! GOAL: forces at the ends of beams.
//! SCENE: cantilevers in any direction, a portal, columns with P–Δ, random frames with offsets, releases and links.
//! REFERENCE: statics by vectors, Kleinlogel's portal, the beam-column's closed form, the assembled stiffness, cuts.

use basemat::Error;
use basemat::fem::{
    Beam, BeamFormulation, BeamSection, Direction, Material, Mesh, SpaceBeam, Spring,
};
use basemat::structure::{BeamRows, FemModel, SectionRows, Structure};
use basemat_problems::dense::{multiply, noise, solve_with_prescribed, stiffness};
use basemat_problems::fiber_tables::FiberTable;

const YOUNG_MODULUS: f64 = 30.0e9;

fn value(rows: &SectionRows, displacement: &[f64]) -> f64 {
    assert!(rows.velocity.is_empty() && rows.acceleration.is_empty());
    rows.displacement.value(displacement)
}

/// Force and moment in x, y, z of a section with the outward normal along the beam.
struct EndForces {
    force: [f64; 3],
    moment: [f64; 3],
}

fn end_forces(rows: &BeamRows, end: usize, displacement: &[f64]) -> EndForces {
    let section = &rows.ends[end];
    let forces = [&section.axial, &section.shears[0], &section.shears[1]];
    let moments = [&section.torque, &section.moments[0], &section.moments[1]];
    let [force, moment] = [forces, moments].map(|parts| {
        let parts = parts.map(|row| value(row, displacement));
        [0, 1, 2].map(|axis| (0..3).map(|k| rows.axes[k][axis] * parts[k]).sum())
    });
    EndForces { force, moment }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[track_caller]
fn assert_near(found: f64, expected: f64, scale: f64) {
    assert!((found - expected).abs() < 1e-8 * scale, "{found} {expected}");
}

#[track_caller]
fn assert_near_by_ratio(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
}

/// Zero displacement of the first `count` degrees of freedom.
fn fixed_dofs(count: usize) -> Vec<(usize, f64)> {
    (0..count).map(|index| (index, 0.0)).collect()
}

#[test]
fn a_cantilever_in_the_plane_has_its_loads_moments() {
    for angle in [0.0, 0.4, 1.57, 2.9, -1.1_f64] {
        let tip = [5.0 * angle.cos(), 5.0 * angle.sin()];
        let mut mesh = Mesh::new();
        let foot = mesh.add_node(0.0, 0.0).unwrap();
        let other_node = mesh.add_node(0.1, 0.0).unwrap();
        let end = mesh.add_node(tip[0], tip[1]).unwrap();
        let stub = Beam::new([foot, other_node], YOUNG_MODULUS, 0.4, 0.02, 0.0).unwrap();
        mesh.add(stub).unwrap();
        let beam =
            mesh.add(Beam::new([foot, end], YOUNG_MODULUS, 0.4, 0.02, 0.0).unwrap()).unwrap();
        let model = FemModel::new(mesh, &[foot, other_node]).unwrap();
        let mut load = vec![0.0; model.dofs()];
        let x = 700.0;
        let y = -300.0;
        let turn = 50.0;
        for (direction, value) in
            [(Direction::X, x), (Direction::Y, y), (Direction::Rotation, turn)]
        {
            load[model.dof(end, direction).unwrap()] = value;
        }
        let u = solve_with_prescribed(&stiffness(&model), &load, &fixed_dofs(6));
        let rows = model.beam_rows(beam).unwrap();
        let c = angle.cos();
        let s = angle.sin();
        for section in &rows.ends {
            assert_near(value(&section.axial, &u), c * x + s * y, 1e3);
            assert_near(value(&section.shears[0], &u), c * y - s * x, 1e3);
            assert!(section.shears[1].displacement.is_empty());
            assert!(section.torque.displacement.is_empty());
            assert_eq!((section.axial.unit, section.moments[1].unit), ("N/m", "N·m/m"));
        }
        assert_near(value(&rows.ends[1].moments[1], &u), turn, 1e3);
        assert_near(value(&rows.ends[0].moments[1], &u), turn + tip[0] * y - tip[1] * x, 1e4);
    }
}

/// Adds a beam of the portal, which hardly changes its length.
fn add_portal_beam(mesh: &mut Mesh, ends: [usize; 2], inertia: f64) -> usize {
    mesh.add(Beam::new(ends, YOUNG_MODULUS, 1.0e6, inertia, 0.0).unwrap()).unwrap()
}

/// Kleinlogel, *Rahmenformeln*, frame 38: clamped feet, a force H at the beam's height.
#[test]
fn a_clamped_portal_has_kleinlogels_moments() {
    let height = 4.0;
    let span = 6.0;
    let force = 1000.0;
    let column = 0.02;
    let girder = 0.05;
    let mut mesh = Mesh::new();
    let places = [[0.0, 0.0], [span, 0.0], [0.0, height], [span, height]];
    let nodes = places.map(|[x, y]| mesh.add_node(x, y).unwrap());
    let left = add_portal_beam(&mut mesh, [nodes[0], nodes[2]], column);
    let right = add_portal_beam(&mut mesh, [nodes[1], nodes[3]], column);
    let top = add_portal_beam(&mut mesh, [nodes[2], nodes[3]], girder);
    let model = FemModel::new(mesh, &nodes[..2]).unwrap();
    let mut load = vec![0.0; model.dofs()];
    load[model.dof(nodes[2], Direction::X).unwrap()] = force;
    let u = solve_with_prescribed(&stiffness(&model), &load, &fixed_dofs(6));
    let k = girder / column * height / span;
    let foot = 0.5 * force * height * (3.0 * k + 1.0) / (6.0 * k + 1.0);
    let corner = 0.5 * force * height * (3.0 * k) / (6.0 * k + 1.0);
    for element in [left, right] {
        let rows = model.beam_rows(element).unwrap();
        // x of a column is up, so that its y is to the left.
        assert_near_by_ratio(value(&rows.ends[0].moments[1], &u), -foot);
        assert_near_by_ratio(value(&rows.ends[1].moments[1], &u), corner);
        assert_near_by_ratio(value(&rows.ends[0].shears[0], &u), -0.5 * force);
    }
    let rows = model.beam_rows(top).unwrap();
    assert_near_by_ratio(value(&rows.ends[0].moments[1], &u), corner);
    assert_near_by_ratio(value(&rows.ends[1].moments[1], &u), -corner);
    // The slope of the moment is minus the shear force.
    assert_near_by_ratio(value(&rows.ends[0].shears[0], &u), 2.0 * corner / span);
    assert_near_by_ratio(
        value(&model.beam_rows(left).unwrap().ends[0].axial, &u),
        2.0 * corner / span,
    );
}

/// Moment at the foot H tan(kL)/k with k² = P/EI; the force across the undeformed axis stays H.
#[test]
fn a_beam_column_has_the_moment_of_its_deformed_state() {
    let length = 8.0;
    let inertia = 0.02;
    let load = 1000.0;
    for compression in [2.0e7, -2.0e7_f64] {
        let mut mesh = Mesh::new();
        let count: usize = 20;
        for k in 0..=count {
            mesh.add_node(0.0, length * k as f64 / count as f64).unwrap();
        }
        for k in 0..count {
            let beam = Beam::new([k, k + 1], YOUNG_MODULUS, 0.4, inertia, 0.0).unwrap();
            mesh.add(beam.with_compression(compression).unwrap()).unwrap();
        }
        let other_node = mesh.add_node(1.0, 0.0).unwrap();
        mesh.add(Beam::new([0, other_node], YOUNG_MODULUS, 0.4, inertia, 0.0).unwrap())
            .unwrap();
        let model = FemModel::new(mesh, &[0, other_node]).unwrap();
        let n = model.dofs();
        let mut force = vec![0.0; n];
        force[model.dof(count, Direction::X).unwrap()] = load;
        let fixed = [0, 1, 2, n - 3, n - 2, n - 1].map(|k| (k, 0.0));
        let u = solve_with_prescribed(&stiffness(&model), &force, &fixed);
        let k = (compression.abs() / (YOUNG_MODULUS * inertia)).sqrt();
        let curve = if compression > 0.0 { (k * length).tan() } else { (k * length).tanh() };
        let computed = value(&model.beam_rows(0).unwrap().ends[0].moments[1], &u);
        assert!((computed / (-load * curve / k) - 1.0).abs() < 1e-6, "{compression}: {computed}");
        for element in 0..count {
            for section in model.beam_rows(element).unwrap().ends {
                assert_near(value(&section.shears[0], &u), -load, 1e4);
            }
        }
    }
}

fn member(nodes: [usize; 2], orientation: [f64; 3]) -> SpaceBeam {
    let concrete = Material::new(YOUNG_MODULUS, 0.2, 2400.0).unwrap();
    let section = BeamSection::new(0.12, [1.6e-3, 0.9e-3], 1.94e-3).unwrap();
    SpaceBeam::new(nodes, concrete, section.with_shear_areas([0.1, 0.09]).unwrap(), orientation)
        .unwrap()
}

/// A square base on the ground, to which a mesh in space is connected.
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
        let force = [700.0, -300.0, 150.0];
        let moment = [50.0, 400.0, -250.0];
        let mut load = vec![0.0; model.dofs()];
        for (k, &direction) in model.mesh().directions().iter().enumerate() {
            load[model.dof(end, direction).unwrap()] = [force, moment].concat()[k];
        }
        let u = solve_with_prescribed(&stiffness(&model), &load, &fixed_dofs(24));
        let rows = model.beam_rows(beam).unwrap();
        for (index, from) in [[0.0; 3], tip].iter().enumerate() {
            let arm = [0, 1, 2].map(|k| tip[k] - from[k] - offsets[index][k]);
            let computed = end_forces(&rows, index, &u);
            let about = cross(arm, force);
            for k in 0..3 {
                assert_near(computed.force[k], force[k], 1e4);
                assert_near(computed.moment[k], moment[k] + about[k], 1e4);
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
            let place = mesh.nodes()[node];
            let top = mesh.add_node_at([place[0] + 0.05 * k as f64, place[1], height]).unwrap();
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

/// Adds a force on a node to the forces on the degrees of freedom.
fn add_force(model: &FemModel, forces: &mut [f64], node: usize, direction: Direction, force: f64) {
    for (dof, weight) in model.row(node, direction).unwrap() {
        forces[dof] += weight * force;
    }
}

/// Elongation of the spring of the frame.
fn spring_stretch(model: &FemModel, u: &[f64]) -> f64 {
    let nodes = model.mesh().elements().last().unwrap().nodes();
    let displacements = [0, 1].map(|k| model.row(nodes[k], Direction::Y).unwrap().value(u));
    displacements[1] - displacements[0]
}

/// Beams and springs balance the forces on every free node: their sum is the assembled stiffness times u.
#[test]
fn end_forces_add_up_to_the_stiffness_of_a_linked_frame() {
    let model = frame();
    let u: Vec<f64> = noise(model.dofs(), 7).iter().map(|value| 1e-3 * value).collect();
    let mut sum = vec![0.0; model.dofs()];
    let directions = model.mesh().directions();
    let mut beams = 0;
    for (element, beam) in model.mesh().elements().enumerate() {
        let Ok(rows) = model.beam_rows(element) else { continue };
        beams += 1;
        let is_offset = element == 4 + 1 || element == 12 + 1;
        for end in 0..2 {
            let sign = [-1.0, 1.0][end];
            let EndForces { force, moment } = end_forces(&rows, end, &u);
            let arm = [[[0.0, 0.1, 0.2], [0.1, 0.0, -0.3]][end], [0.0; 3]][usize::from(!is_offset)];
            let about = cross(arm, force);
            for k in 0..3 {
                let node = beam.nodes()[end];
                add_force(&model, &mut sum, node, directions[k], sign * force[k]);
                let moment = sign * (moment[k] + about[k]);
                add_force(&model, &mut sum, node, directions[k + 3], moment);
            }
        }
    }
    assert_eq!(beams, 20);
    let spring = model.mesh().elements().last().unwrap().nodes();
    let force = 3.0e6 * spring_stretch(&model, &u);
    add_force(&model, &mut sum, spring[1], Direction::Y, force);
    add_force(&model, &mut sum, spring[0], Direction::Y, -force);
    let expected = multiply(&stiffness(&model), &u);
    let scale = expected.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    for (found, expected) in sum.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-11 * scale, "{found} {expected}");
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
    let mut force = [0.0; 3];
    let mut moment = [0.0; 3];
    for element in 4..8 {
        let node = model.mesh().elements().nth(element).unwrap().nodes()[0];
        let offset = if element == 5 { [0.0, 0.1, 0.2] } else { [0.0; 3] };
        let place = model.mesh().nodes()[node];
        let arm = [place[0] - 0.7 + offset[0], place[1] - 0.4 + offset[1], offset[2]];
        let end = end_forces(&model.beam_rows(element).unwrap(), 0, &u);
        let about = cross(arm, end.force);
        for k in 0..3 {
            force[k] += end.force[k];
            moment[k] += end.moment[k] + about[k];
        }
    }
    // The spring stands on the foot, too.
    let pull = 3.0e6 * spring_stretch(&model, &u);
    force[1] += pull;
    moment[2] += pull * (0.0 - 0.7);
    let scale = moment.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let computed = [
        &section.shear[0],
        &section.shear[1],
        &section.compression,
        &section.moments[0],
        &section.moments[1],
        &section.torque,
    ]
    .map(|rows| rows.displacement.value(&u));
    let expected = [force[0], force[1], -force[2], moment[0], moment[1], moment[2]];
    for (computed, expected) in computed.iter().zip(expected) {
        assert!((computed - expected).abs() < 1e-10 * scale, "{computed} {expected}");
    }
}

#[test]
fn other_elements_are_errors() {
    let model = frame();
    let spring = model.mesh().elements().len() - 1;
    assert!(matches!(model.beam_rows(spring), Err(Error::Part { .. } | Error::Item { .. })));
    assert!(matches!(model.beam_rows(99), Err(Error::Index { .. })));
}

/// Forces of beams of fibres are no rows; the error names the method that returns them.
#[test]
fn beams_of_fibres_have_sections_in_place_of_rows() {
    let model = FiberTable::of_steel(BeamFormulation::ForceBased).unwrap().model().unwrap().model;
    let column = model.inelastic_elements().next().unwrap();
    let text = model.beam_rows(column).unwrap_err().to_string();
    assert!(text.contains("beam_sections"), "{text}");
    let sections = model.beam_sections(column).unwrap();
    assert_eq!(sections.len(), 5);
    assert!(sections.iter().all(|section| section.fibers.len() == 48 && section.moment == 0.0));
}
