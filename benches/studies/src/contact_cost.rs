//! Processor time of steps in plan that lift and slide.
//!
//! ```text
//! cargo study contact-cost
//! cargo study contact-cost --long
//! ```
//!
//! A block of 10 × 10 × 15 m on 200 m/s and friction 0.5, under twice El Centro along x and once along y, from 1 s on.
//! The ground's share is measured by a step that stays bonded.

use basemat::history::HistoryOptions;
use basemat::interface::Mode;
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::RigidBody;
use cpu_time::ThreadTime;

use crate::AnyError;

/// Processor time of steps in plan that lift and slide.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Few steps, to see that all works.
    #[arg(long)]
    short: bool,
    /// One run of 100 000 steps on a layer of 5 % damping over rock: memory, and the bound of what it leaves out.
    #[arg(long)]
    long: bool,
    /// Fraction of the coefficients' sum that the long run may leave out.
    #[arg(long, default_value_t = 1e-3)]
    tolerance: f64,
}

/// Numbers of cells along a side, and ways of pressure waves in a step over a cell.
const CASES: [(usize, f64); 7] =
    [(8, 1.0), (12, 1.0), (16, 1.0), (24, 1.0), (16, 3.0), (24, 3.0), (16, 7.8)];
/// Begin and end of the time that is measured, s.
const TIMES: [f64; 2] = [1.0, 4.0];

/// Median, mean and 95 of 100 of the processor times of steps, ms; mean number of iterations, and steps.
fn measure(cells: usize, crossed: f64, bonded: bool, end: f64) -> Result<[f64; 5], AnyError> {
    let body = RigidBody::cuboid([10.0, 10.0, 15.0], 500.0)?;
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let ground = ElasticGround::under(soil, &body, cells)?;
    // Pressure waves are twice as fast as shear waves.
    let step = crossed * 10.0 / (cells as f64 - 0.21) / 400.0;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "thousands")]
    let steps = (end / step) as usize;
    let shake = |scale: f64| Ok::<_, AnyError>(Some(el_centro_1940().scaled(scale)?));
    let mut builder = Simulation::builder(step)
        .ground(ground)
        .structure(body)
        .motion(Triaxial { x: shake(2.0)?, y: shake(1.0)?, up: None })
        .expected_steps(steps);
    builder =
        if bonded { builder.interface(Bonded) } else { builder.interface(Coulomb::new(0.5)?) };
    let mut simulation = builder.build()?;
    let (mut times, mut trials) = (Vec::new(), 0);
    for _ in 0..steps {
        let begin = ThreadTime::try_now()?;
        let state = simulation.step()?;
        let time = begin.try_elapsed()?.as_secs_f64();
        let moves = |mode: &Mode| *mode == Mode::Open || mode.is_slip();
        if state.time > TIMES[0] && (bonded || state.modes.iter().any(moves)) {
            times.push(1e3 * time);
            trials += state.trials;
        }
    }
    times.sort_by(f64::total_cmp);
    let count = times.len().max(1) as f64;
    let of_100 = |share: usize| times.get(times.len() * share / 100).copied().unwrap_or(f64::NAN);
    let mean = times.iter().sum::<f64>() / count;
    Ok([of_100(50), mean, of_100(95), trials as f64 / count, times.len() as f64])
}

/// A run of 100 000 steps of 16 × 16 cells on a layer over rock, which lifts and slides.
fn long_run(tolerance: f64) -> Result<(), AnyError> {
    let body = RigidBody::cuboid([10.0, 10.0, 15.0], 500.0)?;
    let damping = |ratio: f64| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0);
    let rock = Soil::from_shear_wave_speed(600.0, 0.25, 2200.0)?;
    let layer = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let profile = SoilProfile::on_half_plane(rock)
        .with_bedrock_damping(damping(0.01)?)
        .with_layer(layer, 10.0)?
        .with_damping(damping(0.05)?);
    let (steps, step) = (100_000, 2e-3);
    let options = HistoryOptions { tolerance: Some(tolerance), ..HistoryOptions::default() };
    let begin = std::time::Instant::now();
    let mut simulation = Simulation::builder(step)
        .ground(ElasticGround::under(profile, &body, 16)?.with_history(options)?)
        .structure(body)
        .interface(Coulomb::new(0.5)?)
        .motion(Triaxial { x: Some(el_centro_1940().scaled(2.0)?), y: None, up: None })
        .expected_steps(steps)
        .build()?;
    let set_up = begin.elapsed().as_secs_f64();
    let history = simulation.ground().description().history.ok_or("a history")?;
    println!("set-up {set_up:.1} s; {history}");
    for part in 0..4 {
        let begin = ThreadTime::try_now()?;
        simulation.run(steps / 4, |_| {})?;
        let time = begin.try_elapsed()?.as_secs_f64();
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

pub(crate) fn run(options: &Options) -> Result<(), AnyError> {
    if options.long {
        return long_run(options.tolerance);
    }
    let end = if options.short { 1.2 } else { TIMES[1] };
    println!(
        "| cells | c₁Δt/cell | steps that move | median, ms | mean, ms | 95 of 100, ms | iterations | bonded, ms |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (cells, crossed) in CASES {
        let [median, mean, slow, trials, steps] = measure(cells, crossed, false, end)?;
        let [_, bonded, ..] = measure(cells, crossed, true, end.min(2.0))?;
        println!(
            "| {cells} × {cells} | {crossed} | {steps} | {median:.2} | {mean:.2} | {slow:.2} | {trials:.1} | {bonded:.2} |"
        );
    }
    Ok(())
}
