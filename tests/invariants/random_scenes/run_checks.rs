//! Checks of every step of any run.

use basemat::coupled::{EnergyBalance, State};
use basemat::interface::Mode;
use proptest::prelude::*;

use super::recipe::{Bed, Law, Recipe, Scheme};
use super::tally::Tally;

/// Largest magnitude.
pub(crate) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m, x| m.max(x.abs()))
}

/// The left-hand side's terms and the input.
pub(crate) fn terms(energy_balance: &EnergyBalance) -> [f64; 10] {
    [
        energy_balance.kinetic,
        energy_balance.strain,
        energy_balance.hysteresis,
        energy_balance.damping,
        energy_balance.algorithmic,
        energy_balance.soil,
        energy_balance.contact,
        energy_balance.interface,
        energy_balance.static_contact,
        energy_balance.input,
    ]
}

/// Largest energy, traction and length of a run: what counts as rounding is relative to them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    /// Includes the energy of the ground's motion.
    pub(crate) energy: f64,
    pub(crate) traction: f64,
    pub(crate) length: f64,
}

impl Scales {
    pub(crate) fn largest(states: &[State]) -> Self {
        let contact = || states.iter().flat_map(|state| &state.contact);
        let or_one = |value: f64| if value > 0.0 { value } else { 1.0 };
        Self {
            energy: or_one(states.last().map_or(0.0, |state| state.energy_balance.largest)),
            traction: or_one(largest(contact().flat_map(|c| [c.pressure, c.shear]))),
            length: or_one(
                largest(contact().flat_map(|c| [c.gap, c.slip]))
                    .max(largest(states.iter().flat_map(|s| s.free_field)))
                    .max(largest(states.iter().flat_map(|s| s.absolute_displacement().to_vec()))),
            ),
        }
    }
}

pub(crate) fn numbers_are_finite(states: &[State]) -> Result<(), TestCaseError> {
    for state in states {
        let contact = state.contact.iter().flat_map(|c| [c.gap, c.slip, c.pressure, c.shear]);
        let rest = [
            state.time,
            state.base_shear,
            state.base_moment,
            state.normal_force,
            state.uplifted_fraction,
            state.mean_slip,
            state.base_rotation,
        ];
        let all = state
            .absolute_displacement()
            .iter()
            .chain(state.velocity())
            .chain(state.acceleration())
            .chain(&state.free_field)
            .copied()
            .chain(contact)
            .chain(rest)
            .chain(terms(&state.energy_balance));
        prop_assert!({ all }.all(f64::is_finite), "step {}: not finite", state.step);
    }
    Ok(())
}

/// Roundings times the condition of the effective stiffness by which a step of a flight, in degrees of freedom, may
/// open the energy balance. The factor's rounding is the same in every step and acts as a spring on the rigid
/// motion, so that steps add up. In modes the condition is one: see `tests/coupled/conditioning.rs`.
const ROUNDINGS: f64 = 10.0;

/// Every joule is accounted for, and what is lost is lost.
pub(crate) fn energy_is_kept(
    recipe: &Recipe,
    states: &[State],
    condition: f64,
    tally: &mut Tally,
) -> Result<(), TestCaseError> {
    let scale = Scales::largest(states).energy;
    let exact = !matches!(
        recipe.bed,
        Bed::HalfPlane { history: basemat::history::HistoryMethod::Exponentials, .. }
    );
    // Where du = Δt v*, the dashpots' work of a step is a square.
    let one_point = matches!(recipe.scheme, Scheme::Midpoint | Scheme::Theta(_));
    // K Δu of a flight is rounded likewise.
    let flight = if recipe.weightless { ROUNDINGS * condition * f64::EPSILON } else { 0.0 };
    for pair in states.windows(2) {
        let (before, now) = (&pair[0].energy_balance, &pair[1].energy_balance);
        let (open, rounding) = (now.residual(), pair[1].step as f64 * condition * f64::EPSILON);
        let limit = if recipe.weightless { (1e-9_f64).max(ROUNDINGS * rounding) } else { 1e-9 };
        tally.within("energy balance open, of the largest energy so far", open, limit)?;
        if open > 1e-9 {
            tally.count("steps with the energy balance open by more than 1e-9", 1);
            tally.within(
                "the same, in roundings times condition and steps",
                open / rounding,
                ROUNDINGS,
            )?;
        }
        let gained = (before.contact - now.contact) / scale;
        tally.within("gained from friction and impact in a step", gained, 1e-12)?;
        if one_point {
            let gained = (before.damping - now.damping) / scale;
            tally.within("gained from dashpots in a step", gained, 1e-12)?;
            if !matches!(recipe.law, Law::ThinLayer(..)) {
                let gained = (before.algorithmic - now.algorithmic) / scale;
                let limit = flight.max(1e-12);
                tally.within("gained from the θ scheme in a step", gained, limit)?;
            }
        }
        if exact {
            tally.within("taken out of the soil", -now.soil / scale, 1e-12)?;
        }
    }
    Ok(())
}

/// Signorini's and Coulomb's conditions.
pub(crate) fn contact_conditions_hold(
    recipe: &Recipe,
    states: &[State],
    tally: &mut Tally,
) -> Result<(), TestCaseError> {
    let Scales { traction, length, .. } = Scales::largest(states);
    let friction = recipe.friction();
    for pair in states.windows(2) {
        for (e, (before, now)) in pair[0].contact.iter().zip(&pair[1].contact).enumerate() {
            let closed = pair[1].modes[e].is_closed();
            if recipe.law == Law::Bonded {
                tally.within(
                    "bonded base moves",
                    now.gap.abs().max(now.slip.abs()) / length,
                    1e-11,
                )?;
                continue;
            }
            if recipe.is_hard() || closed {
                tally.within(
                    "tension, of the largest traction",
                    -now.pressure / traction,
                    1e-10,
                )?;
                let excess = if friction.is_infinite() {
                    0.0
                } else {
                    now.shear.abs() - friction * now.pressure
                };
                tally.within(
                    "beyond the friction cone, of the largest traction",
                    excess / traction,
                    1e-10,
                )?;
            }
            if !recipe.is_hard() {
                continue;
            }
            tally.within("penetration, of the largest length", -now.gap / length, 1e-11)?;
            let both = (now.gap / length).min(now.pressure / traction);
            tally.within("gap and pressure at once", both, 1e-11)?;
            if !closed {
                tally.within("shear of an open element", now.shear.abs() / traction, 0.0)?;
                continue;
            }
            // Closed at the end of the step: friction works against the slip of the step, and an
            // element only slides at its limit.
            let advance = (now.slip - before.slip) / length;
            let backwards =
                (-advance * (now.shear / traction).signum()).min(now.shear.abs() / traction);
            tally.within(
                "slip along the friction",
                if friction == 0.0 { 0.0 } else { backwards },
                1e-11,
            )?;
            let slack = if friction.is_infinite() {
                now.pressure.min(f64::MAX)
            } else {
                friction * now.pressure - now.shear.abs()
            } / traction;
            tally.within("slip below the friction limit", advance.abs().min(slack), 1e-10)?;
            if pair[1].modes[e] == Mode::Stick {
                tally.within("advance of a sticking element", advance.abs(), 1e-11)?;
            }
        }
    }
    Ok(())
}
