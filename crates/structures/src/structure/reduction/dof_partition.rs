//! Kept and interior degrees of freedom of a reduction, and its basis.

use crate::error::{Error, Result, at_least, in_bounds, memory};
use crate::linalg::{Eigenpairs, SparseFactor, SparseMatrix, lowest_modes};
use crate::structure::detached::submatrix;
use crate::structure::{Base, BaseNode, DofCombination};

/// Bytes for each entry of T.
///
/// They are the basis, its copy while it grows, and scratch of the eigenvalue solver.
const BASIS_BYTES_PER_ENTRY: f64 = 24.0;

/// Kept and interior degrees of freedom.
pub(super) struct DofPartition {
    pub(super) kept_dofs: Vec<usize>,
    pub(super) interior: Vec<usize>,
    /// Index of each degree of freedom among the kept or among the interior ones.
    list_index: Vec<usize>,
    is_kept: Vec<bool>,
}

impl DofPartition {
    /// Partition of `n` degrees of freedom, which keeps the base and `further_dofs`.
    pub(super) fn new(n: usize, base: &Base, further_dofs: &[usize]) -> Result<Self> {
        let base_terms = base.nodes().flat_map(BaseNode::rows).flatten();
        let mut is_kept = vec![false; n];
        for dof in base_terms.map(|&(dof, _)| dof).chain(further_dofs.iter().copied()) {
            is_kept[in_bounds("degree of freedom to be kept", dof, n)?] = true;
        }
        let mut kept_dofs = Vec::new();
        let mut interior = Vec::new();
        let mut list_index = Vec::with_capacity(n);
        for dof in 0..n {
            let dof_list = if is_kept[dof] { &mut kept_dofs } else { &mut interior };
            list_index.push(dof_list.len());
            dof_list.push(dof);
        }
        at_least("list of kept degrees of freedom", kept_dofs.len(), 1)?;
        Ok(Self { kept_dofs, interior, list_index, is_kept })
    }

    /// A sum of kept degrees of freedom in the numbering of the reduced model.
    pub(super) fn renumbered(&self, row: &DofCombination) -> DofCombination {
        row.map_dofs(|dof| self.list_index[dof])
    }

    /// Block A_ii of a matrix.
    fn interior_block(&self, name: &'static str, matrix: &SparseMatrix) -> Result<SparseMatrix> {
        submatrix(name, matrix, self.interior.len(), |dof| {
            (!self.is_kept[dof]).then_some(self.list_index[dof])
        })
    }

    /// Rows of Tᵀ, and squared circular frequencies of the modes (rad²/s²).
    pub(super) fn basis(
        &self,
        stiffness: &SparseMatrix,
        mass: &SparseMatrix,
        mode_count: usize,
    ) -> Result<(Vec<f64>, Vec<f64>)> {
        const MATRIX_NAME: &str = "stiffness matrix with the kept degrees of freedom fixed";
        let n = self.list_index.len();
        let interior_count = self.interior.len();
        let kept_count = self.kept_dofs.len();
        let row_count = (kept_count + mode_count.min(interior_count)) as f64;
        memory::check(
            "degrees of freedom and modes of the reduction",
            row_count,
            BASIS_BYTES_PER_ENTRY * row_count * n as f64,
        )?;
        let mut rows = vec![0.0; kept_count * n];
        for (kept_index, &dof) in self.kept_dofs.iter().enumerate() {
            rows[kept_index * n + dof] = 1.0;
        }
        if interior_count == 0 {
            return Ok((rows, Vec::new()));
        }
        let interior_stiffness = self.interior_block(MATRIX_NAME, stiffness)?;
        let factor = SparseFactor::positive_definite(MATRIX_NAME, &interior_stiffness)?;
        let mut static_responses = vec![0.0; kept_count * interior_count];
        for (row, column, value) in stiffness.entries() {
            if !self.is_kept[row] && self.is_kept[column] {
                static_responses
                    [self.list_index[column] * interior_count + self.list_index[row]] -= value;
            }
        }
        factor.solve_many(&mut static_responses);
        let interior_mass =
            self.interior_block("mass matrix with the kept degrees of freedom fixed", mass)?;
        let Eigenpairs { values: squared_frequencies, vectors: mode_shapes } =
            lowest_modes(&factor, &interior_mass, mode_count, None)
                .ok_or(Error::Singular { matrix: MATRIX_NAME, order: interior_count })?;
        rows.resize((kept_count + squared_frequencies.len()) * n, 0.0);
        let interior_rows = static_responses
            .chunks_exact(interior_count)
            .chain(mode_shapes.chunks_exact(interior_count));
        for (row, values) in rows.chunks_exact_mut(n).zip(interior_rows) {
            for (&dof, value) in self.interior.iter().zip(values) {
                row[dof] = *value;
            }
        }
        if rows.iter().all(|value| value.is_finite()) {
            Ok((rows, squared_frequencies))
        } else {
            Err(Error::Singular { matrix: MATRIX_NAME, order: interior_count })
        }
    }
}
