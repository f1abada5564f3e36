//! Processor time of a step of a frame of ten storeys whose members are beams of fibres.
//!
//! ```text
//! cargo study fiber-cost --docs docs
//! ```
//!
//! 300 elements of five points each, on footings that may lift off, in twice El Centro: it yields in most steps.

use std::path::PathBuf;

use basemat::fem::BeamFormulation;
use basemat_problems::fiber_frames::{FrameLaw, ten_storey_simulation};
use cpu_time::ThreadTime;

use crate::AnyError;
use crate::document::splice_into;

/// Processor time of a step of a frame of beams of fibres.
#[derive(Debug, clap::Args)]
pub(crate) struct FiberCostOptions {
    /// Few steps, as a test.
    #[arg(long)]
    short: bool,
    /// Folder of the documentation: given, the table goes to its `validation.md`.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
}

const TIME_STEP: f64 = 5e-3;
/// Steps before the frame yields, which are not measured.
const FIRST_STEPS: usize = 300;
const MEASURED_STEPS: usize = 600;
/// Each time is the smallest of this many runs.
const REPETITION_COUNT: usize = 2;
/// Largest processor time of a step, s.
const TIME_LIMIT: f64 = 5e-3;

const FRAME_CASES: [(FrameLaw, BeamFormulation, &str); 5] = [
    (FrameLaw::Bilinear, BeamFormulation::DisplacementBased, "bilinear steel, by displacements"),
    (FrameLaw::Bilinear, BeamFormulation::ForceBased, "bilinear steel, by forces"),
    (
        FrameLaw::MenegottoPinto,
        BeamFormulation::DisplacementBased,
        "Menegotto–Pinto, by displacements",
    ),
    (
        FrameLaw::ReinforcedConcrete,
        BeamFormulation::DisplacementBased,
        "concrete with bars, by displacements",
    ),
    (FrameLaw::ReinforcedConcrete, BeamFormulation::ForceBased, "concrete with bars, by forces"),
];

/// Processor time and largest time of a step (s), and the part of the input that yielding dissipates.
#[derive(Debug, Clone, Copy)]
struct FrameStepCost {
    seconds: f64,
    largest_seconds: f64,
    hysteresis: f64,
    energy_error: f64,
}

fn measure(
    law: FrameLaw,
    formulation: BeamFormulation,
    steps: [usize; 2],
) -> Result<FrameStepCost, AnyError> {
    let mut simulation = ten_storey_simulation(law, formulation, TIME_STEP)?;
    for _ in 0..steps[0] {
        simulation.step()?;
    }
    let mut seconds = 0.0;
    let mut largest_seconds = 0.0_f64;
    for _ in 0..steps[1] {
        let start_time = ThreadTime::try_now()?;
        simulation.step()?;
        let step_seconds = start_time.try_elapsed()?.as_secs_f64();
        seconds += step_seconds;
        largest_seconds = largest_seconds.max(step_seconds);
    }
    let balance = simulation.state().energy_balance;
    Ok(FrameStepCost {
        seconds: seconds / steps[1] as f64,
        largest_seconds,
        hysteresis: balance.hysteresis / balance.input,
        energy_error: balance.residual(),
    })
}

pub(crate) fn run(options: &FiberCostOptions) -> Result<(), AnyError> {
    let steps = if options.short { [5, 20] } else { [FIRST_STEPS, MEASURED_STEPS] };
    let repetitions = if options.short { 1 } else { REPETITION_COUNT };
    let mut table = String::from(
        "|members|ms a step|longest step, ms|hysteresis over input|energy open by|\n|---|---|---|---|---|\n",
    );
    let mut slow_ratios = Vec::new();
    for (law, formulation, name) in FRAME_CASES {
        let costs = (0..repetitions).map(|_| measure(law, formulation, steps));
        let mut costs: Vec<FrameStepCost> = costs.collect::<Result<_, _>>()?;
        costs.sort_unstable_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let cost = costs[0];
        let row = format!(
            "|{name}|{:.2}|{:.1}|{:.2}|{:.0e}|\n",
            1e3 * cost.seconds,
            1e3 * cost.largest_seconds,
            cost.hysteresis,
            cost.energy_error
        );
        print!("{row}");
        table.push_str(&row);
        if cost.seconds > TIME_LIMIT {
            slow_ratios.push(name);
        }
    }
    if let Some(docs) = &options.docs {
        splice_into(&docs.join("validation.md"), "fiber-cost", &table)?;
    }
    if slow_ratios.is_empty() || options.short {
        Ok(())
    } else {
        Err(format!("more than {TIME_LIMIT} s a step: {}", slow_ratios.join("; ")).into())
    }
}
