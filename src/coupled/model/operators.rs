//! Precomputed operators of a step, valid while the structure's tangent does not change.

use super::Model;
use std::sync::Arc;

use crate::contact::{Delassus, MAX_STRUCTURE_RANK, OnBed, StructurePart};
use crate::coupled::base::PlacedBase;
use crate::coupled::scheme::SchemeCoefficients;
use crate::error::{Error, Result};
use crate::geometry::check_count;
use crate::linalg::CompressedMatrix;
use crate::linalg::{SparseFactor, SparseMatrix, sparse_condition, transposed_multiply_add};

/// The effective stiffness K_eff, factored, and the Delassus operator.
pub(crate) struct Operators {
    /// Tangent ∂f/∂u of the nonlinear force.
    pub(crate) tangent: SparseMatrix,
    factorization: StiffnessFactorization,
    /// K_eff⁻¹BᵀA, stored column by column.
    pub(crate) traction_responses: Vec<f64>,
    /// W = G¹ + B K_eff⁻¹ BᵀA.
    pub(crate) delassus: Delassus,
}

/// Factorization of K_eff, or its inverse if diagonal.
pub(crate) enum StiffnessFactorization {
    Sparse(Box<SparseFactor>),
    /// Inverse of the diagonal K_eff, in modal coordinates.
    Diagonal(Vec<f64>),
}

/// Name of K_eff in errors.
pub(crate) const EFFECTIVE_STIFFNESS_NAME: &str = "effective stiffness matrix";

impl Operators {
    /// Computes W from the factored K_eff with this tangent.
    ///
    /// Returns an error if the entries of W do not fit into memory.
    pub(crate) fn new(
        model: &Model,
        base: &PlacedBase,
        step_compliance: &Arc<CompressedMatrix>,
        factorization: StiffnessFactorization,
        tangent: SparseMatrix,
    ) -> Result<Self> {
        let (traction_responses, delassus) = condense(
            |rhs| factorization.solve_many(rhs),
            base,
            step_compliance,
            model.coordinate_count,
        )?;
        let delassus = delassus.with_parts(
            step_compliance,
            &traction_responses,
            |u: &[f64], out: &mut [f64]| {
                base.means(u, out);
            },
        );
        Ok(Self { tangent, factorization, traction_responses, delassus })
    }

    /// Inverse of the diagonal K_eff in modal coordinates; empty if K_eff is factored.
    pub(crate) fn inverse_diagonal(&self) -> &[f64] {
        match &self.factorization {
            StiffnessFactorization::Diagonal(values) => values,
            StiffnessFactorization::Sparse(_) => &[],
        }
    }

    /// Overwrites `rhs` with K_eff⁻¹ rhs.
    pub(crate) fn solve(&mut self, rhs: &mut [f64]) {
        match &mut self.factorization {
            StiffnessFactorization::Sparse(factor) => factor.solve(rhs),
            StiffnessFactorization::Diagonal(inverse_diagonal) => {
                rhs.iter_mut().zip(inverse_diagonal).for_each(|(x, inverse)| *x *= *inverse);
            }
        }
    }

    /// Condition number of K_eff, scaled by its diagonal.
    pub(crate) fn condition_number(
        &self,
        model: &Model,
        coefficients: &SchemeCoefficients,
    ) -> Result<f64> {
        match &self.factorization {
            StiffnessFactorization::Diagonal(_) => Ok(1.0),
            StiffnessFactorization::Sparse(factor) => {
                let matrix = effective_stiffness(model, coefficients, &self.tangent)?;
                Ok(sparse_condition(&matrix, factor))
            }
        }
    }

    /// Diagonal of K_eff without the inertia term.
    pub(crate) fn stiffness_diagonal(
        &self,
        model: &Model,
        coefficients: &SchemeCoefficients,
    ) -> Vec<f64> {
        let coefficients_without_inertia =
            SchemeCoefficients { acceleration: [0.0; 3], ..*coefficients };
        let matrix = effective_stiffness(model, &coefficients_without_inertia, &self.tangent);
        matrix.map_or_else(|_| Vec::new(), |matrix| matrix.diagonal())
    }
}

/// The effective stiffness matrix K_eff.
///
/// It is the sum of M, C and K + ∂f/∂u, each times the scheme's coefficient of Δu.
fn effective_stiffness(
    model: &Model,
    coefficients: &SchemeCoefficients,
    tangent: &SparseMatrix,
) -> Result<SparseMatrix> {
    let mass = model.mass.as_sparse();
    let damping = model.damping.as_sparse();
    let stiffness = model.stiffness.as_sparse();
    let terms = [
        (coefficients.acceleration[0], &*mass),
        (coefficients.velocity[0], &*damping),
        (coefficients.displacement[0], &*stiffness),
        (coefficients.displacement[0], tangent),
    ];
    SparseMatrix::sum(EFFECTIVE_STIFFNESS_NAME, model.coordinate_count, &terms)
}

impl StiffnessFactorization {
    /// Factors K_eff in degrees of freedom.
    pub(crate) fn in_dofs(
        model: &Model,
        coefficients: &SchemeCoefficients,
        tangent: &SparseMatrix,
    ) -> Result<Box<SparseFactor>> {
        let matrix = effective_stiffness(model, coefficients, tangent)?;
        SparseFactor::with_elimination(EFFECTIVE_STIFFNESS_NAME, &matrix, &model.elimination)
            .map(Box::new)
    }

    /// Inverts K_eff in modal coordinates, or factors it if the damping couples the modes.
    pub(crate) fn in_modal_coordinates(
        model: &Model,
        coefficients: &SchemeCoefficients,
    ) -> Result<Self> {
        let tangent = SparseMatrix::default();
        if model.diagonals().is_none() {
            return Self::in_dofs(model, coefficients, &tangent).map(Self::Sparse);
        }
        let mut inverse_diagonal = effective_stiffness(model, coefficients, &tangent)?.diagonal();
        for entry in &mut inverse_diagonal {
            *entry = 1.0 / *entry;
        }
        if inverse_diagonal.iter().all(|entry| entry.is_finite()) {
            return Ok(Self::Diagonal(inverse_diagonal));
        }
        Err(Error::Singular { matrix: EFFECTIVE_STIFFNESS_NAME, order: model.coordinate_count })
    }

    /// Solves for many right-hand sides, one after the other, and overwrites them.
    fn solve_many(&self, rhs: &mut [f64]) {
        match self {
            Self::Sparse(factor) => factor.solve_many(rhs),
            Self::Diagonal(inverse_diagonal) => {
                for column in rhs.chunks_exact_mut(inverse_diagonal.len()) {
                    column.iter_mut().zip(inverse_diagonal).for_each(|(x, inverse)| *x *= *inverse);
                }
            }
        }
    }
}

/// Condenses the structure to its contact components.
///
/// Returns K⁻¹BᵀA, stored column by column, and the Delassus operator G + B K⁻¹BᵀA for the compliance G of the ground.
/// `solve` overwrites many right-hand sides, one after the other. For a diagonal G and a structure of small rank the
/// entries of the operator are not stored. Otherwise the function returns an error if they do not fit into memory.
pub(crate) fn condense(
    solve: impl FnOnce(&mut [f64]),
    base: &PlacedBase,
    ground_compliance: &CompressedMatrix,
    dofs: usize,
) -> Result<(Vec<f64>, Delassus)> {
    let order = base.layout().len();
    let mut traction_responses = vec![0.0; order * dofs];
    let mut unit_traction = vec![0.0; order];
    let mut means = vec![0.0; order];
    for (i, force) in traction_responses.chunks_exact_mut(dofs.max(1)).enumerate() {
        unit_traction[i] = 1.0;
        base.add_forces(1.0, &unit_traction, force);
        unit_traction[i] = 0.0;
    }
    solve(&mut traction_responses);
    if let Some(diagonal) = ground_compliance.as_diagonal() {
        if let Some(operator) = operator_on_bed(&traction_responses, base, diagonal, dofs) {
            return Ok((traction_responses, operator.into()));
        }
        check_count(base.elements().len(), base.layout().components())?;
    }
    let mut delassus = ground_compliance.filled(order);
    for (i, response) in traction_responses.chunks_exact(dofs.max(1)).enumerate() {
        base.means(response, &mut means);
        for (row, mean) in means.iter().enumerate() {
            delassus[row * order + i] += mean;
        }
    }
    Ok((traction_responses, delassus.into()))
}

/// Delassus operator of a structure on a bed.
///
/// The operator follows from the bed's diagonal compliance and K⁻¹BᵀA. `None` if the rank of the structure's part is
/// not small.
fn operator_on_bed(
    traction_responses: &[f64],
    base: &PlacedBase,
    bed_diagonal: &[f64],
    dofs: usize,
) -> Option<OnBed> {
    let response = |i: usize| &traction_responses[i * dofs..][..dofs];
    let structure = StructurePart {
        diagonal: (0..bed_diagonal.len()).map(|i| base.component_mean(i, response(i))).collect(),
        column: |i: usize, out: &mut [f64]| base.means(response(i), out),
        product: |traction: &[f64], out: &mut [f64]| {
            let mut displacement = vec![0.0; dofs];
            transposed_multiply_add(traction_responses, 1.0, traction, &mut displacement);
            base.means(&displacement, out);
        },
    };
    let areas = (0..bed_diagonal.len()).map(|i| base.area(i)).collect();
    OnBed::new(bed_diagonal, areas, MAX_STRUCTURE_RANK, structure)
}
