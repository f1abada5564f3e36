//! Matrices of a structure: sparse in its degrees of freedom, diagonal in its modes.

use std::sync::Arc;

use crate::error::{MemoryError, Result, finite, in_bounds, memory, same_length};
use crate::{Triplets, weighted_dot};

/// Bytes per degree of freedom in a structure's sparse matrices, their factor and its states.
const BYTES_PER_DOF: f64 = 400.0;

/// Checks that a structure of this `order` fits into memory.
///
/// `quantity` names what the order counts.
pub fn check_order(quantity: &'static str, order: usize) -> std::result::Result<(), MemoryError> {
    memory::check(quantity, order as f64, BYTES_PER_DOF * order as f64)
}

/// Weights by degree of freedom, zero where there is no (degree of freedom, weight) term.
pub fn spread(terms: &[(usize, f64)], length: usize) -> Vec<f64> {
    let mut weights = vec![0.0; length];
    for &(i, weight) in terms {
        weights[i] += weight;
    }
    weights
}

/// Square sparse matrix, compressed by rows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SparseMatrix {
    pub(super) order: usize,
    pub(super) row_start: Vec<usize>,
    pub(super) column: Vec<usize>,
    pub(super) value: Vec<f64>,
}

impl SparseMatrix {
    /// Matrix of the entries that `fill` writes into `triplets`.
    ///
    /// It has the order of `triplets`, whose entries are overwritten.
    pub fn assembled(
        name: &'static str,
        triplets: &mut Triplets,
        fill: &dyn Fn(&mut Triplets) -> Result<()>,
    ) -> Result<Self> {
        let order = triplets.order();
        triplets.clear();
        fill(triplets)?;
        same_length(name, triplets.order(), order)?;
        Self::new(name, triplets)
    }

    /// Matrix from `triplets`; entries at the same place are summed.
    pub fn new(name: &'static str, triplets: &Triplets) -> Result<Self> {
        let order = triplets.order();
        check_order("rows of a matrix", order)?;
        let mut row_start = vec![0; order + 1];
        for &(row, column, value) in triplets.entries() {
            in_bounds(name, row.max(column), order)?;
            finite(name, value)?;
            row_start[row + 1] += 1;
        }
        for row in 0..order {
            row_start[row + 1] += row_start[row];
        }
        let mut sorted = vec![(0, 0.0); triplets.entries().len()];
        let mut next = row_start.clone();
        for &(row, column, value) in triplets.entries() {
            sorted[next[row]] = (column, value);
            next[row] += 1;
        }
        Ok(Self::by_rows(order, |row, entries| {
            entries.extend_from_slice(&sorted[row_start[row]..row_start[row + 1]]);
        }))
    }

    /// Σ factor · A of matrices of this order, as one matrix.
    pub fn sum(name: &'static str, order: usize, terms: &[(f64, &Self)]) -> Result<Self> {
        let sum = Self::by_rows(order, |row, entries| {
            for (factor, matrix) in terms.iter().filter(|(_, matrix)| row < matrix.order) {
                entries.extend(matrix.row(row).map(|(column, value)| (column, factor * value)));
            }
        });
        sum.value.iter().try_for_each(|value| finite(name, *value).map(drop))?;
        Ok(sum)
    }

    /// Matrix of all its values, row-major.
    pub fn full(order: usize, value: Vec<f64>) -> Self {
        let column = (0..value.len()).map(|k| k % order).collect();
        Self { order, row_start: (0..=order).map(|row| row * order).collect(), column, value }
    }

    /// Matrix whose rows `fill` writes as (column, value); entries at the same place are summed.
    pub(super) fn by_rows(
        order: usize,
        mut fill: impl FnMut(usize, &mut Vec<(usize, f64)>),
    ) -> Self {
        let mut matrix = Self { order, row_start: vec![0], column: vec![], value: vec![] };
        let mut entries = Vec::new();
        let mut sums = Vec::<(usize, f64)>::new();
        // Place of each column in the sums of the row, if the row has the column.
        let mut places = vec![usize::MAX; order];
        for row in 0..order {
            entries.clear();
            fill(row, &mut entries);
            for &(column, value) in &entries {
                if let Some((_, sum)) = sums.get_mut(places[column]) {
                    *sum += value;
                } else {
                    places[column] = sums.len();
                    sums.push((column, value));
                }
            }
            sums.sort_unstable_by_key(|&(column, _)| column);
            for (column, sum) in sums.drain(..) {
                places[column] = usize::MAX;
                matrix.column.push(column);
                matrix.value.push(sum);
            }
            matrix.row_start.push(matrix.column.len());
        }
        matrix
    }

    /// Entries of a row: columns and values.
    pub(super) fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let places = self.row_start[row]..self.row_start[row + 1];
        self.column[places.clone()].iter().copied().zip(self.value[places].iter().copied())
    }

    /// The values at the places of another matrix; `None` if an entry is elsewhere.
    pub fn values_at(&self, other: &Self) -> Option<Vec<f64>> {
        let mut values = vec![0.0; other.stored()];
        for row in 0..self.order {
            let mut place = *other.row_start.get(row)?;
            let end = *other.row_start.get(row + 1)?;
            for (column, value) in self.row(row) {
                place += other.column[place..end].iter().take_while(|j| **j < column).count();
                if place == end || other.column[place] != column {
                    return None;
                }
                values[place] = value;
            }
        }
        Some(values)
    }

    /// Replaces the values by the sums of `triplets`, without allocating.
    ///
    /// Returns false, with undefined values, if an entry has no place in the pattern or is not finite.
    pub fn refill(&mut self, triplets: &Triplets) -> bool {
        self.value.fill(0.0);
        triplets.entries().iter().all(|&(row, column, value)| {
            let start = self.row_start.get(row).copied().unwrap_or(0);
            let end = self.row_start.get(row + 1).copied().unwrap_or(0);
            let Ok(k) = self.column[start..end.max(start)].binary_search(&column) else {
                return false;
            };
            self.value[start + k] += value;
            value.is_finite()
        })
    }

    /// Number of entries stored.
    pub fn stored(&self) -> usize {
        self.value.len()
    }

    /// Adds factor · A to `sum`.
    pub fn add_to(&self, factor: f64, sum: &mut Triplets) {
        for (row, column, value) in self.entries() {
            sum.add(row, column, factor * value);
        }
    }

    /// Σ factor · A of matrices of this order; an empty sum is zero.
    pub fn weighted_sum(order: usize, terms: &[(f64, &Self)]) -> Triplets {
        let mut sum = Triplets::new(order);
        for (factor, matrix) in terms {
            matrix.add_to(*factor, &mut sum);
        }
        sum
    }

    /// All stored entries: (row, column, value).
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        (0..self.order)
            .flat_map(move |row| self.row(row).map(move |(column, value)| (row, column, value)))
    }

    /// The diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        let mut diagonal = vec![0.0; self.order];
        for (row, column, value) in self.entries() {
            if row == column {
                diagonal[row] = value;
            }
        }
        diagonal
    }

    /// Whether no entry is stored.
    pub fn is_empty(&self) -> bool {
        self.value.is_empty()
    }

    /// Rows and columns.
    pub fn order(&self) -> usize {
        self.order
    }

    /// (A x) of one row.
    fn row_product(&self, row: usize, x: &[f64]) -> f64 {
        let range = self.row_start[row]..self.row_start[row + 1];
        self.column[range.clone()]
            .iter()
            .zip(&self.value[range])
            .map(|(&j, a)| a * x[j])
            .sum()
    }

    /// y ← y + factor · A x.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        for (row, y) in y.iter_mut().enumerate() {
            *y += factor * self.row_product(row, x);
        }
    }

    /// x·A y.
    pub fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        x.iter().enumerate().map(|(row, x)| x * self.row_product(row, y)).sum()
    }
}

/// A matrix of the equations of motion in the coordinates in which they are stepped.
#[derive(Debug, Clone)]
pub enum Matrix {
    /// Matrix in the structure's degrees of freedom.
    Sparse(Arc<SparseMatrix>),
    /// Diagonal of the matrix in modal coordinates.
    Diagonal(Vec<f64>),
}

/// Diagonals of the matrices in modal coordinates.
#[derive(Clone, Copy)]
pub struct Diagonals<'a> {
    pub mass: &'a [f64],
    /// `None` without damping.
    pub damping: Option<&'a [f64]>,
    pub stiffness: &'a [f64],
}

impl Matrix {
    /// Whether all entries are zero.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Sparse(matrix) => matrix.is_empty(),
            Self::Diagonal(values) => values.iter().all(|d| *d == 0.0),
        }
    }

    /// The matrix with all entries that are stored.
    pub fn as_sparse(&self) -> Arc<SparseMatrix> {
        match self {
            Self::Sparse(matrix) => Arc::clone(matrix),
            Self::Diagonal(values) => {
                Arc::new(SparseMatrix::by_rows(values.len(), |row, entries| {
                    entries.push((row, values[row]));
                }))
            }
        }
    }

    /// y ← y + factor · A x.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        match self {
            Self::Sparse(matrix) => matrix.multiply_add(factor, x, y),
            Self::Diagonal(values) => {
                for ((y, x), d) in y.iter_mut().zip(x).zip(values) {
                    *y += factor * (d * x);
                }
            }
        }
    }

    /// All entries that are stored.
    pub fn values(&self) -> &[f64] {
        match self {
            Self::Sparse(matrix) => &matrix.value,
            Self::Diagonal(values) => values,
        }
    }

    /// x·A y.
    pub fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        match self {
            Self::Sparse(matrix) => matrix.form(x, y),
            Self::Diagonal(values) => weighted_dot(values, x, y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refill_sums_in_place_or_refuses() {
        let mut triplets = Triplets::new(2);
        triplets.add(0, 1, 1.0);
        triplets.add(0, 1, 2.0);
        let mut matrix = SparseMatrix::new("test", &triplets).unwrap();
        triplets.add(0, 1, 0.5);
        assert!(matrix.refill(&triplets));
        assert_eq!(matrix.entries().collect::<Vec<_>>(), [(0, 1, 3.5)]);
        for (row, column, value) in [(1, 1, 1.0), (5, 1, 1.0), (0, 1, f64::NAN)] {
            let mut more = triplets.clone();
            more.add(row, column, value);
            assert!(!matrix.refill(&more));
        }
    }

    #[test]
    fn diagonal_and_sparse_agree() {
        let d: Vec<f64> = (0..11).map(|i| 1.0 + f64::from(i)).collect();
        let mut triplets = Triplets::new(11);
        d.iter().enumerate().for_each(|(i, d)| triplets.add(i, i, *d));
        let sparse = Matrix::Sparse(Arc::new(SparseMatrix::new("test", &triplets).unwrap()));
        let diagonal = Matrix::Diagonal(d);
        let x: Vec<f64> = (0..11).map(|i| f64::from(i).sin()).collect();
        let y: Vec<f64> = (0..11).map(|i| f64::from(i).cos()).collect();
        assert!((sparse.form(&x, &y) - diagonal.form(&x, &y)).abs() < 1e-13);
        let mut by_sparse = y.clone();
        let mut by_diagonal = y.clone();
        sparse.multiply_add(-2.0, &x, &mut by_sparse);
        diagonal.multiply_add(-2.0, &x, &mut by_diagonal);
        assert!(by_sparse.iter().zip(&by_diagonal).all(|(a, b)| (a - b).abs() < 1e-13));
        assert!(Matrix::Diagonal(vec![0.0]).is_empty() && !diagonal.is_empty());
    }
}
