//! The last lags, exactly: direct sums within a block of steps, transforms of whole blocks beyond.
//!
//! Time is cut into blocks of b steps. Within a block, pairs of input and output are summed as they
//! are. When a block is full, its spectrum is kept beside those of the P − 1 blocks before, and the
//! next block of outputs is their product with the spectra of the coefficients, cut into P parts
//! (uniformly partitioned overlap–save convolution). Memory does not grow with the steps.

use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

use crate::error::{Error, Result};
use crate::history::lag_kernel::LagKernel;
use crate::history::pair_classes::Pair;
use crate::linalg::dot;

const COUPLING_LASTS: Error =
    Error::NoExponentials { needed: "a coupling that ends before the exponentials begin" };

/// Coefficients of lags 1 to W per class (those of lag 1 are no part of the history, but of the
/// check for passivity).
#[derive(Debug, Clone)]
pub(super) struct Lags {
    pub(super) normal: Vec<Vec<f64>>,
    pub(super) tangential: Vec<Vec<f64>>,
    /// Only as long as it is not zero.
    pub(super) coupling: Vec<Vec<f64>>,
}

impl Lags {
    /// Lags 1 to `window`.
    pub(super) fn new(kernel: &dyn LagKernel, window: usize) -> Result<Self> {
        kernel.prepare(window)?;
        let classes = kernel.classes().count();
        let mut lags = Self {
            normal: Vec::with_capacity(classes),
            tangential: Vec::with_capacity(classes),
            coupling: Vec::with_capacity(classes),
        };
        for class in 0..classes {
            let [mut zz, mut xx, mut zx] = [(); 3].map(|()| vec![0.0; window]);
            kernel.coefficients(class, 1, &mut zz, &mut xx, &mut zx)?;
            let last = kernel.last_coupling_lag(class)?.filter(|last| *last <= window);
            zx.truncate(last.ok_or(COUPLING_LASTS)?);
            zx.shrink_to_fit();
            lags.normal.push(zz);
            lags.tangential.push(xx);
            lags.coupling.push(zx);
        }
        Ok(lags)
    }
}

/// Spectra of one part of the coefficients, b + 1 real parts, then as many imaginary ones, each.
struct Partition {
    normal: Vec<f64>,
    tangential: Vec<f64>,
    /// Empty where the coupling has died out.
    coupling: Vec<f64>,
}

/// Exact history of the last W lags.
pub(super) struct Window {
    block: usize,
    pairs: Vec<Pair>,
    count: usize,
    /// Per class, lag b − x at x: what is summed within a block.
    normal: Vec<Vec<f64>>,
    tangential: Vec<Vec<f64>>,
    coupling: Vec<Vec<f64>>,
    partitions: Vec<Partition>,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// 2Q rows of b: inputs of the present block.
    inputs: Vec<f64>,
    /// 2Q rows of b: what earlier blocks give to the present one.
    outputs: Vec<f64>,
    /// P slots of 2Q spectra of earlier blocks.
    past: Vec<f64>,
    /// Blocks completed.
    blocks: usize,
    /// Steps into the present block.
    into: usize,
    real: Vec<f64>,
    sum: Vec<f64>,
    spectrum: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl Window {
    /// Window of `parts` blocks of `block` steps: lags 2 to `parts` · `block`.
    pub(super) fn new(kernel: &dyn LagKernel, lags: &Lags, block: usize, parts: usize) -> Self {
        let count = kernel.classes().elements().len();
        let mut planner = RealFftPlanner::new();
        let (forward, inverse) =
            (planner.plan_fft_forward(2 * block), planner.plan_fft_inverse(2 * block));
        let scratch = forward.get_scratch_len().max(inverse.get_scratch_len());
        let near = |lags: &[Vec<f64>]| -> Vec<Vec<f64>> {
            let reversed = |lags: &Vec<f64>| {
                // Index x is d = b − x steps from traction to output, lag d + 1.
                (0..block).map(|x| lags.get(block - x).copied().unwrap_or(0.0)).collect()
            };
            lags.iter().map(reversed).collect()
        };
        let trimmed = |mut rows: Vec<Vec<f64>>| {
            // The coupling begins where it is not zero.
            for row in &mut rows {
                let zeros = row.iter().take_while(|value| **value == 0.0).count();
                row.drain(..zeros);
            }
            rows
        };
        let bins = block + 1;
        let mut window = Self {
            block,
            pairs: kernel.classes().pairs().to_vec(),
            count,
            normal: near(&lags.normal),
            tangential: near(&lags.tangential),
            coupling: trimmed(near(&lags.coupling)),
            partitions: Vec::with_capacity(parts),
            forward,
            inverse,
            inputs: vec![0.0; 2 * count * block],
            outputs: vec![0.0; 2 * count * block],
            past: vec![0.0; parts * 2 * count * 2 * bins],
            blocks: 0,
            into: 0,
            real: vec![0.0; 2 * block],
            sum: vec![0.0; 2 * count * 2 * bins],
            spectrum: vec![Complex::default(); bins],
            scratch: vec![Complex::default(); scratch],
        };
        for part in 0..parts {
            let normal = window.spectra(&lags.normal, part, parts);
            let tangential = window.spectra(&lags.tangential, part, parts);
            let reach = lags.coupling.iter().map(Vec::len).max().unwrap_or(0);
            let coupling = if reach > (part * block).max(1) {
                window.spectra(&lags.coupling, part, parts)
            } else {
                Vec::new()
            };
            window.partitions.push(Partition { normal, tangential, coupling });
        }
        window
    }

    /// Spectra of d = part·b … (part + 2)·b − 1 of all classes, d below the window's length.
    fn spectra(&mut self, lags: &[Vec<f64>], part: usize, parts: usize) -> Vec<f64> {
        let mut stored = Vec::with_capacity(lags.len() * 2 * (self.block + 1));
        for lags in lags {
            for (r, value) in self.real.iter_mut().enumerate() {
                let delay = part * self.block + r;
                let inside = delay < parts * self.block;
                *value = if inside { lags.get(delay).copied().unwrap_or(0.0) } else { 0.0 };
            }
            self.transform();
            stored.extend(self.spectrum.iter().map(|c| c.re));
            stored.extend(self.spectrum.iter().map(|c| c.im));
        }
        stored
    }

    /// Transform of `real`, which is overwritten as well, into `spectrum`.
    fn transform(&mut self) {
        let scratch = &mut self.scratch[..self.forward.get_scratch_len()];
        // All lengths are the plan's own, so there is nothing that could fail.
        let done = self.forward.process_with_scratch(&mut self.real, &mut self.spectrum, scratch);
        debug_assert!(done.is_ok());
    }

    /// Bytes held.
    pub(super) fn memory(&self) -> usize {
        let near = [&self.normal, &self.tangential, &self.coupling];
        let near: usize = near.into_iter().flatten().map(Vec::len).sum();
        let spectra = |p: &Partition| p.normal.len() + p.tangential.len() + p.coupling.len();
        let spectra: usize = self.partitions.iter().map(spectra).sum();
        let state = self.inputs.len() + self.outputs.len() + self.past.len();
        let work =
            self.real.len() + self.sum.len() + 2 * (self.spectrum.len() + self.scratch.len());
        (near + spectra + state + work) * size_of::<f64>()
    }

    /// Overwrites `displacement` with what the window gives at the end of the next step.
    pub(super) fn evaluate(&self, displacement: &mut [f64]) {
        let (block, into, count) = (self.block, self.into, self.count);
        for (value, row) in displacement.iter_mut().zip(self.outputs.chunks_exact(block)) {
            *value = row[into];
        }
        if into == 0 {
            return;
        }
        let input = |component: usize| &self.inputs[component * block..][..into];
        let (down, along) = displacement.split_at_mut(count);
        for (p, pairs) in self.pairs.chunks_exact(count).enumerate() {
            let (mut normal, mut tangential) = (0.0, 0.0);
            for (q, pair) in pairs.iter().enumerate() {
                let lags = block - into..block;
                let (pressure, shear) = (input(q), input(count + q));
                normal += dot(&self.normal[pair.class][lags.clone()], pressure);
                tangential += dot(&self.tangential[pair.class][lags], shear);
                let coupling = &self.coupling[pair.class];
                let reach = coupling.len().min(into);
                if reach > 0 && pair.sign != 0.0 {
                    let coupling = &coupling[coupling.len() - reach..];
                    normal += pair.sign * dot(coupling, &shear[into - reach..]);
                    tangential -= pair.sign * dot(coupling, &pressure[into - reach..]);
                }
            }
            down[p] += pairs[0].scale * normal;
            along[p] += pairs[0].scale * tangential;
        }
    }

    /// Accepts an input of 2Q.
    pub(super) fn push(&mut self, traction: &[f64]) {
        for (row, value) in self.inputs.chunks_exact_mut(self.block).zip(traction) {
            row[self.into] = *value;
        }
        self.into += 1;
        if self.into == self.block {
            self.complete();
        }
    }

    /// Turns a full block into its spectrum, and spectra into the outputs of the next block.
    fn complete(&mut self) {
        let (block, bins, components) = (self.block, self.block + 1, 2 * self.count);
        let parts = self.partitions.len();
        let size = components * 2 * bins;
        let slot = self.blocks % parts * size;
        for component in 0..components {
            self.real[..block].copy_from_slice(&self.inputs[component * block..][..block]);
            self.real[block..].fill(0.0);
            self.transform();
            let (re, im) = self.past[slot + component * 2 * bins..][..2 * bins].split_at_mut(bins);
            for (value, (re, im)) in self.spectrum.iter().zip(re.iter_mut().zip(im)) {
                (*re, *im) = (value.re, value.im);
            }
        }
        self.blocks += 1;
        self.into = 0;
        self.sum.fill(0.0);
        for (part, partition) in self.partitions.iter().enumerate().take(self.blocks) {
            let slot = (self.blocks - 1 - part) % parts * size;
            let past = &self.past[slot..slot + size];
            multiply(&self.pairs, self.count, bins, partition, past, &mut self.sum);
        }
        for component in 0..components {
            let scale = self.pairs[component % self.count * self.count].scale / (2 * block) as f64;
            let (re, im) = self.sum[component * 2 * bins..][..2 * bins].split_at(bins);
            for (value, (re, im)) in self.spectrum.iter_mut().zip(re.iter().zip(im)) {
                *value = Complex::new(*re, *im);
            }
            // Real up to rounding, and the inverse transform insists on it.
            (self.spectrum[0].im, self.spectrum[block].im) = (0.0, 0.0);
            let scratch = &mut self.scratch[..self.inverse.get_scratch_len()];
            let done =
                self.inverse.process_with_scratch(&mut self.spectrum, &mut self.real, scratch);
            debug_assert!(done.is_ok());
            let output = &mut self.outputs[component * block..][..block];
            for (output, value) in output.iter_mut().zip(&self.real[block..]) {
                *output = scale * value;
            }
        }
    }

    /// Forgets all inputs, as if `blocks` blocks of zeros had been.
    pub(super) fn clear(&mut self, blocks: usize) {
        self.inputs.fill(0.0);
        self.outputs.fill(0.0);
        self.past.fill(0.0);
        (self.blocks, self.into) = (blocks, 0);
    }
}

/// Adds what one earlier block gives, spectra of all components side by side.
fn multiply(
    pairs: &[Pair],
    count: usize,
    bins: usize,
    partition: &Partition,
    past: &[f64],
    sum: &mut [f64],
) {
    let width = 2 * bins;
    for (p, pairs) in pairs.chunks_exact(count).enumerate() {
        for (q, pair) in pairs.iter().enumerate() {
            let mut add = |sign: f64, stored: &[f64], source: usize, receiver: usize| {
                let factor = &stored[pair.class * width..][..width];
                let input = &past[source * width..][..width];
                multiply_add(&mut sum[receiver * width..][..width], sign, factor, input);
            };
            add(1.0, &partition.normal, q, p);
            add(1.0, &partition.tangential, count + q, count + p);
            if pair.sign != 0.0 && !partition.coupling.is_empty() {
                add(pair.sign, &partition.coupling, count + q, p);
                add(-pair.sign, &partition.coupling, q, count + p);
            }
        }
    }
}

/// Adds `sign` times the product of two spectra, all as real parts before imaginary ones.
fn multiply_add(output: &mut [f64], sign: f64, factor: &[f64], input: &[f64]) {
    let bins = output.len() / 2;
    let (out_re, out_im) = output.split_at_mut(bins);
    let ((a_re, a_im), (b_re, b_im)) = (factor.split_at(bins), input.split_at(bins));
    let (a_im, b_re, b_im, out_im) =
        (&a_im[..bins], &b_re[..bins], &b_im[..bins], &mut out_im[..bins]);
    for k in 0..bins {
        let (re, im) = (sign * a_re[k], sign * a_im[k]);
        out_re[k] += re * b_re[k] - im * b_im[k];
        out_im[k] += re * b_im[k] + im * b_re[k];
    }
}
