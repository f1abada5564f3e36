//! Elimination of inner degrees of freedom of an element.

/// Eliminates the degrees of freedom from `kept` on, the last one first.
///
/// Afterwards the leading block is the condensed matrix. The other rows are the equations of the inner degrees of
/// freedom, for [`complete`].
pub(super) fn condense<const N: usize>(matrix: &mut [[f64; N]; N], kept: usize) {
    for pivot in (kept..N).rev() {
        let row = matrix[pivot];
        for i in 0..pivot {
            let factor = matrix[i][pivot] / row[pivot];
            for j in 0..pivot {
                matrix[i][j] -= factor * row[j];
            }
        }
    }
}

/// Overwrites the values from `kept` on with the inner displacements of a condensed matrix.
pub(super) fn complete<const N: usize>(
    condensed: &[[f64; N]; N],
    kept: usize,
    values: &mut [f64; N],
) {
    for pivot in kept..N {
        let row = &condensed[pivot];
        let force: f64 = row[..pivot].iter().zip(&values[..pivot]).map(|(k, u)| k * u).sum();
        values[pivot] = -force / row[pivot];
    }
}

/// The first M rows and columns of a matrix.
pub(super) fn leading<const N: usize, const M: usize>(matrix: &[[f64; N]; N]) -> [[f64; M]; M] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[i][j]))
}
