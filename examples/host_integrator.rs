//! Ground and contact of this crate inside the time integrator of another program.
//!
//! The other program (the host) integrates the structure by central differences. In every step, this crate computes the
//! ground and the contact.
//!
//! ```text
//! cargo run --release --example host_integrator
//! ```
//!
//! The structure is a rigid base with a mass on a column. Its degrees of freedom are the displacements of the base to
//! the right and up, the rotation, and the displacement of the mass to the right. The mass matrix M is diagonal, so a
//! step solves no system of equations: `u₁ = 2u₀ − u₋₁ + Δt² M⁻¹ (−K u₀ − BᵀA τ)`. With the step compliance G¹ of the
//! ground, the Delassus matrix of the contact is `W = G¹ + Δt² B M⁻¹ BᵀA`. B gives the base displacement under the
//! elements, and A contains their lengths.

use basemat::bem::{ContactElement, ElasticGround, Ground, Strip};
use basemat::contact::ContactProblem;
use basemat::interface::{ContactState, Coulomb, Mode, PreviousContact};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::{Result, Soil, unobserved};

/// Time step, s.
const TIME_STEP: f64 = 1.0e-3;
const STEP_COUNT: usize = 8000;
/// Half the width of the base, m.
const HALF_WIDTH: f64 = 2.0;
/// Height of the column, m.
const COLUMN_HEIGHT: f64 = 6.0;
/// Lateral stiffness of the column, N/m².
const COLUMN_STIFFNESS: f64 = 4.0e6;
/// Diagonal of the mass matrix, per metre of thickness: kg, kg, kg·m and kg.
const DIAGONAL_MASS: [f64; 4] = [10.0e3, 30.0e3, 40.0e3, 20.0e3];

/// Mean displacement of the base over each of the Q elements at `centers`: Q components down, then Q to the right.
fn base_displacement(u: &[f64; 4], centers: &[f64]) -> Vec<f64> {
    let downward_displacements = centers.iter().map(|x| -(u[1] + x * u[2]));
    downward_displacements.chain(centers.iter().map(|_| u[0])).collect()
}

/// Accelerations of the degrees of freedom due to the column and to tractions on the base.
fn acceleration(u: &[f64; 4], traction: &[f64], centers: &[f64], lengths: &[f64]) -> [f64; 4] {
    let count = centers.len();
    let shear = COLUMN_STIFFNESS * (u[3] - u[0] + COLUMN_HEIGHT * u[2]);
    let mut force = [shear, 0.0, -COLUMN_HEIGHT * shear, -shear];
    for element in 0..count {
        let up = lengths[element] * traction[element];
        let right = -lengths[element] * traction[count + element];
        force[0] += right;
        force[1] += up;
        force[2] += centers[element] * up;
    }
    std::array::from_fn(|i| force[i] / DIAGONAL_MASS[i])
}

fn main() -> Result<()> {
    let soil = Soil::new(60.0e6, 0.33, 1900.0)?;
    let mut ground = ElasticGround::new(soil, Strip::graded(-HALF_WIDTH..HALF_WIDTH, 10)?)?;
    let motion = el_centro_1940();
    let centers: Vec<f64> = ground.elements().iter().map(|element| element.center()[0]).collect();
    let lengths: Vec<f64> = ground.elements().iter().map(ContactElement::length).collect();
    let count = centers.len();
    let component_count = 2 * count;

    ground.prepare(TIME_STEP, Some(STEP_COUNT), &mut unobserved)?;
    let mut delassus = vec![0.0; component_count * component_count];
    ground.step_compliance(&mut delassus)?;
    for column in 0..component_count {
        let mut unit = vec![0.0; component_count];
        unit[column] = 1.0;
        let response =
            acceleration(&[0.0; 4], &unit, &centers, &lengths).map(|a| TIME_STEP * TIME_STEP * a);
        for (row, displacement) in base_displacement(&response, &centers).into_iter().enumerate() {
            delassus[row * component_count + column] -= displacement;
        }
    }

    // At the beginning of the run the weight is distributed evenly over the base.
    let pressure = STANDARD_GRAVITY * DIAGONAL_MASS[1] / (2.0 * HALF_WIDTH);
    let mut at_rest = vec![0.0; component_count];
    at_rest[..count].fill(pressure);
    let mut contact = ContactProblem::new(delassus, vec![Box::new(Coulomb::new(0.4)?)])?
        .with_static_tractions(at_rest)?;
    let element_under_weight = ContactState { pressure, ..ContactState::default() };
    let mut start =
        contact.start(&vec![
            PreviousContact::new(element_under_weight, Mode::Stick, TIME_STEP);
            count
        ])?;

    let mut previous_displacement = [0.0; 4];
    let mut current_displacement = [0.0; 4];
    let mut history = vec![0.0; component_count];
    let mut free_field = vec![0.0; component_count];
    let mut largest_shear = 0.0_f64;
    let mut largest_open_count = 0;
    let mut largest_slip = 0.0_f64;
    for step in 1..=STEP_COUNT {
        ground.history(&mut history)?;
        ground.free_field(&motion, step as f64 * TIME_STEP, &mut free_field);
        let free_acceleration =
            acceleration(&current_displacement, &vec![0.0; component_count], &centers, &lengths);
        let mut next_displacement: [f64; 4] = std::array::from_fn(|i| {
            2.0 * current_displacement[i] - previous_displacement[i]
                + TIME_STEP * TIME_STEP * free_acceleration[i]
        });
        let base = base_displacement(&next_displacement, &centers);
        let displacement_jump: Vec<f64> =
            (0..component_count).map(|i| free_field[i] + history[i] - base[i]).collect();
        let solution = contact.solve(&displacement_jump, &start)?;
        let traction_acceleration = acceleration(&[0.0; 4], solution.traction, &centers, &lengths);
        for (u, a) in next_displacement.iter_mut().zip(traction_acceleration) {
            *u += TIME_STEP * TIME_STEP * a;
        }
        ground.commit(solution.traction);
        let shear: f64 = solution.states.iter().zip(&lengths).map(|(s, l)| s.shear * l).sum();
        largest_shear = if shear.abs() > largest_shear.abs() { shear } else { largest_shear };
        let open_count = solution.modes.iter().filter(|mode| !mode.is_closed()).count();
        largest_open_count = largest_open_count.max(open_count);
        for element in solution.states {
            largest_slip = largest_slip.max(element.slip.abs());
        }
        // Accepts the step: the contact at its end, with the laws' state variables, becomes the start of the next step.
        solution.commit(&mut start)?;
        previous_displacement = current_displacement;
        current_displacement = next_displacement;
    }
    println!(
        "base shear {:.1} kN/m, {largest_open_count} of {count} elements open at once",
        1e-3 * largest_shear
    );
    println!("largest slip {:.2} mm", 1e3 * largest_slip);
    Ok(())
}
