//! Motion at t = 0 relative to the static state, and the contact state that follows.

use crate::coupled::builder::SimulationBuilder;
use crate::coupled::scene::Scene;
use crate::coupled::state::State;
use crate::error::{Result, require, require_part};
use crate::interface::{Mode, PreviousContact, PreviousContacts};
use crate::linalg::matrix::Matrix;
use crate::linalg::{SparseFactor, SparseMatrix, Triplets, largest};
use crate::structure::{Structure, massless, nonlinear_state};

/// Gap relative to the largest displacement below which an element is closed.
const CLOSED_GAP_TOLERANCE: f64 = 1e-12;

/// Sets `state`, which is at rest, and the structure's internal variables to the initial motion.
///
/// `mass`: mass matrix of the degrees of freedom.
pub(crate) fn set_in_motion(
    builder: &SimulationBuilder,
    mass: &SparseMatrix,
    scene: &Scene,
    structure: &mut dyn Structure,
    state: &mut State,
) -> Result<()> {
    let SimulationBuilder { displacement, velocity, .. } = builder;
    if builder.is_static() && displacement.is_empty() && velocity.is_empty() {
        return Ok(());
    }
    let motion = &mut state.kinematics;
    if !displacement.is_empty() {
        motion.displacement = scene.model.transformation.coordinates(displacement, mass);
    }
    if !velocity.is_empty() {
        motion.velocity = scene.model.transformation.coordinates(velocity, mass);
    }
    set_contact(builder, scene, state)?;
    if let Some(force) = structure.nonlinear_mut() {
        force.commit(&scene.force_displacement_of(&state.kinematics));
    }
    let c = &scene.coefficients;
    if [c.displacement, c.velocity, c.acceleration, c.new_velocity, c.new_acceleration]
        .iter()
        .any(|row| row[2] != 0.0)
    {
        state.kinematics.acceleration = acceleration(scene, structure, state)?;
    }
    state.kinematics.changed();
    state.update_resultants(scene);
    Ok(())
}

/// Sets gaps, slips and modes of the displaced base.
fn set_contact(builder: &SimulationBuilder, scene: &Scene, state: &mut State) -> Result<()> {
    let layout = scene.layout();
    let mut displacement = vec![0.0; layout.len()];
    scene.base.means(&state.kinematics.displacement, &mut displacement);
    let mut velocity = vec![0.0; layout.len()];
    scene.base.means(&state.kinematics.velocity, &mut velocity);
    let closed = CLOSED_GAP_TOLERANCE * largest(&builder.displacement);
    if builder.is_static() {
        let needed = "zero where weight holds it on the ground (begin with \
                      `GravityStage::Unloaded`, or with a load that is released)";
        for value in displacement {
            require("initial displacement of the base, m", value, value.abs() <= closed, needed)?;
        }
    } else {
        let mut starts = Vec::with_capacity(scene.count());
        for (e, (contact, mode)) in state.contact.iter_mut().zip(&mut state.modes).enumerate() {
            contact.gap = -displacement[layout.place(0, e)];
            contact.slip = displacement[layout.place(1, e)];
            if layout.components() > 2 {
                contact.slip_across = displacement[layout.place(2, e)];
            }
            let quantity = "gap of an element under the initial displacement, m";
            require(quantity, contact.gap, contact.gap >= -closed, "zero or more")?;
            if contact.gap > closed {
                let opens = scene.law(e).modes().contains(&Mode::Open);
                let needed =
                    "must leave the base on the ground where the interface law does not open";
                require_part("initial displacement", opens, needed)?;
                *mode = Mode::Open;
            }
            starts.push(PreviousContact::new(*contact, *mode, scene.time_step));
        }
        state.start = PreviousContacts::new(&scene.laws, &starts)?;
    }
    let [_, along, across] = layout.split(&velocity);
    for (e, rate) in state.start.slip_rates_mut().enumerate() {
        *rate = across.get(e).map_or(along[e], |across| along[e].hypot(*across));
    }
    Ok(())
}

/// Acceleration a from M a + C v + K u + f(u) = p at t = 0, before the soil has responded.
fn acceleration(scene: &Scene, structure: &dyn Structure, state: &State) -> Result<Vec<f64>> {
    let model = &scene.model;
    let at_rest = &scene.static_state;
    let mut force = vec![0.0; model.coordinates];
    let mut scratch = vec![0.0; model.dofs];
    model.load(structure, 0.0, &at_rest.load, &mut scratch, &mut force)?;
    scene.add_loads(0.0, &mut force);
    let mut displacement = state.kinematics.displacement.clone();
    scene.subtract_base(&mut displacement, &mut vec![0.0; scene.layout().len()]);
    model.stiffness.multiply_add(-1.0, &displacement, &mut force);
    model.damping.multiply_add(-1.0, &state.kinematics.velocity, &mut force);
    if !model.linear {
        let displacement = scene.force_displacement_of(&state.kinematics);
        let nonlinear = nonlinear_state(structure, &displacement)?.0;
        for (force, (now, at_rest)) in force.iter_mut().zip(nonlinear.iter().zip(&at_rest.force)) {
            *force -= now - at_rest;
        }
    }
    if let (Matrix::Sparse(mass), Matrix::Sparse(stiffness)) = (&model.mass, &model.stiffness) {
        accelerate(mass, stiffness, &mut force)?;
    }
    Ok(force)
}

/// Force on a massless degree of freedom, relative to the largest force, that counts as zero.
const MASSLESS_FORCE_TOLERANCE: f64 = 1e-9;

/// Square of a time, s², that is short for every structure.
const MASSLESS_STIFFNESS_SCALE: f64 = 1e-20;

/// Replaces `force` by the acceleration that it gives a structure at rest.
///
/// Massless degrees of freedom follow the others by their stiffness, scaled so small that it resists nothing. For
/// Lagrange multipliers this stiffness is the constraint of the accelerations.
fn accelerate(mass: &SparseMatrix, stiffness: &SparseMatrix, force: &mut [f64]) -> Result<()> {
    let largest = largest(force);
    if largest == 0.0 {
        return Ok(());
    }
    let massless = massless(mass);
    for (force, _) in force.iter_mut().zip(&massless).filter(|(_, massless)| **massless) {
        let needed = "zero where there is no mass, for the acceleration at t = 0, which \
                      `Midpoint` does not take";
        require_part("force at t = 0", force.abs() <= MASSLESS_FORCE_TOLERANCE * largest, needed)?;
        *force = 0.0;
    }
    let mut matrix = Triplets::new(mass.order());
    for (row, column, value) in mass.entries() {
        if !(massless[row] || massless[column]) {
            matrix.add(row, column, value);
        }
    }
    for (row, column, value) in stiffness.entries() {
        if massless[row] || massless[column] {
            matrix.add(row, column, MASSLESS_STIFFNESS_SCALE * value);
        }
    }
    SparseFactor::new("mass matrix, for the acceleration at t = 0", &matrix)?.solve(force);
    Ok(())
}
