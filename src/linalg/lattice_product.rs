//! Products with matrices that depend on the offset between cells of a lattice alone.
//!
//! | symbol | meaning |
//! |---|---|
//! | S | lengths of the transform, along each axis at least two patches less one: nothing wraps around |
//! | k | wavenumbers: 0 … S/2 along x; all along y |
//! | ĝ | 𝓕 of the blocks over the offset, a Hermitian 3 × 3 matrix at each k |

use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};

/// Largest difference of blocks of equal offset, relative to the largest entry.
const EQUAL: f64 = 1e-14;

/// Symmetric matrix of 3 × 3 blocks, one for each pair of cells, equal for equal offsets.
pub(crate) struct LatticeProduct {
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
    /// For each k, columns of S along y: diagonal of ĝ, then its entries (0, 1), (0, 2), (1, 2).
    spectra: Vec<([f64; 3], [Complex<f64>; 3])>,
}

short_debug! { LatticeProduct; self; lengths: self.lengths }

/// Scratch of a product.
#[derive(Debug, Clone, Default)]
pub(crate) struct LatticeScratch {
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
    pub(crate) fn new(
        cells: &[[usize; 2]],
        factors: &[f64],
        block: impl Fn(usize, usize) -> [[f64; 3]; 3],
    ) -> Option<Self> {
        let counts = [0, 1].map(|axis| cells.iter().fold(0, |most, cell| most.max(cell[axis] + 1)));
        let lengths = counts.map(|count| smooth(2 * count - 1));
        let [length, across] = lengths;
        let mut blocks: Vec<Option<[[f64; 3]; 3]>> = vec![None; length * across];
        let (mut most, mut apart) = (0.0_f64, 0.0_f64);
        for (receiver, to) in cells.iter().enumerate() {
            for (source, from) in cells.iter().enumerate() {
                let own = block(receiver, source);
                let [i, j] =
                    [0, 1].map(|axis| (lengths[axis] + to[axis] - from[axis]) % lengths[axis]);
                let known = blocks[j * length + i].get_or_insert(own);
                for (a, b) in own.as_flattened().iter().zip(known.as_flattened()) {
                    most = most.max(a.abs());
                    apart = apart.max((a - b).abs());
                }
            }
        }
        if apart.is_nan() || apart > EQUAL * most {
            return None;
        }
        let mut real = RealFftPlanner::new();
        let mut complex = FftPlanner::new();
        let mut all = Self {
            cells: cells.to_vec(),
            places: cells.iter().map(|[i, j]| j * length + i).collect(),
            factors: factors.to_vec(),
            lengths,
            rows: counts[1],
            along: (real.plan_fft_forward(length), real.plan_fft_inverse(length)),
            across: [complex.plan_fft_forward(across), complex.plan_fft_inverse(across)],
            spectra: vec![],
        };
        all.find_spectra(&blocks, EQUAL * most)?;
        Some(all)
    }

    /// Transforms the blocks of all offsets; `None` if the matrix is not symmetric.
    fn find_spectra(&mut self, blocks: &[Option<[[f64; 3]; 3]>], rounding: f64) -> Option<()> {
        let [length, across] = self.lengths;
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
            let at = |r: usize, c: usize| entries[r][c][k];
            let unlike = |r: usize, c: usize| (at(r, c) - at(c, r).conj()).norm();
            if [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
                .iter()
                .any(|(r, c)| unlike(*r, *c).is_nan() || unlike(*r, *c) > rounding)
            {
                return None;
            }
            let own = [0, 1, 2].map(|r| scale * at(r, r).re);
            self.spectra.push((own, [(0, 1), (0, 2), (1, 2)].map(|(r, c)| at(r, c) * scale)));
        }
        Some(())
    }

    /// Column and row of each cell.
    pub(crate) fn cells(&self) -> &[[usize; 2]] {
        &self.cells
    }

    /// Scratch for products with this matrix.
    pub(crate) fn scratch(&self) -> LatticeScratch {
        let [length, across] = self.lengths;
        let columns = length / 2 + 1;
        let need =
            self.across.iter().map(|plan| plan.get_inplace_scratch_len()).fold(0, usize::max);
        let need = need.max(self.along.0.get_scratch_len()).max(self.along.1.get_scratch_len());
        LatticeScratch {
            real: vec![0.0; length * self.rows],
            row: vec![Complex::default(); columns],
            waves: vec![Complex::default(); 3 * columns * across],
            scratch: vec![Complex::default(); need],
        }
    }

    /// Calls `write` with the product of the matrix and `x`, component by component: place in `x`, and value.
    pub(crate) fn multiply(
        &self,
        x: &[f64],
        scratch: &mut LatticeScratch,
        mut write: impl FnMut(usize, usize, f64),
    ) {
        let [length, across] = self.lengths;
        let LatticeScratch { real, row, waves, scratch } = scratch;
        let columns = row.len();
        let (count, all) = (self.places.len(), columns * across);
        let (forward, inverse) = (&self.along.0, &self.along.1);
        for (own, x) in waves.chunks_exact_mut(all).zip(x.chunks_exact(count)) {
            real.fill(0.0);
            for ((place, factor), x) in self.places.iter().zip(&self.factors).zip(x) {
                real[*place] = factor * x;
            }
            for (j, values) in real.chunks_exact_mut(length).enumerate() {
                let scratch = &mut scratch[..forward.get_scratch_len()];
                let done = forward.process_with_scratch(values, row, scratch);
                debug_assert!(done.is_ok());
                for (own, value) in own.chunks_exact_mut(across).zip(&*row) {
                    own[j] = *value;
                }
            }
            own.chunks_exact_mut(across).for_each(|own| own[self.rows..].fill(Complex::default()));
        }
        self.across[0].process_with_scratch(waves, scratch);
        let (p, rest) = waves.split_at_mut(all);
        let (x, y) = rest.split_at_mut(all);
        for (((p, x), y), (own, others)) in p.iter_mut().zip(x).zip(y).zip(&self.spectra) {
            let [a, b, c] = others;
            let sums = [
                *p * own[0] + a * *x + b * *y,
                a.conj() * *p + *x * own[1] + c * *y,
                b.conj() * *p + c.conj() * *x + *y * own[2],
            ];
            [*p, *x, *y] = sums;
        }
        self.across[1].process_with_scratch(waves, scratch);
        for (component, own) in waves.chunks_exact(all).enumerate() {
            for (j, values) in real.chunks_exact_mut(length).enumerate() {
                for (value, own) in row.iter_mut().zip(own.chunks_exact(across)) {
                    *value = own[j];
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

/// The smallest even number from `least` on with no prime factor above 5.
pub(crate) fn smooth(least: usize) -> usize {
    let is_smooth = |mut number: usize| {
        for factor in [2, 3, 5] {
            while number.is_multiple_of(factor) {
                number /= factor;
            }
        }
        number == 1
    };
    let mut length = least.max(2).next_multiple_of(2);
    while !is_smooth(length) {
        length += 2;
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;
    use basemat_testkit::random::Random;

    /// Symmetric block for an offset, without any other symmetry.
    fn block(to: [usize; 2], from: [usize; 2]) -> [[f64; 3]; 3] {
        let [x, y] = [0, 1].map(|k| to[k] as f64 - from[k] as f64);
        let far = (-0.3 * x.hypot(y)).exp();
        let odd = |a: f64, b: f64| far * (a * x + b * y + 0.2 * x * y);
        let [zx, zy, xy] = [odd(0.3, -0.1), odd(0.0, 0.4), far * 0.1];
        [[far, zx, zy], [-odd(0.3, -0.1) + 0.4 * far * x * y, 0.8 * far, xy], [zy, xy, 1.3 * far]]
            .map(|row| row)
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
        let both = |r: usize, s: usize| {
            let [a, b] = [block(cells[r], cells[s]), block(cells[s], cells[r])];
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| a[i][j] + b[j][i]))
        };
        let factors: Vec<f64> = (0..count).map(|_| random.within(0.5, 1.5)).collect();
        let product = LatticeProduct::new(&cells, &factors, both).unwrap();
        let mut scratch = product.scratch();
        for _ in 0..2 {
            let x: Vec<f64> = (0..3 * count).map(|_| random.within(-1.0, 1.0)).collect();
            let mut found = vec![0.0; 3 * count];
            product.multiply(&x, &mut scratch, |k, e, value| found[k * count + e] += value);
            for (i, found) in found.iter().enumerate() {
                let (row, receiver) = (i / count, i % count);
                let sum: f64 = (0..3 * count)
                    .map(|j| {
                        let (column, source) = (j / count, j % count);
                        both(receiver, source)[row][column] * factors[source] * x[j]
                    })
                    .sum();
                assert!((found - sum).abs() < 1e-12, "{i}: {found} {sum}");
            }
        }
    }

    #[test]
    fn other_matrices_are_none() {
        let cells: Vec<[usize; 2]> = (0..9).map(|e| [e % 3, e / 3]).collect();
        let even = |r: usize, s: usize| {
            let far =
                (cells[r][0].abs_diff(cells[s][0]) + cells[r][1].abs_diff(cells[s][1])) as f64;
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { 1.0 / (1.0 + far) } else { 0.0 }))
        };
        let factors = [1.0; 9];
        assert!(LatticeProduct::new(&cells, &factors, even).is_some());
        // One block differs; or the matrix is not symmetric.
        let odd = |r: usize, s: usize| {
            even(r, s).map(|row| row.map(|v| if r == 4 { 1.001 * v } else { v }))
        };
        assert!(LatticeProduct::new(&cells, &factors, odd).is_none());
        let turned = |r: usize, s: usize| {
            let mut block = even(r, s);
            block[0][1] = 0.1;
            block
        };
        assert!(LatticeProduct::new(&cells, &factors, turned).is_none());
    }
}
