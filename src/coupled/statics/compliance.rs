//! Compliance of a structure without supports, for its static state.

use std::rc::Rc;
use std::sync::Arc;

use crate::contact::Delassus;
use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::UPWARD_DIRECTION;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::condensed::Condensed;
use crate::coupled::model::joint_compliance::{
    STATIC_JOINT_COMPLIANCE_RATIO, with_joint_compliance,
};
use crate::coupled::model::operators::condense;
use crate::coupled::statics::prescribed_displacement::{PatternResponse, PrescribedDisplacement};
use crate::error::{Error, Result};
use crate::linalg::{CompressedMatrix, SparseFactor, SparseMatrix, sparse_condition};

/// Name of K + D + εM in errors.
pub(super) const STATIC_STIFFNESS_NAME: &str = "static stiffness matrix";
/// Initial stiffness of the fictitious springs, as a fraction of the foundation's stiffness.
pub(super) const PROXIMAL_SPRING_FRACTION: f64 = 1e-4;

/// Factored K + D + εM: stiffness, tangent of the nonlinear force, and fictitious springs.
pub(crate) struct ShiftedStiffnessFactor {
    /// Shift ε: stiffness of the springs per mass, 1/s².
    pub(crate) shift: f64,
    matrix: Arc<SparseMatrix>,
    pub(crate) factor: SparseFactor,
}

/// Static compliance of structure and ground on the contact elements.
pub(crate) struct Compliance {
    /// Factored K + D + εM.
    pub(crate) factor: Rc<ShiftedStiffnessFactor>,
    /// Displacements of the structure under unit tractions, one column after the other.
    pub(crate) traction_responses: Vec<f64>,
    /// Delassus operator of structure and ground.
    pub(crate) delassus: Delassus,
    /// Response to the load pattern of a prescribed displacement; the tractions' responses do not move its control.
    pub(super) pattern_response: Option<PatternResponse>,
}

impl ShiftedStiffnessFactor {
    /// Factors K + D + εM with the shift ε.
    pub(crate) fn new(assembled: &Assembled, tangent: &SparseMatrix, shift: f64) -> Result<Self> {
        Self::with_spring(assembled, tangent, shift, &SparseMatrix::default())
    }

    /// Factors K + D + εM with the shift ε and the stiffness of a further spring; an empty matrix for none.
    pub(super) fn with_spring(
        assembled: &Assembled,
        tangent: &SparseMatrix,
        shift: f64,
        spring: &SparseMatrix,
    ) -> Result<Self> {
        let Assembled { stiffness, mass, .. } = assembled;
        let terms = [(1.0, &**stiffness), (1.0, tangent), (shift, mass), (1.0, spring)];
        let matrix = SparseMatrix::sum(STATIC_STIFFNESS_NAME, assembled.dofs(), &terms)?;
        let factor =
            SparseFactor::with_elimination(STATIC_STIFFNESS_NAME, &matrix, &assembled.elimination)?;
        Ok(Self { shift, matrix: matrix.into(), factor })
    }

    /// Expands the factor of a condensed structure to the whole structure, with springs at its base.
    pub(crate) fn expanded(
        &self,
        whole_structure: &Assembled,
        condensed_structure: Condensed,
    ) -> Option<Self> {
        let factor = condensed_structure.shifted_factor(&self.matrix)?;
        Some(Self { shift: self.shift, matrix: Arc::clone(&whole_structure.stiffness), factor })
    }

    /// The matrix, if it is positive definite.
    pub(crate) fn positive_definite(&self) -> Option<&SparseMatrix> {
        self.factor.is_positive_definite().then_some(&self.matrix)
    }

    /// Condition of the matrix, scaled by its diagonal.
    pub(crate) fn condition(&self) -> f64 {
        sparse_condition(&self.matrix, &self.factor)
    }
}

impl Compliance {
    /// Compliance of a structure on a base, on a ground of this static compliance.
    ///
    /// Returns an error if the entries of the Delassus operator do not fit into memory.
    pub(crate) fn new(
        factor: Rc<ShiftedStiffnessFactor>,
        base: &PlacedBase,
        ground_compliance: &CompressedMatrix,
    ) -> Result<Self> {
        Self::with_control(factor, base, ground_compliance, None)
    }

    /// Compliance of a structure whose displacement is prescribed in one direction.
    pub(super) fn with_control(
        factor: Rc<ShiftedStiffnessFactor>,
        base: &PlacedBase,
        ground_compliance: &CompressedMatrix,
        prescribed_displacement: Option<&PrescribedDisplacement<'_>>,
    ) -> Result<Self> {
        let order = factor.matrix.order();
        let ground_with_joints;
        let ground_compliance = if base.joints().is_empty() {
            ground_compliance
        } else {
            let solve = |rhs: &mut [f64]| factor.factor.solve_many(rhs);
            let ratio = STATIC_JOINT_COMPLIANCE_RATIO;
            ground_with_joints =
                with_joint_compliance(solve, base, ground_compliance, order, ratio);
            &ground_with_joints
        };
        let mut pattern_response = prescribed_displacement
            .map(|prescribed_displacement| {
                PatternResponse::new(prescribed_displacement, &factor.factor)
            })
            .transpose()?;
        let solve = |rhs: &mut [f64]| {
            factor.factor.solve_many(rhs);
            if let (Some(response), Some(prescribed_displacement)) =
                (&mut pattern_response, prescribed_displacement)
            {
                response.fix_control(prescribed_displacement.control, rhs);
            }
        };
        let (traction_responses, delassus) = condense(solve, base, ground_compliance, order)?;
        Ok(Self { factor, traction_responses, delassus, pattern_response })
    }
}

/// Initial shift ε: stiffness of the fictitious springs per mass, 1/s².
pub(crate) fn initial_shift(
    assembled: &Assembled,
    ground_compliance: &CompressedMatrix,
) -> Result<f64> {
    let foundation_stiffness = vertical_stiffness(ground_compliance, &assembled.base);
    let shift = PROXIMAL_SPRING_FRACTION * foundation_stiffness / vertical_mass(assembled);
    if shift.is_finite() {
        return Ok(shift);
    }
    Err(Error::Singular { matrix: STATIC_STIFFNESS_NAME, order: assembled.dofs() })
}

/// Mass in a vertical translation, kg.
fn vertical_mass(assembled: &Assembled) -> f64 {
    let up = assembled.influence.whole_vector(UPWARD_DIRECTION, assembled.dofs());
    assembled.mass.form(&up, &up)
}

/// Vertical force of a uniform pressure per settlement of the ground, N/m.
fn vertical_stiffness(ground_compliance: &CompressedMatrix, base: &PlacedBase) -> f64 {
    let areas = base.elements().areas();
    let order = base.layout().len();
    let element_count = areas.len();
    let total_area = areas.iter().sum::<f64>();
    // Integral of the settlement under a unit pressure.
    let settled_volume: f64 = match ground_compliance.as_diagonal() {
        Some(diagonal) => areas.iter().zip(diagonal).map(|(area, entry)| area * entry).sum(),
        None => (0..element_count)
            .map(|p| {
                let row = &ground_compliance[p * order..][..element_count];
                areas[p] * row.iter().sum::<f64>()
            })
            .sum(),
    };
    total_area * total_area / settled_volume
}
