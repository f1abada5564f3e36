//! What stays constant from step to step while the structure's tangent does.

use super::base::Base;
use super::model::Model;
use super::preload::condense;
use super::scheme::SchemeCoefficients;
use crate::error::{Error, Result};
use crate::linalg::{SparseFactor, SparseMatrix, sparse_condition};
use crate::matrix::Matrix;
use crate::structure::Triplets;

/// The effective stiffness K_eff, factored, and the Delassus operator.
pub(super) struct Operators {
    /// ∂f/∂u.
    pub(super) tangent: SparseMatrix,
    factor: Factor,
    /// Columns of K_eff⁻¹BᵀA, one after the other.
    pub(super) columns: Vec<f64>,
    /// W = G¹ + B K_eff⁻¹ BᵀA, row-major.
    pub(super) delassus: Vec<f64>,
}

/// K_eff⁻¹.
enum Factor {
    Sparse(Box<SparseFactor>),
    /// In modes: the reciprocals.
    Diagonal(Vec<f64>),
}

pub(super) const NAME: &str = "effective stiffness matrix";

impl Operators {
    /// Factors K_eff = M, C, K + ∂f/∂u, each with the scheme's coefficient of Δu, and condenses it.
    pub(super) fn new(
        model: &Model,
        base: &Base,
        soil: &[f64],
        coefficients: &SchemeCoefficients,
        tangent: SparseMatrix,
    ) -> Result<Self> {
        let mut factor = Factor::new(model, coefficients, &tangent)?;
        let solve = |rhs: &mut [f64]| factor.solve(rhs);
        let (columns, delassus) = condense(solve, base, soil, model.unknowns);
        Ok(Self { tangent, factor, columns, delassus })
    }

    /// Overwrites `rhs` with K_eff⁻¹ rhs.
    pub(super) fn solve(&mut self, rhs: &mut [f64]) {
        self.factor.solve(rhs);
    }

    /// Condition of K_eff, scaled by its diagonal.
    pub(super) fn condition(
        &mut self,
        model: &Model,
        coefficients: &SchemeCoefficients,
    ) -> Result<f64> {
        match &mut self.factor {
            Factor::Diagonal(_) => Ok(1.0),
            Factor::Sparse(factor) => {
                let matrix = effective_stiffness(model, coefficients, &self.tangent);
                Ok(sparse_condition(&SparseMatrix::new(NAME, &matrix)?, factor))
            }
        }
    }

    /// Diagonal of K_eff without its inertia.
    pub(super) fn stiffness_diagonal(
        &self,
        model: &Model,
        coefficients: &SchemeCoefficients,
    ) -> Vec<f64> {
        let [c, k] = [coefficients.velocity[0], coefficients.displacement[0]];
        let (damping, stiffness) = (model.damping.diagonal(), model.stiffness.diagonal());
        let tangent = self.tangent.diagonal();
        (0..model.unknowns)
            .map(|i| c * damping[i] + k * (stiffness[i] + tangent.get(i).copied().unwrap_or(0.0)))
            .collect()
    }

    /// Numbers that one solve reads in sparse coordinates.
    pub(super) fn stored(&self) -> usize {
        match &self.factor {
            Factor::Sparse(factor) => factor.stored(),
            Factor::Diagonal(values) => values.len(),
        }
    }
}

/// K_eff, in the structure's unknowns.
fn effective_stiffness(
    model: &Model,
    coefficients: &SchemeCoefficients,
    tangent: &SparseMatrix,
) -> Triplets {
    let [a, c, k] =
        [coefficients.acceleration[0], coefficients.velocity[0], coefficients.displacement[0]];
    let mut matrix = Triplets::new(model.unknowns);
    model.mass.add_to(a, &mut matrix);
    model.damping.add_to(c, &mut matrix);
    model.stiffness.add_to(k, &mut matrix);
    tangent.add_to(k, &mut matrix);
    matrix
}

impl Factor {
    fn new(
        model: &Model,
        coefficients: &SchemeCoefficients,
        tangent: &SparseMatrix,
    ) -> Result<Self> {
        let n = model.unknowns;
        let [a, c, k] =
            [coefficients.acceleration[0], coefficients.velocity[0], coefficients.displacement[0]];
        if let (Matrix::Diagonal(m), Matrix::Diagonal(d), Matrix::Diagonal(s)) =
            (&model.mass, &model.damping, &model.stiffness)
        {
            let inverse: Vec<f64> =
                (0..n).map(|j| 1.0 / (a * m[j] + c * d[j] + k * s[j])).collect();
            if inverse.iter().all(|x| x.is_finite()) {
                return Ok(Self::Diagonal(inverse));
            }
            return Err(Error::Singular { matrix: NAME, order: n });
        }
        let matrix = effective_stiffness(model, coefficients, tangent);
        Ok(Self::Sparse(Box::new(SparseFactor::new(NAME, &matrix)?)))
    }

    fn solve(&mut self, rhs: &mut [f64]) {
        match self {
            Self::Sparse(factor) => factor.solve(rhs),
            Self::Diagonal(inverse) => rhs.iter_mut().zip(inverse).for_each(|(x, d)| *x *= *d),
        }
    }
}
