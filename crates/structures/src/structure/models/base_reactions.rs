//! Geometric stiffness of P–Δ that no element has: rigid links, and reactions of the ground that turn with the base.
//!
//! The forces of the static state are in equilibrium with the weights and with the reactions at the held contact
//! nodes. In a rigid rotation the forces of the elements turn with them, and the weights keep their direction. The
//! reactions of the ground do as follows, so that a structure meets no force in a rotation about the vertical, and in a
//! rocking rotation the overturning moment of its weights about the height of the base:
//!
//! * vertical reactions keep their direction;
//! * other reactions, such as the thrust between the feet of a portal, hold each other through the base and turn with
//!   it. Ground and basemat share them in a way that the structure does not know.
//!
//! | symbol | meaning |
//! |---|---|
//! | K_G | geometric stiffness of elements and links |
//! | R | rigid rotations by 1 rad about the middle of the base, one column an axis |
//! | Q | mean rotations of the base by the degrees of freedom, one row an axis; Q R = 1 |
//! | T | forces that hold the structure in these rotations |
//! | D | K_G R − T, at degrees of freedom of the base |
//!
//! K_G − D Q − (D Q)ᵀ + Qᵀ(RᵀD)Q is symmetric and gives T in the rotations. Q and D have few entries each.

use super::rigid_links::Follower;
use crate::error::Result;
use crate::fem::{Direction, MatrixKind, assemble};
use crate::geometry::span;
use crate::linalg::{SparseMatrix, dot, largest};
use crate::structure::{BaseNode, DofCombination, FemModel, Structure, Triplets};

/// Forces below this fraction of the largest are rounding.
const ROUNDING_OF_FORCES: f64 = 1e-12;

/// Difference of two distances that counts as rounding, relative to the size of the base.
const SAME_DISTANCE: f64 = 1e-9;

type Entries = Vec<(usize, usize, f64)>;

/// Rotations of a mesh with the axes about which they turn.
const ROTATIONS_OF_THE_PLANE: &[(usize, Direction)] = &[(2, Direction::Rotation)];
const ROTATIONS_OF_SPACE: &[(usize, Direction)] =
    &[(0, Direction::RotationX), (1, Direction::RotationY), (2, Direction::RotationZ)];

impl FemModel {
    /// Whether each degree of freedom moves a contact node of the base's floor.
    ///
    /// Walls carry no weight at rest.
    pub(super) fn is_held(&self) -> Vec<bool> {
        let mut is_held = vec![false; self.dofs()];
        let base = self.base();
        let floors = base.parts().iter().flat_map(|part| BaseNode::floor(part));
        for dof in floors.flat_map(BaseNode::dofs) {
            is_held[dof] = true;
        }
        is_held
    }

    /// Axis and direction of each rotation.
    fn rotations(&self) -> &'static [(usize, Direction)] {
        if self.mesh.has_depth() { ROTATIONS_OF_SPACE } else { ROTATIONS_OF_THE_PLANE }
    }

    /// Sum of the elements' matrices by the degrees of freedom of the model.
    fn matrix_of(&self, quantity: MatrixKind) -> Result<SparseMatrix> {
        let mut matrix = Triplets::new(self.dofs());
        self.add(&mut matrix, &[(quantity, 1.0)]);
        SparseMatrix::new("matrix of the elements", &matrix)
    }

    /// Sum of the elements' matrices by the degrees of freedom of the mesh, before rigid links.
    fn mesh_matrix(&self, quantity: MatrixKind) -> Result<SparseMatrix> {
        let mut matrix = Triplets::new(self.numbering.dofs());
        assemble(&self.mesh, &self.numbering, quantity, 1.0, |_| true, &mut matrix);
        SparseMatrix::new("matrix of the elements", &matrix)
    }

    /// Geometric stiffness of rigid links: their followers move by θ × a + θ × (θ × a)/2 at the arm a.
    pub(super) fn rotation_of_links(&self, displacement: &[f64], gravity: f64) -> Result<Entries> {
        let mut entries = Entries::new();
        let Some(links) = &self.links else { return Ok(entries) };
        let n = self.numbering.dofs();
        let mut upwards = vec![0.0; n];
        self.fill_rigid_motion(self.mesh.upwards(), [0.0; 3], &mut upwards, |node, direction| {
            self.numbering.dof(node, direction)
        });
        let moved: Vec<f64> =
            (0..n).map(|dof| self.remaining_row(vec![(dof, 1.0)]).value(displacement)).collect();
        // Forces of the elements less the weight: what a follower exerts on its leader.
        let mut forces = vec![0.0; n];
        let stiffness = self.mesh_matrix(MatrixKind::Stiffness)?;
        stiffness.multiply_add(1.0, &moved, &mut forces);
        let mass = self.mesh_matrix(MatrixKind::Mass(self.mass_kind))?;
        mass.multiply_add(gravity, &upwards, &mut forces);
        for Follower { node, leader, is_body } in links.followers() {
            let place = self.mesh.nodes()[node];
            let origin = self.mesh.nodes()[leader];
            let arm: [f64; 3] = std::array::from_fn(|axis| place[axis] - origin[axis]);
            let force = [Direction::X, Direction::Y, Direction::Z].map(|direction| {
                // A diaphragm holds its nodes in its plane only.
                let is_tied = is_body || direction != Direction::Z;
                let dof = self.numbering.dof(node, direction).filter(|_| is_tied);
                dof.map_or(0.0, |dof| forces[dof])
            });
            let work = dot(&arm, &force);
            let turning = self.rotations().iter().filter(|(axis, _)| is_body || *axis == 2);
            let turning: Vec<(usize, usize)> = turning
                .filter_map(|&(axis, direction)| Some((axis, self.dof(leader, direction)?)))
                .collect();
            for &(i, row) in &turning {
                for &(j, column) in &turning {
                    let product = 0.5 * (force[i] * arm[j] + arm[i] * force[j]);
                    entries.push((row, column, if i == j { product - work } else { product }));
                }
            }
        }
        Ok(entries)
    }

    /// Adds the geometric stiffness of the base to the `entries` of the links.
    ///
    /// `displacement` is the static state under `gravity`.
    pub(super) fn add_base_reactions(
        &self,
        displacement: &[f64],
        gravity: f64,
        entries: &mut Entries,
    ) -> Result<()> {
        let Some(base) = MovingBase::new(self) else { return Ok(()) };
        let geometric = {
            let mut matrix = Triplets::new(self.dofs());
            self.add(&mut matrix, &[(MatrixKind::GeometricStiffness, 1.0)]);
            matrix.extend(entries.iter().copied());
            SparseMatrix::new("geometric stiffness matrix", &matrix)?
        };
        let mut surplus = self.forces_of_rotations(&base, displacement, gravity)?;
        let mut scale = surplus.iter().map(|target| largest(target)).fold(0.0, f64::max);
        for (target, motion) in surplus.iter_mut().zip(&base.motions) {
            for value in target.iter_mut() {
                *value = -*value;
            }
            geometric.multiply_add(1.0, motion, target);
        }
        scale = surplus.iter().map(|force| largest(force)).fold(scale, f64::max);
        for value in surplus.iter_mut().flatten() {
            if value.abs() <= ROUNDING_OF_FORCES * scale {
                *value = 0.0;
            }
        }
        base.remove(&surplus, entries);
        Ok(())
    }

    /// Forces of the mass under an `acceleration` (m/s²) in `direction`.
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

    /// Forces T that hold the structure in rigid rotations of `base`.
    fn forces_of_rotations(
        &self,
        base: &MovingBase,
        displacement: &[f64],
        gravity: f64,
    ) -> Result<Vec<Vec<f64>>> {
        let n = self.dofs();
        let mass = self.matrix_of(MatrixKind::Mass(self.mass_kind))?;
        let upwards = self.mesh.upwards();
        let mut reactions = self.inertia_forces(&mass, upwards, gravity);
        self.matrix_of(MatrixKind::Stiffness)?
            .multiply_add(1.0, displacement, &mut reactions);
        let is_held = self.is_held();
        let mut targets = Vec::with_capacity(base.motions.len());
        for (_, rotation) in self.rotations() {
            // In this rotation a vertical vector of length 1 moves by `factor` along `level`.
            let (level, factor) = match rotation {
                Direction::Rotation => (Direction::X, -1.0),
                Direction::RotationX => (Direction::Y, -1.0),
                Direction::RotationY => (Direction::X, 1.0),
                _ => {
                    targets.push(vec![0.0; n]);
                    continue;
                }
            };
            let mut target = self.inertia_forces(&mass, level, -factor * gravity);
            let moments: Vec<f64> =
                base.motions.iter().map(|motion| dot(motion, &target)).collect();
            for node in 0..self.mesh.nodes().len() {
                let up = self.dof(node, upwards).filter(|&dof| is_held[dof]);
                let level = self.dof(node, level).filter(|&dof| is_held[dof]);
                if let (Some(up), Some(level)) = (up, level) {
                    target[level] += factor * reactions[up];
                }
            }
            // Vertical reactions act on the contact nodes. Moments between these and the held nodes, such as the
            // leader of a rigid base, act on the base.
            for (a, motion) in base.motions.iter().enumerate() {
                let is_vertical = self.rotations()[a].1 == Direction::RotationZ;
                let needed = if is_vertical { 0.0 } else { moments[a] };
                let missing = needed - dot(motion, &target);
                for &(dof, weight) in &base.rows[a] {
                    target[dof] += missing * weight;
                }
            }
            targets.push(target);
        }
        Ok(targets)
    }
}

/// Mean rotations of a base, and the rigid rotations of the structure on it.
struct MovingBase {
    /// R.
    motions: Vec<Vec<f64>>,
    /// Q.
    rows: Vec<DofCombination>,
}

impl MovingBase {
    /// Rotations of a model's base; `None` for a base without width.
    fn new(model: &FemModel) -> Option<Self> {
        let base = model.base();
        let nodes: Vec<BaseNode> =
            base.parts().iter().flat_map(|part| BaseNode::floor(part)).cloned().collect();
        let nodes = outermost(&nodes);
        let rows = if model.mesh.has_depth() {
            let [right, away, turn] = BaseNode::mean_rotations(&nodes);
            vec![away, -right, turn]
        } else {
            let left = nodes.iter().min_by(|a, b| a.x.total_cmp(&b.x))?;
            let right = nodes.iter().max_by(|a, b| a.x.total_cmp(&b.x))?;
            let rise = right.vertical.clone() - left.vertical.clone();
            vec![(1.0 / (right.x - left.x)) * rise]
        };
        let heights = model.feet.iter().flatten();
        let heights =
            heights.map(|foot| model.mesh.nodes()[foot.node][model.mesh.up()] - foot.depth);
        let weight = 1.0 / nodes.len() as f64;
        let x = nodes.iter().map(|node| node.x).sum::<f64>() * weight;
        let y = nodes.iter().map(|node| node.y).sum::<f64>() * weight;
        let mut point = [x, y, 0.0];
        point[model.mesh.up()] = heights.reduce(f64::min)?;
        let motions = model.rotations().iter();
        let motions = motions.map(|(_, rotation)| model.rigid_motion(*rotation, point)).collect();
        let mut weights = rows.iter().flatten();
        weights.all(|(_, weight)| weight.is_finite()).then_some(Self { motions, rows })
    }

    /// Removes the `surplus` forces D from the forces of rigid rotations.
    fn remove(&self, surplus: &[Vec<f64>], entries: &mut Entries) {
        for (a, row) in self.rows.iter().enumerate() {
            for (dof, &force) in surplus[a].iter().enumerate().filter(|(_, force)| **force != 0.0) {
                for &(other, weight) in row {
                    entries.push((dof, other, -force * weight));
                    entries.push((other, dof, -force * weight));
                }
            }
            for (b, column) in self.rows.iter().enumerate() {
                let moment =
                    0.5 * (dot(&self.motions[a], &surplus[b]) + dot(&self.motions[b], &surplus[a]));
                for &(i, weight) in row.iter().filter(|_| moment != 0.0) {
                    for &(j, other) in column {
                        entries.push((i, j, moment * weight * other));
                    }
                }
            }
        }
    }
}

/// The nodes that lie farthest out in eight directions, each once; of several as far out the two ends of their row.
///
/// Few nodes suffice for the mean rotations of a base, and keep the matrix sparse. Their choice depends on their places
/// alone, whatever their numbers.
fn outermost(nodes: &[BaseNode]) -> Vec<BaseNode> {
    let ways = [-1.0, 0.0, 1.0].map(|x| [-1.0, 0.0, 1.0].map(|y| [x, y]));
    let mut found: Vec<BaseNode> = Vec::new();
    for [x, y] in ways.into_iter().flatten().filter(|way| *way != [0.0; 2]) {
        let distances: Vec<f64> = nodes.iter().map(|node| x * node.x + y * node.y).collect();
        let range = span(distances.iter().copied());
        let farthest = range[1];
        let slack = SAME_DISTANCE * (farthest - range[0]);
        let along = |node: &BaseNode| x * node.y - y * node.x;
        let outer = nodes.iter().zip(&distances);
        let outer = outer.filter(|(_, distance)| **distance >= farthest - slack);
        let row = outer.map(|(node, _)| node);
        let first = row.clone().min_by(|a, b| along(a).total_cmp(&along(b)));
        let last = row.max_by(|a, b| along(a).total_cmp(&along(b)));
        for node in first.into_iter().chain(last) {
            if found.iter().all(|other| other.place() != node.place()) {
                found.push(node.clone());
            }
        }
    }
    found
}
