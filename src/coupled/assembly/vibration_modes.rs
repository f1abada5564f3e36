//! All vibration modes of a linear structure, if its matrices are diagonal in modal coordinates.
//!
//! | symbol | meaning |
//! |---|---|
//! | Φ | modes: K φ = λ M φ, Φᵀ M Φ = 1 |
//! | c | modal damping, Φᵀ C Φ = diag(c) |
//! | R | influence vectors |
//!
//! The rigid translations are exact modes. R spans the first modes, and deforming modes are orthogonal to it.

use crate::coupled::assembly::subspace::MAX_MODE_COUPLING;
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::model::assembled::Assembled;
use crate::linalg::orthonormal::transpose;
use crate::linalg::{Eigenpairs, Partition, SparseMatrix, dot, generalised_modes, largest};

/// Eigenvalues below this ratio to the largest count as zero.
const ZERO_EIGENVALUE_RATIO: f64 = 1e-11;
/// Smallest accepted ratio of a nonzero eigenvalue to the largest.
///
/// Between both limits the eigenvalue is uncertain.
const MIN_NONZERO_EIGENVALUE_RATIO: f64 = 1e-8;
/// Number of rigid motions of a part in the plane.
const RIGID_MOTIONS_IN_PLANE: usize = 3;
/// Number of rigid motions of a part in space.
const RIGID_MOTIONS_IN_SPACE: usize = 6;
/// Relative asymmetry of a matrix that counts as rounding.
pub(super) const ASYMMETRY_TOLERANCE: f64 = 1e-13;

/// All modes, if they diagonalise mass, damping and stiffness.
///
/// `None` if there are no such modes, or they are not accurate.
pub(crate) fn vibration_modes(assembled: &Assembled) -> Option<ModalBasis> {
    let matrices = assembled.matrices();
    if !assembled.is_linear
        || matrices.iter().any(|matrix| matrix.asymmetry() > ASYMMETRY_TOLERANCE)
    {
        return None;
    }
    let mass: &SparseMatrix = &assembled.mass;
    let stiffness: &SparseMatrix = &assembled.stiffness;
    let order = mass.order();
    let Eigenpairs { values, vectors } = generalised_modes(stiffness, mass)?;
    let max_eigenvalue = largest(&values);
    let rounding = ZERO_EIGENVALUE_RATIO * max_eigenvalue;
    let rigid_count = values.iter().filter(|value| value.abs() <= rounding).count();
    // An eigenvalue below the rounding belongs to a rigid motion. More such eigenvalues than rigid motions are an
    // error.
    let nonzero_values = values.iter().map(|v| v.abs()).filter(|v| *v > rounding);
    let min_eigenvalue = nonzero_values.fold(max_eigenvalue, f64::min);
    let mut parts = Partition::new(order);
    for matrix in matrices {
        parts.couple(matrix);
    }
    let is_plan = assembled.base.layout().is_plan();
    let motions_per_part = if is_plan { RIGID_MOTIONS_IN_SPACE } else { RIGID_MOTIONS_IN_PLANE };
    if rigid_count > motions_per_part * parts.sets().len()
        || min_eigenvalue < MIN_NONZERO_EIGENVALUE_RATIO * max_eigenvalue
    {
        return None;
    }
    let is_rigid = |j: &usize| values[*j].abs() <= rounding;
    let mode = |j: usize| vectors.iter().skip(j).step_by(order).copied();

    let mut rigid_modes: Vec<Vec<f64>> =
        (0..order).filter(is_rigid).map(|j| mode(j).collect()).collect();
    let RigidBasis { vectors: basis, translation_count } =
        RigidBasis::new(assembled, &mut rigid_modes)?;
    let mut squared_frequencies = vec![0.0; rigid_count];
    let mut modes: Vec<f64> =
        basis.iter().flat_map(|direction| &direction.vector).copied().collect();
    for j in (0..order).filter(|j| !is_rigid(j)) {
        let mut deforming_mode: Vec<f64> = mode(j).collect();
        project(&mut deforming_mode, &basis[..translation_count]);
        modes.extend(deforming_mode);
        squared_frequencies.push(values[j]);
    }
    let dampings = modal_damping(assembled, &modes, &squared_frequencies)?;
    Some(ModalBasis::of(squared_frequencies, dampings, transpose(&modes, order)))
}

/// Modal damping coefficients; `None` unless the modes diagonalise damping and stiffness.
fn modal_damping(
    assembled: &Assembled,
    modes: &[f64],
    squared_frequencies: &[f64],
) -> Option<Vec<f64>> {
    let order = assembled.dofs();
    let mut dampings = Vec::with_capacity(order);
    // The first entry is of the damping, the second of the stiffness.
    let mut max_forces = [0.0_f64; 2];
    let mut max_residuals = [0.0_f64; 2];
    for (mode, square) in modes.chunks_exact(order).zip(squared_frequencies) {
        let inertia = product(&assembled.mass, mode);
        let damping_force = product(&assembled.damping, mode);
        let damping = dot(mode, &damping_force);
        let stiffness_force = product(&assembled.stiffness, mode);
        let forces = [(damping_force, damping), (stiffness_force, *square)];
        for (k, (force, factor)) in forces.iter().enumerate() {
            let residual = force.iter().zip(&inertia).map(|(f, m)| f - factor * m);
            max_forces[k] = max_forces[k].max(largest(force));
            max_residuals[k] = residual.fold(max_residuals[k], |max, r| max.max(r.abs()));
        }
        dampings.push(damping);
    }
    let is_decoupled = (0..2).all(|k| max_residuals[k] <= MAX_MODE_COUPLING * max_forces[k]);
    is_decoupled.then_some(dampings)
}

/// A vector of unit mass norm, and its momentum.
struct MassNormalised {
    vector: Vec<f64>,
    /// Product of the mass matrix with the vector.
    momentum: Vec<f64>,
}

/// Orthonormal basis of the rigid modes.
struct RigidBasis {
    /// The vectors; the first ones span the influence vectors.
    vectors: Vec<MassNormalised>,
    /// Number of influence vectors.
    translation_count: usize,
}

impl RigidBasis {
    /// Orthonormalises the influence vectors, then the remainders of the `rigid_modes`.
    ///
    /// `None` for a dependent set.
    fn new(assembled: &Assembled, rigid_modes: &mut [Vec<f64>]) -> Option<Self> {
        let order = assembled.dofs();
        let mass: &SparseMatrix = &assembled.mass;
        let mut vectors = Vec::with_capacity(rigid_modes.len());
        for translation in assembled.influence.part_vectors(order).chunks_exact(order) {
            let mut vector = translation.to_vec();
            project(&mut vector, &vectors);
            vectors.push(MassNormalised::new(vector, mass)?);
        }
        let translation_count = vectors.len();
        while vectors.len() < rigid_modes.len() {
            for vector in rigid_modes.iter_mut() {
                project(vector, &vectors);
            }
            // The vector with the largest remainder.
            let longest_vector = rigid_modes
                .iter_mut()
                .max_by(|a, b| dot(a, &product(mass, a)).total_cmp(&dot(b, &product(mass, b))))?;
            let remainder = std::mem::replace(longest_vector, vec![0.0; order]);
            let mut vector = MassNormalised::new(remainder, mass)?.vector;
            project(&mut vector, &vectors);
            vectors.push(MassNormalised::new(vector, mass)?);
        }
        (vectors.len() == rigid_modes.len()).then_some(Self { vectors, translation_count })
    }
}

impl MassNormalised {
    /// Scales a vector to a unit mass norm; `None` for a norm of zero.
    fn new(mut vector: Vec<f64>, mass: &SparseMatrix) -> Option<Self> {
        let scale = dot(&vector, &product(mass, &vector)).sqrt().recip();
        for v in &mut vector {
            *v *= scale;
        }
        let momentum = product(mass, &vector);
        scale.is_finite().then_some(Self { vector, momentum })
    }
}

/// Product of a matrix with a vector.
fn product(matrix: &SparseMatrix, vector: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; vector.len()];
    matrix.multiply_add(1.0, vector, &mut product);
    product
}

/// Subtracts from a vector its projection on the basis.
fn project(vector: &mut [f64], basis: &[MassNormalised]) {
    // Two passes remove rounding.
    for MassNormalised { vector: direction, momentum } in basis.iter().chain(basis) {
        let component = dot(momentum, vector);
        vector.iter_mut().zip(direction).for_each(|(v, b)| *v -= component * b);
    }
}
