//! Modified Bessel functions K₀ and K₁ of complex argument.
//!
//! | symbol | meaning |
//! |---|---|
//! | z | argument, Re z > 0 |
//! | q | (z/2)² |
//! | κ | K₁(z)/z − 1/z²: K₁/z without its pole |
//!
//! With ψ the digamma function [Abramowitz & Stegun 1964, 9.6.10–9.6.13],
//!
//! * K₀ = Σ qᵏ/(k!)² · (ψ(k+1) − ln(z/2)),
//! * κ = Σ qᵏ/(k!(k+1)!) · (½ ln(z/2) − ¼ψ(k+1) − ¼ψ(k+2)).

use basemat_fourier::num_complex::Complex;
use complex_bessel::{Scaling, besselk_seq};

/// Complex number of double precision.
pub(super) type Complex64 = Complex<f64>;

/// Largest |z| at which the series has all digits, because its cancellation factor I₀/|K₀| is below 20.
pub(super) const MAX_SERIES_ARGUMENT: f64 = 2.0;

/// Smallest real part for which K is below 1e-30 and counts as zero.
const NEGLIGIBLE_REAL_PART: f64 = 70.0;

/// Number of terms of the series, with which qᵏ/k!² is below 1e-17 at |z| = 2.
const SERIES_TERM_COUNT: usize = 14;

/// Euler's constant.
const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// Modified Bessel functions of one argument, in the combinations of the fundamental solution.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ModifiedBessel {
    /// K₀(z).
    pub(super) k0: Complex64,
    /// K₁(z)/z, or κ without the pole.
    pub(super) quotient: Complex64,
    /// z K₁(z).
    pub(super) product: Complex64,
}

/// K₀ and K₁ of `z`; κ instead of K₁/z if `omits_pole`, for |z| ≤ [`MAX_SERIES_ARGUMENT`].
pub(super) fn modified_bessel(z: Complex64, omits_pole: bool) -> ModifiedBessel {
    if z.norm() <= MAX_SERIES_ARGUMENT {
        let BesselSeries { k0, kappa } = bessel_series(z, false);
        let square = z * z;
        let quotient = if omits_pole { kappa } else { kappa + 1.0 / square };
        return ModifiedBessel { k0, quotient, product: 1.0 + square * kappa };
    }
    if z.re > NEGLIGIBLE_REAL_PART {
        return ModifiedBessel::default();
    }
    if let Ok(sequence) = besselk_seq(0.0, z, 2, Scaling::Unscaled) {
        let k0 = sequence.values[0];
        let k1 = sequence.values[1];
        return ModifiedBessel { k0, quotient: k1 / z, product: k1 * z };
    }
    // The argument is not finite here; the result must not be finite either.
    let nan = Complex64::new(f64::NAN, f64::NAN);
    ModifiedBessel { k0: nan, quotient: nan, product: nan }
}

/// K₀ and κ of one argument, or their means over a line.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct BesselSeries {
    pub(super) k0: Complex64,
    pub(super) kappa: Complex64,
}

/// K₀ and κ at `z` by their series.
///
/// If `is_mean`, means over the line from 0 to `z`.
pub(super) fn bessel_series(z: Complex64, is_mean: bool) -> BesselSeries {
    let half = 0.5 * z;
    let log = half.ln();
    let q = half * half;
    let mut power = Complex64::new(1.0, 0.0);
    let mut sums = BesselSeries::default();
    let mut digamma = -EULER_GAMMA;
    for k in 0..SERIES_TERM_COUNT {
        let term_number = (k + 1) as f64;
        let mut scale = power;
        let mut logarithm = log;
        if is_mean {
            // ∫₀¹ x^{2k} ln(xz/2) dx = (ln(z/2) − 1/(2k+1))/(2k+1)
            let odd_number = (2 * k + 1) as f64;
            scale = power / odd_number;
            logarithm = log - 1.0 / odd_number;
        }
        sums.k0 += scale * (digamma - logarithm);
        sums.kappa += scale / term_number * (0.5 * logarithm - 0.5 * digamma - 0.25 / term_number);
        digamma += 1.0 / term_number;
        power *= q / (term_number * term_number);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Series and library function have all digits of the table, which tests/data/bessel_k.py computes by mpmath.
    #[test]
    fn values_agree_with_the_table() {
        let table = include_str!("../../../tests/data/bessel_k.csv");
        let mut row_count = 0;
        for line in table.lines().filter(|line| !line.starts_with(['#', 'r'])) {
            let x: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
            let z = Complex64::new(x[0], x[1]);
            let k0 = Complex64::new(x[2], x[3]);
            let k1 = Complex64::new(x[4], x[5]);
            let values = modified_bessel(z, false);
            for (name, computed, expected) in [
                ("K0", values.k0, k0),
                ("K1/z", values.quotient, k1 / z),
                ("zK1", values.product, k1 * z),
            ] {
                let error = (computed - expected).norm() / expected.norm();
                assert!(error < 5e-14, "{name}({z}): {computed}, not {expected}: {error:.1e}");
            }
            row_count += 1;
        }
        assert_eq!(row_count, 112);
    }

    /// The regular part of K₁/z agrees with the library near the limit of the series, and near 0 with its leading terms.
    #[test]
    fn regular_part_is_the_quotient_without_its_pole() {
        let z = Complex64::new(1.2, -1.5);
        let kappa = modified_bessel(z, true).quotient;
        let k1 = besselk_seq(0.0, z, 2, Scaling::Unscaled).unwrap().values[1];
        assert!((kappa - (k1 / z - 1.0 / (z * z))).norm() < 1e-14);
        let small_argument = Complex64::new(3e-9, 1e-9);
        let leading_terms = 0.5 * (0.5 * small_argument).ln() + 0.5 * EULER_GAMMA - 0.25;
        assert!((modified_bessel(small_argument, true).quotient - leading_terms).norm() < 1e-14);
    }

    /// Means over [0, z] and [0, z/2] against a Gauss rule from z/2 to z, away from the logarithm.
    #[test]
    fn means_are_integrals() {
        let z = Complex64::new(0.9, 1.1);
        let whole_mean = bessel_series(z, true);
        let half = bessel_series(0.5 * z, true);
        let rule = crate::linalg::gauss::largest_rule();
        let mut k0 = whole_mean.k0 * z - half.k0 * 0.5 * z;
        let mut kappa = whole_mean.kappa * z - half.kappa * 0.5 * z;
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let value = bessel_series(z * (0.75 + 0.25 * node), false);
            k0 -= value.k0 * z * (0.25 * weight);
            kappa -= value.kappa * z * (0.25 * weight);
        }
        assert!(k0.norm() < 1e-14 && kappa.norm() < 1e-14);
    }
}
