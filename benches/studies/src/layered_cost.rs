//! Processor time of the convolution weights of layered ground.
//!
//! ```text
//! cargo study layered-cost
//! ```
//!
//! Processor time of all threads; weights alone, without their transforms for histories.

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
    /// Few steps, as a test.
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
    /// Graded elements, two stages, and steps of 5 ms.
    fn new(name: &'static str, profile: SoilProfile, elements: usize, steps: usize) -> Self {
        Self {
            name,
            profile,
            elements,
            grading: Grading::Cosine,
            stages: Stages::Two,
            time_step: 5e-3,
            steps,
        }
    }

    fn three_stages(self) -> Self {
        Self { stages: Stages::Three, ..self }
    }

    /// Equal elements, with shear waves that cross this fraction of an element in a step.
    fn uniform(self, fraction: f64) -> Self {
        Self { grading: Grading::Uniform, time_step: crossing_step(fraction), ..self }
    }
}

/// Time step (s) in which shear waves cross this fraction of an element of 0.5 m.
fn crossing_step(fraction: f64) -> f64 {
    fraction * 0.5 / 150.0
}

fn cases() -> Result<Vec<WeightsCase>> {
    let clay = [(150.0, 6.0)];
    let ten_layers: Vec<_> = (0..10).map(|i| (150.0 + 20.0 * f64::from(i), 2.0)).collect();
    let on_rock = profile(&clay, true, false)?;
    let undamped_profile = profile(&clay, false, false)?;
    let rigid_base = profile(&clay, true, true)?;
    let undamped_rigid_base = profile(&clay, false, true)?;
    let half_plane = profile(&[], true, false)?;
    let three_layers = profile(&ten_layers[..3], true, false)?;
    let ten_layers = profile(&ten_layers, true, false)?;
    let skin_of_centimetre = profile(&[(300.0, 0.01), clay[0]], true, false)?;
    let skin_of_millimetre = profile(&[(300.0, 1e-3), clay[0]], true, false)?;
    let slab_on_clay = profile(&[(2300.0, 0.5), (100.0, 20.0)], true, false)?;
    Ok(vec![
        WeightsCase::new("layer on rock", on_rock.clone(), 12, 2000),
        WeightsCase::new("the same, three stages", on_rock.clone(), 12, 2000).three_stages(),
        WeightsCase::new("the same, undamped", undamped_profile, 12, 1000).three_stages(),
        WeightsCase::new("rigid base", rigid_base, 8, 1000),
        WeightsCase::new("rigid base, undamped", undamped_rigid_base, 8, 1000).three_stages(),
        WeightsCase::new("half-plane, damped", half_plane, 8, 4000),
        WeightsCase::new("three layers, 32 elements", three_layers, 32, 500).three_stages(),
        WeightsCase::new("ten layers", ten_layers, 12, 500).three_stages(),
        WeightsCase::new("skin of 1 cm", skin_of_centimetre, 8, 200),
        WeightsCase::new("skin of 1 mm", skin_of_millimetre, 8, 100),
        WeightsCase::new("slab on clay", slab_on_clay, 12, 500).three_stages(),
        WeightsCase::new("c Δt/l = 0.1", on_rock.clone(), 12, 400).uniform(0.1),
        WeightsCase::new("c Δt/l = 0.01", on_rock.clone(), 12, 400).uniform(0.01),
        WeightsCase::new("c Δt/l = 0.003", on_rock.clone(), 12, 400).uniform(0.003),
        WeightsCase::new("c Δt/l = 0.001", on_rock, 12, 400).uniform(0.001),
    ])
}

/// Processor time of the lags up to a power of two, s.
fn preparation_time(
    weights: &dyn ConvolutionWeights,
    steps: usize,
) -> std::result::Result<f64, AnyError> {
    let start_time = ProcessTime::try_now()?;
    weights.prepare(steps.next_power_of_two(), &mut unobserved)?;
    Ok(start_time.try_elapsed()?.as_secs_f64())
}

/// Prints times for two seconds of 8 × 8 cells on 10 m; pressure waves cross a fraction of a cell in a step.
fn in_space(short: bool) -> std::result::Result<(), AnyError> {
    let soil = Soil::new(60.0e6, 1.0 / 3.0, 1900.0)?;
    let rock = Soil::new(600.0e6, 0.3, 2200.0)?;
    let layer = SoilProfile::on_half_plane(rock).with_layer(soil, 6.0)?;
    let damped_layer = layer.with_damping(GeneralizedMaxwell::constant_q(0.05, [0.1, 50.0], 1.0)?);
    let grounds =
        [("half-space", SoilProfile::on_half_plane(soil)), ("layer, 5 %, on rock", damped_layer)];
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
    in_space(options.short)
}
