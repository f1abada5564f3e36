//! GOAL: no reader of records panics, whatever the bytes.
//! SCENE: arbitrary bytes, valid files damaged in every way, sources that fail midway, and a corpus of files that are
//! hard to read (`tests/data/fuzz`).
//! REFERENCE: a record on which every method works, or a typed error with its line.
//!
//! `PROPTEST_CASES=100000 cargo test --release --test fast fuzz` runs more cases. Checkpoints are read by serde:
//! `tests/coupled/checkpoint/text.rs` damages those.

use std::io::Read;

use basemat::motion::{
    AccelerationUnit, AfadFormat, AlongLinesFormat, ColumnFormat, CosmosFormat, EsmFormat,
    GeoNetFormat, KNetCsvFormat, KNetFormat, PeerFormat, Record, RecordFormat, SlistFormat,
    SmcFormat,
};
use basemat::{Error, FileError, Result};
use proptest::prelude::*;
use proptest::sample::Index;

/// A valid file of each format, with its reader.
fn valid_files() -> Vec<(&'static str, Box<dyn RecordFormat>)> {
    let columns = ColumnFormat::new(AccelerationUnit::Gal);
    let along = AlongLinesFormat::new(AccelerationUnit::StandardGravity, 0.01);
    vec![
        (include_str!("../data/records/eight_per_line.txt"), Box::new(along)),
        (
            include_str!("../data/records/shake91.acc"),
            Box::new(AlongLinesFormat { layout: "8F9.6".parse().ok(), header_lines: 1, ..along }),
        ),
        (include_str!("../data/records/slist.txt"), Box::new(SlistFormat::default())),
        (include_str!("../data/records/esm.asc"), Box::new(EsmFormat)),
        (include_str!("../data/records/afad.txt"), Box::new(AfadFormat::default())),
        (include_str!("../data/records/knet.csv"), Box::new(KNetCsvFormat::default())),
        (include_str!("../data/records/csmip_v1.v1"), Box::new(CosmosFormat::default())),
        (include_str!("../data/records/smc.smc"), Box::new(SmcFormat)),
        (include_str!("../data/records/geonet.v2a"), Box::new(GeoNetFormat::default())),
        (
            "PEER NGA STRONG MOTION DATABASE RECORD\nEl Centro, 180\n\
             ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=     6, DT=   .0100 SEC,\n \
             .1E-02-.2E-02  .3E-02  .4E-02-.5E-02\n  .6E-02\n",
            Box::new(PeerFormat),
        ),
        ("Title\nUNITS OF G\n   4    .0100    NPTS, DT\n 1 2\r\n 3 4\r\n", Box::new(PeerFormat)),
        (
            "Corrected accelerogram\n\
             4 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.3)\n    \
             1.000    -2.000     3.000-12345.678\n\
             4 points of veloc data equally spaced at  .005 sec, in cm/sec.  (8f10.3)\n    \
             1.000    -2.000     3.000     4.000\n/&  ---- End of data for channel  1 ----\n",
            Box::new(CosmosFormat::default()),
        ),
        (
            "36 Real-header values follow on   6 lines, Format= (6F13.6)\n\
             1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\n1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 .5 1 1\n\
             3 acceleration pts, approx  0 secs, units=cm/s^2 (4),Format=(10F8.5)\n\
             -0.00003-0.00004 9.99999\nEnd-of-data for Chan  1 acceleration\n",
            Box::new(CosmosFormat::default()),
        ),
        (
            "Origin Time       2011/03/11 14:46:00\nSampling Freq(Hz) 2Hz\nDuration Time(s)  3\n\
             Scale Factor      2000(gal)/1000\nMemo.\n 1 2 3 4\n 5 -6\n",
            Box::new(KNetFormat),
        ),
        ("# station 1\nt,a\n0.00, 0\n0.01, 98.1\n0.02, -49.05\n", Box::new(columns)),
        (
            "1 0.0 5\n2 0.1 -5\n3 0.2 7\n",
            Box::new(ColumnFormat { time_column: 2, acceleration_column: Some(3), ..columns }),
        ),
    ]
}

/// Asserts that every method works on a record, or that an error names its line.
fn check(result: Result<Record>) {
    match result {
        Ok(record) => {
            assert!(record.len() >= 2 && record.time_step() > 0.0);
            for values in [record.accelerations(), record.velocities(), record.displacements()] {
                assert_eq!(values.len(), record.len());
                assert!(values.iter().all(|value| value.is_finite()));
            }
            let _ = record.at(0.5 * record.duration()).displacement;
        }
        Err(Error::File(FileError { line, fault, .. })) => {
            assert!(!fault.to_string().is_empty() && line < 1 << 40);
        }
        Err(Error::Input { needed, .. }) => assert!(!needed.is_empty()),
        Err(other) => panic!("{other}"),
    }
}

/// GOAL: the valid files are read.
#[test]
fn valid_files_are_read() {
    for (text, format) in valid_files() {
        let record = Record::from_reader("valid", text.as_bytes(), format.as_ref()).unwrap();
        assert!(record.len() >= 3, "{text}");
    }
}

/// One change of the bytes of a file.
#[derive(Debug, Clone)]
enum FileDamage {
    Overwrite(u8),
    Insert(Vec<u8>),
    Remove(usize),
    /// A part of the file again, somewhere else.
    Repeat(Index, usize),
    Cut,
}

fn damage() -> impl Strategy<Value = FileDamage> {
    let pieces = [
        "-",
        "+",
        "E",
        "e9",
        "1e308",
        "nan",
        "inf",
        ".",
        "\n",
        "\r",
        ",",
        " ",
        "\0",
        "\u{feff}",
        "é",
        "99999999999999999999",
        "4.9e-324",
        "#",
        "=",
        "(gal)/",
        "NPTS",
        "DT",
        "(",
        "[ms]",
        "（",
        "cm/s²_",
    ];
    prop_oneof![
        any::<u8>().prop_map(FileDamage::Overwrite),
        prop::sample::select(pieces.to_vec())
            .prop_map(|piece| FileDamage::Insert(piece.as_bytes().to_vec())),
        prop::collection::vec(any::<u8>(), 1..6).prop_map(FileDamage::Insert),
        (1_usize..40).prop_map(FileDamage::Remove),
        (any::<Index>(), 1_usize..120).prop_map(|(from, length)| FileDamage::Repeat(from, length)),
        Just(FileDamage::Cut),
    ]
}

fn damaged(text: &str, damages: &[(Index, FileDamage)]) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for (place, damage) in damages {
        if bytes.is_empty() {
            break;
        }
        let index = place.index(bytes.len());
        match damage {
            FileDamage::Overwrite(value) => bytes[index] = *value,
            FileDamage::Insert(piece) => {
                bytes.splice(index..index, piece.iter().copied());
            }
            FileDamage::Remove(length) => {
                bytes.drain(index..(index + length).min(bytes.len()));
            }
            FileDamage::Repeat(from, length) => {
                let from = from.index(bytes.len());
                let part = bytes[from..(from + length).min(bytes.len())].to_vec();
                bytes.splice(index..index, part);
            }
            FileDamage::Cut => bytes.truncate(index),
        }
    }
    bytes
}

/// A source that delivers a few bytes per call, and fails after some.
struct FailingSource<'a> {
    bytes: &'a [u8],
    bytes_per_call: usize,
    /// Bytes until the failure.
    remaining: usize,
}

impl Read for FailingSource<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.remaining == 0 {
            return Err(std::io::Error::from(std::io::ErrorKind::ConnectionReset));
        }
        let count = self.bytes_per_call.min(self.remaining).min(self.bytes.len()).min(buffer.len());
        buffer[..count].copy_from_slice(&self.bytes[..count]);
        self.bytes = &self.bytes[count..];
        self.remaining -= count;
        Ok(count)
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// GOAL: damaged files give a record or an error.
    #[test]
    fn damaged_files_are_read_or_are_errors(
        damages in prop::collection::vec((any::<Index>(), damage()), 1..8),
    ) {
        for (text, format) in valid_files() {
            let bytes = damaged(text, &damages);
            check(Record::from_reader("damaged", &bytes[..], format.as_ref()));
        }
    }

    /// GOAL: arbitrary bytes give a record or an error.
    #[test]
    fn any_bytes_are_read_or_are_errors(bytes in prop::collection::vec(any::<u8>(), 0..500)) {
        for (_, format) in valid_files() {
            check(Record::from_reader("any", &bytes[..], format.as_ref()));
        }
    }

    /// GOAL: sources that fail within a file give an error.
    #[test]
    fn sources_that_fail_are_errors(bytes_per_call in 1_usize..9, fraction in 0.0..1.2_f64) {
        for (text, format) in valid_files() {
            let bytes = text.as_bytes();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
            let remaining = (fraction * bytes.len() as f64) as usize;
            let source = FailingSource { bytes, bytes_per_call, remaining };
            let outcome = Record::from_reader("failing", source, format.as_ref());
            prop_assert!(
                remaining > bytes.len() || !text.contains("PEER") || outcome.is_err()
            );
            check(outcome);
        }
    }
}

/// GOAL: files that are hard to read give a record or an error, with every reader.
#[test]
fn corpus_is_read_or_are_errors() {
    let folder = basemat_problems::data_path("fuzz");
    let mut files = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        files += 1;
        for (_, format) in valid_files() {
            check(Record::read(&path, format.as_ref()));
        }
    }
    assert!(files >= 13, "{files}");
}
