//! Processor time of the convolution weights of soil around a trench.
//!
//! ```text
//! cargo study trench-cost
//! ```
//!
//! Trench of a box of soil below a foundation of 12 m: 24 m wide, 6 m deep, steps of 10 ms. Processor time of all threads,
//! with the transforms of the weights for histories, beside its limit on a half-plane. The process fails if it is exceeded.

use std::path::PathBuf;

use basemat::bem::Ground;
use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::{Result, Soil, unobserved};
use cpu_time::ProcessTime;

use crate::AnyError;

/// Processor time of the convolution weights of soil around a trench.
///
/// Fails if a limit is exceeded.
#[derive(Debug, clap::Args)]
pub(crate) struct TrenchCostOptions {
    /// Few elements and steps, as a test.
    #[arg(long)]
    short: bool,
    /// Folder for files of the convolution weights, for comparisons.
    #[arg(long)]
    weights: Option<PathBuf>,
    /// Only cases with this number of elements.
    #[arg(long)]
    elements: Option<usize>,
}

const TIME_STEP: f64 = 0.01;
const HALF_WIDTH: f64 = 12.0;
const TRENCH_DEPTH: f64 = 6.0;

/// Size of a run.
#[derive(Debug, Clone, Copy)]
struct RunSize {
    elements: usize,
    steps: usize,
    /// Largest processor time on a half-plane, s.
    max_seconds: f64,
}

const RUN_SIZES: [RunSize; 3] = [
    RunSize { elements: 32, steps: 390, max_seconds: 4.0 },
    RunSize { elements: 48, steps: 390, max_seconds: 8.0 },
    RunSize { elements: 64, steps: 740, max_seconds: 20.0 },
];
const SHORT_RUN_SIZES: [RunSize; 1] =
    [RunSize { elements: 8, steps: 100, max_seconds: f64::INFINITY }];

fn profiles() -> Result<[(&'static str, SoilProfile); 3]> {
    let clay = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let rock = Soil::from_shear_wave_speed(600.0, 0.3, 2200.0)?;
    let damping_law = |ratio: f64| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0);
    let on_rock = SoilProfile::on_half_plane(rock)
        .with_bedrock_damping(damping_law(0.01)?)
        .with_layer(clay, 15.0)?
        .with_damping(damping_law(0.05)?);
    let on_rigid_bedrock = SoilProfile::on_rigid_bedrock()
        .with_layer(clay, 15.0)?
        .with_damping(damping_law(0.05)?);
    Ok([
        ("half-plane", clay.into()),
        ("layer, 5 %, on rock", on_rock),
        ("layer, 5 %, on rigid bedrock", on_rigid_bedrock),
    ])
}

/// Runs the study.
pub(crate) fn run(options: &TrenchCostOptions) -> std::result::Result<(), AnyError> {
    let sizes: &[RunSize] = if options.short { &SHORT_RUN_SIZES } else { &RUN_SIZES };
    println!("| ground | elements | steps | processor s | limit | elapsed s |");
    println!("|---|---|---|---|---|---|");
    let mut exceeded_count = 0;
    for (index, (name, profile)) in profiles()?.into_iter().enumerate() {
        for RunSize { elements: element_count, steps, max_seconds } in sizes {
            if options.elements.is_some_and(|only| only != *element_count) {
                continue;
            }
            let trench = Trench::new(-HALF_WIDTH..HALF_WIDTH, TRENCH_DEPTH)?;
            let elements = trench.elements(element_count / 2, element_count / 4)?;
            let mut ground = TrenchGround::new(profile.clone(), elements)?;
            if let Some(folder) = &options.weights {
                ground = ground.with_kernel_file(folder.join(format!("{index}_{element_count}")));
            }
            let processor = ProcessTime::try_now()?;
            let clock = std::time::Instant::now();
            ground.prepare(TIME_STEP, Some(*steps), &mut unobserved)?;
            let seconds = processor.try_elapsed()?.as_secs_f64();
            let elapsed_seconds = clock.elapsed().as_secs_f64();
            let is_half_plane = profile.layers().is_empty();
            let limit = if is_half_plane { max_seconds.to_string() } else { String::new() };
            println!(
                "| {name} | {element_count} | {steps} | {seconds:.2} | {limit} | {elapsed_seconds:.2} |"
            );
            exceeded_count += usize::from(is_half_plane && seconds > *max_seconds);
        }
    }
    if exceeded_count == 0 { Ok(()) } else { Err("a limit is exceeded".into()) }
}
