//! Condition numbers from factors.
//!
//! The condition number is computed for the matrix scaled by the roots of its diagonal: SAS with
//! sᵢ = |aᵢᵢ|^−½. It does not depend on units (a degree of freedom may be a length or an angle). For positive
//! definite matrices it is at most the order times the smallest condition number that any diagonal scaling
//! reaches (van der Sluis 1969). It bounds the error of a Cholesky solve, scaled or not (Higham 2002, theorem
//! 10.6 with § 10.1.1).

use super::{DenseFactor, SparseFactor, SparseMatrix};

/// Largest number of solves of the estimator, with A and with Aᵀ.
const ITERATIONS: usize = 5;

/// Estimate of ‖A⁻¹‖₁ from `solve(b, transposed)`, which overwrites b with A⁻¹ b or A⁻ᵀ b.
///
/// Hager's algorithm with Higham's refinements (Higham 2002, algorithm 15.4; LAPACK's dlacn2): a
/// lower bound, nearly always within a factor of three. Infinite if a solve is not finite.
fn inverse_norm(order: usize, solve: &mut dyn FnMut(&mut [f64], bool)) -> f64 {
    let mut x = vec![1.0 / order as f64; order];
    let mut signs = vec![0.0; order];
    let mut estimate = 0.0_f64;
    let mut place = usize::MAX;
    for iteration in 0..ITERATIONS {
        solve(&mut x, false);
        let norm: f64 = x.iter().map(|x| x.abs()).sum();
        if !norm.is_finite() {
            return f64::INFINITY;
        }
        let same = signs.iter().zip(&x).all(|(s, x)| *s == x.signum());
        if iteration > 0 && (norm <= estimate || same) {
            estimate = estimate.max(norm);
            break;
        }
        estimate = norm;
        signs.iter_mut().zip(&x).for_each(|(s, x)| *s = x.signum());
        x.copy_from_slice(&signs);
        solve(&mut x, true);
        let best = (0..order).fold(0, |a, b| if x[b].abs() > x[a].abs() { b } else { a });
        if best == place {
            break;
        }
        place = best;
        x.fill(0.0);
        x[place] = 1.0;
    }
    // This vector finds norms that the iteration may miss.
    let last = order.max(2) as f64 - 1.0;
    for (i, x) in x.iter_mut().enumerate() {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        *x = sign * (1.0 + i as f64 / last);
    }
    solve(&mut x, false);
    let other: f64 = x.iter().map(|x| x.abs()).sum::<f64>() * 2.0 / (3.0 * order as f64);
    if other.is_finite() { estimate.max(other) } else { f64::INFINITY }
}

/// Roots of the diagonal's magnitudes; one where it is zero.
fn scales(diagonal: impl Iterator<Item = f64>) -> Vec<f64> {
    diagonal.map(|d| if d == 0.0 { 1.0 } else { d.abs().sqrt() }).collect()
}

fn scale(values: &mut [f64], scales: &[f64]) {
    values.iter_mut().zip(scales).for_each(|(x, s)| *x *= s);
}

/// Condition number of a dense row-major matrix scaled by its diagonal, in the 1-norm.
///
/// Infinite if the matrix is singular.
pub(crate) fn dense_condition(matrix: &[f64], order: usize) -> f64 {
    if order == 0 {
        return 1.0;
    }
    let scales = scales((0..order).map(|i| matrix[i * order + i]));
    let scaled: Vec<f64> =
        (0..order * order).map(|k| matrix[k] / (scales[k / order] * scales[k % order])).collect();
    let column = |j: usize| (0..order).map(|i| scaled[i * order + j].abs()).sum::<f64>();
    let norm = (0..order).map(column).fold(0.0, f64::max);
    let mut factor = DenseFactor::with_capacity(order);
    if !factor.factor(&scaled, order) {
        return f64::INFINITY;
    }
    norm * inverse_norm(order, &mut |x, transposed| {
        if transposed { factor.solve_transposed(x) } else { factor.solve(x) }
    })
}

/// Condition number of a sparse matrix scaled by its diagonal, from its factors, in the 1-norm.
pub(crate) fn sparse_condition(matrix: &SparseMatrix, factor: &SparseFactor) -> f64 {
    let order = matrix.order();
    let scales = scales(matrix.diagonal().into_iter());
    let mut columns = vec![0.0; order];
    for (row, column, value) in matrix.entries() {
        columns[column] += value.abs() / (scales[row] * scales[column]);
    }
    let norm = columns.into_iter().fold(0.0, f64::max);
    norm * inverse_norm(order, &mut |x, transposed| {
        scale(x, &scales);
        if transposed {
            factor.solve_transposed(x);
        } else {
            factor.solve_many(x);
        }
        scale(x, &scales);
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Triplets;
    use basemat_testkit::random::Random;

    #[test]
    fn estimates_are_within_a_factor_of_three_of_the_inverse() {
        let mut random = Random(3);
        let mut worst = 1.0_f64;
        for case in 0..400 {
            let n = 1 + case % 12;
            // Any condition, any units.
            let own = random.log_within(1e-10, 1.0);
            let units: Vec<f64> = (0..n).map(|_| random.log_within(1e-6, 1e6)).collect();
            let root: Vec<f64> = (0..n * n).map(|_| random.within(-1.0, 1.0)).collect();
            let skew = if case % 3 == 0 { 0.5 } else { 0.0 };
            let mut matrix = vec![0.0; n * n];
            for (i, j) in (0..n * n).map(|k| (k / n, k % n)) {
                // One direction is almost missing.
                let product: f64 = (1..n).map(|k| root[i * n + k] * root[j * n + k]).sum();
                let rest = if i == j { own } else { skew * root[i.min(j) * n + i.max(j)] };
                let sign = if i < j { -1.0 } else { 1.0 };
                matrix[i * n + j] = (product + sign * rest) * units[i] * units[j];
                if i == j {
                    matrix[i * n + j] = matrix[i * n + j].abs();
                }
            }
            let exact = basemat_testkit::dense::condition_by_inverse(&matrix, n);
            let mut triplets = Triplets::new(n);
            for (k, value) in matrix.iter().enumerate() {
                triplets.add(k / n, k % n, *value);
            }
            let sparse = SparseMatrix::new("test", &triplets).unwrap();
            let factor = SparseFactor::new("test", &triplets).unwrap();
            for found in [dense_condition(&matrix, n), sparse_condition(&sparse, &factor)] {
                // The estimate is a lower bound up to rounding, and rarely far below the exact value.
                let ratio = exact / found;
                assert!(ratio > 0.99 && ratio < 3.0, "{case}: {found:e} for {exact:e}");
                worst = worst.max(ratio);
            }
        }
        println!("exact over estimate: {worst} at most");
    }

    #[test]
    fn singular_and_diagonal_matrices_have_their_conditions() {
        assert!((dense_condition(&[1e-9, 0.0, 0.0, 1e9], 2) - 1.0).abs() < 1e-15);
        assert_eq!(dense_condition(&[1.0, 2.0, 2.0, 4.0], 2), f64::INFINITY);
        assert_eq!(dense_condition(&[0.0; 4], 2), f64::INFINITY);
        assert_eq!(dense_condition(&[], 0), 1.0);
    }
}
