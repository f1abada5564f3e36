//! Inverse and products of small matrices.

use super::vector::cross;

/// Pivot, relative to the largest entry of the matrix, below which a matrix counts as singular.
const MIN_RELATIVE_PIVOT: f64 = 1e-14;

/// Inverse of a matrix; `None` for a singular one.
pub(super) fn inverse<const N: usize>(matrix: [[f64; N]; N]) -> Option<[[f64; N]; N]> {
    match N {
        2 => inverse_of_two(matrix),
        3 => inverse_of_three(matrix),
        _ => inverse_by_elimination(matrix),
    }
}

/// Inverse of a matrix of order two by its determinant.
fn inverse_of_two<const N: usize>(matrix: [[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let [[a, b], [c, d]] = [0, 1].map(|i| [matrix[i][0], matrix[i][1]]);
    let diagonal = a * d;
    let off_diagonal = b * c;
    let determinant = diagonal - off_diagonal;
    let scale = diagonal.abs().max(off_diagonal.abs());
    let is_regular = determinant.abs() > MIN_RELATIVE_PIVOT * scale && determinant.is_finite();
    let mut inverse = [[0.0; N]; N];
    inverse[0][0] = d / determinant;
    inverse[0][1] = -b / determinant;
    inverse[1][0] = -c / determinant;
    inverse[1][1] = a / determinant;
    is_regular.then_some(inverse)
}

/// Inverse of a matrix of order three by its cofactors, with scaled rows.
fn inverse_of_three<const N: usize>(matrix: [[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut rows = [0, 1, 2].map(|i| [matrix[i][0], matrix[i][1], matrix[i][2]]);
    let mut factors = [0.0; 3];
    for (row, factor) in rows.iter_mut().zip(&mut factors) {
        *factor = 1.0 / row.iter().fold(0.0_f64, |max, entry| max.max(entry.abs()));
        for entry in row {
            *entry *= *factor;
        }
    }
    let cofactors = [cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])];
    let terms = [0, 1, 2].map(|k| rows[0][k] * cofactors[0][k]);
    let determinant = terms[0] + terms[1] + terms[2];
    let is_regular = determinant.abs() >= MIN_RELATIVE_PIVOT && determinant.is_finite();
    let mut inverse = [[0.0; N]; N];
    for i in 0..3 {
        for j in 0..3 {
            inverse[i][j] = cofactors[j][i] / determinant * factors[j];
        }
    }
    is_regular.then_some(inverse)
}

/// Inverse of a matrix by elimination with row pivoting; `None` for a singular one.
fn inverse_by_elimination<const N: usize>(mut matrix: [[f64; N]; N]) -> Option<[[f64; N]; N]> {
    // Scale of each row, so that rows of different units do not matter.
    let mut inverse = [[0.0; N]; N];
    for (i, (row, unit_row)) in matrix.iter_mut().zip(&mut inverse).enumerate() {
        let scale = row.iter().fold(0.0_f64, |max, entry| max.max(entry.abs()));
        if scale.is_nan() || scale <= 0.0 || scale.is_infinite() {
            return None;
        }
        for entry in row.iter_mut() {
            *entry /= scale;
        }
        unit_row[i] = 1.0 / scale;
    }
    for pivot in 0..N {
        let row = (pivot..N)
            .max_by(|a, b| matrix[*a][pivot].abs().total_cmp(&matrix[*b][pivot].abs()))?;
        matrix.swap(pivot, row);
        inverse.swap(pivot, row);
        let value = matrix[pivot][pivot];
        if value.is_nan() || value.abs() < MIN_RELATIVE_PIVOT {
            return None;
        }
        for column in 0..N {
            matrix[pivot][column] /= value;
            inverse[pivot][column] /= value;
        }
        for other_row in (0..N).filter(|other_row| *other_row != pivot) {
            let factor = matrix[other_row][pivot];
            for column in 0..N {
                matrix[other_row][column] -= factor * matrix[pivot][column];
                inverse[other_row][column] -= factor * inverse[pivot][column];
            }
        }
    }
    Some(inverse)
}

/// Product of a matrix and a vector.
pub(super) fn product<const R: usize, const C: usize>(
    matrix: &[[f64; C]; R],
    vector: &[f64; C],
) -> [f64; R] {
    matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
}

/// Adds factor · aᵀ c a to `sum`.
pub(super) fn add_congruent<const R: usize, const C: usize>(
    factor: f64,
    a: &[[f64; C]; R],
    c: &[[f64; R]; R],
    sum: &mut [[f64; C]; C],
) {
    for (k, row) in c.iter().enumerate() {
        for (l, value) in row.iter().enumerate() {
            for i in 0..C {
                let left_factor = factor * value * a[k][i];
                for j in 0..C {
                    sum[i][j] += left_factor * a[l][j];
                }
            }
        }
    }
}

/// Adds factor · aᵀ x to `sum`.
pub(super) fn add_transposed<const R: usize, const C: usize>(
    factor: f64,
    a: &[[f64; C]; R],
    x: &[f64; R],
    sum: &mut [f64; C],
) {
    for (row, value) in a.iter().zip(x) {
        for (total, entry) in sum.iter_mut().zip(row) {
            *total += factor * entry * value;
        }
    }
}

/// Adds factor · r rᵀ, with r = `row`, to `matrix`.
pub(super) fn add_outer<const N: usize>(factor: f64, row: &[f64; N], matrix: &mut [[f64; N]; N]) {
    for (entries, a) in matrix.iter_mut().zip(row) {
        for (entry, b) in entries.iter_mut().zip(row) {
            *entry += factor * a * b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_inverse<const N: usize>(matrix: [[f64; N]; N]) {
        let inverse = inverse(matrix).unwrap();
        for i in 0..N {
            for j in 0..N {
                let sum: f64 = (0..N).map(|k| inverse[i][k] * matrix[k][j]).sum();
                let scale: f64 = (0..N).map(|k| (inverse[i][k] * matrix[k][j]).abs()).sum();
                let unit = if i == j { 1.0 } else { 0.0 };
                assert!((sum - unit).abs() < 1e-14 * scale.max(1.0), "{i} {j} {sum}");
            }
        }
    }

    #[test]
    fn inverses_of_matrices_of_mixed_units() {
        let matrix = [[2.0e9, 3.0e6, 1.0e3], [1.0e3, 5.0, -2.0], [4.0e-6, 1.0e-9, 7.0e-9]];
        assert_inverse(matrix);
        assert_inverse([[2.0e9, 3.0e6], [1.0e3, 5.0]]);
        let rows = [[4.0, 1.0, 2.0, 0.5, 3.0], [1.0e3, 2.0, -1.0, 1.0, 0.0]];
        let more_rows = [
            [0.0, 1.0e-6, 2.0e-6, 0.0, 0.0],
            [1.0, 1.0, 1.0, 7.0, 1.0],
            [0.0, 0.0, 2.0, 3.0, -5.0],
        ];
        assert_inverse([rows[0], rows[1], more_rows[0], more_rows[1], more_rows[2]]);
        assert!(super::inverse([[1.0, 2.0], [2.0, 4.0]]).is_none());
        assert!(super::inverse([[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [0.0, 1.0, 1.0]]).is_none());
        assert!(super::inverse([[0.0; 3], [1.0; 3], [2.0, 0.0, 1.0]]).is_none());
        assert!(super::inverse([[0.0, 0.0], [0.0, 1.0]]).is_none());
        assert!(super::inverse([[f64::NAN, 0.0], [0.0, 1.0]]).is_none());
    }
}
