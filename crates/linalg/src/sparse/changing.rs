//! Factors of matrices whose numbers change while their sparsity pattern stays, in reused memory.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::prelude::ReborrowMut;
use faer::sparse::SparseColMat;
use faer::sparse::linalg::lu::{LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::{MatMut, MatRef, Par, Side, Spec};

use super::{Factors, LastEntry, SparseFactor, last_entries};
use crate::SparseMatrix;
use crate::block_lu::BlockLu;
use crate::elimination::{Elimination, by_columns, column_indices};
use crate::error::{Error, Result};
use crate::symmetry::{MAX_ASYMMETRY, MirroredPairs};

/// Factor of the last of many matrices with one sparsity pattern.
///
/// The order of elimination and the pattern of the factor are determined once. Each new matrix is factored in the
/// memory of the last one. For symmetric positive definite matrices the result is that of
/// [`SparseFactor::with_elimination`] to the last bit. Large matrices with a symmetric pattern, but unsymmetric values,
/// keep the order of elimination of the symmetric ones.
pub struct ChangingFactor {
    name: &'static str,
    elimination: Elimination,
    /// The matrix, by columns.
    columns: SparseColMat<usize, f64>,
    /// Position, in storage by columns, of each entry in storage by rows.
    column_indices: Vec<usize>,
    mirrored_pairs: MirroredPairs,
    /// Factor of symmetric positive definite matrices.
    cholesky: Option<ReusedFactor>,
    /// Factor of other matrices with a symmetric pattern, in the same order of elimination.
    block_lu: Option<ReusedFactor>,
    /// Whether the last rows are the last in this order.
    ends_with_last_rows: bool,
    /// Factor of all other matrices.
    lu: Option<ReusedFactor>,
    /// Method of the last factorization.
    method: Method,
    /// Buffer for solutions.
    ///
    /// They belong to the test of a factor, and to right-hand sides on the last rows.
    solution: Vec<f64>,
    last_rows: Vec<usize>,
    /// Entries of Cholesky's factor in the last rows; `None` unless these are the last in its order.
    last_entries: Option<Vec<LastEntry>>,
    /// Cholesky's factor of the matrix condensed on the last rows, row-major.
    last_lower: Vec<f64>,
}

/// Method of a factorization.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Method {
    Cholesky,
    BlockLu,
    Lu,
}

/// Largest imbalance of the solution for a test vector, relative to the largest sum of terms.
///
/// The imbalance is larger if pivots would have to be exchanged between fronts.
const MAX_TEST_IMBALANCE: f64 = 1e-10;

/// A factor with the workspaces of its factorization and of solves.
struct ReusedFactor {
    factor: SparseFactor,
    workspace: MemBuffer,
    /// Workspace of solves with many right-hand sides, and their largest number.
    block_workspace: MemBuffer,
    block_columns: usize,
}

impl ChangingFactor {
    /// Factors the first matrix.
    pub fn new(
        name: &'static str,
        matrix: &SparseMatrix,
        elimination: &Elimination,
    ) -> Result<Self> {
        Self::ending_with(name, matrix, elimination, &[])
    }

    /// Factors the first matrix, with `last_rows` (ascending) last in the order of elimination.
    ///
    /// [`ChangingFactor::solve_on_last_rows`] then needs only a small dense matrix.
    pub fn ending_with(
        name: &'static str,
        matrix: &SparseMatrix,
        elimination: &Elimination,
        last_rows: &[usize],
    ) -> Result<Self> {
        let columns = by_columns(matrix);
        let ending_elimination = (!last_rows.is_empty())
            .then(|| elimination.of_pattern_ending_with(columns.symbolic(), last_rows));
        let mut factor = Self {
            name,
            elimination: ending_elimination.flatten().unwrap_or_else(|| elimination.clone()),
            columns,
            column_indices: column_indices(matrix),
            mirrored_pairs: MirroredPairs::of(matrix),
            cholesky: None,
            block_lu: None,
            ends_with_last_rows: false,
            lu: None,
            method: Method::Cholesky,
            solution: vec![0.0; matrix.order()],
            last_rows: last_rows.to_vec(),
            last_entries: None,
            last_lower: vec![0.0; last_rows.len() * last_rows.len()],
        };
        factor.refactor(matrix)?;
        Ok(factor)
    }

    /// Factors another matrix of the same pattern.
    ///
    /// Allocates only at the first matrix that needs another method than all before.
    pub fn refactor(&mut self, matrix: &SparseMatrix) -> Result<()> {
        let values = self.columns.val_mut();
        for (column_index, value) in self.column_indices.iter().zip(&matrix.values) {
            values[*column_index] = *value;
        }
        let is_symmetric = self.mirrored_pairs.asymmetry(matrix) <= MAX_ASYMMETRY;
        self.method = Method::Cholesky;
        if is_symmetric && self.factor_by_cholesky() {
            if self.solves_test() {
                return Ok(());
            }
            return Err(Error::Singular { matrix: self.name, order: matrix.order() });
        }
        self.method = Method::BlockLu;
        if self.factor_by_block_lu(matrix) && self.balances_test(matrix) {
            return Ok(());
        }
        self.method = Method::Lu;
        if self.factor_by_lu() && self.solves_test() {
            return Ok(());
        }
        Err(Error::Singular { matrix: self.name, order: matrix.order() })
    }

    /// Factors by Cholesky; false unless the matrix is positive definite.
    fn factor_by_cholesky(&mut self) -> bool {
        if self.cholesky.is_none() {
            let Some(symbolic) = self.elimination.analyse(self.columns.symbolic()) else {
                return false;
            };
            self.last_entries = last_entries(&symbolic, &self.last_rows);
            let values = vec![0.0; symbolic.len_val()];
            let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
            let workspace = MemBuffer::new(scratch);
            let factors = Factors::Cholesky { symbolic, values };
            self.cholesky = Some(ReusedFactor::new(factors, self.columns.ncols(), workspace));
        }
        let Self { cholesky, columns, last_entries, last_lower, .. } = self;
        let Some(reused) = cholesky else { return false };
        let has_succeeded = reused.refactor(columns, &[]);
        if let (Factors::Cholesky { values, .. }, Some(entries)) =
            (&reused.factor.factors, last_entries)
        {
            for LastEntry { matrix_index, factor_index } in entries {
                last_lower[*matrix_index] = values[*factor_index];
            }
        }
        has_succeeded
    }

    /// Factors by LU with exchanges within fronts; false for a pattern without fronts.
    fn factor_by_block_lu(&mut self, matrix: &SparseMatrix) -> bool {
        if self.block_lu.is_none() {
            if !self.mirrored_pairs.is_symmetric_pattern() {
                return false;
            }
            let symbolic = self.elimination.analyse(self.columns.symbolic());
            let blocks = symbolic.and_then(|symbolic| BlockLu::new(&symbolic, matrix));
            let Some(blocks) = blocks else { return false };
            self.ends_with_last_rows = blocks.ends_with(&self.last_rows);
            let factors = Factors::BlockLu(Box::new(blocks));
            let workspace = MemBuffer::new(StackReq::EMPTY);
            self.block_lu = Some(ReusedFactor::new(factors, self.columns.ncols(), workspace));
        }
        let columns = &self.columns;
        self.block_lu.as_mut().is_some_and(|factor| factor.refactor(columns, &matrix.values))
    }

    /// Whether the solution for a test vector is finite and balances the vector.
    fn balances_test(&mut self, matrix: &SparseMatrix) -> bool {
        if !self.solves_test() {
            return false;
        }
        let mut max_imbalance = 0.0_f64;
        let mut max_sum = 1.0_f64;
        for row in 0..matrix.order() {
            let mut imbalance = -1.0;
            let mut sum = 0.0;
            for (column, value) in matrix.row(row) {
                let term = value * self.solution[column];
                imbalance += term;
                sum += term.abs();
            }
            max_imbalance = max_imbalance.max(imbalance.abs());
            max_sum = max_sum.max(sum);
        }
        max_imbalance <= MAX_TEST_IMBALANCE * max_sum
    }

    /// Factors by LU with partial pivoting; false if it fails.
    fn factor_by_lu(&mut self) -> bool {
        if self.lu.is_none() {
            let parameters = LuSymbolicParams::default();
            let Ok(symbolic) = factorize_symbolic_lu(self.columns.symbolic(), parameters) else {
                return false;
            };
            let scratch = symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Spec::default());
            let workspace = MemBuffer::new(scratch);
            let factors = Factors::Lu { symbolic, numeric: NumericLu::new() };
            self.lu = Some(ReusedFactor::new(factors, self.columns.ncols(), workspace));
        }
        self.lu.as_mut().is_some_and(|factor| factor.refactor(&self.columns, &[]))
    }

    /// Whether the solution for a test vector is finite.
    ///
    /// The pivots of a singular matrix may be rounding errors.
    fn solves_test(&mut self) -> bool {
        let mut solution = std::mem::take(&mut self.solution);
        solution.fill(1.0);
        self.solve(&mut solution);
        self.solution = solution;
        self.solution.iter().all(|x| x.is_finite())
    }

    /// The factor of the last matrix; `None` if its factorization failed.
    pub fn factor(&self) -> Option<&SparseFactor> {
        let factor = match self.method {
            Method::Cholesky => &self.cholesky,
            Method::BlockLu => &self.block_lu,
            Method::Lu => &self.lu,
        };
        factor.as_ref().map(|reused| &reused.factor)
    }

    /// The factor of the last matrix, with its workspaces.
    fn reused_factor(&mut self) -> Option<&mut ReusedFactor> {
        let factor = match self.method {
            Method::Cholesky => &mut self.cholesky,
            Method::BlockLu => &mut self.block_lu,
            Method::Lu => &mut self.lu,
        };
        factor.as_mut()
    }

    /// Overwrites `rhs` with A⁻¹ rhs.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        if let Some(reused) = self.reused_factor() {
            reused.factor.solve(rhs);
        }
    }

    /// Overwrites right-hand sides on the last rows with A⁻¹ rhs on these rows.
    ///
    /// `rhs`: the values on the last rows, one right-hand side after the other. On other rows they are zero.
    pub fn solve_on_last_rows(&mut self, rhs: &mut [f64]) {
        let count = self.last_rows.len();
        if count == 0 {
            return;
        }
        if self.method == Method::Cholesky && self.last_entries.is_some() {
            solve_by_lower(&self.last_lower, count, rhs);
            return;
        }
        if self.method == Method::BlockLu
            && self.ends_with_last_rows
            && let Some(reused) = &mut self.block_lu
            && let Factors::BlockLu(blocks) = &reused.factor.factors
        {
            for column in rhs.chunks_exact_mut(count) {
                let stack = MemStack::new(&mut reused.factor.buffer);
                blocks.solve_on_last_positions(column, stack);
            }
            return;
        }
        let mut solution = std::mem::take(&mut self.solution);
        for column in rhs.chunks_exact_mut(count) {
            solution.fill(0.0);
            for (row, value) in self.last_rows.iter().zip(column.iter()) {
                solution[*row] = *value;
            }
            self.solve(&mut solution);
            for (row, value) in self.last_rows.iter().zip(column) {
                *value = solution[*row];
            }
        }
        self.solution = solution;
    }

    /// Overwrites many right-hand sides, one after the other in `rhs`, with A⁻¹ rhs.
    ///
    /// Allocates only for more right-hand sides than in all earlier calls.
    pub fn solve_many(&mut self, rhs: &mut [f64]) {
        if let Some(reused) = self.reused_factor() {
            reused.solve_many(rhs);
        }
    }
}

/// Overwrites right-hand sides, one after the other, with (L Lᵀ)⁻¹ rhs.
///
/// `lower_triangle`: L, row-major, of this order.
fn solve_by_lower(lower_triangle: &[f64], order: usize, rhs: &mut [f64]) {
    let lower = MatRef::from_row_major_slice(lower_triangle, order, order);
    let mut right_sides = MatMut::from_column_major_slice_mut(rhs, order, rhs.len() / order);
    solve_lower_triangular_in_place(lower, right_sides.rb_mut(), Par::Seq);
    solve_upper_triangular_in_place(lower.transpose(), right_sides, Par::Seq);
}

impl ReusedFactor {
    /// Empty factors of matrices of this order, with the workspace of the factorization.
    fn new(factors: Factors, order: usize, workspace: MemBuffer) -> Self {
        let buffer = MemBuffer::new(factors.scratch(1));
        let block_workspace = MemBuffer::new(factors.scratch(1));
        let factor = SparseFactor { order, factors, buffer };
        Self { factor, workspace, block_workspace, block_columns: 1 }
    }

    /// Factors a matrix; false if it fails.
    ///
    /// `values`: its values by rows, for LU by fronts alone.
    fn refactor(&mut self, columns: &SparseColMat<usize, f64>, values: &[f64]) -> bool {
        let stack = MemStack::new(&mut self.workspace);
        let matrix = columns.as_ref();
        match &mut self.factor.factors {
            Factors::Cholesky { symbolic, values } => {
                let regularization = LltRegularization::default();
                let side = Side::Lower;
                symbolic
                    .factorize_numeric_llt(
                        values,
                        matrix,
                        side,
                        regularization,
                        Par::Seq,
                        stack,
                        Spec::default(),
                    )
                    .is_ok()
            }
            Factors::Lu { symbolic, numeric } => symbolic
                .factorize_numeric_lu(numeric, matrix, Par::Seq, stack, Spec::default())
                .is_ok(),
            Factors::BlockLu(blocks) => {
                blocks.factor(values);
                true
            }
        }
    }

    /// Overwrites many right-hand sides with A⁻¹ rhs.
    fn solve_many(&mut self, rhs: &mut [f64]) {
        let Self { factor, block_workspace, block_columns, .. } = self;
        let needed_columns = factor.block_columns(rhs.len());
        if needed_columns > *block_columns {
            *block_workspace = MemBuffer::new(factor.factors.scratch(needed_columns));
            *block_columns = needed_columns;
        }
        factor.solve_blocks(rhs, block_workspace);
    }
}

#[cfg(test)]
mod tests;
