//! GOAL: surface kernels and the weights of elements are right to their last digits.
//! SCENE: line loads and elements over eleven values of ν, at early, middle and late times.
//! REFERENCE: tables of sixty digits, transforms, quadrature, differential equations.

use basemat::Soil;
use basemat::bem::{ContactElement, InfluenceKernel, PatchKernel};
use basemat::fundamental::{FullPlane, FundamentalSolution, HalfPlane, LoadHistory};
use basemat::history::ConvolutionWeights;
use basemat::motion::PlaneWave;
use std::f64::consts::PI;

const POISSON_RATIOS: [f64; 11] =
    [-0.5, 0.0, 1e-4, 0.2, 0.25, 0.2630, 0.263_082_06, 1.0 / 3.0, 0.45, 0.49, 0.4999];

pub(super) fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines()
        .filter(|line| line.starts_with(|c: char| c == '-' || c.is_ascii_digit()))
        .map(|line| line.split(',').map(|field| field.parse().unwrap()).collect())
        .collect()
}

fn soil(nu: f64) -> Soil {
    Soil::new(1.0, nu, 1.0).unwrap()
}

#[track_caller]
pub(super) fn assert_near(computed: f64, expected: f64, tolerance: f64, name: &str) {
    assert!(
        (computed - expected).abs() <= tolerance,
        "{name}: {computed:e}, expected {expected:e}"
    );
}

/// Unit element around a point.
fn unit_element(center: f64) -> ContactElement {
    ContactElement::new(center - 0.5, center + 0.5)
}

/// GOAL: convolution weights are exact to 1e-10 of the self term at distances up to 25, and to 1e-8 beyond.
#[test]
fn step_coefficients_match_sixty_digits() {
    for row in rows(include_str!("../data/influence.csv")) {
        let kernel = InfluenceKernel::new(soil(row[0]), row[1]).unwrap();
        let receiver = ContactElement::new(row[2], row[3]);
        let source = ContactElement::new(row[4], row[5]);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let weights = kernel.coefficients(receiver, source, row[6] as usize).unwrap();
        // A large source moves a small receiver more than the receiver moves itself.
        let scale = row[10].abs().max(row[7].abs());
        let distance = (row[3] - row[4]).abs().max((row[5] - row[2]).abs());
        let tolerance = scale * if distance > 25.0 { 1e-8 } else { 1e-10 };
        for (computed, expected) in
            [(weights.zz, row[7]), (weights.xx, row[8]), (weights.zx, row[9])]
        {
            assert_near(computed, expected, tolerance, &format!("{row:?}"));
        }
    }
}

fn square_root([re, im]: [f64; 2]) -> [f64; 2] {
    let modulus = re.hypot(im);
    let root = (0.5 * (modulus + re)).max(0.0).sqrt();
    [root, (0.5 * (modulus - re)).max(0.0).sqrt().copysign(im)]
}

fn product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// Imaginary part of a quotient of complex numbers.
fn imaginary_part_of_quotient(numerator: [f64; 2], denominator: [f64; 2]) -> f64 {
    let square = denominator[0] * denominator[0] + denominator[1] * denominator[1];
    product(numerator, [denominator[0], -denominator[1]])[1] / square
}

/// GOAL: the kernels are Im a/R, Im b/R and Im p(G−2ab)/R of the transform on the upper side of the cut.
#[test]
fn impulse_is_the_jump_of_the_transform() {
    for nu in POISSON_RATIOS {
        let plane = HalfPlane::new(soil(nu));
        let a2 = 0.5 * (1.0 - 2.0 * nu) / (1.0 - nu);
        for tau in [0.3, 0.6, 0.75, 0.9, 0.99, 1.01, 1.04, 1.3, 2.0, 10.0, 1e3] {
            let y: f64 = tau * tau;
            // On the upper side the roots have negative imaginary parts.
            let a = square_root([a2 - y, -0.0]);
            let b = square_root([1.0 - y, -0.0]);
            let ab = product(a, b);
            let g = 1.0 - 2.0 * y;
            let r = [g * g + 4.0 * y * ab[0], 4.0 * y * ab[1]];
            let square = r[0] * r[0] + r[1] * r[1];
            let zz = imaginary_part_of_quotient(a, r);
            let xx = imaginary_part_of_quotient(b, r);
            let impulse = plane.impulse(tau);
            // Terms of size y² cancel in R, which limits its relative accuracy. Behind the S wave f decays like
            // 1/τ, and so does the tolerance.
            let rounding = 2e-15 * (1.0 + y) * (1.0 + y) / square.sqrt();
            let tolerance = (1e-13 + rounding) * (zz.abs() + xx.abs()).max(1.0 / (1.0 + tau));
            assert_near(impulse.zz, zz, tolerance, &format!("zz {nu} {tau}"));
            assert_near(impulse.xx, xx, tolerance, &format!("xx {nu} {tau}"));
            let coupling = [tau * (g - 2.0 * ab[0]), tau * -2.0 * ab[1]];
            let zx = -imaginary_part_of_quotient(coupling, r);
            if tau < 1.0 {
                assert_near(impulse.zx, zx, tolerance, &format!("zx {nu} {tau}"));
            }
        }
    }
}

/// Components zz, xx and zx of the primitive with weight τ^−m.
fn primitive(plane: &HalfPlane, m: usize, tau: f64) -> [f64; 3] {
    let values = match m {
        0 => plane.heaviside(tau),
        1 => plane.first_tail(tau),
        _ => plane.second_tail(tau),
    };
    [values.zz, values.xx, values.zx]
}

/// GOAL: primitives are integrals of the impulse, away from arrivals and the Rayleigh pole.
/// REFERENCE: the midpoint rule.
#[test]
fn primitives_match_quadrature() {
    for nu in POISSON_RATIOS {
        let plane = HalfPlane::new(soil(nu));
        let arrival = 1.0 / PlaneWave::rayleigh(soil(nu)).apparent_velocity();
        for (from, to) in [(0.87, 0.95), (1.001, 1.02), (arrival + 0.2, 3.0), (3.0, 6.0)] {
            let count = 20_000;
            let mut sums = [[0.0; 3]; 3];
            for i in 0..count {
                let width = (to - from) / f64::from(count);
                let tau = from + width * (f64::from(i) + 0.5);
                let f = plane.impulse(tau);
                for (m, sum) in sums.iter_mut().enumerate() {
                    let weight = width / tau.powi(i32::try_from(m).unwrap());
                    sum[0] += weight * f.zz;
                    sum[1] += weight * f.xx;
                    sum[2] += weight * f.zx;
                }
            }
            for m in 0..3 {
                // The tails are integrals from τ to infinity.
                let ends = if m == 0 { [from, to] } else { [to, from] };
                let start = primitive(&plane, m, ends[0]);
                let end = primitive(&plane, m, ends[1]);
                for component in 0..3 {
                    let change = end[component] - start[component];
                    let expected = sums[m][component];
                    let name = format!("{nu} {from} {m} {component}");
                    assert_near(change, expected, 1e-6 * expected.abs() + 1e-9, &name);
                }
            }
        }
        // Long-time limits, and continuity where the late series takes over.
        assert_near(plane.heaviside(50.0).zx, PI * (1.0 - 2.0 * nu) / 4.0, 1e-12, "static zx");
        assert_near(50.0 * plane.impulse(50.0).zz, 1.0 - nu, 1e-3, "static zz");
        for tail in [HalfPlane::first_tail, HalfPlane::second_tail] {
            let before = tail(&plane, 3.0 * arrival * (1.0 - 1e-14));
            let after = tail(&plane, 3.0 * arrival * (1.0 + 1e-14));
            assert_near(before.zz, after.zz, 1e-11, &format!("late zz {nu}"));
            assert_near(before.xx, after.xx, 1e-11, &format!("late xx {nu}"));
        }
    }
}

/// Poisson's ratio, and tables of Lamb's problem: step load, one element, mean of an element.
fn lamb_tables() -> [(f64, [&'static str; 3]); 3] {
    [
        (
            0.0,
            [
                include_str!("../data/lamb_heaviside_nu0.csv"),
                include_str!("../data/lamb_element_nu0.csv"),
                include_str!("../data/lamb_galerkin_nu0.csv"),
            ],
        ),
        (
            0.25,
            [
                include_str!("../data/lamb_heaviside_nu025.csv"),
                include_str!("../data/lamb_element_nu025.csv"),
                include_str!("../data/lamb_galerkin_nu025.csv"),
            ],
        ),
        (
            1.0 / 3.0,
            [
                include_str!("../data/lamb_heaviside_nu0333.csv"),
                include_str!("../data/lamb_element_nu0333.csv"),
                include_str!("../data/lamb_galerkin_nu0333.csv"),
            ],
        ),
    ]
}

/// ∫₀^X u dx of a line load: components xx, zz and zx.
///
/// Q for an impulse; X F + t Q for a load H(t).
fn integral_along_surface(plane: &HalfPlane, x: f64, time: f64, is_impulse: bool) -> [f64; 3] {
    if x == 0.0 {
        return [0.0; 3];
    }
    let f = plane.heaviside(time / x.abs());
    let q = plane.first_tail(time / x.abs());
    let [xx, zz, zx] = [[f.xx, q.xx], [f.zz, q.zz], [f.zx, q.zx]]
        .map(|[f, q]| if is_impulse { q } else { x.abs() * f + time * q });
    let sign_factor = x.signum() / PI;
    [xx * sign_factor, zz * sign_factor, zx / PI]
}

/// GOAL: Lamb's problem is right for a line load, for a loaded element, and as the mean of an element.
/// REFERENCE: tables with columns xy (x due to z load) and yx (z due to x load).
#[test]
fn displacements_of_line_loads_and_elements_are_those_of_the_tables() {
    for (nu, [heaviside, element, galerkin]) in lamb_tables() {
        let plane = HalfPlane::new(soil(nu));
        for row in rows(heaviside) {
            let u = plane.displacement([1.0, 0.0], row[0], LoadHistory::Step).unwrap();
            let name = format!("heaviside {nu} {}", row[0]);
            for (computed, expected) in
                [(u[0][0], row[1]), (u[0][1], row[2]), (u[1][0], row[3]), (u[1][1], row[4])]
            {
                assert_near(computed, expected, 1e-11, &name);
            }
        }
        for row in rows(galerkin) {
            let u = plane.element_mean(unit_element(row[0]), unit_element(0.0), row[1]).unwrap();
            let name = format!("galerkin {nu} {row:?}");
            for (computed, expected) in
                [(u.xx, row[2]), (-u.zx, row[3]), (u.zx, row[4]), (u.zz, row[5])]
            {
                assert_near(computed, expected, 1e-11, &name);
            }
        }
        // Under a traction on [−1/2, 1/2], the displacement of a point is a difference of two integrals from this point.
        for row in rows(element).iter().filter(|row| row[0] >= 0.0) {
            let is_impulse = row[0] == 1.0;
            let right = integral_along_surface(&plane, row[1] + 0.5, row[2], is_impulse);
            let left = integral_along_surface(&plane, row[1] - 0.5, row[2], is_impulse);
            let name = format!("element {nu} {row:?}");
            for (i, expected) in [row[3], row[6], row[5]].into_iter().enumerate() {
                assert_near(right[i] - left[i], expected, 1e-11, &name);
            }
        }
    }
}

/// GOAL: each load history is the time derivative of the next.
#[test]
fn half_plane_loads_follow_from_each_other() {
    let ground = Soil::new(3.0, 0.3, 2.0).unwrap();
    let plane = HalfPlane::new(ground);
    let h = 1e-5;
    for (slow, fast) in
        [(LoadHistory::Ramp, LoadHistory::Step), (LoadHistory::Step, LoadHistory::Impulse)]
    {
        for (x, time) in [(0.8, 0.3), (0.8, 0.5), (-0.8, 0.6), (-2.0, 1.3), (0.8, 3.0), (0.8, 0.66)]
        {
            let before = plane.displacement([x, 0.0], time - h, slow).unwrap();
            let after = plane.displacement([x, 0.0], time + h, slow).unwrap();
            let rate = plane.displacement([x, 0.0], time, fast).unwrap();
            for i in 0..2 {
                for j in 0..2 {
                    let computed = (after[i][j] - before[i][j]) / (2.0 * h);
                    let name = format!("{slow:?} {x} {time} {i} {j}");
                    assert_near(computed, rate[i][j], 2e-7, &name);
                }
            }
        }
    }
}

/// GOAL: weights are zero before the first wave and after the last coupling, are reciprocal, and return errors for bad input.
#[test]
fn nothing_arrives_early_and_invalid_input_is_an_error() {
    for nu in POISSON_RATIOS {
        let ground = soil(nu);
        let near_element = ContactElement::new(0.0, 1.0);
        let far_element = ContactElement::new(11.0, 12.0);
        let kernel = InfluenceKernel::new(ground, 0.01).unwrap();
        let weights_at = |lag| kernel.coefficients(far_element, near_element, lag).unwrap();
        let early_weights = weights_at(9);
        if ground.pressure_wave_speed() < 100.0 {
            assert_eq!((early_weights.zz, early_weights.xx, early_weights.zx), (0.0, 0.0, 0.0));
        }
        // The last lag of the coupling, and reciprocity.
        let patch = PatchKernel::new(ground, vec![near_element, far_element], 0.01).unwrap();
        let class = (0..patch.classes().count())
            .find(|class| patch.classes().representative(*class) == Ok([near_element, far_element]))
            .unwrap();
        let last_lag = patch.last_coupling_lag(class).unwrap().unwrap();
        assert!(weights_at(last_lag).zx != 0.0 && weights_at(last_lag + 1).zx == 0.0);
        for lag in [1, 300, 1000, 1190, 5000] {
            let forward = weights_at(lag);
            let backward = kernel.coefficients(near_element, far_element, lag).unwrap();
            assert_eq!(
                (forward.zz, forward.xx, forward.zx),
                (backward.zz, backward.xx, -backward.zx)
            );
        }
        let mut weights = [[7.0; 4]; 3];
        patch
            .coefficients(class, 1100, &mut weights.each_mut().map(|list| &mut list[..]))
            .unwrap();
        assert_eq!(weights[0][2], weights_at(1102).zz);
        assert_eq!(weights[2][2], weights_at(1102).zx);
    }
    let ground = soil(0.3);
    for time_step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(InfluenceKernel::new(ground, time_step).is_err());
    }
    let kernel = InfluenceKernel::new(ground, 0.1).unwrap();
    let valid_element = ContactElement::new(0.0, 1.0);
    for (left, right) in [(0.0, 0.0), (1.0, 0.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
        let invalid_element = ContactElement::new(left, right);
        assert!(kernel.coefficients(valid_element, invalid_element, 1).is_err());
        assert!(HalfPlane::new(ground).element_mean(invalid_element, valid_element, 1.0).is_err());
    }
    assert!(kernel.coefficients(valid_element, valid_element, 0).is_err());
    let plane = HalfPlane::new(ground);
    assert!(plane.displacement([1.0, 0.5], 1.0, LoadHistory::Step).is_err());
    assert!(plane.displacement([0.0, 0.0], 1.0, LoadHistory::Step).is_err());
    assert!(FullPlane::new(ground).displacement([0.0, 0.0], 1.0, LoadHistory::Step).is_err());
}
