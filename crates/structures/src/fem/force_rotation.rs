//! Geometric stiffness of static forces that rotate with their element.
//!
//! With the geometric stiffness of the axial force alone, shear forces and moments keep their directions when the
//! element rotates. The nodal forces are then not in equilibrium with the weights, and a rigid rotation of the
//! structure causes forces. Here all forces rotate with the mean rotation of the element, as in corotational elements
//! (Felippa & Haugen 2005, CMAME 194, 2285–2335: rotational and equilibrium geometric stiffness).
//!
//! | symbol | meaning |
//! |---|---|
//! | f | forces K u at the nodes in the static state |
//! | R | displacements of the nodes in rigid rotations by 1 rad, one column for each axis |
//! | G | matrix from the element's displacements to its mean rotations, one row for each axis; G R = 1 |
//! | T | change of the forces in these rotations: f rotates, the element's weight does not |
//! | A | T − K_G R, with the element's geometric stiffness K_G |
//!
//! The matrix K_G + A G + (A G)ᵀ − Gᵀ(RᵀA)G is symmetric. It gives the forces T in a rigid rotation, and no forces in a
//! translation.

use super::element::{Element, MassKind};
use super::element_nodes::{
    ElementNodes, PLANE_ROTATION_AXES, SPACE_ROTATION_AXES, inner_product, matrix_vector_product,
};
use super::vector::cross;

/// Forces below this fraction of the element's largest force are rounding.
const FORCE_ROUNDING_RATIO: f64 = 1e-12;

/// Static state in which the forces of an element are computed.
pub(super) struct ElementStaticState<'a> {
    /// Displacements of the element's degrees of freedom, m and rad.
    pub(super) displacement: &'a [f64],
    /// Acceleration of gravity, m/s².
    pub(super) gravity: f64,
    pub(super) mass_kind: MassKind,
    /// Whether the mesh is in space.
    pub(super) is_in_space: bool,
}

/// Geometric stiffness A G + (A G)ᵀ − Gᵀ(RᵀA)G of forces that rotate with their element.
///
/// It is stored as its factors, which take a quarter of the matrix's memory for a brick.
#[derive(Clone)]
pub(crate) struct ForceRotation {
    /// Columns of A, one for each axis.
    added_forces: Vec<Vec<f64>>,
    /// Rows of G, one for each axis.
    mean_rotations: Vec<Vec<f64>>,
    /// RᵀA.
    rigid_moments: Vec<Vec<f64>>,
}

impl ForceRotation {
    /// Adds the matrix to a row-major `element_matrix`.
    pub(super) fn add_to(&self, element_matrix: &mut [f64]) {
        let Self { added_forces, mean_rotations, rigid_moments } = self;
        for (axis, rotation) in mean_rotations.iter().enumerate() {
            let order = rotation.len();
            // Half of −(RᵀA)G belongs to A G, the other half to its transpose.
            let mut column = added_forces[axis].clone();
            for (moment, other_rotation) in rigid_moments[axis].iter().zip(mean_rotations) {
                for (force, weight) in column.iter_mut().zip(other_rotation) {
                    *force -= 0.5 * moment * weight;
                }
            }
            for (i, row) in element_matrix.chunks_exact_mut(order).enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += column[i] * rotation[j] + rotation[i] * column[j];
                }
            }
        }
    }
}

/// Geometric stiffness of the static forces of `element` that rotate with it.
///
/// `None` if [`Element::geometric_stiffness`] contains all its forces, or if the forces cannot rotate with the element:
/// it does not have all displacements, all its nodes coincide, or the forces are not in equilibrium.
pub(super) fn force_rotation(
    element: &dyn Element,
    coordinates: &[[f64; 3]],
    state: &ElementStaticState,
) -> Option<ForceRotation> {
    let nodes = ElementNodes::new(element, coordinates, state.is_in_space)?;
    let order = nodes.dofs.len();
    let mut matrix = vec![0.0; order * order];
    element.stiffness(coordinates, &mut matrix);
    let forces = matrix_vector_product(&matrix, state.displacement);
    let max_force = nodes.max_force(&forces);
    if max_force == 0.0 || !max_force.is_finite() {
        return None;
    }
    let axes = if state.is_in_space { SPACE_ROTATION_AXES } else { PLANE_ROTATION_AXES };
    let rigid_rotations: Vec<Vec<f64>> =
        axes.iter().map(|axis| nodes.rotation(axis.direction)).collect();
    let added_forces = added_forces(element, coordinates, state, &nodes, &forces, &rigid_rotations);
    let max_added_force =
        added_forces.iter().map(|column| nodes.max_force(column)).fold(0.0, f64::max);
    if max_added_force <= FORCE_ROUNDING_RATIO * max_force
        || !nodes.are_balanced(&forces, max_force)
        || !added_forces
            .iter()
            .all(|column| nodes.are_balanced_in_translation(column, max_force))
    {
        return None;
    }
    let mean_rotations = nodes.mean_rotations(axes);
    let rigid_moments = symmetric_products(&rigid_rotations, &added_forces);
    Some(ForceRotation { added_forces, mean_rotations, rigid_moments })
}

/// Columns of A = T − K_G R, one for each axis of rotation.
///
/// `forces`: nodal forces f in the static state.
fn added_forces(
    element: &dyn Element,
    coordinates: &[[f64; 3]],
    state: &ElementStaticState,
    nodes: &ElementNodes,
    forces: &[f64],
    rigid_rotations: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let order = forces.len();
    let mut mass = vec![0.0; order * order];
    element.mass(coordinates, state.mass_kind, &mut mass);
    let up = if state.is_in_space { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
    let weight = nodes.dead_load(&mass, state.gravity, up);
    let mut geometric_stiffness = vec![0.0; order * order];
    element.geometric_stiffness(coordinates, &mut geometric_stiffness);
    let axes = if state.is_in_space { SPACE_ROTATION_AXES } else { PLANE_ROTATION_AXES };
    let mut columns = Vec::with_capacity(axes.len());
    for (axis, rigid_rotation) in axes.iter().zip(rigid_rotations) {
        // The rotation changes the weight by `rotated_weight` − `inclined_weight`. This is zero for the nodal forces of
        // the weight, which keep their direction, but not for the moments of distributed weight, which depend on the
        // element's inclination.
        let rotated_forces = nodes.force_changes(axis.vector, forces);
        let rotated_weight = nodes.force_changes(axis.vector, &weight);
        let inclined_weight = nodes.dead_load(&mass, state.gravity, cross(axis.vector, up));
        let element_forces = matrix_vector_product(&geometric_stiffness, rigid_rotation);
        let mut column = Vec::with_capacity(order);
        for k in 0..order {
            column.push(
                rotated_forces[k] - rotated_weight[k] + inclined_weight[k] - element_forces[k],
            );
        }
        columns.push(column);
    }
    columns
}

/// Symmetric part of the inner products of `motions` with `forces`.
fn symmetric_products(motions: &[Vec<f64>], forces: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let motion_count = motions.len();
    let mut products = vec![vec![0.0; motion_count]; motion_count];
    for a in 0..motion_count {
        for b in 0..motion_count {
            products[a][b] = 0.5
                * (inner_product(&motions[a], &forces[b]) + inner_product(&motions[b], &forces[a]));
        }
    }
    products
}
