//! A heavy building on a round mat under ground motion that differs from point to point.
//!
//! ```text
//! cargo run --release --example incoherent_motion
//! ```
//!
//! The coherence of Luco and Wong decays with frequency and distance. The mat averages the motion, so that the building's
//! horizontal acceleration decreases, and it rotates and twists. Each seed is another sample of the motion; results are means
//! and ranges over some twenty seeds, of which this example runs three. A wave that passes twists the mat too.

use basemat::Result;
use basemat::motion::{Baseline, Incoherence, LucoWong, Triaxial};
use basemat::prelude::*;
use basemat::structure::RigidBody;

/// Radius of the mat, m, height of the building, m, and its mean density, kg/m³.
const MAT_RADIUS: f64 = 20.0;
const BUILDING_HEIGHT: f64 = 40.0;
const MEAN_DENSITY: f64 = 600.0;
const FRICTION_COEFFICIENT: f64 = 0.5;
/// Speed of shear waves in the soil, m/s.
const SHEAR_WAVE_SPEED: f64 = 400.0;
/// Parameter α of the coherence.
const COHERENCE_PARAMETER: f64 = 0.3;
/// Apparent velocity of the wave that passes, m/s.
const APPARENT_VELOCITY: f64 = 2000.0;
/// Time at rest before the record, s: random motion begins a little before the record.
const QUIET_LEAD_TIME: f64 = 4.0;
const SEED_COUNT: u64 = 3;

/// Run of 14 s with coherent motion, or with this incoherence.
fn shake(records: &Triaxial, incoherence: Option<&Incoherence>) -> Result<Run> {
    let soil = Soil::from_shear_wave_speed(SHEAR_WAVE_SPEED, 1.0 / 3.0, 2000.0)?;
    let building = RigidBody::cylinder(MAT_RADIUS, BUILDING_HEIGHT, MEAN_DENSITY)?;
    let top = building.displacement_at([0.0, 0.0, BUILDING_HEIGHT])[0].clone();
    let ground = ElasticGround::under(soil, &building, 8)?;
    let motion: Box<dyn FreeField> = match incoherence {
        None => Box::new(records.clone()),
        Some(incoherence) => Box::new(incoherence.motion(records, ground.elements())?),
    };
    let mut simulation = Simulation::builder(0.01)
        .ground(ground)
        .structure(building)
        .interface(Coulomb::new(FRICTION_COEFFICIENT)?)
        .motion(motion)
        .probe(Probe::acceleration("top", top))
        .build()?;
    let steps = simulation.steps_for(QUIET_LEAD_TIME + 10.0);
    simulation.run(steps, |_| {})
}

fn main() -> Result<()> {
    // Records of incoherent motion start and end at rest.
    let record = el_centro_1940()
        .with_baseline(Baseline::RestToRest { degree: 4 })?
        .padded(QUIET_LEAD_TIME, 2.0)?;
    let records =
        Triaxial { y: Some(record.scaled(0.7)?), up: Some(record.scaled(0.4)?), x: Some(record) };
    let coherence = LucoWong::new(COHERENCE_PARAMETER, SHEAR_WAVE_SPEED)?;
    let incoherence = Incoherence::new(coherence);
    let without_incoherence = Incoherence::new(LucoWong::new(0.0, SHEAR_WAVE_SPEED)?);
    let mut comparison = Comparison::default();
    comparison.add("coherent", shake(&records, None)?);
    for seed in 0..SEED_COUNT {
        let sample = incoherence.clone().with_seed(seed);
        comparison.add(format!("seed {seed}"), shake(&records, Some(&sample))?);
    }
    let coherent_wave = without_incoherence.with_passage(APPARENT_VELOCITY, 0.0)?;
    comparison.add("wave passage", shake(&records, Some(&coherent_wave))?);
    let incoherent_wave = incoherence.with_passage(APPARENT_VELOCITY, 0.0)?;
    comparison.add("seed 0, passage", shake(&records, Some(&incoherent_wave))?);
    println!(
        "Building of {BUILDING_HEIGHT} m on a mat of {MAT_RADIUS} m radius, soil of {SHEAR_WAVE_SPEED} m/s, El Centro 1940\n"
    );
    println!("{comparison}");
    Ok(())
}
