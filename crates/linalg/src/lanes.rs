//! Complex numbers in the lanes of vector instructions.
//!
//! A result outside the range of this arithmetic is infinite or NaN; the caller then repeats the computation with
//! [`Complex`].

#![allow(clippy::inline_always, reason = "the caller compiles them for its instruction set")]

use std::f64::consts::{FRAC_1_PI, LOG2_E};
use std::ops::{Add, Mul, Neg, Sub};

use super::{Complex, ComplexArithmetic, Simd};

/// Largest number of lanes of any instruction set: 512 bits.
const MAX_LANES: usize = 8;

/// Complex number in each lane of a vector.
#[derive(Debug, Clone, Copy)]
pub struct Lanes<S: Simd> {
    simd: S,
    re: S::f64s,
    im: S::f64s,
}

/// 1.5 · 2⁵².
///
/// Its sum with a number below 2⁵¹ has the rounded integer in its lowest bits.
const ROUND_TO_INTEGER: f64 = 6_755_399_441_055_744.0;
/// 1.5 · 2²⁰.
///
/// Its sum with an integer has the integer in the lowest of its upper 32 bits.
const INTEGER_TO_UPPER_HALF: f64 = 1_572_864.0;
/// Number of bits of the mantissa in the upper 32 bits, below the exponent.
const UPPER_MANTISSA_BITS: u32 = 20;
/// Bits of the exponent of 2⁰.
const EXPONENT_BIAS_BITS: u64 = 1023 << 52;
/// Parts of π, whose sum is π.
///
/// The first two have 26 bits, so that products with integers up to 2²⁷ are exact.
const PI_PARTS: [f64; 3] =
    [3.141_592_621_803_283_7, 3.178_650_942_459_171_3e-8, 1.224_646_799_147_353_2e-16];
/// Largest angle whose reduction is exact: it has fewer than 2²⁷ half turns.
const MAX_REDUCED_ANGLE: f64 = 1.0e8;
/// Parts of ln 2: the first has 32 bits.
const LN_2_PARTS: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
/// Smallest and largest real part in the range of the exponential.
const EXPONENT_RANGE: [f64; 2] = [-708.0, 708.0];
/// 1/k! from k = 0 to 21.
///
/// The neglected terms are below rounding errors for e^x at |x| ≤ ½ ln 2, and for sine and cosine at |x| ≤ π/2.
const INVERSE_FACTORIALS: [f64; 22] = {
    let mut values = [1.0; 22];
    let mut k = 1;
    while k < 22 {
        values[k] = values[k - 1] / k as f64;
        k += 1;
    }
    values
};

impl<S: Simd> Lanes<S> {
    /// Number of lanes.
    pub const LANE_COUNT: usize = S::F64_LANES;

    /// Loads `numbers` into the lanes; further lanes repeat the last number.
    #[inline(always)]
    pub fn load(simd: S, numbers: &[Complex]) -> Self {
        let mut re = [0.0; MAX_LANES];
        let mut im = [0.0; MAX_LANES];
        for k in 0..Self::LANE_COUNT {
            let number = numbers[k.min(numbers.len() - 1)];
            re[k] = number.re;
            im[k] = number.im;
        }
        let re = S::as_simd_f64s(&re[..Self::LANE_COUNT]).0[0];
        let im = S::as_simd_f64s(&im[..Self::LANE_COUNT]).0[0];
        Self { simd, re, im }
    }

    /// Writes the first lanes to `numbers`.
    #[inline(always)]
    pub fn store(self, numbers: &mut [Complex]) {
        let mut re = [0.0; MAX_LANES];
        let mut im = [0.0; MAX_LANES];
        S::as_mut_simd_f64s(&mut re[..Self::LANE_COUNT]).0[0] = self.re;
        S::as_mut_simd_f64s(&mut im[..Self::LANE_COUNT]).0[0] = self.im;
        for (k, number) in numbers.iter_mut().enumerate().take(Self::LANE_COUNT) {
            *number = Complex::new(re[k], im[k]);
        }
    }

    /// These parts, for the same instruction set.
    #[inline(always)]
    fn with(self, re: S::f64s, im: S::f64s) -> Self {
        Self { simd: self.simd, re, im }
    }

    /// `x` in lanes where the mask is set, `y` in the others.
    ///
    /// It selects bit patterns, because the caller's instruction set applies only to pulp's selection of integers.
    #[inline(always)]
    fn select(simd: S, mask: S::m64s, x: S::f64s, y: S::f64s) -> S::f64s {
        let x_bits = simd.transmute_u64s_f64s(x);
        let y_bits = simd.transmute_u64s_f64s(y);
        simd.transmute_f64s_u64s(simd.select_u64s(mask, x_bits, y_bits))
    }

    /// −x.
    #[inline(always)]
    fn negative(simd: S, x: S::f64s) -> S::f64s {
        let sign = simd.splat_u64s(1 << 63);
        simd.transmute_f64s_u64s(simd.xor_u64s(simd.transmute_u64s_f64s(x), sign))
    }

    /// |x|.
    #[inline(always)]
    fn absolute(simd: S, x: S::f64s) -> S::f64s {
        let bits = simd.splat_u64s(u64::MAX >> 1);
        simd.transmute_f64s_u64s(simd.and_u64s(simd.transmute_u64s_f64s(x), bits))
    }

    /// The non-negative `magnitude` with the sign of `x`.
    #[inline(always)]
    fn with_sign(simd: S, magnitude: S::f64s, x: S::f64s) -> S::f64s {
        let sign = simd.and_u64s(simd.transmute_u64s_f64s(x), simd.splat_u64s(1 << 63));
        simd.transmute_f64s_u64s(simd.or_u64s(simd.transmute_u64s_f64s(magnitude), sign))
    }

    /// |x|².
    #[inline(always)]
    fn squared_modulus(self) -> S::f64s {
        let simd = self.simd;
        simd.mul_add_e_f64s(self.re, self.re, simd.mul_f64s(self.im, self.im))
    }

    /// Σ x^j/k! for k = `first_order` + j `step`, up to k = `last_order`.
    #[inline(always)]
    fn series(simd: S, first_order: usize, step: usize, last_order: usize, x: S::f64s) -> S::f64s {
        let mut sum = simd.splat_f64s(INVERSE_FACTORIALS[last_order]);
        let mut k = last_order;
        while k > first_order {
            k -= step;
            sum = simd.mul_add_e_f64s(sum, x, simd.splat_f64s(INVERSE_FACTORIALS[k]));
        }
        sum
    }

    /// e^x for real x.
    ///
    /// NaN above the range of x, and the smallest value of the range below it.
    #[inline(always)]
    fn real_exp(simd: S, x: S::f64s) -> S::f64s {
        let min_exponent = simd.splat_f64s(EXPONENT_RANGE[0]);
        let max_exponent = simd.splat_f64s(EXPONENT_RANGE[1]);
        let x = Self::select(simd, simd.less_than_f64s(x, min_exponent), min_exponent, x);
        let n = Self::rounded(simd, simd.mul_f64s(x, simd.splat_f64s(LOG2_E)));
        let mut remainder = x;
        for part in LN_2_PARTS {
            remainder = simd.mul_add_e_f64s(n, simd.splat_f64s(-part), remainder);
        }
        let remainder_exp = Self::series(simd, 0, 1, 13, remainder);
        let value = simd.mul_f64s(remainder_exp, Self::power_of_two(simd, n));
        let is_too_large = simd.less_than_f64s(max_exponent, x);
        Self::select(simd, is_too_large, simd.splat_f64s(f64::NAN), value)
    }

    /// `x` rounded to an integer.
    #[inline(always)]
    fn rounded(simd: S, x: S::f64s) -> S::f64s {
        let offset = simd.splat_f64s(ROUND_TO_INTEGER);
        simd.sub_f64s(simd.add_f64s(x, offset), offset)
    }

    /// 2ⁿ for an integer n, by setting the bits of the exponent.
    ///
    /// Adding 1.5 · 2²⁰ moves n into the lowest bits of the upper 32 bits; a shift moves n to the exponent.
    #[inline(always)]
    fn power_of_two(simd: S, n: S::f64s) -> S::f64s {
        let integer_bits =
            simd.transmute_u64s_f64s(simd.add_f64s(n, simd.splat_f64s(INTEGER_TO_UPPER_HALF)));
        let shifted_bits = if S::IS_SCALAR {
            simd.mul_u64s(integer_bits, simd.splat_u64s(1 << UPPER_MANTISSA_BITS))
        } else {
            let halves: S::u32s = pulp::bytemuck::cast(integer_bits);
            let shift = simd.splat_u32s(UPPER_MANTISSA_BITS);
            pulp::bytemuck::cast(simd.wrapping_dyn_shl_u32s(halves, shift))
        };
        simd.transmute_f64s_u64s(simd.add_u64s(shifted_bits, simd.splat_u64s(EXPONENT_BIAS_BITS)))
    }

    /// cos x and sin x; NaN for angles that are too large.
    #[inline(always)]
    fn cosine_and_sine(simd: S, x: S::f64s) -> [S::f64s; 2] {
        let max_angle = simd.splat_f64s(MAX_REDUCED_ANGLE);
        let n = Self::rounded(simd, simd.mul_f64s(x, simd.splat_f64s(FRAC_1_PI)));
        let mut remainder = x;
        for part in PI_PARTS {
            remainder = simd.mul_add_e_f64s(n, simd.splat_f64s(-part), remainder);
        }
        let is_large = simd.less_than_f64s(max_angle, Self::absolute(simd, x));
        let angle = Self::select(simd, is_large, simd.splat_f64s(f64::NAN), remainder);
        let minus_square = Self::negative(simd, simd.mul_f64s(angle, angle));
        // −1 for odd n: 1 − 4 |n/2 − round(n/2)|.
        let half_n = simd.mul_f64s(n, simd.splat_f64s(0.5));
        let half_if_odd = Self::absolute(simd, simd.sub_f64s(half_n, Self::rounded(simd, half_n)));
        let sign =
            simd.sub_f64s(simd.splat_f64s(1.0), simd.mul_f64s(half_if_odd, simd.splat_f64s(4.0)));
        let cosine = Self::series(simd, 0, 2, 20, minus_square);
        let sine = simd.mul_f64s(angle, Self::series(simd, 1, 2, 21, minus_square));
        [simd.mul_f64s(cosine, sign), simd.mul_f64s(sine, sign)]
    }
}

impl<S: Simd> Add for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let simd = self.simd;
        self.with(simd.add_f64s(self.re, other.re), simd.add_f64s(self.im, other.im))
    }
}

impl<S: Simd> Sub for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let simd = self.simd;
        self.with(simd.sub_f64s(self.re, other.re), simd.sub_f64s(self.im, other.im))
    }
}

impl<S: Simd> Mul for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let simd = self.simd;
        let re = simd.sub_f64s(simd.mul_f64s(self.re, other.re), simd.mul_f64s(self.im, other.im));
        let im = simd.mul_add_e_f64s(self.re, other.im, simd.mul_f64s(self.im, other.re));
        self.with(re, im)
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.with(Self::negative(self.simd, self.re), Self::negative(self.simd, self.im))
    }
}

impl<S: Simd> ComplexArithmetic for Lanes<S> {
    #[inline(always)]
    fn like(self, value: Complex) -> Self {
        self.with(self.simd.splat_f64s(value.re), self.simd.splat_f64s(value.im))
    }

    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        let simd = self.simd;
        let factor = simd.splat_f64s(factor);
        self.with(simd.mul_f64s(self.re, factor), simd.mul_f64s(self.im, factor))
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        let simd = self.simd;
        let squared_modulus = self.squared_modulus();
        let reciprocal = simd.div_f64s(simd.splat_f64s(1.0), squared_modulus);
        // Adding zero times the square makes the result NaN if the square is infinite.
        let checked_reciprocal =
            simd.add_f64s(reciprocal, simd.mul_f64s(squared_modulus, simd.splat_f64s(0.0)));
        self.with(
            simd.mul_f64s(self.re, checked_reciprocal),
            Self::negative(simd, simd.mul_f64s(self.im, checked_reciprocal)),
        )
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let simd = self.simd;
        let half = simd.splat_f64s(0.5);
        let sum =
            simd.add_f64s(simd.sqrt_f64s(self.squared_modulus()), Self::absolute(simd, self.re));
        let larger_part = simd.sqrt_f64s(simd.mul_f64s(half, sum));
        // NaN for the number zero.
        let smaller_part = simd.div_f64s(simd.mul_f64s(half, self.im), larger_part);
        let is_negative = simd.less_than_f64s(self.re, simd.splat_f64s(0.0));
        self.with(
            Self::select(simd, is_negative, Self::absolute(simd, smaller_part), larger_part),
            Self::select(
                simd,
                is_negative,
                Self::with_sign(simd, larger_part, self.im),
                smaller_part,
            ),
        )
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let simd = self.simd;
        let magnitude = Self::real_exp(simd, self.re);
        let [cosine, sine] = Self::cosine_and_sine(simd, self.im);
        self.with(simd.mul_f64s(magnitude, cosine), simd.mul_f64s(magnitude, sine))
    }

    #[inline(always)]
    fn at_least(self, minimum: Self) -> Self {
        let simd = self.simd;
        let is_less = simd.less_than_f64s(self.squared_modulus(), minimum.squared_modulus());
        self.with(
            Self::select(simd, is_less, minimum.re, self.re),
            Self::select(simd, is_less, minimum.im, self.im),
        )
    }

    #[inline(always)]
    fn negated_where_negative(self, other: Self, fraction: f64) -> Self {
        let simd = self.simd;
        let magnitude = simd.sqrt_f64s(other.squared_modulus());
        let limit = simd.mul_f64s(magnitude, simd.splat_f64s(-fraction));
        let is_negative = simd.less_than_f64s(other.re, limit);
        self.with(
            Self::select(simd, is_negative, Self::negative(simd, self.re), self.re),
            Self::select(simd, is_negative, Self::negative(simd, self.im), self.im),
        )
    }
}

#[cfg(test)]
mod tests;
