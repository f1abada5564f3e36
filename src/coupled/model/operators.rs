//! Precomputed operators of a step, valid while the structure's tangent does not change.

use std::sync::Arc;

use super::Model;
use super::effective_stiffness::{
    ChangingStiffness, EFFECTIVE_STIFFNESS_NAME, effective_stiffness,
};

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
    ///
    /// It is not used after the tangent of a large structure has changed, except on a bed of springs.
    pub(crate) traction_responses: Vec<f64>,
    /// W = G¹ + B K_eff⁻¹ BᵀA.
    pub(crate) delassus: Delassus,
    /// Buffer of zeros for the tractions of the elements.
    ///
    /// Empty before the first change of the tangent.
    unit_traction: Vec<f64>,
    /// Buffer for the mean displacements of the elements; on a bed of springs, for the displacement of the structure.
    ///
    /// Empty before the first change of the tangent.
    means: Vec<f64>,
}

/// Factorization of K_eff, or its inverse if diagonal.
pub(crate) enum StiffnessFactorization {
    Sparse(Box<SparseFactor>),
    /// Factorization that is updated in place, after the first change of the tangent.
    Changing(Box<ChangingStiffness>),
    /// Inverse of the diagonal K_eff, in modal coordinates.
    Diagonal(Vec<f64>),
}

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
        let mut factorization = factorization;
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
        Ok(Self {
            tangent,
            factorization,
            traction_responses,
            delassus,
            unit_traction: Vec::new(),
            means: Vec::new(),
        })
    }

    /// Computes the operators for another tangent.
    ///
    /// After the first change nothing is allocated while the pattern of the tangent stays.
    pub(crate) fn change_tangent(
        &mut self,
        model: &Model,
        base: &PlacedBase,
        step_compliance: &Arc<CompressedMatrix>,
        coefficients: &SchemeCoefficients,
        tangent: &SparseMatrix,
    ) -> Result<()> {
        let has_same_pattern = self.tangent.has_pattern_of(tangent);
        match &mut self.factorization {
            StiffnessFactorization::Changing(stiffness) if has_same_pattern => {
                if let Err(error) = stiffness.refactor(tangent) {
                    // The factor belongs to no tangent now, so the next change computes all anew.
                    self.tangent = SparseMatrix::default();
                    return Err(error);
                }
            }
            factorization => {
                let stiffness = ChangingStiffness::new(model, base, coefficients, tangent)?;
                *factorization = StiffnessFactorization::Changing(Box::new(stiffness));
            }
        }
        if has_same_pattern {
            self.tangent.copy_values(tangent);
        } else {
            self.tangent.clone_from(tangent);
        }
        let dofs = model.coordinate_count;
        if self.delassus.on_bed().is_some() {
            if !self.refill_on_bed(base, dofs) {
                let solve = |rhs: &mut [f64]| self.factorization.solve_many(rhs);
                (self.traction_responses, self.delassus) =
                    condense(solve, base, step_compliance, dofs)?;
            }
            return Ok(());
        }
        if let StiffnessFactorization::Changing(stiffness) = &mut self.factorization
            && let Some(responses) = &mut stiffness.base_responses
        {
            let factor = &mut stiffness.factor;
            self.delassus.refill(step_compliance, &[], |values| responses.add_to(factor, values));
            return Ok(());
        }
        self.update_traction_responses(base, dofs);
        let Self { traction_responses, delassus, means, .. } = self;
        means.resize(base.layout().len(), 0.0);
        delassus.refill(step_compliance, traction_responses, |values| {
            add_means(base, traction_responses, dofs, means, values);
        });
        Ok(())
    }

    /// Computes K_eff⁻¹BᵀA with the present factor.
    fn update_traction_responses(&mut self, base: &PlacedBase, dofs: usize) {
        let Self { traction_responses, unit_traction, factorization, .. } = self;
        unit_traction.resize(base.layout().len(), 0.0);
        set_unit_forces(base, unit_traction, dofs, traction_responses);
        factorization.solve_many(traction_responses);
    }

    /// Computes the operator on a bed of springs again; false if the structure's part is not of small rank.
    fn refill_on_bed(&mut self, base: &PlacedBase, dofs: usize) -> bool {
        self.update_traction_responses(base, dofs);
        let Self { traction_responses, delassus, means, .. } = self;
        means.resize(dofs, 0.0);
        let structure = structure_part(traction_responses, base, means);
        delassus
            .on_bed_mut()
            .is_some_and(|on_bed| on_bed.refill(MAX_STRUCTURE_RANK, structure))
    }

    /// Inverse of the diagonal K_eff in modal coordinates; empty if K_eff is factored.
    pub(crate) fn inverse_diagonal(&self) -> &[f64] {
        match &self.factorization {
            StiffnessFactorization::Diagonal(values) => values,
            StiffnessFactorization::Sparse(_) | StiffnessFactorization::Changing(_) => &[],
        }
    }

    /// Overwrites `rhs` with K_eff⁻¹ rhs.
    pub(crate) fn solve(&mut self, rhs: &mut [f64]) {
        match &mut self.factorization {
            StiffnessFactorization::Sparse(factor) => factor.solve(rhs),
            StiffnessFactorization::Changing(stiffness) => stiffness.factor.solve(rhs),
            StiffnessFactorization::Diagonal(inverse_diagonal) => {
                rhs.iter_mut().zip(inverse_diagonal).for_each(|(x, inverse)| *x *= *inverse);
            }
        }
    }

    /// Adds the structure's response −K_eff⁻¹BᵀAτ to `displacement`.
    ///
    /// `scratch` has an entry for each coordinate.
    pub(crate) fn add_response(
        &mut self,
        base: &PlacedBase,
        traction: &[f64],
        scratch: &mut [f64],
        displacement: &mut [f64],
    ) {
        let has_base_responses = matches!(
            &self.factorization,
            StiffnessFactorization::Changing(stiffness) if stiffness.base_responses.is_some()
        );
        if has_base_responses && self.delassus.on_bed().is_none() {
            scratch.fill(0.0);
            base.add_forces(-1.0, traction, scratch);
            self.solve(scratch);
            displacement.iter_mut().zip(&*scratch).for_each(|(u, response)| *u += response);
        } else {
            transposed_multiply_add(&self.traction_responses, -1.0, traction, displacement);
        }
    }

    /// Condition number of K_eff, scaled by its diagonal.
    pub(crate) fn condition_number(
        &self,
        model: &Model,
        coefficients: &SchemeCoefficients,
    ) -> Result<f64> {
        let factor = match &self.factorization {
            StiffnessFactorization::Diagonal(_) => return Ok(1.0),
            StiffnessFactorization::Sparse(factor) => Some(&**factor),
            StiffnessFactorization::Changing(stiffness) => stiffness.factor.factor(),
        };
        let matrix = effective_stiffness(model, coefficients, &self.tangent)?;
        Ok(factor.map_or(f64::INFINITY, |factor| sparse_condition(&matrix, factor)))
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

impl StiffnessFactorization {
    /// Factors K_eff as a sparse matrix.
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
    pub(crate) fn solve_many(&mut self, rhs: &mut [f64]) {
        match self {
            Self::Sparse(factor) => factor.solve_many(rhs),
            Self::Changing(stiffness) => stiffness.factor.solve_many(rhs),
            Self::Diagonal(inverse_diagonal) => {
                for column in rhs.chunks_exact_mut(inverse_diagonal.len()) {
                    let entries = column.iter_mut().zip(&*inverse_diagonal);
                    entries.for_each(|(x, inverse)| *x *= *inverse);
                }
            }
        }
    }
}

/// Condenses the structure to its contact components.
///
/// Returns K⁻¹BᵀA, stored column by column, and the Delassus operator G + B K⁻¹BᵀA for the compliance G of the ground.
/// `solve` overwrites many right-hand sides, one after the other. For a diagonal G and a structure of small rank the
/// entries of the operator are not stored. For other structures on a diagonal G it returns an error if they do not fit
/// into memory.
pub(crate) fn condense(
    solve: impl FnOnce(&mut [f64]),
    base: &PlacedBase,
    ground_compliance: &CompressedMatrix,
    dofs: usize,
) -> Result<(Vec<f64>, Delassus)> {
    let order = base.layout().len();
    let mut traction_responses = vec![0.0; order * dofs];
    set_unit_forces(base, &mut vec![0.0; order], dofs, &mut traction_responses);
    solve(&mut traction_responses);
    if let Some(diagonal) = ground_compliance.as_diagonal() {
        if let Some(operator) = operator_on_bed(&traction_responses, base, diagonal, dofs) {
            return Ok((traction_responses, operator.into()));
        }
        check_count(base.elements().len(), base.layout().components())?;
    }
    let mut delassus = ground_compliance.filled(order);
    add_means(base, &traction_responses, dofs, &mut vec![0.0; order], &mut delassus);
    Ok((traction_responses, delassus.into()))
}

/// Overwrites `forces` with the forces BᵀA of unit tractions, column by column.
///
/// `unit_traction` is a buffer of zeros.
fn set_unit_forces(base: &PlacedBase, unit_traction: &mut [f64], dofs: usize, forces: &mut [f64]) {
    forces.fill(0.0);
    for (i, force) in forces.chunks_exact_mut(dofs.max(1)).enumerate() {
        unit_traction[i] = 1.0;
        base.add_forces(1.0, unit_traction, force);
        unit_traction[i] = 0.0;
    }
}

/// Adds the mean displacements due to each unit traction to the row-major `operator`.
fn add_means(
    base: &PlacedBase,
    traction_responses: &[f64],
    dofs: usize,
    means: &mut [f64],
    operator: &mut [f64],
) {
    let order = means.len();
    for (i, response) in traction_responses.chunks_exact(dofs.max(1)).enumerate() {
        base.means(response, means);
        for (row, mean) in means.iter().enumerate() {
            operator[row * order + i] += mean;
        }
    }
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
    let mut displacement = vec![0.0; dofs];
    let structure = structure_part(traction_responses, base, &mut displacement);
    let areas = (0..bed_diagonal.len()).map(|i| base.area(i)).collect();
    OnBed::new(bed_diagonal, areas, MAX_STRUCTURE_RANK, structure)
}

/// Part of the Delassus operator of a structure with the responses K⁻¹BᵀA.
///
/// `displacement`: a buffer with an entry for each degree of freedom.
fn structure_part<'a>(
    traction_responses: &'a [f64],
    base: &'a PlacedBase,
    displacement: &'a mut [f64],
) -> StructurePart<
    impl Fn(usize) -> f64 + 'a,
    impl FnMut(usize, &mut [f64]) + 'a,
    impl FnOnce(&[f64], &mut [f64]) + 'a,
> {
    let dofs = displacement.len();
    let response = move |i: usize| &traction_responses[i * dofs..][..dofs];
    StructurePart {
        diagonal: move |i: usize| base.component_mean(i, response(i)),
        column: move |i: usize, out: &mut [f64]| base.means(response(i), out),
        product: move |traction: &[f64], out: &mut [f64]| {
            displacement.fill(0.0);
            transposed_multiply_add(traction_responses, 1.0, traction, displacement);
            base.means(displacement, out);
        },
    }
}
