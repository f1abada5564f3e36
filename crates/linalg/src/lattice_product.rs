//! Products with matrices that depend only on the offset between cells of a lattice.
//!
//! | symbol | meaning |
//! |---|---|
//! | S | lengths of the transform: along each axis of n cells at least 2n − 1, so that no product wraps around |
//! | k | wavenumbers: 0 … S/2 along x, 0 … S − 1 along y |
//! | ĝ | Fourier transform of the blocks over the offset: a Hermitian 3 × 3 matrix at each k |

use std::sync::Arc;

use basemat_fourier::num_complex::Complex;
use basemat_fourier::{ComplexPlanner, Fft};
use basemat_fourier::{ComplexToReal, RealPlanner, RealToComplex};

/// Largest difference of blocks of equal offset, relative to the largest entry.
///
/// It is above rounding errors of an integral.
const OFFSET_BLOCK_TOLERANCE: f64 = 1e-14;

/// Matrix of 3 × 3 blocks between cells, times a factor of each source.
///
/// Cells of equal offset have equal blocks.
pub struct LatticeProduct {
    /// Column and row of each cell.
    cells: Vec<[usize; 2]>,
    /// Index of each cell in the padded lattice: row by row, S along x.
    lattice_indices: Vec<usize>,
    /// Factor of each source cell.
    source_factors: Vec<f64>,
    /// S along x and y.
    transform_lengths: [usize; 2],
    /// Number of rows of the lattice with cells.
    row_count: usize,
    x_transform: XTransform,
    /// Forward and inverse transform along y.
    y_transforms: [Arc<dyn Fft<f64>>; 2],
    /// ĝ at each k: for each k along x, all along y.
    spectra: Vec<BlockSpectrum>,
}

/// Transforms of real rows along x.
struct XTransform {
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
}

/// Hermitian matrix ĝ at one wavenumber.
struct BlockSpectrum {
    diagonal: [f64; 3],
    /// Entries (0, 1), (0, 2) and (1, 2).
    off_diagonal: [Complex<f64>; 3],
}

short_debug! { LatticeProduct; self; lengths: self.transform_lengths }

/// Memory for intermediate results of a product.
#[derive(Debug, Clone, Default)]
pub struct LatticeScratch {
    /// Values of one component on the lattice, row by row.
    lattice_values: Vec<f64>,
    /// Transform of one row along x.
    row_spectrum: Vec<Complex<f64>>,
    /// Three components, one after the other: for each k along x, all along y.
    spectra: Vec<Complex<f64>>,
    fft_scratch: Vec<Complex<f64>>,
}

impl LatticeProduct {
    /// Matrix with blocks `block(receiver, source)` times `factors[source]`, for `cells` (column and row).
    ///
    /// `None` unless blocks of equal offset are equal and the matrix of the blocks is symmetric.
    pub fn new(
        cells: &[[usize; 2]],
        factors: &[f64],
        block: impl Fn(usize, usize) -> [[f64; 3]; 3],
    ) -> Option<Self> {
        let cell_counts =
            [0, 1].map(|axis| cells.iter().fold(0, |largest, cell| largest.max(cell[axis] + 1)));
        let transform_lengths = cell_counts.map(|count| next_smooth_even(2 * count - 1));
        let OffsetBlocks { blocks, max_entry } =
            OffsetBlocks::new(cells, transform_lengths, block)?;
        let mut real_planner = RealPlanner::new();
        let mut complex_planner = ComplexPlanner::new();
        let [x_length, y_length] = transform_lengths;
        let mut product = Self {
            cells: cells.to_vec(),
            lattice_indices: cells.iter().map(|[i, j]| j * x_length + i).collect(),
            source_factors: factors.to_vec(),
            transform_lengths,
            row_count: cell_counts[1],
            x_transform: XTransform {
                forward: real_planner.plan_fft_forward(x_length),
                inverse: real_planner.plan_fft_inverse(x_length),
            },
            y_transforms: [
                complex_planner.plan_fft_forward(y_length),
                complex_planner.plan_fft_inverse(y_length),
            ],
            spectra: vec![],
        };
        product.transform_blocks(&blocks, OFFSET_BLOCK_TOLERANCE * max_entry)?;
        Some(product)
    }

    /// Transforms the blocks of all offsets to ĝ.
    ///
    /// `None` if the matrix of the blocks is not symmetric.
    ///
    /// `tolerance`: largest rounding error of a block's entry.
    fn transform_blocks(&mut self, blocks: &[Option<[[f64; 3]; 3]>], tolerance: f64) -> Option<()> {
        let [x_length, y_length] = self.transform_lengths;
        let column_count = x_length / 2 + 1;
        let mut scratch = self.scratch();
        let mut entries = [[(); 3]; 3].map(|row| row.map(|()| vec![]));
        for (r, entry_row) in entries.iter_mut().enumerate() {
            for (c, spectrum) in entry_row.iter_mut().enumerate() {
                let mut values: Vec<f64> =
                    blocks.iter().map(|block| block.map_or(0.0, |block| block[r][c])).collect();
                *spectrum = vec![Complex::default(); column_count * y_length];
                for (j, lattice_row) in values.chunks_exact_mut(x_length).enumerate() {
                    self.x_transform
                        .forward
                        .process(lattice_row, &mut scratch.row_spectrum)
                        .ok()?;
                    for (column, value) in scratch.row_spectrum.iter().enumerate() {
                        spectrum[column * y_length + j] = *value;
                    }
                }
                self.y_transforms[0].process(spectrum);
            }
        }
        let spectrum_tolerance = tolerance * (x_length * y_length) as f64;
        let scale = 1.0 / (x_length * y_length) as f64;
        for k in 0..column_count * y_length {
            for (r, c) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
                let difference = (entries[r][c][k] - entries[c][r][k].conj()).norm();
                if difference.is_nan() || difference > spectrum_tolerance {
                    return None;
                }
            }
            self.spectra.push(BlockSpectrum {
                diagonal: [0, 1, 2].map(|r| scale * entries[r][r][k].re),
                off_diagonal: [(0, 1), (0, 2), (1, 2)].map(|(r, c)| entries[r][c][k] * scale),
            });
        }
        Some(())
    }

    /// Column and row of each cell.
    pub fn cells(&self) -> &[[usize; 2]] {
        &self.cells
    }

    /// Scratch for products with this matrix.
    pub fn scratch(&self) -> LatticeScratch {
        let [x_length, y_length] = self.transform_lengths;
        let column_count = x_length / 2 + 1;
        let y_scratch_len = self
            .y_transforms
            .iter()
            .map(|plan| plan.get_inplace_scratch_len())
            .fold(0, usize::max);
        let XTransform { forward, inverse } = &self.x_transform;
        let scratch_len =
            y_scratch_len.max(forward.get_scratch_len()).max(inverse.get_scratch_len());
        LatticeScratch {
            lattice_values: vec![0.0; x_length * self.row_count],
            row_spectrum: vec![Complex::default(); column_count],
            spectra: vec![Complex::default(); 3 * column_count * y_length],
            fft_scratch: vec![Complex::default(); scratch_len],
        }
    }

    /// Product of the matrix and `x`: calls `write(component, cell, value)` for each value.
    ///
    /// `x`: component by component, each over all cells.
    pub fn multiply(
        &self,
        x: &[f64],
        scratch: &mut LatticeScratch,
        mut write: impl FnMut(usize, usize, f64),
    ) {
        let [x_length, y_length] = self.transform_lengths;
        let LatticeScratch { lattice_values, row_spectrum, spectra, fft_scratch } = scratch;
        let column_count = row_spectrum.len();
        let wavenumber_count = column_count * y_length;
        let XTransform { forward, inverse } = &self.x_transform;
        let components = x.chunks_exact(self.cells.len());
        for (spectrum, x) in spectra.chunks_exact_mut(wavenumber_count).zip(components) {
            lattice_values.fill(0.0);
            for ((index, factor), x) in self.lattice_indices.iter().zip(&self.source_factors).zip(x)
            {
                lattice_values[*index] = factor * x;
            }
            for (j, values) in lattice_values.chunks_exact_mut(x_length).enumerate() {
                let scratch = &mut fft_scratch[..forward.get_scratch_len()];
                let result = forward.process_with_scratch(values, row_spectrum, scratch);
                debug_assert!(result.is_ok());
                for (column, value) in spectrum.chunks_exact_mut(y_length).zip(&*row_spectrum) {
                    column[j] = *value;
                }
            }
            for column in spectrum.chunks_exact_mut(y_length) {
                column[self.row_count..].fill(Complex::default());
            }
        }
        self.y_transforms[0].process_with_scratch(spectra, fft_scratch);
        self.multiply_spectra(spectra);
        self.y_transforms[1].process_with_scratch(spectra, fft_scratch);
        for (component, spectrum) in spectra.chunks_exact(wavenumber_count).enumerate() {
            for (j, values) in lattice_values.chunks_exact_mut(x_length).enumerate() {
                for (value, column) in row_spectrum.iter_mut().zip(spectrum.chunks_exact(y_length))
                {
                    *value = column[j];
                }
                // The first and, as S is even, the last value are real up to rounding errors. The inverse transform
                // requires imaginary parts of exactly zero.
                row_spectrum[0].im = 0.0;
                row_spectrum[column_count - 1].im = 0.0;
                let scratch = &mut fft_scratch[..inverse.get_scratch_len()];
                let result = inverse.process_with_scratch(row_spectrum, values, scratch);
                debug_assert!(result.is_ok());
            }
            for (cell, index) in self.lattice_indices.iter().enumerate() {
                write(component, cell, lattice_values[*index]);
            }
        }
    }

    /// Overwrites the spectra of the three components with their products by ĝ.
    fn multiply_spectra(&self, spectra: &mut [Complex<f64>]) {
        let mut components = spectra.chunks_exact_mut(self.spectra.len());
        let z = components.next().unwrap_or_default();
        let x = components.next().unwrap_or_default();
        let y = components.next().unwrap_or_default();
        for (((z, x), y), spectrum) in z.iter_mut().zip(x).zip(y).zip(&self.spectra) {
            let BlockSpectrum { diagonal, off_diagonal: [zx, zy, xy] } = spectrum;
            let products = [
                *z * diagonal[0] + zx * *x + zy * *y,
                zx.conj() * *z + *x * diagonal[1] + xy * *y,
                zy.conj() * *z + xy.conj() * *x + *y * diagonal[2],
            ];
            [*z, *x, *y] = products;
        }
    }
}

/// Blocks of all offsets between cells.
struct OffsetBlocks {
    /// The block of each offset on the padded lattice, row by row.
    ///
    /// `None` for an offset that does not occur.
    blocks: Vec<Option<[[f64; 3]; 3]>>,
    /// Largest magnitude of an entry.
    max_entry: f64,
}

impl OffsetBlocks {
    /// Collects the blocks of all pairs of cells.
    ///
    /// `None` if blocks of equal offset differ.
    fn new(
        cells: &[[usize; 2]],
        [x_length, y_length]: [usize; 2],
        block: impl Fn(usize, usize) -> [[f64; 3]; 3],
    ) -> Option<Self> {
        let mut blocks: Vec<Option<[[f64; 3]; 3]>> = vec![None; x_length * y_length];
        let mut max_entry = 0.0_f64;
        let mut max_difference = 0.0_f64;
        for (receiver, receiver_cell) in cells.iter().enumerate() {
            for (source, source_cell) in cells.iter().enumerate() {
                let pair_block = block(receiver, source);
                let column = (x_length + receiver_cell[0] - source_cell[0]) % x_length;
                let row = (y_length + receiver_cell[1] - source_cell[1]) % y_length;
                let first_block = blocks[row * x_length + column].get_or_insert(pair_block);
                for (a, b) in pair_block.as_flattened().iter().zip(first_block.as_flattened()) {
                    max_entry = max_entry.max(a.abs());
                    max_difference = max_difference.max((a - b).abs());
                }
            }
        }
        let differs =
            max_difference.is_nan() || max_difference > OFFSET_BLOCK_TOLERANCE * max_entry;
        (!differs).then_some(Self { blocks, max_entry })
    }
}

/// Smallest even number that is at least `minimum` and has no prime factor above 5.
pub fn next_smooth_even(minimum: usize) -> usize {
    let mut length = minimum.max(2).next_multiple_of(2);
    while !is_smooth(length) {
        length += 2;
    }
    length
}

/// Whether a number has no prime factor above 5.
fn is_smooth(mut number: usize) -> bool {
    for factor in [2, 3, 5] {
        while number.is_multiple_of(factor) {
            number /= factor;
        }
    }
    number == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use basemat_testkit::random::Random;

    /// Block for an offset without any symmetry, which decreases with the distance.
    fn block(receiver_cell: [usize; 2], source_cell: [usize; 2]) -> [[f64; 3]; 3] {
        let x = receiver_cell[0] as f64 - source_cell[0] as f64;
        let y = receiver_cell[1] as f64 - source_cell[1] as f64;
        let decay = (-0.3 * x.hypot(y)).exp();
        let zx = decay * (0.3 * x - 0.1 * y + 0.2 * x * y);
        let zy = decay * (0.0 * x + 0.4 * y + 0.2 * x * y);
        let xy = decay * 0.1;
        [[decay, zx, zy], [-zx + 0.4 * decay * x * y, 0.8 * decay, xy], [zy, xy, 1.3 * decay]]
    }

    #[test]
    fn products_are_sums_over_all_pairs() {
        let mut random = Random(1);
        // An L of 7 × 5 cells.
        let cells: Vec<[usize; 2]> = (0..7)
            .flat_map(|i| (0..5).map(move |j| [i, j]))
            .filter(|[i, j]| *i < 4 || *j < 2)
            .collect();
        let count = cells.len();
        // B(o) = A(o) + A(−o)ᵀ.
        let symmetric_block = |r: usize, s: usize| {
            let forward = block(cells[r], cells[s]);
            let backward = block(cells[s], cells[r]);
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| forward[i][j] + backward[j][i]))
        };
        let factors: Vec<f64> = (0..count).map(|_| random.within(0.5, 1.5)).collect();
        let product = LatticeProduct::new(&cells, &factors, symmetric_block).unwrap();
        let mut scratch = product.scratch();
        for _ in 0..2 {
            let x: Vec<f64> = (0..3 * count).map(|_| random.within(-1.0, 1.0)).collect();
            let mut products = vec![0.0; 3 * count];
            product.multiply(&x, &mut scratch, |k, e, value| products[k * count + e] += value);
            for (i, computed) in products.iter().enumerate() {
                let mut sum = 0.0;
                for (j, x) in x.iter().enumerate() {
                    let block = symmetric_block(i % count, j % count);
                    sum += block[i / count][j / count] * factors[j % count] * x;
                }
                assert!((computed - sum).abs() < 1e-12, "{i}: {computed} {sum}");
            }
        }
    }

    #[test]
    fn unequal_or_unsymmetric_blocks_are_rejected() {
        let cells: Vec<[usize; 2]> = (0..9).map(|e| [e % 3, e / 3]).collect();
        let isotropic_block = |r: usize, s: usize| {
            let distance =
                (cells[r][0].abs_diff(cells[s][0]) + cells[r][1].abs_diff(cells[s][1])) as f64;
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { 1.0 / (1.0 + distance) } else { 0.0 }))
        };
        let factors = [1.0; 9];
        assert!(LatticeProduct::new(&cells, &factors, isotropic_block).is_some());
        // The blocks of one receiver differ.
        let unequal_block = |r: usize, s: usize| {
            isotropic_block(r, s).map(|row| row.map(|v| if r == 4 { 1.001 * v } else { v }))
        };
        assert!(LatticeProduct::new(&cells, &factors, unequal_block).is_none());
        let unsymmetric_block = |r: usize, s: usize| {
            let mut block = isotropic_block(r, s);
            block[0][1] = 0.1;
            block
        };
        assert!(LatticeProduct::new(&cells, &factors, unsymmetric_block).is_none());
    }
}
