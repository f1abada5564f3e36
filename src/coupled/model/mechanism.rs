//! Mechanisms: motions of a structure without resistance, at all or with a fixed base.

use crate::coupled::base::PlacedBase;
use crate::error::{Error, Result, StabilityError};
use crate::linalg::{SparseFactor, SparseMatrix, largest, weighted_dot};
use crate::structure::{SpringSupportedBase, Structure, Triplets, dof_list_text};

/// Largest regularising term on the diagonal, relative to the largest stiffness.
const REGULARISATION_RATIO: f64 = 1e-12;
/// Largest relative work of a mechanism on the stiffness.
///
/// It is relative to the sum of the magnitudes of the terms of the work.
const MAX_MECHANISM_WORK_RATIO: f64 = 1e-12;
/// Largest relative work of a mechanism where no factorization has failed.
///
/// For a mechanism, rounding in the sum over the elements gives a relative work of 3e-17. The softest displacement of a
/// column of a thousand beams, which is not a mechanism, has 1e-12.
const MAX_CERTAIN_MECHANISM_WORK_RATIO: f64 = f64::EPSILON;
/// Relative work of the softest displacement above which the structure has no mechanism.
const FIRM_WORK_RATIO: f64 = 1e-6;
/// Smallest displacement of a degree of freedom of a mechanism, relative to the largest.
const MIN_MECHANISM_DISPLACEMENT_RATIO: f64 = 0.1;
/// Largest number of independent mechanisms that are reported.
///
/// It limits the time of the search.
const MAX_REPORTED_MECHANISMS: usize = 32;
/// Number of inverse iterations for each mechanism; the gap to the next eigenvalue is large.
const INVERSE_ITERATION_COUNT: usize = 3;

/// Stiffness (including the tangent of the nonlinear force at rest), mass and base of a structure.
#[derive(Clone, Copy)]
pub(crate) struct StructureAtRest<'a> {
    pub(crate) structure: &'a dyn Structure,
    pub(crate) stiffness: &'a SparseMatrix,
    pub(crate) mass: &'a SparseMatrix,
    pub(crate) base: &'a PlacedBase,
}

impl StructureAtRest<'_> {
    /// Returns an error for a mechanism, also for one that the loads do not move.
    ///
    /// `fixed_factor` is the factored stiffness with a fixed base. For most structures it excludes a mechanism.
    pub(crate) fn check(&self, fixed_factor: &mut SparseFactor) -> Result<()> {
        let regularised = RegularisedStiffness::on_firm_springs(self).1;
        let softest_shape = regularised.softest_displacement(fixed_factor, &[]);
        if softest_shape.is_some_and(|shape| regularised.relative_work(&shape) > FIRM_WORK_RATIO) {
            return Ok(());
        }
        self.mechanism_up_to(MAX_CERTAIN_MECHANISM_WORK_RATIO)
            .map_or(Ok(()), |cause| Err(Error::Stability(Box::new(cause))))
    }

    /// The mechanism that has caused a failure; `None` if there is none.
    pub(crate) fn mechanism(&self) -> Option<StabilityError> {
        self.mechanism_up_to(MAX_MECHANISM_WORK_RATIO)
    }

    /// Replaces `error` by the mechanism that has caused it, if there is one.
    pub(crate) fn cause_of(&self, error: Error) -> Error {
        self.mechanism().map_or(error, |cause| Error::Stability(Box::new(cause)))
    }

    /// The mechanism of the structure on firm springs; `None` without one.
    ///
    /// `max_work_ratio`: largest relative work of a mechanism on the stiffness.
    fn mechanism_up_to(&self, max_work_ratio: f64) -> Option<StabilityError> {
        if self.base.dofs().is_empty() {
            return None;
        }
        let dofs = RegularisedStiffness::on_firm_springs(self).1.mechanism_dofs(max_work_ratio)?;
        let place = names_of_dofs(self.structure, &dofs);
        Some(StabilityError::Mechanism { dofs, place, massless: false })
    }
}

/// The mechanism without resistance by stiffness, damping and mass; `None` if there is none.
pub(crate) fn unresisted_mechanism(
    structure: &dyn Structure,
    stiffness: &SparseMatrix,
    damping: &SparseMatrix,
    mass: &SparseMatrix,
) -> Option<StabilityError> {
    let terms = [stiffness, damping, mass].map(|matrix| {
        let max_entry = largest(&matrix.diagonal());
        let factor = if max_entry > 0.0 { max_entry.recip() } else { 0.0 };
        (factor, matrix)
    });
    let sum = SparseMatrix::weighted_sum(stiffness.order(), &terms);
    let dofs = RegularisedStiffness::new(sum, 1.0, &[]).mechanism_dofs(MAX_MECHANISM_WORK_RATIO)?;
    let place = names_of_dofs(structure, &dofs);
    Some(StabilityError::Mechanism { dofs, place, massless: true })
}

/// Names of degrees of freedom in the structure, or their numbers.
fn names_of_dofs(structure: &dyn Structure, dofs: &[usize]) -> String {
    structure.describe(dofs).unwrap_or_else(|| dof_list_text(dofs))
}

/// A stiffness that small terms on its diagonal make regular.
///
/// It is regular even if the structure has mechanisms.
pub(crate) struct RegularisedStiffness {
    matrix: Triplets,
    /// Reference stiffness, about as large as the largest entry, N/m.
    reference_stiffness: f64,
    /// Terms on the diagonal that make the matrix regular.
    regularisation: Vec<f64>,
    /// Degrees of freedom without any entry.
    empty_dofs: Vec<usize>,
}

impl RegularisedStiffness {
    /// The stiffness at rest with springs under the contact nodes, as stiff as its largest entry.
    pub(crate) fn on_firm_springs<'a>(
        at_rest: &StructureAtRest<'a>,
    ) -> (SpringSupportedBase<'a>, Self) {
        Self::on_springs(at_rest, 1.0)
    }

    /// The stiffness at rest with springs under the contact nodes.
    ///
    /// The springs are `stiffness_ratio` times as stiff as the largest entry.
    pub(crate) fn on_springs<'a>(
        at_rest: &StructureAtRest<'a>,
        stiffness_ratio: f64,
    ) -> (SpringSupportedBase<'a>, Self) {
        let StructureAtRest { stiffness, mass, base, .. } = *at_rest;
        let max_entry = stiffness.entries().fold(0.0_f64, |max, (_, _, k)| max.max(k.abs()));
        let spring_stiffness = stiffness_ratio * if max_entry > 0.0 { max_entry } else { 1.0 };
        let springs = SpringSupportedBase::new(base.nodes(), stiffness, spring_stiffness);
        let regularised = Self::new(springs.matrix.clone(), spring_stiffness, &mass.diagonal());
        (springs, regularised)
    }

    /// Regularises a matrix with a largest entry of about `reference_stiffness` by a diagonal `mass`.
    ///
    /// A degree of freedom without mass is regularised by its diagonal entry. Lagrange multipliers have neither mass nor
    /// diagonal entry and stay unchanged.
    fn new(matrix: Triplets, reference_stiffness: f64, mass: &[f64]) -> Self {
        let max_mass = largest(mass);
        let mut diagonal = vec![0.0; matrix.order()];
        for &(row, _, value) in matrix.entries().iter().filter(|entry| entry.0 == entry.1) {
            diagonal[row] += value;
        }
        let mut is_empty_dof = vec![true; diagonal.len()];
        for &(row, column, value) in matrix.entries() {
            if value != 0.0 {
                is_empty_dof[row] = false;
                is_empty_dof[column] = false;
            }
        }
        let regularisation: Vec<f64> = diagonal
            .into_iter()
            .enumerate()
            .map(|(i, entry)| match mass.get(i) {
                Some(mass) if *mass > 0.0 => {
                    REGULARISATION_RATIO * reference_stiffness * mass / max_mass
                }
                _ if entry > 0.0 => REGULARISATION_RATIO * entry,
                _ if is_empty_dof[i] => REGULARISATION_RATIO * reference_stiffness,
                _ => 0.0,
            })
            .collect();
        let empty_dofs = (0..is_empty_dof.len()).filter(|&i| is_empty_dof[i]).collect();
        Self { matrix, reference_stiffness, regularisation, empty_dofs }
    }

    /// Factors the regularised matrix; `None` if the factorization fails.
    pub(crate) fn factor(&self) -> Option<SparseFactor> {
        let mut sum = self.matrix.clone();
        self.regularisation.iter().enumerate().for_each(|(i, value)| sum.add(i, i, *value));
        SparseFactor::new(SpringSupportedBase::STIFFNESS_NAME, &sum).ok()
    }

    /// Degrees of freedom of all mechanisms with a relative work of at most `max_work_ratio`, ascending.
    ///
    /// They are those whose rows have the largest Euclidean norms in a matrix whose columns are a basis of the
    /// mechanisms. The basis is orthonormal with respect to the regularisation, so that neither its choice nor the
    /// numbering of degrees of freedom matters.
    fn mechanism_dofs(&self, max_work_ratio: f64) -> Option<Vec<usize>> {
        let dof_count = self.regularisation.len();
        let mut factor = self.factor()?;
        let mut basis: Vec<Vec<f64>> = Vec::new();
        while basis.len() < MAX_REPORTED_MECHANISMS.min(dof_count) {
            match self.softest_displacement(&mut factor, &basis) {
                Some(shape) if self.relative_work(&shape) <= max_work_ratio => basis.push(shape),
                _ => break,
            }
        }
        let mut row_norms = vec![0.0; dof_count];
        for (i, norm) in
            row_norms.iter_mut().enumerate().filter(|(i, _)| self.regularisation[*i] > 0.0)
        {
            *norm = basis.iter().map(|shape| shape[i] * shape[i]).sum::<f64>().sqrt();
        }
        let min_norm = MIN_MECHANISM_DISPLACEMENT_RATIO * largest(&row_norms);
        (!basis.is_empty()).then(|| (0..dof_count).filter(|&i| row_norms[i] > min_norm).collect())
    }

    /// The softest displacement independent of `basis`, by inverse iteration with a factored stiffness.
    fn softest_displacement(
        &self,
        factor: &mut SparseFactor,
        basis: &[Vec<f64>],
    ) -> Option<Vec<f64>> {
        // The initial vector has entries of mixed signs and magnitudes.
        let mut shape: Vec<f64> =
            (0..self.regularisation.len()).map(|i| (1.0 + i as f64).sin() + 0.5).collect();
        for _ in 0..INVERSE_ITERATION_COUNT {
            let mut force: Vec<f64> =
                shape.iter().zip(&self.regularisation).map(|(u, r)| u * r).collect();
            factor.solve(&mut force);
            shape = force;
            for direction in basis.iter().chain(basis) {
                let component = weighted_dot(&self.regularisation, direction, &shape);
                shape.iter_mut().zip(direction).for_each(|(u, unit)| *u -= component * unit);
            }
            // The division by the largest entry comes first, since squares may overflow.
            let max_entry = largest(&shape);
            shape = shape.into_iter().map(|u| u / max_entry).collect();
            let norm = weighted_dot(&self.regularisation, &shape, &shape).sqrt();
            if !(norm.is_finite() && norm > 0.0) {
                return None;
            }
            shape = shape.into_iter().map(|u| u / norm).collect();
        }
        Some(shape)
    }

    /// Work of a displacement on the matrix, relative to the sum of the magnitudes of its terms.
    ///
    /// A degree of freedom without entries contributes the work of the reference stiffness to the sum. If it moves, the
    /// other displacements are rounding errors, and their work must not count as resistance.
    fn relative_work(&self, shape: &[f64]) -> f64 {
        let mut scale: f64 =
            self.empty_dofs.iter().map(|&i| self.reference_stiffness * shape[i].powi(2)).sum();
        let mut work = 0.0_f64;
        for &(row, column, value) in self.matrix.entries() {
            let product = shape[row] * value * shape[column];
            work += product;
            scale += product.abs();
        }
        if scale > 0.0 { work.abs() / scale } else { 0.0 }
    }
}
