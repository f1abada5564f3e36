//! Determinants of complex matrices, and eigenvalues of Hermitian parts.

#[cfg(feature = "full-plane")]
use super::DenseFactor;
use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd;
use faer::traits::ComplexField;
use faer::traits::math_utils::{add, conj, is_finite, mul_real, real};
use faer::{MatRef, Par, Spec};
#[cfg(feature = "full-plane")]
use realfft::num_complex::Complex64;

#[cfg(feature = "full-plane")]
impl DenseFactor<Complex64> {
    /// ln det A; its imaginary part is determined up to multiples of 2π.
    pub(crate) fn log_determinant(&self) -> Complex64 {
        let sign = if self.transpositions.is_multiple_of(2) { 0.0 } else { std::f64::consts::PI };
        self.pivots().map(Complex64::ln).sum::<Complex64>() + Complex64::new(0.0, sign)
    }
}

/// Smallest and largest eigenvalue of the Hermitian part (A + Aᴴ)/2 of a row-major matrix.
///
/// The matrix may be real or complex. `None` if it is empty or not finite.
pub(crate) fn hermitian_range<T>(matrix: &[T], order: usize) -> Option<[f64; 2]>
where
    T: ComplexField<Real = f64> + Copy,
{
    let mut part = Vec::with_capacity(order * order);
    for row in 0..order {
        for column in 0..order {
            let mirrored = conj(&matrix[column * order + row]);
            part.push(mul_real(&add(&matrix[row * order + column], &mirrored), &0.5));
        }
    }
    if order == 0 || !part.iter().all(is_finite) {
        return None;
    }
    let mut values = part[..order].to_vec();
    let mut buffer = MemBuffer::new(evd::self_adjoint_evd_scratch::<T>(
        order,
        evd::ComputeEigenvectors::No,
        Par::Seq,
        Spec::default(),
    ));
    evd::self_adjoint_evd(
        MatRef::from_row_major_slice(&part, order, order),
        DiagMut::from_slice_mut(&mut values),
        None,
        Par::Seq,
        MemStack::new(&mut buffer),
        Spec::default(),
    )
    .ok()?;
    let smallest = values.iter().map(real).fold(f64::INFINITY, f64::min);
    let largest = values.iter().map(real).fold(f64::NEG_INFINITY, f64::max);
    Some([smallest, largest])
}

#[cfg(test)]
mod tests {
    use realfft::num_complex::Complex64;

    use super::*;

    #[cfg(feature = "full-plane")]
    #[test]
    fn complex_factor_solves_and_knows_its_determinant() {
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
        let wanted = -c(2.0, 1.0) * (c(3.0, -3.0) - c(0.0, 0.5));
        assert!((factor.log_determinant().exp() - wanted).norm() < 1e-14);
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
        // Hermitian part [[1, 2i], [−2i, 1]]: eigenvalues 1 ± 2; the rest is skew.
        let matrix = [c(1.0, 5.0), c(0.7, 2.0), c(-0.7, -2.0), c(1.0, -3.0)];
        let range = hermitian_range(&matrix, 2).unwrap();
        assert!((range[0] + 1.0).abs() < 1e-14 && (range[1] - 3.0).abs() < 1e-14);
        assert!(hermitian_range(&[c(f64::NAN, 0.0)], 1).is_none());
        assert!(hermitian_range::<f64>(&[], 0).is_none());
    }
}
