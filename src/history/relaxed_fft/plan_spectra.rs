//! Transforms of coefficients in plan along the surface, by cosines and sines.

use crate::error::Result;
use crate::geometry::{COMPLIANCES_PER_OFFSET, Lattice};
use crate::history::convolution_weights::ConvolutionWeights;
use crate::linalg::{add_combined_rows, next_smooth_even};

/// Counts of wavenumbers: those with spectra, and their mirror images.
#[derive(Clone, Copy)]
pub(super) struct WaveNumbers {
    /// Number of all wavenumbers.
    pub(super) count: usize,
    /// Number of wavenumbers with spectra, which come first.
    pub(super) with_spectra: usize,
    /// First wavenumber that has an image.
    pub(super) first_mirrored: usize,
}

impl WaveNumbers {
    /// Index of the spectrum of a wavenumber.
    pub(super) fn spectrum(self, wave: usize) -> usize {
        if wave < self.with_spectra {
            wave
        } else {
            wave - self.with_spectra + self.first_mirrored
        }
    }

    /// Ranges of wavenumbers, and the index of the first spectrum of each range.
    pub(super) fn ranges(self) -> [(std::ops::Range<usize>, usize); 2] {
        [(0..self.with_spectra, 0), (self.with_spectra..self.count, self.first_mirrored)]
    }
}

/// Number of lags evaluated together, so that their tables stay small.
pub(super) const LAGS_PER_CHUNK: usize = 512;

/// Numbers of wavenumbers of a lattice in plan.
pub(crate) fn waves_in_plan(lattice: &Lattice) -> WaveNumbers {
    let lengths = lattice.counts.map(|count| next_smooth_even(2 * count - 1));
    let columns = lengths[0] / 2 + 1;
    WaveNumbers {
        count: columns * lengths[1],
        with_spectra: columns * (lengths[1] / 2 + 1),
        first_mirrored: columns,
    }
}

/// Computes [`ElementGrid::coefficients`](super::element_grid::ElementGrid::coefficients) in plan.
///
/// Because the coefficients are even or odd along x and y, the transforms are products with cosines or sines.
pub(super) fn coefficients_in_plan(
    lattice: &Lattice,
    lengths: [usize; 2],
    kernel: &dyn ConvolutionWeights,
    lag_count: usize,
    mut accept: impl FnMut(usize, usize, &[f64]) -> Result<()>,
) -> Result<()> {
    let [columns, rows] = lattice.counts;
    let spectrum_counts = lengths.map(|length| length / 2 + 1);
    let axis_factors = [0, 1].map(|axis| cosines_and_sines(lattice.counts[axis], lengths[axis]));
    let max_chunk_lags = LAGS_PER_CHUNK.min(lag_count);
    let mut tables =
        [(); COMPLIANCES_PER_OFFSET].map(|()| vec![0.0; columns * rows * max_chunk_lags]);
    let mut lags = [(); COMPLIANCES_PER_OFFSET].map(|()| vec![0.0; max_chunk_lags]);
    let mut values = vec![0.0; spectrum_counts[0] * spectrum_counts[1]];
    let mut transformed_along_x = vec![0.0; spectrum_counts[0] * rows * max_chunk_lags];
    let mut transformed = vec![0.0; spectrum_counts[0] * spectrum_counts[1] * max_chunk_lags];
    for chunk_start in (0..lag_count).step_by(LAGS_PER_CHUNK) {
        let chunk_lags = LAGS_PER_CHUNK.min(lag_count - chunk_start);
        // The first weight is the step compliance, which does not belong to the history.
        let skipped_lags = usize::from(chunk_start == 0);
        let mut slices = lags.each_mut().map(|lags| &mut lags[..chunk_lags]);
        read_tables(lattice, kernel, chunk_start, skipped_lags, &mut slices, &mut tables)?;
        for (kind, table) in tables.iter().enumerate() {
            let is_odd = [matches!(kind, 3 | 4), matches!(kind, 3 | 5)];
            let x_factors = &axis_factors[0][usize::from(is_odd[0])];
            let y_factors = &axis_factors[1][usize::from(is_odd[1])];
            let transformed_along_x =
                &mut transformed_along_x[..spectrum_counts[0] * rows * chunk_lags];
            let transformed =
                &mut transformed[..spectrum_counts[0] * spectrum_counts[1] * chunk_lags];
            transformed_along_x.fill(0.0);
            transformed.fill(0.0);
            add_combined_rows(
                x_factors,
                &table[..columns * rows * chunk_lags],
                rows * chunk_lags,
                1.0,
                transformed_along_x,
            );
            // A kind that is odd along both axes has the factor i².
            let sign = if is_odd == [true; 2] { -1.0 } else { 1.0 };
            let x_spectra = transformed_along_x.chunks_exact(rows * chunk_lags);
            for (x_spectrum, sums) in
                x_spectra.zip(transformed.chunks_exact_mut(spectrum_counts[1] * chunk_lags))
            {
                add_combined_rows(y_factors, x_spectrum, chunk_lags, sign, sums);
            }
            for d in skipped_lags..chunk_lags {
                for (wave, value) in values.iter_mut().enumerate() {
                    let row = wave / spectrum_counts[0];
                    let column = wave % spectrum_counts[0];
                    *value = transformed[(column * spectrum_counts[1] + row) * chunk_lags + d];
                }
                accept(kind, chunk_start + d, &values)?;
            }
        }
    }
    Ok(())
}

/// Overwrites `tables`, kind by kind, with the lags from `chunk_start` + 1 on of all offsets.
///
/// `lags` is scratch for as many lags. The first `skipped_lags` lags are left as they are in `lags`.
fn read_tables(
    lattice: &Lattice,
    kernel: &dyn ConvolutionWeights,
    chunk_start: usize,
    skipped_lags: usize,
    lags: &mut [&mut [f64]; COMPLIANCES_PER_OFFSET],
    tables: &mut [Vec<f64>; COMPLIANCES_PER_OFFSET],
) -> Result<()> {
    let [columns, rows] = lattice.counts;
    let chunk_lags = lags[0].len();
    for offset in (0..columns).flat_map(|i| (0..rows).map(move |j| [i, j])) {
        let (class, terms) = lattice.compliance_terms(offset.map(usize::cast_signed));
        let mut slices = lags.each_mut().map(|lags| &mut lags[skipped_lags..]);
        kernel.coefficients(class, chunk_start + skipped_lags + 1, &mut slices)?;
        let [[zz, zx, zy], [_, xx, xy], [_, _, yy]] = terms;
        for (table, (kind, _)) in tables.iter_mut().zip([zz, xx, yy, xy, zx, zy]) {
            let table_start = (offset[0] * rows + offset[1]) * chunk_lags;
            table[table_start..table_start + chunk_lags].copy_from_slice(lags[kind]);
        }
    }
    Ok(())
}

/// Factors of the transforms of an even and of an odd function, for each offset and wavenumber.
///
/// A factor includes both signs of the offset. The transform of the odd function is divided by i.
fn cosines_and_sines(offset_count: usize, length: usize) -> [Vec<f64>; 2] {
    let unit_angle = std::f64::consts::TAU / length as f64;
    let mut cosines = Vec::with_capacity(offset_count * (length / 2 + 1));
    let mut sines = Vec::with_capacity(offset_count * (length / 2 + 1));
    for offset in 0..offset_count {
        for k in 0..=length / 2 {
            let angle = unit_angle * (offset * k % length) as f64;
            cosines.push(if offset == 0 { 1.0 } else { 2.0 * angle.cos() });
            sines.push(if offset == 0 { 0.0 } else { -2.0 * angle.sin() });
        }
    }
    [cosines, sines]
}
