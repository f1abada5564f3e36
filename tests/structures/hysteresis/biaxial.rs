//! GOAL: hysteretic springs in a plane.
//! SCENE: prescribed paths of two components.
//! REFERENCE: the uniaxial laws, rotation, closed forms on a circle, the Bouc–Wen differential equation, differences.

use std::f64::consts::TAU;

use basemat::structure::{
    BiaxialSpring, Bilinear, BoucWen, FrictionPendulum, Hysteresis, LeadRubber,
};

use basemat_problems::random::Random;

pub(super) const INITIAL_STIFFNESS: f64 = 2e7;
pub(super) const YIELD_FORCE: f64 = 1e5;

/// A law, uniaxial and coupled.
pub(super) struct LawPair {
    pub(super) name: String,
    uniaxial: Box<dyn Hysteresis>,
    pub(super) coupled: BiaxialSpring,
}

fn law_pair(name: &str, law: impl Hysteresis + 'static, coupled: BiaxialSpring) -> LawPair {
    LawPair { name: name.into(), uniaxial: Box::new(law), coupled }
}

pub(super) fn laws() -> Vec<LawPair> {
    let bilinear = Bilinear::new(INITIAL_STIFFNESS, YIELD_FORCE, 0.1).unwrap();
    let pendulum = FrictionPendulum::new(1e6, 2.0, 0.06).unwrap();
    let lead = LeadRubber::new(0.4e6, 0.5, 0.2, 0.01).unwrap();
    let mut laws = vec![
        law_pair("bilinear", bilinear.clone(), bilinear.coupled()),
        law_pair("pendulum", pendulum.clone(), pendulum.coupled()),
        law_pair("lead–rubber", lead.clone(), lead.coupled()),
    ];
    for beta in [0.5, 0.8, 1.0] {
        let law = bouc_wen(0.05, beta);
        let coupled = law.coupled().unwrap();
        laws.push(law_pair(&format!("Bouc–Wen {beta}"), law, coupled));
    }
    laws
}

pub(super) fn bouc_wen(hardening: f64, beta: f64) -> BoucWen {
    BoucWen::new(INITIAL_STIFFNESS, YIELD_FORCE, hardening)
        .and_then(|law| law.with_shape(2.0, beta))
        .unwrap()
}

/// A path of random steps, some far beyond yield and some tiny.
fn path(seed: u64, steps: usize) -> Vec<[f64; 2]> {
    let mut random = Random(seed);
    let mut at = [0.0; 2];
    let mut path = Vec::new();
    for _ in 0..steps {
        let size = random.log_within(1e-4, 3e-2);
        at = at.map(|d| 0.9 * d + size * random.within(-1.0, 1.0));
        path.push(at);
    }
    path
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Component of a tangent along a direction.
fn tangent_along(tangent: &[[f64; 2]; 2], angle: f64) -> f64 {
    let rows = tangent.map(|row| row[0] * angle.cos() + row[1] * angle.sin());
    rows[0] * angle.cos() + rows[1] * angle.sin()
}

/// Along a line through the origin, in any direction, with force, tangent and energies.
#[test]
fn along_a_line_a_coupled_spring_is_the_uniaxial_one() {
    for LawPair { name, uniaxial, coupled } in laws() {
        for angle in [0.0, TAU / 8.0, 1.0, 2.5, 4.0] {
            let mut line = uniaxial.clone();
            let mut plane = coupled.clone();
            for [d, _] in path(3, 60) {
                let at = turned([d, 0.0], angle);
                let expected = line.response(d);
                let computed = plane.response(at);
                let force = turned([expected.force, 0.0], angle);
                assert!(distance(computed.force, force) < 1e-12 * 1e6, "{name} {angle} {d}");
                let along = tangent_along(&computed.tangent, angle);
                assert!((along - expected.tangent).abs() < 1e-9 * 1e8, "{name} {angle} {d}");
                let energy = [line.energy(d), plane.energy(at)];
                let scale = energy[0].stored + energy[0].dissipated;
                assert!((energy[0].stored - energy[1].stored).abs() < 1e-12 * scale, "{name}");
                let dissipated_energies = energy.map(|energy| energy.dissipated);
                assert!((dissipated_energies[0] - dissipated_energies[1]).abs() < 1e-12 * scale, "{name} {dissipated_energies:?}");
                line.commit(d);
                plane.commit(at);
                if name.starts_with("Bouc") {
                    // Right after a commit the tangent is that of unloading.
                    let plane_tangent = tangent_along(&plane.response(at).tangent, angle);
                    let tangents = [line.response(d).tangent, plane_tangent];
                    assert!((tangents[0] - tangents[1]).abs() < 1e-9 * 1e8, "{name}: {tangents:?}");
                }
            }
        }
    }
}

/// If a path turns by an angle, force and tangent turn with it; energies are the same.
#[test]
fn a_turned_path_turns_the_force() {
    for LawPair { name, coupled, .. } in laws() {
        for angle in [0.3, TAU / 8.0, 1.9] {
            let mut straight_spring = coupled.clone();
            let mut oblique = coupled.clone();
            for d in path(5, 100) {
                let at = turned(d, angle);
                let straight_response = straight_spring.response(d);
                let oblique_response = oblique.response(at);
                assert!(distance(oblique_response.force, turned(straight_response.force, angle)) < 1e-12 * 1e6, "{name}");
                // R T Rᵀ
                let columns = straight_response.tangent.map(|row| turned(row, angle));
                let rotated_tangent = [0, 1].map(|k| turned([columns[0][k], columns[1][k]], angle));
                let error = distance(oblique_response.tangent[0], [rotated_tangent[0][0], rotated_tangent[1][0]])
                    + distance(oblique_response.tangent[1], [rotated_tangent[0][1], rotated_tangent[1][1]]);
                assert!(error < 1e-9 * 1e8, "{name}: {error}");
                straight_spring.commit(d);
                oblique.commit(at);
            }
            let expected = straight_spring.energy([0.0; 2]).dissipated;
            let computed = oblique.energy([0.0; 2]).dissipated;
            assert!((expected - computed).abs() < 1e-11 * expected, "{name}");
        }
    }
}

/// On a circle of radius A, a perfectly plastic force lags behind the velocity by asin(d_y/A).
///
/// Steps of the angle δ put slider and deformation on circles with A² = ρ² cos² ½δ + (ρ sin ½δ + d_y)², and the slider
/// goes 2 ρ sin ½δ a step.
#[test]
fn on_a_circle_the_force_lags_by_a_constant_angle() {
    let radius = 0.02;
    let yield_displacement = YIELD_FORCE / INITIAL_STIFFNESS;
    let plastic_spring = Bilinear::new(INITIAL_STIFFNESS, YIELD_FORCE, 0.0).unwrap().coupled();
    let smooth_spring = bouc_wen(0.0, 0.7).coupled().unwrap();
    for (mut spring, steps) in [(plastic_spring.clone(), 24), (plastic_spring, 2000), (smooth_spring, 2000)] {
        let is_smooth = spring.save().len() == 5;
        let angle = TAU / f64::from(steps);
        let mut dissipated_energy = 0.0;
        for k in 0..=(4 * steps) {
            let at = turned([radius, 0.0], angle * f64::from(k));
            if k == 3 * steps {
                dissipated_energy = spring.energy(at).dissipated;
            }
            spring.commit(at);
        }
        let force = spring.response([radius, 0.0]).force;
        let per_turn = spring.energy([radius, 0.0]).dissipated - dissipated_energy;
        let half = (0.5 * angle).sin();
        let rho = (radius.powi(2) - (yield_displacement * (0.5 * angle).cos()).powi(2)).sqrt()
            - yield_displacement * half;
        if is_smooth {
            // The velocity points along y.
            let lag = (yield_displacement / radius).asin();
            assert!(
                distance(force, turned([0.0, YIELD_FORCE], -lag)) < 1e-3 * YIELD_FORCE,
                "{force:?}"
            );
            let expected = TAU * YIELD_FORCE * radius * lag.cos();
            assert!((per_turn / expected - 1.0).abs() < 1e-4, "{per_turn} {expected}");
        } else {
            let work = YIELD_FORCE * 2.0 * rho * half * f64::from(steps);
            assert!((per_turn / work - 1.0).abs() < 1e-12, "{per_turn} {work}");
            // The radius of the deformation is the sum of slip and elastic deformation.
            let slip = [0, 1].map(|k| [radius, 0.0][k] - force[k] / INITIAL_STIFFNESS);
            assert!((slip[0].hypot(slip[1]) / rho - 1.0).abs() < 1e-12);
            let lag = (yield_displacement / radius).asin();
            let expected = turned([0.0, YIELD_FORCE], -lag);
            assert!(distance(force, expected) < 1.1 * half * YIELD_FORCE, "{force:?} {expected:?}");
        }
    }
}

/// Rate of z per change of the deformation over the yield displacement.
fn bouc_wen_rate(z: [f64; 2], change: [f64; 2], beta: f64) -> [f64; 2] {
    let along = change[0] * z[0] + change[1] * z[1];
    let fading = beta * along.abs() + (1.0 - beta) * along;
    [0, 1].map(|k| change[k] - fading * z[k])
}

fn shifted(z: [f64; 2], rate: [f64; 2], part: f64) -> [f64; 2] {
    [0, 1].map(|k| z[k] + part * rate[k])
}

/// Runge–Kutta on z' = e − (β |e·z| + γ e·z) z along straight pieces.
#[test]
fn coupled_bouc_wen_follows_its_differential_equation() {
    for beta in [0.5, 0.65, 1.0] {
        let mut spring = bouc_wen(0.0, beta).coupled().unwrap();
        let mut z = [0.0; 2];
        let mut start = [0.0; 2];
        let mut work = 0.0;
        for to in path(17, 25) {
            let pieces = 600;
            let change = [0, 1]
                .map(|k| (to[k] - start[k]) * INITIAL_STIFFNESS / YIELD_FORCE / f64::from(pieces));
            for _ in 0..pieces {
                let a = bouc_wen_rate(z, change, beta);
                let b = bouc_wen_rate(shifted(z, a, 0.5), change, beta);
                let c = bouc_wen_rate(shifted(z, b, 0.5), change, beta);
                let d = bouc_wen_rate(shifted(z, c, 1.0), change, beta);
                let next_z = [0, 1].map(|k| z[k] + (a[k] + 2.0 * (b[k] + c[k]) + d[k]) / 6.0);
                // Simpson's rule for the work
                let last_rate = bouc_wen_rate(next_z, change, beta);
                let middle = [0, 1].map(|k| 0.5 * (z[k] + next_z[k]) + 0.125 * (a[k] - last_rate[k]));
                work += [0, 1]
                    .map(|k| (z[k] + 4.0 * middle[k] + next_z[k]) / 6.0 * change[k])
                    .iter()
                    .sum::<f64>();
                z = next_z;
            }
            spring.commit(to);
            let force = spring.response(to).force;
            let expected = z.map(|z| YIELD_FORCE * z);
            assert!(
                distance(force, expected) < 1e-7 * YIELD_FORCE,
                "β = {beta}: {force:?} {expected:?}"
            );
            start = to;
        }
        let energy = spring.energy(start);
        let work = work * YIELD_FORCE * YIELD_FORCE / INITIAL_STIFFNESS;
        let expected = energy.stored + energy.dissipated;
        assert!((work / expected - 1.0).abs() < 1e-7, "β = {beta}: {work} J, not {expected} J");
    }
}

fn moved_along(point: [f64; 2], k: usize, by: f64) -> [f64; 2] {
    let mut shifted_point = point;
    shifted_point[k] += by;
    shifted_point
}

/// Force times the path from `start` to `end`, at this part of it.
fn work_rate(spring: &BiaxialSpring, start: [f64; 2], end: [f64; 2], part: f64) -> f64 {
    let at = [0, 1].map(|k| start[k] + part * (end[k] - start[k]));
    let force = spring.response(at).force;
    force[0] * (end[0] - start[0]) + force[1] * (end[1] - start[1])
}

/// Central differences of force and energy, along a path.
#[test]
fn tangent_and_force_are_slopes_of_force_and_energy() {
    for LawPair { name, coupled: mut spring, .. } in laws() {
        let is_smooth = name.starts_with("Bouc");
        let mut compared_points = 0;
        let mut dissipated_energy = 0.0;
        let mut previous_point = [0.0; 2];
        for d in path(7, 80) {
            let h = 1e-8;
            let response = spring.response(d);
            let mut difference = [[0.0; 2]; 2];
            let mut is_kink = false;
            for k in 0..2 {
                let below = spring.response(moved_along(d, k, -h));
                let above = spring.response(moved_along(d, k, h));
                for i in 0..2 {
                    difference[i][k] = (above.force[i] - below.force[i]) / (2.0 * h);
                    is_kink |=
                        distance(above.tangent[i], below.tangent[i]) > 1e-3 * INITIAL_STIFFNESS;
                }
            }
            if !is_kink {
                compared_points += 1;
                let mean = 0.5 * (difference[0][1] + difference[1][0]);
                let asymmetry = 0.5 * (difference[0][1] - difference[1][0]).abs();
                assert!(is_smooth || asymmetry < 1e-5 * INITIAL_STIFFNESS, "{name}: {asymmetry}");
                assert!(asymmetry < 0.15 * INITIAL_STIFFNESS, "{name}: {asymmetry}");
                assert_eq!(response.tangent[0][1], response.tangent[1][0], "{name}");
                for (i, j, slope) in
                    [(0, 0, difference[0][0]), (1, 1, difference[1][1]), (0, 1, mean)]
                {
                    let computed = response.tangent[i][j];
                    assert!(
                        (computed - slope).abs() < 1e-5 * INITIAL_STIFFNESS,
                        "{name}: {computed} {slope}"
                    );
                }
            }
            // The work along the path, from the force at points of it.
            let pieces = 200;
            let mut work = 0.0;
            for piece in 0..pieces {
                let rates = [0.0, 0.5, 1.0].map(|part| {
                    let part = (f64::from(piece) + part) / f64::from(pieces);
                    work_rate(&spring, previous_point, d, part)
                });
                work += (rates[0] + 4.0 * rates[1] + rates[2]) / (6.0 * f64::from(pieces));
            }
            let start = spring.energy(previous_point);
            let end = spring.energy(d);
            assert!(end.dissipated >= dissipated_energy && end.stored >= 0.0, "{name}");
            let expected = end.stored + end.dissipated - start.stored - start.dissipated;
            // Simpson's rule has a kink within most steps of the bilinear laws.
            let tolerance = if is_smooth { 1e-6 } else { 3e-4 };
            let scale = YIELD_FORCE * distance(previous_point, d) + 1e-3;
            assert!(
                (work - expected).abs() < tolerance * scale,
                "{name}: {work} J, not {expected} J"
            );
            spring.commit(d);
            let added = spring.energy(d).dissipated - end.dissipated;
            assert!(added.abs() <= 1e-15 * end.dissipated, "{name}: a commit adds {added} J");
            dissipated_energy = end.dissipated;
            previous_point = d;
        }
        assert!(compared_points > 40 && dissipated_energy > 1e3, "{name}: {compared_points}, {dissipated_energy} J");
    }
}
