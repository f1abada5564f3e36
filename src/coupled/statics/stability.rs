//! Reasons why a structure cannot stand: resultants beyond the strength of its base, or a mechanism.
//!
//! | symbol | meaning |
//! |---|---|
//! | N, n | displacements of the contact nodes, and their values in a rigid motion of the base |
//! | r | displacements when the contact nodes follow that motion and all else follows them |
//! | e | distance of the resultant from the middle of the base |

use crate::coupled::base::faces::hull;
use crate::coupled::model::mechanism::{Regular, unresisted};
use crate::coupled::model::signs::FIRMLY;
use crate::coupled::statics::equilibrium::Standing;
use crate::coupled::statics::strength::Strength;
use crate::error::{Error, StabilityError};
use crate::geometry::{Edge, axis_name, middle, resultant, span};
use crate::interface::{InterfaceLaw, law_of};
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
    let Standing { assembled, structure, .. } = *stage;
    let at_rest = assembled.at_rest(structure);
    let is_singular = matches!(error, Singular { .. });
    let others = [&assembled.damping, &assembled.mass];
    let massless = || unresisted(structure, at_rest.stiffness, others);
    at_rest
        .mechanism()
        .or_else(|| if is_singular { massless() } else { None })
        .or_else(|| resultants(stage, laws, load))
        .map_or(error, |cause| Error::Stability(Box::new(cause)))
}

/// Whether the resultants of the load on each part lift it, overturn it, push it off or press it in.
fn resultants(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    load: &[f64],
) -> Option<StabilityError> {
    let (assembled, base) = (stage.assembled, &stage.assembled.base);
    let is_plan = base.layout().is_plan();
    // Firmly: on springs of its own stiffness a structure with P–Δ rotates further than the springs are displaced.
    let (held, regular) = Regular::held_by(&assembled.at_rest(stage.structure), FIRMLY);
    let mut factor = regular.factor()?;
    assembled.influence.parts().iter().find_map(|part| {
        let [along, upward, away] = part.resultants(load);
        let (horizontal, normal) = (resultant(along, away), -upward);
        let nodes = part.nodes(base);
        let bounds = [0, 1].map(|axis| span(nodes.iter().map(|node| node.place()[axis])));
        let (ends, across) = (bounds[0], is_plan.then_some(bounds[1]));
        let lengths = || part.elements().iter().map(|&e| base.areas()[e]);
        let pressure = normal / lengths().sum::<f64>();
        let strength = |&e: &usize| {
            Strength::at_pressure(law_of(laws, e), pressure, is_plan, stage.frictionless)
        };
        let strengths: Vec<_> = part.elements().iter().map(strength).collect();
        // With a bond, something must have broken it: otherwise the state would have been found.
        let pulls = strengths.iter().any(|own| own.pulls);
        let coheres = strengths.iter().any(|own| own.coheres);
        let broken = |bonded: bool, then: StabilityError| {
            let then = Box::new(then);
            Some(if bonded { StabilityError::BondBreaks { then } } else { *then })
        };
        let opens = strengths.iter().any(|own| own.opens);
        if normal <= 0.0 {
            let lifted = StabilityError::Uplift { ends, across, upward };
            return if opens { broken(pulls, lifted) } else { None };
        }
        let friction = strengths.iter().map(|own| own.friction).fold(0.0, f64::max);
        let resistance = friction * normal;
        let slides = || {
            let ratio = horizontal.abs() / resistance;
            let error =
                StabilityError::Sliding { ends, across, horizontal, normal, resistance, ratio };
            if ratio > 1.0 { broken(coheres, error) } else { None }
        };
        if !coheres && let Some(slides) = slides() {
            return Some(slides);
        }
        let middles = bounds.map(middle);
        let half_widths = bounds.map(|[least, most]| 0.5 * (most - least));
        let mut moments = [0.0; 3];
        let turns = held.turns(nodes.iter().copied(), middles);
        moments.iter_mut().zip(turns).for_each(|(own, turn)| *own = work(&mut factor, turn, load));
        // The soil's pressure acts at the distance e: M + N e = 0.
        let eccentricities = [-moments[0] / normal, -moments[1] / normal];
        let part_of = |axis: usize| eccentricities[axis].abs() / half_widths[axis];
        // In plan the ratio to the nearest edge, and the axis that this edge faces more.
        let (ratio, axis) = if is_plan {
            nearest_edge(&hull(nodes.iter().copied()), middles, eccentricities)
        } else {
            (part_of(0), 0)
        };
        let eccentricity = eccentricities[axis];
        // By the right-hand rule about y, a moment that lifts the right side is negative.
        let moment = if is_plan && axis == 0 { -moments[0] } else { moments[axis] };
        if ratio >= 1.0 && opens {
            let axis = axis_name(is_plan, axis);
            let error = StabilityError::Overturning {
                ends,
                across,
                axis,
                moment,
                normal,
                eccentricity,
                ratio,
            };
            return broken(pulls, error);
        }
        let all_middles = part.elements().iter().map(|&e| base.elements()[e].center());
        let passed = [0, 1].map(|axis| middles[axis] + eccentricities[axis]);
        let slack = half_widths.map(|half| 1e-9 * half);
        let mut axes = base.layout().axes();
        let beyond = axes.find_map(|axis| beyond(all_middles.clone(), axis, passed, slack));
        if let Some((axis, reach)) = beyond.filter(|_| opens) {
            let (elements, resultant) = (part.elements().len(), passed[axis]);
            let axis = axis_name(is_plan, axis);
            let error = StabilityError::Beyond { ends, across, axis, elements, resultant, reach };
            return broken(pulls, error);
        }
        if let Some(slides) = slides() {
            return Some(slides);
        }
        if let Some(across) = across {
            let resistance = friction * pressure * area_moment(all_middles.zip(lengths()), middles);
            let (torque, ratio) = (moments[2], moments[2].abs() / resistance);
            if ratio > 1.0 {
                let error =
                    StabilityError::Twisting { ends, across, torque, normal, resistance, ratio };
                return broken(coheres, error);
            }
        }
        let width = if is_plan {
            // The area that both eccentricities leave (Meyerhof 1963).
            lengths().sum::<f64>() * (1.0 - part_of(0)) * (1.0 - part_of(1))
        } else {
            2.0 * half_widths[0] * (1.0 - ratio)
        };
        let [capacity, ratio] =
            bearing(strengths.iter().map(|own| own.bearing_pressure).zip(lengths()), normal, width);
        let failure =
            StabilityError::BearingFailure { ends, across, normal, width, capacity, ratio };
        (ratio > 1.0).then_some(failure)
    })
}

/// Sum of the areas of elements, each times its distance from `middle`.
///
/// `elements`: centre and area of each.
fn area_moment(elements: impl Iterator<Item = ([f64; 3], f64)>, middle: [f64; 2]) -> f64 {
    let arm = |[x, y, _]: [f64; 3]| (x - middle[0]).hypot(y - middle[1]);
    elements.map(|(center, area)| arm(center) * area).sum()
}

/// Work of a load on the displacements that these forces cause.
fn work(factor: &mut SparseFactor, mut force: Vec<f64>, load: &[f64]) -> f64 {
    factor.solve(&mut force);
    dot(&force, load)
}

/// Capacity of bearing pressures on elements of these lengths or areas, and the normal force over it.
///
/// At most the largest pressure on `width`, the width centred under the resultant.
fn bearing(elements: impl Iterator<Item = (f64, f64)>, normal: f64, width: f64) -> [f64; 2] {
    let (all, largest) = elements.fold((0.0, 0.0_f64), |(all, largest), (pressure, length)| {
        (all + pressure * length, largest.max(pressure))
    });
    let capacity = (largest * width).min(all);
    [capacity, normal / capacity]
}

/// Largest ratio of a resultant's distance to an edge's distance, from `middle`, and the axis that this edge faces
/// more.
///
/// `outline`: convex. `distance`: of the resultant from the middle.
fn nearest_edge(outline: &[[f64; 2]], middle: [f64; 2], distance: [f64; 2]) -> (f64, usize) {
    let parts = Edge::all(outline).map(|edge| {
        let faces_y = edge.normal[1].abs() > edge.normal[0].abs();
        (edge.outward(distance) / edge.reach(middle), usize::from(faces_y))
    });
    parts.max_by(|one, other| one.0.total_cmp(&other.0)).unwrap_or((0.0, 0))
}

/// The axis and the smallest and largest of the elements' middles along it, if a resultant passes beyond them.
///
/// By more than the slack.
fn beyond(
    middles: impl Iterator<Item = [f64; 3]>,
    axis: usize,
    passed: [f64; 2],
    slack: [f64; 2],
) -> Option<(usize, [f64; 2])> {
    let reach = span(middles.map(|middle| middle[axis]));
    let is_beyond = passed[axis] < reach[0] - slack[axis] || passed[axis] > reach[1] + slack[axis];
    is_beyond.then_some((axis, reach))
}
