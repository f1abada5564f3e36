//! Tables, CSV and pictures.

use std::path::Path;

use basemat::bem::full_plane::Stability;
use basemat::plot::{Curve, curves};

use super::case::{MarchEnd, MarchOutcome, SchemeRow};
use super::scheme::{COMPARED_SCHEMES, ComparedScheme, PaperScene};
use crate::AnyError;
use crate::document::{file_stem, write_csv};
use basemat_problems::containment::pounds_per_foot;

/// Assessment of the full-plane soils before the march. Growth slower than e-fold over the run is not searched for.
pub(crate) fn print_assessments(scene: &PaperScene, steps: usize) -> Result<(), AnyError> {
    println!(
        "\n| soil | base held, growth per step | base open | marched without leave |\n|---|---|---|---|"
    );
    for scheme in [ComparedScheme::Paper, ComparedScheme::Quadrature] {
        let ground = scheme.full_plane(scene)?;
        let states = ground.assess(scene.time_step, 1.0 / steps as f64)?;
        let bounded = states.iter().all(Stability::is_bounded);
        let answer = if bounded { "yes" } else { "no: `GroundError::Unstable`" };
        let growth = [growth_of(&states[1]), growth_of(&states[0])];
        println!("| {} | {} | {answer} |", scheme.name(), growth.join(" | "));
    }
    Ok(())
}

/// Growth per step and number of modes that grow.
pub(crate) fn growth_of(stability: &Stability) -> String {
    match (stability.is_bounded(), stability.growing_modes) {
        (true, _) => "none".to_owned(),
        (false, 1) => format!("{:.1e} (1 mode)", stability.growth_per_step),
        (false, modes) => format!("{:.1e} ({modes} modes)", stability.growth_per_step),
    }
}

/// Largest difference of a sound step from the half-plane's run, over the peak of that run.
///
/// The half-plane's run has the same interface. It limits runs that grow or end early.
const SOUND_DIFFERENCE: f64 = 0.3;

/// References of a run's numbers: the crate's scheme, and the half-plane under the same interface.
struct Measures {
    sound_steps: usize,
    /// Peak of these steps, lb/ft.
    peak: f64,
    growth: Option<f64>,
    /// Root mean square difference of the sound steps from the crate's scheme and from the half-plane's.
    differences: [f64; 2],
}

fn measures(row: &SchemeRow, outcome: &MarchOutcome) -> Option<Measures> {
    let crate_outcome = row.outcome(ComparedScheme::Basemat)?;
    let half_plane = row.outcome(ComparedScheme::HalfPlane)?;
    let growth = outcome.growth(half_plane);
    let is_sound = outcome.end == MarchEnd::Record && growth.is_none();
    let limit = if is_sound {
        None
    } else {
        outcome.steps_until_difference(half_plane, SOUND_DIFFERENCE)
    };
    let sound_steps = limit.unwrap_or(outcome.shear.len());
    Some(Measures {
        sound_steps,
        peak: pounds_per_foot(outcome.peak(sound_steps)),
        growth,
        differences: [crate_outcome, half_plane]
            .map(|reference| outcome.difference(reference, sound_steps)),
    })
}

/// Peak base shears beside the paper's Table 1.
pub(crate) fn print_peaks(rows: &[SchemeRow]) {
    println!("\nPeak base shear, lb/ft (of runs that grow or end early: as long as sound)\n");
    print!("| case | printed |");
    for scheme in COMPARED_SCHEMES {
        print!(" {} |", scheme.name());
    }
    println!("\n|---|---|---|---|---|---|");
    for row in rows {
        print!("| {} | {:.0} |", row.name, row.paper_peak);
        for (_, outcome) in &row.outcomes {
            let Some(measures) = measures(row, outcome) else { continue };
            match outcome.end {
                MarchEnd::Record if measures.growth.is_none() => print!(" {:.0} |", measures.peak),
                _ => print!(
                    " {:.0} to {:.2} s |",
                    measures.peak,
                    measures.sound_steps as f64 * outcome.time_step
                ),
            }
        }
        println!();
    }
}

/// Time that each run reached, and differences between the runs.
pub(crate) fn print_marches(rows: &[SchemeRow]) {
    println!(
        "\n| case | scheme | marched to, s | ended by | growth per step | from basemat, rms | \
         from half-plane, rms | processor, s |\n|---|---|---|---|---|---|---|---|"
    );
    for row in rows {
        for (scheme, outcome) in &row.outcomes {
            let Some(measures) = measures(row, outcome) else { continue };
            println!(
                "| {} | {} | {:.2} | {} | {} | {} | {} | {:.2} |",
                row.name,
                scheme.name(),
                outcome.time(),
                ending(outcome.end),
                measures.growth.map_or_else(|| "–".to_owned(), |growth| format!("{growth:.1e}")),
                percent(measures.differences[0]),
                percent(measures.differences[1]),
                outcome.processor.as_secs_f64(),
            );
        }
    }
}

/// A difference in percent, if any.
fn percent(difference: f64) -> String {
    if difference == 0.0 {
        "–".to_owned()
    } else {
        format!("{:.1} %", 100.0 * difference)
    }
}

fn ending(end: MarchEnd) -> &'static str {
    match end {
        MarchEnd::Record => "the record's end",
        MarchEnd::Grew => "growth",
        MarchEnd::NoModes => "flow chart cycles",
    }
}

/// Writes `summary.csv`.
pub(crate) fn write_summary(folder: &Path, rows: &[SchemeRow]) -> Result<(), AnyError> {
    let mut lines = Vec::new();
    for row in rows {
        for (scheme, outcome) in &row.outcomes {
            let Some(measures) = measures(row, outcome) else { continue };
            lines.push([
                row.name.to_owned(),
                scheme.name().to_owned(),
                row.paper_peak.to_string(),
                measures.peak.to_string(),
                (measures.sound_steps as f64 * outcome.time_step).to_string(),
                outcome.time().to_string(),
                ending(outcome.end).to_owned(),
                measures.growth.map_or_else(String::new, |growth| growth.to_string()),
                measures.differences[0].to_string(),
                measures.differences[1].to_string(),
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

/// Duration in a picture, s.
const SHOWN_DURATION: f64 = 8.0;

/// Draws one picture per row.
pub(crate) fn draw<'a>(
    folder: &Path,
    rows: impl IntoIterator<Item = &'a SchemeRow>,
) -> Result<(), AnyError> {
    for row in rows {
        let stem = file_stem(row.name);
        let mut lines = Vec::new();
        // The scheme that ends first is drawn on top.
        for (scheme, outcome) in row.outcomes.iter().rev() {
            let sound_steps = measures(row, outcome).map_or(0, |measures| measures.sound_steps);
            let shown_steps = row
                .outcome(ComparedScheme::Basemat)
                .and_then(|reference| outcome.steps_until_difference(reference, 1.0))
                .unwrap_or(usize::MAX);
            let name = match outcome.end {
                MarchEnd::Record => scheme.name().to_owned(),
                _ => format!(
                    "{} (sound to {:.2} s)",
                    scheme.name(),
                    sound_steps as f64 * outcome.time_step
                ),
            };
            let points = outcome.shear.iter().take(shown_steps).enumerate();
            let points = points
                .map(|(k, shear)| ((k + 1) as f64 * outcome.time_step, 1e-3 * shear))
                .take_while(|point| point.0 <= SHOWN_DURATION);
            lines.push(Curve { name, points: points.collect() });
        }
        let title = format!("Base shear, {}", row.name);
        let path = folder.join(format!("paper_scheme_{stem}.svg"));
        curves(&title, "time, s", "shear, kN/m", &lines)?.save(path)?;
    }
    Ok(())
}
