//! Beams of fibres against linear beams, closed forms of plastic hinges, and differences.

use basemat_testkit::random::Random;

use super::*;
use crate::fem::beam::Beam;
use crate::fem::{BilinearSteel, Concrete, Material, MenegottoPinto};

const ALL_FORMULATIONS: [BeamFormulation; 2] =
    [BeamFormulation::DisplacementBased, BeamFormulation::ForceBased];
/// Inclined beam of 5 m.
const INCLINED_ENDS: [[f64; 3]; 2] = [[0.5, 0.2, 0.0], [3.5, 4.2, 0.0]];

/// Section of concrete with bars.
fn concrete_section() -> FiberSection {
    let concrete = Concrete::new(30.0e6, 0.002, 6.0e6, 0.006).unwrap();
    let steel = MenegottoPinto::new(500.0e6, 200.0e9, 0.01).unwrap();
    FiberSection::new()
        .with_rectangle([[-0.3, -0.2], [0.3, 0.2]], [12, 1], concrete)
        .unwrap()
        .with_bars([[-0.25, -0.15], [-0.25, 0.15]], 4, 491.0e-6, steel)
        .unwrap()
        .with_bars([[0.25, -0.15], [0.25, 0.15]], 4, 491.0e-6, steel)
        .unwrap()
}

/// Rectangle of steel without hardening, 0.2 m deep and 0.1 m wide.
fn plastic_section(hardening_ratio: f64) -> FiberSection {
    let steel = BilinearSteel::new(400.0e6, 200.0e9, hardening_ratio).unwrap();
    FiberSection::new()
        .with_rectangle([[-0.1, -0.05], [0.1, 0.05]], [40, 1], steel)
        .unwrap()
}

fn beam(section: &FiberSection, formulation: BeamFormulation) -> FiberBeam {
    FiberBeam::new([0, 1], section, BeamQuadrature::Lobatto(5), 100.0)
        .unwrap()
        .with_formulation(formulation)
}

/// Shear forces of sections are those of the second node, by both formulations.
#[test]
fn sections_have_the_shear_force_of_the_nodes() {
    let section = plastic_section(0.1);
    let axes = [[0.6, 0.8], [-0.8, 0.6]];
    for formulation in ALL_FORMULATIONS {
        let fibres = beam(&section, formulation);
        let mut variables = vec![0.0; fibres.variable_count()];
        fibres.initialize(&INCLINED_ENDS, &mut variables).unwrap();
        let u = [0.0, 0.0, 0.0, 0.03, -0.02, 0.01];
        let mut force = vec![0.0; 6];
        fibres.force(&INCLINED_ENDS, &u, &variables, &mut force).unwrap();
        let [axial, shear] = axes.map(|axis| axis[0] * force[3] + axis[1] * force[4]);
        let mut committed = variables.clone();
        fibres.commit(&INCLINED_ENDS, &u, &mut committed);
        for variables in [&variables, &committed] {
            let sections = fibres.sections(&INCLINED_ENDS, &u, variables).unwrap();
            for state in &sections {
                assert!((state.shear / shear - 1.0).abs() < 1e-9, "{formulation:?}: {state:?}");
                assert_eq!([state.shear_along_z, state.torque, state.moment_about_y], [0.0; 3]);
            }
            let mean_force: f64 = sections.iter().map(|s| s.axial_force * s.length / 5.0).sum();
            assert!((mean_force / axial - 1.0).abs() < 1e-9, "{formulation:?}: {mean_force}");
        }
    }
}

/// Elastic fibres have the matrices of a linear beam with their area and second moment.
#[test]
fn elastic_fibres_are_the_linear_beam() {
    let material = Material::new(30.0e9, 0.0, 0.0).unwrap();
    let section = FiberSection::new()
        .with_rectangle([[-0.3, -0.2], [0.3, 0.2]], [6, 1], material)
        .unwrap();
    let fiber_area = 0.1 * 0.4;
    let second_moment: f64 =
        (0..6).map(|i| fiber_area * (-0.25 + 0.1 * f64::from(i)).powi(2)).sum();
    let linear = Beam::new([0, 1], 30.0e9, 0.24, second_moment, 100.0 / 0.24).unwrap();
    for formulation in ALL_FORMULATIONS {
        let fibres = beam(&section, formulation);
        let mut variables = vec![0.0; fibres.variable_count()];
        fibres.initialize(&INCLINED_ENDS, &mut variables).unwrap();
        let mut random = Random(3);
        let u: Vec<f64> = (0..6).map(|_| random.within(-1.0, 1.0)).collect();
        let mut expected = vec![0.0; 36];
        linear.stiffness(&INCLINED_ENDS, &mut expected);
        let mut stiffness = vec![0.0; 36];
        fibres.stiffness(&INCLINED_ENDS, &mut stiffness);
        let mut tangent = vec![0.0; 36];
        fibres.tangent(&INCLINED_ENDS, &u, &variables, &mut tangent).unwrap();
        for i in 0..36 {
            assert!((stiffness[i] - expected[i]).abs() < 1e-12 * expected[0].abs(), "{i}");
            assert!((tangent[i] - expected[i]).abs() < 1e-12 * expected[0].abs(), "{i}");
        }
        let mut force = vec![0.0; 6];
        fibres.force(&INCLINED_ENDS, &u, &variables, &mut force).unwrap();
        for i in 0..6 {
            let product: f64 = (0..6).map(|j| expected[6 * i + j] * u[j]).sum();
            assert!((force[i] - product).abs() < 1e-10 * expected[0], "{formulation:?} {i}");
        }
        for kind in [MassKind::Consistent, MassKind::Lumped] {
            let mut mass = [vec![0.0; 36], vec![0.0; 36]];
            linear.mass(&INCLINED_ENDS, kind, &mut mass[0]);
            fibres.mass(&INCLINED_ENDS, kind, &mut mass[1]);
            for i in 0..36 {
                assert!((mass[0][i] - mass[1][i]).abs() < 1e-10, "{i}");
            }
        }
    }
}

/// Tangents are symmetric derivatives of the forces, on a path that yields and cracks.
#[test]
fn tangents_are_derivatives_of_forces() {
    let section = concrete_section();
    for formulation in ALL_FORMULATIONS {
        let fibres = beam(&section, formulation);
        let mut variables = vec![0.0; fibres.variable_count()];
        fibres.initialize(&INCLINED_ENDS, &mut variables).unwrap();
        let mut random = Random(5);
        let mut largest_error = 0.0_f64;
        let mut yielded_count = 0;
        let mut elastic = vec![0.0; 36];
        fibres.stiffness(&INCLINED_ENDS, &mut elastic);
        let mut start = vec![0.0; 6];
        for step in 0..30 {
            let u: Vec<f64> = (0..6)
                .map(|i| random.within(-1.0, 1.0) * if i % 3 == 2 { 0.01 } else { 0.004 })
                .collect();
            let mut tangent = vec![0.0; 36];
            fibres.tangent(&INCLINED_ENDS, &u, &variables, &mut tangent).unwrap();
            // Not at the kinks of fibres: the median over the entries of a column.
            let mut errors = Vec::new();
            for j in 0..6 {
                let h = 1e-9;
                let forces = [-h, h].map(|change| {
                    let mut moved = u.clone();
                    moved[j] += change;
                    let mut force = vec![0.0; 6];
                    fibres.force(&INCLINED_ENDS, &moved, &variables, &mut force).unwrap();
                    force
                });
                for i in 0..6 {
                    let difference = (forces[1][i] - forces[0][i]) / (2.0 * h);
                    let scale = (elastic[7 * i] * elastic[7 * j]).sqrt();
                    errors.push((difference - tangent[6 * i + j]).abs() / scale);
                    let asymmetry = (tangent[6 * i + j] - tangent[6 * j + i]).abs() / scale;
                    assert!(asymmetry < 1e-9, "{formulation:?} step {step}: {asymmetry}");
                }
            }
            errors.sort_by(f64::total_cmp);
            largest_error = largest_error.max(errors[18]);
            yielded_count += usize::from(tangent[14] < 0.5 * elastic[14]);
            let middle: Vec<f64> = u.iter().zip(&start).map(|(a, b)| 0.5 * (a + b)).collect();
            let remainder =
                fibres.remainder(&INCLINED_ENDS, [&start, &middle, &u], &variables).unwrap();
            assert!(remainder.is_finite());
            fibres.commit(&INCLINED_ENDS, &u, &mut variables);
            start = u;
        }
        assert!(largest_error < 1e-6, "{formulation:?}: {largest_error}");
        assert!(yielded_count > 3, "{formulation:?}: {yielded_count}");
    }
}

/// Number of steps of a push.
const PUSH_STEP_COUNT: usize = 40;

/// Pushes the tip of a cantilever along y, divided into elements of these lengths (m); returns the force at the tip.
fn push_cantilever(
    section: &FiberSection,
    formulation: BeamFormulation,
    lengths: &[f64],
    tip: f64,
) -> f64 {
    let fibres = beam(section, formulation);
    let mut x = vec![0.0];
    for length in lengths {
        x.push(x[x.len() - 1] + length);
    }
    let count = 3 * lengths.len();
    let variable_count = fibres.variable_count();
    let mut variables = vec![0.0; variable_count * lengths.len()];
    let mut u = vec![0.0; count + 3];
    let tip_dof = count + 1;
    let mut reaction = 0.0;
    for step in 1..=PUSH_STEP_COUNT {
        u[tip_dof] = tip * step as f64 / PUSH_STEP_COUNT as f64;
        for iteration in 0.. {
            let mut force = vec![0.0; count + 3];
            let mut stiffness = vec![vec![0.0; count + 3]; count + 3];
            for e in 0..lengths.len() {
                let ends = [[x[e], 0.0, 0.0], [x[e + 1], 0.0, 0.0]];
                let dofs = 3 * e..3 * e + 6;
                let committed = &variables[e * variable_count..(e + 1) * variable_count];
                let mut element_force = vec![0.0; 6];
                let mut tangent = vec![0.0; 36];
                fibres.force(&ends, &u[dofs.clone()], committed, &mut element_force).unwrap();
                fibres.tangent(&ends, &u[dofs.clone()], committed, &mut tangent).unwrap();
                for i in 0..6 {
                    force[3 * e + i] += element_force[i];
                    for j in 0..6 {
                        stiffness[3 * e + i][3 * e + j] += tangent[6 * i + j];
                    }
                }
            }
            reaction = force[tip_dof];
            let free: Vec<usize> = (3..count + 3).filter(|dof| *dof != tip_dof).collect();
            let residual = free.iter().fold(0.0_f64, |max, dof| max.max(force[*dof].abs()));
            if iteration > 0 && residual < 1e-6 * reaction.abs() {
                break;
            }
            assert!(iteration < 100, "no equilibrium at step {step}: {residual}");
            let rows: Vec<f64> = free
                .iter()
                .flat_map(|i| free.iter().map(|j| stiffness[*i][*j]).collect::<Vec<_>>())
                .collect();
            let mut increment: Vec<f64> = free.iter().map(|dof| -force[*dof]).collect();
            let mut factors = crate::linalg::DenseFactor::with_capacity(free.len());
            assert!(factors.factor(&rows, free.len()));
            factors.solve(&mut increment);
            for (dof, change) in free.iter().zip(increment) {
                u[*dof] += change;
            }
        }
        for e in 0..lengths.len() {
            let ends = [[x[e], 0.0, 0.0], [x[e + 1], 0.0, 0.0]];
            let committed = &mut variables[e * variable_count..(e + 1) * variable_count];
            fibres.commit(&ends, &u[3 * e..3 * e + 6], committed);
        }
    }
    reaction
}

/// A cantilever without hardening carries M_p/L.
#[test]
fn a_plastic_cantilever_carries_its_plastic_moment() {
    let section = plastic_section(1e-9);
    // Σ f_y A |y| of the fibres.
    let plastic_moment = 400.0e6 * 0.1 * 0.1 * 0.1;
    let expected = plastic_moment / 3.0;
    let force = push_cantilever(&section, BeamFormulation::ForceBased, &[3.0], 0.3);
    assert!((force / expected - 1.0).abs() < 1e-3, "{force} {expected}");
    let graded = [0.006, 0.014, 0.03, 0.05, 0.2, 0.7, 2.0];
    let force = push_cantilever(&section, BeamFormulation::DisplacementBased, &graded, 0.3);
    assert!((force / expected - 1.0).abs() < 1e-3, "{force} {expected}");
}

/// Beams that no beam can be are refused.
#[test]
fn impossible_beams_are_refused() {
    let steel = BilinearSteel::new(400.0e6, 200.0e9, 0.01).unwrap();
    let quadrature = BeamQuadrature::Lobatto(3);
    assert!(FiberBeam::new([0, 1], &FiberSection::new(), quadrature, 1.0).is_err());
    let line = FiberSection::new().with_bars([[0.1, -0.1], [0.1, 0.1]], 3, 1e-4, steel).unwrap();
    assert!(FiberBeam::new([0, 1], &line, quadrature, 1.0).is_err());
    let section = plastic_section(0.01);
    assert!(FiberBeam::new([0, 1], &section, BeamQuadrature::Lobatto(6), 1.0).is_err());
    assert!(FiberBeam::new([0, 1], &section, quadrature, -1.0).is_err());
    assert!(
        FiberBeam::new([0, 1], &section, quadrature, 1.0)
            .unwrap()
            .with_compression(f64::NAN)
            .is_err()
    );
    assert!(FiberSection::new().with_fiber([0.0, f64::NAN], 1.0, steel).is_err());
    assert!(FiberSection::new().with_rectangle([[0.0; 2], [1.0, 0.0]], [1, 1], steel).is_err());
    assert!(FiberSection::new().with_rectangle([[0.0; 2], [1.0; 2]], [0, 1], steel).is_err());
    assert!(FiberSection::new().with_ring([0.0; 2], [0.2, 0.1], [1, 8], steel).is_err());
}
