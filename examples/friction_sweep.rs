//! How likely is a block to slide too far? Friction coefficients × ground motions × intensities.
//!
//! ```text
//! cargo run --release --example friction_sweep
//! cargo run --release --features rayon --example friction_sweep
//! ```
//!
//! Each motion of a small set is scaled to the same peak acceleration, and all cases are run. The fraction of
//! motions with more slip than a limit is one row of a fragility table. The set is far too small for a
//! design; it shows the method. [`Sweep`] runs the cases on all processors if the crate is built with the
//! feature `rayon`.

use basemat::Result;
use basemat::prelude::*;

const FRICTIONS: [f64; 4] = [0.15, 0.25, 0.35, 0.5];
/// Peak accelerations, g.
const PEAKS: [f64; 4] = [0.2, 0.3, 0.45, 0.6];

/// Slip above which a motion counts in the fraction, m.
const LIMIT: f64 = 0.025;

/// Set of motions: El Centro unchanged, compressed and stretched in time, and sine pulses.
fn motions() -> Result<Vec<(&'static str, Record)>> {
    let record = el_centro_1940();
    let stretched =
        |factor: f64| Record::new(factor * record.time_step(), record.accelerations().to_vec());
    let pulse = |period: f64| {
        Record::from_fn(0.01 * period, period, |time| (std::f64::consts::TAU * time / period).sin())
    };
    Ok(vec![
        ("El Centro", record.clone()),
        ("El Centro, 0.6 × as long", stretched(0.6)?),
        ("El Centro, 1.6 × as long", stretched(1.6)?),
        ("sine pulse, 0.4 s", pulse(0.4)?),
        ("sine pulse, 0.8 s", pulse(0.8)?),
        ("sine pulse, 1.6 s", pulse(1.6)?),
    ])
}

/// Largest mean slip of the block's base (m) in 15 s.
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
    let (kinds, peaks) = (motions.len(), PEAKS.len());

    // Every combination is a case; the last parameter varies fastest. The row of a case that fails holds its
    // error; the other cases continue.
    let sweep = Sweep::grid([
        Parameter::numbers("friction", FRICTIONS),
        Parameter::numbers("peak_g", PEAKS),
        Parameter::texts("motion", motions.iter().map(|(name, _)| *name)),
    ])?;
    let table = sweep.table(["peak_slip_m"], |case| {
        let peak = case.value("peak_g")? * STANDARD_GRAVITY;
        let motion = motions[case.place("motion")?].1.scaled_to_peak(peak)?;
        Result::Ok([slide(case.value("friction")?, motion)?])
    })?;
    let slips: Vec<_> = table.rows().map(|row| row.value("peak_slip_m")).collect();
    let slip = |f: usize, p: usize, m: usize| &slips[(f * peaks + p) * kinds + m];

    println!("Largest mean slip of the base in mm, motions scaled to {} g\n", PEAKS[2]);
    print!("{:<26}", "friction");
    for friction in FRICTIONS {
        print!("{friction:>9.2}");
    }
    println!();
    for (m, (name, _)) in motions.iter().enumerate() {
        print!("{name:<26}");
        for f in 0..FRICTIONS.len() {
            match slip(f, 2, m) {
                Ok(slip) => print!("{:>9.1}", 1e3 * slip),
                Err(_) => print!("{:>9}", "failed"),
            }
        }
        println!();
    }

    println!("\nShare of the motions with more than {:.0} mm of slip\n", 1e3 * LIMIT);
    print!("{:<26}", "peak acceleration, g");
    for peak in PEAKS {
        print!("{peak:>9.2}");
    }
    println!();
    for (f, friction) in FRICTIONS.iter().enumerate() {
        print!("{:<26}", format!("friction {friction:.2}"));
        for p in 0..peaks {
            let values: Vec<f64> =
                (0..kinds).filter_map(|m| slip(f, p, m).as_ref().ok().copied()).collect();
            let over = values.iter().filter(|&&slip| slip > LIMIT).count();
            print!("{:>9.2}", over as f64 / values.len().max(1) as f64);
        }
        println!();
    }
    for failure in slips.iter().filter_map(|slip| slip.as_ref().err()) {
        println!("failed: {failure}");
    }
    Ok(())
}
