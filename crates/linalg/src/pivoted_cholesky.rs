//! Cholesky factorization of low rank, with diagonal pivoting.

/// Largest magnitude of a negative entry on the diagonal of V − L Lᵀ, relative to the tolerance.
///
/// For a semi-definite V, rounding errors make no entry more negative than this.
const NEGATIVE_RESIDUAL_TOLERANCE_FACTOR: f64 = 10.0;

/// Columns of L with V = L Lᵀ, for a positive semi-definite V of low rank.
///
/// Further factorizations use its memory again.
#[derive(Debug, Clone, Default)]
pub struct PivotedCholesky {
    residual_diagonal: Vec<f64>,
    products: Vec<f64>,
    /// L, column by column.
    columns: Vec<f64>,
    rank: usize,
}

impl PivotedCholesky {
    /// Factors V from its diagonal; false if L has more than `max_rank` columns, or V is empty or not semi-definite.
    ///
    /// Cholesky factorization with diagonal pivoting (Higham 2002, § 10.3). `write_column(j, column)` overwrites `column`
    /// with column j of V. The diagonal of V − L Lᵀ is at most `tolerance`.
    pub fn factor(
        &mut self,
        diagonal: impl Iterator<Item = f64>,
        tolerance: f64,
        max_rank: usize,
        mut write_column: impl FnMut(usize, &mut [f64]),
    ) -> bool {
        let Self { residual_diagonal, products, columns, rank } = self;
        residual_diagonal.clear();
        residual_diagonal.extend(diagonal);
        let size = residual_diagonal.len();
        products.resize(size, 0.0);
        columns.clear();
        *rank = 0;
        loop {
            let indices = 0..size;
            let Some(pivot) =
                indices.max_by(|a, b| residual_diagonal[*a].total_cmp(&residual_diagonal[*b]))
            else {
                return false;
            };
            if residual_diagonal[pivot] <= tolerance {
                let min_residual = -NEGATIVE_RESIDUAL_TOLERANCE_FACTOR * tolerance;
                return residual_diagonal.iter().all(|residual| *residual >= min_residual);
            }
            if *rank == max_rank {
                return false;
            }
            let root = residual_diagonal[pivot].sqrt();
            let first = columns.len();
            columns.resize(first + size, 0.0);
            let (earlier_columns, column) = columns.split_at_mut(first);
            write_column(pivot, column);
            products.fill(0.0);
            for earlier_column in earlier_columns.chunks_exact(size) {
                let factor = earlier_column[pivot];
                for (product, entry) in products.iter_mut().zip(earlier_column) {
                    *product += entry * factor;
                }
            }
            for (value, product) in column.iter_mut().zip(&*products) {
                *value = (*value - product) / root;
            }
            for (residual, value) in residual_diagonal.iter_mut().zip(&*column) {
                *residual -= value * value;
            }
            residual_diagonal[pivot] = 0.0;
            *rank += 1;
        }
    }

    /// Number of columns of L.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// The columns of L.
    pub fn columns(&self) -> impl Iterator<Item = &[f64]> {
        self.columns.chunks_exact(self.residual_diagonal.len().max(1))
    }
}

/// Columns of L with V = L Lᵀ, as [`PivotedCholesky::factor`]; `None` if V has no such factor.
pub fn pivoted_cholesky(
    diagonal: Vec<f64>,
    tolerance: f64,
    max_rank: usize,
    write_column: impl FnMut(usize, &mut [f64]),
) -> Option<Vec<Vec<f64>>> {
    let mut factor = PivotedCholesky::default();
    factor
        .factor(diagonal.into_iter(), tolerance, max_rank, write_column)
        .then(|| factor.columns().map(<[f64]>::to_vec).collect())
}
