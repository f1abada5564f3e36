//! Static state of a structure in a backfilled cut.
//!
//! The structure stands on the bottom of the open cut before the cut is backfilled. The weight acts on the floor alone.
//! The pressures of the soil at rest act on the walls, without shear, and the walls stay closed.
//!
//! | symbol | meaning |
//! |---|---|
//! | S, B | static compliance of the soil, element means of the base displacement |
//! | u₀, τ₀, g₀ | displacement, tractions and gaps after backfilling |
//!
//! The further loads act from this state. The offset of the jumps is therefore B u₀ − S τ₀ + g₀.

use std::cell::RefCell;

use super::static_stages::{GRAVITY_STAGE_TIME_STEP, state_under_load, state_under_weight};
use crate::bem::GroundDescription;
use crate::coupled::base::PlacedBase;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::parts::Parts;
use crate::coupled::statics::equilibrium::StaticProblem;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Result, all_finite, not_negative, same_length};
use crate::geometry::{ContactLayout, Patch};
use crate::interface::{ContactState, InterfaceLaw, PreviousContact, PreviousContacts, law_of};
use crate::linalg::{CompressedMatrix, dense_multiply_add};

/// Static state under weight, backfill and the loads at t = 0.
pub(super) fn state(
    parts: &Parts,
    problem: &StaticProblem<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    let base = &problem.assembled.base;
    let elements = base.elements();
    let layout = base.layout();
    let floor = elements.floor();
    let floor_patch = Patch::new(elements[floor.clone()].to_vec())?;
    let assembled = Assembled::new(problem.structure, &floor_patch, &parts.joints)?.0;
    // Joints act during backfilling too.
    let bearing_elements: Vec<usize> = floor.chain(elements.len()..layout.elements()).collect();
    let floor_indices: Vec<usize> = contact_indices(layout, &bearing_elements).collect();
    let floor_compliance = submatrix(problem.ground_compliance, layout.len(), &floor_indices);
    let shared_compliance = RefCell::default();
    let floor_problem = StaticProblem {
        assembled: &assembled,
        ground_compliance: &floor_compliance,
        shared_compliance: &shared_compliance,
        jump_offset: &assembled.base.initial_gaps(),
        ..*problem
    };

    let mut traction = traction_at_rest(parts, base, false)?;
    let mut weight_and_backfill = weight.to_vec();
    base.add_forces(-1.0, &traction, &mut weight_and_backfill);
    let floor_laws = match laws.len() {
        1 => laws,
        _ if parts.joints.is_empty() => &laws[elements.floor()],
        _ => &parts.bearing_laws,
    };
    let gravity_stage = parts.builder.gravity_stage;
    let (floor_state, floor_contact) =
        state_under_weight(&floor_problem, floor_laws, gravity_stage, &weight_and_backfill)?;

    for (index, value) in floor_indices.iter().zip(&floor_state.traction) {
        traction[*index] = *value;
    }
    let (mut state, mut contact) = closed_state(laws, layout, traction, weight.len())?;
    state.state_variables = vec![Vec::new(); layout.elements()];
    for (k, &e) in bearing_elements.iter().enumerate() {
        state.gap[e] = floor_state.gap[k];
        state.modes[e] = floor_state.modes[k];
        state.state_variables[e].clone_from(&floor_state.state_variables[k]);
        contact[e] = floor_contact[k];
    }
    state.displacement = floor_state.displacement;
    state.substituted_friction = floor_state.substituted_friction;

    // Slip counts from the backfilled state, whose jumps define the offset.
    for element_contact in &mut contact {
        element_contact.slip = 0.0;
        element_contact.slip_across = 0.0;
    }
    let mut jump_offset = vec![0.0; layout.len()];
    base.means(&state.displacement, &mut jump_offset);
    dense_multiply_add(problem.ground_compliance, -1.0, &state.traction, &mut jump_offset);
    jump_offset.iter_mut().zip(&state.gap).for_each(|(offset, gap)| *offset += gap);
    let problem = StaticProblem { jump_offset: &jump_offset, ..*problem };
    state_under_load(&problem, laws, (state, contact), [weight, load])
}

/// Submatrix of the rows and columns at some indices, from a matrix of this order.
fn submatrix(matrix: &[f64], order: usize, indices: &[usize]) -> CompressedMatrix {
    let mut entries = Vec::with_capacity(indices.len() * indices.len());
    for row in indices {
        let row = &matrix[row * order..][..order];
        entries.extend(indices.iter().map(|column| row[*column]));
    }
    CompressedMatrix::dense(entries)
}

/// State of `dofs` degrees of freedom at rest and closed contact under these tractions.
fn closed_state(
    laws: &[Box<dyn InterfaceLaw>],
    layout: ContactLayout,
    traction: Vec<f64>,
    dofs: usize,
) -> Result<(StaticState, Vec<ContactState>)> {
    let mut state = StaticState::weightless(layout, dofs);
    state.traction = traction;
    let mut contact = Vec::with_capacity(layout.elements());
    let mut previous_contacts = Vec::with_capacity(layout.elements());
    for (e, mode) in state.modes.iter_mut().enumerate() {
        *mode = law_of(laws, e).modes()[0];
        contact.push(ContactState { pressure: state.traction[e], ..ContactState::default() });
        previous_contacts.push(PreviousContact::new(contact[e], *mode, GRAVITY_STAGE_TIME_STEP));
    }
    state.set_gaps(laws, &PreviousContacts::new(laws, &previous_contacts)?, &contact)?;
    Ok((state, contact))
}

/// Tractions of the soil at rest on the walls, Pa, and also on the floor if `includes_floor`.
///
/// The elements of `base` are those of the ground, or equal divisions of them. Joints have no such tractions.
pub(super) fn traction_at_rest(
    parts: &Parts,
    base: &PlacedBase,
    includes_floor: bool,
) -> Result<Vec<f64>> {
    let elements = base.elements();
    let layout = base.layout();
    let mut traction = vec![0.0; layout.len()];
    let GroundDescription {
        pressure_at_rest: pressures, depth_of_pressure_at_rest: depths, ..
    } = &parts.description;
    if !pressures.is_empty() {
        same_length("pressures at rest of the ground", pressures.len(), parts.elements.len())?;
        for pressure in pressures {
            not_negative("pressure at rest of the ground", *pressure)?;
        }
    }
    if !depths.is_empty() {
        let quantity = "depths of the pressure at rest of the ground";
        same_length(quantity, depths.len(), parts.elements.len())?;
        all_finite(quantity, depths)?;
    }
    let floor = elements.floor();
    let division_count = elements.len() / parts.elements.len();
    for e in (0..pressures.len() * division_count).filter(|e| includes_floor || !floor.contains(e))
    {
        traction[layout.index_of(0, e)] = parts.builder.gravity * pressures[e / division_count];
    }
    Ok(traction)
}

/// Indices of all components of some elements in a contact vector.
fn contact_indices(layout: ContactLayout, elements: &[usize]) -> impl Iterator<Item = usize> {
    (0..layout.components())
        .flat_map(move |component| elements.iter().map(move |e| layout.index_of(component, *e)))
}
