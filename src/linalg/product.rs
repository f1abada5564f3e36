//! Products of vectors and dense matrices.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

/// Columns below which the call of a library costs more than it saves.
const NARROW: usize = 24;

/// y ← y + factor · A x for a large dense row-major matrix with `x.len()` columns, with the widest
/// vector registers found at run time.
pub(crate) fn wide_multiply_add(matrix: &[f64], factor: f64, x: &[f64], y: &mut [f64]) {
    let (rows, columns) = (y.len(), x.len());
    if columns < NARROW {
        return dense_multiply_add(matrix, factor, x, y);
    }
    matmul(
        MatMut::from_column_major_slice_mut(y, rows, 1),
        Accum::Add,
        MatRef::from_row_major_slice(matrix, rows, columns),
        MatRef::from_column_major_slice(x, columns, 1),
        factor,
        Par::Seq,
    );
}

/// y ← y + factor · Aᵀ x, likewise, for a matrix with `y.len()` columns.
pub(crate) fn wide_transposed_multiply_add(matrix: &[f64], factor: f64, x: &[f64], y: &mut [f64]) {
    let (rows, columns) = (x.len(), y.len());
    if columns < NARROW {
        for (row, x) in matrix.chunks_exact(columns.max(1)).zip(x) {
            y.iter_mut().zip(row).for_each(|(y, a)| *y += factor * x * a);
        }
        return;
    }
    matmul(
        MatMut::from_column_major_slice_mut(y, columns, 1),
        Accum::Add,
        MatRef::from_column_major_slice(matrix, columns, rows),
        MatRef::from_column_major_slice(x, rows, 1),
        factor,
        Par::Seq,
    );
}

/// Row-major A Bᵀ for row-major A and B with `columns` columns.
pub(crate) fn row_products(a: &[f64], b: &[f64], columns: usize) -> Vec<f64> {
    let (m, n) = (a.len() / columns.max(1), b.len() / columns.max(1));
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

/// C ← C + factor · Wᵀ V for row-major C, W and V with `columns` columns of V.
pub(crate) fn add_combined_rows(
    weights: &[f64],
    vectors: &[f64],
    columns: usize,
    factor: f64,
    sum: &mut [f64],
) {
    let (m, k) = (vectors.len() / columns.max(1), sum.len() / columns.max(1));
    matmul(
        MatMut::from_row_major_slice_mut(sum, k, columns),
        Accum::Add,
        MatRef::from_column_major_slice(weights, k, m),
        MatRef::from_row_major_slice(vectors, m, columns),
        factor,
        Par::Seq,
    );
}

/// y ← y + factor · A x for a dense row-major matrix with `x.len()` columns.
pub(crate) fn dense_multiply_add(matrix: &[f64], factor: f64, x: &[f64], y: &mut [f64]) {
    if x.is_empty() {
        return;
    }
    for (row, y) in matrix.chunks_exact(x.len()).zip(y) {
        *y += factor * dot(row, x);
    }
}

/// Largest magnitude; 0 for an empty slice.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Σ xᵢ yᵢ, in eight running sums so that the compiler can use vector registers.
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (x_chunks, y_chunks) = (x.chunks_exact(8), y.chunks_exact(8));
    let tail: f64 = x_chunks.remainder().iter().zip(y_chunks.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in x_chunks.zip(y_chunks) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    tail + (((a + b) + (c + d)) + ((e + f) + (g + h)))
}
