//! Whole runs in separate processes, whose peak resident memory the system reports.

use std::process::Command;
use std::time::Instant;

use basemat::Result;
use basemat::bem::{ElasticGround, Grading, SharedKernels, Strip};
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::RigidBlock;
use basemat::sweep::Sweep;

use super::report::timed;
use crate::AnyError;
use crate::document::peak_memory;
use basemat_problems::headline::{
    ELEMENT_COUNT, ELEMENT_LENGTH, headline, repeated_record, soil, time_step,
};

const SWEEP_CASES: usize = 8;

/// A whole run.
#[derive(Debug, Clone, Copy, PartialEq, clap::ValueEnum)]
pub(crate) enum RunScene {
    Bonded,
    Friction,
    /// Friction, ten graded elements.
    Graded,
    /// Friction, under a record that lasts as long as the run.
    Long,
    /// 200 elements under a rigid block, bonded.
    Wide,
    /// Eight coefficients of friction, on all threads.
    Sweep,
}

/// Time and memory of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RunCost {
    /// Processor time of all threads, s.
    pub(crate) seconds: f64,
    /// Processor time of the steps, s.
    pub(crate) march: f64,
    /// Wall time, s.
    pub(crate) wall: f64,
    /// Largest resident memory, MB; NaN where the system does not report it.
    pub(crate) peak: f64,
    /// Wall time of the slowest step, s.
    pub(crate) slowest: f64,
}

/// Runs `scene` here, and prints the numbers for [`measure`].
pub(crate) fn run(scene: RunScene, steps: usize) -> std::result::Result<(), AnyError> {
    let start_time = Instant::now();
    // A sweep does not measure its steps.
    let time = if scene == RunScene::Sweep {
        sweep(steps)?;
        StepTimes::default()
    } else {
        march(scene, steps)?
    };
    let seconds = cpu_time::ProcessTime::try_now()?.as_duration().as_secs_f64();
    let peak = peak_memory().unwrap_or(f64::NAN);
    let wall = start_time.elapsed().as_secs_f64();
    println!("{seconds} {} {wall} {peak} {}", time.total, time.slowest_step);
    Ok(())
}

/// Times of a march, s.
#[derive(Default)]
struct StepTimes {
    total: f64,
    /// Slowest step but the first.
    slowest_step: f64,
}

fn march(scene: RunScene, steps: usize) -> Result<StepTimes> {
    let (builder, ground) = headline(if scene == RunScene::Wide { 200 } else { ELEMENT_COUNT })?;
    let mut simulation = match scene {
        RunScene::Wide => {
            let block = RigidBlock::new(200.0 * ELEMENT_LENGTH, 20.0, 500.0)?;
            builder.ground(ground).structure(block).interface(Bonded)
        }
        RunScene::Bonded => builder.ground(ground).interface(Bonded),
        RunScene::Graded => {
            let half_width = 0.5 * ELEMENT_LENGTH * ELEMENT_COUNT as f64;
            let strip = Strip::new(-half_width..half_width, ELEMENT_COUNT, Grading::Cosine)?;
            let ground = ElasticGround::new(soil()?, strip)?;
            builder.ground(ground).interface(Coulomb::new(0.4)?)
        }
        RunScene::Long => {
            let record = repeated_record(steps as f64 * time_step())?;
            builder.ground(ground).interface(Coulomb::new(0.4)?).motion(record)
        }
        RunScene::Friction | RunScene::Sweep => {
            builder.ground(ground).interface(Coulomb::new(0.4)?)
        }
    }
    .expected_steps(steps)
    .build()?;
    let mut last = Instant::now();
    let mut slowest_step = 0.0_f64;
    let timed_run = timed(|| {
        simulation.run(steps, |state| {
            if state.step > 1 {
                slowest_step = slowest_step.max(last.elapsed().as_secs_f64());
            }
            last = Instant::now();
        })
    });
    timed_run.result.map(|_| StepTimes { total: timed_run.seconds, slowest_step })
}

fn sweep(steps: usize) -> Result<()> {
    let kernels = SharedKernels::default();
    let mut outcome = Ok(());
    Sweep::new(SWEEP_CASES).run(
        |case| {
            let (builder, ground) = headline(ELEMENT_COUNT)?;
            let builder = builder
                .ground(ground.with_shared_kernels(&kernels))
                .interface(Coulomb::new(0.1 * (case.index + 1) as f64)?);
            builder.expected_steps(steps).build()?.run(steps, |_| ()).map(|_| ())
        },
        |_, result| {
            if let Err(error) = result {
                outcome = Err(error.into());
            }
        },
    );
    outcome
}

/// Runs `scene` in a separate process, on `threads` threads.
pub(crate) fn measure(
    scene: RunScene,
    steps: usize,
    threads: usize,
) -> std::result::Result<RunCost, AnyError> {
    let name = format!("{scene:?}").to_lowercase();
    let output = Command::new(std::env::current_exe()?)
        .args(["performance", "--child", &name, "--steps", &steps.to_string()])
        .env("RAYON_NUM_THREADS", threads.to_string())
        .output()?;
    if !output.status.success() {
        return Err(format!("{name}: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    let text = String::from_utf8(output.stdout)?;
    let numbers: Vec<f64> =
        text.split_whitespace().map(str::parse).collect::<std::result::Result<_, _>>()?;
    let [seconds, march, wall, peak, slowest] = numbers[..] else {
        return Err(format!("{name}: {} numbers, not 5", numbers.len()).into());
    };
    Ok(RunCost { seconds, march, wall, peak, slowest })
}

/// Processor time of all threads and wall time of the example `containment`, files and plots included, s.
pub(crate) fn containment() -> std::result::Result<[f64; 2], AnyError> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let mut build = Command::new(cargo);
    build.current_dir(root);
    build.args(["build", "--quiet", "--release", "--example", "containment"]);
    let program = std::env::current_exe()?;
    let folder = program.parent().ok_or("the program has no folder")?;
    if !build.status()?.success() {
        return Err("the example containment does not compile".into());
    }
    let start_time = Instant::now();
    let before = children_time();
    let output = Command::new(folder.join("examples/containment")).output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    Ok([children_time() - before, start_time.elapsed().as_secs_f64()])
}

/// Processor time of all children that have ended, s; NaN where the system does not report it.
fn children_time() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = text.rsplit(") ").next().unwrap_or_default().split_whitespace();
    // `cutime` and `cstime`, the 16th and 17th, in hundredths of a second.
    let ticks: Vec<f64> = fields.skip(13).take(2).filter_map(|field| field.parse().ok()).collect();
    if let [user, system] = ticks[..] { 0.01 * (user + system) } else { f64::NAN }
}
