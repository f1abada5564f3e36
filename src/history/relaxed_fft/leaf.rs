//! Next output of a leaf from its inputs: one product for each wavenumber, input and pair of components.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::wave_numbers::WaveNumbers;
use crate::geometry::{COMPONENTS_IN_SPACE, SERIES_PER_OFFSET};
use crate::history::pair_classes::STRIP_KINDS;
use crate::linalg::{Scalar, Simd, SimdSlice, SimdSliceMut, WithSimd};

/// Sum over the inputs of a strip's leaf so far, for its next output.
pub(super) struct StripLeaf<'a> {
    pub(super) sum: &'a mut [f64],
    pub(super) inputs: &'a [f64],
    pub(super) coefficients: [&'a [f64]; STRIP_KINDS],
    pub(super) waves: usize,
    pub(super) reach: usize,
}

impl WithSimd for StripLeaf<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sum, inputs, coefficients, waves, reach } = self;
        let place = inputs.len() / sum.len();
        for (m, input) in inputs.chunks_exact(sum.len()).enumerate() {
            let d = place - m;
            let at_delay = coefficients.map(|values| &values[d * waves..(d + 1) * waves]);
            if d <= reach {
                add_coupled(sum, input, at_delay);
            } else {
                add(sum, input, [at_delay[0], at_delay[1]]);
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

/// Adds products of all three kinds.
///
/// The coupling is i times a real number, with opposite signs for the two components.
#[inline(always)]
fn add_coupled(sum: &mut [f64], input: &[f64], coefficients: [&[f64]; 3]) {
    let waves = coefficients[0].len();
    let [normal, tangential, coupling] = coefficients.map(|values| &values[..waves]);
    let (down, along) = sum.split_at_mut(2 * waves);
    let (down_re, down_im) = down.split_at_mut(waves);
    let (along_re, along_im) = along.split_at_mut(waves);
    let along_im = &mut along_im[..waves];
    let p_re = &input[..waves];
    let p_im = &input[waves..][..waves];
    let s_re = &input[2 * waves..][..waves];
    let s_im = &input[3 * waves..][..waves];
    for k in 0..waves {
        let g = normal[k];
        let h = tangential[k];
        let c = coupling[k];
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
    pub(super) coefficients: &'a [Vec<f64>],
    pub(super) waves: WaveNumbers,
}

/// Number of inputs multiplied in one pass over the sums.
const INPUTS_PER_PASS: usize = 4;
/// Number of real and imaginary parts of three components.
const COMPLEX_PARTS: usize = 2 * COMPONENTS_IN_SPACE;

impl WithSimd for PlanLeaf<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let place = self.inputs.len() / self.sum.len();
        let whole = place - place % INPUTS_PER_PASS;
        for m in (0..whole).step_by(INPUTS_PER_PASS) {
            self.add::<S, INPUTS_PER_PASS>(simd, place, m);
        }
        for m in whole..place {
            self.add::<S, 1>(simd, place, m);
        }
    }
}

impl PlanLeaf<'_> {
    /// Adds the products of M inputs from the `m`-th on to the output at `place`.
    #[inline(always)]
    fn add<S: Simd, const M: usize>(&mut self, simd: S, place: usize, m: usize) {
        let Self { sum, inputs, coefficients, waves } = self;
        let size = sum.len();
        for (range, first_spectrum) in waves.ranges() {
            let length = range.len();
            let mut parts = sum.chunks_exact_mut(waves.count);
            let sums: [_; COMPLEX_PARTS] = std::array::from_fn(|_| {
                SimdSliceMut::<S>::new(&mut parts.next().unwrap_or_default()[range.clone()])
            });
            let inputs: [[_; COMPLEX_PARTS]; M] = std::array::from_fn(|n| {
                std::array::from_fn(|part| {
                    let begin = (m + n) * size + part * waves.count + range.start;
                    SimdSlice::<S>::new(&inputs[begin..begin + length])
                })
            });
            let coefficients: [[_; SERIES_PER_OFFSET]; M] = std::array::from_fn(|n| {
                std::array::from_fn(|kind| {
                    let begin = (place - m - n) * waves.with_spectra + first_spectrum;
                    SimdSlice::<S>::new(&coefficients[kind][begin..begin + length])
                })
            });
            for k in 0..sums[0].vectors.len() {
                let mut total = [sums[0].vectors[k]; COMPLEX_PARTS];
                for part in 1..COMPLEX_PARTS {
                    total[part] = sums[part].vectors[k];
                }
                for n in 0..M {
                    let mut x = [total[0]; COMPLEX_PARTS];
                    let mut g = [total[0]; SERIES_PER_OFFSET];
                    for part in 0..COMPLEX_PARTS {
                        x[part] = inputs[n][part].vectors[k];
                    }
                    for kind in 0..SERIES_PER_OFFSET {
                        g[kind] = coefficients[n][kind].vectors[k];
                    }
                    total = times(simd, total, g, x);
                }
                for part in 0..COMPLEX_PARTS {
                    sums[part].vectors[k] = total[part];
                }
            }
            for k in 0..sums[0].tail.len() {
                for n in 0..M {
                    let total = std::array::from_fn(|part| sums[part].tail[k]);
                    let x = std::array::from_fn(|part| inputs[n][part].tail[k]);
                    let g = std::array::from_fn(|kind| coefficients[n][kind].tail[k]);
                    let total = times(Scalar::new(), total, g, x);
                    for part in 0..COMPLEX_PARTS {
                        sums[part].tail[k] = total[part];
                    }
                }
            }
        }
    }
}

/// total + ĝ x, for real and imaginary parts of each component.
///
/// The coupling of pressure and shear is a real number times i, in the other direction times −i.
#[inline(always)]
fn times<S: Simd>(
    simd: S,
    total: [S::f64s; COMPLEX_PARTS],
    [zz, xx, yy, xy, zx, zy]: [S::f64s; SERIES_PER_OFFSET],
    [p, q, a, b, c, d]: [S::f64s; COMPLEX_PARTS],
) -> [S::f64s; COMPLEX_PARTS] {
    let down = [
        simd.sub_f64s(
            simd.sub_f64s(simd.mul_f64s(zz, p), simd.mul_f64s(zx, b)),
            simd.mul_f64s(zy, d),
        ),
        simd.add_f64s(
            simd.add_f64s(simd.mul_f64s(zz, q), simd.mul_f64s(zx, a)),
            simd.mul_f64s(zy, c),
        ),
    ];
    let along = shear(simd, [xx, xy, zx], [p, q, a, b, c, d]);
    let away = shear(simd, [xy, yy, zy], [p, q, a, b, c, d]);
    [
        simd.add_f64s(total[0], down[0]),
        simd.add_f64s(total[1], down[1]),
        simd.add_f64s(total[2], along[0]),
        simd.add_f64s(total[3], along[1]),
        simd.add_f64s(total[4], away[0]),
        simd.add_f64s(total[5], away[1]),
    ]
}

/// A component of ĝ x along the surface.
///
/// Coefficients: of both shears and of the pressure.
#[inline(always)]
fn shear<S: Simd>(
    simd: S,
    [first, second, coupling]: [S::f64s; COMPONENTS_IN_SPACE],
    [p, q, a, b, c, d]: [S::f64s; COMPLEX_PARTS],
) -> [S::f64s; 2] {
    let re = simd.add_f64s(simd.mul_f64s(first, a), simd.mul_f64s(second, c));
    let im = simd.add_f64s(simd.mul_f64s(first, b), simd.mul_f64s(second, d));
    [
        simd.add_f64s(re, simd.mul_f64s(coupling, q)),
        simd.sub_f64s(im, simd.mul_f64s(coupling, p)),
    ]
}
