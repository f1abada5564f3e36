//! Records of the U.S. Geological Survey in the SMC format.
//!
//! Layout: USGS National Strong-Motion Program, *SMC- and BBF-format Data Files* (escweb.wr.usgs.gov/nsmp-data,
//! `smcfmt.txt`): 11 lines of text, 48 integers as `8I10`, 50 reals as `5E15.7`, comments behind `|`, and the time
//! series as `8(1PE10.4E1)`.

use std::io::Read;

use super::agreement;
use super::fault::{not_acceleration, unprocessed};
use super::fortran_format::FortranFormat;
use super::lines::{
    LineResult, Lines, Series, line_after_block, read_numbers, required, sample_count, scaled,
    to_record, to_records,
};
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{FileFault, Result};

/// The `.smc` files of the U.S. Geological Survey, one component a file, in cm/s².
///
/// Numbers may touch. The 2nd real header value is the number of samples a second, the 17th integer the number of
/// samples, the 29th to 32nd reals time and value of the maximum and the minimum, which the samples must have.
/// Files in unequal steps, of velocity, displacement or spectra are errors.
///
/// ```no_run
/// use basemat::motion::{Record, SmcFormat};
/// let record = Record::read("0111a.smc", &SmcFormat)?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SmcFormat;

impl RecordFormat for SmcFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        to_record(name, read(&mut Lines::new(source)))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        to_records(name, read(&mut Lines::new(source)).map(|series| vec![series]))
    }
}

/// Number of lines of text at the beginning.
const TEXT_LINES: usize = 11;
const INTEGER_FORMAT: FortranFormat = FortranFormat { repeat: 8, width: 10, decimals: 0, scale: 0 };
const REAL_FORMAT: FortranFormat = FortranFormat { repeat: 5, width: 15, decimals: 7, scale: 0 };
const SAMPLE_FORMAT: FortranFormat = FortranFormat { repeat: 8, width: 10, decimals: 4, scale: 0 };
/// Upper limit of a recorder's sampling rate, samples a second.
const MAX_SAMPLING_RATE: f64 = 1e5;
/// Indices, from 0, of the times of maximum and minimum in the reals; the values follow the times.
const EXTREME_TIME_INDICES: [usize; 2] = [28, 30];

/// Reads the component.
fn read(lines: &mut Lines) -> LineResult<Series> {
    let name = read_text(lines)?;
    let integers = read_numbers(lines, 48, Some(INTEGER_FORMAT))?;
    let reals = read_numbers(lines, 50, Some(REAL_FORMAT))?;
    let rate = stated_real(&reals, 1).filter(|&rate| rate > 0.0 && rate < MAX_SAMPLING_RATE);
    let Some(rate) = rate else {
        let kind = "no number of samples a second is stated";
        return Err(lines.fault(unprocessed("data in unequal steps", kind)));
    };
    let needed = sample_count(integers[16]);
    let needed = required(lines, needed, "number of samples (17th integer)")?;
    // A whole number from 0.
    let comment_count = (0..=10_000).find(|&number| f64::from(number) == integers[15]);
    for _ in 0..comment_count.unwrap_or(0) {
        lines.next()?;
    }
    let step = 1.0 / rate;
    let gal = AccelerationUnit::Gal.in_metres_per_second_squared();
    let samples = scaled(read_numbers(lines, needed, Some(SAMPLE_FORMAT))?, gal);
    line_after_block(lines, needed)?;
    for index in EXTREME_TIME_INDICES {
        if let Some(time) = stated_real(&reals, index)
            && let Some(value) = stated_real(&reals, index + 1)
        {
            lines.with_line_number(agreement::extreme(&samples, step, time, value * gal))?;
        }
    }
    Ok(Series { name, step, samples })
}

/// Reads the lines of text; returns the name of the component.
fn read_text(lines: &mut Lines) -> LineResult<String> {
    let mut name = String::new();
    let mut line_count = 0;
    while line_count < TEXT_LINES {
        let Some(line) = lines.next()? else {
            return Err(lines.fault(FileFault::missing("header of 11 lines")));
        };
        // Blank lines before the first one.
        if line_count == 0 && line.is_empty() {
            continue;
        }
        line_count += 1;
        let is_accelerogram = line.to_ascii_uppercase().contains("CORRECTED ACCELEROGRAM");
        if line_count == 1 && !is_accelerogram {
            return Err(lines.fault(not_acceleration(&line)));
        }
        if let Some((_, component)) = line.split_once("component=") {
            component.trim().clone_into(&mut name);
        }
    }
    Ok(name)
}

/// A real header value; `None` if it equals the first one, which means unknown.
fn stated_real(reals: &[f64], index: usize) -> Option<f64> {
    Some(reals[index]).filter(|&value| value != reals[0])
}
