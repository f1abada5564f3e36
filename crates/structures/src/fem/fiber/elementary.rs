//! Exponential and logarithm without branches, for loops over many fibres.
//!
//! Compilers turn loops over them into vector instructions. They use additions, products and quotients alone: all processors
//! return the same bits. Both follow fdlibm (Sun Microsystems 1993), and err by less than one unit in the last place.

#![allow(clippy::inline_always, reason = "the caller compiles them for its instruction set")]

/// Parts of ln 2: the first has 32 bits.
const LN_2_PARTS: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
/// Bits of √½: mantissas lie from √½ to √2.
const SQRT_HALF_BITS: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
/// Bits of 1.
const ONE_BITS: u64 = 1.0_f64.to_bits();
/// Number of bits of the mantissa.
const MANTISSA_BITS: u32 = 52;
/// Bits of the mantissa.
const MANTISSA_MASK: u64 = (1 << MANTISSA_BITS) - 1;
/// 2⁵²: its sum with a smaller integer has the integer in the lowest bits.
const TWO_POWER_52: f64 = 4_503_599_627_370_496.0;
/// 1.5 · 2⁵²: its sum with a number below 2⁵¹ has the rounded integer in the lowest bits.
const ROUND_TO_INTEGER: f64 = 1.5 * TWO_POWER_52;
/// Exponent of the bits of 1.
const EXPONENT_BIAS: u64 = 1023;

/// Coefficients of (ln((1 + s)/(1 − s)) − 2 s)/s as a polynomial in s², from s² on.
const LOGARITHM_COEFFICIENTS: [f64; 7] = [
    6.666_666_666_666_735e-1,
    3.999_999_999_940_942e-1,
    2.857_142_874_366_239e-1,
    2.222_219_843_214_978_4e-1,
    1.818_357_216_161_805e-1,
    1.531_383_769_920_937_3e-1,
    1.479_819_860_511_658_6e-1,
];

/// Coefficients of x (eˣ + 1)/(eˣ − 1) − 2 as a polynomial in x², from x² on.
const EXPONENTIAL_COEFFICIENTS: [f64; 5] = [
    1.666_666_666_666_660_2e-1,
    -2.777_777_777_701_559_3e-3,
    6.613_756_321_437_934e-5,
    -1.653_390_220_546_525_2e-6,
    4.138_136_797_057_238_5e-8,
];

/// ln x for a positive, normal x.
#[inline(always)]
pub(super) fn logarithm(x: f64) -> f64 {
    let bits = x.to_bits() + (ONE_BITS - SQRT_HALF_BITS);
    let exponent_bits = (bits >> MANTISSA_BITS) | TWO_POWER_52.to_bits();
    let exponent = f64::from_bits(exponent_bits) - (TWO_POWER_52 + EXPONENT_BIAS as f64);
    let mantissa = f64::from_bits((bits & MANTISSA_MASK) + SQRT_HALF_BITS);
    let f = mantissa - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let [c1, c2, c3, c4, c5, c6, c7] = LOGARITHM_COEFFICIENTS;
    let series = z * (c1 + w * (c3 + w * (c5 + w * c7))) + w * (c2 + w * (c4 + w * c6));
    let half_square = 0.5 * f * f;
    exponent * LN_2_PARTS[0]
        - ((half_square - (s * (half_square + series) + exponent * LN_2_PARTS[1])) - f)
}

/// eˣ for x from −700 to 700.
#[inline(always)]
pub(super) fn exponential(x: f64) -> f64 {
    let rounded = x * std::f64::consts::LOG2_E + ROUND_TO_INTEGER;
    let n = rounded - ROUND_TO_INTEGER;
    let upper_part = x - n * LN_2_PARTS[0];
    let lower_part = n * LN_2_PARTS[1];
    let remainder = upper_part - lower_part;
    let z = remainder * remainder;
    let [p1, p2, p3, p4, p5] = EXPONENTIAL_COEFFICIENTS;
    let c = remainder - z * (p1 + z * (p2 + z * (p3 + z * (p4 + z * p5))));
    let value = 1.0 - ((lower_part - (remainder * c) / (2.0 - c)) - upper_part);
    let power_of_two =
        f64::from_bits(rounded.to_bits().wrapping_add(EXPONENT_BIAS) << MANTISSA_BITS);
    value * power_of_two
}

#[cfg(test)]
mod tests {
    use super::*;
    use basemat_testkit::random::Random;

    /// Largest relative error of a function over random arguments.
    fn largest_error(
        range: [f64; 2],
        computed: fn(f64) -> f64,
        expected: fn(f64) -> f64,
        argument: fn(&mut Random, [f64; 2]) -> f64,
    ) -> f64 {
        let mut random = Random(3);
        let errors = (0..200_000).map(|_| {
            let x = argument(&mut random, range);
            (computed(x) / expected(x) - 1.0).abs()
        });
        errors.fold(0.0, f64::max)
    }

    /// REFERENCE: the functions of the standard library.
    #[test]
    fn both_functions_are_those_of_the_standard_library() {
        let within = |random: &mut Random, [min, max]: [f64; 2]| random.within(min, max);
        let log_within = |random: &mut Random, [min, max]: [f64; 2]| random.log_within(min, max);
        for range in [[-700.0, 700.0], [-2.0, 2.0], [-1e-9, 1e-9]] {
            let error = largest_error(range, exponential, f64::exp, within);
            assert!(error < 4.0e-16, "{range:?}: {error:e}");
        }
        for range in [[f64::MIN_POSITIVE, 1e300], [0.5, 2.0], [0.999, 1.001]] {
            let error = largest_error(range, logarithm, f64::ln, log_within);
            assert!(error < 4.0e-16, "{range:?}: {error:e}");
        }
        assert_eq!(exponential(0.0), 1.0);
        assert_eq!(logarithm(1.0), 0.0);
    }
}
