//! Least squares with unknowns that are not negative.

/// x ≥ 0 that minimises |A x − b| (Lawson & Hanson 1974, ch. 23), A row-major with `columns`
/// columns; meant for a dozen columns.
pub(super) fn least_squares(matrix: &[f64], columns: usize, right: &[f64]) -> Vec<f64> {
    let rows = right.len();
    let mut x = vec![0.0; columns];
    let mut free = vec![false; columns];
    let column = |j: usize| (0..rows).map(move |i| matrix[i * columns + j]);
    let dot = |j: usize, v: &[f64]| column(j).zip(v).map(|(a, b)| a * b).sum::<f64>();
    // Each pass frees one unknown; a few may go back and forth.
    for _ in 0..10 * columns {
        let residual: Vec<f64> = (0..rows)
            .map(|i| right[i] - (0..columns).map(|j| matrix[i * columns + j] * x[j]).sum::<f64>())
            .collect();
        let size = right.iter().map(|b| b * b).sum::<f64>().sqrt();
        let gradient = |j: usize| dot(j, &residual);
        let length = |j: usize| column(j).map(|a| a * a).sum::<f64>().sqrt();
        let best = (0..columns)
            .filter(|&j| !free[j] && gradient(j) > 1e-12 * size * length(j))
            .max_by(|&i, &j| gradient(i).total_cmp(&gradient(j)));
        let Some(best) = best else { break };
        free[best] = true;
        loop {
            let trial = restricted(matrix, columns, right, &free);
            let step = (0..columns)
                .filter(|&j| free[j] && trial[j] <= 0.0)
                .map(|j| x[j] / (x[j] - trial[j]))
                .fold(1.0, f64::min);
            for j in 0..columns {
                x[j] += step * (trial[j] - x[j]);
            }
            if step >= 1.0 {
                break;
            }
            for j in 0..columns {
                if free[j] && trial[j] <= 0.0 && x[j] <= 1e-14 {
                    (free[j], x[j]) = (false, 0.0);
                }
            }
        }
    }
    x
}

/// Least squares over the free unknowns by modified Gram–Schmidt; the others are zero.
fn restricted(matrix: &[f64], columns: usize, right: &[f64], free: &[bool]) -> Vec<f64> {
    let rows = right.len();
    let chosen: Vec<usize> = (0..columns).filter(|&j| free[j]).collect();
    let count = chosen.len();
    let mut basis: Vec<Vec<f64>> =
        chosen.iter().map(|&j| (0..rows).map(|i| matrix[i * columns + j]).collect()).collect();
    let mut upper = vec![0.0; count * count];
    let mut rest = right.to_vec();
    let mut projected = vec![0.0; count];
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for j in 0..count {
        let (done, todo) = basis.split_at_mut(j);
        let current = &mut todo[0];
        for (i, other) in done.iter().enumerate() {
            let share = dot(other, current);
            upper[i * count + j] = share;
            for (value, other) in current.iter_mut().zip(other) {
                *value -= share * other;
            }
        }
        let size = dot(current, current).sqrt().max(f64::MIN_POSITIVE);
        upper[j * count + j] = size;
        for value in current.iter_mut() {
            *value /= size;
        }
        projected[j] = dot(current, &rest);
        for (rest, value) in rest.iter_mut().zip(current.iter()) {
            *rest -= projected[j] * value;
        }
    }
    let mut x = vec![0.0; columns];
    for j in (0..count).rev() {
        let known: f64 = (j + 1..count).map(|i| upper[j * count + i] * x[chosen[i]]).sum();
        x[chosen[j]] = (projected[j] - known) / upper[j * count + j];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknowns_that_would_be_negative_are_zero() {
        // [[1, 1], [1, −1]]: free solutions (2, 1), (2, −1) and (−2, 1).
        let matrix = [1.0, 1.0, 1.0, -1.0];
        for (right, wanted) in
            [([3.0, 1.0], [2.0, 1.0]), ([1.0, 3.0], [2.0, 0.0]), ([-1.0, -3.0], [0.0, 1.0])]
        {
            let found = least_squares(&matrix, 2, &right);
            for (found, wanted) in found.iter().zip(wanted) {
                assert!((found - wanted).abs() < 1e-14 && *found >= 0.0, "{found} {wanted}");
            }
        }
    }
}
