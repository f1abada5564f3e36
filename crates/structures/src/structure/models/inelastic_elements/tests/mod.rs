//! Models with elements that yield: force, tangent, energies and stored states.

mod composition;
mod hinges;
mod step_ends;

use crate::error::Error;
use crate::fem::hardening::{Hardening, HiddenElastic};
use crate::fem::{Beam, Direction, Material, Mesh, Quad4, QuadFormulation, SharedMaterial};
use crate::linalg::SparseMatrix;
use crate::structure::nonlinear::Tangent;
use crate::structure::{FemModel, RayleighDamping, Structure, Triplets};

/// Block of 2 × 3 eight-node quadrilaterals, 3 m wide and 4 m high.
fn mesh(material: impl Into<SharedMaterial>) -> Mesh {
    let material = material.into();
    let lines = [0.0, 1.0, 3.0];
    Mesh::quad8_block(&lines, &[0.0, 1.0, 2.0, 4.0], |_, _| material.clone()).unwrap()
}

fn yielding() -> FemModel {
    FemModel::on_base(mesh(Hardening::FIRM_SOIL)).unwrap()
}

/// Reproducible displacements (Lehmer's generator).
fn displacements(seed: u64, count: usize, scale: f64) -> Vec<f64> {
    let mut number = seed;
    let mut values = Vec::with_capacity(count);
    for _ in 0..count {
        number = number * 48_271 % 2_147_483_647;
        values.push(scale * (2.0 * number as f64 / 2_147_483_647.0 - 1.0));
    }
    values
}

fn force(structure: &dyn Structure, u: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    structure.nonlinear().unwrap().force(u, &mut force).unwrap();
    force
}

fn tangent(structure: &dyn Structure, u: &[f64]) -> Triplets {
    let mut matrix = Triplets::new(u.len());
    structure.nonlinear().unwrap().tangent(u, &mut matrix).unwrap();
    matrix
}

fn assembled(fill: impl Fn(&mut Triplets), order: usize) -> SparseMatrix {
    let mut matrix = Triplets::new(order);
    fill(&mut matrix);
    SparseMatrix::new("matrix", &matrix).unwrap()
}

/// Largest entry of the difference of two matrices, relative to the largest entry of the second.
fn relative_difference(a: &SparseMatrix, b: &SparseMatrix) -> f64 {
    let difference = SparseMatrix::sum("difference", a.order(), &[(1.0, a), (-1.0, b)]).unwrap();
    let max_entry = |matrix: &SparseMatrix| {
        matrix.entries().fold(0.0, |max: f64, (_, _, value)| max.max(value.abs()))
    };
    max_entry(&difference) / max_entry(b)
}

fn assert_near(values: &[f64], expected: &[f64], tolerance: f64) {
    let scale = expected.iter().fold(0.0, |max: f64, value| max.max(value.abs()));
    for (value, expected) in values.iter().zip(expected) {
        assert!((value - expected).abs() <= tolerance * scale, "{value} is not {expected}");
    }
}

/// A block with a beam above its top, whose left end is the leader of both upper corners.
fn with_link(material: impl Into<SharedMaterial>) -> FemModel {
    let mut mesh = mesh(material);
    let corners = [0.0, 3.0].map(|x| mesh.node_at(x, 4.0).unwrap());
    let head = mesh.add_node(2.0, 6.0).unwrap();
    let side = mesh.add_node(4.0, 6.0).unwrap();
    mesh.add(Beam::new([head, side], 1.0e9, 0.2, 0.01, 2400.0).unwrap()).unwrap();
    FemModel::on_base(mesh).unwrap().with_rigid_link(head, &corners).unwrap()
}

#[test]
fn linear_meshes_have_no_nonlinear_force() {
    let mut model = FemModel::on_base(mesh(Material::new(20.0e6, 0.3, 1900.0).unwrap())).unwrap();
    assert!(model.nonlinear().is_none() && model.nonlinear_mut().is_none());
    assert_eq!(model.inelastic_elements().count(), 0);
    assert!(matches!(model.solid_points(0), Err(Error::Part { .. })));
}

#[test]
fn force_of_an_elastic_law_is_that_of_the_elastic_model() {
    let material = Material::new(20.0e6, 0.3, 1900.0).unwrap();
    let pairs = [
        (with_link(HiddenElastic(material)), with_link(material)),
        (
            FemModel::on_base(mesh(HiddenElastic(material))).unwrap(),
            FemModel::on_base(mesh(material)).unwrap(),
        ),
    ];
    let damping = RayleighDamping::new(0.1, 0.01).unwrap();
    for (user_model, elastic) in pairs {
        let n = user_model.dofs();
        let user_model = user_model.with_rayleigh(damping);
        let elastic = elastic.with_rayleigh(damping);
        let u = displacements(3, n, 1e-3);
        let expected = assembled(|m| elastic.stiffness(m).unwrap(), n);
        let linear_part = assembled(|m| user_model.stiffness(m).unwrap(), n);
        let mut forces = force(&user_model, &u);
        linear_part.multiply_add(1.0, &u, &mut forces);
        assert_near(&forces, &expected.times(&u), 1e-13);
        let total_stiffness = assembled(
            |m| {
                user_model.stiffness(m).unwrap();
                user_model.nonlinear().unwrap().tangent(&u, m).unwrap();
            },
            n,
        );
        assert!(relative_difference(&total_stiffness, &expected) < 1e-13);
        let user_damping = assembled(|m| user_model.damping(m).unwrap(), n);
        let damping = assembled(|m| elastic.damping(m).unwrap(), n);
        assert!(relative_difference(&user_damping, &damping) < 1e-13);
    }
}

#[test]
fn pattern_of_the_tangent_never_changes() {
    let mut model = with_link(Hardening::FIRM_SOIL);
    let n = model.dofs();
    let entry_places = |matrix: &Triplets| -> Vec<(usize, usize)> {
        matrix.entries().iter().map(|&(row, column, _)| (row, column)).collect()
    };
    let tangent_at_rest = tangent(&model, &vec![0.0; n]);
    for seed in 1..6 {
        let u = displacements(seed, n, 5e-3);
        assert_eq!(entry_places(&tangent(&model, &u)), entry_places(&tangent_at_rest));
        model.nonlinear_mut().unwrap().commit(&u);
    }
}

#[test]
fn tangent_is_the_derivative_of_the_force() {
    let mut model = with_link(Hardening::FIRM_SOIL);
    let n = model.dofs();
    model.nonlinear_mut().unwrap().commit(&displacements(2, n, 4e-3));
    let u = displacements(9, n, 6e-3);
    let matrix = Tangent::at(&model, &u).unwrap().matrix;
    let direction = displacements(4, n, 1.0);
    let shifted_displacement =
        |step: f64| -> Vec<f64> { u.iter().zip(&direction).map(|(u, d)| u + step * d).collect() };
    let upper_force = force(&model, &shifted_displacement(1e-9));
    let lower_force = force(&model, &shifted_displacement(-1e-9));
    let differences: Vec<f64> = upper_force
        .iter()
        .zip(&lower_force)
        .map(|(upper_force, lower_force)| (upper_force - lower_force) / 2e-9)
        .collect();
    assert_near(&differences, &matrix.times(&direction), 1e-6);
}

#[test]
fn work_is_stored_dissipated_or_the_remainder() {
    for mut model in [yielding(), with_link(Hardening::FIRM_SOIL)] {
        let n = model.dofs();
        let mut start = vec![0.0; n];
        for seed in 1..40 {
            let end = displacements(seed, n, 5e-3);
            let midstep: Vec<f64> =
                start.iter().zip(&end).map(|(start, end)| 0.5 * (start + end)).collect();
            let pairs = start.iter().zip(&end).zip(force(&model, &midstep));
            let work: f64 = pairs.map(|((start, end), force)| force * (end - start)).sum();
            let nonlinear = model.nonlinear_mut().unwrap();
            let start_energy = nonlinear.energy(&start).unwrap();
            let end_energy = nonlinear.energy(&end).unwrap();
            let remainder = nonlinear.remainder(&midstep, &end).unwrap();
            nonlinear.commit(&end);
            let dissipated_energy = end_energy.dissipated - start_energy.dissipated;
            let stored = end_energy.stored - start_energy.stored;
            assert!(dissipated_energy >= -1e-12 * end_energy.dissipated);
            let scale = 1e-12 * (end_energy.stored + dissipated_energy);
            assert!((work - stored - dissipated_energy - remainder).abs() < scale);
            start = end;
        }
    }
}

#[test]
fn saved_state_resumes_to_the_last_bit() {
    let mut model = with_link(Hardening::FIRM_SOIL);
    let n = model.dofs();
    for seed in 1..4 {
        model.nonlinear_mut().unwrap().commit(&displacements(seed, n, 5e-3));
    }
    let saved_variables = model.nonlinear().unwrap().save().unwrap();
    let mut resumed_model = with_link(Hardening::FIRM_SOIL);
    resumed_model.nonlinear_mut().unwrap().restore(&saved_variables).unwrap();
    let cloned = model.clone();
    let midstep = displacements(8, n, 4e-3);
    let end = displacements(9, n, 5e-3);
    for mut other_model in [resumed_model, cloned] {
        assert_eq!(force(&other_model, &end), force(&model, &end));
        assert_eq!(tangent(&other_model, &end), tangent(&model, &end));
        let force = model.nonlinear().unwrap();
        let other_force = other_model.nonlinear_mut().unwrap();
        assert_eq!(other_force.energy(&end), force.energy(&end));
        assert_eq!(other_force.remainder(&midstep, &end), force.remainder(&midstep, &end));
        // A copy has variables of its own.
        other_force.commit(&end);
        assert_ne!(other_force.save().unwrap(), saved_variables);
        assert_eq!(force.save().unwrap(), saved_variables);
        let mut not_finite = saved_variables.clone();
        not_finite[0] = f64::NAN;
        let committed = other_force.save().unwrap();
        for values in [&saved_variables[1..], &[], &not_finite] {
            assert!(matches!(other_force.restore(values), Err(Error::Checkpoint(_))));
        }
        assert_eq!(other_force.save().unwrap(), committed);
    }
}

#[test]
fn translations_give_no_force() {
    let model = with_link(Hardening::FIRM_SOIL);
    let mut u = vec![0.0; model.dofs()];
    for (node, _) in model.mesh().nodes().iter().enumerate() {
        if let Some(dof) = model.dof(node, Direction::X) {
            u[dof] = 2.5;
        }
    }
    let max_force = force(&model, &u).iter().fold(0.0, |max: f64, force| max.max(force.abs()));
    assert!(max_force < 1e-6, "{max_force}");
}

#[test]
fn element_and_state_are_named() {
    let mut model = yielding();
    let n = model.dofs();
    let mut u = vec![0.0; n];
    // Only the top row is sheared: γ = 1 %.
    for (node, point) in model.mesh().nodes().iter().enumerate() {
        u[model.dof(node, Direction::X).unwrap()] = 0.01 * (point[1] - 2.0).max(0.0);
    }
    let top = model.mesh().node_at(0.0, 4.0).unwrap();
    let dofs = [n, model.dof(top, Direction::X).unwrap()];
    let text = model.nonlinear().unwrap().describe_state(&u, &dofs).unwrap();
    // γ^p = γ − τ/G with τ = (r₀ + H ε^p)/√2 and γ^p = √2 ε^p.
    let plastic_arc = (2.0_f64.sqrt() * 10.0e6 * 0.01 - 20.0e3) / (2.0 * 10.0e6 + 1.0e6);
    let plastic_strain = 2.0_f64.sqrt() * plastic_arc;
    let nodes = model.mesh().elements().nth(4).unwrap().nodes().to_vec();
    let expected = format!(
        "element 4 on nodes {nodes:?}: plastic strain {plastic_strain:.2e}, 100 % of its strength"
    );
    assert_eq!(text, expected);
    assert!(model.nonlinear().unwrap().describe_state(&u, &[n]).is_none());
    model.nonlinear_mut().unwrap().commit(&u);
    let points = model.solid_points(4).unwrap();
    assert_eq!(points.len(), 4);
    for point in points {
        assert!((point.state.plastic_strain - plastic_strain).abs() < 1e-15);
        assert!(point.position[1] > 2.0 && point.position[0] < 1.0);
    }
    assert!(model.solid_points(0).unwrap().iter().all(|p| p.state.plastic_strain == 0.0));
    assert!(matches!(model.solid_points(99), Err(Error::Index { .. })));
    assert_eq!(model.inelastic_elements().collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
}

#[test]
fn energies_count_from_the_state_at_rest() {
    let stress = [-10.0e3, -20.0e3, -15.0e3, 0.0];
    let mut mesh = Mesh::new();
    for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
        mesh.add_node(x, y).unwrap();
    }
    let quad = Quad4::new([0, 1, 2, 3], Hardening::FIRM_SOIL, QuadFormulation::MeanDilatation);
    mesh.add(quad.with_initial_stress(stress)).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let energy_at_rest = model.nonlinear().unwrap().energy(&[0.0; 8]).unwrap();
    assert_eq!([energy_at_rest.stored, energy_at_rest.dissipated], [0.0, 0.0]);
    // Compression by 1e-5: work of the stress at rest, and of the elastic stress.
    let u = [0.0, 0.0, 0.0, 0.0, 0.0, -1e-5, 0.0, -1e-5];
    let energy = model.nonlinear().unwrap().energy(&u).unwrap();
    let direct_modulus = 30.0e6 + 4.0 / 3.0 * 10.0e6;
    let expected = 20.0e3 * 1e-5 + 0.5 * direct_modulus * 1e-10;
    assert!((energy.stored - expected).abs() < 1e-9 * expected, "{energy:?}");
    // Static forces of P–Δ do not follow from the weight.
    assert!(matches!(model.with_p_delta(9.81), Err(Error::Scene { .. })));
}

#[test]
fn wrong_displacements_are_errors_and_change_nothing() {
    let mut model = yielding();
    let n = model.dofs();
    let short_displacement = vec![0.0; n - 1];
    let nonlinear = model.nonlinear_mut().unwrap();
    let previous_state = nonlinear.save().unwrap();
    assert!(nonlinear.force(&short_displacement, &mut vec![0.0; n]).is_err());
    assert!(nonlinear.force(&vec![0.0; n], &mut vec![0.0; n - 1]).is_err());
    assert!(nonlinear.tangent(&short_displacement, &mut Triplets::new(n)).is_err());
    assert!(nonlinear.energy(&short_displacement).unwrap().stored.is_nan());
    assert!(nonlinear.remainder(&short_displacement, &short_displacement).unwrap().is_nan());
    assert!(nonlinear.describe_state(&short_displacement, &[0]).is_none());
    nonlinear.commit(&short_displacement);
    assert_eq!(nonlinear.save().unwrap(), previous_state);
}
