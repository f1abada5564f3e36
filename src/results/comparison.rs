//! Comparison of several cases in one table.

use std::fmt;

use super::{ProbeExtremes, Quantity, Run, ServiceCheck};
use crate::coupled::EnergyTerm;
use crate::coupled::run::page::safety_text;
use crate::coupled::run::quantity_row::ShownIn;
use crate::text::column::{NumberCell, column, distinct};
use crate::text::csv::Csv;
use crate::text::readable_number::{number, printed_unit, whole_body_unit};
use crate::text::table::Table;

/// Runs side by side in one table.
///
/// It prints a row per quantity and a column per case, in blocks of as many cases as fit into 100 characters.
///
/// ```no_run
/// # fn runs() -> Vec<(f64, basemat::results::Run)> { vec![] }
/// use basemat::results::Comparison;
/// let named = runs().into_iter().map(|(friction, run)| (format!("friction {friction}"), run));
/// let comparison: Comparison = named.collect();
/// println!("{comparison}");
/// comparison.csv().save("cases.csv")?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Comparison {
    /// Name and run of each case.
    pub cases: Vec<(String, Run)>,
}

/// Function that returns a value of a run; `None` if the run does not have the value.
type RunValue = dyn Fn(&Run) -> Option<f64>;

/// A row of the comparison.
///
/// If runs in the plane and in plan are compared, a result with other units in plan has a row for each.
struct ComparisonRow {
    name: String,
    unit: &'static str,
    /// Heading in files.
    column: String,
    /// Factor from the SI unit to `unit`.
    factor: f64,
    value: Box<RunValue>,
}

impl ComparisonRow {
    fn cell(&self, run: &Run) -> String {
        match (self.value)(run) {
            None => "–".to_owned(),
            Some(value) if self.column.ends_with("safety") => safety_text(value),
            Some(value) if self.column == "slip_events" => format!("{value:.0}"),
            Some(value) => number(self.factor * value),
        }
    }
}

/// Result derived from one or several quantities: name, unit, column, factor and value.
type DerivedResult = (&'static str, &'static str, &'static str, f64, fn(&Run) -> Option<f64>);

const DERIVED_RESULTS: [DerivedResult; 10] = [
    ("shear over weight", "", "base_shear_over_weight", 1.0, Run::shear_coefficient),
    ("mean slip, residual", "mm", "residual_slip_m", 1e3, |run| Some(run.whole.residual_slip)),
    ("mean slip across, residual", "mm", "residual_slip_across_m", 1e3, |run| {
        run.in_plan.then_some(run.whole.residual_slip_across)
    }),
    ("settlement, residual", "mm", "residual_settlement_m", 1e3, |run| {
        Some(run.whole.residual_settlement)
    }),
    ("slip events", "", "slip_events", 1.0, |run| Some(run.slip_events() as f64)),
    ("uplifted for", "s", "uplift_duration_s", 1.0, |run| Some(run.whole.uplift.duration)),
    ("largest gap", "mm", "largest_gap_m", 1e3, |run| Some(run.largest_gap().value)),
    ("largest pressure", "kPa", "largest_pressure_pa", 1e-3, |run| {
        run.largest_pressure().map(|(_, peak)| peak.value)
    }),
    ("serviceability, margin", "%", "serviceability_margin", 100.0, |run| {
        run.check_with_smallest_margin().map(ServiceCheck::margin)
    }),
    ("  first excess at", "s", "serviceability_first_excess_s", 1.0, |run| {
        run.serviceability.iter().filter_map(|check| check.first_excess).reduce(f64::min)
    }),
];

/// Makes all rows: quantities, some with their times, then derived results and energies.
///
/// `run_kinds`: `true` for runs in plan, `false` for runs in the plane.
fn comparison_rows(run_kinds: &[bool]) -> Vec<ComparisonRow> {
    let has_plan_runs = run_kinds.contains(&true);
    let mut rows = Vec::new();
    for quantity in Quantity::shown(ShownIn::Comparison, has_plan_runs) {
        let has_one_unit = quantity.unit(true) == quantity.unit(false);
        let is_in_plan_only = quantity.is_shown(ShownIn::Plan);
        let kinds_with_quantity = run_kinds.iter().filter(|in_plan| **in_plan || !is_in_plan_only);
        for &in_plan in kinds_with_quantity.take(if has_one_unit { 1 } else { 2 }) {
            let value = move |run: &Run| {
                let has_value = run.in_plan == in_plan || has_one_unit && !is_in_plan_only;
                let peak = run.whole.peak(quantity).value;
                Some(peak).filter(|peak| has_value && !peak.is_nan())
            };
            let unit = quantity.printed_unit(in_plan);
            rows.push(ComparisonRow {
                name: quantity.short_name(),
                unit: unit.symbol,
                column: quantity.column(in_plan),
                factor: unit.factor,
                value: Box::new(value),
            });
        }
        if quantity.is_shown(ShownIn::ComparisonTime) {
            rows.push(ComparisonRow {
                name: "  at".to_owned(),
                unit: "s",
                column: format!("{quantity}_time_s"),
                factor: 1.0,
                value: Box::new(move |run: &Run| {
                    let has_value = run.in_plan || !is_in_plan_only;
                    Some(run.whole.peak(quantity).time).filter(|_| has_value)
                }),
            });
        }
    }
    for (name, unit, column, factor, value) in DERIVED_RESULTS {
        if has_plan_runs || !column.contains("across") {
            rows.push(ComparisonRow {
                name: name.to_owned(),
                unit,
                column: column.to_owned(),
                factor,
                value: Box::new(value),
            });
        }
    }
    rows.extend(run_kinds.iter().map(|&in_plan| energy_input_row(in_plan)));
    let lost_terms = EnergyTerm::ALL_TERMS.into_iter().filter(|term| term.is_lost());
    rows.extend(lost_terms.map(energy_fraction_row));
    rows
}

/// Row of the energy input of the runs in the plane or in plan.
fn energy_input_row(in_plan: bool) -> ComparisonRow {
    ComparisonRow {
        name: "energy input".to_owned(),
        unit: whole_body_unit("kJ/m", in_plan),
        column: EnergyTerm::Input.column(in_plan),
        factor: 1e-3,
        value: Box::new(move |run: &Run| {
            Some(run.energy_balance.input).filter(|_| run.in_plan == in_plan)
        }),
    }
}

/// Row of a fraction of the energy input.
fn energy_fraction_row(term: EnergyTerm) -> ComparisonRow {
    ComparisonRow {
        name: format!("  {}", term.name()),
        unit: "%",
        column: format!("energy_fraction_{term}"),
        factor: 100.0,
        value: Box::new(move |run: &Run| {
            run.energy_balance.fraction(term).filter(|fraction| *fraction != 0.0)
        }),
    }
}

impl Comparison {
    /// Adds a case; names need not be distinct.
    pub fn add(&mut self, name: impl Into<String>, run: Run) {
        self.cases.push((name.into(), run));
    }

    /// Rows of the comparison, for the kinds of runs among its cases.
    fn rows(&self) -> Vec<ComparisonRow> {
        let mut run_kinds = Vec::new();
        for in_plan in [false, true] {
            if self.cases.iter().any(|(_, run)| run.in_plan == in_plan) {
                run_kinds.push(in_plan);
            }
        }
        comparison_rows(if run_kinds.is_empty() { &[false] } else { &run_kinds })
    }

    fn table(&self) -> Table {
        let mut heading = vec![String::new(), "unit".to_owned()];
        heading.extend(self.cases.iter().map(|(name, _)| name.clone()));
        let mut rows = Vec::new();
        for row in self.rows() {
            // A quantity without a value in any case has no row.
            let has_value = self.cases.iter().any(|(_, run)| (row.value)(run).is_some());
            if has_value || self.cases.is_empty() {
                let mut cells = vec![row.name.clone(), row.unit.to_owned()];
                cells.extend(self.cases.iter().map(|(_, run)| row.cell(run)));
                rows.push(cells);
            }
        }
        for (k, probe) in self.common_probes().iter().enumerate() {
            let unit = printed_unit(&probe.unit);
            let mut cells = vec![probe.name.clone(), unit.symbol.to_owned()];
            for (_, run) in &self.cases {
                let cell = run.probes.get(k).map_or("–".to_owned(), |probe| {
                    number(unit.factor * probe.extremes.largest().value)
                });
                cells.push(cell);
            }
            rows.push(cells);
        }
        Table { heading, repeated_column_count: 2, rows }
    }

    /// Probes of the first case, if all cases have the same probes.
    fn common_probes(&self) -> &[ProbeExtremes] {
        fn labels(run: &Run) -> impl Iterator<Item = (&str, &str)> {
            run.probes.iter().map(|probe| (&probe.name[..], &probe.unit[..]))
        }
        let Some(((_, first_run), other_cases)) = self.cases.split_first() else {
            return &[];
        };
        let are_same = other_cases.iter().all(|(_, run)| labels(run).eq(labels(first_run)));
        if are_same { &first_run.probes } else { &[] }
    }

    /// The table as Markdown.
    pub fn markdown(&self) -> String {
        self.table().markdown()
    }

    /// One line per case and one column per quantity, in SI units (probes in their own units).
    ///
    /// Columns and numbers follow the [rule](super) for all files; a cell is empty if a case has no value.
    pub fn csv(&self) -> Csv {
        let mut heading = vec!["case".to_owned()];
        let rows = self.rows();
        heading.extend(rows.iter().map(|row| row.column.clone()));
        let probes = self.common_probes();
        let columns = probes.iter().map(|probe| column(&probe.name, &probe.unit));
        heading.extend(distinct(&heading, columns));
        let mut lines = Vec::new();
        for (name, run) in &self.cases {
            let mut cells = vec![name.clone()];
            for row in &rows {
                cells.push(NumberCell((row.value)(run).unwrap_or(f64::NAN)).to_string());
            }
            for probe in run.probes.iter().take(probes.len()) {
                cells.push(NumberCell(probe.extremes.largest().value).to_string());
            }
            lines.push(cells);
        }
        Csv(Table { heading, repeated_column_count: 1, rows: lines }.csv())
    }
}

impl<S: Into<String>> FromIterator<(S, Run)> for Comparison {
    fn from_iter<I: IntoIterator<Item = (S, Run)>>(cases: I) -> Self {
        let mut comparison = Self::default();
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
