//! Factors of sparse matrices.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::linalg::matmul::triangular::BlockStructure;
use faer::sparse::SparseColMat;
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, SymbolicCholeskyRaw};
use faer::sparse::linalg::lu::{
    LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu,
};
use faer::{Conj, MatMut, MatRef, Par, Side, Spec};

mod changing;

pub use changing::ChangingFactor;

use crate::block_lu::BlockLu;
use crate::elimination::{Elimination, by_columns};
use crate::error::{Error, Result};
use crate::product::symmetric_product;
use crate::{SparseMatrix, Triplets};

/// Largest number of values in the right-hand sides of one solve.
///
/// The workspace of the solve has as many values.
const MAX_SOLVE_BLOCK_VALUES: usize = 1 << 22;

/// Smallest number of right-hand sides in one solve, if there are more.
const MIN_SOLVE_BLOCK_COLUMNS: usize = 8;

/// Factors of a square sparse matrix, with the workspace of their solves.
pub struct SparseFactor {
    order: usize,
    factors: Factors,
    buffer: MemBuffer,
}

/// Factors by one of the methods.
enum Factors {
    Cholesky {
        symbolic: SymbolicCholesky<usize>,
        values: Vec<f64>,
    },
    Lu {
        symbolic: SymbolicLu<usize>,
        numeric: NumericLu<usize, f64>,
    },
    /// Of a matrix that changes.
    BlockLu(Box<BlockLu>),
}

impl Factors {
    /// Workspace of a solve with `column_count` right-hand sides.
    fn scratch(&self, column_count: usize) -> StackReq {
        match self {
            Self::Cholesky { symbolic, .. } => {
                symbolic.solve_in_place_scratch::<f64>(column_count, Par::Seq)
            }
            Self::Lu { symbolic, .. } => {
                symbolic.solve_in_place_scratch::<f64>(column_count, Par::Seq)
            }
            Self::BlockLu(blocks) => blocks.solve_scratch(),
        }
    }
}

impl SparseFactor {
    /// Factors by Cholesky if the matrix is symmetric positive definite, else by LU with partial pivoting.
    pub fn new(name: &'static str, triplets: &Triplets) -> Result<Self> {
        let matrix = SparseMatrix::new(name, triplets)?;
        Self::with_elimination(name, &matrix, &Elimination::default())
    }

    /// Factors as [`SparseFactor::new`], in an order of elimination that matrices of one structure share.
    pub fn with_elimination(
        name: &'static str,
        matrix: &SparseMatrix,
        elimination: &Elimination,
    ) -> Result<Self> {
        let columns = by_columns(matrix);
        let cholesky_factor =
            if matrix.is_symmetric() { Self::cholesky(&columns, elimination).ok() } else { None };
        cholesky_factor
            .or_else(|| Self::lu(&columns))
            .and_then(Self::checked_by_solve)
            .ok_or_else(|| Error::Singular { matrix: name, order: matrix.order() })
    }

    /// Cholesky factors of the lower triangle; an error unless the matrix is positive definite.
    pub fn positive_definite(name: &'static str, matrix: &SparseMatrix) -> Result<Self> {
        Self::cholesky(&by_columns(matrix), &Elimination::default())
            .ok()
            .and_then(Self::checked_by_solve)
            .ok_or_else(|| Error::Singular { matrix: name, order: matrix.order() })
    }

    /// Whether the matrix is positive definite: its factors are Cholesky's.
    pub fn is_positive_definite(&self) -> bool {
        matches!(self.factors, Factors::Cholesky { .. })
    }

    /// This factor, or `None` if the solution for a test vector is not finite.
    ///
    /// The pivots of a singular matrix may be rounding errors instead of zeros, so that its factorisation succeeds.
    fn checked_by_solve(mut self) -> Option<Self> {
        let mut solution = vec![1.0; self.order];
        self.solve(&mut solution);
        solution.iter().all(|x| x.is_finite()).then_some(self)
    }

    /// Factors the matrix by Cholesky's method.
    ///
    /// Returns the row at which the matrix fails to be positive definite as the error.
    fn cholesky(
        matrix: &SparseColMat<usize, f64>,
        elimination: &Elimination,
    ) -> std::result::Result<Self, usize> {
        let symbolic = elimination.analyse(matrix.symbolic()).ok_or(0_usize)?;
        let mut values = vec![0.0; symbolic.len_val()];
        let mut buffer = MemBuffer::new(
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default()),
        );
        symbolic
            .factorize_numeric_llt(
                &mut values,
                matrix.as_ref(),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut buffer),
                Spec::default(),
            )
            .map_err(|LltError::NonPositivePivot { index }| {
                let row_permutation = symbolic.perm().map(|order| order.arrays().0);
                row_permutation.map_or(index, |rows| rows.get(index).copied().unwrap_or(0))
            })?;
        let buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Ok(Self { order: matrix.nrows(), factors: Factors::Cholesky { symbolic, values }, buffer })
    }

    /// Factors the matrix by LU with partial pivoting; `None` if it fails.
    fn lu(matrix: &SparseColMat<usize, f64>) -> Option<Self> {
        let symbolic =
            factorize_symbolic_lu(matrix.symbolic(), LuSymbolicParams::default()).ok()?;
        let mut numeric = NumericLu::new();
        let mut buffer =
            MemBuffer::new(symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Spec::default()));
        symbolic
            .factorize_numeric_lu(
                &mut numeric,
                matrix.as_ref(),
                Par::Seq,
                MemStack::new(&mut buffer),
                Spec::default(),
            )
            .ok()?;
        let buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Some(Self { order: matrix.nrows(), factors: Factors::Lu { symbolic, numeric }, buffer })
    }

    /// Number of values that a solve reads.
    ///
    /// For LU factors it is the number of values of a dense matrix.
    pub fn entry_count(&self) -> usize {
        match &self.factors {
            Factors::Cholesky { values, .. } => values.len(),
            Factors::Lu { .. } => self.order * self.order,
            Factors::BlockLu(blocks) => blocks.value_count(),
        }
    }

    /// Overwrites `rhs` with A⁻¹ rhs.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        Self::solve_with(&self.factors, self.order, 1, false, rhs, &mut self.buffer);
    }

    /// Overwrites `rhs` with A⁻ᵀ rhs; allocates its workspace.
    pub fn solve_transposed(&self, rhs: &mut [f64]) {
        let mut buffer = MemBuffer::new(self.factors.scratch(1));
        Self::solve_with(&self.factors, self.order, 1, true, rhs, &mut buffer);
    }

    /// Overwrites many right-hand sides, one after the other in `rhs`, with A⁻¹ rhs; allocates its workspace.
    pub fn solve_many(&self, rhs: &mut [f64]) {
        let mut buffer = MemBuffer::new(self.factors.scratch(self.block_columns(rhs.len())));
        self.solve_blocks(rhs, &mut buffer);
    }

    /// Number of right-hand sides in one solve, if all right-hand sides together have `value_count` values.
    fn block_columns(&self, value_count: usize) -> usize {
        let order = self.order.max(1);
        let max_columns = (MAX_SOLVE_BLOCK_VALUES / order).max(MIN_SOLVE_BLOCK_COLUMNS);
        (value_count / order).min(max_columns)
    }

    /// Overwrites many right-hand sides with A⁻¹ rhs, in a workspace for [`Self::block_columns`] of them.
    fn solve_blocks(&self, rhs: &mut [f64], buffer: &mut MemBuffer) {
        let order = self.order.max(1);
        for block in rhs.chunks_mut(self.block_columns(rhs.len()).max(1) * order) {
            let column_count = block.len() / order;
            Self::solve_with(&self.factors, self.order, column_count, false, block, buffer);
        }
    }

    /// The matrix condensed on `last_rows`, row-major: L Lᵀ of the last block of L.
    ///
    /// `None` unless these rows are the last in the order of elimination, and the factors are Cholesky's.
    pub fn condensed(&self, last_rows: &[usize]) -> Option<Vec<f64>> {
        let count = last_rows.len();
        let Factors::Cholesky { symbolic, values } = &self.factors else { return None };
        let mut lower_triangle = vec![0.0; count * count];
        for LastEntry { matrix_index, factor_index } in last_entries(symbolic, last_rows)? {
            lower_triangle[matrix_index] = values[factor_index];
        }
        let lower_triangle = MatRef::from_row_major_slice(&lower_triangle, count, count);
        let shapes = [BlockStructure::TriangularLower, BlockStructure::TriangularUpper];
        Some(symmetric_product([lower_triangle, lower_triangle.transpose()], shapes))
    }

    /// Factor of a matrix that differs only on `last_rows`, where its condensed matrix is `condensed_matrix`.
    ///
    /// `condensed_matrix`: row-major; only the lower triangle is read. `None` where [`SparseFactor::condensed`] returns
    /// `None`, if the pattern of this factor lacks entries of the last rows, and for a condensed matrix that is not
    /// positive definite.
    pub fn with_condensed(mut self, last_rows: &[usize], condensed_matrix: &[f64]) -> Option<Self> {
        let count = last_rows.len();
        let Factors::Cholesky { symbolic, values } = &mut self.factors else {
            return None;
        };
        let cholesky =
            MatRef::from_row_major_slice(condensed_matrix, count, count).llt(Side::Lower).ok()?;
        let entries = last_entries(symbolic, last_rows)?;
        // The new factor may need entries outside the pattern of this factor.
        if 2 * entries.len() != count * (count + 1) {
            return None;
        }
        for LastEntry { matrix_index, factor_index } in entries {
            values[factor_index] = cholesky.L()[(matrix_index / count, matrix_index % count)];
        }
        Some(self)
    }

    /// Overwrites `rhs` with A⁻¹ rhs, or A⁻ᵀ rhs if `is_transposed`.
    fn solve_with(
        factors: &Factors,
        order: usize,
        column_count: usize,
        is_transposed: bool,
        rhs: &mut [f64],
        buffer: &mut MemBuffer,
    ) {
        let stack = MemStack::new(buffer);
        match factors {
            Factors::BlockLu(blocks) => {
                for column in rhs.chunks_exact_mut(order.max(1)) {
                    blocks.solve(column, is_transposed, stack);
                }
            }
            Factors::Cholesky { symbolic, values } => {
                let rhs = MatMut::from_column_major_slice_mut(rhs, order, column_count);
                let factor = LltRef::new(symbolic, values);
                factor.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
            }
            Factors::Lu { symbolic, numeric } => {
                let rhs = MatMut::from_column_major_slice_mut(rhs, order, column_count);
                let lu = LuRef::new_unchecked(symbolic, numeric);
                if is_transposed {
                    lu.solve_transpose_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
                } else {
                    lu.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
                }
            }
        }
    }
}

/// Entry in the lower triangle of the last rows.
struct LastEntry {
    /// Index in the row-major matrix of the last rows.
    matrix_index: usize,
    /// Index in the values of the factor.
    factor_index: usize,
}

/// Entries of a factor in the lower triangle of `last_rows`.
///
/// `None` unless these rows are the last in the order of elimination.
fn last_entries(symbolic: &SymbolicCholesky<usize>, last_rows: &[usize]) -> Option<Vec<LastEntry>> {
    let count = last_rows.len();
    let first_row = symbolic.nrows().checked_sub(count)?;
    if symbolic.perm()?.arrays().0[first_row..] != *last_rows {
        return None;
    }
    let matrix_index = |row: usize, column: usize| (row - first_row) * count + column - first_row;
    let mut entries = Vec::new();
    let blocks = match symbolic.raw() {
        SymbolicCholeskyRaw::Supernodal(blocks) => blocks,
        SymbolicCholeskyRaw::Simplicial(factor) => {
            for column in first_row..symbolic.nrows() {
                let indices = factor.col_ptr()[column]..factor.col_ptr()[column + 1];
                entries.extend(indices.map(|factor_index| LastEntry {
                    matrix_index: matrix_index(factor.row_idx()[factor_index], column),
                    factor_index,
                }));
            }
            return Some(entries);
        }
    };
    for k in (0..blocks.n_supernodes()).rev() {
        let begin_column = blocks.supernode_begin()[k];
        let end_column = blocks.supernode_end()[k];
        let rows_below = blocks.supernode(k).pattern();
        let first_index = blocks.col_ptr_for_val()[k];
        let height = end_column - begin_column + rows_below.len();
        for column in begin_column.max(first_row)..end_column {
            let rows = (begin_column..end_column).chain(rows_below.iter().copied()).enumerate();
            let lower_rows = rows.filter(|(_, row)| *row >= column);
            entries.extend(lower_rows.map(|(offset, row)| LastEntry {
                matrix_index: matrix_index(row, column),
                factor_index: first_index + (column - begin_column) * height + offset,
            }));
        }
    }
    Some(entries)
}

/// Row at which a symmetric matrix fails to be positive semi-definite.
///
/// `None` if the matrix is semi-definite.
///
/// Diagonal entries between −`floor` and `floor` are rounding errors and count as `floor`. Eigenvalues of the matrix
/// scaled to a unit diagonal may be as low as −`tolerance`. A matrix without such a row is therefore semi-definite
/// after adding 2 `floor` to the diagonal, and `tolerance` times the diagonal. The check costs a sparse Cholesky
/// factorisation, or almost nothing for a diagonal matrix.
pub fn indefinite_row(
    matrix: &SparseMatrix,
    tolerance: f64,
    floor: f64,
    elimination: &Elimination,
) -> Option<usize> {
    let diagonal_entries = matrix.diagonal();
    let min_row = (0..diagonal_entries.len())
        .min_by(|i, j| diagonal_entries[*i].total_cmp(&diagonal_entries[*j]));
    if let Some(row) = min_row.filter(|row| diagonal_entries[*row] < -floor) {
        return Some(row);
    }
    let positive_diagonal: Vec<f64> =
        diagonal_entries.iter().map(|value| value.max(floor)).collect();
    let scale = |row: usize, column: usize| {
        positive_diagonal[row].sqrt() * positive_diagonal[column].sqrt()
    };
    let mut is_diagonal = true;
    for (row, column, value) in matrix.entries() {
        if row != column && value != 0.0 {
            is_diagonal = false;
            if value.abs() > (1.0 + tolerance) * scale(row, column) {
                return Some(if diagonal_entries[column] < diagonal_entries[row] {
                    column
                } else {
                    row
                });
            }
        }
    }
    if is_diagonal {
        return None;
    }
    let scaled_matrix = SparseMatrix::from_rows(matrix.order(), |row, entries| {
        let off_diagonal =
            matrix.row(row).filter(|(column, value)| *column != row && *value != 0.0);
        entries.extend(off_diagonal.map(|(column, value)| (column, value / scale(row, column))));
        entries.push((row, 1.0 + tolerance));
    });
    SparseFactor::cholesky(&by_columns(&scaled_matrix), elimination).err()
}

#[cfg(test)]
mod tests;
