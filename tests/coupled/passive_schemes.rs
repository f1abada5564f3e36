//! GOAL: the midpoint rule and its dissipative form are passive together with the soil; Newmark's method
//! and HHT-α are not, and say so.
//! SCENE: random forced steps; single oscillators over ωΔt; a light block on soft soil, a shear building.
//! REFERENCE: the identity of `docs/theory.md`, section 8; roots of the characteristic polynomial;
//! the oscillator's closed form.

use basemat::Simulation;
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::{
    DissipativeMidpoint, HhtAlpha, Midpoint, Newmark, SchemeCoefficients, State, TimeScheme,
    Warning,
};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{AtRest, el_centro_1940};
use basemat::results::Run;
use basemat::structure::{RigidBlock, ShearBuilding, Storey, Structure, Triplets};
use basemat::{Complex, Soil};

use basemat_problems::dense::{Matrix, dot, form, multiply};
use basemat_problems::random::Random;
use basemat_problems::scenes::{SI, scene, tower};

const GAMMAS: [f64; 5] = [0.5, 0.55, 0.7, 0.8, 1.0];

fn dissipative(gamma: f64) -> DissipativeMidpoint {
    DissipativeMidpoint::new(gamma).unwrap()
}

fn beta(gamma: f64) -> f64 {
    0.25 * (gamma + 0.5).powi(2)
}

/// Σ coefficients (Δu, v₀, a₀), vector by vector.
fn combine(row: [f64; 3], du: &[f64], v: &[f64], a: &[f64]) -> Vec<f64> {
    (0..du.len()).map(|i| row[0] * du[i] + row[1] * v[i] + row[2] * a[i]).collect()
}

fn sum(a: &[f64], b: &[f64], factor: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + factor * b).collect()
}

/// Gaussian elimination with pivots on the diagonal, of a positive definite matrix.
fn solve(mut matrix: Matrix, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for k in 0..n {
        for i in k + 1..n {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..n {
                matrix[i][j] -= factor * matrix[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..n).rev() {
        let rest: f64 = (k + 1..n).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - rest) / matrix[k][k];
    }
    right
}

/// G Gᵀ of random entries, times a random size.
fn random_matrix(random: &mut Random, n: usize) -> Matrix {
    let size = random.log_within(1e-2, 1e2);
    let factor: Matrix =
        (0..n).map(|_| (0..n).map(|_| random.within(-1.0, 1.0)).collect()).collect();
    let entry = |i: usize, j: usize| size * dot(&factor[i], &factor[j]);
    (0..n).map(|i| (0..n).map(|j| entry(i, j) + f64::from(u8::from(i == j))).collect()).collect()
}

#[test]
fn energy_of_a_forced_step_is_as_the_theory_says() {
    const N: usize = 3;
    let mut random = Random(7);
    for _ in 0..20_000 {
        let gamma = random.within(0.5, 1.0);
        let h = random.log_within(1e-2, 1e2);
        let c = dissipative(gamma).coefficients(h);
        let [mass, damping, stiffness] = [(); 3].map(|()| random_matrix(&mut random, N));
        let [u0, v0, a0, force] =
            [(); 4].map(|()| (0..N).map(|_| random.within(-1.0, 1.0)).collect::<Vec<f64>>());
        // M a* + C v* + K u* = force.
        let zero = vec![0.0; N];
        let parts = [
            (&mass, c.acceleration, zero.clone()),
            (&damping, c.velocity, zero.clone()),
            (&stiffness, c.displacement, u0.clone()),
        ];
        let mut effective = vec![vec![0.0; N]; N];
        let mut right = force.clone();
        for (matrix, row, start) in &parts {
            for i in 0..N {
                effective[i] = sum(&effective[i], &matrix[i], row[0]);
            }
            let known = sum(&combine(*row, &zero, &v0, &a0), start, 1.0);
            right = sum(&right, &multiply(matrix, &known), -1.0);
        }
        let du = solve(effective, right);
        let [v1, a1] = [c.new_velocity, c.new_acceleration].map(|row| combine(row, &du, &v0, &a0));
        let (u1, da) = (sum(&u0, &du, 1.0), sum(&a1, &a0, -1.0));
        let kappa = if gamma == 0.5 { 0.0 } else { h * h * (beta(gamma) - 0.5 * gamma) };
        let terms = |u: &[f64], v: &[f64], a: &[f64]| {
            [form(v, &mass, v), form(u, &stiffness, u), kappa * form(a, &mass, a)]
        };
        let [before, after] = [terms(&u0, &v0, &a0), terms(&u1, &v1, &a1)];
        let lost = kappa * (gamma - 0.5) * form(&da, &mass, &da);
        let work = dot(&force, &du) - form(&du, &damping, &du) / h;
        let change: f64 = (0..3).map(|k| 0.5 * (after[k] - before[k])).sum();
        let scale = before.iter().chain(&after).fold(work.abs(), |m, x| m.max(*x));
        let open = (change - work + lost).abs() / scale;
        assert!(open < 3e-12 && lost >= 0.0, "γ = {gamma}, Δt = {h}: {open:e}, loss {lost:e}");
    }
}

/// Matrix of a step on (u, Δt v, Δt² a) for u'' = −(Ω/Δt)² u, with Δt = 1.
fn amplification(scheme: &dyn TimeScheme, omega: f64) -> [[f64; 3]; 3] {
    let SchemeCoefficients { displacement, acceleration, new_velocity, new_acceleration, .. } =
        scheme.coefficients(1.0);
    let square = omega * omega;
    let mut matrix = [[0.0; 3]; 3];
    for k in 0..3 {
        let [u, v, a] = std::array::from_fn(|j| f64::from(u8::from(j == k)));
        let apply = |row: [f64; 3], du: f64| row[0] * du + row[1] * v + row[2] * a;
        let known = apply(acceleration, 0.0) + square * (u + apply(displacement, 0.0));
        let du = -known / (acceleration[0] + square * displacement[0]);
        for (row, new) in
            matrix.iter_mut().zip([u + du, apply(new_velocity, du), apply(new_acceleration, du)])
        {
            row[k] = new;
        }
    }
    matrix
}

/// Largest root of the characteristic polynomial of a matrix, by Weierstrass' iteration on all three.
fn spectral_radius(m: &[[f64; 3]; 3]) -> f64 {
    let minor = |i: usize, j: usize| m[i][i] * m[j][j] - m[i][j] * m[j][i];
    let cross = |i: usize, j: usize| m[1][i] * m[2][j] - m[1][j] * m[2][i];
    let determinant = m[0][0] * cross(1, 2) - m[0][1] * cross(0, 2) + m[0][2] * cross(0, 1);
    let trace = m[0][0] + m[1][1] + m[2][2];
    let minors = minor(0, 1) + minor(0, 2) + minor(1, 2);
    let one = Complex::real(1.0);
    let mut roots = [one, Complex::new(0.4, 0.9), Complex::new(-0.65, 0.72)];
    for _ in 0..500 {
        for i in 0..3 {
            let z = roots[i];
            let value = ((z - Complex::real(trace)) * z + Complex::real(minors)) * z
                - Complex::real(determinant);
            let others =
                (0..3).filter(|j| *j != i).fold(one, |product, j| product * (z - roots[j]));
            roots[i] = z - value / others;
        }
    }
    roots.iter().map(|root| root.abs()).fold(0.0, f64::max)
}

/// The table in the documentation of `DissipativeMidpoint`.
#[test]
fn spectral_radius_is_that_of_the_table() {
    for (gamma, radii) in [
        (0.6, [1.0, 0.9999, 0.9972, 0.9766, 0.9443]),
        (0.8, [1.0, 0.9976, 0.9570, 0.8478, 0.9306]),
        (1.0, [1.0, 0.9907, 0.8873, 0.7082, 0.9630]),
    ] {
        for (omega, wanted) in [0.1, 1.0, 3.0, 10.0, 30.0].into_iter().zip(radii) {
            let found = spectral_radius(&amplification(&dissipative(gamma), omega));
            assert!((found - wanted).abs() < 6e-5, "γ = {gamma}, ωΔt = {omega}: {found}");
        }
        let stiff = spectral_radius(&amplification(&dissipative(gamma), 1e5));
        assert!(stiff <= 1.0 + 1e-9 && stiff > 0.999, "{stiff}");
    }
}

/// u'' + 2ζωu' + ω²u = sin Ωt from rest.
#[test]
fn order_is_two_for_every_gamma() {
    let (omega, ratio, driven) = (3.0_f64, 0.05_f64, 2.0_f64);
    let natural = omega * (1.0 - ratio * ratio).sqrt();
    let (stiff, drag) = (omega * omega - driven * driven, 2.0 * ratio * omega * driven);
    let size = stiff * stiff + drag * drag;
    let (sine, cosine) = (stiff / size, -drag / size);
    // From rest: u = sine sin Ωt + cosine cos Ωt + e^(−ζωt) (p cos ω_d t + q sin ω_d t).
    let p = -cosine;
    let q = (ratio * omega * p - driven * sine) / natural;
    let exact = |t: f64| {
        let free = p * (natural * t).cos() + q * (natural * t).sin();
        sine * (driven * t).sin() + cosine * (driven * t).cos() + free * (-ratio * omega * t).exp()
    };
    let end = 4.0;
    for gamma in GAMMAS {
        let error = |steps: u32| {
            let h = end / f64::from(steps);
            let c = dissipative(gamma).coefficients(h);
            let apply =
                |row: [f64; 3], du: f64, v: f64, a: f64| row[0] * du + row[1] * v + row[2] * a;
            let (mut u, mut v, mut a) = (0.0, 0.0, 0.0);
            let [inertia, dashpot, spring] = [1.0, 2.0 * ratio * omega, omega * omega];
            let mut worst = 0.0_f64;
            for step in 0..steps {
                let force = (driven * h * (f64::from(step) + c.load_fraction)).sin();
                let known = inertia * apply(c.acceleration, 0.0, v, a)
                    + dashpot * apply(c.velocity, 0.0, v, a)
                    + spring * (u + apply(c.displacement, 0.0, v, a));
                let effective = inertia * c.acceleration[0]
                    + dashpot * c.velocity[0]
                    + spring * c.displacement[0];
                let du = (force - known) / effective;
                (v, a) = (apply(c.new_velocity, du, v, a), apply(c.new_acceleration, du, v, a));
                u += du;
                worst = worst.max((u - exact(h * f64::from(step + 1))).abs());
            }
            worst
        };
        let order = (error(400) / error(800)).log2();
        assert!((order - 2.0).abs() < 0.01, "γ = {gamma}: {order}");
    }
}

/// All states of a tower under two pulses.
fn shaken(scheme: impl TimeScheme + 'static, steps: usize) -> Vec<State> {
    let builder = scene(SI, 0.5).structure(tower(SI, None)).interface(Bonded).scheme(scheme);
    let mut simulation = builder.build().unwrap();
    basemat_problems::scenes::states(&mut simulation, steps)
}

#[test]
fn without_dissipation_it_is_the_midpoint_rule_to_the_bit() {
    assert!(shaken(Midpoint, 100) == shaken(dissipative(0.5), 100));
}

/// The algorithmic energy of the balance, computed from the accelerations of the states.
#[test]
fn algorithmic_energy_is_what_the_scheme_holds_and_takes() {
    let mut mass = Triplets::new(tower(SI, None).dofs());
    tower(SI, None).mass(&mut mass).unwrap();
    let square =
        |a: &[f64]| -> f64 { mass.entries().iter().map(|&(i, j, m)| a[i] * m * a[j]).sum() };
    for gamma in [0.6, 0.8, 1.0] {
        let states = shaken(dissipative(gamma), 300);
        let kappa = 2.5e-3_f64.powi(2) * (beta(gamma) - 0.5 * gamma);
        let mut taken = 0.0;
        for pair in states.windows(2) {
            let [before, now] = [pair[0].acceleration(), pair[1].acceleration()];
            taken += kappa * (gamma - 0.5) * square(&sum(now, before, -1.0));
            let wanted = taken + 0.5 * kappa * square(now);
            let energy_balance = &pair[1].energy_balance;
            let apart = (energy_balance.algorithmic - wanted).abs() / energy_balance.largest;
            assert!(apart < 1e-11, "γ = {gamma}: {} {wanted}", energy_balance.algorithmic);
        }
        let end = &states.last().unwrap().energy_balance;
        assert!(taken > 1e-8 * end.largest && end.residual() < 1e-11, "{end}");
    }
}

/// A light block on soft soil that is thrown up and comes down on its two elements.
fn thrown(scheme: impl TimeScheme + 'static, steps: usize) -> Run {
    let block = RigidBlock::new(6.0, 6.0, 50.9).unwrap();
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .ground(
            ElasticGround::new(soil, Strip::under(&block, 2, Grading::Uniform).unwrap()).unwrap(),
        )
        .structure(block)
        .interface(Coulomb::uplift_only())
        .motion(AtRest)
        .initial_velocity([0.0, 0.35, 0.0])
        .scheme(scheme)
        .build()
        .unwrap();
    simulation.run(steps, |_| {}).unwrap()
}

fn made(run: &Run) -> Option<f64> {
    run.warnings.iter().find_map(|warning| match warning {
        Warning::AlgorithmicEnergy { made } => Some(*made),
        _ => None,
    })
}

#[test]
fn newmark_makes_energy_on_the_half_plane_and_warns() {
    let run = thrown(Newmark::default(), 220);
    let total = run.energy_balance.kinetic + run.energy_balance.static_contact;
    assert!(total > 100.0 * run.energy_balance.input, "{}", run.energy_balance);
    assert!(made(&run).unwrap() > 0.5 && run.energy_error < 1e-9, "{:?}", run.warnings);
    for scheme in [DissipativeMidpoint::new(0.5).unwrap(), DissipativeMidpoint::default()] {
        let run = thrown(scheme, 220);
        let total = run.energy_balance.kinetic + run.energy_balance.static_contact;
        assert!(total < run.energy_balance.input, "{}", run.energy_balance);
        assert!(
            run.energy_balance.algorithmic >= -1e-3 * run.energy_balance.largest
                && made(&run).is_none()
        );
        assert!(run.energy_error < 1e-12);
    }
}

/// Newmark's coupling raises the shear of an ordinary building, and the run says so; the midpoint rule and
/// its dissipative form agree.
#[test]
fn schemes_of_a_building() {
    let run = |scheme: Box<dyn TimeScheme>, time_step: f64| {
        let storeys = [Storey::new(3.0, 30e3, 60e6); 3];
        let building = ShearBuilding::new(8.0, 60e3, 4e5, &storeys).unwrap();
        let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0).unwrap();
        let mut simulation = Simulation::builder(time_step)
            .ground(
                ElasticGround::new(soil, Strip::under(&building, 12, Grading::Uniform).unwrap())
                    .unwrap(),
            )
            .structure(building.with_stiffness_damping(0.05).unwrap())
            .motion(el_centro_1940())
            .interface(Bonded)
            .scheme(scheme)
            .build()
            .unwrap();
        let steps = simulation.steps_for(10.0);
        simulation.run(steps, |_| {}).unwrap()
    };
    let reference = run(Box::new(Midpoint), 1e-3).whole.base_shear.magnitude();
    let error = |run: &Run| run.whole.base_shear.magnitude() / reference - 1.0;
    for time_step in [0.01, 0.02] {
        let midpoint = run(Box::new(Midpoint), time_step);
        let damped = run(Box::new(DissipativeMidpoint::new(0.8).unwrap()), time_step);
        let newmark = run(Box::<Newmark>::default(), time_step);
        let hht = run(Box::new(HhtAlpha::new(-0.1).unwrap()), time_step);
        println!(
            "{time_step}: midpoint {:.4}, dissipative {:.4}, Newmark {:.4} {:?}, HHT {:.4} {:?}",
            error(&midpoint),
            error(&damped),
            error(&newmark),
            made(&newmark),
            error(&hht),
            made(&hht),
        );
        assert!(made(&midpoint).is_none() && made(&damped).is_none());
        assert!(error(&damped).abs() < 0.06 && error(&midpoint).abs() < 0.06);
        assert!(error(&newmark) > 0.04 && made(&newmark).unwrap() > 0.02);
    }
}
