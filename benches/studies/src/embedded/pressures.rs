//! Pressures on the walls of a rigid basement under El Centro, beside closed forms for retaining walls.
//!
//! Increments of thrust are divided by k_h γ H²: k_h the peak acceleration of the surface relative to gravity, γ the soil's
//! weight, H the depth.

use std::fmt::Write as _;

use basemat::bem::SharedKernels;
use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::coupled::Face;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::structure::{RigidBlock, WithWalls};
use basemat::{Simulation, Soil, unobserved};

use crate::AnyError;

const BASEMENT_WIDTH: f64 = 12.0;
const BASEMENT_DEPTH: f64 = 5.0;
const SOIL_DENSITY: f64 = 1900.0;
const TIME_STEP: f64 = 0.02;
const RECORD_DURATION: f64 = 8.0;
const PEAK_ACCELERATIONS: [f64; 4] = [0.1, 0.2, 0.3, 0.4];
const RATIO_AT_REST: f64 = 0.5;
/// Angle of internal friction of the closed form.
const FRICTION_ANGLE: f64 = 35.0;
/// Name, height (m) and density (kg/m³): a box without a building, and with a rigid building.
const RIGID_BODIES: [(&str, f64, f64); 2] =
    [("box, ρ = 950", BASEMENT_DEPTH, 950.0), ("20 m high, ρ = 400", 20.0, 400.0)];

/// Coefficient of active pressure of a frictionless vertical wall with level backfill (Mononobe 1929, Okabe 1926).
fn active(friction: f64, horizontal: f64) -> f64 {
    let inclination = horizontal.atan();
    let root = friction.sin() * (friction - inclination).sin() / inclination.cos();
    (friction - inclination).cos().powi(2)
        / (inclination.cos().powi(2) * (1.0 + root.sqrt()).powi(2))
}

/// Largest increment of thrust on either wall, N/m, and its height over the depth.
#[derive(Clone, Copy, Default)]
struct ThrustIncrement {
    thrust: f64,
    height: f64,
}

fn largest_increment(
    soil: Soil,
    block: RigidBlock,
    welded: bool,
    record: &Record,
    kernels: &SharedKernels,
    steps: usize,
) -> Result<ThrustIncrement, AnyError> {
    let elements =
        Trench::new(-0.5 * BASEMENT_WIDTH..0.5 * BASEMENT_WIDTH, BASEMENT_DEPTH)?.elements(4, 4)?;
    let laws = elements.interfaces(Coulomb::new(0.5)?, Coulomb::new(0.3)?);
    let ground = TrenchGround::new(soil, elements)?
        .with_pressure_at_rest(RATIO_AT_REST)?
        .with_shared_kernels(kernels);
    let motion = TrenchMotion::new(&ground, record.clone(), &mut unobserved)?;
    let builder = Simulation::builder(TIME_STEP)
        .structure(WithWalls::new(block, BASEMENT_DEPTH)?)
        .ground(ground)
        .motion(motion)
        .expected_steps(steps);
    let builder = if welded { builder.interface(Bonded) } else { builder.interfaces(laws) };
    let mut simulation = builder.build()?;
    let walls = [Face::LeftWall, Face::RightWall];
    let rest = walls.map(|wall| simulation.state().face(wall));
    let mut max_increment = ThrustIncrement::default();
    let run = simulation.run(steps, |state| {
        for (wall, rest) in walls.iter().zip(rest) {
            let forces = state.face(*wall);
            let thrust = forces.thrust - rest.thrust;
            if thrust > max_increment.thrust {
                let moment = forces.thrust * forces.place - rest.thrust * rest.place;
                max_increment =
                    ThrustIncrement { thrust, height: moment / thrust / BASEMENT_DEPTH };
            }
        }
    })?;
    if run.energy_error >= 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(max_increment)
}

pub(super) fn tables(short: bool) -> Result<String, AnyError> {
    let mut text = String::from("| ΔP/(k_h γ H²) |");
    for peak in PEAK_ACCELERATIONS {
        write!(text, " {peak} g |")?;
    }
    text += " height/H at 0.1 g; 0.4 g |\n|---|---|---|---|---|---|\n";
    let record = el_centro_1940().trimmed(0.0, RECORD_DURATION)?.padded(0.2, 0.0)?;
    let steps = if short { 50 } else { 410 };
    let speeds: &[f64] = if short { &[200.0] } else { &[100.0, 200.0, 400.0] };
    for &speed in speeds {
        let soil = Soil::from_shear_wave_speed(speed, 0.33, SOIL_DENSITY)?;
        let kernels = SharedKernels::default();
        for (name, height, density) in RIGID_BODIES {
            for is_welded in [true, false] {
                let law = if is_welded { "welded" } else { "contact" };
                write!(text, "| {speed} m/s, {name}, {law} |")?;
                let mut heights = vec![];
                for peak in PEAK_ACCELERATIONS {
                    let record = record.scaled_to_peak(peak * STANDARD_GRAVITY)?;
                    let block = RigidBlock::new(BASEMENT_WIDTH, height, density)?;
                    let increment =
                        largest_increment(soil, block, is_welded, &record, &kernels, steps)?;
                    let unit =
                        peak * SOIL_DENSITY * STANDARD_GRAVITY * BASEMENT_DEPTH * BASEMENT_DEPTH;
                    write!(text, " {:.3} |", increment.thrust / unit)?;
                    heights.push(increment.height);
                }
                writeln!(
                    text,
                    " {:.2}; {:.2} |",
                    heights[0],
                    heights[PEAK_ACCELERATIONS.len() - 1]
                )?;
            }
        }
    }
    write!(text, "| Mononobe–Okabe, active, φ = {FRICTION_ANGLE}°, smooth wall |")?;
    let friction = FRICTION_ANGLE.to_radians();
    for peak in PEAK_ACCELERATIONS {
        write!(text, " {:.3} |", 0.5 * (active(friction, peak) - active(friction, 0.0)) / peak)?;
    }
    text += " 1/3 |\n| Wood's rigid wall on rock, wide backfill | 1 | 1 | 1 | 1 | 0.6 |\n";
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rankine's coefficient without shaking; a wedge of soil in equilibrium with it.
    #[test]
    fn active_pressure_is_the_largest_of_all_wedges() {
        let friction = 35.0_f64.to_radians();
        assert!(
            (active(friction, 0.0) - (1.0 - friction.sin()) / (1.0 + friction.sin())).abs() < 1e-12
        );
        for horizontal in [0.1, 0.3] {
            // Wedge at an angle α: weight cot α/2 and its k_h fold, friction on the plane.
            let mut max_value = 0.0_f64;
            for k in 1..9000 {
                let angle = f64::from(k) * 1e-2_f64.to_radians();
                let sine = (angle - friction).sin();
                let cosine = (angle - friction).cos();
                max_value = max_value.max((sine + horizontal * cosine) / cosine / angle.tan());
            }
            assert!((active(friction, horizontal) - max_value).abs() < 1e-5);
        }
    }
}
