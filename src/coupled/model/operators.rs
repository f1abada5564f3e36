//! Precomputed operators of a step, valid while the structure's tangent is unchanged.

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
    /// ∂f/∂u.
    pub(crate) tangent: SparseMatrix,
    factor: Factor,
    /// Columns of K_eff⁻¹BᵀA, one after the other.
    pub(crate) columns: Vec<f64>,
    /// W = G¹ + B K_eff⁻¹ BᵀA.
    pub(crate) delassus: Delassus,
}

/// K_eff⁻¹.
pub(crate) enum Factor {
    Sparse(Box<SparseFactor>),
    /// Reciprocals of the diagonal, in modal coordinates.
    Diagonal(Vec<f64>),
}

pub(crate) const EFFECTIVE_STIFFNESS_NAME: &str = "effective stiffness matrix";

impl Operators {
    /// Condenses the factored K_eff with this tangent.
    ///
    /// Returns an error for more elements than the entries of W allow.
    pub(crate) fn new(
        model: &Model,
        base: &PlacedBase,
        soil: &Arc<CompressedMatrix>,
        factor: Factor,
        tangent: SparseMatrix,
    ) -> Result<Self> {
        let (columns, delassus) =
            condense(|rhs| factor.solve_many(rhs), base, soil, model.coordinates)?;
        let delassus =
            delassus.with_parts(soil, &columns, |u: &[f64], out: &mut [f64]| base.means(u, out));
        Ok(Self { tangent, factor, columns, delassus })
    }

    /// Reciprocals of K_eff in modal coordinates; empty in degrees of freedom.
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
    pub(crate) fn condition(&self, model: &Model, c: &SchemeCoefficients) -> Result<f64> {
        match &self.factor {
            Factor::Diagonal(_) => Ok(1.0),
            Factor::Sparse(factor) => {
                Ok(sparse_condition(&effective_stiffness(model, c, &self.tangent)?, factor))
            }
        }
    }

    /// Diagonal of K_eff without its inertia.
    pub(crate) fn stiffness_diagonal(&self, model: &Model, c: &SchemeCoefficients) -> Vec<f64> {
        let massless = SchemeCoefficients { acceleration: [0.0; 3], ..*c };
        let matrix = effective_stiffness(model, &massless, &self.tangent);
        matrix.map_or_else(|_| Vec::new(), |matrix| matrix.diagonal())
    }
}

/// K_eff: M, C, K + ∂f/∂u, each with the scheme's coefficient of Δu.
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
    /// Factors K_eff of degrees of freedom.
    pub(crate) fn of_dofs(
        model: &Model,
        coefficients: &SchemeCoefficients,
        tangent: &SparseMatrix,
    ) -> Result<Box<SparseFactor>> {
        let matrix = effective_stiffness(model, coefficients, tangent)?;
        SparseFactor::with_elimination(EFFECTIVE_STIFFNESS_NAME, &matrix, &model.elimination)
            .map(Box::new)
    }

    /// Inverts K_eff of modes, or factors it if the damping couples them.
    pub(crate) fn of_modes(model: &Model, coefficients: &SchemeCoefficients) -> Result<Self> {
        let tangent = SparseMatrix::default();
        if model.diagonals().is_none() {
            return Self::of_dofs(model, coefficients, &tangent).map(Self::Sparse);
        }
        let mut inverse = effective_stiffness(model, coefficients, &tangent)?.diagonal();
        for k in &mut inverse {
            *k = 1.0 / *k;
        }
        if inverse.iter().all(|x| x.is_finite()) {
            return Ok(Self::Diagonal(inverse));
        }
        Err(Error::Singular { matrix: EFFECTIVE_STIFFNESS_NAME, order: model.coordinates })
    }

    /// Solves for many right-hand sides, one after the other, and overwrites them.
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

/// Columns of K⁻¹BᵀA and the Delassus operator `soil` + B K⁻¹BᵀA.
///
/// `solve` overwrites many right-hand sides, one after the other. The entries of the operator are not stored for a soil that
/// is a diagonal, and a structure that moves it in few ways. Otherwise the function returns an error if they do not fit into
/// memory.
pub(crate) fn condense(
    solve: impl FnOnce(&mut [f64]),
    base: &PlacedBase,
    soil: &CompressedMatrix,
    dofs: usize,
) -> Result<(Vec<f64>, Delassus)> {
    let size = base.layout().len();
    let mut columns = vec![0.0; size * dofs];
    let mut unit = vec![0.0; size];
    let mut means = vec![0.0; size];
    for (i, column) in columns.chunks_exact_mut(dofs.max(1)).enumerate() {
        unit[i] = 1.0;
        base.add_forces(1.0, &unit, column);
        unit[i] = 0.0;
    }
    solve(&mut columns);
    if let Some(diagonal) = soil.as_diagonal() {
        if let Some(on_bed) = on_bed(&columns, base, diagonal, dofs) {
            return Ok((columns, on_bed.into()));
        }
        check_count(base.elements().len(), base.layout().components())?;
    }
    let mut delassus = soil.filled(size);
    for (i, column) in columns.chunks_exact(dofs.max(1)).enumerate() {
        base.means(column, &mut means);
        for (row, mean) in means.iter().enumerate() {
            delassus[row * size + i] += mean;
        }
    }
    Ok((columns, delassus.into()))
}

/// The operator for the diagonal of a soil and these columns of K⁻¹BᵀA; `None` if the structure moves it in many ways.
fn on_bed(columns: &[f64], base: &PlacedBase, soil: &[f64], dofs: usize) -> Option<OnBed> {
    let column = |i: usize| &columns[i * dofs..][..dofs];
    let structure = StructurePart {
        diagonal: (0..soil.len()).map(|i| base.component_mean(i, column(i))).collect(),
        column: |i: usize, out: &mut [f64]| base.means(column(i), out),
        product: |traction: &[f64], out: &mut [f64]| {
            let mut displacement = vec![0.0; dofs];
            transposed_multiply_add(columns, 1.0, traction, &mut displacement);
            base.means(&displacement, out);
        },
    };
    let areas = (0..soil.len()).map(|i| base.area(i)).collect();
    OnBed::new(soil, areas, MAX_STRUCTURE_RANK, structure)
}
