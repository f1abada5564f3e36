//! Arithmetic written once for one complex number and for several at a time.

use std::ops::{Add, Mul, Neg, Sub};

use super::Complex;

/// Complex number, or several of them, one in each lane.
#[doc(hidden)]
pub trait ComplexArithmetic:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> + 'static
{
    /// `value` in as many lanes as this number has.
    fn like(self, value: Complex) -> Self;

    /// A real number in as many lanes as this number has.
    fn like_real(self, value: f64) -> Self {
        self.like(Complex::real(value))
    }

    /// Product with a real number.
    fn scale(self, factor: f64) -> Self;

    /// 1/x.
    fn inverse(self) -> Self;

    /// Square root with a real part not below zero.
    fn sqrt(self) -> Self;

    /// e^x.
    fn exp(self) -> Self;

    /// This number, or `minimum` where that has the larger magnitude.
    fn at_least(self, minimum: Self) -> Self;

    /// −x where Re `other` < −`fraction` |`other`|, x elsewhere.
    fn negated_where_negative(self, other: Self, fraction: f64) -> Self;
}

impl ComplexArithmetic for Complex {
    #[inline]
    fn like(self, value: Complex) -> Self {
        value
    }

    #[inline]
    fn scale(self, factor: f64) -> Self {
        self.scale(factor)
    }

    #[inline]
    fn inverse(self) -> Self {
        self.inverse()
    }

    #[inline]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline]
    fn exp(self) -> Self {
        self.exp()
    }

    #[inline]
    fn at_least(self, minimum: Self) -> Self {
        if self.abs() < minimum.abs() { minimum } else { self }
    }

    #[inline]
    fn negated_where_negative(self, other: Self, fraction: f64) -> Self {
        if other.re < -fraction * other.abs() { -self } else { self }
    }
}
