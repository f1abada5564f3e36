//! What the inputs of a leaf give to its next output: one product per wavenumber, input and pair of components.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::level::WaveNumbers;
use super::wave_level::kinds;
use crate::linalg::{Simd, WithSimd};

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
        let place = inputs.len() / sum.len();
        for (m, input) in inputs.chunks_exact(sum.len()).enumerate() {
            let d = place - m;
            for (run, first) in waves.runs().into_iter().filter(|(run, _)| !run.is_empty()) {
                let of = |kind: usize| &near[kind][d * waves.own + first..][..run.len()];
                // Real parts, then imaginary ones.
                for part in 0..2 {
                    let from = |n: usize| (2 * n + part) * waves.all + run.start;
                    if d <= reach {
                        let coefficients = kinds::<N>().map(|row| row.map(of));
                        let input = std::array::from_fn(|n| &input[from(n)..][..run.len()]);
                        add_coupled(sum, from, coefficients, input);
                    } else {
                        for n in 0..N {
                            let sum = &mut sum[from(n)..][..run.len()];
                            let input = &input[from(n)..][..run.len()];
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

/// sum ← sum + ĝ · input, for what begins at `from` each component.
#[inline(always)]
fn add_coupled<const N: usize>(
    sum: &mut [f64],
    from: impl Fn(usize) -> usize,
    coefficients: [[&[f64]; N]; N],
    input: [&[f64]; N],
) {
    let count = input[0].len();
    let (input, coefficients) =
        (input.map(|it| &it[..count]), coefficients.map(|row| row.map(|it| &it[..count])));
    for (n, row) in coefficients.into_iter().enumerate() {
        let sum = &mut sum[from(n)..][..count];
        for k in 0..count {
            let first = row[0][k] * input[0][k];
            sum[k] += (1..N).fold(first, |sum, m| sum + row[m][k] * input[m][k]);
        }
    }
}
