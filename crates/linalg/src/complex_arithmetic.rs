//! Complex arithmetic, written once for single numbers and for lanes of several numbers.

use std::ops::{Add, Mul, Neg, Sub};

use super::Complex;

/// Complex number, or several complex numbers, one in each lane.
#[doc(hidden)]
pub trait ComplexArithmetic:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> + 'static
{
    /// Number with as many lanes as `self`, and `value` in each of them.
    fn like(self, value: Complex) -> Self;

    /// Number with as many lanes as `self`, and the real `value` in each of them.
    #[inline]
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

    /// This number, or `minimum` in lanes where `minimum` has the larger magnitude.
    fn at_least(self, minimum: Self) -> Self;

    /// −x in lanes where Re `other` < −`fraction` |`other`|, x in the others.
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
