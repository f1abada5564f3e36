//! Reduced coordinates with damping in proportion to mass and to the stiffness without P–Δ.
//!
//! | symbol | meaning |
//! |---|---|
//! | K, G | stiffness with P–Δ, and the part of it that is P–Δ |
//! | C | damping β(K − G) + αM |
//! | Φ, ω | Ritz modes of M and K, and their circular frequencies |
//! | Z | K_eff, or K + σ²M |
//!
//! Only −βG in C couples the modes. The space is built, and its tolerance checked, with the damping βK + αM. The damping
//! forces −βG of the modes' velocities act on all degrees of freedom. The responses Z⁻¹βGΦω to them are added to the space.

use crate::coupled::assembly::krylov::Reduction;
use crate::coupled::assembly::subspace::{RitzModes, Subspace};
use crate::coupled::base::transformation::ModalBasis;
use crate::error::Result;
use crate::linalg::{SparseFactor, SparseMatrix, symmetric_products};

/// Smallest length of a response to the coupling that is added to the space.
///
/// It is relative to the mode and to the root of the tolerance. Errors of forces and probes depend on the square of
/// this length.
const MIN_COUPLING_LENGTH_RATIO: f64 = 0.1;

impl Reduction<'_> {
    /// The modes in degrees of freedom, with responses to the coupling by damping.
    ///
    /// `factors` are the factored matrices Z.
    pub(super) fn basis_with_damping(
        &self,
        mut space: Subspace<'_>,
        modes: &RitzModes,
        factors: &[&SparseFactor],
        tolerance: f64,
    ) -> Result<ModalBasis> {
        let Some([beta, alpha]) = self.damping_without_p_delta else {
            return Ok(space.basis(modes));
        };
        let mass: &SparseMatrix = &self.assembled.mass;
        let damping: &SparseMatrix = &self.assembled.damping;
        let stiffness: &SparseMatrix = &self.assembled.stiffness;
        let order = mass.order();
        let terms = [(1.0, damping), (-beta, stiffness), (-alpha, mass)];
        let coupling = SparseMatrix::sum("damping matrix of P–Δ", order, &terms)?;
        // The space may have more vectors than the modes.
        let modes = space.ritz()?;
        // The time scheme does not resolve higher frequencies.
        let c = self.coefficients;
        let max_frequency = (c.acceleration[0] / c.displacement[0]).max(0.0).sqrt();
        let mut forces = coupling.times(&space.mode_rows(&modes));
        for (force, square) in forces.chunks_exact_mut(order).zip(&modes.stiffness) {
            let frequency = square.max(0.0).sqrt().min(max_frequency);
            for value in force.iter_mut() {
                *value *= frequency;
            }
        }
        for factor in factors {
            let mut block = forces.clone();
            factor.solve_many(&mut block);
            space.extend_by_length(block, MIN_COUPLING_LENGTH_RATIO * tolerance.sqrt());
        }
        let modes = space.ritz()?;
        let rows = space.mode_rows(&modes);
        let coupled_damping = symmetric_products(&damping.times(&rows), &rows, order);
        let mut basis = space.basis(&modes);
        basis.coupled_damping = coupled_damping;
        Ok(basis)
    }
}
