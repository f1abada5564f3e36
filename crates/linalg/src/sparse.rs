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

use crate::elimination::{Elimination, by_columns};
use crate::error::{Error, Result};
use crate::product::symmetric_product;
use crate::{SparseMatrix, Triplets};

/// Largest number of values in the right-hand sides of one solve.
const MAX_SOLVE_BLOCK_VALUES: usize = 1 << 22;

/// Factors of a square sparse matrix, with the workspace of their solves.
pub struct SparseFactor {
    order: usize,
    factors: Factors,
    buffer: MemBuffer,
}

enum Factors {
    Cholesky { symbolic: SymbolicCholesky<usize>, values: Vec<f64> },
    Lu { symbolic: SymbolicLu<usize>, numeric: NumericLu<usize, f64> },
}

impl Factors {
    /// Workspace of a solve for `columns` right-hand sides.
    fn scratch(&self, columns: usize) -> StackReq {
        match self {
            Self::Cholesky { symbolic, .. } => {
                symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq)
            }
            Self::Lu { symbolic, .. } => symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq),
        }
    }
}

impl SparseFactor {
    /// Factors by Cholesky if the matrix is symmetric positive definite, else by LU with partial pivoting.
    pub fn new(name: &'static str, triplets: &Triplets) -> Result<Self> {
        Self::of(name, &SparseMatrix::new(name, triplets)?, &Elimination::default())
    }

    /// Factors as [`SparseFactor::new`] does, in an order of elimination that matrices of a structure share.
    pub fn of(
        name: &'static str,
        matrix: &SparseMatrix,
        elimination: &Elimination,
    ) -> Result<Self> {
        let columns = by_columns(matrix);
        let symmetric = matrix.asymmetry() <= 1e-13;
        let factor = if symmetric { Self::cholesky(&columns, elimination).ok() } else { None };
        factor
            .or_else(|| Self::lu(&columns))
            .and_then(Self::probed)
            .ok_or_else(|| Error::Singular { matrix: name, order: matrix.order() })
    }

    /// Cholesky factors of the lower triangle; an error unless the matrix is positive definite.
    pub fn positive_definite(name: &'static str, matrix: &SparseMatrix) -> Result<Self> {
        Self::cholesky(&by_columns(matrix), &Elimination::default())
            .ok()
            .and_then(Self::probed)
            .ok_or_else(|| Error::Singular { matrix: name, order: matrix.order() })
    }

    /// Whether the matrix was found positive definite.
    pub fn is_positive_definite(&self) -> bool {
        matches!(self.factors, Factors::Cholesky { .. })
    }

    /// This factor, or `None` if a solve is not finite.
    ///
    /// LU may accept a singular matrix with a pivot of rounding size.
    fn probed(mut self) -> Option<Self> {
        let mut probe = vec![1.0; self.order];
        self.solve(&mut probe);
        probe.iter().all(|x| x.is_finite()).then_some(self)
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
                let forward = symbolic.perm().map(|order| order.arrays().0);
                forward.map_or(index, |rows| rows.get(index).copied().unwrap_or(0))
            })?;
        let buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Ok(Self { order: matrix.nrows(), factors: Factors::Cholesky { symbolic, values }, buffer })
    }

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

    /// Approximate number of values that a solve reads.
    pub fn stored(&self) -> usize {
        match &self.factors {
            Factors::Cholesky { values, .. } => values.len(),
            Factors::Lu { .. } => self.order * self.order,
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
        let order = self.order.max(1);
        let columns = (rhs.len() / order).min((MAX_SOLVE_BLOCK_VALUES / order).max(8));
        let mut buffer = MemBuffer::new(self.factors.scratch(columns));
        for block in rhs.chunks_mut(columns.max(1) * order) {
            let columns = block.len() / order;
            Self::solve_with(&self.factors, self.order, columns, false, block, &mut buffer);
        }
    }

    /// The matrix condensed on the rows `last`, row-major: L Lᵀ of its last rows.
    ///
    /// `None` unless `last` are the last rows in the order of elimination, of a factor by Cholesky in blocks.
    pub fn condensed(&self, last: &[usize]) -> Option<Vec<f64>> {
        let count = last.len();
        let Factors::Cholesky { symbolic, values } = &self.factors else { return None };
        let mut lower = vec![0.0; count * count];
        for (place, at) in last_entries(symbolic, last)? {
            lower[place] = values[at];
        }
        let lower = MatRef::from_row_major_slice(&lower, count, count);
        let shapes = [BlockStructure::TriangularLower, BlockStructure::TriangularUpper];
        Some(symmetric_product([lower, lower.transpose()], shapes))
    }

    /// Factor of the matrix whose condensation on the rows `last` is `matrix`.
    ///
    /// Elsewhere the matrix is the same as this factor's.
    ///
    /// `matrix`: row-major, of which the lower triangle is read. `None` where [`SparseFactor::condensed`] is, and for a
    /// matrix that is not positive definite.
    pub fn with_condensed(mut self, last: &[usize], matrix: &[f64]) -> Option<Self> {
        let count = last.len();
        let Factors::Cholesky { symbolic, values } = &mut self.factors else {
            return None;
        };
        let lower = MatRef::from_row_major_slice(matrix, count, count).llt(Side::Lower).ok()?;
        let entries = last_entries(symbolic, last)?;
        // Entries outside the pattern are zero in this factor, and may not be in the new one.
        if 2 * entries.len() != count * (count + 1) {
            return None;
        }
        for (place, at) in entries {
            values[at] = lower.L()[(place / count, place % count)];
        }
        Some(self)
    }

    fn solve_with(
        factors: &Factors,
        order: usize,
        columns: usize,
        transposed: bool,
        rhs: &mut [f64],
        buffer: &mut MemBuffer,
    ) {
        let stack = MemStack::new(buffer);
        let rhs = MatMut::from_column_major_slice_mut(rhs, order, columns);
        match factors {
            Factors::Cholesky { symbolic, values } => {
                let factor = LltRef::new(symbolic, values);
                factor.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
            }
            Factors::Lu { symbolic, numeric } => {
                let lu = LuRef::new_unchecked(symbolic, numeric);
                if transposed {
                    lu.solve_transpose_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
                } else {
                    lu.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
                }
            }
        }
    }
}

/// Places of the last rows' lower triangle: in their matrix, and among a factor's values.
///
/// The matrix is row-major.
///
/// `None` unless `last` are the last rows in the order of elimination, of a factor in blocks.
fn last_entries(symbolic: &SymbolicCholesky<usize>, last: &[usize]) -> Option<Vec<(usize, usize)>> {
    let SymbolicCholeskyRaw::Supernodal(blocks) = symbolic.raw() else {
        return None;
    };
    let count = last.len();
    let first = symbolic.nrows().checked_sub(count)?;
    if symbolic.perm()?.arrays().0[first..] != *last {
        return None;
    }
    let mut entries = Vec::new();
    for k in (0..blocks.n_supernodes()).rev() {
        let begin = blocks.supernode_begin()[k];
        let end = blocks.supernode_end()[k];
        let pattern = blocks.supernode(k).pattern();
        let start = blocks.col_ptr_for_val()[k];
        let height = end - begin + pattern.len();
        for column in begin.max(first)..end {
            let rows = (begin..end).chain(pattern.iter().copied()).enumerate();
            entries.extend(rows.filter(|(_, row)| *row >= column).map(|(offset, row)| {
                let place = (row - first) * count + column - first;
                (place, start + (column - begin) * height + offset)
            }));
        }
    }
    Some(entries)
}

/// Row at which a symmetric matrix fails to be positive semi-definite; `None` if it is.
///
/// Diagonal entries below `floor` count as `floor`, if they are above −`floor`: they are rounding.
/// Eigenvalues of the matrix scaled to a unit diagonal may be as low as −`tolerance`. A matrix that passes is
/// therefore semi-definite except for 2 `floor` on the diagonal and `tolerance` relative to the diagonal. The
/// check costs a sparse Cholesky factorisation, or almost nothing if the matrix is diagonal.
pub fn indefinite_row(
    matrix: &SparseMatrix,
    tolerance: f64,
    floor: f64,
    elimination: &Elimination,
) -> Option<usize> {
    let diagonal_entries = matrix.diagonal();
    let smallest = (0..diagonal_entries.len())
        .min_by(|i, j| diagonal_entries[*i].total_cmp(&diagonal_entries[*j]));
    if let Some(row) = smallest.filter(|row| diagonal_entries[*row] < -floor) {
        return Some(row);
    }
    let diagonal: Vec<f64> = diagonal_entries.iter().map(|value| value.max(floor)).collect();
    let scale = |row: usize, column: usize| diagonal[row].sqrt() * diagonal[column].sqrt();
    let mut coupled = false;
    for (row, column, value) in matrix.entries() {
        if row != column && value != 0.0 {
            coupled = true;
            if value.abs() > (1.0 + tolerance) * scale(row, column) {
                return Some(if diagonal_entries[column] < diagonal_entries[row] {
                    column
                } else {
                    row
                });
            }
        }
    }
    if !coupled {
        return None;
    }
    let scaled = SparseMatrix::by_rows(matrix.order(), |row, entries| {
        let off_diagonal =
            matrix.row(row).filter(|(column, value)| *column != row && *value != 0.0);
        entries.extend(off_diagonal.map(|(column, value)| (column, value / scale(row, column))));
        entries.push((row, 1.0 + tolerance));
    });
    SparseFactor::cholesky(&by_columns(&scaled), elimination).err()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ladder(order: usize, skew: f64) -> Triplets {
        let mut matrix = Triplets::new(order);
        for i in 0..order {
            matrix.add(i, i, 3.0 + i as f64);
            if i > 0 {
                matrix.add(i, i - 1, -1.0 + skew);
                matrix.add(i - 1, i, -0.5);
                matrix.add(i - 1, i, -0.5 - skew);
            }
        }
        matrix
    }

    #[test]
    fn sparse_factors_solve_symmetric_and_unsymmetric() {
        for skew in [0.0, 0.3] {
            let triplets = ladder(40, skew);
            let matrix = SparseMatrix::new("test", &triplets).unwrap();
            let x: Vec<f64> = (0..40).map(|i| f64::from(i).sin()).collect();
            let mut rhs = vec![0.0; 40];
            matrix.multiply_add(1.0, &x, &mut rhs);
            let mut factor = SparseFactor::new("test", &triplets).unwrap();
            assert_eq!(matches!(factor.factors, Factors::Cholesky { .. }), skew == 0.0);
            factor.solve(&mut rhs);
            for (a, b) in rhs.iter().zip(&x) {
                assert!((a - b).abs() < 1e-13);
            }
        }
    }

    /// Chains with one spring of the opposite sign: indefinite, although every diagonal entry is positive.
    #[test]
    fn indefinite_matrices_are_told_by_a_row() {
        for (negative, tolerance) in [(None, 1e-12), (Some(17), 1e-12), (Some(17), 1e-6)] {
            let mut chain = Triplets::new(40);
            chain.add(0, 0, 5.0e6);
            for i in 1..40 {
                chain.add_spring(i - 1, i, if Some(i) == negative { -1.0e5 } else { 4.0e6 });
            }
            let matrix = SparseMatrix::new("test", &chain).unwrap();
            assert_eq!(
                indefinite_row(&matrix, tolerance, 1e-6, &Elimination::default()).is_some(),
                negative.is_some()
            );
            assert!(matrix.diagonal().iter().all(|k| *k > 0.0));
        }
        let rows = |entries: &[(usize, usize, f64)]| {
            let mut matrix = Triplets::new(3);
            for &(i, j, value) in entries {
                matrix.add(i, j, value);
            }
            let matrix = SparseMatrix::new("test", &matrix).unwrap();
            indefinite_row(&matrix, 1e-6, 1e-12, &Elimination::default())
        };
        assert_eq!(rows(&[(0, 0, 1.0), (1, 1, -1e-3)]), Some(1));
        assert_eq!(rows(&[(0, 0, 1.0), (0, 2, 1e-3), (2, 0, 1e-3)]), Some(2));
        assert_eq!(rows(&[(0, 0, 1e-4), (0, 2, 1e-3), (2, 0, 1e-3), (2, 2, 1e-3)]), Some(0));
        // The row of the most negative entry is returned.
        assert_eq!(rows(&[(0, 0, 1.0), (1, 1, -1e-9), (2, 2, -1e-3)]), Some(2));
        // An entry below the floor counts as rounding; just above the floor it does not.
        for (value, found) in [(0.99e-12, None), (1.01e-12, Some(1))] {
            assert_eq!(rows(&[(0, 0, 1.0), (1, 1, -value)]), found);
        }
        for (value, found) in [(0.99e-6, None), (1.01e-6, Some(1))] {
            assert_eq!(rows(&[(0, 0, 1.0), (0, 1, value), (1, 0, value)]), found);
        }
        // Singular matrices are semi-definite: a row of zeros, a mass on a weighted sum of degrees of
        // freedom.
        assert_eq!(rows(&[(0, 0, 1.0)]), None);
        assert_eq!(rows(&[(0, 0, 4.0), (0, 1, 6.0), (1, 0, 6.0), (1, 1, 9.0)]), None);
    }

    #[test]
    fn singular_and_bad_matrices_are_errors() {
        let mut zero = Triplets::new(2);
        zero.add(0, 0, 1.0);
        assert!(matches!(SparseFactor::new("k", &zero), Err(Error::Singular { .. })));
        zero.add(1, 2, 1.0);
        assert!(matches!(SparseMatrix::new("k", &zero), Err(Error::Index { index: 2, .. })));
        let mut nan = Triplets::new(1);
        nan.add(0, 0, f64::NAN);
        assert!(matches!(SparseMatrix::new("k", &nan), Err(Error::Input { .. })));
    }
}
