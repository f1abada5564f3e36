//! Several cases in one table.

use std::fmt;
use std::path::Path;

use super::Summary;
use super::page::{factor, number};
use super::table::Table;
use crate::error::{Result, write_file};

/// Summaries side by side; prints as a table with a row per quantity and a column per case.
///
/// ```no_run
/// # fn summaries() -> Vec<(f64, basemat::results::Summary)> { vec![] }
/// use basemat::results::Comparison;
/// let mut comparison = Comparison::new();
/// for (friction, summary) in summaries() {
///     comparison.add(format!("friction {friction}"), summary);
/// }
/// println!("{comparison}");
/// comparison.save_csv("cases.csv")?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Comparison {
    cases: Vec<(String, Summary)>,
}

/// Name, unit and heading of a row, the factor from SI to the unit, and its value.
type Row = (&'static str, &'static str, &'static str, f64, fn(&Summary) -> Option<f64>);

const ROWS: [Row; 20] = [
    ("base shear", "kN/m", "base_shear_n_per_m", 1e-3, |s| Some(s.base_shear.largest().value)),
    ("  at", "s", "base_shear_time_s", 1.0, |s| Some(s.base_shear.largest().time)),
    ("  over weight", "", "base_shear_over_weight", 1.0, Summary::shear_coefficient),
    ("base moment", "kN·m/m", "base_moment_n_m_per_m", 1e-3, |s| {
        Some(s.base_moment.largest().value)
    }),
    ("  at", "s", "base_moment_time_s", 1.0, |s| Some(s.base_moment.largest().time)),
    ("largest pressure", "kPa", "largest_pressure_pa", 1e-3, |s| {
        s.largest_pressure().map(|(_, peak)| peak.value)
    }),
    ("base rotation", "mrad", "base_rotation_rad", 1e3, |s| Some(s.base_rotation.largest().value)),
    ("uplifted part", "%", "uplifted_fraction", 100.0, |s| Some(s.uplift.peak.value)),
    ("  for", "s", "uplift_duration_s", 1.0, |s| Some(s.uplift.duration)),
    ("largest gap", "mm", "largest_gap_m", 1e3, |s| Some(s.largest_gap().value)),
    ("mean slip, peak", "mm", "mean_slip_m", 1e3, |s| Some(s.sliding.peak.value)),
    ("mean slip, residual", "mm", "residual_slip_m", 1e3, |s| Some(s.sliding.residual)),
    ("slip events", "", "slip_events", 1.0, |s| Some(s.sliding.events.len() as f64)),
    ("safety, sliding", "", "sliding_safety", 1.0, |s| s.least_sliding_safety.map(|p| p.value)),
    ("safety, overturning", "", "overturning_safety", 1.0, |s| {
        Some(s.least_overturning_safety.value)
    }),
    ("energy input", "kJ/m", "energy_input_j_per_m", 1e-3, |s| Some(s.ledger.input)),
    ("  to the soil", "%", "energy_share_soil", 100.0, |s| s.energy.map(|e| e.soil)),
    ("  friction, impact", "%", "energy_share_contact", 100.0, |s| s.energy.map(|e| e.contact)),
    ("  hysteresis", "%", "energy_share_hysteresis", 100.0, |s| {
        s.energy.map(|e| e.hysteresis).filter(|share| *share != 0.0)
    }),
    ("  damping", "%", "energy_share_damping", 100.0, |s| s.energy.map(|e| e.damping)),
];

impl Comparison {
    /// No cases yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a case.
    pub fn add(&mut self, name: impl Into<String>, summary: Summary) {
        self.cases.push((name.into(), summary));
    }

    /// The cases, in the order they were added.
    pub fn cases(&self) -> &[(String, Summary)] {
        &self.cases
    }

    fn table(&self) -> Table {
        let mut heading = vec![String::new(), "unit".to_owned()];
        heading.extend(self.cases.iter().map(|(name, _)| name.clone()));
        let cell = |row: &Row, summary: &Summary| match (row.4)(summary) {
            None => "–".to_owned(),
            Some(value) if row.2.ends_with("safety") => factor(value),
            Some(value) if row.2 == "slip_events" => format!("{value:.0}"),
            Some(value) => number(row.3 * value),
        };
        let line = |row: &Row| {
            let mut cells = vec![row.0.to_owned(), row.1.to_owned()];
            cells.extend(self.cases.iter().map(|(_, summary)| cell(row, summary)));
            cells
        };
        // What no case has is no row.
        let known = |row: &&Row| {
            self.cases.is_empty() || self.cases.iter().any(|(_, s)| (row.4)(s).is_some())
        };
        let mut rows: Vec<_> = ROWS.iter().filter(known).map(line).collect();
        for (k, name) in self.probe_names().into_iter().enumerate() {
            let value = |summary: &Summary| {
                summary.probes.get(k).map_or("–".to_owned(), |(_, e)| number(e.largest().value))
            };
            let mut cells = vec![name, "SI".to_owned()];
            cells.extend(self.cases.iter().map(|(_, summary)| value(summary)));
            rows.push(cells);
        }
        Table { heading, rows }
    }

    /// Names of the probes, if all cases have the same ones.
    fn probe_names(&self) -> Vec<String> {
        let names = |summary: &Summary| {
            summary.probes.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>()
        };
        let mut all = self.cases.iter().map(|(_, summary)| names(summary));
        let first = all.next().unwrap_or_default();
        if all.all(|other| other == first) { first } else { Vec::new() }
    }

    /// The table as Markdown.
    pub fn markdown(&self) -> String {
        self.table().markdown()
    }

    /// Writes the table of [`Comparison::csv`] to a file; its folder is made if it is not there.
    ///
    /// # Errors
    /// [`Error::Write`](crate::Error::Write) if that fails.
    pub fn save_csv(&self, path: impl AsRef<Path>) -> Result<()> {
        write_file(path.as_ref(), self.csv())
    }

    /// A line per case and a column per quantity, in SI units and full precision; empty where a
    /// case has no value.
    pub fn csv(&self) -> String {
        let mut heading = vec!["case".to_owned()];
        heading.extend(ROWS.iter().map(|row| row.2.to_owned()));
        heading.extend(self.probe_names());
        let probes = self.probe_names().len();
        let line = |(name, summary): &(String, Summary)| {
            let values = ROWS.iter().map(|row| (row.4)(summary));
            let peaks = summary.probes.iter().take(probes).map(|(_, e)| Some(e.largest().value));
            let cells = values.chain(peaks).map(|v| v.map_or(String::new(), |v| v.to_string()));
            std::iter::once(name.clone()).chain(cells).collect()
        };
        Table { heading, rows: self.cases.iter().map(line).collect() }.csv()
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.table().text())
    }
}
