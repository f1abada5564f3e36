//! Arithmetic that is written once for one complex number and for several at a time.

use std::ops::{Add, Mul, Neg, Sub};

use super::Complex;

/// Complex number, or several of them, one in each lane.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> + 'static
{
    /// The number `value` in all lanes, of as many as this one.
    fn like(self, value: Complex) -> Self;

    /// A real number in all lanes, of as many as this one.
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

    /// This number, or `least` where that has the larger magnitude.
    fn at_least(self, least: Self) -> Self;

    /// −x where Re `other` < −`fraction` |`other`|, x elsewhere.
    fn negated_where_negative(self, other: Self, fraction: f64) -> Self;
}

impl Number for Complex {
    fn like(self, value: Complex) -> Self {
        value
    }

    fn scale(self, factor: f64) -> Self {
        self.scale(factor)
    }

    fn inverse(self) -> Self {
        self.inverse()
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn exp(self) -> Self {
        self.exp()
    }

    fn at_least(self, least: Self) -> Self {
        if self.abs() < least.abs() { least } else { self }
    }

    fn negated_where_negative(self, other: Self, fraction: f64) -> Self {
        if other.re < -fraction * other.abs() { -self } else { self }
    }
}
