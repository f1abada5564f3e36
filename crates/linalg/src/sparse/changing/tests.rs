//! Factors of changing matrices beside new factors.

use super::*;
use crate::Triplets;

/// Grid of springs to near neighbours, with stiffnesses between `low` and 1, and an unsymmetric part.
fn grid(side: usize, seed: f64, low: f64, skew: f64) -> SparseMatrix {
    let mut matrix = Triplets::new(side * side);
    for v in 0..side * side {
        matrix.add(v, v, 0.1);
        let stiffness = low + (seed + v as f64).sin().abs() * (1.0 - low);
        // Many neighbours: the factor of a large grid then has dense blocks.
        for [x, y] in (1..16).map(|k| [v % side + k % 4, v / side + k / 4]) {
            if x < side && y < side {
                matrix.add_spring(v, x + side * y, stiffness);
                matrix.add(v, x + side * y, skew);
            }
        }
    }
    SparseMatrix::new("grid", &matrix).unwrap()
}

/// REFERENCE: a new factor of each matrix, to the last bit.
#[test]
fn changing_factors_are_new_factors() {
    for side in [5, 40] {
        let elimination = Elimination::default();
        let first = grid(side, 0.0, 0.5, 0.0);
        let mut changing = ChangingFactor::new("grid", &first, &elimination).unwrap();
        // Symmetric, unsymmetric, indefinite and symmetric again.
        let cases = [(0.1, 0.0), (0.5, 0.2), (-0.9, 0.0), (0.3, 0.0), (0.3, -0.1)];
        for (k, (low, skew)) in (0..).zip(cases) {
            let matrix = grid(side, f64::from(k), low, skew);
            changing.refactor(&matrix).unwrap();
            let new = SparseFactor::with_elimination("grid", &matrix, &elimination).unwrap();
            let is_definite = changing.factor().unwrap().is_positive_definite();
            assert_eq!(is_definite, new.is_positive_definite());
            assert_eq!(is_definite, low > 0.0 && skew == 0.0);
            let many: Vec<f64> = (0..7 * side * side).map(|i| (i as f64).sin()).collect();
            let mut a = many.clone();
            let mut b = many.clone();
            changing.solve_many(&mut a);
            new.solve_many(&mut b);
            if is_definite {
                assert_eq!(a, b);
            } else {
                let largest = b.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
                let differences = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
                assert!(differences.fold(0.0, f64::max) < 1e-10 * largest);
                let is_by_blocks = changing.method == Method::BlockLu;
                assert_eq!(is_by_blocks, side == 40);
                let factor = changing.factor().unwrap();
                let mut a = many[..side * side].to_vec();
                let mut b = a.clone();
                factor.solve_transposed(&mut a);
                new.solve_transposed(&mut b);
                let differences = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
                assert!(differences.fold(0.0, f64::max) < 1e-10 * largest);
            }
            let residual = matrix.times(&a[..side * side]);
            let error = residual.iter().enumerate().map(|(i, r)| (r - (i as f64).sin()).abs());
            assert!(error.fold(0.0, f64::max) < 1e-9);
        }
        // On the last rows, with a dense block or without.
        let last_rows: Vec<usize> = (0..side).map(|k| k * side + (k * k) % side).collect();
        let mut ending =
            ChangingFactor::ending_with("grid", &first, &elimination, &last_rows).unwrap();
        for (low, skew) in [(0.2, 0.0), (0.2, 0.1), (-0.9, 0.0), (0.4, 0.0)] {
            let matrix = grid(side, 0.7, low, skew);
            ending.refactor(&matrix).unwrap();
            changing.refactor(&matrix).unwrap();
            let mut on_last: Vec<f64> = (0..3 * side).map(|i| (i as f64).cos()).collect();
            for (k, column) in on_last.clone().chunks_exact(side).enumerate() {
                let mut whole = vec![0.0; side * side];
                last_rows.iter().zip(column).for_each(|(row, value)| whole[*row] = *value);
                changing.solve(&mut whole);
                ending.solve_on_last_rows(&mut on_last[k * side..][..side]);
                for (row, value) in last_rows.iter().zip(&on_last[k * side..]) {
                    assert!((whole[*row] - value).abs() < 1e-9, "{} {value}", whole[*row]);
                }
            }
        }
        assert_eq!(ending.last_entries.is_some(), side == 40);
        let zero = grid(side, 0.0, 0.0, 0.0);
        let mut singular = zero.clone();
        singular.values.fill(0.0);
        assert!(matches!(changing.refactor(&singular), Err(Error::Singular { .. })));
        changing.refactor(&first).unwrap();
    }
}
