//! GOAL: forces at rest turn with the structure: P–Δ meets no rotation about the vertical, overturns by the weights,
//! and has the effects of shear forces and moments.
//! SCENE: random frames with offsets, releases, braces, links and diaphragms; walls, bricks; cantilevers.
//! REFERENCE: statics, Euler, Prandtl 1899.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::GravityStage;
use basemat::fem::{
    BeamSection, Direction, Hex8, LumpedMass, MassKind, Material, Mesh, Shell, SpaceBeam, Spring,
    Truss,
};
use basemat::interface::Coulomb;
use basemat::structure::FemModel;
use basemat_problems::dense::{form, largest, mass, multiply, stiffness};
use basemat_problems::random::Random;

const GRAVITY_ACCELERATION: f64 = 9.81;
const TRANSLATION_DIRECTIONS: [Direction; 3] = [Direction::X, Direction::Y, Direction::Z];
const ROTATION_DIRECTIONS: [Direction; 3] =
    [Direction::RotationX, Direction::RotationY, Direction::RotationZ];

fn concrete() -> Material {
    Material::new(30e9, 0.2, 2500.0).unwrap()
}

/// Rigid motions of a structure in space with P–Δ, about a point at the height of its base.
///
/// Translations and the rotation about the vertical meet no force, the others the moment of the weights.
fn assert_rotates(model: &FemModel, point: [f64; 3], scene: &str) {
    let stiffness = stiffness(model);
    let mass = mass(model);
    let translations = TRANSLATION_DIRECTIONS.map(|direction| model.rigid_motion(direction, point));
    let rotations = ROTATION_DIRECTIONS.map(|direction| model.rigid_motion(direction, point));
    let weight = GRAVITY_ACCELERATION * form(&translations[2], &mass, &translations[2]);
    let height = form(&translations[0], &mass, &rotations[1])
        / form(&translations[0], &mass, &translations[0]);
    let scale = weight * height.max(1.0);
    let max_stiffness = stiffness.iter().map(|row| largest(row)).fold(0.0, f64::max);
    let rounding = 1e-9 * scale + 1e-13 * max_stiffness;
    for motion in translations.iter().chain([&rotations[2]]) {
        let force = largest(&multiply(&stiffness, motion));
        assert!(force < rounding, "{scene}: {:.3e} of the weight", force / weight);
    }
    for a in 0..3 {
        for b in 0..3 {
            let expected = if a == b && a < 2 { -weight * height } else { 0.0 };
            let computed = form(&rotations[a], &stiffness, &rotations[b]);
            let error = (computed - expected).abs();
            assert!(error < 10.0 * rounding, "{scene}: {a} {b} {computed} {expected}");
        }
    }
}

fn section(side: f64) -> BeamSection {
    BeamSection::new(side * side, [side.powi(4) / 12.0; 2], 0.14 * side.powi(4)).unwrap()
}

/// Two storeys of columns, beams and braces on a raft; everything differs, nothing is symmetric.
fn frame(random: &mut Random) -> FemModel {
    let mut mesh = Mesh::in_space();
    let raft = mesh
        .add_grid(3, 3, |row, column| [6.0 * (column as f64 - 1.0), 4.0 * (row as f64 - 1.0), 0.0])
        .unwrap();
    for (_, nodes) in raft.cells() {
        mesh.add(Shell::new(nodes, concrete(), 1.0).unwrap()).unwrap();
    }
    let mut feet = [raft.row(0)[0], raft.row(0)[2], raft.row(2)[2], raft.row(2)[0]];
    let mut floors = Vec::new();
    for storey in 0..2 {
        let tops = feet.map(|foot| {
            let place = mesh.nodes()[foot];
            let aside = random.within(-0.4, 0.4);
            let height = 4.0 * f64::from(storey + 1);
            mesh.add_node_at([place[0] + aside, place[1] - 0.5 * aside, height]).unwrap()
        });
        for k in 0..4 {
            let side = section(random.within(0.4, 0.8));
            let mut column =
                SpaceBeam::new([feet[k], tops[k]], concrete(), side, [1.0, 0.3, 0.0]).unwrap();
            if random.chance(0.4) {
                let offsets = [[0.2, random.within(-0.3, 0.3), 0.0], [0.0, 0.1, -0.3]];
                column = column.with_offsets(offsets).unwrap();
            }
            if random.chance(0.2) {
                column =
                    column.with_releases(1, &[Direction::RotationY, Direction::RotationZ]).unwrap();
            }
            mesh.add(column).unwrap();
            let depth = random.within(0.4, 0.7);
            let beam = BeamSection::new(
                0.3 * depth,
                [0.3 * depth.powi(3) / 12.0, depth * 0.3_f64.powi(3) / 12.0],
                0.0037,
            );
            let ends = [tops[k], tops[(k + 1) % 4]];
            let beam = SpaceBeam::new(ends, concrete(), beam.unwrap(), [0.0, 0.0, 1.0]).unwrap();
            mesh.add(beam).unwrap();
            let inertia = if random.chance(0.3) { [1e4, 2e4, 3e4] } else { [0.0; 3] };
            let floor = random.log_within(10e3, 100e3);
            mesh.add(LumpedMass::in_space(tops[k], floor, inertia).unwrap()).unwrap();
        }
        let brace = [feet[0], tops[1]];
        match random.pick(&[0, 1, 2]) {
            0 => drop(mesh.add(Truss::in_space(brace, 200e9, 4e-3, 7850.0).unwrap()).unwrap()),
            1 => drop(mesh.add(Spring::axial_in_space(brace, 2e8).unwrap()).unwrap()),
            _ => (),
        }
        floors.push(tops);
        feet = tops;
    }
    let kind = random.pick(&[MassKind::Consistent, MassKind::Lumped]);
    let model = FemModel::on_base(mesh).unwrap().with_mass(kind);
    let lower = floors[0];
    let upper = floors[1];
    let model = if random.chance(0.4) {
        model.with_rigid_link(lower[0], &lower[1..]).unwrap()
    } else {
        model
    };
    if random.chance(0.4) {
        model.with_rigid_diaphragm(upper[0], &upper[1..]).unwrap()
    } else {
        model
    }
}

/// If the axial forces alone turned, r_zᵀ K r_z of such frames would be as much as −3e5 N·m.
#[test]
fn a_rotation_of_a_frame_about_the_vertical_meets_no_force() {
    for number in 0..60 {
        let model = frame(&mut Random(71 + number)).with_p_delta(GRAVITY_ACCELERATION).unwrap();
        assert_rotates(&model, [0.0, 0.0, -0.5], &format!("frame {number}"));
    }
}

/// Frames come to rest on a ground without friction, which carries no torque.
#[test]
fn frames_stand_without_friction() {
    for number in 0..10 {
        for stage in [GravityStage::Frictionless, GravityStage::Frictional] {
            let model = frame(&mut Random(71 + number)).with_p_delta(GRAVITY_ACCELERATION).unwrap();
            let ground = SpringGround::under(&model, 6, 5e7, 4e7).unwrap();
            let result = Simulation::builder(0.005)
                .gravity(GRAVITY_ACCELERATION)
                .gravity_stage(stage)
                .ground(ground.with_dashpots(4e5, 3e5).unwrap())
                .structure(model)
                .interface(Coulomb::new(0.0).unwrap())
                .build();
            assert!(result.is_ok(), "{number}: {}", result.err().unwrap());
        }
    }
}

/// A frame on a rigid basemat: the contact nodes follow a node 0.7 m above them.
#[test]
fn a_frame_on_a_rigid_basemat_rotates_freely() {
    let mut mesh = Mesh::in_space();
    let corners = [[-3.0, -2.0], [3.0, -2.0], [3.0, 2.0], [-3.0, 2.0]]
        .map(|[x, y]| mesh.add_node_at([x, y, 0.0]).unwrap());
    let leader = mesh.add_node_at([0.4, 0.2, 0.7]).unwrap();
    mesh.add(LumpedMass::in_space(leader, 50e3, [1e4; 3]).unwrap()).unwrap();
    let mut tops = Vec::new();
    for (k, &corner) in corners.iter().enumerate() {
        mesh.add(LumpedMass::in_space(corner, 5e3, [1.0; 3]).unwrap()).unwrap();
        let place = mesh.nodes()[corner];
        let top = mesh.add_node_at([0.8 * place[0], 0.7 * place[1], 5.0]).unwrap();
        let column = section(0.3 + 0.1 * k as f64);
        mesh.add(SpaceBeam::new([corner, top], concrete(), column, [1.0, 0.0, 0.0]).unwrap())
            .unwrap();
        mesh.add(LumpedMass::in_space(top, 30e3, [0.0; 3]).unwrap()).unwrap();
        tops.push(top);
    }
    for k in 0..4 {
        let ends = [tops[k], tops[(k + 1) % 4]];
        let beam = SpaceBeam::new(ends, concrete(), section(0.4), [0.0, 0.0, 1.0]).unwrap();
        mesh.add(beam).unwrap();
    }
    let model = FemModel::on_faces(mesh, &[corners.to_vec()]).unwrap();
    let model = model
        .with_rigid_link(leader, &corners)
        .unwrap()
        .with_p_delta(GRAVITY_ACCELERATION)
        .unwrap();
    assert_rotates(&model, [0.0; 3], "rigid basemat");
}

/// A tower of bricks and one of shells, bent by an eccentric mass.
fn solids() -> [FemModel; 2] {
    let mut mesh = Mesh::in_space();
    let foot = mesh.add_grid(3, 2, |row, column| [column as f64, row as f64, 0.0]).unwrap();
    for brick in foot.extrude(&mut mesh, &[1.5, 3.0, 4.5, 6.0]).unwrap() {
        mesh.add(Hex8::new(brick, concrete())).unwrap();
    }
    let top = mesh.node_at_point([1.0, 2.0, 6.0]).unwrap();
    mesh.add(LumpedMass::in_space(top, 80e3, [0.0; 3]).unwrap()).unwrap();
    let bricks = FemModel::on_base(mesh).unwrap();
    let mut mesh = Mesh::in_space();
    let raft = mesh.add_grid(3, 4, |row, column| [2.0 * column as f64, 2.0 * row as f64, 0.0]);
    let raft = raft.unwrap();
    for (_, nodes) in raft.cells() {
        mesh.add(Shell::new(nodes, concrete(), 0.8).unwrap()).unwrap();
    }
    let mut row = raft.row(1).to_vec();
    for level in 1..4_usize {
        let next_nodes: Vec<usize> = row
            .iter()
            .map(|&node| {
                let place = mesh.nodes()[node];
                let level = level as f64;
                mesh.add_node_at([place[0], place[1] + 0.1 * level, 1.5 * level]).unwrap()
            })
            .collect();
        for k in 0..row.len() - 1 {
            let nodes = [row[k], row[k + 1], next_nodes[k + 1], next_nodes[k]];
            if (k + level).is_multiple_of(2) {
                mesh.add(Shell::new(nodes, concrete(), 0.3).unwrap()).unwrap();
            } else {
                for corners in [[nodes[0], nodes[1], nodes[2]], [nodes[0], nodes[2], nodes[3]]] {
                    mesh.add(Shell::new(corners, concrete(), 0.3).unwrap()).unwrap();
                }
            }
        }
        row = next_nodes;
    }
    mesh.add(LumpedMass::in_space(row[0], 60e3, [0.0; 3]).unwrap()).unwrap();
    [bricks, FemModel::on_base(mesh).unwrap()]
}

#[test]
fn bricks_and_shells_rotate_with_their_forces() {
    for (model, depth, name) in solids()
        .into_iter()
        .zip([0.0, 0.4])
        .zip(["bricks", "shells"])
        .map(|((model, depth), name)| (model, depth, name))
    {
        let model = model.with_p_delta(GRAVITY_ACCELERATION).unwrap();
        assert_rotates(&model, [1.0, 1.0, -depth], name);
    }
}

/// PROBLEM: a light column of bricks with a mass on it. RESULT: Euler's π²EI/(4 L²), from above with the square of the
/// bricks' height.
#[test]
fn a_column_of_bricks_buckles_as_euler_says() {
    let length = 12.0_f64;
    let side = 0.5_f64;
    let light_material = Material::new(30e9, 0.0, 1e-3).unwrap();
    let euler = std::f64::consts::PI.powi(2) * 30e9 * side.powi(4) / 12.0 / (4.0 * length * length);
    let errors = [6, 12].map(|count| {
        let mut mesh = Mesh::in_space();
        let foot =
            mesh.add_grid(2, 2, |row, column| [side * column as f64, side * row as f64, 0.0]);
        let heights: Vec<f64> =
            (1..=count).map(|k| length * f64::from(k) / f64::from(count)).collect();
        for brick in foot.unwrap().extrude(&mut mesh, &heights).unwrap() {
            mesh.add(Hex8::new(brick, light_material)).unwrap();
        }
        for node in mesh.nodes_at_height(length, 1e-6).unwrap() {
            mesh.add(LumpedMass::in_space(node, 1e3, [0.0; 3]).unwrap()).unwrap();
        }
        let model = FemModel::on_base(mesh).unwrap().with_p_delta(GRAVITY_ACCELERATION).unwrap();
        model.buckling_factor().unwrap() * 4e3 * GRAVITY_ACCELERATION / euler - 1.0
    });
    println!("{errors:?}");
    assert!(errors[1].abs() < 0.01, "{errors:?}");
}

/// PROBLEM: a narrow cantilever with a mass at its tip twists and bends sideways at 4.0126 √(EI GJ)/L² (Prandtl 1899;
/// Timoshenko & Gere, Theory of Elastic Stability, eq. 6-24): without axial forces.
#[test]
fn a_narrow_cantilever_buckles_sideways() {
    let length = 5.0;
    let mass = 100.0;
    let lateral = 2.0e-7;
    let torsion = 6.0e-7;
    let light_material = Material::new(200e9, 0.25, 1e-6).unwrap();
    let expected = 4.0126 * 200e9 * (lateral * torsion / 2.5_f64).sqrt() / (length * length);
    let errors = [8, 16].map(|count| {
        let mut mesh = Mesh::in_space();
        let foot = mesh.add_grid(2, 2, |row, column| [column as f64, row as f64, 0.0]).unwrap();
        for brick in foot.extrude(&mut mesh, &[1.0]).unwrap() {
            mesh.add(Hex8::new(brick, light_material)).unwrap();
        }
        let root = mesh.add_node_at([0.5, 0.5, 0.0]).unwrap();
        let mut end_node = root;
        for k in 1..=count {
            let next_node =
                mesh.add_node_at([0.5 + length * f64::from(k) / f64::from(count), 0.5, 0.0]);
            let next_node = next_node.unwrap();
            // Much stiffer in the vertical plane.
            let section = BeamSection::new(1e-2, [lateral * 1e4, lateral], torsion).unwrap();
            let beam =
                SpaceBeam::new([end_node, next_node], light_material, section, [0.0, 1.0, 0.0])
                    .unwrap();
            mesh.add(beam).unwrap();
            end_node = next_node;
        }
        mesh.add(LumpedMass::in_space(end_node, mass, [0.0; 3]).unwrap()).unwrap();
        let leader = mesh.node_at_point([0.0; 3]).unwrap();
        mesh.add(LumpedMass::in_space(leader, 1.0, [1.0; 3]).unwrap()).unwrap();
        let corners: Vec<usize> = mesh
            .nodes_at_height(0.0, 1e-6)
            .unwrap()
            .into_iter()
            .filter(|&node| {
                let place = mesh.nodes()[node];
                node != leader && place[0] <= 1.0 && (place[1] - 0.5).abs() > 0.4
            })
            .chain([root])
            .collect();
        let model = FemModel::on_base(mesh).unwrap().with_rigid_link(leader, &corners).unwrap();
        let model = model.with_p_delta(GRAVITY_ACCELERATION).unwrap();
        model.buckling_factor().unwrap() * mass * GRAVITY_ACCELERATION / expected - 1.0
    });
    println!("{errors:?}");
    assert!(errors[1].abs() < 0.01 && errors[1].abs() < 0.4 * errors[0].abs(), "{errors:?}");
}
