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
    /// Whether the matrix is symmetric up to rounding.
    ///
    /// It may then be factored as a symmetric one.
    pub fn is_symmetric(&self) -> bool {
        self.asymmetry() <= MAX_ASYMMETRY
    }

    /// Largest |a_ij − a_ji| relative to the largest |a_ij|.
    pub fn asymmetry(&self) -> f64 {
        relative_asymmetry(self.mirrored_entries().map(|entry| (entry.value, entry.mirrored_value)))
    }

    /// The pair of mirrored entries whose difference exceeds the allowed difference most.
    ///
    /// `None` if none does.
    ///
    /// `allowed_difference(i, j)` is the largest |a_ij − a_ji| that counts as symmetric. Returns row, column, and
    /// [a_ij, a_ji].
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
    fn mirrored_indices(&self) -> impl Iterator<Item = usize> {
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

/// Largest difference of mirrored entries, relative to the largest entry.
///
/// `pairs`: those of all stored entries.
fn relative_asymmetry(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut max_value = 0.0_f64;
    let mut max_difference = 0.0_f64;
    for (value, mirrored_value) in pairs {
        max_value = max_value.max(value.abs());
        max_difference = max_difference.max((value - mirrored_value).abs());
    }
    if max_value > 0.0 { max_difference / max_value } else { 0.0 }
}

/// Indices of mirrored entries in the pattern of a matrix.
///
/// They give the asymmetry of the matrix whenever its values have changed.
pub(super) struct MirroredPairs {
    /// Indices of an entry above the diagonal and of its mirrored entry.
    pairs: Vec<[usize; 2]>,
    /// Indices of entries whose mirrored entry is not stored.
    single_indices: Vec<usize>,
}

impl MirroredPairs {
    /// Pairs in the pattern of a matrix.
    pub(super) fn of(matrix: &SparseMatrix) -> Self {
        let mut pairs = Vec::new();
        let mut single_indices = Vec::new();
        for (index, mirrored_index) in matrix.mirrored_indices().enumerate() {
            if mirrored_index == usize::MAX {
                single_indices.push(index);
            } else if index < mirrored_index {
                pairs.push([index, mirrored_index]);
            }
        }
        Self { pairs, single_indices }
    }

    /// Whether the mirrored entry of each entry is stored.
    pub(super) fn is_symmetric_pattern(&self) -> bool {
        self.single_indices.is_empty()
    }

    /// Largest |a_ij − a_ji| relative to the largest |a_ij|, as [`SparseMatrix::asymmetry`].
    pub(super) fn asymmetry(&self, matrix: &SparseMatrix) -> f64 {
        let values = &matrix.values;
        let max_value = largest_of(values.iter().map(|value| value.abs()));
        let differences = self.pairs.iter().map(|[a, b]| (values[*a] - values[*b]).abs());
        let single_values = self.single_indices.iter().map(|index| values[*index].abs());
        let max_difference = largest_of(differences).max(largest_of(single_values));
        if max_value > 0.0 { max_difference / max_value } else { 0.0 }
    }
}

/// Largest of the numbers, at least zero; NaN is ignored.
fn largest_of(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |max, number| if number > max { number } else { max })
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
        // The only entry whose mirrored entry is stored.
        triplets.add(2, 0, 4.5);
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
        let pairs = MirroredPairs::of(&matrix);
        assert!(!pairs.pairs.is_empty() && !pairs.single_indices.is_empty());
        assert_eq!(pairs.asymmetry(&matrix), max_difference / max_value);
        let (row, column, pair) = matrix.unsymmetric_pair(|_, _| 0.0).unwrap();
        assert_eq!(pair, [dense[row][column], dense[column][row]]);
        assert_eq!((pair[0] - pair[1]).abs(), max_difference);
    }
}
