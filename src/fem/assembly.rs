//! From element matrices to those of the whole mesh.

use super::element::MassKind;
use super::mesh::Mesh;
use super::numbering::Numbering;
use crate::linalg::Triplets;

/// Which matrix of the elements is meant.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Quantity {
    Stiffness,
    GeometricStiffness,
    Mass(MassKind),
    Damping,
}

/// Adds `factor` times the stiffness of all elements, without geometric stiffness, to `matrix`.
///
/// `numbering` must be that of `mesh`; where it is not, `matrix` gets indices out of range.
pub(crate) fn assemble_stiffness(
    mesh: &Mesh,
    numbering: &Numbering,
    factor: f64,
    matrix: &mut Triplets,
) {
    assemble(mesh, numbering, Quantity::Stiffness, factor, |_| true, matrix);
}

/// Adds `factor` times the geometric stiffness of all elements to `matrix`.
///
/// `numbering` must be that of `mesh`; where it is not, `matrix` gets indices out of range.
pub(crate) fn assemble_geometric_stiffness(
    mesh: &Mesh,
    numbering: &Numbering,
    factor: f64,
    matrix: &mut Triplets,
) {
    assemble(mesh, numbering, Quantity::GeometricStiffness, factor, |_| true, matrix);
}

/// Adds `factor` times the mass of all elements to `matrix`.
///
/// `numbering` must be that of `mesh`; where it is not, `matrix` gets indices out of range.
pub(crate) fn assemble_mass(
    mesh: &Mesh,
    numbering: &Numbering,
    kind: MassKind,
    factor: f64,
    matrix: &mut Triplets,
) {
    assemble(mesh, numbering, Quantity::Mass(kind), factor, |_| true, matrix);
}

/// Adds `factor` times the damping of all elements (not Rayleigh's) to `matrix`.
///
/// `numbering` must be that of `mesh`; where it is not, `matrix` gets indices out of range.
pub(crate) fn assemble_damping(
    mesh: &Mesh,
    numbering: &Numbering,
    factor: f64,
    matrix: &mut Triplets,
) {
    assemble(mesh, numbering, Quantity::Damping, factor, |_| true, matrix);
}

/// Adds `factor` times a matrix of the elements that `keep` picks by their coordinates.
pub(crate) fn assemble(
    mesh: &Mesh,
    numbering: &Numbering,
    quantity: Quantity,
    factor: f64,
    keep: impl Fn(&[[f64; 2]]) -> bool,
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
            Quantity::Stiffness => element.stiffness(&coordinates, &mut block),
            Quantity::GeometricStiffness => element.geometric_stiffness(&coordinates, &mut block),
            Quantity::Mass(kind) => element.mass(&coordinates, kind, &mut block),
            Quantity::Damping => element.damping(&coordinates, &mut block),
        }
        // An element without, say, damping adds no entries to the pattern.
        if block.iter().all(|&value| value == 0.0) {
            continue;
        }
        for value in &mut block {
            *value *= factor;
        }
        numbering.of_element(element, &mut indices);
        matrix.add_block(&indices, &block);
    }
}
