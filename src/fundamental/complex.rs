//! The few complex operations that the closed forms need.

use std::ops::{Add, Div, Mul, Sub};

/// A complex number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Complex {
    pub(crate) re: f64,
    pub(crate) im: f64,
}

impl Complex {
    pub(crate) const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    pub(crate) const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    pub(crate) fn abs(self) -> f64 {
        self.re.hypot(self.im)
    }

    /// Square root with real part not below zero.
    pub(crate) fn sqrt(self) -> Self {
        let size = self.abs();
        if size == 0.0 {
            return Self::real(0.0);
        }
        let large = (0.5 * (size + self.re.abs())).sqrt();
        let small = 0.5 * self.im / large;
        if self.re >= 0.0 {
            Self::new(large, small)
        } else {
            Self::new(small.abs(), large.copysign(self.im))
        }
    }

    /// Principal artanh; on the real axis beyond ±1 its real part.
    pub(crate) fn atanh(self) -> Self {
        let above = (1.0 + self.re).powi(2) + self.im * self.im;
        // The floor stands for the pole itself.
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

    pub(crate) fn scale(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
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

impl Div for Complex {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let size = other.re * other.re + other.im * other.im;
        (self * Self::new(other.re, -other.im)).scale(1.0 / size)
    }
}
