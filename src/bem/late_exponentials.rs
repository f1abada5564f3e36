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
//! exponentially in the reciprocal of its step (Beylkin & Monzón 2010, Appl. Comput. Harmon. Anal. 28, 131–149); its
//! error is relative at every t and for every k. Φ is entire: a few Legendre polynomials over the patch represent it,
//! fewer for a smaller s.
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

/// Exponentials begin when the Rayleigh wave has crossed the patch this many times. After three, the coefficients
/// themselves are summed from the same series.
const WINDOW_CROSSINGS: f64 = 3.0;
/// Largest number of poles; no accepted tolerance needs so many.
const MAX_POLE_COUNT: f64 = 1e4;
/// Largest number of polynomials of a pole.
const MAX_DEGREES: usize = 24;
/// Fraction of the tolerance reserved for neglected polynomials.
const NEGLECTED_TOLERANCE_FRACTION: f64 = 0.05;
/// Largest energy that neglected polynomials take from slow motions, relative to the energy that a step radiates at
/// once. It is far below the passivity margin.
const NEGLECTED_ENERGY_FRACTION: f64 = 1e-4;

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
    let unit = kernel.unit();
    let half_span = 0.5 * classes.span();
    let begin = window as f64 * travel_per_step;
    let fastest = (1.5 * (5.0 - tolerance.ln()) / begin).ln();
    let slowest =
        (NEGLECTED_TOLERANCE_FRACTION * tolerance / (horizon as f64 * travel_per_step)).ln();
    let count = ((fastest - slowest) / h).ceil();
    // The count is infinite where the horizon exceeds the largest number.
    require(
        "number of exponentials",
        count,
        count < MAX_POLE_COUNT,
        "below 10000: the time step is too long",
    )?;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred")]
    let count = count as usize;
    let difference_powers = legendre_of_difference_powers();
    let mut poles: Vec<Pole> = Vec::with_capacity(count);
    for k in 0..count {
        let s = (fastest - k as f64 * h).exp();
        let weight = -unit * h * (-s * travel_per_step).exp_m1() * (-s * begin).exp();
        let mut pole = Pole::new(late_series, &difference_powers, s, s * half_span, weight);
        // Largest contribution of this pole to the coefficient of a time in the sum.
        let contribution = if s * begin > 1.0 { s * begin * (1.0 - s * begin).exp() } else { 1.0 };
        let energy = h * (-s * begin).exp() / (s * travel_per_step);
        let max_error = NEGLECTED_TOLERANCE_FRACTION * tolerance / contribution;
        pole.reduce_degrees(late_series, max_error.min(NEGLECTED_ENERGY_FRACTION / energy));
        poles.push(pole);
    }
    // A pole has all the degrees of slower poles, so that each degree has the first few poles.
    for k in (1..poles.len()).rev() {
        poles[k - 1].degrees = poles[k - 1].degrees.max(poles[k].degrees);
    }
    let degrees = poles.first().map_or(1, |pole| pole.degrees);
    let mut products = Vec::new();
    for i in 0..degrees {
        for j in (i..degrees).step_by(2) {
            let mut normal = vec![];
            let mut tangential = vec![];
            for pole in poles.iter().take_while(|pole| pole.degrees > j) {
                normal.push(pole.weight * pole.legendre[0][i * MAX_DEGREES + j]);
                tangential.push(pole.weight * pole.legendre[1][i * MAX_DEGREES + j]);
            }
            products.push(TailProduct { functions: [i, j], normal, tangential });
        }
    }
    let rates = poles.iter().map(|pole| pole.s * travel_per_step).collect();
    ExponentialSum::new(rates, legendre_means(classes.elements(), degrees), products)
}

/// A rate, and the Legendre coefficients of Φ for it.
struct Pole {
    s: f64,
    weight: f64,
    degrees: usize,
    /// `β_ij` of zz and xx, `MAX_DEGREES` × `MAX_DEGREES`.
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
        Self { s, weight, degrees: MAX_DEGREES, legendre }
    }

    /// Reduces the degrees to the fewest whose neglected terms, relative to t⁻¹ alone, are below `limit`.
    fn reduce_degrees(&mut self, late_series: &[[f64; LATE_SERIES_TERMS]; 2], limit: f64) {
        let mut neglected = [0.0; 2];
        while self.degrees > 1 {
            let last = self.degrees - 1;
            for (component, neglected) in neglected.iter_mut().enumerate() {
                let legendre = &self.legendre[component];
                let mut added = 0.0;
                for i in 0..last {
                    added += legendre[i * MAX_DEGREES + last].abs()
                        + legendre[last * MAX_DEGREES + i].abs();
                }
                added += legendre[last * MAX_DEGREES + last].abs();
                *neglected += added / late_series[component][0].abs();
            }
            if neglected[0].max(neglected[1]) > limit {
                return;
            }
            self.degrees = last;
        }
    }
}

/// Legendre coefficients of Φ(s(ξ−η)) over the patch, `MAX_DEGREES` × `MAX_DEGREES`.
fn legendre_of_kernel(
    series: [f64; LATE_SERIES_TERMS],
    difference_powers: &[f64],
    scaled_half_span: f64,
) -> Vec<f64> {
    let mut legendre = vec![0.0; MAX_DEGREES * MAX_DEGREES];
    let mut power = 1.0;
    for (k, of_power) in difference_powers.chunks_exact(MAX_DEGREES * MAX_DEGREES).enumerate() {
        let factor = series[k] * power;
        for (sum, value) in legendre.iter_mut().zip(of_power) {
            *sum += factor * value;
        }
        let next = (2 * k + 2) as f64;
        power *= scaled_half_span * scaled_half_span / (next * (next - 1.0));
    }
    // Higher degrees at slow poles are rounding errors.
    let rounding = 1e-15 * legendre[0].abs();
    for (place, value) in legendre.iter_mut().enumerate() {
        let i = place / MAX_DEGREES;
        let j = place % MAX_DEGREES;
        if value.abs() < rounding * ((2 * i + 1) * (2 * j + 1)) as f64 {
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

/// Means over the elements of the Legendre polynomials of the first `degrees` degrees.
///
/// The interval [−1, 1] of the polynomials is stretched over the patch.
fn legendre_means(elements: &[ContactElement], degrees: usize) -> Vec<Vec<f64>> {
    let first = elements[0].left();
    let last = elements[elements.len() - 1].right();
    let half_span = 0.5 * (last - first);
    let middle = 0.5 * (first + last);
    let mut means = vec![vec![0.0; elements.len()]; degrees];
    let mut values = vec![0.0; degrees];
    // A Gauss rule over each element is exact, and does not cancel on short ones.
    let rule = gauss::largest();
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

/// Legendre coefficients of (x−y)^(2k) in x and y, `MAX_DEGREES` × `MAX_DEGREES` for each k.
///
/// All binomial terms that contribute to a coefficient have one sign, so no digits are lost.
fn legendre_of_difference_powers() -> Vec<f64> {
    let powers = legendre_of_powers(2 * LATE_SERIES_TERMS - 1);
    let mut tables = vec![0.0; LATE_SERIES_TERMS * MAX_DEGREES * MAX_DEGREES];
    for (k, table) in tables.chunks_exact_mut(MAX_DEGREES * MAX_DEGREES).enumerate() {
        let mut binomial = 1.0;
        for m in 0..=2 * k {
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            for (i, row) in table.chunks_exact_mut(MAX_DEGREES).enumerate() {
                let factor = sign * binomial * powers[m][i];
                if factor != 0.0 {
                    let other = &powers[2 * k - m];
                    row.iter_mut().zip(other).for_each(|(sum, value)| *sum += factor * value);
                }
            }
            binomial *= (2 * k - m) as f64 / (m + 1) as f64;
        }
    }
    tables
}

/// Legendre coefficients of 1, x, x², …, none of them negative: x Pᵢ = ((i+1) Pᵢ₊₁ + i Pᵢ₋₁)/(2i+1).
fn legendre_of_powers(count: usize) -> Vec<Vec<f64>> {
    let mut powers = vec![vec![0.0; MAX_DEGREES.max(count + 1)]; count];
    powers[0][0] = 1.0;
    for m in 1..count {
        for i in 0..m {
            let part = powers[m - 1][i] / (2 * i + 1) as f64;
            powers[m][i + 1] += (i + 1) as f64 * part;
            if i > 0 {
                powers[m][i - 1] += i as f64 * part;
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
        let tables = legendre_of_difference_powers();
        for (k, table) in
            tables.chunks_exact(MAX_DEGREES * MAX_DEGREES).enumerate().take(MAX_DEGREES / 2)
        {
            for (x, y) in [(0.3_f64, -0.8), (-0.95, 0.9), (0.5, 0.5), (1.0, -1.0)] {
                let mut in_x = [0.0; MAX_DEGREES];
                let mut in_y = [0.0; MAX_DEGREES];
                fill_legendre(x, &mut in_x);
                fill_legendre(y, &mut in_y);
                let sum: f64 = (0..MAX_DEGREES * MAX_DEGREES)
                    .map(|place| {
                        table[place] * in_x[place / MAX_DEGREES] * in_y[place % MAX_DEGREES]
                    })
                    .sum();
                let exact = (0..k).fold(1.0_f64, |power, _| power * (x - y) * (x - y));
                let largest = (2.0 * k as f64).exp2();
                assert!((sum - exact).abs() < 1e-13 * largest, "{k} {x} {y}");
            }
        }
    }
}
