//! Causes of a missing equilibrium: mechanisms, buckling, or loads beyond the strength of the base.
//!
//! | symbol | meaning |
//! |---|---|
//! | N, n | displacements of the contact nodes, and their values in a rigid motion of the base |
//! | r | displacements of the structure in that motion of its contact nodes |

use crate::coupled::base::faces::hull;
use crate::coupled::model::mechanism::{RegularisedStiffness, unresisted_mechanism};
use crate::coupled::model::signs::FIRM_SPRING_FACTOR;
use crate::coupled::statics::buckling::{GroundedStructure, load_factor};
use crate::coupled::statics::equilibrium::StaticProblem;
use crate::coupled::statics::loaded_part::LoadedPart;
use crate::coupled::statics::strength::InterfaceStrength;
use crate::error::{Error, StabilityError};
use crate::geometry::{Edge, middle, resultant, span};
use crate::interface::{InterfaceLaw, LawForm, law_of};
use crate::linalg::{SparseFactor, dot};

/// Replaces the `error` of a missing equilibrium under `load` by its cause, if there is one.
pub(crate) fn cause(
    problem: &StaticProblem<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    load: &[f64],
    error: Error,
) -> Error {
    use Error::{IllConditioned, Preload, Singular};
    if !matches!(error, Preload { .. } | IllConditioned { .. } | Singular { .. }) {
        return error;
    }
    let StaticProblem { assembled, structure, ground_compliance, .. } = *problem;
    let grounded = GroundedStructure { assembled, structure, ground_compliance, laws };
    let at_rest = assembled.structure_at_rest(structure);
    let is_singular = matches!(error, Singular { .. });
    at_rest
        .mechanism()
        .or_else(|| {
            if is_singular {
                unresisted_mechanism(
                    structure,
                    at_rest.stiffness,
                    &assembled.damping,
                    &assembled.mass,
                )
            } else {
                None
            }
        })
        .or_else(|| load_factor(grounded).map(|factor| StabilityError::Buckling { factor }))
        .or_else(|| base_failure(problem, laws, load))
        .map_or(error, |cause| Error::Stability(Box::new(cause)))
}

/// Failure of the first connected part whose base does not resist its load.
fn base_failure(
    problem: &StaticProblem<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    load: &[f64],
) -> Option<StabilityError> {
    let assembled = problem.assembled;
    let base = &assembled.base;
    // A structure with P–Δ needs firm springs. On springs as stiff as itself it rotates more than the springs.
    let at_rest = assembled.structure_at_rest(problem.structure);
    let (springs, regularised) = RegularisedStiffness::on_springs(&at_rest, FIRM_SPRING_FACTOR);
    let mut factor = regularised.factor()?;
    // The load on the base of a part that carries others does not follow from its own weight.
    if !base.joints().is_empty() {
        return None;
    }
    assembled.influence.parts().iter().find_map(|part| {
        let [right, upward, along_y] = part.resultants(load);
        let nodes = part.nodes(base);
        let bounds = [0, 1].map(|axis| span(nodes.iter().map(|node| node.place()[axis])));
        // A moment is the work of the load on a unit rotation.
        let mut moments = [0.0; 3];
        let rotation_forces = springs.rotation_forces(nodes.iter().copied(), bounds.map(middle));
        for (moment, forces) in moments.iter_mut().zip(rotation_forces) {
            *moment = work(&mut factor, forces, load);
        }
        let [moment_x, moment_y, torque] = moments;
        let elements: Vec<_> = part.elements().iter().map(|&e| (e, base.areas()[e])).collect();
        let layout = base.layout();
        let normal = -upward;
        let pressure = normal / elements.iter().map(|(_, area)| area).sum::<f64>();
        let form = LawForm::of(layout);
        let strengths = elements.iter().map(|&(e, _)| {
            InterfaceStrength::at_pressure(law_of(laws, e), pressure, form, problem.is_frictionless)
        });
        // In the plane a base has two ends.
        let outline = if layout.axes().len() > 1 { hull(nodes.iter().copied()) } else { vec![] };
        let part = LoadedPart {
            layout,
            edges: Edge::of_base(&outline, bounds[0]),
            bounds,
            strengths: strengths.collect(),
            elements: elements
                .iter()
                .map(|&(e, area)| (base.elements()[e].center(), area))
                .collect(),
            horizontal: resultant(right, along_y),
            normal,
            moments: [moment_x, moment_y],
            torque,
            pressure,
        };
        part.failure()
    })
}

/// Work of a load on the displacements due to other forces.
fn work(factor: &mut SparseFactor, forces: Vec<f64>, load: &[f64]) -> f64 {
    let mut displacements = forces;
    factor.solve(&mut displacements);
    dot(&displacements, load)
}
