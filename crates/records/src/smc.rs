//! Records of the U.S. Geological Survey in the SMC format.
//!
//! Layout: USGS National Strong-Motion Program, *SMC- and BBF-format Data Files* (escweb.wr.usgs.gov/nsmp-data,
//! `smcfmt.txt`): 11 lines of text, 48 integers as `8I10`, 50 reals as `5E15.7`, comments behind `|`, and the time
//! series as `8(1PE10.4E1)`.

use super::AccelerationUnit;
use super::agreement;
use super::fault::{not_acceleration, unprocessed};
use super::format::read_one_component;
use super::fortran_format::FortranFormat;
use super::lines::{LineResult, Lines, line_after_block, read_numbers, required};
use super::series::{Series, multiplied, whole_sample_count};
use crate::error::FileFault;

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

read_one_component!(SmcFormat);

/// Number of lines of text at the beginning.
const TEXT_LINE_COUNT: usize = 11;
/// Number of whole numbers after the text.
const INTEGER_COUNT: usize = 48;
/// Number of real numbers after the whole ones.
const REAL_COUNT: usize = 50;
/// Index, from 0, of the number of comment lines in the whole numbers.
const COMMENT_COUNT_INDEX: usize = 15;
/// Index, from 0, of the number of samples in the whole numbers.
const SAMPLE_COUNT_INDEX: usize = 16;
/// Index, from 0, of the number of samples a second in the real numbers.
const SAMPLING_RATE_INDEX: usize = 1;
/// Largest number of comment lines that are skipped; a larger number is not plausible.
const MAX_COMMENT_COUNT: u32 = 10_000;
/// Columns of the whole numbers.
const INTEGER_FORMAT: FortranFormat = FortranFormat { repeat: 8, width: 10, decimals: 0, scale: 0 };
/// Columns of the real numbers.
const REAL_FORMAT: FortranFormat = FortranFormat { repeat: 5, width: 15, decimals: 7, scale: 0 };
/// Columns of the samples.
const SAMPLE_FORMAT: FortranFormat = FortranFormat { repeat: 8, width: 10, decimals: 4, scale: 0 };
/// Upper limit of a recorder's sampling rate, samples a second.
const MAX_SAMPLING_RATE: f64 = 1e5;
/// Indices, from 0, of the times of maximum and minimum in the reals.
///
/// The values follow the times.
const EXTREME_TIME_INDICES: [usize; 2] = [28, 30];

/// Reads the component of a file.
fn read(lines: &mut Lines) -> LineResult<Series> {
    let name = read_text(lines)?;
    let integers = read_numbers(lines, INTEGER_COUNT, Some(INTEGER_FORMAT))?;
    let reals = read_numbers(lines, REAL_COUNT, Some(REAL_FORMAT))?;
    let sampling_rate = stated_real(&reals, SAMPLING_RATE_INDEX)
        .filter(|&sampling_rate| sampling_rate > 0.0 && sampling_rate < MAX_SAMPLING_RATE);
    let Some(sampling_rate) = sampling_rate else {
        let reason = "no number of samples a second is stated";
        return Err(lines.fault(unprocessed("data in unequal steps", reason)));
    };
    let sample_count = whole_sample_count(integers[SAMPLE_COUNT_INDEX]);
    let sample_count = required(lines, sample_count, "number of samples (17th integer)")?;
    let comment_count =
        (0..=MAX_COMMENT_COUNT).find(|&number| f64::from(number) == integers[COMMENT_COUNT_INDEX]);
    for _ in 0..comment_count.unwrap_or(0) {
        lines.next()?;
    }
    let time_step = 1.0 / sampling_rate;
    let gal = AccelerationUnit::Gal.in_metres_per_second_squared();
    let samples = multiplied(read_numbers(lines, sample_count, Some(SAMPLE_FORMAT))?, gal);
    line_after_block(lines, sample_count)?;
    for index in EXTREME_TIME_INDICES {
        if let Some(time) = stated_real(&reals, index)
            && let Some(value) = stated_real(&reals, index + 1)
        {
            lines.with_line_number(agreement::check_extreme(
                &samples,
                time_step,
                time,
                value * gal,
            ))?;
        }
    }
    Ok(Series { name, time_step, samples })
}

/// Reads the lines of text; returns the name of the component.
fn read_text(lines: &mut Lines) -> LineResult<String> {
    let mut name = String::new();
    let mut line_count = 0;
    while line_count < TEXT_LINE_COUNT {
        let Some(line) = lines.next()? else {
            return Err(lines.fault(FileFault::missing("header of 11 lines")));
        };
        // Blank lines before the first line of text do not count.
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
