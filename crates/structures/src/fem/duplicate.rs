//! Elements entered twice.

use super::element::{Element, MassKind};
use super::element_face::ElementFace;

/// Relative difference up to which matrix entries count as equal: rounding.
const MATRIX_ENTRY_TOLERANCE: f64 = 1e-12;

/// Key of an element's place: the nodes of its faces, or all nodes without faces, sorted.
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

/// Whether `element` duplicates the element `other` of the same [`element_key`].
///
/// `points`: coordinates of the nodes of the mesh.
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
    let same_directions = other.directions() == directions;
    if nodes.len() < 2 || !same_directions || [element.order(), other.order()] != [order; 2] {
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

/// Stiffness, mass and damping of an element, with its nodes in ascending order.
fn matrices_by_node(element: &dyn Element, points: &[[f64; 3]]) -> Vec<f64> {
    let nodes = element.nodes();
    let coordinates: Vec<[f64; 3]> = nodes.iter().map(|&node| points[node]).collect();
    let order = element.order();
    let directions = element.directions().len();
    let mut ascending: Vec<usize> = (0..nodes.len()).collect();
    ascending.sort_by_key(|&k| nodes[k]);
    let dofs: Vec<usize> =
        ascending.into_iter().flat_map(|k| k * directions..(k + 1) * directions).collect();
    let mut stiffness = vec![0.0; order * order];
    let mut mass = vec![0.0; order * order];
    let mut damping = vec![0.0; order * order];
    element.stiffness(&coordinates, &mut stiffness);
    element.mass(&coordinates, MassKind::default(), &mut mass);
    element.damping(&coordinates, &mut damping);
    let mut matrices = Vec::with_capacity(3 * order * order);
    for matrix in [stiffness, mass, damping] {
        let largest = matrix.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
        for row in &dofs {
            for column in &dofs {
                // An entry that cancels keeps a rounding error, which depends on the order of the nodes.
                let entry = matrix[row * order + column];
                let exceeds_rounding = entry.abs() > MATRIX_ENTRY_TOLERANCE * largest;
                matrices.push(if exceeds_rounding { entry } else { 0.0 });
            }
        }
    }
    matrices
}
