//! Factors of changing matrices beside new factors.

use super::*;
use crate::Triplets;

/// Grid of springs to near neighbours, with stiffnesses between `min_stiffness` and 1, and an unsymmetric part.
fn grid(side: usize, seed: f64, min_stiffness: f64, asymmetry: f64) -> SparseMatrix {
    let mut matrix = Triplets::new(side * side);
    for v in 0..side * side {
        matrix.add(v, v, 0.1);
        let stiffness = min_stiffness + (seed + v as f64).sin().abs() * (1.0 - min_stiffness);
        // Many neighbours: the factor of a large grid then has dense blocks.
        for [x, y] in (1..16).map(|k| [v % side + k % 4, v / side + k / 4]) {
            if x < side && y < side {
                matrix.add_spring(v, x + side * y, stiffness);
                matrix.add(v, x + side * y, asymmetry);
            }
        }
    }
    SparseMatrix::new("grid", &matrix).unwrap()
}

/// Checks that no value differs by more than rounding of the largest.
fn assert_near(computed: &[f64], expected: &[f64]) {
    let max_magnitude = expected.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
    let differences = computed.iter().zip(expected).map(|(a, b)| (a - b).abs());
    assert!(differences.fold(0.0, f64::max) < 1e-10 * max_magnitude);
}

/// REFERENCE: a new factor of each matrix, to the last bit where it is Cholesky's.
#[test]
fn changing_factors_are_new_factors() {
    for side in [5, 40] {
        let elimination = Elimination::default();
        let first_matrix = grid(side, 0.0, 0.5, 0.0);
        let mut changing_factor = ChangingFactor::new("grid", &first_matrix, &elimination).unwrap();
        // Symmetric, unsymmetric, indefinite and symmetric again.
        let cases = [(0.1, 0.0), (0.5, 0.2), (-0.9, 0.0), (0.3, 0.0), (0.3, -0.1)];
        for (k, (min_stiffness, asymmetry)) in (0..).zip(cases) {
            let matrix = grid(side, f64::from(k), min_stiffness, asymmetry);
            changing_factor.refactor(&matrix).unwrap();
            let new_factor = SparseFactor::with_elimination("grid", &matrix, &elimination).unwrap();
            let is_definite = changing_factor.factor().unwrap().is_positive_definite();
            assert_eq!(is_definite, new_factor.is_positive_definite());
            assert_eq!(is_definite, min_stiffness > 0.0 && asymmetry == 0.0);
            let right_sides: Vec<f64> = (0..7 * side * side).map(|i| (i as f64).sin()).collect();
            let mut computed = right_sides.clone();
            let mut expected = right_sides.clone();
            changing_factor.solve_many(&mut computed);
            new_factor.solve_many(&mut expected);
            if is_definite {
                assert_eq!(computed, expected);
            } else {
                assert_near(&computed, &expected);
                assert_eq!(changing_factor.method == Method::BlockLu, side == 40);
                let mut computed = right_sides[..side * side].to_vec();
                let mut expected = computed.clone();
                changing_factor.factor().unwrap().solve_transposed(&mut computed);
                new_factor.solve_transposed(&mut expected);
                assert_near(&computed, &expected);
            }
            let residual = matrix.times(&computed[..side * side]);
            let error = residual.iter().enumerate().map(|(i, r)| (r - (i as f64).sin()).abs());
            assert!(error.fold(0.0, f64::max) < 1e-9);
        }
        // Solutions on the last rows alone.
        let last_rows: Vec<usize> = (0..side).map(|k| k * side + (k * k) % side).collect();
        let mut ending_factor =
            ChangingFactor::ending_with("grid", &first_matrix, &elimination, &last_rows).unwrap();
        for (min_stiffness, asymmetry) in [(0.2, 0.0), (0.2, 0.1), (-0.9, 0.0), (0.4, 0.0)] {
            let matrix = grid(side, 0.7, min_stiffness, asymmetry);
            ending_factor.refactor(&matrix).unwrap();
            changing_factor.refactor(&matrix).unwrap();
            let mut last_values: Vec<f64> = (0..3 * side).map(|i| (i as f64).cos()).collect();
            for (k, column) in last_values.clone().chunks_exact(side).enumerate() {
                let mut full_solution = vec![0.0; side * side];
                last_rows.iter().zip(column).for_each(|(row, value)| full_solution[*row] = *value);
                changing_factor.solve(&mut full_solution);
                ending_factor.solve_on_last_rows(&mut last_values[k * side..][..side]);
                for (row, value) in last_rows.iter().zip(&last_values[k * side..]) {
                    assert!(
                        (full_solution[*row] - value).abs() < 1e-9,
                        "{} {value}",
                        full_solution[*row]
                    );
                }
            }
        }
        assert!(ending_factor.last_entries.is_some());
        let zero_matrix = grid(side, 0.0, 0.0, 0.0);
        let mut singular_matrix = zero_matrix.clone();
        singular_matrix.values.fill(0.0);
        assert!(matches!(changing_factor.refactor(&singular_matrix), Err(Error::Singular { .. })));
        changing_factor.refactor(&first_matrix).unwrap();
    }
}

/// REFERENCE: whole solutions in another order, for two right-hand sides at once.
#[test]
fn last_rows_of_uncoupled_parts_have_a_dense_block() {
    let side = 40;
    let first_part = grid(side, 0.0, 0.5, 0.0);
    let first_order = side * side;
    let order = first_order + 3;
    let mut triplets = Triplets::new(order);
    for (row, column, value) in first_part.entries() {
        triplets.add(row, column, value);
    }
    for row in first_order..order {
        for column in first_order..order {
            triplets.add(row, column, if row == column { 2.0 } else { 0.5 });
        }
    }
    let matrix = SparseMatrix::new("parts", &triplets).unwrap();
    let last_rows: Vec<usize> = (0..side).map(|k| k * side + k).chain(first_order..order).collect();
    let elimination = Elimination::default();
    let mut factor =
        ChangingFactor::ending_with("parts", &matrix, &elimination, &last_rows).unwrap();
    assert!(factor.last_entries.is_some());
    let count = last_rows.len();
    let forces: Vec<f64> = (0..2 * count).map(|i| (i as f64).cos()).collect();
    let mut computed = forces.clone();
    factor.solve_on_last_rows(&mut computed);
    let other_factor = SparseFactor::with_elimination("parts", &matrix, &elimination).unwrap();
    let mut expected = vec![0.0; 2 * order];
    for (solution, forces) in expected.chunks_exact_mut(order).zip(forces.chunks_exact(count)) {
        last_rows.iter().zip(forces).for_each(|(row, force)| solution[*row] = *force);
    }
    other_factor.solve_many(&mut expected);
    let expected: Vec<f64> = expected
        .chunks_exact(order)
        .flat_map(|solution| last_rows.iter().map(|row| solution[*row]))
        .collect();
    assert_near(&computed, &expected);
}
