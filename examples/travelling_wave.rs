//! A tower that may uplift and slide under four kinds of waves.
//!
//! The same horizontal record is the motion of a vertical S wave, of an inclined SV wave, of a Rayleigh wave, and of a
//! horizontal motion that travels along the surface.
//!
//! ```text
//! cargo run --release --example travelling_wave
//! ```
//!
//! In all four cases the left edge of the base has the same horizontal motion. The last three waves arrive later at the
//! right edge, and the SV wave and the Rayleigh wave have a vertical component. Both effects rock the tower. It is an
//! extreme assumption that the whole record is a Rayleigh wave: the vertical motion then exceeds the horizontal motion.

use basemat::Result;
use basemat::motion::{Baseline, PlaneWave, TravellingWave};
use basemat::prelude::*;

/// Half the width of the base, m.
const HALF_WIDTH: f64 = 5.0;
/// Height of the tower, m.
const TOWER_HEIGHT: f64 = 20.0;
const FRICTION_COEFFICIENT: f64 = 0.4;
/// Time at rest before the record, s: the vertical part of a Rayleigh wave begins before the horizontal part.
const QUIET_LEAD_TIME: f64 = 10.0;

/// Angle of the SV wave from the vertical, degrees.
const SV_WAVE_ANGLE: f64 = 25.0;
/// Velocity of the horizontal motion that travels along the surface, m/s.
const SURFACE_WAVE_VELOCITY: f64 = 300.0;

fn shake(soil: Soil, motion: impl FreeField + 'static) -> Result<Run> {
    let tower = RigidBlock::new(2.0 * HALF_WIDTH, TOWER_HEIGHT, 600.0)?;
    let top = tower.horizontal_at(TOWER_HEIGHT);
    let edge = tower.vertical_at(HALF_WIDTH);
    let mut simulation = Simulation::builder(5.0e-3)
        .ground(ElasticGround::under(soil, &tower, 16)?)
        .structure(tower)
        .interface(Coulomb::new(FRICTION_COEFFICIENT)?)
        .motion(motion)
        .probe(Probe::acceleration("top", top))
        .probe(Probe::acceleration("edge, up", edge))
        .build()?;
    let steps = simulation.steps_for(QUIET_LEAD_TIME + 12.0);
    simulation.run(steps, |_| {})
}

fn main() -> Result<()> {
    let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
    // The record starts and ends at rest, as a Rayleigh wave requires.
    let record = el_centro_1940()
        .with_baseline(Baseline::RestToRest { degree: 4 })?
        .padded(QUIET_LEAD_TIME, 8.0)?;
    // Position of the left edge, which all waves that travel along the surface reach first.
    let origin = -HALF_WIDTH;
    let inclined_wave = PlaneWave::sv(soil, SV_WAVE_ANGLE.to_radians())?;
    let rayleigh = PlaneWave::rayleigh(soil);

    println!(
        "Tower of {} m × {TOWER_HEIGHT} m, friction {FRICTION_COEFFICIENT}, soil of 200 m/s, El Centro 1940",
        2.0 * HALF_WIDTH
    );
    println!(
        "Velocities along the surface: SV at {SV_WAVE_ANGLE}° {:.0} m/s, Rayleigh {:.0} m/s, on surface {SURFACE_WAVE_VELOCITY:.0} m/s\n",
        inclined_wave.apparent_velocity(),
        rayleigh.apparent_velocity()
    );
    let mut comparison = Comparison::default();
    comparison.add("vertical", shake(soil, record.clone())?);
    comparison.add(
        format!("SV, {SV_WAVE_ANGLE}°"),
        shake(soil, inclined_wave.field_from_horizontal(&record, origin)?)?,
    );
    comparison.add("Rayleigh", shake(soil, rayleigh.field_from_horizontal(&record, origin)?)?);
    comparison.add(
        "on surface",
        shake(soil, TravellingWave::new(record, SURFACE_WAVE_VELOCITY, origin)?)?,
    );
    println!("{comparison}");
    Ok(())
}
