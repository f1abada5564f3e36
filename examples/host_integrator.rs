//! A program with its own time integrator, which uses the crate for the ground and the contact of each step.
//!
//! The structure is integrated by central differences.
//!
//! ```text
//! cargo run --release --example host_integrator
//! ```
//!
//! The structure is a rigid base with a mass on a column. Its degrees of freedom are base to the right, base
//! up, rotation, mass to the right. Its mass matrix is diagonal, so a step needs no solve: `u₁ = 2u₀ − u₋₁ +
//! Δt² M⁻¹ (−K u₀ − BᵀA τ)`, and `W = G¹ + Δt² B M⁻¹ BᵀA`.

use basemat::bem::{ContactElement, ElasticGround, Ground, Strip};
use basemat::contact::ContactProblem;
use basemat::interface::{ContactState, Coulomb, Mode, PreviousContact};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::{Result, Soil, unobserved};

const STEP: f64 = 1.0e-3;
const STEPS: usize = 8000;
const HALF_WIDTH: f64 = 2.0;
const HEIGHT: f64 = 6.0;
const MASS: [f64; 4] = [10.0e3, 30.0e3, 40.0e3, 20.0e3];
const COLUMN: f64 = 4.0e6;

/// Element means of the base displacement for elements at `centers` (2Q, normal components down first).
fn base(u: &[f64; 4], centers: &[f64]) -> Vec<f64> {
    let down = centers.iter().map(|x| -(u[1] + x * u[2]));
    down.chain(centers.iter().map(|_| u[0])).collect()
}

/// Acceleration due to the column and to tractions on the base.
fn acceleration(u: &[f64; 4], traction: &[f64], centers: &[f64], lengths: &[f64]) -> [f64; 4] {
    let count = centers.len();
    let column = COLUMN * (u[3] - u[0] + HEIGHT * u[2]);
    let mut force = [column, 0.0, -HEIGHT * column, -column];
    for e in 0..count {
        let (up, right) = (lengths[e] * traction[e], -lengths[e] * traction[count + e]);
        force[0] += right;
        force[1] += up;
        force[2] += centers[e] * up;
    }
    std::array::from_fn(|i| force[i] / MASS[i])
}

fn main() -> Result<()> {
    let soil = Soil::new(60.0e6, 0.33, 1900.0)?;
    let mut ground = ElasticGround::new(soil, Strip::graded(-HALF_WIDTH..HALF_WIDTH, 10)?)?;
    let motion = el_centro_1940();
    let centers: Vec<f64> = ground.elements().iter().map(|element| element.center()[0]).collect();
    let lengths: Vec<f64> = ground.elements().iter().map(ContactElement::length).collect();
    let (count, size) = (centers.len(), 2 * centers.len());

    ground.prepare(STEP, Some(STEPS), &mut unobserved)?;
    let mut delassus = vec![0.0; size * size];
    ground.step_compliance(&mut delassus)?;
    for column in 0..size {
        let mut unit = vec![0.0; size];
        unit[column] = 1.0;
        let answer = acceleration(&[0.0; 4], &unit, &centers, &lengths).map(|a| STEP * STEP * a);
        for (row, moved) in base(&answer, &centers).into_iter().enumerate() {
            delassus[row * size + column] -= moved;
        }
    }

    // The weight is spread evenly at the beginning of the run.
    let pressure = STANDARD_GRAVITY * MASS[1] / (2.0 * HALF_WIDTH);
    let mut at_rest = vec![0.0; size];
    at_rest[..count].fill(pressure);
    let mut contact = ContactProblem::new(delassus, vec![Box::new(Coulomb::new(0.4)?)])?
        .with_static_tractions(at_rest)?;
    let pressed = ContactState { pressure, ..ContactState::default() };
    let mut start =
        contact.start(&vec![PreviousContact::new(pressed, Mode::Stick, STEP); count])?;

    let (mut before, mut now) = ([0.0; 4], [0.0; 4]);
    let [mut history, mut free_field] = [vec![0.0; size], vec![0.0; size]];
    let (mut peak, mut open, mut slip) = (0.0_f64, 0_usize, 0.0_f64);
    for step in 1..=STEPS {
        ground.history(&mut history)?;
        ground.free_field(&motion, step as f64 * STEP, &mut free_field);
        let free = acceleration(&now, &vec![0.0; size], &centers, &lengths);
        let mut next: [f64; 4] =
            std::array::from_fn(|i| 2.0 * now[i] - before[i] + STEP * STEP * free[i]);
        let moved = base(&next, &centers);
        let jump: Vec<f64> = (0..size).map(|i| free_field[i] + history[i] - moved[i]).collect();
        let solution = contact.solve(&jump, &start)?;
        let pushed = acceleration(&[0.0; 4], solution.traction, &centers, &lengths);
        for (u, a) in next.iter_mut().zip(pushed) {
            *u += STEP * STEP * a;
        }
        ground.commit(solution.traction);
        let shear: f64 = solution.states.iter().zip(&lengths).map(|(s, l)| s.shear * l).sum();
        peak = if shear.abs() > peak.abs() { shear } else { peak };
        open = open.max(solution.modes.iter().filter(|mode| !mode.is_closed()).count());
        slip = solution.states.iter().fold(slip, |most, s| most.max(s.slip.abs()));
        // Accepts the step: its end, with the laws' state variables, becomes the previous contact of the next
        // step.
        solution.commit(&mut start)?;
        (before, now) = (now, next);
    }
    println!("base shear {:.1} kN/m, {open} of {count} elements open at once", 1e-3 * peak);
    println!("largest slip {:.2} mm", 1e3 * slip);
    Ok(())
}
