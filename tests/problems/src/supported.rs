//! Meshes in space on supports: displacements, frequencies and buckling loads.
//!
//! Supports delete rows and columns of the matrices, which this file assembles from the elements.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use crate::dense::{eigenpairs, noise};
use basemat::fem::{Direction, Element, MassKind, Mesh};

pub const X: Direction = Direction::X;
pub const Y: Direction = Direction::Y;
pub const Z: Direction = Direction::Z;
pub const RX: Direction = Direction::RotationX;
pub const RY: Direction = Direction::RotationY;
pub const RZ: Direction = Direction::RotationZ;
pub const CLAMPED: [Direction; 6] = [X, Y, Z, RX, RY, RZ];
pub const HINGED: [Direction; 3] = [X, Y, Z];

/// Force (N) or moment (N m) at a node.
pub type Load = (usize, Direction, f64);

/// A matrix of the elements.
#[derive(Debug, Clone, Copy)]
pub enum Part {
    Stiffness,
    GeometricStiffness,
    Mass(MassKind),
}

impl Part {
    /// This matrix of an element.
    pub fn of(self, element: &dyn Element, points: &[[f64; 3]]) -> Vec<f64> {
        let mut matrix = vec![0.0; element.order().pow(2)];
        match self {
            Self::Stiffness => element.stiffness(points, &mut matrix),
            Self::GeometricStiffness => element.geometric_stiffness(points, &mut matrix),
            Self::Mass(kind) => element.mass(points, kind, &mut matrix),
        }
        matrix
    }
}

/// A mesh in space and its supports.
#[derive(Debug, Default)]
pub struct Supported {
    pub mesh: Mesh,
    held: HashSet<(usize, Direction)>,
}

impl Supported {
    pub fn new() -> Self {
        Self { mesh: Mesh::in_space(), held: HashSet::new() }
    }

    pub fn node(&mut self, point: [f64; 3]) -> usize {
        self.mesh.add_node_at(point).unwrap()
    }

    pub fn add(&mut self, element: impl Element + 'static) {
        self.mesh.add(element).unwrap();
    }

    pub fn hold(&mut self, node: usize, directions: &[Direction]) {
        self.held.extend(directions.iter().map(|&direction| (node, direction)));
    }

    pub fn points(&self, nodes: &[usize]) -> Vec<[f64; 3]> {
        nodes.iter().map(|&node| self.mesh.nodes()[node]).collect()
    }

    /// Numbers of the degrees of freedom that are not held, node by node.
    pub fn numbers(&self) -> HashMap<(usize, Direction), usize> {
        let mut used = HashSet::new();
        for element in self.mesh.elements() {
            for &node in element.nodes() {
                used.extend(element.directions().iter().map(|&direction| (node, direction)));
            }
        }
        let all = (0..self.mesh.nodes().len()).flat_map(|node| CLAMPED.map(|d| (node, d)));
        let free = all.filter(|place| used.contains(place) && !self.held.contains(place));
        free.enumerate().map(|(number, place)| (place, number)).collect()
    }

    pub fn matrix(&self, part: Part, factor: f64) -> Skyline {
        let numbers = self.numbers();
        let mut matrix = Skyline(vec![vec![0.0]; numbers.len()]);
        for element in self.mesh.elements() {
            let own = part.of(element, &self.points(element.nodes()));
            let places = element
                .nodes()
                .iter()
                .flat_map(|&node| element.directions().iter().map(move |&d| (node, d)));
            let places: Vec<Option<usize>> =
                places.map(|place| numbers.get(&place).copied()).collect();
            for (row, values) in places.iter().zip(own.chunks(places.len())) {
                for (column, value) in places.iter().zip(values) {
                    if let (Some(row), Some(column)) = (*row, *column) {
                        matrix.add(row, column, factor * value);
                    }
                }
            }
        }
        matrix
    }

    /// Displacements under `loads`: zero where held.
    pub fn solve(&self, loads: &[Load]) -> impl Fn(usize, Direction) -> f64 + use<> {
        let numbers = self.numbers();
        let mut displacement = vec![0.0; numbers.len()];
        for &(node, direction, force) in loads {
            if let Some(&number) = numbers.get(&(node, direction)) {
                displacement[number] += force;
            }
        }
        self.matrix(Part::Stiffness, 1.0).factor().solve(&mut displacement);
        move |node, direction| numbers.get(&(node, direction)).map_or(0.0, |&k| displacement[k])
    }

    /// Displacements of all nodes under `loads`.
    pub fn displacements(&self, loads: &[Load]) -> Vec<[f64; 6]> {
        let found = self.solve(loads);
        let nodes = 0..self.mesh.nodes().len();
        nodes.map(|node| CLAMPED.map(|direction| found(node, direction))).collect()
    }

    /// Displacement in the direction of the `loads`: their work.
    pub fn work(&self, loads: &[Load]) -> f64 {
        let found = self.solve(loads);
        loads.iter().map(|&(node, direction, force)| force * found(node, direction)).sum()
    }

    /// Lowest frequencies, Hz.
    pub fn frequencies(&self, kind: MassKind, count: usize) -> Vec<f64> {
        self.modes(kind, count, 0.0).into_iter().map(|mode| mode.frequency).collect()
    }

    /// Lowest modes. A structure that can move without deforming needs a `shift` of its squared circular frequencies.
    pub fn modes(&self, kind: MassKind, count: usize, shift: f64) -> Vec<Vibration> {
        let mass = self.matrix(Part::Mass(kind), 1.0);
        let mut shifted = self.matrix(Part::Stiffness, 1.0);
        if shift > 0.0 {
            shifted.add_all(&mass, shift);
        }
        let numbers = self.numbers();
        let found = lowest(&shifted, &mass, count).into_iter().map(|(squared, shape)| {
            let value = |place| numbers.get(&place).map_or(0.0, |&number| shape[number]);
            let nodes = 0..self.mesh.nodes().len();
            let shape = nodes.map(|node| CLAMPED.map(|direction| value((node, direction))));
            let frequency = (squared - shift).max(0.0).sqrt() / TAU;
            Vibration { frequency, shape: shape.collect() }
        });
        found.collect()
    }

    /// aᵀ P b of a matrix of the elements, for motions of all nodes, held ones included.
    pub fn form(&self, part: Part, a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
        let of_element = |element: &dyn Element| {
            let [a, b] = [a, b].map(|all| values(element, all));
            let own = part.of(element, &self.points(element.nodes()));
            own.chunks(a.len()).zip(&a).map(|(row, a)| a * dot(row, &b)).sum::<f64>()
        };
        self.mesh.elements().map(of_element).sum()
    }

    /// Lowest factor on the axial forces at which the structure buckles.
    pub fn buckling(&self) -> f64 {
        let other = self.matrix(Part::GeometricStiffness, -1.0);
        lowest(&self.matrix(Part::Stiffness, 1.0), &other, 1)[0].0
    }
}

/// A mode of vibration.
#[derive(Debug, Clone)]
pub struct Vibration {
    /// Hz.
    pub frequency: f64,
    /// Motion of each node.
    pub shape: Vec<[f64; 6]>,
}

/// Unit motion of a rigid body at a point: along x, y, z, and about axes through the origin.
pub fn rigid(motion: usize, [x, y, z]: [f64; 3]) -> [f64; 6] {
    let mut own = [0.0; 6];
    own[motion] = 1.0;
    match motion {
        3 => [own[1], own[2]] = [-z, y],
        4 => [own[0], own[2]] = [z, -x],
        5 => [own[0], own[1]] = [-y, x],
        _ => (),
    }
    own
}

/// Values of an element's degrees of freedom from the motions of all nodes.
pub fn values(element: &dyn Element, all: &[[f64; 6]]) -> Vec<f64> {
    let place = |direction: &Direction| CLAMPED.iter().position(|own| own == direction).unwrap();
    let places: Vec<usize> = element.directions().iter().map(place).collect();
    let nodes = element.nodes().iter();
    nodes.flat_map(|&node| places.iter().map(move |&place| all[node][place])).collect()
}

/// Lowest positive λ of K x = λ B x and their x, by iteration of a subspace.
fn lowest(stiffness: &Skyline, other: &Skyline, count: usize) -> Vec<(f64, Vec<f64>)> {
    let factor = stiffness.clone().factor();
    let order = stiffness.0.len();
    let mut basis: Vec<Vec<f64>> =
        (0..2 * count + 6).map(|seed| noise(order, seed as u64 + 1)).collect();
    let mut before = vec![0.0; count];
    for _ in 0..300 {
        let images = basis.iter().map(|vector| {
            let mut image = other.multiply(vector);
            factor.solve(&mut image);
            image
        });
        basis = orthonormal(images.collect(), stiffness);
        let images: Vec<Vec<f64>> = basis.iter().map(|v| other.multiply(v)).collect();
        let small: Vec<Vec<f64>> =
            basis.iter().map(|a| images.iter().map(|b| dot(a, b)).collect()).collect();
        // The greatest 1/λ last.
        let (small, vectors) = eigenpairs(&small);
        let found: Vec<f64> = small.iter().rev().take(count).map(|value| 1.0 / value).collect();
        if found.iter().zip(&before).all(|(a, b)| (a - b).abs() < 1e-11 * a.abs()) {
            let shape = |vector: &Vec<f64>| {
                let mut sum = vec![0.0; order];
                for (factor, own) in vector.iter().zip(&basis) {
                    sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += factor * own);
                }
                sum
            };
            return found.into_iter().zip(vectors.iter().rev().map(shape)).collect();
        }
        before = found;
    }
    panic!("no convergence: {before:?}");
}

/// Vectors of unit energy xᵀKx with the same span; those that depend on earlier ones are left out.
fn orthonormal(vectors: Vec<Vec<f64>>, stiffness: &Skyline) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut vector in vectors {
        let size = |vector: &[f64]| dot(vector, &stiffness.multiply(vector)).sqrt();
        let first = size(&vector);
        for _ in 0..2 {
            let force = stiffness.multiply(&vector);
            for other in &basis {
                let part = dot(other, &force);
                for (value, other) in vector.iter_mut().zip(other) {
                    *value -= part * other;
                }
            }
        }
        let last = size(&vector);
        if last > 1e-10 * first {
            basis.push(vector.into_iter().map(|value| value / last).collect());
        }
    }
    basis
}

/// Lower half of a symmetric matrix; each row ends at the diagonal and begins at its first entry.
#[derive(Debug, Clone)]
pub struct Skyline(Vec<Vec<f64>>);

impl Skyline {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        if column > row {
            return;
        }
        let entries = &mut self.0[row];
        let place = row - column;
        if entries.len() <= place {
            entries.splice(0..0, vec![0.0; place + 1 - entries.len()]);
        }
        let last = entries.len() - 1;
        entries[last - place] += value;
    }

    /// Adds another matrix of the same profile times a factor.
    fn add_all(&mut self, other: &Self, factor: f64) {
        for (row, (own, other)) in self.0.iter_mut().zip(&other.0).enumerate() {
            assert_eq!(own.len(), other.len(), "row {row} of both matrices");
            own.iter_mut().zip(other).for_each(|(own, value)| *own += factor * value);
        }
    }

    pub fn multiply(&self, vector: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; vector.len()];
        for (row, entries) in self.0.iter().enumerate() {
            let first = row + 1 - entries.len();
            product[row] += dot(entries, &vector[first..=row]);
            for (value, entry) in product[first..row].iter_mut().zip(entries) {
                *value += entry * vector[row];
            }
        }
        product
    }

    /// Cholesky's factor.
    fn factor(mut self) -> Self {
        for row in 0..self.0.len() {
            let (above, rest) = self.0.split_at_mut(row);
            let entries = &mut rest[0];
            let first = row + 1 - entries.len();
            for column in first..row {
                let other = &above[column];
                let start = first.max(column + 1 - other.len());
                let own = &entries[start - first..column - first];
                let rest = dot(own, &other[start + other.len() - column - 1..other.len() - 1]);
                entries[column - first] = (entries[column - first] - rest) / other[other.len() - 1];
            }
            let last = entries.len() - 1;
            let rest = dot(&entries[..last], &entries[..last]);
            assert!(entries[last] > rest, "row {row} has no stiffness");
            entries[last] = (entries[last] - rest).sqrt();
        }
        self
    }

    /// Solution by this factor.
    fn solve(&self, vector: &mut [f64]) {
        for (row, entries) in self.0.iter().enumerate() {
            let last = entries.len() - 1;
            let rest = dot(&entries[..last], &vector[row - last..row]);
            vector[row] = (vector[row] - rest) / entries[last];
        }
        for (row, entries) in self.0.iter().enumerate().rev() {
            let last = entries.len() - 1;
            vector[row] /= entries[last];
            let value = vector[row];
            for (other, entry) in vector[row - last..row].iter_mut().zip(entries) {
                *other -= entry * value;
            }
        }
    }
}

/// Product of two vectors, in eight sums.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (first, rest) = a.as_chunks::<8>();
    let (others, last) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in first.iter().zip(others) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = rest.iter().zip(last).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// Asserts that two numbers differ by less than this, relative to the second.
pub fn near(what: &str, found: f64, exact: f64, tolerance: f64) {
    println!("{what}: {found:.9e}, {exact:.9e}");
    assert!((found / exact - 1.0).abs() < tolerance, "{what}: {found} is not {exact}");
}
