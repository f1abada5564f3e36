//! Static state of a structure in the ground: cast on the bottom of an open cut, then backfilled.
//!
//! The base alone carries the weight. The soil at rest presses on the walls, without shear, and the walls stay closed.
//!
//! | symbol | meaning |
//! |---|---|
//! | S, B | static compliance of the soil, element means of the base displacement |
//! | u₀, τ₀ | displacement and tractions after backfilling |

use std::cell::RefCell;

use super::static_stages::{GRAVITY_STAGE_TIME_STEP, loaded, placed};
use crate::bem::GroundDescription;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::parts::Parts;
use crate::coupled::statics::equilibrium::Standing;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Result, all_finite, not_negative, same_length};
use crate::geometry::{ContactLayout, Patch};
use crate::interface::{ContactState, InterfaceLaw, PreviousContact, PreviousContacts, law_of};
use crate::linalg::{CompressedMatrix, dense_multiply_add};

/// The state under weight and backfill, and then under the loads at t = 0.
pub(super) fn state(
    parts: &Parts,
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    let base = &stage.assembled.base;
    let elements = base.elements();
    let layout = elements.layout();
    let floor = elements.floor();
    let below = Patch::new(elements[floor.clone()].to_vec())?;
    let assembled = Assembled::new(stage.structure, &below)?.0;
    let places: Vec<usize> = places(layout, floor.clone()).collect();
    let mut soil = Vec::with_capacity(places.len() * places.len());
    for row in &places {
        soil.extend(places.iter().map(|column| stage.soil[row * layout.len() + column]));
    }
    let soil = CompressedMatrix::dense(soil);
    let shared = RefCell::default();
    let on_floor = Standing { assembled: &assembled, soil: &soil, shared: &shared, ..*stage };

    let mut traction = at_rest(parts, elements, false)?;
    let mut total = weight.to_vec();
    base.add_forces(-1.0, &traction, &mut total);
    let floor_laws = if laws.len() > 1 { &laws[floor.clone()] } else { laws };
    let (found, contact) = placed(&on_floor, floor_laws, parts.builder.gravity_stage, &total)?;

    places
        .iter()
        .zip(&found.traction)
        .for_each(|(place, value)| traction[*place] = *value);
    let mut state = StaticState::weightless(layout, weight.len());
    state.traction = traction;
    let mut states: Vec<ContactState> = (0..layout.elements())
        .map(|e| ContactState { pressure: state.traction[e], ..ContactState::default() })
        .collect();
    for (e, mode) in state.modes.iter_mut().enumerate() {
        *mode = law_of(laws, e).modes()[0];
    }
    let mut start = Vec::with_capacity(states.len());
    for (contact, mode) in states.iter().zip(&state.modes) {
        start.push(PreviousContact::new(*contact, *mode, GRAVITY_STAGE_TIME_STEP));
    }
    state.close_gaps(laws, &PreviousContacts::new(laws, &start)?, &states)?;
    state.gap[floor.clone()].copy_from_slice(&found.gap);
    state.modes[floor.clone()].copy_from_slice(&found.modes);
    state.state_variables = vec![Vec::new(); layout.elements()];
    state.state_variables[floor.clone()].clone_from_slice(&found.state_variables);
    state.displacement = found.displacement;
    state.substituted_friction = found.substituted_friction;
    states[floor].copy_from_slice(&contact);

    // Jumps count from the placed state.
    for element in &mut states {
        element.slip = 0.0;
        element.slip_across = 0.0;
    }
    let mut offset = vec![0.0; layout.len()];
    base.means(&state.displacement, &mut offset);
    dense_multiply_add(stage.soil, -1.0, &state.traction, &mut offset);
    offset.iter_mut().zip(&state.gap).for_each(|(offset, gap)| *offset += gap);
    loaded(&Standing { offset: &offset, ..*stage }, laws, (state, states), [weight, load])
}

/// Tractions of the soil at rest on the ground's elements or on parts of them: on the walls, and on the `base`.
pub(super) fn at_rest(parts: &Parts, elements: &Patch, base: bool) -> Result<Vec<f64>> {
    let layout = elements.layout();
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
    let parts_of_element = elements.len() / parts.elements.len();
    for e in (0..pressures.len() * parts_of_element).filter(|e| base || !floor.contains(e)) {
        traction[layout.place(0, e)] = parts.builder.gravity * pressures[e / parts_of_element];
    }
    Ok(traction)
}

/// Places of the numbers of some elements in a contact vector.
fn places(layout: ContactLayout, elements: std::ops::Range<usize>) -> impl Iterator<Item = usize> {
    (0..layout.components())
        .flat_map(move |component| elements.clone().map(move |e| layout.place(component, e)))
}
