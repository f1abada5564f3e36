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
const CROSSINGS: f64 = 3.0;
/// Limit of the number of poles; no tolerance needs so many.
const MOST: f64 = 1e4;
/// Largest number of polynomials of a pole.
const DEGREES: usize = 24;
/// Fraction of the tolerance reserved for neglected polynomials.
const DROPPED: f64 = 0.05;
/// Largest energy that neglected polynomials take from slow motions, relative to the energy that a step radiates at
/// once. It is far below the passivity margin.
const DROPPED_ENERGY: f64 = 1e-4;

impl LateWeights for PatchKernel {
    /// Number of lags until the Rayleigh wave has crossed the patch three times.
    fn window(&self) -> usize {
        let InfluenceKernel { branches, step, .. } = &self.kernel;
        let lags = (CROSSINGS * branches.arrival * self.classes().span() / step).ceil();
        // Float to integer casts saturate.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let lags = lags as usize;
        lags
    }

    fn exponentials(
        &self,
        window: usize,
        horizon: usize,
        tolerance: f64,
    ) -> Result<ExponentialSum> {
        tail(&self.kernel, self.classes(), [window as f64, horizon as f64], tolerance)
    }
}

/// Sum of exponentials for lags from `window` + 1 to `horizon`.
fn tail(
    kernel: &InfluenceKernel,
    classes: &PairClasses,
    [window, horizon]: [f64; 2],
    tolerance: f64,
) -> Result<ExponentialSum> {
    // The error of the trapezoidal rule is about e^(3−π²/h); this includes the narrowing of the analytic strip by the
    // Rayleigh wave.
    let h = std::f64::consts::PI.powi(2) / (3.0 - tolerance.ln());
    let InfluenceKernel { late: terms, step, .. } = kernel;
    let unit = kernel.unit();
    let half = 0.5 * classes.span();
    let begin = window * step;
    let fastest = (1.5 * (5.0 - tolerance.ln()) / begin).ln();
    let slowest = (DROPPED * tolerance / (horizon * step)).ln();
    let count = ((fastest - slowest) / h).ceil();
    // The count is infinite where the horizon exceeds the largest number.
    require(
        "number of exponentials",
        count,
        count < MOST,
        "below 10000: the time step is too long",
    )?;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred")]
    let count = count as usize;
    let differences = differences();
    let mut poles: Vec<Pole> = (0..count)
        .map(|k| {
            let s = (fastest - k as f64 * h).exp();
            let weight = -unit * h * (-s * step).exp_m1() * (-s * begin).exp();
            let mut pole = Pole::new(terms, &differences, s, s * half, weight);
            // Largest contribution of this pole to the coefficient at its own time.
            let share = if s * begin > 1.0 { s * begin * (1.0 - s * begin).exp() } else { 1.0 };
            let energy = h * (-s * begin).exp() / (s * step);
            pole.cut(terms, DROPPED * tolerance / share, DROPPED_ENERGY / energy);
            pole
        })
        .collect();
    // A pole has all the degrees of slower poles, so that each degree has the first few poles.
    for k in (1..poles.len()).rev() {
        poles[k - 1].degrees = poles[k - 1].degrees.max(poles[k].degrees);
    }
    let degrees = poles.first().map_or(1, |pole| pole.degrees);
    let having = |degree| poles.iter().take_while(|pole| pole.degrees > degree).count();
    let mut products = Vec::new();
    for i in 0..degrees {
        for j in (i..degrees).step_by(2) {
            let [normal, tangential] = [0, 1].map(|part| {
                let of = |pole: &Pole| pole.weight * pole.table[part][i * DEGREES + j];
                poles[..having(j)].iter().map(of).collect()
            });
            products.push(TailProduct { functions: [i, j], normal, tangential });
        }
    }
    let rates = poles.iter().map(|pole| pole.s * step).collect();
    ExponentialSum::new(rates, means(classes.elements(), degrees), products)
}

/// A rate, and the Legendre coefficients of Φ for it.
struct Pole {
    s: f64,
    weight: f64,
    degrees: usize,
    /// `β_ij` of zz and xx, `DEGREES` × `DEGREES`.
    table: [Vec<f64>; 2],
}

impl Pole {
    /// Makes a pole; `reach` is s times half the length of the patch.
    fn new(
        terms: &[[f64; LATE_SERIES_TERMS]; 2],
        differences: &[f64],
        s: f64,
        reach: f64,
        weight: f64,
    ) -> Self {
        let table = [0, 1].map(|part| {
            let mut table = vec![0.0; DEGREES * DEGREES];
            let mut power = 1.0;
            for (k, differences) in differences.chunks_exact(DEGREES * DEGREES).enumerate() {
                let factor = terms[part][k] * power;
                table.iter_mut().zip(differences).for_each(|(sum, value)| *sum += factor * value);
                let next = (2 * k + 2) as f64;
                power *= reach * reach / (next * (next - 1.0));
            }
            // Higher degrees at slow poles are rounding.
            let noise = 1e-15 * table[0].abs();
            for (place, value) in table.iter_mut().enumerate() {
                let i = place / DEGREES;
                let j = place % DEGREES;
                if value.abs() < noise * ((2 * i + 1) * (2 * j + 1)) as f64 {
                    *value = 0.0;
                }
            }
            table
        });
        Self { s, weight, degrees: DEGREES, table }
    }

    /// Keeps the fewest degrees for which the rest, relative to t⁻¹ alone, is within both limits.
    fn cut(&mut self, terms: &[[f64; LATE_SERIES_TERMS]; 2], accuracy: f64, energy: f64) {
        let limit = accuracy.min(energy);
        let mut rest = [0.0; 2];
        while self.degrees > 1 {
            let last = self.degrees - 1;
            for ((rest, table), terms) in rest.iter_mut().zip(&self.table).zip(terms) {
                let at = |i: usize, j: usize| table[i * DEGREES + j].abs();
                let added: f64 = (0..last).map(|i| at(i, last) + at(last, i)).sum();
                *rest += (added + at(last, last)) / terms[0].abs();
            }
            if rest[0].max(rest[1]) > limit {
                return;
            }
            self.degrees = last;
        }
    }
}

/// Overwrites `values` with the Legendre polynomials of degree 0, 1, … at `x`.
fn legendre(x: f64, values: &mut [f64]) {
    for degree in 0..values.len() {
        values[degree] = match degree {
            0 => 1.0,
            1 => x,
            _ => gauss::next_legendre(degree, x, [values[degree - 2], values[degree - 1]]),
        };
    }
}

/// Means over the elements of the Legendre polynomials of degree 0, 1, … below `degrees`, on [−1, 1] stretched over the
/// patch.
fn means(elements: &[ContactElement], degrees: usize) -> Vec<Vec<f64>> {
    let first = elements[0].left();
    let last = elements[elements.len() - 1].right();
    let half = 0.5 * (last - first);
    let middle = 0.5 * (first + last);
    let mut means = vec![vec![0.0; elements.len()]; degrees];
    let mut values = vec![0.0; degrees];
    // A Gauss rule over each element is exact, and does not cancel on short ones.
    let rule = gauss::largest();
    for (e, element) in elements.iter().enumerate() {
        for (node, weight) in rule.points() {
            let x = element.center()[0] - middle + 0.5 * element.length() * node;
            legendre(x / half, &mut values);
            for (mean, value) in means.iter_mut().zip(&values) {
                mean[e] += 0.5 * weight * value;
            }
        }
    }
    means
}

/// Legendre coefficients of (x−y)^(2k) in x and y, `DEGREES` × `DEGREES` for each k.
///
/// All binomial terms that contribute to a coefficient have one sign, so no digits are lost.
fn differences() -> Vec<f64> {
    let powers = monomials(2 * LATE_SERIES_TERMS - 1);
    let mut tables = vec![0.0; LATE_SERIES_TERMS * DEGREES * DEGREES];
    for (k, table) in tables.chunks_exact_mut(DEGREES * DEGREES).enumerate() {
        let mut binomial = 1.0;
        for m in 0..=2 * k {
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            for (i, row) in table.chunks_exact_mut(DEGREES).enumerate() {
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
fn monomials(count: usize) -> Vec<Vec<f64>> {
    let mut powers = vec![vec![0.0; DEGREES.max(count + 1)]; count];
    powers[0][0] = 1.0;
    for m in 1..count {
        for i in 0..m {
            let share = powers[m - 1][i] / (2 * i + 1) as f64;
            powers[m][i + 1] += (i + 1) as f64 * share;
            if i > 0 {
                powers[m][i - 1] += i as f64 * share;
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
        let tables = differences();
        for (k, table) in tables.chunks_exact(DEGREES * DEGREES).enumerate().take(DEGREES / 2) {
            for (x, y) in [(0.3_f64, -0.8), (-0.95, 0.9), (0.5, 0.5), (1.0, -1.0)] {
                let [mut in_x, mut in_y] = [[0.0; DEGREES]; 2];
                legendre(x, &mut in_x);
                legendre(y, &mut in_y);
                let sum: f64 = (0..DEGREES * DEGREES)
                    .map(|place| table[place] * in_x[place / DEGREES] * in_y[place % DEGREES])
                    .sum();
                let exact = (0..k).fold(1.0_f64, |power, _| power * (x - y) * (x - y));
                let largest = (2.0 * k as f64).exp2();
                assert!((sum - exact).abs() < 1e-13 * largest, "{k} {x} {y}");
            }
        }
    }
}
