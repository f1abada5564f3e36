//! Assembly of element matrices into the matrices of the whole mesh.

use super::element::MassKind;
use super::force_rotation::{ElementStaticState, force_rotation};
use super::mesh::Mesh;
use super::numbering::Numbering;
use crate::error::Result;
use crate::linalg::Triplets;

/// Element matrix to assemble.
#[derive(Debug, Clone, Copy)]
pub(crate) enum MatrixKind {
    /// Stiffness of small displacements, without the geometric stiffness.
    Stiffness,
    /// Stiffness of the elements without internal variables.
    LinearStiffness,
    /// Stiffness of the elements that count in stiffness-proportional damping.
    DampedStiffness,
    GeometricStiffness,
    Mass(MassKind),
    /// Damping of the elements, without Rayleigh damping.
    Damping,
}

/// Adds `factor` times the matrices of selected elements to `matrix`.
///
/// `is_included` selects elements by the coordinates of their nodes. `numbering` must belong to `mesh`; otherwise
/// `matrix` gets indices out of range.
pub(crate) fn assemble(
    mesh: &Mesh,
    numbering: &Numbering,
    matrix_kind: MatrixKind,
    factor: f64,
    is_included: impl Fn(&[[f64; 3]]) -> bool,
    matrix: &mut Triplets,
) {
    let mut dofs = Vec::new();
    let mut element_matrix = Vec::new();
    for (element_index, element) in mesh.elements().enumerate() {
        let coordinates = mesh.coordinates(element.nodes());
        if !is_included(&coordinates) {
            continue;
        }
        element_matrix.clear();
        element_matrix.resize(element.order().pow(2), 0.0);
        match matrix_kind {
            MatrixKind::LinearStiffness if element.inelastic().is_some() => continue,
            MatrixKind::DampedStiffness if !element.has_stiffness_damping() => continue,
            MatrixKind::Stiffness | MatrixKind::LinearStiffness | MatrixKind::DampedStiffness => {
                element.stiffness(&coordinates, &mut element_matrix);
            }
            MatrixKind::GeometricStiffness => {
                element.geometric_stiffness(&coordinates, &mut element_matrix);
                if let Some(force_rotation) = mesh.force_rotation(element_index) {
                    force_rotation.add_to(&mut element_matrix);
                }
            }
            MatrixKind::Mass(mass_kind) => {
                element.mass(&coordinates, mass_kind, &mut element_matrix);
            }
            MatrixKind::Damping => element.damping(&coordinates, &mut element_matrix),
        }
        // A zero matrix, such as the damping of most elements, adds no entries to the sparsity pattern.
        if element_matrix.iter().all(|&value| value == 0.0) {
            continue;
        }
        for value in &mut element_matrix {
            *value *= factor;
        }
        numbering.element_dofs(element, &mut dofs);
        // Two directions of a node have no common mass. Products with a mass matrix without these zeros take a third of
        // the time.
        let keeps_zeros = !matches!(matrix_kind, MatrixKind::Mass(_));
        let index_pairs =
            dofs.iter().flat_map(|row| dofs.iter().map(move |column| (*row, *column)));
        let entries =
            index_pairs.zip(&element_matrix).map(|((row, column), value)| (row, column, *value));
        matrix.extend(entries.filter(|(.., value)| keeps_zeros || *value != 0.0));
    }
}

/// Adds the geometric stiffness of the static state to the elements of `mesh`.
///
/// `displacements` (m, rad): degrees of freedom of each element in that state; `gravity` is in m/s². Returns whether
/// the user prescribed the axial force of any element; such a force does not change.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) if the copy of an element in the static state has other nodes or directions.
pub(crate) fn set_static_state(
    mesh: &mut Mesh,
    displacements: &[Vec<f64>],
    gravity: f64,
    mass_kind: MassKind,
) -> Result<bool> {
    let mut prescribed_flags = Vec::with_capacity(displacements.len());
    mesh.replace_elements(|element, coordinates| {
        let displacement = displacements.get(prescribed_flags.len())?;
        let new_element = element.in_static_state(coordinates, displacement, gravity);
        prescribed_flags.push(new_element.is_none() && element.compression().is_some());
        new_element
    })?;
    let is_in_space = mesh.has_depth();
    let mut rotations = Vec::with_capacity(displacements.len());
    for ((element, displacement), is_prescribed) in
        mesh.elements().zip(displacements).zip(&prescribed_flags)
    {
        let state = ElementStaticState { displacement, gravity, mass_kind, is_in_space };
        let coordinates = mesh.coordinates(element.nodes());
        let force_rotation =
            force_rotation(element, &coordinates, &state).filter(|_| !is_prescribed);
        rotations.push(force_rotation);
    }
    mesh.set_force_rotations(rotations);
    Ok(prescribed_flags.contains(&true))
}
