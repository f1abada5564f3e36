//! Next output of a leaf by direct summation over wavenumbers.
//!
//! The sum has one product for each wavenumber, input and pair of components.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::plan_spectra::WaveNumbers;
use crate::geometry::{COMPLIANCES_PER_OFFSET, COMPONENTS_IN_SPACE};
use crate::history::pair_classes::STRIP_KINDS;
use crate::linalg::{Scalar, Simd, SimdSlice, SimdSliceMut, WithSimd};

/// Sum over the inputs of a strip's leaf so far, for its next output.
pub(super) struct StripLeaf<'a> {
    pub(super) sum: &'a mut [f64],
    pub(super) inputs: &'a [f64],
    pub(super) coefficients: [&'a [f64]; STRIP_KINDS],
    /// Number of wavenumbers.
    pub(super) waves: usize,
    /// Last delay d at which the coupling is not zero.
    pub(super) reach: usize,
}

impl WithSimd for StripLeaf<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sum, inputs, coefficients, waves, reach } = self;
        let leaf_step = inputs.len() / sum.len();
        for (m, input) in inputs.chunks_exact(sum.len()).enumerate() {
            let d = leaf_step - m;
            let delay_coefficients = coefficients.map(|values| &values[d * waves..(d + 1) * waves]);
            if d <= reach {
                add_coupled(sum, input, delay_coefficients);
            } else {
                add_diagonal(sum, input, [delay_coefficients[0], delay_coefficients[1]]);
            }
        }
    }
}

/// sum ← sum + ĝ · input.
#[inline(always)]
fn add_diagonal(sum: &mut [f64], input: &[f64], coefficients: [&[f64]; 2]) {
    let waves = coefficients[0].len();
    let parts = sum.chunks_exact_mut(waves).zip(input.chunks_exact(waves));
    for (part_index, (sum, input)) in parts.enumerate() {
        for ((sum, input), g) in sum.iter_mut().zip(input).zip(coefficients[part_index / 2]) {
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
    let (normal_sum, tangential_sum) = sum.split_at_mut(2 * waves);
    let (normal_re, normal_im) = normal_sum.split_at_mut(waves);
    let (tangential_re, tangential_im) = tangential_sum.split_at_mut(waves);
    let tangential_im = &mut tangential_im[..waves];
    let p_re = &input[..waves];
    let p_im = &input[waves..][..waves];
    let s_re = &input[2 * waves..][..waves];
    let s_im = &input[3 * waves..][..waves];
    for k in 0..waves {
        let g = normal[k];
        let h = tangential[k];
        let c = coupling[k];
        normal_re[k] += g * p_re[k] - c * s_im[k];
        normal_im[k] += g * p_im[k] + c * s_re[k];
        tangential_re[k] += h * s_re[k] + c * p_im[k];
        tangential_im[k] += h * s_im[k] - c * p_re[k];
    }
}

/// Sum over the inputs of a leaf of cells in plan, for its next output.
pub(super) struct PlanLeaf<'a> {
    pub(super) sum: &'a mut [f64],
    pub(super) inputs: &'a [f64],
    pub(super) coefficients: &'a [Vec<f64>],
    pub(super) waves: WaveNumbers,
}

/// Number of inputs multiplied in one pass over the sums, so that the sums are read and written less often.
const INPUTS_PER_PASS: usize = 4;
/// Number of real and imaginary parts of three components.
const COMPLEX_PARTS: usize = 2 * COMPONENTS_IN_SPACE;

impl WithSimd for PlanLeaf<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let leaf_step = self.inputs.len() / self.sum.len();
        let whole_passes_end = leaf_step - leaf_step % INPUTS_PER_PASS;
        for m in (0..whole_passes_end).step_by(INPUTS_PER_PASS) {
            self.add_inputs::<S, INPUTS_PER_PASS>(simd, leaf_step, m);
        }
        for m in whole_passes_end..leaf_step {
            self.add_inputs::<S, 1>(simd, leaf_step, m);
        }
    }
}

impl PlanLeaf<'_> {
    /// Adds the products of M inputs from the `m`-th on to the output at `leaf_step`.
    #[inline(always)]
    fn add_inputs<S: Simd, const M: usize>(&mut self, simd: S, leaf_step: usize, m: usize) {
        let Self { sum, inputs, coefficients, waves } = self;
        let input_width = sum.len();
        for (range, first_spectrum) in waves.ranges() {
            let length = range.len();
            let mut parts = sum.chunks_exact_mut(waves.count);
            let sums: [_; COMPLEX_PARTS] = std::array::from_fn(|_| {
                SimdSliceMut::<S>::new(&mut parts.next().unwrap_or_default()[range.clone()])
            });
            let inputs: [[_; COMPLEX_PARTS]; M] = std::array::from_fn(|n| {
                std::array::from_fn(|part| {
                    let start = (m + n) * input_width + part * waves.count + range.start;
                    SimdSlice::<S>::new(&inputs[start..start + length])
                })
            });
            let coefficients: [[_; COMPLIANCES_PER_OFFSET]; M] = std::array::from_fn(|n| {
                std::array::from_fn(|kind| {
                    let start = (leaf_step - m - n) * waves.with_spectra + first_spectrum;
                    SimdSlice::<S>::new(&coefficients[kind][start..start + length])
                })
            });
            for k in 0..sums[0].vectors.len() {
                let mut total = [sums[0].vectors[k]; COMPLEX_PARTS];
                for part in 1..COMPLEX_PARTS {
                    total[part] = sums[part].vectors[k];
                }
                for n in 0..M {
                    let mut x = [total[0]; COMPLEX_PARTS];
                    let mut g = [total[0]; COMPLIANCES_PER_OFFSET];
                    for part in 0..COMPLEX_PARTS {
                        x[part] = inputs[n][part].vectors[k];
                    }
                    for kind in 0..COMPLIANCES_PER_OFFSET {
                        g[kind] = coefficients[n][kind].vectors[k];
                    }
                    total = add_products(simd, total, g, x);
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
                    let total = add_products(Scalar::new(), total, g, x);
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
/// The coupling of pressure and shear is a real number times i, in the other direction times −i. The components of x
/// are real and imaginary parts of the pressure (p, q), of the shear along x (a, b) and of the shear along y (c, d).
#[inline(always)]
fn add_products<S: Simd>(
    simd: S,
    total: [S::f64s; COMPLEX_PARTS],
    [zz, xx, yy, xy, zx, zy]: [S::f64s; COMPLIANCES_PER_OFFSET],
    [p, q, a, b, c, d]: [S::f64s; COMPLEX_PARTS],
) -> [S::f64s; COMPLEX_PARTS] {
    let normal = [
        simd.sub_f64s(
            simd.sub_f64s(simd.mul_f64s(zz, p), simd.mul_f64s(zx, b)),
            simd.mul_f64s(zy, d),
        ),
        simd.add_f64s(
            simd.add_f64s(simd.mul_f64s(zz, q), simd.mul_f64s(zx, a)),
            simd.mul_f64s(zy, c),
        ),
    ];
    let x_shear = shear_component(simd, [xx, xy, zx], [p, q, a, b, c, d]);
    let y_shear = shear_component(simd, [xy, yy, zy], [p, q, a, b, c, d]);
    [
        simd.add_f64s(total[0], normal[0]),
        simd.add_f64s(total[1], normal[1]),
        simd.add_f64s(total[2], x_shear[0]),
        simd.add_f64s(total[3], x_shear[1]),
        simd.add_f64s(total[4], y_shear[0]),
        simd.add_f64s(total[5], y_shear[1]),
    ]
}

/// Real and imaginary part of one component of ĝ x along the surface.
///
/// `first` and `second`: coefficients of the shears along x and y; `coupling`: of the pressure.
#[inline(always)]
fn shear_component<S: Simd>(
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
