//! Records of the U.S. Geological Survey in the SMC format.
//!
//! Layout: USGS National Strong-Motion Program, *SMC- and BBF-format Data Files* (escweb.wr.usgs.gov/nsmp-data,
//! `smcfmt.txt`): 11 lines of text, 48 integers as `8I10`, 50 reals as `5E15.7`, comments behind `|`, and the time
//! series as `8(1PE10.4E1)`.

use std::io::Read;

use super::agreement;
use super::fault::{no_acceleration, not_in_header, unprocessed};
use super::fortran_format::FortranFormat;
use super::lines::{
    Lines, Reason, Series, count, line_after_block, read_numbers, record, records, scaled,
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
        record(name, read(&mut Lines::new(source)))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        records(name, read(&mut Lines::new(source)).map(|series| vec![series]))
    }
}

const TEXT_LINES: usize = 11;
const INTEGERS: FortranFormat = FortranFormat { repeat: 8, width: 10, decimals: 0, scale: 0 };
const REALS: FortranFormat = FortranFormat { repeat: 5, width: 15, decimals: 7, scale: 0 };
const SAMPLES: FortranFormat = FortranFormat { repeat: 8, width: 10, decimals: 4, scale: 0 };
/// Upper limit of a recorder's sampling rate, samples a second.
const FASTEST: f64 = 1e5;

fn read(lines: &mut Lines) -> Reason<Series> {
    let mut name = String::new();
    let mut number = 0;
    while number < TEXT_LINES {
        let Some(line) = lines.next()? else {
            return Err(lines.refuse(FileFault::missing("header of 11 lines")));
        };
        // Blank lines before the first one.
        if number == 0 && line.is_empty() {
            continue;
        }
        number += 1;
        let accelerogram = line.to_ascii_uppercase().contains("CORRECTED ACCELEROGRAM");
        if number == 1 && !accelerogram {
            return Err(lines.refuse(no_acceleration(&line)));
        }
        if let Some((_, component)) = line.split_once("component=") {
            component.trim().clone_into(&mut name);
        }
    }
    let integers = read_numbers(lines, 48, Some(INTEGERS))?;
    let reals = read_numbers(lines, 50, Some(REALS))?;
    // The first value of each kind means unknown.
    let real = |index: usize| Some(reals[index]).filter(|&value| value != reals[0]);
    let Some(rate) = real(1).filter(|&rate| rate > 0.0 && rate < FASTEST) else {
        let kind = "no number of samples a second is stated";
        return Err(lines.refuse(unprocessed("data in unequal steps", kind)));
    };
    let missing = |quantity| lines.refuse(not_in_header(quantity));
    let needed = count(integers[16]).ok_or_else(|| missing("number of samples (17th integer)"))?;
    // A whole number from 0: the number of comments.
    let comments = (0..=10_000).find(|&number| f64::from(number) == integers[15]);
    for _ in 0..comments.unwrap_or(0) {
        lines.next()?;
    }
    let step = 1.0 / rate;
    let gal = AccelerationUnit::Gal.in_metres_per_second_squared();
    let samples = scaled(read_numbers(lines, needed, Some(SAMPLES))?, gal);
    line_after_block(lines, needed)?;
    for extreme in [28, 30] {
        let stated = real(extreme).zip(real(extreme + 1).map(|value| value * gal));
        let agrees =
            stated.map_or(Ok(()), |(time, value)| agreement::extreme(&samples, step, time, value));
        agrees.map_err(|reason| lines.refuse(reason))?;
    }
    Ok(Series { name, step, samples })
}
