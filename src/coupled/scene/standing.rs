//! Why a structure cannot stand: resultants that its base does not carry, or a mechanism.
//!
//! | symbol | meaning |
//! |---|---|
//! | N, n | displacements of the contact nodes; those of a rigid motion of the base |
//! | r | displacements when the contact nodes take part in that motion and the rest follows |
//! | e | distance of the resultant from the middle of the base |

use super::base::Base;
use super::influence::Part;
use super::model::Tangent;
use super::proximal::Standing;
use crate::error::{Error, StandingError};
use crate::interface::{InterfaceLaw, law_of};
use crate::linalg::{SparseFactor, dot, largest};
use crate::structure::{ContactNode, Triplets, unknown_numbers};

const NAME: &str = "stiffness matrix with its base held";
/// Springs that hold the contact nodes, relative to the largest stiffness.
const HELD: f64 = 1.0;
/// Mass that keeps mechanisms regular, relative to what makes it as large as the stiffness.
const REGULAR: f64 = 1e-12;
/// Work of a mechanism on the stiffness, relative to that of its largest entries.
const FREE: f64 = 1e-12;
/// Share of the largest displacement from which on an unknown takes part in a mechanism.
const TAKES_PART: f64 = 0.1;

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
    mechanism(stage)
        .or_else(|| resultants(stage, laws, load))
        .map_or(error, |cause| Error::Standing(Box::new(cause)))
}

/// Whether the resultants of the load on each part lift it, overturn it or push it off.
fn resultants(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    load: &[f64],
) -> Option<StandingError> {
    let model = stage.model;
    let mut held = Held::new(stage)?;
    model.influence.parts().iter().find_map(|part| {
        let [horizontal, upward] = part.resultants(load);
        let normal = -upward;
        if normal <= 0.0 {
            return Some(StandingError::Lifted { upward });
        }
        let friction = part.elements().iter().map(|&e| law_of(laws, e).friction_coefficient());
        let friction = friction.map(|known| known.unwrap_or(f64::INFINITY)).fold(0.0, f64::max);
        let resistance = friction * normal;
        if horizontal.abs() > resistance {
            let ratio = horizontal.abs() / resistance;
            return Some(StandingError::Slides { horizontal, normal, resistance, ratio });
        }
        let nodes = nodes_under(stage.base, part);
        let (left, right) = (nodes.first()?.x, nodes.last()?.x);
        let (middle, half_width) = (0.5 * (left + right), 0.5 * (right - left));
        let moment = dot(&held.rotation(&nodes, middle), load);
        // The soil's pressure stands at the distance e: M + N e = 0.
        let eccentricity = -moment / normal;
        let ratio = eccentricity.abs() / half_width;
        (ratio >= 1.0).then_some(StandingError::Overturns { moment, normal, eccentricity, ratio })
    })
}

/// A displacement with the base at rest that no stiffness resists.
fn mechanism(stage: &Standing<'_>) -> Option<StandingError> {
    let mut held = Held::new(stage)?;
    let n = stage.model.unknowns;
    // Inverse iteration from a vector of all signs and sizes.
    let mut motion: Vec<f64> = (0..n).map(|i| (1.0 + i as f64).sin() + 0.5).collect();
    for _ in 0..3 {
        let mut force = vec![0.0; n];
        stage.model.mass.multiply_add(1.0, &motion, &mut force);
        held.factor.solve(&mut force);
        let size = largest(&force);
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        motion = force.into_iter().map(|x| x / size).collect();
    }
    let mut work = 0.0;
    let mut around = 0.0;
    for &(row, column, value) in held.matrix.entries() {
        let product = motion[row] * value * motion[column];
        work += product;
        around += product.abs();
    }
    if work.abs() > FREE * around {
        return None;
    }
    let moves = |i: &usize| motion[*i].abs() > TAKES_PART;
    let unknowns: Vec<usize> = (0..n).filter(moves).collect();
    let place = stage.structure.describe(&unknowns);
    let place = place.unwrap_or_else(|| unknown_numbers(&unknowns));
    Some(StandingError::Mechanism { unknowns, place })
}

/// The stiffness at rest with springs under the contact nodes.
struct Held {
    matrix: Triplets,
    spring: f64,
    factor: SparseFactor,
}

impl Held {
    fn new(stage: &Standing<'_>) -> Option<Self> {
        let Standing { model, structure, base, .. } = *stage;
        let n = model.unknowns;
        let mut tangent = Tangent::new(n);
        tangent.refill(structure, &vec![0.0; n]).ok()?;
        let mut matrix = Triplets::new(n);
        model.stiffness.add_to(1.0, &mut matrix);
        tangent.matrix.add_to(1.0, &mut matrix);
        let stiffest = matrix.entries().iter().fold(0.0_f64, |m, (_, _, k)| m.max(k.abs()));
        let spring = HELD * if stiffest > 0.0 { stiffest } else { 1.0 };
        let [mut right, mut up] = [(); 2].map(|()| vec![0.0; n]);
        base.tie_nodes(spring, &mut matrix, [&mut right, &mut up]);
        let mut regular = matrix.clone();
        let heaviest = largest(&model.mass.diagonal());
        if heaviest > 0.0 {
            model.mass.add_to(REGULAR * spring / heaviest, &mut regular);
        }
        let factor = SparseFactor::new(NAME, &regular).ok()?;
        Some(Self { matrix, spring, factor })
    }

    /// r of a rotation of `nodes` by 1 rad about `middle`.
    fn rotation(&mut self, nodes: &[&ContactNode], middle: f64) -> Vec<f64> {
        let mut rotation = vec![0.0; self.matrix.order()];
        for node in nodes {
            for &(i, weight) in &node.vertical {
                rotation[i] += self.spring * weight * (node.x - middle);
            }
        }
        self.factor.solve(&mut rotation);
        rotation
    }
}

/// The contact nodes of a part's foundations.
fn nodes_under<'a>(base: &'a Base, part: &Part) -> Vec<&'a ContactNode> {
    base.foundations()
        .filter(|(_, elements)| part.elements().contains(&elements.start))
        .flat_map(|(nodes, _)| nodes)
        .collect()
}
