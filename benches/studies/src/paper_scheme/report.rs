//! Tables, CSV and pictures.

use std::path::Path;

use basemat::bem::full_plane::Stability;
use basemat::plot::{Curve, curves};

use super::case::{End, Outcome, Row};
use super::scheme::{SCHEMES, Scene, Scheme};
use crate::AnyError;
use crate::document::{file_stem, write_csv};
use basemat_problems::containment::pounds_per_foot;

/// Assessment of the full-plane soils before the march. Growth slower than e-fold over the run is not searched for.
pub(crate) fn print_assessments(scene: &Scene, steps: usize) -> Result<(), AnyError> {
    println!(
        "\n| soil | base held, growth per step | base open | marched without leave |\n|---|---|---|---|"
    );
    for scheme in [Scheme::Paper, Scheme::Quadrature] {
        let [open, held] = scheme.full_plane(scene)?.assess(scene.time_step, 1.0 / steps as f64)?;
        let growth = [&held, &open].map(growth_of);
        let bounded = held.is_bounded() && open.is_bounded();
        let answer = if bounded { "yes" } else { "no: `GroundError::Unstable`" };
        println!("| {} | {} | {} | {answer} |", scheme.name(), growth[0], growth[1]);
    }
    Ok(())
}

/// Growth per step and number of modes that grow.
pub(crate) fn growth_of(found: &Stability) -> String {
    match (found.is_bounded(), found.growing_modes) {
        (true, _) => "none".to_owned(),
        (false, 1) => format!("{:.1e} (1 mode)", found.growth_per_step),
        (false, modes) => format!("{:.1e} ({modes} modes)", found.growth_per_step),
    }
}

/// A run that grows, or ends early, is sound as long as it is within this share of the half-plane's
/// peak from the half-plane's run, which has the same interface.
const SOUND: f64 = 0.3;

/// References of a run's numbers: the crate's own scheme, and the half-plane under the same interface.
struct Measures {
    /// Sound steps.
    sound: usize,
    /// Peak of these steps, lb/ft.
    peak: f64,
    growth: Option<f64>,
    /// Root mean square difference of the sound steps from the crate's own and from the
    /// half-plane's.
    differences: [f64; 2],
}

fn measures(row: &Row, outcome: &Outcome) -> Option<Measures> {
    let (own, half_plane) = (row.outcome(Scheme::Own)?, row.outcome(Scheme::HalfPlane)?);
    let growth = outcome.growth(half_plane);
    let whole = outcome.end == End::Record && growth.is_none();
    let parts = if whole { None } else { outcome.parts_from(half_plane, SOUND) };
    let sound = parts.unwrap_or(outcome.shear.len());
    Some(Measures {
        sound,
        peak: pounds_per_foot(outcome.peak(sound)),
        growth,
        differences: [own, half_plane].map(|other| outcome.difference(other, sound)),
    })
}

/// Peak base shears beside the paper's Table 1.
pub(crate) fn print_peaks(rows: &[Row]) {
    println!("\nPeak base shear, lb/ft (of runs that grow or end early: as long as sound)\n");
    print!("| case | printed |");
    for scheme in SCHEMES {
        print!(" {} |", scheme.name());
    }
    println!("\n|---|---|---|---|---|---|");
    for row in rows {
        print!("| {} | {:.0} |", row.name, row.printed);
        for (_, outcome) in &row.outcomes {
            let Some(found) = measures(row, outcome) else { continue };
            match outcome.end {
                End::Record if found.growth.is_none() => print!(" {:.0} |", found.peak),
                _ => print!(
                    " {:.0} to {:.2} s |",
                    found.peak,
                    found.sound as f64 * outcome.time_step
                ),
            }
        }
        println!();
    }
}

/// Time that each run reached, and differences between the runs.
pub(crate) fn print_marches(rows: &[Row]) {
    println!(
        "\n| case | scheme | marched to, s | ended by | growth per step | from basemat, rms | \
         from half-plane, rms | processor, s |\n|---|---|---|---|---|---|---|---|"
    );
    for row in rows {
        for (scheme, outcome) in &row.outcomes {
            let Some(found) = measures(row, outcome) else { continue };
            println!(
                "| {} | {} | {:.2} | {} | {} | {} | {} | {:.2} |",
                row.name,
                scheme.name(),
                outcome.time(),
                ending(outcome.end),
                found.growth.map_or_else(|| "–".to_owned(), |growth| format!("{growth:.1e}")),
                share(found.differences[0]),
                share(found.differences[1]),
                outcome.processor.as_secs_f64(),
            );
        }
    }
}

/// A difference in percent, if any.
fn share(difference: f64) -> String {
    if difference == 0.0 { "–".to_owned() } else { format!("{:.1} %", 100.0 * difference) }
}

fn ending(end: End) -> &'static str {
    match end {
        End::Record => "the record's end",
        End::Grew => "growth",
        End::NoModes => "flow chart cycles",
    }
}

/// Writes `summary.csv`.
pub(crate) fn write_summary(folder: &Path, rows: &[Row]) -> Result<(), AnyError> {
    let mut lines = Vec::new();
    for row in rows {
        for (scheme, outcome) in &row.outcomes {
            let Some(found) = measures(row, outcome) else { continue };
            lines.push([
                row.name.to_owned(),
                scheme.name().to_owned(),
                row.printed.to_string(),
                found.peak.to_string(),
                (found.sound as f64 * outcome.time_step).to_string(),
                outcome.time().to_string(),
                ending(outcome.end).to_owned(),
                found.growth.map_or_else(String::new, |growth| growth.to_string()),
                found.differences[0].to_string(),
                found.differences[1].to_string(),
                outcome.processor.as_secs_f64().to_string(),
            ]);
        }
    }
    write_csv(
        folder.join("summary.csv"),
        [
            "case",
            "scheme",
            "table_1_lb_per_ft",
            "peak_base_shear_lb_per_ft",
            "sound_s",
            "marched_s",
            "ended_by",
            "growth_per_step",
            "rms_from_basemat",
            "rms_from_half_plane",
            "processor_s",
        ],
        lines,
    )
}

/// Seconds that a picture shows.
const SHOWN: f64 = 8.0;

/// One picture per row.
pub(crate) fn draw<'a>(
    folder: &Path,
    rows: impl IntoIterator<Item = &'a Row>,
) -> Result<(), AnyError> {
    for row in rows {
        let stem = file_stem(row.name);
        let curve = |(scheme, outcome): &(Scheme, Outcome)| {
            let sound = measures(row, outcome).map_or(0, |found| found.sound);
            let beyond = row.outcome(Scheme::Own).and_then(|own| outcome.parts_from(own, 1.0));
            let shown = beyond.unwrap_or(usize::MAX);
            let name = match outcome.end {
                End::Record => scheme.name().to_owned(),
                _ => format!(
                    "{} (sound to {:.2} s)",
                    scheme.name(),
                    sound as f64 * outcome.time_step
                ),
            };
            let points = outcome.shear.iter().take(shown).enumerate();
            let points = points
                .map(|(k, v)| ((k + 1) as f64 * outcome.time_step, 1e-3 * v))
                .take_while(|point| point.0 <= SHOWN);
            Curve { name, points: points.collect() }
        };
        // The scheme that ends first on top.
        let lines: Vec<_> = row.outcomes.iter().rev().map(curve).collect();
        let title = format!("Base shear, {}", row.name);
        let path = folder.join(format!("paper_scheme_{stem}.svg"));
        curves(&title, "time, s", "shear, kN/m", &lines)?.save(path)?;
    }
    Ok(())
}
