//! Least-squares solution with unknowns that are not negative.

/// Largest number of passes, per column.
///
/// Each pass frees one unknown. Some unknowns are fixed and freed again, so that more passes than columns are possible.
const MAX_PASSES_PER_COLUMN: usize = 10;
/// Smallest gradient along a fixed unknown that frees it, relative to the norms of its column and of the right-hand side.
const GRADIENT_TOLERANCE: f64 = 1e-12;
/// Largest value of a decreasing unknown that counts as zero: above its rounding, below any ratio of interest.
const ZERO_TOLERANCE: f64 = 1e-14;

/// x ≥ 0 that minimises |A x − b| (Lawson & Hanson 1974, ch. 23).
///
/// A is row-major with `column_count` columns; `rhs` is b. The method is meant for a dozen columns.
pub(super) fn nonnegative_least_squares(
    matrix: &[f64],
    column_count: usize,
    rhs: &[f64],
) -> Vec<f64> {
    let row_count = rhs.len();
    let mut x = vec![0.0; column_count];
    let mut is_free = vec![false; column_count];
    for _ in 0..MAX_PASSES_PER_COLUMN * column_count {
        let residual: Vec<f64> = (0..row_count)
            .map(|i| {
                rhs[i] - (0..column_count).map(|j| matrix[i * column_count + j] * x[j]).sum::<f64>()
            })
            .collect();
        let rhs_norm = rhs.iter().map(|b| b * b).sum::<f64>().sqrt();
        let mut gradients = vec![0.0; column_count];
        let mut column_norms = vec![0.0; column_count];
        for j in 0..column_count {
            gradients[j] = column(matrix, column_count, j).zip(&residual).map(|(a, b)| a * b).sum();
            column_norms[j] = column(matrix, column_count, j).map(|a| a * a).sum::<f64>().sqrt();
        }
        let steepest_column = (0..column_count)
            .filter(|&j| {
                !is_free[j] && gradients[j] > GRADIENT_TOLERANCE * rhs_norm * column_norms[j]
            })
            .max_by(|&i, &j| gradients[i].total_cmp(&gradients[j]));
        let Some(steepest_column) = steepest_column else { break };
        is_free[steepest_column] = true;
        loop {
            let trial_solution = free_least_squares(matrix, column_count, rhs, &is_free);
            let step_fraction = (0..column_count)
                .filter(|&j| is_free[j] && trial_solution[j] <= 0.0)
                .map(|j| x[j] / (x[j] - trial_solution[j]))
                .fold(1.0, f64::min);
            for j in 0..column_count {
                x[j] += step_fraction * (trial_solution[j] - x[j]);
            }
            if step_fraction >= 1.0 {
                break;
            }
            for j in 0..column_count {
                if is_free[j] && trial_solution[j] <= 0.0 && x[j] <= ZERO_TOLERANCE {
                    is_free[j] = false;
                    x[j] = 0.0;
                }
            }
        }
    }
    x
}

/// Column j of a row-major matrix.
fn column(matrix: &[f64], column_count: usize, j: usize) -> impl Iterator<Item = f64> {
    matrix.iter().skip(j).step_by(column_count).copied()
}

/// Least squares over the free unknowns by modified Gram–Schmidt; the other unknowns are zero.
fn free_least_squares(
    matrix: &[f64],
    column_count: usize,
    rhs: &[f64],
    is_free: &[bool],
) -> Vec<f64> {
    let free_columns: Vec<usize> = (0..column_count).filter(|&j| is_free[j]).collect();
    let free_count = free_columns.len();
    let mut basis: Vec<Vec<f64>> =
        free_columns.iter().map(|&j| column(matrix, column_count, j).collect()).collect();
    let mut upper_triangle = vec![0.0; free_count * free_count];
    let mut residual = rhs.to_vec();
    let mut rhs_projections = vec![0.0; free_count];
    for j in 0..free_count {
        let (orthonormal, remaining_columns) = basis.split_at_mut(j);
        let candidate = &mut remaining_columns[0];
        for (i, vector) in orthonormal.iter().enumerate() {
            let projection = dot(vector, candidate);
            upper_triangle[i * free_count + j] = projection;
            for (value, entry) in candidate.iter_mut().zip(vector) {
                *value -= projection * entry;
            }
        }
        let candidate_norm = dot(candidate, candidate).sqrt().max(f64::MIN_POSITIVE);
        upper_triangle[j * free_count + j] = candidate_norm;
        for value in candidate.iter_mut() {
            *value /= candidate_norm;
        }
        rhs_projections[j] = dot(candidate, &residual);
        for (residual, value) in residual.iter_mut().zip(candidate.iter()) {
            *residual -= rhs_projections[j] * value;
        }
    }
    let mut x = vec![0.0; column_count];
    for j in (0..free_count).rev() {
        let solved_terms: f64 = (j + 1..free_count)
            .map(|i| upper_triangle[j * free_count + i] * x[free_columns[i]])
            .sum();
        x[free_columns[j]] =
            (rhs_projections[j] - solved_terms) / upper_triangle[j * free_count + j];
    }
    x
}

/// Scalar product, summed in order.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknowns_that_would_be_negative_are_zero() {
        // The matrix [[1, 1], [1, −1]]; without the bound the solutions are (2, 1), (2, −1) and (−2, 1).
        let matrix = [1.0, 1.0, 1.0, -1.0];
        for (rhs, expected) in
            [([3.0, 1.0], [2.0, 1.0]), ([1.0, 3.0], [2.0, 0.0]), ([-1.0, -3.0], [0.0, 1.0])]
        {
            let computed = nonnegative_least_squares(&matrix, 2, &rhs);
            for (computed, expected) in computed.iter().zip(expected) {
                assert!(
                    (computed - expected).abs() < 1e-14 && *computed >= 0.0,
                    "{computed} {expected}"
                );
            }
        }
    }
}
