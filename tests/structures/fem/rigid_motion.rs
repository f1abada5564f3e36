//! GOAL: rigid motions meet no force and carry the inertia of the whole.
//! SCENE: one of every element in a distorted mesh.
//! REFERENCE: total mass, and closed-form rotary inertia.

use basemat::fem::{
    Beam, Dashpot, Direction, Layer, LumpedMass, MassKind, Material, Mesh, Quad4, QuadFormulation,
    Spring, Truss,
};
use basemat::structure::{FemModel, RayleighDamping};
use basemat_problems::dense::{
    assert_symmetric, damping, form, largest, mass, multiply, noise, stiffness,
};

const PLANE_DIRECTIONS: [Direction; 3] = [Direction::X, Direction::Y, Direction::Rotation];

/// One of every element, on nodes that are moved at random.
fn menagerie(formulation: QuadFormulation, seed: u64) -> FemModel {
    let shift = noise(12, seed);
    let material = Material::new(3.0e7, 0.3, 2000.0).unwrap();
    let mut mesh = Mesh::new();
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.1, 1.9], [0.2, 2.2], [1.0, 5.0], [3.0, 4.0]];
    for (k, [x, y]) in corners.into_iter().enumerate() {
        let amount = if k < 2 { 0.0 } else { 0.3 };
        mesh.add_node(x + amount * shift[2 * k], y + amount * shift[2 * k + 1]).unwrap();
    }
    mesh.add(Quad4::new([0, 1, 2, 3], material, formulation)).unwrap();
    mesh.add(Beam::new([3, 4], 3.0e7, 0.2, 0.01, 2400.0).unwrap()).unwrap();
    let timoshenko = Beam::new([4, 5], 3.0e7, 0.2, 0.03, 2400.0).unwrap();
    mesh.add(timoshenko.with_shear_stiffness(1.0e6).unwrap()).unwrap();
    mesh.add(Truss::new([2, 5], 3.0e7, 0.1, 7800.0).unwrap()).unwrap();
    mesh.add(Spring::axial([2, 4], 5.0e6).unwrap()).unwrap();
    mesh.add(Spring::new([3, 5], Direction::Rotation, 4.0e5).unwrap()).unwrap();
    mesh.add(Dashpot::axial([1, 5], 3.0e4).unwrap()).unwrap();
    mesh.add(Dashpot::new([3, 4], Direction::Rotation, 3.0e4).unwrap()).unwrap();
    mesh.add(LumpedMass::new(4, 800.0).unwrap()).unwrap();
    mesh.add(LumpedMass::new(5, 500.0).unwrap().with_rotary_inertia(90.0).unwrap())
        .unwrap();
    let rayleigh = RayleighDamping::new(0.0, 0.01).unwrap();
    FemModel::on_base(mesh).unwrap().with_rayleigh(rayleigh)
}

#[test]
fn rigid_motions_meet_no_force() {
    for formulation in
        [QuadFormulation::Full, QuadFormulation::IncompatibleModes, QuadFormulation::OnePoint]
    {
        for seed in 1..20 {
            let model = menagerie(formulation, seed);
            for matrix in [stiffness(&model), damping(&model)] {
                assert_symmetric(&matrix);
                let scale = matrix.iter().map(|row| largest(row)).fold(0.0, f64::max);
                for direction in PLANE_DIRECTIONS {
                    let motion = model.rigid_motion(direction, [0.7, -0.2, 0.0]);
                    let force = multiply(&matrix, &motion);
                    assert!(largest(&force) < 1e-13 * scale * largest(&motion), "{direction:?}");
                }
            }
        }
    }
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// Twice the area of a triangle with the origin.
fn cross(p: [f64; 3], q: [f64; 3]) -> f64 {
    p[0] * q[1] - q[0] * p[1]
}

#[test]
fn mass_of_the_whole_is_the_sum_of_its_parts() {
    for kind in [MassKind::Consistent, MassKind::Lumped] {
        let model = menagerie(QuadFormulation::Full, 3).with_mass(kind);
        let p = model.mesh().nodes();
        let area =
            0.5 * (cross(p[0], p[1]) + cross(p[1], p[2]) + cross(p[2], p[3]) + cross(p[3], p[0]));
        let total = 2000.0 * area
            + 2400.0 * 0.2 * (distance(p[3], p[4]) + distance(p[4], p[5]))
            + 7800.0 * 0.1 * distance(p[2], p[5])
            + 1300.0;
        let matrix = mass(&model);
        assert_symmetric(&matrix);
        for direction in [Direction::X, Direction::Y] {
            let motion = model.rigid_motion(direction, [0.0; 3]);
            assert!((form(&motion, &matrix, &motion) / total - 1.0).abs() < 1e-13);
        }
        if kind == MassKind::Lumped {
            for (i, row) in matrix.iter().enumerate() {
                let scale = row[i];
                assert!(row.iter().enumerate().all(|(j, v)| i == j || v.abs() < 1e-14 * scale));
            }
        }
    }
}

/// Consistent mass has the exact rotary inertia: m (b² + h²)/12 for a rectangle, m L²/12 for a beam
/// and a truss; on distorted quads too, since they carry a rotation exactly.
#[test]
fn consistent_mass_has_the_exact_rotary_inertia() {
    let material = Material::new(1.0, 0.0, 3.0).unwrap();
    let block = Mesh::layered_block(-1.0..1.0, 3, &[Layer::new(5.0, 4, material)]).unwrap();
    let block = FemModel::on_base(block).unwrap();
    let turn = block.rigid_motion(Direction::Rotation, [0.0, 2.5, 0.0]);
    let expected = 30.0 * (4.0 + 25.0) / 12.0;
    assert!((form(&turn, &mass(&block), &turn) / expected - 1.0).abs() < 1e-13);

    let mut mesh = Mesh::new();
    let ends = [mesh.add_node(-2.0, 0.0).unwrap(), mesh.add_node(2.0, 0.0).unwrap()];
    mesh.add(Beam::new(ends, 1.0, 1.0, 1.0, 6.0).unwrap()).unwrap();
    mesh.add(Truss::new(ends, 1.0, 1.0, 1.0).unwrap()).unwrap();
    mesh.add(LumpedMass::new(ends[1], 5.0).unwrap().with_rotary_inertia(2.0).unwrap())
        .unwrap();
    let bar = FemModel::on_base(mesh).unwrap();
    let turn = bar.rigid_motion(Direction::Rotation, [0.0; 3]);
    let expected = 7.0 * 4.0 * 16.0 / 12.0 + 5.0 * 4.0 + 2.0;
    assert!((form(&turn, &mass(&bar), &turn) / expected - 1.0).abs() < 1e-13);
}
