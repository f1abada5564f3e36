//! GOAL: parts of records have their samples; written records are read back.
//! SCENE: El Centro, arbitrary samples at arbitrary time steps.
//! REFERENCE: the samples themselves, bit for bit.

use basemat::motion::{ColumnFormat, Record, el_centro_1940};
use basemat::{Error, Result};
use basemat_problems::faults::is_unwritable;
use proptest::prelude::*;

use super::{SI_UNIT, read};

fn csv_bytes(record: &Record) -> Vec<u8> {
    record.csv().as_bytes().to_vec()
}

/// GOAL: a part of a record has its samples, and begins at rest.
#[test]
fn parts_keep_their_samples() {
    let record = el_centro_1940();
    let samples = record.accelerations();
    for (start, end, first, last) in [
        (0.0, record.duration(), 0, 1559),
        (0.02, 0.04, 1, 2),
        // 0.06 and 0.14 are 3 and 7 steps but for rounding.
        (0.06, 0.14, 3, 7),
        (0.061, 0.139, 3, 7),
        (0.079, 0.0791, 3, 4),
        (31.17, 31.175, 1558, 1559),
    ] {
        let part = record.trimmed(start, end).unwrap();
        assert_eq!(part.accelerations(), &samples[first..=last], "{start} {end}");
        assert_eq!(part.time_step(), record.time_step());
        // It begins at rest: velocities differ by the initial one.
        let initial = record.velocities()[first];
        for (v, w) in part.velocities().iter().zip(&record.velocities()[first..]) {
            assert!((v - (w - initial)).abs() < 1e-13);
        }
    }
    // Less than a millionth of a step apart, on a sample.
    let sample = 100.0 * record.time_step();
    let part = record.trimmed(sample - 1e-9, sample + 1e-9).unwrap();
    assert_eq!(part.accelerations(), &samples[100..=101]);
    let end = record.duration();
    assert_eq!(record.trimmed(end - 1e-9, end).unwrap().accelerations(), &samples[1558..]);
}

/// The part of a record between two fractions of its intensity.
fn significant_part(record: &Record, from: f64, to: f64) -> Result<Record> {
    let times = record.significant_times(from, to)?;
    record.trimmed(times[0], times[1])
}

/// GOAL: parts outside a record, and empty ones, are errors; the significant part is cut.
#[test]
fn parts_outside_are_errors() {
    let record = el_centro_1940();
    let end = record.duration();
    let nan = f64::NAN;
    for (start, stop, name) in [
        (-0.1, 1.0, "start"),
        (nan, 1.0, "start"),
        (end, end + 1.0, "start"),
        (f64::INFINITY, f64::INFINITY, "start"),
        (1.0, 1.0, "end"),
        (1.0, 0.5, "end"),
        (1.0, nan, "end"),
        (1.0, end + 0.01, "end"),
        (1.0, f64::INFINITY, "end"),
    ] {
        let Err(Error::Input { quantity, value, .. }) = record.trimmed(start, stop) else {
            panic!("{start} {stop}");
        };
        assert!(quantity.starts_with(name));
        let result = if name == "start" { start } else { stop };
        assert_eq!(value.to_bits(), result.to_bits());
    }
    assert!(significant_part(&record, 0.5, 0.5).is_err());
    assert!(significant_part(&record, 0.95, 0.05).is_err());
    let at_rest = Record::new(0.1, vec![0.0; 5]).unwrap();
    assert!(significant_part(&at_rest, 0.0, 1.0).is_err());
    // 1.67 s to 25.51 s, and the samples around, from 83 times 0.02 s on.
    let significant = significant_part(&record, 0.05, 0.95).unwrap();
    assert!((significant.duration() - 23.86).abs() < 1e-9);
    assert_eq!(significant.accelerations()[0], record.accelerations()[83]);
}

/// GOAL: a record is saved in a new folder and read back; a file in place of a folder is an error.
#[test]
fn records_are_read_back_from_files() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("records/new/el_centro.csv");
    let record = el_centro_1940();
    record.csv().save(&path).unwrap();
    assert_eq!(Record::read(&path, &ColumnFormat::new(SI_UNIT)).unwrap(), record);
    assert_eq!(std::fs::read(&path).unwrap(), csv_bytes(&record));
    let below = path.join("below_a_file.csv");
    assert!(is_unwritable(&record.csv().save(&below)));
}

proptest! {
    /// GOAL: written records are read back to the last bit.
    #[test]
    fn records_are_read_back_to_the_last_bit(
        samples in prop::collection::vec(-20.0..20.0, 2..300),
        exponent in -12.0..3.0_f64,
    ) {
        let record = Record::new(10.0_f64.powf(exponent), samples).unwrap();
        let read_back = read(&csv_bytes(&record), &ColumnFormat::new(SI_UNIT)).unwrap();
        prop_assert_eq!(read_back.time_step().to_bits(), record.time_step().to_bits());
        prop_assert_eq!(read_back, record);
    }
}
