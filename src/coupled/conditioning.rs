//! Condition numbers of a scene: how much of double precision it uses.

use crate::coupled::model::operators;
use crate::coupled::model::operators::Operators;
use crate::coupled::scene::Scene;
use crate::coupled::step::solver::Solver;
use crate::error::{Error, Result};
use crate::interface::PreviousContacts;
use crate::linalg::dense_condition;
use std::fmt;

/// Largest accepted conditions of the effective stiffness and the Delassus operator.
///
/// From the measurements of `tests/coupled/conditioning.rs`. Displacements have errors of about thirty roundings
/// times the first condition: a percent at this limit. Tractions have errors that do not matter (a light structure
/// depends on three of their sums), until the sum contains nothing of the ground.
const STIFFNESS_LIMIT: f64 = 1e12;
const DELASSUS_LIMIT: f64 = 1e16;
/// Fraction of a condition that a quantity must explain to be named as its cause.
const MIN_CAUSE_FRACTION: f64 = 1e-3;
/// Condition beyond which a matrix counts as singular.
const SINGULAR_CONDITION: f64 = 1e18;

/// Condition numbers of the matrices of a step.
///
/// A solution loses as many digits as they have.
///
/// In the 1-norm, of matrices scaled by the roots of their diagonal, so that they do not depend on units. Higham's
/// algorithm estimates them from below, nearly always within a factor of three. Infinite for a singular matrix.
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
    /// Condition of the effective stiffness `K_eff` = M/(θΔt²) + C/Δt + θ (K + ∂f/∂u), at the static state.
    ///
    /// One for a structure in modal coordinates, in which it is diagonal.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub effective_stiffness: f64,
    /// Condition of the ground's step compliance G¹. It has no limit, since no step solves with G¹ alone.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub ground: f64,
    /// Condition of the Delassus operator W = G¹ + B K_eff⁻¹ Bᵀ A for the interface at rest.
    ///
    /// Only its normal part if there is no friction; including the compliance of a thin layer.
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

/// Estimates the condition numbers, with laws at the `start` of the first step.
///
/// Returns an error if double precision is insufficient.
pub(crate) fn conditioning(
    scene: &Scene,
    solver: &mut Solver,
    start: &PreviousContacts,
) -> Result<Conditioning> {
    let (operators, contact) = solver.parts_mut();
    let size = scene.layout().len();
    let c = &scene.coefficients;
    let effective_stiffness = operators.condition(&scene.model, c)?;
    let ground = match scene.soil.as_diagonal() {
        // Scaled by its diagonal.
        Some(_) => 1.0,
        None => dense_condition(&scene.soil, size),
    };
    let delassus = contact.condition_at_rest(
        &operators.delassus,
        &scene.static_state.traction,
        start,
        &scene.laws,
    )?;
    if effective_stiffness.is_nan() || effective_stiffness > STIFFNESS_LIMIT {
        let (quantity, ratio) = cause_of_stiffness(scene, operators, effective_stiffness);
        return Err(Error::IllConditioned {
            matrix: operators::EFFECTIVE_STIFFNESS_NAME,
            condition: effective_stiffness,
            limit: STIFFNESS_LIMIT,
            quantity,
            ratio,
        });
    }
    if delassus.is_nan() || delassus > DELASSUS_LIMIT {
        let (quantity, ratio) = cause_of_delassus(scene, operators, delassus, ground);
        return Err(Error::IllConditioned {
            matrix: "Delassus operator",
            condition: delassus,
            limit: DELASSUS_LIMIT,
            quantity,
            ratio,
        });
    }
    Ok(Conditioning { effective_stiffness, ground, delassus })
}

/// Cause of a large condition of K_eff: little inertia of a translation, or very different stiffnesses.
///
/// Returns its name and ratio.
fn cause_of_stiffness(scene: &Scene, operators: &Operators, condition: f64) -> (&'static str, f64) {
    let c = &scene.coefficients;
    let model = &scene.model;
    let stiffness = operators.stiffness_diagonal(model, c);
    let mut ratio: f64 = 0.0;
    for vector in model.influence.of_all(model.coordinates) {
        let resistance: f64 = stiffness.iter().zip(&vector).map(|(k, r)| k * r * r).sum();
        let inertia = c.acceleration[0] * model.mass.form(&vector, &vector);
        ratio = ratio.max(resistance / inertia);
    }
    if ratio >= MIN_CAUSE_FRACTION * condition.min(SINGULAR_CONDITION) {
        return ("stiffness of the structure over its inertia in a time step", ratio);
    }
    let mut largest: f64 = 0.0;
    let mut smallest = f64::INFINITY;
    for &stiffness in stiffness.iter().filter(|stiffness| **stiffness > 0.0) {
        largest = largest.max(stiffness);
        smallest = smallest.min(stiffness);
    }
    let ratio = largest / smallest;
    ("largest over least stiffness within the structure", ratio)
}

/// Cause of a large condition of W: a compliant structure, the ground, or very different elements.
///
/// Returns its name and ratio.
fn cause_of_delassus(
    scene: &Scene,
    operators: &Operators,
    condition: f64,
    ground: f64,
) -> (&'static str, f64) {
    let size = scene.layout().len();
    let mut ratio: f64 = 0.0;
    for i in 0..size {
        let soil = scene.soil.diagonal(size, i);
        ratio = ratio.max((operators.delassus.diagonal(size, i) - soil).abs() / soil.abs());
    }
    if ratio >= MIN_CAUSE_FRACTION * condition.min(SINGULAR_CONDITION) {
        return ("compliance of the structure in a time step over that of the ground", ratio);
    }
    if ground >= MIN_CAUSE_FRACTION * condition.min(SINGULAR_CONDITION) {
        return ("condition of the ground's instantaneous operator", ground);
    }
    let areas = scene.base.areas();
    let largest = areas.iter().copied().fold(0.0, f64::max);
    let smallest = areas.iter().copied().fold(f64::INFINITY, f64::min);
    ("longest over shortest contact element", largest / smallest)
}
