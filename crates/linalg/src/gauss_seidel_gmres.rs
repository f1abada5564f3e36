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
//!
//! The matrix has single precision: substitutions then read half as much memory, which takes most of their time.

#![allow(
    clippy::inline_always,
    reason = "inlined functions are compiled for the instruction set of their caller"
)]
#![allow(clippy::cast_possible_truncation, reason = "the matrix has single precision")]

use super::product::{
    ROWS_AT_ONCE as COLUMNS_AT_ONCE, Simd, WithSimd, dot, transposed_multiply_add, vectorized,
};

/// Largest number of iterations; a factorization takes less time than many more.
const MAX_KRYLOV_VECTORS: usize = 32;

/// A dense matrix, and memory for the solution of its systems by iterations.
#[derive(Default)]
pub struct GaussSeidelGmres {
    order: usize,
    /// A, column by column.
    columns: Vec<f32>,
    /// D.
    diagonal: Vec<f64>,
    /// V, one vector after the other.
    basis: Vec<f64>,
    /// Right-hand side, then a product with the preconditioned matrix.
    product: Vec<f64>,
    /// Vector of a substitution.
    substituted: Vec<f32>,
    /// Column in double precision.
    column: Vec<f64>,
}

impl GaussSeidelGmres {
    /// Allocates memory for matrices up to order `capacity`, unless it is there; discards the matrix.
    pub fn reserve(&mut self, capacity: usize) {
        self.order = 0;
        self.columns.clear();
        self.columns.reserve_exact(capacity * capacity);
        self.basis.clear();
        self.basis.reserve_exact(capacity * (MAX_KRYLOV_VECTORS + 1));
        self.substituted.clear();
        self.substituted.reserve_exact(capacity);
        for vector in [&mut self.diagonal, &mut self.product, &mut self.column] {
            vector.clear();
            vector.reserve_exact(capacity);
        }
    }

    /// Stores the matrix of `order` whose columns `append_column` writes, one after the other.
    ///
    /// Returns false if an entry on the diagonal is not finite and above zero in single precision: sweeps then need not
    /// converge.
    pub fn set_columns(
        &mut self,
        order: usize,
        mut append_column: impl FnMut(usize, &mut Vec<f64>),
    ) -> bool {
        self.order = order;
        self.columns.clear();
        self.diagonal.clear();
        for k in 0..order {
            self.column.clear();
            append_column(k, &mut self.column);
            self.columns.extend(self.column.iter().map(|entry| *entry as f32));
            self.diagonal.push(f64::from(self.columns[k * (order + 1)]));
        }
        self.diagonal.iter().all(|entry| *entry > 0.0 && entry.is_finite())
    }

    /// Overwrites `rhs` with a solution; `tolerance` bounds its preconditioned residual.
    ///
    /// The residual is relative to the residual of the zero vector, and exact up to the rounding errors of single
    /// precision times the condition number: tolerances below 1e-5 gain nothing.
    ///
    /// Returns the number of iterations; `None`, with the same `rhs`, if they do not reach the tolerance.
    pub fn solve(&mut self, rhs: &mut [f64], tolerance: f64) -> Option<usize> {
        let order = self.order;
        let mut least_squares = LeastSquares::default();
        let Self { columns, product, substituted, .. } = self;
        overwrite(substituted, rhs.iter().copied());
        vectorized(Forward { columns, x: substituted });
        product.clear();
        product.extend(substituted.iter().copied().map(f64::from));
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
        let Self { order, columns, diagonal, basis, product, substituted, .. } = self;
        let vector = &basis[vector * *order..][..*order];
        overwrite(substituted, vector.iter().zip(&*diagonal).map(|(v, d)| v * d));
        vectorized(Backward { columns, x: substituted });
        product.clear();
        product.extend(substituted.iter().copied().map(f64::from));
        let differences = vector.iter().zip(&*product).zip(diagonal);
        overwrite(substituted, differences.map(|((v, t), d)| *d * (v - t)));
        vectorized(Forward { columns, x: substituted });
        product
            .iter_mut()
            .zip(substituted)
            .for_each(|(value, correction)| *value += f64::from(*correction));
    }

    /// Overwrites `solution` with (D + U)⁻¹ D V c, c: `coefficients`.
    fn combine(&mut self, coefficients: &[f64; MAX_KRYLOV_VECTORS], solution: &mut [f64]) {
        let Self { order, columns, diagonal, basis, substituted, .. } = self;
        solution.fill(0.0);
        for (vector, coefficient) in basis.chunks_exact(*order).zip(coefficients) {
            transposed_multiply_add(vector, 1.0, &[*coefficient], solution);
        }
        overwrite(substituted, solution.iter().zip(diagonal).map(|(x, d)| x * *d));
        vectorized(Backward { columns, x: substituted });
        solution.iter_mut().zip(substituted).for_each(|(x, value)| *x = f64::from(*value));
    }
}

/// Overwrites a vector of single precision.
fn overwrite(vector: &mut Vec<f32>, values: impl Iterator<Item = f64>) {
    vector.clear();
    vector.extend(values.map(|value| value as f32));
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
    columns: &'a [f32],
    x: &'a mut [f32],
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
                let below: [&[f32]; COLUMNS_AT_ONCE] = std::array::from_fn(|j| {
                    &columns[(begin + j) * order + begin + block_len..][..rows_below.len()]
                });
                subtract_columns(simd, block, below, rows_below);
            }
            begin += block_len;
        }
    }
}

/// Substitution x ← (D + U)⁻¹ x.
struct Backward<'a> {
    columns: &'a [f32],
    x: &'a mut [f32],
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
                let above: [&[f32]; COLUMNS_AT_ONCE] =
                    std::array::from_fn(|j| &columns[(begin + j) * order..][..begin]);
                subtract_columns(simd, block, above, rows_above);
            }
            end = begin;
        }
    }
}

/// y ← y − Σ factor · column for as many columns as there are factors in a complete block.
#[inline(always)]
fn subtract_columns<S: Simd>(
    simd: S,
    factors: &[f32],
    columns: [&[f32]; COLUMNS_AT_ONCE],
    y: &mut [f32],
) {
    let vector_factors: [S::f32s; COLUMNS_AT_ONCE] =
        std::array::from_fn(|k| simd.splat_f32s(-factors[k]));
    let [a, b, c, d] = columns.map(|column| S::as_simd_f32s(column));
    let y_parts = S::as_mut_simd_f32s(y);
    let columns = a.0.iter().zip(b.0).zip(c.0.iter().zip(d.0));
    for (y, ((a, b), (c, d))) in y_parts.0.iter_mut().zip(columns) {
        let first_sum = simd.mul_add_e_f32s(*a, vector_factors[0], *y);
        let second_sum = simd.mul_add_e_f32s(*b, vector_factors[1], first_sum);
        let third_sum = simd.mul_add_e_f32s(*c, vector_factors[2], second_sum);
        *y = simd.mul_add_e_f32s(*d, vector_factors[3], third_sum);
    }
    for (i, y) in y_parts.1.iter_mut().enumerate() {
        for (column, factor) in [a.1, b.1, c.1, d.1].iter().zip(factors) {
            *y -= column[i] * factor;
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
            assert!(system.solve(&mut x, 1e-5).is_some(), "order {order}");
            for (a, b) in x.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-4, "order {order}: {a} for {b}");
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
