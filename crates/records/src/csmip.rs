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
    text_after_volume_2_key(line).is_some() || text_after_volume_1_key(line).is_some()
}

/// Whether a line in lower case is the title of a block of velocity or displacement.
pub(super) fn is_other_title(line: &str) -> bool {
    let text_before =
        line.split_once("equally spaced at").map_or("", |(text_before, _)| text_before);
    text_before.contains("points of vel") || text_before.contains("points of disp")
}

/// The text after the key of volume 2, if a title has the key.
///
/// Example: `15200 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)`.
fn text_after_volume_2_key(title: &str) -> Option<&str> {
    let (text_before, text_after) = title.split_once("equally spaced at")?;
    text_before.contains("points of acc").then_some(text_after)
}

/// The text after the key of volume 1, if a title has the key.
///
/// Example: `13200 Accelerogram points at 200 pts/sec in units of g .  Format: (8f9.6)`.
fn text_after_volume_1_key(title: &str) -> Option<&str> {
    Some(title.split_once("accelerogram points at")?.1)
}

/// Quantities that both the header and the title of the block state.
#[derive(Default)]
pub(super) struct CsmipHeader {
    /// Number of samples.
    sample_count: Option<f64>,
    /// Time step, s.
    time_step: Option<f64>,
    peak: Option<StatedPeak>,
}

/// Peak acceleration, and the word after it, which may be its unit.
struct StatedPeak {
    value: f64,
    unit_name: String,
}

impl CsmipHeader {
    /// Stores the quantities of a line in lower case.
    pub(super) fn read(&mut self, line: &str) {
        if line.contains("baseline") && line.contains("corrected") {
            self.sample_count = leading_number(line).or(self.sample_count);
        } else if let Some((_, text)) = line.split_once("equally-spaced intervals of") {
            let time_step = leading_number(text).filter(|_| line.contains(" sec"));
            self.time_step = time_step.or(self.time_step);
        } else if let Some((_, text)) = line.split_once("peak acceleration =") {
            self.peak = stated_peak(text);
        } else if let Some((_, text)) = line.split_once("no. of points =") {
            // From volume 1: `No. of Points = 13200  Record Length = 66.000 sec   at 200 Samples/sec`.
            self.sample_count = leading_number(text);
            let rate_text =
                text.split_once("samples/sec").and_then(|(text, _)| text.rsplit_once(" at "));
            self.time_step = rate_text.and_then(|(_, rate)| finite(rate.trim())).map(f64::recip);
        } else if let Some((_, text)) = line.split_once("units of uncor") {
            // `Units of uncor data are sec and g .        Max  =   .079 g , at  30.590 sec.`
            let text = text.split_once(" max").map_or("", |(_, text)| text);
            self.peak = stated_peak(text.trim_start_matches([' ', '=']));
        }
    }

    /// Description of the block under a title.
    ///
    /// `default_unit`: unit of a file that names none.
    pub(super) fn block(
        &self,
        line: &str,
        default_unit: Option<AccelerationUnit>,
    ) -> FaultResult<DataBlock> {
        let title = line.to_ascii_lowercase();
        let title = title.as_str();
        let sample_count = block::leading_count(title, "number of points")?;
        let time_step = block::positive_time_step(time_step(title)?)?;
        let stated_peak = self.peak_in_unit()?;
        let (unit, text_after_unit) = if let Some(text) = unit_text(title) {
            block::unit_and_text_after(line, text)?
        } else {
            let expected_unit = stated_peak.map(|(_, unit)| unit).or(default_unit);
            let text_after_unit =
                text_after_volume_2_key(title).map_or("", |text| &text[time_step_end(text)..]);
            (block::unit_without_name(title, expected_unit)?, text_after_unit)
        };
        let format = block::format_of_title(title, text_after_unit)?;
        self.check(sample_count, time_step)?;
        let peak = stated_peak.map(|(value, peak_unit)| {
            let factor =
                peak_unit.in_metres_per_second_squared() / unit.in_metres_per_second_squared();
            value * factor
        });
        Ok(DataBlock { sample_count, time_step, unit, format, peak })
    }

    /// The peak acceleration and its unit, if a unit follows the number.
    ///
    /// Returns an error for a unit of another quantity.
    fn peak_in_unit(&self) -> FaultResult<Option<(f64, AccelerationUnit)>> {
        let Some(StatedPeak { value, unit_name }) = &self.peak else { return Ok(None) };
        match AccelerationUnit::named(unit_name) {
            None if is_unit(unit_name) => {
                Err(not_acceleration(&format!("peak of {value} {unit_name}")))
            }
            unit => Ok(unit.map(|unit| (*value, unit))),
        }
    }

    /// Returns an error if header and title state different numbers of points or time steps.
    fn check(&self, sample_count: usize, time_step: f64) -> FaultResult<()> {
        if let Some(stated_count) = self.sample_count {
            agreement::check_number(
                "number of points of the title",
                sample_count as f64,
                stated_count,
            )?;
        }
        match self.time_step {
            Some(stated_step) => {
                agreement::check_number("time step of the title (s)", time_step, stated_step)
            }
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

/// Time step (s) that a title states.
fn time_step(title: &str) -> FaultResult<Option<f64>> {
    if let Some(text) = text_after_volume_1_key(title) {
        let rate_text = text.split_once("pts/sec").map_or("", |(rate, _)| rate);
        return Ok(HeaderNumber::Frequency.read(rate_text)?.map(f64::recip));
    }
    let text = text_after_volume_2_key(title).unwrap_or("");
    HeaderNumber::TimeStep.read(&text[..time_step_end(text)])
}

/// Position at which the time step ends in a title of volume 2.
///
/// `text`: the title after its key.
fn time_step_end(text: &str) -> usize {
    let key_positions = [" in ", "(units", "units", "format"].map(|key| text.find(key));
    // Other brackets may enclose the unit of time.
    let format_position = text.match_indices('(').map(|(position, _)| position).find(|position| {
        text[position + 1..]
            .starts_with(|character: char| character.is_ascii_digit() || character == '*')
    });
    let end = key_positions.into_iter().chain([format_position]).flatten().min();
    end.unwrap_or(text.len()).min(clause_end(text))
}

/// The text of a title that begins with its unit, if it names one.
///
/// Examples: `units=g`, `(UNITS: CM/SEC/SEC)`, `in units of g`, `in cm/sec2.`
fn unit_text(title: &str) -> Option<&str> {
    if let Some((_, text)) = title.split_once("units") {
        let text = text.trim_start_matches([' ', '=', ':']);
        let text_after_verb =
            ["of ", "are ", "is "].into_iter().find_map(|verb| text.strip_prefix(verb));
        return Some(text_after_verb.unwrap_or(text).trim_start());
    }
    Some(text_after_volume_2_key(title)?.split_once(" in ")?.1)
}
