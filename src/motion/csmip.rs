//! Blocks of the CSMIP format, volumes 1 and 2, and quantities that their headers repeat.
//!
//! Layout: A. F. Shakal and M. J. Huang, *Standard Tape Format for CSMIP Strong-Motion Data Tapes*, California
//! Division of Mines and Geology, Report OSMS 85-03 (1985), which follows the "blue books" of Caltech; the titles
//! vary with the year of processing.

use super::block::{self, Block};
use super::fault::no_acceleration;
use super::header_number::{HeaderNumber, clause_end};
use super::unit_name::is_unit;
use super::{AccelerationUnit, agreement};
use crate::error::FileFault;
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

/// `15200 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)`: the text after the key.
fn volume_2(title: &str) -> Option<&str> {
    let (before, after) = title.split_once("equally spaced at")?;
    before.contains("points of acc").then_some(after)
}

/// `13200 Accelerogram points at 200 pts/sec in units of g .  Format: (8f9.6)`: the text after the key.
fn volume_1(title: &str) -> Option<&str> {
    Some(title.split_once("accelerogram points at")?.1)
}

/// Quantities in the header that the title of the block states too.
#[derive(Default)]
pub(super) struct Notes {
    points: Option<f64>,
    /// Time step, s.
    interval: Option<f64>,
    /// Peak acceleration, and the name of its unit.
    peak: Option<(f64, String)>,
}

impl Notes {
    /// Stores the quantities of a line in lower case.
    pub(super) fn read(&mut self, line: &str) {
        let value = |text: &str| text.split_whitespace().next().and_then(finite);
        if line.contains("baseline") && line.contains("corrected") {
            self.points = value(line).or(self.points);
        } else if let Some((_, text)) = line.split_once("equally-spaced intervals of") {
            self.interval = value(text).filter(|_| line.contains(" sec")).or(self.interval);
        } else if let Some((_, text)) = line.split_once("peak acceleration =") {
            self.peak = peak(text);
        } else if let Some((_, text)) = line.split_once("no. of points =") {
            // From volume 1: `No. of Points = 13200  Record Length = 66.000 sec   at 200 Samples/sec`.
            self.points = value(text);
            let rate =
                text.split_once("samples/sec").and_then(|(text, _)| text.rsplit_once(" at "));
            self.interval = rate.and_then(|(_, rate)| finite(rate.trim())).map(f64::recip);
        } else if let Some((_, text)) = line.split_once("units of uncor") {
            // `Units of uncor data are sec and g .        Max  =   .079 g , at  30.590 sec.`
            let (_, text) = text.split_once(" max").unwrap_or(("", ""));
            self.peak = peak(text.trim_start_matches([' ', '=']));
        }
    }

    /// The block under a title; `unnamed` is the unit if the file names none.
    pub(super) fn block(
        &self,
        line: &str,
        unnamed: Option<AccelerationUnit>,
    ) -> Result<Block, FileFault> {
        let title = line.to_ascii_lowercase();
        let title = title.as_str();
        let points = block::points(title, "number of points")?;
        let step = block::step(step(title)?)?;
        let peak = self.peak()?;
        let (unit, rest) = match unit_text(title) {
            Some(text) => block::unit(line, text)?,
            None => (
                block::unnamed(title, peak.map(|(_, unit)| unit).or(unnamed))?,
                volume_2(title).map_or("", |text| &text[time_end(text)..]),
            ),
        };
        let columns = block::columns(title, rest)?;
        self.agree(points, step)?;
        let factor = |other: AccelerationUnit| {
            other.in_metres_per_second_squared() / unit.in_metres_per_second_squared()
        };
        let peak = peak.map(|(value, other)| value * factor(other));
        Ok(Block { points, step, unit, columns, peak })
    }

    /// The peak acceleration, if the word behind it is a unit. Error if it is another unit than of acceleration.
    fn peak(&self) -> Result<Option<(f64, AccelerationUnit)>, FileFault> {
        let Some((value, name)) = &self.peak else { return Ok(None) };
        match AccelerationUnit::named(name) {
            None if is_unit(name) => Err(no_acceleration(&format!("peak of {value} {name}"))),
            unit => Ok(unit.map(|unit| (*value, unit))),
        }
    }

    /// Error if the header states another number of points or another interval than the title.
    fn agree(&self, points: usize, step: f64) -> Result<(), FileFault> {
        if let Some(stated) = self.points {
            agreement::number("number of points of the title", points as f64, stated)?;
        }
        match self.interval {
            Some(stated) => agreement::number("time step of the title (s)", step, stated),
            None => Ok(()),
        }
    }
}

/// A number at the beginning of a text, and the word behind it.
fn peak(text: &str) -> Option<(f64, String)> {
    let mut words = text.split_whitespace();
    let value = finite(words.next()?)?;
    Some((value, words.next()?.trim_end_matches([',', '.']).to_owned()))
}

/// Time step of a title, s.
fn step(title: &str) -> Result<Option<f64>, FileFault> {
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
    // A bracket may hold the unit of time.
    let bracket = text
        .match_indices('(')
        .map(|(at, _)| at)
        .find(|&at| text[at + 1..].starts_with(|sign: char| sign.is_ascii_digit() || sign == '*'));
    let first = keys.into_iter().chain([bracket]).flatten().min().unwrap_or(text.len());
    first.min(clause_end(text))
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
