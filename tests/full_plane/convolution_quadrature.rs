//! GOAL: coefficients by convolution quadrature solve the transformed equation, at the order of the method.
//! SCENE: flat surfaces and a trench of unequal elements, BDF1 and BDF2.
//! REFERENCE: mpmath, the symbol's power series, and the fundamental solution in time.

use basemat::bem::full_plane::{BoundaryKernel, ConvolutionQuadrature, CqMethod, Segment};
use basemat::fundamental::{FullPlane, FundamentalSolution, LoadHistory};
use basemat::{Error, Result};

use super::{flat, point_between, unit_soil};
use basemat_problems::dense::largest;
use basemat_problems::{assert_close, table};

/// A trench: flat, down, flat, up, flat, of unequal elements.
fn trench() -> Vec<Segment> {
    let points =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 0.8], [1.7, 1.0], [2.2, 1.0], [2.9, 0.1], [4.0, 0.0]];
    points.windows(2).map(|ends| Segment { from: ends[0], to: ends[1] }).collect()
}

/// G and H of a lag.
fn coefficients(kernel: &dyn BoundaryKernel, lag: usize) -> [Vec<f64>; 2] {
    let size = 4 * kernel.segments().len().pow(2);
    let mut g = vec![f64::NAN; size];
    let mut h = vec![f64::NAN; size];
    kernel.coefficients(lag, &mut g, &mut h).unwrap();
    [g, h]
}

/// The transformed kernel at one ζ; complex numbers as real and imaginary parts.
struct SymbolValues {
    /// G and H.
    matrices: [Vec<[f64; 2]>; 2],
    /// Laplace variable s of ζ.
    laplace: [f64; 2],
}

fn symbol(kernel: &dyn BoundaryKernel, zeta: [f64; 2]) -> SymbolValues {
    let size = 8 * kernel.segments().len().pow(2);
    let mut g = vec![f64::NAN; size];
    let mut h = vec![f64::NAN; size];
    let laplace = kernel.symbol(zeta, &mut g, &mut h).unwrap().unwrap();
    let matrices = [g, h].map(|matrix| matrix.chunks(2).map(|x| [x[0], x[1]]).collect());
    SymbolValues { matrices, laplace }
}

/// Magnitude of the difference of two complex numbers.
fn complex_distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Place of a component, such as `xz`, from the last of `count` elements to the first.
fn index_of_component(component: &str, count: usize) -> usize {
    let letters = component.as_bytes();
    let i = usize::from(letters[0] == b'z');
    let j = usize::from(letters[1] == b'z');
    i * count * 2 * count + j * count + count - 1
}

/// GOAL: element integrals of the transformed kernels. TABLE: mpmath, laplace_element.py.
/// With BDF1 and a unit step, s = 1 − ζ, so that any s is possible.
#[test]
fn laplace_integrals_agree_with_the_table() {
    let table = table("laplace_element.csv");
    let a = table.rows(["a0", "a1", "a2", "a3"]);
    let b = table.rows(["b0", "b1", "b2", "b3"]);
    let s = table.rows(["s_re", "s_im"]);
    let names = table.text("view");
    assert!(table.len() >= 7);
    for row in 0..table.len() {
        let mut segments: Vec<Segment> = [a[row], b[row]]
            .map(|ends| Segment { from: [ends[0], ends[1]], to: [ends[2], ends[3]] })
            .into();
        // An element that acts on itself is one segment, and has the free term.
        let is_on_itself = a[row] == b[row];
        if is_on_itself {
            segments.truncate(1);
        }
        let kernel =
            ConvolutionQuadrature::new(unit_soil(), &segments, 1.0, CqMethod::Bdf1).unwrap();
        let computed = symbol(&kernel, [1.0 - s[row][0], -s[row][1]]);
        let laplace_error = complex_distance(computed.laplace, s[row]);
        assert!(laplace_error < 1e-13 * s[row][0].hypot(s[row][1]));
        for (k, kind) in ["g", "h"].into_iter().enumerate() {
            let entries = ["xx", "xz", "zx", "zz"].map(|component| {
                let expected = ["re", "im"]
                    .map(|part| table.column(&format!("{kind}_{component}_{part}"))[row]);
                let is_diagonal = component == "xx" || component == "zz";
                let free_term = if kind == "h" && is_on_itself && is_diagonal { 0.5 } else { 0.0 };
                let mut value = computed.matrices[k][index_of_component(component, segments.len())];
                value[0] -= free_term;
                (component, value, expected)
            });
            // Relative to the largest component at this s.
            let scale = entries.iter().fold(1e-12_f64, |m, (_, _, w)| m.max(w[0].hypot(w[1])));
            for (component, value, expected) in entries {
                let error = complex_distance(value, expected) / scale;
                assert!(
                    error < 2e-12,
                    "{} {kind}_{component} at s = {:?}: {value:?}, expected {expected:?} ({error:.1e})",
                    names[row],
                    s[row]
                );
            }
        }
    }
}

/// GOAL: the coefficients are those of the symbol's power series.
/// SCENE: |ζ| = 0.99; the terms beyond 4000 lags sum to 3e-18.
#[test]
fn coefficients_sum_to_the_symbol() {
    for (segments, step) in [(flat(5), 0.25), (trench(), 0.6)] {
        for method in [CqMethod::Bdf1, CqMethod::Bdf2] {
            let kernel = ConvolutionQuadrature::new(unit_soil(), &segments, step, method).unwrap();
            assert!(kernel.contour_lags() < 1024);
            let lags: Vec<_> = (0..4000).map(|lag| coefficients(&kernel, lag)).collect();
            for angle in [0.0, 0.4, 2.0, 3.1] {
                let expected = symbol(&kernel, [0.99 * f64::cos(angle), 0.99 * f64::sin(angle)]);
                for k in 0..2 {
                    for entry in 0..lags[0][0].len() {
                        let mut sum = [0.0, 0.0];
                        for (n, lag) in lags.iter().enumerate() {
                            let size = (n as f64 * 0.99_f64.ln()).exp() * lag[k][entry];
                            sum[0] += size * (n as f64 * angle).cos();
                            sum[1] += size * (n as f64 * angle).sin();
                        }
                        let error = complex_distance(sum, expected.matrices[k][entry]);
                        assert!(error < 1e-11, "{method:?} {angle} {entry}: {error:.1e}");
                    }
                }
            }
        }
    }
}

/// Nodes and weights of the Gauss rule of 5 points (Abramowitz & Stegun 1964, table 25.4).
const GAUSS_RULE_OF_FIVE: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// G and H of the impulse response, by Gauss points on eight parts of each element.
///
/// The rule is accurate at late times, when the response is smooth.
fn impulse_response(segments: &[Segment], time: f64) -> [Vec<f64>; 2] {
    let plane = FullPlane::new(unit_soil());
    let count = segments.len();
    let mut g = vec![0.0; 4 * count * count];
    let mut h = vec![0.0; 4 * count * count];
    for (row, receiver) in segments.iter().enumerate() {
        for (column, segment) in segments.iter().enumerate() {
            for part in 0..8 {
                for (node, weight) in GAUSS_RULE_OF_FIVE {
                    let fraction = (f64::from(part) + 0.5 + 0.5 * node) / 8.0;
                    let weight = weight / 16.0 * segment.length();
                    let point = point_between(segment.from, segment.to, fraction);
                    let offset = [0, 1].map(|i| point[i] - receiver.center()[i]);
                    let u = plane.displacement(offset, time, LoadHistory::Impulse).unwrap();
                    let t = plane
                        .traction(offset, segment.normal(), time, LoadHistory::Impulse)
                        .unwrap();
                    for i in 0..2 {
                        for j in 0..2 {
                            let entry = (i * count + row) * 2 * count + j * count + column;
                            g[entry] += weight * u[i][j];
                            if row != column {
                                h[entry] += weight * t[j][i];
                            }
                        }
                    }
                }
            }
        }
    }
    [g, h]
}

/// Relative errors of G and H at a lag against Δt times the impulse response.
fn late_errors(kernel: &ConvolutionQuadrature, step: f64, lag: usize) -> [f64; 2] {
    let computed = coefficients(kernel, lag);
    let expected = impulse_response(kernel.segments(), lag as f64 * step);
    [0, 1].map(|k| {
        let difference = computed[k]
            .iter()
            .zip(&expected[k])
            .fold(0.0_f64, |m, (a, b)| m.max((a - step * b).abs()));
        difference / step / largest(&expected[k])
    })
}

/// GOAL: late coefficients are Δt times the impulse response at nΔt, at relative order n⁻² for
/// BDF2 and n⁻¹ for BDF1; at 54 000 lags still to 1e-8 and 1e-3.
#[test]
fn late_coefficients_agree_with_the_time_domain() {
    let step = 0.25;
    for segments in [flat(4), trench()] {
        for (method, order) in [(CqMethod::Bdf1, 1.0), (CqMethod::Bdf2, 2.0)] {
            let kernel = ConvolutionQuadrature::new(unit_soil(), &segments, step, method).unwrap();
            // Tractions, where the factor ln s starts with s².
            let early_error = late_errors(&kernel, step, 400)[1];
            let fine = late_errors(&kernel, step, 800)[1];
            assert_close("order", (early_error / fine).log2(), order, 0.1, 0.0);
            let latest_errors = late_errors(&kernel, step, 54_000);
            assert!(latest_errors[0] < 1e-8, "{:e}", latest_errors[0]);
            assert!(latest_errors[1] < if order > 1.5 { 1e-8 } else { 1e-3 });
        }
    }
}

/// GOAL: the coefficients continue smoothly from contour integral to closed form.
#[test]
fn contour_integral_and_closed_form_agree_where_they_meet() {
    for method in [CqMethod::Bdf1, CqMethod::Bdf2] {
        let kernel = ConvolutionQuadrature::new(unit_soil(), &flat(6), 0.5, method).unwrap();
        let seam = kernel.contour_lags();
        let lags: Vec<_> = (seam - 4..seam + 4).map(|lag| coefficients(&kernel, lag)).collect();
        for k in 0..2 {
            for entry in 0..lags[0][0].len() {
                // The seventh difference of a smooth function is rounding alone.
                let binomial = [1.0, -7.0, 21.0, -35.0, 35.0, -21.0, 7.0, -1.0];
                let difference: f64 =
                    lags.iter().zip(binomial).map(|(lag, b)| b * lag[k][entry]).sum();
                assert!(difference.abs() < 1e-11, "{method:?} {k} {entry}: {difference:e}");
            }
        }
    }
}

/// Vertical displacement of one element at time `end` under the traction t⁴ on another.
///
/// Integration by parts leaves the ramp response against f″ = 12t²; the composite midpoint rule
/// is sufficient, as the integrand is smooth but for its fronts.
fn response_to_quartic_load(segments: &[Segment], row: usize, column: usize, end: f64) -> f64 {
    let plane = FullPlane::new(unit_soil());
    let segment = segments[column];
    let center = segments[row].center();
    let parts = 24;
    let times = 1600;
    let mut sum = 0.0;
    for part in 0..parts {
        let fraction = (f64::from(part) + 0.5) / f64::from(parts);
        let point = point_between(segment.from, segment.to, fraction);
        let offset = [0, 1].map(|i| point[i] - center[i]);
        for k in 0..times {
            let t = end * (f64::from(k) + 0.5) / f64::from(times);
            let u = plane.displacement(offset, end - t, LoadHistory::Ramp).unwrap();
            sum += u[1][1] * 12.0 * t * t;
        }
    }
    sum * end / f64::from(times) * segment.length() / f64::from(parts)
}

/// Quadrature's response to the traction t⁴ at time `end`, from the third of three elements to the first.
fn quadrature_of_quartic_load(segments: &[Segment], method: CqMethod, steps: u32, end: f64) -> f64 {
    let step = end / f64::from(steps);
    let kernel = ConvolutionQuadrature::new(unit_soil(), segments, step, method).unwrap();
    let entry = 3 * 6 + 3 + 2;
    (0..=steps)
        .map(|m| {
            let lag = usize::try_from(steps - m).unwrap();
            coefficients(&kernel, lag)[0][entry] * (step * f64::from(m)).powi(4)
        })
        .sum()
}

/// GOAL: Σ ω f(mΔt) converges to the convolution with order 1 and 2, for a pair of elements and the
/// smooth traction t⁴.
#[test]
fn convolution_converges_at_the_order_of_the_method() {
    let segments = flat(3);
    let end = 6.0;
    let expected = response_to_quartic_load(&segments, 0, 2, end);
    for (method, order) in [(CqMethod::Bdf1, 1.0), (CqMethod::Bdf2, 2.0)] {
        let errors = [80, 160].map(|steps| {
            let computed = quadrature_of_quartic_load(&segments, method, steps, end);
            (computed / expected - 1.0).abs()
        });
        assert_close("order", (errors[0] / errors[1]).log2(), order, 0.2, 0.0);
        assert!(errors[1] < if order > 1.5 { 5e-3 } else { 0.1 }, "{:e}", errors[1]);
    }
}

/// Components i by j of one pair of five elements.
fn entry_of_five(matrix: &[f64], pair: [usize; 2], i: usize, j: usize) -> f64 {
    matrix[(i * 5 + pair[0]) * 10 + j * 5 + pair[1]]
}

/// GOAL: on a flat surface the coupling blocks of G are zero, and equal distances give equal entries.
#[test]
fn flat_boundaries_have_zero_and_toeplitz_blocks() {
    let kernel = ConvolutionQuadrature::new(unit_soil(), &flat(5), 0.5, CqMethod::Bdf2).unwrap();
    for lag in [0, 3, 50, 5000] {
        let [g, h] = coefficients(&kernel, lag);
        for row in 0..5 {
            for column in 0..5 {
                let pair = [row, column];
                assert_eq!(entry_of_five(&g, pair, 0, 1), 0.0);
                assert_eq!(entry_of_five(&g, pair, 1, 0), 0.0);
                let free_term = if lag == 0 && row == column { 0.5 } else { 0.0 };
                for i in 0..2 {
                    assert!((entry_of_five(&h, pair, i, i) - free_term).abs() < 1e-13);
                }
                if row > 0 && column > 0 {
                    let previous_pair = [row - 1, column - 1];
                    assert_eq!(
                        entry_of_five(&g, pair, 0, 0),
                        entry_of_five(&g, previous_pair, 0, 0)
                    );
                }
            }
        }
    }
}

fn bdf2_quadrature(segments: &[Segment], step: f64) -> Result<ConvolutionQuadrature> {
    ConvolutionQuadrature::new(unit_soil(), segments, step, CqMethod::Bdf2)
}

/// GOAL: invalid input gives typed errors, without a panic or an endless loop.
#[test]
fn invalid_input_is_an_error() {
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
        assert!(matches!(bdf2_quadrature(&flat(2), step), Err(Error::Input { .. })), "{step}");
    }
    assert!(matches!(bdf2_quadrature(&[], 1.0), Err(Error::Size { .. })));
    for coordinate in [f64::NAN, f64::INFINITY] {
        let segment = Segment { from: [coordinate, 0.0], to: [1.0, 0.0] };
        assert!(matches!(bdf2_quadrature(&[segment], 1.0), Err(Error::Input { .. })));
    }
    let point = Segment { from: [1.0, 0.0], to: [1.0, 0.0] };
    assert!(matches!(bdf2_quadrature(&[point], 1.0), Err(Error::Input { .. })));
    let kernel = bdf2_quadrature(&flat(2), 1.0).unwrap();
    let mut g = [0.0; 16];
    let mut h = [0.0; 15];
    assert!(matches!(kernel.coefficients(0, &mut g, &mut h), Err(Error::Size { .. })));
    assert!(matches!(kernel.symbol([0.5, 0.0], &mut g, &mut h), Err(Error::Size { .. })));
}
