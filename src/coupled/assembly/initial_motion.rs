//! Motion at t = 0 relative to the static state, and the contact that follows from it.

use crate::coupled::builder::SimulationBuilder;
use crate::coupled::scene::Scene;
use crate::coupled::state::State;
use crate::error::{Result, require, require_part};
use crate::interface::{Mode, PreviousContact, PreviousContacts};
use crate::linalg::matrix::Matrix;
use crate::linalg::{SparseFactor, SparseMatrix, Triplets, largest};
use crate::structure::{Structure, massless, nonlinear_state};

/// Gap up to which an element is closed, relative to the largest displacement.
const CLOSED_GAP_TOLERANCE: f64 = 1e-12;

/// Sets a `state` at rest, and the structure's internal variables, to the initial motion.
///
/// `mass` is the mass matrix of the degrees of freedom.
pub(crate) fn set_initial_motion(
    builder: &SimulationBuilder,
    mass: &SparseMatrix,
    scene: &Scene,
    structure: &mut dyn Structure,
    state: &mut State,
) -> Result<()> {
    let displacement = &builder.initial_displacement;
    let velocity = &builder.initial_velocity;
    if builder.has_static_loads() && displacement.is_empty() && velocity.is_empty() {
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
    state.kinematics.clear_dof_cache();
    state.update_resultants(scene);
    Ok(())
}

/// Sets gaps, slips and modes of a base with an initial displacement.
fn set_contact(builder: &SimulationBuilder, scene: &Scene, state: &mut State) -> Result<()> {
    let layout = scene.layout();
    let mut displacement = vec![0.0; layout.len()];
    scene.base.means(&state.kinematics.displacement, &mut displacement);
    let mut velocity = vec![0.0; layout.len()];
    scene.base.means(&state.kinematics.velocity, &mut velocity);
    let gap_tolerance = CLOSED_GAP_TOLERANCE * largest(&builder.initial_displacement);
    if builder.has_static_loads() {
        let needed = "zero under a weight in the static state (use `GravityStage::Unloaded`, or \
                      release a load)";
        for value in displacement {
            require(
                "initial displacement of the base, m",
                value,
                value.abs() <= gap_tolerance,
                needed,
            )?;
        }
    } else {
        let mut previous_contacts = Vec::with_capacity(scene.element_count());
        for (e, (contact, mode)) in state.elements_mut().enumerate() {
            contact.gap = scene.base.initial_gap(e) - displacement[layout.index_of(0, e)];
            contact.slip = displacement[layout.index_of(1, e)];
            if layout.components() > 2 {
                contact.slip_across = displacement[layout.index_of(2, e)];
            }
            let quantity = "gap of an element under the initial displacement, m";
            require(quantity, contact.gap, contact.gap >= -gap_tolerance, "zero or more")?;
            if contact.gap > gap_tolerance {
                let can_open = scene.law(e).modes().contains(&Mode::Open);
                let needed = "must not open elements whose interface law does not open";
                require_part("initial displacement", can_open, needed)?;
                *mode = Mode::Open;
            }
            previous_contacts.push(PreviousContact::new(*contact, *mode, scene.time_step));
        }
        state.start = PreviousContacts::new(&scene.laws, &previous_contacts)?;
    }
    let [_, velocity_x, velocity_y] = layout.split(&velocity);
    for (e, rate) in state.start.slip_rates_mut().enumerate() {
        *rate = velocity_y.get(e).map_or(velocity_x[e], |y| velocity_x[e].hypot(*y));
    }
    Ok(())
}

/// Acceleration at t = 0, before the soil has responded.
///
/// It is a from M a + C v + K u + f(u) = p.
fn acceleration(scene: &Scene, structure: &dyn Structure, state: &State) -> Result<Vec<f64>> {
    let model = &scene.model;
    let static_state = &scene.static_state;
    let mut force = vec![0.0; model.coordinate_count];
    let mut scratch = vec![0.0; model.dofs];
    model.add_load(structure, 0.0, &static_state.load, &mut scratch, &mut force)?;
    scene.add_loads(0.0, &mut force);
    let mut displacement = state.kinematics.displacement.clone();
    scene.subtract_base_translation(&mut displacement, &mut vec![0.0; scene.layout().len()]);
    model.stiffness.multiply_add(-1.0, &displacement, &mut force);
    model.damping.multiply_add(-1.0, &state.kinematics.velocity, &mut force);
    if !model.is_linear {
        let displacement = scene.force_displacement_of(&state.kinematics);
        let nonlinear_force = nonlinear_state(structure, &displacement)?.0;
        let pairs = nonlinear_force.iter().zip(&static_state.force);
        for (force, (nonlinear, at_rest)) in force.iter_mut().zip(pairs) {
            *force -= nonlinear - at_rest;
        }
    }
    if let (Matrix::Sparse(mass), Matrix::Sparse(stiffness)) = (&model.mass, &model.stiffness) {
        replace_by_acceleration(mass, stiffness, &mut force)?;
    }
    Ok(force)
}

/// Force on a massless degree of freedom, relative to the largest force, that counts as zero.
const MASSLESS_FORCE_TOLERANCE: f64 = 1e-9;

/// Factor of the stiffness of massless degrees of freedom, s².
///
/// It is the square of a time that is short for every structure.
const MASSLESS_STIFFNESS_SCALE: f64 = 1e-20;

/// Replaces the `force` on a structure at rest by the acceleration that it causes.
///
/// Massless degrees of freedom follow the others through their stiffness, with a factor so small that it causes no
/// resistance. For Lagrange multipliers this stiffness is the constraint of the accelerations.
fn replace_by_acceleration(
    mass: &SparseMatrix,
    stiffness: &SparseMatrix,
    force: &mut [f64],
) -> Result<()> {
    let max_force = largest(force);
    if max_force == 0.0 {
        return Ok(());
    }
    let is_massless = massless(mass);
    for (entry, _) in force.iter_mut().zip(&is_massless).filter(|(_, massless)| **massless) {
        let needed = "zero without mass, since the scheme needs the acceleration at t = 0 (`Midpoint` does not)";
        let is_zero = entry.abs() <= MASSLESS_FORCE_TOLERANCE * max_force;
        require_part("force at t = 0", is_zero, needed)?;
        *entry = 0.0;
    }
    let mut matrix = Triplets::new(mass.order());
    for (row, column, value) in mass.entries() {
        if !(is_massless[row] || is_massless[column]) {
            matrix.add(row, column, value);
        }
    }
    for (row, column, value) in stiffness.entries() {
        if is_massless[row] || is_massless[column] {
            matrix.add(row, column, MASSLESS_STIFFNESS_SCALE * value);
        }
    }
    SparseFactor::new("mass matrix, for the acceleration at t = 0", &matrix)?.solve(force);
    Ok(())
}
