//! Assembly of element matrices into the matrices of the whole mesh.

use super::element::MassKind;
use super::mesh::Mesh;
use super::numbering::Numbering;
use crate::error::Result;
use crate::linalg::Triplets;

/// Kind of element matrix to assemble.
#[derive(Debug, Clone, Copy)]
pub(crate) enum MatrixKind {
    /// Stiffness without the geometric stiffness.
    Stiffness,
    GeometricStiffness,
    Mass(MassKind),
    /// Damping of the elements, without Rayleigh damping.
    Damping,
}

/// Adds `factor` times the matrices of the elements that `keep` selects by their coordinates.
///
/// `numbering` must belong to `mesh`; otherwise `matrix` gets indices out of range.
pub(crate) fn assemble(
    mesh: &Mesh,
    numbering: &Numbering,
    quantity: MatrixKind,
    factor: f64,
    keep: impl Fn(&[[f64; 3]]) -> bool,
    matrix: &mut Triplets,
) {
    let mut indices = Vec::new();
    let mut block = Vec::new();
    for element in mesh.elements() {
        let coordinates = mesh.coordinates(element.nodes());
        if !keep(&coordinates) {
            continue;
        }
        block.clear();
        block.resize(element.order().pow(2), 0.0);
        match quantity {
            MatrixKind::Stiffness => element.stiffness(&coordinates, &mut block),
            MatrixKind::GeometricStiffness => element.geometric_stiffness(&coordinates, &mut block),
            MatrixKind::Mass(kind) => element.mass(&coordinates, kind, &mut block),
            MatrixKind::Damping => element.damping(&coordinates, &mut block),
        }
        // An element whose matrix is zero, say without damping, adds no entries to the pattern.
        if block.iter().all(|&value| value == 0.0) {
            continue;
        }
        for value in &mut block {
            *value *= factor;
        }
        numbering.of_element(element, &mut indices);
        // Most directions have no common mass: without their zeros products with the mass take a third of the time.
        let keeps_zeros = !matches!(quantity, MatrixKind::Mass(_));
        let places =
            indices.iter().flat_map(|row| indices.iter().map(move |column| (*row, *column)));
        let entries = places.zip(&block).map(|((row, column), value)| (row, column, *value));
        matrix.extend(entries.filter(|(.., value)| keeps_zeros || *value != 0.0));
    }
}

/// Replaces elements of `mesh` by their versions in the static state, with its axial forces.
///
/// `displacements` (m, rad): degrees of freedom of each element; `gravity` is in m/s².
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) for an element whose new version has other nodes or directions.
pub(crate) fn set_static_state(
    mesh: &mut Mesh,
    displacements: Vec<Vec<f64>>,
    gravity: f64,
) -> Result<()> {
    let mut displacements = displacements.into_iter();
    mesh.replace_elements(|element, points| {
        element.in_static_state(points, &displacements.next()?, gravity)
    })
}
