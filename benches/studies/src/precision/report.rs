//! CSV files and tables in Markdown.

use std::fmt::Write as _;
use std::path::Path;

use super::force::Errors;
use super::sweep::{Outcome, Point};
use crate::AnyError;
use crate::document::{processor, threads, told_by, write_csv};

/// Tolerances of the summary.
const TOLERANCES: [f64; 3] = [0.1, 0.01, 0.001];

/// Writes every point of every sweep.
pub(crate) fn write_points(path: &Path, sweeps: &[Outcome]) -> Result<(), AnyError> {
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
    let row = |(sweep, point): (&Outcome, &Point)| {
        let s = &point.settings;
        [
            sweep.scene.to_owned(),
            s.elements.to_string(),
            s.grading_name().to_owned(),
            s.time_step.to_string(),
            (sweep.crossing / s.time_step).to_string(),
            s.history.name.to_owned(),
            s.scheme.name(),
            format!("{:.4e}", point.errors.history),
            format!("{:.4e}", point.errors.peak),
            format!("{:.4e}", point.seconds),
            point.front.to_string(),
        ]
    };
    write_csv(path, columns, points.map(row))
}

/// Everything: fastest settings, fronts, every proposal.
pub(crate) fn tables(sweeps: &[Outcome]) -> Result<String, AnyError> {
    let mut text = fastest(sweeps)?;
    for sweep in sweeps {
        writeln!(text, "\n{}: the front\n", capitalised(sweep.scene))?;
        text.push_str(
            "| elements | Δt/crossing | history, scheme | error: history | peak | time |\n\
             |---|---|---|---|---|---|\n",
        );
        let mut front: Vec<&Point> = sweep.points.iter().filter(|point| point.front).collect();
        front.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        for point in front {
            writeln!(text, "{}", row(point, sweep.crossing))?;
        }
    }
    Ok(text)
}

/// Part shown in the document: settings to read, and the accuracy of the containment's references.
pub(crate) fn summary(settings: &str, sweeps: &[Outcome]) -> Result<String, AnyError> {
    let mut text = format!("{}\n\n{settings}", machine());
    doubts(&mut text, sweeps)?;
    Ok(text)
}

/// Machine, the fastest settings for each tolerance, and how good the references are.
fn fastest(sweeps: &[Outcome]) -> Result<String, AnyError> {
    let mut text = format!(
        "{}\n\nThe fastest settings with both errors within the tolerance:\n\n\
         | scene | tolerance | elements | Δt/crossing | history, scheme | error: history | peak | \
         time |\n|---|---|---|---|---|---|---|---|\n",
        machine()
    );
    for sweep in sweeps {
        for tolerance in TOLERANCES {
            let good = |errors: &Errors| errors.history.max(errors.peak) <= tolerance;
            let points = sweep.points.iter().filter(|point| good(&point.errors));
            let best = points.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
            write!(text, "| {} | {} % ", sweep.scene, 100.0 * tolerance)?;
            match best {
                Some(point) => writeln!(text, "{}", row(point, sweep.crossing))?,
                None => writeln!(text, "| none that was tried | | | | | |")?,
            }
        }
    }
    doubts(&mut text, sweeps)?;
    Ok(text)
}

fn doubts(text: &mut String, sweeps: &[Outcome]) -> Result<(), AnyError> {
    for sweep in sweeps {
        if let Some(doubt) = sweep.doubt {
            writeln!(
                text,
                "\n{}: half the elements and twice the step of the reference differ from it by \
                 {:.1e} (history) and {:.1e} (peak).",
                capitalised(sweep.scene),
                doubt.history,
                doubt.peak
            )?;
        }
    }
    Ok(())
}

/// A point as cells of a table.
fn row(point: &Point, crossing: f64) -> String {
    let s = &point.settings;
    format!(
        "| {} {} | 1/{:.0} | {}, {} | {:.1e} | {:.1e} | {} |",
        s.grading_name(),
        s.elements,
        crossing / s.time_step,
        s.history.name,
        s.scheme.name(),
        point.errors.history,
        point.errors.peak,
        time(point.seconds)
    )
}

fn time(seconds: f64) -> String {
    if seconds < 0.1 { format!("{:.2} ms", 1e3 * seconds) } else { format!("{seconds:.2} s") }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |c| c.to_uppercase().chain(letters).collect())
}

/// Processor and compiler.
pub(crate) fn machine() -> String {
    let compiler = told_by("rustc", &["--version"]);
    let compiler = compiler.split(" (").next().unwrap_or_default();
    format!("Machine: {}, one thread of {}; {compiler}.", processor("model name"), threads())
}
