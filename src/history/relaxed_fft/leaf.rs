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
                // Real parts, then imaginary ones; pressure and shear couple by i times real numbers.
                for (part, sign) in [-1.0, 1.0].into_iter().enumerate() {
                    let from = |n: usize, part: usize| (2 * n + part) * waves.all + run.start;
                    if d <= reach {
                        let coefficients = kinds::<N>().map(|row| row.map(of));
                        let [own, other] = [part, 1 - part].map(|part| {
                            std::array::from_fn(|n| &input[from(n, part)..][..run.len()])
                        });
                        let from = |n: usize| from(n, part);
                        add_coupled(sum, from, coefficients, [own, other], sign);
                    } else {
                        for n in 0..N {
                            let sum = &mut sum[from(n, part)..][..run.len()];
                            let input = &input[from(n, part)..][..run.len()];
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

/// sum ← sum + ĝ · input, for what begins at `from` each component: the same part of the input, and the other one with
/// a `sign` where pressure is due to shear.
#[inline(always)]
fn add_coupled<const N: usize>(
    sum: &mut [f64],
    from: impl Fn(usize) -> usize,
    coefficients: [[&[f64]; N]; N],
    input: [[&[f64]; N]; 2],
    sign: f64,
) {
    let count = input[0][0].len();
    let [own, other] = input.map(|parts| parts.map(|it| &it[..count]));
    for (n, row) in coefficients.map(|row| row.map(|it| &it[..count])).into_iter().enumerate() {
        let sum = &mut sum[from(n)..][..count];
        for k in 0..count {
            sum[k] += if n == 0 {
                let first = row[0][k] * own[0][k];
                (1..N).fold(first, |sum, m| sum + sign * row[m][k] * other[m][k])
            } else {
                let first = row[1][k] * own[1][k];
                let shear = (2..N).fold(first, |sum, m| sum + row[m][k] * own[m][k]);
                shear - sign * row[0][k] * other[0][k]
            };
        }
    }
}
