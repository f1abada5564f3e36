//! Tangents of a large structure that Newton's method uses again instead of factoring a new one.
//!
//! A factor takes as long as five iterations without one. The first iteration of a step therefore has the last tangent of the
//! step before, and the last iterations have the tangent of an earlier one.

use crate::linalg::SparseMatrix;

/// Smallest number of degrees of freedom for which iterations with an old tangent take less time than a new factor.
const MIN_KEPT_TANGENT_DOFS: usize = 400;
/// Factor of the expected contraction of an iteration with an old tangent.
const CONTRACTION_SAFETY: f64 = 2.0;
/// Largest number of iterations with an old tangent that take less time than a new factor.
const MAX_KEPT_ITERATIONS: i32 = 4;

/// Whether the last tangent is good enough for the remaining iterations of a step.
///
/// The tangents at the last two iterates differ by about `contraction`, the factor by which an iteration with the last
/// tangent reduces the out-of-balance force. `residual`: the present out-of-balance force; `tolerance`: the one at the end.
pub(super) fn may_keep_tangent(
    dof_count: usize,
    contraction: f64,
    residual: f64,
    tolerance: f64,
) -> bool {
    let expected_contraction = CONTRACTION_SAFETY * contraction;
    dof_count >= MIN_KEPT_TANGENT_DOFS
        && residual * expected_contraction.powi(MAX_KEPT_ITERATIONS) <= tolerance
}

/// Tangent with which the first iteration of a step begins.
///
/// A step that is tried again, or continues from a checkpoint, begins with the same tangent.
#[derive(Debug, Default)]
pub(super) struct FirstTangent {
    /// The tangent; empty for none.
    matrix: SparseMatrix,
    /// The step that begins with it.
    step: Option<usize>,
}

impl FirstTangent {
    /// The first tangent of a step; `None` if a new one is needed.
    ///
    /// `last_tangent`: tangent of the last iteration so far.
    pub(super) fn of_step(
        &mut self,
        step: usize,
        last_tangent: &SparseMatrix,
    ) -> Option<&SparseMatrix> {
        if self.follows(step) {
            if last_tangent.order() < MIN_KEPT_TANGENT_DOFS {
                self.matrix = SparseMatrix::default();
            } else if self.matrix.has_pattern_of(last_tangent) {
                self.matrix.copy_values(last_tangent);
            } else {
                self.matrix.clone_from(last_tangent);
            }
        } else if self.step != Some(step) {
            self.matrix = SparseMatrix::default();
        }
        self.step = Some(step);
        (!self.matrix.is_empty()).then_some(&self.matrix)
    }

    /// Whether this is the step after the last one.
    fn follows(&self, step: usize) -> bool {
        self.step.is_some_and(|last_step| last_step + 1 == step)
    }

    /// Values of the first tangent of the next step, for a checkpoint; empty for none.
    pub(super) fn values<'a>(&'a self, step: usize, last_tangent: &'a SparseMatrix) -> &'a [f64] {
        if self.follows(step) && last_tangent.order() >= MIN_KEPT_TANGENT_DOFS {
            last_tangent.values()
        } else if self.step == Some(step) {
            self.matrix.values()
        } else {
            &[]
        }
    }

    /// The first tangent of the next step, from a checkpoint; an empty matrix for none.
    pub(super) fn from_checkpoint(step: usize, matrix: SparseMatrix) -> Self {
        Self { matrix, step: Some(step) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::Triplets;

    fn diagonal(order: usize, value: f64) -> SparseMatrix {
        let entries = (0..order).map(|i| (i, i, value));
        SparseMatrix::new("test", &Triplets::from_entries(order, entries)).unwrap()
    }

    #[test]
    fn a_step_begins_with_the_last_tangent_of_the_step_before() {
        let order = MIN_KEPT_TANGENT_DOFS;
        let mut first_tangent = FirstTangent::default();
        let a = diagonal(order, 1.0);
        let b = diagonal(order, 2.0);
        let c = diagonal(order, 3.0);
        assert!(first_tangent.of_step(4, &a).is_none() && first_tangent.values(4, &a).is_empty());
        // Tangent b is the last of step 4.
        assert_eq!(first_tangent.values(5, &b), b.values());
        assert_eq!(first_tangent.of_step(5, &b), Some(&b));
        // Step 5 is tried again, after iterations with tangent c.
        assert_eq!(first_tangent.of_step(5, &c), Some(&b));
        assert_eq!(first_tangent.values(5, &c), b.values());
        assert_eq!(first_tangent.of_step(6, &c), Some(&c));
        // A run that continues somewhere else.
        assert!(first_tangent.of_step(9, &c).is_none());
        let mut resumed_tangent = FirstTangent::from_checkpoint(6, c.clone());
        assert_eq!(resumed_tangent.of_step(6, &a), Some(&c));
        // Small structures have a new tangent in every step.
        let small_tangent = diagonal(order - 1, 1.0);
        assert!(
            FirstTangent { step: Some(1), ..Default::default() }
                .of_step(2, &small_tangent)
                .is_none()
        );
    }

    #[test]
    fn tangents_are_kept_for_four_iterations() {
        let keeps = |contraction| may_keep_tangent(MIN_KEPT_TANGENT_DOFS, contraction, 1e-4, 1e-12);
        assert!(keeps(4.9e-3) && !keeps(5.1e-3));
        assert!(!keeps(f64::INFINITY) && !may_keep_tangent(1, 1e-9, 1e-4, 1e-12));
    }
}
