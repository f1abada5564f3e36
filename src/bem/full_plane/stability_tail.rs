//! Sums over late lags, which a polynomial in 1/n interpolates.
//!
//! n·(Gⁿ, Hⁿ) of an elastic plane is analytic in x = N/n for nΔt beyond the waves' travel time. Its
//! polynomial through Chebyshev points of 0 < x < 1 is summed in closed form,
//!
//! ```text
//! Σ_{n≥N} ζⁿ (N/n)^p = 1/Γ(p) ∫₀^∞ y^{p−1} e^{−y} ζ^N / (1 − ζ e^{−y/N}) dy ,
//! ```
//!
//! with the integral by the trapezoidal rule in ln y, which converges exponentially, because for |ζ| ≤ 1 the argument of
//! the pole y = N ln ζ is at least a quarter turn.

use std::f64::consts::PI;

use basemat_fourier::num_complex::Complex64;

/// Number of powers p = 1, 2, … of N/n in the interpolation.
pub(super) const TAIL_POWERS: usize = 10;

/// Step of ln y in the trapezoidal rule.
const LOGARITHM_STEP: f64 = 0.125;
/// First step of the rule, at which y = e^{−35} is below rounding.
const FIRST_STEP: i32 = -280;
/// Last step of the rule, at which e^{−y} with y = e⁴ is below rounding.
const LAST_STEP: i32 = 32;

/// Lag of the Chebyshev point `k`; the lag is between two points for a `k` between two integers.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "n ≥ N")]
pub(super) fn interpolation_lag(first_lag: f64, k: f64) -> usize {
    let point = 0.5 + 0.5 * (PI * (k + 0.5) / TAIL_POWERS as f64).cos();
    (first_lag / point).ceil() as usize
}

/// Σ_{n≥first} ζⁿ (first/n)^p for p = 1 … [`TAIL_POWERS`].
pub(super) fn tail_sums(zeta: Complex64, first_lag: f64) -> [Complex64; TAIL_POWERS] {
    let mut sums = [Complex64::default(); TAIL_POWERS];
    let factor = (zeta.ln() * first_lag).exp() * LOGARITHM_STEP;
    for k in FIRST_STEP..=LAST_STEP {
        let y = (LOGARITHM_STEP * f64::from(k)).exp();
        // dy = y d(ln y)
        let mut term = factor * (-y).exp() * y / (1.0 - zeta * (-y / first_lag).exp());
        for (p, sum) in sums.iter_mut().enumerate() {
            *sum += term;
            term *= y / (p + 1) as f64;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed sums against direct summation where |ζ| < 1, and for p = 1 against a logarithm where |ζ| = 1.
    #[test]
    fn tails_are_sums() {
        for (radius, angle) in [(0.99, 0.0), (0.99, 1.0), (0.98, 3.1), (0.995, 0.01)] {
            let zeta = Complex64::from_polar(radius, angle);
            let tails = tail_sums(zeta, 64.0);
            for (p, tail) in tails.iter().enumerate() {
                let power = i32::try_from(p + 1).unwrap();
                let sum: Complex64 =
                    (64..9000).map(|n| zeta.powi(n) * (64.0 / f64::from(n)).powi(power)).sum();
                assert!((tail - sum).norm() < 1e-12, "{zeta} {p}: {tail} {sum}");
            }
        }
        // On the circle: Σ_{n≥1} ζⁿ/n = −ln(1−ζ).
        let zeta = Complex64::from_polar(1.0, 0.3);
        let early_sum: Complex64 = (1..64).map(|n| zeta.powi(n) / f64::from(n)).sum();
        let sum = early_sum + tail_sums(zeta, 64.0)[0] / 64.0;
        assert!((sum + (1.0 - zeta).ln()).norm() < 1e-13);
    }
}
