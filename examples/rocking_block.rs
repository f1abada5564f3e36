//! A slender rigid block under one sine pulse: when it lifts off, how far it rocks, and when it overturns.
//!
//! ```text
//! cargo run --release --example rocking_block
//! ```
//!
//! On rigid ground the block lifts off at the ground acceleration g b/h, with half the width b and half the height h
//! (Housner 1963). Elastic soil deforms under the edges, so the block rocks on a part of its base instead of an edge,
//! and loses energy by radiation as well as by impacts.

use std::ops::ControlFlow::{Break, Continue};

use basemat::Result;
use basemat::prelude::*;
use basemat::reference::RockingBlock;

/// Half the width of the block, m.
const HALF_WIDTH: f64 = 0.5;
/// Half the height of the block, m.
const HALF_HEIGHT: f64 = 2.0;
/// Time step, s.
const TIME_STEP: f64 = 2.0e-3;
const STEP_COUNT: usize = 2000;

/// One sine cycle with the peak acceleration `peak` (m/s²) and the `period` (s).
fn pulse(peak: f64, period: f64) -> Result<Record> {
    Record::from_fn(period / 200.0, period, |time| {
        peak * (std::f64::consts::TAU * time / period).sin()
    })
}

/// Runs the block on soil of this shear wave speed (m/s) until the rotation exceeds `tipping_angle` (rad).
fn rock(shear_wave_speed: f64, motion: Record, tipping_angle: f64) -> Result<Run> {
    let soil = Soil::from_shear_wave_speed(shear_wave_speed, 0.33, 1900.0)?;
    // With the P–Δ effect, the weight adds to the overturning moment of a tilted block.
    let block = RigidBlock::new(2.0 * HALF_WIDTH, 2.0 * HALF_HEIGHT, 2400.0)?
        .with_p_delta(STANDARD_GRAVITY)?;
    let mut simulation = Simulation::builder(TIME_STEP)
        .ground(ElasticGround::under(soil, &block, 8)?)
        .structure(block)
        .interface(Coulomb::uplift_only())
        .motion(motion)
        .build()?;
    // The observer ends the run when the rotation exceeds the tipping angle.
    simulation.run(STEP_COUNT, |state| {
        if state.base_rotation.abs() > tipping_angle { Break(()) } else { Continue(()) }
    })
}

fn main() -> Result<()> {
    let block_on_rigid_ground = RockingBlock::new(HALF_WIDTH, HALF_HEIGHT, STANDARD_GRAVITY)?;
    let uplift_acceleration = block_on_rigid_ground.uplift_acceleration();
    let tipping_angle = block_on_rigid_ground.slenderness_angle();
    println!(
        "Block {} m × {} m: rocks on rigid ground from {uplift_acceleration:.2} m/s² on, tips at {:.0} mrad",
        2.0 * HALF_WIDTH,
        2.0 * HALF_HEIGHT,
        1e3 * tipping_angle
    );
    println!("Sine pulse of 0.8 s; acceleration in units of g b/h\n");
    println!("{:<8}{:>24}{:>42}", "", "soil of 400 m/s", "soil of 120 m/s");
    println!("{:<8}{}", "peak", "     rotation    uplift liftoffs     outcome".repeat(2));
    let mut has_warning = false;
    for strength in [0.5, 0.9, 1.2, 1.6, 2.0, 2.6, 3.2] {
        print!("{strength:<8.2}");
        for speed in [400.0, 120.0] {
            let run = rock(speed, pulse(strength * uplift_acceleration, 0.8)?, tipping_angle)?;
            let rotation = run.whole.base_rotation.magnitude();
            let outcome = if rotation > tipping_angle {
                "falls"
            } else if run.whole.uplifted_fraction.largest().value >= 0.5 {
                "rocks"
            } else if run.whole.uplift.count > 0 {
                "edge opens"
            } else {
                "stands"
            };
            // The crate assumes small rotations; a run with large rotations has a warning.
            let mark = if run.warnings.is_empty() { ' ' } else { '*' };
            has_warning |= mark == '*';
            print!(
                "{:>8.1} mrad{mark}{:>7.0} %{:>9}{outcome:>12}",
                1e3 * rotation,
                100.0 * run.whole.uplifted_fraction.largest().value,
                run.whole.uplift.count,
            );
        }
        println!();
    }
    if has_warning {
        println!(
            "\n* rotations of more than 100 mrad are not small: the geometry is off by a percent"
        );
    }
    Ok(())
}
