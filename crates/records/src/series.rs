//! Samples of a component, their number and unit, and the records made of them.

use super::Record;
use super::fault::{out_of_range, wrong_sample_count};
use super::lines::{LineResult, Lines};
use crate::error::{FileFault, Result};
use crate::text::column::distinct;

/// A number of samples in a header; `None` unless whole and at least two.
pub(super) fn whole_sample_count(value: f64) -> Option<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in 2..=1e9")]
    (value.fract() == 0.0 && (2.0..=1e9).contains(&value)).then_some(value as usize)
}

/// Returns an error unless a file has the expected number of samples.
pub(super) fn check_sample_count(
    lines: &Lines,
    sample_count: usize,
    expected_count: usize,
) -> LineResult<()> {
    if sample_count == expected_count {
        return Ok(());
    }
    Err(lines.fault(wrong_sample_count(sample_count, expected_count)))
}

/// All values times `factor`.
pub(super) fn multiplied(values: Vec<f64>, factor: f64) -> Vec<f64> {
    values.into_iter().map(|value| value * factor).collect()
}

/// One component of a file.
pub(super) struct Series {
    /// Name of the component in the file.
    pub(super) name: String,
    /// Time step, s.
    pub(super) time_step: f64,
    /// Acceleration, m/s².
    pub(super) samples: Vec<f64>,
}

/// Makes the record of one component; errors name `file`.
pub(super) fn to_record(file: &str, series: LineResult<Series>) -> Result<Record> {
    let series = series.map_err(|(line, fault)| fault.of(file, line))?;
    Record::new(series.time_step, series.samples)
        .map_err(|error| FileFault::Unusable(Box::new(error)).of(file, 0))
}

/// Makes records of several components, with unique names; errors name `file`.
pub(super) fn to_records(
    file: &str,
    components: LineResult<Vec<Series>>,
) -> Result<Vec<(String, Record)>> {
    let components = components.map_err(|(line, fault)| fault.of(file, line))?;
    let names = distinct(&[], components.iter().map(|series| series.name.clone()));
    let mut records = Vec::with_capacity(names.len());
    for (name, series) in names.into_iter().zip(components) {
        records.push((name, to_record(file, Ok(series))?));
    }
    Ok(records)
}

/// Selects the component with this number, counted from 1.
pub(super) fn select_component(
    number: usize,
    components: LineResult<Vec<Series>>,
) -> LineResult<Series> {
    let components = components?;
    let component_count = components.len();
    let selected = number.checked_sub(1).and_then(|index| components.into_iter().nth(index));
    selected.ok_or_else(|| (0, out_of_range("component", component_count, number)))
}
