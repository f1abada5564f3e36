//! A case of the validation, and its outcome.

use std::ops::RangeInclusive;

use crate::AnyError;
use crate::figure::Figure;

/// A validation problem.
#[derive(Clone, Copy)]
pub(crate) struct Case {
    /// Name on the command line, in file names and in the document's markers.
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    /// Reference, in a few words.
    pub(crate) reference: &'static str,
    /// Mesh and time step.
    pub(crate) settings: &'static str,
    /// Runs the case; `true` selects the short form.
    pub(crate) run: fn(bool) -> Result<Outcome, AnyError>,
}

/// Errors and picture of a case.
pub(crate) struct Outcome {
    pub(crate) checks: Vec<Check>,
    pub(crate) figure: Figure,
}

/// A number that must lie within limits.
pub(crate) struct Check {
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) limits: RangeInclusive<f64>,
}

impl Check {
    /// An error that must not exceed `limit`.
    pub(crate) fn below(name: impl Into<String>, value: f64, limit: f64) -> Self {
        Self { name: name.into(), value, limits: 0.0..=limit }
    }

    /// A number that must lie in a range.
    pub(crate) fn within(name: impl Into<String>, value: f64, limits: RangeInclusive<f64>) -> Self {
        Self { name: name.into(), value, limits }
    }

    /// Checks of several errors, each with its name and limit.
    pub(crate) fn list(names: &[&str], values: &[f64], limits: &[f64]) -> Vec<Self> {
        let each = names.iter().zip(values).zip(limits);
        each.map(|((name, value), limit)| Self::below(*name, *value, *limit)).collect()
    }

    /// Whether the number is where it must be; NaN never is.
    pub(crate) fn holds(&self) -> bool {
        self.limits.contains(&self.value)
    }
}

/// The larger of two errors; NaN, which is the worst, if either is (`f64::max` would drop it).
pub(crate) fn worse(one: f64, other: f64) -> f64 {
    if one.is_nan() || one > other { one } else { other }
}

/// A case that has run.
pub(crate) struct Finished {
    pub(crate) case: Case,
    pub(crate) outcome: Outcome,
    /// Processor time of the case, reference included, s.
    pub(crate) seconds: f64,
}

impl Finished {
    /// File name of its picture.
    pub(crate) fn image(&self) -> String {
        format!("validation_{}.svg", self.case.name)
    }

    /// Whether every check holds.
    pub(crate) fn holds(&self) -> bool {
        self.outcome.checks.iter().all(Check::holds)
    }
}
