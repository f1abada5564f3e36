//! Products of vectors and dense matrices.

#![allow(clippy::inline_always, reason = "the caller compiles them for its instruction set")]

use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, MatMut, MatRef, Par};

pub use pulp::{Scalar, Simd, WithSimd};

/// Number of matrix rows that one pass over a vector multiplies: their sums fit into registers.
pub(super) const ROWS_AT_ONCE: usize = 4;

/// Values in complete SIMD vectors, and the remaining values.
pub struct SimdSlice<'a, S: Simd> {
    /// Complete vectors.
    pub vectors: &'a [S::f64s],
    /// Values after the last complete vector.
    pub tail: &'a [f64],
}

impl<'a, S: Simd> SimdSlice<'a, S> {
    /// Splits values into vectors.
    #[inline(always)]
    pub fn new(values: &'a [f64]) -> Self {
        let parts = S::as_simd_f64s(values);
        Self { vectors: parts.0, tail: parts.1 }
    }
}

/// Mutable values in complete SIMD vectors, and the remaining values.
pub struct SimdSliceMut<'a, S: Simd> {
    /// Complete vectors.
    pub vectors: &'a mut [S::f64s],
    /// Values after the last complete vector.
    pub tail: &'a mut [f64],
}

impl<'a, S: Simd> SimdSliceMut<'a, S> {
    /// Splits values into vectors.
    #[inline(always)]
    pub fn new(values: &'a mut [f64]) -> Self {
        let parts = S::as_mut_simd_f64s(values);
        Self { vectors: parts.0, tail: parts.1 }
    }
}

/// y ← y + factor · A x for a dense row-major matrix with `x.len()` columns.
pub fn dense_multiply_add(matrix: &[f64], factor: f64, x: &[f64], y: &mut [f64]) {
    debug_assert_eq!(matrix.len(), x.len() * y.len());
    if !x.is_empty() {
        vectorized(MultiplyAdd { matrix, factor, x, y });
    }
}

/// y ← y + factor · Aᵀ x for a dense row-major matrix with `y.len()` columns.
pub fn transposed_multiply_add(matrix: &[f64], factor: f64, x: &[f64], y: &mut [f64]) {
    debug_assert_eq!(matrix.len(), x.len() * y.len());
    if !y.is_empty() {
        vectorized(TransposedMultiplyAdd { matrix, factor, x, y });
    }
}

/// y ← y + factor · A x.
struct MultiplyAdd<'a> {
    matrix: &'a [f64],
    factor: f64,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for MultiplyAdd<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { matrix, factor, x, y } = self;
        let columns = x.len();
        let mut blocks = matrix.chunks_exact(ROWS_AT_ONCE * columns);
        let mut outputs = y.chunks_exact_mut(ROWS_AT_ONCE);
        for (block, y) in blocks.by_ref().zip(outputs.by_ref()) {
            let rows: [&[f64]; ROWS_AT_ONCE] =
                std::array::from_fn(|k| &block[k * columns..][..columns]);
            for (y, sum) in y.iter_mut().zip(dots(simd, rows, x)) {
                *y += factor * sum;
            }
        }
        let remaining_rows = blocks.remainder().chunks_exact(columns);
        for (row, y) in remaining_rows.zip(outputs.into_remainder()) {
            *y += factor * Dot { weights: None, x: row, y: x }.with_simd(simd);
        }
    }
}

/// y ← y + factor · Aᵀ x.
struct TransposedMultiplyAdd<'a> {
    matrix: &'a [f64],
    factor: f64,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for TransposedMultiplyAdd<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { matrix, factor, x, y } = self;
        let columns = y.len();
        let mut blocks = matrix.chunks_exact(ROWS_AT_ONCE * columns);
        let mut inputs = x.chunks_exact(ROWS_AT_ONCE);
        for (block, x) in blocks.by_ref().zip(inputs.by_ref()) {
            let rows: [&[f64]; ROWS_AT_ONCE] =
                std::array::from_fn(|k| &block[k * columns..][..columns]);
            add_rows(simd, std::array::from_fn(|k| factor * x[k]), rows, y);
        }
        let remaining_rows = blocks.remainder().chunks_exact(columns);
        for (row, x) in remaining_rows.zip(inputs.remainder()) {
            add_row(simd, factor * x, row, y);
        }
    }
}

/// Products of four rows with x.
#[inline(always)]
fn dots<S: Simd>(simd: S, [a, b, c, d]: [&[f64]; ROWS_AT_ONCE], x: &[f64]) -> [f64; ROWS_AT_ONCE] {
    // Consecutive additions to one sum cannot overlap, so each row has two sums.
    let mut sums = [simd.splat_f64s(0.0); 2 * ROWS_AT_ONCE];
    let x = SimdSlice::<S>::new(x);
    let a = SimdSlice::<S>::new(a);
    let b = SimdSlice::<S>::new(b);
    let c = SimdSlice::<S>::new(c);
    let d = SimdSlice::<S>::new(d);
    let vector_count = x.vectors.len();
    let x_pairs = x.vectors.chunks_exact(2);
    let last_x = x_pairs.remainder();
    let row_pairs = a.vectors.chunks_exact(2).zip(b.vectors.chunks_exact(2));
    let row_pairs = row_pairs.zip(c.vectors.chunks_exact(2).zip(d.vectors.chunks_exact(2)));
    for (x, ((a, b), (c, d))) in x_pairs.zip(row_pairs) {
        for k in 0..2 {
            sums[k] = simd.mul_add_e_f64s(a[k], x[k], sums[k]);
            sums[2 + k] = simd.mul_add_e_f64s(b[k], x[k], sums[2 + k]);
            sums[4 + k] = simd.mul_add_e_f64s(c[k], x[k], sums[4 + k]);
            sums[6 + k] = simd.mul_add_e_f64s(d[k], x[k], sums[6 + k]);
        }
    }
    if let [x] = last_x {
        for (k, row) in [a.vectors, b.vectors, c.vectors, d.vectors].into_iter().enumerate() {
            sums[2 * k] = simd.mul_add_e_f64s(row[vector_count - 1], *x, sums[2 * k]);
        }
    }
    let tails = [a.tail, b.tail, c.tail, d.tail];
    std::array::from_fn(|k| {
        let tail: f64 = tails[k].iter().zip(x.tail).map(|(a, x)| a * x).sum();
        tail + simd.reduce_sum_f64s(simd.add_f64s(sums[2 * k], sums[2 * k + 1]))
    })
}

/// y ← y + Σ factor · row for four rows.
#[inline(always)]
pub fn add_rows<S: Simd>(
    simd: S,
    factors: [f64; ROWS_AT_ONCE],
    rows: [&[f64]; ROWS_AT_ONCE],
    y: &mut [f64],
) {
    let vector_factors = factors.map(|factor| simd.splat_f64s(factor));
    let a = SimdSlice::<S>::new(rows[0]);
    let b = SimdSlice::<S>::new(rows[1]);
    let c = SimdSlice::<S>::new(rows[2]);
    let d = SimdSlice::<S>::new(rows[3]);
    let y = SimdSliceMut::<S>::new(y);
    let rows = a.vectors.iter().zip(b.vectors).zip(c.vectors.iter().zip(d.vectors));
    for (y, ((a, b), (c, d))) in y.vectors.iter_mut().zip(rows) {
        let first_sum = simd.mul_add_e_f64s(*a, vector_factors[0], *y);
        let second_sum = simd.mul_add_e_f64s(*b, vector_factors[1], first_sum);
        let third_sum = simd.mul_add_e_f64s(*c, vector_factors[2], second_sum);
        *y = simd.mul_add_e_f64s(*d, vector_factors[3], third_sum);
    }
    for (i, y) in y.tail.iter_mut().enumerate() {
        for (row, factor) in [a.tail, b.tail, c.tail, d.tail].iter().zip(factors) {
            *y += row[i] * factor;
        }
    }
}

/// y ← y + factor · row.
#[inline(always)]
pub fn add_row<S: Simd>(simd: S, factor: f64, row: &[f64], y: &mut [f64]) {
    let vector_factor = simd.splat_f64s(factor);
    let row = SimdSlice::<S>::new(row);
    let y = SimdSliceMut::<S>::new(y);
    for (y, value) in y.vectors.iter_mut().zip(row.vectors) {
        *y = simd.mul_add_e_f64s(*value, vector_factor, *y);
    }
    y.tail.iter_mut().zip(row.tail).for_each(|(y, value)| *y += factor * value);
}

/// Products of all rows of A with all rows of B: the row-major A Bᵀ.
///
/// A and B are row-major with `column_count` columns.
pub fn row_products(a: &[f64], b: &[f64], column_count: usize) -> Vec<f64> {
    let m = a.len() / column_count.max(1);
    let n = b.len() / column_count.max(1);
    let mut products = vec![0.0; m * n];
    matmul(
        MatMut::from_row_major_slice_mut(&mut products, m, n),
        Accum::Replace,
        MatRef::from_row_major_slice(a, m, column_count),
        MatRef::from_column_major_slice(b, column_count, n),
        1.0,
        Par::Seq,
    );
    products
}

/// Products of all rows of A with all rows of B: the row-major A Bᵀ, which is symmetric.
///
/// A and B are row-major with `column_count` columns.
pub fn symmetric_products(a: &[f64], b: &[f64], column_count: usize) -> Vec<f64> {
    let n = a.len() / column_count.max(1);
    let a = MatRef::from_row_major_slice(a, n, column_count);
    let b = MatRef::from_column_major_slice(b, column_count, n);
    symmetric_product([a, b], [BlockStructure::Rectangular; 2])
}

/// Row-major product of two matrices with these shapes, if the product is symmetric.
pub(super) fn symmetric_product(
    [a, b]: [MatRef<'_, f64>; 2],
    [a_shape, b_shape]: [BlockStructure; 2],
) -> Vec<f64> {
    let n = a.nrows();
    let mut product = vec![0.0; n * n];
    let target = MatMut::from_row_major_slice_mut(&mut product, n, n);
    let target_shape = BlockStructure::TriangularLower;
    triangular::matmul(target, target_shape, Accum::Replace, a, a_shape, b, b_shape, 1.0, Par::Seq);
    for (row, column) in (0..n).flat_map(|row| (0..row).map(move |column| (row, column))) {
        product[column * n + row] = product[row * n + column];
    }
    product
}

/// Adds linear combinations of rows: C ← C + factor · Wᵀ V.
///
/// `weights` W, `vectors` V and `sum` C are row-major; V has `column_count` columns.
pub fn add_combined_rows(
    weights: &[f64],
    vectors: &[f64],
    column_count: usize,
    factor: f64,
    sum: &mut [f64],
) {
    let m = vectors.len() / column_count.max(1);
    let k = sum.len() / column_count.max(1);
    matmul(
        MatMut::from_row_major_slice_mut(sum, k, column_count),
        Accum::Add,
        MatRef::from_column_major_slice(weights, k, m),
        MatRef::from_row_major_slice(vectors, m, column_count),
        factor,
        Par::Seq,
    );
}

/// Number of maxima that [`largest`] computes at once.
const MAXIMA_AT_ONCE: usize = 8;

/// Largest magnitude of `values`; 0 for an empty slice.
#[inline]
pub fn largest(values: &[f64]) -> f64 {
    // Several maxima at once: comparisons with a single one would wait for each other.
    let mut maxima = [0.0_f64; MAXIMA_AT_ONCE];
    for block in values.chunks(MAXIMA_AT_ONCE) {
        for (maximum, x) in maxima.iter_mut().zip(block) {
            // NaN is not larger than anything.
            *maximum = if x.abs() > *maximum { x.abs() } else { *maximum };
        }
    }
    maxima.into_iter().fold(0.0, f64::max)
}

/// Weight of the value `k` in [`mixing_sum`].
fn mixing_weight(k: usize) -> f64 {
    1.0 + 0.5 * (k as f64).cos()
}

/// Weighted sum of `values`, which changes if two values are exchanged.
pub fn mixing_sum(values: &[f64]) -> f64 {
    values.iter().enumerate().map(|(k, value)| mixing_weight(k) * value).sum()
}

/// Number of independent sums in [`magnitude_sum`]: consecutive additions to one sum cannot overlap.
const MAGNITUDE_SUMS: usize = 8;

/// Sum of magnitudes, Σ |xᵢ|.
pub fn magnitude_sum(x: &[f64]) -> f64 {
    let chunks = x.chunks_exact(MAGNITUDE_SUMS);
    let mut sums = [0.0; MAGNITUDE_SUMS];
    let tail: f64 = chunks.remainder().iter().map(|x| x.abs()).sum();
    for x in chunks {
        for k in 0..MAGNITUDE_SUMS {
            sums[k] += x[k].abs();
        }
    }
    tail + sums.iter().sum::<f64>()
}

/// Number of independent sums of a scalar product: consecutive additions to one sum cannot overlap.
const DOT_SUMS: usize = 4;

/// Σ xᵢ yᵢ.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    vectorized(Dot { weights: None, x, y })
}

/// Σ wᵢ xᵢ yᵢ.
pub fn weighted_dot(weights: &[f64], x: &[f64], y: &[f64]) -> f64 {
    vectorized(Dot { weights: Some(weights), x, y })
}

/// Scalar product Σ xᵢ yᵢ, or Σ wᵢ xᵢ yᵢ with weights.
///
/// Entries beyond the end of the shorter vector do not count.
pub struct Dot<'a> {
    /// Weights, at least as many as entries of the shorter vector.
    pub weights: Option<&'a [f64]>,
    pub x: &'a [f64],
    pub y: &'a [f64],
}

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let length = self.x.len().min(self.y.len());
        let x = SimdSlice::<S>::new(&self.x[..length]);
        let y = SimdSlice::<S>::new(&self.y[..length]);
        let tail = x.tail.iter().zip(y.tail);
        // Each sum adds up every fourth vector.
        let mut sums = [simd.splat_f64s(0.0); DOT_SUMS];
        let x = x.vectors.chunks_exact(DOT_SUMS);
        let y = y.vectors.chunks_exact(DOT_SUMS);
        let remaining_vectors = x.remainder().iter().zip(y.remainder());
        let Some(weights) = self.weights else {
            for (x, y) in x.zip(y) {
                for k in 0..DOT_SUMS {
                    sums[k] = simd.mul_add_e_f64s(x[k], y[k], sums[k]);
                }
            }
            for (x, y) in remaining_vectors {
                sums[0] = simd.mul_add_e_f64s(*x, *y, sums[0]);
            }
            return tail.map(|(x, y)| x * y).sum::<f64>() + sum_of_lanes(simd, sums);
        };
        let weights = SimdSlice::<S>::new(&weights[..length]);
        let tail = weights.tail.iter().zip(tail).map(|(w, (x, y))| w * x * y);
        let w = weights.vectors.chunks_exact(DOT_SUMS);
        let remaining_vectors = w.remainder().iter().zip(remaining_vectors);
        for (w, (x, y)) in w.zip(x.zip(y)) {
            for k in 0..DOT_SUMS {
                sums[k] = simd.mul_add_e_f64s(simd.mul_f64s(w[k], x[k]), y[k], sums[k]);
            }
        }
        for (w, (x, y)) in remaining_vectors {
            sums[0] = simd.mul_add_e_f64s(simd.mul_f64s(*w, *x), *y, sums[0]);
        }
        tail.sum::<f64>() + sum_of_lanes(simd, sums)
    }
}

/// Sum of all lanes of four vectors.
#[inline(always)]
fn sum_of_lanes<S: Simd>(simd: S, [a, b, c, d]: [S::f64s; DOT_SUMS]) -> f64 {
    simd.reduce_sum_f64s(simd.add_f64s(simd.add_f64s(a, b), simd.add_f64s(c, d)))
}

/// Runs `loops` with the widest instruction set of this processor.
///
/// The loops are compiled once for each instruction set. The method `with_simd` of the loops, and all functions that
/// this method calls, must be `#[inline(always)]`.
#[inline]
pub fn vectorized<L: WithSimd>(loops: L) -> L::Output {
    pulp::Arch::new().dispatch(loops)
}
