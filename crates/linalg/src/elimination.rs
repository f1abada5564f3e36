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

/// Places of the entries of a matrix, by columns.
type Pattern<'a> = SymbolicSparseColMatRef<'a, usize>;

/// Number of entries of a factor from which nested dissection is tried.
///
/// Smaller factors cost less than the dissection.
const MIN_SHARED_ORDER_ENTRIES: usize = 1_500_000;
/// Smallest ratio of a factor's entries to its condensed matrix' entries.
const MIN_ENTRIES_PER_SQUARE: usize = 4;

/// Order of elimination that matrices of one structure share.
///
/// Empty until the first factor with many entries chooses it. Smaller factors do not need it.
#[derive(Debug, Clone, Default)]
pub struct Elimination(Arc<OnceLock<EliminationOrder>>);

/// Rows in the order of elimination, and the place of each row.
#[derive(Debug)]
struct EliminationOrder {
    rows: Vec<usize>,
    places: Vec<usize>,
    /// Entries of the factor for which the order was chosen.
    entries: usize,
}

impl Elimination {
    /// Order for a matrix, if its factor may have many entries.
    pub fn of(matrix: &SparseMatrix) -> Self {
        let elimination = Self::default();
        if matrix.order() * matrix.order() / 2 > MIN_SHARED_ORDER_ENTRIES {
            elimination.analyse(by_columns(matrix).symbolic());
        }
        elimination
    }

    /// The shared order with the rows `last` at the end.
    ///
    /// `None` unless the factor has many more entries than the square of their number.
    pub fn ending_with(&self, last: &[usize]) -> Option<Self> {
        let order = self
            .0
            .get()
            .filter(|order| MIN_ENTRIES_PER_SQUARE * last.len().pow(2) <= order.entries)?;
        let mut is_last = vec![false; order.rows.len()];
        for row in last {
            is_last[*row] = true;
        }
        let others = order.rows.iter().filter(|row| !is_last[**row]);
        let reordered = EliminationOrder::new(others.chain(last).copied().collect(), order.entries);
        Some(Self(Arc::new(OnceLock::from(reordered))))
    }

    /// Symbolic factor in the shared order.
    ///
    /// While there is none, in the order of minimum degree.
    ///
    /// The first factor of many entries chooses the shared order: by dissection, if its factor has fewer entries.
    pub(super) fn analyse(&self, pattern: Pattern<'_>) -> Option<SymbolicCholesky<usize>> {
        if let Some(order) = self.0.get().filter(|order| order.rows.len() == pattern.ncols()) {
            return symbolic_in(pattern, order.by_parts(pattern).as_symmetric());
        }
        let by_degree = symbolic_in(pattern, SymmetricOrdering::Amd)?;
        if by_degree.len_val() < MIN_SHARED_ORDER_ENTRIES {
            return Some(by_degree);
        }
        let Some(dissection_order) = EliminationOrder::by_dissection(pattern) else {
            return Some(by_degree);
        };
        let by_dissection = symbolic_in(pattern, dissection_order.as_symmetric())?;
        let is_better = by_dissection.len_val() < by_degree.len_val();
        let order = if is_better {
            Some(EliminationOrder { entries: by_dissection.len_val(), ..dissection_order })
        } else {
            EliminationOrder::of_factor(&by_degree)
        };
        if let Some(order) = order {
            // Another factor may have chosen an order meanwhile; then that one stays.
            let _ = self.0.set(order);
        }
        Some(if is_better { by_dissection } else { by_degree })
    }
}

impl EliminationOrder {
    /// Order of a symbolic factor.
    fn of_factor(factor: &SymbolicCholesky<usize>) -> Option<Self> {
        let permutation = factor.perm()?.arrays();
        Some(Self {
            rows: permutation.0.to_vec(),
            places: permutation.1.to_vec(),
            entries: factor.len_val(),
        })
    }

    fn by_dissection(pattern: Pattern<'_>) -> Option<Self> {
        let rows = dissection(
            pattern.ncols(),
            |column| pattern.row_idx_of_col_raw(column),
            by_minimum_degree,
        )?;
        Some(Self::new(rows, 0))
    }

    fn new(rows: Vec<usize>, entries: usize) -> Self {
        let mut places = vec![0; rows.len()];
        rows.iter().enumerate().for_each(|(place, &row)| places[row] = place);
        Self { rows, places, entries }
    }

    /// This order, with uncoupled parts of the matrix one after the other.
    ///
    /// The masses of bricks do not couple directions: a factor whose columns alternate between directions has no
    /// dense blocks.
    fn by_parts(&self, pattern: Pattern<'_>) -> Self {
        let mut parts = Partition::new(self.rows.len());
        for column in 0..self.rows.len() {
            let rows = pattern.row_idx_of_col_raw(column).iter();
            rows.for_each(|row| parts.join(column, *row));
        }
        let mut rows = self.rows.clone();
        rows.sort_by_key(|row| parts.root(*row));
        Self::new(rows, self.entries)
    }

    fn as_symmetric(&self) -> SymmetricOrdering<'_, usize> {
        let order = PermRef::new_checked(&self.rows, &self.places, self.rows.len());
        SymmetricOrdering::Custom(order)
    }
}

fn symbolic_in(
    pattern: Pattern<'_>,
    order: SymmetricOrdering<'_, usize>,
) -> Option<SymbolicCholesky<usize>> {
    let parameters = CholeskySymbolicParams::default();
    factorize_symbolic_cholesky(pattern, Side::Lower, order, parameters).ok()
}

/// Vertices of a graph in the order of minimum degree.
fn by_minimum_degree(graph: &Adjacency) -> Option<Vec<usize>> {
    let count = graph.start.len() - 1;
    let mut order = vec![0; count];
    let mut places = vec![0; count];
    let pattern = Pattern::new_checked(count, count, &graph.start, None, &graph.neighbours);
    let scratch = amd::order_maybe_unsorted_scratch::<usize>(count, graph.neighbours.len());
    let mut buffer = MemBuffer::new(scratch);
    let stack = MemStack::new(&mut buffer);
    let control = amd::Control::default();
    amd::order_maybe_unsorted(&mut order, &mut places, pattern, control, stack).ok()?;
    Some(order)
}

/// The matrix, compressed by columns.
pub(super) fn by_columns(matrix: &SparseMatrix) -> SparseColMat<usize, f64> {
    let order = matrix.order();
    let mut start = vec![0; order + 1];
    matrix.entries().for_each(|(_, column, _)| start[column + 1] += 1);
    (0..order).for_each(|column| start[column + 1] += start[column]);
    let mut next = start.clone();
    let mut rows = vec![0; matrix.stored()];
    let mut values = vec![0.0; matrix.stored()];
    for (row, column, value) in matrix.entries() {
        let place = next[column];
        rows[place] = row;
        values[place] = value;
        next[column] += 1;
    }
    let pattern = SymbolicSparseColMat::new_checked(order, order, start, None, rows);
    SparseColMat::new(pattern, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SparseFactor, SparseMatrix, Triplets};

    /// A cube of `side`³ masses, each joined to its 26 neighbours by springs and to the ground by one.
    fn cube(side: usize, spring: f64) -> SparseMatrix {
        let mut matrix = Triplets::new(side.pow(3));
        for v in 0..side.pow(3) {
            matrix.add(v, v, 0.1);
            let at = [v % side, v / side % side, v / side / side];
            for u in (0..27).map(|k| [at[0] + k % 3, at[1] + k / 3 % 3, at[2] + k / 9]) {
                // One more than the neighbour's place.
                if u.iter().all(|k| (1..=side).contains(k)) {
                    let u = u[0] - 1 + side * (u[1] - 1 + side * (u[2] - 1));
                    if u > v {
                        matrix.add_spring(u, v, spring);
                    }
                }
            }
        }
        SparseMatrix::new("cube", &matrix).unwrap()
    }

    /// Small factors keep the order of minimum degree; large ones share a better order.
    #[test]
    fn factors_of_many_entries_share_an_order_with_fewer() {
        let elimination = Elimination::default();
        SparseFactor::of("cube", &cube(8, 1.0), &elimination).unwrap();
        assert!(elimination.0.get().is_none());
        let matrix = cube(20, 1.0);
        let x: Vec<f64> = (0..8000).map(|i| f64::from(i).sin()).collect();
        let mut stored = Vec::new();
        for spring in [1.0, 7.0] {
            let matrix = cube(20, spring);
            let mut factor = SparseFactor::of("cube", &matrix, &elimination).unwrap();
            let mut found = vec![0.0; 8000];
            matrix.multiply_add(1.0, &x, &mut found);
            factor.solve(&mut found);
            assert!(found.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-10));
            stored.push(factor.stored());
        }
        let order = elimination.0.get().unwrap();
        assert_eq!((order.rows.len(), stored[0]), (8000, stored[1]));
        let columns = by_columns(&matrix);
        let amd = symbolic_in(columns.symbolic(), SymmetricOrdering::Amd).unwrap();
        assert!(
            amd.len_val() > MIN_SHARED_ORDER_ENTRIES && 5 * stored[0] < 4 * amd.len_val(),
            "{stored:?}"
        );
        // A matrix of another size chooses another order.
        SparseFactor::of("cube", &cube(8, 1.0), &elimination).unwrap();
    }

    /// REFERENCE: a solve in another order, S (A⁻¹ f)_b = f for forces f on the last rows b.
    #[test]
    fn factors_are_condensed_on_their_last_rows() {
        let matrix = cube(20, 2.0);
        let elimination = Elimination::of(&matrix);
        let last: Vec<usize> = (0..400).map(|k| k * k % 20 + 20 * k).collect();
        let ending = elimination.ending_with(&last).unwrap();
        let factor = SparseFactor::of("cube", &matrix, &ending).unwrap();
        let condensed = factor.condensed(&last).unwrap();
        let force: Vec<f64> = (0..400).map(|i| f64::from(i).cos()).collect();
        let mut displacement = vec![0.0; 8000];
        last.iter().zip(&force).for_each(|(row, force)| displacement[*row] = *force);
        SparseFactor::of("cube", &matrix, &Elimination::default())
            .unwrap()
            .solve(&mut displacement);
        let on_last: Vec<f64> = last.iter().map(|row| displacement[*row]).collect();
        let found = SparseMatrix::full(400, condensed.clone()).times(&on_last);
        assert!(found.iter().zip(&force).all(|(a, b)| (a - b).abs() < 1e-10));
        // With another matrix on the last rows, which couples all.
        let shift = |k: usize| if k.is_multiple_of(401) { 0.5 } else { 1e-3 };
        let shifted = condensed.iter().enumerate().map(|(k, value)| value + shift(k));
        let shifted: Vec<f64> = shifted.collect();
        let x: Vec<f64> = (0..8000).map(|i| f64::from(i).sin()).collect();
        let mut solution = matrix.times(&x);
        for (k, row) in last.iter().enumerate() {
            let added = last.iter().enumerate().map(|(j, row)| shift(400 * k + j) * x[*row]);
            solution[*row] += added.sum::<f64>();
        }
        factor.with_condensed(&last, &shifted).unwrap().solve(&mut solution);
        assert!(solution.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-10));
        let factor = SparseFactor::of("cube", &matrix, &ending).unwrap();
        // Other rows are not the last ones, and for too many rows condensation costs more than a solve.
        assert!(factor.condensed(&last[1..]).is_none_or(|matrix| matrix.len() == 399 * 399));
        assert!(factor.condensed(&[last[0]]).is_none());
        assert!(factor.with_condensed(&last, &vec![0.0; 160_000]).is_none());
        assert!(elimination.ending_with(&(0..4000).collect::<Vec<_>>()).is_none());
        assert!(Elimination::default().ending_with(&last).is_none());
    }

    /// Three uncoupled cubes, numbered in turns: an order for coupled cubes gives the factors of each.
    #[test]
    fn separate_parts_are_eliminated_one_after_the_other() {
        let single_cube = cube(13, 2.0);
        let mut uncoupled = Triplets::new(3 * single_cube.order());
        let mut coupled = Triplets::new(3 * single_cube.order());
        for (row, column, value) in single_cube.entries() {
            (0..3).for_each(|k| uncoupled.add(3 * row + k, 3 * column + k, value));
            for (k, l) in (0..9).map(|k| (k / 3, k % 3)) {
                let value = if k == l { 3.0 * value } else { 0.1 * value };
                coupled.add(3 * row + k, 3 * column + l, value);
            }
        }
        let uncoupled = SparseMatrix::new("", &uncoupled).unwrap();
        let coupled = SparseMatrix::new("", &coupled).unwrap();
        let elimination = Elimination::of(&coupled);
        let order = elimination.0.get().unwrap();
        let columns = by_columns(&uncoupled);
        let parts = order.by_parts(columns.symbolic());
        for (k, rows) in parts.rows.chunks(single_cube.order()).enumerate() {
            assert!(rows.iter().all(|row| row % 3 == k));
            assert!(rows.is_sorted_by_key(|row| order.places[*row]));
        }
        assert_eq!(order.by_parts(by_columns(&coupled).symbolic()).rows, order.rows);
        let x: Vec<f64> = (0..uncoupled.order()).map(|i| (i as f64).sin()).collect();
        let mut found = uncoupled.times(&x);
        SparseFactor::of("apart", &uncoupled, &elimination).unwrap().solve(&mut found);
        assert!(found.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-10));
    }
}
