//! Dense linear systems by GMRES, preconditioned by symmetric Gauss–Seidel sweeps.
//!
//! | symbol | meaning |
//! |---|---|
//! | A = L + D + U | matrix: strict lower triangle, diagonal, strict upper triangle |
//! | x, b | solution and right-hand side |
//! | z | unknown of the preconditioned system: x = (D + U)⁻¹ D z |
//! | V, H | orthonormal basis of the Krylov space, and the matrix of Arnoldi's relation |
//!
//! The system is (D + L)⁻¹ A (D + U)⁻¹ D z = (D + L)⁻¹ b. With t = (D + U)⁻¹ D v its matrix multiplies v to
//! t + (D + L)⁻¹ D (v − t): two substitutions, which read each entry of A once (Eisenstat 1981, SIAM J. Sci. Stat. Comput.
//! 2, 1). The residual in the norm of this system does not grow in any iteration (Saad & Schultz 1986, SIAM J. Sci. Stat.
//! Comput. 7, 856).

#![allow(
    clippy::inline_always,
    reason = "inlined functions are compiled for the instruction set of their caller"
)]

use super::product::{
    ROWS_AT_ONCE as COLUMNS_AT_ONCE, Simd, WithSimd, add_rows, dot, transposed_multiply_add,
    vectorized,
};

/// Largest number of iterations; a factorization takes less time than many more.
const MAX_KRYLOV_VECTORS: usize = 32;

/// A dense matrix, and memory for the solution of its systems by iterations.
#[derive(Default)]
pub struct GaussSeidelGmres {
    order: usize,
    /// A, column by column.
    columns: Vec<f64>,
    /// V, one vector after the other.
    basis: Vec<f64>,
    /// Right-hand side, then a product with the preconditioned matrix.
    product: Vec<f64>,
}

impl GaussSeidelGmres {
    /// Allocates memory for matrices up to order `capacity`, unless it is there; discards the matrix.
    pub fn reserve(&mut self, capacity: usize) {
        self.order = 0;
        self.columns.clear();
        self.columns.reserve_exact(capacity * capacity);
        self.basis.clear();
        self.basis.reserve_exact(capacity * (MAX_KRYLOV_VECTORS + 1));
        self.product.clear();
        self.product.reserve_exact(capacity);
    }

    /// Stores the matrix of `order` whose columns `append_column` writes, one after the other.
    ///
    /// Returns false if an entry on the diagonal is not finite and above zero: sweeps then need not converge.
    pub fn set_columns(
        &mut self,
        order: usize,
        mut append_column: impl FnMut(usize, &mut Vec<f64>),
    ) -> bool {
        self.order = order;
        self.columns.clear();
        (0..order).for_each(|column| append_column(column, &mut self.columns));
        self.diagonal().all(|entry| entry > 0.0 && entry.is_finite())
    }

    /// A column of the matrix.
    pub fn column(&self, k: usize) -> &[f64] {
        &self.columns[k * self.order..][..self.order]
    }

    fn diagonal(&self) -> impl Iterator<Item = f64> {
        (0..self.order).map(|k| self.columns[k * (self.order + 1)])
    }

    /// Overwrites `rhs` with a solution; `tolerance` bounds its preconditioned residual.
    ///
    /// The residual is relative to the residual of the zero vector.
    ///
    /// Returns the number of iterations; `None`, with the same `rhs`, if they do not reach the tolerance.
    pub fn solve(&mut self, rhs: &mut [f64], tolerance: f64) -> Option<usize> {
        let order = self.order;
        let mut least_squares = LeastSquares::default();
        self.product.clear();
        self.product.extend_from_slice(rhs);
        vectorized(Forward { columns: &self.columns, x: &mut self.product });
        self.basis.clear();
        let norm = self.append_to_basis();
        if norm == 0.0 {
            rhs.fill(0.0);
            return Some(0);
        }
        least_squares.rhs[0] = norm;
        for iteration in 0..MAX_KRYLOV_VECTORS {
            self.multiply(iteration);
            let mut column = [0.0; MAX_KRYLOV_VECTORS + 1];
            let vectors = self.basis.chunks_exact(order);
            // Modified Gram–Schmidt.
            for (vector, entry) in vectors.zip(&mut column) {
                *entry = dot(vector, &self.product);
                transposed_multiply_add(vector, 1.0, &[-*entry], &mut self.product);
            }
            column[iteration + 1] = self.append_to_basis();
            let residual = least_squares.append(iteration, &column);
            // False for NaN.
            if residual <= tolerance * norm {
                self.combine(&least_squares.solution(iteration + 1), rhs);
                return Some(iteration + 1);
            }
        }
        None
    }

    /// Appends the product to the basis at unit length; returns its norm.
    fn append_to_basis(&mut self) -> f64 {
        let norm = dot(&self.product, &self.product).sqrt();
        let scale = if norm > 0.0 { norm.recip() } else { 0.0 };
        self.basis.extend(self.product.iter().map(|value| scale * value));
        norm
    }

    /// Overwrites the product with the preconditioned matrix times a vector of the basis.
    fn multiply(&mut self, vector: usize) {
        let Self { order, columns, basis, product, .. } = self;
        let vector = &basis[vector * *order..][..*order];
        product.clear();
        product.extend(vector.iter().zip(columns.iter().step_by(*order + 1)).map(|(v, d)| v * d));
        vectorized(Backward { columns, x: product });
        // The second substitution takes the place of the next vector.
        let end = basis.len();
        basis.extend_from_within(end - *order..);
        let correction = &mut basis[end..];
        for ((value, t), d) in
            correction.iter_mut().zip(product.iter()).zip(columns.iter().step_by(*order + 1))
        {
            *value = d * (*value - t);
        }
        vectorized(Forward { columns, x: correction });
        product
            .iter_mut()
            .zip(correction)
            .for_each(|(value, correction)| *value += *correction);
        basis.truncate(end);
    }

    /// Overwrites `solution` with (D + U)⁻¹ D V c, c: `coefficients`.
    fn combine(&mut self, coefficients: &[f64; MAX_KRYLOV_VECTORS], solution: &mut [f64]) {
        let Self { order, columns, basis, .. } = self;
        solution.fill(0.0);
        for (vector, coefficient) in basis.chunks_exact(*order).zip(coefficients) {
            transposed_multiply_add(vector, 1.0, &[*coefficient], solution);
        }
        let diagonal = columns.iter().step_by(*order + 1);
        solution.iter_mut().zip(diagonal).for_each(|(value, d)| *value *= d);
        vectorized(Backward { columns, x: solution });
    }
}

/// The least-squares problem of GMRES, whose Hessenberg matrix rotations make triangular.
struct LeastSquares {
    /// Columns of the triangle.
    triangle: [[f64; MAX_KRYLOV_VECTORS + 1]; MAX_KRYLOV_VECTORS],
    /// Cosine and sine of each rotation.
    rotations: [[f64; 2]; MAX_KRYLOV_VECTORS],
    rhs: [f64; MAX_KRYLOV_VECTORS + 1],
}

impl Default for LeastSquares {
    fn default() -> Self {
        Self {
            triangle: [[0.0; MAX_KRYLOV_VECTORS + 1]; MAX_KRYLOV_VECTORS],
            rotations: [[1.0, 0.0]; MAX_KRYLOV_VECTORS],
            rhs: [0.0; MAX_KRYLOV_VECTORS + 1],
        }
    }
}

impl LeastSquares {
    /// Appends column `k` of H; returns the norm of the residual.
    fn append(&mut self, k: usize, h_column: &[f64; MAX_KRYLOV_VECTORS + 1]) -> f64 {
        let mut column = *h_column;
        for (i, [c, s]) in self.rotations[..k].iter().enumerate() {
            [column[i], column[i + 1]] =
                [c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]];
        }
        let length = column[k].hypot(column[k + 1]);
        let cosine = column[k] / length;
        let sine = column[k + 1] / length;
        self.rotations[k] = [cosine, sine];
        column[k] = length;
        self.triangle[k] = column;
        self.rhs[k + 1] = -sine * self.rhs[k];
        self.rhs[k] *= cosine;
        self.rhs[k + 1].abs()
    }

    /// Coefficients of the first `count` vectors, with zeros for the other vectors.
    fn solution(&self, count: usize) -> [f64; MAX_KRYLOV_VECTORS] {
        let mut coefficients = [0.0; MAX_KRYLOV_VECTORS];
        coefficients[..count].copy_from_slice(&self.rhs[..count]);
        for k in (0..count).rev() {
            let column = &self.triangle[k];
            coefficients[k] /= column[k];
            for i in 0..k {
                coefficients[i] -= column[i] * coefficients[k];
            }
        }
        coefficients
    }
}

/// Substitution x ← (D + L)⁻¹ x.
struct Forward<'a> {
    columns: &'a [f64],
    x: &'a mut [f64],
}

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { columns, x } = self;
        let order = x.len();
        let mut begin = 0;
        while begin < order {
            let block_len = COLUMNS_AT_ONCE.min(order - begin);
            let (block, rows_below) = x[begin..].split_at_mut(block_len);
            for j in 0..block_len {
                let column = &columns[(begin + j) * order + begin..][..block_len];
                block[j] /= column[j];
                for i in j + 1..block_len {
                    block[i] -= column[i] * block[j];
                }
            }
            if !rows_below.is_empty() {
                // Only the last block is incomplete, without rows below.
                let below = std::array::from_fn(|j| {
                    &columns[(begin + j) * order + begin + block_len..][..rows_below.len()]
                });
                add_rows(simd, std::array::from_fn(|j| -block[j]), below, rows_below);
            }
            begin += block_len;
        }
    }
}

/// Substitution x ← (D + U)⁻¹ x.
struct Backward<'a> {
    columns: &'a [f64],
    x: &'a mut [f64],
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { columns, x } = self;
        let order = x.len();
        let mut end = order;
        while end > 0 {
            let begin = end - COLUMNS_AT_ONCE.min(end);
            let (rows_above, rest) = x.split_at_mut(begin);
            let block = &mut rest[..end - begin];
            for j in (0..block.len()).rev() {
                let column = &columns[(begin + j) * order + begin..][..block.len()];
                block[j] /= column[j];
                for i in 0..j {
                    block[i] -= column[i] * block[j];
                }
            }
            if !rows_above.is_empty() {
                // Only the first block is incomplete, without rows above.
                let above = std::array::from_fn(|j| &columns[(begin + j) * order..][..begin]);
                add_rows(simd, std::array::from_fn(|j| -block[j]), above, rows_above);
            }
            end = begin;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense_multiply_add;

    /// Row-major matrix with a dominant diagonal, not symmetric.
    fn matrix(random: &mut basemat_testkit::random::Random, order: usize) -> Vec<f64> {
        let mut matrix: Vec<f64> =
            (0..order * order).map(|_| random.within(-1.0, 1.0) / order as f64).collect();
        (0..order).for_each(|k| matrix[k * (order + 1)] = random.within(1.0, 3.0));
        matrix
    }

    #[test]
    fn solutions_of_all_orders_have_the_tolerance() {
        let mut random = basemat_testkit::random::Random(3);
        let mut system = GaussSeidelGmres::default();
        for order in 0..=40 {
            let matrix = matrix(&mut random, order);
            let expected: Vec<f64> = (0..order).map(|_| random.within(-1.0, 1.0)).collect();
            let mut x = vec![0.0; order];
            dense_multiply_add(&matrix, 1.0, &expected, &mut x);
            assert!(system.set_columns(order, |j, values| {
                values.extend(matrix.chunks_exact(order).map(|row| row[j]));
            }));
            assert!(system.solve(&mut x, 1e-12).is_some(), "order {order}");
            for (a, b) in x.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-10, "order {order}: {a} for {b}");
            }
        }
    }

    #[test]
    fn systems_that_sweeps_do_not_suit_are_reported_and_keep_their_right_hand_side() {
        let mut system = GaussSeidelGmres::default();
        let has_positive_diagonal = |system: &mut GaussSeidelGmres, entry: f64| {
            system.set_columns(2, |j, values| values.extend([[1.0, 0.5], [0.5, entry]][j]))
        };
        for entry in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(!has_positive_diagonal(&mut system, entry));
        }
        assert!(has_positive_diagonal(&mut system, 1.0));
        let mut rhs = [f64::NAN, 1.0];
        assert!(system.solve(&mut rhs, 1e-6).is_none() && rhs[1] == 1.0);
        // A cyclic shift needs as many iterations as unknowns.
        let order = 40;
        assert!(system.set_columns(order, |j, values| {
            values.extend((0..order).map(|i| match (i + order - j) % order {
                0 => 1e-9,
                1 => 1.0,
                _ => 0.0,
            }));
        }));
        let mut rhs = vec![0.0; order];
        rhs[0] = 1.0;
        let begin = rhs.clone();
        assert!(system.solve(&mut rhs, 1e-6).is_none());
        assert_eq!(rhs, begin);
    }
}
