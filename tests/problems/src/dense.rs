//! Dense matrices of structures.

use basemat::structure::{DofCombination, Structure, Triplets};

pub use basemat_testkit::dense::*;

pub fn dense(triplets: &Triplets) -> DenseMatrix {
    let mut matrix = vec![vec![0.0; triplets.order()]; triplets.order()];
    for &(row, column, value) in triplets.entries() {
        matrix[row][column] += value;
    }
    matrix
}

/// A sparse matrix times a vector.
pub fn product(matrix: &Triplets, vector: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; matrix.order()];
    for &(row, column, value) in matrix.entries() {
        sum[row] += value * vector[column];
    }
    sum
}

/// Entries that a structure adds to an empty matrix.
pub fn collect(
    structure: &dyn Structure,
    fill: impl FnOnce(&mut Triplets) -> basemat::Result<()>,
) -> DenseMatrix {
    let mut triplets = Triplets::new(structure.dofs());
    fill(&mut triplets).unwrap();
    dense(&triplets)
}

pub fn mass(structure: &dyn Structure) -> DenseMatrix {
    collect(structure, |m| structure.mass(m))
}

pub fn stiffness(structure: &dyn Structure) -> DenseMatrix {
    collect(structure, |m| structure.stiffness(m))
}

pub fn damping(structure: &dyn Structure) -> DenseMatrix {
    collect(structure, |m| structure.damping(m))
}

/// Value of a combination of degrees of freedom.
pub fn row_value(row: &DofCombination, values: &[f64]) -> f64 {
    row.iter().map(|&(index, weight)| weight * values[index]).sum()
}
