//! Records of New Zealand's network GeoNet.
//!
//! Layout: GNS Science, *Strong-motion data file formats* (geonet.org.nz), volumes 1 and 2: for each component 16 lines
//! of text, 40 integers as `10I8`, 60 reals as `10F8`, then acceleration, and in volume 2 velocity and displacement, as
//! `10F8.1` in mm/s², in which numbers may touch.

use std::io::Read;

use super::fault::{no_acceleration, not_in_header};
use super::fortran_format::FortranFormat;
use super::header_number::HeaderNumber;
use super::lines::{
    Lines, Reason, Series, component, count, read_numbers, record, records, scaled,
};
use super::unit_name::is_unit;
use super::{AccelerationUnit, Record, RecordFormat, agreement};
use crate::error::{FileFault, Result};
use crate::text::decimal::finite;

/// The `.V1A` and `.V2A` files of GeoNet (New Zealand).
///
/// One file has all components of a station, one after the other.
///
/// Samples are in mm/s² times the unit of the readings (`Raw readings in units of 1.00 mm/s/s`). The header states
/// interval, number of points and duration in words and in numbers, which must agree, and the peak of each
/// component. [`Record::read_all`] returns all components. Velocity and displacement are skipped.
///
/// ```no_run
/// use basemat::motion::{GeoNetFormat, Record};
/// let record = Record::read("20161113_110300_HSES_20.V2A", &GeoNetFormat { component: 2 })?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct GeoNetFormat {
    /// Number of the component, counted from 1 in the order of the file.
    pub component: usize,
}

impl Default for GeoNetFormat {
    /// The first component, a horizontal one.
    fn default() -> Self {
        Self { component: 1 }
    }
}

impl RecordFormat for GeoNetFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, component(self.component, read(&mut Lines::new(source))))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        records(name, read(&mut Lines::new(source)))
    }
}

const TEXT_LINES: usize = 16;
const INTEGERS: FortranFormat = FortranFormat { repeat: 10, width: 8, decimals: 0, scale: 0 };
const REALS: FortranFormat = FortranFormat { repeat: 10, width: 8, decimals: 1, scale: 0 };

/// Quantities in the lines of text.
#[derive(Default)]
struct Header {
    name: String,
    points: Option<f64>,
    /// Duration, s.
    duration: Option<f64>,
    /// Time step, s.
    interval: Option<f64>,
    /// Unit of the numbers, mm/s².
    unit: Option<f64>,
    /// Peak acceleration, mm/s².
    peak: f64,
}

impl Header {
    fn read(&mut self, line: &str) -> std::result::Result<(), FileFault> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let after = |key: &str| {
            let at = words.iter().position(|word| word.eq_ignore_ascii_case(key))?;
            finite(words.get(at + 1)?)
        };
        let lower = line.to_ascii_lowercase();
        if lower.starts_with("number of points") {
            self.points = after("points");
            self.duration = after("duration");
        } else if lower.starts_with("component") {
            words.get(1).copied().unwrap_or("").clone_into(&mut self.name);
        } else if lower.starts_with("acceleration:") && lower.contains("mm/s/s") {
            self.peak = after("peak").unwrap_or(0.0);
            self.unit.get_or_insert(1.0);
        } else if lower.starts_with("acceleration:") && words.iter().any(|word| is_unit(word)) {
            return Err(no_acceleration(line));
        } else if let Some((_, text)) = lower.split_once("in units of") {
            let (value, _) = text.split_once("mm/s/s").unwrap_or(("", ""));
            self.unit = HeaderNumber::Peak.read(value)?;
        }
        // `at intervals of 0.005 s`, `at 0.020 sec intervals`.
        if let Some((_, text)) = lower.split_once("intervals of") {
            self.interval = text.split_whitespace().next().and_then(finite);
        } else if lower.contains("intervals") {
            self.interval = after("at");
        }
        Ok(())
    }
}

fn read(lines: &mut Lines) -> Reason<Vec<Series>> {
    let mut components = Vec::new();
    while let Some(first) = lines.next()? {
        if first.is_empty() {
            continue;
        }
        if !first.to_ascii_lowercase().contains("accelerogram") {
            return Err(lines.refuse(no_acceleration(&first)));
        }
        components.push(read_component(lines)?);
    }
    Ok(components)
}

/// A component after its first line.
fn read_component(lines: &mut Lines) -> Reason<Series> {
    let mut header = Header::default();
    for _ in 1..TEXT_LINES {
        let Some(line) = lines.next()? else {
            return Err(lines.refuse(FileFault::missing("header of 16 lines")));
        };
        header.read(&line).map_err(|reason| lines.refuse(reason))?;
    }
    let integers = read_numbers(lines, 40, Some(INTEGERS))?;
    let reals = read_numbers(lines, 60, Some(REALS))?;
    let missing = |quantity| lines.refuse(not_in_header(quantity));
    let points = count(integers[33]).ok_or_else(|| missing("number of points (34th integer)"))?;
    let step = Some(reals[25]).filter(|&step| step > 0.0);
    let step = step.ok_or_else(|| missing("sampling interval (26th real)"))?;
    let unit = header.unit.filter(|&unit| unit > 0.0);
    let unit = unit.ok_or_else(|| missing("unit (mm/s/s)"))?;
    let factor = unit * AccelerationUnit::MillimetrePerSecondSquared.in_metres_per_second_squared();
    let samples = scaled(read_numbers(lines, points, Some(REALS))?, factor);
    let agrees = || {
        if let Some(stated) = header.points {
            agreement::number("number of points", points as f64, stated)?;
        }
        if let Some(stated) = header.interval {
            agreement::number("time step (s)", step, stated)?;
        }
        if let Some(stated) = header.duration {
            agreement::duration(points, step, stated, 0.0)?;
        }
        agreement::peak(&samples, header.peak * 1e-3)
    };
    agrees().map_err(|reason| lines.refuse(reason))?;
    for others in [integers[34], integers[35]] {
        // Velocity and displacement, in lines of ten.
        let mut left = others;
        while left > 0.0
            && let Some(line) = lines.next()?
        {
            left -= if line.is_empty() { 0.0 } else { 10.0 };
        }
    }
    Ok(Series { name: header.name, step, samples })
}
