//! GOAL: end-of-step schemes amplify, damp and converge as published.
//! SCENE: single oscillators over Δt/T; a block under its contact tractions.
//! REFERENCE: Hughes 1987; Hilber, Hughes & Taylor 1977; the equation of motion at the end of the
//! step.

use basemat::coupled::{HhtAlpha, Newmark, SchemeCoefficients, TimeScheme};
use basemat::results::Quantity;
use basemat::structure::{Structure, Triplets};
use basemat_problems::scenes::{SI, block, friction, scene};

type Matrix = [[f64; 3]; 3];

/// Matrix of a step on (u, Δt v, Δt² a) for u'' = −(Ω/Δt)² u.
fn amplification(scheme: &dyn TimeScheme, omega: f64) -> Matrix {
    let h = 0.01;
    let c = scheme.coefficients(h);
    let stiffness = (omega / h).powi(2);
    let mut matrix = [[0.0; 3]; 3];
    for k in 0..3 {
        let (u, v, a) = [(1.0, 0.0, 0.0), (0.0, 1.0 / h, 0.0), (0.0, 0.0, 1.0 / (h * h))][k];
        let apply = |row: [f64; 3], du: f64| row[0] * du + row[1] * v + row[2] * a;
        let SchemeCoefficients { displacement, acceleration, .. } = c;
        let known = apply(acceleration, 0.0) + stiffness * (u + apply(displacement, 0.0));
        let du = -known / (acceleration[0] + stiffness * displacement[0]);
        let new = [u + du, h * apply(c.new_velocity, du), h * h * apply(c.new_acceleration, du)];
        for (row, new) in matrix.iter_mut().zip(new) {
            row[k] = new;
        }
    }
    matrix
}

/// Trace, sum of principal minors, determinant.
fn invariants(m: &Matrix) -> [f64; 3] {
    let minor = |i: usize, j: usize| m[i][i] * m[j][j] - m[i][j] * m[j][i];
    let cross = |i: usize, j: usize| m[1][i] * m[2][j] - m[1][j] * m[2][i];
    let determinant = m[0][0] * cross(1, 2) - m[0][1] * cross(0, 2) + m[0][2] * cross(0, 1);
    [m[0][0] + m[1][1] + m[2][2], minor(0, 1) + minor(0, 2) + minor(1, 2), determinant]
}

const OMEGAS: [f64; 5] = [0.05, 0.4, 2.0, 11.0, 300.0];

/// Hughes, The Finite Element Method (1987), sec. 9.1: λ² − 2A₁λ + A₂, and an eigenvalue of zero.
#[test]
fn newmark_amplifies_as_in_the_book() {
    for (gamma, beta) in [(0.5, 0.25), (0.6, 0.3025), (0.5, 0.4), (0.9, 0.49), (1.0, 1.0)] {
        let scheme = Newmark::new(gamma, beta).unwrap();
        for omega in OMEGAS {
            let w = omega * omega;
            let d = 1.0 + beta * w;
            let [trace, minors, determinant] = invariants(&amplification(&scheme, omega));
            assert!(
                (trace - (2.0 - w * (gamma + 0.5) / d)).abs() < 1e-11,
                "{gamma} {beta} {omega}"
            );
            assert!((minors - (1.0 - w * (gamma - 0.5) / d)).abs() < 1e-11);
            assert!(determinant.abs() < 1e-11);
        }
    }
}

/// Average acceleration turns the phase by θ with tan(θ/2) = Ω/2 and keeps the amplitude: the
/// period is longer by Ω/θ − 1 → Ω²/12.
#[test]
fn average_acceleration_keeps_energy_and_its_period_error() {
    for omega in OMEGAS {
        let [trace, minors, _] = invariants(&amplification(&Newmark::default(), omega));
        let theta = 2.0 * (0.5 * omega).atan();
        assert!((0.5 * trace - theta.cos()).abs() < 1e-11);
        assert!((minors - 1.0).abs() < 1e-11);
    }
    let longer = |omega: f64| {
        let trace = invariants(&amplification(&Newmark::default(), omega))[0];
        omega / (0.5 * trace).acos() - 1.0
    };
    assert!((longer(0.05) / (0.05_f64.powi(2) / 12.0) - 1.0).abs() < 1e-2);
    // A hundred thousand steps of free vibration.
    let matrix = amplification(&Newmark::default(), 0.7);
    let mut x = [1.0, 0.3, -0.49];
    let energy = |x: [f64; 3]| x[1] * x[1] + 0.49 * x[0] * x[0];
    let start = energy(x);
    for _ in 0..100_000 {
        x = matrix.map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum());
    }
    assert!((energy(x) / start - 1.0).abs() < 1e-9, "{}", energy(x) / start - 1.0);
}

/// Hilber, Hughes & Taylor (1977), eqs. 9–11: λ³ − 2A₁λ² + A₂λ − A₃.
#[test]
fn hht_amplifies_as_published() {
    for alpha in [0.0, -0.05, -0.1, -0.3, -1.0 / 3.0] {
        let scheme = HhtAlpha::new(alpha).unwrap();
        let (gamma, beta) = (0.5 - alpha, 0.25 * (1.0 - alpha) * (1.0 - alpha));
        for omega in OMEGAS {
            let w = omega * omega;
            let d = 1.0 + (1.0 + alpha) * beta * w;
            let first = 2.0 - w * ((1.0 + alpha) * (gamma + 0.5) - alpha * beta) / d;
            let second = 1.0 - w * (gamma - 0.5 + 2.0 * alpha * (gamma - beta)) / d;
            let third = alpha * w * (beta - gamma + 0.5) / d;
            let found = invariants(&amplification(&scheme, omega));
            for (found, wanted) in found.into_iter().zip([first, second, third]) {
                assert!((found - wanted).abs() < 1e-11, "{alpha} {omega}: {found} {wanted}");
            }
        }
    }
}

/// Growth per step after many, from a state without symmetry: the spectral radius.
fn spectral_radius(matrix: &Matrix) -> f64 {
    let mut x = [0.3, -1.0, 0.7];
    let mut logarithm = 0.0;
    let steps = 4000;
    for _ in 0..steps {
        x = matrix.map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum());
        let size = x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        logarithm += size.ln();
        x = x.map(|x| x / size);
    }
    (logarithm / f64::from(steps)).exp()
}

#[test]
fn hht_damps_short_periods_only() {
    for alpha in [-0.05_f64, -0.1, -0.3] {
        let scheme = HhtAlpha::new(alpha).unwrap();
        let stiff = spectral_radius(&amplification(&scheme, 1e6));
        let limit = (1.0 + alpha) / (1.0 - alpha);
        assert!((stiff - limit).abs() < 5e-3, "{alpha}: {stiff} {limit}");
        let soft = spectral_radius(&amplification(&scheme, 0.02));
        assert!(1.0 - soft < 1e-4, "{alpha}: {soft}");
    }
}

/// Error after one period against the steps in it.
fn order(scheme: &dyn TimeScheme) -> f64 {
    let error = |steps: u32| {
        let omega = std::f64::consts::TAU / f64::from(steps);
        let matrix = amplification(scheme, omega);
        let mut x = [1.0, 0.0, -omega * omega];
        for _ in 0..steps {
            x = matrix.map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum());
        }
        (x[0] - 1.0).hypot(x[1] / omega)
    };
    (error(200) / error(400)).log2()
}

#[test]
fn orders_are_two_unless_gamma_damps() {
    assert!((order(&Newmark::default()) - 2.0).abs() < 0.05);
    assert!((order(&HhtAlpha::new(-0.2).unwrap()) - 2.0).abs() < 0.05);
    assert!((order(&Newmark::new(0.6, 0.3025).unwrap()) - 1.0).abs() < 0.1);
}

/// The tractions of step N and the accelerations at its end are in equilibrium, as in the paper.
#[test]
fn traction_enters_at_the_end_of_the_step() {
    for alpha in [0.0, -0.2] {
        let mut mass = Triplets::new(3);
        block(SI).mass(&mut mass).unwrap();
        let mut simulation = scene(SI, 0.5)
            .structure(block(SI))
            .interface(friction(0.3))
            .scheme(HhtAlpha::new(alpha).unwrap())
            .build()
            .unwrap();
        let mut before = simulation.state().clone();
        let weight = before.normal_force;
        for _ in 0..200 {
            let state = simulation.step().unwrap().clone();
            // The block's first degree of freedom shifts it to the right: its row is the horizontal balance.
            let row = mass.entries().iter().filter(|entry| entry.0 == 0);
            let inertia: f64 = row.map(|&(_, j, m)| m * state.acceleration()[j]).sum();
            assert!((inertia + state.base_shear).abs() < 1e-10 * weight);
            // Newmark's rule, not the mean of the step.
            let (gamma, h) = (0.5 - alpha, simulation.time_step());
            let mean = (1.0 - gamma) * before.acceleration()[0] + gamma * state.acceleration()[0];
            let gained = state.velocity()[0] - before.velocity()[0];
            assert!((gained - h * mean).abs() < 1e-9 * (1e-3 + gained.abs()));
            before = state;
        }
        assert!(before.value(Quantity::LargestSlip) > 1e-4, "nothing slid");
    }
}

#[test]
fn parameters_out_of_range_are_refused() {
    let (nan, infinite) = (f64::NAN, f64::INFINITY);
    for (gamma, beta) in [(0.49, 0.25), (0.5, 0.24), (0.6, 0.29), (nan, 0.25), (0.5, nan)] {
        assert!(Newmark::new(gamma, beta).is_err(), "{gamma} {beta}");
    }
    for (gamma, beta) in [(infinite, infinite), (0.5, infinite), (3.0, 2.0)] {
        assert!(Newmark::new(gamma, beta).is_err(), "{gamma} {beta}");
    }
    for alpha in [-0.34, 1e-9, nan, -infinite] {
        assert!(HhtAlpha::new(alpha).is_err());
    }
}
