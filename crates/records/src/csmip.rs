//! Blocks of the CSMIP format, volumes 1 and 2, and quantities that their headers repeat.
//!
//! Layout: A. F. Shakal and M. J. Huang, *Standard Tape Format for CSMIP Strong-Motion Data Tapes*, California
//! Division of Mines and Geology, Report OSMS 85-03 (1985), which follows the "blue books" of Caltech; the titles
//! vary with the year of processing.

use super::block::{self, DataBlock};
use super::fault::{FaultResult, not_acceleration};
use super::header_number::{HeaderNumber, clause_end};
use super::unit_name::is_unit;
use super::{AccelerationUnit, agreement};
use crate::text::decimal::finite;

/// Whether a line in lower case is the title of a block of acceleration.
pub(super) fn is_title(line: &str) -> bool {
    volume_2(line).is_some() || volume_1(line).is_some()
}

/// Whether a line in lower case is the title of a block of velocity or displacement.
pub(super) fn is_other_title(line: &str) -> bool {
    let before = line.split_once("equally spaced at").map_or("", |(before, _)| before);
    before.contains("points of vel") || before.contains("points of disp")
}

/// The text after the key of a title of volume 2.
///
/// Example: `15200 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)`.
fn volume_2(title: &str) -> Option<&str> {
    let (before, after) = title.split_once("equally spaced at")?;
    before.contains("points of acc").then_some(after)
}

/// The text after the key of a title of volume 1.
///
/// Example: `13200 Accelerogram points at 200 pts/sec in units of g .  Format: (8f9.6)`.
fn volume_1(title: &str) -> Option<&str> {
    Some(title.split_once("accelerogram points at")?.1)
}

/// Quantities in the header that the title of the block states too.
#[derive(Default)]
pub(super) struct CsmipHeader {
    /// Number of samples.
    points: Option<f64>,
    /// Time step, s.
    interval: Option<f64>,
    peak: Option<StatedPeak>,
}

/// Peak acceleration, and the word behind it, which may be its unit.
struct StatedPeak {
    value: f64,
    unit_name: String,
}

impl CsmipHeader {
    /// Stores the quantities of a line in lower case.
    pub(super) fn read(&mut self, line: &str) {
        if line.contains("baseline") && line.contains("corrected") {
            self.points = leading_number(line).or(self.points);
        } else if let Some((_, text)) = line.split_once("equally-spaced intervals of") {
            let interval = leading_number(text).filter(|_| line.contains(" sec"));
            self.interval = interval.or(self.interval);
        } else if let Some((_, text)) = line.split_once("peak acceleration =") {
            self.peak = stated_peak(text);
        } else if let Some((_, text)) = line.split_once("no. of points =") {
            // From volume 1: `No. of Points = 13200  Record Length = 66.000 sec   at 200 Samples/sec`.
            self.points = leading_number(text);
            let rate =
                text.split_once("samples/sec").and_then(|(text, _)| text.rsplit_once(" at "));
            self.interval = rate.and_then(|(_, rate)| finite(rate.trim())).map(f64::recip);
        } else if let Some((_, text)) = line.split_once("units of uncor") {
            // `Units of uncor data are sec and g .        Max  =   .079 g , at  30.590 sec.`
            let text = text.split_once(" max").map_or("", |(_, text)| text);
            self.peak = stated_peak(text.trim_start_matches([' ', '=']));
        }
    }

    /// The block under a title; `default_unit` is the unit if the file names none.
    pub(super) fn block(
        &self,
        line: &str,
        default_unit: Option<AccelerationUnit>,
    ) -> FaultResult<DataBlock> {
        let title = line.to_ascii_lowercase();
        let title = title.as_str();
        let points = block::leading_count(title, "number of points")?;
        let step = block::positive_step(time_step(title)?)?;
        let peak = self.peak_in_unit()?;
        let (unit, rest) = if let Some(text) = unit_text(title) {
            block::unit_and_rest(line, text)?
        } else {
            let expected = peak.map(|(_, unit)| unit).or(default_unit);
            let rest = volume_2(title).map_or("", |text| &text[time_end(text)..]);
            (block::unit_of_untitled(title, expected)?, rest)
        };
        let format = block::format_of_title(title, rest)?;
        self.check(points, step)?;
        let peak = peak.map(|(value, peak_unit)| {
            let factor =
                peak_unit.in_metres_per_second_squared() / unit.in_metres_per_second_squared();
            value * factor
        });
        Ok(DataBlock { points, step, unit, format, peak })
    }

    /// The peak acceleration, if the word behind it is a unit. Error if it is a unit of another quantity.
    fn peak_in_unit(&self) -> FaultResult<Option<(f64, AccelerationUnit)>> {
        let Some(StatedPeak { value, unit_name }) = &self.peak else { return Ok(None) };
        match AccelerationUnit::named(unit_name) {
            None if is_unit(unit_name) => {
                Err(not_acceleration(&format!("peak of {value} {unit_name}")))
            }
            unit => Ok(unit.map(|unit| (*value, unit))),
        }
    }

    /// Error if the header states another number of points or another interval than the title.
    fn check(&self, points: usize, step: f64) -> FaultResult<()> {
        if let Some(stated) = self.points {
            agreement::number("number of points of the title", points as f64, stated)?;
        }
        match self.interval {
            Some(stated) => agreement::number("time step of the title (s)", step, stated),
            None => Ok(()),
        }
    }
}

/// The number at the beginning of a text.
fn leading_number(text: &str) -> Option<f64> {
    text.split_whitespace().next().and_then(finite)
}

/// The number at the beginning of a text, and the word behind it.
fn stated_peak(text: &str) -> Option<StatedPeak> {
    let mut words = text.split_whitespace();
    let value = finite(words.next()?)?;
    let unit_name = words.next()?.trim_end_matches([',', '.']).to_owned();
    Some(StatedPeak { value, unit_name })
}

/// Time step of a title, s.
fn time_step(title: &str) -> FaultResult<Option<f64>> {
    if let Some(text) = volume_1(title) {
        let rate = text.split_once("pts/sec").map_or("", |(rate, _)| rate);
        return Ok(HeaderNumber::Frequency.read(rate)?.map(f64::recip));
    }
    let text = volume_2(title).unwrap_or("");
    HeaderNumber::TimeStep.read(&text[..time_end(text)])
}

/// End of the time step in a title of volume 2.
fn time_end(text: &str) -> usize {
    let keys = [" in ", "(units", "units", "format"].map(|key| text.find(key));
    // Other brackets may enclose the unit of time.
    let format_bracket = text.match_indices('(').map(|(position, _)| position).find(|position| {
        text[position + 1..]
            .starts_with(|character: char| character.is_ascii_digit() || character == '*')
    });
    let first_key = keys.into_iter().chain([format_bracket]).flatten().min();
    first_key.unwrap_or(text.len()).min(clause_end(text))
}

/// The text of a title from its unit on.
///
/// Examples: `units=g`, `(UNITS: CM/SEC/SEC)`, `in units of g`, `in cm/sec2.`
fn unit_text(title: &str) -> Option<&str> {
    if let Some((_, text)) = title.split_once("units") {
        let text = text.trim_start_matches([' ', '=', ':']);
        let word = ["of ", "are ", "is "].into_iter().find_map(|word| text.strip_prefix(word));
        return Some(word.unwrap_or(text).trim_start());
    }
    Some(volume_2(title)?.split_once(" in ")?.1)
}
