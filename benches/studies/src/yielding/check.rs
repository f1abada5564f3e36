//! A check of the study: a number beside its limit.

use std::fmt::Write;

/// Bound of a number.
#[derive(Debug, Clone, Copy)]
pub(super) enum Limit {
    AtMost(f64),
    AtLeast(f64),
}

/// What was computed, beside what, and within which limit.
#[derive(Debug)]
pub(super) struct Check {
    name: String,
    reference: &'static str,
    value: f64,
    limit: Limit,
    /// Further numbers of the check, for its row.
    remark: String,
}

impl Check {
    pub(super) fn new(
        name: impl Into<String>,
        reference: &'static str,
        value: f64,
        limit: Limit,
    ) -> Self {
        Self { name: name.into(), reference, value, limit, remark: String::new() }
    }

    /// Adds further numbers.
    pub(super) fn with_remark(self, remark: impl Into<String>) -> Self {
        Self { remark: remark.into(), ..self }
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Whether the value is within its limit; NaN is not.
    pub(super) fn holds(&self) -> bool {
        match self.limit {
            Limit::AtMost(limit) => self.value <= limit,
            Limit::AtLeast(limit) => self.value >= limit,
        }
    }

    fn limit_text(&self) -> String {
        match self.limit {
            Limit::AtMost(limit) => format!("≤ {}", number_text(limit)),
            Limit::AtLeast(limit) => format!("≥ {}", number_text(limit)),
        }
    }
}

/// A number with few digits: small ones with an exponent.
fn number_text(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if value.abs() < 1e-3 {
        format!("{value:.1e}")
    } else if value.fract() == 0.0 {
        format!("{value}")
    } else {
        format!("{value:.3}").trim_end_matches('0').to_owned()
    }
}

/// The table of all checks.
pub(super) fn markdown(checks: &[Check]) -> String {
    let mut text = String::from("|check|reference|result|limit|\n|---|---|---|---|\n");
    for check in checks {
        let separator = if check.remark.is_empty() { "" } else { "; " };
        let mark = if check.holds() { "" } else { " **exceeded**" };
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "|{}|{}|{}{separator}{}|{}{mark}|",
            check.name,
            check.reference,
            number_text(check.value),
            check.remark,
            check.limit_text(),
        );
    }
    text
}
