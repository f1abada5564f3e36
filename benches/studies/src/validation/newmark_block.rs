//! A low rigid block that slides on stiff and on soft soil under El Centro: Newmark's block.

use basemat::bem::{ElasticGround, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, milli_curve, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_ORANGE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::series::{RelativeError, nearest_integer};
use basemat_problems::table;

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "newmark_block",
    title: "Newmark's sliding block under El Centro",
    reference: "separate integration in 10 µs steps, and a table of peaks",
    settings: "block 4 m × 0.4 m, 4 elements, c_S = 1600 m/s, Δt = 1.25 ms, friction 0.1 and 0.2",
    run,
};

/// Interval of the samples, s.
const SAMPLE_INTERVAL: f64 = 0.005;

/// Slip of a rigid block on rigid shaken ground at every sample.
///
/// Friction reduces the slip velocity by φg at most, and not below zero within a step.
fn reference(record: &Record, friction: f64, duration: f64) -> Vec<f64> {
    let substeps = 500;
    let step = SAMPLE_INTERVAL / f64::from(substeps);
    let friction_change = friction * STANDARD_GRAVITY * step;
    let mut slip = 0.0;
    let mut velocity = 0.0_f64;
    let mut slips = vec![0.0];
    for n in 0..nearest_integer(duration / SAMPLE_INTERVAL) {
        for k in 0..substeps {
            let time = n as f64 * SAMPLE_INTERVAL + (f64::from(k) + 0.5) * step;
            let free = velocity - interpolated(record, time) * step;
            let next_velocity = free - free.signum() * free.abs().min(friction_change);
            slip += 0.5 * step * (velocity + next_velocity);
            velocity = next_velocity;
        }
        slips.push(slip);
    }
    slips
}

/// Acceleration of a record at a time, linear between its samples.
pub(super) fn interpolated(record: &Record, time: f64) -> f64 {
    let samples = record.accelerations();
    let position = time / record.time_step();
    let k = nearest_integer(position.floor()).min(samples.len() - 2);
    let part = position - k as f64;
    samples[k] * (1.0 - part) + samples[k + 1] * part
}

/// Mean slip of the block on the half-plane at every sample.
fn slide(speed: f64, friction: f64, time_step: f64, duration: f64) -> Result<Vec<f64>, AnyError> {
    let soil = Soil::from_wave_speeds(speed, 2.0 * speed, 2000.0)?;
    let mut simulation = Simulation::builder(time_step)
        .structure(RigidBlock::new(4.0, 0.4, 2000.0)?)
        .ground(ElasticGround::new(soil, Strip::uniform(-2.0..2.0, 4)?)?)
        .interface(Coulomb::new(friction)?)
        .motion(el_centro_1940())
        .build()?;
    let stride = nearest_integer(SAMPLE_INTERVAL / time_step);
    let mut slips = vec![0.0];
    let run = simulation.run(stride * nearest_integer(duration / SAMPLE_INTERVAL), |state| {
        if state.step % stride == 0 {
            slips.push(state.mean_slip);
        }
    })?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(slips)
}

fn distance(computed: &[f64], reference: &[f64]) -> f64 {
    let mut error = RelativeError::default();
    computed.iter().zip(reference).for_each(|(a, b)| error.add(*a, *b));
    error.relative()
}

fn largest(slips: &[f64]) -> f64 {
    slips.iter().fold(0.0, |largest, slip| worse(largest, slip.abs()))
}

fn last(slips: &[f64]) -> f64 {
    slips.last().copied().unwrap_or(f64::NAN)
}

/// Slip of the first 12 s, mm.
fn slip_curve(slips: &[f64]) -> Vec<(f64, f64)> {
    milli_curve(SAMPLE_INTERVAL, &slips[..slips.len().min(nearest_integer(12.0 / SAMPLE_INTERVAL))])
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let record = el_centro_1940();
    let duration = if short { 7.0 } else { 31.18 };
    let table = table("sliding_rigid_block.csv");
    let records = table.text("record");
    let rows = table.rows(["mu", "max_abs_slip_m", "slip_residual_m"]);
    let mut checks = Vec::new();
    let mut panels = Vec::new();
    for (friction, limits) in [(0.1, [4e-3, 1e-5, 2e-5]), (0.2, [8e-3, 5e-6, 2e-5])] {
        let reference = reference(&record, friction, duration);
        let slide_on_stiff_soil = slide(1600.0, friction, 1.25e-3, duration)?;
        let slide_on_soft_soil = slide(100.0, friction, 2.5e-3, duration)?;
        let error = distance(&slide_on_stiff_soil, &reference);
        checks.push(ValidationCheck::below(
            format!("friction {friction}: history of slip, relative L2"),
            error,
            limits[0],
        ));
        let row = rows
            .iter()
            .zip(&records)
            .find(|(row, name)| **name == "peknold" && row[0] == friction);
        let ([_, peak, residual], _) = row.ok_or("no such row in the table")?;
        let label = |name: &str| format!("friction {friction}: {name} against the table, m");
        let error = (largest(&slide_on_stiff_soil) - peak).abs();
        checks.push(ValidationCheck::below(label("largest slip"), error, limits[1]));
        if !short {
            let error = (last(&slide_on_stiff_soil) - residual).abs();
            checks.push(ValidationCheck::below(label("slip left"), error, limits[2]));
            // The table's last digit is 1e-6 m, and its sub-steps have an error of 2e-6 m.
            let error =
                worse((last(&reference) - residual).abs(), (largest(&reference) - peak).abs());
            checks.push(ValidationCheck::below(label("separate integration"), error, 2e-6));
        }
        panels.push(
            FigurePanel::new("time, s", &format!("slip, mm (friction {friction})"))
                .legend(SeriesLabelPosition::LowerRight)
                .room(0.3, 0.05)
                .reference("rigid ground, separate integration", CURVE_RED, slip_curve(&reference))
                .dashed("basemat, c_S = 100 m/s", CURVE_ORANGE, slip_curve(&slide_on_soft_soil))
                .line("basemat, c_S = 1600 m/s", CURVE_BLUE, slip_curve(&slide_on_stiff_soil)),
        );
    }
    let title = "Block 4 m × 0.4 m sliding under El Centro 1940 NS";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, panels) })
}
