//! CSV file and tables in Markdown.

use std::fmt::Write as _;
use std::path::Path;

use super::axes::{Map, SCHEME_MAP};
use super::run::{Cell, ROUNDING, Verdict};
use super::scene::Scheme;
use crate::AnyError;
use crate::document::write_csv;

/// Writes every cell.
pub(crate) fn write_cells(path: &Path, maps: &[Map], cells: &[Cell]) -> Result<(), AnyError> {
    let rows = cells.iter().map(|cell| {
        let (map, out) = (&maps[cell.map], &cell.outcome);
        let short = |x: f64| format!("{x:.3e}");
        [
            map.name.to_owned(),
            cell.scheme.name().to_owned(),
            map.x.name.to_owned(),
            map.x.labels[cell.place[0]].clone(),
            map.y.name.to_owned(),
            map.y.labels[cell.place[1]].clone(),
            out.verdict.name().to_owned(),
            short(out.energy_balance[0]),
            short(out.energy_balance[1]),
            short(out.growth),
            short(out.growth_per_step),
            out.assessed.map(|growth| short(growth[0])).unwrap_or_default(),
            out.assessed.map(|growth| short(growth[1])).unwrap_or_default(),
            short(out.rise),
            short(out.least_soil),
            short(out.made),
            format!("{:.2}", out.trials[0]),
            format!("{:.0}", out.trials[1]),
            out.fallbacks[0].to_string(),
            out.fallbacks[1].to_string(),
            out.mode_changes.to_string(),
            format!("{:.2}", out.largest_uplift),
            out.steps.to_string(),
            out.error.as_ref().map(ToString::to_string).unwrap_or_default(),
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
pub(crate) fn tables(maps: &[Map], cells: &[Cell]) -> String {
    let mut text = String::from(
        "| sweep | scheme | cells | steps | bounded | active | grows | refused | failed | \
         energy_balance residual, end | on the way | rise of energy | solves per step: mean | most | \
         steps by Gauss–Seidel | by path |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (index, map) in maps.iter().enumerate() {
        for &scheme in map.schemes {
            let own: Vec<_> =
                cells.iter().filter(|c| c.map == index && c.scheme == scheme).collect();
            if !own.is_empty() {
                summary(&mut text, map.name, scheme, &own);
            }
        }
    }
    let all: Vec<_> = cells.iter().filter(|cell| cell.scheme == Scheme::Own).collect();
    if !all.is_empty() {
        summary(&mut text, "**all**", Scheme::Own, &all);
    }
    if cells.iter().any(|cell| cell.outcome.assessed.is_some()) {
        text.push_str(&foretold(maps, cells));
    }
    text.push_str(&long_runs(maps, cells));
    text
}

fn summary(text: &mut String, name: &str, scheme: Scheme, cells: &[&Cell]) {
    let count = |verdict: Verdict| cells.iter().filter(|c| c.outcome.verdict == verdict).count();
    let steps: usize = cells.iter().map(|c| c.outcome.steps).sum();
    let most = |pick: &dyn Fn(&Cell) -> f64| cells.iter().map(|c| pick(c)).fold(0.0, f64::max);
    let solves: f64 = cells.iter().map(|c| c.outcome.trials[0] * c.outcome.steps as f64).sum();
    let fallbacks = |k: usize| cells.iter().map(|c| c.outcome.fallbacks[k]).sum::<usize>();
    let _ = write!(text, "| {name} | {} | {} | {steps} ", scheme.name(), cells.len());
    for verdict in Verdict::ALL {
        let _ = write!(text, "| {} ", count(verdict));
    }
    let rise = if scheme.is_passive() {
        format!("{:.1e}", most(&|c| c.outcome.rise))
    } else {
        "–".into()
    };
    let _ = writeln!(
        text,
        "| {:.1e} | {:.1e} | {rise} | {:.2} | {:.0} | {} | {} |",
        most(&|c| c.outcome.energy_balance[0]),
        most(&|c| c.outcome.energy_balance[1]),
        solves / steps.max(1) as f64,
        most(&|c| c.outcome.trials[1]),
        fallbacks(0),
        fallbacks(1)
    );
}

/// The share of [`tables`] that the document shows: verdicts of each scheme, figures of the
/// crate's own, and the long runs.
pub(crate) fn document(maps: &[Map], cells: &[Cell]) -> String {
    let mut text = String::from(
        "| sweep | basemat | energy error: end | on the way | rise of energy | most solves in a \
         step | paper | quadrature |\n|---|---|---|---|---|---|---|---|\n",
    );
    let of = |scheme: Scheme, map: Option<usize>| -> Vec<&Cell> {
        let all = cells.iter().filter(|cell| cell.scheme == scheme);
        let others = |cell: &&Cell| maps[cell.map].name != SCHEME_MAP;
        all.filter(|cell| map.map_or(others(cell), |map| cell.map == map)).collect()
    };
    let others = maps.iter().enumerate().filter(|(_, map)| map.name != SCHEME_MAP);
    let names = others.map(|(index, map)| (map.name, Some(index)));
    for (name, map) in names.chain([("**all**", None)]) {
        let own = of(Scheme::Own, map);
        let most = |pick: &dyn Fn(&Cell) -> f64| own.iter().map(|c| pick(c)).fold(0.0, f64::max);
        let _ = write!(
            text,
            "| {name} | {} | {:.1e} | {:.1e} | {:.1e} | {:.0} ",
            verdicts(&own),
            most(&|c| c.outcome.energy_balance[0]),
            most(&|c| c.outcome.energy_balance[1]),
            most(&|c| c.outcome.rise),
            most(&|c| c.outcome.trials[1]),
        );
        for scheme in [Scheme::Paper, Scheme::Quadrature] {
            let of_map = if map.is_some() { of(scheme, map) } else { Vec::new() };
            let _ = write!(text, "| {} ", verdicts(&of_map));
        }
        text.push_str("|\n");
    }
    text.push_str(&long_runs(maps, cells));
    text
}

/// Long runs one by one.
fn long_runs(maps: &[Map], cells: &[Cell]) -> String {
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
            let out = &cell.outcome;
            let _ = writeln!(
                text,
                "| {} | {} | {} | {:.1e} | {:.1e} | {:.2} | {:.0} | {} |",
                map.y.labels[cell.place[1]],
                out.steps,
                out.verdict.name(),
                out.energy_balance[0],
                out.rise,
                out.trials[0],
                out.trials[1],
                out.mode_changes
            );
        }
    }
    text
}

/// Results of the time schemes on the crate's soil.
pub(crate) fn schemes(maps: &[Map], cells: &[Cell]) -> String {
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
            let own: Vec<&Cell> =
                cells.iter().filter(|cell| cell.map == index && cell.scheme == scheme).collect();
            let most =
                |pick: &dyn Fn(&Cell) -> f64| own.iter().map(|c| pick(c)).fold(0.0, f64::max);
            let beyond = |made: f64| own.iter().filter(|cell| cell.outcome.made > made).count();
            let _ = writeln!(
                text,
                "| {name} | {} | {:.1e} | {} | {} | {:.1e} |",
                verdicts(&own),
                most(&|cell| cell.outcome.made),
                beyond(0.02),
                beyond(0.5),
                most(&|cell| cell.outcome.energy_balance[1]),
            );
        }
    }
    text
}

/// Number of cells of each verdict, in words.
fn verdicts(cells: &[&Cell]) -> String {
    let counts = Verdict::ALL.into_iter().filter_map(|verdict| {
        let count = cells.iter().filter(|cell| cell.outcome.verdict == verdict).count();
        (count > 0).then(|| format!("{count} {}", verdict.name()))
    });
    let text = counts.collect::<Vec<_>>().join(", ");
    if text.is_empty() { "–".into() } else { text }
}

/// The cells of the crate's own scheme that are not as they must be, one a line.
pub(crate) fn broken(maps: &[Map], cells: &[Cell]) -> String {
    let mut text = String::new();
    let own = cells.iter().filter(|cell| cell.scheme.is_passive());
    for cell in own.filter(|cell| !cell.outcome.is_as_guaranteed(maps[cell.map].allowed)) {
        let (map, out) = (&maps[cell.map], &cell.outcome);
        let _ = write!(
            text,
            "\n--map {} --x {} --y {}: {} (energy balance {:.1e} of {ROUNDING:.0e}, rise {:.1e}, least work \
             on the soil {:.1e})",
            map.name,
            map.x.labels[cell.place[0]],
            map.y.labels[cell.place[1]],
            out.verdict.name(),
            out.energy_balance[0],
            out.rise,
            out.least_soil
        );
        if let Some(error) = &out.error {
            let _ = write!(text, ": {error}");
        }
    }
    if text.is_empty() { text } else { format!("not as guaranteed:{text}") }
}

/// Predictions for the full-plane schemes and their outcome, each equation counted once a cell.
fn foretold(maps: &[Map], cells: &[Cell]) -> String {
    let mut text = String::from(
        "\n| sweep | scheme | assessed | growth foretold: of these grew or failed | were active | \
         stayed bounded | no growth foretold: grew or failed | active | bounded |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for (index, map) in maps.iter().enumerate() {
        for &scheme in map.schemes.iter().filter(|scheme| !scheme.is_half_plane()) {
            let own: Vec<_> = cells
                .iter()
                .filter(|c| c.map == index && c.scheme == scheme)
                .map(|c| &c.outcome)
                .filter(|out| out.assessed.is_some())
                .collect();
            let _ = write!(text, "| {} | {} | {} ", map.name, scheme.name(), own.len());
            for growth in [true, false] {
                let count = |verdicts: &[Verdict]| {
                    let those = own.iter().filter(|out| out.is_foretold() == growth);
                    those.filter(|out| verdicts.contains(&out.verdict)).count()
                };
                let bad = count(&[Verdict::Grows, Verdict::Failed, Verdict::Refused]);
                let active = count(&[Verdict::Active]);
                let _ = write!(text, "| {bad} | {active} | {} ", count(&[Verdict::Bounded]));
            }
            text.push_str("|\n");
        }
    }
    text
}
