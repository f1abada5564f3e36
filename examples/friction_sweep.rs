//! How likely is a block to slide too far? Friction coefficients × ground motions × intensities.
//!
//! ```text
//! cargo run --release --example friction_sweep
//! cargo run --release --features rayon --example friction_sweep
//! ```
//!
//! The motions of a small set are scaled to the same peak acceleration, and all cases are run. The fractions of motions
//! that cause more slip than a limit form a fragility table. The set is far too small for a design; it shows the
//! method. [`Sweep`] runs the cases on all processors if the crate is built with the feature `rayon`.

use basemat::Result;
use basemat::prelude::*;

/// Friction coefficients.
const FRICTION_COEFFICIENTS: [f64; 4] = [0.15, 0.25, 0.35, 0.5];
/// Peak accelerations, g.
const PEAK_ACCELERATIONS: [f64; 4] = [0.2, 0.3, 0.45, 0.6];

/// Index in [`PEAK_ACCELERATIONS`] of the peak whose slips are printed for each motion.
const PRINTED_PEAK_INDEX: usize = 2;

/// Slip above which a motion counts in the fraction, m.
const SLIP_LIMIT: f64 = 0.025;

/// Names and records of the motions: El Centro unchanged, compressed and stretched in time, and sine pulses.
fn motions() -> Result<Vec<(&'static str, Record)>> {
    let record = el_centro_1940();
    Ok(vec![
        ("El Centro", record.clone()),
        ("El Centro, 0.6 × as long", stretched(&record, 0.6)?),
        ("El Centro, 1.6 × as long", stretched(&record, 1.6)?),
        ("sine pulse, 0.4 s", sine_pulse(0.4)?),
        ("sine pulse, 0.8 s", sine_pulse(0.8)?),
        ("sine pulse, 1.6 s", sine_pulse(1.6)?),
    ])
}

/// The record with its duration multiplied by `factor`.
fn stretched(record: &Record, factor: f64) -> Result<Record> {
    Record::new(factor * record.time_step(), record.accelerations().to_vec())
}

/// One sine cycle of 1 m/s².
fn sine_pulse(period: f64) -> Result<Record> {
    Record::from_fn(0.01 * period, period, |time| (std::f64::consts::TAU * time / period).sin())
}

/// Runs 15 s of a block on soil; returns the largest mean slip of its base, m.
fn slide(friction: f64, motion: Record) -> Result<f64> {
    let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
    let block = RigidBlock::new(8.0, 4.0, 2000.0)?;
    let mut simulation = Simulation::builder(0.01)
        .ground(ElasticGround::under(soil, &block, 8)?)
        .structure(block)
        .interface(Coulomb::new(friction)?)
        .motion(motion)
        .build()?;
    let run = simulation.run(1500, |_| {})?;
    Ok(run.whole.mean_slip.magnitude())
}

fn main() -> Result<()> {
    let motions = motions()?;

    // Every combination of values is a case; the last parameter varies fastest. If a case fails, its row contains the
    // error, and the other cases continue.
    let sweep = Sweep::grid([
        Parameter::numbers("friction", FRICTION_COEFFICIENTS),
        Parameter::numbers("peak_g", PEAK_ACCELERATIONS),
        Parameter::texts("motion", motions.iter().map(|(name, _)| *name)),
    ])?;
    let table = sweep.table(["peak_slip_m"], |case| {
        let peak = case.value("peak_g")? * STANDARD_GRAVITY;
        let motion = motions[case.place("motion")?].1.scaled_to_peak(peak)?;
        Result::Ok([slide(case.value("friction")?, motion)?])
    })?;
    let slips: Vec<_> = table.rows().map(|row| row.value("peak_slip_m")).collect();
    // Slips under all motions, for each peak acceleration of each friction coefficient.
    let rows: Vec<_> = slips.chunks(motions.len()).collect();
    let rows: Vec<_> = rows.chunks(PEAK_ACCELERATIONS.len()).collect();

    println!(
        "Largest mean slip of the base in mm, motions scaled to {} g\n",
        PEAK_ACCELERATIONS[PRINTED_PEAK_INDEX]
    );
    print!("{:<26}", "friction");
    for friction in FRICTION_COEFFICIENTS {
        print!("{friction:>9.2}");
    }
    println!();
    for (motion_index, (name, _)) in motions.iter().enumerate() {
        print!("{name:<26}");
        for row in &rows {
            match &row[PRINTED_PEAK_INDEX][motion_index] {
                Ok(slip) => print!("{:>9.1}", 1e3 * slip),
                Err(_) => print!("{:>9}", "failed"),
            }
        }
        println!();
    }

    println!("\nFraction of the motions with more than {:.0} mm of slip\n", 1e3 * SLIP_LIMIT);
    print!("{:<26}", "peak acceleration, g");
    for peak in PEAK_ACCELERATIONS {
        print!("{peak:>9.2}");
    }
    println!();
    for (friction, row) in FRICTION_COEFFICIENTS.iter().zip(&rows) {
        print!("{:<26}", format!("friction {friction:.2}"));
        for slips_at_peak in *row {
            let computed_slips: Vec<f64> =
                slips_at_peak.iter().filter_map(|slip| slip.as_ref().ok().copied()).collect();
            let exceeding_count = computed_slips.iter().filter(|&&slip| slip > SLIP_LIMIT).count();
            print!("{:>9.2}", exceeding_count as f64 / computed_slips.len().max(1) as f64);
        }
        println!();
    }
    for failure in slips.iter().filter_map(|slip| slip.as_ref().err()) {
        println!("failed: {failure}");
    }
    Ok(())
}
