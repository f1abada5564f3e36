//! What the inputs of a leaf give to its next output: one product per wavenumber, input and pair of components.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::level::WaveNumbers;
use super::wave_level::kinds;
use crate::linalg::{Simd, WithSimd};

/// Wavenumbers that are multiplied together.
const LANES: usize = 4;

/// Sum over the inputs of a leaf so far, for its next output; N components.
pub(super) struct Leaf<'a, const N: usize> {
    pub(super) sum: &'a mut [f64],
    pub(super) inputs: &'a [f64],
    pub(super) near: &'a [Vec<f64>],
    pub(super) waves: WaveNumbers,
    pub(super) reach: usize,
}

impl<const N: usize> WithSimd for Leaf<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sum, inputs, near, waves, reach } = self;
        let size = sum.len();
        let place = inputs.len() / size;
        let mut parts = sum.chunks_exact_mut(waves.all);
        let mut sums: [[&mut [f64]; 2]; N] =
            std::array::from_fn(|_| std::array::from_fn(|_| parts.next().unwrap_or_default()));
        for (m, input) in inputs.chunks_exact(size).enumerate() {
            let d = place - m;
            let mut parts = input.chunks_exact(waves.all);
            let inputs: [[&[f64]; 2]; N] =
                std::array::from_fn(|_| std::array::from_fn(|_| parts.next().unwrap_or_default()));
            for (run, first) in waves.runs() {
                if run.is_empty() {
                    continue;
                }
                let of = |kind: usize| &near[kind][d * waves.own + first..][..run.len()];
                let mut sums =
                    sums.each_mut().map(|parts| parts.each_mut().map(|sum| &mut sum[run.clone()]));
                let inputs = inputs.map(|parts| parts.map(|input| &input[run.clone()]));
                if d <= reach {
                    let coefficients = kinds::<N>().map(|row| row.map(of));
                    let whole = run.len() - run.len() % LANES;
                    for k in (0..whole).step_by(LANES) {
                        add_coupled::<N, LANES>(k, &mut sums, &inputs, &coefficients);
                    }
                    for k in whole..run.len() {
                        add_coupled::<N, 1>(k, &mut sums, &inputs, &coefficients);
                    }
                } else {
                    for (n, (sums, inputs)) in sums.into_iter().zip(inputs).enumerate() {
                        for (sum, input) in sums.into_iter().zip(inputs) {
                            for ((sum, input), g) in sum.iter_mut().zip(input).zip(of(n)) {
                                *sum += g * input;
                            }
                        }
                    }
                }
            }
        }
    }
}

/// sum ← sum + ĝ · input for L wavenumbers from the `k`-th on, real and imaginary parts of each component. Pressure and
/// shear couple by i times real numbers, and by −i.
#[inline(always)]
fn add_coupled<const N: usize, const L: usize>(
    k: usize,
    sums: &mut [[&mut [f64]; 2]; N],
    inputs: &[[&[f64]; 2]; N],
    coefficients: &[[&[f64]; N]; N],
) {
    let load = |values: &[f64]| -> [f64; L] {
        let values = &values[k..k + L];
        std::array::from_fn(|lane| values[lane])
    };
    let inputs = inputs.map(|parts| parts.map(load));
    let mut add = |n: usize, part: usize, values: [f64; L]| {
        for (sum, value) in sums[n][part][k..k + L].iter_mut().zip(values) {
            *sum += value;
        }
    };
    let times = |a: [f64; L], b: [f64; L]| -> [f64; L] { std::array::from_fn(|i| a[i] * b[i]) };
    let plus = |a: [f64; L], b: [f64; L]| -> [f64; L] { std::array::from_fn(|i| a[i] + b[i]) };
    let minus = |a: [f64; L], b: [f64; L]| -> [f64; L] { std::array::from_fn(|i| a[i] - b[i]) };
    let own = load(coefficients[0][0]);
    let mut down = inputs[0].map(|input| times(own, input));
    for m in 1..N {
        let g = load(coefficients[0][m]);
        down = [minus(down[0], times(g, inputs[m][1])), plus(down[1], times(g, inputs[m][0]))];
    }
    down.into_iter().enumerate().for_each(|(part, values)| add(0, part, values));
    for n in 1..N {
        let first = load(coefficients[n][1]);
        let mut along = inputs[1].map(|input| times(first, input));
        for m in 2..N {
            let g = load(coefficients[n][m]);
            along = [0, 1].map(|part| plus(along[part], times(g, inputs[m][part])));
        }
        let g = load(coefficients[n][0]);
        add(n, 0, plus(along[0], times(g, inputs[0][1])));
        add(n, 1, minus(along[1], times(g, inputs[0][0])));
    }
}
