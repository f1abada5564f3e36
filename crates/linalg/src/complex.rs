//! Complex numbers: Laplace variables, complex moduli of soil, and arguments of closed-form functions.
//!
//! Small functions are `#[inline]`, because other crates call them in loops.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use basemat_fourier::num_complex::Complex64;

/// Complex number, such as a Laplace variable s (unit 1/s) or a soil's complex modulus at s.
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

/// Lower bound of squared distances from the poles of artanh, so that [`Complex::atanh`] stays finite there.
const MIN_POLE_DISTANCE_SQUARE: f64 = 1e-30;

impl Complex {
    /// `re` + i `im`.
    #[inline]
    pub const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// A real number.
    #[inline]
    pub const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// `modulus` e^(i `angle`).
    #[doc(hidden)]
    #[inline]
    pub fn polar(modulus: f64, angle: f64) -> Self {
        Self::new(modulus * angle.cos(), modulus * angle.sin())
    }

    /// Absolute value.
    #[inline]
    pub fn abs(self) -> f64 {
        let squared_modulus = self.squared_modulus();
        // `hypot` is slower, but its intermediate results stay in the range of f64.
        if squared_modulus.is_normal() {
            squared_modulus.sqrt()
        } else {
            self.re.hypot(self.im)
        }
    }

    /// |x|².
    #[doc(hidden)]
    #[inline]
    pub fn squared_modulus(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    /// Complex conjugate.
    #[must_use]
    #[doc(hidden)]
    #[inline]
    pub const fn conj(self) -> Self {
        Self::new(self.re, -self.im)
    }

    /// Product with a real number.
    #[must_use]
    #[doc(hidden)]
    #[inline]
    pub fn scale(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    /// 1/x.
    #[must_use]
    #[inline]
    pub fn inverse(self) -> Self {
        let squared_modulus = self.squared_modulus();
        if squared_modulus.is_normal() {
            return self.conj().scale(1.0 / squared_modulus);
        }
        let larger_part = self.re.abs().max(self.im.abs());
        let scaled_number = self.scale(1.0 / larger_part);
        scaled_number
            .conj()
            .scale(1.0 / scaled_number.squared_modulus())
            .scale(1.0 / larger_part)
    }

    /// Square root with a real part not below zero.
    #[must_use]
    #[inline]
    pub fn sqrt(self) -> Self {
        let modulus = self.abs();
        if modulus == 0.0 {
            return Self::default();
        }
        let larger_part = (0.5 * (modulus + self.re.abs())).sqrt();
        let smaller_part = 0.5 * self.im / larger_part;
        if self.re >= 0.0 {
            Self::new(larger_part, smaller_part)
        } else {
            Self::new(smaller_part.abs(), larger_part.copysign(self.im))
        }
    }

    /// e^x.
    #[must_use]
    #[inline]
    pub fn exp(self) -> Self {
        let modulus = self.re.exp();
        if modulus == 0.0 {
            return Self::default();
        }
        Self::polar(modulus, self.im)
    }

    /// Principal logarithm.
    #[must_use]
    #[inline]
    pub fn ln(self) -> Self {
        Self::new(self.abs().ln(), self.im.atan2(self.re))
    }

    /// Principal power with a real exponent.
    #[must_use]
    #[inline]
    pub fn powf(self, exponent: f64) -> Self {
        Self::polar(self.abs().powf(exponent), exponent * self.im.atan2(self.re))
    }

    /// Principal artanh; on the real axis beyond ±1, its real part.
    #[doc(hidden)]
    #[inline]
    pub fn atanh(self) -> Self {
        // |1 + x|² and |1 − x|².
        let plus_square =
            ((1.0 + self.re).powi(2) + self.im * self.im).max(MIN_POLE_DISTANCE_SQUARE);
        let minus_square =
            ((1.0 - self.re).powi(2) + self.im * self.im).max(MIN_POLE_DISTANCE_SQUARE);
        let re = if self.re.abs() < 0.5 * plus_square.min(minus_square) {
            0.25 * (4.0 * self.re / minus_square).ln_1p()
        } else {
            0.25 * (plus_square / minus_square).ln()
        };
        if self.im == 0.0 {
            return Self::real(re);
        }
        Self::new(re, 0.5 * (2.0 * self.im).atan2(1.0 - self.squared_modulus()))
    }

    /// Converts to the type that transforms and matrices use.
    #[doc(hidden)]
    #[inline]
    pub fn to_complex64(self) -> Complex64 {
        Complex64::new(self.re, self.im)
    }

    /// Whether both parts are finite.
    #[doc(hidden)]
    #[inline]
    pub fn is_finite(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
}

impl Add for Complex {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl AddAssign for Complex {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Complex {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl Mul for Complex {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::new(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)
    }
}

impl Mul<f64> for Complex {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        self.scale(factor)
    }
}

impl Div for Complex {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let squared_modulus = other.squared_modulus();
        if squared_modulus.is_normal() {
            return (self * other.conj()).scale(1.0 / squared_modulus);
        }
        self * other.inverse()
    }
}

impl Neg for Complex {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.re, -self.im)
    }
}
