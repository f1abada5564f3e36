//! Meshes in space on supports: displacements, frequencies and buckling loads.
//!
//! This file assembles the matrices from the elements, without the rows and columns of the supports.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use basemat::fem::{Direction, Element, MassKind, Mesh};

use crate::dense::{eigenpairs, noise};

pub use basemat::fem::Direction::{RotationX as RX, RotationY as RY, RotationZ as RZ, X, Y, Z};

pub const CLAMPED_DIRECTIONS: [Direction; 6] = [X, Y, Z, RX, RY, RZ];
pub const HINGED_DIRECTIONS: [Direction; 3] = [X, Y, Z];

/// Iterations after which the search for eigenvalues fails.
const MAX_SUBSPACE_ITERATIONS: usize = 300;
/// Relative change of eigenvalues at which the iteration ends.
const EIGENVALUE_TOLERANCE: f64 = 1e-11;
/// Norm of the new component below which a vector depends on earlier ones, relative to the vector's norm.
const DEPENDENCE_TOLERANCE: f64 = 1e-10;

/// Force (N) or moment (N m) at a node.
pub type NodalLoad = (usize, Direction, f64);

/// A matrix of the elements.
#[derive(Debug, Clone, Copy)]
pub enum ElementMatrix {
    Stiffness,
    GeometricStiffness,
    Mass(MassKind),
}

impl ElementMatrix {
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
pub struct SupportedMesh {
    pub mesh: Mesh,
    fixed: HashSet<(usize, Direction)>,
}

impl SupportedMesh {
    pub fn new() -> Self {
        Self { mesh: Mesh::in_space(), fixed: HashSet::new() }
    }

    pub fn node(&mut self, point: [f64; 3]) -> usize {
        self.mesh.add_node_at(point).unwrap()
    }

    pub fn add(&mut self, element: impl Element + 'static) {
        self.mesh.add(element).unwrap();
    }

    /// Fixes a node in these directions.
    pub fn fix(&mut self, node: usize, directions: &[Direction]) {
        self.fixed.extend(directions.iter().map(|&direction| (node, direction)));
    }

    pub fn points(&self, nodes: &[usize]) -> Vec<[f64; 3]> {
        nodes.iter().map(|&node| self.mesh.nodes()[node]).collect()
    }

    /// Matrix indices of the degrees of freedom that are not fixed, node by node.
    pub fn numbers(&self) -> HashMap<(usize, Direction), usize> {
        let mut used_dofs = HashSet::new();
        for element in self.mesh.elements() {
            for &node in element.nodes() {
                used_dofs.extend(element.directions().iter().map(|&direction| (node, direction)));
            }
        }
        let nodes = 0..self.mesh.nodes().len();
        let all_dofs = nodes.flat_map(|node| CLAMPED_DIRECTIONS.map(|direction| (node, direction)));
        let free = all_dofs.filter(|dof| used_dofs.contains(dof) && !self.fixed.contains(dof));
        free.enumerate().map(|(number, dof)| (dof, number)).collect()
    }

    /// Assembled matrix of this kind, times a factor.
    pub fn matrix(&self, kind: ElementMatrix, factor: f64) -> Skyline {
        let numbers = self.numbers();
        let mut matrix = Skyline(vec![vec![0.0]; numbers.len()]);
        for element in self.mesh.elements() {
            let block = kind.of(element, &self.points(element.nodes()));
            let dofs = element
                .nodes()
                .iter()
                .flat_map(|&node| element.directions().iter().map(move |&d| (node, d)));
            let dofs: Vec<Option<usize>> = dofs.map(|dof| numbers.get(&dof).copied()).collect();
            for (row, values) in dofs.iter().zip(block.chunks(dofs.len())) {
                for (column, value) in dofs.iter().zip(values) {
                    if let (Some(row), Some(column)) = (*row, *column) {
                        matrix.add(row, column, factor * value);
                    }
                }
            }
        }
        matrix
    }

    /// Displacements under `loads`: zero where fixed.
    pub fn solve(&self, loads: &[NodalLoad]) -> impl Fn(usize, Direction) -> f64 + use<> {
        let numbers = self.numbers();
        let mut displacement = vec![0.0; numbers.len()];
        for &(node, direction, force) in loads {
            if let Some(&number) = numbers.get(&(node, direction)) {
                displacement[number] += force;
            }
        }
        self.matrix(ElementMatrix::Stiffness, 1.0).factor().solve(&mut displacement);
        move |node, direction| numbers.get(&(node, direction)).map_or(0.0, |&k| displacement[k])
    }

    /// Displacements of all nodes under `loads`.
    pub fn displacements(&self, loads: &[NodalLoad]) -> Vec<[f64; 6]> {
        let solution = self.solve(loads);
        let nodes = 0..self.mesh.nodes().len();
        nodes
            .map(|node| CLAMPED_DIRECTIONS.map(|direction| solution(node, direction)))
            .collect()
    }

    /// Work of the `loads`: the displacement in their direction if their sum is one.
    pub fn work(&self, loads: &[NodalLoad]) -> f64 {
        let solution = self.solve(loads);
        loads.iter().map(|&(node, direction, force)| force * solution(node, direction)).sum()
    }

    /// Lowest frequencies, Hz.
    pub fn frequencies(&self, kind: MassKind, count: usize) -> Vec<f64> {
        self.modes(kind, count, 0.0).into_iter().map(|mode| mode.frequency).collect()
    }

    /// Lowest modes. A structure that can move without deforming needs a `shift` of its squared circular frequencies.
    pub fn modes(&self, kind: MassKind, count: usize, shift: f64) -> Vec<Vibration> {
        let mass = self.matrix(ElementMatrix::Mass(kind), 1.0);
        let mut shifted_stiffness = self.matrix(ElementMatrix::Stiffness, 1.0);
        if shift > 0.0 {
            shifted_stiffness.add_all(&mass, shift);
        }
        let numbers = self.numbers();
        let mut modes = Vec::new();
        for EigenPair { value, vector } in lowest(&shifted_stiffness, &mass, count) {
            let nodes = 0..self.mesh.nodes().len();
            let shape = nodes.map(|node| {
                CLAMPED_DIRECTIONS.map(|direction| {
                    numbers.get(&(node, direction)).map_or(0.0, |&number| vector[number])
                })
            });
            let frequency = (value - shift).max(0.0).sqrt() / TAU;
            modes.push(Vibration { frequency, shape: shape.collect() });
        }
        modes
    }

    /// aᵀ P b of a matrix of the elements, for motions of all nodes, fixed ones included.
    pub fn form(&self, kind: ElementMatrix, a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
        self.mesh
            .elements()
            .map(|element| {
                let a = values(element, a);
                let b = values(element, b);
                let block = kind.of(element, &self.points(element.nodes()));
                block.chunks(a.len()).zip(&a).map(|(row, a)| a * dot(row, &b)).sum::<f64>()
            })
            .sum()
    }

    /// Lowest factor on the axial forces at which the structure buckles.
    pub fn buckling(&self) -> f64 {
        let geometric = self.matrix(ElementMatrix::GeometricStiffness, -1.0);
        lowest(&self.matrix(ElementMatrix::Stiffness, 1.0), &geometric, 1)[0].value
    }
}

/// A mode of vibration.
#[derive(Debug, Clone)]
pub struct Vibration {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Motion of each node.
    pub shape: Vec<[f64; 6]>,
}

/// Unit motion of a rigid body at a point: along x, y, z, and about axes through the origin.
pub fn rigid_motion(motion: usize, [x, y, z]: [f64; 3]) -> [f64; 6] {
    let mut u = [0.0; 6];
    u[motion] = 1.0;
    // θ × r.
    match motion {
        3 => [u[1], u[2]] = [-z, y],
        4 => [u[0], u[2]] = [z, -x],
        5 => [u[0], u[1]] = [-y, x],
        _ => (),
    }
    u
}

/// Values of an element's degrees of freedom from the motions of all nodes.
pub fn values(element: &dyn Element, motions: &[[f64; 6]]) -> Vec<f64> {
    let mut values = Vec::new();
    for &node in element.nodes() {
        for direction in element.directions() {
            let index = CLAMPED_DIRECTIONS.iter().position(|other| other == direction).unwrap();
            values.push(motions[node][index]);
        }
    }
    values
}

/// λ and x of K x = λ B x.
struct EigenPair {
    value: f64,
    vector: Vec<f64>,
}

/// Solutions of K x = λ B x with the lowest positive λ, by iteration of a subspace.
fn lowest(stiffness: &Skyline, right_matrix: &Skyline, count: usize) -> Vec<EigenPair> {
    let factor = stiffness.clone().factor();
    let order = stiffness.0.len();
    let mut basis: Vec<Vec<f64>> =
        (0..2 * count + 6).map(|seed| noise(order, seed as u64 + 1)).collect();
    let mut previous_values = vec![0.0; count];
    for _ in 0..MAX_SUBSPACE_ITERATIONS {
        let images = basis.iter().map(|vector| {
            let mut image = right_matrix.multiply(vector);
            factor.solve(&mut image);
            image
        });
        basis = orthonormal(images.collect(), stiffness);
        let images: Vec<Vec<f64>> = basis.iter().map(|v| right_matrix.multiply(v)).collect();
        let projected_matrix: Vec<Vec<f64>> =
            basis.iter().map(|a| images.iter().map(|b| dot(a, b)).collect()).collect();
        // The eigenvalues 1/λ ascend.
        let (inverse_values, vectors) = eigenpairs(&projected_matrix);
        let values: Vec<f64> =
            inverse_values.iter().rev().take(count).map(|value| 1.0 / value).collect();
        if values
            .iter()
            .zip(&previous_values)
            .all(|(a, b)| (a - b).abs() < EIGENVALUE_TOLERANCE * a.abs())
        {
            return values
                .into_iter()
                .zip(vectors.iter().rev())
                .map(|(value, factors)| EigenPair { value, vector: combination(factors, &basis) })
                .collect();
        }
        previous_values = values;
    }
    panic!("no convergence: {previous_values:?}");
}

/// Sum of vectors times factors.
fn combination(factors: &[f64], vectors: &[Vec<f64>]) -> Vec<f64> {
    let mut sum = vec![0.0; vectors[0].len()];
    for (factor, vector) in factors.iter().zip(vectors) {
        sum.iter_mut().zip(vector).for_each(|(sum, value)| *sum += factor * value);
    }
    sum
}

/// Root of the energy xᵀKx.
fn energy_norm(vector: &[f64], stiffness: &Skyline) -> f64 {
    dot(vector, &stiffness.multiply(vector)).sqrt()
}

/// Vectors of unit energy xᵀKx with the same span; those that depend on earlier ones are left out.
fn orthonormal(vectors: Vec<Vec<f64>>, stiffness: &Skyline) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut vector in vectors {
        let first_norm = energy_norm(&vector, stiffness);
        for _ in 0..2 {
            let force = stiffness.multiply(&vector);
            for other in &basis {
                let component = dot(other, &force);
                for (value, other) in vector.iter_mut().zip(other) {
                    *value -= component * other;
                }
            }
        }
        let orthogonal_norm = energy_norm(&vector, stiffness);
        if orthogonal_norm > DEPENDENCE_TOLERANCE * first_norm {
            basis.push(vector.into_iter().map(|value| value / orthogonal_norm).collect());
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
        let distance = row - column;
        if entries.len() <= distance {
            entries.splice(0..0, vec![0.0; distance + 1 - entries.len()]);
        }
        let diagonal = entries.len() - 1;
        entries[diagonal - distance] += value;
    }

    /// Adds another matrix of the same profile times a factor.
    fn add_all(&mut self, other: &Self, factor: f64) {
        for (row, (entries, other)) in self.0.iter_mut().zip(&other.0).enumerate() {
            assert_eq!(entries.len(), other.len(), "row {row} of both matrices");
            entries.iter_mut().zip(other).for_each(|(entry, value)| *entry += factor * value);
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

    /// Cholesky factor of this matrix.
    fn factor(mut self) -> Self {
        for row in 0..self.0.len() {
            let (previous_rows, following_rows) = self.0.split_at_mut(row);
            let entries = &mut following_rows[0];
            let first = row + 1 - entries.len();
            for column in first..row {
                let upper_row = &previous_rows[column];
                let start = first.max(column + 1 - upper_row.len());
                let row_entries = &entries[start - first..column - first];
                let factors = &upper_row[start + upper_row.len() - column - 1..upper_row.len() - 1];
                let sum = dot(row_entries, factors);
                entries[column - first] =
                    (entries[column - first] - sum) / upper_row[upper_row.len() - 1];
            }
            let last_index = entries.len() - 1;
            let sum = dot(&entries[..last_index], &entries[..last_index]);
            assert!(entries[last_index] > sum, "row {row} has no stiffness");
            entries[last_index] = (entries[last_index] - sum).sqrt();
        }
        self
    }

    /// Overwrites a right-hand side with the solution; `self` is a Cholesky factor.
    fn solve(&self, vector: &mut [f64]) {
        for (row, entries) in self.0.iter().enumerate() {
            let last_index = entries.len() - 1;
            let sum = dot(&entries[..last_index], &vector[row - last_index..row]);
            vector[row] = (vector[row] - sum) / entries[last_index];
        }
        for (row, entries) in self.0.iter().enumerate().rev() {
            let last_index = entries.len() - 1;
            vector[row] /= entries[last_index];
            let value = vector[row];
            for (other, entry) in vector[row - last_index..row].iter_mut().zip(entries) {
                *other -= entry * value;
            }
        }
    }
}

/// Dot product of two vectors, by eight partial sums that the compiler vectorises.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_chunks, a_remainder) = a.as_chunks::<8>();
    let (b_chunks, b_remainder) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a_chunks.iter().zip(b_chunks) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    let remainder: f64 = a_remainder.iter().zip(b_remainder).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + remainder
}

/// Asserts that two numbers differ by less than this, relative to the second.
pub fn assert_near(quantity: &str, computed: f64, expected: f64, tolerance: f64) {
    println!("{quantity}: {computed:.9e}, {expected:.9e}");
    let error = (computed / expected - 1.0).abs();
    assert!(error < tolerance, "{quantity}: {computed} is not {expected}");
}
