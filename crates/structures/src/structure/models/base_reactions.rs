//! Geometric stiffness of P–Δ due to rigid links and due to reactions of the ground.
//!
//! The forces of the static state are in equilibrium with the weights and with the reactions at the fixed contact
//! nodes. In a rigid rotation the forces of the elements rotate with them, and the weights keep their direction. The
//! reactions of the ground follow two rules. A rotation of the structure about the vertical then causes no force, and a
//! rocking rotation causes the overturning moment of the weights about the height of the base:
//!
//! * Vertical reactions keep their direction.
//! * Other reactions, such as the thrust between the feet of a portal, are in equilibrium through the base and rotate
//!   with it. Their distribution between ground and basemat is not a property of the structure.
//!
//! | symbol | meaning |
//! |---|---|
//! | K_G | geometric stiffness of elements and links |
//! | R | rigid rotations by 1 rad about the middle of the base, one column for each axis |
//! | Q | matrix from the degrees of freedom to the mean rotations of the base, one row for each axis; Q R = 1 |
//! | T | forces in equilibrium with the structure in these rotations |
//! | D | surplus K_G R − T, at degrees of freedom of the base |
//!
//! The matrix K_G − D Q − (D Q)ᵀ + Qᵀ(RᵀD)Q is symmetric and gives T in the rotations. Q and D have few entries.

use super::rigid_links::Follower;
use crate::error::Result;
use crate::fem::{Direction, MatrixKind, assemble};
use crate::geometry::span;
use crate::linalg::{SparseMatrix, dot, largest};
use crate::structure::{BaseNode, DofCombination, FemModel, Structure, Triplets};

/// Forces below this fraction of the largest are rounding.
const FORCE_ROUNDING_RATIO: f64 = 1e-12;

/// Largest difference of two distances because of rounding, relative to the extent of the base.
const DISTANCE_ROUNDING_RATIO: f64 = 1e-9;

/// Matrix entries (row, column, value).
type Entries = Vec<(usize, usize, f64)>;

/// A rotation of a mesh, and the index of its axis.
struct ReactionAxis {
    axis: usize,
    direction: Direction,
}
/// Rotations of a mesh in the plane.
const PLANE_ROTATIONS: &[ReactionAxis] =
    &[ReactionAxis { axis: 2, direction: Direction::Rotation }];
/// Rotations of a mesh in space.
const SPACE_ROTATIONS: &[ReactionAxis] = &[
    ReactionAxis { axis: 0, direction: Direction::RotationX },
    ReactionAxis { axis: 1, direction: Direction::RotationY },
    ReactionAxis { axis: 2, direction: Direction::RotationZ },
];

impl FemModel {
    /// Whether each degree of freedom of the model moves a contact node of the base's floor.
    ///
    /// Walls have no static reactions to the weight.
    pub(super) fn is_base_dof(&self) -> Vec<bool> {
        let mut is_base_dof = vec![false; self.dofs()];
        let base = self.base();
        let floors = base.parts().iter().flat_map(|part| BaseNode::floor(part));
        for dof in floors.flat_map(BaseNode::dofs) {
            is_base_dof[dof] = true;
        }
        is_base_dof
    }

    /// Rotations of the mesh.
    fn rotations(&self) -> &'static [ReactionAxis] {
        if self.mesh.has_depth() { SPACE_ROTATIONS } else { PLANE_ROTATIONS }
    }

    /// Matrix of all elements for the degrees of freedom of the model.
    fn model_matrix(&self, kind: MatrixKind) -> Result<SparseMatrix> {
        let mut entries = Triplets::new(self.dofs());
        self.add_matrices(&mut entries, &[(kind, 1.0)]);
        SparseMatrix::new("matrix of the elements", &entries)
    }

    /// Matrix of all elements for the degrees of freedom of the mesh, before rigid links.
    fn mesh_matrix(&self, kind: MatrixKind) -> Result<SparseMatrix> {
        let mut entries = Triplets::new(self.numbering.dofs());
        assemble(&self.mesh, &self.numbering, kind, 1.0, |_| true, &mut entries);
        SparseMatrix::new("matrix of the elements", &entries)
    }

    /// Geometric stiffness of rigid links under the static `displacement` and `gravity` (m/s²).
    ///
    /// A follower at the arm a moves by θ × a + θ × (θ × a)/2 in a rotation θ of its leader.
    pub(super) fn link_stiffness(&self, displacement: &[f64], gravity: f64) -> Result<Entries> {
        let mut entries = Entries::new();
        let Some(links) = &self.links else { return Ok(entries) };
        let follower_forces = self.mesh_forces(displacement, gravity)?;
        for Follower { node, leader, is_body } in links.followers() {
            let follower_point = self.mesh.nodes()[node];
            let leader_point = self.mesh.nodes()[leader];
            let arm: [f64; 3] =
                std::array::from_fn(|axis| follower_point[axis] - leader_point[axis]);
            let force = [Direction::X, Direction::Y, Direction::Z].map(|direction| {
                // A diaphragm ties its nodes in its plane only.
                let is_tied = is_body || direction != Direction::Z;
                let dof = self.numbering.dof(node, direction).filter(|_| is_tied);
                dof.map_or(0.0, |dof| follower_forces[dof])
            });
            let trace = dot(&arm, &force);
            let tied_rotations =
                self.rotations().iter().filter(|rotation| is_body || rotation.axis == 2);
            let rotation_dofs: Vec<(usize, usize)> = tied_rotations
                .filter_map(|rotation| Some((rotation.axis, self.dof(leader, rotation.direction)?)))
                .collect();
            for &(i, row) in &rotation_dofs {
                for &(j, column) in &rotation_dofs {
                    let product = 0.5 * (force[i] * arm[j] + arm[i] * force[j]);
                    entries.push((row, column, if i == j { product - trace } else { product }));
                }
            }
        }
        Ok(entries)
    }

    /// Forces of the elements less the weight, one for each degree of freedom of the mesh.
    ///
    /// These are the forces that followers of rigid links exert on their leaders.
    fn mesh_forces(&self, displacement: &[f64], gravity: f64) -> Result<Vec<f64>> {
        let n = self.numbering.dofs();
        let mut upwards = vec![0.0; n];
        let up_direction = self.mesh.up_direction();
        self.fill_rigid_motion(up_direction, [0.0; 3], &mut upwards, |node, direction| {
            self.numbering.dof(node, direction)
        });
        let mesh_displacement: Vec<f64> =
            (0..n).map(|dof| self.remaining_row(vec![(dof, 1.0)]).value(displacement)).collect();
        let mut forces = vec![0.0; n];
        let stiffness = self.mesh_matrix(MatrixKind::Stiffness)?;
        stiffness.multiply_add(1.0, &mesh_displacement, &mut forces);
        let mass = self.mesh_matrix(MatrixKind::Mass(self.mass_kind))?;
        mass.multiply_add(gravity, &upwards, &mut forces);
        Ok(forces)
    }

    /// Adds the geometric stiffness of the base to the `entries` of the links.
    ///
    /// `displacement` is the static state under `gravity` (m/s²).
    pub(super) fn add_base_stiffness(
        &self,
        displacement: &[f64],
        gravity: f64,
        entries: &mut Entries,
    ) -> Result<()> {
        let Some(base) = BaseRotations::new(self) else { return Ok(()) };
        let geometric_stiffness = {
            let mut matrix = Triplets::new(self.dofs());
            self.add_matrices(&mut matrix, &[(MatrixKind::GeometricStiffness, 1.0)]);
            matrix.extend(entries.iter().copied());
            SparseMatrix::new("geometric stiffness matrix", &matrix)?
        };
        let mut surplus_forces = self.equilibrium_forces(&base, displacement, gravity)?;
        let mut max_force = surplus_forces.iter().map(|forces| largest(forces)).fold(0.0, f64::max);
        for (forces, motion) in surplus_forces.iter_mut().zip(&base.rigid_rotations) {
            for force in forces.iter_mut() {
                *force = -*force;
            }
            geometric_stiffness.multiply_add(1.0, motion, forces);
        }
        max_force = surplus_forces.iter().map(|forces| largest(forces)).fold(max_force, f64::max);
        for force in surplus_forces.iter_mut().flatten() {
            if force.abs() <= FORCE_ROUNDING_RATIO * max_force {
                *force = 0.0;
            }
        }
        base.remove_forces(&surplus_forces, entries);
        Ok(())
    }

    /// Product of the mass and an `acceleration` (m/s²) in `direction`.
    fn inertia_forces(
        &self,
        mass: &SparseMatrix,
        direction: Direction,
        acceleration: f64,
    ) -> Vec<f64> {
        let mut forces = vec![0.0; self.dofs()];
        let motion = self.rigid_motion(direction, [0.0; 3]);
        mass.multiply_add(acceleration, &motion, &mut forces);
        forces
    }

    /// Forces T in equilibrium with the structure in rigid rotations of `base`, one list for each rotation.
    fn equilibrium_forces(
        &self,
        base: &BaseRotations,
        displacement: &[f64],
        gravity: f64,
    ) -> Result<Vec<Vec<f64>>> {
        let n = self.dofs();
        let mass = self.model_matrix(MatrixKind::Mass(self.mass_kind))?;
        let up_direction = self.mesh.up_direction();
        let mut reactions = self.inertia_forces(&mass, up_direction, gravity);
        self.model_matrix(MatrixKind::Stiffness)?
            .multiply_add(1.0, displacement, &mut reactions);
        let is_base_dof = self.is_base_dof();
        let mut force_lists = Vec::with_capacity(base.rigid_rotations.len());
        for rotation in self.rotations() {
            // In this rotation the end of a vertical unit vector moves by `factor` along `horizontal`.
            let (horizontal, factor) = match rotation.direction {
                Direction::Rotation => (Direction::X, -1.0),
                Direction::RotationX => (Direction::Y, -1.0),
                Direction::RotationY => (Direction::X, 1.0),
                _ => {
                    force_lists.push(vec![0.0; n]);
                    continue;
                }
            };
            let mut forces = self.inertia_forces(&mass, horizontal, -factor * gravity);
            let weight_moments: Vec<f64> =
                base.rigid_rotations.iter().map(|motion| dot(motion, &forces)).collect();
            for node in 0..self.mesh.nodes().len() {
                let vertical_dof = self.dof(node, up_direction).filter(|&dof| is_base_dof[dof]);
                let horizontal_dof = self.dof(node, horizontal).filter(|&dof| is_base_dof[dof]);
                if let (Some(vertical_dof), Some(horizontal_dof)) = (vertical_dof, horizontal_dof) {
                    forces[horizontal_dof] += factor * reactions[vertical_dof];
                }
            }
            // Vertical reactions act at the contact nodes. Their moments about the nodes with these degrees of freedom,
            // such as the leader of a rigid base, act on the base.
            for (axis, motion) in base.rigid_rotations.iter().enumerate() {
                let is_vertical = self.rotations()[axis].direction == Direction::RotationZ;
                let required_moment = if is_vertical { 0.0 } else { weight_moments[axis] };
                let missing_moment = required_moment - dot(motion, &forces);
                for &(dof, weight) in &base.mean_rotations[axis] {
                    forces[dof] += missing_moment * weight;
                }
            }
            force_lists.push(forces);
        }
        Ok(force_lists)
    }
}

/// Mean rotations of a base, and the rigid rotations of the structure with it.
struct BaseRotations {
    /// Columns of R.
    rigid_rotations: Vec<Vec<f64>>,
    /// Rows of Q.
    mean_rotations: Vec<DofCombination>,
}

impl BaseRotations {
    /// Rotations of a model's base; `None` for a base without width.
    fn new(model: &FemModel) -> Option<Self> {
        let base = model.base();
        let floor_nodes: Vec<BaseNode> =
            base.parts().iter().flat_map(|part| BaseNode::floor(part)).cloned().collect();
        let nodes = outermost_nodes(&floor_nodes);
        let mean_rotations = if model.mesh.has_depth() {
            let [slope_right, slope_away, vertical_rotation] = BaseNode::mean_rotations(&nodes);
            vec![slope_away, -slope_right, vertical_rotation]
        } else {
            let left_end = nodes.iter().min_by(|a, b| a.x.total_cmp(&b.x))?;
            let right_end = nodes.iter().max_by(|a, b| a.x.total_cmp(&b.x))?;
            let rise = right_end.vertical.clone() - left_end.vertical.clone();
            vec![(1.0 / (right_end.x - left_end.x)) * rise]
        };
        let up_axis = model.mesh.up_axis();
        let foot_heights = model
            .feet
            .iter()
            .flatten()
            .map(|foot| model.mesh.nodes()[foot.node][up_axis] - foot.depth);
        let weight = 1.0 / nodes.len() as f64;
        let x = nodes.iter().map(|node| node.x).sum::<f64>() * weight;
        let y = nodes.iter().map(|node| node.y).sum::<f64>() * weight;
        let mut center = [x, y, 0.0];
        center[up_axis] = foot_heights.reduce(f64::min)?;
        let rotations = model.rotations().iter();
        let rigid_rotations =
            rotations.map(|rotation| model.rigid_motion(rotation.direction, center)).collect();
        let mut terms = mean_rotations.iter().flatten();
        terms
            .all(|(_, weight)| weight.is_finite())
            .then_some(Self { rigid_rotations, mean_rotations })
    }

    /// Adds the matrix `entries` that subtract the surplus forces D from the forces of rigid rotations.
    fn remove_forces(&self, surplus_forces: &[Vec<f64>], entries: &mut Entries) {
        for (a, row) in self.mean_rotations.iter().enumerate() {
            let nonzero_forces =
                surplus_forces[a].iter().enumerate().filter(|(_, force)| **force != 0.0);
            for (dof, &force) in nonzero_forces {
                for &(base_dof, weight) in row {
                    entries.push((dof, base_dof, -force * weight));
                    entries.push((base_dof, dof, -force * weight));
                }
            }
            for (b, column) in self.mean_rotations.iter().enumerate() {
                let moment = 0.5
                    * (dot(&self.rigid_rotations[a], &surplus_forces[b])
                        + dot(&self.rigid_rotations[b], &surplus_forces[a]));
                for &(i, row_weight) in row.iter().filter(|_| moment != 0.0) {
                    for &(j, column_weight) in column {
                        entries.push((i, j, moment * row_weight * column_weight));
                    }
                }
            }
        }
    }
}

/// Outermost nodes of a base in eight directions, each once.
///
/// Of several equally distant nodes in a direction, the two ends of their row are returned. Few nodes suffice for the
/// mean rotations of a base, and keep the matrix sparse. The choice depends on the coordinates only, not on the
/// numbering.
fn outermost_nodes(nodes: &[BaseNode]) -> Vec<BaseNode> {
    let direction_grid = [-1.0, 0.0, 1.0].map(|x| [-1.0, 0.0, 1.0].map(|y| [x, y]));
    let mut outermost: Vec<BaseNode> = Vec::new();
    for [x, y] in direction_grid.into_iter().flatten().filter(|direction| *direction != [0.0; 2]) {
        let distances: Vec<f64> = nodes.iter().map(|node| x * node.x + y * node.y).collect();
        let distance_range = span(distances.iter().copied());
        let max_distance = distance_range[1];
        let tolerance = DISTANCE_ROUNDING_RATIO * (max_distance - distance_range[0]);
        let row_coordinate = |node: &BaseNode| x * node.y - y * node.x;
        let node_row = nodes
            .iter()
            .zip(&distances)
            .filter(|(_, distance)| **distance >= max_distance - tolerance)
            .map(|(node, _)| node);
        let first_end =
            node_row.clone().min_by(|a, b| row_coordinate(a).total_cmp(&row_coordinate(b)));
        let second_end = node_row.max_by(|a, b| row_coordinate(a).total_cmp(&row_coordinate(b)));
        for node in first_end.into_iter().chain(second_end) {
            if outermost.iter().all(|outer_node| outer_node.place() != node.place()) {
                outermost.push(node.clone());
            }
        }
    }
    outermost
}
