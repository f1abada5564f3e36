//! Condition numbers from factors.
//!
//! The matrix A is first scaled by its diagonal to S A S with sᵢ = |aᵢᵢ|^−½. The condition number of S A S
//! does not depend on units (a degree of freedom may be a length or an angle). For a positive definite matrix of order
//! n it is, in the 2-norm, at most n times the smallest condition number of any diagonal scaling (van der Sluis 1969).
//! It bounds the error of a Cholesky solve, with and without scaling (Higham 2002, theorem 10.6 with § 10.1.1).

use super::{DenseFactor, SparseFactor, SparseMatrix};

/// Largest number of iterations of the estimator, as in LAPACK's dlacn2.
///
/// Further iterations seldom improve the estimate.
const MAX_ESTIMATOR_ITERATIONS: usize = 5;

/// Estimate of the norm ‖B‖₁ of a matrix from its products.
///
/// `multiply(b, is_transposed)` overwrites b with B b or Bᵀ b.
///
/// Hager's algorithm with Higham's refinements (Higham 2002, algorithm 15.4; LAPACK's dlacn2): a
/// lower bound, nearly always within a factor of three. Infinite if a product is not finite.
fn estimated_one_norm(order: usize, multiply: &mut dyn FnMut(&mut [f64], bool)) -> f64 {
    let mut x = vec![1.0 / order as f64; order];
    let mut signs = vec![0.0; order];
    let mut estimate = 0.0_f64;
    let mut unit_index = usize::MAX;
    for iteration in 0..MAX_ESTIMATOR_ITERATIONS {
        multiply(&mut x, false);
        let norm: f64 = x.iter().map(|x| x.abs()).sum();
        if !norm.is_finite() {
            return f64::INFINITY;
        }
        let signs_repeat = signs.iter().zip(&x).all(|(s, x)| *s == x.signum());
        if iteration > 0 && (norm <= estimate || signs_repeat) {
            estimate = estimate.max(norm);
            break;
        }
        estimate = norm;
        signs.iter_mut().zip(&x).for_each(|(s, x)| *s = x.signum());
        x.copy_from_slice(&signs);
        multiply(&mut x, true);
        let index_of_largest =
            (0..order).fold(0, |a, b| if x[b].abs() > x[a].abs() { b } else { a });
        if index_of_largest == unit_index {
            break;
        }
        unit_index = index_of_largest;
        x.fill(0.0);
        x[unit_index] = 1.0;
    }
    // The product with this vector is large for matrices whose norm the iteration underestimates (Higham 2002).
    let last_index = order.max(2) as f64 - 1.0;
    for (i, x) in x.iter_mut().enumerate() {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        *x = sign * (1.0 + i as f64 / last_index);
    }
    multiply(&mut x, false);
    let alternative_estimate: f64 =
        x.iter().map(|x| x.abs()).sum::<f64>() * 2.0 / (3.0 * order as f64);
    if alternative_estimate.is_finite() {
        estimate.max(alternative_estimate)
    } else {
        f64::INFINITY
    }
}

/// Square roots of the diagonal's magnitudes; 1 for a zero on the diagonal.
fn roots_of_diagonal(diagonal: impl Iterator<Item = f64>) -> Vec<f64> {
    diagonal.map(|d| if d == 0.0 { 1.0 } else { d.abs().sqrt() }).collect()
}

/// Multiplies each value by its factor.
pub fn scale_by(values: &mut [f64], factors: &[f64]) {
    values.iter_mut().zip(factors).for_each(|(x, s)| *x *= s);
}

/// Condition number of a dense row-major matrix scaled by its diagonal, in the 1-norm.
///
/// The norm of the inverse is an estimate. Infinite if the matrix is singular.
pub fn dense_condition(matrix: &[f64], order: usize) -> f64 {
    if order == 0 {
        return 1.0;
    }
    let roots = roots_of_diagonal((0..order).map(|i| matrix[i * order + i]));
    let scaled_matrix: Vec<f64> = (0..order * order)
        .map(|k| matrix[k] / (roots[k / order] * roots[k % order]))
        .collect();
    let norm = (0..order)
        .map(|j| (0..order).map(|i| scaled_matrix[i * order + j].abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let mut factor = DenseFactor::with_capacity(order);
    if !factor.factor(&scaled_matrix, order) {
        return f64::INFINITY;
    }
    norm * estimated_one_norm(order, &mut |x, is_transposed| {
        if is_transposed { factor.solve_transposed(x) } else { factor.solve(x) }
    })
}

/// Condition number of a matrix A scaled by its `diagonal`, in the 1-norm.
///
/// The norms of the matrix and of its inverse are estimates.
///
/// `multiply(b, is_transposed)` overwrites b with A b or Aᵀ b, and `solve(b, is_transposed)` with A⁻¹ b or A⁻ᵀ b.
pub fn condition_by_products(
    diagonal: &[f64],
    multiply: impl Fn(&mut [f64], bool),
    mut solve: impl FnMut(&mut [f64], bool),
) -> f64 {
    let roots = roots_of_diagonal(diagonal.iter().copied());
    let reciprocals: Vec<f64> = roots.iter().map(|root| root.recip()).collect();
    let norm = estimated_one_norm(diagonal.len(), &mut |x, is_transposed| {
        scale_by(x, &reciprocals);
        multiply(x, is_transposed);
        scale_by(x, &reciprocals);
    });
    norm * estimated_one_norm(diagonal.len(), &mut |x, is_transposed| {
        scale_by(x, &roots);
        solve(x, is_transposed);
        scale_by(x, &roots);
    })
}

/// Condition number of a sparse matrix scaled by its diagonal, from its factors, in the 1-norm.
///
/// The norm of the inverse is an estimate.
pub fn sparse_condition(matrix: &SparseMatrix, factor: &SparseFactor) -> f64 {
    let order = matrix.order();
    let roots = roots_of_diagonal(matrix.diagonal().into_iter());
    let mut column_sums = vec![0.0; order];
    for (row, column, value) in matrix.entries() {
        column_sums[column] += value.abs() / (roots[row] * roots[column]);
    }
    let norm = column_sums.into_iter().fold(0.0, f64::max);
    norm * estimated_one_norm(order, &mut |x, is_transposed| {
        scale_by(x, &roots);
        if is_transposed {
            factor.solve_transposed(x);
        } else {
            factor.solve_many(x);
        }
        scale_by(x, &roots);
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Triplets;
    use basemat_testkit::random::Random;

    #[test]
    fn estimates_are_within_a_factor_of_three_of_the_exact_condition_number() {
        let mut random = Random(3);
        let mut max_ratio = 1.0_f64;
        for case in 0..400 {
            let n = 1 + case % 12;
            // The condition number and the units vary over many decades.
            let diagonal_shift = random.log_within(1e-10, 1.0);
            let units: Vec<f64> = (0..n).map(|_| random.log_within(1e-6, 1e6)).collect();
            let random_entries: Vec<f64> = (0..n * n).map(|_| random.within(-1.0, 1.0)).collect();
            let asymmetry = if case % 3 == 0 { 0.5 } else { 0.0 };
            let mut matrix = vec![0.0; n * n];
            for (i, j) in (0..n * n).map(|k| (k / n, k % n)) {
                // The product is singular; the shift of its diagonal makes the matrix regular.
                let product: f64 =
                    (1..n).map(|k| random_entries[i * n + k] * random_entries[j * n + k]).sum();
                let addition = if i == j {
                    diagonal_shift
                } else {
                    asymmetry * random_entries[i.min(j) * n + i.max(j)]
                };
                let sign = if i < j { -1.0 } else { 1.0 };
                matrix[i * n + j] = (product + sign * addition) * units[i] * units[j];
                if i == j {
                    matrix[i * n + j] = matrix[i * n + j].abs();
                }
            }
            let exact_condition = basemat_testkit::dense::condition_by_inverse(&matrix, n);
            let mut triplets = Triplets::new(n);
            for (k, value) in matrix.iter().enumerate() {
                triplets.add(k / n, k % n, *value);
            }
            let sparse_matrix = SparseMatrix::new("test", &triplets).unwrap();
            let factor = SparseFactor::new("test", &triplets).unwrap();
            for estimate in [dense_condition(&matrix, n), sparse_condition(&sparse_matrix, &factor)]
            {
                // The estimate is a lower bound up to rounding, and rarely far below the exact value.
                let ratio = exact_condition / estimate;
                assert!(
                    ratio > 0.99 && ratio < 3.0,
                    "{case}: {estimate:e} for {exact_condition:e}"
                );
                max_ratio = max_ratio.max(ratio);
            }
        }
        println!("largest ratio of exact value to estimate: {max_ratio}");
    }

    #[test]
    fn condition_number_of_a_diagonal_matrix_is_one_and_of_a_singular_matrix_infinite() {
        assert!((dense_condition(&[1e-9, 0.0, 0.0, 1e9], 2) - 1.0).abs() < 1e-15);
        assert_eq!(dense_condition(&[1.0, 2.0, 2.0, 4.0], 2), f64::INFINITY);
        assert_eq!(dense_condition(&[0.0; 4], 2), f64::INFINITY);
        assert_eq!(dense_condition(&[], 0), 1.0);
    }
}
