//! Reasons why a structure cannot stand: resultants beyond the strength of its base, or a mechanism.
//!
//! | symbol | meaning |
//! |---|---|
//! | N, n | displacements of the contact nodes, and their values in a rigid motion of the base |
//! | r | displacements when the contact nodes follow that motion and all else follows them |

use crate::coupled::base::faces::hull;
use crate::coupled::model::mechanism::{Regular, unresisted};
use crate::coupled::model::signs::FIRM_SPRING_FACTOR;
use crate::coupled::statics::buckling::{Grounded, load_factor};
use crate::coupled::statics::equilibrium::Standing;
use crate::coupled::statics::loaded_part::LoadedPart;
use crate::coupled::statics::strength::Strength;
use crate::error::{Error, StabilityError};
use crate::geometry::{Edge, middle, resultant, span};
use crate::interface::{InterfaceLaw, LawForm, law_of};
use crate::linalg::{SparseFactor, dot};

/// The cause of `error`, that there is no equilibrium under `load`; `error` itself if it is unknown.
pub(crate) fn cause(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    load: &[f64],
    error: Error,
) -> Error {
    use Error::{IllConditioned, Preload, Singular};
    if !matches!(error, Preload { .. } | IllConditioned { .. } | Singular { .. }) {
        return error;
    }
    let Standing { assembled, structure, soil, .. } = *stage;
    let grounded = Grounded { assembled, structure, soil, laws };
    let at_rest = assembled.at_rest(structure);
    let is_singular = matches!(error, Singular { .. });
    let others = [&*assembled.damping, &assembled.mass];
    at_rest
        .mechanism()
        .or_else(
            || {
                if is_singular { unresisted(structure, at_rest.stiffness, others) } else { None }
            },
        )
        .or_else(|| load_factor(grounded).map(|factor| StabilityError::Buckling { factor }))
        .or_else(|| resultants(stage, laws, load))
        .map_or(error, |cause| Error::Stability(Box::new(cause)))
}

/// Failure of the first part that its load lifts, overturns, pushes off or presses in.
fn resultants(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    load: &[f64],
) -> Option<StabilityError> {
    let assembled = stage.assembled;
    let base = &assembled.base;
    // On springs as stiff as itself, a structure with P–Δ rotates further than the springs are displaced.
    let (springs, regular) =
        Regular::on_springs(&assembled.at_rest(stage.structure), FIRM_SPRING_FACTOR);
    let mut factor = regular.factor()?;
    assembled.influence.parts().iter().find_map(|part| {
        let [along, upward, away] = part.resultants(load);
        let nodes = part.nodes(base);
        let bounds = [0, 1].map(|axis| span(nodes.iter().map(|node| node.place()[axis])));
        let mut moments = [0.0; 3];
        let turns = springs.turns(nodes.iter().copied(), bounds.map(middle));
        for (moment, turn) in moments.iter_mut().zip(turns) {
            *moment = work(&mut factor, turn, load);
        }
        let elements: Vec<_> = part.elements().iter().map(|&e| (e, base.areas()[e])).collect();
        let layout = base.layout();
        let normal = -upward;
        let pressure = normal / elements.iter().map(|(_, area)| area).sum::<f64>();
        let form = LawForm::of(layout);
        let strengths = elements.iter().map(|&(e, _)| {
            Strength::at_pressure(law_of(laws, e), pressure, form, stage.frictionless)
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
            horizontal: resultant(along, away),
            normal,
            moments,
            pressure,
        };
        part.failure()
    })
}

/// Work of a load on the displacements that these forces cause.
fn work(factor: &mut SparseFactor, mut force: Vec<f64>, load: &[f64]) -> f64 {
    factor.solve(&mut force);
    dot(&force, load)
}
