//! Matrices of a structure: sparse in its degrees of freedom, diagonal in its modes.

use std::sync::Arc;

use crate::error::{MemoryError, Result, finite, in_bounds, memory, same_length};
use crate::{Triplets, weighted_dot};

/// Memory per degree of freedom for a structure's sparse matrices, their factor and its states, bytes.
const BYTES_PER_DOF: f64 = 400.0;

/// Returns an error unless the memory suffices for matrices of this `order`, their number of rows.
///
/// `quantity`: name of the counted rows or degrees of freedom.
pub fn check_order(quantity: &'static str, order: usize) -> std::result::Result<(), MemoryError> {
    memory::check(quantity, order as f64, BYTES_PER_DOF * order as f64)
}

/// Dense vector of (degree of freedom, weight) terms.
///
/// Terms at the same degree of freedom are summed.
pub fn dense_vector(terms: &[(usize, f64)], length: usize) -> Vec<f64> {
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
    /// Index of the first entry of each row, then the number of entries.
    pub(super) row_starts: Vec<usize>,
    /// Column of each entry, ascending in each row.
    pub(super) columns: Vec<usize>,
    /// Value of each entry.
    pub(super) values: Vec<f64>,
}

impl SparseMatrix {
    /// Matrix of the entries that `fill` writes into `triplets`.
    ///
    /// The matrix has the order of `triplets`, whose entries are overwritten.
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

    /// Matrix of the entries of `triplets`; entries with equal indices are summed.
    pub fn new(name: &'static str, triplets: &Triplets) -> Result<Self> {
        let order = triplets.order();
        check_order("rows of a matrix", order)?;
        let mut row_starts = vec![0; order + 1];
        for &(row, column, value) in triplets.entries() {
            in_bounds(name, row.max(column), order)?;
            finite(name, value)?;
            row_starts[row + 1] += 1;
        }
        for row in 0..order {
            row_starts[row + 1] += row_starts[row];
        }
        // Entries in the order of rows, and the index of the next entry of each row.
        let mut row_entries = vec![(0, 0.0); triplets.entries().len()];
        let mut next_indices = row_starts.clone();
        for &(row, column, value) in triplets.entries() {
            row_entries[next_indices[row]] = (column, value);
            next_indices[row] += 1;
        }
        Ok(Self::from_rows(order, |row, entries| {
            entries.extend_from_slice(&row_entries[row_starts[row]..row_starts[row + 1]]);
        }))
    }

    /// Sum Σ factor · A of matrices up to this order.
    pub fn sum(name: &'static str, order: usize, terms: &[(f64, &Self)]) -> Result<Self> {
        let sum = Self::from_rows(order, |row, entries| {
            for (factor, matrix) in terms.iter().filter(|(_, matrix)| row < matrix.order) {
                entries.extend(matrix.row(row).map(|(column, value)| (column, factor * value)));
            }
        });
        sum.values.iter().try_for_each(|value| finite(name, *value).map(drop))?;
        Ok(sum)
    }

    /// Matrix that stores all entries of the row-major `values`.
    pub fn from_dense(order: usize, values: Vec<f64>) -> Self {
        let columns = (0..values.len()).map(|k| k % order).collect();
        let row_starts = (0..=order).map(|row| row * order).collect();
        Self { order, row_starts, columns, values }
    }

    /// Matrix whose rows `fill` writes as (column, value); entries with equal indices are summed.
    pub(super) fn from_rows(
        order: usize,
        mut fill: impl FnMut(usize, &mut Vec<(usize, f64)>),
    ) -> Self {
        let mut matrix = Self { order, row_starts: vec![0], columns: vec![], values: vec![] };
        let mut entries = Vec::new();
        let mut sums = Vec::<(usize, f64)>::new();
        // Index of each column in `sums`; the largest number for columns without an entry in the row.
        let mut sum_indices = vec![usize::MAX; order];
        for row in 0..order {
            entries.clear();
            fill(row, &mut entries);
            for &(column, value) in &entries {
                if let Some((_, sum)) = sums.get_mut(sum_indices[column]) {
                    *sum += value;
                } else {
                    sum_indices[column] = sums.len();
                    sums.push((column, value));
                }
            }
            sums.sort_unstable_by_key(|&(column, _)| column);
            for (column, sum) in sums.drain(..) {
                sum_indices[column] = usize::MAX;
                matrix.columns.push(column);
                matrix.values.push(sum);
            }
            matrix.row_starts.push(matrix.columns.len());
        }
        matrix
    }

    /// Entries of a row: columns and values.
    #[inline]
    pub(super) fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.row_starts[row]..self.row_starts[row + 1];
        self.columns[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }

    /// Number of stored entries.
    #[inline]
    pub fn entry_count(&self) -> usize {
        self.values.len()
    }

    /// Adds factor · A to `sum`.
    pub fn add_to(&self, factor: f64, sum: &mut Triplets) {
        for (row, column, value) in self.entries() {
            sum.add(row, column, factor * value);
        }
    }

    /// Triplets of the sum Σ factor · A of matrices of this order.
    ///
    /// An empty sum is zero.
    pub fn weighted_sum(order: usize, terms: &[(f64, &Self)]) -> Triplets {
        let mut sum = Triplets::new(order);
        for (factor, matrix) in terms {
            matrix.add_to(*factor, &mut sum);
        }
        sum
    }

    /// All stored entries: (row, column, value).
    #[inline]
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
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Number of rows and of columns.
    #[inline]
    pub fn order(&self) -> usize {
        self.order
    }

    /// Entry of A x in one row.
    #[inline]
    fn row_product(&self, row: usize, x: &[f64]) -> f64 {
        let range = self.row_starts[row]..self.row_starts[row + 1];
        self.columns[range.clone()]
            .iter()
            .zip(&self.values[range])
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

/// Matrix of the equations of motion, in the coordinates of the time integration.
#[derive(Debug, Clone)]
pub enum Matrix {
    /// Matrix in the structure's degrees of freedom.
    Sparse(Arc<SparseMatrix>),
    /// Diagonal of the matrix in modal coordinates.
    Diagonal(Vec<f64>),
}

/// Diagonals of the structure's matrices in modal coordinates.
#[derive(Clone, Copy)]
pub struct Diagonals<'a> {
    /// Diagonal of the mass matrix.
    pub mass: &'a [f64],
    /// Diagonal of the damping matrix; `None` without damping.
    pub damping: Option<&'a [f64]>,
    /// Diagonal of the stiffness matrix.
    pub stiffness: &'a [f64],
}

impl Matrix {
    /// Whether a sparse matrix stores no entry, or all entries of a diagonal are zero.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Sparse(matrix) => matrix.is_empty(),
            Self::Diagonal(values) => values.iter().all(|d| *d == 0.0),
        }
    }

    /// The matrix as a sparse matrix.
    pub fn as_sparse(&self) -> Arc<SparseMatrix> {
        match self {
            Self::Sparse(matrix) => Arc::clone(matrix),
            Self::Diagonal(values) => {
                Arc::new(SparseMatrix::from_rows(values.len(), |row, entries| {
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

    /// Values of all stored entries.
    pub fn values(&self) -> &[f64] {
        match self {
            Self::Sparse(matrix) => &matrix.values,
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
    fn diagonal_and_sparse_agree() {
        let diagonal_values: Vec<f64> = (0..11).map(|i| 1.0 + f64::from(i)).collect();
        let mut triplets = Triplets::new(11);
        diagonal_values.iter().enumerate().for_each(|(i, value)| triplets.add(i, i, *value));
        let sparse_matrix = Matrix::Sparse(Arc::new(SparseMatrix::new("test", &triplets).unwrap()));
        let diagonal_matrix = Matrix::Diagonal(diagonal_values);
        let x: Vec<f64> = (0..11).map(|i| f64::from(i).sin()).collect();
        let y: Vec<f64> = (0..11).map(|i| f64::from(i).cos()).collect();
        assert!((sparse_matrix.form(&x, &y) - diagonal_matrix.form(&x, &y)).abs() < 1e-13);
        let mut sparse_sum = y.clone();
        let mut diagonal_sum = y.clone();
        sparse_matrix.multiply_add(-2.0, &x, &mut sparse_sum);
        diagonal_matrix.multiply_add(-2.0, &x, &mut diagonal_sum);
        assert!(sparse_sum.iter().zip(&diagonal_sum).all(|(a, b)| (a - b).abs() < 1e-13));
        assert!(Matrix::Diagonal(vec![0.0]).is_empty() && !diagonal_matrix.is_empty());
    }
}
