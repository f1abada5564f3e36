//! Estimated condition numbers against those of the inverse.

use super::*;
use crate::linalg::Triplets;
use basemat_problems::random::Random;

#[test]
fn estimates_are_within_a_factor_of_three_of_the_inverse() {
    let mut random = Random(3);
    let mut worst = 1.0_f64;
    for case in 0..400 {
        let n = 1 + case % 12;
        // Any condition, any units.
        let own = random.log_within(1e-10, 1.0);
        let units: Vec<f64> = (0..n).map(|_| random.log_within(1e-6, 1e6)).collect();
        let root: Vec<f64> = (0..n * n).map(|_| random.within(-1.0, 1.0)).collect();
        let skew = if case % 3 == 0 { 0.5 } else { 0.0 };
        let mut matrix = vec![0.0; n * n];
        for (i, j) in (0..n * n).map(|k| (k / n, k % n)) {
            // One direction is as good as missing.
            let product: f64 = (1..n).map(|k| root[i * n + k] * root[j * n + k]).sum();
            let rest = if i == j { own } else { skew * root[i.min(j) * n + i.max(j)] };
            let sign = if i < j { -1.0 } else { 1.0 };
            matrix[i * n + j] = (product + sign * rest) * units[i] * units[j];
            if i == j {
                matrix[i * n + j] = matrix[i * n + j].abs();
            }
        }
        let exact = basemat_problems::dense::condition_by_inverse(&matrix, n);
        let mut triplets = Triplets::new(n);
        for (k, value) in matrix.iter().enumerate() {
            triplets.add(k / n, k % n, *value);
        }
        let sparse = SparseMatrix::new("test", &triplets).unwrap();
        let mut factor = SparseFactor::new("test", &triplets).unwrap();
        for found in [dense_condition(&matrix, n), sparse_condition(&sparse, &mut factor)] {
            // A lower bound but for rounding, and seldom far below.
            let ratio = exact / found;
            assert!(ratio > 0.99 && ratio < 3.0, "{case}: {found:e} for {exact:e}");
            worst = worst.max(ratio);
        }
    }
    println!("exact over estimate: {worst} at most");
}

#[test]
fn singular_and_diagonal_matrices_have_their_conditions() {
    assert!((dense_condition(&[1e-9, 0.0, 0.0, 1e9], 2) - 1.0).abs() < 1e-15);
    assert_eq!(dense_condition(&[1.0, 2.0, 2.0, 4.0], 2), f64::INFINITY);
    assert_eq!(dense_condition(&[0.0; 4], 2), f64::INFINITY);
    assert_eq!(dense_condition(&[], 0), 1.0);
}
