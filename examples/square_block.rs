//! A square block that uplifts and slides in three dimensions.
//!
//! ```text
//! cargo run --release --example square_block
//! ```
//!
//! A block of 16 × 16 m, 20 m high, stands on soil with a shear wave speed of 250 m/s. Three components of motion shake
//! it at the same time, mostly along a diagonal. If the block may uplift and slide, its corner rises a quarter more
//! than if it is bonded. If the block is turned by 45° under the same motion, it rocks about an edge, and that corner
//! rises less. The block is also compared with a slice in plane strain: one metre of the block on an infinitely long
//! strip, under one horizontal record.

use std::f64::consts::PI;

use basemat::interface::InterfaceLaw;
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::structure::RigidBody;

/// Side of the square base, m.
const BLOCK_SIDE: f64 = 16.0;
/// Height of the block, m.
const BLOCK_HEIGHT: f64 = 20.0;
/// Mean density, kg/m³.
const MASS_DENSITY: f64 = 400.0;
/// Time step, s.
const TIME_STEP: f64 = 0.005;

/// Runs El Centro; the probe "corner" is the vertical displacement of a corner due to rotations of the base.
///
/// `corner` contains the degrees of freedom of the rotations, and their weights in this displacement.
fn shake(
    builder: basemat::coupled::SimulationBuilder,
    law: impl InterfaceLaw + 'static,
    corner: &[(usize, f64)],
) -> basemat::Result<Run> {
    let record = el_centro_1940();
    let mut simulation = builder
        .interface(law)
        .probe(Probe::displacement("corner", corner.to_vec()))
        .build()?;
    simulation.run(simulation.steps_for(record.duration()), |_| {})
}

/// Builder of the simulation of the block in three dimensions, turned by `angle` (rad) about the vertical axis.
///
/// The block keeps its axes; instead, the motion is turned by −`angle`.
fn block(soil: Soil, angle: f64) -> basemat::Result<basemat::coupled::SimulationBuilder> {
    let block = RigidBody::cuboid([BLOCK_SIDE, BLOCK_SIDE, BLOCK_HEIGHT], MASS_DENSITY)?;
    let record = el_centro_1940();
    // Components: 1 along the direction of the record, 0.8 across it.
    let s = angle.sin();
    let c = angle.cos();
    let motion = Triaxial {
        x: Some(record.scaled(c + 0.8 * s)?),
        y: Some(record.scaled(0.8 * c - s)?),
        up: Some(record.scaled(0.5)?),
    };
    let ground = ElasticGround::under(soil, &block, 8)?;
    Ok(Simulation::builder(TIME_STEP).structure(block).ground(ground).motion(motion))
}

fn main() -> basemat::Result<()> {
    let soil = Soil::from_shear_wave_speed(250.0, 1.0 / 3.0, 1900.0)?;
    // In three dimensions there are 8 × 8 cells under the block's base. The degrees of freedom are u_x, u_y, u_z, r_x,
    // r_y and r_z; the rotations about x and y lift the corner at positive x and y.
    let corner = [(3, 0.5 * BLOCK_SIDE), (4, -0.5 * BLOCK_SIDE)];
    let bonded = shake(block(soil, 0.0)?, Bonded, &corner)?;
    let free = shake(block(soil, 0.0)?, Coulomb::new(0.5)?, &corner)?;
    let turned_block = shake(block(soil, PI / 4.0)?, Coulomb::new(0.5)?, &corner)?;

    let slice = RigidBlock::new(BLOCK_SIDE, BLOCK_HEIGHT, MASS_DENSITY)?;
    let ground = ElasticGround::under(soil, &slice, 12)?;
    let builder = Simulation::builder(TIME_STEP)
        .structure(slice)
        .ground(ground)
        .motion(el_centro_1940());
    let plane_strain = shake(builder, Bonded, &[(RigidBlock::ROTATION_DOF, 0.5 * BLOCK_SIDE)])?;

    println!("                    rise, mm  shear x/weight  open   slip, mm   energy error");
    for (name, run) in [
        ("bonded", bonded),
        ("lifts and slides", free),
        ("the same at 45°", turned_block),
        ("plane strain, bonded", plane_strain),
    ] {
        let whole = &run.whole;
        println!(
            "{name:<20}{:>8.2} {:>15.3} {:>5.2} {:>10.2} {:>14.1e}",
            1e3 * run.probe("corner")?.magnitude(),
            run.shear_coefficient().unwrap_or(f64::NAN),
            whole.uplifted_fraction.magnitude(),
            1e3 * whole.largest_slip.magnitude(),
            run.energy_error,
        );
        assert!(run.energy_error < 1e-9);
    }
    Ok(())
}
