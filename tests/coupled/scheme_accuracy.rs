//! GOAL: the dissipative midpoint rule is of second order and damps high frequencies as its documentation says.
//! SCENE: single oscillators over ωΔt, free and driven.
//! REFERENCE: roots of the characteristic polynomial; the oscillator's closed form.

use basemat::Complex;
use basemat::coupled::{SchemeCoefficients, TimeScheme};

use super::passive_schemes::{combine, dissipative};

/// Values of Newmark's γ, from no dissipation to the most.
const GAMMA_VALUES: [f64; 5] = [0.5, 0.55, 0.7, 0.8, 1.0];

/// Matrix of a step on (u, Δt v, Δt² a) for u'' = −(Ω/Δt)² u, with Δt = 1.
fn amplification(scheme: &dyn TimeScheme, omega: f64) -> [[f64; 3]; 3] {
    let SchemeCoefficients { displacement, acceleration, new_velocity, new_acceleration, .. } =
        scheme.coefficients(1.0);
    let square = omega * omega;
    let mut matrix = [[0.0; 3]; 3];
    for k in 0..3 {
        let unit: [f64; 3] = std::array::from_fn(|j| if j == k { 1.0 } else { 0.0 });
        let u = unit[0];
        let v = unit[1];
        let a = unit[2];
        let start_force =
            combine(acceleration, 0.0, v, a) + square * (u + combine(displacement, 0.0, v, a));
        let du = -start_force / (acceleration[0] + square * displacement[0]);
        matrix[0][k] = u + du;
        matrix[1][k] = combine(new_velocity, du, v, a);
        matrix[2][k] = combine(new_acceleration, du, v, a);
    }
    matrix
}

/// Principal minor of two rows and columns of a matrix.
fn principal_minor(m: &[[f64; 3]; 3], i: usize, j: usize) -> f64 {
    m[i][i] * m[j][j] - m[i][j] * m[j][i]
}

/// Minor of the second and third row.
fn lower_minor(m: &[[f64; 3]; 3], i: usize, j: usize) -> f64 {
    m[1][i] * m[2][j] - m[1][j] * m[2][i]
}

/// Largest root of the characteristic polynomial of a matrix, by Weierstrass' iteration on all three.
fn spectral_radius(m: &[[f64; 3]; 3]) -> f64 {
    let determinant = m[0][0] * lower_minor(m, 1, 2) - m[0][1] * lower_minor(m, 0, 2)
        + m[0][2] * lower_minor(m, 0, 1);
    let trace = m[0][0] + m[1][1] + m[2][2];
    let minors = principal_minor(m, 0, 1) + principal_minor(m, 0, 2) + principal_minor(m, 1, 2);
    let one = Complex::real(1.0);
    let mut roots = [one, Complex::new(0.4, 0.9), Complex::new(-0.65, 0.72)];
    for _ in 0..500 {
        for i in 0..3 {
            let z = roots[i];
            let value = ((z - Complex::real(trace)) * z + Complex::real(minors)) * z
                - Complex::real(determinant);
            let differences =
                (0..3).filter(|j| *j != i).fold(one, |product, j| product * (z - roots[j]));
            roots[i] = z - value / differences;
        }
    }
    roots.iter().map(|root| root.abs()).fold(0.0, f64::max)
}

/// Spectral radii are those in the documentation of `DissipativeMidpoint`.
#[test]
fn spectral_radius_is_that_of_the_table() {
    for (gamma, radii) in [
        (0.6, [1.0, 0.9999, 0.9972, 0.9766, 0.9443]),
        (0.8, [1.0, 0.9976, 0.9570, 0.8478, 0.9306]),
        (1.0, [1.0, 0.9907, 0.8873, 0.7082, 0.9630]),
    ] {
        for (omega, expected) in [0.1, 1.0, 3.0, 10.0, 30.0].into_iter().zip(radii) {
            let radius = spectral_radius(&amplification(&dissipative(gamma), omega));
            assert!((radius - expected).abs() < 6e-5, "γ = {gamma}, ωΔt = {omega}: {radius}");
        }
        let radius_at_high_frequency = spectral_radius(&amplification(&dissipative(gamma), 1e5));
        assert!(
            radius_at_high_frequency <= 1.0 + 1e-9 && radius_at_high_frequency > 0.999,
            "{radius_at_high_frequency}"
        );
    }
}

/// Circular frequency, damping ratio and circular frequency of the force of an oscillator.
const NATURAL_FREQUENCY: f64 = 3.0;
const DAMPING_RATIO: f64 = 0.05;
const FORCE_FREQUENCY: f64 = 2.0;

/// Displacement of u'' + 2ζωu' + ω²u = sin Ωt from rest.
///
/// u = sine sin Ωt + cosine cos Ωt + e^(−ζωt) (p cos ω_d t + q sin ω_d t).
fn driven_oscillator(time: f64) -> f64 {
    let omega = NATURAL_FREQUENCY;
    let ratio = DAMPING_RATIO;
    let force_frequency = FORCE_FREQUENCY;
    let damped_frequency = omega * (1.0 - ratio * ratio).sqrt();
    let stiffness_difference = omega * omega - force_frequency * force_frequency;
    let drag = 2.0 * ratio * omega * force_frequency;
    let size = stiffness_difference * stiffness_difference + drag * drag;
    let sine = stiffness_difference / size;
    let cosine = -drag / size;
    let p = -cosine;
    let q = (ratio * omega * p - force_frequency * sine) / damped_frequency;
    let free = p * (damped_frequency * time).cos() + q * (damped_frequency * time).sin();
    sine * (force_frequency * time).sin()
        + cosine * (force_frequency * time).cos()
        + free * (-ratio * omega * time).exp()
}

/// Largest error of the displacement in the first 4 s, in so many steps.
fn oscillator_error(gamma: f64, steps: u32) -> f64 {
    let step = 4.0 / f64::from(steps);
    let scheme = dissipative(gamma).coefficients(step);
    let inertia = 1.0;
    let dashpot = 2.0 * DAMPING_RATIO * NATURAL_FREQUENCY;
    let spring = NATURAL_FREQUENCY * NATURAL_FREQUENCY;
    let mut u = 0.0;
    let mut v = 0.0;
    let mut a = 0.0;
    let mut largest_error = 0.0_f64;
    for n in 0..steps {
        let force = (FORCE_FREQUENCY * step * (f64::from(n) + scheme.load_fraction)).sin();
        let start_force = inertia * combine(scheme.acceleration, 0.0, v, a)
            + dashpot * combine(scheme.velocity, 0.0, v, a)
            + spring * (u + combine(scheme.displacement, 0.0, v, a));
        let effective = inertia * scheme.acceleration[0]
            + dashpot * scheme.velocity[0]
            + spring * scheme.displacement[0];
        let du = (force - start_force) / effective;
        let new_velocity = combine(scheme.new_velocity, du, v, a);
        a = combine(scheme.new_acceleration, du, v, a);
        v = new_velocity;
        u += du;
        let error = (u - driven_oscillator(step * f64::from(n + 1))).abs();
        largest_error = largest_error.max(error);
    }
    largest_error
}

#[test]
fn order_is_two_for_every_gamma() {
    for gamma in GAMMA_VALUES {
        let order = (oscillator_error(gamma, 400) / oscillator_error(gamma, 800)).log2();
        assert!((order - 2.0).abs() < 0.01, "γ = {gamma}: {order}");
    }
}
