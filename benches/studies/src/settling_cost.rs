//! Processor time of steps on soil that settles in every cycle, relative to soil with a bearing pressure alone.
//!
//! ```text
//! cargo study settling-cost --docs docs
//! ```
//!
//! A block of 4 × 7 m on 145 m/s under 1.5 times El Centro, whose weight is a third of the bearing pressure: it rocks, lifts
//! off, and yields in most steps. In space it is 3 m wide, and shaken across by 0.7 times El Centro.
//! The process fails if a step takes more than 1.5 times as long as with `Yielding`.

use std::path::PathBuf;

use basemat::bem::plan::Plan;
use basemat::interface::{CyclicYielding, Yielding};
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::structure::{RigidBlock, RigidBody};
use cpu_time::ThreadTime;

use crate::AnyError;
use crate::document::splice_into;

/// Processor time of steps on soil that settles in every cycle.
///
/// Fails if a step takes more than 1.5 times as long as on soil with a bearing pressure alone.
#[derive(Debug, clap::Args)]
pub(crate) struct SettlingCostOptions {
    /// Few steps, as a test without limit.
    #[arg(long)]
    short: bool,
    /// Folder of the documentation: given, the table goes to its `validation.md`.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
}

const TIME_STEP: f64 = 5e-3;
const BLOCK_WIDTH: f64 = 4.0;
const BLOCK_DEPTH: f64 = 3.0;
const BLOCK_HEIGHT: f64 = 7.0;
const BLOCK_DENSITY: f64 = 2000.0;
const FRICTION_COEFFICIENT: f64 = 0.6;
/// Bearing pressure relative to the pressure of the weight.
const PRESSURE_RESERVE: f64 = 3.0;
const REFERENCE_SETTLEMENT: f64 = 5e-3;
const PRESSURE_GRADIENT: f64 = 1e6;
const SHORT_RANGE: f64 = 0.1;
/// Samples of the record before its strong part.
const WEAK_SAMPLES: usize = 70;
const STEP_COUNT: usize = 1500;
/// Each ratio is the median of this many, an odd number.
///
/// The runs of the laws alternate, so that other processes and the processor's frequency change both times alike.
const REPETITION_COUNT: usize = 9;
/// Largest processor time of a step, relative to `Yielding`.
const MAX_TIME_RATIO: f64 = 1.5;

/// Cells below the block.
#[derive(Debug, Clone, Copy)]
enum CellCase {
    /// Number of strips in the plane.
    Strips(usize),
    /// Number of cells along the longer side, in space.
    Cells(usize),
}

const CELL_CASES: [CellCase; 4] =
    [CellCase::Strips(16), CellCase::Strips(40), CellCase::Cells(6), CellCase::Cells(12)];

#[derive(Debug, Clone, Copy)]
enum LawCase {
    Yielding,
    /// Elastic range η, and growth of the bearing pressure, Pa/m.
    Cyclic {
        elastic_range: f64,
        depth_gradient: f64,
    },
}

const LAW_CASES: [LawCase; 3] = [
    LawCase::Yielding,
    LawCase::Cyclic { elastic_range: 1.0, depth_gradient: 0.0 },
    LawCase::Cyclic { elastic_range: SHORT_RANGE, depth_gradient: PRESSURE_GRADIENT },
];

/// Number of cells, processor time of a step (s), and mean number of trials.
#[derive(Debug, Clone, Copy)]
struct SettlingStepCost {
    cells: usize,
    seconds: f64,
    trials: f64,
}

fn strong_motion(factor: f64) -> basemat::Result<Record> {
    let record = el_centro_1940();
    let strong_samples = record.accelerations().iter().skip(WEAK_SAMPLES).map(|a| factor * a);
    Record::new(record.time_step(), strong_samples.collect())
}

fn simulation(cells: CellCase, law: LawCase) -> basemat::Result<Simulation> {
    let soil = Soil::new(4e7, 0.3, 1900.0)?;
    let bearing_pressure = PRESSURE_RESERVE * BLOCK_DENSITY * STANDARD_GRAVITY * BLOCK_HEIGHT;
    let builder = Simulation::builder(TIME_STEP).expected_steps(STEP_COUNT);
    let builder = match law {
        LawCase::Yielding => {
            builder.interface(Yielding::new(bearing_pressure, FRICTION_COEFFICIENT)?)
        }
        LawCase::Cyclic { elastic_range, depth_gradient } => builder.interface(
            CyclicYielding::new(bearing_pressure, REFERENCE_SETTLEMENT, FRICTION_COEFFICIENT)?
                .with_elastic_range(elastic_range)?
                .with_depth_gradient(depth_gradient)?,
        ),
    };
    match cells {
        CellCase::Strips(count) => {
            let block = RigidBlock::new(BLOCK_WIDTH, BLOCK_HEIGHT, BLOCK_DENSITY)?;
            let ground = ElasticGround::under(soil, &block, count)?;
            builder.ground(ground).structure(block).motion(strong_motion(1.5)?).build()
        }
        CellCase::Cells(count) => {
            let body = RigidBody::cuboid([BLOCK_WIDTH, BLOCK_DEPTH, BLOCK_HEIGHT], BLOCK_DENSITY)?;
            let half = [BLOCK_WIDTH, BLOCK_DEPTH].map(|side| 0.5 * side);
            let plan = Plan::rectangle(-half[0]..half[0], -half[1]..half[1], count)?;
            let motion =
                Triaxial { x: Some(strong_motion(1.5)?), y: Some(strong_motion(0.7)?), up: None };
            let ground = ElasticGround::in_plan(soil, plan)?;
            builder.ground(ground).structure(body).motion(motion).build()
        }
    }
}

fn measure(cells: CellCase, law: LawCase, steps: usize) -> Result<SettlingStepCost, AnyError> {
    let mut simulation = simulation(cells, law)?;
    let mut trials = 0;
    let start_time = ThreadTime::try_now()?;
    for _ in 0..steps {
        trials += simulation.step()?.trials;
    }
    let seconds = start_time.try_elapsed()?.as_secs_f64() / steps as f64;
    let trials = trials as f64 / steps as f64;
    Ok(SettlingStepCost { cells: simulation.ground().elements().len(), seconds, trials })
}

/// Cost of each law.
type LawCosts = [SettlingStepCost; LAW_CASES.len()];

/// Costs of the laws in one scene, of each repetition.
fn costs(cells: CellCase, repetitions: usize, steps: usize) -> Result<Vec<LawCosts>, AnyError> {
    let measure_all = |_| {
        let [yielding, long, short] = LAW_CASES.map(|law| measure(cells, law, steps));
        Ok([yielding?, long?, short?])
    };
    (0..repetitions).map(measure_all).collect()
}

/// Median of the ratios of a law's times to those of [`LawCase::Yielding`].
fn median_ratio(costs: &[LawCosts], law: usize) -> f64 {
    let mut ratios: Vec<f64> =
        costs.iter().map(|cost| cost[law].seconds / cost[0].seconds).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    ratios[ratios.len() / 2]
}

/// Runs the study.
pub(crate) fn run(options: &SettlingCostOptions) -> Result<(), AnyError> {
    let (repetitions, steps) =
        if options.short { (1, 100) } else { (REPETITION_COUNT, STEP_COUNT) };
    let mut table = format!(
        "|cells|`Yielding`, trials|`CyclicYielding`, η = 1: time, trials|η = {SHORT_RANGE}: time, trials|\n|---|---|---|---|\n"
    );
    print!("{table}");
    let mut slow_cases = Vec::new();
    for cells in CELL_CASES {
        let costs = costs(cells, repetitions, steps)?;
        let [yielding, long, short] = costs[0];
        let name = match cells {
            CellCase::Strips(count) => format!("{count} strips"),
            CellCase::Cells(_) => format!("{} in plan", yielding.cells),
        };
        let [long_ratio, short_ratio] = [1, 2].map(|law| median_ratio(&costs, law));
        let row = format!(
            "|{name}|{:.2}|{long_ratio:.2}, {:.2}|{short_ratio:.2}, {:.2}|\n",
            yielding.trials, long.trials, short.trials
        );
        print!("{row}");
        let fastest = costs.iter().map(|cost| cost[0].seconds).fold(f64::INFINITY, f64::min);
        println!("  `Yielding`: {:.1} µs a step", 1e6 * fastest);
        table.push_str(&row);
        if long_ratio.max(short_ratio) > MAX_TIME_RATIO {
            slow_cases.push(name);
        }
    }
    if let Some(docs) = &options.docs {
        splice_into(&docs.join("validation.md"), "settling-cost", &table)?;
    }
    if slow_cases.is_empty() || options.short {
        Ok(())
    } else {
        let names = slow_cases.join("; ");
        Err(format!("more than {MAX_TIME_RATIO} times as long as `Yielding`: {names}").into())
    }
}
