//! Meshes in space on supports: displacements, frequencies and buckling loads.
//!
//! Supports delete rows and columns of the matrices, which this file assembles from the elements.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use basemat::fem::{Direction, Element, MassKind, Mesh};
use basemat_problems::dense::{dot, eigenvalues, noise};

pub(crate) const X: Direction = Direction::X;
pub(crate) const Y: Direction = Direction::Y;
pub(crate) const Z: Direction = Direction::Z;
pub(crate) const RX: Direction = Direction::RotationX;
pub(crate) const RY: Direction = Direction::RotationY;
pub(crate) const RZ: Direction = Direction::RotationZ;
pub(crate) const CLAMPED: [Direction; 6] = [X, Y, Z, RX, RY, RZ];
pub(crate) const HINGED: [Direction; 3] = [X, Y, Z];

/// Force (N) or moment (N m) at a node.
pub(crate) type Load = (usize, Direction, f64);

/// A matrix of the elements.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Part {
    Stiffness,
    GeometricStiffness,
    Mass(MassKind),
}

impl Part {
    /// This matrix of an element.
    pub(crate) fn of(self, element: &dyn Element, points: &[[f64; 3]]) -> Vec<f64> {
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
pub(crate) struct Supported {
    pub(crate) mesh: Mesh,
    held: HashSet<(usize, Direction)>,
}

impl Supported {
    pub(crate) fn new() -> Self {
        Self { mesh: Mesh::in_space(), held: HashSet::new() }
    }

    pub(crate) fn node(&mut self, point: [f64; 3]) -> usize {
        self.mesh.add_node_at(point).unwrap()
    }

    pub(crate) fn add(&mut self, element: impl Element + 'static) {
        self.mesh.add(element).unwrap();
    }

    pub(crate) fn hold(&mut self, node: usize, directions: &[Direction]) {
        self.held.extend(directions.iter().map(|&direction| (node, direction)));
    }

    pub(crate) fn points(&self, nodes: &[usize]) -> Vec<[f64; 3]> {
        nodes.iter().map(|&node| self.mesh.nodes()[node]).collect()
    }

    /// Numbers of the degrees of freedom that are not held, node by node.
    pub(crate) fn numbers(&self) -> HashMap<(usize, Direction), usize> {
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

    pub(crate) fn matrix(&self, part: Part, factor: f64) -> Skyline {
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
    pub(crate) fn solve(&self, loads: &[Load]) -> impl Fn(usize, Direction) -> f64 + use<> {
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

    /// Displacement in the direction of the `loads`: their work.
    pub(crate) fn work(&self, loads: &[Load]) -> f64 {
        let found = self.solve(loads);
        loads.iter().map(|&(node, direction, force)| force * found(node, direction)).sum()
    }

    /// Lowest frequencies, Hz.
    pub(crate) fn frequencies(&self, kind: MassKind, count: usize) -> Vec<f64> {
        let squared = self.lowest(&self.matrix(Part::Mass(kind), 1.0), count);
        squared.into_iter().map(|squared| squared.sqrt() / TAU).collect()
    }

    /// Lowest factor on the axial forces at which the structure buckles.
    pub(crate) fn buckling(&self) -> f64 {
        self.lowest(&self.matrix(Part::GeometricStiffness, -1.0), 1)[0]
    }

    /// Lowest positive λ of K x = λ B x, by iteration of a subspace.
    fn lowest(&self, other: &Skyline, count: usize) -> Vec<f64> {
        let stiffness = self.matrix(Part::Stiffness, 1.0);
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
            basis = orthonormal(images.collect(), &stiffness);
            let images: Vec<Vec<f64>> = basis.iter().map(|v| other.multiply(v)).collect();
            let small: Vec<Vec<f64>> =
                basis.iter().map(|a| images.iter().map(|b| dot(a, b)).collect()).collect();
            let unit = |i: usize| (0..basis.len()).map(|j| f64::from(u8::from(i == j))).collect();
            let unit: Vec<Vec<f64>> = (0..basis.len()).map(unit).collect();
            let found: Vec<f64> =
                eigenvalues(&small, &unit).iter().rev().take(count).map(|v| 1.0 / v).collect();
            if found.iter().zip(&before).all(|(a, b)| (a - b).abs() < 1e-11 * a.abs()) {
                return found;
            }
            before = found;
        }
        panic!("no convergence: {before:?}");
    }
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
#[derive(Clone)]
pub(crate) struct Skyline(Vec<Vec<f64>>);

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

    pub(crate) fn multiply(&self, vector: &[f64]) -> Vec<f64> {
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

/// Asserts that two numbers differ by less than this, relative to the second.
pub(crate) fn near(what: &str, found: f64, exact: f64, tolerance: f64) {
    println!("{what}: {found:.9e}, {exact:.9e}");
    assert!((found / exact - 1.0).abs() < tolerance, "{what}: {found} is not {exact}");
}
