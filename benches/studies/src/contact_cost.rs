//! Processor time of steps in space that lift and slide.
//!
//! ```text
//! cargo study contact-cost
//! cargo study contact-cost --long
//! ```
//!
//! A block of 10 × 10 × 15 m on 200 m/s and friction 0.5, under twice El Centro along x and once along y, from 1 s on.
//! The steps of a bonded block measure the time of the ground alone.

use basemat::history::HistoryOptions;
use basemat::interface::Mode;
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::RigidBody;
use cpu_time::ThreadTime;

use crate::AnyError;

/// Processor time of steps in space that lift and slide.
#[derive(Debug, clap::Args)]
pub(crate) struct ContactCostOptions {
    /// Few steps, as a test.
    #[arg(long)]
    short: bool,
    /// One run of 100 000 steps on a layer of 5 % damping over rock: memory, and the bound of the error of its
    /// truncated history.
    #[arg(long)]
    long: bool,
    /// Fraction of the coefficients' sum that the long run may omit.
    #[arg(long, default_value_t = 1e-3)]
    tolerance: f64,
}

/// Numbers of cells along a side, and paths of pressure waves in a step, in cells.
const CELL_CASES: [(usize, f64); 7] =
    [(8, 1.0), (12, 1.0), (16, 1.0), (24, 1.0), (16, 3.0), (24, 3.0), (16, 7.8)];
/// Begin and end of the measured time, s.
const MEASURED_FROM: f64 = 1.0;
const MEASURED_UNTIL: f64 = 4.0;

/// Processor times of steps, ms; mean number of iterations, and number of steps.
struct StepCost {
    median: f64,
    mean: f64,
    /// Time that 95 of 100 steps do not exceed.
    slow: f64,
    iterations: f64,
    steps: usize,
}

fn measure(cells: usize, crossed_cells: f64, bonded: bool, end: f64) -> Result<StepCost, AnyError> {
    let body = RigidBody::cuboid([10.0, 10.0, 15.0], 500.0)?;
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let ground = ElasticGround::under(soil, &body, cells)?;
    // Pressure waves are twice as fast as shear waves.
    let step = crossed_cells * 10.0 / (cells as f64 - 0.21) / 400.0;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "thousands")]
    let steps = (end / step) as usize;
    let mut builder = Simulation::builder(step)
        .ground(ground)
        .structure(body)
        .motion(Triaxial {
            x: Some(el_centro_1940().scaled(2.0)?),
            y: Some(el_centro_1940()),
            up: None,
        })
        .expected_steps(steps);
    builder = if bonded {
        builder.interface(Bonded)
    } else {
        builder.interface(Coulomb::new(0.5)?)
    };
    let mut simulation = builder.build()?;
    let mut times = Vec::new();
    let mut trials = 0;
    for _ in 0..steps {
        let start_time = ThreadTime::try_now()?;
        let state = simulation.step()?;
        let time = start_time.try_elapsed()?.as_secs_f64();
        let moves = state.modes.iter().any(|mode| *mode == Mode::Open || mode.is_slip());
        if state.time > MEASURED_FROM && (bonded || moves) {
            times.push(1e3 * time);
            trials += state.trials;
        }
    }
    times.sort_by(f64::total_cmp);
    let count = times.len().max(1) as f64;
    Ok(StepCost {
        median: percentile(&times, 50),
        mean: times.iter().sum::<f64>() / count,
        slow: percentile(&times, 95),
        iterations: trials as f64 / count,
        steps: times.len(),
    })
}

fn percentile(sorted_values: &[f64], percent: usize) -> f64 {
    sorted_values.get(sorted_values.len() * percent / 100).copied().unwrap_or(f64::NAN)
}

fn constant_damping(ratio: f64) -> basemat::Result<GeneralizedMaxwell> {
    GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0)
}

/// A run of 100 000 steps of 16 × 16 cells on a layer over rock, which lifts and slides.
fn long_run(tolerance: f64) -> Result<(), AnyError> {
    let body = RigidBody::cuboid([10.0, 10.0, 15.0], 500.0)?;
    let rock = Soil::from_shear_wave_speed(600.0, 0.25, 2200.0)?;
    let layer = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let profile = SoilProfile::on_half_plane(rock)
        .with_bedrock_damping(constant_damping(0.01)?)
        .with_layer(layer, 10.0)?
        .with_damping(constant_damping(0.05)?);
    let steps = 100_000;
    let step = 2e-3;
    let options = HistoryOptions { tolerance: Some(tolerance), ..HistoryOptions::default() };
    let start_time = std::time::Instant::now();
    let mut simulation = Simulation::builder(step)
        .ground(ElasticGround::under(profile, &body, 16)?.with_history(options)?)
        .structure(body)
        .interface(Coulomb::new(0.5)?)
        .motion(Triaxial { x: Some(el_centro_1940().scaled(2.0)?), y: None, up: None })
        .expected_steps(steps)
        .build()?;
    let setup_seconds = start_time.elapsed().as_secs_f64();
    let history = simulation.ground().description().history.ok_or("a history")?;
    println!("set-up {setup_seconds:.1} s; {history}");
    for part in 0..4 {
        let start_time = ThreadTime::try_now()?;
        simulation.run(steps / 4, |_| {})?;
        let time = start_time.try_elapsed()?.as_secs_f64();
        let history = simulation.ground().description().history.ok_or("a history")?;
        let balance = &simulation.state().energy_balance;
        println!(
            "{} steps: {:.2} ms a step, {} MB, soil {:.4e} J within {:.1e}",
            (part + 1) * (steps / 4),
            1e3 * time / (steps / 4) as f64,
            history.memory >> 20,
            balance.soil,
            balance.soil_error_bound / balance.soil
        );
    }
    Ok(())
}

pub(crate) fn run(options: &ContactCostOptions) -> Result<(), AnyError> {
    if options.long {
        return long_run(options.tolerance);
    }
    let end = if options.short { 1.2 } else { MEASURED_UNTIL };
    println!(
        "| cells | c₁Δt/cell | steps that move | median, ms | mean, ms | 95 of 100, ms | iterations | bonded, ms |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (cells, crossed) in CELL_CASES {
        let StepCost { median, mean, slow, iterations, steps } =
            measure(cells, crossed, false, end)?;
        let bonded = measure(cells, crossed, true, end.min(2.0))?.mean;
        println!(
            "| {cells} × {cells} | {crossed} | {steps} | {median:.2} | {mean:.2} | {slow:.2} | {iterations:.1} | {bonded:.2} |"
        );
    }
    Ok(())
}
