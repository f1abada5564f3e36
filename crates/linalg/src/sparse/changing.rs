//! Factors of matrices whose numbers change while their sparsity pattern stays, in reused memory.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::SparseColMat;
use faer::sparse::linalg::lu::{LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::{Par, Side, Spec};

use super::{Factors, LastEntry, SparseFactor, last_entries};
use crate::SparseMatrix;
use crate::elimination::{Elimination, by_columns, column_indices};
use crate::error::{Error, Result};
use crate::symmetry::{MAX_ASYMMETRY, relative_asymmetry};

/// Factor of the last of many matrices with one sparsity pattern.
///
/// The order of elimination and the pattern of the factor are determined once. Each new matrix is factored in the
/// memory of the last one, with the same result to the last bit as by [`SparseFactor::with_elimination`].
pub struct ChangingFactor {
    name: &'static str,
    elimination: Elimination,
    /// The matrix, by columns.
    columns: SparseColMat<usize, f64>,
    /// Position, in storage by columns, of each entry in storage by rows.
    column_indices: Vec<usize>,
    /// Index of the mirrored entry of each entry, both by rows; `usize::MAX` if the mirrored entry is not stored.
    mirrored_indices: Vec<usize>,
    /// Factor of symmetric positive definite matrices.
    cholesky: Option<ReusedFactor>,
    /// Factor of all other matrices.
    lu: Option<ReusedFactor>,
    /// Whether the last matrix was factored by LU.
    uses_lu: bool,
    /// Buffer for the solution of a factor's test, and for solutions of right-hand sides on the last rows.
    solution: Vec<f64>,
    last_rows: Vec<usize>,
    /// Entries of Cholesky's factor in the last rows; `None` unless they are a dense block.
    last_entries: Option<Vec<LastEntry>>,
    /// Cholesky's factor of the matrix condensed on the last rows, row-major.
    last_lower: Vec<f64>,
}

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
            mirrored_indices: matrix.mirrored_indices().collect(),
            cholesky: None,
            lu: None,
            uses_lu: false,
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
        let is_symmetric = self.asymmetry(matrix) <= MAX_ASYMMETRY;
        self.uses_lu = !(is_symmetric && self.factor_by_cholesky());
        if (!self.uses_lu || self.factor_by_lu()) && self.solves_test() {
            return Ok(());
        }
        Err(Error::Singular { matrix: self.name, order: matrix.order() })
    }

    /// Largest |a_ij − a_ji| relative to the largest |a_ij|, as [`SparseMatrix::asymmetry`].
    fn asymmetry(&self, matrix: &SparseMatrix) -> f64 {
        let pairs = matrix.values.iter().zip(&self.mirrored_indices);
        relative_asymmetry(pairs.map(|(value, mirrored_index)| {
            (*value, matrix.values.get(*mirrored_index).copied().unwrap_or(0.0))
        }))
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
        let has_succeeded = reused.refactor(columns);
        if let (Factors::Cholesky { values, .. }, Some(entries)) =
            (&reused.factor.factors, last_entries)
        {
            for LastEntry { matrix_index, factor_index } in entries {
                last_lower[*matrix_index] = values[*factor_index];
            }
        }
        has_succeeded
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
        self.lu.as_mut().is_some_and(|factor| factor.refactor(&self.columns))
    }

    /// Whether the solution for a test vector is finite: the pivots of a singular matrix may be rounding errors.
    fn solves_test(&mut self) -> bool {
        let mut solution = std::mem::take(&mut self.solution);
        solution.fill(1.0);
        self.solve(&mut solution);
        self.solution = solution;
        self.solution.iter().all(|x| x.is_finite())
    }

    /// The factor of the last matrix; `None` if its factorization failed.
    pub fn factor(&self) -> Option<&SparseFactor> {
        let factor = if self.uses_lu { &self.lu } else { &self.cholesky };
        factor.as_ref().map(|reused| &reused.factor)
    }

    /// The factor of the last matrix, with its workspaces.
    fn reused_factor(&mut self) -> Option<&mut ReusedFactor> {
        let factor = if self.uses_lu { &mut self.lu } else { &mut self.cholesky };
        factor.as_mut()
    }

    /// Overwrites `rhs` with A⁻¹ rhs.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        if let Some(reused) = self.reused_factor() {
            reused.factor.solve(rhs);
        }
    }

    /// Overwrites right-hand sides that are zero but for the last rows, with A⁻¹ rhs on these rows.
    ///
    /// `rhs`: the values on the last rows, one right-hand side after the other.
    pub fn solve_on_last_rows(&mut self, rhs: &mut [f64]) {
        let count = self.last_rows.len().max(1);
        if !self.uses_lu && self.last_entries.is_some() {
            for column in rhs.chunks_exact_mut(count) {
                solve_by_lower(&self.last_lower, column);
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

/// Overwrites `rhs` with (L Lᵀ)⁻¹ rhs, for a row-major lower triangle L.
fn solve_by_lower(lower: &[f64], rhs: &mut [f64]) {
    let count = rhs.len();
    for (i, row) in lower.chunks_exact(count).enumerate() {
        let sum: f64 = row[..i].iter().zip(&*rhs).map(|(l, x)| l * x).sum();
        rhs[i] = (rhs[i] - sum) / row[i];
    }
    for (i, row) in lower.chunks_exact(count).enumerate().rev() {
        rhs[i] /= row[i];
        let x = rhs[i];
        rhs[..i].iter_mut().zip(row).for_each(|(value, l)| *value -= l * x);
    }
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
    fn refactor(&mut self, columns: &SparseColMat<usize, f64>) -> bool {
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
mod tests {
    use super::*;
    use crate::Triplets;

    /// Grid of springs to near neighbours, with stiffnesses between `low` and 1, and an unsymmetric part.
    fn grid(side: usize, seed: f64, low: f64, skew: f64) -> SparseMatrix {
        let mut matrix = Triplets::new(side * side);
        for v in 0..side * side {
            matrix.add(v, v, 0.1);
            let stiffness = low + (seed + v as f64).sin().abs() * (1.0 - low);
            // Many neighbours: the factor of a large grid then has dense blocks.
            for [x, y] in (1..16).map(|k| [v % side + k % 4, v / side + k / 4]) {
                if x < side && y < side {
                    matrix.add_spring(v, x + side * y, stiffness);
                    matrix.add(v, x + side * y, skew);
                }
            }
        }
        SparseMatrix::new("grid", &matrix).unwrap()
    }

    /// REFERENCE: a new factor of each matrix, to the last bit.
    #[test]
    fn changing_factors_are_new_factors() {
        for side in [5, 40] {
            let elimination = Elimination::default();
            let first = grid(side, 0.0, 0.5, 0.0);
            let mut changing = ChangingFactor::new("grid", &first, &elimination).unwrap();
            // Symmetric, unsymmetric, indefinite and symmetric again.
            let cases = [(0.1, 0.0), (0.5, 0.2), (-0.9, 0.0), (0.3, 0.0), (0.3, -0.1)];
            for (k, (low, skew)) in (0..).zip(cases) {
                let matrix = grid(side, f64::from(k), low, skew);
                changing.refactor(&matrix).unwrap();
                let new_factor =
                    SparseFactor::with_elimination("grid", &matrix, &elimination).unwrap();
                let is_definite = changing.factor().unwrap().is_positive_definite();
                assert_eq!(is_definite, new_factor.is_positive_definite());
                assert_eq!(is_definite, low > 0.0 && skew == 0.0);
                let right_sides: Vec<f64> =
                    (0..7 * side * side).map(|i| (i as f64).sin()).collect();
                let mut computed = right_sides.clone();
                let mut expected = right_sides;
                changing.solve_many(&mut computed);
                new_factor.solve_many(&mut expected);
                assert_eq!(computed, expected);
                let residual = matrix.times(&computed[..side * side]);
                let error = residual.iter().enumerate().map(|(i, r)| (r - (i as f64).sin()).abs());
                assert!(error.fold(0.0, f64::max) < 1e-9);
            }
            // On the last rows, with computed dense block or without.
            let last_rows: Vec<usize> = (0..side).map(|k| k * side + (k * k) % side).collect();
            let mut ending_factor =
                ChangingFactor::ending_with("grid", &first, &elimination, &last_rows).unwrap();
            for (low, skew) in [(0.2, 0.0), (0.2, 0.1), (-0.9, 0.0), (0.4, 0.0)] {
                let matrix = grid(side, 0.7, low, skew);
                ending_factor.refactor(&matrix).unwrap();
                changing.refactor(&matrix).unwrap();
                let mut last_values: Vec<f64> = (0..3 * side).map(|i| (i as f64).cos()).collect();
                for (k, column) in last_values.clone().chunks_exact(side).enumerate() {
                    let mut full_solution = vec![0.0; side * side];
                    last_rows
                        .iter()
                        .zip(column)
                        .for_each(|(row, value)| full_solution[*row] = *value);
                    changing.solve(&mut full_solution);
                    ending_factor.solve_on_last_rows(&mut last_values[k * side..][..side]);
                    for (row, value) in last_rows.iter().zip(&last_values[k * side..]) {
                        assert!(
                            (full_solution[*row] - value).abs() < 1e-9,
                            "{} {value}",
                            full_solution[*row]
                        );
                    }
                }
            }
            assert_eq!(ending_factor.last_entries.is_some(), side == 40);
            let zero = grid(side, 0.0, 0.0, 0.0);
            let mut singular = zero.clone();
            singular.values.fill(0.0);
            assert!(matches!(changing.refactor(&singular), Err(Error::Singular { .. })));
            changing.refactor(&first).unwrap();
        }
    }
}
