//! GOAL: coefficients of the time kernel keep their relative precision at every lag.
//! SCENE: pairs of elements on a line and above each other; closed polygons.
//! REFERENCE: quadrature with forty digits, rigid translations, causality.

use basemat::Error;
use basemat::bem::full_plane::{Segment, TimeKernel};

use super::{circle, coefficients, soil};
use basemat_problems::dense::largest;
use basemat_problems::series::nearest_integer;
use basemat_problems::{assert_close, table};

/// Entry of a matrix of two elements: components i of the first by components j of the second.
fn entry_of_pair(matrix: &[f64], i: usize, j: usize) -> f64 {
    matrix[(2 * i) * 4 + 2 * j + 1]
}

/// Largest difference of entries, relative to the largest entry of the exact matrix.
fn relative_error(computed: &[f64], expected: &[f64]) -> f64 {
    let size = largest(expected);
    expected.iter().zip(computed).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / size
}

/// GOAL: coefficients keep their relative precision at early, middle and late lags.
/// REFERENCE: quadrature of the fundamental solution with 40 digits; elements on the receiver's
/// line and above it, dd, dn, nn of G and traction components dd, dn, nd, nn of H.
#[test]
fn coefficients_match_forty_digits() {
    let mut count = 0;
    for [nu, low, high, height, lag, expected @ ..] in table("full_plane_coefficients.csv").rows([
        "nu", "s1", "s2", "h", "lag", "u_dd", "u_dn", "u_nn", "t_dd", "t_dn", "t_nd", "t_nn",
    ]) {
        // d to the right, n up (−z): the receiver is at the origin, the source `height` above it.
        let source = Segment { from: [low, -height], to: [high, -height] };
        let receiver = Segment { from: [-0.01, 0.0], to: [0.01, 0.0] };
        let kernel = TimeKernel::new(soil(nu), &[receiver, source], 0.5).unwrap();
        let matrices = coefficients(&kernel, nearest_integer(lag));
        let computed = [
            entry_of_pair(&matrices.g, 0, 0),
            -entry_of_pair(&matrices.g, 0, 1),
            entry_of_pair(&matrices.g, 1, 1),
            entry_of_pair(&matrices.h, 0, 0),
            -entry_of_pair(&matrices.h, 1, 0),
            -entry_of_pair(&matrices.h, 0, 1),
            entry_of_pair(&matrices.h, 1, 1),
        ];
        // Components of one kind, displacement or traction, are of one size.
        for kind in [0..3, 3..7] {
            let size = largest(&expected[kind.clone()]);
            for k in kind {
                assert_close("coefficient", computed[k], expected[k], 2e-13 * size, 0.0);
                count += 1;
            }
        }
    }
    assert_eq!(count, 70);
}

/// GOAL: the paper's sub-elements converge to the exact integrals, slowly where a front is inside.
#[test]
fn subelements_converge_to_the_exact_integrals() {
    let pair = [
        Segment { from: [-0.5, 0.0], to: [0.5, 0.0] },
        Segment { from: [2.5, 0.0], to: [3.5, 0.0] },
    ];
    let kernel = || TimeKernel::new(soil(0.25), &pair, 0.47).unwrap();
    // The shear wave is inside the element at lag 6; both waves have passed at lag 12.
    for (lag, order) in [(6, 0.4), (12, 1.9)] {
        let expected = coefficients(&kernel(), lag);
        let errors = [5, 5000].map(|count| {
            let approximate = coefficients(&kernel().with_subelements(count).unwrap(), lag);
            relative_error(&approximate.h, &expected.h)
        });
        println!("lag {lag}: {errors:?}");
        assert!(errors[1] < errors[0] / 1000.0_f64.powf(order));
    }
    // No front is inside: three Gauss points resolve the last digits that one point does not.
    let expected = coefficients(&kernel(), 12);
    let errors = [1, 2, 3].map(|points| {
        let approximate = coefficients(&kernel().with_gauss_subelements(5, points).unwrap(), 12);
        relative_error(&approximate.h, &expected.h)
    });
    println!("Gauss: {errors:?}");
    assert!(errors[1] < 1e-2 * errors[0] && errors[2] < 1e-4 * errors[0]);
    assert!(matches!(kernel().with_subelements(0), Err(Error::Input { .. })));
    for (count, points) in [(0, 2), (5, 0), (5, 9)] {
        let result = kernel().with_gauss_subelements(count, points);
        assert!(matches!(result, Err(Error::Input { .. })), "{count} {points}");
    }
}

/// GOAL: in rigid translations of a closed polygon Σ H over all lags is 1 outside and 0 inside.
#[test]
fn sums_over_closed_polygons_are_one_outside_and_zero_inside() {
    for (outside, x_row_sum) in [(true, 1.0), (false, 0.0)] {
        let kernel = TimeKernel::new(soil(0.3), &circle(9, outside), 0.7).unwrap();
        let mut sums = [0.0; 18];
        for lag in 0..600 {
            let matrices = coefficients(&kernel, lag);
            for (sum, row) in sums.iter_mut().zip(matrices.h.chunks_exact(18)) {
                *sum += row[..9].iter().sum::<f64>();
            }
        }
        // All elements move along x: the rows of x sum to the free term, and the rows of z to zero. The
        // remainder after a time t decreases like (r/ct)².
        for (k, sum) in sums.iter().enumerate() {
            assert_close("row sum", *sum, if k < 9 { x_row_sum } else { 0.0 }, 3e-5, 0.0);
        }
    }
}

/// GOAL: two elements do not act on each other before the pressure wave arrives.
#[test]
fn coefficients_are_zero_before_the_pressure_wave() {
    let distant_pair = [
        Segment { from: [-0.5, 0.0], to: [0.5, 0.0] },
        Segment { from: [4.0, 3.0], to: [5.0, 3.5] },
    ];
    let kernel = TimeKernel::new(soil(0.0), &distant_pair, 0.1).unwrap();
    // 5 m at √2 m/s: 3.53 s.
    for lag in [0, 1, 20, 34] {
        let matrices = coefficients(&kernel, lag);
        for (i, j) in [(0, 1), (1, 0), (0, 3), (3, 0), (2, 3), (3, 2)] {
            assert_eq!([matrices.g[i * 4 + j], matrices.h[i * 4 + j]], [0.0; 2]);
        }
    }
    assert!(coefficients(&kernel, 36).g[1] != 0.0);
}
