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
    let mut step = || {
        at = 0.9 * at + random.within(-1.0, 1.0) * random.log_within(1e-4, 3e-2);
        at
    };
    (0..steps).map(|_| step()).collect()
}

/// Central differences of the force, and of the energy: d(stored + dissipated)/dd is the force.
#[test]
fn tangent_and_force_are_the_slopes_of_force_and_energy() {
    for (name, mut law) in laws() {
        let mut random = Random(7);
        for d in path(&mut random, 100) {
            let h = 1e-8;
            // The slope has kinks at yield and where the way turns: no difference across them.
            let slope = |x: f64| law.response(x).tangent;
            let [below, here, above] = [slope(d - h), slope(d), slope(d + h)];
            if (above - below).abs() < 1e-3 * here.abs() {
                let [f0, f1] = [law.response(d - h).force, law.response(d + h).force];
                let found = (f1 - f0) / (2.0 * h);
                assert!((found - here).abs() < 1e-5 * 2e7, "{name} at {d}: {found} {here}");
                let work = |x: f64| law.energy(x).stored + law.energy(x).dissipated;
                let force = (work(d + h) - work(d - h)) / (2.0 * h);
                let expected = law.response(d).force;
                // Stored energy of kilojoules, to its last digits, over 2 h
                let tolerance = 1e-15 * work(d).abs().max(1.0) / h + 1e-6 * expected.abs();
                assert!((force - expected).abs() < 10.0 * tolerance, "{name}: {force} {expected}");
            }
            law.commit(d);
        }
    }
}

/// The work of the force by Simpson's rule along a path, against the energies that the laws tell.
#[test]
fn work_is_stored_or_dissipated_and_none_comes_back() {
    for (name, mut law) in laws() {
        let mut random = Random(11);
        let (mut work, mut last, mut lost) = (0.0, 0.0, 0.0);
        for d in path(&mut random, 40) {
            let pieces = 300;
            let at = |k: f64| law.response(last + (d - last) * k / f64::from(pieces)).force;
            let width = (d - last) / f64::from(pieces);
            for k in 0..pieces {
                let k = f64::from(k);
                work += width / 6.0 * (at(k) + 4.0 * at(k + 0.5) + at(k + 1.0));
            }
            let energy = law.energy(d);
            assert!(energy.dissipated >= lost && energy.stored >= 0.0, "{name}");
            law.commit(d);
            assert_eq!(law.energy(d).dissipated, energy.dissipated, "{name}: commit adds nothing");
            (last, lost) = (d, energy.dissipated);
        }
        let told = law.energy(last).stored + lost;
        assert!(lost > 1e3, "{name} never yielded");
        // Simpson's rule meets a kink in most steps of the bilinear laws.
        let tolerance = if name.starts_with("Bouc") { 1e-7 } else { 1e-4 };
        assert!((work - told).abs() < tolerance * told, "{name}: {work} J, but {told} J told");
    }
}

/// However a straight path is cut into steps, it leads to the same place.
#[test]
fn steps_of_a_straight_path_do_not_matter() {
    for (name, mut law) in laws() {
        law.commit(0.013);
        for target in [-0.02, 0.004, -0.0045, 0.03] {
            let whole = law.response(target);
            let energy = law.energy(target);
            let from = law.save();
            let start = if target == -0.02 { 0.013 } else { f64::NAN };
            if start.is_finite() {
                for k in 1..=37 {
                    law.commit(start + (target - start) * f64::from(k) / 37.0);
                }
                let parts = law.response(target);
                assert!((parts.force - whole.force).abs() < 1e-9 * 1e5, "{name}");
                let both = [law.energy(target).dissipated, energy.dissipated];
                assert!((both[0] - both[1]).abs() < 1e-11 * both[1], "{name}: {both:?}");
                law.restore(&from).unwrap();
                assert_eq!(law.response(target), whole, "{name}");
            }
            law.commit(target);
        }
    }
}

/// Runge–Kutta on dz/dt = (1 − (β sgn(ḋ z) + γ)|z|ⁿ) ḋ/d_y in time, in small steps, for a motion of
/// two frequencies; the law is committed at a few dozen points of each half-cycle, turns included.
#[test]
fn bouc_wen_follows_its_differential_equation() {
    let (k, fy, alpha) = (2e7, 1e5, 0.05);
    let dy = fy / k;
    for (n, beta) in [(1.0, 0.8), (1.5, 0.6), (2.0, 0.5), (5.5, 0.75)] {
        let gamma = 1.0 - beta;
        let mut law = BoucWen::new(k, fy, alpha).unwrap().with_shape(n, beta).unwrap();
        let amplitude = |t: f64| dy * (1.5 + 0.4 * t);
        let (w, fine) = (std::f64::consts::PI, 20_000_u32);
        let mut z = 0.0_f64;
        let mut largest = 0.0_f64;
        // Half-cycles between turns: d runs from turn to turn like a cosine.
        let mut from = 0.0;
        for half in 0..8 {
            let side = if half % 2 == 0 { 1.0 } else { -1.0 };
            let to = side * amplitude(f64::from(half));
            let middle = 0.5 * (from + to);
            let rate = |t: f64| 0.5 * (to - from) * w * (w * t).sin();
            let dz = |z: f64, v: f64| {
                let sign = if v * z > 0.0 { 1.0 } else { -1.0 };
                (1.0 - (beta * sign + gamma) * z.abs().powf(n)) * v / dy
            };
            for step in 0..fine {
                let h = 1.0 / f64::from(fine);
                let t = f64::from(step) * h;
                let [v0, v1, v2] = [rate(t), rate(t + 0.5 * h), rate(t + h)];
                let a = dz(z, v0);
                let b = dz(z + 0.5 * h * a, v1);
                let c = dz(z + 0.5 * h * b, v1);
                let d = dz(z + h * c, v2);
                z += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
                if (step + 1) % 500 == 0 {
                    let at = middle - 0.5 * (to - from) * (w * (t + h)).cos();
                    law.commit(at);
                    let expected = alpha * k * at + (1.0 - alpha) * fy * z;
                    largest = largest.max((law.response(at).force - expected).abs() / fy);
                }
            }
            from = to;
        }
        println!("n = {n}, β = {beta}: off by {largest:.1e} F_y");
        // Fourth order, but only second where |z|ⁿ has its kink at z = 0.
        assert!(largest < 1e-8, "n = {n}, β = {beta}: off by {largest:e} F_y");
    }
}

/// n = 1 and n = 2 have elementary solutions.
#[test]
fn bouc_wen_has_its_elementary_solutions() {
    for x in [1e-9, 0.01, 0.3, 0.7, 1.0, 3.0, 12.0, 40.0] {
        let z = |n: f64| {
            let law = BoucWen::new(1.0, 1.0, 0.0).unwrap().with_shape(n, 0.8).unwrap();
            law.response(x).force
        };
        assert!((z(1.0) + (-x).exp_m1()).abs() < 4e-16, "{x}");
        assert!((z(2.0) - x.tanh()).abs() < 1e-15, "{x}");
    }
    // Unloading from saturation with b = 2β − 1 = 0.6, n = 2: √b atan-like until z = 0
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
