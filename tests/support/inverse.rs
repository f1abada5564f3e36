//! Inverses of dense matrices, and condition numbers by them.

/// Inverse of a row-major matrix of this order, by Gauss–Jordan elimination with row exchanges.
pub(crate) fn inverse(matrix: &[f64], order: usize) -> Vec<f64> {
    let n = order;
    let mut a = matrix.to_vec();
    let mut inverse: Vec<f64> = (0..n * n).map(|i| f64::from(u8::from(i / n == i % n))).collect();
    for k in 0..n {
        let larger = |i: &usize, j: &usize| a[i * n + k].abs().total_cmp(&a[j * n + k].abs());
        let pivot = (k..n).max_by(larger).unwrap();
        for j in 0..n {
            a.swap(k * n + j, pivot * n + j);
            inverse.swap(k * n + j, pivot * n + j);
        }
        let scale = 1.0 / a[k * n + k];
        for j in 0..n {
            a[k * n + j] *= scale;
            inverse[k * n + j] *= scale;
        }
        for i in (0..n).filter(|i| *i != k) {
            let factor = a[i * n + k];
            if factor != 0.0 {
                for j in 0..n {
                    a[i * n + j] -= factor * a[k * n + j];
                    inverse[i * n + j] -= factor * inverse[k * n + j];
                }
            }
        }
    }
    inverse
}

/// ‖SAS‖₁ ‖(SAS)⁻¹‖₁ of a row-major matrix with sᵢ = |aᵢᵢ|^−½.
pub(crate) fn condition_by_inverse(matrix: &[f64], n: usize) -> f64 {
    let s: Vec<f64> = (0..n).map(|i| matrix[i * n + i].abs().sqrt()).collect();
    let scaled: Vec<f64> = (0..n * n).map(|k| matrix[k] / (s[k / n] * s[k % n])).collect();
    let norm = |a: &[f64]| {
        (0..n).map(|j| (0..n).map(|i| a[i * n + j].abs()).sum::<f64>()).fold(0.0, f64::max)
    };
    norm(&scaled) * norm(&inverse(&scaled, n))
}
