//! Pressures on the walls of a rigid basement under El Centro, beside closed forms for retaining walls.
//!
//! Increments of thrust are divided by k_h γ H²: k_h the peak of the surface's acceleration over gravity, γ the soil's
//! weight, H the depth.

use std::fmt::Write as _;

use basemat::bem::SharedKernels;
use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::coupled::{Face, FaceForces};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::structure::{RigidBlock, WithWalls};
use basemat::{Simulation, Soil, unobserved};

use crate::AnyError;

const WIDTH: f64 = 12.0;
const DEPTH: f64 = 5.0;
const DENSITY: f64 = 1900.0;
const STEP: f64 = 0.02;
const DURATION: f64 = 8.0;
const PEAKS: [f64; 4] = [0.1, 0.2, 0.3, 0.4];
const AT_REST: f64 = 0.5;
/// Angle of internal friction of the closed form.
const FRICTION_ANGLE: f64 = 35.0;
/// Heights and densities: a box without a building, and with a rigid one.
const BODIES: [(&str, [f64; 2]); 2] =
    [("box, ρ = 950", [DEPTH, 950.0]), ("20 m high, ρ = 400", [20.0, 400.0])];

/// Coefficient of active pressure of a smooth vertical wall with level backfill (Mononobe 1929, Okabe 1926).
fn active(friction: f64, horizontal: f64) -> f64 {
    let turned = horizontal.atan();
    let root = friction.sin() * (friction - turned).sin() / turned.cos();
    (friction - turned).cos().powi(2) / (turned.cos().powi(2) * (1.0 + root.sqrt()).powi(2))
}

/// Largest increment of thrust on either wall, N/m, and its height over the depth.
fn increment(
    soil: Soil,
    [height, density]: [f64; 2],
    (welded, record): (bool, &Record),
    (kernels, steps): (&SharedKernels, usize),
) -> Result<[f64; 2], AnyError> {
    let elements = Trench::new(-0.5 * WIDTH..0.5 * WIDTH, DEPTH)?.elements(4, 4)?;
    let laws = elements.interfaces(Coulomb::new(0.5)?, Coulomb::new(0.3)?);
    let ground = TrenchGround::new(soil, elements)?
        .with_pressure_at_rest(AT_REST)?
        .with_shared_kernels(kernels);
    let motion = TrenchMotion::new(&ground, record.clone(), &mut unobserved)?;
    let builder = Simulation::builder(STEP)
        .structure(WithWalls::new(RigidBlock::new(WIDTH, height, density)?, DEPTH)?)
        .ground(ground)
        .motion(motion)
        .expected_steps(steps);
    let builder = if welded { builder.interface(Bonded) } else { builder.interfaces(laws) };
    let mut simulation = builder.build()?;
    let walls = [Face::LeftWall, Face::RightWall];
    let rest = walls.map(|wall| simulation.state().face(wall));
    let mut most = [0.0; 2];
    let run = simulation.run(steps, |state| {
        for (wall, rest) in walls.iter().zip(rest) {
            let own = state.face(*wall);
            let more = own.thrust - rest.thrust;
            if more > most[0] {
                let moment = |forces: FaceForces| forces.thrust * forces.place;
                most = [more, (moment(own) - moment(rest)) / more / DEPTH];
            }
        }
    })?;
    if run.energy_error >= 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(most)
}

pub(super) fn tables(short: bool) -> Result<String, AnyError> {
    let mut text = String::from("| ΔP/(k_h γ H²) |");
    for peak in PEAKS {
        write!(text, " {peak} g |")?;
    }
    text += " height/H at 0.1 g; 0.4 g |\n|---|---|---|---|---|---|\n";
    let record = el_centro_1940().trimmed(0.0, DURATION)?.padded(0.2, 0.0)?;
    let steps = if short { 50 } else { 410 };
    let speeds: &[f64] = if short { &[200.0] } else { &[100.0, 200.0, 400.0] };
    for &speed in speeds {
        let soil = Soil::from_shear_wave_speed(speed, 0.33, DENSITY)?;
        let kernels = SharedKernels::default();
        for (name, body) in BODIES {
            for welded in [true, false] {
                let law = if welded { "welded" } else { "contact" };
                write!(text, "| {speed} m/s, {name}, {law} |")?;
                let mut heights = vec![];
                for peak in PEAKS {
                    let record = record.scaled_to_peak(peak * STANDARD_GRAVITY)?;
                    let [more, height] =
                        increment(soil, body, (welded, &record), (&kernels, steps))?;
                    let unit = peak * DENSITY * STANDARD_GRAVITY * DEPTH * DEPTH;
                    write!(text, " {:.3} |", more / unit)?;
                    heights.push(height);
                }
                writeln!(text, " {:.2}; {:.2} |", heights[0], heights[PEAKS.len() - 1])?;
            }
        }
    }
    write!(text, "| Mononobe–Okabe, active, φ = {FRICTION_ANGLE}°, smooth wall |")?;
    let friction = FRICTION_ANGLE.to_radians();
    for peak in PEAKS {
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
            let thrust = |angle: f64| {
                let [sine, cosine] = [(angle - friction).sin(), (angle - friction).cos()];
                (sine + horizontal * cosine) / cosine / angle.tan()
            };
            let all = (1..9000).map(|k| thrust(f64::from(k) * 1e-2_f64.to_radians()));
            let largest = all.fold(0.0, f64::max);
            assert!((active(friction, horizontal) - largest).abs() < 1e-5);
        }
    }
}
