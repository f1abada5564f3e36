//! Assembly of element matrices into the matrices of the whole mesh.

use super::element::MassKind;
use super::force_rotation::{ElementStaticState, force_rotation};
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

/// Adds `factor` times the matrices of the selected elements.
///
/// `is_included` selects elements by the coordinates of their nodes.
///
/// `numbering` must belong to `mesh`; otherwise `matrix` gets indices out of range.
pub(crate) fn assemble(
    mesh: &Mesh,
    numbering: &Numbering,
    quantity: MatrixKind,
    factor: f64,
    is_included: impl Fn(&[[f64; 3]]) -> bool,
    matrix: &mut Triplets,
) {
    let mut indices = Vec::new();
    let mut block = Vec::new();
    for (index, element) in mesh.elements().enumerate() {
        let coordinates = mesh.coordinates(element.nodes());
        if !is_included(&coordinates) {
            continue;
        }
        block.clear();
        block.resize(element.order().pow(2), 0.0);
        match quantity {
            MatrixKind::Stiffness => element.stiffness(&coordinates, &mut block),
            MatrixKind::GeometricStiffness => {
                element.geometric_stiffness(&coordinates, &mut block);
                if let Some(rotation) = mesh.force_rotation(index) {
                    rotation.add_to(&mut block);
                }
            }
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

/// Replaces elements of `mesh` by their versions in the static state, whose forces rotate with them.
///
/// `displacements` (m, rad): degrees of freedom of each element; `gravity` is in m/s². Returns whether the
/// user gave the axial force of an element, which does not change.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) for an element whose new version has other nodes or directions.
pub(crate) fn set_static_state(
    mesh: &mut Mesh,
    displacements: &[Vec<f64>],
    gravity: f64,
    mass_kind: MassKind,
) -> Result<bool> {
    let mut is_prescribed = Vec::with_capacity(displacements.len());
    mesh.replace_elements(|element, points| {
        let displacement = displacements.get(is_prescribed.len())?;
        let replaced = element.in_static_state(points, displacement, gravity);
        is_prescribed.push(replaced.is_none() && element.compression().is_some());
        replaced
    })?;
    let has_depth = mesh.has_depth();
    let mut rotations = Vec::with_capacity(displacements.len());
    for ((element, displacement), is_prescribed) in
        mesh.elements().zip(displacements).zip(&is_prescribed)
    {
        let state = ElementStaticState { displacement, gravity, mass_kind, has_depth };
        let points = mesh.coordinates(element.nodes());
        let rotation = force_rotation(element, &points, &state).filter(|_| !is_prescribed);
        rotations.push(rotation);
    }
    mesh.set_force_rotations(rotations);
    Ok(is_prescribed.contains(&true))
}
