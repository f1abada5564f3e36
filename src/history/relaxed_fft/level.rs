//! Blocks of one size over pairs of elements, with the spectra of their coefficients.

use std::ops::Range;
use std::sync::Arc;

use super::coefficients::ClassCoefficients;
use super::ring::Ring;
use crate::geometry::COMPONENTS_IN_PLANE;
use crate::history::pair_classes::{COUPLING_KIND, MAX_PLANE_KINDS, Pair, PairClasses};
use crate::linalg::{Simd, SimdSlice, SimdSliceMut, WithSimd, vectorized};
use basemat_fourier::num_complex::Complex;
use basemat_fourier::{ComplexToReal, RealPlanner, RealToComplex};

/// Number of frequencies multiplied together, so that all inputs and outputs stay in cache.
const FREQUENCIES_PER_TILE: usize = 64;

/// Effect of b inputs on the next b outputs: convolutions of length 2b.
pub(super) struct PairLevel {
    /// Number b of steps in a block.
    pub(super) block_size: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// Spectra over 2b of each kind and class: real parts, then imaginary parts.
    ///
    /// There are b + 1 of each. The coupling has none if it ends within smaller blocks.
    spectra: [Vec<f64>; MAX_PLANE_KINDS],
}

/// Scratch of the transforms of all levels.
#[derive(Default)]
pub(super) struct TransformScratch {
    real: Vec<f64>,
    spectra: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
    inputs: Vec<f64>,
    outputs: Vec<f64>,
}

impl TransformScratch {
    /// Number of stored real values.
    pub(super) fn stored_value_count(&self) -> usize {
        self.real.capacity()
            + 2 * (self.spectra.capacity() + self.scratch.capacity())
            + self.inputs.capacity()
            + self.outputs.capacity()
    }

    /// Enlarges the scratch for blocks of `level` with `row_count` rows transformed together.
    pub(super) fn grow(&mut self, level: &PairLevel, row_count: usize) {
        let plan_scratch = level.forward.get_scratch_len().max(level.inverse.get_scratch_len());
        let tile_length = row_count * 2 * FREQUENCIES_PER_TILE;
        extend_to(&mut self.real, 2 * level.block_size);
        extend_to(&mut self.spectra, row_count * (level.block_size + 1));
        extend_to(&mut self.scratch, plan_scratch);
        extend_to(&mut self.inputs, tile_length);
        extend_to(&mut self.outputs, tile_length);
    }
}

/// Extends a buffer with zeros to at least `length` values.
fn extend_to<T: Copy + Default>(buffer: &mut Vec<T>, length: usize) {
    buffer.resize(buffer.len().max(length), T::default());
}

/// Components of tractions and displacements that a product includes.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Components {
    /// Displacement down due to pressure, and to the right due to shear.
    Even,
    /// Displacement down due to shear, and to the right due to pressure.
    Coupling,
    /// All components.
    All,
}

/// Rows of inputs and outputs, and the pair classes of the elements.
pub(super) struct BlockRows<'a> {
    /// 2Q rows of inputs and outputs.
    pub(super) rows: &'a mut [f64],
    /// Length of a row.
    pub(super) stride: usize,
    pub(super) ring: Ring,
    /// Number of inputs so far.
    pub(super) step: usize,
    pub(super) classes: &'a PairClasses,
}

impl PairLevel {
    /// Number of stored real values.
    pub(super) fn stored_value_count(&self) -> usize {
        self.spectra.iter().map(Vec::capacity).sum()
    }

    /// Blocks of `block_size`, without spectra yet.
    ///
    /// Allocates for `class_count` spectra of each of the first `kind_count`.
    pub(super) fn new(
        block_size: usize,
        class_count: usize,
        kind_count: usize,
        planner: &mut RealPlanner,
    ) -> Self {
        Self {
            block_size,
            forward: planner.plan_fft_forward(2 * block_size),
            inverse: planner.plan_fft_inverse(2 * block_size),
            spectra: std::array::from_fn(|kind| {
                Vec::with_capacity(if kind < kind_count {
                    class_count * 2 * (block_size + 1)
                } else {
                    0
                })
            }),
        }
    }

    /// Adds the spectra of the first `kind_count` of the next class, from at least 2b coefficients.
    pub(super) fn add_class(
        &mut self,
        values: &ClassCoefficients,
        kind_count: usize,
        buffers: &mut TransformScratch,
    ) {
        for (values, stored) in values.iter().zip(&mut self.spectra).take(kind_count) {
            let real = &mut buffers.real[..2 * self.block_size];
            let spectrum = &mut buffers.spectra[..=self.block_size];
            real.copy_from_slice(&values[..2 * self.block_size]);
            transform(&*self.forward, real, spectrum, &mut buffers.scratch);
            stored.extend(spectrum.iter().map(|c| c.re));
            stored.extend(spectrum.iter().map(|c| c.im));
        }
    }

    /// Adds the effect of the last b inputs to the next b outputs.
    pub(super) fn apply(
        &self,
        block: &mut BlockRows<'_>,
        part: Components,
        buffers: &mut TransformScratch,
    ) {
        let element_count = block.classes.elements().len();
        if part == Components::Even {
            // One component after the other needs half the scratch.
            for kind in 0..COMPONENTS_IN_PLANE {
                self.apply_to(
                    block,
                    part,
                    kind,
                    kind * element_count..(kind + 1) * element_count,
                    buffers,
                );
            }
        } else {
            self.apply_to(block, part, 0, 0..COMPONENTS_IN_PLANE * element_count, buffers);
        }
    }

    /// Adds the effects on a range of rows; `kind` is the kind of all coefficients if `part` is even.
    fn apply_to(
        &self,
        block: &mut BlockRows<'_>,
        part: Components,
        kind: usize,
        row_range: Range<usize>,
        buffers: &mut TransformScratch,
    ) {
        let element_count = block.classes.elements().len();
        let first_row = row_range.start;
        let row_count = row_range.len();
        let block_size = self.block_size;
        let frequencies = block_size + 1;
        for row_index in 0..row_count {
            let row = &block.rows[(first_row + row_index) * block.stride..][..block.stride];
            let real = &mut buffers.real[..2 * block_size];
            real[..block_size]
                .copy_from_slice(&row[block.ring.input_range(block.step, block_size)]);
            real[block_size..].fill(0.0);
            let spectrum = &mut buffers.spectra[row_index * frequencies..][..frequencies];
            transform(&*self.forward, real, spectrum, &mut buffers.scratch);
        }
        self.multiply(block.classes, part, kind, row_count, buffers);
        for row_index in 0..row_count {
            let receiver = block.classes.pairs()[row_index % element_count * element_count];
            let scale = receiver.scale / (2 * block_size) as f64;
            let real = &mut buffers.real[..2 * block_size];
            let spectrum = &mut buffers.spectra[row_index * frequencies..][..frequencies];
            // These values are real up to rounding; the inverse transform requires exact zeros.
            spectrum[0].im = 0.0;
            spectrum[block_size].im = 0.0;
            let scratch = &mut buffers.scratch[..self.inverse.get_scratch_len()];
            let result = self.inverse.process_with_scratch(spectrum, real, scratch);
            debug_assert!(result.is_ok());
            let start = (first_row + row_index) * block.stride + block.ring.column(block.step);
            let row = &mut block.rows[start..start + block_size];
            for (output, value) in row.iter_mut().zip(&real[block_size..]) {
                *output += scale * value;
            }
        }
    }

    /// Replaces the spectra of inputs by the spectra of outputs, tile by tile.
    fn multiply(
        &self,
        classes: &PairClasses,
        part: Components,
        kind: usize,
        row_count: usize,
        buffers: &mut TransformScratch,
    ) {
        let frequencies = self.block_size + 1;
        let element_count = classes.elements().len();
        let has_coupling = part != Components::Even && !self.spectra[COUPLING_KIND].is_empty();
        let tile_count = frequencies.div_ceil(FREQUENCIES_PER_TILE);
        let tile_width = frequencies.div_ceil(tile_count);
        let TransformScratch { spectra, inputs, outputs, .. } = buffers;
        for first_frequency in (0..frequencies).step_by(tile_width) {
            let tile_width = tile_width.min(frequencies - first_frequency);
            let tile_range =
                |row_index: usize| row_index * 2 * tile_width..(row_index + 1) * 2 * tile_width;
            for row_index in 0..row_count {
                let values = &spectra[row_index * frequencies + first_frequency..][..tile_width];
                copy_to_tile(values, &mut inputs[tile_range(row_index)]);
            }
            outputs[..row_count * 2 * tile_width].fill(0.0);
            // Adds the product of a class's spectrum with the source's tile to the receiver's tile.
            let mut add_product = |(kind, sign): (usize, f64), class: usize, source, receiver| {
                let factor = [0, 1].map(|complex_part| {
                    let start = (class * 2 + complex_part) * frequencies + first_frequency;
                    &self.spectra[kind][start..][..tile_width]
                });
                let multiply =
                    if sign > 0.0 { multiply_add::<true> } else { multiply_add::<false> };
                multiply(&mut outputs[tile_range(receiver)], factor, &inputs[tile_range(source)]);
            };
            for (p, pairs) in classes.pairs().chunks_exact(element_count).enumerate() {
                for (q, &Pair { class, sign, .. }) in pairs.iter().enumerate() {
                    match part {
                        Components::Even => add_product((kind, 1.0), class, q, p),
                        Components::Coupling => {}
                        Components::All => {
                            add_product((0, 1.0), class, q, p);
                            add_product((1, 1.0), class, element_count + q, element_count + p);
                        }
                    }
                    if has_coupling && sign != 0.0 {
                        let coupling = classes.coupling(p * element_count + q);
                        add_product(coupling[0], class, element_count + q, p);
                        add_product(coupling[1], class, q, element_count + p);
                    }
                }
            }
            for row_index in 0..row_count {
                let values =
                    &mut spectra[row_index * frequencies + first_frequency..][..tile_width];
                copy_from_tile(&outputs[tile_range(row_index)], values);
            }
        }
    }
}

/// Copies frequencies of a spectrum to a tile: real parts, then imaginary parts.
fn copy_to_tile(values: &[Complex<f64>], tile: &mut [f64]) {
    let (re, im) = tile.split_at_mut(values.len());
    for (value, (re, im)) in values.iter().zip(re.iter_mut().zip(im)) {
        *re = value.re;
        *im = value.im;
    }
}

/// Copies a tile to frequencies of a spectrum.
fn copy_from_tile(tile: &[f64], values: &mut [Complex<f64>]) {
    let (re, im) = tile.split_at(values.len());
    for (value, (re, im)) in values.iter_mut().zip(re.iter().zip(im)) {
        *value = Complex::new(*re, *im);
    }
}

/// Overwrites `spectrum` with the transform of `real`, and `real` with intermediate values.
fn transform(
    plan: &dyn RealToComplex<f64>,
    real: &mut [f64],
    spectrum: &mut [Complex<f64>],
    scratch: &mut [Complex<f64>],
) {
    // All lengths come from the plan, so that the transform cannot fail.
    let result = plan.process_with_scratch(real, spectrum, &mut scratch[..plan.get_scratch_len()]);
    debug_assert!(result.is_ok());
}

/// Adds (or subtracts) the product of two spectra, stored as real parts, then imaginary parts.
fn multiply_add<const PLUS: bool>(output: &mut [f64], factor: [&[f64]; 2], input: &[f64]) {
    vectorized(SpectrumProduct::<PLUS> { output, factor, input });
}

struct SpectrumProduct<'a, const PLUS: bool> {
    output: &'a mut [f64],
    factor: [&'a [f64]; 2],
    input: &'a [f64],
}

impl<const PLUS: bool> WithSimd for SpectrumProduct<'_, PLUS> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]
    fn with_simd<S: Simd>(self, simd: S) {
        let width = self.output.len() / 2;
        let (out_re, out_im) = self.output.split_at_mut(width);
        let (in_re, in_im) = self.input.split_at(width);
        let sum_re = SimdSliceMut::<S>::new(out_re);
        let sum_im = SimdSliceMut::<S>::new(out_im);
        let a_re = SimdSlice::<S>::new(&self.factor[0][..width]);
        let a_im = SimdSlice::<S>::new(&self.factor[1][..width]);
        let b_re = SimdSlice::<S>::new(in_re);
        let b_im = SimdSlice::<S>::new(&in_im[..width]);
        let a_vectors = a_re.vectors.iter().zip(a_im.vectors);
        let factors = a_vectors.zip(b_re.vectors.iter().zip(b_im.vectors));
        let sums = sum_re.vectors.iter_mut().zip(sum_im.vectors);
        for ((x, y), ((a, b), (c, d))) in sums.zip(factors) {
            let a = if PLUS { *a } else { simd.neg_f64s(*a) };
            let b = if PLUS { *b } else { simd.neg_f64s(*b) };
            *x = simd.mul_add_e_f64s(a, *c, simd.mul_add_e_f64s(simd.neg_f64s(b), *d, *x));
            *y = simd.mul_add_e_f64s(a, *d, simd.mul_add_e_f64s(b, *c, *y));
        }
        let sign = if PLUS { 1.0 } else { -1.0 };
        for k in 0..sum_re.tail.len() {
            let a = sign * a_re.tail[k];
            let b = sign * a_im.tail[k];
            sum_re.tail[k] += a * b_re.tail[k] - b * b_im.tail[k];
            sum_im.tail[k] += a * b_im.tail[k] + b * b_re.tail[k];
        }
    }
}
