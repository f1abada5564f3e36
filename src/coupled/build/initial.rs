//! Motion at t = 0: displacement and velocity against the static state, and what the base does with them.

use super::parts::Given;
use crate::coupled::scene::Scene;
use crate::coupled::state::State;
use crate::error::{Error, Result};
use crate::interface::{Mode, PreviousContact, PreviousContacts};
use crate::linalg::matrix::Matrix;
use crate::linalg::{SparseFactor, SparseMatrix, largest};
use crate::structure::{Structure, nonlinear_state};

/// Gap relative to the largest displacement below which an element is closed.
const CLOSED: f64 = 1e-12;

/// Sets `state`, which is at rest, and the structure's internal variables in motion; `mass` is that of
/// the degrees of freedom.
pub(super) fn set_in_motion(
    given: &Given,
    mass: &SparseMatrix,
    scene: &Scene,
    structure: &mut dyn Structure,
    state: &mut State,
) -> Result<()> {
    let Given { displacement, velocity, .. } = given;
    if displacement.is_empty() && velocity.is_empty() && !given.falls() {
        return Ok(());
    }
    let motion = &mut state.motion;
    for (start, own) in [(displacement, &mut motion.displacement), (velocity, &mut motion.velocity)]
    {
        if !start.is_empty() {
            *own = scene.model.transformation.coordinates(start, mass);
        }
    }
    set_contact(given, scene, state)?;
    if let Some(force) = structure.nonlinear_mut() {
        force.commit(&scene.seen_at(&state.motion));
    }
    let c = &scene.coefficients;
    if [c.displacement, c.velocity, c.acceleration, c.new_velocity, c.new_acceleration]
        .iter()
        .any(|row| row[2] != 0.0)
    {
        state.motion.acceleration = acceleration(scene, structure, state)?;
    }
    state.motion.changed();
    state.update_resultants(scene);
    Ok(())
}

/// Gaps, slips and modes of the displaced base.
fn set_contact(given: &Given, scene: &Scene, state: &mut State) -> Result<()> {
    let layout = scene.layout();
    let [mut moved, mut rate] = [(); 2].map(|()| vec![0.0; layout.len()]);
    scene.base.means(&state.motion.displacement, &mut moved);
    scene.base.means(&state.motion.velocity, &mut rate);
    let closed = CLOSED * largest(&given.displacement);
    if given.is_static() {
        if let Some(&value) = moved.iter().find(|means| means.abs() > closed) {
            return Err(Error::Input {
                quantity: "initial displacement of the base, m",
                value,
                needed: "zero where weight holds it on the ground (begin with \
                         `GravityStage::Unloaded`, or with a load that is released)",
            });
        }
    } else {
        let mut starts = Vec::with_capacity(scene.count());
        for (e, (contact, mode)) in state.contact.iter_mut().zip(&mut state.modes).enumerate() {
            let [down, along] = layout.places(e);
            contact.gap = -moved[down];
            contact.slip = moved[along];
            if contact.gap < -closed {
                return Err(Error::Input {
                    quantity: "gap of an element under the initial displacement, m",
                    value: contact.gap,
                    needed: "zero or more",
                });
            }
            if contact.gap > closed {
                if !scene.law(e).modes().contains(&Mode::Open) {
                    return Err(Error::Scene {
                        quantity: "initial displacement",
                        needed: "must leave the base on the ground where the interface law does \
                                 not open",
                    });
                }
                *mode = Mode::Open;
            }
            starts.push(PreviousContact::new(*contact, *mode, scene.time_step));
        }
        state.start = PreviousContacts::new(&scene.laws, &starts)?;
    }
    let [_, rate] = layout.split(&rate);
    state.start.slip_rates_mut().zip(rate).for_each(|(own, rate)| *own = *rate);
    Ok(())
}

/// a of M a + C v + K u + f(u) = p at t = 0, before the soil has answered.
fn acceleration(scene: &Scene, structure: &dyn Structure, state: &State) -> Result<Vec<f64>> {
    let (model, at_rest) = (&scene.model, &scene.static_state);
    let mut force = vec![0.0; model.coordinates];
    let mut scratch = vec![0.0; model.dofs];
    model.load(structure, 0.0, &at_rest.load, &mut scratch, &mut force)?;
    scene.add_loads(0.0, &mut force);
    let mut displacement = state.motion.displacement.clone();
    scene.subtract_base(&mut displacement, &mut vec![0.0; scene.layout().len()]);
    model.stiffness.multiply_add(-1.0, &displacement, &mut force);
    model.damping.multiply_add(-1.0, &state.motion.velocity, &mut force);
    if !model.linear {
        let (nonlinear, _) = nonlinear_state(structure, &scene.seen_at(&state.motion))?;
        for (force, (now, at_rest)) in force.iter_mut().zip(nonlinear.iter().zip(&at_rest.force)) {
            *force -= now - at_rest;
        }
    }
    if let Matrix::Sparse(mass) = &model.mass {
        let mass = SparseMatrix::weighted_sum(model.dofs, &[(1.0, mass)]);
        SparseFactor::new("mass matrix, for the acceleration at t = 0", &mass)?.solve(&mut force);
    }
    Ok(force)
}
