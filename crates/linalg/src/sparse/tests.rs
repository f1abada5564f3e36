//! Factors of small matrices, and the rows of indefinite ones.

use super::*;

fn ladder(order: usize, asymmetry: f64) -> Triplets {
    let mut matrix = Triplets::new(order);
    for i in 0..order {
        matrix.add(i, i, 3.0 + i as f64);
        if i > 0 {
            matrix.add(i, i - 1, -1.0 + asymmetry);
            matrix.add(i - 1, i, -0.5);
            matrix.add(i - 1, i, -0.5 - asymmetry);
        }
    }
    matrix
}

#[test]
fn sparse_factors_solve_symmetric_and_unsymmetric() {
    for asymmetry in [0.0, 0.3] {
        let triplets = ladder(40, asymmetry);
        let matrix = SparseMatrix::new("test", &triplets).unwrap();
        let x: Vec<f64> = (0..40).map(|i| f64::from(i).sin()).collect();
        let mut rhs = vec![0.0; 40];
        matrix.multiply_add(1.0, &x, &mut rhs);
        let mut factor = SparseFactor::new("test", &triplets).unwrap();
        assert_eq!(matches!(factor.factors, Factors::Cholesky { .. }), asymmetry == 0.0);
        factor.solve(&mut rhs);
        for (a, b) in rhs.iter().zip(&x) {
            assert!((a - b).abs() < 1e-13);
        }
    }
}

/// A chain with one negative spring is indefinite, although every diagonal entry is positive.
#[test]
fn indefinite_matrices_have_an_indefinite_row() {
    for (negative_spring, tolerance) in [(None, 1e-12), (Some(17), 1e-12), (Some(17), 1e-6)] {
        let mut chain = Triplets::new(40);
        chain.add(0, 0, 5.0e6);
        for i in 1..40 {
            chain.add_spring(i - 1, i, if Some(i) == negative_spring { -1.0e5 } else { 4.0e6 });
        }
        let matrix = SparseMatrix::new("test", &chain).unwrap();
        assert_eq!(
            indefinite_row(&matrix, tolerance, 1e-6, &Elimination::default()).is_some(),
            negative_spring.is_some()
        );
        assert!(matrix.diagonal().iter().all(|k| *k > 0.0));
    }
    let row_of_entries = |entries: &[(usize, usize, f64)]| {
        let mut matrix = Triplets::new(3);
        for &(i, j, value) in entries {
            matrix.add(i, j, value);
        }
        let matrix = SparseMatrix::new("test", &matrix).unwrap();
        indefinite_row(&matrix, 1e-6, 1e-12, &Elimination::default())
    };
    assert_eq!(row_of_entries(&[(0, 0, 1.0), (1, 1, -1e-3)]), Some(1));
    assert_eq!(row_of_entries(&[(0, 0, 1.0), (0, 2, 1e-3), (2, 0, 1e-3)]), Some(2));
    assert_eq!(row_of_entries(&[(0, 0, 1e-4), (0, 2, 1e-3), (2, 0, 1e-3), (2, 2, 1e-3)]), Some(0));
    // The row of the most negative entry is returned.
    assert_eq!(row_of_entries(&[(0, 0, 1.0), (1, 1, -1e-9), (2, 2, -1e-3)]), Some(2));
    // A negative entry is a rounding error if its magnitude is below the floor.
    for (value, expected_row) in [(0.99e-12, None), (1.01e-12, Some(1))] {
        assert_eq!(row_of_entries(&[(0, 0, 1.0), (1, 1, -value)]), expected_row);
    }
    for (value, expected_row) in [(0.99e-6, None), (1.01e-6, Some(1))] {
        assert_eq!(row_of_entries(&[(0, 0, 1.0), (0, 1, value), (1, 0, value)]), expected_row);
    }
    // Singular matrices may be semi-definite: with a row of zeros, or with one mass for a sum of degrees of freedom.
    assert_eq!(row_of_entries(&[(0, 0, 1.0)]), None);
    assert_eq!(row_of_entries(&[(0, 0, 4.0), (0, 1, 6.0), (1, 0, 6.0), (1, 1, 9.0)]), None);
}

#[test]
fn singular_and_invalid_matrices_are_errors() {
    let mut singular_matrix = Triplets::new(2);
    singular_matrix.add(0, 0, 1.0);
    assert!(matches!(SparseFactor::new("k", &singular_matrix), Err(Error::Singular { .. })));
    singular_matrix.add(1, 2, 1.0);
    assert!(matches!(SparseMatrix::new("k", &singular_matrix), Err(Error::Index { index: 2, .. })));
    let mut nan = Triplets::new(1);
    nan.add(0, 0, f64::NAN);
    assert!(matches!(SparseMatrix::new("k", &nan), Err(Error::Input { .. })));
}
