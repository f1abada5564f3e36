//! A case of the validation, and its outcome.

use std::ops::RangeInclusive;

use crate::AnyError;
use crate::figure::Figure;

/// A validation problem.
#[derive(Clone, Copy)]
pub(crate) struct ValidationCase {
    /// Name on the command line, in file names and in the document's markers.
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    /// Reference, in a few words.
    pub(crate) reference: &'static str,
    /// Mesh and time step.
    pub(crate) settings: &'static str,
    /// Runs the case; `true` selects the short form.
    pub(crate) run: fn(bool) -> Result<ValidationOutcome, AnyError>,
}

/// Errors and picture of a case.
pub(crate) struct ValidationOutcome {
    pub(crate) checks: Vec<ValidationCheck>,
    pub(crate) figure: Figure,
}

/// A number that must lie within limits.
pub(crate) struct ValidationCheck {
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) limits: RangeInclusive<f64>,
}

impl ValidationCheck {
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
        let errors = names.iter().zip(values).zip(limits);
        errors.map(|((name, value), limit)| Self::below(*name, *value, *limit)).collect()
    }

    /// Whether the number is within its limits; NaN never is.
    pub(crate) fn holds(&self) -> bool {
        self.limits.contains(&self.value)
    }
}

/// The larger of two errors; NaN if either is NaN (`f64::max` would ignore it).
pub(crate) fn worse(error: f64, other: f64) -> f64 {
    if error.is_nan() || error > other { error } else { other }
}

/// Curve of samples at an interval, with values multiplied by 1000.
pub(crate) fn milli_curve(interval: f64, values: &[f64]) -> Vec<(f64, f64)> {
    values
        .iter()
        .enumerate()
        .map(|(k, value)| (k as f64 * interval, 1e3 * value))
        .collect()
}

/// Results of a case.
pub(crate) struct Finished {
    pub(crate) case: ValidationCase,
    pub(crate) outcome: ValidationOutcome,
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
        self.outcome.checks.iter().all(ValidationCheck::holds)
    }
}
