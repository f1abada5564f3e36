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
    factor: Factor,
    /// Columns of K_eff⁻¹BᵀA, one after the other.
    pub(crate) columns: Vec<f64>,
    /// W = G¹ + B K_eff⁻¹ BᵀA.
    pub(crate) delassus: Delassus,
}

/// K_eff, ready for solutions.
pub(crate) enum Factor {
    Sparse(Box<SparseFactor>),
    /// Reciprocals of the diagonal, in modal coordinates.
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
        factor: Factor,
        tangent: SparseMatrix,
    ) -> Result<Self> {
        let (columns, delassus) =
            condense(|rhs| factor.solve_many(rhs), base, step_compliance, model.coordinates)?;
        let delassus =
            delassus.with_parts(step_compliance, &columns, |u: &[f64], out: &mut [f64]| {
                base.means(u, out);
            });
        Ok(Self { tangent, factor, columns, delassus })
    }

    /// Reciprocals of the diagonal K_eff in modal coordinates; empty in degrees of freedom.
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
            Factor::Diagonal(reciprocals) => {
                rhs.iter_mut().zip(reciprocals).for_each(|(x, reciprocal)| *x *= *reciprocal);
            }
        }
    }

    /// Condition of K_eff, scaled by its diagonal.
    pub(crate) fn condition(&self, model: &Model, c: &SchemeCoefficients) -> Result<f64> {
        match &self.factor {
            Factor::Diagonal(_) => Ok(1.0),
            Factor::Sparse(factor) => {
                Ok(sparse_condition(&effective_stiffness(model, c, &self.tangent)?, factor))
            }
        }
    }

    /// Diagonal of K_eff without the inertia term.
    pub(crate) fn stiffness_diagonal(&self, model: &Model, c: &SchemeCoefficients) -> Vec<f64> {
        let coefficients_without_inertia = SchemeCoefficients { acceleration: [0.0; 3], ..*c };
        let matrix = effective_stiffness(model, &coefficients_without_inertia, &self.tangent);
        matrix.map_or_else(|_| Vec::new(), |matrix| matrix.diagonal())
    }
}

/// K_eff: the sum of M, C and K + ∂f/∂u, each times the scheme's coefficient of Δu.
fn effective_stiffness(
    model: &Model,
    c: &SchemeCoefficients,
    tangent: &SparseMatrix,
) -> Result<SparseMatrix> {
    let mass = model.mass.as_sparse();
    let damping = model.damping.as_sparse();
    let stiffness = model.stiffness.as_sparse();
    let terms = [
        (c.acceleration[0], &*mass),
        (c.velocity[0], &*damping),
        (c.displacement[0], &*stiffness),
        (c.displacement[0], tangent),
    ];
    SparseMatrix::sum(EFFECTIVE_STIFFNESS_NAME, model.coordinates, &terms)
}

impl Factor {
    /// Factors K_eff in degrees of freedom.
    pub(crate) fn of_dofs(
        model: &Model,
        coefficients: &SchemeCoefficients,
        tangent: &SparseMatrix,
    ) -> Result<Box<SparseFactor>> {
        let matrix = effective_stiffness(model, coefficients, tangent)?;
        SparseFactor::with_elimination(EFFECTIVE_STIFFNESS_NAME, &matrix, &model.elimination)
            .map(Box::new)
    }

    /// Inverts K_eff in modal coordinates, or factors it if the damping couples the modes.
    pub(crate) fn of_modes(model: &Model, coefficients: &SchemeCoefficients) -> Result<Self> {
        let tangent = SparseMatrix::default();
        if model.diagonals().is_none() {
            return Self::of_dofs(model, coefficients, &tangent).map(Self::Sparse);
        }
        let mut reciprocals = effective_stiffness(model, coefficients, &tangent)?.diagonal();
        for entry in &mut reciprocals {
            *entry = 1.0 / *entry;
        }
        if reciprocals.iter().all(|entry| entry.is_finite()) {
            return Ok(Self::Diagonal(reciprocals));
        }
        Err(Error::Singular { matrix: EFFECTIVE_STIFFNESS_NAME, order: model.coordinates })
    }

    /// Solves for many right-hand sides, one after the other, and overwrites them.
    fn solve_many(&self, rhs: &mut [f64]) {
        match self {
            Self::Sparse(factor) => factor.solve_many(rhs),
            Self::Diagonal(reciprocals) => {
                for column in rhs.chunks_exact_mut(reciprocals.len()) {
                    column
                        .iter_mut()
                        .zip(reciprocals)
                        .for_each(|(x, reciprocal)| *x *= *reciprocal);
                }
            }
        }
    }
}

/// Columns of K⁻¹BᵀA and the Delassus operator G + B K⁻¹BᵀA, for the compliance G of the ground.
///
/// `solve` overwrites many right-hand sides, one after the other. For a diagonal G and a structure of small rank the
/// entries of the operator are not stored. Otherwise the function returns an error if they do not fit into memory.
pub(crate) fn condense(
    solve: impl FnOnce(&mut [f64]),
    base: &PlacedBase,
    ground_compliance: &CompressedMatrix,
    dofs: usize,
) -> Result<(Vec<f64>, Delassus)> {
    let order = base.layout().len();
    let mut columns = vec![0.0; order * dofs];
    let mut unit_traction = vec![0.0; order];
    let mut means = vec![0.0; order];
    for (i, column) in columns.chunks_exact_mut(dofs.max(1)).enumerate() {
        unit_traction[i] = 1.0;
        base.add_forces(1.0, &unit_traction, column);
        unit_traction[i] = 0.0;
    }
    solve(&mut columns);
    if let Some(diagonal) = ground_compliance.as_diagonal() {
        if let Some(operator) = operator_on_bed(&columns, base, diagonal, dofs) {
            return Ok((columns, operator.into()));
        }
        check_count(base.elements().len(), base.layout().components())?;
    }
    let mut delassus = ground_compliance.filled(order);
    for (i, column) in columns.chunks_exact(dofs.max(1)).enumerate() {
        base.means(column, &mut means);
        for (row, mean) in means.iter().enumerate() {
            delassus[row * order + i] += mean;
        }
    }
    Ok((columns, delassus.into()))
}

/// Delassus operator on a bed, from the bed's diagonal compliance and the columns of K⁻¹BᵀA.
///
/// `None` if the rank of the structure's part is not small.
fn operator_on_bed(
    columns: &[f64],
    base: &PlacedBase,
    bed_diagonal: &[f64],
    dofs: usize,
) -> Option<OnBed> {
    let column = |i: usize| &columns[i * dofs..][..dofs];
    let structure = StructurePart {
        diagonal: (0..bed_diagonal.len()).map(|i| base.component_mean(i, column(i))).collect(),
        column: |i: usize, out: &mut [f64]| base.means(column(i), out),
        product: |traction: &[f64], out: &mut [f64]| {
            let mut displacement = vec![0.0; dofs];
            transposed_multiply_add(columns, 1.0, traction, &mut displacement);
            base.means(&displacement, out);
        },
    };
    let areas = (0..bed_diagonal.len()).map(|i| base.area(i)).collect();
    OnBed::new(bed_diagonal, areas, MAX_STRUCTURE_RANK, structure)
}
