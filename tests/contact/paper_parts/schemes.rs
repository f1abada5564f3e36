//! GOAL: end-of-step schemes amplify, damp and converge as published.
//! SCENE: single oscillators over Δt/T; a block under its contact tractions.
//! REFERENCE: Hughes 1987; Hilber, Hughes & Taylor 1977; the equation of motion at the end of the
//! step.

use basemat::coupled::{HhtAlpha, Newmark, SchemeCoefficients, TimeScheme};
use basemat::results::Quantity;
use basemat::structure::{Structure, Triplets};
use basemat_problems::scenes::{SI_UNITS, block, friction, scene};

type SquareMatrix = [[f64; 3]; 3];

/// Displacement, velocity and acceleration of an oscillator.
#[derive(Clone, Copy)]
struct OscillatorMotion {
    u: f64,
    v: f64,
    a: f64,
}

impl OscillatorMotion {
    /// Row of a scheme's coefficients times (Δu, v, a).
    fn combine(self, row: [f64; 3], du: f64) -> f64 {
        row[0] * du + row[1] * self.v + row[2] * self.a
    }

    /// (u, Δt v, Δt² a) after a step of u'' = −stiffness · u.
    fn advance(self, c: &SchemeCoefficients, stiffness: f64, h: f64) -> [f64; 3] {
        let start_term = self.combine(c.acceleration, 0.0)
            + stiffness * (self.u + self.combine(c.displacement, 0.0));
        let du = -start_term / (c.acceleration[0] + stiffness * c.displacement[0]);
        [
            self.u + du,
            h * self.combine(c.new_velocity, du),
            h * h * self.combine(c.new_acceleration, du),
        ]
    }
}

/// Matrix of a step on (u, Δt v, Δt² a) for u'' = −(Ω/Δt)² u.
fn amplification(scheme: &dyn TimeScheme, omega: f64) -> SquareMatrix {
    let h = 0.01;
    let coefficients = scheme.coefficients(h);
    let stiffness = (omega / h).powi(2);
    let unit_motions = [
        OscillatorMotion { u: 1.0, v: 0.0, a: 0.0 },
        OscillatorMotion { u: 0.0, v: 1.0 / h, a: 0.0 },
        OscillatorMotion { u: 0.0, v: 0.0, a: 1.0 / (h * h) },
    ];
    let mut matrix = [[0.0; 3]; 3];
    for (column, motion) in unit_motions.into_iter().enumerate() {
        let values = motion.advance(&coefficients, stiffness, h);
        for (row, value) in matrix.iter_mut().zip(values) {
            row[column] = value;
        }
    }
    matrix
}

fn multiply(matrix: &SquareMatrix, x: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum())
}

/// Principal minor of two rows and columns.
fn principal_minor(m: &SquareMatrix, i: usize, j: usize) -> f64 {
    m[i][i] * m[j][j] - m[i][j] * m[j][i]
}

/// Minor of the second and third row.
fn lower_minor(m: &SquareMatrix, i: usize, j: usize) -> f64 {
    m[1][i] * m[2][j] - m[1][j] * m[2][i]
}

/// Trace, sum of principal minors, determinant.
fn invariants(m: &SquareMatrix) -> [f64; 3] {
    let trace = m[0][0] + m[1][1] + m[2][2];
    let minors = principal_minor(m, 0, 1) + principal_minor(m, 0, 2) + principal_minor(m, 1, 2);
    let determinant = m[0][0] * lower_minor(m, 1, 2) - m[0][1] * lower_minor(m, 0, 2)
        + m[0][2] * lower_minor(m, 0, 1);
    [trace, minors, determinant]
}

/// Values of Ω = ωΔt, from long periods to short ones.
const OMEGA_VALUES: [f64; 5] = [0.05, 0.4, 2.0, 11.0, 300.0];

/// λ² − 2A₁λ + A₂ and an eigenvalue of zero: Hughes, The Finite Element Method (1987), sec. 9.1.
#[test]
fn newmark_amplifies_as_in_the_book() {
    for (gamma, beta) in [(0.5, 0.25), (0.6, 0.3025), (0.5, 0.4), (0.9, 0.49), (1.0, 1.0)] {
        let scheme = Newmark::new(gamma, beta).unwrap();
        for omega in OMEGA_VALUES {
            let w = omega * omega;
            let d = 1.0 + beta * w;
            let computed = invariants(&amplification(&scheme, omega));
            let expected = [2.0 - w * (gamma + 0.5) / d, 1.0 - w * (gamma - 0.5) / d, 0.0];
            for (computed, expected) in computed.into_iter().zip(expected) {
                assert!((computed - expected).abs() < 1e-11, "{gamma} {beta} {omega}");
            }
        }
    }
}

/// Average acceleration turns the phase by θ with tan(θ/2) = Ω/2 and keeps the amplitude.
///
/// The period is longer by Ω/θ − 1 → Ω²/12.
#[test]
fn average_acceleration_has_its_period_error() {
    for omega in OMEGA_VALUES {
        let invariants = invariants(&amplification(&Newmark::default(), omega));
        let theta = 2.0 * (0.5 * omega).atan();
        assert!((0.5 * invariants[0] - theta.cos()).abs() < 1e-11);
        assert!((invariants[1] - 1.0).abs() < 1e-11);
    }
    let omega = 0.05_f64;
    let trace = invariants(&amplification(&Newmark::default(), omega))[0];
    let elongation = omega / (0.5 * trace).acos() - 1.0;
    assert!((elongation / (omega.powi(2) / 12.0) - 1.0).abs() < 1e-2);
}

/// Twice the energy of (u, Δt v, Δt² a) for Ω = 0.7.
fn doubled_energy(x: [f64; 3]) -> f64 {
    x[1] * x[1] + 0.49 * x[0] * x[0]
}

/// Average acceleration conserves energy in a hundred thousand steps of free vibration.
#[test]
fn average_acceleration_conserves_energy() {
    let matrix = amplification(&Newmark::default(), 0.7);
    let mut x = [1.0, 0.3, -0.49];
    let initial_energy = doubled_energy(x);
    for _ in 0..100_000 {
        x = multiply(&matrix, x);
    }
    let error = doubled_energy(x) / initial_energy - 1.0;
    assert!(error.abs() < 1e-9, "{error}");
}

/// λ³ − 2A₁λ² + A₂λ − A₃: Hilber, Hughes & Taylor (1977), eqs. 9–11.
#[test]
fn hht_amplifies_as_published() {
    for alpha in [0.0, -0.05, -0.1, -0.3, -1.0 / 3.0] {
        let scheme = HhtAlpha::new(alpha).unwrap();
        let gamma = 0.5 - alpha;
        let beta = 0.25 * (1.0 - alpha) * (1.0 - alpha);
        for omega in OMEGA_VALUES {
            let w = omega * omega;
            let d = 1.0 + (1.0 + alpha) * beta * w;
            let first = 2.0 - w * ((1.0 + alpha) * (gamma + 0.5) - alpha * beta) / d;
            let second = 1.0 - w * (gamma - 0.5 + 2.0 * alpha * (gamma - beta)) / d;
            let third = alpha * w * (beta - gamma + 0.5) / d;
            let computed = invariants(&amplification(&scheme, omega));
            for (computed, expected) in computed.into_iter().zip([first, second, third]) {
                let error = (computed - expected).abs();
                assert!(error < 1e-11, "{alpha} {omega}: {computed} {expected}");
            }
        }
    }
}

/// Spectral radius as the mean growth in many steps from a state without symmetry.
fn spectral_radius(matrix: &SquareMatrix) -> f64 {
    let mut x = [0.3, -1.0, 0.7];
    let mut logarithm = 0.0;
    let steps = 4000;
    for _ in 0..steps {
        x = multiply(matrix, x);
        let magnitude = x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        logarithm += magnitude.ln();
        x = x.map(|x| x / magnitude);
    }
    (logarithm / f64::from(steps)).exp()
}

#[test]
fn hht_damps_short_periods_only() {
    for alpha in [-0.05_f64, -0.1, -0.3] {
        let scheme = HhtAlpha::new(alpha).unwrap();
        let radius_at_high_frequency = spectral_radius(&amplification(&scheme, 1e6));
        let limit = (1.0 + alpha) / (1.0 - alpha);
        assert!(
            (radius_at_high_frequency - limit).abs() < 5e-3,
            "{alpha}: {radius_at_high_frequency} {limit}"
        );
        let radius_at_low_frequency = spectral_radius(&amplification(&scheme, 0.02));
        assert!(1.0 - radius_at_low_frequency < 1e-4, "{alpha}: {radius_at_low_frequency}");
    }
}

/// Error after one period of free vibration, computed in `steps` steps.
fn error_after_period(scheme: &dyn TimeScheme, steps: u32) -> f64 {
    let omega = std::f64::consts::TAU / f64::from(steps);
    let matrix = amplification(scheme, omega);
    let mut x = [1.0, 0.0, -omega * omega];
    for _ in 0..steps {
        x = multiply(&matrix, x);
    }
    (x[0] - 1.0).hypot(x[1] / omega)
}

/// Order of convergence of a scheme.
fn convergence_order(scheme: &dyn TimeScheme) -> f64 {
    (error_after_period(scheme, 200) / error_after_period(scheme, 400)).log2()
}

#[test]
fn orders_are_two_unless_gamma_damps() {
    assert!((convergence_order(&Newmark::default()) - 2.0).abs() < 0.05);
    assert!((convergence_order(&HhtAlpha::new(-0.2).unwrap()) - 2.0).abs() < 0.05);
    assert!((convergence_order(&Newmark::new(0.6, 0.3025).unwrap()) - 1.0).abs() < 0.1);
}

/// The tractions of step N and the accelerations at its end are in equilibrium, as in the paper.
#[test]
fn traction_enters_at_the_end_of_the_step() {
    for alpha in [0.0, -0.2] {
        let mut mass = Triplets::new(3);
        block(SI_UNITS).mass(&mut mass).unwrap();
        let mut simulation = scene(SI_UNITS, 0.5)
            .structure(block(SI_UNITS))
            .interface(friction(0.3))
            .scheme(HhtAlpha::new(alpha).unwrap())
            .build()
            .unwrap();
        let mut previous_state = simulation.state().clone();
        let weight = previous_state.normal_force;
        for _ in 0..200 {
            let state = simulation.step().unwrap().clone();
            // The first row is the horizontal equilibrium of the block.
            let row = mass.entries().iter().filter(|entry| entry.0 == 0);
            let inertia: f64 = row.map(|&(_, j, m)| m * state.acceleration()[j]).sum();
            assert!((inertia + state.base_shear).abs() < 1e-10 * weight);
            // Newmark's rule for the velocity.
            let gamma = 0.5 - alpha;
            let mean =
                (1.0 - gamma) * previous_state.acceleration()[0] + gamma * state.acceleration()[0];
            let change = state.velocity()[0] - previous_state.velocity()[0];
            let error = (change - simulation.time_step() * mean).abs();
            assert!(error < 1e-9 * (1e-3 + change.abs()));
            previous_state = state;
        }
        assert!(previous_state.value(Quantity::LargestSlip) > 1e-4, "nothing slid");
    }
}

#[test]
fn parameters_out_of_range_are_errors() {
    for (gamma, beta) in [
        (0.49, 0.25),
        (0.5, 0.24),
        (0.6, 0.29),
        (f64::NAN, 0.25),
        (0.5, f64::NAN),
        (f64::INFINITY, f64::INFINITY),
        (0.5, f64::INFINITY),
        (3.0, 2.0),
    ] {
        assert!(Newmark::new(gamma, beta).is_err(), "{gamma} {beta}");
    }
    for alpha in [-0.34, 1e-9, f64::NAN, f64::NEG_INFINITY] {
        assert!(HhtAlpha::new(alpha).is_err());
    }
}
