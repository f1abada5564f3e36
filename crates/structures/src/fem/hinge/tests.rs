//! Hinges against closed forms, differences, the variational inequality of closest points, and the balance of energy.

mod closest_points;

use basemat_testkit::random::Random;

use super::{AxialMomentSurface, BilinearMoment, Hinge, InteractionHinge, SpaceHinge};
use crate::error::Result;
use crate::fem::element::Element;
use crate::fem::fiber::MenegottoPinto;
use crate::fem::inelastic_force::InelasticForce;

const PLASTIC_MOMENT: f64 = 300.0e3;
const AXIAL_STRENGTH: f64 = 2.0e6;
/// Nodes at one place, which is not the origin.
const NODE_POINTS: [[f64; 3]; 2] = [[3.0, 2.0, 0.0]; 2];

/// Yield surfaces of axial force and moment with these strengths.
fn surfaces() -> Vec<(&'static str, AxialMomentSurface)> {
    let polygon = [[1.0e6, 0.0], [0.0, 250.0e3], [-1.5e6, 300.0e3], [-2.0e6, 0.0]];
    let lower = [[-1.5e6, -300.0e3], [0.0, -250.0e3]];
    vec![
        ("rectangle", AxialMomentSurface::rectangle(AXIAL_STRENGTH, PLASTIC_MOMENT).unwrap()),
        ("ellipse", AxialMomentSurface::ellipse(AXIAL_STRENGTH, PLASTIC_MOMENT).unwrap()),
        ("polygon", AxialMomentSurface::polygon(&[&polygon[..], &lower].concat()).unwrap()),
    ]
}

fn interaction(surface: AxialMomentSurface, hardening_ratio: f64) -> InteractionHinge {
    InteractionHinge::new([0, 1], [0.6, 0.8], [4.0e8, 3.0e8], 6.0e7, surface)
        .and_then(|hinge| hinge.with_hardening(hardening_ratio))
        .unwrap()
}

fn in_space(stiffness: [f64; 3], moments: [f64; 2], hardening_ratio: f64) -> SpaceHinge {
    let axes = [[0.3, 0.2, 1.0], [1.0, 0.5, 0.0]];
    SpaceHinge::new([0, 1], axes, 5.0e8, stiffness, moments)
        .and_then(|hinge| hinge.with_hardening(hardening_ratio))
        .unwrap()
}

/// Hinges of all kinds, with their name and whether they yield by associated flow.
fn hinges() -> Vec<(String, Box<dyn Element>, bool)> {
    let steel = MenegottoPinto::new(PLASTIC_MOMENT, 6.0e7, 0.02).unwrap();
    let bilinear = BilinearMoment::new(PLASTIC_MOMENT, 6.0e7, 0.02).unwrap();
    let mut list: Vec<(String, Box<dyn Element>, bool)> = vec![
        ("bilinear".into(), Box::new(Hinge::new([0, 1], 3.0e8, bilinear).unwrap()), true),
        ("curved".into(), Box::new(Hinge::new([0, 1], 3.0e8, steel).unwrap()), false),
    ];
    for hardening_ratio in [0.0, 0.02] {
        for (name, surface) in surfaces() {
            let name = format!("{name}, hardening {hardening_ratio}");
            list.push((name, Box::new(interaction(surface, hardening_ratio)), true));
        }
        let circle = in_space([8.0e7, 6.0e7, 6.0e7], [PLASTIC_MOMENT; 2], hardening_ratio);
        let ellipse = in_space([8.0e7, 9.0e7, 4.0e7], [PLASTIC_MOMENT, 150.0e3], hardening_ratio);
        list.push((format!("circle, hardening {hardening_ratio}"), Box::new(circle), true));
        list.push((
            format!("ellipse in space, hardening {hardening_ratio}"),
            Box::new(ellipse),
            true,
        ));
    }
    list
}

fn initial_variables(force: &dyn InelasticForce) -> Vec<f64> {
    let mut variables = vec![0.0; force.variable_count()];
    force.initialize(&NODE_POINTS, &mut variables).unwrap();
    variables
}

fn nodal_forces(force: &dyn InelasticForce, u: &[f64], variables: &[f64]) -> Vec<f64> {
    let mut forces = vec![0.0; u.len()];
    force.force(&NODE_POINTS, u, variables, &mut forces).unwrap();
    forces
}

fn tangent(force: &dyn InelasticForce, u: &[f64], variables: &[f64]) -> Vec<f64> {
    let mut matrix = vec![0.0; u.len() * u.len()];
    force.tangent(&NODE_POINTS, u, variables, &mut matrix).unwrap();
    matrix
}

/// Tangents are symmetric and derivatives, energies balance in every step, and neither dissipation nor remainder is negative.
#[test]
fn tangents_and_energies_belong_to_the_forces() {
    for (name, hinge, is_associated) in hinges() {
        let force = hinge.inelastic().unwrap();
        let order = hinge.order();
        let mut random = Random(5);
        let mut variables = initial_variables(force);
        let mut start = vec![0.0; order];
        let mut checked_count = 0;
        for step in 0..300 {
            let end: Vec<f64> = (0..order).map(|_| random.within(-0.01, 0.01)).collect();
            let midstep: Vec<f64> = start.iter().zip(&end).map(|(a, b)| 0.5 * (a + b)).collect();
            let forces = nodal_forces(force, &midstep, &variables);
            let matrix = tangent(force, &midstep, &variables);
            let largest = matrix.iter().fold(0.0_f64, |max, k| max.max(k.abs()));
            let direction: Vec<f64> = (0..order).map(|_| random.within(-1.0, 1.0)).collect();
            let [below, above] = [-1e-10, 1e-10].map(|h| {
                let u: Vec<f64> = midstep.iter().zip(&direction).map(|(u, d)| u + h * d).collect();
                nodal_forces(force, &u, &variables)
            });
            for i in 0..order {
                let row = &matrix[i * order..(i + 1) * order];
                let expected: f64 = row.iter().zip(&direction).map(|(k, d)| k * d).sum();
                // Not across a kink.
                let bend = (above[i] - 2.0 * forces[i] + below[i]).abs();
                if bend < 1e-6 * largest * 1e-10 {
                    let error = ((above[i] - below[i]) / 2e-10 - expected).abs() / largest;
                    assert!(error < 1e-6, "{name}, step {step}: {error:e}");
                    checked_count += 1;
                }
                for j in 0..i {
                    let asymmetry = (row[j] - matrix[j * order + i]).abs();
                    assert!(asymmetry < 1e-14 * largest, "{name}: {asymmetry:e}");
                }
            }
            let energy =
                |u: &[f64], variables: &[f64]| force.energy(&NODE_POINTS, u, variables).unwrap();
            let before = energy(&start, &variables);
            let after = energy(&end, &variables);
            let work: f64 =
                forces.iter().zip(start.iter().zip(&end)).map(|(f, (a, b))| f * (b - a)).sum();
            let stored = after.stored - before.stored;
            let dissipated = after.dissipated - before.dissipated;
            let remainder =
                force.remainder(&NODE_POINTS, [&start, &midstep, &end], &variables).unwrap();
            let scale = after.stored + before.stored + work.abs();
            let error = (work - stored - dissipated - remainder).abs() / scale;
            assert!(error < 1e-12, "{name}, step {step}: {error:e}");
            if is_associated {
                assert!(dissipated >= -1e-13 * scale, "{name}, step {step}: {dissipated:e}");
                assert!(remainder >= -1e-13 * scale, "{name}, step {step}: {remainder:e}");
            }
            let end_forces = nodal_forces(force, &end, &variables);
            force.commit(&NODE_POINTS, &end, &mut variables);
            // A commit changes neither forces nor energies.
            let committed = nodal_forces(force, &end, &variables);
            for (value, expected) in committed.iter().zip(&end_forces) {
                assert!((value - expected).abs() < 1e-13 * largest, "{name}, step {step}");
            }
            let committed_energy = energy(&end, &variables);
            assert!((committed_energy.dissipated - after.dissipated).abs() < 1e-12 * scale);
            start = end;
        }
        assert!(checked_count > 200 * order, "{name}: {checked_count}");
    }
}

/// Rotations of a path with its moments: slopes k and b k, an elastic range of 2 M_p after each reversal.
#[test]
fn a_bilinear_hinge_follows_masings_path() {
    let law = BilinearMoment::new(400.0e3, 40.0e6, 0.01).unwrap();
    let hinge = Hinge::new([0, 1], 1.0e9, law).unwrap();
    let force = hinge.inelastic().unwrap();
    let mut variables = initial_variables(force);
    let path = [
        (0.005, 200.0e3),
        (0.03, 408.0e3),
        (0.02, 8.0e3),
        (-0.02, -404.0e3),
        (0.0, 396.0e3),
        (0.05, 416.0e3),
    ];
    for (rotation, moment) in path {
        let displacement = [0.0, 0.0, 0.001, 0.0, 0.0, rotation + 0.001];
        let forces = nodal_forces(force, &displacement, &variables);
        assert!((forces[5] / moment - 1.0).abs() < 1e-10, "{rotation}: {}", forces[5]);
        assert_eq!(forces[2], -forces[5]);
        force.commit(&NODE_POINTS, &displacement, &mut variables);
    }
    // The part (1 − b) M_p does work in the plastic rotations 0.02, 0.03 and 0.05.
    let dissipated =
        force.energy(&NODE_POINTS, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.05], &variables).unwrap();
    let expected = 0.99 * 400.0e3 * (0.02 + 0.03 + 0.05);
    assert!((dissipated.dissipated / expected - 1.0).abs() < 1e-10, "{}", dissipated.dissipated);
}

/// Axial force and moment of a hinge by its elongation and rotation, along and about the axis of the member.
fn axial_force_and_moment(
    force: &dyn InelasticForce,
    elongation: f64,
    rotation: f64,
    variables: &[f64],
) -> [f64; 2] {
    let u = [0.0, 0.0, 0.0, 0.6 * elongation, 0.8 * elongation, rotation];
    let forces = nodal_forces(force, &u, variables);
    [0.6 * forces[3] + 0.8 * forces[4], forces[5]]
}

/// Deformations of a hinge with a prescribed axial force.
struct PressedHinge<'a> {
    force: &'a dyn InelasticForce,
    variables: Vec<f64>,
    elongation: f64,
    rotation: f64,
}

impl PressedHinge<'_> {
    /// Rotates in steps, while the axial force grows evenly from one value to another; returns the moment.
    fn rotate(&mut self, rotation: f64, axial_forces: [f64; 2], step_count: usize) -> f64 {
        let start = self.rotation;
        let mut moment = 0.0;
        for step in 1..=step_count {
            let part = step as f64 / step_count as f64;
            let axial_force = axial_forces[0] + part * (axial_forces[1] - axial_forces[0]);
            self.rotation = start + part * (rotation - start);
            // The axial force grows with the elongation: bisection.
            let mut lower = self.elongation - 0.1;
            let mut upper = self.elongation + 0.1;
            for _ in 0..80 {
                self.elongation = 0.5 * (lower + upper);
                let forces = axial_force_and_moment(
                    self.force,
                    self.elongation,
                    self.rotation,
                    &self.variables,
                );
                moment = forces[1];
                if forces[0] < axial_force {
                    lower = self.elongation;
                } else {
                    upper = self.elongation;
                }
            }
            let u = [0.0, 0.0, 0.0, 0.6 * self.elongation, 0.8 * self.elongation, self.rotation];
            self.force.commit(&NODE_POINTS, &u, &mut self.variables);
        }
        moment
    }
}

/// Closed form of the moment capacity of `surfaces` under a ratio of the axial strength.
fn capacity(name: &str, ratio: f64) -> f64 {
    match name {
        "rectangle" => PLASTIC_MOMENT * (1.0 - ratio * ratio),
        "ellipse" => PLASTIC_MOMENT * (1.0 - ratio * ratio).sqrt(),
        _ if ratio >= 0.0 => 250.0e3 * (1.0 - 2.0 * ratio),
        _ if ratio >= -0.75 => 250.0e3 - 50.0e3 / 0.75 * ratio,
        _ => 300.0e3 * (1.0 + ratio) / 0.25,
    }
}

/// The moment reaches the yield surface of its axial force, whatever came before.
#[test]
fn the_limit_moment_lies_on_the_yield_surface_by_any_path() {
    for (name, surface) in surfaces() {
        let hinge = interaction(surface.clone(), 0.0);
        let force = hinge.inelastic().unwrap();
        for ratio in [0.0, 0.3, -0.3, -0.6, -0.9] {
            let axial_force = ratio * AXIAL_STRENGTH;
            let expected = capacity(name, ratio);
            let range = surface.moments_at(axial_force).unwrap();
            assert!((range[1] / expected - 1.0).abs() < 1e-12 && range[0] == -range[1]);
            let undeformed = || PressedHinge {
                force,
                variables: initial_variables(force),
                elongation: 0.0,
                rotation: 0.0,
            };
            // The force first; both together; rotation first, to the other side, with a larger force.
            let mut direct = undeformed();
            direct.rotate(0.0, [0.0, axial_force], 1);
            let mut proportional = undeformed();
            proportional.rotate(0.02, [0.0, axial_force], 40);
            let mut detour = undeformed();
            detour.rotate(-0.03, [0.0, -0.95 * AXIAL_STRENGTH], 10);
            detour.rotate(0.01, [-0.95 * AXIAL_STRENGTH, axial_force], 10);
            for (path, mut hinge) in
                [("direct", direct), ("proportional", proportional), ("detour", detour)]
            {
                let rotation = hinge.rotation + 0.2;
                let moment = hinge.rotate(rotation, [axial_force; 2], 400);
                let error = (moment / expected - 1.0).abs();
                assert!(error < 1e-8, "{name}, {ratio}, {path}: {error:e}");
            }
        }
    }
}

/// Forces and moments of a hinge in space after a path of relative rotations, as vectors of its nodes.
fn moments_along(hinge: &SpaceHinge, path: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let force = hinge.inelastic().unwrap();
    let mut variables = initial_variables(force);
    let mut moments = Vec::new();
    for rotation in path {
        let mut u = [0.0; 12];
        u[9..].copy_from_slice(rotation);
        let forces = nodal_forces(force, &u, &variables);
        force.commit(&NODE_POINTS, &u, &mut variables);
        moments.push([forces[9], forces[10], forces[11]]);
    }
    moments
}

/// A circular yield surface is the same in all directions, and along a line the bilinear law.
#[test]
fn a_circle_is_the_bilinear_law_at_any_angle() {
    let axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    let hinge = SpaceHinge::new([0, 1], axes, 1.0e9, [1.0e8, 40.0e6, 40.0e6], [400.0e3; 2])
        .and_then(|hinge| hinge.with_hardening(0.01))
        .unwrap();
    let rotations = [0.005, 0.03, 0.02, -0.02, 0.0, 0.05];
    let expected = [200.0e3, 408.0e3, 8.0e3, -404.0e3, 396.0e3, 416.0e3];
    for k in 0..24 {
        let angle = 0.1 + 0.26 * f64::from(k);
        let direction = [angle.cos(), angle.sin(), 0.0];
        let path = rotations.map(|rotation| direction.map(|component| rotation * component));
        for (moment, expected) in moments_along(&hinge, &path).iter().zip(expected) {
            let along = moment[0] * direction[0] + moment[1] * direction[1];
            let across = moment[1] * direction[0] - moment[0] * direction[1];
            assert!((along / expected - 1.0).abs() < 1e-10, "{angle}: {along} {expected}");
            assert!(across.abs() < 1e-9 * expected.abs(), "{angle}: {across}");
        }
    }
}

/// A path that turns its direction on a circle: dM/ds = k (I − n n) dθ/ds, solved in 10⁵ small steps with n = M/M_p.
#[test]
fn a_circle_follows_a_turning_path_by_associated_flow() {
    let axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    let hinge =
        SpaceHinge::new([0, 1], axes, 1.0e9, [1.0e8, 40.0e6, 40.0e6], [400.0e3; 2]).unwrap();
    let rotation_at = |s: f64| [0.01 + 0.01 * s, 0.02 * s * s, 0.0];
    // Yield begins at 0.01 rad about x. M = M_p [cos φ, sin φ]: M_p dφ = k (−sin φ dθ_x + cos φ dθ_y).
    let step_count = 4000;
    let mut angle = 0.0_f64;
    let rate = |s: f64, angle: f64| 100.0 * (-angle.sin() * 0.01 + angle.cos() * 0.04 * s);
    let h = 1.0 / f64::from(step_count);
    for step in 0..step_count {
        let s = f64::from(step) * h;
        let k1 = rate(s, angle);
        let k2 = rate(s + 0.5 * h, angle + 0.5 * h * k1);
        let k3 = rate(s + 0.5 * h, angle + 0.5 * h * k2);
        let k4 = rate(s + h, angle + h * k3);
        angle += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    let path: Vec<[f64; 3]> =
        (0..=step_count).map(|step| rotation_at(f64::from(step) * h)).collect();
    let moment = moments_along(&hinge, &path)[path.len() - 1];
    assert!((moment[0].hypot(moment[1]) / 400.0e3 - 1.0).abs() < 1e-12);
    assert!((moment[1].atan2(moment[0]) - angle).abs() < 1e-3 * angle, "{angle}");
}

/// A rigid arm: the hinge at the second node feels no rigid motion, and rotations move its far end.
#[test]
fn rigid_motions_cause_no_force_on_a_rigid_arm() -> Result<()> {
    let points = [[3.0, 2.0, 0.0], [3.4, 2.9, 0.0]];
    let law = BilinearMoment::new(400.0e3, 40.0e6, 0.01)?;
    let hinge = Hinge::new([0, 1], 1.0e9, law)?.with_rigid_arm();
    hinge.check(&points)?;
    let force = hinge.inelastic().unwrap();
    let variables = vec![0.0; force.variable_count()];
    // A rotation by 1 mrad about the origin.
    let rigid = [-2.0e-3, 3.0e-3, 1.0e-3, -2.9e-3, 3.4e-3, 1.0e-3];
    let mut forces = [0.0; 6];
    force.force(&points, &rigid, &variables, &mut forces)?;
    assert!(forces.iter().all(|force| force.abs() < 1e-6), "{forces:?}");
    // The first node turns alone: the end of its arm moves by −0.9 mm and 0.4 mm.
    force.force(&points, &[0.0, 0.0, 1.0e-3, 0.0, 0.0, 0.0], &variables, &mut forces)?;
    assert!((forces[3] - 0.9e6).abs() < 1e-3 && (forces[4] + 0.4e6).abs() < 1e-3, "{forces:?}");
    assert!((forces[5] + 40.0e3).abs() < 1e-6);
    Ok(())
}
