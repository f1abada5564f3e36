//! Nodes of an element: their rigid and mean rotations, and changes of nodal forces.

use super::element::Element;
use super::vector::{add_scaled, cross, dot, norm, unit_vector};
use crate::geometry::Direction;

/// Largest imbalance of forces that can rotate with their element, relative to the largest force.
///
/// Rounding of the stiffness gives far less. Unbalanced forces would do work in a rigid rotation.
const MAX_FORCE_IMBALANCE: f64 = 1e-8;
/// Largest distance of nodes from a line, relative to the radius of the element.
///
/// Nodes up to this distance count as lying on the line.
///
/// It is far above the rounding of coordinates.
const MAX_DISTANCE_FROM_LINE: f64 = 1e-6;

/// A rotation of a mesh, and the unit vector of its axis.
pub(super) struct RotationAxis {
    pub(super) direction: Direction,
    pub(super) vector: [f64; 3],
}
/// Rotations of a mesh in the plane.
pub(super) const PLANE_ROTATION_AXES: &[RotationAxis] =
    &[RotationAxis { direction: Direction::Rotation, vector: [0.0, 0.0, 1.0] }];
/// Rotations of a mesh in space.
pub(super) const SPACE_ROTATION_AXES: &[RotationAxis] = &[
    RotationAxis { direction: Direction::RotationX, vector: [1.0, 0.0, 0.0] },
    RotationAxis { direction: Direction::RotationY, vector: [0.0, 1.0, 0.0] },
    RotationAxis { direction: Direction::RotationZ, vector: [0.0, 0.0, 1.0] },
];

/// Nodes of an element relative to their mean, and its degrees of freedom.
pub(super) struct ElementNodes {
    /// Vectors from the mean of the nodes to each node, m.
    arms: Vec<[f64; 3]>,
    pub(super) dofs: Vec<ElementDof>,
    /// Largest distance of a node from the mean, m.
    radius: f64,
}

/// Force (N) and moment (N m) at a node.
#[derive(Clone, Copy, Default)]
struct NodalForce {
    force: [f64; 3],
    moment: [f64; 3],
}

/// Degree of freedom of an element.
#[derive(Clone, Copy)]
pub(super) struct ElementDof {
    /// Index of the node among the nodes of the element.
    node: usize,
    direction: Direction,
    /// Axis of the displacement or rotation: x, y or z.
    axis: usize,
    is_rotation: bool,
}

impl ElementDof {
    fn new(node: usize, direction: Direction) -> Self {
        let axis = match direction {
            Direction::X | Direction::RotationX => 0,
            Direction::Y | Direction::RotationY => 1,
            Direction::Z | Direction::RotationZ | Direction::Rotation => 2,
        };
        Self { node, direction, axis, is_rotation: direction.is_rotation() }
    }
}

impl ElementNodes {
    /// Nodes of an element that has all displacements; `None` for other elements.
    pub(super) fn new(
        element: &dyn Element,
        coordinates: &[[f64; 3]],
        is_in_space: bool,
    ) -> Option<Self> {
        let directions = element.directions();
        let needed_directions: &[Direction] = if is_in_space {
            &[Direction::X, Direction::Y, Direction::Z]
        } else {
            &[Direction::X, Direction::Y]
        };
        if !needed_directions.iter().all(|direction| directions.contains(direction)) {
            return None;
        }
        let mean_weight = 1.0 / coordinates.len() as f64;
        let mean =
            coordinates.iter().fold([0.0; 3], |sum, point| add_scaled(sum, mean_weight, *point));
        let arms: Vec<[f64; 3]> =
            coordinates.iter().map(|point| add_scaled(*point, -1.0, mean)).collect();
        let radius = arms.iter().map(|arm| norm(*arm)).fold(0.0, f64::max);
        let mut dofs = Vec::with_capacity(element.order());
        for node in 0..coordinates.len() {
            dofs.extend(directions.iter().map(|&direction| ElementDof::new(node, direction)));
        }
        (radius > 0.0).then_some(Self { arms, dofs, radius })
    }

    /// Force and moment at each node, from the forces of all degrees of freedom.
    fn nodal_forces(&self, dof_forces: &[f64]) -> Vec<NodalForce> {
        let mut nodal_forces = vec![NodalForce::default(); self.arms.len()];
        for (dof, value) in self.dofs.iter().zip(dof_forces) {
            let nodal_force = &mut nodal_forces[dof.node];
            if dof.is_rotation {
                nodal_force.moment[dof.axis] = *value;
            } else {
                nodal_force.force[dof.axis] = *value;
            }
        }
        nodal_forces
    }

    /// Change of nodal forces that rotate by 1 rad about an axis.
    ///
    /// Moments change by half of the change in a rotation: they are conjugate to rotation vectors, and therefore
    /// semitangential (Argyris 1979).
    pub(super) fn force_changes(&self, axis: [f64; 3], dof_forces: &[f64]) -> Vec<f64> {
        let nodal_forces = self.nodal_forces(dof_forces);
        let mut changes = Vec::with_capacity(dof_forces.len());
        for dof in &self.dofs {
            let NodalForce { force, moment } = nodal_forces[dof.node];
            changes.push(if dof.is_rotation {
                0.5 * cross(axis, moment)[dof.axis]
            } else {
                cross(axis, force)[dof.axis]
            });
        }
        changes
    }

    /// Dead load of an element with this `mass` matrix; gravity acts against the unit vector `up`.
    pub(super) fn dead_load(&self, mass: &[f64], gravity: f64, up: [f64; 3]) -> Vec<f64> {
        let mut load = matrix_vector_product(mass, &self.translation(up));
        for force in &mut load {
            *force *= -gravity;
        }
        load
    }

    /// Displacements of all degrees of freedom in a translation by the vector `direction`.
    fn translation(&self, direction: [f64; 3]) -> Vec<f64> {
        let dofs = self.dofs.iter();
        dofs.map(|dof| if dof.is_rotation { 0.0 } else { direction[dof.axis] }).collect()
    }

    /// Displacements of all degrees of freedom in a rotation by 1 rad about the mean of the nodes.
    pub(super) fn rotation(&self, rotation: Direction) -> Vec<f64> {
        let dofs = self.dofs.iter();
        dofs.map(|dof| dof.direction.in_rigid_motion(rotation, self.arms[dof.node]))
            .collect()
    }

    /// Largest force, N; moments are divided by the radius of the element.
    pub(super) fn max_force(&self, dof_forces: &[f64]) -> f64 {
        let mut max_force = 0.0_f64;
        for (dof, value) in self.dofs.iter().zip(dof_forces) {
            let force = if dof.is_rotation { value.abs() / self.radius } else { value.abs() };
            max_force = max_force.max(force);
        }
        max_force
    }

    /// Whether nodal forces have no resultant force, up to rounding of `max_force`.
    pub(super) fn are_balanced_in_translation(&self, dof_forces: &[f64], max_force: f64) -> bool {
        let nodal_forces = self.nodal_forces(dof_forces);
        let resultant =
            nodal_forces.iter().fold([0.0; 3], |sum, nodal| add_scaled(sum, 1.0, nodal.force));
        norm(resultant) <= MAX_FORCE_IMBALANCE * max_force
    }

    /// Whether nodal forces have no resultant force and no resultant moment.
    pub(super) fn are_balanced(&self, dof_forces: &[f64], max_force: f64) -> bool {
        let nodal_forces = self.nodal_forces(dof_forces);
        let mut resultant_moment = [0.0; 3];
        for (nodal, arm) in nodal_forces.iter().zip(&self.arms) {
            let with_nodal_moment = add_scaled(resultant_moment, 1.0, nodal.moment);
            resultant_moment = add_scaled(with_nodal_moment, 1.0, cross(*arm, nodal.force));
        }
        self.are_balanced_in_translation(dof_forces, max_force)
            && norm(resultant_moment) <= MAX_FORCE_IMBALANCE * max_force * self.radius
    }

    /// Rows that map the element's displacements to its mean rotations about `axes`.
    ///
    /// The mean rotation fits the displacements of the nodes best. If the nodes lie on one line, the rotation about
    /// that line is the mean of the nodes' rotations, or zero for nodes without rotations.
    pub(super) fn mean_rotations(&self, axes: &[RotationAxis]) -> Vec<Vec<f64>> {
        let line_direction = self.line_direction();
        let inverse_inertia = self.inverse_inertia(line_direction);
        let has_all_rotations = SPACE_ROTATION_AXES
            .iter()
            .all(|axis| self.dofs.iter().any(|dof| dof.direction == axis.direction));
        let node_count = self.arms.len() as f64;
        let mut rows = Vec::with_capacity(axes.len());
        for RotationAxis { vector: axis, .. } in axes {
            let weights: [f64; 3] =
                std::array::from_fn(|k| (0..3).map(|i| axis[i] * inverse_inertia[i][k]).sum());
            let mut row = Vec::with_capacity(self.dofs.len());
            for dof in &self.dofs {
                row.push(match (dof.is_rotation, line_direction) {
                    // weights · (arm × u)
                    (false, _) => cross(weights, self.arms[dof.node])[dof.axis],
                    (true, Some(tangent)) if has_all_rotations => {
                        dot(*axis, tangent) * tangent[dof.axis] / node_count
                    }
                    (true, _) => 0.0,
                });
            }
            rows.push(row);
        }
        rows
    }

    /// Inverse of the inertia tensor of unit masses at the nodes, 1/m².
    ///
    /// Nodes on a line have no inertia about that line: the inverse then refers to rotations about axes at right angles
    /// to the line.
    fn inverse_inertia(&self, line_direction: Option<[f64; 3]>) -> [[f64; 3]; 3] {
        if let Some(tangent) = line_direction {
            let polar_inertia: f64 = self.arms.iter().map(|arm| dot(*arm, *arm)).sum();
            return std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    let diagonal = if i == j { 1.0 } else { 0.0 };
                    (diagonal - tangent[i] * tangent[j]) / polar_inertia
                })
            });
        }
        let mut inertia = [[0.0; 3]; 3];
        for arm in &self.arms {
            let squared_arm = dot(*arm, *arm);
            for i in 0..3 {
                for j in 0..3 {
                    let diagonal = if i == j { squared_arm } else { 0.0 };
                    inertia[i][j] += diagonal - arm[i] * arm[j];
                }
            }
        }
        symmetric_inverse(&inertia)
    }

    /// Unit vector of the line on which all nodes lie.
    ///
    /// `None` if they do not.
    fn line_direction(&self) -> Option<[f64; 3]> {
        let longest_arm = self
            .arms
            .iter()
            .max_by(|a, b| norm(**a).total_cmp(&norm(**b)))
            .copied()
            .unwrap_or_default();
        let tangent = unit_vector(longest_arm);
        let max_distance = MAX_DISTANCE_FROM_LINE * self.radius;
        self.arms
            .iter()
            .all(|arm| norm(cross(*arm, tangent)) <= max_distance)
            .then_some(tangent)
    }
}

/// Inverse of a symmetric matrix of order 3.
fn symmetric_inverse(matrix: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactors =
        [cross(matrix[1], matrix[2]), cross(matrix[2], matrix[0]), cross(matrix[0], matrix[1])];
    let determinant = dot(matrix[0], cofactors[0]);
    // The matrix is symmetric, so the rows of its inverse are its columns.
    cofactors.map(|row| row.map(|value| value / determinant))
}

pub(super) fn inner_product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Product of a square row-major `matrix` and a vector.
pub(super) fn matrix_vector_product(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    let rows = matrix.chunks_exact(vector.len().max(1));
    rows.map(|row| inner_product(row, vector)).collect()
}
