//! Determinants of complex matrices, and eigenvalues of Hermitian parts of matrices.

use super::DenseFactor;
use super::matrix_scalar::MatrixScalar;
use basemat_fourier::num_complex::Complex64;

impl DenseFactor<Complex64> {
    /// ln det A; its imaginary part is determined up to multiples of 2π.
    pub fn log_determinant(&self) -> Complex64 {
        let sign_angle =
            if self.exchange_count.is_multiple_of(2) { 0.0 } else { std::f64::consts::PI };
        self.pivots().map(Complex64::ln).sum::<Complex64>() + Complex64::new(0.0, sign_angle)
    }
}

/// Smallest and largest eigenvalue of the Hermitian part (A + Aᴴ)/2 of a row-major matrix.
///
/// The matrix may be real or complex. `None` if it is empty or not finite.
pub fn hermitian_range<T: MatrixScalar>(matrix: &[T], order: usize) -> Option<[f64; 2]> {
    T::hermitian_range(matrix, order)
}

#[cfg(test)]
mod tests {
    use basemat_fourier::num_complex::Complex64;

    use super::*;

    #[test]
    fn complex_factors_give_solutions_and_determinants() {
        let c = Complex64::new;
        let matrix = [
            c(0.0, 0.0),
            c(2.0, 1.0),
            c(0.0, 0.0),
            c(1.0, -1.0),
            c(0.0, 0.0),
            c(0.5, 0.0),
            c(0.0, 1.0),
            c(0.0, 0.0),
            c(3.0, 0.0),
        ];
        let mut factor = DenseFactor::with_columns(3, 2);
        assert!(factor.factor(&matrix, 3));
        // −(2+i)·[(1−i)·3 − ½·i]
        let expected = -c(2.0, 1.0) * (c(3.0, -3.0) - c(0.0, 0.5));
        assert!((factor.log_determinant().exp() - expected).norm() < 1e-14);
        // Two columns: A x for x = (1, i, 2) and (0, 1, −i).
        let x = [c(1.0, 0.0), c(0.0, 0.0), c(0.0, 1.0), c(1.0, 0.0), c(2.0, 0.0), c(0.0, -1.0)];
        let mut rhs: Vec<_> = (0..6)
            .map(|k| (0..3).map(|j| matrix[k / 2 * 3 + j] * x[2 * j + k % 2]).sum::<Complex64>())
            .collect();
        factor.solve_columns(&mut rhs, 2);
        assert!(rhs.iter().zip(&x).all(|(a, b)| (a - b).norm() < 1e-14));
        assert!(!factor.factor(&[c(1.0, 0.0); 9], 3));
    }

    #[test]
    fn hermitian_range_of_a_matrix_with_known_eigenvalues() {
        let c = Complex64::new;
        // Hermitian part [[1, 2i], [−2i, 1]]: eigenvalues 1 ± 2.
        let matrix = [c(1.0, 5.0), c(0.7, 2.0), c(-0.7, -2.0), c(1.0, -3.0)];
        let range = hermitian_range(&matrix, 2).unwrap();
        assert!((range[0] + 1.0).abs() < 1e-14 && (range[1] - 3.0).abs() < 1e-14);
        assert!(hermitian_range(&[c(f64::NAN, 0.0)], 1).is_none());
        assert!(hermitian_range::<f64>(&[], 0).is_none());
    }
}
