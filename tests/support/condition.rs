//! Condition numbers by the inverse.

/// ‖SAS‖₁ ‖(SAS)⁻¹‖₁ of a row-major matrix with sᵢ = |aᵢᵢ|^−½, the inverse by Gauss–Jordan
/// elimination with row exchanges.
pub(crate) fn condition_by_inverse(matrix: &[f64], n: usize) -> f64 {
    let s: Vec<f64> = (0..n).map(|i| matrix[i * n + i].abs().sqrt()).collect();
    let mut a: Vec<f64> = (0..n * n).map(|k| matrix[k] / (s[k / n] * s[k % n])).collect();
    let norm = |a: &[f64]| {
        (0..n).map(|j| (0..n).map(|i| a[i * n + j].abs()).sum::<f64>()).fold(0.0, f64::max)
    };
    let before = norm(&a);
    let mut inverse: Vec<f64> =
        (0..n * n).map(|k| if k / n == k % n { 1.0 } else { 0.0 }).collect();
    for k in 0..n {
        let by_size = |i: &usize, j: &usize| a[i * n + k].abs().total_cmp(&a[j * n + k].abs());
        let pivot_row = (k..n).max_by(by_size).unwrap();
        for j in 0..n {
            a.swap(k * n + j, pivot_row * n + j);
            inverse.swap(k * n + j, pivot_row * n + j);
        }
        let pivot = a[k * n + k];
        for j in 0..n {
            a[k * n + j] /= pivot;
            inverse[k * n + j] /= pivot;
        }
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[i * n + k];
            for j in 0..n {
                a[i * n + j] -= factor * a[k * n + j];
                inverse[i * n + j] -= factor * inverse[k * n + j];
            }
        }
    }
    before * norm(&inverse)
}
