//! Load factor at which a structure buckles: the multiple of its forces at rest (P–Δ) that it carries.

use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::structure::{Structure, Triplets};

/// Relative accuracy of a load factor.
const LOAD_FACTOR_ACCURACY: f64 = 1e-6;

/// A stiffness and the part of it that comes from the forces at rest.
pub(crate) struct LoadedStiffness<'a> {
    stiffness: &'a SparseMatrix,
    geometric: SparseMatrix,
}

impl<'a> LoadedStiffness<'a> {
    /// Parts of a structure's `stiffness`; `None` without P–Δ.
    pub(crate) fn new(structure: &dyn Structure, stiffness: &'a SparseMatrix) -> Option<Self> {
        let mut geometric = Triplets::new(structure.dofs());
        structure.geometric_stiffness(&mut geometric).ok()?;
        let geometric = SparseMatrix::new("geometric stiffness matrix", &geometric).ok()?;
        (!geometric.is_empty()).then_some(Self { stiffness, geometric })
    }

    /// Stiffness under `factor` times the forces at rest.
    pub(crate) fn at(&self, factor: f64) -> Result<SparseMatrix> {
        let terms = [(1.0, self.stiffness), (factor - 1.0, &self.geometric)];
        SparseMatrix::sum("stiffness matrix", self.stiffness.order(), &terms)
    }

    /// Smallest factor at which the structure does not stand, between 0 and `limit`.
    ///
    /// `stands` tells whether it does with a stiffness. `None` if it stands under `limit` times its forces at rest, or not
    /// even without them.
    pub(crate) fn factor(&self, limit: f64, stands: impl Fn(&SparseMatrix) -> bool) -> Option<f64> {
        let stands_at = |factor: f64| self.at(factor).is_ok_and(|stiffness| stands(&stiffness));
        if !stands_at(0.0) || stands_at(limit) {
            return None;
        }
        let mut low = 0.0;
        let mut high = limit;
        while high - low > LOAD_FACTOR_ACCURACY * high && high > f64::MIN_POSITIVE {
            let middle = 0.5 * (low + high);
            if stands_at(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }
}
