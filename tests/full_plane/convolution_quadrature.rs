//! GOAL: coefficients by convolution quadrature solve the transformed equation, at the order of the
//! method. SCENE: flat surfaces and a trench of unequal elements, BDF1 and BDF2. REFERENCE: mpmath,
//! the symbol's power series, and the solution in time.

use basemat::Error;
use basemat::bem::full_plane::{BoundaryKernel, ConvolutionQuadrature, CqMethod, Segment};
use basemat::fundamental::{FullPlane, FundamentalSolution, LoadHistory};

use super::{flat, unit_soil};
use basemat_problems::{close, table};

/// A trench: flat, down, flat, up, flat, of unequal elements.
fn trench() -> Vec<Segment> {
    let points =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 0.8], [1.7, 1.0], [2.2, 1.0], [2.9, 0.1], [4.0, 0.0]];
    points.windows(2).map(|ends| Segment { from: ends[0], to: ends[1] }).collect()
}

fn coefficients(kernel: &dyn BoundaryKernel, lag: usize) -> [Vec<f64>; 2] {
    let size = 4 * kernel.segments().len().pow(2);
    let (mut g, mut h) = (vec![f64::NAN; size], vec![f64::NAN; size]);
    kernel.coefficients(lag, &mut g, &mut h).unwrap();
    [g, h]
}

fn symbol(kernel: &dyn BoundaryKernel, zeta: [f64; 2]) -> ([Vec<[f64; 2]>; 2], [f64; 2]) {
    let size = 8 * kernel.segments().len().pow(2);
    let (mut g, mut h) = (vec![f64::NAN; size], vec![f64::NAN; size]);
    let s = kernel.symbol(zeta, &mut g, &mut h).unwrap().unwrap();
    let pairs = |list: Vec<f64>| list.chunks(2).map(|x| [x[0], x[1]]).collect();
    ([pairs(g), pairs(h)], s)
}

/// GOAL: element integrals of the transformed kernels. TABLE: mpmath, laplace_element.py.
/// With BDF1 and a unit step, ζ = 1 − s reaches any s.
#[test]
fn laplace_integrals_agree_with_the_table() {
    let table = table("laplace_element.csv");
    let a = table.rows(["a0", "a1", "a2", "a3"]);
    let b = table.rows(["b0", "b1", "b2", "b3"]);
    let s = table.rows(["s_re", "s_im"]);
    let names = table.text("view");
    assert!(table.len() >= 7);
    for row in 0..table.len() {
        let own = names[row].starts_with("own");
        let ends = |x: [f64; 4]| Segment { from: [x[0], x[1]], to: [x[2], x[3]] };
        let segments = if own { vec![ends(a[row])] } else { vec![ends(a[row]), ends(b[row])] };
        let kernel =
            ConvolutionQuadrature::new(unit_soil(), &segments, 1.0, CqMethod::Bdf1).unwrap();
        let (found, at) = symbol(&kernel, [1.0 - s[row][0], -s[row][1]]);
        assert!((at[0] - s[row][0]).hypot(at[1] - s[row][1]) < 1e-13 * s[row][0].hypot(s[row][1]));
        let count = segments.len();
        for (k, kind) in ["g", "h"].into_iter().enumerate() {
            let entries: Vec<_> = ["xx", "xz", "zx", "zz"]
                .map(|name| {
                    let wanted =
                        ["re", "im"].map(|p| table.column(&format!("{kind}_{name}_{p}"))[row]);
                    let index = |c: char| usize::from(c == 'z');
                    let (i, j) =
                        (index(name.as_bytes()[0] as char), index(name.as_bytes()[1] as char));
                    let place = i * count * 2 * count + j * count + count - 1;
                    let free = if kind == "h" && own && i == j { 0.5 } else { 0.0 };
                    let mut value = found[k][place];
                    value[0] -= free;
                    (name, value, wanted)
                })
                .into();
            // Relative to the largest component at this s; the tolerance was 1e-11.
            let scale = entries.iter().fold(1e-12_f64, |m, (_, _, w)| m.max(w[0].hypot(w[1])));
            for (name, value, wanted) in entries {
                let error = (value[0] - wanted[0]).hypot(value[1] - wanted[1]) / scale;
                assert!(
                    error < 2e-12,
                    "{} {kind}_{name} at s = {:?}: {value:?}, wanted {wanted:?} ({error:.1e})",
                    names[row],
                    s[row]
                );
            }
        }
    }
}

/// GOAL: the coefficients sum to the symbol's power series, tail included. Σ over 4000 lags at |ζ|
/// = 0.99 leaves 3e-18.
#[test]
fn coefficients_sum_to_the_symbol() {
    for (segments, step) in [(flat(5), 0.25), (trench(), 0.6)] {
        for method in [CqMethod::Bdf1, CqMethod::Bdf2] {
            let kernel = ConvolutionQuadrature::new(unit_soil(), &segments, step, method).unwrap();
            assert!(kernel.contour_lags() < 1024);
            let lags: Vec<_> = (0..4000).map(|lag| coefficients(&kernel, lag)).collect();
            for angle in [0.0, 0.4, 2.0, 3.1] {
                let (wanted, _) = symbol(&kernel, [0.99 * f64::cos(angle), 0.99 * f64::sin(angle)]);
                for k in 0..2 {
                    for place in 0..lags[0][0].len() {
                        let mut sum = [0.0, 0.0];
                        for (n, lag) in lags.iter().enumerate() {
                            let size = (n as f64 * 0.99_f64.ln()).exp() * lag[k][place];
                            sum[0] += size * (n as f64 * angle).cos();
                            sum[1] += size * (n as f64 * angle).sin();
                        }
                        let wanted = wanted[k][place];
                        let error = (sum[0] - wanted[0]).hypot(sum[1] - wanted[1]);
                        assert!(error < 1e-11, "{method:?} {angle} {place}: {error:.1e}");
                    }
                }
            }
        }
    }
}

/// Impulse response of all pairs, integrated over the elements by 20 Gauss points in four parts:
/// late, when it is smooth.
fn impulse(segments: &[Segment], time: f64) -> [Vec<f64>; 2] {
    // Rule of 5 points on each of 8 parts (Abramowitz & Stegun 1964, table 25.4).
    let rule = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let plane = FullPlane::new(unit_soil());
    let count = segments.len();
    let (mut g, mut h) = (vec![0.0; 4 * count * count], vec![0.0; 4 * count * count]);
    for (row, point) in segments.iter().enumerate() {
        for (column, segment) in segments.iter().enumerate() {
            for part in 0..8 {
                for (node, weight) in rule {
                    let share = (f64::from(part) + 0.5 + 0.5 * node) / 8.0;
                    let weight = weight / 16.0 * segment.length();
                    let offset = [0, 1].map(|i| {
                        segment.from[i] + share * (segment.to[i] - segment.from[i])
                            - point.center()[i]
                    });
                    let u = plane.displacement(offset, time, LoadHistory::Impulse).unwrap();
                    let t = plane
                        .traction(offset, segment.normal(), time, LoadHistory::Impulse)
                        .unwrap();
                    for i in 0..2 {
                        for j in 0..2 {
                            let place = (i * count + row) * 2 * count + j * count + column;
                            g[place] += weight * u[i][j];
                            if row != column {
                                h[place] += weight * t[j][i];
                            }
                        }
                    }
                }
            }
        }
    }
    [g, h]
}

/// GOAL: late coefficients are Δt times the impulse response at nΔt, at relative order n⁻² for
/// BDF2 and n⁻¹ for BDF1; at 54 000 lags still to 1e-8 and 1e-3.
#[test]
fn late_coefficients_agree_with_the_time_domain() {
    let step = 0.25;
    for segments in [flat(4), trench()] {
        for (method, order) in [(CqMethod::Bdf1, 1.0), (CqMethod::Bdf2, 2.0)] {
            let kernel = ConvolutionQuadrature::new(unit_soil(), &segments, step, method).unwrap();
            let error = |lag: usize, k: usize| {
                let found = &coefficients(&kernel, lag)[k];
                let wanted = &impulse(&segments, lag as f64 * step)[k];
                let difference =
                    found.iter().zip(wanted).fold(0.0_f64, |m, (a, b)| m.max((a - step * b).abs()));
                difference / step / wanted.iter().fold(0.0_f64, |m, x| m.max(x.abs()))
            };
            // Tractions, where the factor ln s starts with s².
            let (coarse, fine) = (error(400, 1), error(800, 1));
            close("order", (coarse / fine).log2(), order, 0.1, 0.0);
            assert!(error(54_000, 0) < 1e-8, "{:e}", error(54_000, 0));
            assert!(error(54_000, 1) < if order > 1.5 { 1e-8 } else { 1e-3 });
        }
    }
}

/// GOAL: no seam between contour and closed form: the coefficients go on smoothly.
#[test]
fn contour_and_closed_form_meet() {
    for method in [CqMethod::Bdf1, CqMethod::Bdf2] {
        let kernel = ConvolutionQuadrature::new(unit_soil(), &flat(6), 0.5, method).unwrap();
        let seam = kernel.contour_lags();
        let lags: Vec<_> = (seam - 4..seam + 4).map(|lag| coefficients(&kernel, lag)).collect();
        for k in 0..2 {
            for place in 0..lags[0][0].len() {
                // Seventh difference: of a smooth function nothing but rounding.
                let binomial = [1.0, -7.0, 21.0, -35.0, 35.0, -21.0, 7.0, -1.0];
                let difference: f64 =
                    lags.iter().zip(binomial).map(|(lag, b)| b * lag[k][place]).sum();
                assert!(difference.abs() < 1e-11, "{method:?} {k} {place}: {difference:e}");
            }
        }
    }
}

/// Convolution at time T of one pair with f = t⁴ by the exact time kernel: ∫ k(T−t) f(t) dt for
/// the load t⁴ needs the step response five times integrated by parts; a composite rule on the
/// step response against f' (smooth but for its fronts) is enough here.
fn exact_response(segments: &[Segment], row: usize, column: usize, end: f64) -> f64 {
    let plane = FullPlane::new(unit_soil());
    let segment = segments[column];
    let center = segments[row].center();
    let (parts, times) = (24, 1600);
    let mut sum = 0.0;
    for part in 0..parts {
        let share = (f64::from(part) + 0.5) / f64::from(parts);
        let offset =
            [0, 1].map(|i| segment.from[i] + share * (segment.to[i] - segment.from[i]) - center[i]);
        for k in 0..times {
            // Midpoint rule; f' = 4t³.
            let t = end * (f64::from(k) + 0.5) / f64::from(times);
            let u = plane.displacement(offset, end - t, LoadHistory::Ramp).unwrap();
            sum += u[1][1] * 12.0 * t * t;
        }
    }
    sum * end / f64::from(times) * segment.length() / f64::from(parts)
}

/// GOAL: Σ ω f(mΔt) tends to the convolution at order 1 and 2, for a pair of elements and the
/// smooth traction t⁴.
#[test]
fn convolution_converges_at_the_order_of_the_method() {
    let segments = flat(3);
    let end = 6.0;
    let wanted = exact_response(&segments, 0, 2, end);
    for (method, order) in [(CqMethod::Bdf1, 1.0), (CqMethod::Bdf2, 2.0)] {
        let error = |steps: u32| {
            let step = end / f64::from(steps);
            let kernel = ConvolutionQuadrature::new(unit_soil(), &segments, step, method).unwrap();
            let place = 3 * 6 + 3 + 2;
            let sum: f64 = (0..=steps)
                .map(|m| {
                    let lag = usize::try_from(steps - m).unwrap();
                    coefficients(&kernel, lag)[0][place] * (step * f64::from(m)).powi(4)
                })
                .sum();
            (sum / wanted - 1.0).abs()
        };
        let (coarse, fine) = (error(80), error(160));
        close("order", (coarse / fine).log2(), order, 0.2, 0.0);
        assert!(fine < if order > 1.5 { 5e-3 } else { 0.1 }, "{fine:e}");
    }
}

/// GOAL: what is zero on a flat surface is zero, and equal pairs are equal.
#[test]
fn flat_boundaries_have_zero_blocks_and_toeplitz_ones() {
    let kernel = ConvolutionQuadrature::new(unit_soil(), &flat(5), 0.5, CqMethod::Bdf2).unwrap();
    for lag in [0, 3, 50, 5000] {
        let [g, h] = coefficients(&kernel, lag);
        for row in 0..5 {
            for column in 0..5 {
                let at = |m: &[f64], i: usize, j: usize| m[(i * 5 + row) * 10 + j * 5 + column];
                assert_eq!(at(&g, 0, 1), 0.0);
                assert_eq!(at(&g, 1, 0), 0.0);
                let free = if lag == 0 && row == column { 0.5 } else { 0.0 };
                assert!((at(&h, 0, 0) - free).abs() < 1e-13 && (at(&h, 1, 1) - free).abs() < 1e-13);
                if row > 0 && column > 0 {
                    let before = |m: &[f64]| m[(row - 1) * 10 + column - 1];
                    assert_eq!(g[row * 10 + column], before(&g));
                }
            }
        }
    }
}

/// GOAL: bad input gives typed errors, never a panic or a hang.
#[test]
fn bad_input_is_an_error() {
    let make = |segments: &[Segment], step| {
        ConvolutionQuadrature::new(unit_soil(), segments, step, CqMethod::Bdf2)
    };
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
        assert!(matches!(make(&flat(2), step), Err(Error::Input { .. })), "{step}");
    }
    assert!(matches!(make(&[], 1.0), Err(Error::Size { .. })));
    for bad in [f64::NAN, f64::INFINITY] {
        let segment = Segment { from: [bad, 0.0], to: [1.0, 0.0] };
        assert!(matches!(make(&[segment], 1.0), Err(Error::Input { .. })));
    }
    let point = Segment { from: [1.0, 0.0], to: [1.0, 0.0] };
    assert!(matches!(make(&[point], 1.0), Err(Error::Input { .. })));
    let kernel = make(&flat(2), 1.0).unwrap();
    let (mut g, mut h) = ([0.0; 16], [0.0; 15]);
    assert!(matches!(kernel.coefficients(0, &mut g, &mut h), Err(Error::Size { .. })));
    assert!(matches!(kernel.symbol([0.5, 0.0], &mut g, &mut h), Err(Error::Size { .. })));
}
