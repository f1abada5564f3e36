//! A square block that stays bonded, in three dimensions and as a slice of plane strain.
//!
//! ```text
//! cargo run --release --example square_block
//! ```
//!
//! A block of 16 × 16 m, 20 m high, on soil of 250 m/s, shaken by three records at once. In plane strain one metre of it
//! stands on an endless strip, which is softer and radiates more: here its edge rises by 6 % more.

use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::structure::RigidBody;

/// Sides and height, m; density, kg/m³.
const SIDES: [f64; 3] = [16.0, 16.0, 20.0];
const DENSITY: f64 = 400.0;
/// Time step, s.
const STEP: f64 = 0.005;

/// The run, and the largest rise of an edge by the rotation, m.
fn shake(
    builder: basemat::coupled::SimulationBuilder,
    rotation: usize,
) -> basemat::Result<(Run, f64)> {
    let record = el_centro_1940();
    let mut simulation =
        builder.interface(Bonded).probe(Probe::displacement("rotation", rotation)).build()?;
    let run = simulation.run(simulation.steps_for(record.duration()), |_| {})?;
    let rotation = run.probe("rotation")?.magnitude();
    Ok((run, 0.5 * SIDES[0] * rotation))
}

fn main() -> basemat::Result<()> {
    let soil = Soil::from_shear_wave_speed(250.0, 1.0 / 3.0, 1900.0)?;
    let [width, _, height] = SIDES;
    let record = el_centro_1940();

    // Three dimensions: 8 × 8 cells under the block's base, records to the right, away and up.
    let block = RigidBody::cuboid(SIDES, DENSITY)?;
    let motion = Triaxial {
        x: Some(record.clone()),
        y: Some(record.scaled(0.8)?),
        up: Some(record.scaled(0.5)?),
    };
    let ground = ElasticGround::under(soil, &block, 8)?;
    let builder = Simulation::builder(STEP).structure(block).ground(ground).motion(motion);
    // Of u_x, u_y, u_z, r_x, r_y, r_z the rotation about y.
    let (run, edge) = shake(builder, 4)?;

    let slice = RigidBlock::new(width, height, DENSITY)?;
    let ground = ElasticGround::under(soil, &slice, 12)?;
    let builder = Simulation::builder(STEP).structure(slice).ground(ground).motion(record);
    let (strip, strip_edge) = shake(builder, RigidBlock::ROTATION)?;

    println!("                    three dimensions   plane strain");
    let mm = |edge: f64| 1e3 * edge;
    println!("rise of an edge, mm {:>16.2} {:>14.2}", mm(edge), mm(strip_edge));
    let coefficient = |run: &Run| run.shear_coefficient().unwrap_or(f64::NAN);
    println!("base shear/weight   {:>16.3} {:>14.3}", coefficient(&run), coefficient(&strip));
    println!("energy error        {:>16.1e} {:>14.1e}", run.energy_error, strip.energy_error);
    assert!(run.energy_error < 1e-9 && strip.energy_error < 1e-9);
    Ok(())
}
