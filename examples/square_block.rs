//! A square block that uplifts and slides in three dimensions, compared with a bonded block and a
//! plane-strain slice.
//!
//! ```text
//! cargo run --release --example square_block
//! ```
//!
//! A block of 16 × 16 m, 20 m high, stands on soil of 250 m/s. Three records shake it at the same time,
//! mostly along a diagonal. If the block may uplift and slide, its corner rises a quarter more than if it is
//! bonded. If the block is turned by 45° under the same motion, it rocks about an edge, and that corner rises
//! less. In plane strain, one metre of the block stands on an endless strip under one horizontal record.

use std::f64::consts::PI;

use basemat::interface::InterfaceLaw;
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::structure::RigidBody;

/// Sides and height, m; density, kg/m³.
const SIDES: [f64; 3] = [16.0, 16.0, 20.0];
const DENSITY: f64 = 400.0;
/// Time step, s.
const STEP: f64 = 0.005;

/// The run, and the largest vertical motion of a corner due to rotations of the base, m.
///
/// `corner` holds the weights of the rotations.
fn shake(
    builder: basemat::coupled::SimulationBuilder,
    law: impl InterfaceLaw + 'static,
    corner: Vec<(usize, f64)>,
) -> basemat::Result<(Run, f64)> {
    let record = el_centro_1940();
    let mut simulation =
        builder.interface(law).probe(Probe::displacement("corner", corner)).build()?;
    let run = simulation.run(simulation.steps_for(record.duration()), |_| {})?;
    let rise = run.probe("corner")?.magnitude();
    Ok((run, rise))
}

/// The block in three dimensions, turned by `angle` about the vertical axis; in the code the motion is turned
/// back.
fn block(soil: Soil, angle: f64) -> basemat::Result<basemat::coupled::SimulationBuilder> {
    let block = RigidBody::cuboid(SIDES, DENSITY)?;
    let record = el_centro_1940();
    // Components: 1 along the record's own direction, 0.8 across it.
    let (s, c) = angle.sin_cos();
    let motion = Triaxial {
        x: Some(record.scaled(c + 0.8 * s)?),
        y: Some(record.scaled(0.8 * c - s)?),
        up: Some(record.scaled(0.5)?),
    };
    let ground = ElasticGround::under(soil, &block, 8)?;
    Ok(Simulation::builder(STEP).structure(block).ground(ground).motion(motion))
}

fn main() -> basemat::Result<()> {
    let soil = Soil::from_shear_wave_speed(250.0, 1.0 / 3.0, 1900.0)?;
    let [width, _, height] = SIDES;
    let record = el_centro_1940();

    // In three dimensions: 8 × 8 cells under the block's base; records act to the right, away and up. Degrees
    // of freedom are u_x, u_y, u_z, r_x, r_y, r_z; the rotations about x and y lift the corner to the right
    // and away.
    let corner = || vec![(3, 0.5 * width), (4, -0.5 * width)];
    let (bonded, edge) = shake(block(soil, 0.0)?, Bonded, corner())?;
    let (square, square_edge) = shake(block(soil, 0.0)?, Coulomb::new(0.5)?, corner())?;
    let (turned, turned_edge) = shake(block(soil, PI / 4.0)?, Coulomb::new(0.5)?, corner())?;

    let slice = RigidBlock::new(width, height, DENSITY)?;
    let ground = ElasticGround::under(soil, &slice, 12)?;
    let builder = Simulation::builder(STEP).structure(slice).ground(ground).motion(record);
    let (strip, strip_edge) = shake(builder, Bonded, vec![(RigidBlock::ROTATION, 0.5 * width)])?;

    println!("                    rise, mm  shear x/weight  open   slip, mm   energy error");
    for (name, run, edge) in [
        ("bonded", &bonded, edge),
        ("lifts and slides", &square, square_edge),
        ("the same at 45°", &turned, turned_edge),
        ("plane strain, bonded", &strip, strip_edge),
    ] {
        let whole = &run.whole;
        println!(
            "{name:<20}{:>8.2} {:>15.3} {:>5.2} {:>10.2} {:>14.1e}",
            1e3 * edge,
            run.shear_coefficient().unwrap_or(f64::NAN),
            whole.uplifted_fraction.magnitude(),
            1e3 * whole.largest_slip.magnitude(),
            run.energy_error,
        );
        assert!(run.energy_error < 1e-9);
    }
    Ok(())
}
