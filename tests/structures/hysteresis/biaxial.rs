//! GOAL: hysteretic springs in a plane.
//! SCENE: prescribed paths of two components.
//! REFERENCE: the uniaxial laws, rotation, closed forms on a circle, the Bouc–Wen differential equation, differences.

use std::f64::consts::{SQRT_2, TAU};

use basemat::structure::{
    BiaxialSpring, Bilinear, BoucWen, FrictionPendulum, Hysteresis, LeadRubber, NonlinearForce,
    RigidBlock, Triplets, WithSprings,
};
use basemat::{Error, Result};

use basemat_problems::random::Random;

const STIFFNESS: f64 = 2e7;
const LIMIT: f64 = 1e5;

/// Each law, uniaxial and coupled.
fn laws() -> Vec<(String, Box<dyn Hysteresis>, BiaxialSpring)> {
    fn both<L: Hysteresis + 'static>(
        name: &str,
        law: L,
        coupled: BiaxialSpring,
    ) -> (String, Box<dyn Hysteresis>, BiaxialSpring) {
        (name.into(), Box::new(law), coupled)
    }
    let bilinear = Bilinear::new(STIFFNESS, LIMIT, 0.1).unwrap();
    let pendulum = FrictionPendulum::new(1e6, 2.0, 0.06).unwrap();
    let lead = LeadRubber::new(0.4e6, 0.5, 0.2, 0.01).unwrap();
    let mut laws = vec![
        both("bilinear", bilinear.clone(), bilinear.coupled()),
        both("pendulum", pendulum.clone(), pendulum.coupled()),
        both("lead–rubber", lead.clone(), lead.coupled()),
    ];
    for beta in [0.5, 0.8, 1.0] {
        let law = bouc_wen(0.05, beta);
        let coupled = law.coupled().unwrap();
        laws.push(both(&format!("Bouc–Wen {beta}"), law, coupled));
    }
    laws
}

fn bouc_wen(hardening: f64, beta: f64) -> BoucWen {
    BoucWen::new(STIFFNESS, LIMIT, hardening).and_then(|law| law.with_shape(2.0, beta)).unwrap()
}

/// A path of random steps, some far beyond yield and some tiny.
fn path(seed: u64, steps: usize) -> Vec<[f64; 2]> {
    let mut random = Random(seed);
    let mut at = [0.0; 2];
    let mut step = || {
        let size = random.log_within(1e-4, 3e-2);
        at = at.map(|d| 0.9 * d + size * random.within(-1.0, 1.0));
        at
    };
    (0..steps).map(|_| step()).collect()
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Along a line through the origin, in any direction, with force, tangent and energies.
#[test]
fn along_a_line_it_is_the_uniaxial_spring() {
    for (name, uniaxial, coupled) in laws() {
        for angle in [0.0, TAU / 8.0, 1.0, 2.5, 4.0] {
            let (mut line, mut plane) = (uniaxial.clone(), coupled.clone());
            for [d, _] in path(3, 60) {
                let at = turned([d, 0.0], angle);
                let (expected, found) = (line.response(d), plane.response(at));
                let force = turned([expected.force, 0.0], angle);
                assert!(distance(found.force, force) < 1e-12 * 1e6, "{name} {angle} {d}");
                let along_of = |tangent: &[[f64; 2]; 2]| {
                    let rows = tangent.map(|row| row[0] * angle.cos() + row[1] * angle.sin());
                    rows[0] * angle.cos() + rows[1] * angle.sin()
                };
                let along = along_of(&found.tangent);
                assert!((along - expected.tangent).abs() < 1e-9 * 1e8, "{name} {angle} {d}");
                let energy = [line.energy(d), plane.energy(at)];
                let scale = energy[0].stored + energy[0].dissipated;
                assert!((energy[0].stored - energy[1].stored).abs() < 1e-12 * scale, "{name}");
                let lost = energy.map(|energy| energy.dissipated);
                assert!((lost[0] - lost[1]).abs() < 1e-12 * scale, "{name} {lost:?}");
                line.commit(d);
                plane.commit(at);
                if name.starts_with("Bouc") {
                    // Where the next way is not known, it unloads.
                    let next = [line.response(d).tangent, along_of(&plane.response(at).tangent)];
                    assert!((next[0] - next[1]).abs() < 1e-9 * 1e8, "{name}: {next:?}");
                }
            }
        }
    }
}

/// If a path turns by an angle, force, tangent and nothing else turn with it.
#[test]
fn a_turned_path_turns_the_force() {
    for (name, _, coupled) in laws() {
        for angle in [0.3, TAU / 8.0, 1.9] {
            let (mut straight, mut oblique) = (coupled.clone(), coupled.clone());
            for d in path(5, 100) {
                let at = turned(d, angle);
                let [here, there] = [straight.response(d), oblique.response(at)];
                assert!(distance(there.force, turned(here.force, angle)) < 1e-12 * 1e6, "{name}");
                // R T Rᵀ
                let columns = here.tangent.map(|row| turned(row, angle));
                let [first, second] = [0, 1].map(|k| turned([columns[0][k], columns[1][k]], angle));
                let error = distance(there.tangent[0], [first[0], second[0]])
                    + distance(there.tangent[1], [first[1], second[1]]);
                assert!(error < 1e-9 * 1e8, "{name}: {error}");
                straight.commit(d);
                oblique.commit(at);
            }
            let [a, b] = [straight, oblique].map(|spring| spring.energy([0.0; 2]));
            assert!((a.dissipated - b.dissipated).abs() < 1e-11 * a.dissipated, "{name}");
        }
    }
}

/// On a circle of radius A, a perfectly plastic force lags behind the velocity by asin(d_y/A).
///
/// Steps of the angle δ put slider and deformation on circles with A² = ρ² cos² ½δ + (ρ sin ½δ + d_y)², and the slider
/// goes 2 ρ sin ½δ a step.
#[test]
fn on_a_circle_the_force_lags_by_a_constant_angle() {
    let (radius, yield_displacement) = (0.02, LIMIT / STIFFNESS);
    let plastic = Bilinear::new(STIFFNESS, LIMIT, 0.0).unwrap().coupled();
    let smooth = bouc_wen(0.0, 0.7).coupled().unwrap();
    for (mut spring, steps) in [(plastic.clone(), 24), (plastic, 2000), (smooth, 2000)] {
        let is_smooth = spring.save().len() == 5;
        let angle = TAU / f64::from(steps);
        let mut lost = 0.0;
        for k in 0..=(4 * steps) {
            let at = turned([radius, 0.0], angle * f64::from(k));
            if k == 3 * steps {
                lost = spring.energy(at).dissipated;
            }
            spring.commit(at);
        }
        let force = spring.response([radius, 0.0]).force;
        let per_turn = spring.energy([radius, 0.0]).dissipated - lost;
        let half = (0.5 * angle).sin();
        let rho = (radius.powi(2) - (yield_displacement * (0.5 * angle).cos()).powi(2)).sqrt()
            - yield_displacement * half;
        if is_smooth {
            // The velocity points along y.
            let lag = (yield_displacement / radius).asin();
            assert!(distance(force, turned([0.0, LIMIT], -lag)) < 1e-3 * LIMIT, "{force:?}");
            let expected = TAU * LIMIT * radius * lag.cos();
            assert!((per_turn / expected - 1.0).abs() < 1e-4, "{per_turn} {expected}");
        } else {
            let work = LIMIT * 2.0 * rho * half * f64::from(steps);
            assert!((per_turn / work - 1.0).abs() < 1e-12, "{per_turn} {work}");
            // The radius of the deformation is the sum of slip and elastic deformation.
            let slip = [0, 1].map(|k| [radius, 0.0][k] - force[k] / STIFFNESS);
            assert!((slip[0].hypot(slip[1]) / rho - 1.0).abs() < 1e-12);
            let lag = (yield_displacement / radius).asin();
            let expected = turned([0.0, LIMIT], -lag);
            assert!(distance(force, expected) < 1.1 * half * LIMIT, "{force:?} {expected:?}");
        }
    }
}

/// Runge–Kutta on z' = e − (β |e·z| + γ e·z) z along straight pieces.
#[test]
fn coupled_bouc_wen_follows_its_differential_equation() {
    for beta in [0.5, 0.65, 1.0] {
        let gamma = 1.0 - beta;
        let mut spring = bouc_wen(0.0, beta).coupled().unwrap();
        let (mut z, mut from, mut lost) = ([0.0; 2], [0.0; 2], 0.0);
        for to in path(17, 25) {
            let pieces = 600;
            let change = [0, 1].map(|k| (to[k] - from[k]) * STIFFNESS / LIMIT / f64::from(pieces));
            let rate = |z: [f64; 2]| {
                let along = change[0] * z[0] + change[1] * z[1];
                let fading = beta * along.abs() + gamma * along;
                [0, 1].map(|k| change[k] - fading * z[k])
            };
            let shifted =
                |z: [f64; 2], by: [f64; 2], part: f64| [0, 1].map(|k| z[k] + part * by[k]);
            for _ in 0..pieces {
                let a = rate(z);
                let b = rate(shifted(z, a, 0.5));
                let c = rate(shifted(z, b, 0.5));
                let d = rate(shifted(z, c, 1.0));
                let next = [0, 1].map(|k| z[k] + (a[k] + 2.0 * (b[k] + c[k]) + d[k]) / 6.0);
                // Simpson's rule for the work
                let middle =
                    [0, 1].map(|k| 0.5 * (z[k] + next[k]) + 0.125 * (a[k] - rate(next)[k]));
                lost += [0, 1]
                    .map(|k| (z[k] + 4.0 * middle[k] + next[k]) / 6.0 * change[k])
                    .iter()
                    .sum::<f64>();
                z = next;
            }
            spring.commit(to);
            let force = spring.response(to).force;
            let expected = z.map(|z| LIMIT * z);
            assert!(distance(force, expected) < 1e-7 * LIMIT, "β = {beta}: {force:?} {expected:?}");
            from = to;
        }
        let energy = spring.energy(from);
        let work = lost * LIMIT * LIMIT / STIFFNESS;
        let told = energy.stored + energy.dissipated;
        assert!((work / told - 1.0).abs() < 1e-7, "β = {beta}: {work} J, {told} J told");
    }
}

/// Central differences of force and energy, along a path.
#[test]
fn tangent_and_force_are_slopes_of_force_and_energy() {
    for (name, _, mut spring) in laws() {
        let is_smooth = name.starts_with("Bouc");
        let mut compared = 0;
        let (mut lost, mut last) = (0.0, [0.0; 2]);
        for d in path(7, 80) {
            let h = 1e-8;
            let beside = |k: usize, by: f64| {
                let mut there = d;
                there[k] += by;
                there
            };
            let here = spring.response(d);
            let mut difference = [[0.0; 2]; 2];
            let mut is_kink = false;
            for k in 0..2 {
                let [below, above] = [-h, h].map(|by| spring.response(beside(k, by)));
                for i in 0..2 {
                    difference[i][k] = (above.force[i] - below.force[i]) / (2.0 * h);
                    is_kink |= distance(above.tangent[i], below.tangent[i]) > 1e-3 * STIFFNESS;
                }
            }
            if !is_kink {
                compared += 1;
                let mean = 0.5 * (difference[0][1] + difference[1][0]);
                let skew = 0.5 * (difference[0][1] - difference[1][0]).abs();
                assert!(is_smooth || skew < 1e-5 * STIFFNESS, "{name}: {skew}");
                assert!(skew < 0.15 * STIFFNESS, "{name}: {skew}");
                assert_eq!(here.tangent[0][1], here.tangent[1][0], "{name}");
                for (i, j, slope) in
                    [(0, 0, difference[0][0]), (1, 1, difference[1][1]), (0, 1, mean)]
                {
                    let found = here.tangent[i][j];
                    assert!((found - slope).abs() < 1e-5 * STIFFNESS, "{name}: {found} {slope}");
                }
            }
            // The work along the path, by the force at points of it.
            let pieces = 200;
            let force = |part: f64| {
                let at = [0, 1].map(|k| last[k] + part * (d[k] - last[k]));
                let force = spring.response(at).force;
                force[0] * (d[0] - last[0]) + force[1] * (d[1] - last[1])
            };
            let work: f64 = (0..pieces)
                .map(|piece| {
                    let at = |part: f64| force((f64::from(piece) + part) / f64::from(pieces));
                    (at(0.0) + 4.0 * at(0.5) + at(1.0)) / (6.0 * f64::from(pieces))
                })
                .sum();
            let [start, end] = [last, d].map(|at| spring.energy(at));
            assert!(end.dissipated >= lost && end.stored >= 0.0, "{name}");
            let told = end.stored + end.dissipated - start.stored - start.dissipated;
            // Simpson's rule meets a kink on most ways of the bilinear laws.
            let tolerance = if is_smooth { 1e-6 } else { 3e-4 };
            let scale = LIMIT * distance(last, d) + 1e-3;
            assert!((work - told).abs() < tolerance * scale, "{name}: {work} J, {told} J told");
            spring.commit(d);
            let added = spring.energy(d).dissipated - end.dissipated;
            assert!(added.abs() <= 1e-15 * end.dissipated, "{name}: a commit adds {added} J");
            (lost, last) = (end.dissipated, d);
        }
        assert!(compared > 40 && lost > 1e3, "{name}: {compared}, {lost} J");
    }
}

/// Two uniaxial sliders carry √2 times their friction on the diagonal, a coupled one carries its friction.
#[test]
fn two_sliders_along_the_axes_are_stronger_on_the_diagonal() {
    let law = Bilinear::new(STIFFNESS, LIMIT, 0.0).unwrap();
    let both = law.response(0.1).force * SQRT_2;
    let [x, y] = law.coupled().response([0.1, 0.1]).force;
    assert!((x.hypot(y) / LIMIT - 1.0).abs() < 1e-14 && (both / LIMIT - SQRT_2).abs() < 1e-14);
}

#[test]
fn bad_states_and_wild_deformations_are_no_panic() {
    let input = |made: Result<BiaxialSpring>| matches!(made, Err(Error::Input { .. }));
    for exponent in [1.0, 1.999, 10.0] {
        let law = BoucWen::new(1e7, 1e5, 0.1).and_then(|law| law.with_shape(exponent, 0.5));
        assert!(input(law.unwrap().coupled()));
    }
    for (name, _, mut spring) in laws() {
        spring.commit([0.02, -0.05]);
        let (saved, before) = (spring.save(), spring.response([0.03, 0.01]));
        for place in 0..saved.len() {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut wrong = saved.clone();
                wrong[place] = bad;
                assert!(matches!(spring.restore(&wrong), Err(Error::Checkpoint(_))), "{name}");
                assert_eq!(spring.response([0.03, 0.01]), before);
            }
        }
        let mut wrong = saved.clone();
        *wrong.last_mut().unwrap() = -1.0;
        assert!(spring.restore(&wrong).is_err() && spring.restore(&saved[1..]).is_err());
        if saved.len() == 5 {
            assert!(spring.restore(&[0.0, 0.0, 0.8, 0.7, 0.0]).is_err());
        }
        spring.commit([-0.04, 0.01]);
        assert_ne!(spring.response([0.03, 0.01]), before);
        spring.restore(&saved).unwrap();
        assert_eq!(spring.response([0.03, 0.01]), before);
        for wild in [f64::NAN, f64::INFINITY] {
            let force = spring.response([wild, 0.0]).force;
            assert!(force.iter().any(|force| !force.is_finite()), "{name}: {force:?}");
            assert!(!spring.energy([0.1, wild]).dissipated.is_finite(), "{name}");
        }
        let far = spring.response([1e300, -1e300]);
        assert!(!far.force[0].is_nan() && far.tangent.iter().flatten().all(|k| k.is_finite()));
    }
}

/// Springs of both kinds on the degrees of freedom of a block: force, tangent, energy and saved states.
#[test]
fn springs_of_both_kinds_act_on_their_degrees_of_freedom() {
    let block = || WithSprings::new(RigidBlock::new(2.0, 4.0, 2000.0).unwrap());
    let (one, two) =
        (Bilinear::new(STIFFNESS, LIMIT, 0.1).unwrap(), bouc_wen(0.05, 0.7).coupled().unwrap());
    let rows = [vec![(0, 1.0), (2, 3.0)], vec![(1, -2.0)]];
    let mut held = block()
        .spring((2, 0.5), one.clone())
        .and_then(|held| held.biaxial_spring(rows, two.clone()))
        .unwrap();
    let force = |held: &WithSprings, u: [f64; 3]| {
        let mut force = [0.0; 3];
        held.force(&u, &mut force).unwrap();
        force
    };
    let u = [0.004, -0.006, 0.003];
    let uniaxial = one.response(0.5 * u[2]).force;
    let [x, y] = two.response([u[0] + 3.0 * u[2], -2.0 * u[1]]).force;
    assert_eq!(force(&held, u), [x, -2.0 * y, 0.5 * uniaxial + 3.0 * x]);
    let mut matrix = Triplets::new(3);
    held.tangent(&u, &mut matrix).unwrap();
    let mut tangent = [[0.0; 3]; 3];
    matrix.entries().iter().for_each(|&(i, j, value)| tangent[i][j] += value);
    for k in 0..3 {
        let [below, above] = [-1e-8, 1e-8].map(|by| {
            let mut there = u;
            there[k] += by;
            force(&held, there)
        });
        for i in 0..3 {
            let slope = (above[i] - below[i]) / 2e-8;
            assert!((tangent[i][k] - slope).abs() < 1e-5 * STIFFNESS, "{i} {k}: {slope}");
            assert_eq!(tangent[i][k], tangent[k][i]);
        }
    }
    held.commit(&u);
    let (saved, before) = (held.save().unwrap(), force(&held, [0.0; 3]));
    assert_eq!(saved.len(), 2 + 5);
    let mut wrong = saved.clone();
    wrong[5] = 2.0;
    wrong[0] += 0.01;
    assert!(matches!(held.restore(&wrong), Err(Error::Checkpoint(_))));
    assert_eq!(force(&held, [0.0; 3]), before);
    held.commit(&[0.0, 0.01, 0.02]);
    held.restore(&saved).unwrap();
    assert_eq!(force(&held, [0.0; 3]), before);
    let far = block().biaxial_spring([vec![(0, 1.0)], vec![(3, 1.0)]], two.clone());
    assert!(matches!(far, Err(Error::Index { index: 3, .. })));
    let wild = block().biaxial_spring([vec![(0, f64::NAN)], vec![(1, 1.0)]], two);
    assert!(matches!(wild, Err(Error::Input { .. })));
}
