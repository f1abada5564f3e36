//! Several cases in one table.

use std::fmt;
use std::path::Path;

use super::page::factor;
use super::table::Table;
use super::unit::{number, printed};
use super::{ProbeExtremes, Run, ServiceCheck};
use crate::column::{Cell, column, distinct};
use crate::error::{Result, write_file};

/// Runs side by side; prints as a table with a row per quantity and a column per case, in blocks of
/// as many cases as lines below 100 characters hold.
///
/// ```no_run
/// # fn runs() -> Vec<(f64, basemat::results::Run)> { vec![] }
/// use basemat::results::Comparison;
/// let named = runs().into_iter().map(|(friction, run)| (format!("friction {friction}"), run));
/// let comparison: Comparison = named.collect();
/// println!("{comparison}");
/// comparison.save_csv("cases.csv")?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Comparison {
    cases: Vec<(String, Run)>,
}

/// Name, unit and heading of a row, the factor from SI to the unit, and its value.
type Line = (&'static str, &'static str, &'static str, f64, fn(&Run) -> Option<f64>);

const ROWS: [Line; 22] = [
    ("base shear", "kN/m", "base_shear_n_per_m", 1e-3, |s| Some(s.base_shear.largest().value)),
    ("  at", "s", "base_shear_time_s", 1.0, |s| Some(s.base_shear.largest().time)),
    ("  over weight", "", "base_shear_over_weight", 1.0, Run::shear_coefficient),
    ("base moment", "kN·m/m", "base_moment_n_m_per_m", 1e-3, |s| {
        Some(s.base_moment.largest().value)
    }),
    ("  at", "s", "base_moment_time_s", 1.0, |s| Some(s.base_moment.largest().time)),
    ("largest pressure", "kPa", "largest_pressure_pa", 1e-3, |s| {
        s.largest_pressure().map(|(_, peak)| peak.value)
    }),
    ("base rotation", "mrad", "base_rotation_rad", 1e3, |s| Some(s.base_rotation.largest().value)),
    ("uplifted part", "%", "uplifted_fraction", 100.0, |s| Some(s.uplifted_fraction.value)),
    ("  for", "s", "uplift_duration_s", 1.0, |s| Some(s.uplift.duration)),
    ("largest gap", "mm", "largest_gap_m", 1e3, |s| Some(s.largest_gap().value)),
    ("mean slip, peak", "mm", "mean_slip_m", 1e3, |s| Some(s.mean_slip.largest().value)),
    ("mean slip, residual", "mm", "residual_slip_m", 1e3, |s| Some(s.residual_slip)),
    ("slip events", "", "slip_events", 1.0, |s| Some(s.slip_events() as f64)),
    ("safety, sliding", "", "sliding_safety", 1.0, |s| s.least_sliding_safety().map(|p| p.value)),
    ("safety, overturning", "", "overturning_safety", 1.0, |s| {
        Some(s.least_overturning_safety().value)
    }),
    ("serviceability, margin", "%", "serviceability_margin", 100.0, |s| {
        s.least_serviceable().map(ServiceCheck::margin)
    }),
    ("  first excess at", "s", "serviceability_first_excess_s", 1.0, |s| {
        s.serviceability.iter().filter_map(|check| check.first_excess).reduce(f64::min)
    }),
    ("energy input", "kJ/m", "input_energy_j_per_m", 1e-3, |s| Some(s.ledger.input)),
    ("  to the soil", "%", "energy_share_soil", 100.0, |s| s.energy().map(|e| e.soil)),
    ("  friction, impact", "%", "energy_share_contact", 100.0, |s| s.energy().map(|e| e.contact)),
    ("  hysteresis", "%", "energy_share_hysteresis", 100.0, |s| {
        s.energy().map(|e| e.hysteresis).filter(|share| *share != 0.0)
    }),
    ("  damping", "%", "energy_share_damping", 100.0, |s| s.energy().map(|e| e.damping)),
];

impl Comparison {
    /// No cases yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a case.
    pub fn add(&mut self, name: impl Into<String>, run: Run) {
        self.cases.push((name.into(), run));
    }

    /// The cases, in the order they were added.
    pub fn cases(&self) -> &[(String, Run)] {
        &self.cases
    }

    fn table(&self) -> Table {
        let mut heading = vec![String::new(), "unit".to_owned()];
        heading.extend(self.cases.iter().map(|(name, _)| name.clone()));
        let cell = |row: &Line, run: &Run| match (row.4)(run) {
            None => "–".to_owned(),
            Some(value) if row.2.ends_with("safety") => factor(value),
            Some(value) if row.2 == "slip_events" => format!("{value:.0}"),
            Some(value) => number(row.3 * value),
        };
        let line = |row: &Line| {
            let mut cells = vec![row.0.to_owned(), row.1.to_owned()];
            cells.extend(self.cases.iter().map(|(_, run)| cell(row, run)));
            cells
        };
        // What no case has is no row.
        let known = |row: &&Line| {
            self.cases.is_empty() || self.cases.iter().any(|(_, s)| (row.4)(s).is_some())
        };
        let mut rows: Vec<_> = ROWS.iter().filter(known).map(line).collect();
        for (k, probe) in self.common_probes().iter().enumerate() {
            let (factor, unit) = printed(&probe.unit);
            let value = |run: &Run| {
                let own = run.probes.get(k).map(|own| own.extremes.largest().value);
                own.map_or("–".to_owned(), |value| number(factor * value))
            };
            let mut cells = vec![probe.name.clone(), unit.to_owned()];
            cells.extend(self.cases.iter().map(|(_, run)| value(run)));
            rows.push(cells);
        }
        Table { heading, repeated: 2, rows }
    }

    /// Probes of the first case, if all cases have the same ones.
    fn common_probes(&self) -> &[ProbeExtremes] {
        fn labels(run: &Run) -> impl Iterator<Item = (&str, &str)> {
            run.probes.iter().map(|probe| (&probe.name[..], &probe.unit[..]))
        }
        let Some(((_, first), others)) = self.cases.split_first() else { return &[] };
        let same = others.iter().all(|(_, other)| labels(other).eq(labels(first)));
        if same { &first.probes } else { &[] }
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

    /// A line per case and a column per quantity, in SI units (probes in their own): columns and numbers
    /// as the [module](super) has them for all files; empty where a case has no value.
    pub fn csv(&self) -> String {
        let mut heading = vec!["case".to_owned()];
        heading.extend(ROWS.iter().map(|row| row.2.to_owned()));
        let probes = self.common_probes();
        let columns = probes.iter().map(|probe| column(&probe.name, &probe.unit));
        heading.extend(distinct(&heading, columns));
        let line = |(name, run): &(String, Run)| {
            let values = ROWS.iter().map(|row| (row.4)(run));
            let own = run.probes.iter().take(probes.len());
            let peaks = own.map(|probe| Some(probe.extremes.largest().value));
            let cells = values.chain(peaks).map(|v| Cell(v.unwrap_or(f64::NAN)).to_string());
            std::iter::once(name.clone()).chain(cells).collect()
        };
        Table { heading, repeated: 1, rows: self.cases.iter().map(line).collect() }.csv()
    }
}

impl<S: Into<String>> FromIterator<(S, Run)> for Comparison {
    fn from_iter<I: IntoIterator<Item = (S, Run)>>(cases: I) -> Self {
        let mut comparison = Self::new();
        comparison.extend(cases);
        comparison
    }
}

impl<S: Into<String>> Extend<(S, Run)> for Comparison {
    fn extend<I: IntoIterator<Item = (S, Run)>>(&mut self, cases: I) {
        self.cases.extend(cases.into_iter().map(|(name, run)| (name.into(), run)));
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.table().text())
    }
}
