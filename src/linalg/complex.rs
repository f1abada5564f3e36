//! Complex numbers, dense complex matrices, and eigenvalues of Hermitian parts.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

#[cfg(feature = "full-plane")]
use super::DenseFactor;
use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd;
use faer::traits::ComplexField;
use faer::traits::math_utils::{add, conj, is_finite, mul_real, real};
use faer::{MatRef, Par, Spec};
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
            let twin = conj(&matrix[column * order + row]);
            part.push(mul_real(&add(&matrix[row * order + column], &twin), &0.5));
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
    let range = values
        .iter()
        .map(real)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    Some(range)
}

// Complex numbers: Laplace variables, moduli and the closed forms.

/// A complex number: a Laplace variable s, 1/s, or a modulus at it.
///
/// ```
/// use basemat::Complex;
/// let s = Complex::new(3.0, 4.0);
/// assert_eq!(s.abs(), 5.0);
/// assert_eq!(s.sqrt(), Complex::new(2.0, 1.0));
/// assert_eq!(Complex::new(0.0, 2.0).inverse(), Complex::new(0.0, -0.5));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// `re` + i `im`.
    pub const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// A real number.
    pub const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// `size` e^(i `angle`).
    pub(crate) fn polar(size: f64, angle: f64) -> Self {
        Self::new(size * angle.cos(), size * angle.sin())
    }

    /// Absolute value.
    pub fn abs(self) -> f64 {
        let square = self.square();
        // If the square leaves the range of f64, `hypot` is used, which is slower.
        if square.is_normal() { square.sqrt() } else { self.re.hypot(self.im) }
    }

    /// |x|².
    pub(crate) fn square(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    /// Complex conjugate.
    #[must_use]
    pub(crate) const fn conj(self) -> Self {
        Self::new(self.re, -self.im)
    }

    /// Product with a real number.
    #[must_use]
    pub(crate) fn scale(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    /// 1/x.
    #[must_use]
    pub fn inverse(self) -> Self {
        let square = self.square();
        if square.is_normal() {
            return self.conj().scale(1.0 / square);
        }
        let size = self.re.abs().max(self.im.abs());
        let unit = self.scale(1.0 / size);
        unit.conj().scale(1.0 / unit.square()).scale(1.0 / size)
    }

    /// Square root with a real part not below zero.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let size = self.abs();
        if size == 0.0 {
            return Self::default();
        }
        let large = (0.5 * (size + self.re.abs())).sqrt();
        let small = 0.5 * self.im / large;
        if self.re >= 0.0 {
            Self::new(large, small)
        } else {
            Self::new(small.abs(), large.copysign(self.im))
        }
    }

    /// e^x.
    #[must_use]
    pub fn exp(self) -> Self {
        let size = self.re.exp();
        if size == 0.0 {
            return Self::default();
        }
        Self::polar(size, self.im)
    }

    /// Principal logarithm.
    #[must_use]
    pub fn ln(self) -> Self {
        Self::new(self.abs().ln(), self.im.atan2(self.re))
    }

    /// Principal power with a real exponent.
    #[must_use]
    pub fn powf(self, exponent: f64) -> Self {
        Self::polar(self.abs().powf(exponent), exponent * self.im.atan2(self.re))
    }

    /// Principal artanh; on the real axis beyond ±1, its real part.
    pub(crate) fn atanh(self) -> Self {
        let above = (1.0 + self.re).powi(2) + self.im * self.im;
        // The lower limit 1e-30 replaces zero at the pole.
        let below = ((1.0 - self.re).powi(2) + self.im * self.im).max(1e-30);
        let above = above.max(1e-30);
        let re = if self.re.abs() < 0.5 * above.min(below) {
            0.25 * (4.0 * self.re / below).ln_1p()
        } else {
            0.25 * (above / below).ln()
        };
        if self.im == 0.0 {
            return Self::real(re);
        }
        let size = self.re * self.re + self.im * self.im;
        Self::new(re, 0.5 * (2.0 * self.im).atan2(1.0 - size))
    }

    /// This number in the type that transforms and matrices use.
    pub(crate) fn inner(self) -> Complex64 {
        Complex64::new(self.re, self.im)
    }

    /// Whether both parts are finite.
    pub(crate) fn is_finite(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl AddAssign for Complex {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)
    }
}

impl Mul<f64> for Complex {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.scale(factor)
    }
}

impl Div for Complex {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let square = other.square();
        if square.is_normal() {
            return (self * other.conj()).scale(1.0 / square);
        }
        self * other.inverse()
    }
}

impl Neg for Complex {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.re, -self.im)
    }
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
        let [low, high] = hermitian_range(&matrix, 2).unwrap();
        assert!((low + 1.0).abs() < 1e-14 && (high - 3.0).abs() < 1e-14);
        assert!(hermitian_range(&[c(f64::NAN, 0.0)], 1).is_none());
        assert!(hermitian_range::<f64>(&[], 0).is_none());
    }
}
