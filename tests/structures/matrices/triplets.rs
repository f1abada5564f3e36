//! GOAL: matrices from entries, dense arrays and compressed rows.
//! SCENE: any matrix; wrong lengths, pointers and columns.
//! REFERENCE: the dense matrix.

use basemat::Error;
use basemat::structure::Triplets;
use proptest::prelude::*;

fn dense(matrix: &Triplets) -> Vec<f64> {
    let order = matrix.order();
    let mut values = vec![0.0; order * order];
    for &(row, column, value) in matrix.entries() {
        values[row * order + column] += value;
    }
    values
}

proptest! {
    #[test]
    fn all_constructors_give_the_same_matrix(
        order in 1_usize..7,
        numbers in prop::collection::vec(prop_oneof![Just(0.0), -1e3..1e3], 36),
    ) {
        let values = &numbers[..order * order];
        let matrix = Triplets::from_dense(order, values).unwrap();
        prop_assert_eq!(&dense(&matrix)[..], values);

        let mut pointers = vec![0];
        let mut columns = vec![];
        let mut nonzero_entries = vec![];
        for row in values.chunks(order) {
            // From right to left: any order within a row is valid.
            for (column, value) in row.iter().enumerate().rev().filter(|(_, v)| **v != 0.0) {
                columns.push(column);
                nonzero_entries.push(*value);
            }
            pointers.push(columns.len());
        }
        let compressed = Triplets::from_csr(order, &pointers, &columns, &nonzero_entries).unwrap();
        prop_assert_eq!(&dense(&compressed)[..], values);

        let copied_matrix = Triplets::from_entries(order, matrix.entries().iter().copied());
        prop_assert_eq!(&copied_matrix, &matrix);
        let mut extended_matrix = Triplets::new(order);
        extended_matrix.extend(matrix.entries().iter().copied());
        prop_assert_eq!(&extended_matrix, &matrix);
        let collected: Triplets = matrix.entries().iter().copied().collect();
        prop_assert_eq!(collected.entries(), matrix.entries());
        prop_assert!(collected.order() <= order);
    }
}

#[test]
fn entries_at_the_same_place_add_up_and_invalid_ones_are_kept() {
    let repeated_entry = Triplets::from_csr(1, &[0, 2], &[0, 0], &[1.0, 2.0]).unwrap();
    assert_eq!(dense(&repeated_entry), [3.0]);
    // Values that are not finite are errors where the matrix is used, as with `add`.
    assert!(Triplets::from_dense(1, &[f64::NAN]).unwrap().entries()[0].2.is_nan());
    assert_eq!(Triplets::from_iter([(usize::MAX, 0, 1.0)]).order(), usize::MAX);
    assert_eq!(Triplets::from_iter([]).order(), 0);
    assert_eq!(Triplets::from_csr(0, &[0], &[], &[]).unwrap(), Triplets::new(0));
    assert_eq!(Triplets::from_dense(0, &[]).unwrap(), Triplets::new(0));
}

fn csr_error(order: usize, pointers: &[usize], columns: &[usize], values: usize) -> Error {
    Triplets::from_csr(order, pointers, columns, &vec![1.0; values]).unwrap_err()
}

fn size_error(quantity: &'static str, found: usize, needed: usize) -> Error {
    Error::Size { quantity, found, needed }
}

fn index_error(quantity: &'static str, index: usize, bound: usize) -> Error {
    Error::Index { quantity, index, bound }
}

#[test]
fn invalid_arrays_are_errors() {
    for (order, count) in [(2, 3), (0, 1), (usize::MAX, 4), (3, 0)] {
        let Err(Error::Size { quantity, found, .. }) =
            Triplets::from_dense(order, &vec![1.0; count])
        else {
            panic!("{order} {count}")
        };
        assert_eq!((quantity, found), ("dense matrix", count));
    }
    assert_eq!(csr_error(2, &[0, 1], &[0], 1), size_error("list of row pointers", 2, 3));
    assert_eq!(
        csr_error(usize::MAX, &[], &[], 0),
        size_error("list of row pointers", 0, usize::MAX)
    );
    assert_eq!(csr_error(2, &[0, 1, 2], &[0], 2), size_error("list of columns", 1, 2));
    assert_eq!(csr_error(2, &[0, 1, 3], &[0, 1], 2), size_error("list of values", 2, 3));
    assert_eq!(
        csr_error(2, &[0, 1, usize::MAX], &[0, 1], 2),
        size_error("list of values", 2, usize::MAX)
    );
    assert_eq!(csr_error(2, &[1, 1, 2], &[0, 1], 2), index_error("first row pointer", 1, 1));
    assert_eq!(csr_error(2, &[0, 3, 2], &[0, 1], 2), index_error("row pointer", 3, 3));
    assert_eq!(csr_error(2, &[0, 1, 2], &[0, 2], 2), index_error("column of a matrix", 2, 2));
}
