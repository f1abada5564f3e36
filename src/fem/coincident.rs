//! Points at the same place, within a tolerance.

use std::collections::HashMap;

use crate::error::{Error, Result, not_negative};

/// Cells on each side of a point's cell in which a point within the tolerance may lie.
const NEIGHBOURS: [f64; 3] = [0.0, -1.0, 1.0];

/// For each point the first one at its place: itself, or an earlier point within `tolerance` (m).
///
/// # Errors
/// [`Error::Input`] unless the tolerance is finite and not negative; [`Error::Part`] for points in a row of which
/// neighbours are within the tolerance and others are not, so that places are not separate.
pub(crate) fn first_at_place(points: &[[f64; 3]], tolerance: f64) -> Result<Vec<usize>> {
    not_negative("tolerance of coincident nodes", tolerance)?;
    // Cells as wide as the tolerance. Without one, a cell is a value of the coordinates; −0 + 0 is 0.
    let cell = |value: f64| if tolerance > 0.0 { (value / tolerance).floor() } else { value + 0.0 };
    let key = |cell: [f64; 3]| cell.map(|value| (value + 0.0).to_bits());
    let mut firsts: Vec<usize> = Vec::with_capacity(points.len());
    // Points in each cell that are the first at their place.
    let mut cells: HashMap<[u64; 3], Vec<usize>> = HashMap::new();
    // All points of each place, by its first.
    let mut places: HashMap<usize, Vec<usize>> = HashMap::new();
    for (index, point) in points.iter().enumerate() {
        let home = point.map(cell);
        let mut near = Vec::new();
        for x in NEIGHBOURS {
            for y in NEIGHBOURS {
                for z in NEIGHBOURS {
                    let around = [home[0] + x, home[1] + y, home[2] + z];
                    for &other in cells.get(&key(around)).into_iter().flatten() {
                        if distance(points[other], *point) <= tolerance && !near.contains(&other) {
                            near.push(other);
                        }
                    }
                }
            }
        }
        let first = near.iter().map(|&other| firsts[other]).min().unwrap_or(index);
        // All points at the place must be within the tolerance, and no point of another place.
        let same_place = places.entry(first).or_default();
        let far = |other: &&usize| distance(points[**other], *point) > tolerance;
        let other_place = near.iter().find(|other| firsts[**other] != first);
        if let Some(&other) = same_place.iter().find(far).or(other_place) {
            return Err(in_a_row(other, index, tolerance));
        }
        same_place.push(index);
        firsts.push(first);
        cells.entry(key(home)).or_default().push(index);
    }
    Ok(firsts)
}

/// Error for nodes of which some are within the tolerance of others, and some are not.
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
