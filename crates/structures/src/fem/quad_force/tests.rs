//! Forces, tangents and energies of quadrilaterals with internal variables.

use basemat_testkit::DISTORTED_QUAD_NODES;

use crate::error::Error;
use crate::fem::hardening::{Hardening, HiddenElastic};
use crate::fem::{
    DruckerPrager, Element, InelasticForce, Material, Mesh, Quad4, Quad8, Quad8Integration,
    QuadFormulation, SharedMaterial,
};

/// An element, and its nodes' coordinates.
type PlacedElement = (Box<dyn Element>, Vec<[f64; 3]>);

/// Distorted elements of a material.
fn elements(material: &SharedMaterial) -> Vec<PlacedElement> {
    let eight_nodes = std::array::from_fn(|k| k);
    let reduced_quad = Quad8::new(eight_nodes, material.clone());
    let full_quad = reduced_quad.clone().with_integration(Quad8Integration::Full);
    let four_node_quad =
        Quad4::new([0, 1, 2, 3], material.clone(), QuadFormulation::MeanDilatation);
    vec![
        (Box::new(reduced_quad), DISTORTED_QUAD_NODES.to_vec()),
        (Box::new(full_quad), DISTORTED_QUAD_NODES.to_vec()),
        (Box::new(four_node_quad), DISTORTED_QUAD_NODES[..4].to_vec()),
    ]
}

/// Reproducible numbers between −1 and 1 (Lehmer's generator).
struct RepeatableNumbers(u64);

impl RepeatableNumbers {
    fn list(&mut self, count: usize, scale: f64) -> Vec<f64> {
        let mut values = Vec::with_capacity(count);
        for _ in 0..count {
            self.0 = self.0 * 48_271 % 2_147_483_647;
            values.push(scale * (2.0 * self.0 as f64 / 2_147_483_647.0 - 1.0));
        }
        values
    }
}

fn max_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |max: f64, (a, b)| max.max((a - b).abs()))
}

fn max_magnitude(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max: f64, value| max.max(value.abs()))
}

fn stiffness(element: &dyn Element, points: &[[f64; 3]]) -> Vec<f64> {
    let mut matrix = vec![0.0; element.order().pow(2)];
    element.stiffness(points, &mut matrix);
    matrix
}

fn force(
    element: &dyn InelasticForce,
    points: &[[f64; 3]],
    u: &[f64],
    variables: &[f64],
) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    element.force(points, u, variables, &mut force).unwrap();
    force
}

/// Variables of an element with yielded points.
fn yielded_variables(element: &dyn InelasticForce, points: &[[f64; 3]]) -> Vec<f64> {
    let mut variables = vec![0.0; element.variable_count()];
    element.initialize(points, &mut variables).unwrap();
    let mut numbers = RepeatableNumbers(7);
    for _ in 0..3 {
        let u = numbers.list(2 * points.len(), 4e-3);
        element.commit(points, &u, &mut variables);
    }
    variables
}

/// Displacement at which points yield further.
fn next_displacement(points: &[[f64; 3]]) -> Vec<f64> {
    RepeatableNumbers(23).list(2 * points.len(), 6e-3)
}

#[test]
fn elastic_law_of_a_user_has_the_forces_of_the_elastic_element() {
    let material = Material::new(20.0e6, 0.3, 1900.0).unwrap();
    let user_elements = elements(&HiddenElastic(material).into());
    for ((user, points), (elastic, _)) in user_elements.iter().zip(elements(&material.into())) {
        assert!(elastic.inelastic().is_none());
        let law = user.inelastic().unwrap();
        let expected = stiffness(&elastic, points);
        let matrix = stiffness(user, points);
        let mut tangent = vec![0.0; matrix.len()];
        let u = RepeatableNumbers(3).list(2 * points.len(), 1e-3);
        law.tangent(points, &u, &[], &mut tangent).unwrap();
        let scale = 1e-14 * max_magnitude(&expected);
        assert!(max_difference(&matrix, &expected) < 10.0 * scale);
        assert!(max_difference(&tangent, &expected) < 10.0 * scale);
        let expected_force: Vec<f64> = expected
            .chunks_exact(u.len())
            .map(|row| row.iter().zip(&u).map(|(k, u)| k * u).sum())
            .collect();
        let difference = max_difference(&force(law, points, &u, &[]), &expected_force);
        assert!(difference < 1e-13 * max_magnitude(&expected_force), "{difference}");
        assert_eq!(user.density(), Some(1900.0));
    }
}

#[test]
fn linear_displacements_give_the_stress_of_their_strain() {
    // ε_xx = 1e-4, ε_yy = −3e-4, γ_xy = 2e-4, and a rotation.
    let displacement = |[x, y, _]: [f64; 3]| [1e-4 * x + 5e-4 * y, -3e-4 * x - 3e-4 * y];
    for (element, points) in elements(&Hardening::FIRM_SOIL.into()) {
        let law = element.inelastic().unwrap();
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(&points, &mut variables).unwrap();
        let u: Vec<f64> = points.iter().flat_map(|point| displacement(*point)).collect();
        let states = law.points(&points, &u, &variables).unwrap();
        let area: f64 = states.iter().map(|point| point.area).sum();
        // Shoelace formula for the outline; edges of this Quad8 are curved.
        if points.len() == 4 {
            let outline: f64 = (0..4)
                .map(|k| {
                    let next_point = points[(k + 1) % 4];
                    0.5 * (points[k][0] * next_point[1] - next_point[0] * points[k][1])
                })
                .sum();
            assert!((area - outline).abs() < 1e-14);
        }
        for point in states {
            for (strain, expected) in point.strain.iter().zip([1e-4, -3e-4, 0.0, 2e-4]) {
                assert!((strain - expected).abs() < 1e-17, "{:?}", point.strain);
            }
            // Elastic: λ = K − 2G/3.
            let lame = 30.0e6 - 20.0e6 / 3.0;
            let expected =
                [lame * -2e-4 + 2.0e3, lame * -2e-4 - 6.0e3, lame * -2e-4, 10.0e6 * 2e-4];
            assert!(max_difference(&point.stress, &expected) < 1e-9, "{:?}", point.stress);
        }
    }
}

#[test]
fn rigid_motions_give_no_force() {
    for (element, points) in elements(&Hardening::FIRM_SOIL.into()) {
        let law = element.inelastic().unwrap();
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(&points, &mut variables).unwrap();
        let u: Vec<f64> =
            points.iter().flat_map(|[x, y, _]| [3.0 - 0.5 * y, 0.5 * x - 2.0]).collect();
        let forces = force(law, &points, &u, &variables);
        assert!(max_magnitude(&forces) < 1e-15 * 30.0e6 * 10.0, "{forces:?}");
    }
}

/// Central differences of the force.
fn difference_quotients(
    law: &dyn InelasticForce,
    points: &[[f64; 3]],
    u: &[f64],
    variables: &[f64],
) -> Vec<f64> {
    let order = u.len();
    let mut quotients = vec![0.0; order * order];
    for column in 0..order {
        let mut shifted_displacements = [u.to_vec(), u.to_vec()];
        shifted_displacements[0][column] += 1e-8;
        shifted_displacements[1][column] -= 1e-8;
        let forces = shifted_displacements.map(|u| force(law, points, &u, variables));
        for row in 0..order {
            quotients[row * order + column] = (forces[0][row] - forces[1][row]) / 2e-8;
        }
    }
    quotients
}

#[test]
fn tangent_is_the_derivative_of_the_force() {
    for (element, points) in elements(&Hardening::FIRM_SOIL.into()) {
        let law = element.inelastic().unwrap();
        let variables = yielded_variables(law, &points);
        let u = next_displacement(&points);
        let order = u.len();
        let mut tangent = vec![0.0; order * order];
        law.tangent(&points, &u, &variables, &mut tangent).unwrap();
        // Softer than the stiffness of small strains: points yield.
        assert!(tangent[0] < 0.9 * stiffness(&element, &points)[0]);
        let differences = difference_quotients(law, &points, &u, &variables);
        let error = max_difference(&tangent, &differences) / max_magnitude(&tangent);
        assert!(error < 1e-6, "{error}");
    }
}

/// Sand dilates less than an associated flow rule gives for its friction angle: ∂f_i/∂u_j is not ∂f_j/∂u_i.
#[test]
fn unsymmetric_tangent_has_its_rows_and_columns() {
    let elastic = Material::new(40.0e6, 0.3, 1900.0).unwrap();
    let sand = DruckerPrager::new(elastic, 2.0e3, 0.6, 0.1).unwrap();
    for (element, points) in elements(&sand.into()) {
        let law = element.inelastic().unwrap();
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(&points, &mut variables).unwrap();
        // Shear, and compression so that no stress reaches the tip of the cone.
        let mut u = RepeatableNumbers(31).list(2 * points.len(), 1e-4);
        for (k, point) in points.iter().enumerate() {
            u[2 * k] += 5e-3 * point[1] - 1e-3 * point[0];
            u[2 * k + 1] -= 2e-3 * point[1];
        }
        for point in law.points(&points, &u, &variables).unwrap() {
            assert!(point.stress[1] < 0.0 && point.state.plastic_strain > 0.0, "{point:?}");
        }
        let order = u.len();
        let mut tangent = vec![0.0; order * order];
        law.tangent(&points, &u, &variables, &mut tangent).unwrap();
        let differences = difference_quotients(law, &points, &u, &variables);
        let error = max_difference(&tangent, &differences) / max_magnitude(&tangent);
        assert!(error < 1e-6, "{error}");
        let mirrored_tangent: Vec<f64> = (0..order * order)
            .map(|index| tangent[index % order * order + index / order])
            .collect();
        assert!(max_difference(&tangent, &mirrored_tangent) > 0.1 * max_magnitude(&tangent));
        assert!(!law.has_symmetric_tangent());
    }
}

#[test]
fn work_is_stored_dissipated_or_the_remainder() {
    for (element, points) in elements(&Hardening::FIRM_SOIL.into()) {
        let law = element.inelastic().unwrap();
        let mut variables = yielded_variables(law, &points);
        let mut start = next_displacement(&points);
        law.commit(&points, &start, &mut variables);
        let mut numbers = RepeatableNumbers(11);
        let mut last_dissipated = 0.0;
        for _ in 0..50 {
            let end = numbers.list(start.len(), 6e-3);
            let midstep: Vec<f64> =
                start.iter().zip(&end).map(|(start, end)| 0.5 * (start + end)).collect();
            let midstep_force = force(law, &points, &midstep, &variables);
            let pairs = start.iter().zip(&end).zip(&midstep_force);
            let work: f64 = pairs.map(|((start, end), force)| force * (end - start)).sum();
            let start_energy = law.energy(&points, &start, &variables).unwrap();
            let end_energy = law.energy(&points, &end, &variables).unwrap();
            let remainder = law.remainder(&points, [&start, &midstep, &end], &variables).unwrap();
            law.commit(&points, &end, &mut variables);
            // A commit changes no energy.
            let committed_energy = law.energy(&points, &end, &variables).unwrap();
            assert!(
                (committed_energy.stored - end_energy.stored).abs() < 1e-12 * end_energy.stored
            );
            let dissipated_energy = end_energy.dissipated - start_energy.dissipated;
            let stored = end_energy.stored - start_energy.stored;
            let rounding = 1e-12 * end_energy.dissipated;
            assert!(dissipated_energy >= -rounding);
            assert!(end_energy.dissipated >= last_dissipated - rounding);
            let scale = 1e-12 * (end_energy.stored + dissipated_energy);
            assert!((work - stored - dissipated_energy - remainder).abs() < scale);
            last_dissipated = committed_energy.dissipated;
            start = end;
        }
    }
}

#[test]
fn energy_is_the_integral_of_the_force() {
    for (element, points) in elements(&Hardening::FIRM_SOIL.into()) {
        let law = element.inelastic().unwrap();
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(&points, &mut variables).unwrap();
        let target = RepeatableNumbers(5).list(2 * points.len(), 3e-3);
        let mut work = 0.0;
        for step in 0..400 {
            let displacement_at =
                |fraction: f64| target.iter().map(|u| u * fraction).collect::<Vec<_>>();
            let midstep = displacement_at((f64::from(step) + 0.5) / 400.0);
            let midstep_force = force(law, &points, &midstep, &variables);
            work += midstep_force.iter().zip(&target).map(|(f, u)| f * u / 400.0).sum::<f64>();
            law.commit(&points, &displacement_at(f64::from(step + 1) / 400.0), &mut variables);
        }
        let energy = law.energy(&points, &target, &variables).unwrap();
        assert!(energy.dissipated > 0.1 * energy.stored);
        let error = work / (energy.stored + energy.dissipated) - 1.0;
        assert!(error.abs() < 1e-5, "{error}");
    }
}

#[test]
fn initial_stress_acts_at_zero_displacement() {
    let stress = [-30.0e3, -40.0e3, -35.0e3, 5.0e3];
    let soil = SharedMaterial::from(Hardening::FIRM_SOIL);
    let quad8 = Quad8::new(std::array::from_fn(|k| k), soil.clone()).with_initial_stress(stress);
    let quad4 =
        Quad4::new([0, 1, 2, 3], soil, QuadFormulation::MeanDilatation).with_initial_stress(stress);
    let laws: [(&dyn Element, &[[f64; 3]]); 2] =
        [(&quad8, &DISTORTED_QUAD_NODES), (&quad4, &DISTORTED_QUAD_NODES[..4])];
    for (element, points) in laws {
        let law = element.inelastic().unwrap();
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(points, &mut variables).unwrap();
        let u = vec![0.0; 2 * points.len()];
        for point in law.points(points, &u, &variables).unwrap() {
            assert!(max_difference(&point.stress, &stress) < 1e-10);
        }
        // The forces do the work of the stress on a strain, and none on a rigid motion.
        let forces = force(law, points, &u, &variables);
        let area: f64 =
            law.points(points, &u, &variables).unwrap().iter().map(|point| point.area).sum();
        let strain_work: f64 =
            points.iter().enumerate().map(|(k, point)| forces[2 * k] * point[0]).sum();
        assert!((strain_work - stress[0] * area).abs() < 1e-9);
        let rotation_work: f64 = points
            .iter()
            .enumerate()
            .map(|(k, point)| forces[2 * k + 1] * point[0] - forces[2 * k] * point[1])
            .sum();
        assert!(rotation_work.abs() < 1e-9);
    }
}

#[test]
fn elements_in_errors_are_named() {
    let mut mesh = Mesh::new();
    for [x, y, _] in DISTORTED_QUAD_NODES {
        mesh.add_node(x, y).unwrap();
    }
    let soil = SharedMaterial::from(Hardening::FIRM_SOIL);
    for formulation in [
        QuadFormulation::Full,
        QuadFormulation::IncompatibleModes,
        QuadFormulation::OnePoint,
        QuadFormulation::Hourglass { percent: 5 },
    ] {
        let error = mesh.add(Quad4::new([0, 1, 2, 3], soil.clone(), formulation)).unwrap_err();
        assert!(
            matches!(error, Error::Scene { .. }) && error.to_string().contains("MeanDilatation")
        );
    }
    let nodes = std::array::from_fn(|k| k);
    let elastic = Material::new(20.0e6, 0.3, 1900.0).unwrap();
    let stressed = Quad8::new(nodes, elastic).with_initial_stress([-1.0, 0.0, 0.0, 0.0]);
    assert!(matches!(mesh.add(stressed), Err(Error::Input { .. })));
    let beyond_yield_surface =
        Quad8::new(nodes, soil.clone()).with_initial_stress([-1e6, 0.0, 0.0, 0.0]);
    assert!(matches!(mesh.add(beyond_yield_surface), Err(Error::Part { .. })));
    let not_finite_stress = Quad8::new(nodes, soil.clone()).with_initial_stress([f64::NAN; 4]);
    assert!(matches!(mesh.add(not_finite_stress), Err(Error::NotFinite { .. })));
    mesh.add(Quad8::new(nodes, soil).with_initial_stress([-20.0e3; 4].map(|s| s / 4.0)))
        .unwrap();
}

#[test]
fn lists_of_wrong_length_are_errors() {
    for (element, points) in elements(&Hardening::FIRM_SOIL.into()) {
        let law = element.inelastic().unwrap();
        let variable_count = law.variable_count();
        let mut variables = vec![0.0; variable_count];
        law.initialize(&points, &mut variables).unwrap();
        let u = vec![0.0; 2 * points.len()];
        let mut forces = u.clone();
        assert!(law.initialize(&points, &mut variables[1..]).is_err());
        assert!(law.force(&points, &u[1..], &variables, &mut forces).is_err());
        assert!(law.force(&points[1..], &u, &variables, &mut forces).is_err());
        assert!(law.energy(&points, &u, &variables[1..]).is_err());
        assert!(law.tangent(&points, &u, &[], &mut forces).is_err());
        assert!(law.remainder(&points, [&u, &u, &u[1..]], &variables).is_err());
        assert!(law.points(&points, &u, &[]).is_err());
        law.commit(&points, &u[1..], &mut variables);
        assert!(variables.iter().all(|value| *value == 0.0));
    }
}
