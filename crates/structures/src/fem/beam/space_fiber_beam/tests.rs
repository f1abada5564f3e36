//! Beams of fibres in space against linear beams, differences and closed forms.

use basemat_testkit::random::Random;

use super::*;
use crate::fem::beam::{BeamSection, SpaceBeam};
use crate::fem::{BilinearSteel, Concrete, Material, MenegottoPinto, UniaxialMaterial};
use crate::linalg::dot;

const ALL_FORMULATIONS: [BeamFormulation; 2] =
    [BeamFormulation::DisplacementBased, BeamFormulation::ForceBased];
/// Inclined beam of 5 m.
const INCLINED_ENDS: [[f64; 3]; 2] = [[0.5, 0.2, 1.0], [2.5, 3.2, 1.0 + 3.464_101_615_137_754_6]];
/// Axis of the section neither along nor across an axis of space.
const SKEW_ORIENTATION: [f64; 3] = [0.3, -0.8, 0.4];
/// Displacements and rotations of both nodes.
const MATRIX_SIZE: usize = DOF_COUNT * DOF_COUNT;

/// Section of concrete with bars, 0.6 m along y and 0.4 m along z.
fn concrete_section() -> FiberSection {
    let concrete = Concrete::new(30.0e6, 0.002, 6.0e6, 0.006).unwrap();
    let steel = MenegottoPinto::new(500.0e6, 200.0e9, 0.01).unwrap();
    FiberSection::new()
        .with_rectangle([[-0.3, -0.2], [0.3, 0.2]], [9, 7], concrete)
        .and_then(|section| section.with_bars([[-0.25, -0.15], [-0.25, 0.15]], 4, 491.0e-6, steel))
        .and_then(|section| section.with_bars([[0.25, -0.15], [0.25, 0.15]], 3, 491.0e-6, steel))
        .and_then(|section| section.with_torsional_stiffness(40.0e6))
        .unwrap()
}

fn beam(section: &FiberSection, formulation: BeamFormulation) -> SpaceFiberBeam {
    let quadrature = BeamQuadrature::Lobatto(5);
    SpaceFiberBeam::new([0, 1], section, quadrature, 100.0, SKEW_ORIENTATION)
        .unwrap()
        .with_formulation(formulation)
}

/// Σ A s² of `count` fibres along a side, divided by the area.
fn squared_radius(side: f64, count: i32) -> f64 {
    let size = side / f64::from(count);
    let positions = (0..count).map(|i| (f64::from(i) + 0.5) * size - 0.5 * side);
    positions.map(|position| position * position).sum::<f64>() / f64::from(count)
}

/// Asserts that two matrices agree to this part of the largest entry.
fn assert_same(name: &str, computed: &[f64], expected: &[f64], tolerance: f64) {
    let scale = expected.iter().fold(0.0_f64, |max, entry| max.max(entry.abs()));
    for (index, (a, b)) in computed.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance * scale, "{name}, entry {index}: {a} {b}");
    }
}

/// Asserts that a force or moment agrees with another one to seven digits.
fn assert_near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-7 * b.abs().max(1e3), "{a} {b}");
}

/// Elastic fibres have the matrices, forces and compression of a linear beam with their area and second moments.
#[test]
fn elastic_fibres_are_the_linear_beam() {
    let area = 0.6 * 0.4;
    let material = Material::new(30.0e9, 0.2, 100.0 / area).unwrap();
    let torsion_constant = 7.5e-3;
    let torsional_stiffness = material.shear_modulus() * torsion_constant;
    let section = FiberSection::new()
        .with_rectangle([[-0.3, -0.2], [0.3, 0.2]], [6, 5], material)
        .and_then(|section| section.with_torsional_stiffness(torsional_stiffness))
        .unwrap();
    let second_moments = [area * squared_radius(0.4, 5), area * squared_radius(0.6, 6)];
    let linear_section = BeamSection::new(area, second_moments, torsion_constant).unwrap();
    let linear = SpaceBeam::new([0, 1], material, linear_section, SKEW_ORIENTATION).unwrap();
    let mut random = Random(3);
    let u: Vec<f64> = (0..DOF_COUNT).map(|_| random.within(-1.0, 1.0)).collect();
    let mut expected = vec![0.0; MATRIX_SIZE];
    linear.stiffness(&INCLINED_ENDS, &mut expected);
    let rows = expected.chunks(DOF_COUNT);
    let expected_force: Vec<f64> = rows.map(|row| dot(row, &u)).collect();
    let linear = linear.in_static_state(&INCLINED_ENDS, &u, 9.81).unwrap();
    for formulation in ALL_FORMULATIONS {
        let fibers = beam(&section, formulation);
        let mut variables = vec![0.0; fibers.variable_count()];
        fibers.initialize(&INCLINED_ENDS, &mut variables).unwrap();
        let mut stiffness = vec![0.0; MATRIX_SIZE];
        fibers.stiffness(&INCLINED_ENDS, &mut stiffness);
        assert_same("stiffness", &stiffness, &expected, 1e-13);
        let mut tangent = vec![0.0; MATRIX_SIZE];
        fibers.tangent(&INCLINED_ENDS, &u, &variables, &mut tangent).unwrap();
        assert_same("tangent", &tangent, &expected, 1e-12);
        let mut force = vec![0.0; DOF_COUNT];
        fibers.force(&INCLINED_ENDS, &u, &variables, &mut force).unwrap();
        assert_same("force", &force, &expected_force, 1e-12);
        let energy = fibers.energy(&INCLINED_ENDS, &u, &variables).unwrap();
        let work = 0.5 * dot(&expected_force, &u);
        assert!((energy.stored / work - 1.0).abs() < 1e-12 && energy.dissipated == 0.0);
        let fibers = fibers.in_static_state(&INCLINED_ENDS, &u, 9.81).unwrap();
        let compression_ratio = fibers.compression().unwrap() / linear.compression().unwrap();
        assert!((compression_ratio - 1.0).abs() < 1e-12);
        let mut geometric = [vec![0.0; MATRIX_SIZE], vec![0.0; MATRIX_SIZE]];
        fibers.geometric_stiffness(&INCLINED_ENDS, &mut geometric[0]);
        linear.geometric_stiffness(&INCLINED_ENDS, &mut geometric[1]);
        assert_same("geometric stiffness", &geometric[0], &geometric[1], 1e-12);
        for kind in [MassKind::Consistent, MassKind::Lumped] {
            let mut mass = [vec![0.0; MATRIX_SIZE], vec![0.0; MATRIX_SIZE]];
            fibers.mass(&INCLINED_ENDS, kind, &mut mass[0]);
            linear.mass(&INCLINED_ENDS, kind, &mut mass[1]);
            assert_same("mass", &mass[0], &mass[1], 1e-13);
        }
    }
}

/// Tangents are symmetric derivatives of the forces, on a path that yields, cracks and twists; the remainder closes the energy.
#[test]
fn tangents_are_derivatives_of_forces() {
    let section = concrete_section();
    for formulation in ALL_FORMULATIONS {
        let fibers = beam(&section, formulation);
        let mut variables = vec![0.0; fibers.variable_count()];
        fibers.initialize(&INCLINED_ENDS, &mut variables).unwrap();
        let mut random = Random(5);
        let mut elastic = vec![0.0; MATRIX_SIZE];
        fibers.stiffness(&INCLINED_ENDS, &mut elastic);
        let mut largest_error = 0.0_f64;
        let mut start = vec![0.0; DOF_COUNT];
        for step in 0..12 {
            let end: Vec<f64> = (0..DOF_COUNT)
                .map(|i| random.within(-1.0, 1.0) * if i % 6 < 3 { 0.004 } else { 0.01 })
                .collect();
            let mut tangent = vec![0.0; MATRIX_SIZE];
            fibers.tangent(&INCLINED_ENDS, &end, &variables, &mut tangent).unwrap();
            // Not at the kinks of fibres: the median over the entries.
            let mut errors = Vec::new();
            for j in 0..DOF_COUNT {
                let h = 1e-9;
                let forces = [-h, h].map(|change| {
                    let mut moved = end.clone();
                    moved[j] += change;
                    let mut force = vec![0.0; DOF_COUNT];
                    fibers.force(&INCLINED_ENDS, &moved, &variables, &mut force).unwrap();
                    force
                });
                for i in 0..DOF_COUNT {
                    let difference = (forces[1][i] - forces[0][i]) / (2.0 * h);
                    let scale = (elastic[13 * i] * elastic[13 * j]).sqrt();
                    errors.push((difference - tangent[DOF_COUNT * i + j]).abs() / scale);
                    let asymmetry = tangent[DOF_COUNT * i + j] - tangent[DOF_COUNT * j + i];
                    assert!(asymmetry.abs() < 1e-9 * scale, "{formulation:?} step {step}");
                }
            }
            errors.sort_by(f64::total_cmp);
            largest_error = largest_error.max(errors[MATRIX_SIZE / 2]);
            // The mid-step need not be the middle.
            let midstep: Vec<f64> =
                start.iter().zip(&end).map(|(a, b)| 0.3 * a + 0.7 * b).collect();
            let mut force = vec![0.0; DOF_COUNT];
            fibers.force(&INCLINED_ENDS, &midstep, &variables, &mut force).unwrap();
            let increment: Vec<f64> = start.iter().zip(&end).map(|(a, b)| b - a).collect();
            let before = fibers.energy(&INCLINED_ENDS, &start, &variables).unwrap();
            let after = fibers.energy(&INCLINED_ENDS, &end, &variables).unwrap();
            let change = after.stored + after.dissipated - before.stored - before.dissipated;
            let remainder =
                fibers.remainder(&INCLINED_ENDS, [&start, &midstep, &end], &variables).unwrap();
            let work = dot(&force, &increment);
            let error = (work - change - remainder).abs();
            assert!(error < 1e-9 * work.abs().max(change.abs()), "{formulation:?} {step}: {error}");
            fibers.commit(&INCLINED_ENDS, &end, &mut variables);
            start = end;
        }
        assert!(largest_error < 1e-6, "{formulation:?}: {largest_error}");
    }
}

/// Depth along y and width along z of the plastic rectangle, m.
const PLASTIC_SIDES: [f64; 2] = [0.3, 0.2];
const YIELD_STRESS: f64 = 400.0e6;

/// Neutral axis z = c + t y of a rectangle, which cuts both of its sides along z.
#[derive(Clone, Copy)]
struct NeutralAxis {
    c: f64,
    t: f64,
}

impl NeutralAxis {
    /// Axial force and moments about z and about y of the fully plastic rectangle, with tension above the axis.
    fn plastic_resultants(self) -> [f64; 3] {
        let h = PLASTIC_SIDES[0];
        let b = PLASTIC_SIDES[1];
        let c = self.c;
        let t = self.t;
        let axial = -2.0 * c * h;
        let about_z = t * h.powi(3) / 6.0;
        let about_y = b * b * h / 4.0 - c * c * h - t * t * h.powi(3) / 12.0;
        [axial, about_z, about_y].map(|value| YIELD_STRESS * value)
    }
}

/// Axial force and moments about z and y at the second end of a beam that is bent uniformly about a neutral axis.
fn uniformly_bent(fibers: &SpaceFiberBeam, axis: NeutralAxis) -> [f64; 3] {
    let axes = fibers.axes(&INCLINED_ENDS).unwrap();
    let [x, y, z] = axes.axes;
    let mut variables = vec![0.0; fibers.variable_count()];
    fibers.initialize(&INCLINED_ENDS, &mut variables).unwrap();
    let step_count = 40;
    let mut force = vec![0.0; DOF_COUNT];
    for step in 1..=step_count {
        // The corners reach three hundred times the yield strain.
        let curvature = 0.6 / PLASTIC_SIDES[1] * f64::from(step) / f64::from(step_count);
        let elongation = -axis.c * curvature * axes.length;
        let about_y = 0.5 * curvature * axes.length;
        let about_z = axis.t * about_y;
        let mut u = vec![0.0; DOF_COUNT];
        for k in 0..3 {
            u[6 + k] = elongation * x[k];
            u[9 + k] = about_y * y[k] + about_z * z[k];
            u[3 + k] = -u[9 + k];
        }
        force.fill(0.0);
        fibers.force(&INCLINED_ENDS, &u, &variables, &mut force).unwrap();
        fibers.commit(&INCLINED_ENDS, &u, &mut variables);
    }
    [dot(&force[6..9], &x), dot(&force[9..12], &z), dot(&force[9..12], &y)]
}

/// A plastic rectangle bent about a diagonal carries two thirds of both plastic moments; others lie on the surface
/// m_y + 3/4 m_z² + n² = 1 of its interaction.
#[test]
fn a_plastic_rectangle_carries_its_biaxial_moments() {
    let h = PLASTIC_SIDES[0];
    let b = PLASTIC_SIDES[1];
    let steel = BilinearSteel::new(YIELD_STRESS, 200.0e9, 1e-9).unwrap();
    let corners = [[-0.5 * h, -0.5 * b], [0.5 * h, 0.5 * b]];
    let section = FiberSection::new()
        .with_rectangle(corners, [48, 64], steel)
        .and_then(|section| section.with_torsional_stiffness(1.0e6))
        .unwrap();
    let squash_load = YIELD_STRESS * b * h;
    let plastic_about_z = squash_load * h / 4.0;
    let plastic_about_y = squash_load * b / 4.0;
    let diagonal = NeutralAxis { c: 0.0, t: b / h };
    let diagonal_resultants = diagonal.plastic_resultants();
    assert!((diagonal_resultants[1] / plastic_about_z - 2.0 / 3.0).abs() < 1e-12);
    assert!((diagonal_resultants[2] / plastic_about_y - 2.0 / 3.0).abs() < 1e-12);
    let axes = [
        diagonal,
        NeutralAxis { c: 0.0, t: -0.4 },
        NeutralAxis { c: 0.03, t: 0.3 },
        NeutralAxis { c: -0.05, t: -0.2 },
    ];
    for formulation in ALL_FORMULATIONS {
        let quadrature = BeamQuadrature::Legendre(2);
        let fibers = SpaceFiberBeam::new([0, 1], &section, quadrature, 1.0, SKEW_ORIENTATION)
            .unwrap()
            .with_formulation(formulation);
        for axis in axes {
            let plastic_limits = [squash_load, plastic_about_z, plastic_about_y];
            let expected = axis.plastic_resultants();
            let ratios: [f64; 3] = std::array::from_fn(|k| expected[k] / plastic_limits[k]);
            let surface = ratios[2] + 0.75 * ratios[1] * ratios[1] + ratios[0] * ratios[0];
            assert!((surface - 1.0).abs() < 1e-12);
            let computed = uniformly_bent(&fibers, axis);
            let errors: [f64; 3] =
                std::array::from_fn(|k| computed[k] / plastic_limits[k] - ratios[k]);
            println!("{formulation:?}: N, M_z, M_y off by {errors:?} of the plastic limits");
            assert!(errors.iter().all(|error| error.abs() < 1e-3), "{formulation:?}: {errors:?}");
        }
    }
}

/// Resultants of sections are in equilibrium with the forces of the nodes, and fibres have the strains of their place.
#[test]
fn sections_are_in_equilibrium() {
    let fibers = beam(&concrete_section(), BeamFormulation::ForceBased);
    let mut variables = vec![0.0; fibers.variable_count()];
    fibers.initialize(&INCLINED_ENDS, &mut variables).unwrap();
    let mut random = Random(9);
    let u: Vec<f64> = (0..DOF_COUNT).map(|_| random.within(-5e-3, 5e-3)).collect();
    let mut force = vec![0.0; DOF_COUNT];
    fibers.force(&INCLINED_ENDS, &u, &variables, &mut force).unwrap();
    let [x, y, z] = fibers.axes(&INCLINED_ENDS).unwrap().axes;
    let sections = fibers.sections(&INCLINED_ENDS, &u, &variables).unwrap();
    assert_eq!(sections.len(), 5);
    let first = &sections[0];
    let last = &sections[4];
    assert_near(last.axial_force, dot(&force[6..9], &x));
    assert_near(last.shear, dot(&force[6..9], &y));
    assert_near(last.shear_along_z, dot(&force[6..9], &z));
    assert_near(last.torque, dot(&force[9..12], &x));
    assert_near(last.moment_about_y, dot(&force[9..12], &y));
    assert_near(last.moment, dot(&force[9..12], &z));
    assert_near(first.moment, -dot(&force[3..6], &z));
    assert_near(first.moment_about_y, -dot(&force[3..6], &y));
    assert_near(last.torque, 40.0e6 * last.twist_rate);
    assert_near(sections.iter().map(|section| section.length).sum(), 5.0);
    let mut axial = 0.0;
    let mut about_y = 0.0;
    for fiber in &last.fibers {
        let z = fiber.position[1];
        let bending_strain = z * last.curvature_about_y - fiber.position[0] * last.curvature;
        let strain = last.axial_strain + bending_strain;
        assert!((fiber.strain - strain).abs() < 1e-15);
        axial += fiber.area * fiber.stress;
        about_y += fiber.area * fiber.stress * z;
    }
    assert_near(last.axial_force, axial);
    assert_near(last.moment_about_y, about_y);
}

/// Beams that no beam can be are refused, with the reason.
#[test]
fn impossible_beams_are_refused() {
    let steel = BilinearSteel::new(400.0e6, 200.0e9, 0.01).unwrap();
    let quadrature = BeamQuadrature::Lobatto(3);
    let refusal = |section: &FiberSection| {
        SpaceFiberBeam::new([0, 1], section, quadrature, 1.0, [1.0, 0.0, 0.0])
            .unwrap_err()
            .to_string()
    };
    let layers = |counts| {
        FiberSection::new()
            .with_rectangle([[-0.2, -0.1], [0.2, 0.1]], counts, steel)
            .unwrap()
    };
    let twisting = |section: FiberSection| section.with_torsional_stiffness(1e6).unwrap();
    for (section, reason) in [
        (layers([4, 4]), "torsional stiffness"),
        (twisting(layers([8, 1])), "along z"),
        (twisting(layers([1, 8])), "along y"),
        (
            twisting(layers([8, 1]).with_bars([[0.0, -0.1], [0.0, 0.1]], 2, 1e-4, steel).unwrap()),
            "cut",
        ),
        (
            twisting(
                FiberSection::new().with_bars([[-0.1, 0.2], [0.3, -0.1]], 5, 1e-4, steel).unwrap(),
            ),
            "on a line",
        ),
        (
            twisting(
                FiberSection::new().with_bars([[0.1, -0.2], [0.1, 0.2]], 5, 1e-4, steel).unwrap(),
            ),
            "along y",
        ),
    ] {
        let text = refusal(&section);
        assert!(text.contains(reason) && text.contains("nodes 0 and 1"), "{text}");
    }
    let section = twisting(layers([4, 4]));
    for orientation in [[0.0; 3], [f64::NAN, 1.0, 0.0]] {
        assert!(SpaceFiberBeam::new([0, 1], &section, quadrature, 1.0, orientation).is_err());
    }
    let too_many = BeamQuadrature::Lobatto(6);
    assert!(SpaceFiberBeam::new([0, 1], &section, too_many, 1.0, [1.0, 0.0, 0.0]).is_err());
    let column = SpaceFiberBeam::new([0, 1], &section, quadrature, 1.0, [0.0, 0.0, 2.0]).unwrap();
    assert!(column.check(&[[0.0; 3], [0.0, 0.0, 3.0]]).is_err());
    assert!(column.check(&[[0.0; 3], [0.0; 3]]).is_err());
    assert!(column.with_compression(f64::INFINITY).is_err());
    assert!(FiberSection::new().with_torsional_stiffness(0.0).is_err());
}

/// Beams by forces have a state behind steps of any size, also where concrete crushes, cracks and closes.
#[test]
fn beams_by_forces_have_a_state_behind_large_steps() {
    let steel = BilinearSteel::new(355.0e6, 210.0e9, 0.005).unwrap();
    let curved = MenegottoPinto::new(500.0e6, 200.0e9, 0.01).unwrap();
    let rectangle = |law: Arc<dyn UniaxialMaterial>| {
        FiberSection::new()
            .with_rectangle([[-0.15, -0.1], [0.15, 0.1]], [8, 6], law)
            .and_then(|section| section.with_torsional_stiffness(10.0e6))
            .unwrap()
    };
    let sections = [
        ("bilinear steel", rectangle(Arc::new(steel))),
        ("curved steel", rectangle(Arc::new(curved))),
        ("concrete with bars", concrete_section()),
    ];
    for (name, section) in sections {
        let fibers = beam(&section, BeamFormulation::ForceBased);
        let mut random = Random(17);
        let mut failure_count = 0;
        let mut variables = vec![0.0; fibers.variable_count()];
        for path in 0..20 {
            fibers.initialize(&INCLINED_ENDS, &mut variables).unwrap();
            let scale = random.log_within(3e-3, 0.1);
            for _ in 0..20 {
                let u: Vec<f64> =
                    (0..DOF_COUNT).map(|_| scale * random.within(-1.0, 1.0)).collect();
                let mut force = [0.0; DOF_COUNT];
                match fibers.force(&INCLINED_ENDS, &u, &variables, &mut force) {
                    Ok(()) => fibers.commit(&INCLINED_ENDS, &u, &mut variables),
                    Err(fault) => {
                        println!("{name}, path {path}, scale {scale:.1e}: {fault}");
                        failure_count += 1;
                    }
                }
            }
        }
        assert_eq!(failure_count, 0, "{name}");
    }
}
