//! Measured quantities and their targets.

use super::child::{Scene, Taken, containment, measure};
use super::histories::{alone, bounded, coefficients, direct, exponent, growth, relaxed};
use super::report::{Report, timed};
use crate::AnyError;
use basemat_problems::headline::{ROWS, STEPS};

/// The least processor time of `repeats` runs, and the least of all else.
fn best(scene: Scene, steps: usize, threads: usize, repeats: usize) -> Result<Taken, AnyError> {
    let mut best = measure(scene, steps, threads)?;
    for _ in 1..repeats {
        let taken = measure(scene, steps, threads)?;
        best = Taken {
            seconds: best.seconds.min(taken.seconds),
            march: best.march.min(taken.march),
            wall: best.wall.min(taken.wall),
            peak: best.peak.min(taken.peak),
            slowest: best.slowest.min(taken.slowest),
        };
    }
    Ok(best)
}

/// Unknown is not a miss.
fn within(peak: f64, limit: f64) -> bool {
    peak.is_nan() || peak < limit
}

/// Whole runs.
pub(crate) fn runs(report: &mut Report, short: bool) -> Result<(), AnyError> {
    let repeats = if short { 1 } else { 3 };
    for (name, scene) in [
        ("bonded", Scene::Bonded),
        ("friction 0.4", Scene::Friction),
        ("friction 0.4, graded elements", Scene::Graded),
    ] {
        let taken = best(scene, STEPS, 1, repeats)?;
        report.target(
            &format!("headline run, {name}: whole, setup included"),
            "< 0.7 s",
            &format!(
                "{:.2} s ({:.1} µs per step; slowest step {:.2} ms)",
                taken.seconds,
                1e6 * taken.seconds / STEPS as f64,
                1e3 * taken.slowest
            ),
            taken.seconds < 0.7,
        );
        report.target(
            "its peak resident memory",
            "< 15 MB",
            &format!("{:.1} MB", taken.peak),
            within(taken.peak, 15.0),
        );
    }
    let steps = if short { 100_000 } else { 1_000_000 };
    let taken = best(Scene::Long, steps, 1, 1)?;
    report.target(
        &format!("{steps} steps, 10 elements, friction 0.4, the record repeated"),
        "< 10 s",
        &format!(
            "{:.1} s ({:.1} µs per step; {:.1} MB)",
            taken.seconds,
            1e6 * taken.seconds / steps as f64,
            taken.peak
        ),
        taken.seconds < 10.0 && within(taken.peak, 15.0),
    );
    let steps = if short { 4_000 } else { STEPS };
    let taken = measure(Scene::Wide, steps, 1)?;
    let whole = taken.seconds * STEPS as f64 / steps as f64;
    let [_, march, _] = alone(relaxed, 200, steps, 1)?;
    report.target(
        "200 contact elements, rigid block, bonded, 54 000 steps: whole run",
        "< 20 s",
        &format!(
            "{whole:.1} s{} ({:.0} µs per step, {:.0} of them history; slowest step {:.0} ms; {:.0} MB)",
            if short { format!(", scaled from {steps} steps") } else { String::new() },
            1e6 * taken.seconds / steps as f64,
            1e6 * march / steps as f64,
            1e3 * taken.slowest,
            taken.peak,
        ),
        whole < 20.0,
    );
    let [seconds, wall] = containment()?;
    report.target(
        "example `containment` as it is: five cases, 34 × 80 ft, full record, files and plots",
        "< 4 s",
        &format!("{wall:.2} s by the clock, {seconds:.2} s of processors"),
        wall < 4.0,
    );
    Ok(())
}

/// Convolutions and coefficients by themselves.
pub(crate) fn histories(report: &mut Report, short: bool) -> Result<(), AnyError> {
    // The direct sum costs its N² multiply–adds at a rate that is constant from here on.
    let steps: usize = if short { 3_000 } else { 8_000 };
    let seconds = direct(10, steps)?;
    let rate = 100.0 * (steps as f64).powi(2) / seconds;
    let whole = seconds * (STEPS as f64 / steps as f64).powi(2);
    let [setup, total, slowest] = alone(bounded, 10, STEPS, 3)?;
    report.target(
        "history alone, 10 elements, 54 000 steps: direct over exponentials at 1e-12",
        "≥ 200",
        &format!(
            "{:.0} ({total:.3} s, setup {setup:.3} s, slowest step {:.1} ms; direct {whole:.0} s \
             at {:.2} G multiply–adds/s, scaled by N² from {steps} steps)",
            whole / total,
            1e3 * slowest,
            1e-9 * rate,
        ),
        whole / total >= 200.0,
    );
    let longest = if short { 100_000 } else { 1_000_000 };
    let growths = [growth(relaxed, longest)?, growth(bounded, longest)?];
    report.target(
        &format!("the same: exponent of marching time over N, 10³ to {longest}, setup apart"),
        "≤ 1.02",
        &format!("{:.3}", growths[1].exponent),
        growths[1].exponent <= 1.02,
    );
    for (count, target) in [(10, 0.1), (200, 2.0)] {
        let seconds = coefficients(count, STEPS)?;
        report.target(
            &format!("coefficients of {count} elements, 54 000 lags"),
            &format!("< {target} s"),
            &format!("{seconds:.3} s"),
            seconds < target,
        );
    }
    let rows: Vec<_> = growths[0]
        .points
        .iter()
        .zip(&growths[1].points)
        .map(|(one, two)| {
            let mut row = vec![one.0.to_string()];
            for (steps, total, slowest) in [one, two] {
                row.push(format!("{:.2}", 1e6 * total / *steps as f64));
                row.push(format!("{:.2}", 1e3 * slowest));
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
    let head = ["steps", "µs per step", "slowest step, ms"];
    let mut points = Vec::new();
    // Fewer steps would be made in degrees of freedom, not in modes.
    for steps in [10_000, 100_000, 1_000_000, 10_000_000].into_iter().filter(|n| *n <= 10 * longest)
    {
        let taken = best(Scene::Long, steps, 1, if steps > 10_000 { 1 } else { 3 })?;
        points.push((steps, taken.march, taken.slowest));
    }
    let rows: Vec<_> = points
        .iter()
        .map(|&(steps, total, slowest)| {
            let each = 1e6 * total / steps as f64;
            vec![steps.to_string(), format!("{each:.2}"), format!("{:.1}", 1e3 * slowest)]
        })
        .collect();
    let exponent = exponent(&points);
    report.table(
        &format!("Headline scene, friction 0.4, record repeated: exponent {exponent:.3}"),
        &head,
        &rows,
    );
    let mut rows = Vec::new();
    for count in if short { &[10, 40][..] } else { &[10, 20, 40, 80, 200] } {
        let mut row = vec![count.to_string()];
        for make in [relaxed, bounded] {
            let [setup, total, _] = alone(make, *count, 10_000, 2)?;
            row.extend([format!("{setup:.3}"), format!("{:.2}", 100.0 * total)]);
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

/// Time per step of each scene.
pub(crate) fn scenes(report: &mut Report, short: bool) -> Result<(), AnyError> {
    let (steps, repeats) = if short { (2_000, 1) } else { (10_000, 3) };
    let mut rows = Vec::new();
    for scene in &ROWS {
        let [mut least, mut build] = [f64::INFINITY; 2];
        for _ in 0..repeats {
            let (simulation, seconds) = timed(|| scene.build(steps));
            build = build.min(seconds);
            let mut simulation = simulation?;
            let (sum, seconds) = timed(|| scene.march(&mut simulation, steps));
            std::hint::black_box(sum?);
            least = least.min(seconds);
        }
        rows.push(vec![
            scene.name.into(),
            format!("{:.1}", 1e6 * least / steps as f64),
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

/// One and two threads.
pub(crate) fn sweep(report: &mut Report, short: bool) -> Result<(), AnyError> {
    if cfg!(not(feature = "rayon")) {
        return Ok(());
    }
    let (steps, repeats) = if short { (4_000, 1) } else { (20_000, 3) };
    let [one, two] = [1, 2].map(|threads| best(Scene::Sweep, steps, threads, repeats));
    let (one, two) = (one?, two?);
    let rows: Vec<_> = [("1", one), ("2", two)]
        .iter()
        .map(|(threads, taken)| {
            vec![
                (*threads).into(),
                format!("{:.2}", taken.wall),
                format!("{:.2}", taken.seconds),
                format!("{:.2}", one.wall / taken.wall),
                format!("{:.2}", taken.seconds / one.seconds),
                format!("{:.0}", taken.peak),
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
