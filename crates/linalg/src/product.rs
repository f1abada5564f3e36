//! Products of vectors and dense matrices.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, MatMut, MatRef, Par};

pub use pulp::{Scalar, Simd, WithSimd};

/// Number of matrix rows that one pass over a vector reads.
pub(super) const ROWS_AT_ONCE: usize = 4;

/// Values in whole SIMD vectors, and the rest.
pub struct SimdSlice<'a, S: Simd> {
    pub vectors: &'a [S::f64s],
    pub tail: &'a [f64],
}

impl<'a, S: Simd> SimdSlice<'a, S> {
    #[inline(always)]
    pub fn new(values: &'a [f64]) -> Self {
        let parts = S::as_simd_f64s(values);
        Self { vectors: parts.0, tail: parts.1 }
    }
}

/// Mutable values in whole SIMD vectors, and the rest.
pub struct SimdSliceMut<'a, S: Simd> {
    pub vectors: &'a mut [S::f64s],
    pub tail: &'a mut [f64],
}

impl<'a, S: Simd> SimdSliceMut<'a, S> {
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
        let rest = blocks.remainder();
        for (row, y) in rest.chunks_exact(columns).zip(outputs.into_remainder()) {
            *y += factor * Dot { weights: None, x: row, y: x }.with_simd(simd);
        }
    }
}

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
        let rest = blocks.remainder().chunks_exact(columns);
        for (row, x) in rest.zip(inputs.remainder()) {
            add_row(simd, factor * x, row, y);
        }
    }
}

/// Σ aᵢ xᵢ for four rows of the length of x.
#[inline(always)]
fn dots<S: Simd>(simd: S, [a, b, c, d]: [&[f64]; ROWS_AT_ONCE], x: &[f64]) -> [f64; ROWS_AT_ONCE] {
    // An addition waits for the previous one to the same sum, so each row has two sums.
    let mut sums = [simd.splat_f64s(0.0); 2 * ROWS_AT_ONCE];
    let x = SimdSlice::<S>::new(x);
    let a = SimdSlice::<S>::new(a);
    let b = SimdSlice::<S>::new(b);
    let c = SimdSlice::<S>::new(c);
    let d = SimdSlice::<S>::new(d);
    let n = x.vectors.len();
    let pairs = x.vectors.chunks_exact(2);
    let odd = pairs.remainder();
    let rows = a.vectors.chunks_exact(2).zip(b.vectors.chunks_exact(2));
    let rows = rows.zip(c.vectors.chunks_exact(2).zip(d.vectors.chunks_exact(2)));
    for (x, ((a, b), (c, d))) in pairs.zip(rows) {
        for k in 0..2 {
            sums[k] = simd.mul_add_e_f64s(a[k], x[k], sums[k]);
            sums[2 + k] = simd.mul_add_e_f64s(b[k], x[k], sums[2 + k]);
            sums[4 + k] = simd.mul_add_e_f64s(c[k], x[k], sums[4 + k]);
            sums[6 + k] = simd.mul_add_e_f64s(d[k], x[k], sums[6 + k]);
        }
    }
    if let [x] = odd {
        for (k, row) in [a.vectors, b.vectors, c.vectors, d.vectors].into_iter().enumerate() {
            sums[2 * k] = simd.mul_add_e_f64s(row[n - 1], *x, sums[2 * k]);
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
    let splat = factors.map(|factor| simd.splat_f64s(factor));
    let a = SimdSlice::<S>::new(rows[0]);
    let b = SimdSlice::<S>::new(rows[1]);
    let c = SimdSlice::<S>::new(rows[2]);
    let d = SimdSlice::<S>::new(rows[3]);
    let y = SimdSliceMut::<S>::new(y);
    let rows = a.vectors.iter().zip(b.vectors).zip(c.vectors.iter().zip(d.vectors));
    for (y, ((a, b), (c, d))) in y.vectors.iter_mut().zip(rows) {
        let first_two = simd.mul_add_e_f64s(*b, splat[1], simd.mul_add_e_f64s(*a, splat[0], *y));
        *y = simd.mul_add_e_f64s(*d, splat[3], simd.mul_add_e_f64s(*c, splat[2], first_two));
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
    let splat_factor = simd.splat_f64s(factor);
    let row = SimdSlice::<S>::new(row);
    let y = SimdSliceMut::<S>::new(y);
    for (y, value) in y.vectors.iter_mut().zip(row.vectors) {
        *y = simd.mul_add_e_f64s(*value, splat_factor, *y);
    }
    y.tail.iter_mut().zip(row.tail).for_each(|(y, value)| *y += factor * value);
}

/// Row-major A Bᵀ for row-major A and B with `columns` columns.
pub fn row_products(a: &[f64], b: &[f64], columns: usize) -> Vec<f64> {
    let m = a.len() / columns.max(1);
    let n = b.len() / columns.max(1);
    let mut products = vec![0.0; m * n];
    matmul(
        MatMut::from_row_major_slice_mut(&mut products, m, n),
        Accum::Replace,
        MatRef::from_row_major_slice(a, m, columns),
        MatRef::from_column_major_slice(b, columns, n),
        1.0,
        Par::Seq,
    );
    products
}

/// Row-major A Bᵀ for row-major A and B with `columns` columns, if it is symmetric.
pub fn symmetric_products(a: &[f64], b: &[f64], columns: usize) -> Vec<f64> {
    let n = a.len() / columns.max(1);
    let a = MatRef::from_row_major_slice(a, n, columns);
    let b = MatRef::from_column_major_slice(b, columns, n);
    symmetric_product([a, b], [BlockStructure::Rectangular; 2])
}

/// The product of two factors of these shapes, row-major, if it is symmetric.
pub(super) fn symmetric_product(
    [a, b]: [MatRef<'_, f64>; 2],
    [left, right]: [BlockStructure; 2],
) -> Vec<f64> {
    let n = a.nrows();
    let mut product = vec![0.0; n * n];
    let sum = MatMut::from_row_major_slice_mut(&mut product, n, n);
    let below = BlockStructure::TriangularLower;
    triangular::matmul(sum, below, Accum::Replace, a, left, b, right, 1.0, Par::Seq);
    for (row, column) in (0..n).flat_map(|row| (0..row).map(move |column| (row, column))) {
        product[column * n + row] = product[row * n + column];
    }
    product
}

/// C ← C + factor · Wᵀ V for row-major C, W and V with `columns` columns of V.
pub fn add_combined_rows(
    weights: &[f64],
    vectors: &[f64],
    columns: usize,
    factor: f64,
    sum: &mut [f64],
) {
    let m = vectors.len() / columns.max(1);
    let k = sum.len() / columns.max(1);
    matmul(
        MatMut::from_row_major_slice_mut(sum, k, columns),
        Accum::Add,
        MatRef::from_column_major_slice(weights, k, m),
        MatRef::from_row_major_slice(vectors, m, columns),
        factor,
        Par::Seq,
    );
}

/// Largest magnitude; 0 for an empty slice.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Weight of the number `k` in [`mixed`].
fn mixing_weight(k: usize) -> f64 {
    1.0 + 0.5 * (k as f64).cos()
}

/// Weighted sum that differs where numbers are exchanged.
pub fn mixed(values: &[f64]) -> f64 {
    values.iter().enumerate().map(|(k, value)| mixing_weight(k) * value).sum()
}

/// Σ |xᵢ|.
pub fn magnitude(x: &[f64]) -> f64 {
    let chunks = x.chunks_exact(8);
    let mut sums = [0.0; 8];
    let tail: f64 = chunks.remainder().iter().map(|x| x.abs()).sum();
    for x in chunks {
        for k in 0..8 {
            sums[k] += x[k].abs();
        }
    }
    tail + sums.iter().sum::<f64>()
}

/// Σ xᵢ yᵢ.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    vectorized(Dot { weights: None, x, y })
}

/// Σ wᵢ xᵢ yᵢ.
pub fn weighted_dot(weights: &[f64], x: &[f64], y: &[f64]) -> f64 {
    vectorized(Dot { weights: Some(weights), x, y })
}

/// Σ xᵢ yᵢ, or Σ wᵢ xᵢ yᵢ with weights, up to the length of the shortest slice.
pub struct Dot<'a> {
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
        // An addition waits for the previous one to the same sum, so there are four sums.
        let mut sums = [simd.splat_f64s(0.0); 4];
        let x = x.vectors.chunks_exact(4);
        let y = y.vectors.chunks_exact(4);
        let rest = x.remainder().iter().zip(y.remainder());
        let Some(weights) = self.weights else {
            for (x, y) in x.zip(y) {
                for k in 0..4 {
                    sums[k] = simd.mul_add_e_f64s(x[k], y[k], sums[k]);
                }
            }
            for (x, y) in rest {
                sums[0] = simd.mul_add_e_f64s(*x, *y, sums[0]);
            }
            return tail.map(|(x, y)| x * y).sum::<f64>() + total(simd, sums);
        };
        let weights = SimdSlice::<S>::new(&weights[..length]);
        let tail = weights.tail.iter().zip(tail).map(|(w, (x, y))| w * x * y);
        let w = weights.vectors.chunks_exact(4);
        let rest = w.remainder().iter().zip(rest);
        for (w, (x, y)) in w.zip(x.zip(y)) {
            for k in 0..4 {
                sums[k] = simd.mul_add_e_f64s(simd.mul_f64s(w[k], x[k]), y[k], sums[k]);
            }
        }
        for (w, (x, y)) in rest {
            sums[0] = simd.mul_add_e_f64s(simd.mul_f64s(*w, *x), *y, sums[0]);
        }
        tail.sum::<f64>() + total(simd, sums)
    }
}

#[inline(always)]
fn total<S: Simd>(simd: S, [a, b, c, d]: [S::f64s; 4]) -> f64 {
    simd.reduce_sum_f64s(simd.add_f64s(simd.add_f64s(a, b), simd.add_f64s(c, d)))
}

/// Runs `loops` with the best instruction set of this processor.
///
/// The loops are compiled once for each instruction set. Their `with_simd` and all functions that it calls
/// must be `#[inline(always)]`.
#[inline]
pub fn vectorized<L: WithSimd>(loops: L) -> L::Output {
    pulp::Arch::new().dispatch(loops)
}
