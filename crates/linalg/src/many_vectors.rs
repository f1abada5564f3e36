//! Products of a sparse matrix with many vectors.

#![allow(clippy::inline_always, reason = "the caller compiles them for its instruction set")]

use super::matrix::SparseMatrix;
use super::product::{Simd, WithSimd, vectorized};

/// Number of vectors that one pass over the matrix multiplies: their sums fit into registers.
const VECTORS_AT_ONCE: usize = 16;

impl SparseMatrix {
    /// Products A x of many vectors x, one after the other.
    pub fn times(&self, vectors: &[f64]) -> Vec<f64> {
        let mut products = vec![0.0; vectors.len()];
        self.multiply_many(vectors, &mut products);
        products
    }

    /// Overwrites `products` with A x of many vectors x, one after the other.
    pub fn multiply_many(&self, vectors: &[f64], products: &mut [f64]) {
        let n = self.order.max(1);
        let mut interleaved = vec![[0.0; VECTORS_AT_ONCE]; self.order];
        for (x, y) in
            vectors.chunks(VECTORS_AT_ONCE * n).zip(products.chunks_mut(VECTORS_AT_ONCE * n))
        {
            for (row, values) in interleaved.iter_mut().enumerate() {
                for (value, x) in values.iter_mut().zip(x[row..].iter().step_by(n)) {
                    *value = *x;
                }
            }
            vectorized(InterleavedProducts { matrix: self, x: &interleaved, y });
        }
    }
}

/// Products y = A x of several vectors.
///
/// The vectors are interleaved in `x`, and one after the other in `y`.
struct InterleavedProducts<'a> {
    matrix: &'a SparseMatrix,
    x: &'a [[f64; VECTORS_AT_ONCE]],
    y: &'a mut [f64],
}

impl WithSimd for InterleavedProducts<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { matrix, x, y } = self;
        for row in 0..matrix.order {
            let mut sums = [0.0; VECTORS_AT_ONCE];
            let range = matrix.row_starts[row]..matrix.row_starts[row + 1];
            for (&column, a) in matrix.columns[range.clone()].iter().zip(&matrix.values[range]) {
                let x = &x[column];
                for k in 0..VECTORS_AT_ONCE {
                    sums[k] += a * x[k];
                }
            }
            y[row..].iter_mut().step_by(matrix.order).zip(sums).for_each(|(y, sum)| *y = sum);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Triplets;

    #[test]
    fn products_of_many_vectors_equal_single_products() {
        let mut triplets = Triplets::new(5);
        (0..20).for_each(|k| triplets.add(k % 5, (3 * k + 1) % 5, 0.3 * k as f64 - 2.0));
        let matrix = SparseMatrix::new("test", &triplets).unwrap();
        let vectors: Vec<f64> =
            (0..5 * (2 * VECTORS_AT_ONCE + 3)).map(|k| (k as f64).sin()).collect();
        let mut single_products = vec![0.0; vectors.len()];
        for (x, y) in vectors.chunks_exact(5).zip(single_products.chunks_exact_mut(5)) {
            matrix.multiply_add(1.0, x, y);
        }
        assert_eq!(matrix.times(&vectors), single_products);
    }
}
