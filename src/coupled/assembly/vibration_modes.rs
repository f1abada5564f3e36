//! All vibration modes of a linear structure with matrices that are diagonal in them.
//!
//! | symbol | meaning |
//! |---|---|
//! | Φ | modes: K φ = λ M φ, Φᵀ M Φ = 1 |
//! | c | modal damping, Φᵀ C Φ = diag(c) |
//! | R | influence vectors |
//!
//! The rigid translations are exact modes: R spans the first modes, and deforming modes have no part of them.

use crate::coupled::assembly::subspace::DECOUPLED;
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::model::assembled::Assembled;
use crate::linalg::orthonormal::transpose;
use crate::linalg::{Partition, dot, generalised_modes, largest};

/// Eigenvalues below this, relative to the largest, count as zero.
const ZERO: f64 = 1e-11;
/// Smallest eigenvalue above zero, relative to the largest: between the two limits it is uncertain.
const SMALLEST: f64 = 1e-8;
/// Rigid motions in a plane, and in three dimensions.
const RIGID_MOTIONS: [usize; 2] = [3, 6];

/// Modes that diagonalise mass, damping and stiffness; `None` if they do not exist or are not accurate.
pub(crate) fn vibration_modes(assembled: &Assembled) -> Option<ModalBasis> {
    let matrices = assembled.matrices();
    if !assembled.linear || matrices.iter().any(|matrix| matrix.asymmetry() > 1e-13) {
        return None;
    }
    let [mass, _, stiffness] = matrices;
    let n = mass.order();
    let (values, vectors) = generalised_modes(stiffness, mass)?;
    let top = largest(&values);
    let noise = ZERO * top;
    let rigid = values.iter().filter(|value| value.abs() <= noise).count();
    // An eigenvalue below the noise belongs to a rigid motion, unless there are too many of them.
    let smallest = values.iter().map(|v| v.abs()).filter(|v| *v > noise);
    let mut parts = Partition::new(n);
    for matrix in matrices {
        parts.couple(matrix);
    }
    let is_plan = assembled.base.layout().is_plan();
    let most = RIGID_MOTIONS[usize::from(is_plan)] * parts.sets().len();
    if rigid > most || smallest.fold(top, f64::min) < SMALLEST * top {
        return None;
    }
    let is_rigid = |j: &usize| values[*j].abs() <= noise;
    let mode = |j: usize| vectors.iter().skip(j).step_by(n).copied();

    let mut still: Vec<Vec<f64>> = (0..n).filter(is_rigid).map(|j| mode(j).collect()).collect();
    let (basis, separated) = rigid_basis(assembled, &mut still)?;
    let mut squares = vec![0.0; rigid];
    let mut modes: Vec<f64> = basis.iter().flat_map(|[own, _]| own).copied().collect();
    for j in (0..n).filter(|j| !is_rigid(j)) {
        let mut deforming: Vec<f64> = mode(j).collect();
        project(&mut deforming, &basis[..separated]);
        modes.extend(deforming);
        squares.push(values[j]);
    }

    let mut dampings = Vec::with_capacity(n);
    let (mut sizes, mut residuals) = ([0.0_f64; 2], [0.0_f64; 2]);
    for (mode, square) in modes.chunks_exact(n).zip(&squares) {
        let [inertia, dashpots, springs] = matrices.map(|matrix| {
            let mut product = vec![0.0; n];
            matrix.multiply_add(1.0, mode, &mut product);
            product
        });
        let own = dot(mode, &dashpots);
        for (k, (forces, factor)) in [(dashpots, own), (springs, *square)].iter().enumerate() {
            let apart = forces.iter().zip(&inertia).map(|(f, m)| f - factor * m);
            sizes[k] = sizes[k].max(largest(forces));
            residuals[k] = apart.fold(residuals[k], |r, x| r.max(x.abs()));
        }
        dampings.push(own);
    }
    let decoupled = (0..2).all(|k| residuals[k] <= DECOUPLED * sizes[k]);
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
    let momentum = |vector: &[f64]| {
        let mut momentum = vec![0.0; n];
        assembled.mass.multiply_add(1.0, vector, &mut momentum);
        momentum
    };
    let norm = |vector: &Vec<f64>| dot(vector, &momentum(vector));
    let normalised = |mut vector: Vec<f64>| {
        let scale = norm(&vector).sqrt().recip();
        for v in &mut vector {
            *v *= scale;
        }
        let momentum = momentum(&vector);
        scale.is_finite().then_some([vector, momentum])
    };
    let mut basis = Vec::with_capacity(still.len());
    for vector in assembled.influence.translations(n).chunks_exact(n) {
        let mut own = vector.to_vec();
        project(&mut own, &basis);
        basis.push(normalised(own)?);
    }
    let separated = basis.len();
    while basis.len() < still.len() {
        // The vector with the largest remainder.
        for vector in still.iter_mut() {
            project(vector, &basis);
        }
        let longest = |a: &&mut Vec<f64>, b: &&mut Vec<f64>| norm(a).total_cmp(&norm(b));
        let chosen = std::mem::replace(still.iter_mut().max_by(longest)?, vec![0.0; n]);
        let [mut chosen, _] = normalised(chosen)?;
        project(&mut chosen, &basis);
        basis.push(normalised(chosen)?);
    }
    (basis.len() == still.len()).then_some((basis, separated))
}

/// Subtracts from a vector its part in the basis.
fn project(vector: &mut [f64], basis: &[[Vec<f64>; 2]]) {
    // Two passes remove rounding.
    for [own, momentum] in basis.iter().chain(basis) {
        let share = dot(momentum, vector);
        vector.iter_mut().zip(own).for_each(|(v, b)| *v -= share * b);
    }
}
