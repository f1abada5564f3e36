//! Evaluation of panel polynomials at the points of a circle.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use std::ops::Range;

use super::contour::{
    CHEBYSHEV_POINTS, Circle, CirclePanel, PANEL_OFFSET_RATIO, PanelPolynomials,
    chebyshev_coefficients, nodes, panel_factor,
};
use crate::error::Result;
use crate::linalg::{Complex, Simd, WithSimd, vectorized};

/// Number of points of a circle in one evaluation by vector instructions.
const POINT_LANES: usize = 32;
/// Approximate number of values between two calls of `report`, computed in about a hundredth of a second.
const VALUES_PER_REPORT: usize = 1 << 18;

/// Chebyshev polynomials of all degrees at several points.
#[inline]
fn chebyshev(x: [f64; POINT_LANES]) -> [[f64; POINT_LANES]; CHEBYSHEV_POINTS] {
    let mut polynomials = [[1.0; POINT_LANES]; CHEBYSHEV_POINTS];
    polynomials[1] = x;
    for degree in 2..CHEBYSHEV_POINTS {
        let before_previous = polynomials[degree - 2];
        let previous = polynomials[degree - 1];
        polynomials[degree] =
            std::array::from_fn(|lane| 2.0 * x[lane] * previous[lane] - before_previous[lane]);
    }
    polynomials
}

/// Adds the contribution of an eigenvalue on a panel to the values at the points of a circle.
///
/// `node` is the index of the eigenvalue; `spectra` has one row for each function. An error of `report` ends the
/// evaluation.
pub(super) fn evaluate(
    node: usize,
    polynomials: &PanelPolynomials,
    panel: CirclePanel,
    circle: Circle,
    spectra: &mut [Complex],
    mut report: impl FnMut() -> Result<()>,
) -> Result<()> {
    let PanelPolynomials { coefficients, phase } = polynomials;
    let function_count = coefficients.len() / CHEBYSHEV_POINTS;
    let points = panel.points_of(circle);
    // On the circle, the coordinate of the panel has this imaginary part. The polynomials are converted to the circle.
    let shift = -(circle.log_radius + PANEL_OFFSET_RATIO * panel.width()) / (0.5 * panel.width());
    let mut values_on_circle = vec![Complex::default(); coefficients.len()];
    for (x, values) in nodes().zip(values_on_circle.chunks_exact_mut(function_count)) {
        let shifted_x = Complex::new(x, shift);
        let mut previous = shifted_x;
        let mut polynomial = Complex::real(1.0);
        for row in coefficients.chunks_exact(function_count) {
            for (sum, coefficient) in values.iter_mut().zip(row) {
                *sum += polynomial * *coefficient;
            }
            let next = shifted_x.scale(2.0) * polynomial - previous;
            previous = polynomial;
            polynomial = next;
        }
    }
    let circle_coefficients = chebyshev_coefficients(&values_on_circle);
    let steps_per_report = (VALUES_PER_REPORT / (POINT_LANES * function_count)).max(1);
    for first_point in points.clone().step_by(POINT_LANES) {
        if ((first_point - points.start) / POINT_LANES).is_multiple_of(steps_per_report) {
            report()?;
        }
        let x: [f64; POINT_LANES] = std::array::from_fn(|lane| {
            2.0 * (first_point + lane - points.start) as f64 / points.len() as f64 - 1.0
        });
        let chebyshev_values = chebyshev(x);
        let factors: [Complex; POINT_LANES] = std::array::from_fn(|lane| {
            let power = Complex::polar((-phase * shift).exp(), phase * x[lane]);
            power * panel_factor(node, [circle.log_radius, circle.angle(first_point + lane)])
        });
        let point_range = first_point..points.end.min(first_point + POINT_LANES);
        let row_length = circle.half_circle_points();
        vectorized(AddToSpectra {
            coefficients: &circle_coefficients,
            chebyshev_values,
            factors,
            spectra,
            row_length,
            point_range,
        });
    }
    Ok(())
}

/// Adds polynomials, times factors of the points, to the values at a few points of all functions.
struct AddToSpectra<'a> {
    /// Coefficients degree by degree, one column for each function.
    coefficients: &'a [Complex],
    chebyshev_values: [[f64; POINT_LANES]; CHEBYSHEV_POINTS],
    factors: [Complex; POINT_LANES],
    /// One row of `row_length` points for each function.
    spectra: &'a mut [Complex],
    row_length: usize,
    /// Points within each row.
    point_range: Range<usize>,
}

impl WithSimd for AddToSpectra<'_> {
    type Output = ();

    // The loops have no fused operations, so that the results have the same bits on any processor.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { coefficients, chebyshev_values, factors, spectra, row_length, point_range } =
            self;
        let function_count = coefficients.len() / CHEBYSHEV_POINTS;
        for (function, row) in spectra.chunks_exact_mut(row_length).enumerate() {
            let mut re = [0.0; POINT_LANES];
            let mut im = [0.0; POINT_LANES];
            for (polynomial, degree_coefficients) in
                chebyshev_values.iter().zip(coefficients.chunks_exact(function_count))
            {
                let coefficient = degree_coefficients[function];
                for lane in 0..POINT_LANES {
                    re[lane] += coefficient.re * polynomial[lane];
                    im[lane] += coefficient.im * polynomial[lane];
                }
            }
            for (lane, value) in row[point_range.clone()].iter_mut().enumerate() {
                *value += factors[lane] * Complex::new(re[lane], im[lane]);
            }
        }
    }
}
