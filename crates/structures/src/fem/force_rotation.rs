//! Geometric stiffness of static forces that rotate with their element.
//!
//! If an element's geometric stiffness has the axial force alone, shears and moments keep their directions when it
//! rotates. The nodal forces are then not in equilibrium with the weights, and a rigid rotation of the structure causes
//! forces. Here all forces rotate with the mean rotation of the element, as in corotational elements
//! (Felippa & Haugen 2005, CMAME 194, 2285–2335; the rotational and the equilibrium geometric stiffness).
//!
//! | symbol | meaning |
//! |---|---|
//! | f | forces K u at the nodes in the static state |
//! | R | displacements of the nodes in rigid rotations by 1 rad, one column an axis |
//! | G | mean rotations of the element by its displacements, one row an axis; G R = 1 |
//! | T | change of the forces in these rotations: f turns, the element's weight does not |
//! | A | T − K_G R, with the element's geometric stiffness K_G |
//!
//! K_G + A G + (A G)ᵀ − Gᵀ(RᵀA)G is symmetric, gives the forces T in a rigid rotation, and none in a translation.

use super::element::{Element, MassKind};
use super::vector::{add, cross, dot, length, unit};
use crate::geometry::Direction;

/// Forces below this fraction of the element's largest force are rounding.
const ROUNDING_OF_FORCES: f64 = 1e-12;
/// Imbalance of an element's forces, relative to the largest, above which they cannot turn with it.
const MAX_FORCE_IMBALANCE: f64 = 1e-8;
/// Largest distance of nodes that lie on a line, relative to the size of the element.
const MAX_DISTANCE_FROM_LINE: f64 = 1e-6;

/// Static state in which the forces of an element are computed.
pub(super) struct ElementStaticState<'a> {
    /// Displacements of the element's degrees of freedom, m and rad.
    pub(super) displacement: &'a [f64],
    /// Acceleration of gravity, m/s².
    pub(super) gravity: f64,
    pub(super) mass_kind: MassKind,
    /// Whether the mesh lies in space.
    pub(super) has_depth: bool,
}

/// Axes of rotation of a mesh, and their directions.
type Axis = (Direction, [f64; 3]);
const AXES_OF_THE_PLANE: &[Axis] = &[(Direction::Rotation, [0.0, 0.0, 1.0])];
const AXES_OF_SPACE: &[Axis] = &[
    (Direction::RotationX, [1.0, 0.0, 0.0]),
    (Direction::RotationY, [0.0, 1.0, 0.0]),
    (Direction::RotationZ, [0.0, 0.0, 1.0]),
];

/// Geometric stiffness A G + (A G)ᵀ − Gᵀ(RᵀA)G, stored as its factors.
///
/// For a brick they take a fourth of the matrix' memory.
#[derive(Clone)]
pub(crate) struct ForceRotation {
    /// Columns of A, one an axis.
    added_forces: Vec<Vec<f64>>,
    /// Rows of G.
    rotations: Vec<Vec<f64>>,
    /// RᵀA.
    products: Vec<Vec<f64>>,
}

impl ForceRotation {
    /// Adds the matrix, row-major, to `block`.
    pub(super) fn add_to(&self, block: &mut [f64]) {
        let Self { added_forces, rotations, products } = self;
        for ((a, rotation), added_forces) in rotations.iter().enumerate().zip(added_forces) {
            let order = rotation.len();
            // Half of −(RᵀA)G belongs to each of the two products.
            let mut column = added_forces.clone();
            for (product, other) in products[a].iter().zip(rotations) {
                let pairs = column.iter_mut().zip(other);
                pairs.for_each(|(value, weight)| *value -= 0.5 * product * weight);
            }
            for (i, row) in block.chunks_exact_mut(order).enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += column[i] * rotation[j] + rotation[i] * column[j];
                }
            }
        }
    }
}

/// Geometric stiffness to add to the element's.
///
/// `None` if the element's geometric stiffness has all its forces already, or if its forces cannot rotate with it:
/// for an element that does not move in all directions, with all nodes at one place, or with forces that are not in
/// equilibrium.
pub(super) fn force_rotation(
    element: &dyn Element,
    points: &[[f64; 3]],
    state: &ElementStaticState,
) -> Option<ForceRotation> {
    let nodes = ElementNodes::new(element, points, state.has_depth)?;
    let order = nodes.dofs.len();
    let mut matrix = vec![0.0; order * order];
    element.stiffness(points, &mut matrix);
    let force = times(&matrix, state.displacement);
    let largest = nodes.largest(&force);
    if largest == 0.0 || !largest.is_finite() {
        return None;
    }
    matrix.fill(0.0);
    element.mass(points, state.mass_kind, &mut matrix);
    let up = if state.has_depth { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
    // Dead load of the element when gravity acts against the direction `upwards`.
    let dead_load = |upwards: [f64; 3]| {
        let mut load = times(&matrix, &nodes.translation(upwards));
        for value in &mut load {
            *value *= -state.gravity;
        }
        load
    };
    let weight = dead_load(up);
    let mut geometric_stiffness = vec![0.0; order * order];
    element.geometric_stiffness(points, &mut geometric_stiffness);
    let axes = if state.has_depth { AXES_OF_SPACE } else { AXES_OF_THE_PLANE };
    let motions: Vec<Vec<f64>> = axes.iter().map(|axis| nodes.rotation(axis.0)).collect();
    let mut added_forces = Vec::with_capacity(axes.len());
    for ((_, axis), motion) in axes.iter().zip(&motions) {
        // Forces of the weight keep their direction; moments of distributed weight follow the element.
        let turned = nodes.turned(*axis, &force);
        let turned_weight = nodes.turned(*axis, &weight);
        let dead_weight = dead_load(cross(*axis, up));
        let element_forces = times(&geometric_stiffness, motion);
        let mut added = Vec::with_capacity(order);
        for k in 0..order {
            added.push(turned[k] - turned_weight[k] + dead_weight[k] - element_forces[k]);
        }
        added_forces.push(added);
    }
    let largest_added = added_forces.iter().map(|part| nodes.largest(part)).fold(0.0, f64::max);
    if largest_added <= ROUNDING_OF_FORCES * largest
        || !nodes.is_balanced(&force, largest)
        || !added_forces.iter().all(|part| nodes.is_balanced_in_translation(part, largest))
    {
        return None;
    }
    let rotations = nodes.mean_rotations(axes);
    let products = symmetric_products(&motions, &added_forces);
    Some(ForceRotation { added_forces, rotations, products })
}

/// Symmetric part of the products of `motions` with `forces`.
fn symmetric_products(motions: &[Vec<f64>], forces: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let count = motions.len();
    let mut products = vec![vec![0.0; count]; count];
    for a in 0..count {
        for b in 0..count {
            products[a][b] = 0.5
                * (sum_of_products(&motions[a], &forces[b])
                    + sum_of_products(&motions[b], &forces[a]));
        }
    }
    products
}

fn sum_of_products(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A square row-major `matrix` times a vector.
fn times(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    let rows = matrix.chunks_exact(vector.len().max(1));
    rows.map(|row| sum_of_products(row, vector)).collect()
}

/// Places of an element's nodes relative to their mean, and its degrees of freedom.
struct ElementNodes {
    arms: Vec<[f64; 3]>,

    dofs: Vec<ElementDof>,
    /// Largest distance of a node from the mean, m.
    size: f64,
}

/// Degree of freedom of an element.
#[derive(Clone, Copy)]
struct ElementDof {
    /// Place of the node in the element's list.
    node: usize,
    direction: Direction,
    /// Axis of the displacement or rotation, 0 to 2.
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
    /// Nodes of an element that moves in all directions; `None` for another one.
    fn new(element: &dyn Element, points: &[[f64; 3]], has_depth: bool) -> Option<Self> {
        let directions = element.directions();
        let needed: &[Direction] = if has_depth {
            &[Direction::X, Direction::Y, Direction::Z]
        } else {
            &[Direction::X, Direction::Y]
        };
        if !needed.iter().all(|direction| directions.contains(direction)) {
            return None;
        }
        let mean_weight = 1.0 / points.len() as f64;
        let mean = points.iter().fold([0.0; 3], |sum, point| add(sum, mean_weight, *point));
        let arms: Vec<[f64; 3]> = points.iter().map(|point| add(*point, -1.0, mean)).collect();
        let size = arms.iter().map(|arm| length(*arm)).fold(0.0, f64::max);
        let mut dofs = Vec::with_capacity(element.order());
        for node in 0..points.len() {
            dofs.extend(directions.iter().map(|&direction| ElementDof::new(node, direction)));
        }
        (size > 0.0).then_some(Self { arms, dofs, size })
    }

    /// Forces and moments at each node.
    fn vectors(&self, values: &[f64]) -> Vec<[[f64; 3]; 2]> {
        let mut vectors = vec![[[0.0; 3]; 2]; self.arms.len()];
        for (dof, value) in self.dofs.iter().zip(values) {
            vectors[dof.node][usize::from(dof.is_rotation)][dof.axis] = *value;
        }
        vectors
    }

    /// Change of nodal forces that turn by 1 rad about an axis.
    ///
    /// Moments change by half of their rotation: they belong to rotation vectors, whose moments are semitangential
    /// (Argyris 1979).
    fn turned(&self, axis: [f64; 3], values: &[f64]) -> Vec<f64> {
        let vectors = self.vectors(values);
        let mut turned = Vec::with_capacity(values.len());
        for dof in &self.dofs {
            let factor = if dof.is_rotation { 0.5 } else { 1.0 };
            let vector = vectors[dof.node][usize::from(dof.is_rotation)];
            turned.push(factor * cross(axis, vector)[dof.axis]);
        }
        turned
    }

    /// Displacements in a translation by the vector `direction`.
    fn translation(&self, direction: [f64; 3]) -> Vec<f64> {
        let dofs = self.dofs.iter();
        dofs.map(|dof| if dof.is_rotation { 0.0 } else { direction[dof.axis] }).collect()
    }

    /// Displacements in a rotation by 1 rad about the mean of the nodes.
    fn rotation(&self, motion: Direction) -> Vec<f64> {
        let dofs = self.dofs.iter();
        dofs.map(|dof| dof.direction.in_rigid_motion(motion, self.arms[dof.node])).collect()
    }

    /// Largest force; moments are divided by the size of the element.
    fn largest(&self, values: &[f64]) -> f64 {
        let mut largest = 0.0_f64;
        for (dof, value) in self.dofs.iter().zip(values) {
            let force = if dof.is_rotation { value.abs() / self.size } else { value.abs() };
            largest = largest.max(force);
        }
        largest
    }

    fn is_balanced_in_translation(&self, values: &[f64], largest: f64) -> bool {
        let vectors = self.vectors(values);
        let sum = vectors.iter().fold([0.0; 3], |sum, [force, _]| add(sum, 1.0, *force));
        length(sum) <= MAX_FORCE_IMBALANCE * largest
    }

    /// Whether nodal forces have no resultant.
    fn is_balanced(&self, values: &[f64], largest: f64) -> bool {
        let vectors = self.vectors(values);
        let mut moment = [0.0; 3];
        for ([force, nodal_moment], arm) in vectors.iter().zip(&self.arms) {
            moment = add(add(moment, 1.0, *nodal_moment), 1.0, cross(*arm, *force));
        }
        self.is_balanced_in_translation(values, largest)
            && length(moment) <= MAX_FORCE_IMBALANCE * largest * self.size
    }

    /// Mean rotations of the element about `axes`, as rows over its displacements.
    ///
    /// It is the rotation that fits the displacements of the nodes best. If the nodes lie on one line, the rotation
    /// about that line is the mean of the nodes' rotations, or zero without them.
    fn mean_rotations(&self, axes: &[Axis]) -> Vec<Vec<f64>> {
        let mut inertia = [[0.0; 3]; 3];
        for arm in &self.arms {
            let square = dot(*arm, *arm);
            for i in 0..3 {
                for j in 0..3 {
                    let diagonal = if i == j { square } else { 0.0 };
                    inertia[i][j] += diagonal - arm[i] * arm[j];
                }
            }
        }
        let line = self.line();
        let inverse = match line {
            Some(along) => {
                let moment: f64 = self.arms.iter().map(|arm| dot(*arm, *arm)).sum();
                std::array::from_fn(|i| {
                    std::array::from_fn(|j| {
                        let diagonal = if i == j { 1.0 } else { 0.0 };
                        (diagonal - along[i] * along[j]) / moment
                    })
                })
            }
            None => inverse(&inertia),
        };
        let has_all_rotations = AXES_OF_SPACE
            .iter()
            .all(|(rotation, _)| self.dofs.iter().any(|dof| dof.direction == *rotation));
        let count = self.arms.len() as f64;
        let mut rows = Vec::with_capacity(axes.len());
        for (_, axis) in axes {
            let weights: [f64; 3] =
                std::array::from_fn(|k| (0..3).map(|i| axis[i] * inverse[i][k]).sum());
            let mut row = Vec::with_capacity(self.dofs.len());
            for dof in &self.dofs {
                row.push(match (dof.is_rotation, line) {
                    // weights · (arm × u)
                    (false, _) => cross(weights, self.arms[dof.node])[dof.axis],
                    (true, Some(along)) if has_all_rotations => {
                        dot(*axis, along) * along[dof.axis] / count
                    }
                    (true, _) => 0.0,
                });
            }
            rows.push(row);
        }
        rows
    }

    /// Direction of the line on which all nodes lie; `None` if they do not.
    fn line(&self) -> Option<[f64; 3]> {
        let farthest = self
            .arms
            .iter()
            .max_by(|a, b| length(**a).total_cmp(&length(**b)))
            .copied()
            .unwrap_or_default();
        let along = unit(farthest);
        let limit = MAX_DISTANCE_FROM_LINE * self.size;
        self.arms.iter().all(|arm| length(cross(*arm, along)) <= limit).then_some(along)
    }
}

/// Inverse of a symmetric matrix of order 3.
fn inverse(matrix: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let columns =
        [cross(matrix[1], matrix[2]), cross(matrix[2], matrix[0]), cross(matrix[0], matrix[1])];
    let determinant = dot(matrix[0], columns[0]);
    // Symmetric: rows of the inverse are its columns.
    columns.map(|column| column.map(|value| value / determinant))
}
