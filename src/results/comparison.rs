//! Comparison of several cases in one table.

use std::fmt;

use super::{ProbeExtremes, Quantity, Run, ServiceCheck};
use crate::coupled::EnergyTerm;
use crate::coupled::run::page::factor;
use crate::coupled::run::quantity::ShownIn;
use crate::text::column::{NumberCell, column, distinct};
use crate::text::csv::Csv;
use crate::text::readable_number::{number, of_body, printed};
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
type Value = dyn Fn(&Run) -> Option<f64>;

/// A row: name and unit, heading in files, factor from SI to the unit, and the value of a run.
///
/// If runs in the plane and in plan are compared, a result with other units in plan has a row for each.
struct Line {
    name: String,
    unit: &'static str,
    column: String,
    factor: f64,
    value: Box<Value>,
}

impl Line {
    fn cell(&self, run: &Run) -> String {
        match (self.value)(run) {
            None => "–".to_owned(),
            Some(value) if self.column.ends_with("safety") => factor(value),
            Some(value) if self.column == "slip_events" => format!("{value:.0}"),
            Some(value) => number(self.factor * value),
        }
    }
}

/// Result derived from one or several quantities: name, unit, column, factor and value.
type Derived = (&'static str, &'static str, &'static str, f64, fn(&Run) -> Option<f64>);

const DERIVED: [Derived; 9] = [
    ("shear over weight", "", "base_shear_over_weight", 1.0, Run::shear_coefficient),
    ("mean slip, residual", "mm", "residual_slip_m", 1e3, |s| Some(s.whole.residual_slip)),
    ("mean slip across, residual", "mm", "residual_slip_across_m", 1e3, |s| {
        s.in_plan.then_some(s.whole.residual_slip_across)
    }),
    ("slip events", "", "slip_events", 1.0, |s| Some(s.slip_events() as f64)),
    ("uplifted for", "s", "uplift_duration_s", 1.0, |s| Some(s.whole.uplift.duration)),
    ("largest gap", "mm", "largest_gap_m", 1e3, |s| Some(s.largest_gap().value)),
    ("largest pressure", "kPa", "largest_pressure_pa", 1e-3, |s| {
        s.largest_pressure().map(|(_, peak)| peak.value)
    }),
    ("serviceability, margin", "%", "serviceability_margin", 100.0, |s| {
        s.least_serviceable().map(ServiceCheck::margin)
    }),
    ("  first excess at", "s", "serviceability_first_excess_s", 1.0, |s| {
        s.serviceability.iter().filter_map(|check| check.first_excess).reduce(f64::min)
    }),
];

/// Makes all rows: quantities, some with their times, then derived results.
///
/// `of`: dimensions of the runs, `true` for in plan.
fn lines(of: &[bool]) -> Vec<Line> {
    let mut lines = Vec::new();
    for quantity in Quantity::shown(ShownIn::Comparison, of.contains(&true)) {
        let peak = move |run: &Run| run.whole.peak(quantity);
        let of_all = quantity.unit(true) == quantity.unit(false);
        let in_plan_only = quantity.is_shown(ShownIn::Plan);
        let dimensions = of.iter().filter(|in_plan| **in_plan || !in_plan_only);
        for &in_plan in dimensions.take(if of_all { 1 } else { 2 }) {
            let has = move |run: &Run| run.in_plan == in_plan || of_all && !in_plan_only;
            let known = move |run: &Run| Some(peak(run).value).filter(|x| has(run) && !x.is_nan());
            let (factor, unit) = quantity.printed(in_plan);
            let (name, column) = (quantity.short_name(), quantity.column(in_plan));
            lines.push(Line { name, unit, column, factor, value: Box::new(known) });
        }
        if quantity.is_shown(ShownIn::ComparisonTime) {
            let has = move |run: &Run| run.in_plan || !in_plan_only;
            let time = move |run: &Run| Some(peak(run).time).filter(|_| has(run));
            lines.push(Line {
                name: "  at".to_owned(),
                unit: "s",
                column: format!("{quantity}_time_s"),
                factor: 1.0,
                value: Box::new(time),
            });
        }
    }
    let has = |own: &Derived| of.contains(&true) || !own.2.contains("across");
    lines.extend(DERIVED.into_iter().filter(has).map(|(name, unit, column, factor, value)| Line {
        name: name.to_owned(),
        unit,
        column: column.to_owned(),
        factor,
        value: Box::new(value),
    }));
    lines.extend(of.iter().map(|&in_plan| Line {
        name: "energy input".to_owned(),
        unit: of_body("kJ/m", in_plan),
        column: EnergyTerm::Input.column(in_plan),
        factor: 1e-3,
        value: Box::new(move |run: &Run| {
            Some(run.energy_balance.input).filter(|_| run.in_plan == in_plan)
        }),
    }));
    lines.extend(EnergyTerm::ALL.into_iter().filter(|term| term.is_lost()).map(|term| Line {
        name: format!("  {}", term.name()),
        unit: "%",
        column: format!("energy_fraction_{term}"),
        factor: 100.0,
        value: Box::new(move |run: &Run| {
            run.energy_balance.fraction(term).filter(|fraction| *fraction != 0.0)
        }),
    }));
    lines
}

impl Comparison {
    /// Adds a case; names need not be distinct.
    pub fn add(&mut self, name: impl Into<String>, run: Run) {
        self.cases.push((name.into(), run));
    }

    /// Rows of the comparison, for the kinds of runs among its cases.
    fn lines(&self) -> Vec<Line> {
        let has = |in_plan: &bool| self.cases.iter().any(|(_, run)| run.in_plan == *in_plan);
        let of: Vec<bool> = [false, true].into_iter().filter(has).collect();
        lines(if of.is_empty() { &[false] } else { &of })
    }

    fn table(&self) -> Table {
        let mut heading = vec![String::new(), "unit".to_owned()];
        heading.extend(self.cases.iter().map(|(name, _)| name.clone()));
        let line = |row: Line| {
            let mut cells = vec![row.name.clone(), row.unit.to_owned()];
            cells.extend(self.cases.iter().map(|(_, run)| row.cell(run)));
            cells
        };
        // A quantity without a value in any case gets no row.
        let known = |row: &Line| {
            self.cases.is_empty() || self.cases.iter().any(|(_, s)| (row.value)(s).is_some())
        };
        let mut rows: Vec<_> = self.lines().into_iter().filter(known).map(line).collect();
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

    /// One line per case and one column per quantity, in SI units (probes in their own units).
    ///
    /// Columns and numbers follow the [rule](super) for all files; a cell is empty if a case has no value.
    pub fn csv(&self) -> Csv {
        let mut heading = vec!["case".to_owned()];
        let lines = self.lines();
        heading.extend(lines.iter().map(|row| row.column.clone()));
        let probes = self.common_probes();
        let columns = probes.iter().map(|probe| column(&probe.name, &probe.unit));
        heading.extend(distinct(&heading, columns));
        let line = |(name, run): &(String, Run)| {
            let values = lines.iter().map(|row| (row.value)(run));
            let own = run.probes.iter().take(probes.len());
            let peaks = own.map(|probe| Some(probe.extremes.largest().value));
            let cells = values.chain(peaks).map(|v| NumberCell(v.unwrap_or(f64::NAN)).to_string());
            std::iter::once(name.clone()).chain(cells).collect()
        };
        Csv(Table { heading, repeated: 1, rows: self.cases.iter().map(line).collect() }.csv())
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
