//! GOAL: hysteretic laws by themselves.
//! SCENE: prescribed paths, cut into steps in many ways.
//! REFERENCE: differences of force and energy, the Bouc–Wen differential equation and its
//! elementary solutions, areas of loops.

use basemat::structure::{Bilinear, BoucWen, FrictionPendulum, Hysteresis, LeadRubber};

use basemat_problems::random::Random;

/// All laws, with a yield displacement between 0.5 mm and 1 cm.
fn laws() -> Vec<(String, Box<dyn Hysteresis>)> {
    let mut laws: Vec<(String, Box<dyn Hysteresis>)> = vec![
        ("bilinear".into(), Box::new(Bilinear::new(2e7, 1e5, 0.1).unwrap())),
        ("plastic".into(), Box::new(Bilinear::new(2e7, 1e5, 0.0).unwrap())),
        ("pendulum".into(), Box::new(FrictionPendulum::new(1e6, 2.0, 0.06).unwrap())),
        ("lead–rubber".into(), Box::new(LeadRubber::new(0.4e6, 0.5, 0.2, 0.01).unwrap())),
    ];
    for (n, beta) in [(1.0, 0.5), (1.0, 0.9), (1.4, 1.0), (2.0, 0.5), (3.3, 0.7), (10.0, 1.0)] {
        let law = BoucWen::new(2e7, 1e5, 0.05).unwrap().with_shape(n, beta).unwrap();
        laws.push((format!("Bouc–Wen {n} {beta}"), Box::new(law)));
    }
    laws
}

/// A path of random steps, some far beyond yield and some tiny.
fn path(random: &mut Random, steps: usize) -> Vec<f64> {
    let mut at = 0.0;
    let mut path = Vec::new();
    for _ in 0..steps {
        at = 0.9 * at + random.within(-1.0, 1.0) * random.log_within(1e-4, 3e-2);
        path.push(at);
    }
    path
}

/// Stored and dissipated energy.
fn total_energy(law: &dyn Hysteresis, d: f64) -> f64 {
    law.energy(d).stored + law.energy(d).dissipated
}

/// Central differences of the force, and of the energy: d(stored + dissipated)/dd is the force.
#[test]
fn tangent_and_force_are_the_slopes_of_force_and_energy() {
    for (name, mut law) in laws() {
        let mut random = Random(7);
        for d in path(&mut random, 100) {
            let h = 1e-8;
            // The slope has kinks at yield and where the path reverses: no difference across them.
            let below = law.response(d - h);
            let tangent = law.response(d).tangent;
            let above = law.response(d + h);
            if (above.tangent - below.tangent).abs() < 1e-3 * tangent.abs() {
                let computed = (above.force - below.force) / (2.0 * h);
                assert!((computed - tangent).abs() < 1e-5 * 2e7, "{name} at {d}: {computed} {tangent}");
                let force = (total_energy(&*law, d + h) - total_energy(&*law, d - h)) / (2.0 * h);
                let expected = law.response(d).force;
                // Stored energy of kilojoules, to its last digits, over 2 h
                let energy = total_energy(&*law, d);
                let tolerance = 1e-15 * energy.abs().max(1.0) / h + 1e-6 * expected.abs();
                assert!((force - expected).abs() < 10.0 * tolerance, "{name}: {force} {expected}");
            }
            law.commit(d);
        }
    }
}

/// The work of the force by Simpson's rule along a path, against the energies of the laws.
#[test]
fn work_is_stored_or_dissipated() {
    for (name, mut law) in laws() {
        let mut random = Random(11);
        let mut work = 0.0;
        let mut previous_deformation = 0.0;
        let mut dissipated_energy = 0.0;
        for d in path(&mut random, 40) {
            let pieces = 300;
            let width = (d - previous_deformation) / f64::from(pieces);
            for k in 0..pieces {
                let forces = [0.0, 0.5, 1.0].map(|part| {
                    let place = f64::from(k) + part;
                    law.response(previous_deformation + (d - previous_deformation) * place / f64::from(pieces)).force
                });
                work += width / 6.0 * (forces[0] + 4.0 * forces[1] + forces[2]);
            }
            let energy = law.energy(d);
            assert!(energy.dissipated >= dissipated_energy && energy.stored >= 0.0, "{name}");
            law.commit(d);
            assert_eq!(law.energy(d).dissipated, energy.dissipated, "{name}: commit adds nothing");
            previous_deformation = d;
            dissipated_energy = energy.dissipated;
        }
        let expected = law.energy(previous_deformation).stored + dissipated_energy;
        assert!(dissipated_energy > 1e3, "{name} never yielded");
        // Simpson's rule has a kink within most steps of the bilinear laws.
        let tolerance = if name.starts_with("Bouc") { 1e-7 } else { 1e-4 };
        assert!(
            (work - expected).abs() < tolerance * expected,
            "{name}: {work} J, not {expected} J"
        );
    }
}

/// A straight path has the same end state in any number of steps.
#[test]
fn steps_of_a_straight_path_have_no_effect() {
    for (name, mut law) in laws() {
        law.commit(0.013);
        for target in [-0.02, 0.004, -0.0045, 0.03] {
            let single_response = law.response(target);
            let energy = law.energy(target);
            let from = law.save();
            let start = if target == -0.02 { 0.013 } else { f64::NAN };
            if start.is_finite() {
                for k in 1..=37 {
                    law.commit(start + (target - start) * f64::from(k) / 37.0);
                }
                let parts = law.response(target);
                assert!((parts.force - single_response.force).abs() < 1e-9 * 1e5, "{name}");
                let losses = [law.energy(target).dissipated, energy.dissipated];
                assert!((losses[0] - losses[1]).abs() < 1e-11 * losses[1], "{name}: {losses:?}");
                law.restore(&from).unwrap();
                assert_eq!(law.response(target), single_response, "{name}");
            }
            law.commit(target);
        }
    }
}

/// dz/dt for the rate v of the deformation.
fn bouc_wen_rate(z: f64, v: f64, n: f64, beta: f64, dy: f64) -> f64 {
    let sign = if v * z > 0.0 { 1.0 } else { -1.0 };
    (1.0 - (beta * sign + (1.0 - beta)) * z.abs().powf(n)) * v / dy
}

/// Runge–Kutta on dz/dt = (1 − (β sgn(ḋ z) + γ)|z|ⁿ) ḋ/d_y in time, in small steps, for a motion of
/// two frequencies; the law is committed at a few dozen points of each half-cycle, turns included.
#[test]
fn bouc_wen_follows_its_differential_equation() {
    let k = 2e7;
    let fy = 1e5;
    let alpha = 0.05;
    let dy = fy / k;
    for (n, beta) in [(1.0, 0.8), (1.5, 0.6), (2.0, 0.5), (5.5, 0.75)] {
        let mut law = BoucWen::new(k, fy, alpha).unwrap().with_shape(n, beta).unwrap();
        let w = std::f64::consts::PI;
        let fine = 20_000_u32;
        let mut z = 0.0_f64;
        let mut max_difference = 0.0_f64;
        // Half-cycles between turns: d runs from turn to turn like a cosine.
        let mut start = 0.0;
        for half in 0..8 {
            let side = if half % 2 == 0 { 1.0 } else { -1.0 };
            let amplitude = dy * (1.5 + 0.4 * f64::from(half));
            let to = side * amplitude;
            let middle = 0.5 * (start + to);
            for step in 0..fine {
                let h = 1.0 / f64::from(fine);
                let t = f64::from(step) * h;
                let [v0, v1, v2] =
                    [t, t + 0.5 * h, t + h].map(|t| 0.5 * (to - start) * w * (w * t).sin());
                let a = bouc_wen_rate(z, v0, n, beta, dy);
                let b = bouc_wen_rate(z + 0.5 * h * a, v1, n, beta, dy);
                let c = bouc_wen_rate(z + 0.5 * h * b, v1, n, beta, dy);
                let d = bouc_wen_rate(z + h * c, v2, n, beta, dy);
                z += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
                if (step + 1) % 500 == 0 {
                    let at = middle - 0.5 * (to - start) * (w * (t + h)).cos();
                    law.commit(at);
                    let expected = alpha * k * at + (1.0 - alpha) * fy * z;
                    max_difference = max_difference.max((law.response(at).force - expected).abs() / fy);
                }
            }
            start = to;
        }
        println!("n = {n}, β = {beta}: error {max_difference:.1e} F_y");
        // Fourth order, but only second where |z|ⁿ has its kink at z = 0.
        assert!(max_difference < 1e-8, "n = {n}, β = {beta}: error {max_difference:e} F_y");
    }
}

/// Force over the yield force at the deformation x over the yield displacement.
fn bouc_wen_force(n: f64, x: f64) -> f64 {
    BoucWen::new(1.0, 1.0, 0.0).unwrap().with_shape(n, 0.8).unwrap().response(x).force
}

/// n = 1 and n = 2 have elementary solutions.
#[test]
fn bouc_wen_has_its_elementary_solutions() {
    for x in [1e-9, 0.01, 0.3, 0.7, 1.0, 3.0, 12.0, 40.0] {
        assert!((bouc_wen_force(1.0, x) + (-x).exp_m1()).abs() < 4e-16, "{x}");
        assert!((bouc_wen_force(2.0, x) - x.tanh()).abs() < 1e-15, "{x}");
    }
    // Unloading from saturation with b = 2β − 1 = 0.6, n = 2: dz/dx = 1 + b z²
    let mut law = BoucWen::new(1.0, 1.0, 0.0).unwrap().with_shape(2.0, 0.8).unwrap();
    law.commit(50.0);
    let b = 0.6_f64.sqrt();
    let turn = b.atan() / b;
    assert!(law.response(50.0 - turn).force.abs() < 1e-14);
    let expected = (b * 0.3).tan() / b;
    assert!((law.response(50.0 - turn + 0.3).force - expected).abs() < 1e-14);
}

/// The loop of full cycles ±D encloses 4 Q (D − d_y) for each of the bilinear laws.
#[test]
fn loops_enclose_their_area() {
    let cases: [(Box<dyn Hysteresis>, f64, f64); 3] = [
        (Box::new(Bilinear::new(1e7, 1e5, 0.2).unwrap()), 0.8e5, 0.01),
        (Box::new(FrictionPendulum::new(1e6, 2.0, 0.05).unwrap()), 0.05e6, 0.5e-3),
        (Box::new(LeadRubber::from_strength(1e6, 1e5).unwrap()), 1e5, 1e5 / 9e6),
    ];
    for (mut law, strength, yield_displacement) in cases {
        law.commit(0.1);
        let before = law.energy(0.1).dissipated;
        law.commit(-0.1);
        law.commit(0.1);
        let area = law.energy(0.1).dissipated - before;
        let expected = 4.0 * strength * (0.1 - yield_displacement);
        assert!((area - expected).abs() < 1e-9 * expected, "{area} {expected}");
    }
}
