//! Geometric stiffness by which the static forces of an element turn with the element.
//!
//! An element with the axial force alone in its geometric stiffness leaves shears and moments behind when it rotates.
//! The forces at its nodes then are no longer in equilibrium with the weights, and a rigid rotation of the structure
//! meets forces. The mean rotation of the element carries all its forces along, as in corotational elements
//! (Felippa & Haugen 2005, CMAME 194, 2285–2335; the rotational and the equilibrium geometric stiffness).
//!
//! | symbol | meaning |
//! |---|---|
//! | f | forces K u at the nodes in the static state |
//! | R | displacements of the nodes in rigid rotations by 1 rad, one column an axis |
//! | G | mean rotations of the element by its displacements, one row an axis; G R = 1 |
//! | T | change of the forces in these rotations: f turns, the element's own weight does not |
//! | A | T − K_G R, with the element's own geometric stiffness K_G |
//!
//! K_G + A G + (A G)ᵀ − Gᵀ(RᵀA)G is symmetric, gives the forces T in a rigid rotation, and none in a translation.

use super::element::{Element, MassKind};
use super::vector::{add, cross, direction, dot};
use crate::geometry::Direction;

/// Forces below this fraction of the element's largest force are rounding.
const ROUNDING_OF_FORCES: f64 = 1e-12;
/// Imbalance of an element's forces, relative to the largest, above which they cannot turn with it.
const MAX_FORCE_IMBALANCE: f64 = 1e-8;
/// Distance of nodes from a line, relative to the size of the element, at which they count as on it.
const MAX_DISTANCE_FROM_LINE: f64 = 1e-6;

/// Static state in which the forces of an element are computed.
pub(super) struct StaticState<'a> {
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

/// Geometric stiffness A G + (A G)ᵀ − Gᵀ(RᵀA)G by its factors, which take a fourth of the matrix of a brick.
#[derive(Clone)]
pub(crate) struct ForceRotation {
    /// Columns of A, one an axis.
    missing: Vec<Vec<f64>>,
    /// Rows of G.
    rotations: Vec<Vec<f64>>,
    /// RᵀA.
    products: Vec<Vec<f64>>,
}

impl ForceRotation {
    /// Adds the matrix, row-major, to `block`.
    pub(super) fn add_to(&self, block: &mut [f64]) {
        let Self { missing, rotations, products } = self;
        for ((a, rotation), missing) in rotations.iter().enumerate().zip(missing) {
            let order = rotation.len();
            // Half of −(RᵀA)G belongs to each of the two products.
            let mut column = missing.clone();
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

/// Geometric stiffness to add to the one of `element`.
///
/// `None` if the element carries no other forces than its geometric stiffness has, or if its forces cannot turn with
/// it: an element that does not move in all directions, with all nodes at one place, or with forces that are not in
/// equilibrium.
pub(super) fn force_rotation(
    element: &dyn Element,
    points: &[[f64; 3]],
    state: &StaticState,
) -> Option<ForceRotation> {
    let nodes = Nodes::new(element, points, state.has_depth)?;
    let order = nodes.places.len();
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
    // Dead load of the element when its weight has the direction `way`.
    let load = |way: [f64; 3]| {
        let mut load = times(&matrix, &nodes.translation(way));
        for value in &mut load {
            *value *= -state.gravity;
        }
        load
    };
    let weight = load(up);
    let mut own = vec![0.0; order * order];
    element.geometric_stiffness(points, &mut own);
    let axes = if state.has_depth { AXES_OF_SPACE } else { AXES_OF_THE_PLANE };
    let motions: Vec<Vec<f64>> = axes.iter().map(|axis| nodes.rotation(axis.0)).collect();
    let mut missing = Vec::with_capacity(axes.len());
    for ((_, axis), motion) in axes.iter().zip(&motions) {
        // Forces of the weight keep their direction; moments of distributed weight follow the element.
        let turned = nodes.turned(*axis, &force);
        let turned_weight = nodes.turned(*axis, &weight);
        let dead_weight = load(cross(*axis, up));
        let present = times(&own, motion);
        let change = |k: usize| turned[k] - turned_weight[k] + dead_weight[k] - present[k];
        missing.push((0..order).map(change).collect::<Vec<f64>>());
    }
    let largest_missing = missing.iter().map(|part| nodes.largest(part)).fold(0.0, f64::max);
    if largest_missing <= ROUNDING_OF_FORCES * largest
        || !nodes.is_balanced(&force, largest)
        || !missing.iter().all(|part| nodes.is_balanced_in_translation(part, largest))
    {
        return None;
    }
    let rotations = nodes.mean_rotations(axes);
    let products = symmetric_products(&motions, &missing);
    Some(ForceRotation { missing, rotations, products })
}

/// Symmetric part of the products of `motions` with `forces`.
fn symmetric_products(motions: &[Vec<f64>], forces: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let product =
        |motion: &[f64], force: &[f64]| motion.iter().zip(force).map(|(a, b)| a * b).sum::<f64>();
    (0..motions.len())
        .map(|a| {
            (0..motions.len())
                .map(|b| {
                    0.5 * (product(&motions[a], &forces[b]) + product(&motions[b], &forces[a]))
                })
                .collect()
        })
        .collect()
}

/// A square row-major `matrix` times a vector.
fn times(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    let rows = matrix.chunks_exact(vector.len().max(1));
    rows.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum()).collect()
}

/// Places of an element's nodes relative to their mean, and its degrees of freedom.
struct Nodes {
    arms: Vec<[f64; 3]>,
    /// Node, direction, axis (0 to 2) and kind of each degree of freedom.
    places: Vec<Place>,
    /// Largest distance of a node from the mean, m.
    size: f64,
}

#[derive(Clone, Copy)]
struct Place {
    node: usize,
    direction: Direction,
    axis: usize,
    is_rotation: bool,
}

impl Nodes {
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
        let share = 1.0 / points.len() as f64;
        let mean = points.iter().fold([0.0; 3], |sum, point| add(sum, share, *point));
        let arms: Vec<[f64; 3]> = points.iter().map(|point| add(*point, -1.0, mean)).collect();
        let size = arms.iter().map(|arm| direction(*arm).0).fold(0.0, f64::max);
        let place = |node: usize, direction: Direction| Place {
            node,
            direction,
            axis: match direction {
                Direction::X | Direction::RotationX => 0,
                Direction::Y | Direction::RotationY => 1,
                Direction::Z | Direction::RotationZ | Direction::Rotation => 2,
            },
            is_rotation: direction.is_rotation(),
        };
        let of_node = |node: usize| directions.iter().map(move |&own| place(node, own));
        let places: Vec<Place> = (0..points.len()).flat_map(of_node).collect();
        (size > 0.0).then_some(Self { arms, places, size })
    }

    /// Forces and moments at each node.
    fn vectors(&self, values: &[f64]) -> Vec<[[f64; 3]; 2]> {
        let mut vectors = vec![[[0.0; 3]; 2]; self.arms.len()];
        for (place, value) in self.places.iter().zip(values) {
            vectors[place.node][usize::from(place.is_rotation)][place.axis] = *value;
        }
        vectors
    }

    /// Change of nodal forces that turn by 1 rad about an axis.
    ///
    /// Moments change by half of their rotation: they belong to rotation vectors, whose moments are semitangential
    /// (Argyris 1979).
    fn turned(&self, axis: [f64; 3], values: &[f64]) -> Vec<f64> {
        let vectors = self.vectors(values);
        let turned = |place: &Place| {
            let factor = if place.is_rotation { 0.5 } else { 1.0 };
            factor * cross(axis, vectors[place.node][usize::from(place.is_rotation)])[place.axis]
        };
        self.places.iter().map(turned).collect()
    }

    /// Displacements in a translation by the vector `way`.
    fn translation(&self, way: [f64; 3]) -> Vec<f64> {
        let part = |place: &Place| if place.is_rotation { 0.0 } else { way[place.axis] };
        self.places.iter().map(part).collect()
    }

    /// Displacements in a rotation by 1 rad about the mean of the nodes.
    fn rotation(&self, motion: Direction) -> Vec<f64> {
        let part = |place: &Place| place.direction.in_rigid_motion(motion, self.arms[place.node]);
        self.places.iter().map(part).collect()
    }

    /// Largest force; moments count by the size of the element.
    fn largest(&self, values: &[f64]) -> f64 {
        let force = |(place, value): (&Place, &f64)| {
            if place.is_rotation { value.abs() / self.size } else { value.abs() }
        };
        self.places.iter().zip(values).map(force).fold(0.0, f64::max)
    }

    fn is_balanced_in_translation(&self, values: &[f64], largest: f64) -> bool {
        let vectors = self.vectors(values);
        let sum = vectors.iter().fold([0.0; 3], |sum, [force, _]| add(sum, 1.0, *force));
        direction(sum).0 <= MAX_FORCE_IMBALANCE * largest
    }

    /// Whether nodal forces have no resultant.
    fn is_balanced(&self, values: &[f64], largest: f64) -> bool {
        let vectors = self.vectors(values);
        let moment = vectors.iter().zip(&self.arms).fold([0.0; 3], |sum, ([force, own], arm)| {
            add(add(sum, 1.0, *own), 1.0, cross(*arm, *force))
        });
        self.is_balanced_in_translation(values, largest)
            && direction(moment).0 <= MAX_FORCE_IMBALANCE * largest * self.size
    }

    /// Mean rotations of the element about `axes`, as rows over its displacements.
    ///
    /// The rotation that fits the displacements of the nodes best; about the line of nodes that lie on one line, the
    /// mean of the nodes' rotations, or zero without them.
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
        let far = |a: &&[f64; 3], b: &&[f64; 3]| direction(**a).0.total_cmp(&direction(**b).0);
        let farthest = self.arms.iter().max_by(far).copied().unwrap_or_default();
        let (_, along) = direction(farthest);
        let is_near =
            |arm: &[f64; 3]| direction(cross(*arm, along)).0 <= MAX_DISTANCE_FROM_LINE * self.size;
        let line = self.arms.iter().all(is_near).then_some(along);
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
        let turning: Vec<Direction> =
            self.places.iter().filter(|own| own.is_rotation).map(|own| own.direction).collect();
        let spins = AXES_OF_SPACE.iter().all(|(own, _)| turning.contains(own));
        let count = self.arms.len() as f64;
        let row = |axis: &[f64; 3]| {
            let weights: [f64; 3] =
                std::array::from_fn(|k| (0..3).map(|i| axis[i] * inverse[i][k]).sum());
            let part = |place: &Place| match (place.is_rotation, line) {
                // weights · (arm × u)
                (false, _) => cross(weights, self.arms[place.node])[place.axis],
                (true, Some(along)) if spins => dot(*axis, along) * along[place.axis] / count,
                (true, _) => 0.0,
            };
            self.places.iter().map(part).collect()
        };
        axes.iter().map(|(_, axis)| row(axis)).collect()
    }
}

/// Inverse of a symmetric matrix of order 3.
fn inverse(matrix: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let [a, b, c] = *matrix;
    let columns = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant = dot(a, columns[0]);
    // Symmetric: rows of the inverse are its columns.
    columns.map(|column| column.map(|value| value / determinant))
}
