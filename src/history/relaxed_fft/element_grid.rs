//! Fourier transforms along the surface, for equal elements on a lattice.
//!
//! The coefficients of two such elements depend only on their offset, so that a transform along the surface replaces
//! the sums over pairs.
//!
//! | symbol | meaning |
//! |---|---|
//! | S | lengths of the transform, along each axis at least twice the number of cells less one, so that the cyclic convolution equals the plain one |
//! | k | wavenumbers: 0 … S/2 along x; all along y |
//! | 𝓕 | discrete Fourier transform along the surface |
//! | ĝ | 𝓕 of the coefficients over the offset: i times a real number for coefficients that are odd in one axis, real otherwise |
//!
//! In plan the wavenumbers (kx, −ky) are mirror images of (kx, ky): ĝ is the same when the sign of the components along
//! y is changed.

use std::sync::Arc;

use basemat_fourier::num_complex::Complex;
use basemat_fourier::{ComplexPlanner, Fft};
use basemat_fourier::{ComplexToReal, RealPlanner, RealToComplex};

use super::plan_spectra::{LAGS_PER_CHUNK, WaveNumbers, coefficients_in_plan};
use crate::error::Result;
use crate::geometry::{COMPLIANCES_PER_OFFSET, COMPONENTS_IN_PLANE, COMPONENTS_IN_SPACE, Lattice};
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::pair_classes::{COUPLING_KIND, PairClasses, STRIP_KINDS};
use crate::linalg::next_smooth_even;

/// Smallest number of elements for which the transform along the surface is used.
///
/// For fewer elements wavenumbers save little time, and their rows take twice the memory. With 6 elements a step took
/// 10 % less time than by pairs, with 10 elements 40 % less, with 14 elements half the time.
pub(super) const MIN_WAVENUMBER_ELEMENTS: usize = 8;

/// Whether a history transforms along the surface by default.
pub(super) fn uses_wavenumbers(kernel: &dyn ConvolutionWeights) -> bool {
    let classes = kernel.classes();
    let has_enough = classes.elements().len() >= MIN_WAVENUMBER_ELEMENTS;
    classes.plan().is_some() || has_enough && ElementGrid::from_pairs(classes).is_some()
}

/// Largest number of lattice cells per element: cells in gaps between strips cost as much as elements.
const MAX_CELLS_PER_ELEMENT: usize = 2;

/// Relative difference of two element lengths that counts as rounding.
const SCALE_TOLERANCE: f64 = 1e-9;

/// Cells of the elements, and the transforms along the surface.
pub(super) struct ElementGrid {
    /// Cell of each element; cells are numbered row by row, S along x.
    cells: Vec<usize>,
    offsets: Offsets,
    /// 1/length of an element in the plane, 1/area in plan.
    scale: f64,
    /// S along x and y; 1 along y in the plane.
    lengths: [usize; 2],
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// Forward and inverse transform along y.
    y_transforms: [Arc<dyn Fft<f64>>; 2],
    /// Values of the cells, row by row.
    real: Vec<f64>,
    /// Spectrum of one row.
    spectrum: Vec<Complex<f64>>,
    /// Spectra of all rows, columns of S along y.
    spectra: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

/// Class of each offset.
enum Offsets {
    /// Along a strip; `None` for an offset that no pair has.
    Strip(Vec<Option<usize>>),
    /// In plan: the lattice numbers its classes.
    Plan(Lattice),
}

impl ElementGrid {
    /// Creates the grid of the elements.
    ///
    /// `None` if the elements are not on a lattice, or most cells of the lattice are empty.
    pub(super) fn from_pairs(pairs: &PairClasses) -> Option<Self> {
        if let Some((lattice, cells)) = pairs.plan() {
            let lengths = lattice.counts.map(|count| next_smooth_even(2 * count - 1));
            let cells = cells.iter().map(|[i, j]| j * lengths[0] + i).collect();
            let scale = 1.0 / (lattice.pitch[0] * lattice.pitch[1]);
            let rows = lattice.counts[1];
            return Some(Self::new(cells, Offsets::Plan(lattice.clone()), scale, lengths, rows));
        }
        if pairs.has_two_couplings() {
            return None;
        }
        let elements = pairs.elements();
        let first_element = elements.first()?;
        let last_element = elements.last()?;
        let pitch = first_element.length();
        let max_cells = MAX_CELLS_PER_ELEMENT * elements.len();
        if (last_element.right() - first_element.left()) / pitch >= max_cells as f64 + 0.5 {
            return None;
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most `max_cells`"
        )]
        let cells: Vec<_> = elements
            .iter()
            .map(|element| ((element.left() - first_element.left()) / pitch).round() as usize)
            .collect();
        let mut classes = vec![None; cells.last()? + 1];
        // Pairs of one class are equal except for rounding: all pairs of one offset must be in one class.
        let mut scales = pairs.pairs().iter().map(|pair| pair.scale);
        let scale = scales.next()?;
        if scales.any(|pair_scale| (pair_scale - scale).abs() > SCALE_TOLERANCE * scale) {
            return None;
        }
        for (p, sources) in pairs.pairs().chunks_exact(cells.len()).enumerate() {
            for (q, pair) in sources.iter().enumerate() {
                let class = classes[cells[p].abs_diff(cells[q])].get_or_insert(pair.class);
                if *class != pair.class {
                    return None;
                }
            }
        }
        let lengths = [next_smooth_even(2 * classes.len() - 1), 1];
        Some(Self::new(cells, Offsets::Strip(classes), scale, lengths, 1))
    }

    fn new(
        cells: Vec<usize>,
        offsets: Offsets,
        scale: f64,
        lengths: [usize; 2],
        row_count: usize,
    ) -> Self {
        let mut planner = RealPlanner::new();
        let x_length = lengths[0];
        let forward = planner.plan_fft_forward(x_length);
        let inverse = planner.plan_fft_inverse(x_length);
        let mut planner = ComplexPlanner::new();
        let y_transforms =
            [planner.plan_fft_forward(lengths[1]), planner.plan_fft_inverse(lengths[1])];
        let x_scratch_length = forward.get_scratch_len().max(inverse.get_scratch_len());
        let scratch_length = y_transforms
            .iter()
            .map(|plan| plan.get_inplace_scratch_len())
            .fold(x_scratch_length, usize::max);
        let column_count = x_length / 2 + 1;
        Self {
            cells,
            offsets,
            scale,
            lengths,
            real: vec![0.0; row_count * x_length],
            spectrum: vec![Complex::default(); column_count],
            spectra: vec![Complex::default(); column_count * lengths[1]],
            scratch: vec![Complex::default(); scratch_length],
            forward,
            inverse,
            y_transforms,
        }
    }

    /// The wavenumbers.
    pub(super) fn waves(&self) -> WaveNumbers {
        let columns = self.spectrum.len();
        WaveNumbers {
            count: columns * self.lengths[1],
            with_spectra: columns * (self.lengths[1] / 2 + 1),
            first_mirrored: columns,
        }
    }

    /// Number of components of each element.
    pub(super) fn components(&self) -> usize {
        match self.offsets {
            Offsets::Strip(_) => COMPONENTS_IN_PLANE,
            Offsets::Plan(_) => COMPONENTS_IN_SPACE,
        }
    }

    /// Number of kinds of coefficients.
    pub(super) fn kinds(&self) -> usize {
        match self.offsets {
            Offsets::Strip(_) => STRIP_KINDS,
            Offsets::Plan(_) => COMPLIANCES_PER_OFFSET,
        }
    }

    /// Number of stored real values.
    pub(super) fn stored_value_count(&self) -> usize {
        self.real.len() + 2 * (self.spectrum.len() + self.spectra.len() + self.scratch.len())
    }

    /// Last lag at which any coupling is not zero; `usize::MAX` if it never ends.
    pub(super) fn last_coupling_lag(&self, kernel: &dyn ConvolutionWeights) -> Result<usize> {
        let Offsets::Strip(classes) = &self.offsets else { return Ok(usize::MAX) };
        let mut last_lag = 0;
        for class in classes.iter().flatten() {
            last_lag = last_lag.max(kernel.last_coupling_lag(*class)?.unwrap_or(usize::MAX));
        }
        Ok(last_lag)
    }

    /// Transforms row `row` along x, into `self.spectrum`.
    fn transform(&mut self, row: usize) {
        let Self { forward, real, spectrum, scratch, lengths: [length, _], .. } = self;
        let scratch = &mut scratch[..forward.get_scratch_len()];
        // All lengths come from the plan, so that the transform cannot fail.
        let real = &mut real[row * *length..(row + 1) * *length];
        let result = forward.process_with_scratch(real, spectrum, scratch);
        debug_assert!(result.is_ok());
    }

    /// Transforms one value per element to real and imaginary parts; zero in cells without element.
    pub(super) fn forward(
        &mut self,
        component: usize,
        values: &[f64],
        re: &mut [f64],
        im: &mut [f64],
    ) {
        self.real.fill(0.0);
        for (&cell, &value) in self.cells.iter().zip(values) {
            self.real[cell] = value;
        }
        let length = self.lengths[0];
        let y_length = self.lengths[1];
        let column_count = self.spectrum.len();
        if y_length > 1 {
            self.spectra.fill(Complex::default());
            for row in 0..self.real.len() / length {
                self.transform(row);
                for (column, value) in self.spectrum.iter().enumerate() {
                    self.spectra[column * y_length + row] = *value;
                }
            }
            self.y_transforms[0].process_with_scratch(&mut self.spectra, &mut self.scratch);
            let rows = re.chunks_exact_mut(column_count).zip(im.chunks_exact_mut(column_count));
            for (row, (re, im)) in rows.enumerate() {
                let spectrum_index = spectrum_row(row, y_length);
                let sign = image_sign(row, y_length, component);
                for (column, (re, im)) in re.iter_mut().zip(im).enumerate() {
                    let value = self.spectra[column * y_length + spectrum_index];
                    *re = sign * value.re;
                    *im = sign * value.im;
                }
            }
            return;
        }
        self.transform(0);
        for (value, (re, im)) in self.spectrum.iter().zip(re.iter_mut().zip(im)) {
            *re = value.re;
            *im = value.im;
        }
    }

    /// Transforms real and imaginary parts back to one mean per element.
    pub(super) fn inverse(&mut self, component: usize, re: &[f64], im: &[f64], values: &mut [f64]) {
        let length = self.lengths[0];
        let y_length = self.lengths[1];
        let column_count = self.spectrum.len();
        if y_length > 1 {
            for (row, (re, im)) in
                re.chunks_exact(column_count).zip(im.chunks_exact(column_count)).enumerate()
            {
                let spectrum_index = spectrum_row(row, y_length);
                let sign = image_sign(row, y_length, component);
                for (column, (re, im)) in re.iter().zip(im).enumerate() {
                    self.spectra[column * y_length + spectrum_index] =
                        Complex::new(sign * re, sign * im);
                }
            }
            self.y_transforms[1].process_with_scratch(&mut self.spectra, &mut self.scratch);
        } else {
            for (value, (re, im)) in self.spectrum.iter_mut().zip(re.iter().zip(im)) {
                *value = Complex::new(*re, *im);
            }
        }
        let Self { inverse, real, spectrum, spectra, scratch, .. } = self;
        let scratch = &mut scratch[..inverse.get_scratch_len()];
        for (row, real) in real.chunks_exact_mut(length).enumerate() {
            if y_length > 1 {
                for (value, column) in spectrum.iter_mut().zip(spectra.chunks_exact(y_length)) {
                    *value = column[row];
                }
            }
            // These values are real up to rounding; the inverse transform requires exact zeros. S is even.
            (spectrum[0].im, spectrum[length / 2].im) = (0.0, 0.0);
            let result = inverse.process_with_scratch(spectrum, real, scratch);
            debug_assert!(result.is_ok());
        }
        let scale = self.scale / (length * y_length) as f64;
        for (&cell, value) in self.cells.iter().zip(values) {
            *value = scale * self.real[cell];
        }
    }

    /// Calls `accept` with ĝ of lag d + 1 for d = 0 … `lag_count` − 1, zero for d = 0.
    ///
    /// Its arguments are the kind, d, and one slice over the wavenumbers. The coupling of strips is omitted from
    /// d = `coupled_lags` on.
    pub(super) fn coefficients(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        lag_count: usize,
        coupled_lags: usize,
        mut accept: impl FnMut(usize, usize, &[f64]) -> Result<()>,
    ) -> Result<()> {
        if let Offsets::Plan(lattice) = &self.offsets {
            return coefficients_in_plan(lattice, self.lengths, kernel, lag_count, accept);
        }
        let Offsets::Strip(classes) = &self.offsets else { return Ok(()) };
        let classes = classes.clone();
        let offset_count = classes.len();
        let length = self.lengths[0];
        let mut tables: [_; STRIP_KINDS] =
            std::array::from_fn(|_| vec![0.0; LAGS_PER_CHUNK.min(lag_count) * offset_count]);
        let mut values = vec![0.0; self.waves().count];
        for chunk_start in (0..lag_count).step_by(LAGS_PER_CHUNK) {
            let chunk_lags = LAGS_PER_CHUNK.min(lag_count - chunk_start);
            // The first weight is the step compliance, which does not belong to the history.
            let skipped_lags = usize::from(chunk_start == 0);
            for (offset, class) in classes.iter().enumerate() {
                let Some(class) = class else { continue };
                let range = offset * chunk_lags + skipped_lags..(offset + 1) * chunk_lags;
                let mut slices = tables.each_mut().map(|values| &mut values[range.clone()]);
                kernel.coefficients(*class, chunk_start + skipped_lags + 1, &mut slices)?;
            }
            for d in chunk_start + skipped_lags..chunk_start + chunk_lags {
                for (kind, table) in tables.iter().enumerate() {
                    let is_odd = kind == COUPLING_KIND;
                    if is_odd && d >= coupled_lags {
                        continue;
                    }
                    self.real.fill(0.0);
                    for offset in 0..offset_count {
                        let value = table[offset * chunk_lags + d - chunk_start];
                        self.real[offset] = if is_odd && offset == 0 { 0.0 } else { value };
                        if offset > 0 {
                            self.real[length - offset] = if is_odd { -value } else { value };
                        }
                    }
                    self.transform(0);
                    for (value, spectrum) in values.iter_mut().zip(&self.spectrum) {
                        *value = if is_odd { spectrum.im } else { spectrum.re };
                    }
                    accept(kind, d, &values)?;
                }
            }
        }
        Ok(())
    }
}

/// Index of a row of wavenumbers among the S along y.
///
/// The rows with spectra come first, then their images (kx, −ky), beginning with the first row that has an image.
fn spectrum_row(row: usize, y_length: usize) -> usize {
    let rows_with_spectra = y_length / 2 + 1;
    if row < rows_with_spectra { row } else { y_length - (row - rows_with_spectra + 1) }
}

/// Sign of a component in a row of wavenumbers: −1 for the component along y in an image.
fn image_sign(row: usize, y_length: usize, component: usize) -> f64 {
    if row > y_length / 2 && component == COMPONENTS_IN_SPACE - 1 { -1.0 } else { 1.0 }
}
