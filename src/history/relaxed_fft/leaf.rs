//! Next output of a leaf from its inputs: one product for each wavenumber, input and pair of components.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::wave_level::kinds;
use super::wave_numbers::WaveNumbers;
use crate::geometry::SPACE;
use crate::history::pair_classes::KINDS;
use crate::linalg::{Simd, WithSimd};

/// Number of wavenumbers multiplied together.
const LANES: usize = 4;

/// Sum over the inputs of a strip's leaf so far, for its next output.
pub(super) struct StripLeaf<'a> {
    pub(super) sum: &'a mut [f64],
    pub(super) inputs: &'a [f64],
    pub(super) near: [&'a [f64]; KINDS],
    pub(super) waves: usize,
    pub(super) reach: usize,
}

impl WithSimd for StripLeaf<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sum, inputs, near, waves, reach } = self;
        let place = inputs.len() / sum.len();
        for (m, input) in inputs.chunks_exact(sum.len()).enumerate() {
            let d = place - m;
            let [normal, tangential, coupling] =
                near.map(|values| &values[d * waves..(d + 1) * waves]);
            if d <= reach {
                add_coupled(sum, input, [normal, tangential, coupling]);
            } else {
                add(sum, input, [normal, tangential]);
            }
        }
    }
}

/// sum ← sum + ĝ · input.
#[inline(always)]
fn add(sum: &mut [f64], input: &[f64], coefficients: [&[f64]; 2]) {
    let waves = coefficients[0].len();
    let parts = sum.chunks_exact_mut(waves).zip(input.chunks_exact(waves));
    for (number, (sum, input)) in parts.enumerate() {
        for ((sum, input), g) in sum.iter_mut().zip(input).zip(coefficients[number / 2]) {
            *sum += g * input;
        }
    }
}

/// Adds products of all three kinds; the coupling is i times a real number, with opposite signs for the two components.
#[inline(always)]
fn add_coupled(sum: &mut [f64], input: &[f64], coefficients: [&[f64]; 3]) {
    let waves = coefficients[0].len();
    let [normal, tangential, coupling] = coefficients.map(|values| &values[..waves]);
    let (down, along) = sum.split_at_mut(2 * waves);
    let ((down_re, down_im), (along_re, along_im)) =
        (down.split_at_mut(waves), along.split_at_mut(waves));
    let (along_re, along_im) = (&mut along_re[..waves], &mut along_im[..waves]);
    let part = |k: usize| &input[k * waves..(k + 1) * waves];
    let [p_re, p_im, s_re, s_im] = [part(0), part(1), part(2), part(3)];
    for k in 0..waves {
        let (g, h, c) = (normal[k], tangential[k], coupling[k]);
        down_re[k] += g * p_re[k] - c * s_im[k];
        down_im[k] += g * p_im[k] + c * s_re[k];
        along_re[k] += h * s_re[k] + c * p_im[k];
        along_im[k] += h * s_im[k] - c * p_re[k];
    }
}

/// Sum over the inputs of a leaf of cells in plan, for its next output.
pub(super) struct PlanLeaf<'a> {
    pub(super) sum: &'a mut [f64],
    pub(super) inputs: &'a [f64],
    pub(super) near: &'a [Vec<f64>],
    pub(super) waves: WaveNumbers,
}

impl WithSimd for PlanLeaf<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sum, inputs, near, waves } = self;
        let size = sum.len();
        let place = inputs.len() / size;
        let mut parts = sum.chunks_exact_mut(waves.all);
        let mut sums: [[&mut [f64]; 2]; SPACE] =
            std::array::from_fn(|_| std::array::from_fn(|_| parts.next().unwrap_or_default()));
        for (m, input) in inputs.chunks_exact(size).enumerate() {
            let d = place - m;
            let mut parts = input.chunks_exact(waves.all);
            let inputs: [[&[f64]; 2]; SPACE] =
                std::array::from_fn(|_| std::array::from_fn(|_| parts.next().unwrap_or_default()));
            for (run, first) in waves.runs() {
                let of = |kind: usize| &near[kind][d * waves.own + first..][..run.len()];
                let mut sums =
                    sums.each_mut().map(|parts| parts.each_mut().map(|sum| &mut sum[run.clone()]));
                let inputs = inputs.map(|parts| parts.map(|input| &input[run.clone()]));
                let coefficients = kinds::<SPACE>().map(|row| row.map(of));
                let whole = run.len() - run.len() % LANES;
                for k in (0..whole).step_by(LANES) {
                    add_all::<LANES>(k, &mut sums, &inputs, &coefficients);
                }
                for k in whole..run.len() {
                    add_all::<1>(k, &mut sums, &inputs, &coefficients);
                }
            }
        }
    }
}

/// sum ← sum + ĝ · input for L wavenumbers from the `k`-th on, real and imaginary parts of each component.
///
/// The coupling of pressure and shear is a real number times i, in the other direction times −i.
#[inline(always)]
fn add_all<const L: usize>(
    k: usize,
    sums: &mut [[&mut [f64]; 2]; SPACE],
    inputs: &[[&[f64]; 2]; SPACE],
    coefficients: &[[&[f64]; SPACE]; SPACE],
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
    for m in 1..SPACE {
        let g = load(coefficients[0][m]);
        down = [minus(down[0], times(g, inputs[m][1])), plus(down[1], times(g, inputs[m][0]))];
    }
    down.into_iter().enumerate().for_each(|(part, values)| add(0, part, values));
    for n in 1..SPACE {
        let first = load(coefficients[n][1]);
        let mut along = inputs[1].map(|input| times(first, input));
        for m in 2..SPACE {
            let g = load(coefficients[n][m]);
            along = [0, 1].map(|part| plus(along[part], times(g, inputs[m][part])));
        }
        let g = load(coefficients[n][0]);
        add(n, 0, plus(along[0], times(g, inputs[0][1])));
        add(n, 1, minus(along[1], times(g, inputs[0][0])));
    }
}
