//! Products with matrices that depend on the offset between cells of a lattice alone.
//!
//! | symbol | meaning |
//! |---|---|
//! | S | lengths of the transform, along each axis at least two patches less one: nothing wraps around |
//! | k | wavenumbers: 0 … S/2 along x; all along y |
//! | ĝ | 𝓕 of the blocks over the offset, a Hermitian 3 × 3 matrix at each k |

use std::sync::Arc;

use basemat_fourier::num_complex::Complex;
use basemat_fourier::{ComplexPlanner, Fft};
use basemat_fourier::{ComplexToReal, RealPlanner, RealToComplex};

/// Largest difference of blocks of equal offset, relative to the largest entry.
const OFFSET_BLOCK_TOLERANCE: f64 = 1e-14;

/// Symmetric matrix of 3 × 3 blocks, one for each pair of cells, equal for equal offsets.
pub struct LatticeProduct {
    /// Column and row of each cell, and its place: row by row, S along x.
    cells: Vec<[usize; 2]>,
    places: Vec<usize>,
    /// Factor of each source.
    factors: Vec<f64>,
    /// S along x and y; number of rows that hold cells.
    lengths: [usize; 2],
    rows: usize,
    along: (Arc<dyn RealToComplex<f64>>, Arc<dyn ComplexToReal<f64>>),
    across: [Arc<dyn Fft<f64>>; 2],
    /// ĝ at each k: its diagonal, then its entries (0, 1), (0, 2), (1, 2).
    ///
    /// For each k along x all along y.
    spectra: Vec<([f64; 3], [Complex<f64>; 3])>,
}

short_debug! { LatticeProduct; self; lengths: self.lengths }

/// Scratch of a product.
#[derive(Debug, Clone, Default)]
pub struct LatticeScratch {
    real: Vec<f64>,
    row: Vec<Complex<f64>>,
    /// Three components, one after the other: for each k along x all along y.
    waves: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
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
        let counts =
            [0, 1].map(|axis| cells.iter().fold(0, |largest, cell| largest.max(cell[axis] + 1)));
        let lengths = counts.map(|count| next_smooth_even(2 * count - 1));
        let length = lengths[0];
        let across = lengths[1];
        let mut blocks: Vec<Option<[[f64; 3]; 3]>> = vec![None; length * across];
        let mut largest = 0.0_f64;
        let mut max_difference = 0.0_f64;
        for (receiver, to) in cells.iter().enumerate() {
            for (source, from) in cells.iter().enumerate() {
                let offset_block = block(receiver, source);
                let column = (length + to[0] - from[0]) % length;
                let row = (across + to[1] - from[1]) % across;
                let first_block = blocks[row * length + column].get_or_insert(offset_block);
                for (a, b) in offset_block.as_flattened().iter().zip(first_block.as_flattened()) {
                    largest = largest.max(a.abs());
                    max_difference = max_difference.max((a - b).abs());
                }
            }
        }
        if max_difference.is_nan() || max_difference > OFFSET_BLOCK_TOLERANCE * largest {
            return None;
        }
        let mut real = RealPlanner::new();
        let mut complex = ComplexPlanner::new();
        let mut product = Self {
            cells: cells.to_vec(),
            places: cells.iter().map(|[i, j]| j * length + i).collect(),
            factors: factors.to_vec(),
            lengths,
            rows: counts[1],
            along: (real.plan_fft_forward(length), real.plan_fft_inverse(length)),
            across: [complex.plan_fft_forward(across), complex.plan_fft_inverse(across)],
            spectra: vec![],
        };
        product.find_spectra(&blocks, OFFSET_BLOCK_TOLERANCE * largest)?;
        Some(product)
    }

    /// Transforms the blocks of all offsets; `None` if the matrix is not symmetric.
    fn find_spectra(&mut self, blocks: &[Option<[[f64; 3]; 3]>], rounding: f64) -> Option<()> {
        let length = self.lengths[0];
        let across = self.lengths[1];
        let columns = length / 2 + 1;
        let mut scratch = self.scratch();
        let mut entries = [[(); 3]; 3].map(|row| row.map(|()| vec![]));
        for (r, row) in entries.iter_mut().enumerate() {
            for (c, waves) in row.iter_mut().enumerate() {
                let mut values: Vec<f64> =
                    blocks.iter().map(|block| block.map_or(0.0, |block| block[r][c])).collect();
                *waves = vec![Complex::default(); columns * across];
                for (j, row) in values.chunks_exact_mut(length).enumerate() {
                    self.along.0.process(row, &mut scratch.row).ok()?;
                    for (column, value) in scratch.row.iter().enumerate() {
                        waves[column * across + j] = *value;
                    }
                }
                self.across[0].process(waves);
            }
        }
        let rounding = rounding * (length * across) as f64;
        let scale = 1.0 / (length * across) as f64;
        for k in 0..columns * across {
            for (r, c) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
                let difference = (entries[r][c][k] - entries[c][r][k].conj()).norm();
                if difference.is_nan() || difference > rounding {
                    return None;
                }
            }
            let diagonal = [0, 1, 2].map(|r| scale * entries[r][r][k].re);
            let others = [(0, 1), (0, 2), (1, 2)].map(|(r, c)| entries[r][c][k] * scale);
            self.spectra.push((diagonal, others));
        }
        Some(())
    }

    /// Column and row of each cell.
    pub fn cells(&self) -> &[[usize; 2]] {
        &self.cells
    }

    /// Scratch for products with this matrix.
    pub fn scratch(&self) -> LatticeScratch {
        let length = self.lengths[0];
        let across = self.lengths[1];
        let columns = length / 2 + 1;
        let scratch_len =
            self.across.iter().map(|plan| plan.get_inplace_scratch_len()).fold(0, usize::max);
        let scratch_len =
            scratch_len.max(self.along.0.get_scratch_len()).max(self.along.1.get_scratch_len());
        LatticeScratch {
            real: vec![0.0; length * self.rows],
            row: vec![Complex::default(); columns],
            waves: vec![Complex::default(); 3 * columns * across],
            scratch: vec![Complex::default(); scratch_len],
        }
    }

    /// Calls `write(component, cell, value)` with the product of the matrix and `x`.
    ///
    /// `x`: component by component, each over all cells.
    pub fn multiply(
        &self,
        x: &[f64],
        scratch: &mut LatticeScratch,
        mut write: impl FnMut(usize, usize, f64),
    ) {
        let length = self.lengths[0];
        let across = self.lengths[1];
        let LatticeScratch { real, row, waves, scratch } = scratch;
        let columns = row.len();
        let count = self.places.len();
        let wave_count = columns * across;
        let forward = &self.along.0;
        let inverse = &self.along.1;
        for (spectrum, x) in waves.chunks_exact_mut(wave_count).zip(x.chunks_exact(count)) {
            real.fill(0.0);
            for ((place, factor), x) in self.places.iter().zip(&self.factors).zip(x) {
                real[*place] = factor * x;
            }
            for (j, values) in real.chunks_exact_mut(length).enumerate() {
                let scratch = &mut scratch[..forward.get_scratch_len()];
                let done = forward.process_with_scratch(values, row, scratch);
                debug_assert!(done.is_ok());
                for (column, value) in spectrum.chunks_exact_mut(across).zip(&*row) {
                    column[j] = *value;
                }
            }
            for column in spectrum.chunks_exact_mut(across) {
                column[self.rows..].fill(Complex::default());
            }
        }
        self.across[0].process_with_scratch(waves, scratch);
        let mut components = waves.chunks_exact_mut(wave_count);
        let p = components.next().unwrap_or_default();
        let x = components.next().unwrap_or_default();
        let y = components.next().unwrap_or_default();
        for (((p, x), y), (diagonal, [a, b, c])) in p.iter_mut().zip(x).zip(y).zip(&self.spectra) {
            let sums = [
                *p * diagonal[0] + a * *x + b * *y,
                a.conj() * *p + *x * diagonal[1] + c * *y,
                b.conj() * *p + c.conj() * *x + *y * diagonal[2],
            ];
            [*p, *x, *y] = sums;
        }
        self.across[1].process_with_scratch(waves, scratch);
        for (component, spectrum) in waves.chunks_exact(wave_count).enumerate() {
            for (j, values) in real.chunks_exact_mut(length).enumerate() {
                for (value, column) in row.iter_mut().zip(spectrum.chunks_exact(across)) {
                    *value = column[j];
                }
                // These values are real up to rounding; the inverse transform requires exact zeros. S is even.
                (row[0].im, row[columns - 1].im) = (0.0, 0.0);
                let scratch = &mut scratch[..inverse.get_scratch_len()];
                let done = inverse.process_with_scratch(row, values, scratch);
                debug_assert!(done.is_ok());
            }
            for (e, place) in self.places.iter().enumerate() {
                write(component, e, real[*place]);
            }
        }
    }
}

/// The smallest even number of at least `minimum` with no prime factor above 5.
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

    /// Symmetric block for an offset, without any other symmetry.
    fn block(to: [usize; 2], from: [usize; 2]) -> [[f64; 3]; 3] {
        let x = to[0] as f64 - from[0] as f64;
        let y = to[1] as f64 - from[1] as f64;
        let far = (-0.3 * x.hypot(y)).exp();
        let zx = far * (0.3 * x - 0.1 * y + 0.2 * x * y);
        let zy = far * (0.0 * x + 0.4 * y + 0.2 * x * y);
        let xy = far * 0.1;
        [[far, zx, zy], [-zx + 0.4 * far * x * y, 0.8 * far, xy], [zy, xy, 1.3 * far]]
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
            let mut found = vec![0.0; 3 * count];
            product.multiply(&x, &mut scratch, |k, e, value| found[k * count + e] += value);
            for (i, found) in found.iter().enumerate() {
                let mut sum = 0.0;
                for (j, x) in x.iter().enumerate() {
                    let block = symmetric_block(i % count, j % count);
                    sum += block[i / count][j / count] * factors[j % count] * x;
                }
                assert!((found - sum).abs() < 1e-12, "{i}: {found} {sum}");
            }
        }
    }

    #[test]
    fn other_matrices_are_none() {
        let cells: Vec<[usize; 2]> = (0..9).map(|e| [e % 3, e / 3]).collect();
        let isotropic_block = |r: usize, s: usize| {
            let far =
                (cells[r][0].abs_diff(cells[s][0]) + cells[r][1].abs_diff(cells[s][1])) as f64;
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { 1.0 / (1.0 + far) } else { 0.0 }))
        };
        let factors = [1.0; 9];
        assert!(LatticeProduct::new(&cells, &factors, isotropic_block).is_some());
        // One block differs; or the matrix is not symmetric.
        let with_other_row = |r: usize, s: usize| {
            isotropic_block(r, s).map(|row| row.map(|v| if r == 4 { 1.001 * v } else { v }))
        };
        assert!(LatticeProduct::new(&cells, &factors, with_other_row).is_none());
        let unsymmetric = |r: usize, s: usize| {
            let mut block = isotropic_block(r, s);
            block[0][1] = 0.1;
            block
        };
        assert!(LatticeProduct::new(&cells, &factors, unsymmetric).is_none());
    }
}
