//! Effective stiffness of a step, and its factor for a tangent that changes.

use super::Model;
use super::base_responses::{BaseResponses, MIN_BASE_LAST_DOFS};
use crate::coupled::base::PlacedBase;
use crate::coupled::scheme::SchemeCoefficients;
use crate::error::{Error, Result, first_not_finite};
use crate::linalg::{ChangingFactor, SparseMatrix};

/// Name of K_eff in errors.
pub(crate) const EFFECTIVE_STIFFNESS_NAME: &str = "effective stiffness matrix";

/// The effective stiffness matrix K_eff.
///
/// It is the sum of M, C and K + ∂f/∂u, each times the scheme's coefficient of Δu.
pub(super) fn effective_stiffness(
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

/// K_eff with a tangent of fixed pattern, factored anew in reused memory when the tangent changes.
pub(crate) struct ChangingStiffness {
    /// K_eff.
    matrix: SparseMatrix,
    /// Values of K_eff without the tangent.
    constant_values: Vec<f64>,
    /// Index in K_eff of each entry of the tangent.
    tangent_indices: Vec<usize>,
    /// Factor of the tangent in K_eff.
    tangent_coefficient: f64,
    pub(super) factor: ChangingFactor,
    /// Responses of the base, for many degrees of freedom.
    pub(super) base_responses: Option<BaseResponses>,
}

impl ChangingStiffness {
    /// Factors K_eff with a tangent.
    ///
    /// The order of elimination and the pattern of the factor serve all later tangents of this pattern.
    pub(super) fn new(
        model: &Model,
        base: &PlacedBase,
        coefficients: &SchemeCoefficients,
        tangent: &SparseMatrix,
    ) -> Result<Self> {
        let matrix = effective_stiffness(model, coefficients, tangent)?;
        let constant = effective_stiffness(model, coefficients, &SparseMatrix::default())?;
        // The pattern of a sum contains the patterns of its terms.
        let constant_values = constant.values_at(&matrix).unwrap_or_default();
        let tangent_indices = tangent.indices_in(&matrix).unwrap_or_default();
        let base_responses = (matrix.order() >= MIN_BASE_LAST_DOFS)
            .then(|| BaseResponses::new(base, matrix.order()));
        let last_rows = base_responses.as_ref().map_or(&[][..], |responses| &responses.dofs);
        let factor = ChangingFactor::ending_with(
            EFFECTIVE_STIFFNESS_NAME,
            &matrix,
            &model.elimination,
            last_rows,
        )?;
        Ok(Self {
            matrix,
            constant_values,
            tangent_indices,
            tangent_coefficient: coefficients.displacement[0],
            factor,
            base_responses,
        })
    }

    /// Factors K_eff with another tangent of the same pattern, without allocating.
    pub(super) fn refactor(&mut self, tangent: &SparseMatrix) -> Result<()> {
        let Self { matrix, constant_values, tangent_indices, tangent_coefficient, factor, .. } =
            self;
        matrix.set_sum(constant_values, *tangent_coefficient, tangent, tangent_indices);
        if let Some((_, value)) = first_not_finite(matrix.values()) {
            let quantity = EFFECTIVE_STIFFNESS_NAME;
            return Err(Error::Input { quantity, value, needed: "finite" });
        }
        factor.refactor(matrix)
    }
}
