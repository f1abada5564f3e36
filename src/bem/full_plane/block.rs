//! Blocks of one size: spectra of the coefficients, and the effect of b inputs on the next b outputs.

use std::sync::Arc;

use basemat_fourier::num_complex::Complex;
use basemat_fourier::{ComplexToReal, RealPlanner, RealToComplex};

/// Number of frequencies that are multiplied together, so that all inputs and outputs stay in cache.
const FREQUENCY_TILE_SIZE: usize = 64;

/// A series of coefficients between one input and one output.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeriesLink {
    pub(super) output: usize,
    pub(super) input: usize,
    pub(super) series: usize,
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
    /// Allocates for the blocks of `level` with `inputs` channels, and for smaller ones.
    pub(super) fn grow(&mut self, level: &BlockTransform, inputs: usize) {
        let scratch = level.forward.get_scratch_len().max(level.inverse.get_scratch_len());
        let zero = Complex::default();
        self.real.resize(self.real.len().max(2 * level.size), 0.0);
        self.scratch.resize(self.scratch.len().max(scratch), zero);
        self.inputs.resize(self.inputs.len().max(inputs * (level.size + 1)), zero);
        self.outputs.resize(self.outputs.len().max(inputs * (level.size + 1)), zero);
    }
}

/// Effect of b inputs on the next b outputs: convolutions of length 2b.
pub(super) struct BlockTransform {
    size: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// For each series, b + 1 frequencies; empty where all coefficients are zero.
    spectra: Vec<Vec<Complex<f64>>>,
}

impl BlockTransform {
    /// Level with blocks of `size`; each of the `series` has at least 2b lags or is empty.
    pub(super) fn new(
        size: usize,
        series: &[Vec<f64>],
        planner: &mut RealPlanner,
        work: &mut TransformBuffers,
    ) -> Self {
        let mut level = Self {
            size,
            forward: planner.plan_fft_forward(2 * size),
            inverse: planner.plan_fft_inverse(2 * size),
            spectra: Vec::with_capacity(series.len()),
        };
        work.grow(&level, 0);
        for list in series {
            let mut spectrum = Vec::new();
            if list.iter().take(2 * size).any(|value| *value != 0.0) {
                spectrum.resize(size + 1, Complex::default());
                work.real[..2 * size].copy_from_slice(&list[..2 * size]);
                level.transform(&mut work.real[..2 * size], &mut spectrum, &mut work.scratch);
            }
            level.spectra.push(spectrum);
        }
        level
    }

    /// Transforms `real`, which is overwritten as well.
    fn transform(
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

    /// Adds the effect of the last b inputs before step `step` to the b outputs from there on.
    ///
    /// Rows of `inputs` and `outputs` have length `stride`.
    pub(super) fn apply(
        &self,
        links: &[SeriesLink],
        inputs: &[f64],
        outputs: &mut [f64],
        stride: usize,
        step: usize,
        work: &mut TransformBuffers,
    ) {
        let size = self.size;
        let bins = self.size + 1;
        let real = &mut work.real[..2 * size];
        let spectra = work.inputs.chunks_exact_mut(bins);
        for (row, spectrum) in inputs.chunks_exact(stride).zip(spectra) {
            real[..size].copy_from_slice(&row[step - size..step]);
            real[size..].fill(0.0);
            self.transform(real, spectrum, &mut work.scratch);
        }
        work.outputs.fill(Complex::default());
        for begin in (0..bins).step_by(FREQUENCY_TILE_SIZE) {
            let range = begin..(begin + FREQUENCY_TILE_SIZE).min(bins);
            for link in links {
                let spectrum = &self.spectra[link.series];
                if spectrum.is_empty() {
                    continue;
                }
                let input = &work.inputs[link.input * bins..][range.clone()];
                let output = &mut work.outputs[link.output * bins..][range.clone()];
                for ((out, c), x) in output.iter_mut().zip(&spectrum[range.clone()]).zip(input) {
                    out.re += link.sign * (c.re * x.re - c.im * x.im);
                    out.im += link.sign * (c.re * x.im + c.im * x.re);
                }
            }
        }
        let scale = 1.0 / (2 * size) as f64;
        let spectra = work.outputs.chunks_exact_mut(bins);
        for (row, spectrum) in outputs.chunks_exact_mut(stride).zip(spectra) {
            // These values are real up to rounding; the inverse transform requires exactly real values.
            spectrum[0].im = 0.0;
            spectrum[size].im = 0.0;
            let scratch = &mut work.scratch[..self.inverse.get_scratch_len()];
            let outcome = self.inverse.process_with_scratch(spectrum, real, scratch);
            debug_assert!(outcome.is_ok());
            for (output, value) in row[step..].iter_mut().zip(&real[size..]) {
                *output += scale * value;
            }
        }
    }
}
