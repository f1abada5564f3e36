//! Reasons why a structure cannot stand: resultants beyond the strength of its base, or a mechanism.
//!
//! | symbol | meaning |
//! |---|---|
//! | N, n | displacements of the contact nodes, and their values in a rigid motion of the base |
//! | r | displacements when the contact nodes follow that motion and all else follows them |

use crate::coupled::base::faces::hull;
use crate::coupled::model::load_factor::LoadedStiffness;
use crate::coupled::model::mechanism::{Regular, unresisted};
use crate::coupled::model::signs::FIRMLY;
use crate::coupled::statics::equilibrium::Standing;
use crate::coupled::statics::loaded_part::LoadedPart;
use crate::coupled::statics::strength::Strength;
use crate::error::{Error, StabilityError};
use crate::geometry::{Edge, middle, resultant, span};
use crate::interface::{InterfaceLaw, LawForm, law_of};
use crate::linalg::{Elimination, SparseFactor, SparseMatrix, Triplets, dot};
use crate::structure::DofCombination;

/// Load factor below which a structure has no equilibrium because it buckles, or is too close to it.
const VERGE_OF_BUCKLING: f64 = 1.1;

const SOIL: &str = "stiffness matrix on the ground";

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
    let others = [&*assembled.damping, &assembled.mass];
    let massless = || unresisted(structure, at_rest.stiffness, others);
    at_rest
        .mechanism()
        .or_else(|| if is_singular { massless() } else { None })
        .or_else(|| buckling(stage))
        .or_else(|| resultants(stage, laws, load))
        .map_or(error, |cause| Error::Stability(Box::new(cause)))
}

/// Failure of the first part that its load lifts, overturns, pushes off or presses in.
fn resultants(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    load: &[f64],
) -> Option<StabilityError> {
    let (assembled, base) = (stage.assembled, &stage.assembled.base);
    // Firmly: on springs of its own stiffness a structure with P–Δ rotates further than the springs are displaced.
    let (held, regular) = Regular::held_by(&assembled.at_rest(stage.structure), FIRMLY);
    let mut factor = regular.factor()?;
    assembled.influence.parts().iter().find_map(|part| {
        let [along, upward, away] = part.resultants(load);
        let nodes = part.nodes(base);
        let bounds = [0, 1].map(|axis| span(nodes.iter().map(|node| node.place()[axis])));
        let mut moments = [0.0; 3];
        let turns = held.turns(nodes.iter().copied(), bounds.map(middle));
        moments.iter_mut().zip(turns).for_each(|(own, turn)| *own = work(&mut factor, turn, load));
        let elements: Vec<_> = part.elements().iter().map(|&e| (e, base.areas()[e])).collect();
        let (layout, normal) = (base.layout(), -upward);
        let pressure = normal / elements.iter().map(|(_, area)| area).sum::<f64>();
        let form = LawForm::of(layout);
        let strength = |&(e, _): &(usize, f64)| {
            let law = law_of(laws, e);
            Strength::at_pressure(law, pressure, form, stage.frictionless)
        };
        // In the plane a base has two ends.
        let outline = if layout.axes().len() > 1 { hull(nodes.iter().copied()) } else { vec![] };
        let part = LoadedPart {
            layout,
            edges: Edge::of_base(&outline, bounds[0]),
            bounds,
            strengths: elements.iter().map(strength).collect(),
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

/// Load factor at which a structure with P–Δ buckles or falls over with its base bonded to the ground.
///
/// `None` if it stands, without P–Δ, and for a ground whose static compliance has no inverse.
fn buckling(stage: &Standing<'_>) -> Option<StabilityError> {
    let (assembled, base) = (stage.assembled, &stage.assembled.base);
    let size = base.layout().len();
    let soil = SparseFactor::of(
        SOIL,
        &SparseMatrix::full(size, stage.soil.to_vec()),
        &Elimination::default(),
    )
    .ok()?;
    // Rows of the inverse: tractions by displacements of the elements.
    let mut inverse = vec![0.0; size * size];
    inverse.iter_mut().step_by(size + 1).for_each(|entry| *entry = 1.0);
    soil.solve_many(&mut inverse);
    let rows: Vec<DofCombination> = (0..size).map(|i| base.mean_row(i)).collect();
    let mut on_ground = Triplets::new(assembled.dofs());
    for (j, column) in inverse.chunks_exact(size).enumerate() {
        for (i, traction) in column.iter().enumerate() {
            let stiffness = base.area(i) * traction;
            for &(dof, weight) in &rows[i] {
                let terms = rows[j].iter();
                on_ground.extend(terms.map(|(other, by)| (dof, *other, weight * stiffness * by)));
            }
        }
    }
    let on_ground = SparseMatrix::new(SOIL, &on_ground).ok()?;
    let stands = |stiffness: &SparseMatrix| {
        let sum = [(1.0, stiffness), (1.0, &on_ground)];
        let sum = SparseMatrix::sum(SOIL, assembled.dofs(), &sum);
        sum.and_then(|sum| SparseFactor::positive_definite(SOIL, &sum)).is_ok()
    };
    let loaded = LoadedStiffness::new(stage.structure, assembled.stiffness_at_rest())?;
    loaded.factor(VERGE_OF_BUCKLING, stands).map(|factor| StabilityError::Buckling { factor })
}

/// Work of a load on the displacements that these forces cause.
fn work(factor: &mut SparseFactor, mut force: Vec<f64>, load: &[f64]) -> f64 {
    factor.solve(&mut force);
    dot(&force, load)
}
