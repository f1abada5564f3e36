//! Mechanisms: structures with a motion that nothing resists, at all or while their base is at rest.

use crate::coupled::base::PlacedBase;
use crate::error::{Error, Result, StabilityError};
use crate::linalg::{SparseFactor, SparseMatrix, largest, weighted_dot};
use crate::structure::{HeldBase, Structure, Triplets, dof_list_text};

/// Mass that keeps mechanisms regular, relative to a mass as large as the stiffness.
const REGULARISING_MASS_RATIO: f64 = 1e-12;
/// Work of a mechanism on the stiffness, relative to the work of its largest entries.
const FREE_WORK_RATIO: f64 = 1e-12;
/// Relative work of a mechanism if no factorization has failed.
///
/// Elements added up leave 3e-17; a column of a thousand beams one above the other has 1e-12.
const CERTAINLY_FREE_WORK_RATIO: f64 = f64::EPSILON;
/// Relative work of the softest displacement above which there is no mechanism.
const FIRM_WORK_RATIO: f64 = 1e-6;
/// Fraction of the largest displacement above which a degree of freedom takes part in a mechanism.
const MECHANISM_PART_FRACTION: f64 = 0.1;
/// Largest number of independent mechanisms that are reported.
const MAX_REPORTED_MOTIONS: usize = 32;
/// Number of inverse iterations for each.
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
    /// Error for a mechanism, even if the loads do not set it in motion.
    ///
    /// `held`: factored stiffness with the base held, which suffices for most structures.
    pub(crate) fn check(&self, fixed_factor: &mut SparseFactor) -> Result<()> {
        let regular = Regular::on_firm_springs(self).1;
        let softest = regular.softest(fixed_factor, &[]);
        if softest.is_some_and(|motion| regular.relative_work(&motion) > FIRM_WORK_RATIO) {
            return Ok(());
        }
        self.motion(CERTAINLY_FREE_WORK_RATIO)
            .map_or(Ok(()), |cause| Err(Error::Stability(Box::new(cause))))
    }

    /// The mechanism that causes a failure; `None` if there is none.
    pub(crate) fn mechanism(&self) -> Option<StabilityError> {
        self.motion(FREE_WORK_RATIO)
    }

    /// Cause of `error`, for a structure without equilibrium or factors.
    pub(crate) fn behind(&self, error: Error) -> Error {
        self.mechanism().map_or(error, |cause| Error::Stability(Box::new(cause)))
    }

    /// Error for displacements with the base at rest whose work on the stiffness is at most `free`.
    fn motion(&self, free: f64) -> Option<StabilityError> {
        if self.base.dofs().is_empty() {
            return None;
        }
        let dofs = Regular::on_firm_springs(self).1.free_dofs(free)?;
        let place = place(self.structure, &dofs);
        Some(StabilityError::Mechanism { dofs, place, massless: false })
    }
}

/// A motion that neither stiffness nor damping nor mass resist.
pub(crate) fn unresisted(
    structure: &dyn Structure,
    stiffness: &SparseMatrix,
    others: [&SparseMatrix; 2],
) -> Option<StabilityError> {
    let terms = [stiffness, others[0], others[1]].map(|matrix| {
        let largest = largest(&matrix.diagonal());
        let factor = if largest > 0.0 { largest.recip() } else { 0.0 };
        (factor, matrix)
    });
    let sum = SparseMatrix::weighted_sum(stiffness.order(), &terms);
    let dofs = Regular::new(sum, 1.0, &[]).free_dofs(FREE_WORK_RATIO)?;
    let place = place(structure, &dofs);
    Some(StabilityError::Mechanism { dofs, place, massless: true })
}

/// The structure's names of degrees of freedom, or their numbers.
fn place(structure: &dyn Structure, dofs: &[usize]) -> String {
    structure.describe(dofs).unwrap_or_else(|| dof_list_text(dofs))
}

/// A stiffness, and terms that keep it regular.
pub(crate) struct Regular {
    matrix: Triplets,
    spring: f64,
    /// Terms on the diagonal that keep mechanisms regular.
    added: Vec<f64>,
    /// Degrees of freedom without any entry.
    absent: Vec<usize>,
}

impl Regular {
    /// The stiffness at rest with springs under the contact nodes, as stiff as its largest entry.
    pub(crate) fn on_firm_springs<'a>(at_rest: &StructureAtRest<'a>) -> (HeldBase<'a>, Self) {
        Self::on_springs(at_rest, 1.0)
    }

    /// The stiffness at rest with springs under the contact nodes, `factor` times as stiff as its largest entry.
    pub(crate) fn on_springs<'a>(
        at_rest: &StructureAtRest<'a>,
        factor: f64,
    ) -> (HeldBase<'a>, Self) {
        let StructureAtRest { stiffness, mass, base, .. } = *at_rest;
        let stiffest = stiffness.entries().fold(0.0_f64, |m, (_, _, k)| m.max(k.abs()));
        let spring = factor * if stiffest > 0.0 { stiffest } else { 1.0 };
        let springs = HeldBase::new(base.nodes(), stiffness, spring);
        let regular = Self::new(springs.matrix.clone(), spring, &mass.diagonal());
        (springs, regular)
    }

    /// A matrix with a largest entry of about `spring`, kept regular by `mass`.
    ///
    /// Without mass, its diagonal is used instead. Lagrange multipliers have neither and stay as they are.
    fn new(matrix: Triplets, spring: f64, mass: &[f64]) -> Self {
        let heaviest = largest(mass);
        let mut diagonal = vec![0.0; matrix.order()];
        for &(row, _, value) in matrix.entries().iter().filter(|entry| entry.0 == entry.1) {
            diagonal[row] += value;
        }
        let mut is_absent = vec![true; diagonal.len()];
        for &(row, column, value) in matrix.entries() {
            if value != 0.0 {
                is_absent[row] = false;
                is_absent[column] = false;
            }
        }
        let added: Vec<f64> = diagonal
            .into_iter()
            .enumerate()
            .map(|(i, entry)| match mass.get(i) {
                Some(mass) if *mass > 0.0 => REGULARISING_MASS_RATIO * spring * mass / heaviest,
                _ if entry > 0.0 => REGULARISING_MASS_RATIO * entry,
                _ if is_absent[i] => REGULARISING_MASS_RATIO * spring,
                _ => 0.0,
            })
            .collect();
        let absent = (0..is_absent.len()).filter(|&i| is_absent[i]).collect();
        Self { matrix, spring, added, absent }
    }

    /// Factors of the regular matrix.
    pub(crate) fn factor(&self) -> Option<SparseFactor> {
        let mut sum = self.matrix.clone();
        self.added.iter().enumerate().for_each(|(i, value)| sum.add(i, i, *value));
        SparseFactor::new(HeldBase::STIFFNESS_NAME, &sum).ok()
    }

    /// The degrees of freedom that take part in displacements with work of at most `free`, ascending.
    ///
    /// All such displacements together: by the length of their rows in a basis that the regular part makes
    /// orthonormal, so that neither the choice of the basis nor the numbering of degrees of freedom matters.
    fn free_dofs(&self, free: f64) -> Option<Vec<usize>> {
        let n = self.added.len();
        let mut factor = self.factor()?;
        let mut basis: Vec<Vec<f64>> = Vec::new();
        while basis.len() < MAX_REPORTED_MOTIONS.min(n) {
            match self.softest(&mut factor, &basis) {
                Some(motion) if self.relative_work(&motion) <= free => basis.push(motion),
                _ => break,
            }
        }
        let mut parts = vec![0.0; n];
        for (i, part) in parts.iter_mut().enumerate().filter(|(i, _)| self.added[*i] > 0.0) {
            *part = basis.iter().map(|motion| motion[i] * motion[i]).sum::<f64>().sqrt();
        }
        let limit = MECHANISM_PART_FRACTION * largest(&parts);
        (!basis.is_empty()).then(|| (0..n).filter(|&i| parts[i] > limit).collect())
    }

    /// The softest displacement independent of `basis`, by a factored stiffness.
    fn softest(&self, factor: &mut SparseFactor, basis: &[Vec<f64>]) -> Option<Vec<f64>> {
        // Inverse iteration from a vector of mixed signs and sizes.
        let mut motion: Vec<f64> =
            (0..self.added.len()).map(|i| (1.0 + i as f64).sin() + 0.5).collect();
        for _ in 0..INVERSE_ITERATION_COUNT {
            let mut force: Vec<f64> = motion.iter().zip(&self.added).map(|(u, r)| u * r).collect();
            factor.solve(&mut force);
            motion = force;
            for direction in basis.iter().chain(basis) {
                let component = weighted_dot(&self.added, direction, &motion);
                motion.iter_mut().zip(direction).for_each(|(u, unit)| *u -= component * unit);
            }
            // First divided by the largest entry, since squares may overflow.
            let size = largest(&motion);
            motion = motion.into_iter().map(|u| u / size).collect();
            let size = weighted_dot(&self.added, &motion, &motion).sqrt();
            if !(size.is_finite() && size > 0.0) {
                return None;
            }
            motion = motion.into_iter().map(|u| u / size).collect();
        }
        Some(motion)
    }

    /// Work of a displacement on the matrix, relative to the work of its largest entries.
    ///
    /// Degrees of freedom without entries count with a spring: beside such a displacement all others are rounding.
    fn relative_work(&self, motion: &[f64]) -> f64 {
        let mut scale: f64 = self.absent.iter().map(|&i| self.spring * motion[i].powi(2)).sum();
        let mut work = 0.0_f64;
        for &(row, column, value) in self.matrix.entries() {
            let product = motion[row] * value * motion[column];
            work += product;
            scale += product.abs();
        }
        if scale > 0.0 { work.abs() / scale } else { 0.0 }
    }
}
