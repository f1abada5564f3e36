//! Solutions with the factors of a matrix for another matrix in which few rows differ.
//!
//! | symbol | meaning |
//! |---|---|
//! | A | factored matrix |
//! | e_k, r_k | unit vector of changed row k, and its difference from the row of A |
//! | A_k | A after the changes of the first k rows: A_{k−1} + e_k r_kᵀ |
//!
//! With z_k = A_{k−1}⁻¹ e_k the solution is A_k⁻¹ b = x − z_k (r_k · x)/(1 + r_k · z_k), where x = A_{k−1}⁻¹ b (Sherman &
//! Morrison 1950; Hager 1989, SIAM Rev. 31, 221). The denominator is the ratio of the determinants of A_k and A_{k−1}.

use crate::linalg::{DenseFactor, dot, transposed_multiply_add};

/// Largest number of changed rows: solves with more of them take as long as a factorization.
pub(super) const MAX_CHANGED_ROWS: usize = 6;
/// Largest number of rows whose columns of A⁻¹ are stored.
const MAX_STORED_COLUMNS: usize = 16;
/// Largest factor by which small ratios of determinants may raise rounding errors, over all changes.
const MAX_ERROR_GROWTH: f64 = 1e3;
/// Largest factor by which the changes may raise the determinant.
///
/// A matrix A that is nearly singular, with large errors in its solutions, has a larger one.
const MAX_DETERMINANT_GROWTH: f64 = 1e6;

/// Changes of a few rows of a factored matrix.
pub(super) struct RowUpdates {
    /// Rows whose columns of A⁻¹ are stored.
    stored_rows: Vec<usize>,
    /// A⁻¹ e of the stored rows, one after the other.
    stored_columns: Vec<f64>,
    /// r_k of each change.
    differences: Vec<f64>,
    /// z_k of each change.
    columns: Vec<f64>,
    /// Reciprocal of 1 + r_k · z_k of each change.
    inverse_ratios: Vec<f64>,
    /// Products over the changes: of the reciprocals of ratios below one, and of ratios above one.
    growth: [f64; 2],
}

impl RowUpdates {
    /// Allocates for matrices up to order `capacity`.
    pub(super) fn with_capacity(capacity: usize) -> Self {
        Self {
            stored_rows: Vec::with_capacity(MAX_STORED_COLUMNS),
            stored_columns: Vec::with_capacity(MAX_STORED_COLUMNS * capacity),
            differences: Vec::with_capacity(MAX_CHANGED_ROWS * capacity),
            columns: Vec::with_capacity(MAX_CHANGED_ROWS * capacity),
            inverse_ratios: Vec::with_capacity(MAX_CHANGED_ROWS),
            growth: [1.0; 2],
        }
    }

    /// Discards everything; call this when A has changed.
    pub(super) fn begin_matrix(&mut self) {
        self.clear();
        self.stored_rows.clear();
        self.stored_columns.clear();
    }

    /// Discards the changes: solutions are again those with A.
    pub(super) fn clear(&mut self) {
        self.differences.clear();
        self.columns.clear();
        self.inverse_ratios.clear();
        self.growth = [1.0; 2];
    }

    /// Changes one more row by `difference`, with the factors of A.
    ///
    /// Returns `false` if there are too many changes, or if rounding errors would grow.
    pub(super) fn change_row(
        &mut self,
        factor: &mut DenseFactor,
        row: usize,
        difference: &[f64],
    ) -> bool {
        let order = difference.len();
        let stored = self.stored_rows.iter().position(|stored_row| *stored_row == row);
        let slot = stored.unwrap_or(self.stored_rows.len());
        if self.inverse_ratios.len() == MAX_CHANGED_ROWS || slot == MAX_STORED_COLUMNS {
            return false;
        }
        if stored.is_none() {
            let begin = self.stored_columns.len();
            self.stored_rows.push(row);
            self.stored_columns.resize(begin + order, 0.0);
            self.stored_columns[begin + row] = 1.0;
            factor.solve_small(&mut self.stored_columns[begin..]);
        }
        let begin = self.columns.len();
        self.columns.extend_from_slice(&self.stored_columns[slot * order..][..order]);
        let (earlier_columns, column) = self.columns.split_at_mut(begin);
        apply(earlier_columns, &self.differences, &self.inverse_ratios, column);
        let ratio = 1.0 + dot(difference, column);
        self.differences.extend_from_slice(difference);
        self.inverse_ratios.push(ratio.recip());
        self.growth[0] *= ratio.abs().recip().max(1.0);
        self.growth[1] *= ratio.abs().max(1.0);
        let is_accurate =
            self.growth[0] <= MAX_ERROR_GROWTH && self.growth[1] <= MAX_DETERMINANT_GROWTH;
        is_accurate && ratio.is_finite()
    }

    /// Overwrites A⁻¹ b with the solution for the changed rows.
    pub(super) fn correct(&self, solution: &mut [f64]) {
        apply(&self.columns, &self.differences, &self.inverse_ratios, solution);
    }
}

/// Overwrites A⁻¹ b with A_k⁻¹ b, change by change.
fn apply(columns: &[f64], differences: &[f64], inverse_ratios: &[f64], solution: &mut [f64]) {
    let order = solution.len();
    for (k, inverse_ratio) in inverse_ratios.iter().enumerate() {
        let factor = inverse_ratio * dot(&differences[k * order..][..order], solution);
        transposed_multiply_add(&columns[k * order..][..order], 1.0, &[-factor], solution);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basemat_testkit::random::Random;

    #[test]
    fn solutions_with_changed_rows_are_those_of_new_factors() {
        let mut random = Random(5);
        for order in [1, 2, 5, 12, 33] {
            let mut matrix: Vec<f64> =
                (0..order * order).map(|_| random.within(-0.2, 0.2)).collect();
            (0..order).for_each(|k| matrix[k * (order + 1)] += 2.0);
            let mut factor = DenseFactor::with_capacity(order);
            let mut changed_factor = DenseFactor::with_capacity(order);
            let mut updates = RowUpdates::with_capacity(order);
            assert!(factor.factor(&matrix, order));
            updates.begin_matrix();
            for count in [0, 1, 3, 6, 2] {
                let count = count.min(order);
                let mut changed = matrix.clone();
                updates.clear();
                for row in (0..count).map(|k| (3 * k + 1) % order) {
                    let difference: Vec<f64> =
                        (0..order).map(|_| random.within(-0.3, 0.3)).collect();
                    for (entry, change) in changed[row * order..].iter_mut().zip(&difference) {
                        *entry += change;
                    }
                    assert!(updates.change_row(&mut factor, row, &difference));
                }
                let mut solution: Vec<f64> = (0..order).map(|_| random.within(-1.0, 1.0)).collect();
                let mut expected = solution.clone();
                factor.solve_small(&mut solution);
                updates.correct(&mut solution);
                assert!(changed_factor.factor(&changed, order));
                changed_factor.solve_small(&mut expected);
                for (a, b) in solution.iter().zip(&expected) {
                    assert!((a - b).abs() < 1e-12, "order {order}, {count} rows: {a} for {b}");
                }
            }
        }
    }

    #[test]
    fn singular_and_too_many_changes_are_reported() {
        let order = 8;
        let mut identity = vec![0.0; order * order];
        (0..order).for_each(|k| identity[k * (order + 1)] = 1.0);
        let mut factor = DenseFactor::with_capacity(order);
        assert!(factor.factor(&identity, order));
        let mut updates = RowUpdates::with_capacity(order);
        let mut difference = vec![0.0; order];
        difference[2] = -1.0;
        assert!(!updates.change_row(&mut factor, 2, &difference));
        updates.clear();
        difference[2] = f64::NAN;
        assert!(!updates.change_row(&mut factor, 2, &difference));
        updates.clear();
        difference.fill(0.0);
        for row in 0..MAX_CHANGED_ROWS {
            assert!(updates.change_row(&mut factor, row, &difference));
        }
        assert!(!updates.change_row(&mut factor, MAX_CHANGED_ROWS, &difference));
    }
}
