//! Tables on the screen, in a CSV file, and between the markers of the document.

use std::fmt::Write as _;
use std::path::Path;

use super::outcome::{Finished, ValidationCheck};
use crate::AnyError;
use crate::document::{splice, write_csv};

/// Prints the checks of a case.
pub(crate) fn print(finished: &Finished) {
    println!("\n{} ({}), {:.2} s", finished.case.title, finished.case.name, finished.seconds);
    for check in &finished.outcome.checks {
        let mark = if check.holds() { "" } else { "   <-- FAILS" };
        println!("  {:<58}{:>12}  {}{mark}", check.name, number(check.value), limits(check));
    }
}

/// Writes every check of every case.
pub(crate) fn write_checks(path: &Path, list: &[Finished]) -> Result<(), AnyError> {
    let checks = list
        .iter()
        .flat_map(|finished| finished.outcome.checks.iter().map(move |check| (finished, check)));
    write_csv(
        path,
        ["case", "check", "value", "lowest", "highest", "holds"],
        checks.map(|(finished, check)| {
            [
                finished.case.name.to_owned(),
                check.name.clone(),
                format!("{:.6e}", check.value),
                check.limits.start().to_string(),
                check.limits.end().to_string(),
                check.holds().to_string(),
            ]
        }),
    )
}

/// Writes the numbers to the table of validation and the pictures to `images`.
pub(crate) fn write_docs(docs: &Path, list: &[Finished]) -> Result<(), AnyError> {
    for finished in list {
        let name = format!("validation {}", finished.case.name);
        splice("validation.md", &name, &section(finished)?)?;
        finished.outcome.figure.draw(&docs.join("images").join(finished.image()))?;
    }
    Ok(())
}

/// Reference, settings and errors of a case.
fn section(finished: &Finished) -> Result<String, AnyError> {
    let Finished { case, outcome, .. } = finished;
    let mut text = format!(
        "Reference: {}. Settings: {}.\n\n| check | found |\n|---|---|\n",
        case.reference, case.settings
    );
    for check in &outcome.checks {
        let mark = if check.holds() { "" } else { " **exceeds its limit**" };
        writeln!(text, "| {} | {}{mark} |", check.name, number(check.value))?;
    }
    Ok(text)
}

fn limits(check: &ValidationCheck) -> String {
    let low = *check.limits.start();
    let high = *check.limits.end();
    if low == 0.0 {
        format!("≤ {}", number(high))
    } else {
        format!("{low} … {high}")
    }
}

/// Two or three digits: 0.71, 1.98, 3.4e-3.
fn number(value: f64) -> String {
    if value == 0.0 {
        "0".into()
    } else if (0.1..1000.0).contains(&value.abs()) {
        let text = format!("{value:.3}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.1e}")
    }
}
