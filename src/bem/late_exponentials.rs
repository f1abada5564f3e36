//! Late lags of the half-plane as sums of decaying exponentials.
//!
//! After the Rayleigh wave has passed, the convolution weights are (see `PairInfluence`)
//!
//! * G = 1/(πμ) · (1/l) ∫∫ Σ `c_k` (ξ−η)^(2k) ∫ t^(−2k−1) dt dξ dη
//! * t^(−2k−1) = 1/(2k)! ∫₀^∞ s^(2k) e^(−st) ds
//! * G = 1/(πμ) ∫₀^∞ (e^(sδ)−1) e^(−s n δ) · (1/l) ∫∫ Φ(s(ξ−η)) dξ dη ds/s,
//!   Φ(y) = Σ `c_k` y^(2k)/(2k)!
//!
//! The integral over u = ln s decays at both ends and is analytic in a strip, so that the trapezoidal rule converges
//! exponentially in the reciprocal of its step (Beylkin & Monzón 2010, Appl. Comput. Harmon. Anal. 28, 131–149). Its
//! error is relative at every t and for every k. Φ is an entire function, which a few Legendre polynomials over the
//! patch represent. The number of polynomials decreases with s.
//!
//! | symbol | meaning |
//! |---|---|
//! | δ | `c_S` Δt, m |
//! | s | rate of a pole, 1/m; z = e^(−sδ) its decay in a step |
//! | h | step of the trapezoidal rule in ln s |
//! | W | lags of the window: the exponentials begin at lag W + 1 |
//! | `β_ij` | Legendre coefficients of Φ(s(ξ−η)) over the patch |

use super::{InfluenceKernel, PatchKernel};
use crate::error::{Result, require};
use crate::fundamental::rayleigh::LATE_SERIES_TERMS;
use crate::geometry::ContactElement;
use crate::history::{ConvolutionWeights, ExponentialSum, LateWeights, PairClasses, TailProduct};
use crate::linalg::gauss;

/// Crossings of the patch by the Rayleigh wave before the exponentials begin.
///
/// From three crossings on, the weights themselves are sums of the same series.
const WINDOW_CROSSINGS: f64 = 3.0;
/// Largest number of poles; sums for the accepted tolerances have fewer.
const MAX_POLE_COUNT: f64 = 1e4;
/// Largest number of Legendre polynomials of a pole; neglected terms of the fastest pole are below all tolerances.
const MAX_POLYNOMIAL_COUNT: usize = 24;
/// Fraction of the tolerance reserved for neglected polynomials.
const NEGLECTED_TOLERANCE_FRACTION: f64 = 0.05;
/// Largest energy error of neglected polynomials in slow motions, relative to the energy radiated within one step.
///
/// It is far below the passivity margin.
const NEGLECTED_ENERGY_FRACTION: f64 = 1e-4;
/// Rounding error of a Legendre coefficient of degree 0, relative to the largest coefficient.
const COEFFICIENT_ROUNDING: f64 = 1e-15;

impl LateWeights for PatchKernel {
    /// Number of lags until the Rayleigh wave has crossed the patch three times.
    fn window(&self) -> usize {
        let InfluenceKernel { branches, travel_per_step, .. } = &self.kernel;
        let crossing_length = WINDOW_CROSSINGS * branches.rayleigh_arrival * self.classes().span();
        let lag_count = (crossing_length / travel_per_step).ceil();
        // Float to integer casts saturate.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let window = lag_count as usize;
        window
    }

    fn exponentials(
        &self,
        window: usize,
        horizon: usize,
        tolerance: f64,
    ) -> Result<ExponentialSum> {
        exponential_sum(&self.kernel, self.classes(), window, horizon, tolerance)
    }
}

/// Sum of exponentials for lags from `window` + 1 to `horizon`.
fn exponential_sum(
    kernel: &InfluenceKernel,
    classes: &PairClasses,
    window: usize,
    horizon: usize,
    tolerance: f64,
) -> Result<ExponentialSum> {
    // The error of the trapezoidal rule is about e^(3−π²/h); this includes the narrowing of the analytic strip by the
    // Rayleigh wave.
    let h = std::f64::consts::PI.powi(2) / (3.0 - tolerance.ln());
    let InfluenceKernel { late_series, travel_per_step, .. } = kernel;
    let compliance_factor = kernel.compliance_factor();
    let half_span = 0.5 * classes.span();
    let window_length = window as f64 * travel_per_step;
    // At the largest rate, the exponential at the end of the window is far below the tolerance: (tolerance/e⁵)^1.5.
    let max_log_rate = (1.5 * (5.0 - tolerance.ln()) / window_length).ln();
    // At the smallest rate, the exponential changes over the horizon by a fraction of the tolerance.
    let min_log_rate =
        (NEGLECTED_TOLERANCE_FRACTION * tolerance / (horizon as f64 * travel_per_step)).ln();
    let pole_count = ((max_log_rate - min_log_rate) / h).ceil();
    // The count is infinite if the length of the horizon is beyond the largest floating-point number.
    require(
        "number of exponentials",
        pole_count,
        pole_count < MAX_POLE_COUNT,
        "below 10000: the time step is too long",
    )?;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred")]
    let pole_count = pole_count as usize;
    let difference_powers = legendre_of_difference_powers();
    let mut poles: Vec<Pole> = Vec::with_capacity(pole_count);
    for k in 0..pole_count {
        let s = (max_log_rate - k as f64 * h).exp();
        let weight =
            -compliance_factor * h * (-s * travel_per_step).exp_m1() * (-s * window_length).exp();
        let mut pole = Pole::new(late_series, &difference_powers, s, s * half_span, weight);
        // Largest contribution of this pole to the sum at any time.
        let relative_window = s * window_length;
        let contribution = if relative_window > 1.0 {
            relative_window * (1.0 - relative_window).exp()
        } else {
            1.0
        };
        let energy = h * (-s * window_length).exp() / (s * travel_per_step);
        let max_error = NEGLECTED_TOLERANCE_FRACTION * tolerance / contribution;
        pole.reduce_polynomials(late_series, max_error.min(NEGLECTED_ENERGY_FRACTION / energy));
        poles.push(pole);
    }
    // A pole has all polynomials of slower poles, so that the poles of each polynomial are the first few.
    for k in (1..poles.len()).rev() {
        poles[k - 1].polynomial_count =
            poles[k - 1].polynomial_count.max(poles[k].polynomial_count);
    }
    let polynomial_count = poles.first().map_or(1, |pole| pole.polynomial_count);
    let rates = poles.iter().map(|pole| pole.s * travel_per_step).collect();
    let means = legendre_means(classes.elements(), polynomial_count);
    ExponentialSum::new(rates, means, polynomial_products(&poles, polynomial_count))
}

/// Products of two Legendre polynomials, with their coefficients for each pole.
fn polynomial_products(poles: &[Pole], polynomial_count: usize) -> Vec<TailProduct> {
    let mut products = Vec::new();
    for i in 0..polynomial_count {
        for j in (i..polynomial_count).step_by(2) {
            let mut normal = vec![];
            let mut tangential = vec![];
            for pole in poles.iter().take_while(|pole| pole.polynomial_count > j) {
                normal.push(pole.weight * pole.legendre[0][i * MAX_POLYNOMIAL_COUNT + j]);
                tangential.push(pole.weight * pole.legendre[1][i * MAX_POLYNOMIAL_COUNT + j]);
            }
            products.push(TailProduct { functions: [i, j], normal, tangential });
        }
    }
    products
}

/// Exponential of the sum, with the Legendre coefficients of Φ for its rate.
struct Pole {
    /// Rate, 1/m.
    s: f64,
    /// Weight in the trapezoidal rule, 1/Pa.
    weight: f64,
    /// Number of Legendre polynomials of this pole.
    polynomial_count: usize,
    /// `β_ij` of zz and xx, `MAX_POLYNOMIAL_COUNT` × `MAX_POLYNOMIAL_COUNT`.
    legendre: [Vec<f64>; 2],
}

impl Pole {
    /// Pole of the rate `s`; `scaled_half_span` is s times half the length of the patch.
    fn new(
        late_series: &[[f64; LATE_SERIES_TERMS]; 2],
        difference_powers: &[f64],
        s: f64,
        scaled_half_span: f64,
        weight: f64,
    ) -> Self {
        let legendre = late_series
            .map(|series| legendre_of_kernel(series, difference_powers, scaled_half_span));
        Self { s, weight, polynomial_count: MAX_POLYNOMIAL_COUNT, legendre }
    }

    /// Reduces the number of polynomials while the neglected terms are at most `max_error`.
    ///
    /// `max_error`: bound of the sum of all neglected terms, relative to the term t⁻¹.
    fn reduce_polynomials(&mut self, late_series: &[[f64; LATE_SERIES_TERMS]; 2], max_error: f64) {
        let mut neglected_sums = [0.0; 2];
        while self.polynomial_count > 1 {
            let last_degree = self.polynomial_count - 1;
            for (component, neglected_sum) in neglected_sums.iter_mut().enumerate() {
                let legendre = &self.legendre[component];
                let mut dropped_sum = 0.0;
                for i in 0..last_degree {
                    dropped_sum += legendre[i * MAX_POLYNOMIAL_COUNT + last_degree].abs()
                        + legendre[last_degree * MAX_POLYNOMIAL_COUNT + i].abs();
                }
                dropped_sum += legendre[last_degree * MAX_POLYNOMIAL_COUNT + last_degree].abs();
                *neglected_sum += dropped_sum / late_series[component][0].abs();
            }
            if neglected_sums[0].max(neglected_sums[1]) > max_error {
                return;
            }
            self.polynomial_count = last_degree;
        }
    }
}

/// Legendre coefficients of Φ(s(ξ−η)) over the patch, `MAX_POLYNOMIAL_COUNT` × `MAX_POLYNOMIAL_COUNT`.
fn legendre_of_kernel(
    series: [f64; LATE_SERIES_TERMS],
    difference_powers: &[f64],
    scaled_half_span: f64,
) -> Vec<f64> {
    let mut legendre = vec![0.0; MAX_POLYNOMIAL_COUNT * MAX_POLYNOMIAL_COUNT];
    let mut power = 1.0;
    for (k, table) in difference_powers
        .chunks_exact(MAX_POLYNOMIAL_COUNT * MAX_POLYNOMIAL_COUNT)
        .enumerate()
    {
        let factor = series[k] * power;
        for (sum, value) in legendre.iter_mut().zip(table) {
            *sum += factor * value;
        }
        let next_exponent = (2 * k + 2) as f64;
        power *= scaled_half_span * scaled_half_span / (next_exponent * (next_exponent - 1.0));
    }
    // Coefficients of higher degrees at slow poles are rounding errors.
    let rounding_error = COEFFICIENT_ROUNDING * legendre[0].abs();
    for (index, value) in legendre.iter_mut().enumerate() {
        let i = index / MAX_POLYNOMIAL_COUNT;
        let j = index % MAX_POLYNOMIAL_COUNT;
        if value.abs() < rounding_error * ((2 * i + 1) * (2 * j + 1)) as f64 {
            *value = 0.0;
        }
    }
    legendre
}

/// Overwrites `values` with the Legendre polynomials of degree 0, 1, … at `x`.
fn fill_legendre(x: f64, values: &mut [f64]) {
    for degree in 0..values.len() {
        values[degree] = match degree {
            0 => 1.0,
            1 => x,
            _ => gauss::next_legendre(degree, x, [values[degree - 2], values[degree - 1]]),
        };
    }
}

/// Element means of the first `polynomial_count` Legendre polynomials.
///
/// The interval [−1, 1] of the polynomials is mapped to the patch.
fn legendre_means(elements: &[ContactElement], polynomial_count: usize) -> Vec<Vec<f64>> {
    let left_end = elements[0].left();
    let right_end = elements[elements.len() - 1].right();
    let half_span = 0.5 * (right_end - left_end);
    let middle = 0.5 * (left_end + right_end);
    let mut means = vec![vec![0.0; elements.len()]; polynomial_count];
    let mut values = vec![0.0; polynomial_count];
    // A Gauss rule over each element is exact, without cancellation on short elements.
    let rule = gauss::largest_rule();
    for (e, element) in elements.iter().enumerate() {
        for (node, weight) in rule.points() {
            let x = element.center()[0] - middle + 0.5 * element.length() * node;
            fill_legendre(x / half_span, &mut values);
            for (mean, value) in means.iter_mut().zip(&values) {
                mean[e] += 0.5 * weight * value;
            }
        }
    }
    means
}

/// Legendre coefficients of (x−y)^(2k) in x and y, `MAX_POLYNOMIAL_COUNT` × `MAX_POLYNOMIAL_COUNT` for each k.
///
/// All binomial terms of a coefficient have the same sign, so no digits are lost.
fn legendre_of_difference_powers() -> Vec<f64> {
    let powers = legendre_of_powers(2 * LATE_SERIES_TERMS - 1);
    let mut tables = vec![0.0; LATE_SERIES_TERMS * MAX_POLYNOMIAL_COUNT * MAX_POLYNOMIAL_COUNT];
    for (k, table) in
        tables.chunks_exact_mut(MAX_POLYNOMIAL_COUNT * MAX_POLYNOMIAL_COUNT).enumerate()
    {
        let mut binomial = 1.0;
        for m in 0..=2 * k {
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            for (i, row) in table.chunks_exact_mut(MAX_POLYNOMIAL_COUNT).enumerate() {
                let factor = sign * binomial * powers[m][i];
                if factor != 0.0 {
                    for (sum, value) in row.iter_mut().zip(&powers[2 * k - m]) {
                        *sum += factor * value;
                    }
                }
            }
            binomial *= (2 * k - m) as f64 / (m + 1) as f64;
        }
    }
    tables
}

/// Legendre coefficients of the powers 1, x, x², …, none of them negative.
///
/// They follow from the recurrence x Pᵢ = ((i+1) Pᵢ₊₁ + i Pᵢ₋₁)/(2i+1).
fn legendre_of_powers(power_count: usize) -> Vec<Vec<f64>> {
    let mut powers = vec![vec![0.0; MAX_POLYNOMIAL_COUNT.max(power_count + 1)]; power_count];
    powers[0][0] = 1.0;
    for m in 1..power_count {
        for i in 0..m {
            let quotient = powers[m - 1][i] / (2 * i + 1) as f64;
            powers[m][i + 1] += (i + 1) as f64 * quotient;
            if i > 0 {
                powers[m][i - 1] += i as f64 * quotient;
            }
        }
    }
    powers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_powers_of_the_distance() {
        const N: usize = MAX_POLYNOMIAL_COUNT;
        let tables = legendre_of_difference_powers();
        for (k, table) in tables.chunks_exact(N * N).enumerate().take(N / 2) {
            for (x, y) in [(0.3_f64, -0.8), (-0.95, 0.9), (0.5, 0.5), (1.0, -1.0)] {
                let mut x_polynomials = [0.0; N];
                let mut y_polynomials = [0.0; N];
                fill_legendre(x, &mut x_polynomials);
                fill_legendre(y, &mut y_polynomials);
                let mut computed = 0.0;
                for (index, coefficient) in table.iter().enumerate() {
                    computed += coefficient * x_polynomials[index / N] * y_polynomials[index % N];
                }
                let expected = (0..k).fold(1.0_f64, |power, _| power * (x - y) * (x - y));
                let max_power = (2.0 * k as f64).exp2();
                assert!((computed - expected).abs() < 1e-13 * max_power, "{k} {x} {y}");
            }
        }
    }
}
