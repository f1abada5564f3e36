//! Symmetry of sparse matrices.

use super::matrix::SparseMatrix;

/// Largest relative asymmetry of a matrix that is factored as a symmetric one: a rounding error.
pub(super) const MAX_ASYMMETRY: f64 = 1e-13;

/// Stored entry a_ij with its mirrored entry a_ji.
struct MirroredEntry {
    row: usize,
    column: usize,
    value: f64,
    mirrored_value: f64,
}

impl SparseMatrix {
    /// Whether the matrix is symmetric up to rounding, so that it may be factored as a symmetric one.
    pub fn is_symmetric(&self) -> bool {
        self.asymmetry() <= MAX_ASYMMETRY
    }

    /// Largest |a_ij − a_ji| relative to the largest |a_ij|.
    pub fn asymmetry(&self) -> f64 {
        relative_asymmetry(self.mirrored_entries().map(|entry| (entry.value, entry.mirrored_value)))
    }

    /// The pair of mirrored entries whose difference exceeds the allowed difference most; `None` if none does.
    ///
    /// `allowed_difference(row, column)` belongs to one pair. Returns row, column, and [a_ij, a_ji].
    pub fn unsymmetric_pair(
        &self,
        allowed_difference: impl Fn(usize, usize) -> f64,
    ) -> Option<(usize, usize, [f64; 2])> {
        let mut max_excess = 0.0;
        let mut worst_pair = None;
        for MirroredEntry { row, column, value, mirrored_value } in self.mirrored_entries() {
            let excess = (value - mirrored_value).abs() - allowed_difference(row, column);
            // Of equal excesses, the first pair is returned.
            if excess > max_excess {
                max_excess = excess;
                worst_pair = Some((row, column, [value, mirrored_value]));
            }
        }
        worst_pair
    }

    /// All stored entries with their mirrored entries.
    fn mirrored_entries(&self) -> impl Iterator<Item = MirroredEntry> {
        self.entries().zip(self.mirrored_indices()).map(|((row, column, value), index)| {
            let mirrored_value = self.values.get(index).copied().unwrap_or(0.0);
            MirroredEntry { row, column, value, mirrored_value }
        })
    }

    /// Index of the mirrored entry of each stored entry; `usize::MAX` if it is not stored.
    pub(super) fn mirrored_indices(&self) -> impl Iterator<Item = usize> {
        // Rows ascend, so each search in the row of a mirrored entry continues from the end of the previous search
        // there.
        let mut search_starts = self.row_starts.clone();
        self.entries().map(move |(row, column, _)| {
            let end = self.row_starts[column + 1];
            let start = search_starts[column];
            let index = start + self.columns[start..end].iter().take_while(|j| **j < row).count();
            search_starts[column] = index;
            let is_stored = index < end && self.columns[index] == row;
            if is_stored { index } else { usize::MAX }
        })
    }
}

/// Largest difference of mirrored entries relative to the largest entry, from the pairs of all stored entries.
pub(super) fn relative_asymmetry(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut max_value = 0.0_f64;
    let mut max_difference = 0.0_f64;
    for (value, mirrored_value) in pairs {
        max_value = max_value.max(value.abs());
        max_difference = max_difference.max((value - mirrored_value).abs());
    }
    if max_value > 0.0 { max_difference / max_value } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Triplets;

    /// REFERENCE: the dense matrix.
    #[test]
    fn asymmetry_is_that_of_the_dense_matrix() {
        let mut triplets = Triplets::new(7);
        (0..25).for_each(|k| triplets.add(k * k % 7, (5 * k + 2) % 7, k as f64 - 9.5));
        let matrix = SparseMatrix::new("test", &triplets).unwrap();
        let mut dense = [[0.0; 7]; 7];
        matrix.entries().for_each(|(i, j, value)| dense[i][j] = value);
        let mut max_value = 0.0_f64;
        let mut max_difference = 0.0_f64;
        for (i, j, value) in matrix.entries() {
            max_value = max_value.max(value.abs());
            max_difference = max_difference.max((value - dense[j][i]).abs());
        }
        assert!(max_difference > 0.0);
        assert_eq!(matrix.asymmetry(), max_difference / max_value);
        let (row, column, pair) = matrix.unsymmetric_pair(|_, _| 0.0).unwrap();
        assert_eq!(pair, [dense[row][column], dense[column][row]]);
        assert_eq!((pair[0] - pair[1]).abs(), max_difference);
    }
}
