//! The crate's performance targets, measured: histories, kernels, whole runs, growth, memory.
//!
//! ```text
//! cargo run --release --example performance            # everything, some minutes
//! cargo run --release --example performance -- --short # tens of seconds, shorter runs
//! ```
//!
//! Prints Markdown. Times are those of the thread on the processor (where the system tells them,
//! else wall time), so that other work on the machine disturbs little; the largest single step is
//! wall time. Whole runs are child processes, whose peak resident memory the system reports.

use std::error::Error;
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

use basemat::bem::{HalfPlaneGround, PatchKernel, Strip};
use basemat::fem::{Layer, Material, Mesh};
use basemat::history::{ConvolutionHistory, DirectHistory, RelaxedFftHistory};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{FemModel, RigidBlock};
use basemat::{Simulation, Soil};

type AnyError = Box<dyn Error>;

/// 1.5 ft.
const ELEMENT: f64 = 0.4572;
/// c_P Δt is half an element.
const STEPS: usize = 54_000;

/// The soil of the headline problem: ν = 1/3, waves of 650 and 1300 ft/s.
fn soil() -> Result<Soil, basemat::Error> {
    Soil::from_wave_speeds(198.12, 396.24, 1804.0)
}

fn time_step() -> f64 {
    0.5 * ELEMENT / 396.24
}

fn patch(count: usize) -> Result<Arc<PatchKernel>, basemat::Error> {
    let half = 0.5 * ELEMENT * count as f64;
    let elements = Strip::uniform(-half..half, count)?.elements();
    Ok(Arc::new(PatchKernel::new(soil()?, elements, time_step())?))
}

/// Seconds that this thread has been on a processor.
fn processor_time() -> f64 {
    static BEGIN: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    let wall = BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64();
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds =
        told.and_then(|text| text.split_whitespace().next().and_then(|n| n.parse::<f64>().ok()));
    nanoseconds.map_or(wall, |n| 1e-9 * n)
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = processor_time();
    let result = work();
    (result, processor_time() - begin)
}

/// Seconds of a march, and of its slowest step.
fn march(
    history: &mut dyn ConvolutionHistory,
    size: usize,
    steps: usize,
) -> Result<[f64; 2], basemat::Error> {
    let (mut displacement, mut traction) = (vec![0.0; size], vec![0.0; size]);
    let mut slowest = 0.0_f64;
    let (done, seconds) = timed(|| {
        for step in 0..steps {
            let begin = Instant::now();
            history.evaluate(&mut displacement)?;
            for (i, value) in traction.iter_mut().enumerate() {
                *value = ((step * 7919 + i * 104_729) % 1009) as f64;
            }
            history.push(&traction);
            slowest = slowest.max(begin.elapsed().as_secs_f64());
        }
        Ok(())
    });
    done.map(|()| [seconds, slowest])
}

/// Setup, march and slowest step of the relaxed history: means over `repeats`, which are marched
/// one after the other as the clock of the processor is coarse, and the least of the slowest steps.
fn relaxed(count: usize, steps: usize, repeats: usize) -> Result<[f64; 3], basemat::Error> {
    let kernel = patch(count)?;
    let (histories, setup) = timed(|| -> Result<Vec<_>, basemat::Error> {
        (0..repeats)
            .map(|_| {
                let mut history = RelaxedFftHistory::new(Arc::clone(&kernel));
                history.reserve(steps)?;
                Ok(history)
            })
            .collect()
    });
    let mut slowest = f64::INFINITY;
    let (marched, total) = timed(|| -> Result<(), basemat::Error> {
        for mut history in histories? {
            let [_, largest] = march(&mut history, 2 * count, steps)?;
            slowest = slowest.min(largest);
        }
        Ok(())
    });
    marched?;
    let repeats = repeats as f64;
    Ok([setup / repeats, total / repeats, slowest])
}

/// Seconds for all coefficients of a patch over `lags`.
fn kernels(count: usize, lags: usize) -> Result<f64, basemat::Error> {
    let kernel = patch(count)?;
    let mut values = [(); 3].map(|()| vec![0.0; lags]);
    let [normal, tangential, coupling] = &mut values;
    let (done, seconds) = timed(|| {
        (0..kernel.classes())
            .try_for_each(|class| kernel.coefficients(class, 1, normal, tangential, coupling))
    });
    done.map(|()| seconds)
}

/// Whole scenes, which run in a process of their own.
fn child(scene: &str, steps: usize) -> Result<(), AnyError> {
    let count = if scene == "200 elements" { 200 } else { 10 };
    let half = 0.5 * ELEMENT * f64::from(count);
    let ground = HalfPlaneGround::strip(soil()?, -half..half, usize::try_from(count)?)?;
    let builder = Simulation::builder(time_step())
        .ground(ground)
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY);
    let ((run, slowest), seconds) = timed(|| -> Result<_, AnyError> {
        let mut simulation = match scene {
            "200 elements" => {
                let block = RigidBlock::new(2.0 * half, 20.0, 500.0)?;
                builder.structure(block).interface(Bonded).build()?
            }
            "bonded" => builder.structure(tower(half)?).interface(Bonded).build()?,
            _ => builder.structure(tower(half)?).interface(Coulomb::new(0.4)?).build()?,
        };
        let (mut last, mut slowest) = (Instant::now(), 0.0_f64);
        let run = simulation.run(steps, |state| {
            // The first carries the setup.
            if state.step > 1 {
                slowest = slowest.max(last.elapsed().as_secs_f64());
            }
            last = Instant::now();
        })?;
        Ok((run, slowest))
    })
    .map_first()?;
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok())
        .map_or(f64::NAN, |kilobytes| 1.024e-3 * kilobytes);
    println!("{seconds} {peak} {slowest} {}", run.steps);
    Ok(())
}

/// Takes the error out of a timed result.
trait MapFirst<T> {
    fn map_first(self) -> Result<(T, f64), AnyError>;
}

impl<T> MapFirst<T> for (Result<T, AnyError>, f64) {
    fn map_first(self) -> Result<(T, f64), AnyError> {
        self.0.map(|value| (value, self.1))
    }
}

/// The paper's model: a basemat and twelve layers of the containment.
fn tower(half: f64) -> Result<FemModel, basemat::Error> {
    let (psf, slug, layer) = (47.880_259, 515.378_818, 1.8757);
    let foundation = Material::new(106_560_369.0 * psf, 1.0 / 3.0, 3.043_48 * slug)?;
    let above = Material::new(106_577_648.0 * psf, 1.0 / 3.0, 0.590_06 * slug)?;
    let layers = [Layer::new(layer, 1, foundation), Layer::new(12.0 * layer, 12, above)];
    FemModel::on_base(Mesh::layered_block(-half..half, 10, &layers)?)
}

/// Seconds, peak megabytes and slowest step of a scene.
fn measure(scene: &str, steps: usize) -> Result<[f64; 3], AnyError> {
    let output = Command::new(std::env::current_exe()?)
        .args(["--child", scene, &steps.to_string()])
        .output()?;
    if !output.status.success() {
        return Err(format!("{scene}: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    let text = String::from_utf8(output.stdout)?;
    let mut numbers = text.split_whitespace().map(str::parse::<f64>);
    let mut next = || numbers.next().ok_or("a number is missing");
    Ok([next()??, next()??, next()??])
}

fn row(what: &str, target: &str, measured: &str, met: bool) {
    println!("| {what} | {target} | {measured} | {} |", if met { "yes" } else { "**no**" });
}

/// What a command prints, or "unknown".
fn tell(command: &str, arguments: &[&str]) -> String {
    let output = Command::new(command).args(arguments).output().ok();
    let told = output.filter(|output| output.status.success());
    told.map_or("unknown".into(), |output| String::from_utf8_lossy(&output.stdout).trim().into())
}

fn history_rows(short: bool) -> Result<(), AnyError> {
    // The direct sum costs its N² multiply–adds at a rate that is constant from here on.
    let steps: usize = if short { 3_000 } else { 8_000 };
    let mut direct = DirectHistory::new(patch(10)?);
    direct.reserve(steps)?;
    let [seconds, _] = march(&mut direct, 20, steps)?;
    let rate = 100.0 * (steps as f64).powi(2) / seconds;
    let whole = seconds * (STEPS as f64 / steps as f64).powi(2);
    let [setup, total, slowest] = relaxed(10, STEPS, 3)?;
    row(
        "history alone, 10 elements, 54 000 steps: direct over relaxed",
        "≥ 200",
        &format!(
            "{:.0} ({total:.3} s, setup {setup:.3} s, slowest step {:.1} ms; direct {whole:.0} s \
             at {:.2} G multiply–adds/s, from {steps} steps)",
            whole / total,
            1e3 * slowest,
            1e-9 * rate,
        ),
        whole / total >= 200.0,
    );

    let longest = if short { 100_000 } else { 1_000_000 };
    let (mut points, mut list) = (Vec::new(), Vec::new());
    for steps in [1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000] {
        if steps <= longest {
            let repeats = (200_000 / steps).clamp(1, 200);
            let [_, total, slowest] = relaxed(10, steps, repeats)?;
            points.push([(steps as f64).ln(), total.ln()]);
            let each = 1e6 * total / steps as f64;
            list.push(format!("{steps}: {each:.2} µs, {:.1} ms", 1e3 * slowest));
        }
    }
    let count = points.len() as f64;
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let slope = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>()
        / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>();
    row(
        &format!("growth of marching time with N, 10³ to {longest}, setup apart: exponent"),
        "≤ 1.15",
        &format!("{slope:.3} (time per step and slowest step: {})", list.join("; ")),
        slope <= 1.15,
    );
    Ok(())
}

fn main() -> Result<(), AnyError> {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    if let [flag, scene, steps] = &arguments[..]
        && flag == "--child"
    {
        return child(scene, steps.parse()?);
    }
    let short = arguments.iter().any(|argument| argument == "--short");
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("unknown");
    println!("* processor: {}", model.trim_start_matches([' ', '\t', ':']));
    println!("* {}", tell("rustc", &["--version"]));
    let sources = tell("git", &["describe", "--always", "--dirty", "--tags"]);
    println!("* basemat {}, sources {sources}", env!("CARGO_PKG_VERSION"));
    println!("* one thread; times on the processor, slowest steps by the wall\n");
    println!("| what | target | measured | met |\n|---|---|---|---|");

    history_rows(short)?;
    for scene in ["bonded", "friction 0.4"] {
        let [seconds, peak, slowest] = measure(scene, STEPS)?;
        row(
            &format!("headline run, {scene}, 54 000 steps: peak resident memory"),
            "< 60 MB",
            &format!("{peak:.0} MB (run: {seconds:.2} s, slowest step {:.1} ms)", 1e3 * slowest),
            // Unknown is not a miss.
            peak.is_nan() || peak < 60.0,
        );
    }
    let steps = if short { 4_000 } else { STEPS };
    let [_, march, slowest] = relaxed(200, steps, 1)?;
    let [seconds, peak, slowest_whole] = measure("200 elements", steps)?;
    let whole = seconds * STEPS as f64 / steps as f64;
    let scaled = if short { format!(", scaled from {steps} steps") } else { String::new() };
    row(
        "200 contact elements, rigid block, bonded, 54 000 steps: whole run",
        "< 20 s",
        &format!(
            "{whole:.1} s{scaled} ({:.0} µs per step, {:.0} of them history; slowest step \
             {:.0} ms, history alone {:.0} ms; {peak:.0} MB)",
            1e6 * seconds / steps as f64,
            1e6 * march / steps as f64,
            1e3 * slowest_whole,
            1e3 * slowest,
        ),
        whole < 20.0,
    );
    for (count, target) in [(10, 0.1), (200, 2.0)] {
        let seconds = kernels(count, STEPS)?;
        row(
            &format!("coefficients of {count} elements, 54 000 lags"),
            &format!("< {target} s"),
            &format!("{seconds:.3} s"),
            seconds < target,
        );
    }
    println!("\nhistory alone, uniform strips, 10 000 steps:\n");
    println!("| elements | setup, s | µs per step | slowest step, ms |\n|---|---|---|---|");
    for count in if short { &[10, 40][..] } else { &[10, 20, 40, 80, 200] } {
        let [setup, total, slowest] = relaxed(*count, 10_000, 2)?;
        println!("| {count} | {setup:.3} | {:.2} | {:.1} |", 100.0 * total, 1e3 * slowest);
    }
    Ok(())
}
