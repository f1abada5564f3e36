//! Buckling of a structure with P–Δ on its ground.
//!
//! | symbol | meaning |
//! |---|---|
//! | K | stiffness of the structure, P–Δ included |
//! | B, A | means of the base displacement over the elements in contact, and areas of these elements |
//! | S | static compliance of the ground and of the interface under these elements |
//!
//! The structure stands if K + BᵀA S⁻¹ B is positive definite.

use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::assembled::LoadedStiffness;
use crate::coupled::model::signs::{FIRM_SPRING_FACTOR, with_constraints};
use crate::coupled::statics::static_state::StaticState;
use crate::coupled::statics::strength::compliance_at_rest;
use crate::error::{Error, Result, StabilityError};
use crate::interface::{InterfaceLaw, law_of};
use crate::linalg::{
    CompressedMatrix, SparseFactor, SparseMatrix, Triplets, largest, row_products,
};
use crate::structure::{Structure, Tangent, stiffest};

const GROUNDED_STIFFNESS_NAME: &str = "stiffness matrix on the ground";
const GROUND_COMPLIANCE_NAME: &str = "static compliance of the ground";
/// Common settlement or translation under a force, relative to the largest that the compliance may give.
const DATUM_SHIFT: f64 = 10.0;

/// A structure on the static compliance of its ground.
#[derive(Clone, Copy)]
pub(crate) struct Grounded<'a> {
    pub(crate) assembled: &'a Assembled,
    pub(crate) structure: &'a dyn Structure,
    /// Static compliance of the ground under all elements.
    pub(crate) soil: &'a CompressedMatrix,
    pub(crate) laws: &'a [Box<dyn InterfaceLaw>],
}

/// Stiffness BᵀA S⁻¹ B of the ground in a structure's degrees of freedom.
struct GroundStiffness<'a> {
    assembled: &'a Assembled,
    matrix: SparseMatrix,
}

/// Whether a structure has P–Δ.
pub(crate) fn has_p_delta(structure: &dyn Structure) -> bool {
    let mut geometric = Triplets::new(structure.dofs());
    structure.geometric_stiffness(&mut geometric).is_ok() && !geometric.entries().is_empty()
}

/// Error for a structure with P–Δ whose static state is an unstable equilibrium.
///
/// Elements that are closed at rest are bonded to the ground. The load factor is the one with all elements bonded, if it is
/// below 1. `condensed`: the structure condensed on its base, if it was, whose matrix is much cheaper to factor.
pub(crate) fn check(
    grounded: Grounded<'_>,
    condensed: Option<&Assembled>,
    at_rest: &StaticState,
) -> Result<()> {
    let Grounded { assembled, structure, .. } = grounded;
    // The stiffness of follower forces has no energy, whose smallest value would be the stable state.
    if structure.has_active_stiffness() {
        return Ok(());
    }
    let Some(loaded) = LoadedStiffness::new(structure, assembled.stiffness_at_rest()) else {
        return Ok(());
    };
    let is_closed = |element: usize| at_rest.modes[element].is_closed();
    let on_base = condensed.unwrap_or(assembled);
    let ground_of_base =
        GroundStiffness::new(Grounded { assembled: on_base, ..grounded }, is_closed);
    if ground_of_base.is_none_or(|ground| ground.is_fixed_base(on_base.stiffness_at_rest())) {
        return Ok(());
    }
    let Some(ground) = GroundStiffness::new(grounded, is_closed) else {
        return Ok(());
    };
    // Without a factor between 0 and 1 the cause is not P–Δ, such as a mechanism, which has its own error.
    let factor_on = |ground: &GroundStiffness<'_>| {
        loaded.factor(1.0, |stiffness| ground.is_fixed_base(stiffness))
    };
    let bonded = GroundStiffness::new(grounded, |_| true);
    let factor = bonded.as_ref().and_then(factor_on).or_else(|| factor_on(&ground));
    let Some(factor) = factor else { return Ok(()) };
    if !assembled.linear && stands_with_tangent(grounded, &ground, at_rest) {
        return Ok(());
    }
    Err(Error::Stability(Box::new(StabilityError::Buckling { factor })))
}

/// Whether a nonlinear structure stands with the tangent of its force at its displacement at rest.
fn stands_with_tangent(
    grounded: Grounded<'_>,
    ground: &GroundStiffness<'_>,
    at_rest: &StaticState,
) -> bool {
    let Grounded { assembled, structure, .. } = grounded;
    Tangent::at(structure, &at_rest.displacement)
        .and_then(|tangent| {
            let terms = [(1.0, &*assembled.stiffness), (1.0, &tangent.matrix)];
            SparseMatrix::sum(GROUNDED_STIFFNESS_NAME, assembled.dofs(), &terms)
        })
        .is_ok_and(|stiffness| ground.is_fixed_base(&stiffness))
}

/// Load factor up to 1 at which a structure with P–Δ buckles or falls over, with all elements bonded to the ground.
///
/// `None` if it stands, and without P–Δ.
pub(super) fn load_factor(grounded: Grounded<'_>) -> Option<f64> {
    let Grounded { assembled, structure, .. } = grounded;
    // A structure condensed on its base has other degrees of freedom.
    if structure.has_active_stiffness() || structure.dofs() != assembled.dofs() {
        return None;
    }
    let loaded = LoadedStiffness::new(structure, assembled.stiffness_at_rest())?;
    let ground = GroundStiffness::new(grounded, |_| true)?;
    loaded.factor(1.0, |stiffness| ground.is_fixed_base(stiffness))
}

impl<'a> GroundStiffness<'a> {
    /// Stiffness of the ground under the closed elements; `None` unless its compliance is positive definite.
    fn new(grounded: Grounded<'a>, is_closed: impl Fn(usize) -> bool) -> Option<Self> {
        let assembled = grounded.assembled;
        let base = &assembled.base;
        let layout = base.layout();
        let places: Vec<usize> =
            (0..layout.len()).filter(|place| is_closed(layout.origin(*place)[1])).collect();
        let factor = factored_compliance(grounded, &places)?;
        let dofs = base.dofs();
        // Rows of Bᵀ.
        let size = places.len();
        let mut columns = vec![0.0; dofs.len() * size];
        for (column, place) in places.iter().enumerate() {
            for &(dof, weight) in &base.mean_row(*place) {
                let row = dofs.binary_search(&dof).ok()?;
                columns[row * size + column] += weight;
            }
        }
        let mut forces = columns.clone();
        factor.solve_many(&mut forces);
        let products = row_products(&columns, &forces, size.max(1));
        let mut matrix = Triplets::new(assembled.dofs());
        for (i, row) in dofs.iter().enumerate() {
            for (j, column) in dofs.iter().enumerate() {
                let mean = 0.5 * (products[i * dofs.len() + j] + products[j * dofs.len() + i]);
                matrix.add(*row, *column, mean);
            }
        }
        let matrix = SparseMatrix::new(GROUNDED_STIFFNESS_NAME, &matrix).ok()?;
        Some(Self { assembled, matrix })
    }

    /// Whether a structure of this stiffness stands on the ground.
    fn is_fixed_base(&self, stiffness: &SparseMatrix) -> bool {
        let terms = [(1.0, stiffness), (1.0, &self.matrix)];
        let matrices = self.assembled.matrices();
        let penalty = FIRM_SPRING_FACTOR * stiffest(stiffness);
        SparseMatrix::sum(GROUNDED_STIFFNESS_NAME, stiffness.order(), &terms)
            .and_then(|sum| with_constraints(sum, matrices, penalty))
            .and_then(|sum| SparseFactor::positive_definite(GROUNDED_STIFFNESS_NAME, &sum))
            .is_ok()
    }
}

/// Factored compliance of the elements at these places of a contact vector, by forces.
///
/// The compliance of a half-plane in the plane has an arbitrary common settlement. A structure that begins to buckle does
/// not change the sum of its forces on the ground, so that a softer common settlement changes no load factor. It is added
/// where the compliance is not positive definite without.
fn factored_compliance(grounded: Grounded<'_>, places: &[usize]) -> Option<SparseFactor> {
    let Grounded { assembled, soil, laws, .. } = grounded;
    let base = &assembled.base;
    let layout = base.layout();
    let by_force = |i: usize, j: usize| {
        let entry = match soil.as_diagonal() {
            Some(diagonal) => diagonal[i],
            None => soil[i * layout.len() + j],
        };
        entry / base.area(j)
    };
    let mut compliance = Triplets::new(places.len());
    for (row, &i) in places.iter().enumerate() {
        let [component, element] = layout.origin(i);
        let law_compliance = compliance_at_rest(law_of(laws, element))[component.min(1)];
        compliance.add(row, row, law_compliance / base.area(i));
        // All columns, or the one of a diagonal.
        let columns = if soil.as_diagonal().is_some() { row..row + 1 } else { 0..places.len() };
        for column in columns {
            let j = places[column];
            let mean = 0.5 * (by_force(i, j) + by_force(j, i));
            if mean != 0.0 {
                compliance.add(row, column, mean);
            }
        }
    }
    if let Some(factor) = positive_definite(&compliance) {
        return Some(factor);
    }
    let entries = compliance.entries().iter();
    let max_entry = entries.fold(0.0, |max: f64, (_, _, value)| value.abs().max(max));
    let mut means = vec![0.0; layout.len()];
    for translation in assembled.influence.of_all(assembled.dofs()) {
        base.means(&translation, &mut means);
        let displacement: Vec<f64> = places.iter().map(|place| means[*place]).collect();
        if largest(&displacement) > 0.0 {
            let row: Vec<(usize, f64)> = displacement.into_iter().enumerate().collect();
            compliance.add_outer(&row, DATUM_SHIFT * max_entry);
        }
    }
    positive_definite(&compliance)
}

/// Factors of a compliance; `None` unless it is positive definite.
fn positive_definite(compliance: &Triplets) -> Option<SparseFactor> {
    let matrix = SparseMatrix::new(GROUND_COMPLIANCE_NAME, compliance).ok()?;
    SparseFactor::positive_definite(GROUND_COMPLIANCE_NAME, &matrix).ok()
}
