//! Order of elimination of sparse symmetric matrices.

use std::sync::{Arc, OnceLock};

use faer::Side;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, SymbolicSparseColMat, SymbolicSparseColMatRef};

use super::dissection::{Adjacency, dissection};
use super::matrix::SparseMatrix;
use super::partition::Partition;

/// Pattern of a sparse matrix, by columns.
type Pattern<'a> = SymbolicSparseColMatRef<'a, usize>;

/// Smallest number of entries of a factor for which nested dissection is tried.
///
/// The factorisation of a smaller matrix costs less than its dissection.
const MIN_DISSECTION_ENTRIES: usize = 1_500_000;
/// Smallest ratio of a factor's entries to the entries of its condensed matrix.
///
/// Below this ratio a condensed matrix saves little.
const MIN_CONDENSATION_RATIO: usize = 4;

/// Order of elimination that all matrices of one structure share.
///
/// It is empty until the first factor with many entries determines it. Smaller factors do not need it.
#[derive(Debug, Clone, Default)]
pub struct Elimination(Arc<OnceLock<EliminationOrder>>);

/// Rows in the order of elimination, and the position of each row.
#[derive(Debug)]
struct EliminationOrder {
    rows: Vec<usize>,
    positions: Vec<usize>,
    /// Number of entries of the factor for which the order was chosen.
    entry_count: usize,
    /// Number of rows that stay last, whatever parts of the matrix they belong to.
    last_count: usize,
}

impl Elimination {
    /// Order for a matrix and others of its structure, if its factor may have many entries.
    pub fn for_matrix(matrix: &SparseMatrix) -> Self {
        let elimination = Self::default();
        if matrix.order() * matrix.order() / 2 > MIN_DISSECTION_ENTRIES {
            elimination.analyse(by_columns(matrix).symbolic());
        }
        elimination
    }

    /// The shared order with `last_rows` moved to the end.
    ///
    /// `None` unless the factor has many more entries than the matrix condensed on these rows.
    pub fn ending_with(&self, last_rows: &[usize]) -> Option<Self> {
        let order = self
            .0
            .get()
            .filter(|order| MIN_CONDENSATION_RATIO * last_rows.len().pow(2) <= order.entry_count)?;
        Some(order.ending_with(last_rows))
    }

    /// The order for a pattern with `last_rows` moved to the end, whatever its number of entries.
    ///
    /// It is the order of minimum degree or of nested dissection, whichever then gives fewer entries: many factors in this
    /// order repay its search.
    pub(super) fn of_pattern_ending_with(
        &self,
        pattern: Pattern<'_>,
        last_rows: &[usize],
    ) -> Option<Self> {
        let order = EliminationOrder::of_factor(&self.analyse(pattern)?)?.ending_with(last_rows);
        let Some(dissection_order) = EliminationOrder::from_dissection(pattern) else {
            return Some(order);
        };
        let dissection_order = dissection_order.ending_with(last_rows);
        let entry_count = order.analyse(pattern)?.len_val();
        let dissection_count = dissection_order.analyse(pattern)?.len_val();
        Some(if dissection_count < entry_count { dissection_order } else { order })
    }

    /// Symbolic factor in the shared order.
    ///
    /// Before an order is chosen, it is in the order of minimum degree.
    ///
    /// The first factor with many entries determines the shared order: nested dissection if it gives fewer entries,
    /// else minimum degree.
    pub(super) fn analyse(&self, pattern: Pattern<'_>) -> Option<SymbolicCholesky<usize>> {
        if let Some(order) = self.0.get().filter(|order| order.rows.len() == pattern.ncols()) {
            return symbolic_factor(pattern, order.sorted_by_parts(pattern).as_symmetric());
        }
        let min_degree_factor = symbolic_factor(pattern, SymmetricOrdering::Amd)?;
        if min_degree_factor.len_val() < MIN_DISSECTION_ENTRIES {
            return Some(min_degree_factor);
        }
        let Some(dissection_order) = EliminationOrder::from_dissection(pattern) else {
            return Some(min_degree_factor);
        };
        let dissection_factor = symbolic_factor(pattern, dissection_order.as_symmetric())?;
        let has_dissection_fewer_entries =
            dissection_factor.len_val() < min_degree_factor.len_val();
        let order = if has_dissection_fewer_entries {
            let entry_count = dissection_factor.len_val();
            Some(EliminationOrder { entry_count, ..dissection_order })
        } else {
            EliminationOrder::of_factor(&min_degree_factor)
        };
        if let Some(order) = order {
            // If another thread has set an order in the meantime, that order is kept.
            let _ = self.0.set(order);
        }
        Some(if has_dissection_fewer_entries { dissection_factor } else { min_degree_factor })
    }
}

impl EliminationOrder {
    /// Order of a symbolic factor.
    fn of_factor(factor: &SymbolicCholesky<usize>) -> Option<Self> {
        let permutation = factor.perm()?.arrays();
        Some(Self {
            rows: permutation.0.to_vec(),
            positions: permutation.1.to_vec(),
            entry_count: factor.len_val(),
            last_count: 0,
        })
    }

    /// This order with `last_rows` moved to the end.
    fn ending_with(&self, last_rows: &[usize]) -> Elimination {
        let mut is_last = vec![false; self.rows.len()];
        for row in last_rows {
            is_last[*row] = true;
        }
        let first_rows = self.rows.iter().filter(|row| !is_last[**row]);
        let rows = first_rows.chain(last_rows).copied().collect();
        let order = Self { last_count: last_rows.len(), ..Self::new(rows, self.entry_count) };
        Elimination(Arc::new(OnceLock::from(order)))
    }

    /// Order of nested dissection.
    fn from_dissection(pattern: Pattern<'_>) -> Option<Self> {
        let rows = dissection(
            pattern.ncols(),
            |column| pattern.row_idx_of_col_raw(column),
            minimum_degree_order,
        )?;
        Some(Self::new(rows, 0))
    }

    /// Order of elimination with these rows.
    fn new(rows: Vec<usize>, entry_count: usize) -> Self {
        let mut positions = vec![0; rows.len()];
        rows.iter().enumerate().for_each(|(position, &row)| positions[row] = position);
        Self { rows, positions, entry_count, last_count: 0 }
    }

    /// This order, with the uncoupled parts of the matrix one after the other.
    ///
    /// The mass matrix of bricks does not couple directions: if columns of different directions alternate, its factor
    /// has no dense blocks. The last rows stay last, because a condensed matrix has rows of all parts.
    fn sorted_by_parts(&self, pattern: Pattern<'_>) -> Self {
        let mut parts = Partition::new(self.rows.len());
        for column in 0..self.rows.len() {
            let rows = pattern.row_idx_of_col_raw(column).iter();
            rows.for_each(|row| parts.join(column, *row));
        }
        let mut rows = self.rows.clone();
        let first_count = rows.len() - self.last_count;
        rows[..first_count].sort_by_key(|row| parts.root(*row));
        Self { last_count: self.last_count, ..Self::new(rows, self.entry_count) }
    }

    /// The order in the form of the matrix library.
    fn as_symmetric(&self) -> SymmetricOrdering<'_, usize> {
        let order = PermRef::new_checked(&self.rows, &self.positions, self.rows.len());
        SymmetricOrdering::Custom(order)
    }
}

/// Symbolic Cholesky factor in an order of elimination.
fn symbolic_factor(
    pattern: Pattern<'_>,
    order: SymmetricOrdering<'_, usize>,
) -> Option<SymbolicCholesky<usize>> {
    let parameters = CholeskySymbolicParams::default();
    factorize_symbolic_cholesky(pattern, Side::Lower, order, parameters).ok()
}

/// Vertices of a graph in the order of minimum degree.
fn minimum_degree_order(graph: &Adjacency) -> Option<Vec<usize>> {
    let first_neighbours = &graph.first_neighbours;
    let count = first_neighbours.len() - 1;
    let mut order = vec![0; count];
    let mut positions = vec![0; count];
    let pattern = Pattern::new_checked(count, count, first_neighbours, None, &graph.neighbours);
    let scratch = amd::order_maybe_unsorted_scratch::<usize>(count, graph.neighbours.len());
    let mut buffer = MemBuffer::new(scratch);
    let stack = MemStack::new(&mut buffer);
    let control = amd::Control::default();
    amd::order_maybe_unsorted(&mut order, &mut positions, pattern, control, stack).ok()?;
    Some(order)
}

/// The matrix, compressed by columns.
pub(super) fn by_columns(matrix: &SparseMatrix) -> SparseColMat<usize, f64> {
    let order = matrix.order();
    let mut rows = vec![0; matrix.entry_count()];
    let mut values = vec![0.0; matrix.entry_count()];
    for ((row, _, value), index) in matrix.entries().zip(column_indices(matrix)) {
        rows[index] = row;
        values[index] = value;
    }
    let starts = column_starts(matrix);
    let pattern = SymbolicSparseColMat::new_checked(order, order, starts, None, rows);
    SparseColMat::new(pattern, values)
}

/// Position, in storage by columns, of each entry in storage by rows.
pub(super) fn column_indices(matrix: &SparseMatrix) -> Vec<usize> {
    // Index of the next entry of each column.
    let mut next_index = column_starts(matrix);
    let take_next_index = |(_, column, _): (usize, usize, f64)| {
        let index = next_index[column];
        next_index[column] += 1;
        index
    };
    matrix.entries().map(take_next_index).collect()
}

/// Position of the first entry of each column, in storage by columns.
///
/// The number of entries follows at the end.
fn column_starts(matrix: &SparseMatrix) -> Vec<usize> {
    let mut starts = vec![0; matrix.order() + 1];
    matrix.entries().for_each(|(_, column, _)| starts[column + 1] += 1);
    (0..matrix.order()).for_each(|column| starts[column + 1] += starts[column]);
    starts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SparseFactor, SparseMatrix, Triplets};

    /// Cube of `side`³ masses, with springs to their 26 neighbours and to the ground.
    fn cube(side: usize, spring: f64) -> SparseMatrix {
        let mut matrix = Triplets::new(side.pow(3));
        for v in 0..side.pow(3) {
            matrix.add(v, v, 0.1);
            let [x, y, z] = [v % side, v / side % side, v / side / side];
            // Positions of the neighbours, counted from 1.
            for position in (0..27).map(|k| [x + k % 3, y + k / 3 % 3, z + k / 9]) {
                if position.iter().all(|coordinate| (1..=side).contains(coordinate)) {
                    let [x, y, z] = position.map(|coordinate| coordinate - 1);
                    let u = x + side * (y + side * z);
                    if u > v {
                        matrix.add_spring(u, v, spring);
                    }
                }
            }
        }
        SparseMatrix::new("cube", &matrix).unwrap()
    }

    /// Small factors have the order of minimum degree; large factors share a better order.
    #[test]
    fn large_factors_share_an_order_with_fewer_entries() {
        let elimination = Elimination::default();
        SparseFactor::with_elimination("cube", &cube(8, 1.0), &elimination).unwrap();
        assert!(elimination.0.get().is_none());
        let matrix = cube(20, 1.0);
        let x: Vec<f64> = (0..8000).map(|i| f64::from(i).sin()).collect();
        let mut entry_counts = Vec::new();
        for spring in [1.0, 7.0] {
            let matrix = cube(20, spring);
            let mut factor = SparseFactor::with_elimination("cube", &matrix, &elimination).unwrap();
            let mut solution = vec![0.0; 8000];
            matrix.multiply_add(1.0, &x, &mut solution);
            factor.solve(&mut solution);
            assert!(solution.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-10));
            entry_counts.push(factor.entry_count());
        }
        let order = elimination.0.get().unwrap();
        assert_eq!((order.rows.len(), entry_counts[0]), (8000, entry_counts[1]));
        let columns = by_columns(&matrix);
        let min_degree_factor =
            symbolic_factor(columns.symbolic(), SymmetricOrdering::Amd).unwrap();
        let degree_count = min_degree_factor.len_val();
        assert!(degree_count > MIN_DISSECTION_ENTRIES, "{degree_count}");
        assert!(5 * entry_counts[0] < 4 * degree_count, "{entry_counts:?}");
        // A matrix of another size chooses another order.
        SparseFactor::with_elimination("cube", &cube(8, 1.0), &elimination).unwrap();
    }

    /// REFERENCE: a solve in another order. For forces f on the last rows b, S (A⁻¹ f)_b = f.
    #[test]
    fn factors_are_condensed_on_their_last_rows() {
        let matrix = cube(20, 2.0);
        let elimination = Elimination::for_matrix(&matrix);
        let last_rows: Vec<usize> = (0..400).map(|k| k * k % 20 + 20 * k).collect();
        let ending_elimination = elimination.ending_with(&last_rows).unwrap();
        let factor = SparseFactor::with_elimination("cube", &matrix, &ending_elimination).unwrap();
        let condensed_matrix = factor.condensed(&last_rows).unwrap();
        let force: Vec<f64> = (0..400).map(|i| f64::from(i).cos()).collect();
        let mut displacement = vec![0.0; 8000];
        last_rows.iter().zip(&force).for_each(|(row, force)| displacement[*row] = *force);
        SparseFactor::with_elimination("cube", &matrix, &Elimination::default())
            .unwrap()
            .solve(&mut displacement);
        let last_displacement: Vec<f64> = last_rows.iter().map(|row| displacement[*row]).collect();
        let computed =
            SparseMatrix::from_dense(400, condensed_matrix.clone()).times(&last_displacement);
        assert!(computed.iter().zip(&force).all(|(a, b)| (a - b).abs() < 1e-10));
        // Another condensed matrix, which couples all last rows.
        let shift = |k: usize| if k.is_multiple_of(401) { 0.5 } else { 1e-3 };
        let shifted_values = condensed_matrix.iter().enumerate().map(|(k, value)| value + shift(k));
        let shifted_matrix: Vec<f64> = shifted_values.collect();
        let x: Vec<f64> = (0..8000).map(|i| f64::from(i).sin()).collect();
        let mut solution = matrix.times(&x);
        for (k, row) in last_rows.iter().enumerate() {
            let shift_products =
                last_rows.iter().enumerate().map(|(j, row)| shift(400 * k + j) * x[*row]);
            solution[*row] += shift_products.sum::<f64>();
        }
        factor.with_condensed(&last_rows, &shifted_matrix).unwrap().solve(&mut solution);
        assert!(solution.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-10));
        let factor = SparseFactor::with_elimination("cube", &matrix, &ending_elimination).unwrap();
        // Other rows are not the last ones, and for too many rows condensation costs more than a solve.
        assert!(factor.condensed(&last_rows[1..]).is_none_or(|matrix| matrix.len() == 399 * 399));
        assert!(factor.condensed(&[last_rows[0]]).is_none());
        assert!(factor.with_condensed(&last_rows, &vec![0.0; 160_000]).is_none());
        assert!(elimination.ending_with(&(0..4000).collect::<Vec<_>>()).is_none());
        assert!(Elimination::default().ending_with(&last_rows).is_none());
    }

    /// The order of three coupled cubes eliminates three uncoupled cubes one by one.
    ///
    /// The rows of the cubes alternate.
    #[test]
    fn uncoupled_parts_are_eliminated_one_after_the_other() {
        let single_cube = cube(13, 2.0);
        let mut uncoupled_matrix = Triplets::new(3 * single_cube.order());
        let mut coupled_matrix = Triplets::new(3 * single_cube.order());
        for (row, column, value) in single_cube.entries() {
            (0..3).for_each(|k| uncoupled_matrix.add(3 * row + k, 3 * column + k, value));
            for (k, l) in (0..9).map(|k| (k / 3, k % 3)) {
                let value = if k == l { 3.0 * value } else { 0.1 * value };
                coupled_matrix.add(3 * row + k, 3 * column + l, value);
            }
        }
        let uncoupled_matrix = SparseMatrix::new("", &uncoupled_matrix).unwrap();
        let coupled_matrix = SparseMatrix::new("", &coupled_matrix).unwrap();
        let elimination = Elimination::for_matrix(&coupled_matrix);
        let order = elimination.0.get().unwrap();
        let columns = by_columns(&uncoupled_matrix);
        let sorted_order = order.sorted_by_parts(columns.symbolic());
        for (k, rows) in sorted_order.rows.chunks(single_cube.order()).enumerate() {
            assert!(rows.iter().all(|row| row % 3 == k));
            assert!(rows.is_sorted_by_key(|row| order.positions[*row]));
        }
        assert_eq!(order.sorted_by_parts(by_columns(&coupled_matrix).symbolic()).rows, order.rows);
        let x: Vec<f64> = (0..uncoupled_matrix.order()).map(|i| (i as f64).sin()).collect();
        let mut solution = uncoupled_matrix.times(&x);
        SparseFactor::with_elimination("cubes", &uncoupled_matrix, &elimination)
            .unwrap()
            .solve(&mut solution);
        assert!(solution.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-10));
    }
}
