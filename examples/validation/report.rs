//! Tables on the screen, in a CSV file, and between the markers of the document.

use std::fmt::Write as _;
use std::path::Path;

use super::AnyError;
use super::outcome::{Check, Finished};

/// Prints the checks of a case.
pub(crate) fn print(finished: &Finished) {
    println!("\n{} ({}), {:.2} s", finished.case.title, finished.case.name, finished.seconds);
    for check in &finished.outcome.checks {
        let mark = if check.holds() { "" } else { "   <-- FAILS" };
        println!("  {:<58}{:>12}  {}{mark}", check.name, number(check.value), limits(check));
    }
}

/// Writes every check of every case.
pub(crate) fn write_csv(path: &Path, list: &[Finished]) -> Result<(), AnyError> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record(["case", "check", "value", "lowest", "highest", "holds"])?;
    for finished in list {
        for check in &finished.outcome.checks {
            writer.write_record([
                finished.case.name.to_owned(),
                check.name.clone(),
                format!("{:.6e}", check.value),
                check.limits.start().to_string(),
                check.limits.end().to_string(),
                check.holds().to_string(),
            ])?;
        }
    }
    Ok(writer.flush()?)
}

/// Puts numbers into `validation.md` and pictures into `images`.
pub(crate) fn write_docs(docs: &Path, list: &[Finished]) -> Result<(), AnyError> {
    let path = docs.join("validation.md");
    let mut text = std::fs::read_to_string(&path)?;
    text = splice(&text, "summary", &summary(list)?)?;
    for finished in list {
        text = splice(&text, finished.case.name, &section(finished)?)?;
        finished.outcome.figure.draw(&docs.join("images").join(finished.image()))?;
    }
    Ok(std::fs::write(path, text)?)
}

/// A row a case.
fn summary(list: &[Finished]) -> Result<String, AnyError> {
    let mut text = format!(
        "Processor time, reference included, on {}.\n\n\
         | case | reference | error nearest its limit | limit | checks | settings | time |\n\
         |---|---|---|---|---|---|---|\n",
        processor()
    );
    for Finished { case, outcome, seconds } in list {
        let shares = outcome.checks.iter().filter_map(|check| Some((check, check.share()?)));
        let worst = shares.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(check, _)| check);
        // A case of ranges only, as orders are, shows its first.
        let (error, limit) =
            worst.or(outcome.checks.first()).map_or_else(Default::default, |check| {
                (format!("{} ({})", number(check.value), check.name), limits(check))
            });
        let held = outcome.checks.iter().filter(|check| check.holds()).count();
        writeln!(
            text,
            "| [{}](#{}) | {} | {error} | {limit} | {held} of {} | {} | {seconds:.2} s |",
            case.title,
            anchor(case.title),
            case.reference,
            outcome.checks.len(),
            case.settings,
        )?;
    }
    Ok(text)
}

/// Settings, errors and time of a case.
fn section(finished: &Finished) -> Result<String, AnyError> {
    let Finished { case, outcome, seconds } = finished;
    let mut text = format!(
        "Settings: {}. Time: {seconds:.2} s.\n\n| check | found | limit |\n|---|---|---|\n",
        case.settings
    );
    for check in &outcome.checks {
        let mark = if check.holds() { "" } else { " **exceeded**" };
        writeln!(text, "| {} | {} | {}{mark} |", check.name, number(check.value), limits(check))?;
    }
    Ok(text)
}

/// How GitHub names the anchor of a heading.
fn anchor(title: &str) -> String {
    let kept = title.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-'));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}

fn limits(check: &Check) -> String {
    let (low, high) = (*check.limits.start(), *check.limits.end());
    if low == 0.0 { format!("≤ {}", number(high)) } else { format!("{low} … {high}") }
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

/// The processor's name.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    line.map_or(std::env::consts::ARCH, |(_, name)| name.trim()).to_owned()
}

/// `text` with `new` between the markers called `name`.
fn splice(text: &str, name: &str, new: &str) -> Result<String, AnyError> {
    let [begin, end] = ["begin", "end"].map(|which| format!("<!-- validation {name}: {which} -->"));
    let missing = || format!("validation.md: no markers '{begin}', '{end}'");
    let (before, rest) = text.split_once(&begin).ok_or_else(missing)?;
    let (_, after) = rest.split_once(&end).ok_or_else(missing)?;
    Ok(format!("{before}{begin}\n\n{}\n\n{end}{after}", new.trim()))
}
