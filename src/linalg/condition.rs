//! Condition numbers from factors.
//!
//! The condition is that of the matrix scaled by the roots of its diagonal, SAS with sᵢ = |aᵢᵢ|^−½:
//! it does not depend on units (a degree of freedom may be a length or an angle), it is within a factor of
//! the order of the least that any scaling reaches for positive definite matrices (van der Sluis
//! 1969), and it is what bounds the error of a Cholesky solve, scaled or not (Higham 2002, theorem
//! 10.6 with § 10.1.1).

use super::{DenseFactor, SparseFactor};
use crate::linalg::SparseMatrix;

/// Solves of the estimator, at most, with A and with Aᵀ.
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
    // A vector that catches what the iteration may miss.
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

/// Condition of a dense row-major matrix scaled by its diagonal, in the 1-norm; infinite if it is
/// singular.
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

/// The same for a sparse matrix with its factors.
pub(crate) fn sparse_condition(matrix: &SparseMatrix, factor: &mut SparseFactor) -> f64 {
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
            factor.solve(x);
        }
        scale(x, &scales);
    })
}

#[cfg(test)]
mod tests;
