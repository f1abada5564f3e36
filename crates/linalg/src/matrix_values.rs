//! Values of a sparse matrix in an unchanged pattern.

use crate::Triplets;
use crate::matrix::SparseMatrix;

impl SparseMatrix {
    /// The values in the pattern of another matrix.
    ///
    /// `None` if an entry is outside this pattern.
    pub fn values_at(&self, pattern: &Self) -> Option<Vec<f64>> {
        let mut values = vec![0.0; pattern.entry_count()];
        for (index, value) in self.indices_in(pattern)?.into_iter().zip(&self.values) {
            values[index] = *value;
        }
        Some(values)
    }

    /// Index of each entry in the pattern of another matrix.
    ///
    /// `None` if an entry is outside this pattern.
    pub fn indices_in(&self, pattern: &Self) -> Option<Vec<usize>> {
        let mut indices = Vec::with_capacity(self.entry_count());
        for row in 0..self.order {
            let mut index = *pattern.row_starts.get(row)?;
            let end = *pattern.row_starts.get(row + 1)?;
            for (column, _) in self.row(row) {
                index += pattern.columns[index..end].iter().take_while(|j| **j < column).count();
                if index == end || pattern.columns[index] != column {
                    return None;
                }
                indices.push(index);
            }
        }
        Some(indices)
    }

    /// Replaces the values by `constant_values` plus `factor` · A, without allocating.
    ///
    /// `indices`: index of each entry of A in the pattern, from [`SparseMatrix::indices_in`].
    pub fn set_sum(
        &mut self,
        constant_values: &[f64],
        factor: f64,
        matrix: &Self,
        indices: &[usize],
    ) {
        self.values.copy_from_slice(constant_values);
        for (index, value) in indices.iter().zip(&matrix.values) {
            self.values[*index] += factor * value;
        }
    }

    /// Whether another matrix stores entries at the same places.
    pub fn has_pattern_of(&self, other: &Self) -> bool {
        self.row_starts == other.row_starts && self.columns == other.columns
    }

    /// Copies the values of another matrix of the same pattern.
    pub fn copy_values(&mut self, other: &Self) {
        self.values.copy_from_slice(&other.values);
    }

    /// This pattern with other values, row by row; `None` for another number of values.
    pub fn with_values(self, values: &[f64]) -> Option<Self> {
        (values.len() == self.values.len()).then(|| Self { values: values.to_vec(), ..self })
    }

    /// Whether another matrix has other entries.
    ///
    /// Values are compared before places: matrices of one pattern mostly differ in a value.
    pub fn differs_from(&self, other: &Self) -> bool {
        self.values != other.values || self != other
    }

    /// Values of all stored entries, row by row.
    #[inline]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Replaces the values by the sums of `triplets`.
    ///
    /// `indices` has the index of each triplet's entry from the last call, so that unchanged entries need no search; it
    /// may be empty. Allocates only for more triplets than before. Returns false, with undefined values, if an entry is
    /// outside the pattern or not finite.
    pub fn refill(&mut self, triplets: &Triplets, indices: &mut Vec<usize>) -> bool {
        self.values.fill(0.0);
        indices.resize(triplets.entries().len(), usize::MAX);
        triplets.entries().iter().zip(indices).all(|(&(row, column, value), index)| {
            let start = self.row_starts.get(row).copied().unwrap_or(0);
            let end = self.row_starts.get(row + 1).copied().unwrap_or(0).max(start);
            let is_found = (start..end).contains(index) && self.columns[*index] == column;
            if !is_found {
                let Ok(k) = self.columns[start..end].binary_search(&column) else {
                    return false;
                };
                *index = start + k;
            }
            self.values[*index] += value;
            value.is_finite()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refill_sums_entries_or_rejects_them() {
        let mut triplets = Triplets::new(2);
        triplets.add(0, 1, 1.0);
        triplets.add(0, 1, 2.0);
        let mut matrix = SparseMatrix::new("test", &triplets).unwrap();
        triplets.add(0, 1, 0.5);
        let mut indices = Vec::new();
        assert!(matrix.refill(&triplets, &mut indices));
        assert_eq!(indices, [0; 3]);
        assert_eq!(matrix.entries().collect::<Vec<_>>(), [(0, 1, 3.5)]);
        for (row, column, value) in [(1, 1, 1.0), (5, 1, 1.0), (0, 1, f64::NAN)] {
            let mut invalid_triplets = triplets.clone();
            invalid_triplets.add(row, column, value);
            assert!(!matrix.refill(&invalid_triplets, &mut indices));
        }
    }

    #[test]
    fn sums_in_a_pattern_are_new_sums() {
        let constant = Triplets::from_entries(3, [(0, 0, 2.0), (1, 1, 3.0), (2, 0, 0.1)]);
        let constant = SparseMatrix::new("", &constant).unwrap();
        let changing = Triplets::from_entries(3, [(0, 0, 0.7), (1, 2, 0.3)]);
        let changing = SparseMatrix::new("", &changing).unwrap();
        let mut sum = SparseMatrix::sum("", 3, &[(1.0, &constant), (0.5, &changing)]).unwrap();
        let expected = SparseMatrix::sum("", 3, &[(1.0, &constant), (0.3, &changing)]).unwrap();
        let constant_values = constant.values_at(&sum).unwrap();
        let indices = changing.indices_in(&sum).unwrap();
        assert_eq!(indices, [0, 2]);
        sum.set_sum(&constant_values, 0.3, &changing, &indices);
        assert_eq!(sum, expected);
        assert!(sum.indices_in(&changing).is_none());
        let mut copy = sum.clone();
        copy.values.fill(0.0);
        assert!(copy.differs_from(&sum) && copy.has_pattern_of(&sum));
        copy.copy_values(&sum);
        assert!(!copy.differs_from(&sum) && !copy.has_pattern_of(&changing));
        let mut moved_sum = sum.clone();
        moved_sum.columns.swap(0, 1);
        assert!(moved_sum.differs_from(&sum));
    }
}
