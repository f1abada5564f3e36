//! CSV files and tables in Markdown.

use std::fmt::Write as _;
use std::path::Path;

use super::sweep::{SweepOutcome, SweepPoint};
use crate::AnyError;
use crate::document::{command_output, processor, threads, write_csv};

/// Tolerances of the summary.
const SUMMARY_TOLERANCES: [f64; 3] = [0.1, 0.01, 0.001];

/// Writes every point of every sweep.
pub(crate) fn write_points(path: &Path, sweeps: &[SweepOutcome]) -> Result<(), AnyError> {
    let points =
        sweeps.iter().flat_map(|sweep| sweep.points.iter().map(move |point| (sweep, point)));
    let columns = [
        "scene",
        "elements",
        "grading",
        "time_step_s",
        "steps_per_crossing",
        "history",
        "scheme",
        "error_of_history",
        "error_of_peak",
        "processor_s",
        "front",
    ];
    let rows = points.map(|(sweep, point)| {
        let settings = &point.settings;
        [
            sweep.scene.to_owned(),
            settings.elements.to_string(),
            settings.grading_name().to_owned(),
            settings.time_step.to_string(),
            (sweep.crossing / settings.time_step).to_string(),
            settings.history.name.to_owned(),
            settings.scheme.name(),
            format!("{:.4e}", point.errors.series),
            format!("{:.4e}", point.errors.peak),
            format!("{:.4e}", point.seconds),
            point.front.to_string(),
        ]
    });
    write_csv(path, columns, rows)
}

/// All tables: fastest settings, and fronts.
pub(crate) fn tables(sweeps: &[SweepOutcome]) -> Result<String, AnyError> {
    let mut text = fastest(sweeps)?;
    for sweep in sweeps {
        writeln!(text, "\n{}: the front\n", capitalised(sweep.scene))?;
        text.push_str(
            "| elements | Δt/crossing | history, scheme | error: history | peak | time |\n\
             |---|---|---|---|---|---|\n",
        );
        let mut front: Vec<&SweepPoint> = sweep.points.iter().filter(|point| point.front).collect();
        front.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        for point in front {
            writeln!(text, "{}", row(point, sweep.crossing))?;
        }
    }
    Ok(text)
}

/// Part shown in the document: settings to read, and the accuracy of the containment's references.
pub(crate) fn summary(settings: &str, sweeps: &[SweepOutcome]) -> Result<String, AnyError> {
    let mut text = format!("{}\n\n{settings}", machine());
    add_reference_errors(&mut text, sweeps)?;
    Ok(text)
}

/// Machine, the fastest settings for each tolerance, and the errors of the references.
fn fastest(sweeps: &[SweepOutcome]) -> Result<String, AnyError> {
    let mut text = format!(
        "{}\n\nThe fastest settings with both errors within the tolerance:\n\n\
         | scene | tolerance | elements | Δt/crossing | history, scheme | error: history | peak | \
         time |\n|---|---|---|---|---|---|---|---|\n",
        machine()
    );
    for sweep in sweeps {
        for tolerance in SUMMARY_TOLERANCES {
            let accurate = sweep
                .points
                .iter()
                .filter(|point| point.errors.series.max(point.errors.peak) <= tolerance);
            let best_point = accurate.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
            write!(text, "| {} | {} % ", sweep.scene, 100.0 * tolerance)?;
            match best_point {
                Some(point) => writeln!(text, "{}", row(point, sweep.crossing))?,
                None => writeln!(text, "| none that was tried | | | | | |")?,
            }
        }
    }
    add_reference_errors(&mut text, sweeps)?;
    Ok(text)
}

/// Adds the differences of coarser runs from the references.
fn add_reference_errors(text: &mut String, sweeps: &[SweepOutcome]) -> Result<(), AnyError> {
    for sweep in sweeps {
        if let Some(error) = sweep.reference_error {
            writeln!(
                text,
                "\n{}: half the elements and twice the step of the reference differ from it by \
                 {:.1e} (history) and {:.1e} (peak).",
                capitalised(sweep.scene),
                error.series,
                error.peak
            )?;
        }
    }
    Ok(())
}

/// A point as cells of a table.
fn row(point: &SweepPoint, crossing: f64) -> String {
    let settings = &point.settings;
    format!(
        "| {} {} | 1/{:.0} | {}, {} | {:.1e} | {:.1e} | {} |",
        settings.grading_name(),
        settings.elements,
        crossing / settings.time_step,
        settings.history.name,
        settings.scheme.name(),
        point.errors.series,
        point.errors.peak,
        time(point.seconds)
    )
}

fn time(seconds: f64) -> String {
    if seconds < 0.1 {
        format!("{:.2} ms", 1e3 * seconds)
    } else {
        format!("{seconds:.2} s")
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |c| c.to_uppercase().chain(letters).collect())
}

/// Processor and compiler.
pub(crate) fn machine() -> String {
    let compiler = command_output("rustc", &["--version"]);
    let compiler = compiler.split(" (").next().unwrap_or_default();
    format!("Machine: {}, one thread of {}; {compiler}.", processor("model name"), threads())
}
