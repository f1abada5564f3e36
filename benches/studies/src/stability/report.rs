//! CSV file and tables in Markdown.

use std::fmt::Write as _;
use std::path::Path;

use super::axes::{SCHEME_MAP, StabilityMap};
use super::run::{ENERGY_ROUNDING, MapCell, Verdict};
use super::scene::StabilityScheme;
use crate::AnyError;
use crate::document::write_csv;

fn number_text(number: f64) -> String {
    format!("{number:.3e}")
}

/// Largest value of some cells.
fn largest(cells: &[&MapCell], value: impl Fn(&MapCell) -> f64) -> f64 {
    cells.iter().map(|cell| value(cell)).fold(0.0, f64::max)
}

fn count_verdicts(cells: &[&MapCell], verdict: Verdict) -> usize {
    cells.iter().filter(|cell| cell.outcome.verdict == verdict).count()
}

/// Writes every cell.
pub(crate) fn write_cells(
    path: &Path,
    maps: &[StabilityMap],
    cells: &[MapCell],
) -> Result<(), AnyError> {
    let rows = cells.iter().map(|cell| {
        let map = &maps[cell.map];
        let outcome = &cell.outcome;
        [
            map.name.to_owned(),
            cell.scheme.name().to_owned(),
            map.x.name.to_owned(),
            map.x.labels[cell.place[0]].clone(),
            map.y.name.to_owned(),
            map.y.labels[cell.place[1]].clone(),
            outcome.verdict.name().to_owned(),
            number_text(outcome.energy_balance[0]),
            number_text(outcome.energy_balance[1]),
            number_text(outcome.growth),
            number_text(outcome.growth_per_step),
            outcome.assessed.map(|growth| number_text(growth[0])).unwrap_or_default(),
            outcome.assessed.map(|growth| number_text(growth[1])).unwrap_or_default(),
            number_text(outcome.rise),
            number_text(outcome.smallest_soil_work),
            number_text(outcome.created_energy),
            format!("{:.2}", outcome.trials[0]),
            format!("{:.0}", outcome.trials[1]),
            outcome.fallbacks[0].to_string(),
            outcome.fallbacks[1].to_string(),
            outcome.mode_changes.to_string(),
            format!("{:.2}", outcome.largest_uplift),
            outcome.steps.to_string(),
            outcome.error.as_ref().map(ToString::to_string).unwrap_or_default(),
        ]
    });
    let columns = [
        "map",
        "scheme",
        "x_name",
        "x",
        "y_name",
        "y",
        "verdict",
        "energy_error",
        "largest_energy_error",
        "energy_growth",
        "growth_per_step",
        "assessed_growth_uplifted",
        "assessed_growth_bonded",
        "energy_rise",
        "least_soil_work",
        "made_by_time_scheme",
        "trials_per_step",
        "most_trials",
        "gauss_seidel_steps",
        "path_steps",
        "mode_changes",
        "largest_uplift",
        "steps",
        "error",
    ];
    write_csv(path, columns, rows)
}

/// The summary of all maps, and the long runs one by one.
pub(crate) fn tables(maps: &[StabilityMap], cells: &[MapCell]) -> String {
    let mut text = String::from(
        "| sweep | scheme | cells | steps | bounded | active | grows | refused | failed | \
         energy_balance residual, end | on the way | rise of energy | solves per step: mean | most | \
         steps by Gauss–Seidel | by path |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (index, map) in maps.iter().enumerate() {
        for &scheme in map.schemes {
            let scheme_cells: Vec<_> =
                cells.iter().filter(|cell| cell.map == index && cell.scheme == scheme).collect();
            if !scheme_cells.is_empty() {
                summary(&mut text, map.name, scheme, &scheme_cells);
            }
        }
    }
    let all: Vec<_> = cells.iter().filter(|cell| cell.scheme == StabilityScheme::Basemat).collect();
    if !all.is_empty() {
        summary(&mut text, "**all**", StabilityScheme::Basemat, &all);
    }
    if cells.iter().any(|cell| cell.outcome.assessed.is_some()) {
        text.push_str(&assessments(maps, cells));
    }
    text.push_str(&long_runs(maps, cells));
    text
}

fn summary(text: &mut String, name: &str, scheme: StabilityScheme, cells: &[&MapCell]) {
    let steps: usize = cells.iter().map(|cell| cell.outcome.steps).sum();
    let solves: f64 =
        cells.iter().map(|cell| cell.outcome.trials[0] * cell.outcome.steps as f64).sum();
    let gauss_seidel: usize = cells.iter().map(|cell| cell.outcome.fallbacks[0]).sum();
    let paths: usize = cells.iter().map(|cell| cell.outcome.fallbacks[1]).sum();
    let _ = write!(text, "| {name} | {} | {} | {steps} ", scheme.name(), cells.len());
    for verdict in Verdict::ALL_VERDICTS {
        let _ = write!(text, "| {} ", count_verdicts(cells, verdict));
    }
    let rise = if scheme.is_passive() {
        format!("{:.1e}", largest(cells, |cell| cell.outcome.rise))
    } else {
        "–".into()
    };
    let _ = writeln!(
        text,
        "| {:.1e} | {:.1e} | {rise} | {:.2} | {:.0} | {} | {} |",
        largest(cells, |cell| cell.outcome.energy_balance[0]),
        largest(cells, |cell| cell.outcome.energy_balance[1]),
        solves / steps.max(1) as f64,
        largest(cells, |cell| cell.outcome.trials[1]),
        gauss_seidel,
        paths
    );
}

/// The part of [`tables`] for the document.
///
/// It has verdicts of each scheme, figures of the crate's scheme, and the long runs.
pub(crate) fn document(maps: &[StabilityMap], cells: &[MapCell]) -> String {
    let mut text = String::from(
        "| sweep | basemat | energy error: end | on the way | rise of energy | most solves in a \
         step | paper | quadrature |\n|---|---|---|---|---|---|---|---|\n",
    );
    // Cells of a scheme in one map, or in all maps but the comparison of time schemes.
    let select = |scheme: StabilityScheme, map: Option<usize>| -> Vec<&MapCell> {
        let scheme_cells = cells.iter().filter(|cell| cell.scheme == scheme);
        scheme_cells
            .filter(|cell| match map {
                Some(map) => cell.map == map,
                None => maps[cell.map].name != SCHEME_MAP,
            })
            .collect()
    };
    let other_maps = maps.iter().enumerate().filter(|(_, map)| map.name != SCHEME_MAP);
    let names = other_maps.map(|(index, map)| (map.name, Some(index)));
    for (name, map) in names.chain([("**all**", None)]) {
        let crate_cells = select(StabilityScheme::Basemat, map);
        let _ = write!(
            text,
            "| {name} | {} | {:.1e} | {:.1e} | {:.1e} | {:.0} ",
            verdicts(&crate_cells),
            largest(&crate_cells, |cell| cell.outcome.energy_balance[0]),
            largest(&crate_cells, |cell| cell.outcome.energy_balance[1]),
            largest(&crate_cells, |cell| cell.outcome.rise),
            largest(&crate_cells, |cell| cell.outcome.trials[1]),
        );
        for scheme in [StabilityScheme::Paper, StabilityScheme::Quadrature] {
            let map_cells = if map.is_some() { select(scheme, map) } else { Vec::new() };
            let _ = write!(text, "| {} ", verdicts(&map_cells));
        }
        text.push_str("|\n");
    }
    text.push_str(&long_runs(maps, cells));
    text
}

/// Long runs one by one.
fn long_runs(maps: &[StabilityMap], cells: &[MapCell]) -> String {
    let mut text = String::new();
    for (index, map) in maps.iter().enumerate().filter(|(_, map)| !map.drawn) {
        let _ = write!(
            text,
            "\n{}, and then as many of rest (at most 100 000):\n\n\
             | case | steps | verdict | energy_balance residual | rise of energy | solves per step: mean | \
             most | mode changes |\n|---|---|---|---|---|---|---|---|\n",
            map.title
        );
        for cell in cells.iter().filter(|cell| cell.map == index) {
            let outcome = &cell.outcome;
            let _ = writeln!(
                text,
                "| {} | {} | {} | {:.1e} | {:.1e} | {:.2} | {:.0} | {} |",
                map.y.labels[cell.place[1]],
                outcome.steps,
                outcome.verdict.name(),
                outcome.energy_balance[0],
                outcome.rise,
                outcome.trials[0],
                outcome.trials[1],
                outcome.mode_changes
            );
        }
    }
    text
}

/// Results of the time schemes on the crate's soil.
pub(crate) fn schemes(maps: &[StabilityMap], cells: &[MapCell]) -> String {
    let mut text = String::from(
        "| time scheme | cells | most energy made by the scheme | cells beyond 2 % | beyond 50 % | \
         energy error |\n|---|---|---|---|---|---|\n",
    );
    for (index, map) in maps.iter().enumerate().filter(|(_, map)| map.name == SCHEME_MAP) {
        for (&scheme, name) in map.schemes.iter().zip([
            "midpoint rule",
            "dissipative midpoint rule, γ = 0.8",
            "Newmark, average acceleration",
            "HHT-α, α = −0.1",
        ]) {
            let scheme_cells: Vec<&MapCell> =
                cells.iter().filter(|cell| cell.map == index && cell.scheme == scheme).collect();
            let beyond = |limit: f64| {
                scheme_cells.iter().filter(|cell| cell.outcome.created_energy > limit).count()
            };
            let _ = writeln!(
                text,
                "| {name} | {} | {:.1e} | {} | {} | {:.1e} |",
                verdicts(&scheme_cells),
                largest(&scheme_cells, |cell| cell.outcome.created_energy),
                beyond(0.02),
                beyond(0.5),
                largest(&scheme_cells, |cell| cell.outcome.energy_balance[1]),
            );
        }
    }
    text
}

/// Number of cells of each verdict, as text.
fn verdicts(cells: &[&MapCell]) -> String {
    let counts = Verdict::ALL_VERDICTS.into_iter().filter_map(|verdict| {
        let count = count_verdicts(cells, verdict);
        (count > 0).then(|| format!("{count} {}", verdict.name()))
    });
    let text = counts.collect::<Vec<_>>().join(", ");
    if text.is_empty() { "–".into() } else { text }
}

/// The cells of the crate's schemes that violate their guarantees, one per line.
pub(crate) fn broken(maps: &[StabilityMap], cells: &[MapCell]) -> String {
    let mut text = String::new();
    let passive = cells.iter().filter(|cell| cell.scheme.is_passive());
    for cell in passive.filter(|cell| !cell.outcome.is_as_guaranteed(maps[cell.map].allowed)) {
        let map = &maps[cell.map];
        let outcome = &cell.outcome;
        let _ = write!(
            text,
            "\n--map {} --x {} --y {}: {} (energy balance {:.1e} of {ENERGY_ROUNDING:.0e}, rise {:.1e}, least work \
             on the soil {:.1e})",
            map.name,
            map.x.labels[cell.place[0]],
            map.y.labels[cell.place[1]],
            outcome.verdict.name(),
            outcome.energy_balance[0],
            outcome.rise,
            outcome.smallest_soil_work
        );
        if let Some(error) = &outcome.error {
            let _ = write!(text, ": {error}");
        }
    }
    if text.is_empty() { text } else { format!("not as guaranteed:{text}") }
}

/// Predictions for the full-plane schemes and their outcome, one count per cell.
fn assessments(maps: &[StabilityMap], cells: &[MapCell]) -> String {
    let mut text = String::from(
        "\n| sweep | scheme | assessed | growth foretold: of these grew or failed | were active | \
         stayed bounded | no growth foretold: grew or failed | active | bounded |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for (index, map) in maps.iter().enumerate() {
        for &scheme in map.schemes.iter().filter(|scheme| !scheme.is_half_plane()) {
            let outcomes: Vec<_> = cells
                .iter()
                .filter(|cell| cell.map == index && cell.scheme == scheme)
                .map(|cell| &cell.outcome)
                .filter(|outcome| outcome.assessed.is_some())
                .collect();
            let _ = write!(text, "| {} | {} | {} ", map.name, scheme.name(), outcomes.len());
            for growth in [true, false] {
                let count = |verdicts: &[Verdict]| {
                    let assessed =
                        outcomes.iter().filter(|outcome| outcome.is_unstable() == growth);
                    assessed.filter(|outcome| verdicts.contains(&outcome.verdict)).count()
                };
                let bad_count = count(&[Verdict::Grows, Verdict::Failed, Verdict::Refused]);
                let active = count(&[Verdict::Active]);
                let _ = write!(text, "| {bad_count} | {active} | {} ", count(&[Verdict::Bounded]));
            }
            text.push_str("|\n");
        }
    }
    text
}
