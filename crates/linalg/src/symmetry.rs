//! Symmetry of sparse matrices.

use super::matrix::SparseMatrix;

/// A stored entry a_ij, and a_ji.
struct MirroredEntry {
    row: usize,
    column: usize,
    value: f64,
    mirrored: f64,
}

impl SparseMatrix {
    /// Largest |a_ij − a_ji| relative to the largest |a_ij|.
    pub fn asymmetry(&self) -> f64 {
        let mut largest = 0.0_f64;
        let mut difference = 0.0_f64;
        for entry in self.mirrored_entries() {
            largest = largest.max(entry.value.abs());
            difference = difference.max((entry.value - entry.mirrored).abs());
        }
        if largest > 0.0 { difference / largest } else { 0.0 }
    }

    /// The pair whose difference exceeds the allowed one by the most.
    ///
    /// `allowed(row, column)`: allowed difference. Returns row, column, and a_ij with a_ji.
    pub fn unsymmetric_pair(
        &self,
        allowed: impl Fn(usize, usize) -> f64,
    ) -> Option<(usize, usize, [f64; 2])> {
        let mut largest_excess = 0.0;
        let mut found = None;
        for MirroredEntry { row, column, value, mirrored } in self.mirrored_entries() {
            let excess = (value - mirrored).abs() - allowed(row, column);
            // The first of equal pairs.
            if excess > largest_excess {
                largest_excess = excess;
                found = Some((row, column, [value, mirrored]));
            }
        }
        found
    }

    /// All stored entries with their mirrored ones.
    fn mirrored_entries(&self) -> impl Iterator<Item = MirroredEntry> {
        // Rows ascend, so that the search in each column's row starts where the previous one ended.
        let mut next = self.row_start.clone();
        self.entries().map(move |(row, column, value)| {
            let places = next[column]..self.row_start[column + 1];
            next[column] += self.column[places.clone()].iter().take_while(|j| **j < row).count();
            let is_stored = places.end > next[column] && self.column[next[column]] == row;
            let mirrored = if is_stored { self.value[next[column]] } else { 0.0 };
            MirroredEntry { row, column, value, mirrored }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Triplets;

    /// REFERENCE: the dense matrix.
    #[test]
    fn entries_meet_their_mirrored_ones() {
        let mut triplets = Triplets::new(7);
        (0..25).for_each(|k| triplets.add(k * k % 7, (5 * k + 2) % 7, k as f64 - 9.5));
        let matrix = SparseMatrix::new("test", &triplets).unwrap();
        let mut dense = [[0.0; 7]; 7];
        matrix.entries().for_each(|(i, j, value)| dense[i][j] = value);
        let mut largest = 0.0_f64;
        let mut difference = 0.0_f64;
        for (i, j, value) in matrix.entries() {
            largest = largest.max(value.abs());
            difference = difference.max((value - dense[j][i]).abs());
        }
        assert!(difference > 0.0);
        assert_eq!(matrix.asymmetry(), difference / largest);
        let found = matrix.unsymmetric_pair(|_, _| 0.0).unwrap();
        let pair = found.2;
        assert_eq!(pair, [dense[found.0][found.1], dense[found.1][found.0]]);
        assert_eq!((pair[0] - pair[1]).abs(), difference);
    }
}
