//! A free-standing spent-fuel cask on a concrete pad, compared with a sliding block and a plane-strain slice.
//!
//! ```text
//! cargo run --release --example cask
//! ```
//!
//! A cylinder 3.4 m wide and 5.6 m high stands on a stiff pad over soil of 200 m/s. Three records shake it at
//! the same time. With friction 0.3 it slides; with 0.8 it rocks on its rim and walks along it. Newmark's
//! block is rigid on rigid ground, under one record. The slice, a wall of the same section, also has one
//! record; it rocks on an edge instead of a rim. Other cells and steps change sliding by a few percent.
//! Walking depends on every impact, and changes by factors of up to four.

use basemat::bem::plan::Plan;
use basemat::motion::Triaxial;
use basemat::plot::contact_plan;
use basemat::prelude::*;
use basemat::reference::SlidingBlock;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::RigidBody;

/// Diameter and height, m; mean density of steel, concrete and fuel, kg/m³.
const DIAMETER: f64 = 3.4;
const HEIGHT: f64 = 5.6;
const DENSITY: f64 = 3200.0;
/// Time step, s, and number of steps.
const STEP: f64 = 0.00125;
const STEPS: usize = 4800;

/// Pad 1.5 m thick on soil of 200 m/s; both are laterally unbounded and have 3 % damping.
fn pad() -> basemat::Result<SoilProfile> {
    let damping = || GeneralizedMaxwell::constant_q(0.03, [0.1, 30.0], 1.0);
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let pad = Soil::from_shear_wave_speed(400.0, 0.25, 2200.0)?;
    let base = SoilProfile::on_half_plane(soil).with_bedrock_damping(damping()?);
    Ok(base.with_layer(pad, 1.5)?.with_damping(damping()?))
}

/// Runs the cask under `motion`; returns the run and its time series.
fn cask(friction: f64, motion: &Triaxial) -> basemat::Result<(Run, TimeSeries)> {
    let body = RigidBody::cylinder(0.5 * DIAMETER, HEIGHT, DENSITY)?;
    // Cells on a disc, eight along its diameter.
    let disc = Plan::disc([0.0; 2], 0.5 * DIAMETER, 8)?;
    let mut simulation = Simulation::builder(STEP)
        .structure(body.with_p_delta(STANDARD_GRAVITY)?)
        .ground(ElasticGround::in_plan(pad()?, disc)?)
        .interface(Coulomb::new(friction)?)
        .motion(motion.clone())
        .expected_steps(STEPS)
        .build()?;
    let mut series = Recorder::new().contact(1).start(&simulation)?;
    let run = simulation.run(STEPS, |state| series.record(state))?;
    Ok((run, series))
}

/// A metre of a wall of the same section, along x.
fn slice(friction: f64, record: &Record) -> basemat::Result<Run> {
    let body = RigidBlock::new(DIAMETER, HEIGHT, DENSITY)?.with_p_delta(STANDARD_GRAVITY)?;
    Simulation::builder(STEP)
        .ground(ElasticGround::under(pad()?, &body, 10)?)
        .structure(body)
        .interface(Coulomb::new(friction)?)
        .motion(record.clone())
        .expected_steps(STEPS)
        .build()?
        .run(STEPS, |_| {})
}

fn main() -> basemat::Result<()> {
    // The crate contains one record only. The same record therefore acts along y half a second later, and
    // vertically a second later.
    let record = el_centro_1940().scaled(2.0)?;
    let late = |factor: f64, quiet: f64| record.scaled(factor)?.padded(quiet, 0.0);
    let x = Some(record.clone());
    let along = Triaxial { x: x.clone(), ..Triaxial::default() };
    let all = Triaxial { x, y: Some(late(0.8, 0.5)?), up: Some(late(0.5, 1.0)?) };

    println!(
        "friction                  slip x, mm   slip y    rests off   tilt, mrad   open   energy error"
    );
    for friction in [0.3, 0.8] {
        let newmark = SlidingBlock::new(friction, STANDARD_GRAVITY)?.slide(&record);
        let slip = newmark.maximum().max(-newmark.minimum());
        let rest = newmark.residual().abs();
        println!("{friction:<5} Newmark's block   {:>13.1} {:>21.1}", 1e3 * slip, 1e3 * rest);
        let (one, _) = cask(friction, &along)?;
        let (three, series) = cask(friction, &all)?;
        let time = three.whole.base_rotation.largest().time;
        contact_plan("Cask, most tilted", &series, time)?.save("target/cask.svg")?;
        for (name, run) in [
            ("plane strain", slice(friction, &record)?),
            ("cask, record along x", one),
            ("cask, three records", three),
        ] {
            let whole = &run.whole;
            println!(
                "      {name:<20} {:>9.1} {:>8.1} {:>12.1} {:>12.2} {:>6.2} {:>14.1e}",
                1e3 * whole.mean_slip.magnitude(),
                1e3 * whole.mean_slip_across.magnitude(),
                1e3 * whole.residual_slip.hypot(whole.residual_slip_across),
                1e3 * whole.base_rotation.magnitude().max(whole.rotation_across.magnitude()),
                whole.uplifted_fraction.magnitude(),
                run.energy_error,
            );
            assert!(run.energy_error < 1e-9);
        }
    }
    Ok(())
}
