//! Precomputed operators of a step, valid while the structure's tangent is unchanged.

use std::sync::Arc;

use super::base::Base;
use super::influence::Influence;
use super::transformation::{ModalBasis, Terms, Transformation};
use crate::contact::Delassus;
use crate::coupled::build::assembled::Assembled;
use crate::coupled::scheme::SchemeCoefficients;
use crate::error::{Error, Result};
use crate::linalg::matrix::{Diagonals, Matrix, Thinned};
use crate::linalg::{SparseFactor, SparseMatrix, sparse_condition};
use crate::structure::{Structure, Triplets};

/// The effective stiffness K_eff, factored, and the Delassus operator.
pub(crate) struct Operators {
    /// ∂f/∂u.
    pub(crate) tangent: SparseMatrix,
    factor: Factor,
    /// Columns of K_eff⁻¹BᵀA, one after the other.
    pub(crate) columns: Vec<f64>,
    /// W = G¹ + B K_eff⁻¹ BᵀA, row-major.
    pub(crate) delassus: Delassus,
}

/// K_eff⁻¹.
pub(crate) enum Factor {
    Sparse(Box<SparseFactor>),
    /// Reciprocals of the diagonal, in modal coordinates.
    Diagonal(Vec<f64>),
}

pub(crate) const NAME: &str = "effective stiffness matrix";

impl Operators {
    /// Condenses the factored K_eff of this tangent.
    pub(crate) fn new(
        model: &Model,
        base: &Base,
        soil: &Arc<Thinned>,
        factor: Factor,
        tangent: SparseMatrix,
    ) -> Self {
        let solve = |rhs: &mut [f64]| factor.solve_many(rhs);
        let (columns, delassus) = condense(solve, base, soil, model.coordinates);
        let means = |u: &[f64], out: &mut [f64]| base.means(u, out);
        let delassus = Delassus::new(delassus, soil, &columns, means);
        Self { tangent, factor, columns, delassus }
    }

    /// Reciprocals of K_eff in modes; empty in degrees of freedom.
    pub(crate) fn reciprocals(&self) -> &[f64] {
        match &self.factor {
            Factor::Diagonal(values) => values,
            Factor::Sparse(_) => &[],
        }
    }

    /// Overwrites `rhs` with K_eff⁻¹ rhs.
    pub(crate) fn solve(&mut self, rhs: &mut [f64]) {
        match &mut self.factor {
            Factor::Sparse(factor) => factor.solve(rhs),
            Factor::Diagonal(inverse) => rhs.iter_mut().zip(inverse).for_each(|(x, d)| *x *= *d),
        }
    }

    /// Condition of K_eff, scaled by its diagonal.
    pub(crate) fn condition(&mut self, model: &Model, c: &SchemeCoefficients) -> Result<f64> {
        match &mut self.factor {
            Factor::Diagonal(_) => Ok(1.0),
            Factor::Sparse(factor) => {
                let matrix = effective_stiffness(model, c, &self.tangent);
                Ok(sparse_condition(&SparseMatrix::new(NAME, &matrix)?, factor))
            }
        }
    }

    /// Diagonal of K_eff without its inertia.
    pub(crate) fn stiffness_diagonal(&self, model: &Model, c: &SchemeCoefficients) -> Vec<f64> {
        let massless = SchemeCoefficients { acceleration: [0.0; 3], ..*c };
        let mut diagonal = vec![0.0; model.coordinates];
        for &(row, column, k) in effective_stiffness(model, &massless, &self.tangent).entries() {
            if row == column {
                diagonal[row] += k;
            }
        }
        diagonal
    }
}

/// K_eff: M, C, K + ∂f/∂u, each with the scheme's coefficient of Δu.
fn effective_stiffness(model: &Model, c: &SchemeCoefficients, tangent: &SparseMatrix) -> Triplets {
    let mut matrix = Triplets::new(model.coordinates);
    model.mass.add_to(c.acceleration[0], &mut matrix);
    model.damping.add_to(c.velocity[0], &mut matrix);
    model.stiffness.add_to(c.displacement[0], &mut matrix);
    tangent.add_to(c.displacement[0], &mut matrix);
    matrix
}

impl Factor {
    /// Factors K_eff of degrees of freedom.
    pub(crate) fn of_dofs(
        model: &Model,
        coefficients: &SchemeCoefficients,
        tangent: &SparseMatrix,
    ) -> Result<Box<SparseFactor>> {
        SparseFactor::new(NAME, &effective_stiffness(model, coefficients, tangent)).map(Box::new)
    }

    /// Inverts K_eff of modes.
    pub(crate) fn of_modes(model: &Model, coefficients: &SchemeCoefficients) -> Result<Self> {
        let mut inverse = vec![0.0; model.coordinates];
        let matrix = effective_stiffness(model, coefficients, &SparseMatrix::default());
        matrix.entries().iter().for_each(|&(i, _, k)| inverse[i] += k);
        for k in &mut inverse {
            *k = 1.0 / *k;
        }
        if inverse.iter().all(|x| x.is_finite()) {
            return Ok(Self::Diagonal(inverse));
        }
        Err(Error::Singular { matrix: NAME, order: model.coordinates })
    }

    /// Overwrites many right-hand sides, one after the other.
    fn solve_many(&self, rhs: &mut [f64]) {
        match self {
            Self::Sparse(factor) => factor.solve_many(rhs),
            Self::Diagonal(inverse) => {
                for rhs in rhs.chunks_exact_mut(inverse.len()) {
                    rhs.iter_mut().zip(inverse).for_each(|(x, d)| *x *= *d);
                }
            }
        }
    }
}

/// Columns of K⁻¹BᵀA and the Delassus operator `soil` + B K⁻¹BᵀA; `solve` overwrites many right-hand
/// sides, one after the other.
pub(crate) fn condense(
    solve: impl FnOnce(&mut [f64]),
    base: &Base,
    soil: &[f64],
    dofs: usize,
) -> (Vec<f64>, Vec<f64>) {
    let size = base.layout().len();
    let mut columns = vec![0.0; size * dofs];
    let mut delassus = soil.to_vec();
    let mut unit = vec![0.0; size];
    let mut means = vec![0.0; size];
    for (i, column) in columns.chunks_exact_mut(dofs.max(1)).enumerate() {
        unit[i] = 1.0;
        base.add_forces(1.0, &unit, column);
        unit[i] = 0.0;
    }
    solve(&mut columns);
    for (i, column) in columns.chunks_exact(dofs.max(1)).enumerate() {
        base.means(column, &mut means);
        for (row, mean) in means.iter().enumerate() {
            delassus[row * size + i] += mean;
        }
    }
    (columns, delassus)
}

// A structure in the coordinates that are stepped.

/// Matrices, influence vectors and coordinates of a structure.
pub(crate) struct Model {
    /// Degrees of freedom of the structure, and the number of coordinates that are stepped.
    pub(crate) dofs: usize,
    pub(crate) coordinates: usize,
    pub(crate) mass: Matrix,
    pub(crate) damping: Matrix,
    pub(crate) stiffness: Matrix,
    pub(crate) linear: bool,
    /// Whether any damping coefficient is not zero.
    pub(crate) damped: bool,
    /// Influence vectors in the coordinates that are stepped.
    pub(crate) influence: Arc<Influence>,
    pub(crate) transformation: Transformation,
}

impl Model {
    /// Steps the degrees of freedom.
    pub(crate) fn new(assembled: &Assembled) -> Self {
        let [mass, damping, stiffness] =
            assembled.matrices().map(|matrix| Matrix::Sparse(matrix.clone()));
        Self {
            dofs: assembled.dofs(),
            coordinates: assembled.dofs(),
            mass,
            damped: !damping.is_empty(),
            damping,
            stiffness,
            linear: assembled.linear,
            influence: assembled.influence.clone(),
            transformation: Transformation::Identity,
        }
    }

    /// This structure in modal coordinates.
    pub(crate) fn in_modes(self, assembled: &Assembled, modes: ModalBasis) -> Self {
        let convert = |vector: &Terms| modes.translation(vector, &assembled.mass);
        let influence = Arc::new(assembled.influence.converted(convert));
        let damping = Matrix::Diagonal(modes.damping.clone());
        Self {
            coordinates: modes.count(),
            mass: Matrix::Diagonal(vec![1.0; modes.count()]),
            damped: !damping.is_empty(),
            damping,
            stiffness: Matrix::Diagonal(modes.stiffness.clone()),
            influence,
            transformation: Transformation::Modes(Arc::new(modes)),
            ..self
        }
    }

    /// The three matrices, if they are diagonal.
    pub(crate) fn diagonals(&self) -> Option<Diagonals<'_>> {
        match (&self.mass, &self.damping, &self.stiffness) {
            (Matrix::Diagonal(mass), Matrix::Diagonal(damping), Matrix::Diagonal(stiffness)) => {
                let damping = self.damped.then_some(damping.as_slice());
                Some(Diagonals { mass, damping, stiffness })
            }
            _ => None,
        }
    }

    /// Adds the external load at `time`, weight excepted, minus `at_start`, to `load`, and returns
    /// whether there is any; `scratch` has an entry for every degree of freedom. An error is the structure's.
    pub(crate) fn load(
        &self,
        structure: &dyn Structure,
        time: f64,
        at_start: &[f64],
        scratch: &mut [f64],
        load: &mut [f64],
    ) -> Result<bool> {
        scratch.fill(0.0);
        structure.load(time, scratch)?;
        let mut differs = false;
        for (now, at_start) in scratch.iter_mut().zip(at_start) {
            *now -= at_start;
            // Without a branch, for the vector units; NaN differs.
            differs |= *now != 0.0;
        }
        if differs {
            self.transformation.add_forces(scratch, load);
        }
        Ok(differs)
    }
}
