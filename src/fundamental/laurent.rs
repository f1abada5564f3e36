//! Late-time series of the surface kernels of a half-plane.

use crate::fundamental::rayleigh::Rayleigh;

/// Terms kept: enough for rounding from three Rayleigh arrivals on.
pub(crate) const TERMS: usize = 20;

/// `c_k` of f = Σ `c_k` τ^(−2k−1), for zz and xx; converges for τ above the Rayleigh arrival.
///
/// f = τ⁻¹ n(v)/p(v) with v = τ⁻² and p(v) = v³ P(1/v): the numerators are binomial series, and
/// the division by the cubic is a recurrence, stable because the Rayleigh root dominates.
pub(crate) fn late_coefficients(rayleigh: &Rayleigh) -> [[f64; TERMS]; 2] {
    let a2 = rayleigh.a2;
    let root = |k2: f64| {
        let mut series = [1.0; TERMS];
        for k in 1..TERMS {
            series[k] = series[k - 1] * k2 * (k as f64 - 1.5) / k as f64;
        }
        series
    };
    let (sa, sb) = (root(a2), root(1.0));
    let mut result = [[0.0; TERMS]; 2];
    let p = [-16.0 * rayleigh.h, 24.0 - 16.0 * a2, -8.0, 1.0];
    for k in 0..TERMS {
        let at = |s: &[f64; TERMS], back: usize| if k >= back { s[k - back] } else { 0.0 };
        let square = |s: &[f64; TERMS]| 4.0 * at(s, 0) - 4.0 * at(s, 1) + at(s, 2);
        let numerator = [
            square(&sa) + 4.0 * (at(&sb, 0) - a2 * at(&sb, 1)),
            4.0 * (at(&sa, 0) - at(&sa, 1)) + square(&sb),
        ];
        for (series, numerator) in result.iter_mut().zip(numerator) {
            let mut value = -numerator;
            for back in 1..=3.min(k) {
                value -= p[back] * series[k - back];
            }
            series[k] = value / p[0];
        }
    }
    result
}
