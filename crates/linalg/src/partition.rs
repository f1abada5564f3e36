//! Disjoint sets of indices, such as the connected parts of a structure.

use crate::SparseMatrix;

/// Disjoint sets of the indices below an order (union–find).
///
/// It stores, for each index, an index of the same set that is not larger.
pub struct Partition(Vec<usize>);

impl Partition {
    /// Sets of one index each.
    pub fn new(order: usize) -> Self {
        Self((0..order).collect())
    }

    /// The smallest index in the set of `index`.
    #[inline]
    pub fn root(&mut self, mut index: usize) -> usize {
        while self.0[index] != index {
            self.0[index] = self.0[self.0[index]];
            index = self.0[index];
        }
        index
    }

    /// Merges the sets of two indices.
    #[inline]
    pub fn join(&mut self, first: usize, second: usize) {
        let first_root = self.root(first);
        let second_root = self.root(second);
        self.0[first_root.max(second_root)] = first_root.min(second_root);
    }

    /// Merges the sets of all pairs that a nonzero entry of `matrix` couples.
    pub fn couple(&mut self, matrix: &SparseMatrix) {
        for (row, column, value) in matrix.entries() {
            if value != 0.0 {
                self.join(row, column);
            }
        }
    }

    /// The sets, each ascending, in the order of their smallest indices.
    pub fn sets(&mut self) -> Vec<Vec<usize>> {
        let mut sets = vec![Vec::new(); self.0.len()];
        for index in 0..self.0.len() {
            sets[self.root(index)].push(index);
        }
        sets.retain(|set| !set.is_empty());
        sets
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Triplets;

    #[test]
    fn coupled_indices_are_one_set() {
        let mut matrix = Triplets::new(6);
        matrix.add_spring(5, 1, 2.0);
        matrix.add(1, 3, 1e-300);
        // An entry that cancels couples nothing.
        matrix.add(0, 4, 1.0);
        matrix.add(0, 4, -1.0);
        let mut partition = Partition::new(6);
        partition.couple(&SparseMatrix::new("test", &matrix).unwrap());
        assert_eq!(partition.sets(), [vec![0], vec![1, 3, 5], vec![2], vec![4]]);
        assert_eq!(partition.root(5), 1);
    }
}
