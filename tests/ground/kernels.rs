//! GOAL: surface and full-plane kernels, and the coefficients of elements, to their last digits.
//! SCENE: line loads and elements over eleven values of ν, at early, middle and late times.
//! REFERENCE: tables of sixty digits, transforms, quadrature, differential equations.

use basemat::Soil;
use basemat::bem::{ContactElement, InfluenceKernel, PatchKernel};
use basemat::fundamental::{FullPlane, FundamentalSolution, HalfPlane, LoadHistory};
use basemat::history::ConvolutionWeights;
use basemat::motion::PlaneWave;
use std::f64::consts::PI;

const POISSON: [f64; 11] =
    [-0.5, 0.0, 1e-4, 0.2, 0.25, 0.2630, 0.263_082_06, 1.0 / 3.0, 0.45, 0.49, 0.4999];

fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines()
        .filter(|line| line.starts_with(|c: char| c == '-' || c.is_ascii_digit()))
        .map(|line| line.split(',').map(|field| field.parse().unwrap()).collect())
        .collect()
}

fn soil(nu: f64) -> Soil {
    Soil::new(1.0, nu, 1.0).unwrap()
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found:e}, expected {expected:e}");
}

/// Convolution weights: 1e-10 of the self term up to 20 elements, 1e-8 up to 200.
#[test]
fn step_coefficients_match_sixty_digits() {
    for row in rows(include_str!("../data/influence.csv")) {
        let kernel = InfluenceKernel::new(soil(row[0]), row[1]).unwrap();
        let receiver = ContactElement::new(row[2], row[3]);
        let source = ContactElement::new(row[4], row[5]);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let found = kernel.coefficients(receiver, source, row[6] as usize).unwrap();
        // A large source on a small receiver gives more than the receiver on itself.
        let scale = row[10].abs().max(row[7].abs());
        let far = (row[3] - row[4]).abs().max((row[5] - row[2]).abs());
        let tolerance = scale * if far > 25.0 { 1e-8 } else { 1e-10 };
        for (value, expected) in [(found.zz, row[7]), (found.xx, row[8]), (found.zx, row[9])] {
            close(value, expected, tolerance, &format!("{row:?}"));
        }
    }
}

fn square_root([re, im]: [f64; 2]) -> [f64; 2] {
    let size = re.hypot(im);
    let root = (0.5 * (size + re)).max(0.0).sqrt();
    [root, (0.5 * (size - re)).max(0.0).sqrt().copysign(im)]
}

fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// The kernels are Im a/R, Im b/R and Im p(G−2ab)/R of the transform on the upper side of the cut.
#[test]
fn impulse_is_the_jump_of_the_transform() {
    for nu in POISSON {
        let plane = HalfPlane::new(soil(nu));
        let a2 = 0.5 * (1.0 - 2.0 * nu) / (1.0 - nu);
        for tau in [0.3, 0.6, 0.75, 0.9, 0.99, 1.01, 1.04, 1.3, 2.0, 10.0, 1e3] {
            let y: f64 = tau * tau;
            // On the upper side the roots have negative imaginary parts.
            let (a, b) = (square_root([a2 - y, -0.0]), square_root([1.0 - y, -0.0]));
            let ab = times(a, b);
            let g = 1.0 - 2.0 * y;
            let r = [g * g + 4.0 * y * ab[0], 4.0 * y * ab[1]];
            let size = r[0] * r[0] + r[1] * r[1];
            let over = |v: [f64; 2]| times(v, [r[0], -r[1]])[1] / size;
            let found = plane.impulse(tau);
            // Terms of size y² cancel in R: its relative rounding. Behind the S wave f decays like
            // 1/τ, and the tolerance with it.
            let rounding = 2e-15 * (1.0 + y) * (1.0 + y) / size.sqrt();
            let scale = (1e-13 + rounding) * (over(a).abs() + over(b).abs()).max(1.0 / (1.0 + tau));
            close(found.zz, over(a), scale, &format!("zz {nu} {tau}"));
            close(found.xx, over(b), scale, &format!("xx {nu} {tau}"));
            let coupled = [tau * (g - 2.0 * ab[0]), tau * -2.0 * ab[1]];
            let expected = -over(coupled);
            if tau < 1.0 {
                close(found.zx, expected, scale, &format!("zx {nu} {tau}"));
            }
        }
    }
}

/// Primitives against the midpoint rule, away from arrivals and the
/// Rayleigh pole.
#[test]
fn primitives_match_quadrature() {
    for nu in POISSON {
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
            let change = |m: usize, component: usize| {
                let at = |tau: f64| {
                    let v = match m {
                        0 => plane.heaviside(tau),
                        1 => plane.first_tail(tau),
                        _ => plane.second_tail(tau),
                    };
                    [v.zz, v.xx, v.zx][component]
                };
                if m == 0 { at(to) - at(from) } else { at(from) - at(to) }
            };
            for m in 0..3 {
                for component in 0..3 {
                    let expected = sums[m][component];
                    let what = format!("{nu} {from} {m} {component}");
                    close(change(m, component), expected, 1e-6 * expected.abs() + 1e-9, &what);
                }
            }
        }
        // Long-time limits, and continuity where the late series takes over.
        close(plane.heaviside(50.0).zx, PI * (1.0 - 2.0 * nu) / 4.0, 1e-12, "static zx");
        close(50.0 * plane.impulse(50.0).zz, 1.0 - nu, 1e-3, "static zz");
        let (before, after) = (3.0 * arrival * (1.0 - 1e-14), 3.0 * arrival * (1.0 + 1e-14));
        for read in [HalfPlane::first_tail, HalfPlane::second_tail] {
            let (one, two) = (read(&plane, before), read(&plane, after));
            close(one.zz, two.zz, 1e-11, &format!("late zz {nu}"));
            close(one.xx, two.xx, 1e-11, &format!("late xx {nu}"));
        }
    }
}

fn lamb() -> [(f64, [&'static str; 3]); 3] {
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

/// Columns of these tables: xy is x due to z load, yx is z due to x load.
#[test]
fn lamb_line_load_and_elements() {
    for (nu, [heaviside, element, galerkin]) in lamb() {
        let plane = HalfPlane::new(soil(nu));
        for row in rows(heaviside) {
            let u = plane.displacement([1.0, 0.0], row[0], LoadHistory::Step).unwrap();
            let what = format!("heaviside {nu} {}", row[0]);
            for (found, expected) in
                [(u[0][0], row[1]), (u[0][1], row[2]), (u[1][0], row[3]), (u[1][1], row[4])]
            {
                close(found, expected, 1e-11, &what);
            }
        }
        let receiver = |d: f64| ContactElement::new(d - 0.5, d + 0.5);
        for row in rows(galerkin) {
            let u = plane.element_mean(receiver(row[0]), receiver(0.0), row[1]).unwrap();
            let what = format!("galerkin {nu} {row:?}");
            for (found, expected) in
                [(u.xx, row[2]), (-u.zx, row[3]), (u.zx, row[4]), (u.zz, row[5])]
            {
                close(found, expected, 1e-11, &what);
            }
        }
        // Traction on [−1/2, 1/2], receiver a point: differences of ∫₀^X u dx, which is Q for an
        // impulse and X F + t Q for a load H(t).
        for row in rows(element).iter().filter(|row| row[0] >= 0.0) {
            let sides = [row[1] + 0.5, row[1] - 0.5].map(|x: f64| {
                if x == 0.0 {
                    return [0.0; 3];
                }
                let tau = row[2] / x.abs();
                let (f, q) = (plane.heaviside(tau), plane.first_tail(tau));
                let join = |f: f64, q: f64| {
                    if row[0] == 1.0 { q } else { x.abs() * f + row[2] * q }
                };
                let even = x.signum() / PI;
                [join(f.xx, q.xx) * even, join(f.zz, q.zz) * even, join(f.zx, q.zx) / PI]
            });
            let what = format!("element {nu} {row:?}");
            for (i, expected) in [row[3], row[6], row[5]].into_iter().enumerate() {
                close(sides[0][i] - sides[1][i], expected, 1e-11, &what);
            }
        }
    }
}

/// Each load is the time derivative of the next.
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
            let at = |time: f64| plane.displacement([x, 0.0], time, slow).unwrap();
            let (before, after) = (at(time - h), at(time + h));
            let rate = plane.displacement([x, 0.0], time, fast).unwrap();
            for i in 0..2 {
                for j in 0..2 {
                    let found = (after[i][j] - before[i][j]) / (2.0 * h);
                    let what = format!("{slow:?} {x} {time} {i} {j}");
                    close(found, rate[i][j], 2e-7, &what);
                }
            }
        }
    }
}

#[test]
fn full_plane_test_vectors() {
    for row in rows(include_str!("../data/es_fullplane_testvectors.csv")) {
        let ground = Soil::from_wave_speeds(row[2], row[1], row[0]).unwrap();
        let plane = FullPlane::new(ground);
        let (offset, normal, time) = ([row[3], row[4]], [row[5], row[6]], row[7]);
        let load = if row[8] == 0.0 { LoadHistory::Step } else { LoadHistory::Ramp };
        let u = plane.displacement(offset, time, load).unwrap();
        let t = plane.traction(offset, normal, time, load).unwrap();
        let d = plane.displacement(offset, time, LoadHistory::Impulse).unwrap();
        for (block, found) in [(9, u), (13, t), (17, d)] {
            let expected = &row[block..block + 4];
            let size = expected.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for (i, expected) in expected.iter().enumerate() {
                let value = found[i / 2][i % 2];
                close(value, *expected, 1e-10 * size + 1e-14, &format!("{block} {i} {row:?}"));
            }
        }
    }
}

/// Traction by finite differences of the displacement, Kelvin's limit, time derivatives.
#[test]
fn full_plane_is_consistent() {
    let ground = Soil::new(2.0, 0.3, 1.5).unwrap();
    let plane = FullPlane::new(ground);
    let (x, n, h) = ([0.7, -0.4], [0.6, 0.8], 1e-5);
    let (mu, lame) = (2.0, 2.0 * 2.0 * 0.3 / 0.4);
    for load in [LoadHistory::Impulse, LoadHistory::Step, LoadHistory::Ramp] {
        for time in [0.3, 0.5, 0.9, 30.0] {
            let u = |dx: f64, dz: f64| plane.displacement([x[0] + dx, x[1] + dz], time, load);
            let (xp, xm) = (u(h, 0.0).unwrap(), u(-h, 0.0).unwrap());
            let (zp, zm) = (u(0.0, h).unwrap(), u(0.0, -h).unwrap());
            let t = plane.traction(x, n, time, load).unwrap();
            let size = t.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
            for j in 0..2 {
                let slope = |i: usize, k: usize| {
                    let (p, m) = if k == 0 { (xp, xm) } else { (zp, zm) };
                    (p[i][j] - m[i][j]) / (2.0 * h)
                };
                for i in 0..2 {
                    let mut expected = lame * (slope(0, 0) + slope(1, 1)) * n[i];
                    for k in 0..2 {
                        expected += mu * (slope(i, k) + slope(k, i)) * n[k];
                    }
                    let what = format!("{load:?} {time} {i} {j}");
                    close(t[i][j], expected, 2e-8 * size.max(0.1), &what);
                }
            }
        }
    }
    // Kelvin: χ → −1/(8πμ(1−ν)), so u_xz → e_x e_z/(8πμ(1−ν)), to rounding at very late times.
    let late = plane.displacement(x, 1e9, LoadHistory::Step).unwrap();
    let kelvin = -0.28 / 0.65 / (8.0 * PI * mu * 0.7);
    close(late[0][1], kelvin, 1e-16, "Kelvin");
    let first = plane.traction(x, n, 1e7, LoadHistory::Step).unwrap();
    let second = plane.traction(x, n, 1e9, LoadHistory::Step).unwrap();
    close(first[0][1], second[0][1], 1e-13, "late traction");
}

/// Navier's equation for every load: the divergence of the tractions of the ramp is the density
/// times its second time derivative, the impulse. And reciprocity: u_ij(x) = u_ji(−x).
#[test]
fn full_plane_obeys_navier_and_reciprocity() {
    for (mu, nu, density) in [(2.0, 0.3, 1.5), (1.0, 0.0, 1.0), (3.0, 0.45, 0.7)] {
        let plane = FullPlane::new(Soil::new(mu, nu, density).unwrap());
        let h = 1e-4;
        for (x, time) in [([0.7, -0.4], 0.55), ([0.7, -0.4], 1.4), ([-0.2, 0.9], 2.5)] {
            let inertia = plane.displacement(x, time, LoadHistory::Impulse).unwrap();
            let size = inertia.iter().flatten().fold(0.1_f64, |m, v| m.max(v.abs()));
            let stress = |dx: f64, dz: f64, normal: [f64; 2]| {
                plane.traction([x[0] + dx, x[1] + dz], normal, time, LoadHistory::Ramp).unwrap()
            };
            let (right, left) = (stress(h, 0.0, [1.0, 0.0]), stress(-h, 0.0, [1.0, 0.0]));
            let (down, up) = (stress(0.0, h, [0.0, 1.0]), stress(0.0, -h, [0.0, 1.0]));
            for i in 0..2 {
                for j in 0..2 {
                    let found = (right[i][j] - left[i][j] + down[i][j] - up[i][j]) / (2.0 * h);
                    let what = format!("Navier {nu} {x:?} {time} {i} {j}");
                    close(found, density * inertia[i][j], 1e-5 * density * size, &what);
                }
            }
            for load in [LoadHistory::Impulse, LoadHistory::Step, LoadHistory::Ramp] {
                let there = plane.displacement(x, time, load).unwrap();
                let back = plane.displacement([-x[0], -x[1]], time, load).unwrap();
                for i in 0..2 {
                    for j in 0..2 {
                        assert_eq!(there[i][j], back[j][i], "reciprocity {load:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn nothing_arrives_early_and_bad_input_is_refused() {
    for nu in POISSON {
        let ground = soil(nu);
        let near = ContactElement::new(0.0, 1.0);
        let far = ContactElement::new(11.0, 12.0);
        let kernel = InfluenceKernel::new(ground, 0.01).unwrap();
        let at = |lag| kernel.coefficients(far, near, lag).unwrap();
        let quiet = at(9);
        if ground.pressure_wave_speed() < 100.0 {
            assert_eq!((quiet.zz, quiet.xx, quiet.zx), (0.0, 0.0, 0.0));
        }
        // The last lag of the coupling, and reciprocity.
        let patch = PatchKernel::new(ground, vec![near, far], 0.01).unwrap();
        let apart = |class: &usize| patch.classes().representative(*class) == Ok([near, far]);
        let class = (0..patch.classes().count()).find(apart).unwrap();
        let last = patch.last_coupling_lag(class).unwrap().unwrap();
        assert!(at(last).zx != 0.0 && at(last + 1).zx == 0.0);
        for lag in [1, 300, 1000, 1190, 5000] {
            let (one, two) = (at(lag), kernel.coefficients(near, far, lag).unwrap());
            assert_eq!((one.zz, one.xx, one.zx), (two.zz, two.xx, -two.zx));
        }
        let mut noise = [[7.0; 4]; 3];
        let [zz, xx, zx] = &mut noise;
        patch.coefficients(class, 1100, &mut [zz, xx, zx]).unwrap();
        assert_eq!(noise[0][2], at(1102).zz);
        assert_eq!(noise[2][2], at(1102).zx);
    }
    let ground = soil(0.3);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(InfluenceKernel::new(ground, bad).is_err());
    }
    let kernel = InfluenceKernel::new(ground, 0.1).unwrap();
    let good = ContactElement::new(0.0, 1.0);
    for bad in [(0.0, 0.0), (1.0, 0.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
        let bad = ContactElement::new(bad.0, bad.1);
        assert!(kernel.coefficients(good, bad, 1).is_err());
        assert!(HalfPlane::new(ground).element_mean(bad, good, 1.0).is_err());
    }
    assert!(kernel.coefficients(good, good, 0).is_err());
    let plane = HalfPlane::new(ground);
    assert!(plane.displacement([1.0, 0.5], 1.0, LoadHistory::Step).is_err());
    assert!(plane.displacement([0.0, 0.0], 1.0, LoadHistory::Step).is_err());
    assert!(FullPlane::new(ground).displacement([0.0, 0.0], 1.0, LoadHistory::Step).is_err());
}
