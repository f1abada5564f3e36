//! Products of a sparse matrix with many vectors.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::matrix::SparseMatrix;
use super::product::{Simd, WithSimd, vectorized};

/// Number of vectors that a matrix multiplies together.
const WIDTH: usize = 16;

impl SparseMatrix {
    /// A x of many vectors, one after the other.
    pub(crate) fn times(&self, vectors: &[f64]) -> Vec<f64> {
        let mut products = vec![0.0; vectors.len()];
        self.multiply_many(vectors, &mut products);
        products
    }

    /// Overwrites `products` with A x of many vectors, one after the other.
    pub(crate) fn multiply_many(&self, vectors: &[f64], products: &mut [f64]) {
        let n = self.order.max(1);
        let mut beside = vec![[0.0; WIDTH]; self.order];
        for (x, y) in vectors.chunks(WIDTH * n).zip(products.chunks_mut(WIDTH * n)) {
            for (row, own) in beside.iter_mut().enumerate() {
                own.iter_mut().zip(x[row..].iter().step_by(n)).for_each(|(own, x)| *own = *x);
            }
            vectorized(Times { matrix: self, x: &beside, y });
        }
    }
}

/// A x of vectors whose entries are beside each other in `x` and one after the other in `y`.
struct Times<'a> {
    matrix: &'a SparseMatrix,
    x: &'a [[f64; WIDTH]],
    y: &'a mut [f64],
}

impl WithSimd for Times<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { matrix, x, y } = self;
        for row in 0..matrix.order {
            let mut sums = [0.0; WIDTH];
            let own = matrix.row_start[row]..matrix.row_start[row + 1];
            for (&column, a) in matrix.column[own.clone()].iter().zip(&matrix.value[own]) {
                let x = &x[column];
                for k in 0..WIDTH {
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
    use crate::linalg::Triplets;

    #[test]
    fn many_vectors_are_multiplied_as_each() {
        let mut triplets = Triplets::new(5);
        (0..20).for_each(|k| triplets.add(k % 5, (3 * k + 1) % 5, 0.3 * k as f64 - 2.0));
        let matrix = SparseMatrix::new("test", &triplets).unwrap();
        let vectors: Vec<f64> = (0..5 * (2 * WIDTH + 3)).map(|k| (k as f64).sin()).collect();
        let mut each = vec![0.0; vectors.len()];
        for (x, y) in vectors.chunks_exact(5).zip(each.chunks_exact_mut(5)) {
            matrix.multiply_add(1.0, x, y);
        }
        assert_eq!(matrix.times(&vectors), each);
    }
}
