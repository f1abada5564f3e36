//! Closed form of convolution-quadrature weights after the waves have passed.
//!
//! K₀ and K₁ carry the factor ln s: an integral over an element is K(s) = A(s²) ln s + B(s²) with
//! A and B entire. Inside the circle of convergence B and polynomials have no late coefficients, so
//!
//! ```text
//! ωₙ = Σ_k A_k Δt^{−2k} [ζⁿ] δ(ζ)^{2k} ln δ(ζ)      once n Δt exceeds the S wave's travel time,
//! ```
//!
//! and with \[ζⁿ\] (1−ζ)^m ln(1−ζ) = −(−1)^m m!/(n(n−1)…(n−m)) for n > m:
//!
//! * BDF1: δ = 1−ζ;
//! * BDF2: δ = (1−ζ)(1 + (1−ζ)/2), expanded binomially; the factor ln(1 + (1−ζ)/2) is singular
//!   only at ζ = 3 and contributes 3^{−n}.
//!
//! The remainder of the front is neglected: with ρ = r/(c₂Δt) a Cauchy circle of radius X bounds it
//! by e^{ρ(X−1)} X^{−n} (BDF1) and e^{ρ(X²−1)/2} X^{−n} (BDF2, 1 < X < 3).
//!
//! The leading term −A₀/n is Δt times the impulse response −A₀/t at t = nΔt. BDF2 departs from
//! Δt·k(nΔt) at relative order n^{−2} and more, BDF1 at n^{−1} where A₁ matters (tractions).

use super::cq_method::CqMethod;
use super::laplace_element::ElementView;
use crate::linalg::gauss;
use crate::soil::Soil;

/// Number of terms k: A has degree 2k along an element, and the largest Gauss rule is exact to degree 51.
pub(super) const LOG_TERM_COUNT: usize = 26;

/// Coefficients A_k R^{−2k} of one view, in the order of [`ViewBlock`](super::laplace_element::ViewBlock).
pub(super) type LogTerms = [[f64; 8]; LOG_TERM_COUNT];

/// Coefficients of s^{2k} ln s; lengths in units of `length_unit`, and times in units of `length_unit`/c₂.
///
/// With I₀ and I₁/z of the factors ln s in K₀ → −I₀ and K₁/z → I₁/z, ψ = Σ p_k (s r)^{2k} and
/// χ = Σ q_k (s r)^{2k}; r^{2k−2} x_i x_j and similar terms are polynomials on the element.
pub(super) fn log_terms(soil: Soil, view: &ElementView, length_unit: f64) -> LogTerms {
    let line = view.line();
    let radial = radial_terms(soil);
    let center = 0.5 * (line.low + line.high);
    let half_length = 0.5 * (line.high - line.low);
    let nu = soil.poisson();
    let lame_ratio = 2.0 * nu / (1.0 - 2.0 * nu);
    let rule = gauss::largest_rule();
    let mut terms = [[0.0; 8]; LOG_TERM_COUNT];
    for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
        let x = line.offset(center + half_length * node);
        let square = (x[0] * x[0] + x[1] * x[1]) / (length_unit * length_unit);
        let n = line.normal;
        let normal_offset = x[0] * n[0] + x[1] * n[1];
        let weight = weight * half_length;
        // (r/R)^{2k} and (r/R)^{2k−2}.
        let mut power = 1.0;
        let mut lower_power = 0.0;
        for (k, term) in terms.iter_mut().enumerate() {
            let two_k = (2 * k) as f64;
            let p = radial.p[k];
            let q = radial.q[k];
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let delta = if i == j { 1.0 } else { 0.0 };
                let product = x[i] * x[j] / (length_unit * length_unit);
                term[2 * i + j] += weight * (p * delta * power - q * lower_power * product);
                if view.is_self || k == 0 {
                    continue;
                }
                // Traction j on the element from load i at the point.
                let scale = weight * soil.shear_modulus() / (length_unit * length_unit);
                let mut value = (two_k * p - q) * (delta * normal_offset + x[j] * n[i])
                    - 2.0 * q * n[j] * x[i]
                    + lame_ratio * (two_k * (p - q) - q) * x[i] * n[j];
                // 4(1−k) q_k r^{2k−4} x_i x_j x_n vanishes for k = 1.
                if k > 1 {
                    value += (4.0 - 2.0 * two_k) * q * normal_offset * product / square;
                }
                term[4 + 2 * i + j] += scale * lower_power * value;
            }
            lower_power = power;
            power *= square;
        }
    }
    terms
}

/// Coefficients `p_k` and `q_k` of the powers (s r/c₂)^{2k}.
struct RadialTerms {
    p: [f64; LOG_TERM_COUNT],
    q: [f64; LOG_TERM_COUNT],
}

/// Coefficients of the radial functions of a soil.
fn radial_terms(soil: Soil) -> RadialTerms {
    let speed_ratio_squared = soil.speed_ratio_squared();
    let shear_speed = soil.shear_wave_speed();
    let unit = 1.0 / (2.0 * std::f64::consts::PI * soil.density() * shear_speed * shear_speed);
    let mut terms = RadialTerms { p: [0.0; LOG_TERM_COUNT], q: [0.0; LOG_TERM_COUNT] };
    // 1/(4^k k!²) and (c₂/c₁)^{2k+2}.
    let mut scale = unit;
    let mut power = speed_ratio_squared;
    for k in 0..LOG_TERM_COUNT {
        let k_plus_one = (k + 1) as f64;
        terms.p[k] = scale * (0.5 * (1.0 - power) / k_plus_one - 1.0);
        // 1/((k−1)!(k+1)!) = k/((k+1) k!²), from I₂.
        terms.q[k] = -scale * (1.0 - power) * k as f64 / k_plus_one;
        scale /= 4.0 * k_plus_one * k_plus_one;
        power *= speed_ratio_squared;
    }
    terms
}

/// Weights [ζⁿ] (ρδ)^{2k} ln δ of one lag n, for all k.
///
/// The lag n must be above four times [`LOG_TERM_COUNT`].
pub(super) fn lag_weights(method: CqMethod, lag: usize, rho: f64) -> [f64; LOG_TERM_COUNT] {
    let n = lag as f64;
    let mut weights = [0.0; LOG_TERM_COUNT];
    match method {
        CqMethod::Bdf1 => {
            let mut power = -1.0 / n;
            for (k, weight) in weights.iter_mut().enumerate() {
                *weight = power;
                for m in [2 * k + 1, 2 * k + 2] {
                    power *= -(m as f64) * rho / (n - m as f64);
                }
            }
        }
        CqMethod::Bdf2 => {
            // (ρ(1−ζ))^m ln(1−ζ)
            let mut powers = [0.0; 4 * LOG_TERM_COUNT];
            let mut power = -1.0 / n;
            for (m, entry) in powers.iter_mut().enumerate() {
                *entry = power;
                let m = (m + 1) as f64;
                power *= -m * rho / (n - m);
            }
            for (k, weight) in weights.iter_mut().enumerate() {
                let mut binomial = 1.0;
                for j in 0..=2 * k {
                    *weight += binomial * powers[2 * k + j];
                    binomial *= (2 * k - j) as f64 / (j + 1) as f64 * 0.5 / rho;
                }
            }
        }
    }
    weights
}

/// First lag at which the closed form has all digits, for distances up to ρ c₂ Δt.
pub(super) fn first_lag(method: CqMethod, rho: f64) -> usize {
    let mut lag = 8 * LOG_TERM_COUNT;
    while !is_late(method, lag, rho) {
        lag += 8 + lag / 16;
    }
    lag
}

/// Minus the logarithm of a negligible contribution: e^{−37} is below rounding.
const NEGLIGIBLE_EXPONENT: f64 = 37.0;
/// Largest last term of the series, relative to the first, that counts as zero.
const LAST_TERM_TOLERANCE: f64 = 1e-17;
/// Smallest late lag over ρ; at the lag n = ρ the wave front passes.
const MIN_LATE_LAG_RATIO: f64 = 1.5;
/// Largest radius of the Cauchy circle, inside the singularity at 3 of BDF2.
const MAX_CIRCLE_RADIUS: f64 = 2.9;

/// Whether the closed form has all digits at `lag`.
fn is_late(method: CqMethod, lag: usize, rho: f64) -> bool {
    let n = lag as f64;
    if n <= MIN_LATE_LAG_RATIO * rho {
        return false;
    }
    // Minus the logarithm of the front, with the best radius x of the circle.
    let front_exponent = match method {
        CqMethod::Bdf1 => {
            let x = n / rho;
            n * x.ln() - rho * (x - 1.0)
        }
        CqMethod::Bdf2 => {
            let x = (n / rho).sqrt().min(MAX_CIRCLE_RADIUS);
            n * x.ln() - 0.5 * rho * (x * x - 1.0)
        }
    };
    // Last term of the series relative to the first: the largest A_k is below 1/(4^k k!²).
    let weights = lag_weights(method, lag, rho);
    let factor: f64 = (1..LOG_TERM_COUNT).map(|k| 0.25 / (k * k) as f64).product();
    let last_term = (weights[LOG_TERM_COUNT - 1] * factor).abs();
    front_exponent > NEGLIGIBLE_EXPONENT && last_term < LAST_TERM_TOLERANCE * weights[0].abs()
}
