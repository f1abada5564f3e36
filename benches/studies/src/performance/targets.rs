//! Measured quantities and their targets.

use super::child::{RunCost, RunScene, containment, measure};
use super::histories::{
    Growth, GrowthPoint, bounded, coefficients, direct, exponent, growth, history_cost, relaxed,
};
use super::report::{Report, timed};
use crate::AnyError;
use basemat_problems::headline::{RECORD_STEPS, TIMED_SCENES};

/// The smallest times and memory of `repeats` runs.
fn best(
    scene: RunScene,
    steps: usize,
    threads: usize,
    repeats: usize,
) -> Result<RunCost, AnyError> {
    let mut best_cost = measure(scene, steps, threads)?;
    for _ in 1..repeats {
        let cost = measure(scene, steps, threads)?;
        best_cost = RunCost {
            seconds: best_cost.seconds.min(cost.seconds),
            march: best_cost.march.min(cost.march),
            wall: best_cost.wall.min(cost.wall),
            peak: best_cost.peak.min(cost.peak),
            slowest: best_cost.slowest.min(cost.slowest),
        };
    }
    Ok(best_cost)
}

/// Whether the memory is below the limit, or unknown.
fn within(peak: f64, limit: f64) -> bool {
    peak.is_nan() || peak < limit
}

/// Measures whole runs.
pub(crate) fn runs(report: &mut Report, short: bool) -> Result<(), AnyError> {
    let repeats = if short { 1 } else { 3 };
    for (name, scene) in [
        ("bonded", RunScene::Bonded),
        ("friction 0.4", RunScene::Friction),
        ("friction 0.4, graded elements", RunScene::Graded),
    ] {
        let cost = best(scene, RECORD_STEPS, 1, repeats)?;
        report.target(
            &format!("headline run, {name}: whole, setup included"),
            "< 0.7 s",
            &format!(
                "{:.2} s ({:.1} µs per step; slowest step {:.2} ms)",
                cost.seconds,
                1e6 * cost.seconds / RECORD_STEPS as f64,
                1e3 * cost.slowest
            ),
            cost.seconds < 0.7,
        );
        report.target(
            "its peak resident memory",
            "< 15 MB",
            &format!("{:.1} MB", cost.peak),
            within(cost.peak, 15.0),
        );
    }
    let steps = if short { 100_000 } else { 1_000_000 };
    let cost = best(RunScene::Long, steps, 1, 1)?;
    report.target(
        &format!("{steps} steps, 10 elements, friction 0.4, the record repeated"),
        "< 10 s",
        &format!(
            "{:.1} s ({:.1} µs per step; {:.1} MB)",
            cost.seconds,
            1e6 * cost.seconds / steps as f64,
            cost.peak
        ),
        cost.seconds < 10.0 && within(cost.peak, 15.0),
    );
    let steps = if short { 4_000 } else { RECORD_STEPS };
    let cost = measure(RunScene::Wide, steps, 1)?;
    let scaled_seconds = cost.seconds * RECORD_STEPS as f64 / steps as f64;
    let march = history_cost(relaxed, 200, steps, 1)?.march;
    report.target(
        "200 contact elements, rigid block, bonded, 54 000 steps: whole run",
        "< 20 s",
        &format!(
            "{scaled_seconds:.1} s{} ({:.0} µs per step, {:.0} of them history; slowest step {:.0} ms; {:.0} MB)",
            if short { format!(", scaled from {steps} steps") } else { String::new() },
            1e6 * cost.seconds / steps as f64,
            1e6 * march / steps as f64,
            1e3 * cost.slowest,
            cost.peak,
        ),
        scaled_seconds < 20.0,
    );
    let example = containment()?;
    report.target(
        "example `containment` as it is: five cases, 34 × 80 ft, full record, files and plots",
        "< 4 s",
        &format!("{:.2} s by the clock, {:.2} s of processors", example[1], example[0]),
        example[1] < 4.0,
    );
    Ok(())
}

/// Measures convolutions and their weights.
pub(crate) fn histories(report: &mut Report, short: bool) -> Result<(), AnyError> {
    // The direct sum costs its N² multiply–adds at a rate that is constant from here on.
    let steps: usize = if short { 3_000 } else { 8_000 };
    let seconds = direct(10, steps)?;
    let rate = 100.0 * (steps as f64).powi(2) / seconds;
    let scaled_seconds = seconds * (RECORD_STEPS as f64 / steps as f64).powi(2);
    let exponentials = history_cost(bounded, 10, RECORD_STEPS, 3)?;
    report.target(
        "history alone, 10 elements, 54 000 steps: direct over exponentials at 1e-12",
        "≥ 200",
        &format!(
            "{:.0} ({:.3} s, setup {:.3} s, slowest step {:.1} ms; direct {scaled_seconds:.0} s \
             at {:.2} G multiply–adds/s, scaled_seconds by N² from {steps} steps)",
            scaled_seconds / exponentials.march,
            exponentials.march,
            exponentials.setup,
            1e3 * exponentials.slowest_step,
            1e-9 * rate,
        ),
        scaled_seconds / exponentials.march >= 200.0,
    );
    let max_steps = if short { 100_000 } else { 1_000_000 };
    let growths = [growth(relaxed, max_steps)?, growth(bounded, max_steps)?];
    report.target(
        &format!("the same: exponent of marching time over N, 10³ to {max_steps}, setup apart"),
        "≤ 1.02",
        &format!("{:.3}", growths[1].exponent),
        growths[1].exponent <= 1.02,
    );
    coefficient_targets(report)?;
    growth_table(report, &growths);
    long_run_table(report, max_steps)?;
    strip_table(report, short)
}

fn coefficient_targets(report: &mut Report) -> Result<(), AnyError> {
    for (count, target) in [(10, 0.1), (200, 2.0)] {
        let seconds = coefficients(count, RECORD_STEPS)?;
        report.target(
            &format!("coefficients of {count} elements, 54 000 lags"),
            &format!("< {target} s"),
            &format!("{seconds:.3} s"),
            seconds < target,
        );
    }
    Ok(())
}

/// Adds the times of both histories over the number of steps.
fn growth_table(report: &mut Report, growths: &[Growth; 2]) {
    let rows: Vec<_> = growths[0]
        .points
        .iter()
        .zip(&growths[1].points)
        .map(|(transforms, exponentials)| {
            let mut row = vec![transforms.steps.to_string()];
            for point in [transforms, exponentials] {
                row.push(format!("{:.2}", 1e6 * point.march / point.steps as f64));
                row.push(format!("{:.2}", 1e3 * point.slowest_step));
            }
            row
        })
        .collect();
    report.table(
        &format!(
            "Convolutions alone, 10 elements: transforms (exponent {:.3}), exponentials at 1e-12 ({:.3})",
            growths[0].exponent, growths[1].exponent
        ),
        &[
            "steps",
            "transforms: µs per step",
            "slowest step, ms",
            "exponentials: µs per step",
            "slowest step, ms",
        ],
        &rows,
    );
}

/// Adds the times of whole runs over the number of steps.
fn long_run_table(report: &mut Report, max_steps: usize) -> Result<(), AnyError> {
    let head = ["steps", "µs per step", "slowest step, ms"];
    let mut points = Vec::new();
    // With fewer steps, the simulation would use degrees of freedom instead of modes.
    for steps in
        [10_000, 100_000, 1_000_000, 10_000_000].into_iter().filter(|n| *n <= 10 * max_steps)
    {
        let cost = best(RunScene::Long, steps, 1, if steps > 10_000 { 1 } else { 3 })?;
        points.push(GrowthPoint { steps, march: cost.march, slowest_step: cost.slowest });
    }
    let rows: Vec<_> = points
        .iter()
        .map(|point| {
            let step_time = 1e6 * point.march / point.steps as f64;
            let slowest_step = 1e3 * point.slowest_step;
            vec![point.steps.to_string(), format!("{step_time:.2}"), format!("{slowest_step:.1}")]
        })
        .collect();
    let exponent = exponent(&points);
    report.table(
        &format!("Headline scene, friction 0.4, record repeated: exponent {exponent:.3}"),
        &head,
        &rows,
    );
    Ok(())
}

/// Adds the times of both histories over the number of elements.
fn strip_table(report: &mut Report, short: bool) -> Result<(), AnyError> {
    let mut rows = Vec::new();
    for count in if short { &[10, 40][..] } else { &[10, 20, 40, 80, 200] } {
        let mut row = vec![count.to_string()];
        for prepare in [relaxed, bounded] {
            let cost = history_cost(prepare, *count, 10_000, 2)?;
            row.extend([format!("{:.3}", cost.setup), format!("{:.2}", 100.0 * cost.march)]);
        }
        rows.push(row);
    }
    let head = [
        "elements",
        "transforms: setup, s",
        "µs per step",
        "exponentials: setup, s",
        "µs per step",
    ];
    report.table("Convolutions alone, uniform strips, 10 000 steps", &head, &rows);
    Ok(())
}

/// Measures the time per step of each scene.
pub(crate) fn scenes(report: &mut Report, short: bool) -> Result<(), AnyError> {
    let steps = if short { 2_000 } else { 10_000 };
    let repeats = if short { 1 } else { 3 };
    let mut rows = Vec::new();
    for scene in &TIMED_SCENES {
        let mut march = f64::INFINITY;
        let mut build = f64::INFINITY;
        for _ in 0..repeats {
            let timed_build = timed(|| scene.build(steps));
            build = build.min(timed_build.seconds);
            let mut simulation = timed_build.result?;
            let timed_march = timed(|| scene.march(&mut simulation, steps));
            std::hint::black_box(timed_march.result?);
            march = march.min(timed_march.seconds);
        }
        rows.push(vec![
            scene.name.into(),
            format!("{:.1}", 1e6 * march / steps as f64),
            format!("{:.0}", 1e3 * build),
            scene.left_out.into(),
        ]);
    }
    report.table(
        &format!("Time per step of scenes, the first {steps} steps of the headline run"),
        &["scene", "µs per step", "build, ms", "what is left out"],
        &rows,
    );
    Ok(())
}

/// Measures a sweep on one and on two threads.
pub(crate) fn sweep(report: &mut Report, short: bool) -> Result<(), AnyError> {
    if cfg!(not(feature = "rayon")) {
        return Ok(());
    }
    let steps = if short { 4_000 } else { 20_000 };
    let repeats = if short { 1 } else { 3 };
    let one_thread = best(RunScene::Sweep, steps, 1, repeats)?;
    let two_threads = best(RunScene::Sweep, steps, 2, repeats)?;
    let rows: Vec<_> = [("1", one_thread), ("2", two_threads)]
        .iter()
        .map(|(threads, cost)| {
            vec![
                (*threads).into(),
                format!("{:.2}", cost.wall),
                format!("{:.2}", cost.seconds),
                format!("{:.2}", one_thread.wall / cost.wall),
                format!("{:.2}", cost.seconds / one_thread.seconds),
                format!("{:.0}", cost.peak),
            ]
        })
        .collect();
    report.table(
        &format!("Sweep of eight coefficients of friction, {steps} steps each, shared kernels"),
        &[
            "threads",
            "by the clock, s",
            "processors, s",
            "speed-up",
            "processor time over one thread's",
            "MB",
        ],
        &rows,
    );
    Ok(())
}
