//! Processor time of the convolution weights of layered ground.
//!
//! ```text
//! cargo study layered-cost
//! ```
//!
//! Processor time of all threads; weights alone, without the histories' transforms of them.

use basemat::bem::layered::Stages;
use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::history::ConvolutionWeights;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::{Result, Soil, unobserved};
use cpu_time::ProcessTime;

use crate::AnyError;

/// Processor time of the convolution weights of layered ground.
#[derive(Debug, clap::Args)]
pub(crate) struct LayeredCostOptions {
    /// Few steps, to see that all works.
    #[arg(long)]
    short: bool,
}

fn damping(ratio: f64) -> Result<GeneralizedMaxwell> {
    GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0)
}

/// Layers of these shear wave speeds (m/s) and thicknesses, with 5 % damping on 1 % or none at all, on rock or a
/// rigid base.
fn profile(layers: &[(f64, f64)], damped: bool, rigid: bool) -> Result<SoilProfile> {
    let mut profile = if rigid {
        SoilProfile::on_rigid_bedrock()
    } else {
        SoilProfile::on_half_plane(Soil::from_shear_wave_speed(600.0, 0.3, 2200.0)?)
    };
    if damped {
        profile = profile.with_bedrock_damping(damping(0.01)?);
    }
    for (speed, thickness) in layers {
        let soil = Soil::from_shear_wave_speed(*speed, 0.33, 1800.0)?;
        profile = profile.with_layer(soil, *thickness)?;
        if damped {
            profile = profile.with_damping(damping(0.05)?);
        }
    }
    Ok(profile)
}

struct WeightsCase {
    name: &'static str,
    profile: SoilProfile,
    elements: usize,
    grading: Grading,
    stages: Stages,
    time_step: f64,
    steps: usize,
}

impl WeightsCase {
    #[allow(clippy::too_many_arguments, reason = "a row of the table")]
    fn new(
        name: &'static str,
        profile: SoilProfile,
        elements: usize,
        grading: Grading,
        stages: Stages,
        time_step: f64,
        steps: usize,
    ) -> Self {
        Self { name, profile, elements, grading, stages, time_step, steps }
    }
}

/// Time step (s) in which shear waves cross this fraction of an element of 0.5 m.
fn crossing_step(fraction: f64) -> f64 {
    fraction * 0.5 / 150.0
}

fn cases() -> Result<Vec<WeightsCase>> {
    let clay = [(150.0, 6.0)];
    let ten_layers: Vec<_> = (0..10).map(|i| (150.0 + 20.0 * f64::from(i), 2.0)).collect();
    let two = Stages::Two;
    let three = Stages::Three;
    let graded = Grading::Cosine;
    let equal = Grading::Uniform;
    let rows = [
        WeightsCase::new(
            "layer on rock",
            profile(&clay, true, false)?,
            12,
            graded,
            two,
            5e-3,
            2000,
        ),
        WeightsCase::new(
            "the same, three stages",
            profile(&clay, true, false)?,
            12,
            graded,
            three,
            5e-3,
            2000,
        ),
        WeightsCase::new(
            "the same, undamped",
            profile(&clay, false, false)?,
            12,
            graded,
            three,
            5e-3,
            1000,
        ),
        WeightsCase::new("rigid base", profile(&clay, true, true)?, 8, graded, two, 5e-3, 1000),
        WeightsCase::new(
            "rigid base, undamped",
            profile(&clay, false, true)?,
            8,
            graded,
            three,
            5e-3,
            1000,
        ),
        WeightsCase::new(
            "half-plane, damped",
            profile(&[], true, false)?,
            8,
            graded,
            two,
            5e-3,
            4000,
        ),
        WeightsCase::new(
            "three layers, 32 elements",
            profile(&ten_layers[..3], true, false)?,
            32,
            graded,
            three,
            5e-3,
            500,
        ),
        WeightsCase::new(
            "ten layers",
            profile(&ten_layers, true, false)?,
            12,
            graded,
            three,
            5e-3,
            500,
        ),
        WeightsCase::new(
            "skin of 1 cm",
            profile(&[(300.0, 0.01), clay[0]], true, false)?,
            8,
            graded,
            two,
            5e-3,
            200,
        ),
        WeightsCase::new(
            "skin of 1 mm",
            profile(&[(300.0, 1e-3), clay[0]], true, false)?,
            8,
            graded,
            two,
            5e-3,
            100,
        ),
        WeightsCase::new(
            "slab on clay",
            profile(&[(2300.0, 0.5), (100.0, 20.0)], true, false)?,
            12,
            graded,
            three,
            5e-3,
            500,
        ),
        WeightsCase::new(
            "c Δt/l = 0.1",
            profile(&clay, true, false)?,
            12,
            equal,
            two,
            crossing_step(0.1),
            400,
        ),
        WeightsCase::new(
            "c Δt/l = 0.01",
            profile(&clay, true, false)?,
            12,
            equal,
            two,
            crossing_step(0.01),
            400,
        ),
        WeightsCase::new(
            "c Δt/l = 0.003",
            profile(&clay, true, false)?,
            12,
            equal,
            two,
            crossing_step(0.003),
            400,
        ),
        WeightsCase::new(
            "c Δt/l = 0.001",
            profile(&clay, true, false)?,
            12,
            equal,
            two,
            crossing_step(0.001),
            400,
        ),
    ];
    Ok(rows.into())
}

/// Processor time of the lags up to a power of two, s.
fn preparation_time(
    weights: &dyn ConvolutionWeights,
    steps: usize,
) -> std::result::Result<f64, AnyError> {
    let begin = ProcessTime::try_now()?;
    weights.prepare(steps.next_power_of_two(), &mut unobserved)?;
    Ok(begin.try_elapsed()?.as_secs_f64())
}

/// Prints times for two seconds of 8 × 8 cells on 10 m; pressure waves cross a fraction of a cell in a step.
fn in_plan(short: bool) -> std::result::Result<(), AnyError> {
    let soil = Soil::new(60.0e6, 1.0 / 3.0, 1900.0)?;
    let rock = Soil::new(600.0e6, 0.3, 2200.0)?;
    let layer = SoilProfile::on_half_plane(rock).with_layer(soil, 6.0)?;
    let damped = layer.with_damping(GeneralizedMaxwell::constant_q(0.05, [0.1, 50.0], 1.0)?);
    let grounds =
        [("half-space", SoilProfile::on_half_plane(soil)), ("layer, 5 %, on rock", damped)];
    println!("\n| 8 × 8 cells | c₁Δt/cell | steps | s |");
    println!("|---|---|---|---|");
    for (name, profile) in grounds {
        for ratio in [1.2, 0.6, 0.24, 0.12, 0.06, 0.03] {
            let plan = Plan::rectangle(0.0..10.0, 0.0..10.0, 8)?;
            let time_step = ratio * plan.pitch()[0] / soil.pressure_wave_speed();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "thousands")]
            let steps = if short { 100 } else { (2.0 / time_step) as usize };
            let ground = ElasticGround::in_plan(profile.clone(), plan)?;
            let seconds = preparation_time(&*ground.weights(time_step)?, steps)?;
            println!("| {name} | {ratio} | {steps} | {seconds:.2} |");
        }
    }
    Ok(())
}

pub(crate) fn run(options: &LayeredCostOptions) -> std::result::Result<(), AnyError> {
    println!("| ground | elements | steps | s |");
    println!("|---|---|---|---|");
    for WeightsCase { name, profile, elements, grading, stages, time_step, steps } in cases()? {
        let steps = if options.short { 100 } else { steps };
        let strip = Strip::new(-3.0..3.0, elements, grading)?;
        let ground = ElasticGround::new(profile, strip)?.with_stages(stages);
        let seconds = preparation_time(&*ground.weights(time_step)?, steps)?;
        println!("| {name} | {elements} | {steps} | {seconds:.2} |");
    }
    in_plan(options.short)
}
