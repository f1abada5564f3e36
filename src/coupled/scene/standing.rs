//! Why a structure cannot stand: resultants that its base does not carry, or a mechanism.
//!
//! | symbol | meaning |
//! |---|---|
//! | N, n | displacements of the contact nodes; those of a rigid motion of the base |
//! | r | displacements when the contact nodes take part in that motion and the rest follows |
//! | e | distance of the resultant from the middle of the base |

use super::base::Base;
use super::influence::Part;
use super::mechanism::{AtRest, Held};
use super::model::Tangent;
use super::proximal::Standing;
use crate::error::{Error, StandingError};
use crate::interface::{ContactState, InterfaceLaw, Mode, StepStart, Tolerance, law_of};
use crate::linalg::dot;
use crate::matrix::SparseMatrix;
use crate::structure::{ContactNode, Triplets};

/// The reason behind `error`, that no equilibrium was found under `load`, if it can be told.
pub(super) fn cause(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    load: &[f64],
    error: Error,
) -> Error {
    use Error::{IllConditioned, Preload, Singular};
    if !matches!(error, Preload { .. } | IllConditioned { .. } | Singular { .. }) {
        return error;
    }
    let Some(stiffness) = stiffness_at_rest(stage) else { return error };
    let Standing { model, structure, base, .. } = *stage;
    let at_rest = AtRest { structure, stiffness: &stiffness, mass: &model.mass, base };
    at_rest
        .mechanism()
        .or_else(|| resultants(stage, &at_rest, laws, load))
        .map_or(error, |cause| Error::Standing(Box::new(cause)))
}

/// K and the tangent of the nonlinear force at rest.
fn stiffness_at_rest(stage: &Standing<'_>) -> Option<SparseMatrix> {
    let n = stage.model.unknowns;
    let mut tangent = Tangent::new(n);
    tangent.refill(stage.structure, &vec![0.0; n]).ok()?;
    let mut sum = Triplets::new(n);
    stage.model.stiffness.add_to(1.0, &mut sum);
    tangent.matrix.add_to(1.0, &mut sum);
    SparseMatrix::new("stiffness matrix", &sum).ok()
}

/// Whether the resultants of the load on each part lift it, overturn it, push it off or press it in.
fn resultants(
    stage: &Standing<'_>,
    at_rest: &AtRest<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    load: &[f64],
) -> Option<StandingError> {
    let model = stage.model;
    let mut held = Held::new(at_rest)?;
    model.influence.parts().iter().find_map(|part| {
        let [horizontal, upward] = part.resultants(load);
        let normal = -upward;
        let nodes = nodes_under(stage.base, part);
        let (left, right) = (nodes.first()?.x, nodes.last()?.x);
        let ends = [left, right];
        // What glue carries is not to be told from resultants.
        let little = 1e-6 * normal.abs().max(1.0);
        let glued = |trial| part.elements().iter().any(|&e| sticks_at(law_of(laws, e), trial));
        if glued(ContactState { pressure: -little, ..ContactState::default() }) {
            return None;
        }
        if normal <= 0.0 {
            return Some(StandingError::Lifted { ends, upward });
        }
        let friction = part.elements().iter().map(|&e| law_of(laws, e).friction_coefficient());
        let friction = friction.map(|known| known.unwrap_or(f64::INFINITY)).fold(0.0, f64::max);
        let resistance = friction * normal;
        let cohesive = glued(ContactState { shear: little, ..ContactState::default() });
        if horizontal.abs() > resistance && !cohesive {
            let ratio = horizontal.abs() / resistance;
            return Some(StandingError::Slides { ends, horizontal, normal, resistance, ratio });
        }
        let (middle, half_width) = (0.5 * (left + right), 0.5 * (right - left));
        let moment = dot(&held.rotation(&nodes, middle), load);
        // The soil's pressure stands at the distance e: M + N e = 0.
        let eccentricity = -moment / normal;
        let ratio = eccentricity.abs() / half_width;
        if ratio >= 1.0 {
            return Some(StandingError::Overturns { ends, moment, normal, eccentricity, ratio });
        }
        // At most the bearing pressure everywhere between the resultant's two equal distances.
        let pressures = || part.elements().iter().map(|&e| (e, bearing_pressure(law_of(laws, e))));
        let largest = pressures().fold(0.0, |most: f64, (_, pressure)| most.max(pressure));
        let all: f64 = pressures().map(|(e, pressure)| pressure * stage.base.lengths()[e]).sum();
        let width = 2.0 * half_width * (1.0 - ratio);
        let capacity = all.min(largest * width);
        let ratio = normal / capacity;
        (ratio > 1.0).then_some(StandingError::Sinks { ends, normal, width, capacity, ratio })
    })
}

/// Whether a law holds an element that nobody has moved so far at these tractions, without sliding
/// or opening.
fn sticks_at(law: &dyn InterfaceLaw, trial: ContactState) -> bool {
    let mut memory = vec![0.0; law.memory()];
    let start = StepStart::new(ContactState::default(), Mode::Stick, 1.0);
    if !memory.is_empty() {
        law.initial_memory(&start, &mut memory);
    }
    let start = start.with_memory(&memory);
    let tolerance = Tolerance::new(0.0, 0.0);
    // A bonded base has no other mode.
    law.modes().len() > 1 && law.next_mode(Mode::Stick, &start, &trial, tolerance) == Mode::Stick
}

/// The largest pressure that a law carries; infinite if it has no mode of yielding.
fn bearing_pressure(law: &dyn InterfaceLaw) -> f64 {
    let start = StepStart::new(ContactState::default(), Mode::Stick, 1.0);
    let yielding = law.modes().iter().filter(|mode| mode.is_yield());
    let conditions = yielding.flat_map(|&mode| law.conditions(mode, &start));
    let pressures = conditions.filter_map(|c| c.pressure_alone());
    pressures.reduce(f64::max).unwrap_or(f64::INFINITY)
}

/// The contact nodes of a part's foundations.
fn nodes_under<'a>(base: &'a Base, part: &Part) -> Vec<&'a ContactNode> {
    base.foundations()
        .filter(|(_, elements)| part.elements().contains(&elements.start))
        .flat_map(|(nodes, _)| nodes)
        .collect()
}
