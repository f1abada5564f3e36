//! The coordinates in which a structure is stepped: its unknowns, or its modes.
//!
//! | symbol | meaning |
//! |---|---|
//! | Φ | modes: K φ = λ M φ, Φᵀ M Φ = 1 |
//! | q | modal coordinates, u = Φ q |
//! | c | modal damping, Φᵀ C Φ = diag(c) |
//!
//! In modes every matrix of the equation of motion is diagonal, so a step costs a few operations
//! per mode, and as many per mode and contact component to meet the ground. Only the rows of Φ
//! that the ground or a probe sees are needed in a step; the others wait until they are asked for.

use std::sync::{Arc, OnceLock};

use super::model::Model;
use crate::linalg::{SparseMatrix, dot, generalised_modes, largest};

/// In which coordinates a linear structure is stepped. Results are the same to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Coordinates {
    /// Whichever is expected to take less time, with the modes' own computation counted against
    /// them; see [`super::SimulationBuilder::expected_steps`]. Nonlinear structures, and those that
    /// modes do not decouple, keep their unknowns.
    #[default]
    Auto,
    /// The structure's unknowns: sparse matrices, one back-substitution per step.
    Unknowns,
    /// The modes of the structure without ground and damping. Needs a linear structure with
    /// symmetric matrices, a positive definite mass and damping that the modes decouple.
    Modes,
}

/// Modes of a structure.
#[derive(Debug)]
pub(crate) struct Modes {
    /// λ.
    pub(crate) stiffness: Vec<f64>,
    /// c.
    pub(crate) damping: Vec<f64>,
    /// Φ, row-major: a row per unknown.
    vectors: Vec<f64>,
}

/// Residual of the eigenproblem, and of damping taken for diagonal, relative to its terms.
const DECOUPLED: f64 = 1e-10;
/// Eigenvalues below this, relative to the largest, are zeros with the error of their computation.
const ZERO: f64 = 1e-11;
/// Smallest eigenvalue besides zero, relative to the largest: between the two nothing is certain.
const SMALLEST: f64 = 1e-8;
/// Rigid motions in a plane.
const RIGID_MOTIONS: usize = 3;

impl Modes {
    /// Modes of a linear model that is still in its unknowns.
    pub(crate) fn of(model: &Model) -> Option<Self> {
        let [mass, damping, stiffness] = model.sparse()?;
        if model.linear { Self::new(mass, damping, stiffness) } else { None }
    }

    /// Modes that diagonalise all three matrices; `None` if there are none, or not well enough.
    fn new(mass: &SparseMatrix, damping: &SparseMatrix, stiffness: &SparseMatrix) -> Option<Self> {
        let n = mass.order();
        if [mass, damping, stiffness].iter().any(|matrix| matrix.asymmetry() > 1e-13) {
            return None;
        }
        let (mut values, vectors) = generalised_modes(stiffness, mass)?;
        let top = largest(&values);
        let noise = ZERO * top;
        let rigid = values.iter().filter(|value| value.abs() <= noise).count();
        // Below its noise an eigenvalue is a rigid motion's, unless there are too many of them.
        let smallest = values.iter().map(|v| v.abs()).filter(|v| *v > noise);
        let most = RIGID_MOTIONS * parts(&[mass, damping, stiffness]);
        if rigid > most || smallest.fold(top, f64::min) < SMALLEST * top {
            return None;
        }
        for value in &mut values {
            if value.abs() <= noise {
                *value = 0.0;
            }
        }
        let mut modes = Self { stiffness: values, damping: vec![0.0; n], vectors };
        modes.decouple(mass, damping, stiffness).then_some(modes)
    }

    /// Finds c, and checks K φ = λ M φ and C φ = c M φ.
    fn decouple(
        &mut self,
        mass: &SparseMatrix,
        damping: &SparseMatrix,
        stiffness: &SparseMatrix,
    ) -> bool {
        let n = self.stiffness.len();
        let mut products = [(); 3].map(|()| vec![0.0; n]);
        let mut mode = vec![0.0; n];
        let (mut sizes, mut residuals) = ([0.0_f64; 2], [0.0_f64; 2]);
        for j in 0..n {
            for (i, value) in mode.iter_mut().enumerate() {
                *value = self.vectors[i * n + j];
            }
            for (product, matrix) in products.iter_mut().zip([mass, damping, stiffness]) {
                product.fill(0.0);
                matrix.multiply_add(1.0, &mode, product);
            }
            self.damping[j] = dot(&mode, &products[1]);
            let [inertia, dashpots, springs] = &products;
            let factors = [self.damping[j], self.stiffness[j]];
            for (k, (forces, factor)) in [dashpots, springs].into_iter().zip(factors).enumerate() {
                let apart = forces.iter().zip(inertia).map(|(f, m)| f - factor * m);
                sizes[k] = sizes[k].max(largest(forces));
                residuals[k] = apart.fold(residuals[k], |r, x| r.max(x.abs()));
            }
        }
        (0..2).all(|k| residuals[k] <= DECOUPLED * sizes[k])
    }

    /// Number of modes.
    pub(crate) fn count(&self) -> usize {
        self.stiffness.len()
    }

    /// Adds Φᵀ f to `modal`; unknowns without force cost nothing.
    pub(crate) fn project(&self, force: &[f64], modal: &mut [f64]) {
        for (row, force) in self.vectors.chunks_exact(self.count()).zip(force) {
            if *force != 0.0 {
                modal.iter_mut().zip(row).for_each(|(q, phi)| *q += phi * force);
            }
        }
    }

    /// Φ q.
    fn unknowns(&self, modal: &[f64]) -> Vec<f64> {
        self.vectors.chunks_exact(self.count()).map(|row| dot(row, modal)).collect()
    }
}

/// Number of parts of the structure that no matrix connects.
fn parts(matrices: &[&SparseMatrix]) -> usize {
    let n = matrices[0].order();
    let mut leader: Vec<usize> = (0..n).collect();
    let find = |leader: &[usize], mut i: usize| {
        while leader[i] != i {
            i = leader[i];
        }
        i
    };
    for matrix in matrices {
        for (row, column, _) in matrix.entries() {
            let (a, b) = (find(&leader, row), find(&leader, column));
            leader[a.max(b)] = a.min(b);
        }
    }
    (0..n).filter(|&i| leader[i] == i).count()
}

/// A weighted sum of unknowns, in the coordinates that are stepped.
#[derive(Debug, Clone)]
pub(crate) enum SteppedRow {
    /// (unknown, weight) pairs.
    Unknowns(Vec<(usize, f64)>),
    /// A weight for every mode; none for a sum of nothing.
    Modes(Vec<f64>),
}

impl SteppedRow {
    pub(crate) fn new(terms: &[(usize, f64)], modes: Option<&Modes>) -> Self {
        let Some(modes) = modes else { return Self::Unknowns(terms.to_vec()) };
        if terms.is_empty() {
            return Self::Modes(Vec::new());
        }
        let n = modes.count();
        let mut weights = vec![0.0; n];
        for &(i, weight) in terms {
            let row = &modes.vectors[i * n..(i + 1) * n];
            weights.iter_mut().zip(row).for_each(|(w, phi)| *w += weight * phi);
        }
        Self::Modes(weights)
    }

    /// The sum at coordinates `x`.
    pub(crate) fn of(&self, x: &[f64]) -> f64 {
        match self {
            Self::Unknowns(terms) => terms.iter().map(|&(i, weight)| weight * x[i]).sum(),
            Self::Modes(weights) if weights.is_empty() => 0.0,
            Self::Modes(weights) => dot(weights, x),
        }
    }
}

/// Displacement, velocity and acceleration in the coordinates that are stepped, and the unknowns
/// once somebody has asked for them.
#[derive(Clone)]
pub(crate) struct Motion {
    pub(crate) displacement: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    modes: Option<Arc<Modes>>,
    unknowns: [OnceLock<Vec<f64>>; 3],
}

impl Motion {
    /// At rest.
    pub(crate) fn new(coordinates: usize, modes: Option<Arc<Modes>>) -> Self {
        let zero = || vec![0.0; coordinates];
        Self {
            displacement: zero(),
            velocity: zero(),
            acceleration: zero(),
            modes,
            unknowns: Default::default(),
        }
    }

    /// To be called when coordinates have changed.
    pub(crate) fn changed(&mut self) {
        self.unknowns.iter_mut().for_each(|seen| drop(seen.take()));
    }

    /// Unknowns of the displacement (0), velocity (1) or acceleration (2).
    pub(crate) fn unknowns(&self, which: usize) -> &[f64] {
        let coordinates = [&self.displacement, &self.velocity, &self.acceleration][which];
        match &self.modes {
            None => coordinates,
            Some(modes) => self.unknowns[which].get_or_init(|| modes.unknowns(coordinates)),
        }
    }
}

impl PartialEq for Motion {
    fn eq(&self, other: &Self) -> bool {
        (0..3).all(|which| self.unknowns(which) == other.unknowns(which))
    }
}

impl std::fmt::Debug for Motion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Motion")
            .field("displacement", &self.unknowns(0))
            .field("velocity", &self.unknowns(1))
            .field("acceleration", &self.unknowns(2))
            .finish()
    }
}
