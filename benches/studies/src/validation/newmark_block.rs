//! A low rigid block that slides on ever stiffer soil under El Centro: Newmark's block.

use basemat::bem::{ElasticGround, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{Case, Check, Outcome, worse};
use crate::AnyError;
use crate::figure::{BLUE, Figure, ORANGE, Panel, RED};
use basemat_problems::series::{Error, whole};
use basemat_problems::table;

pub(crate) const CASE: Case = Case {
    name: "newmark_block",
    title: "Newmark's sliding block under El Centro",
    reference: "own integration in 10 µs steps, and a table of peaks",
    settings: "block 4 m × 0.4 m, 4 elements, c_S = 1600 m/s, Δt = 1.25 ms, friction 0.1 and 0.2",
    run,
};

/// Samples of the reference's history, s.
const SAMPLE: f64 = 0.005;

/// Slip of a rigid block on rigid shaken ground every `SAMPLE`: friction drives the slip velocity
/// to zero with at most φg, and no farther than zero within a step.
fn reference(record: &Record, friction: f64, duration: f64) -> Vec<f64> {
    let substeps = 500;
    let step = SAMPLE / f64::from(substeps);
    let hold = friction * STANDARD_GRAVITY * step;
    let (mut slip, mut velocity, mut slips) = (0.0, 0.0_f64, vec![0.0]);
    let samples = record.accelerations();
    let ground = |time: f64| {
        let place = time / record.time_step();
        let k = whole(place.floor()).min(samples.len() - 2);
        let part = place - k as f64;
        samples[k] * (1.0 - part) + samples[k + 1] * part
    };
    for n in 0..whole(duration / SAMPLE) {
        for k in 0..substeps {
            let time = n as f64 * SAMPLE + (f64::from(k) + 0.5) * step;
            let free = velocity - ground(time) * step;
            let next = free - free.signum() * free.abs().min(hold);
            slip += 0.5 * step * (velocity + next);
            velocity = next;
        }
        slips.push(slip);
    }
    slips
}

/// Mean slip of the block on the half-plane every `SAMPLE`.
fn slide(speed: f64, friction: f64, time_step: f64, duration: f64) -> Result<Vec<f64>, AnyError> {
    let soil = Soil::from_wave_speeds(speed, 2.0 * speed, 2000.0)?;
    let mut simulation = Simulation::builder(time_step)
        .structure(RigidBlock::new(4.0, 0.4, 2000.0)?)
        .ground(ElasticGround::new(soil, Strip::uniform(-2.0..2.0, 4)?)?)
        .interface(Coulomb::new(friction)?)
        .motion(el_centro_1940())
        .build()?;
    let every = whole(SAMPLE / time_step);
    let mut slips = vec![0.0];
    let run = simulation.run(every * whole(duration / SAMPLE), |state| {
        if state.step % every == 0 {
            slips.push(state.mean_slip);
        }
    })?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(slips)
}

fn distance(found: &[f64], wanted: &[f64]) -> f64 {
    let mut error = Error::default();
    found.iter().zip(wanted).for_each(|(a, b)| error.add(*a, *b));
    error.relative()
}

fn largest(slips: &[f64]) -> f64 {
    slips.iter().fold(0.0, |most, slip| worse(most, slip.abs()))
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let record = el_centro_1940();
    let duration = if short { 7.0 } else { 31.18 };
    let table = table("sliding_rigid_block.csv");
    let records = table.text("record");
    let rows = table.rows(["mu", "max_abs_slip_m", "slip_residual_m"]);
    let mut checks = Vec::new();
    let mut panels = Vec::new();
    for (friction, limits) in [(0.1, [4e-3, 1e-5, 2e-5]), (0.2, [8e-3, 5e-6, 2e-5])] {
        let wanted = reference(&record, friction, duration);
        let found = slide(1600.0, friction, 1.25e-3, duration)?;
        let soft = slide(100.0, friction, 2.5e-3, duration)?;
        let error = distance(&found, &wanted);
        checks.push(Check::below(
            format!("friction {friction}: history of slip, relative L2"),
            error,
            limits[0],
        ));
        let row =
            rows.iter().zip(&records).find(|(r, name)| **name == "peknold" && r[0] == friction);
        let ([_, peak, residual], _) = row.ok_or("no such row in the table")?;
        let unit = |name: &str| format!("friction {friction}: {name} against the table, m");
        let off = (largest(&found) - peak).abs();
        checks.push(Check::below(unit("largest slip"), off, limits[1]));
        let end = |slips: &[f64]| slips.last().copied().unwrap_or(f64::NAN);
        if !short {
            let off = (end(&found) - residual).abs();
            checks.push(Check::below(unit("slip left"), off, limits[2]));
            // The table's last digit is 1e-6 m, its own sub-steps leave 2e-6 m.
            let off = worse((end(&wanted) - residual).abs(), (largest(&wanted) - peak).abs());
            checks.push(Check::below(unit("own integration"), off, 2e-6));
        }
        let points = |slips: &[f64]| {
            let each = slips.iter().enumerate().take(whole(12.0 / SAMPLE));
            each.map(|(k, slip)| (k as f64 * SAMPLE, 1e3 * slip)).collect::<Vec<_>>()
        };
        panels.push(
            Panel::new("time, s", &format!("slip, mm (friction {friction})"))
                .legend(SeriesLabelPosition::LowerRight)
                .room(0.3, 0.05)
                .reference("rigid ground, own integration", RED, points(&wanted))
                .dashed("basemat, c_S = 100 m/s", ORANGE, points(&soft))
                .line("basemat, c_S = 1600 m/s", BLUE, points(&found)),
        );
    }
    let title = "Block 4 m × 0.4 m sliding under El Centro 1940 NS";
    Ok(Outcome { checks, figure: Figure::new(title, 2, panels) })
}
