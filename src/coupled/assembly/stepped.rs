//! The structure in its stepping coordinates: degrees of freedom, all modes, or Ritz modes.

use std::rc::Rc;
use std::sync::Arc;

use super::vibration_modes::vibration_modes;
use crate::coupled::assembly::fixed_base_results::FixedBaseResponses;
use crate::coupled::assembly::krylov::{FactorEffective, Reduction};
use crate::coupled::base::PlacedBase;
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::coordinates::Coordinates;
use crate::coupled::model::Model;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::joint_compliance::{step_compliance_ratio, with_joint_compliance};
use crate::coupled::model::mechanism::unresisted_mechanism;
use crate::coupled::model::operators::{Operators, StiffnessFactorization};
use crate::coupled::parts::Parts;
use crate::coupled::statics::compliance::ShiftedStiffnessFactor;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, Result};
use crate::interface::LawForm;
use crate::linalg::{CompressedMatrix, SparseMatrix};
use crate::structure::{NonlinearForce, Structure, Tangent};

/// Number of steps for the choice of coordinates if the expected number is unknown.
const DEFAULT_EXPECTED_STEPS: usize = 4_000;

/// Largest number of degrees of freedom for which all modes replace inaccurate Ritz modes.
const MAX_FALLBACK_DOFS: usize = 1_000;
/// Largest number of degrees of freedom for the same replacement with many forces.
///
/// With many forces Ritz modes often do not reach tolerances below 1e-4. All modes of a structure of this size take
/// seven seconds.
const MAX_FALLBACK_DOFS_OF_MANY_FORCES: usize = 2_500;

/// Properties that [`Coordinates::Modes`] needs, for errors.
const MODAL_COORDINATES_NEED: &str = "a linear structure with symmetric matrices, a positive definite mass and a damping that the modes decouple";

/// Times in nanoseconds for the choice of coordinates, as measured by `benches/studies/benches/step.rs`.
mod cost {
    /// Time for each use of an entry of a sparse factor or matrix.
    pub(crate) const SPARSE_ENTRY: f64 = 1.0;
    /// Time for each mode and step.
    pub(crate) const MODE_AND_STEP: f64 = 4.0;
    /// Additional time for each mode, contact component and step.
    ///
    /// It is the excess over the time in degrees of freedom.
    pub(crate) const MODE_AND_CONTACT: f64 = 0.15;
    /// Time for the computation of all modes, divided by the square of their number.
    pub(crate) const ALL_MODES_SQUARE: f64 = 60.0;
    /// Time for the computation of all modes, divided by the cube of their number.
    pub(crate) const ALL_MODES_CUBE: f64 = 0.45;
}

/// Matrices, base and operators of a structure, in the stepping coordinates.
pub(crate) struct SteppedStructure {
    pub(crate) model: Model,
    pub(crate) base: PlacedBase,
    pub(crate) operators: Operators,
    /// Step compliance of the ground, with the numerical compliance of joints.
    pub(crate) step_compliance: Arc<CompressedMatrix>,
}

impl SteppedStructure {
    /// Chooses the coordinates, and factors the effective stiffness in them.
    ///
    /// The effective stiffness in degrees of freedom is factored only if these are stepped, or if the choice depends on the
    /// factor. `reduction` is the input of [`Reduction`], for reduced coordinates.
    pub(crate) fn new(
        parts: &Parts,
        assembled: &Assembled,
        reduction: Option<(FixedBaseResponses, Option<Rc<ShiftedStiffnessFactor>>)>,
        static_state: &StaticState,
    ) -> Result<Self> {
        let Parts { builder, coefficients, .. } = parts;
        let structure = parts.structure.as_ref();
        check_tangent(structure, assembled)?;
        let tangent = Tangent::at(structure, &static_state.displacement)?.matrix;
        let steps = if builder.expected_steps > 0 {
            builder.expected_steps
        } else {
            DEFAULT_EXPECTED_STEPS
        };
        let physical = Model::new(assembled);
        let factor_in_dofs = || {
            let factor = StiffnessFactorization::in_dofs(&physical, coefficients, &tangent);
            factor.map_err(|error| singularity_cause(assembled, structure, &tangent, error))
        };
        // The factor in degrees of freedom, if the choice has computed it.
        let mut chosen_factor = None;
        let modes = match builder.coordinates {
            Coordinates::Physical => None,
            Coordinates::Auto => {
                let factor = chosen_factor.insert(factor_in_dofs()?);
                modes_if_faster(assembled, factor.entry_count(), steps)
            }
            Coordinates::Modes => {
                let modes = vibration_modes(assembled);
                if modes.is_none() {
                    // A singular matrix has its own error, which comes first.
                    factor_in_dofs()?;
                    let needed = MODAL_COORDINATES_NEED;
                    return Err(Error::Scene { quantity: "modal coordinates", needed });
                }
                modes
            }
            Coordinates::Reduced { tolerance } => {
                let (fixed_base, shifted_stiffness) = reduction.unwrap_or_default();
                let inputs =
                    (fixed_base, shifted_stiffness, &factor_in_dofs as &FactorEffective<'_>);
                let reduction = Reduction::new(parts, assembled, inputs, steps)?;
                Some(ritz_modes(&reduction, assembled, tolerance)?)
            }
        };
        let (model, factor) = if let Some(modes) = modes {
            let model = physical.in_modes(assembled, modes);
            let factor = StiffnessFactorization::in_modal_coordinates(&model, coefficients)?;
            (model, factor)
        } else {
            let factor = chosen_factor.map_or_else(factor_in_dofs, Ok)?;
            (physical, StiffnessFactorization::Sparse(factor))
        };
        let base = assembled.base.stepped(&model.transformation);
        let mut factor = factor;
        let step_compliance = compliance_with_joints(parts, &base, &model, &mut factor);
        let operators = Operators::new(&model, &base, &step_compliance, factor, tangent)?;
        Ok(Self { model, base, operators, step_compliance })
    }
}

/// Step compliance of the ground, with the numerical compliance of joints.
fn compliance_with_joints(
    parts: &Parts,
    base: &PlacedBase,
    model: &Model,
    factor: &mut StiffnessFactorization,
) -> Arc<CompressedMatrix> {
    let ground_compliance = Arc::clone(&parts.step_compliance);
    if base.joints().is_empty() {
        return ground_compliance;
    }
    let solve = |rhs: &mut [f64]| factor.solve_many(rhs);
    let count = model.coordinate_count;
    let ratio = step_compliance_ratio(parts.builder.time_step);
    Arc::new(with_joint_compliance(solve, base, &ground_compliance, count, ratio))
}

/// Returns an error for an unsymmetric tangent in plan, where contact needs a symmetric compliance.
fn check_tangent(structure: &dyn Structure, assembled: &Assembled) -> Result<()> {
    let is_symmetric = structure.nonlinear().is_none_or(NonlinearForce::has_symmetric_tangent);
    if is_symmetric || LawForm::of(assembled.base.layout()) == LawForm::Modes {
        return Ok(());
    }
    let quantity = "tangent of the structure";
    Err(Error::Scene { quantity, needed: "symmetric on a base in plan" })
}

/// Ritz modes that reach a tolerance, or all modes of a small structure.
fn ritz_modes(
    reduction: &Reduction<'_>,
    assembled: &Assembled,
    tolerance: f64,
) -> Result<ModalBasis> {
    let max_dofs = if reduction.has_many_forces() {
        MAX_FALLBACK_DOFS_OF_MANY_FORCES
    } else {
        MAX_FALLBACK_DOFS
    };
    reduction.modes(tolerance).or_else(|error| {
        let is_small = matches!(error, Error::Accuracy { .. }) && assembled.dofs() <= max_dofs;
        let modes = if is_small { vibration_modes(assembled) } else { None };
        modes.ok_or(error)
    })
}

/// Replaces the `error` of a singular effective stiffness by its cause.
///
/// The cause is a mechanism; without one the error stays.
fn singularity_cause(
    assembled: &Assembled,
    structure: &dyn Structure,
    tangent: &SparseMatrix,
    error: Error,
) -> Error {
    let Assembled { mass, damping, stiffness, .. } = assembled;
    let terms = [(1.0, &**stiffness), (1.0, tangent)];
    let sum = SparseMatrix::sum("stiffness matrix", assembled.dofs(), &terms).ok();
    let mechanism = sum.and_then(|sum| unresisted_mechanism(structure, &sum, damping, mass));
    mechanism.map_or(error, |cause| Error::Stability(Box::new(cause)))
}

/// The modes, if steps in modal coordinates take less time.
///
/// The computation of the modes is included. `factor_entries` is the number of entries of the sparse factor in
/// degrees of freedom.
fn modes_if_faster(
    assembled: &Assembled,
    factor_entries: usize,
    steps: usize,
) -> Option<ModalBasis> {
    let dofs = assembled.dofs() as f64;
    let steps = steps as f64;
    let contact_components = assembled.base.layout().len();
    let matrix_entries: usize =
        assembled.matrices().into_iter().map(SparseMatrix::entry_count).sum();
    let sparse_step = cost::SPARSE_ENTRY * (2 * factor_entries + 2 * matrix_entries) as f64;
    let modal_step =
        cost::MODE_AND_STEP * dofs + cost::MODE_AND_CONTACT * dofs * contact_components as f64;
    let mode_computation =
        cost::ALL_MODES_SQUARE * dofs.powi(2) + cost::ALL_MODES_CUBE * dofs.powi(3);
    let saves_time = modal_step * steps + mode_computation < sparse_step * steps;
    if saves_time { vibration_modes(assembled) } else { None }
}
