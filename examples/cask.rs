//! A free-standing spent-fuel cask on a concrete pad, beside two simpler models.
//!
//! ```text
//! cargo run --release --example cask
//! ```
//!
//! A cylinder 3.4 m wide and 5.6 m high stands on a stiff pad over soil of 200 m/s. Three records shake it at the same
//! time. With friction 0.3 it slides; with 0.8 it rocks on its rim and walks along it. The simpler models are a sliding
//! block and a plane-strain slice. Newmark's block is rigid on rigid ground, under one record. The slice, a wall of the
//! same section, is also under one record; it rocks on an edge instead of a rim. Other sizes of cells and steps change
//! the sliding by a few percent. Walking depends on every impact, and changes by factors of up to four.

use basemat::bem::plan::Plan;
use basemat::motion::Triaxial;
use basemat::plot::contact_plan;
use basemat::prelude::*;
use basemat::reference::SlidingBlock;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::RigidBody;

/// Diameter of the cask, m.
const CASK_DIAMETER: f64 = 3.4;
/// Height of the cask, m.
const CASK_HEIGHT: f64 = 5.6;
/// Mean density of steel, concrete and fuel, kg/m³.
const MASS_DENSITY: f64 = 3200.0;
/// Time step, s.
const TIME_STEP: f64 = 0.00125;
const STEP_COUNT: usize = 4800;

/// Pad 1.5 m thick on soil of 200 m/s; both are laterally unbounded and have 3 % damping.
fn pad() -> basemat::Result<SoilProfile> {
    let damping = GeneralizedMaxwell::constant_q(0.03, [0.1, 30.0], 1.0)?;
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let pad = Soil::from_shear_wave_speed(400.0, 0.25, 2200.0)?;
    let base = SoilProfile::on_half_plane(soil).with_bedrock_damping(damping.clone());
    Ok(base.with_layer(pad, 1.5)?.with_damping(damping))
}

/// Runs the cask under `motion`; returns the run and its time series.
fn shake_cask(friction: f64, motion: &Triaxial) -> basemat::Result<(Run, TimeSeries)> {
    let body = RigidBody::cylinder(0.5 * CASK_DIAMETER, CASK_HEIGHT, MASS_DENSITY)?;
    // Cells on a disc, eight along its diameter.
    let disc = Plan::disc([0.0; 2], 0.5 * CASK_DIAMETER, 8)?;
    let mut simulation = Simulation::builder(TIME_STEP)
        .structure(body.with_p_delta(STANDARD_GRAVITY)?)
        .ground(ElasticGround::in_plan(pad()?, disc)?)
        .interface(Coulomb::new(friction)?)
        .motion(motion.clone())
        .expected_steps(STEP_COUNT)
        .build()?;
    let mut series = Recorder::new().contact(1).start(&simulation)?;
    let run = simulation.run(STEP_COUNT, |state| series.record(state))?;
    Ok((run, series))
}

/// Runs a metre of a wall of the same section under a record along x.
fn shake_slice(friction: f64, record: &Record) -> basemat::Result<Run> {
    let body = RigidBlock::new(CASK_DIAMETER, CASK_HEIGHT, MASS_DENSITY)?
        .with_p_delta(STANDARD_GRAVITY)?;
    Simulation::builder(TIME_STEP)
        .ground(ElasticGround::under(pad()?, &body, 10)?)
        .structure(body)
        .interface(Coulomb::new(friction)?)
        .motion(record.clone())
        .expected_steps(STEP_COUNT)
        .build()?
        .run(STEP_COUNT, |_| {})
}

fn main() -> basemat::Result<()> {
    let record = el_centro_1940().scaled(2.0)?;
    let along_x = Triaxial { x: Some(record.clone()), ..Triaxial::default() };
    // The crate contains one record only. The same record therefore acts along y half a second later, and
    // vertically a second later.
    let three_records = Triaxial {
        x: Some(record.clone()),
        y: Some(record.scaled(0.8)?.padded(0.5, 0.0)?),
        up: Some(record.scaled(0.5)?.padded(1.0, 0.0)?),
    };

    println!(
        "friction                  slip x, mm   slip y    rests off   tilt, mrad   open   energy error"
    );
    for friction in [0.3, 0.8] {
        let newmark = SlidingBlock::new(friction, STANDARD_GRAVITY)?.slide(&record);
        let largest_slip = newmark.maximum().max(-newmark.minimum());
        let final_slip = newmark.residual().abs();
        println!(
            "{friction:<5} Newmark's block   {:>13.1} {:>21.1}",
            1e3 * largest_slip,
            1e3 * final_slip
        );
        let (three_records_run, series) = shake_cask(friction, &three_records)?;
        let time = three_records_run.whole.base_rotation.largest().time;
        contact_plan("Cask, most tilted", &series, time)?.save("target/cask.svg")?;
        for (name, run) in [
            ("plane strain", shake_slice(friction, &record)?),
            ("cask, record along x", shake_cask(friction, &along_x)?.0),
            ("cask, three records", three_records_run),
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
