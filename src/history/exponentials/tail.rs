//! What acts longer ago than the window, as a sum of decaying exponentials.
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
//! | W | steps of the window: the tail begins at lag W + 1 |
//! | `β_ij` | Legendre coefficients of Φ(s(ξ−η)) over the patch |

use super::basis::{Basis, legendre};
use crate::bem::LateSeries;
use crate::fundamental::gauss;
use crate::fundamental::laurent::TERMS;
use crate::linalg::dot;

/// Polynomials that a pole may have.
pub(super) const DEGREES: usize = 24;
/// Share of the tolerance for polynomials left out.
const DROPPED: f64 = 0.05;
/// What polynomials left out may take from the energy of slow motions, over that which a step
/// radiates at once: far below what passivity has to spare.
const DROPPED_ENERGY: f64 = 1e-4;

/// What one polynomial of the traction gives to another of the displacement, pole by pole.
#[derive(Debug, Clone)]
struct Product {
    /// Degrees, the lower one first.
    degrees: [usize; 2],
    /// `β_ij` h (1−z) e^(−sWδ)/(πμ) of zz and xx.
    weights: [Vec<f64>; 2],
}

/// Common poles, their weights, and the state that they carry.
#[derive(Debug, Clone)]
pub(super) struct Tail {
    basis: Basis,
    /// z, the fastest pole first.
    decay: Vec<f64>,
    /// sδ.
    rates: Vec<f64>,
    products: Vec<Product>,
    /// Of zz and xx, per degree: Σ z^(age) moment, for the poles that have this degree.
    states: [Vec<Vec<f64>>; 2],
    moments: Vec<f64>,
    amplitudes: Vec<f64>,
}

impl Tail {
    /// Poles with the step `h` in ln s, for lags from `window` + 1 to `horizon`.
    pub(super) fn new(
        series: &LateSeries<'_>,
        mut basis: Basis,
        [window, horizon]: [f64; 2],
        h: f64,
        tolerance: f64,
    ) -> Self {
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
                // How much of the coefficient at its own time this pole makes up, at most.
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
                let weights = [0, 1].map(|part| {
                    let of = |pole: &Pole| pole.weight * pole.table[part][i * DEGREES + j];
                    poles[..having(j)].iter().map(of).collect()
                });
                products.push(Product { degrees: [i, j], weights });
            }
        }
        let states = [(); 2].map(|()| (0..degrees).map(|i| vec![0.0; having(i)]).collect());
        Self {
            decay: poles.iter().map(|pole| (-pole.s * step).exp()).collect(),
            rates: poles.iter().map(|pole| pole.s * step).collect(),
            basis,
            products,
            states,
            moments: vec![0.0; degrees],
            amplitudes: vec![0.0; degrees],
        }
    }

    /// Number of poles.
    pub(super) fn poles(&self) -> usize {
        self.decay.len()
    }

    /// Polynomials over the patch.
    pub(super) fn degrees(&self) -> usize {
        self.basis.degrees()
    }

    /// Numbers that are carried from step to step.
    pub(super) fn state_length(&self) -> usize {
        self.states.iter().flatten().map(Vec::len).sum()
    }

    /// Bytes held.
    pub(super) fn memory(&self) -> usize {
        let products: usize = self.products.iter().map(|p| 2 * p.weights[0].len()).sum();
        let basis = self.degrees() * self.basis.lengths.len();
        (products + self.state_length() + basis + 2 * self.poles()) * size_of::<f64>()
    }

    /// The state, to be saved.
    pub(super) fn state(&self) -> impl Iterator<Item = f64> {
        self.states.iter().flatten().flatten().copied()
    }

    /// Takes the state back, of which there must be as much as [`Tail::state_length`].
    pub(super) fn set_state(&mut self, state: &[f64]) {
        for (own, saved) in self.states.iter_mut().flatten().flatten().zip(state) {
            *own = *saved;
        }
    }

    /// One step on: all that is held decays, `leaving` (2Q) leaves the window and comes in.
    pub(super) fn advance(&mut self, leaving: Option<&[f64]>) {
        let count = self.basis.lengths.len();
        for (part, states) in self.states.iter_mut().enumerate() {
            self.moments.fill(0.0);
            if let Some(traction) = leaving {
                let traction = &traction[part * count..(part + 1) * count];
                self.basis.moments(traction, &mut self.moments);
            }
            for (state, moment) in states.iter_mut().zip(&self.moments) {
                for (state, decay) in state.iter_mut().zip(&self.decay) {
                    *state = decay * *state + moment;
                }
            }
        }
    }

    /// Adds what the tail gives at the end of the next step.
    pub(super) fn add(&mut self, displacement: &mut [f64]) {
        let count = self.basis.lengths.len();
        for (part, states) in self.states.iter().enumerate() {
            self.amplitudes.fill(0.0);
            for Product { degrees: [i, j], weights } in &self.products {
                let weights = &weights[part];
                self.amplitudes[*i] += dot(weights, &states[*j][..weights.len()]);
                if i != j {
                    self.amplitudes[*j] += dot(weights, &states[*i][..weights.len()]);
                }
            }
            self.basis.add(&self.amplitudes, &mut displacement[part * count..(part + 1) * count]);
        }
    }

    /// Legendre coefficients (degrees × degrees) of zz and xx with `factor` for each pole.
    fn sum(&self, factor: impl Fn(usize) -> f64) -> [Vec<f64>; 2] {
        let degrees = self.degrees();
        let factors: Vec<f64> = (0..self.poles()).map(factor).collect();
        let mut sums = [(); 2].map(|()| vec![0.0; degrees * degrees]);
        for Product { degrees: [i, j], weights } in &self.products {
            for (sum, weights) in sums.iter_mut().zip(weights) {
                let value = dot(weights, &factors[..weights.len()]);
                sum[i * degrees + j] = value;
                sum[j * degrees + i] = value;
            }
        }
        sums
    }

    /// Legendre coefficients at the `age`-th lag of the tail, from 0.
    pub(super) fn at_age(&self, age: f64) -> [Vec<f64>; 2] {
        self.sum(|pole| (-self.rates[pole] * age).exp())
    }

    /// Legendre coefficients of Re Σ (1−ζ) ζ^W z^n ζ^n, ζ = e^(iω), over all ages n.
    pub(super) fn at_frequency(&self, window: f64, omega: f64) -> [Vec<f64>; 2] {
        let half = 0.5 * omega;
        let (sine, square) = (omega.sin(), 2.0 * half.sin() * half.sin());
        let (turn_re, turn_im) = ((window * omega).cos(), (window * omega).sin());
        self.sum(|pole| {
            // (1−ζ)/(1−zζ), 1−ζ = square − i sine, 1−zζ = (1−z) + z(1−ζ).
            let (lost, z) = (-(-self.rates[pole]).exp_m1(), self.decay[pole]);
            let (re, im) = (lost + z * square, -z * sine);
            let size = re * re + im * im;
            let (real, imaginary) =
                ((square * re - sine * im) / size, (-sine * re - square * im) / size);
            real * turn_re - imaginary * turn_im
        })
    }

    /// Integral over the receiver of the coefficient of a pair, from Legendre coefficients.
    pub(super) fn of_pair(&self, sum: &[f64], receiver: usize, source: usize) -> f64 {
        let area = self.basis.lengths[receiver] * self.basis.lengths[source];
        let mean: f64 = self
            .basis
            .over(receiver)
            .zip(sum.chunks_exact(self.degrees()))
            .map(|(p, row)| {
                p * row.iter().zip(self.basis.over(source)).map(|(b, q)| b * q).sum::<f64>()
            })
            .sum();
        area * mean
    }
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
            // What is left of higher degrees at slow poles is rounding.
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
