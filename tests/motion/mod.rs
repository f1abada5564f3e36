//! GOAL: ground-motion records, their files, baselines, spectra and free fields are right.
//! SCENE: El Centro 1940, pulses, and any samples.
//! REFERENCE: published values, closed forms, independent integrations.

mod agency_files;
mod along_lines;
mod baselines;
mod filters;
mod free_fields;
mod fuzz;
mod inclined_waves;
mod incoherent;
mod late_components;
mod motion_formats;
mod motion_reader;
mod odd_columns;
mod odd_files;
mod odd_headers;
mod odd_titles;
mod parts_and_files;
mod records;
mod response_spectrum;
mod stated_twice;

use basemat::motion::{AccelerationUnit, Record, RecordFormat};
use basemat::{Error, FileError, FileFault, Result};

/// Standard gravity, m/s².
const STANDARD_GRAVITY: f64 = 9.80665;

/// Metres per second squared.
const SI_UNIT: AccelerationUnit = AccelerationUnit::MetrePerSecondSquared;
/// Multiples of standard gravity.
const GRAVITY_UNIT: AccelerationUnit = AccelerationUnit::StandardGravity;

/// The record in a text.
fn read(text: &(impl AsRef<[u8]> + ?Sized), format: &dyn RecordFormat) -> Result<Record> {
    Record::from_reader("text", text.as_ref(), format)
}

/// Error of a text that cannot be read.
#[track_caller]
fn error_in(text: &(impl AsRef<[u8]> + ?Sized), format: &dyn RecordFormat) -> FileError {
    match read(text, format) {
        Err(Error::File(error)) => {
            assert_eq!(error.file, "text");
            error
        }
        other => panic!("{other:?}"),
    }
}

/// Error of a text at this line.
fn error_at(line: usize, fault: FileFault) -> FileError {
    FileError { file: "text".into(), line, fault }
}

/// Asserts time step (s) and accelerations (m/s²) of a record, up to rounding.
#[track_caller]
fn assert_record(record: &Record, time_step: f64, expected: &[f64]) {
    let step_error = (record.time_step() / time_step - 1.0).abs();
    assert!(step_error < 1e-15, "{} s, not {time_step} s", record.time_step());
    assert_eq!(record.len(), expected.len());
    for (computed, expected) in record.accelerations().iter().zip(expected) {
        assert!((computed - expected).abs() <= 1e-14 * expected.abs(), "{computed} {expected}");
    }
}
