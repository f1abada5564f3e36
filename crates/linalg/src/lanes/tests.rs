//! Lanes against single numbers.

use super::super::{WithSimd, vectorized};
use super::*;
use std::f64::consts::FRAC_PI_4;

/// Function of one number, for lanes and for single numbers.
trait Function {
    fn value<C: ComplexArithmetic>(&self, x: C) -> C;
}

/// Values of a function at all numbers.
struct Values<'a, F>(&'a F, &'a [Complex]);

impl<F: Function> WithSimd for Values<'_, F> {
    type Output = Vec<Complex>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<Complex> {
        let mut values = vec![Complex::default(); self.1.len()];
        let count = Lanes::<S>::LANE_COUNT;
        for (numbers, values) in self.1.chunks(count).zip(values.chunks_mut(count)) {
            self.0.value(Lanes::load(simd, numbers)).store(values);
        }
        values
    }
}

/// Values computed in the widest lanes, in single lanes, and by complex numbers.
fn computed_values(function: &impl Function, numbers: &[Complex]) -> [Vec<Complex>; 3] {
    [
        vectorized(Values(function, numbers)),
        Values(function, numbers).with_simd(pulp::Scalar::new()),
        numbers.iter().map(|x| function.value(*x)).collect(),
    ]
}

struct Arithmetic;

impl Function for Arithmetic {
    fn value<C: ComplexArithmetic>(&self, x: C) -> C {
        let other = x.like(Complex::new(0.3, -1.7));
        let root = (x * x + other).sqrt() - x.scale(3.3);
        let inverse = root.at_least(x.like_real(2.0)).inverse();
        inverse.negated_where_negative(x, 1e-12) - other.sqrt()
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

/// Numbers of these moduli, with many angles.
fn sample_numbers(moduli: &[f64]) -> Vec<Complex> {
    (0..40 * moduli.len())
        .map(|k| Complex::polar(moduli[k % moduli.len()], 0.1 + 0.613 * k as f64))
        .collect()
}

/// REFERENCE: arithmetic of single numbers, and functions of the standard library.
#[test]
fn lanes_compute_as_single_numbers() {
    let numbers = sample_numbers(&[1e-3, 1.0, 7.0, 1e5, 1e12]);
    let computed = computed_values(&Arithmetic, &numbers);
    for (k, expected) in computed[2].iter().enumerate() {
        for value in [computed[0][k], computed[1][k]] {
            assert!((value - *expected).abs() <= 4e-15 * expected.abs(), "{:?}", numbers[k]);
        }
    }
    // Decay and rotation, also with multiples of a quarter turn.
    let mut numbers = sample_numbers(&[1e-9, 0.3, 1.0, 20.0, 300.0, 700.0]);
    numbers.extend((-400..400).map(|k| Complex::new(0.0, FRAC_PI_4 * f64::from(k))));
    numbers.extend((0..400).map(|k| Complex::new(-0.5, 2.47e5 * f64::from(k))));
    numbers.extend((0..400).map(|k| Complex::new(-1.8 * f64::from(k), 1e-3)));
    let computed = computed_values(&Exponential, &numbers);
    for (k, expected) in computed[2].iter().enumerate() {
        for value in [computed[0][k], computed[1][k]] {
            let tolerance = 1e-15 * expected.abs() + 1e-307;
            assert!((value - *expected).abs() <= tolerance, "{:?} {value:?}", numbers[k]);
        }
    }
}

#[test]
fn lanes_out_of_range_are_not_finite() {
    let inverses = computed_values(&Inverse, &[0.0, 1e-200, 1e200].map(Complex::real));
    let arguments_out_of_range = [[0.0, 1e9], [800.0, 1.0], [f64::NAN, 1.0], [0.0, f64::INFINITY]];
    let exponentials =
        computed_values(&Exponential, &arguments_out_of_range.map(|[re, im]| Complex::new(re, im)));
    for computed in [inverses, exponentials] {
        assert!(computed[..2].iter().flatten().all(|x| !x.is_finite()), "{computed:?}");
    }
}
