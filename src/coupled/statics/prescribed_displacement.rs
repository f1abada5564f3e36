//! Static loads whose factor follows from a prescribed displacement.
//!
//! | symbol | meaning |
//! |---|---|
//! | p, λ | load pattern, and its factor |
//! | c, d | sum of degrees of freedom with weights, and its prescribed value: c·u = d |
//! | κ | stiffness of a spring on c·u |
//! | C | flexibility (K + D + εM + κ ccᵀ)⁻¹ of an iteration |
//! | R | displacements C BᵀA under unit tractions |
//!
//! The factor is an unknown of each iteration. With the out-of-balance force r, the missing displacement g and the changes
//! δ, Δλ, Δτ, it solves the bordered system
//!
//! ```text
//! (K + D + εM) δ − p Δλ + BᵀA Δτ = r,   c·δ = g
//! ```
//!
//! The spring κ adds the same force on both sides of the first equation, and changes nothing in the solution. C then exists
//! also where the structure is a mechanism, or softens, in the direction of c:
//!
//! ```text
//! Δλ = (g − c·x)/(c·y) + h·Δτ,   x = C (r + κ g c),  y = C p,  h = Rᵀc/(c·y)
//! δ = x + y (g − c·x)/(c·y) − (R − y hᵀ) Δτ
//! ```

use crate::error::{Error, Result};
use crate::linalg::{SparseFactor, SparseMatrix};
use crate::structure::{DofCombination, Triplets};

/// Name of κ ccᵀ in errors.
const CONTROL_SPRING_NAME: &str = "spring on the controlled displacement";

/// Load pattern with the displacement that determines its factor.
pub(crate) struct PrescribedDisplacement<'a> {
    /// Forces of the pattern on the degrees of freedom, N per unit of the factor.
    pub(crate) pattern: &'a [f64],
    pub(crate) control: &'a DofCombination,
    /// Prescribed value of the control, m or rad.
    pub(crate) displacement: f64,
    /// Stiffness κ of the spring on the control, N/m or N m/rad.
    pub(crate) spring_stiffness: f64,
}

/// Response of the matrix of an iteration to the load pattern.
pub(crate) struct PatternResponse {
    /// Displacement y.
    displacement: Vec<f64>,
    /// Value c·y of the control.
    controlled: f64,
    /// Change h of the load factor due to a unit of each traction.
    traction_factors: Vec<f64>,
}

/// Stiffness κ of the control's spring: that of its degrees of freedom at rest.
///
/// `diagonal`: diagonal of the structure's stiffness at rest. Zero for a rigid body, whose springs εM resist the control.
pub(crate) fn control_stiffness(control: &DofCombination, diagonal: &[f64]) -> f64 {
    let mut stiffness = 0.0;
    let mut weight_square = 0.0;
    for &(dof, weight) in control {
        stiffness += weight * weight * diagonal[dof].max(0.0);
        weight_square += weight * weight;
    }
    stiffness / (weight_square * weight_square)
}

impl PrescribedDisplacement<'_> {
    /// Matrix κ ccᵀ.
    pub(crate) fn spring(&self, dofs: usize) -> Result<SparseMatrix> {
        let mut spring = Triplets::new(dofs);
        spring.add_outer(self.control, self.spring_stiffness);
        SparseMatrix::new(CONTROL_SPRING_NAME, &spring)
    }

    /// Displacement g that the control still has to move.
    pub(crate) fn missing_displacement(&self, displacement: &[f64]) -> f64 {
        self.displacement - self.control.value(displacement)
    }

    /// Adds κ g c, the force of the control's spring, to a right-hand side.
    pub(crate) fn add_spring_force(&self, missing_displacement: f64, right_hand_side: &mut [f64]) {
        for &(dof, weight) in self.control {
            right_hand_side[dof] += self.spring_stiffness * missing_displacement * weight;
        }
    }
}

impl PatternResponse {
    /// Response to the pattern of `prescribed_displacement`, without tractions.
    ///
    /// # Errors
    /// [`Error::Scene`] for a pattern that does not move the control.
    pub(crate) fn new(
        prescribed_displacement: &PrescribedDisplacement<'_>,
        factor: &SparseFactor,
    ) -> Result<Self> {
        let mut displacement = prescribed_displacement.pattern.to_vec();
        factor.solve_many(&mut displacement);
        let controlled = prescribed_displacement.control.value(&displacement);
        if controlled == 0.0 || !controlled.is_finite() {
            let needed = "one that moves the controlled degree of freedom";
            return Err(Error::Scene { quantity: "load pattern of the push-over", needed });
        }
        Ok(Self { displacement, controlled, traction_factors: Vec::new() })
    }

    /// Replaces the columns of R by those of R − y hᵀ, in which the control does not move.
    pub(crate) fn fix_control(&mut self, control: &DofCombination, columns: &mut [f64]) {
        self.traction_factors.clear();
        for column in columns.chunks_exact_mut(self.displacement.len()) {
            let factor = control.value(column) / self.controlled;
            for (entry, y) in column.iter_mut().zip(&self.displacement) {
                *entry -= factor * y;
            }
            self.traction_factors.push(factor);
        }
    }

    /// Moves the control by `missing_displacement` in all, after x.
    ///
    /// Returns the change of the load factor without changes of tractions.
    pub(crate) fn move_control(
        &self,
        control: &DofCombination,
        missing_displacement: f64,
        displacement: &mut [f64],
    ) -> f64 {
        let factor = (missing_displacement - control.value(displacement)) / self.controlled;
        for (entry, y) in displacement.iter_mut().zip(&self.displacement) {
            *entry += factor * y;
        }
        factor
    }

    /// Change of the load factor due to changes of the tractions.
    pub(crate) fn factor_of_tractions(&self, from: &[f64], to: &[f64]) -> f64 {
        let changes = from.iter().zip(to).map(|(from, to)| to - from);
        self.traction_factors.iter().zip(changes).map(|(h, change)| h * change).sum()
    }
}
