//! Connected parts of a structure.

use crate::matrix::SparseMatrix;

/// Which unknowns belong together: a disjoint-set forest.
pub(crate) struct Parts {
    leader: Vec<usize>,
}

impl Parts {
    /// Unknowns that an entry of a matrix couples, a zero among them, are in one part.
    pub(crate) fn coupled<const N: usize>(matrices: [&SparseMatrix; N]) -> Self {
        let order = matrices.first().map_or(0, |matrix| matrix.order());
        let mut parts = Self { leader: (0..order).collect() };
        for (row, column, _) in matrices.iter().flat_map(|matrix| matrix.entries()) {
            parts.join(row, column);
        }
        parts
    }

    /// Makes one part of those of all `unknowns`.
    pub(crate) fn join_all(&mut self, mut unknowns: impl Iterator<Item = usize>) {
        if let Some(first) = unknowns.next() {
            unknowns.for_each(|unknown| self.join(first, unknown));
        }
    }

    /// For each unknown, the one that stands for its part.
    pub(crate) fn leaders(mut self) -> Vec<usize> {
        (0..self.leader.len()).map(|unknown| self.find(unknown)).collect()
    }

    /// Number of parts.
    pub(crate) fn count(&self) -> usize {
        self.leader.iter().enumerate().filter(|(unknown, leader)| unknown == *leader).count()
    }

    fn join(&mut self, first: usize, second: usize) {
        let (a, b) = (self.find(first), self.find(second));
        self.leader[a.max(b)] = a.min(b);
    }

    fn find(&mut self, mut unknown: usize) -> usize {
        while self.leader[unknown] != unknown {
            self.leader[unknown] = self.leader[self.leader[unknown]];
            unknown = self.leader[unknown];
        }
        unknown
    }
}
