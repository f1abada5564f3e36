//! Late lags as decaying exponentials in time and a few functions over the patch in space.
//!
//! Their state represents all tractions from before the window.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use crate::error::{Result, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactElement, ContactLayout};
use crate::history::exponential_sum::{ExponentialSum, TailProduct};
use crate::linalg::{Dot, Simd, SimdSlice, SimdSliceMut, WithSimd, dot, vectorized};

/// Measured errors of exponentials.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct MeasuredErrors {
    /// Largest error of any coefficient, relative to the largest coefficient of the same lag.
    pub(super) largest_relative: f64,
    /// Σ over lags of the largest change of an error from lag to lag, m/Pa.
    pub(super) increment_sum: f64,
    /// Largest coefficient at the end of the horizon, m/Pa.
    pub(super) last_coefficient: f64,
}

/// Exponentials of the late lags, and the state that represents all tractions before the window.
#[derive(Debug, Clone)]
pub(super) struct Tail {
    /// Lengths of the elements, m.
    lengths: Vec<f64>,
    exponentials: ExponentialSum,
    /// e^(−rate), pole by pole.
    decay_factors: Vec<f64>,
    /// States of normal and tangential components, for each function and its poles.
    ///
    /// A state is Σ decay^age · moment, over all tractions before the window.
    states: [Vec<Vec<f64>>; COMPONENTS_IN_PLANE],
    /// Scratch: moment ∫ τ φ of one traction with each function, N/m.
    moments: Vec<f64>,
    /// Scratch: amplitude of each function in the displacement, m.
    amplitudes: Vec<f64>,
}

impl Tail {
    /// Creates a tail without inputs.
    pub(super) fn new(exponentials: ExponentialSum, elements: &[ContactElement]) -> Result<Self> {
        for means in &exponentials.functions {
            same_length("means of a function", means.len(), elements.len())?;
        }
        let function_count = exponentials.functions.len();
        let mut pole_counts = vec![0; function_count];
        for product in &exponentials.products {
            for function in product.functions {
                pole_counts[function] = pole_counts[function].max(product.normal.len());
            }
        }
        Ok(Self {
            lengths: elements.iter().map(ContactElement::length).collect(),
            decay_factors: exponentials.rates.iter().map(|rate| (-rate).exp()).collect(),
            states: [(); COMPONENTS_IN_PLANE]
                .map(|()| pole_counts.iter().map(|&pole_count| vec![0.0; pole_count]).collect()),
            moments: vec![0.0; function_count],
            amplitudes: vec![0.0; function_count],
            exponentials,
        })
    }

    /// Number of poles.
    pub(super) fn pole_count(&self) -> usize {
        self.decay_factors.len()
    }

    /// Number of functions over the patch.
    pub(super) fn function_count(&self) -> usize {
        self.moments.len()
    }

    /// Number of values in the state.
    pub(super) fn state_length(&self) -> usize {
        self.states.iter().flatten().map(Vec::len).sum()
    }

    /// Bytes of memory used.
    pub(super) fn memory(&self) -> usize {
        let weight_count: usize =
            self.exponentials.products.iter().map(|p| 2 * p.normal.len()).sum();
        let mean_count = self.function_count() * self.lengths.len();
        (weight_count + self.state_length() + mean_count + 2 * self.pole_count()) * size_of::<f64>()
    }

    /// Values of the state, to be saved.
    pub(super) fn state(&self) -> impl Iterator<Item = f64> {
        self.states.iter().flatten().flatten().copied()
    }

    /// Restores the state, of length [`Tail::state_length`].
    pub(super) fn set_state(&mut self, state: &[f64]) {
        for (value, saved) in self.states.iter_mut().flatten().flatten().zip(state) {
            *value = *saved;
        }
    }

    /// Advances by a step: the state decays, and a traction is added.
    ///
    /// `leaving_traction` (2Q numbers): traction that the window does not include from this step on.
    pub(super) fn advance(&mut self, leaving_traction: Option<&[f64]>) {
        let layout = ContactLayout::new(COMPONENTS_IN_PLANE, self.lengths.len());
        for (component, states) in self.states.iter_mut().enumerate() {
            self.moments.fill(0.0);
            if let Some(contact_vector) = leaving_traction {
                let tractions = layout.split::<_, COMPONENTS_IN_PLANE>(contact_vector)[component];
                for (moment, means) in self.moments.iter_mut().zip(&self.exponentials.functions) {
                    for ((traction, length), mean) in tractions.iter().zip(&self.lengths).zip(means)
                    {
                        *moment += traction * length * mean;
                    }
                }
            }
            vectorized(AdvanceStates {
                states,
                decay: &self.decay_factors,
                moments: &self.moments,
            });
        }
    }

    /// Adds the displacement at the end of the next step.
    pub(super) fn add_displacement(&mut self, displacement: &mut [f64]) {
        let component_slices: [_; COMPONENTS_IN_PLANE] =
            ContactLayout::new(COMPONENTS_IN_PLANE, self.lengths.len()).split_mut(displacement);
        for (component, (states, displacement)) in
            self.states.iter().zip(component_slices).enumerate()
        {
            let amplitudes = self.amplitudes.as_mut_slice();
            vectorized(TailAmplitudes {
                states,
                products: &self.exponentials.products,
                component,
                amplitudes,
            });
            for (amplitude, means) in self.amplitudes.iter().zip(&self.exponentials.functions) {
                for (displacement, mean) in displacement.iter_mut().zip(means) {
                    *displacement += amplitude * mean;
                }
            }
        }
    }

    /// Σ weights · `factor` over the poles, for each pair of functions (functions × functions).
    ///
    /// First of the normal components, then of the tangential components.
    fn pole_sums(&self, factor: impl Fn(usize) -> f64) -> [Vec<f64>; COMPONENTS_IN_PLANE] {
        let function_count = self.function_count();
        let factors: Vec<f64> = (0..self.pole_count()).map(factor).collect();
        let mut sums =
            [(); COMPONENTS_IN_PLANE].map(|()| vec![0.0; function_count * function_count]);
        for product in &self.exponentials.products {
            let [i, j] = product.functions;
            for (component, sum) in sums.iter_mut().enumerate() {
                let weights = component_weights(product, component);
                let value = dot(weights, &factors[..weights.len()]);
                sum[i * function_count + j] += value;
                if i != j {
                    sum[j * function_count + i] += value;
                }
            }
        }
        sums
    }

    /// Sums over the poles at the `age`-th lag of the tail, from 0.
    pub(super) fn pole_sums_at_age(&self, age: f64) -> [Vec<f64>; COMPONENTS_IN_PLANE] {
        self.pole_sums(|pole| (-self.exponentials.rates[pole] * age).exp())
    }

    /// Sums over the poles at a frequency `omega`, radians per step.
    ///
    /// The factor of a pole is Re Σ (1−ζ) ζ^W zⁿ ζⁿ over all ages n, with ζ = e^(iω) and the decay z.
    pub(super) fn pole_sums_at_frequency(
        &self,
        window: f64,
        omega: f64,
    ) -> [Vec<f64>; COMPONENTS_IN_PLANE] {
        let half_angle = 0.5 * omega;
        let sine = omega.sin();
        let one_minus_cosine = 2.0 * half_angle.sin() * half_angle.sin();
        let rotation_re = (window * omega).cos();
        let rotation_im = (window * omega).sin();
        self.pole_sums(|pole| {
            // (1−ζ)/(1−zζ), 1−ζ = one_minus_cosine − i sine, 1−zζ = (1−z) + z(1−ζ), z = decay.
            let one_minus_decay = -(-self.exponentials.rates[pole]).exp_m1();
            let decay = self.decay_factors[pole];
            let denominator_re = one_minus_decay + decay * one_minus_cosine;
            let denominator_im = -decay * sine;
            let squared_modulus = denominator_re * denominator_re + denominator_im * denominator_im;
            let quotient_re =
                (one_minus_cosine * denominator_re - sine * denominator_im) / squared_modulus;
            let quotient_im =
                (-sine * denominator_re - one_minus_cosine * denominator_im) / squared_modulus;
            quotient_re * rotation_re - quotient_im * rotation_im
        })
    }

    /// Coefficient of a pair, integrated over the receiver, m²/Pa.
    ///
    /// `pole_sums`: of one component, from [`Tail::pole_sums_at_age`] or [`Tail::pole_sums_at_frequency`].
    pub(super) fn pair_integral(&self, pole_sums: &[f64], receiver: usize, source: usize) -> f64 {
        let area = self.lengths[receiver] * self.lengths[source];
        let functions = &self.exponentials.functions;
        let mean_coefficient: f64 = functions
            .iter()
            .zip(pole_sums.chunks_exact(functions.len().max(1)))
            .map(|(function_means, row)| {
                let terms = row
                    .iter()
                    .zip(functions)
                    .map(|(weight, function_means)| weight * function_means[source]);
                function_means[receiver] * terms.sum::<f64>()
            })
            .sum();
        area * mean_coefficient
    }
}

/// Advances the states by a step: they decay, and moments are added.
struct AdvanceStates<'a> {
    states: &'a mut [Vec<f64>],
    decay: &'a [f64],
    moments: &'a [f64],
}

impl WithSimd for AdvanceStates<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for (state, moment) in self.states.iter_mut().zip(self.moments) {
            let splat_moment = simd.splat_f64s(*moment);
            let decay = SimdSlice::<S>::new(&self.decay[..state.len()]);
            let state = SimdSliceMut::<S>::new(state);
            for (state, decay) in state.vectors.iter_mut().zip(decay.vectors) {
                *state = simd.mul_add_e_f64s(*state, *decay, splat_moment);
            }
            for (state, decay) in state.tail.iter_mut().zip(decay.tail) {
                *state = *state * decay + moment;
            }
        }
    }
}

/// Amplitudes of the functions at the end of the next step.
struct TailAmplitudes<'a> {
    states: &'a [Vec<f64>],
    products: &'a [TailProduct],
    component: usize,
    amplitudes: &'a mut [f64],
}

impl WithSimd for TailAmplitudes<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { states, products, component, amplitudes } = self;
        amplitudes.fill(0.0);
        for product in products {
            let x = component_weights(product, component);
            let [i, j] = product.functions;
            amplitudes[i] += Dot { weights: None, x, y: &states[j] }.with_simd(simd);
            if i != j {
                amplitudes[j] += Dot { weights: None, x, y: &states[i] }.with_simd(simd);
            }
        }
    }
}

/// Weights of the normal (0) or tangential (1) components.
fn component_weights(product: &TailProduct, component: usize) -> &[f64] {
    if component == 0 { &product.normal } else { &product.tangential }
}
