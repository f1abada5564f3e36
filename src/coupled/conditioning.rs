//! Condition numbers of a scene: the loss of digits in double precision.

use crate::coupled::model::effective_stiffness::EFFECTIVE_STIFFNESS_NAME;
use crate::coupled::model::operators::Operators;
use crate::coupled::scene::Scene;
use crate::coupled::step::solver::StepSolver;
use crate::error::{Error, Result};
use crate::interface::PreviousContacts;
use crate::linalg::dense_condition;
use std::fmt;

/// Largest accepted condition of the effective stiffness, from the measurements of `tests/coupled/conditioning.rs`.
///
/// Displacements have errors of about thirty roundings times this condition: one per cent at the limit.
const MAX_STIFFNESS_CONDITION: f64 = 1e12;
/// Largest accepted condition of the Delassus operator, from the same measurements.
///
/// A light structure depends only on three sums of the tractions, in which their errors cancel. Beyond the limit the
/// operator retains no digit of the ground's compliance.
const MAX_DELASSUS_CONDITION: f64 = 1e16;
/// Fraction of a condition number that a ratio must reach to count as its cause.
const MIN_CAUSE_FRACTION: f64 = 1e-3;
/// Condition beyond which a matrix counts as singular.
const SINGULAR_CONDITION: f64 = 1e18;

/// Condition numbers of the matrices of a step.
///
/// A solution loses about as many digits as the decimal logarithm of the condition number. The numbers are in the
/// 1-norm, for matrices scaled by the roots of their diagonals, so that they do not depend on units. Higham's algorithm
/// estimates them from below, nearly always within a factor of three. A singular matrix has an infinite number.
///
/// ```
/// use basemat::bem::SpringGround;
/// use basemat::interface::Bonded;
/// use basemat::structure::RigidBlock;
/// use basemat::Simulation;
///
/// let simulation = Simulation::builder(0.01)
///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
///     .interface(Bonded)
///     .build()?;
/// let conditioning = simulation.conditioning();
/// assert!((conditioning.ground - 1.0).abs() < 1e-12); // independent springs
/// assert!(conditioning.effective_stiffness < 20.0);
/// assert!(conditioning.delassus < 100.0);
/// println!("{conditioning}");
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Conditioning {
    /// Condition of the effective stiffness `K_eff` at the static state.
    ///
    /// `K_eff` = M/(θΔt²) + C/Δt + θ (K + ∂f/∂u) for the θ-method. The condition is one for a structure in modal
    /// coordinates, in which the matrix is diagonal.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub effective_stiffness: f64,
    /// Condition of the ground's step compliance G¹.
    ///
    /// It has no limit, since no step solves with G¹ alone.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub ground: f64,
    /// Condition of the Delassus operator W for the interface at rest.
    ///
    /// W = G¹ + B K_eff⁻¹ Bᵀ A. Without friction it is the condition of the normal part. The compliance of a
    /// thin layer is included.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub delassus: f64,
}

impl fmt::Display for Conditioning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "condition: effective stiffness {:.1e}, ground {:.1e}, Delassus operator {:.1e}",
            self.effective_stiffness, self.ground, self.delassus
        )
    }
}

/// Estimates the condition numbers at the `start` of the first step.
///
/// Returns an error if double precision is insufficient.
pub(crate) fn conditioning(
    scene: &Scene,
    solver: &mut StepSolver,
    start: &PreviousContacts,
) -> Result<Conditioning> {
    let (operators, contact) = solver.operators_and_contact_mut();
    let effective_stiffness = operators.condition_number(&scene.model, &scene.coefficients)?;
    let ground = if scene.step_compliance.as_diagonal().is_some() {
        // A diagonal matrix scaled by its diagonal is the identity.
        1.0
    } else {
        let ground_order = scene.base.elements().layout().len();
        dense_condition(&scene.base.ground_matrix(&scene.step_compliance), ground_order)
    };
    let delassus = contact.condition_number_at_rest(
        &operators.delassus,
        &scene.static_state.traction,
        start,
        &scene.laws,
    )?;
    if effective_stiffness.is_nan() || effective_stiffness > MAX_STIFFNESS_CONDITION {
        let Cause { quantity, ratio } =
            cause_of_stiffness_condition(scene, operators, effective_stiffness);
        return Err(Error::IllConditioned {
            matrix: EFFECTIVE_STIFFNESS_NAME,
            condition: effective_stiffness,
            limit: MAX_STIFFNESS_CONDITION,
            quantity,
            ratio,
        });
    }
    if delassus.is_nan() || delassus > MAX_DELASSUS_CONDITION {
        let Cause { quantity, ratio } =
            cause_of_delassus_condition(scene, operators, delassus, ground);
        return Err(Error::IllConditioned {
            matrix: "Delassus operator",
            condition: delassus,
            limit: MAX_DELASSUS_CONDITION,
            quantity,
            ratio,
        });
    }
    Ok(Conditioning { effective_stiffness, ground, delassus })
}

/// Cause of a large condition number.
struct Cause {
    /// Name of the ratio.
    quantity: &'static str,
    ratio: f64,
}

/// Cause of a large condition of K_eff.
///
/// Either a translation has little inertia, or the structure has very different stiffnesses.
fn cause_of_stiffness_condition(scene: &Scene, operators: &Operators, condition: f64) -> Cause {
    let c = &scene.coefficients;
    let model = &scene.model;
    let stiffnesses = operators.stiffness_diagonal(model, c);
    let mut inertia_ratio: f64 = 0.0;
    for vector in model.influence.whole_vectors(model.coordinate_count) {
        let resistance: f64 = stiffnesses.iter().zip(&vector).map(|(k, r)| k * r * r).sum();
        let inertia = c.acceleration[0] * model.mass.form(&vector, &vector);
        inertia_ratio = inertia_ratio.max(resistance / inertia);
    }
    if inertia_ratio >= MIN_CAUSE_FRACTION * condition.min(SINGULAR_CONDITION) {
        let quantity = "stiffness of the structure over its inertia in a time step";
        return Cause { quantity, ratio: inertia_ratio };
    }
    let mut max_stiffness: f64 = 0.0;
    let mut min_stiffness = f64::INFINITY;
    for &stiffness in stiffnesses.iter().filter(|stiffness| **stiffness > 0.0) {
        max_stiffness = max_stiffness.max(stiffness);
        min_stiffness = min_stiffness.min(stiffness);
    }
    let quantity = "largest over smallest stiffness within the structure";
    Cause { quantity, ratio: max_stiffness / min_stiffness }
}

/// Cause of a large condition of W: a compliant structure, the ground, or very different elements.
fn cause_of_delassus_condition(
    scene: &Scene,
    operators: &Operators,
    condition: f64,
    ground_condition: f64,
) -> Cause {
    let order = scene.layout().len();
    let mut compliance_ratio: f64 = 0.0;
    for i in 0..order {
        let ground_compliance = scene.step_compliance.diagonal(order, i);
        let structure_compliance =
            (operators.delassus.diagonal(order, i) - ground_compliance).abs();
        compliance_ratio = compliance_ratio.max(structure_compliance / ground_compliance.abs());
    }
    if compliance_ratio >= MIN_CAUSE_FRACTION * condition.min(SINGULAR_CONDITION) {
        let quantity = "compliance of the structure in a time step over that of the ground";
        return Cause { quantity, ratio: compliance_ratio };
    }
    if ground_condition >= MIN_CAUSE_FRACTION * condition.min(SINGULAR_CONDITION) {
        let quantity = "condition of the ground's step compliance";
        return Cause { quantity, ratio: ground_condition };
    }
    let areas = scene.base.areas();
    let max_area = areas.iter().copied().fold(0.0, f64::max);
    let min_area = areas.iter().copied().fold(f64::INFINITY, f64::min);
    Cause { quantity: "largest over smallest contact element", ratio: max_area / min_area }
}
