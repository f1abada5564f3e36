//! Blocks of one size over the wavenumbers of a lattice, and levels that histories share.

use std::ops::Range;
use std::sync::Arc;

use super::level::Components;
use super::plan_spectra::WaveNumbers;
use super::ring::Ring;
use crate::error::Result;
use crate::history::pair_classes::{COUPLING_KIND, STRIP_KINDS};
use basemat_fourier::RealPlanner;
use basemat_fourier::num_complex::Complex;
use basemat_fourier::{ComplexPlanner, Fft};

/// Kind of the coefficient for each displacement (row) and traction (column): of two components, and of three.
const COMPONENT_KINDS: [&[&[usize]]; 2] =
    [&[&[0, 2], &[2, 1]], &[&[0, 4, 5], &[4, 1, 3], &[5, 3, 2]]];

/// Matrix of the kinds of coefficients for N components: displacements (rows) due to tractions (columns).
pub(super) fn kinds<const N: usize>() -> [[usize; N]; N] {
    let rows = COMPONENT_KINDS[usize::from(N == 3)];
    std::array::from_fn(|row| std::array::from_fn(|column| rows[row][column]))
}

/// Coefficients of a leaf, kind by kind: for each d = 0 … leaf − 1 the wavenumbers with spectra.
pub(super) type LeafCoefficients = Vec<Vec<f64>>;

/// Effect of b inputs on the next b outputs, separately for each wavenumber.
///
/// The blocks and spectra of one wavenumber fit into cache.
pub(super) struct WaveLevel {
    /// Number b of steps in a block.
    pub(super) block_size: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    waves: WaveNumbers,
    /// Spectra of each kind: for each wavenumber, the b + 1 lower frequencies of 2b.
    ///
    /// The coefficients are real numbers in time, so that the upper frequencies are conjugates. The coupling of
    /// pressure and shear is i times the stored coefficients. A strip's coupling has no spectra if it ends within
    /// smaller blocks.
    spectra: Vec<Vec<Complex<f64>>>,
}

impl WaveLevel {
    /// Blocks of `block_size`, without spectra yet; `kinds` states for each kind whether it will have spectra.
    pub(super) fn new(
        block_size: usize,
        waves: WaveNumbers,
        kinds: impl Iterator<Item = bool>,
        planner: &mut ComplexPlanner,
    ) -> Self {
        let length = waves.with_spectra * (block_size + 1);
        Self {
            block_size,
            forward: planner.plan_fft_forward(2 * block_size),
            inverse: planner.plan_fft_inverse(2 * block_size),
            waves,
            spectra: kinds
                .map(|has_spectra| vec![Complex::default(); if has_spectra { length } else { 0 }])
                .collect(),
        }
    }

    /// Number of stored real values.
    pub(super) fn stored_value_count(&self) -> usize {
        2 * self.spectra.iter().map(Vec::len).sum::<usize>()
    }

    /// Length of the scratch that transforms need.
    pub(super) fn scratch_length(&self) -> usize {
        self.forward.get_inplace_scratch_len().max(self.inverse.get_inplace_scratch_len())
    }

    /// Whether there are spectra of this kind.
    pub(super) fn has_spectra(&self, kind: usize) -> bool {
        !self.spectra[kind].is_empty()
    }

    /// Stores the coefficients of d, one per wavenumber, in the memory of the spectra.
    pub(super) fn store_coefficients(&mut self, kind: usize, d: usize, values: &[f64]) {
        let rows = self.spectra[kind].chunks_exact_mut(self.block_size + 1);
        if d.is_multiple_of(2) {
            rows.zip(values).for_each(|(row, value)| row[d / 2].re = *value);
        } else {
            rows.zip(values).for_each(|(row, value)| row[d / 2].im = *value);
        }
    }

    /// Overwrites `samples` with the coefficients stored for a wavenumber.
    pub(super) fn stored_coefficients(&self, kind: usize, wave: usize, samples: &mut [f64]) {
        let row = &self.spectra[kind][wave * (self.block_size + 1)..][..self.block_size];
        for (pair, value) in samples.chunks_exact_mut(2).zip(row) {
            pair.copy_from_slice(&[value.re, value.im]);
        }
    }

    /// Transforms 2b coefficients to the spectrum; overwrites `samples` too.
    pub(super) fn transform(
        &mut self,
        kind: usize,
        wave: usize,
        samples: &mut [f64],
        planner: &mut RealPlanner,
        scratch: &mut Vec<Complex<f64>>,
    ) {
        let plan = planner.plan_fft_forward(2 * self.block_size);
        scratch.resize(scratch.len().max(plan.get_scratch_len()), Complex::default());
        let spectrum = &mut self.spectra[kind][wave * (self.block_size + 1)..][..=self.block_size];
        let scratch = &mut scratch[..plan.get_scratch_len()];
        // All lengths come from the plan, so that the transform cannot fail.
        let result = plan.process_with_scratch(samples, spectrum, scratch);
        debug_assert!(result.is_ok());
    }

    /// Adds the effect of the b inputs before `step` to the next b outputs, in all rows.
    ///
    /// There is one row per wavenumber for the first component, then as many for each other component.
    #[allow(clippy::too_many_arguments, reason = "buffers of one step, each with its meaning")]
    pub(super) fn apply(
        &self,
        rows: &mut [Complex<f64>],
        stride: usize,
        ring: Ring,
        step: usize,
        components: Components,
        blocks: &mut [Complex<f64>],
        scratch: &mut [Complex<f64>],
    ) {
        let block_size = self.block_size;
        // Rows may end before the block does.
        let input_range = ring.input_range(step, block_size);
        let start = ring.column(step);
        let output_range = start..stride.min(start + block_size);
        if components == Components::Even {
            // One component at a time: the largest blocks need no more scratch than the blocks of the coupling.
            let block = &mut blocks[..2 * block_size];
            for (kind, rows) in rows.chunks_exact_mut(self.waves.count * stride).enumerate() {
                for (wave, row) in rows.chunks_exact_mut(stride).enumerate() {
                    self.transform_inputs(&row[input_range.clone()], block, scratch);
                    multiply(block, self.spectrum(kind, wave));
                    self.add_to_outputs(block, &mut row[output_range.clone()], scratch);
                }
            }
        } else if self.spectra.len() == STRIP_KINDS {
            self.apply_coupled::<2>(
                rows,
                stride,
                input_range,
                output_range,
                components,
                blocks,
                scratch,
            );
        } else {
            self.apply_coupled::<3>(
                rows,
                stride,
                input_range,
                output_range,
                components,
                blocks,
                scratch,
            );
        }
    }

    /// Lower frequencies of the spectrum of a kind at a wavenumber.
    fn spectrum(&self, kind: usize, wave: usize) -> &[Complex<f64>] {
        let frequency_count = self.block_size + 1;
        &self.spectra[kind][self.waves.spectrum(wave) * frequency_count..][..frequency_count]
    }

    /// Adds the effect of the inputs `input_range` to the outputs `output_range`, for N coupled components.
    #[allow(clippy::too_many_arguments, reason = "as of `apply`, with both ranges")]
    fn apply_coupled<const N: usize>(
        &self,
        rows: &mut [Complex<f64>],
        stride: usize,
        input_range: Range<usize>,
        output_range: Range<usize>,
        components: Components,
        blocks: &mut [Complex<f64>],
        scratch: &mut [Complex<f64>],
    ) {
        let blocks = &mut blocks[..2 * N * self.block_size];
        for wave in 0..self.waves.count {
            for (component, block) in blocks.chunks_exact_mut(2 * self.block_size).enumerate() {
                let start = (component * self.waves.count + wave) * stride;
                let row = &rows[start..][..stride];
                self.transform_inputs(&row[input_range.clone()], block, scratch);
            }
            if components == Components::All {
                let spectra = kinds::<N>().map(|row| row.map(|kind| self.spectrum(kind, wave)));
                multiply_all(blocks, spectra);
            } else {
                let (pressure, shear) = blocks.split_at_mut(2 * self.block_size);
                multiply_coupling(pressure, shear, self.spectrum(COUPLING_KIND, wave));
            }
            for (component, block) in blocks.chunks_exact_mut(2 * self.block_size).enumerate() {
                let start = (component * self.waves.count + wave) * stride;
                let row = &mut rows[start..][..stride];
                self.add_to_outputs(block, &mut row[output_range.clone()], scratch);
            }
        }
    }

    /// Transforms b inputs, followed by as many zeros.
    fn transform_inputs(
        &self,
        inputs: &[Complex<f64>],
        block: &mut [Complex<f64>],
        scratch: &mut [Complex<f64>],
    ) {
        block[..self.block_size].copy_from_slice(inputs);
        block[self.block_size..].fill(Complex::default());
        self.forward.process_with_scratch(block, scratch);
    }

    /// Transforms a block back, and adds its second half to the outputs, at most b.
    fn add_to_outputs(
        &self,
        block: &mut [Complex<f64>],
        outputs: &mut [Complex<f64>],
        scratch: &mut [Complex<f64>],
    ) {
        self.inverse.process_with_scratch(block, scratch);
        let scale = 0.5 / self.block_size as f64;
        for (output, value) in outputs.iter_mut().zip(&block[self.block_size..]) {
            *output += value.scale(scale);
        }
    }
}

/// Upper frequencies of a spectrum in ascending order, from its lower frequencies.
fn upper_frequencies(lower: &[Complex<f64>]) -> impl Iterator<Item = Complex<f64>> {
    lower[1..lower.len() - 1].iter().rev().map(Complex::conj)
}

/// Multiplies a transformed block by a spectrum, frequency by frequency.
fn multiply(block: &mut [Complex<f64>], spectrum: &[Complex<f64>]) {
    let (low, high) = block.split_at_mut(spectrum.len());
    for (value, factor) in low.iter_mut().zip(spectrum) {
        *value *= factor;
    }
    for (value, factor) in high.iter_mut().zip(upper_frequencies(spectrum)) {
        *value *= factor;
    }
}

/// Multiplies pressure and shear by the coupling: (p, s) ← (i c s, −i c p).
fn multiply_coupling(
    pressure: &mut [Complex<f64>],
    shear: &mut [Complex<f64>],
    coupling: &[Complex<f64>],
) {
    let spectrum = coupling.iter().copied().chain(upper_frequencies(coupling));
    for ((p, s), c) in pressure.iter_mut().zip(shear).zip(spectrum) {
        let c = times_i(c);
        (*p, *s) = (c * *s, -c * *p);
    }
}

fn times_i(value: Complex<f64>) -> Complex<f64> {
    Complex::new(-value.im, value.re)
}

/// Multiplies blocks of N components by a Hermitian matrix.
///
/// The factor between the first component and the others is i times the spectrum in the first row, −i times in the
/// first column.
fn multiply_all<const N: usize>(blocks: &mut [Complex<f64>], spectra: [[&[Complex<f64>]; N]; N]) {
    let length = blocks.len() / N;
    let lower_count = length / 2 + 1;
    let mut halves = blocks.chunks_exact_mut(length).map(|block| block.split_at_mut(lower_count));
    let mut low: [&mut [Complex<f64>]; N] = std::array::from_fn(|_| Default::default());
    let mut high: [&mut [Complex<f64>]; N] = std::array::from_fn(|_| Default::default());
    for ((low, high), half) in low.iter_mut().zip(&mut high).zip(&mut halves) {
        (*low, *high) = half;
    }
    multiply_matrix::<N, false>(low, spectra);
    multiply_matrix::<N, true>(high, spectra);
}

/// Multiplies the lower frequencies of N blocks by a matrix, or the upper frequencies if `UPPER`.
fn multiply_matrix<const N: usize, const UPPER: bool>(
    mut blocks: [&mut [Complex<f64>]; N],
    spectra: [[&[Complex<f64>]; N]; N],
) {
    let length = blocks[0].len();
    let mut blocks = blocks.each_mut().map(|block| &mut block[..length]);
    let spectra = spectra.map(|row| row.map(|spectrum| &spectrum[..length + usize::from(UPPER)]));
    for frequency in 0..length {
        let values: [Complex<f64>; N] = std::array::from_fn(|n| blocks[n][frequency]);
        for (n, (block, row)) in blocks.iter_mut().zip(&spectra).enumerate() {
            let factor = |m: usize| {
                if UPPER { row[m][length - frequency].conj() } else { row[m][frequency] }
            };
            block[frequency] = if n == 0 {
                (1..N).fold(factor(0) * values[0], |sum, m| sum + times_i(factor(m)) * values[m])
            } else {
                let shear_sum =
                    (2..N).fold(factor(1) * values[1], |sum, m| sum + factor(m) * values[m]);
                shear_sum - times_i(factor(0)) * values[0]
            };
        }
    }
}

/// Levels of blocks, from the smallest on, with the coefficients C of a leaf.
pub(crate) struct Levels<L, C> {
    pub(super) levels: Vec<Arc<L>>,
    /// Coefficients of a leaf; `None` until they are computed.
    pub(super) leaf: Option<Arc<C>>,
}

impl<L, C> Default for Levels<L, C> {
    fn default() -> Self {
        Self { levels: Vec::new(), leaf: None }
    }
}

impl<L, C> Levels<L, C> {
    /// Returns the smallest `count` levels and the coefficients of a leaf.
    ///
    /// `compute_missing` computes the levels of a range of indices, and the coefficients unless they exist.
    pub(super) fn smallest(
        &mut self,
        count: usize,
        compute_missing: impl FnOnce(Range<usize>, &mut Option<Arc<C>>) -> Result<Vec<Arc<L>>>,
    ) -> Result<Self> {
        let new_levels = compute_missing(self.levels.len()..count, &mut self.leaf)?;
        self.levels.extend(new_levels);
        Ok(Self { levels: self.levels[..count].to_vec(), leaf: self.leaf.clone() })
    }
}
