//! Detection of elements that were entered twice.

use super::element::{Element, ElementFace, MassKind};

/// Relative difference up to which matrix entries count as equal.
///
/// An entry below this fraction of the largest one counts as zero. Rounding is far smaller.
const MATRIX_ENTRY_TOLERANCE: f64 = 1e-12;

/// Key by which duplicates of an element are found: its sorted nodes.
///
/// They are the nodes of its faces, or all nodes of an element without faces.
pub(super) fn element_key(element: &dyn Element) -> Vec<usize> {
    let mut key: Vec<usize> =
        element.faces().iter().flat_map(ElementFace::corners).copied().collect();
    if key.is_empty() {
        key = element.nodes().to_vec();
    }
    key.sort_unstable();
    key.dedup();
    key
}

/// Whether `element` duplicates the element `other` with the same [`element_key`].
///
/// Two solids with one key are duplicates. Other elements are duplicates if they have mass and the same stiffness, mass
/// and damping.
///
/// `points`: coordinates of all nodes of the mesh.
pub(super) fn is_duplicate(
    element: &dyn Element,
    other: &dyn Element,
    points: &[[f64; 3]],
) -> bool {
    if is_solid(element) || is_solid(other) {
        return is_solid(element) && is_solid(other);
    }
    let nodes = element.nodes();
    let directions = element.directions();
    let order = nodes.len() * directions.len();
    let has_same_directions = other.directions() == directions;
    if nodes.len() < 2 || !has_same_directions || [element.order(), other.order()] != [order; 2] {
        return false;
    }
    let matrices = matrices_by_node(element, points);
    let other_matrices = matrices_by_node(other, points);
    let has_mass = matrices[order * order..2 * order * order].iter().any(|mass| *mass != 0.0);
    has_mass
        && matrices
            .iter()
            .zip(&other_matrices)
            .all(|(a, b)| (a - b).abs() <= MATRIX_ENTRY_TOLERANCE * a.abs().max(b.abs()))
}

fn is_solid(element: &dyn Element) -> bool {
    element.faces().iter().any(ElementFace::is_side)
}

/// Entries of the stiffness, then of the mass and the damping, with the nodes in ascending order.
fn matrices_by_node(element: &dyn Element, points: &[[f64; 3]]) -> Vec<f64> {
    let nodes = element.nodes();
    let coordinates: Vec<[f64; 3]> = nodes.iter().map(|&node| points[node]).collect();
    let order = element.order();
    let direction_count = element.directions().len();
    let mut node_order: Vec<usize> = (0..nodes.len()).collect();
    node_order.sort_by_key(|&local_node| nodes[local_node]);
    let sorted_dofs: Vec<usize> = node_order
        .into_iter()
        .flat_map(|local_node| local_node * direction_count..(local_node + 1) * direction_count)
        .collect();
    let mut stiffness = vec![0.0; order * order];
    let mut mass = vec![0.0; order * order];
    let mut damping = vec![0.0; order * order];
    element.stiffness(&coordinates, &mut stiffness);
    element.mass(&coordinates, MassKind::default(), &mut mass);
    element.damping(&coordinates, &mut damping);
    let mut matrices = Vec::with_capacity(3 * order * order);
    for matrix in [stiffness, mass, damping] {
        let max_entry = matrix.iter().fold(0.0_f64, |max_entry, entry| max_entry.max(entry.abs()));
        for row in &sorted_dofs {
            for column in &sorted_dofs {
                // A sum that cancels has a rounding error that depends on the order of the nodes.
                let entry = matrix[row * order + column];
                let exceeds_rounding = entry.abs() > MATRIX_ENTRY_TOLERANCE * max_entry;
                matrices.push(if exceeds_rounding { entry } else { 0.0 });
            }
        }
    }
    matrices
}
