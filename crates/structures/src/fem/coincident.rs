//! Points that coincide within a tolerance.

use std::collections::HashMap;

use super::vector::distance;
use crate::error::{Error, Result, not_negative};

/// Offsets of the neighbouring cells along an axis, in which coincident points may lie.
const NEIGHBOUR_OFFSETS: [f64; 3] = [0.0, -1.0, 1.0];

/// Index of the first point with which each point coincides: itself, or an earlier point.
///
/// `tolerance`: largest distance of coincident points, m.
///
/// # Errors
/// [`Error::Input`] unless the tolerance is finite and not negative. [`Error::Part`] for a chain of points: neighbours
/// are within the tolerance, but its ends are not.
pub fn first_coincident_points(points: &[[f64; 3]], tolerance: f64) -> Result<Vec<usize>> {
    not_negative("tolerance of coincident nodes", tolerance)?;

    let mut first_points: Vec<usize> = Vec::with_capacity(points.len());
    let mut cell_points: HashMap<[u64; 3], Vec<usize>> = HashMap::new();
    // All points of a group of coincident points, by its first point.
    let mut groups: HashMap<usize, Vec<usize>> = HashMap::new();
    for (index, point) in points.iter().enumerate() {
        let cell = point.map(|coordinate| cell_index(coordinate, tolerance));
        let near_points = points_within_tolerance(points, *point, cell, tolerance, &cell_points);
        let first_point =
            near_points.iter().map(|&near_point| first_points[near_point]).min().unwrap_or(index);
        // All points of the group must lie within the tolerance, and all points of other groups beyond it.
        let group = groups.entry(first_point).or_default();
        let distant_member =
            group.iter().find(|member| distance(points[**member], *point) > tolerance);
        let point_of_other_group =
            near_points.iter().find(|near_point| first_points[**near_point] != first_point);
        if let Some(&other) = distant_member.or(point_of_other_group) {
            return Err(chain_error(other, index, tolerance));
        }
        group.push(index);
        first_points.push(first_point);
        cell_points.entry(cell_key(cell)).or_default().push(index);
    }
    Ok(first_points)
}

/// Points in a `cell` and its neighbours that lie within the tolerance of a `point`.
fn points_within_tolerance(
    points: &[[f64; 3]],
    point: [f64; 3],
    cell: [f64; 3],
    tolerance: f64,
    cell_points: &HashMap<[u64; 3], Vec<usize>>,
) -> Vec<usize> {
    let mut near_points = Vec::new();
    for dx in NEIGHBOUR_OFFSETS {
        for dy in NEIGHBOUR_OFFSETS {
            for dz in NEIGHBOUR_OFFSETS {
                let neighbour_cell = [cell[0] + dx, cell[1] + dy, cell[2] + dz];
                let candidates = cell_points.get(&cell_key(neighbour_cell));
                for &candidate in candidates.into_iter().flatten() {
                    if distance(points[candidate], point) <= tolerance
                        && !near_points.contains(&candidate)
                    {
                        near_points.push(candidate);
                    }
                }
            }
        }
    }
    near_points
}

/// Index of a cell along an axis; cells are as wide as the tolerance.
///
/// For a tolerance of zero the index is the coordinate itself. Adding zero turns −0 into 0.
fn cell_index(coordinate: f64, tolerance: f64) -> f64 {
    if tolerance > 0.0 { (coordinate / tolerance).floor() } else { coordinate + 0.0 }
}

/// Hash key of a cell; adding zero turns −0 into 0.
fn cell_key(cell: [f64; 3]) -> [u64; 3] {
    cell.map(|index| (index + 0.0).to_bits())
}

/// Error for a chain of nodes: neighbours within the tolerance, ends beyond it.
fn chain_error(first_node: usize, second_node: usize, tolerance: f64) -> Error {
    let reason = format!(
        "they belong to a chain of nodes, of which neighbours are within the tolerance of {tolerance} m, but the ends \
         are not: reduce the tolerance far below the distance of nodes"
    );
    Error::part(format!("nodes {first_node} and {second_node}"), reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coincident_points_are_found_in_any_cell() {
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [-0.0, 1e-9, -1e-9],
            [1.0 - 1e-9, 0.0, 0.0],
            [2.0, 0.0, 0.0],
        ];
        assert_eq!(first_coincident_points(&points, 1e-8).unwrap(), [0, 1, 0, 1, 4]);
        assert_eq!(first_coincident_points(&points, 0.0).unwrap(), [0, 1, 2, 3, 4]);
        assert_eq!(first_coincident_points(&[[0.0; 3], [-0.0, 0.0, -0.0]], 0.0).unwrap(), [0, 0]);
        assert!(
            first_coincident_points(&points, -1.0).is_err()
                && first_coincident_points(&points, f64::NAN).is_err()
        );
        // A chain of three points, in any order.
        for order in [[0.0, 0.6, 1.2], [0.0, 1.2, 0.6], [0.6, 0.0, 1.2]] {
            let chain = order.map(|x| [x, 0.0, 0.0]);
            assert!(
                matches!(
                    first_coincident_points(&chain, 0.7),
                    Err(Error::Part { .. } | Error::Item { .. })
                ),
                "{order:?}"
            );
        }
    }
}
