//! Operations on the matrices of one element: sums, transformation, elimination of inner degrees of freedom.

/// Adds an element matrix to a row-major `sum` of the same order.
pub(crate) fn add_matrix<const N: usize>(sum: &mut [f64], element_matrix: &[[f64; N]; N]) {
    for (entry, value) in sum.iter_mut().zip(element_matrix.iter().flatten()) {
        *entry += value;
    }
}

/// Adds the matrix Tᵀ k T in global directions to a row-major `sum`.
///
/// k = `local_matrix`; T = `to_local` transforms global to local displacements.
pub(crate) fn add_transformed<const N: usize>(
    local_matrix: &[[f64; N]; N],
    to_local: &[[f64; N]; N],
    sum: &mut [f64],
) {
    let mut local_matrix_times_t = [[0.0; N]; N];
    let mut global_matrix = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            local_matrix_times_t[i][j] = (0..N).map(|k| local_matrix[i][k] * to_local[k][j]).sum();
        }
    }
    for i in 0..N {
        for j in 0..N {
            global_matrix[i][j] = (0..N).map(|k| to_local[k][i] * local_matrix_times_t[k][j]).sum();
        }
    }
    add_matrix(sum, &global_matrix);
}

/// Eliminates the degrees of freedom from `outer_order` on by static condensation.
///
/// The last degree of freedom is eliminated first. Afterwards the leading block is the condensed matrix. The other
/// rows are the equations of the inner degrees of freedom, for [`recover_inner`].
pub(super) fn condense<const N: usize>(matrix: &mut [[f64; N]; N], outer_order: usize) {
    for pivot in (outer_order..N).rev() {
        let pivot_row = matrix[pivot];
        for i in 0..pivot {
            let factor = matrix[i][pivot] / pivot_row[pivot];
            for j in 0..pivot {
                matrix[i][j] -= factor * pivot_row[j];
            }
        }
    }
}

/// Overwrites the inner displacements, from `outer_order` on, by the outer displacements.
///
/// `condensed_matrix`: matrix after [`condense`].
pub(super) fn recover_inner<const N: usize>(
    condensed_matrix: &[[f64; N]; N],
    outer_order: usize,
    displacement: &mut [f64; N],
) {
    for pivot in outer_order..N {
        let pivot_row = &condensed_matrix[pivot];
        let force: f64 =
            pivot_row[..pivot].iter().zip(&displacement[..pivot]).map(|(k, u)| k * u).sum();
        displacement[pivot] = -force / pivot_row[pivot];
    }
}

/// Leading block of a matrix: its first M rows and columns.
pub(super) fn leading_block<const N: usize, const M: usize>(
    matrix: &[[f64; N]; N],
) -> [[f64; M]; M] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[i][j]))
}
