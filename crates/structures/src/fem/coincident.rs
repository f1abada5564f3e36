//! Points at the same place, within a tolerance.

use std::collections::HashMap;

use crate::error::{Error, Result, not_negative};

/// Offsets of the cells in which a point within the tolerance may lie.
const NEIGHBOUR_OFFSETS: [f64; 3] = [0.0, -1.0, 1.0];

/// For each point the first one at its place: itself, or an earlier point.
///
/// `tolerance`: largest distance of points at one place, m.
///
/// # Errors
/// [`Error::Input`] unless the tolerance is finite and not negative; [`Error::Part`] for points in a row of which
/// neighbours are within the tolerance and others are not, so that places are not separate.
pub fn first_at_place(points: &[[f64; 3]], tolerance: f64) -> Result<Vec<usize>> {
    not_negative("tolerance of coincident nodes", tolerance)?;

    let mut firsts: Vec<usize> = Vec::with_capacity(points.len());
    // Points in each cell that are the first at their place.
    let mut cells: HashMap<[u64; 3], Vec<usize>> = HashMap::new();
    // All points of each place, by its first.
    let mut places: HashMap<usize, Vec<usize>> = HashMap::new();
    for (index, point) in points.iter().enumerate() {
        let cell_of_point = point.map(|value| cell_index(value, tolerance));
        let mut within_tolerance = Vec::new();
        for x in NEIGHBOUR_OFFSETS {
            for y in NEIGHBOUR_OFFSETS {
                for z in NEIGHBOUR_OFFSETS {
                    let neighbour =
                        [cell_of_point[0] + x, cell_of_point[1] + y, cell_of_point[2] + z];
                    for &other in cells.get(&cell_key(neighbour)).into_iter().flatten() {
                        if distance(points[other], *point) <= tolerance
                            && !within_tolerance.contains(&other)
                        {
                            within_tolerance.push(other);
                        }
                    }
                }
            }
        }
        let first = within_tolerance.iter().map(|&other| firsts[other]).min().unwrap_or(index);
        // All points at the place must be within the tolerance, and no point of another place.
        let same_place = places.entry(first).or_default();
        let too_far = same_place.iter().find(|other| distance(points[**other], *point) > tolerance);
        let other_place = within_tolerance.iter().find(|other| firsts[**other] != first);
        if let Some(&other) = too_far.or(other_place) {
            return Err(in_a_row(other, index, tolerance));
        }
        same_place.push(index);
        firsts.push(first);
        cells.entry(cell_key(cell_of_point)).or_default().push(index);
    }
    Ok(firsts)
}

/// Index of the cell of a coordinate; cells are as wide as the tolerance.
///
/// Without a tolerance the index is the coordinate itself.
fn cell_index(value: f64, tolerance: f64) -> f64 {
    if tolerance > 0.0 { (value / tolerance).floor() } else { value + 0.0 }
}

/// Hash key of a cell; adding zero turns −0 into 0.
fn cell_key(cell: [f64; 3]) -> [u64; 3] {
    cell.map(|index| (index + 0.0).to_bits())
}

/// Error for nodes in a row: neighbours within the tolerance, ends beyond it.
fn in_a_row(one: usize, other: usize, tolerance: f64) -> Error {
    let reason = format!(
        "they are within the tolerance of {tolerance} m, as others beside them, which are farther apart: take a \
         smaller one, far below the distance of nodes"
    );
    Error::part(format!("nodes {one} and {other}"), reason)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_found_in_any_cell() {
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [-0.0, 1e-9, -1e-9],
            [1.0 - 1e-9, 0.0, 0.0],
            [2.0, 0.0, 0.0],
        ];
        assert_eq!(first_at_place(&points, 1e-8).unwrap(), [0, 1, 0, 1, 4]);
        assert_eq!(first_at_place(&points, 0.0).unwrap(), [0, 1, 2, 3, 4]);
        assert_eq!(first_at_place(&[[0.0; 3], [-0.0, 0.0, -0.0]], 0.0).unwrap(), [0, 0]);
        assert!(
            first_at_place(&points, -1.0).is_err() && first_at_place(&points, f64::NAN).is_err()
        );
        // Three in a row, in any order.
        for order in [[0.0, 0.6, 1.2], [0.0, 1.2, 0.6], [0.6, 0.0, 1.2]] {
            let row = order.map(|x| [x, 0.0, 0.0]);
            assert!(
                matches!(first_at_place(&row, 0.7), Err(Error::Part { .. } | Error::Item { .. })),
                "{order:?}"
            );
        }
    }
}
