//! Late lags of the half-plane as sums of decaying exponentials.
//!
//! Behind the Rayleigh wave the step coefficients are (see [`crate::bem::PairInfluence`])
//!
//! * G = 1/(πμ) · (1/l) ∫∫ Σ `c_k` (ξ−η)^(2k) ∫ t^(−2k−1) dt dξ dη
//! * t^(−2k−1) = 1/(2k)! ∫₀^∞ s^(2k) e^(−st) ds
//! * G = 1/(πμ) ∫₀^∞ (e^(sδ)−1) e^(−s n δ) · (1/l) ∫∫ Φ(s(ξ−η)) dξ dη ds/s,
//!   Φ(y) = Σ `c_k` y^(2k)/(2k)!
//!
//! The integral over u = ln s decays at both ends and is analytic in a strip, so that the
//! trapezoidal rule converges exponentially in the reciprocal of its step (Beylkin & Monzón 2010,
//! Appl. Comput. Harmon. Anal. 28, 131–149); its error is relative at every t and for every k.
//! Φ is entire: a few Legendre polynomials over the patch carry it, the fewer the smaller s.
//!
//! | symbol | meaning |
//! |---|---|
//! | δ | `c_S` Δt, m |
//! | s | rate of a pole, 1/m; z = e^(−sδ) its decay in a step |
//! | h | step of the trapezoidal rule in ln s |
//! | W | lags of the window: the exponentials begin at lag W + 1 |
//! | `β_ij` | Legendre coefficients of Φ(s(ξ−η)) over the patch |

use super::PatchKernel;
use super::influence::LateSeries;
use super::legendre::{Basis, legendre};
use crate::error::Result;
use crate::fundamental::laurent::TERMS;
use crate::gauss;
use crate::history::{ExponentialTail, LagKernel, LateLags, TailProduct};

/// Times that the Rayleigh wave has crossed the patch when exponentials take over. Behind three,
/// the coefficients themselves are summed from the same series.
const CROSSINGS: f64 = 3.0;
/// Polynomials that a pole may have.
const DEGREES: usize = 24;
/// Share of the tolerance for polynomials left out.
const DROPPED: f64 = 0.05;
/// Energy that neglected polynomials may take from slow motions, over that which a step
/// radiates at once: far below what passivity has to spare.
const DROPPED_ENERGY: f64 = 1e-4;

impl LateLags for PatchKernel {
    /// Until the Rayleigh wave has crossed the patch three times.
    fn window(&self) -> usize {
        let series = self.late_series();
        let lags = (CROSSINGS * series.arrival * self.classes().span() / series.step).ceil();
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
    ) -> Result<ExponentialTail> {
        let basis = Basis::new(self.classes().elements(), DEGREES);
        tail(&self.late_series(), basis, [window as f64, horizon as f64], tolerance)
    }
}

/// Poles for lags from `window` + 1 to `horizon`.
fn tail(
    series: &LateSeries<'_>,
    mut basis: Basis,
    [window, horizon]: [f64; 2],
    tolerance: f64,
) -> Result<ExponentialTail> {
    // The error of the trapezoidal rule is about e^(3−π²/h), the strip narrowed by the Rayleigh wave
    // included.
    let h = std::f64::consts::PI.powi(2) / (3.0 - tolerance.ln());
    let LateSeries { terms, step, unit, .. } = *series;
    let begin = window * step;
    let fastest = (1.5 * (5.0 - tolerance.ln()) / begin).ln();
    let slowest = (DROPPED * tolerance / (horizon * step)).ln();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred")]
    let count = ((fastest - slowest) / h).ceil() as usize;
    let mut poles: Vec<Pole> = (0..count)
        .map(|k| {
            let s = (fastest - k as f64 * h).exp();
            let weight = -unit * h * (-s * step).exp_m1() * (-s * begin).exp();
            let mut pole = Pole::new(terms, s, s * basis.half, weight);
            // Largest share of this pole in the coefficient at its own time.
            let share = if s * begin > 1.0 { s * begin * (1.0 - s * begin).exp() } else { 1.0 };
            let energy = h * (-s * begin).exp() / (s * step);
            pole.cut(terms, DROPPED * tolerance / share, DROPPED_ENERGY / energy);
            pole
        })
        .collect();
    // A pole has all the degrees of slower ones, so that each degree has the first few poles.
    for k in (1..poles.len()).rev() {
        poles[k - 1].degrees = poles[k - 1].degrees.max(poles[k].degrees);
    }
    let degrees = poles.first().map_or(1, |pole| pole.degrees);
    basis.truncate(degrees);
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
    ExponentialTail::new(rates, basis.into_means(), products)
}

/// A rate and the Legendre coefficients of Φ that go with it.
struct Pole {
    s: f64,
    weight: f64,
    degrees: usize,
    /// `β_ij` of zz and xx, `DEGREES` × `DEGREES`.
    table: [Vec<f64>; 2],
}

impl Pole {
    /// `reach` is s times half of the patch.
    fn new(terms: &[[f64; TERMS]; 2], s: f64, reach: f64, weight: f64) -> Self {
        let rule = gauss::largest();
        let order = rule.nodes.len();
        let mut values = vec![0.0; order * DEGREES];
        for (node, values) in rule.nodes.iter().zip(values.chunks_exact_mut(DEGREES)) {
            legendre(*node, values);
        }
        let project = |degree: usize, node: usize| {
            (degree as f64 + 0.5) * rule.weights[node] * values[node * DEGREES + degree]
        };
        let table = [0, 1].map(|part| {
            let mut rows = vec![0.0; DEGREES * order];
            for a in 0..order {
                for b in 0..order {
                    let phi = phi(&terms[part], reach * (rule.nodes[a] - rule.nodes[b]));
                    for i in 0..DEGREES {
                        rows[i * order + b] += project(i, a) * phi;
                    }
                }
            }
            let mut table = vec![0.0; DEGREES * DEGREES];
            for i in 0..DEGREES {
                // Φ is even: the degrees of a product are both even or both odd.
                for j in (i % 2..DEGREES).step_by(2) {
                    table[i * DEGREES + j] =
                        (0..order).map(|b| rows[i * order + b] * project(j, b)).sum();
                }
            }
            // Higher degrees at slow poles are rounding.
            let noise = 1e-15 * table[0].abs();
            for (place, value) in table.iter_mut().enumerate() {
                let (i, j) = (place / DEGREES, place % DEGREES);
                if value.abs() < noise * ((2 * i + 1) * (2 * j + 1)) as f64 {
                    *value = 0.0;
                }
            }
            table
        });
        Self { s, weight, degrees: DEGREES, table }
    }

    /// Keeps as few degrees as the rest, over that of t⁻¹ alone, is within both limits.
    fn cut(&mut self, terms: &[[f64; TERMS]; 2], accuracy: f64, energy: f64) {
        let limit = accuracy.min(energy);
        let rest = |degrees: usize| {
            let mut largest = 0.0_f64;
            for (table, terms) in self.table.iter().zip(terms) {
                let mut sum = 0.0;
                for i in 0..DEGREES {
                    for j in 0..DEGREES {
                        if i >= degrees || j >= degrees {
                            sum += table[i * DEGREES + j].abs();
                        }
                    }
                }
                largest = largest.max(sum / terms[0].abs());
            }
            largest
        };
        while self.degrees > 1 && rest(self.degrees - 1) <= limit {
            self.degrees -= 1;
        }
    }
}

/// Φ(y) = Σ `c_k` y^(2k)/(2k)!.
fn phi(terms: &[f64; TERMS], y: f64) -> f64 {
    let (mut power, mut sum) = (1.0, 0.0);
    for (k, term) in terms.iter().enumerate() {
        sum += term * power;
        let next = (2 * k + 2) as f64;
        power *= y * y / (next * (next - 1.0));
    }
    sum
}
