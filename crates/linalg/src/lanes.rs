//! Complex numbers in the lanes of vector instructions.
//!
//! A number that leaves the range of this arithmetic becomes infinite or NaN; the caller then computes with
//! [`Complex`].

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use std::f64::consts::{FRAC_1_PI, LOG2_E};
use std::ops::{Add, Mul, Neg, Sub};

use super::{Complex, ComplexArithmetic, Simd};

/// Largest number of lanes of any instruction set.
const MAX_LANES: usize = 8;

/// Complex number in each lane of a vector.
#[derive(Debug, Clone, Copy)]
pub struct Lanes<S: Simd> {
    simd: S,
    re: S::f64s,
    im: S::f64s,
}

/// 1.5 · 2⁵²: adding it to a number below 2⁵¹ leaves the rounded integer in the lowest bits.
const ROUND_TO_INTEGER: f64 = 6_755_399_441_055_744.0;
/// Parts of π: the first two have 26 bits, so that products with integers up to 2²⁷ are exact.
const PI_PARTS: [f64; 3] =
    [3.141_592_621_803_283_7, 3.178_650_942_459_171_3e-8, 1.224_646_799_147_353_2e-16];
/// Largest angle that is reduced exactly.
const MAX_REDUCED_ANGLE: f64 = 1.0e8;
/// Parts of ln 2: the first has 32 bits.
const LN_2_PARTS: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
/// Smallest and largest real part in the range of the exponential.
const EXPONENT_RANGE: [f64; 2] = [-708.0, 708.0];
/// 1/k! from k = 0 up to 21: series end below rounding, e^x at |x| ≤ ½ ln 2 and the others at |x| ≤ π/2.
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

    /// Loads `numbers` into the lanes; lanes beyond repeat the last number.
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

    #[inline(always)]
    fn with(self, re: S::f64s, im: S::f64s) -> Self {
        Self { simd: self.simd, re, im }
    }

    /// `x` where the mask is set, `y` elsewhere.
    ///
    /// It selects bits: pulp's function for bits is compiled for its caller, its function for numbers is not.
    #[inline(always)]
    fn select(simd: S, mask: S::m64s, x: S::f64s, y: S::f64s) -> S::f64s {
        let x_bits = simd.transmute_u64s_f64s(x);
        let y_bits = simd.transmute_u64s_f64s(y);
        simd.transmute_f64s_u64s(simd.select_u64s(mask, x_bits, y_bits))
    }

    #[inline(always)]
    fn negative(simd: S, x: S::f64s) -> S::f64s {
        let sign = simd.splat_u64s(1 << 63);
        simd.transmute_f64s_u64s(simd.xor_u64s(simd.transmute_u64s_f64s(x), sign))
    }

    #[inline(always)]
    fn absolute(simd: S, x: S::f64s) -> S::f64s {
        let bits = simd.splat_u64s(u64::MAX >> 1);
        simd.transmute_f64s_u64s(simd.and_u64s(simd.transmute_u64s_f64s(x), bits))
    }

    /// `magnitude`, not negative, with the sign of `x`.
    #[inline(always)]
    fn with_sign(simd: S, magnitude: S::f64s, x: S::f64s) -> S::f64s {
        let sign = simd.and_u64s(simd.transmute_u64s_f64s(x), simd.splat_u64s(1 << 63));
        simd.transmute_f64s_u64s(simd.or_u64s(simd.transmute_u64s_f64s(magnitude), sign))
    }

    #[inline(always)]
    fn square(self) -> S::f64s {
        let simd = self.simd;
        simd.mul_add_e_f64s(self.re, self.re, simd.mul_f64s(self.im, self.im))
    }

    /// Σ x^k/(first + step k)!, up to 1/last!.
    #[inline(always)]
    fn series(simd: S, first: usize, step: usize, last: usize, x: S::f64s) -> S::f64s {
        let mut sum = simd.splat_f64s(INVERSE_FACTORIALS[last]);
        let mut k = last;
        while k > first {
            k -= step;
            sum = simd.mul_add_e_f64s(sum, x, simd.splat_f64s(INVERSE_FACTORIALS[k]));
        }
        sum
    }

    /// e^x; NaN above the range, and the smallest value in range below it.
    #[inline(always)]
    fn real_exp(simd: S, x: S::f64s) -> S::f64s {
        let lowest = simd.splat_f64s(EXPONENT_RANGE[0]);
        let highest = simd.splat_f64s(EXPONENT_RANGE[1]);
        let x = Self::select(simd, simd.less_than_f64s(x, lowest), lowest, x);
        let n = Self::rounded(simd, simd.mul_f64s(x, simd.splat_f64s(LOG2_E)));
        let mut remainder = x;
        for part in LN_2_PARTS {
            remainder = simd.mul_add_e_f64s(n, simd.splat_f64s(-part), remainder);
        }
        let value = Self::series(simd, 0, 1, 13, remainder);
        let value = simd.mul_f64s(value, Self::power_of_two(simd, n));
        Self::select(simd, simd.less_than_f64s(highest, x), simd.splat_f64s(f64::NAN), value)
    }

    /// `x` rounded to an integer.
    #[inline(always)]
    fn rounded(simd: S, x: S::f64s) -> S::f64s {
        let shift = simd.splat_f64s(ROUND_TO_INTEGER);
        simd.sub_f64s(simd.add_f64s(x, shift), shift)
    }

    /// 2ⁿ for an integer n, by setting the exponent's bits.
    ///
    /// Adding 1.5 · 2²⁰ puts n into the lowest bits of the upper half, whose top is the exponent.
    #[inline(always)]
    fn power_of_two(simd: S, n: S::f64s) -> S::f64s {
        let bits = simd.transmute_u64s_f64s(simd.add_f64s(n, simd.splat_f64s(1_572_864.0)));
        let bits = if S::IS_SCALAR {
            simd.mul_u64s(bits, simd.splat_u64s(1 << 20))
        } else {
            let halves: S::u32s = pulp::bytemuck::cast(bits);
            pulp::bytemuck::cast(simd.wrapping_dyn_shl_u32s(halves, simd.splat_u32s(20)))
        };
        simd.transmute_f64s_u64s(simd.add_u64s(bits, simd.splat_u64s(1023 << 52)))
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
        let square = Self::negative(simd, simd.mul_f64s(angle, angle));
        // −1 for odd n: 1 − 4 |n/2 − round(n/2)|.
        let half = simd.mul_f64s(n, simd.splat_f64s(0.5));
        let odd = Self::absolute(simd, simd.sub_f64s(half, Self::rounded(simd, half)));
        let sign = simd.sub_f64s(simd.splat_f64s(1.0), simd.mul_f64s(odd, simd.splat_f64s(4.0)));
        let cosine = Self::series(simd, 0, 2, 20, square);
        let sine = simd.mul_f64s(angle, Self::series(simd, 1, 2, 21, square));
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
        let square = self.square();
        // Not finite if the square is zero or infinite.
        let scale = simd.div_f64s(simd.splat_f64s(1.0), square);
        let scale = simd.add_f64s(scale, simd.mul_f64s(square, simd.splat_f64s(0.0)));
        self.with(
            simd.mul_f64s(self.re, scale),
            Self::negative(simd, simd.mul_f64s(self.im, scale)),
        )
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let simd = self.simd;
        let half = simd.splat_f64s(0.5);
        let sum = simd.add_f64s(simd.sqrt_f64s(self.square()), Self::absolute(simd, self.re));
        let large = simd.sqrt_f64s(simd.mul_f64s(half, sum));
        // NaN at zero.
        let small = simd.div_f64s(simd.mul_f64s(half, self.im), large);
        let is_negative = simd.less_than_f64s(self.re, simd.splat_f64s(0.0));
        self.with(
            Self::select(simd, is_negative, Self::absolute(simd, small), large),
            Self::select(simd, is_negative, Self::with_sign(simd, large, self.im), small),
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
        let is_less = simd.less_than_f64s(self.square(), minimum.square());
        self.with(
            Self::select(simd, is_less, minimum.re, self.re),
            Self::select(simd, is_less, minimum.im, self.im),
        )
    }

    #[inline(always)]
    fn negated_where_negative(self, other: Self, fraction: f64) -> Self {
        let simd = self.simd;
        let magnitude = simd.sqrt_f64s(other.square());
        let limit = simd.mul_f64s(magnitude, simd.splat_f64s(-fraction));
        let is_negative = simd.less_than_f64s(other.re, limit);
        self.with(
            Self::select(simd, is_negative, Self::negative(simd, self.re), self.re),
            Self::select(simd, is_negative, Self::negative(simd, self.im), self.im),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::{WithSimd, vectorized};
    use super::*;
    use std::f64::consts::FRAC_PI_4;

    /// A function of one number, written for lanes and for single ones.
    trait Function {
        fn value<C: ComplexArithmetic>(&self, x: C) -> C;
    }

    struct Each<'a, F>(&'a F, &'a [Complex]);

    impl<F: Function> WithSimd for Each<'_, F> {
        type Output = Vec<Complex>;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Vec<Complex> {
            let mut found = vec![Complex::default(); self.1.len()];
            let count = Lanes::<S>::LANE_COUNT;
            for (numbers, found) in self.1.chunks(count).zip(found.chunks_mut(count)) {
                self.0.value(Lanes::load(simd, numbers)).store(found);
            }
            found
        }
    }

    /// Results in the widest lanes, in single ones, and as complex numbers.
    fn each(function: &impl Function, numbers: &[Complex]) -> [Vec<Complex>; 3] {
        [
            vectorized(Each(function, numbers)),
            Each(function, numbers).with_simd(pulp::Scalar::new()),
            numbers.iter().map(|x| function.value(*x)).collect(),
        ]
    }

    struct Arithmetic;

    impl Function for Arithmetic {
        fn value<C: ComplexArithmetic>(&self, x: C) -> C {
            let other = x.like(Complex::new(0.3, -1.7));
            let root = (x * x + other).sqrt() - x.scale(3.3);
            let floored = root.at_least(x.like_real(2.0)).inverse();
            floored.negated_where_negative(x, 1e-12) - other.sqrt()
        }
    }

    struct Exponential;

    impl Function for Exponential {
        fn value<C: ComplexArithmetic>(&self, x: C) -> C {
            x.exp()
        }
    }

    struct Inverse;

    impl Function for Inverse {
        fn value<C: ComplexArithmetic>(&self, x: C) -> C {
            x.inverse()
        }
    }

    fn spread(sizes: &[f64]) -> Vec<Complex> {
        (0..40 * sizes.len())
            .map(|k| Complex::polar(sizes[k % sizes.len()], 0.1 + 0.613 * k as f64))
            .collect()
    }

    /// Against the arithmetic of single numbers and the functions of the standard library.
    #[test]
    fn lanes_compute_as_single_numbers() {
        let numbers = spread(&[1e-3, 1.0, 7.0, 1e5, 1e12]);
        let computed = each(&Arithmetic, &numbers);
        for (k, wanted) in computed[2].iter().enumerate() {
            for found in [computed[0][k], computed[1][k]] {
                assert!((found - *wanted).abs() <= 4e-15 * wanted.abs(), "{:?}", numbers[k]);
            }
        }
        // Pure decay and pure rotation, and both; quarters of a turn.
        let mut numbers = spread(&[1e-9, 0.3, 1.0, 20.0, 300.0, 700.0]);
        numbers.extend((-400..400).map(|k| Complex::new(0.0, FRAC_PI_4 * f64::from(k))));
        numbers.extend((0..400).map(|k| Complex::new(-0.5, 2.47e5 * f64::from(k))));
        numbers.extend((0..400).map(|k| Complex::new(-1.8 * f64::from(k), 1e-3)));
        let computed = each(&Exponential, &numbers);
        for (k, wanted) in computed[2].iter().enumerate() {
            for found in [computed[0][k], computed[1][k]] {
                let slack = 1e-15 * wanted.abs() + 1e-307;
                assert!((found - *wanted).abs() <= slack, "{:?} {found:?}", numbers[k]);
            }
        }
    }

    #[test]
    fn lanes_out_of_range_are_not_finite() {
        let inverses = each(&Inverse, &[0.0, 1e-200, 1e200].map(Complex::real));
        let beyond = [[0.0, 1e9], [800.0, 1.0], [f64::NAN, 1.0], [0.0, f64::INFINITY]];
        let exponentials = each(&Exponential, &beyond.map(|[re, im]| Complex::new(re, im)));
        for computed in [inverses, exponentials] {
            assert!(computed[..2].iter().flatten().all(|x| !x.is_finite()), "{computed:?}");
        }
    }
}
