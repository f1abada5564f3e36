//! Peaks of blocks that rock and twist under fifty inputs that differ by one percent: distributions beside single runs.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome};
use crate::AnyError;
use crate::artificial_motion::artificial_motion;
use crate::figure::{CURVE_BLUE, CURVE_GREEN, CURVE_ORANGE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::random::Random;
use basemat_problems::series::nearest_integer;

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "scatter",
    title: "Blocks that rock and twist under fifty inputs",
    reference: "the same scene at half the step, as a distribution; the run with factor 1 alone",
    settings: "factors of the motion within 1 % of 1 (seed 46); block 1.6 m × 6 m, 16 graded elements, Δt = 2.5; 1.25 ms; column 2 m × 2 m × 7 m, 4 × 4 cells, Δt = 5; 2.5 ms",
    run,
};

const INPUT_COUNT: usize = 50;
const RUN_DURATION: f64 = 14.0;
/// Shear wave speed of the soil, m/s.
const SHEAR_WAVE_SPEED: f64 = 300.0;

/// Function of the largest tilt and twist of a run (mrad) by factor of the motion and time step.
type PeakFunction = fn(f64, f64) -> Result<[f64; 2], AnyError>;

fn soil() -> basemat::Result<Soil> {
    Soil::from_shear_wave_speed(SHEAR_WAVE_SPEED, 1.0 / 3.0, 1900.0)
}

/// A block in the plane under a factor of El Centro.
fn rocking_block(factor: f64, time_step: f64) -> Result<[f64; 2], AnyError> {
    let block = RigidBlock::new(1.6, 6.0, 2000.0)?.with_p_delta(STANDARD_GRAVITY)?;
    let strip = Strip::under(&block, 16, Grading::Cosine)?.remove(0);
    let mut simulation = Simulation::builder(time_step)
        .structure(block)
        .ground(ElasticGround::new(soil()?, strip)?)
        .interface(Coulomb::new(0.7)?)
        .motion(el_centro_1940().scaled(factor)?)
        .build()?;
    let run = simulation.run(nearest_integer(RUN_DURATION / time_step), |_| {})?;
    Ok([1e3 * run.whole.base_rotation.magnitude(), 0.0])
}

/// A column in space under a factor of El Centro and, across, of an artificial motion.
fn twisting_column(factor: f64, time_step: f64) -> Result<[f64; 2], AnyError> {
    let column = RigidBody::cuboid([2.0, 2.0, 7.0], 2000.0)?.with_p_delta(STANDARD_GRAVITY)?;
    let across = artificial_motion(2.0, 3)?.scaled(0.35 * STANDARD_GRAVITY * factor)?;
    let mut simulation = Simulation::builder(time_step)
        .structure(column)
        .ground(ElasticGround::in_plan(soil()?, Plan::rectangle(-1.0..1.0, -1.0..1.0, 4)?)?)
        .interface(Coulomb::new(0.7)?)
        .motion(Triaxial {
            x: Some(el_centro_1940().scaled(factor)?),
            y: Some(across),
            ..Triaxial::default()
        })
        .build()?;
    let run = simulation.run(nearest_integer(RUN_DURATION / time_step), |_| {})?;
    let whole = &run.whole;
    let tilt = whole.base_rotation.magnitude();
    Ok([1e3 * tilt, 1e3 * whole.twist.magnitude()])
}

/// Value below which this fraction of the sorted values lies.
fn quantile(sorted_values: &[f64], part: f64) -> f64 {
    let position = part * (sorted_values.len() - 1) as f64;
    let below = nearest_integer(position.floor());
    let above = (below + 1).min(sorted_values.len() - 1);
    sorted_values[below]
        + (position - position.floor()) * (sorted_values[above] - sorted_values[below])
}

/// Peaks of the run with factor 1, and the sorted peaks of all inputs.
struct Peaks {
    single: f64,
    all: Vec<f64>,
}

impl Peaks {
    /// Fraction of the inputs over their peak.
    fn distribution(&self) -> Vec<(f64, f64)> {
        let peaks = self.all.iter().enumerate();
        peaks.map(|(n, peak)| (*peak, (n as f64 + 0.5) / self.all.len() as f64)).collect()
    }
}

/// Tilts and twists of a scene under `scale` times the motion.
fn peaks(
    scene: PeakFunction,
    scale: f64,
    factors: &[f64],
    time_step: f64,
) -> Result<[Peaks; 2], AnyError> {
    let single_run = scene(scale, time_step)?;
    let runs = factors.iter().map(|factor| scene(scale * factor, time_step));
    let runs: Vec<[f64; 2]> = runs.collect::<Result<_, _>>()?;
    Ok([0, 1].map(|k| {
        let mut all: Vec<f64> = runs.iter().map(|run| run[k]).collect();
        all.sort_by(f64::total_cmp);
        Peaks { single: single_run[k], all }
    }))
}

/// Name and peaks of a scene, scale of its motion, time step, largest spread relative to the median, and quantities.
type ScatterCase = (&'static str, PeakFunction, f64, f64, f64, &'static [&'static str]);

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let mut random = Random(46);
    let count = if short { 6 } else { INPUT_COUNT };
    let factors: Vec<f64> = (0..count).map(|_| random.within(0.99, 1.01)).collect();
    let mut checks = Vec::new();
    let mut panels = Vec::new();
    // Half the step may change a peak by a third of the spread.
    let scenes: [ScatterCase; 4] = [
        ("block, 1.2 El Centro", rocking_block, 1.2, 2.5e-3, 0.1, &["tilt"]),
        ("block, 1.5 El Centro", rocking_block, 1.5, 2.5e-3, 0.1, &["tilt"]),
        ("block, 2 El Centro", rocking_block, 2.0, 2.5e-3, 0.1, &["tilt"]),
        ("column that twists", twisting_column, 1.0, 5e-3, 0.6, &["tilt", "twist"]),
    ];
    for (scene, run, scale, step, spread, quantities) in scenes {
        let close_range = 1.0 - spread / 3.0..=1.0 + spread / 3.0;
        let coarse = peaks(run, scale, &factors, step)?;
        let fine = peaks(run, scale, &factors, 0.5 * step)?;
        for ((name, coarse), fine) in quantities.iter().zip(&coarse).zip(&fine) {
            let mut add = |label: &str, value: f64, limits| {
                checks.push(ValidationCheck::within(
                    format!("{scene}: {name}, {label}"),
                    value,
                    limits,
                ));
            };
            let parts = [0.16, 0.5, 0.84].map(|part| quantile(&coarse.all, part));
            add("factor 1, mrad", coarse.single, 30.0..=130.0);
            let half = fine.single / coarse.single;
            add("factor 1 at half the step, over that", half, close_range.clone());
            add("median, mrad", parts[1], 30.0..=130.0);
            add("16 % over the median", parts[0] / parts[1], 1.0 - spread..=1.0);
            add("84 % over the median", parts[2] / parts[1], 1.0..=1.0 + spread);
            let half = quantile(&fine.all, 0.5) / parts[1];
            add("median at half the step, over that", half, close_range.clone());
            panels.push(
                FigurePanel::new(&format!("{scene}: largest {name}, mrad"), "part of the inputs")
                    .line("fifty inputs", CURVE_BLUE, coarse.distribution())
                    .line("half the step", CURVE_GREEN, fine.distribution())
                    .circles("factor 1", CURVE_ORANGE, vec![(coarse.single, 0.5)])
                    .crosses("factor 1, half the step", CURVE_RED, vec![(fine.single, 0.5)])
                    .legend(SeriesLabelPosition::LowerRight),
            );
        }
    }
    let title = "Largest tilt and twist under inputs that differ by 1 % at most";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 3, panels) })
}
