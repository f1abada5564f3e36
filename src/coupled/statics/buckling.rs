//! Buckling of a structure with P–Δ on its ground.
//!
//! | symbol | meaning |
//! |---|---|
//! | K | stiffness of the structure, P–Δ included |
//! | B, A | means of the base displacement over the elements in contact, and areas of these elements |
//! | S | static compliance of the ground and of the interface under these elements |
//!
//! The structure is stable if K + BᵀA S⁻¹ B is positive definite.

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
use crate::structure::{Structure, Tangent, max_diagonal_stiffness};

/// Name of K + BᵀA S⁻¹ B in errors.
const GROUNDED_STIFFNESS_NAME: &str = "stiffness matrix on the ground";
/// Name of S in errors.
const GROUND_COMPLIANCE_NAME: &str = "static compliance of the ground";
/// Compliance of an element of a joint, relative to the largest entry of the ground's compliance.
const CLOSED_JOINT_COMPLIANCE_RATIO: f64 = 1e-6;
/// Uniform compliance that is added to a compliance without a datum.
///
/// It is relative to the largest entry of that compliance.
const UNIFORM_COMPLIANCE_FACTOR: f64 = 10.0;

/// A structure on the static compliance of its ground.
#[derive(Clone, Copy)]
pub(crate) struct GroundedStructure<'a> {
    pub(crate) assembled: &'a Assembled,
    pub(crate) structure: &'a dyn Structure,
    /// Static compliance of the ground under all elements.
    pub(crate) ground_compliance: &'a CompressedMatrix,
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

/// Returns an error for a structure with P–Δ whose static state is an unstable equilibrium.
///
/// Elements that are closed at rest count as bonded to the ground. The error has the load factor with all elements bonded
/// if this factor is below 1. `condensed_structure` is the structure condensed on its base, if it exists. Its matrix
/// takes much less time to factor.
pub(crate) fn check(
    grounded: GroundedStructure<'_>,
    condensed_structure: Option<&Assembled>,
    at_rest: &StaticState,
) -> Result<()> {
    let GroundedStructure { assembled, structure, .. } = grounded;
    // Follower forces have no potential energy, so that this criterion does not apply.
    if structure.has_active_stiffness() {
        return Ok(());
    }
    let Some(loaded) = LoadedStiffness::new(structure, assembled.stiffness_at_rest()) else {
        return Ok(());
    };
    let is_closed = |element: usize| at_rest.modes[element].is_closed();
    // The first check uses the condensed structure, if there is one.
    let first_structure = condensed_structure.unwrap_or(assembled);
    let first_ground = GroundStiffness::new(
        GroundedStructure { assembled: first_structure, ..grounded },
        is_closed,
    );
    if first_ground.is_none_or(|ground| ground.is_stable_with(first_structure.stiffness_at_rest()))
    {
        return Ok(());
    }
    let Some(ground) = GroundStiffness::new(grounded, is_closed) else {
        return Ok(());
    };
    // Without a factor between 0 and 1, P–Δ is not the cause. A mechanism, for example, has its own error.
    let factor_on = |ground: &GroundStiffness<'_>| {
        loaded.critical_factor(1.0, |stiffness| ground.is_stable_with(stiffness))
    };
    let bonded = GroundStiffness::new(grounded, |_| true);
    let factor = bonded.as_ref().and_then(factor_on).or_else(|| factor_on(&ground));
    let Some(factor) = factor else { return Ok(()) };
    if !assembled.is_linear && is_stable_with_tangent(grounded, &ground, at_rest) {
        return Ok(());
    }
    Err(Error::Stability(Box::new(StabilityError::Buckling { factor })))
}

/// Whether a nonlinear structure is stable with the tangent of its force at rest.
fn is_stable_with_tangent(
    grounded: GroundedStructure<'_>,
    ground: &GroundStiffness<'_>,
    at_rest: &StaticState,
) -> bool {
    let GroundedStructure { assembled, structure, .. } = grounded;
    Tangent::at(structure, &at_rest.displacement)
        .and_then(|tangent| {
            let terms = [(1.0, &*assembled.stiffness), (1.0, &tangent.matrix)];
            SparseMatrix::sum(GROUNDED_STIFFNESS_NAME, assembled.dofs(), &terms)
        })
        .is_ok_and(|stiffness| ground.is_stable_with(&stiffness))
}

/// Load factor up to 1 at which a structure with P–Δ becomes unstable.
///
/// All elements are bonded to the ground. `None` for a stable structure, and without P–Δ.
pub(super) fn load_factor(grounded: GroundedStructure<'_>) -> Option<f64> {
    let GroundedStructure { assembled, structure, .. } = grounded;
    // A structure condensed on its base has other degrees of freedom.
    if structure.has_active_stiffness() || structure.dofs() != assembled.dofs() {
        return None;
    }
    let loaded_stiffness = LoadedStiffness::new(structure, assembled.stiffness_at_rest())?;
    let ground = GroundStiffness::new(grounded, |_| true)?;
    loaded_stiffness.critical_factor(1.0, |stiffness| ground.is_stable_with(stiffness))
}

impl<'a> GroundStiffness<'a> {
    /// Stiffness of the ground under the closed elements.
    ///
    /// `None` unless its compliance is positive definite.
    fn new(grounded: GroundedStructure<'a>, is_closed: impl Fn(usize) -> bool) -> Option<Self> {
        let assembled = grounded.assembled;
        let base = &assembled.base;
        let layout = base.layout();
        let contact_indices: Vec<usize> = (0..layout.len())
            .filter(|index| is_closed(layout.component_and_element(*index)[1]))
            .collect();
        let factor = factored_compliance(grounded, &contact_indices)?;
        let dofs = base.dofs();
        // Rows of Bᵀ.
        let contact_count = contact_indices.len();
        let mut columns = vec![0.0; dofs.len() * contact_count];
        for (column, index) in contact_indices.iter().enumerate() {
            for &(dof, weight) in &base.mean_row(*index) {
                let row = dofs.binary_search(&dof).ok()?;
                columns[row * contact_count + column] += weight;
            }
        }
        let mut forces = columns.clone();
        factor.solve_many(&mut forces);
        let products = row_products(&columns, &forces, contact_count.max(1));
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

    /// Whether a structure of this stiffness is stable on the ground.
    fn is_stable_with(&self, stiffness: &SparseMatrix) -> bool {
        let terms = [(1.0, stiffness), (1.0, &self.matrix)];
        let matrices = self.assembled.matrices();
        let penalty = FIRM_SPRING_FACTOR * max_diagonal_stiffness(stiffness);
        SparseMatrix::sum(GROUNDED_STIFFNESS_NAME, stiffness.order(), &terms)
            .and_then(|sum| with_constraints(sum, matrices, penalty))
            .and_then(|sum| SparseFactor::positive_definite(GROUNDED_STIFFNESS_NAME, &sum))
            .is_ok()
    }
}

/// Factored compliance for forces on some components of a contact vector.
///
/// The static compliance of a half-plane is defined up to a uniform settlement. A structure that begins to buckle does not
/// change the sum of its forces on the ground. A uniform compliance therefore does not change the load factor. It is added
/// if the compliance is not positive definite otherwise.
fn factored_compliance(
    grounded: GroundedStructure<'_>,
    contact_indices: &[usize],
) -> Option<SparseFactor> {
    let GroundedStructure { assembled, ground_compliance, laws, .. } = grounded;
    let base = &assembled.base;
    let layout = base.layout();
    let force_compliance = |i: usize, j: usize| {
        let entry = match ground_compliance.as_diagonal() {
            Some(diagonal) => diagonal[i],
            None => ground_compliance[i * layout.len() + j],
        };
        entry / base.area(j)
    };
    let mut compliance = Triplets::new(contact_indices.len());
    for (row, &i) in contact_indices.iter().enumerate() {
        let [component, element] = layout.component_and_element(i);
        let law_compliance = compliance_at_rest(law_of(laws, element))[component.min(1)];
        compliance.add(row, row, law_compliance / base.area(i));
        let has_diagonal = ground_compliance.as_diagonal().is_some();
        let columns = if has_diagonal { row..row + 1 } else { 0..contact_indices.len() };
        for column in columns {
            let j = contact_indices[column];
            let mean = 0.5 * (force_compliance(i, j) + force_compliance(j, i));
            if mean != 0.0 {
                compliance.add(row, column, mean);
            }
        }
    }
    let entries = compliance.entries().iter();
    let max_entry = entries.fold(0.0, |max: f64, (_, _, value)| value.abs().max(max));
    // The compliance of hard contact between bodies is zero.
    for (row, &i) in contact_indices.iter().enumerate() {
        if layout.component_and_element(i)[1] >= base.elements().len() {
            compliance.add(row, row, CLOSED_JOINT_COMPLIANCE_RATIO * max_entry);
        }
    }
    if let Some(factor) = positive_definite(&compliance) {
        return Some(factor);
    }
    let mut means = vec![0.0; layout.len()];
    for translation in assembled.influence.whole_vectors(assembled.dofs()) {
        base.means(&translation, &mut means);
        let displacement: Vec<f64> = contact_indices.iter().map(|index| means[*index]).collect();
        if largest(&displacement) > 0.0 {
            let row: Vec<(usize, f64)> = displacement.into_iter().enumerate().collect();
            compliance.add_outer(&row, UNIFORM_COMPLIANCE_FACTOR * max_entry);
        }
    }
    positive_definite(&compliance)
}

/// Factors a compliance; `None` unless it is positive definite.
fn positive_definite(compliance: &Triplets) -> Option<SparseFactor> {
    let matrix = SparseMatrix::new(GROUND_COMPLIANCE_NAME, compliance).ok()?;
    SparseFactor::positive_definite(GROUND_COMPLIANCE_NAME, &matrix).ok()
}
