//! Checks of every step of any run.

use basemat::coupled::{EnergyBalance, State};
use basemat::interface::{ContactState, Mode};
use proptest::prelude::*;

use super::recipe::{GroundRecipe, LawRecipe, SceneRecipe, SchemeRecipe};
use super::tally::PropertyTally;

/// Largest magnitude.
pub(crate) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m, x| m.max(x.abs()))
}

/// The left-hand side's terms and the input.
pub(crate) fn terms(energy_balance: &EnergyBalance) -> [f64; 11] {
    [
        energy_balance.kinetic,
        energy_balance.strain,
        energy_balance.hysteresis,
        energy_balance.damping,
        energy_balance.algorithmic,
        energy_balance.midstep_remainder,
        energy_balance.soil,
        energy_balance.contact,
        energy_balance.interface,
        energy_balance.static_contact,
        energy_balance.input,
    ]
}

/// Largest energy, traction and length of a run, to which rounding is relative.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RunScales {
    /// Includes the energy of the ground's motion.
    pub(crate) energy: f64,
    pub(crate) traction: f64,
    pub(crate) length: f64,
}

impl RunScales {
    pub(crate) fn largest(states: &[State]) -> Self {
        let contact = states.iter().flat_map(|state| &state.contact);
        let jump = largest(contact.clone().flat_map(|c| [c.gap, c.slip]));
        let free_field = largest(states.iter().flat_map(|state| state.free_field));
        let displacement =
            largest(states.iter().flat_map(|state| state.absolute_displacement().to_vec()));
        Self {
            energy: one_if_zero(states.last().map_or(0.0, |state| state.energy_balance.largest)),
            traction: one_if_zero(largest(contact.flat_map(|c| [c.pressure, c.shear]))),
            length: one_if_zero(jump.max(free_field).max(displacement)),
        }
    }
}

fn one_if_zero(value: f64) -> f64 {
    if value > 0.0 { value } else { 1.0 }
}

pub(crate) fn numbers_are_finite(states: &[State]) -> Result<(), TestCaseError> {
    for state in states {
        let contact = state.contact.iter().flat_map(|c| [c.gap, c.slip, c.pressure, c.shear]);
        let results = [
            state.time,
            state.base_shear,
            state.base_moment,
            state.normal_force,
            state.uplifted_fraction,
            state.mean_slip,
            state.base_rotation,
        ];
        let all_contacts = state
            .absolute_displacement()
            .iter()
            .chain(state.velocity())
            .chain(state.acceleration())
            .chain(&state.free_field)
            .copied()
            .chain(contact)
            .chain(results)
            .chain(terms(&state.energy_balance));
        prop_assert!({ all_contacts }.all(f64::is_finite), "step {}: not finite", state.step);
    }
    Ok(())
}

/// Energy error that a step of a flight may have, in roundings times the condition of the effective stiffness.
///
/// The rounding of the factors is the same in every step and acts as a spring on the rigid motion, so that errors of
/// steps add up. In modes the condition is one: see `tests/coupled/conditioning.rs`.
const MAX_ROUNDINGS: f64 = 10.0;

/// The energy balance closes, and dissipated energy never decreases.
pub(crate) fn energy_is_conserved(
    recipe: &SceneRecipe,
    states: &[State],
    condition: f64,
    tally: &mut PropertyTally,
) -> Result<(), TestCaseError> {
    let scale = RunScales::largest(states).energy;
    let has_exact_history = !matches!(
        recipe.ground,
        GroundRecipe::HalfPlane { history: basemat::history::HistoryMethod::Exponentials, .. }
    );
    // Where du = Δt v*, the work of the dashpots in a step is a square.
    let is_one_point_scheme =
        matches!(recipe.scheme, SchemeRecipe::Midpoint | SchemeRecipe::Theta(_));
    // K Δu of a flight is rounded likewise.
    let flight_rounding =
        if recipe.weightless { MAX_ROUNDINGS * condition * f64::EPSILON } else { 0.0 };
    for pair in states.windows(2) {
        let start = &pair[0].energy_balance;
        let end = &pair[1].energy_balance;
        let energy_error = end.residual();
        let rounding = pair[1].step as f64 * condition * f64::EPSILON;
        let limit = if recipe.weightless { (1e-9_f64).max(MAX_ROUNDINGS * rounding) } else { 1e-9 };
        tally.within("energy error, of the largest energy so far", energy_error, limit)?;
        if energy_error > 1e-9 {
            tally.count("steps with an energy error of more than 1e-9", 1);
            tally.within(
                "the same, in roundings times condition and steps",
                energy_error / rounding,
                MAX_ROUNDINGS,
            )?;
        }
        let gain = (start.contact - end.contact) / scale;
        tally.within("gained from friction and impact in a step", gain, 1e-12)?;
        if is_one_point_scheme {
            let gain = (start.damping - end.damping) / scale;
            tally.within("gained from dashpots in a step", gain, 1e-12)?;
            if !matches!(recipe.law, LawRecipe::ThinLayer(..)) {
                let gain = (start.algorithmic - end.algorithmic) / scale;
                let limit = flight_rounding.max(1e-12);
                tally.within("gained from the θ scheme in a step", gain, limit)?;
            }
        }
        if has_exact_history {
            tally.within("taken out of the soil", -end.soil / scale, 1e-12)?;
        }
    }
    Ok(())
}

/// Signorini's and Coulomb's conditions.
pub(crate) fn contact_conditions_hold(
    recipe: &SceneRecipe,
    states: &[State],
    tally: &mut PropertyTally,
) -> Result<(), TestCaseError> {
    let scales = RunScales::largest(states);
    for pair in states.windows(2) {
        for (e, (start, end)) in pair[0].contact.iter().zip(&pair[1].contact).enumerate() {
            let mode = pair[1].modes[e];
            if recipe.law == LawRecipe::Bonded {
                let motion = end.gap.abs().max(end.slip.abs()) / scales.length;
                tally.within("bonded base moves", motion, 1e-11)?;
                continue;
            }
            if recipe.is_hard() || mode.is_closed() {
                check_cone(recipe, end, scales, tally)?;
            }
            if !recipe.is_hard() {
                continue;
            }
            check_signorini(end, scales, tally)?;
            if mode.is_closed() {
                check_slip(recipe, start, end, mode, scales, tally)?;
            } else {
                let shear = end.shear.abs() / scales.traction;
                tally.within("shear of an open element", shear, 0.0)?;
            }
        }
    }
    Ok(())
}

/// Tractions are within the friction cone.
fn check_cone(
    recipe: &SceneRecipe,
    end: &ContactState,
    scales: RunScales,
    tally: &mut PropertyTally,
) -> Result<(), TestCaseError> {
    let tension = -end.pressure / scales.traction;
    tally.within("tension, of the largest traction", tension, 1e-10)?;
    let friction = recipe.friction();
    let excess_shear =
        if friction.is_infinite() { 0.0 } else { end.shear.abs() - friction * end.pressure };
    tally.within(
        "beyond the friction cone, of the largest traction",
        excess_shear / scales.traction,
        1e-10,
    )
}

/// No penetration, and no pressure at a gap.
fn check_signorini(
    end: &ContactState,
    scales: RunScales,
    tally: &mut PropertyTally,
) -> Result<(), TestCaseError> {
    let gap = end.gap / scales.length;
    tally.within("penetration, of the largest length", -gap, 1e-11)?;
    tally.within("gap and pressure at once", gap.min(end.pressure / scales.traction), 1e-11)
}

/// Friction works against the slip of an element that is closed at the end of the step.
///
/// The element slides at its friction limit only.
fn check_slip(
    recipe: &SceneRecipe,
    start: &ContactState,
    end: &ContactState,
    mode: Mode,
    scales: RunScales,
    tally: &mut PropertyTally,
) -> Result<(), TestCaseError> {
    let friction = recipe.friction();
    let slip_increment = (end.slip - start.slip) / scales.length;
    let shear = end.shear / scales.traction;
    let backward_slip = if friction == 0.0 {
        0.0
    } else {
        (-slip_increment * shear.signum()).min(end.shear.abs() / scales.traction)
    };
    tally.within("slip along the friction", backward_slip, 1e-11)?;
    let distance_from_limit = if friction.is_infinite() {
        end.pressure.min(f64::MAX)
    } else {
        friction * end.pressure - end.shear.abs()
    } / scales.traction;
    let slip_below_limit = slip_increment.abs().min(distance_from_limit);
    tally.within("slip below the friction limit", slip_below_limit, 1e-10)?;
    if mode == Mode::Stick {
        tally.within("slip of a sticking element", slip_increment.abs(), 1e-11)?;
    }
    Ok(())
}
