//! Convolutions of blocks of one size b: the effect of b inputs on the next b outputs.

use std::sync::Arc;

use basemat_fourier::num_complex::Complex;
use basemat_fourier::{ComplexToReal, RealPlanner, RealToComplex};

/// Number of frequencies that are multiplied together, so that all inputs and outputs stay in cache.
const FREQUENCY_TILE_SIZE: usize = 64;

/// Series of coefficients between one input and one output: row and series indices.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeriesLink {
    pub(super) output_row: usize,
    pub(super) input_row: usize,
    pub(super) series_index: usize,
    pub(super) sign: f64,
}

/// Workspace of the transforms of all levels.
#[derive(Default)]
pub(super) struct TransformBuffers {
    real: Vec<f64>,
    scratch: Vec<Complex<f64>>,
    inputs: Vec<Complex<f64>>,
    outputs: Vec<Complex<f64>>,
}

impl TransformBuffers {
    /// Allocates for the blocks of `transform` with `input_count` rows, and for smaller blocks.
    pub(super) fn grow(&mut self, transform: &BlockTransform, input_count: usize) {
        let forward_length = transform.forward.get_scratch_len();
        let scratch_length = forward_length.max(transform.inverse.get_scratch_len());
        let spectrum_length = input_count * (transform.block_size + 1);
        let zero = Complex::default();
        self.real.resize(self.real.len().max(2 * transform.block_size), 0.0);
        self.scratch.resize(self.scratch.len().max(scratch_length), zero);
        self.inputs.resize(self.inputs.len().max(spectrum_length), zero);
        self.outputs.resize(self.outputs.len().max(spectrum_length), zero);
    }
}

/// Effect of b inputs on the next b outputs: convolutions of length 2b.
pub(super) struct BlockTransform {
    block_size: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// Spectrum of each series, with b + 1 frequencies; empty where all coefficients are zero.
    spectra: Vec<Vec<Complex<f64>>>,
}

impl BlockTransform {
    /// Transform of blocks of `block_size`; each of the `series` has at least 2b lags or is empty.
    pub(super) fn new(
        block_size: usize,
        series: &[Vec<f64>],
        planner: &mut RealPlanner,
        buffers: &mut TransformBuffers,
    ) -> Self {
        let mut transform = Self {
            block_size,
            forward: planner.plan_fft_forward(2 * block_size),
            inverse: planner.plan_fft_inverse(2 * block_size),
            spectra: Vec::with_capacity(series.len()),
        };
        buffers.grow(&transform, 0);
        for coefficients in series {
            let mut spectrum = Vec::new();
            if coefficients.iter().take(2 * block_size).any(|value| *value != 0.0) {
                spectrum.resize(block_size + 1, Complex::default());
                buffers.real[..2 * block_size].copy_from_slice(&coefficients[..2 * block_size]);
                let real = &mut buffers.real[..2 * block_size];
                transform.forward_transform(real, &mut spectrum, &mut buffers.scratch);
            }
            transform.spectra.push(spectrum);
        }
        transform
    }

    /// Overwrites `spectrum` with the transform of `real`, which becomes workspace.
    fn forward_transform(
        &self,
        real: &mut [f64],
        spectrum: &mut [Complex<f64>],
        scratch: &mut [Complex<f64>],
    ) {
        let scratch = &mut scratch[..self.forward.get_scratch_len()];
        // All lengths come from the plan, so the transform cannot fail.
        let outcome = self.forward.process_with_scratch(real, spectrum, scratch);
        debug_assert!(outcome.is_ok());
    }

    /// Adds the effect of the last b inputs before `step` to the b outputs from `step` on.
    ///
    /// Rows of `inputs` and `outputs` have length `stride`.
    pub(super) fn apply(
        &self,
        links: &[SeriesLink],
        inputs: &[f64],
        outputs: &mut [f64],
        stride: usize,
        step: usize,
        buffers: &mut TransformBuffers,
    ) {
        let block_size = self.block_size;
        let frequency_count = self.block_size + 1;
        let real = &mut buffers.real[..2 * block_size];
        let spectra = buffers.inputs.chunks_exact_mut(frequency_count);
        for (row, spectrum) in inputs.chunks_exact(stride).zip(spectra) {
            real[..block_size].copy_from_slice(&row[step - block_size..step]);
            real[block_size..].fill(0.0);
            self.forward_transform(real, spectrum, &mut buffers.scratch);
        }
        buffers.outputs.fill(Complex::default());
        for start in (0..frequency_count).step_by(FREQUENCY_TILE_SIZE) {
            let tile = start..(start + FREQUENCY_TILE_SIZE).min(frequency_count);
            for link in links {
                let spectrum = &self.spectra[link.series_index];
                if spectrum.is_empty() {
                    continue;
                }
                let input = &buffers.inputs[link.input_row * frequency_count..][tile.clone()];
                let output =
                    &mut buffers.outputs[link.output_row * frequency_count..][tile.clone()];
                for ((out, c), x) in output.iter_mut().zip(&spectrum[tile.clone()]).zip(input) {
                    out.re += link.sign * (c.re * x.re - c.im * x.im);
                    out.im += link.sign * (c.re * x.im + c.im * x.re);
                }
            }
        }
        let scale = 1.0 / (2 * block_size) as f64;
        let spectra = buffers.outputs.chunks_exact_mut(frequency_count);
        for (row, spectrum) in outputs.chunks_exact_mut(stride).zip(spectra) {
            // These values are real up to rounding; the inverse transform requires exactly real values.
            spectrum[0].im = 0.0;
            spectrum[block_size].im = 0.0;
            let scratch = &mut buffers.scratch[..self.inverse.get_scratch_len()];
            let outcome = self.inverse.process_with_scratch(spectrum, real, scratch);
            debug_assert!(outcome.is_ok());
            for (output, value) in row[step..].iter_mut().zip(&real[block_size..]) {
                *output += scale * value;
            }
        }
    }
}
