//! GOAL: coefficients of the time kernel keep their relative precision at every lag.
//! SCENE: pairs of elements on a line and above each other; closed polygons.
//! REFERENCE: quadrature with forty digits, rigid translations, causality.

use basemat::Error;
use basemat::bem::full_plane::{Segment, TimeKernel};

use super::{circle, coefficients, soil};
use basemat_problems::series::whole;
use basemat_problems::{close, table};

/// GOAL: coefficients keep their relative precision at early, middle and late lags.
/// REFERENCE: quadrature of the fundamental solution with 40 digits; elements on the receiver's
/// line and above it, dd, dn, nn of G and traction components dd, dn, nd, nn of H.
#[test]
fn coefficients_match_forty_digits() {
    let mut count = 0;
    for row in table("full_plane_coefficients.csv").rows([
        "nu", "s1", "s2", "h", "lag", "u_dd", "u_dn", "u_nn", "t_dd", "t_dn", "t_nd", "t_nn",
    ]) {
        let [nu, low, high, height, lag, wanted @ ..] = row;
        // d to the right, n up (−z): the receiver is at the origin, the source `height` above it.
        let source = Segment { from: [low, -height], to: [high, -height] };
        let receiver = Segment { from: [-0.01, 0.0], to: [0.01, 0.0] };
        let kernel = TimeKernel::new(soil(nu), &[receiver, source], 0.5).unwrap();
        let [g, h] = coefficients(&kernel, whole(lag));
        let at = |m: &[f64], i: usize, j: usize| m[(2 * i) * 4 + 2 * j + 1];
        let found = [
            at(&g, 0, 0),
            -at(&g, 0, 1),
            at(&g, 1, 1),
            at(&h, 0, 0),
            -at(&h, 1, 0),
            -at(&h, 0, 1),
            at(&h, 1, 1),
        ];
        // Components of one kind, displacement or traction, are of one size.
        for kind in [0..3, 3..7] {
            let size = wanted[kind.clone()].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for k in kind {
                close("coefficient", found[k], wanted[k], 2e-13 * size, 0.0);
                count += 1;
            }
        }
    }
    assert_eq!(count, 70);
}

/// GOAL: the paper's sub-elements tend to the exact integrals, slowly where a front is inside.
#[test]
fn subelements_tend_to_the_exact_integrals() {
    let ends = |low, high| Segment { from: [low, 0.0], to: [high, 0.0] };
    let pair = [ends(-0.5, 0.5), ends(2.5, 3.5)];
    let make = || TimeKernel::new(soil(0.25), &pair, 0.47).unwrap();
    // The shear wave is inside the element at lag 6; both waves are past at lag 12.
    for (lag, order) in [(6, 0.4), (12, 1.9)] {
        let exact = coefficients(&make(), lag);
        let error = |count: usize| {
            let rough = coefficients(&make().with_subelements(count).unwrap(), lag);
            let size = exact[1].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            exact[1].iter().zip(&rough[1]).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / size
        };
        let errors = [error(5), error(5000)];
        println!("lag {lag}: {errors:?}");
        assert!(errors[1] < errors[0] / 1000.0_f64.powf(order));
    }
    // No front inside: three Gauss points see the last digits that one point does not.
    let error = |points: usize| {
        let rough = coefficients(&make().with_gauss_subelements(5, points).unwrap(), 12);
        let exact = coefficients(&make(), 12);
        let size = exact[1].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        exact[1].iter().zip(&rough[1]).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / size
    };
    let errors = [1, 2, 3].map(error);
    println!("Gauss: {errors:?}");
    assert!(errors[1] < 1e-2 * errors[0] && errors[2] < 1e-4 * errors[0]);
    assert!(matches!(make().with_subelements(0), Err(Error::Input { .. })));
    for (count, points) in [(0, 2), (5, 0), (5, 9)] {
        let refused = make().with_gauss_subelements(count, points);
        assert!(matches!(refused, Err(Error::Input { .. })), "{count} {points}");
    }
}

/// GOAL: rigid translations: Σ H over lags and a closed polygon is 1 outside and 0 inside.
#[test]
fn rigid_motion_of_closed_polygons() {
    for (outside, wanted) in [(true, 1.0), (false, 0.0)] {
        let kernel = TimeKernel::new(soil(0.3), &circle(9, outside), 0.7).unwrap();
        let mut sum = [0.0; 18];
        for lag in 0..600 {
            let [_, h] = coefficients(&kernel, lag);
            for (sum, row) in sum.chunks_exact_mut(9).zip(h.chunks_exact(18 * 9)) {
                for (sum, row) in sum.iter_mut().zip(row.chunks_exact(18)) {
                    *sum += row[..9].iter().sum::<f64>();
                }
            }
        }
        // x-components of all elements move: the x rows see it, the z rows do not. The rest after a
        // time t falls like (r/ct)².
        for (k, sum) in sum.iter().enumerate() {
            close("row sum", *sum, if k < 9 { wanted } else { 0.0 }, 3e-5, 0.0);
        }
    }
}

#[test]
fn nothing_moves_before_the_pressure_wave() {
    let far = [
        Segment { from: [-0.5, 0.0], to: [0.5, 0.0] },
        Segment { from: [4.0, 3.0], to: [5.0, 3.5] },
    ];
    let kernel = TimeKernel::new(soil(0.0), &far, 0.1).unwrap();
    // 5 m at √2 m/s: 3.53 s.
    for lag in [0, 1, 20, 34] {
        let [g, h] = coefficients(&kernel, lag);
        for (i, j) in [(0, 1), (1, 0), (0, 3), (3, 0), (2, 3), (3, 2)] {
            assert_eq!([g[i * 4 + j], h[i * 4 + j]], [0.0; 2]);
        }
    }
    assert!(coefficients(&kernel, 36)[0][1] != 0.0);
}
