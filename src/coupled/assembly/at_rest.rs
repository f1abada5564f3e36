//! Static state of a scene, in stages; walls are backfilled or wished in place.

use std::cell::RefCell;

use super::backfilled;
use super::static_stages::{
    contacts_under_load, state_under_load, state_under_weight, unloaded_contacts,
};
use crate::coupled::base::PlacedBase;
use crate::coupled::base::fixed_base::is_fixed_base;
use crate::coupled::base::influence::UPWARD_DIRECTION;
use crate::coupled::gravity_stage::GravityStage;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::condensed::Condensed;
use crate::coupled::parts::Parts;
use crate::coupled::statics::buckling::{self, GroundedStructure};
use crate::coupled::statics::compliance::Compliance;
use crate::coupled::statics::equilibrium::StaticProblem;
use crate::coupled::statics::static_state::StaticState;
use crate::coupled::step_compliance::diagonal_inside_outline;
use crate::error::{Result, all_finite, finite};
use crate::interface::{InterfaceLaw, Mode, PreviousContacts, law_of};
use crate::linalg::{CompressedMatrix, dense_multiply_add};
use crate::structure::nonlinear_state;

/// Sum of weight and support of soil at rest that counts as zero, relative to the weight.
const WEIGHT_ROUNDING: f64 = 1e-12;

/// Static state under the weight and the loads at t = 0.
///
/// Without gravity it is the state without forces. The function commits this state to the structure's internal
/// variables. `shared_compliance` receives the compliance of the condensed structure, or otherwise of a linear
/// structure. If the condensed structure has no static state, `condensation` becomes `None`, and the state of the whole
/// structure is computed. A structure with P–Δ that buckles on its ground is an error in every gravity stage, since it
/// would overturn during the run.
pub(crate) fn solve(
    parts: &mut Parts,
    assembled: &Assembled,
    condensation: &mut Option<Condensed>,
    shared_compliance: &RefCell<Option<Compliance>>,
) -> Result<StaticState> {
    let mut state = StaticState::weightless(assembled.base.layout(), assembled.dofs());
    open_gaps(&mut state, &assembled.base, &parts.builder.laws);
    let has_p_delta = buckling::has_p_delta(parts.structure.as_ref());
    let mut ground_compliance = CompressedMatrix::dense(Vec::new());
    if parts.builder.has_static_loads() {
        ground_compliance = static_compliance(parts, &assembled.base)?;
        let loads = StaticLoads::new(parts, assembled)?;
        let weight = &loads.weight;
        let load = &loads.load;
        let laws = &parts.builder.laws;
        let ground = StaticGround {
            compliance: &ground_compliance,
            shared_compliance,
            may_shorten_increments: true,
        };
        let condensed_state = condensation.as_ref().and_then(|condensed| {
            let forces = [condensed.weight.as_slice(), &condensed.load];
            let mut state =
                state_under_loads(parts, &condensed.assembled, ground, laws, forces).ok()?;
            let mut force: Vec<f64> = weight.iter().zip(load).map(|(w, f)| w + f).collect();
            assembled.base.add_forces(-1.0, &state.traction, &mut force);
            state.displacement = condensed.expanded(assembled, &state.displacement, &force);
            Some(state)
        });
        if condensed_state.is_none() {
            *condensation = None;
            *shared_compliance.borrow_mut() = None;
        }
        let is_soil_alone =
            parts.mass_at_rest.is_some() && weight.iter().chain(load).all(|force| *force == 0.0);
        state = match condensed_state {
            Some(state) => state,
            None if is_soil_alone => state,
            None => state_under_loads(parts, assembled, ground, laws, [weight, load])?,
        };
        state.load = loads.structure_load;
    } else if has_p_delta {
        ground_compliance = static_compliance(parts, &assembled.base)?;
    }
    // On a fixed base the assembly has already checked buckling.
    if has_p_delta && !is_fixed_base(parts.ground.as_ref()) {
        let structure = parts.structure.as_ref();
        let laws = &parts.builder.laws;
        let grounded =
            GroundedStructure { assembled, structure, ground_compliance: &ground_compliance, laws };
        let condensed_assembled = condensation.as_ref().map(|condensed| &condensed.assembled);
        buckling::check(grounded, condensed_assembled, &state)?;
    }
    if parts.builder.has_static_loads()
        && let Some(force) = parts.structure.nonlinear_mut()
    {
        force.commit(&state.displacement);
    }
    let structure = &parts.structure;
    (state.force, state.energy) = nonlinear_state(structure.as_ref(), &state.displacement)?;
    all_finite("nonlinear force at t = 0", &state.force)?;
    if let Some(energy) = &state.energy {
        finite("stored energy of the nonlinear force at t = 0", energy.stored)?;
        finite("dissipated energy of the nonlinear force at t = 0", energy.dissipated)?;
    }
    Ok(state)
}

/// Opens the joints of an unloaded structure that have a gap.
fn open_gaps(state: &mut StaticState, base: &PlacedBase, laws: &[Box<dyn InterfaceLaw>]) {
    for e in base.joints().iter().flat_map(|joint| joint.elements.clone()) {
        let gap = base.initial_gap(e);
        if gap > 0.0 && law_of(laws, e).modes().contains(&Mode::Open) {
            state.gap[e] = gap;
            state.modes[e] = Mode::Open;
        }
    }
}

/// Static compliance of the ground, for tractions inside the outline.
///
/// It is a diagonal if the step compliance is one, and zero at joints.
pub(crate) fn static_compliance(parts: &Parts, base: &PlacedBase) -> Result<CompressedMatrix> {
    if parts.step_compliance.as_diagonal().is_some()
        && let Some(compliance) = parts.ground.diagonal_compliance()?
    {
        let quantity = "diagonal static compliance of the ground";
        let diagonal = diagonal_inside_outline(quantity, compliance.at_rest, &parts.elements)?;
        return Ok(CompressedMatrix::of_diagonal(diagonal));
    }
    let mut compliance = vec![0.0; parts.elements.layout().matrix_len()];
    parts.ground.static_compliance(&mut compliance)?;
    parts.elements.refer_inside(&mut compliance);
    Ok(CompressedMatrix::dense(base.spread_ground_matrix(compliance)))
}

/// Weight, and all other loads at t = 0, N.
///
/// Empty without a static state.
pub(crate) fn weight_and_load(parts: &Parts, assembled: &Assembled) -> Result<[Vec<f64>; 2]> {
    if !parts.builder.has_static_loads() {
        return Ok([vec![], vec![]]);
    }
    StaticLoads::new(parts, assembled).map(|loads| [loads.weight, loads.load])
}

/// Static state of a foundation without walls under weight and loads at t = 0, from which further loads act.
///
/// The function commits the state to the structure's internal variables.
pub(super) fn loaded_state(
    parts: &mut Parts,
    assembled: &Assembled,
    ground_compliance: &CompressedMatrix,
) -> Result<LoadedState> {
    let StaticLoads { weight, load, .. } = StaticLoads::new(parts, assembled)?;
    let laws = &parts.builder.laws;
    let gaps = assembled.base.initial_gaps();
    let problem = StaticProblem {
        assembled,
        structure: parts.structure.as_ref(),
        ground_compliance,
        is_frictionless: false,
        jump_offset: &gaps,
        shared_compliance: &RefCell::default(),
        may_shorten_increments: true,
        prescribed_displacement: None,
    };
    let forces: Vec<f64> = weight.iter().zip(&load).map(|(w, f)| w + f).collect();
    let has_p_delta = buckling::has_p_delta(parts.structure.as_ref());
    let (state, contacts) = if forces.iter().all(|force| *force == 0.0) {
        let mut state = StaticState::weightless(assembled.base.layout(), assembled.dofs());
        open_gaps(&mut state, &assembled.base, laws);
        let contacts = unloaded_contacts(laws, &state)?;
        (state, contacts)
    } else {
        let stage = parts.builder.gravity_stage;
        let weight_state = state_under_weight(&problem, laws, stage, &weight)?;
        contacts_under_load(&problem, laws, weight_state, [&weight, &load])?
    };
    if has_p_delta && !is_fixed_base(parts.ground.as_ref()) {
        let structure = parts.structure.as_ref();
        let grounded = GroundedStructure { assembled, structure, ground_compliance, laws };
        buckling::check(grounded, None, &state)?;
    }
    if let Some(force) = parts.structure.nonlinear_mut() {
        force.commit(&state.displacement);
    }
    Ok(LoadedState { state, contacts, forces })
}

/// A static state, with the contacts from which further loads act.
pub(super) struct LoadedState {
    pub(super) state: StaticState,
    pub(super) contacts: PreviousContacts,
    /// Weight and loads, N.
    pub(super) forces: Vec<f64>,
}

/// Forces on the degrees of freedom at t = 0, N.
pub(super) struct StaticLoads {
    /// Load that the structure defines.
    structure_load: Vec<f64>,
    /// Weight, including the loads and the water that are applied with it.
    pub(super) weight: Vec<f64>,
    /// All other loads.
    load: Vec<f64>,
}

impl StaticLoads {
    /// Collects the loads of structure and builder at t = 0.
    pub(super) fn new(parts: &Parts, assembled: &Assembled) -> Result<Self> {
        let Parts { structure, builder, .. } = parts;
        let dofs = assembled.dofs();
        let mut structure_load = vec![0.0; dofs];
        structure.load(0.0, &mut structure_load)?;
        all_finite("load of the structure at t = 0", &structure_load)?;
        let mut load = structure_load.clone();
        let mut weight = vec![0.0; dofs];
        let up = assembled.influence.whole_vector(UPWARD_DIRECTION, dofs);
        assembled.mass.multiply_add(-builder.gravity, &up, &mut weight);
        if let Some(masses) = &parts.mass_at_rest {
            for (sum, mass) in weight.iter_mut().zip(masses) {
                let soil_weight = builder.gravity * mass;
                *sum += soil_weight;
                // Where the support balances the weight, the sum is exactly zero: rounding must not act as a load.
                if sum.abs() <= WEIGHT_ROUNDING * soil_weight.abs() {
                    *sum = 0.0;
                }
            }
        }
        weight.iter_mut().zip(&parts.water_force).for_each(|(sum, force)| *sum += force);
        for external_load in &builder.loads {
            let force = external_load.value(0.0);
            let sum = if external_load.is_weight() { &mut weight } else { &mut load };
            external_load.row().iter().for_each(|&(i, factor)| sum[i] += force * factor);
        }
        all_finite("weight", &weight)?;
        all_finite("load at t = 0", &load)?;
        Ok(Self { structure_load, weight, load })
    }
}

/// Ground in a static problem.
#[derive(Clone, Copy)]
pub(crate) struct StaticGround<'a> {
    /// Static compliance on the contact elements.
    pub(crate) compliance: &'a CompressedMatrix,
    /// Compliance of structure and ground, if it has been computed.
    pub(crate) shared_compliance: &'a RefCell<Option<Compliance>>,
    /// Whether the search for an equilibrium may shorten its increments.
    pub(crate) may_shorten_increments: bool,
}

impl<'a> StaticGround<'a> {
    /// Ground for a comparison of static states.
    ///
    /// Only states that full increments find are compared: close to the capacity of a yielding structure, shapes differ by
    /// far more than forces.
    pub(crate) fn for_comparison(
        compliance: &'a CompressedMatrix,
        shared_compliance: &'a RefCell<Option<Compliance>>,
    ) -> Self {
        Self { compliance, shared_compliance, may_shorten_increments: false }
    }
}

/// Static state under weight and loads at t = 0, with interface laws.
///
/// The structure's internal variables stay unchanged.
pub(crate) fn state_under_loads(
    parts: &Parts,
    assembled: &Assembled,
    ground: StaticGround<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    let Parts { structure, builder, .. } = parts;
    let gaps = assembled.base.initial_gaps();
    let problem = StaticProblem {
        assembled,
        structure: structure.as_ref(),
        ground_compliance: ground.compliance,
        is_frictionless: false,
        jump_offset: &gaps,
        shared_compliance: ground.shared_compliance,
        may_shorten_increments: ground.may_shorten_increments,
        prescribed_displacement: None,
    };
    let has_walls = parts.elements.has_walls() && !is_fixed_base(parts.ground.as_ref());
    let is_backfilled =
        parts.mass_at_rest.is_none() && builder.gravity_stage != GravityStage::WishedInPlace;
    if has_walls && is_backfilled {
        return backfilled::state(parts, &problem, laws, [weight, load]);
    }
    let mut jump_offset = gaps.clone();
    if has_walls {
        // Jumps are zero under the tractions of the soil at rest.
        let traction = backfilled::traction_at_rest(parts, &assembled.base, true)?;
        jump_offset.resize(traction.len(), 0.0);
        dense_multiply_add(ground.compliance, -1.0, &traction, &mut jump_offset);
    }
    let problem = StaticProblem { jump_offset: &jump_offset, ..problem };
    let weight_state = state_under_weight(&problem, laws, builder.gravity_stage, weight)?;
    state_under_load(&problem, laws, weight_state, [weight, load])
}
