//! All vibration modes of a linear structure with matrices that are diagonal in them.
//!
//! | symbol | meaning |
//! |---|---|
//! | Φ | modes: K φ = λ M φ, Φᵀ M Φ = 1 |
//! | c | modal damping, Φᵀ C Φ = diag(c) |
//! | R | influence vectors |
//!
//! The rigid translations are exact modes: R spans the first modes, and deforming modes have no part of them.

use crate::coupled::assembly::subspace::MAX_MODE_COUPLING;
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::model::assembled::Assembled;
use crate::linalg::orthonormal::transpose;
use crate::linalg::{Eigenpairs, Partition, SparseMatrix, dot, generalised_modes, largest};

/// Eigenvalues below this, relative to the largest, count as zero.
const ZERO_EIGENVALUE_RATIO: f64 = 1e-11;
/// Smallest eigenvalue above zero, relative to the largest: between the two limits it is uncertain.
const MIN_NONZERO_EIGENVALUE_RATIO: f64 = 1e-8;
/// Rigid motions in a plane, and in three dimensions.
const RIGID_MOTIONS: [usize; 2] = [3, 6];

/// Modes that diagonalise mass, damping and stiffness; `None` if they do not exist or are not accurate.
pub(crate) fn vibration_modes(assembled: &Assembled) -> Option<ModalBasis> {
    let matrices = assembled.matrices();
    if !assembled.linear || matrices.iter().any(|matrix| matrix.asymmetry() > 1e-13) {
        return None;
    }
    let mass: &SparseMatrix = &assembled.mass;
    let stiffness: &SparseMatrix = &assembled.stiffness;
    let n = mass.order();
    let Eigenpairs { values, vectors } = generalised_modes(stiffness, mass)?;
    let top = largest(&values);
    let noise = ZERO_EIGENVALUE_RATIO * top;
    let rigid = values.iter().filter(|value| value.abs() <= noise).count();
    // An eigenvalue below the noise belongs to a rigid motion, unless there are too many of them.
    let smallest = values.iter().map(|v| v.abs()).filter(|v| *v > noise);
    let mut parts = Partition::new(n);
    for matrix in matrices {
        parts.couple(matrix);
    }
    let is_plan = assembled.base.layout().is_plan();
    let max_rigid = RIGID_MOTIONS[usize::from(is_plan)] * parts.sets().len();
    if rigid > max_rigid || smallest.fold(top, f64::min) < MIN_NONZERO_EIGENVALUE_RATIO * top {
        return None;
    }
    let is_rigid = |j: &usize| values[*j].abs() <= noise;
    let mode = |j: usize| vectors.iter().skip(j).step_by(n).copied();

    let mut still: Vec<Vec<f64>> = (0..n).filter(is_rigid).map(|j| mode(j).collect()).collect();
    let (basis, separated) = rigid_basis(assembled, &mut still)?;
    let mut squares = vec![0.0; rigid];
    let mut modes: Vec<f64> = basis.iter().flat_map(|[vector, _]| vector).copied().collect();
    for j in (0..n).filter(|j| !is_rigid(j)) {
        let mut deforming: Vec<f64> = mode(j).collect();
        project(&mut deforming, &basis[..separated]);
        modes.extend(deforming);
        squares.push(values[j]);
    }

    let mut dampings = Vec::with_capacity(n);
    let mut sizes = [0.0_f64; 2];
    let mut residuals = [0.0_f64; 2];
    for (mode, square) in modes.chunks_exact(n).zip(&squares) {
        let inertia = product(mass, mode);
        let damping_force = product(&assembled.damping, mode);
        let damping = dot(mode, &damping_force);
        let forces = [(damping_force, damping), (product(stiffness, mode), *square)];
        for (k, (force, factor)) in forces.iter().enumerate() {
            let residual = force.iter().zip(&inertia).map(|(f, m)| f - factor * m);
            sizes[k] = sizes[k].max(largest(force));
            residuals[k] = residual.fold(residuals[k], |r, x| r.max(x.abs()));
        }
        dampings.push(damping);
    }
    let decoupled = (0..2).all(|k| residuals[k] <= MAX_MODE_COUPLING * sizes[k]);
    decoupled.then(|| ModalBasis::of(squares, dampings, transpose(&modes, n)))
}

/// An orthonormal basis of the rigid modes `still`, as vectors and their momenta.
///
/// The influence vectors come first; the second value is their number.
fn rigid_basis(
    assembled: &Assembled,
    still: &mut [Vec<f64>],
) -> Option<(Vec<[Vec<f64>; 2]>, usize)> {
    let n = assembled.dofs();
    let mass: &SparseMatrix = &assembled.mass;
    let mut basis = Vec::with_capacity(still.len());
    for vector in assembled.influence.translations(n).chunks_exact(n) {
        let mut vector = vector.to_vec();
        project(&mut vector, &basis);
        basis.push(normalised(vector, mass)?);
    }
    let separated = basis.len();
    while basis.len() < still.len() {
        // The vector with the largest remainder.
        for vector in still.iter_mut() {
            project(vector, &basis);
        }
        let longest = still
            .iter_mut()
            .max_by(|a, b| dot(a, &product(mass, a)).total_cmp(&dot(b, &product(mass, b))))?;
        let mut chosen = std::mem::replace(longest, vec![0.0; n]);
        [chosen, _] = normalised(chosen, mass)?;
        project(&mut chosen, &basis);
        basis.push(normalised(chosen, mass)?);
    }
    (basis.len() == still.len()).then_some((basis, separated))
}

/// A vector of unit mass norm, and its momentum; `None` for a norm of zero.
fn normalised(mut vector: Vec<f64>, mass: &SparseMatrix) -> Option<[Vec<f64>; 2]> {
    let scale = dot(&vector, &product(mass, &vector)).sqrt().recip();
    for v in &mut vector {
        *v *= scale;
    }
    let momentum = product(mass, &vector);
    scale.is_finite().then_some([vector, momentum])
}

/// Product of a matrix with a vector.
fn product(matrix: &SparseMatrix, vector: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; vector.len()];
    matrix.multiply_add(1.0, vector, &mut product);
    product
}

/// Subtracts from a vector its part in the basis.
fn project(vector: &mut [f64], basis: &[[Vec<f64>; 2]]) {
    // Two passes remove rounding.
    for [direction, momentum] in basis.iter().chain(basis) {
        let component = dot(momentum, vector);
        vector.iter_mut().zip(direction).for_each(|(v, b)| *v -= component * b);
    }
}
