//! GOAL: records are read as the agencies publish them: samples, interval and unit.
//! SCENE: small files in the layout of each agency, with invented samples (`tests/data/records`).
//! REFERENCE: the samples and the interval that the file was made with, which its header states in several places.

use basemat::motion::{
    AccelerationUnit, AfadFormat, ColumnFormat, CosmosFormat, EsmFormat, GeoNetFormat,
    KNetCsvFormat, KNetFormat, PeerFormat, Record, RecordFormat, SmcFormat,
};
use basemat_problems::faults::{is_contradiction, is_unprocessed, value};

use super::{GRAVITY_UNIT, SI_UNIT, STANDARD_GRAVITY, error_at, error_in, read};

/// Samples of the short files of CESMD, repeated.
const SHORT_FILE_SAMPLES: [f64; 8] = [0.0, 12.5, -30.25, 44.0, -8.75, 3.0, 1.5, 0.0];

pub(super) fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(path(name)).unwrap()
}

/// Asserts time step (s) and accelerations (m/s²) of a file.
#[track_caller]
fn assert_file(
    name: &str,
    format: &dyn RecordFormat,
    time_step: f64,
    expected: impl Iterator<Item = f64>,
) {
    let record = read(&bytes(name), format).unwrap();
    let step_error = (record.time_step() / time_step - 1.0).abs();
    assert!(step_error < 1e-12, "{name}: {} s", record.time_step());
    let expected: Vec<f64> = expected.collect();
    assert_eq!(record.len(), expected.len(), "{name}");
    for (computed, expected) in record.accelerations().iter().zip(expected) {
        let error = (computed - expected).abs();
        assert!(error <= 1e-12 * expected.abs(), "{name}: {computed} {expected}");
    }
}

/// Components of the longer files (gal) at a time (s): decaying sines.
fn signal(component: usize, time: f64) -> f64 {
    let amplitude = [120.0, 90.0, 60.0][component];
    let frequency = [2.5, 3.5, 5.0][component];
    amplitude * (std::f64::consts::TAU * frequency * time).sin() * (-time).exp()
}

/// Asserts that a record is `factor` times a component of the longer files, to `tolerance` (gal) and a baseline.
#[track_caller]
fn assert_signal(record: &Record, component: usize, factor: f64, time_step: f64, tolerance: f64) {
    let step_error = (record.time_step() / time_step - 1.0).abs();
    assert!(step_error < 1e-12, "{} s", record.time_step());
    let count = if time_step < 0.01 { 200 } else { 100 };
    assert_eq!(record.len(), count);
    let offset = record.accelerations()[0];
    for (k, computed) in record.accelerations().iter().enumerate() {
        let expected = 0.01 * factor * signal(component, k as f64 * time_step);
        let error = (computed - offset - expected).abs();
        assert!(error <= 0.01 * tolerance, "sample {k}: {computed} {expected}");
    }
}

pub(super) fn path(name: &str) -> std::path::PathBuf {
    basemat_problems::data_path(&format!("records/{name}"))
}

/// Asserts the first record of a file: component, factor, time step (s), half of the last digit (gal).
#[track_caller]
fn assert_first_record(
    name: &str,
    format: &dyn RecordFormat,
    component: usize,
    factor: f64,
    time_step: f64,
    tolerance: f64,
) {
    let record = Record::read(path(name), format).unwrap();
    assert_signal(&record, component, factor, time_step, tolerance);
}

/// GOAL: the first record of a file of each agency is read.
#[test]
fn every_agency_is_read() {
    assert_first_record("peer.at2", &PeerFormat, 0, 1.0, 0.01, 1e-4);
    assert_first_record("cosmos.v2c", &CosmosFormat::default(), 0, 1.0, 0.01, 5.1e-6);
    assert_first_record("csmip.v2", &CosmosFormat::default(), 0, 1.0, 0.01, 5.1e-6);
    assert_first_record("k_net.ns", &KNetFormat, 0, 1.0, 0.01, 7e-4);
    assert_first_record("kik_net.ew2", &KNetFormat, 1, 1.0, 0.005, 3e-4);
    assert_first_record("k_net.csv", &KNetCsvFormat::default(), 0, 1.0, 0.01, 5.1e-4);
    assert_first_record("esm_hne.asc", &EsmFormat, 0, 1.0, 0.01, 5.1e-7);
    assert_first_record("afad_three.txt", &AfadFormat::default(), 0, 1.0, 0.01, 5.1e-7);
    assert_first_record("smc.smc", &SmcFormat, 0, 1.0, 0.01, 5.1e-3);
    assert_first_record("geonet.v2a", &GeoNetFormat::default(), 0, 20.0, 0.01, 5.1e-3);
}

/// Names and records of all components of a file.
fn read_all(name: &str, format: &dyn RecordFormat) -> Vec<(String, Record)> {
    Record::read_all(path(name), format).unwrap()
}

/// Asserts names and records of a file's components, the first with a factor, to `tolerance` (gal).
#[track_caller]
fn assert_station(
    file: &str,
    format: &dyn RecordFormat,
    names: &[&str],
    first_factor: f64,
    tolerance: f64,
) {
    let station = read_all(file, format);
    let computed: Vec<&str> = station.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(computed, names, "{file}");
    for (k, (_, record)) in station.iter().enumerate() {
        assert_signal(record, k, if k == 0 { first_factor } else { 1.0 }, 0.01, tolerance);
    }
}

/// GOAL: all components of a station are read from one file, with their names.
#[test]
fn components_of_a_station_are_read_at_once() {
    let cosmos = CosmosFormat::default();
    assert_station("cosmos.v2c", &cosmos, &["Chan 1: 0 Deg", "Chan 2: 90 Deg"], 1.0, 5.1e-6);
    let csmip_names = ["Chan 1: 90 Deg", "Chan 2: 180 Deg", "Chan 3: Up"];
    assert_station("csmip.v2", &cosmos, &csmip_names, 1.0, 5.1e-6);
    assert_station("k_net.csv", &KNetCsvFormat::default(), &["NS", "EW", "UD"], 1.0, 5.1e-4);
    let afad = AfadFormat::default();
    assert_station("afad_three.txt", &afad, &["N-S", "E-W", "U-D"], 1.0, 5.1e-7);
    // The first component is large enough for its numbers to touch.
    let geonet = GeoNetFormat::default();
    assert_station("geonet.v2a", &geonet, &["N10E", "N80W", "Up"], 20.0, 5.1e-3);
    let second = Record::read(path("geonet.v2a"), &GeoNetFormat { component: 2 }).unwrap();
    assert_eq!(second, read_all("geonet.v2a", &geonet)[1].1);
    let single = read_all("esm_hne.asc", &EsmFormat);
    assert_eq!((single.len(), single[0].0.as_str()), (1, "HNE"));
    for component in [0, 4] {
        let error = error_in(&bytes("afad_three.txt"), &AfadFormat { component });
        assert_eq!(
            error.fault,
            value("requested component", &component.to_string(), "from 1 to 3")
        );
    }
    let format = ColumnFormat::equally_spaced(GRAVITY_UNIT, 0.01);
    let columns = read_all("three_components.txt", &format);
    assert_eq!(columns[1].0, "column 2");
    assert_eq!(columns[1].1.accelerations(), [0.2, 0.21, 0.22].map(|a| a * STANDARD_GRAVITY));
}

/// The samples of the short files, repeated and scaled.
fn repeated(repetitions: usize, factor: f64) -> impl Iterator<Item = f64> {
    std::iter::repeat_n(SHORT_FILE_SAMPLES, repetitions)
        .flatten()
        .map(move |value| value * factor)
}

/// GOAL: COSMOS files are read with the interval of their data, or the recorder's if it is unknown.
#[test]
fn cosmos_files_have_the_interval_of_their_data() {
    let format = CosmosFormat::default();
    assert_file("cosmos_interval_5ms.v2c", &format, 0.005, repeated(50, 0.01));
    let error = error_in(&bytes("cosmos_counts.v0c"), &format);
    assert!(error.line == 44 && is_unprocessed(&error.fault), "{error}");
    assert!(error.fault.to_string().contains("raw counts"), "{error}");

    // If the interval of the data is unknown, the recorder's counts. A contradicting duration is an error.
    let text = String::from_utf8(bytes("cosmos_interval_5ms.v2c")).unwrap();
    let recorder = text.replace("     5.000000  -999", "  -999.000000  -999");
    assert_eq!(read(&recorder, &format).unwrap().time_step(), 0.005);
    for (from, to) in [
        ("     5.000000  -999", "    50.000000  -999"),
        ("     5.000000  -999", "     0.005000  -999"),
        ("approx    2 secs", "approx   20 secs"),
        ("     5.000000  -999.000000", "     5.000000     4.000000"),
    ] {
        assert!(text.contains(from));
        let error = error_in(&text.replace(from, to), &format);
        assert!(is_contradiction(&error.fault), "{to}: {error}");
    }
}

/// GOAL: CSMIP files of 1984 and of volume 1 are read.
#[test]
fn csmip_files_of_all_years_are_read() {
    let format = CosmosFormat::default();
    assert_file("csmip_1984.v2", &format, 0.02, repeated(2, 0.01));
    assert_file("csmip_v1.v1", &format, 0.005, repeated(2, STANDARD_GRAVITY * 1e-3));
}

/// GOAL: short files of other agencies are read by their format, and in columns after their header.
#[test]
fn short_files_of_other_agencies_are_read() {
    let peer = [0.1, -0.2, 0.3, 0.4].map(|a| a * STANDARD_GRAVITY);
    assert_file("at2_unitsare.at2", &PeerFormat, 0.02, peer.into_iter());
    assert_file("esm.asc", &EsmFormat, 0.005, [0.0, 0.01, -0.02, 0.005].into_iter());
    let first = [0.001, 0.0011, 0.0012];
    let second = [0.002, 0.0021, 0.0022];
    assert_file("afad.txt", &AfadFormat::default(), 0.01, first.into_iter());
    assert_file("knet.csv", &KNetCsvFormat { component: 2 }, 0.01, second.into_iter());
    // In columns: times of day, and lines of a header.
    let columns = ColumnFormat::new(AccelerationUnit::Gal);
    assert_file("knet.csv", &columns, 0.01, first.into_iter());
    let single = ColumnFormat::equally_spaced(AccelerationUnit::Gal, 0.005);
    let esm = ColumnFormat { header_lines: 7, ..single };
    assert_file("esm.asc", &esm, 0.005, [0.0, 0.01, -0.02, 0.005].into_iter());
    let afad = ColumnFormat { header_lines: 6, acceleration_column: Some(2), ..single };
    assert_file("afad.txt", &afad, 0.005, second.into_iter());
    for name in ["esm.asc", "afad.txt"] {
        for format in [columns, single] {
            let error = error_in(&bytes(name), &format);
            assert!(
                error.line == 2 && error.fault.to_string().contains("more than one line of header")
            );
            assert!(error.fault.to_string().contains("header_lines"), "{error}");
        }
    }
}

/// GOAL: times rounded too coarsely for a time step are errors; the error names `time_step`.
#[test]
fn times_that_are_rounded_too_coarsely_are_errors() {
    let columns = ColumnFormat::new(SI_UNIT);
    let error = error_in(&bytes("rounded128.csv"), &columns);
    assert!(error.line == 5 && error.fault.to_string().contains("`time_step`"), "{error}");
    let with_step = ColumnFormat { time_step: Some(1.0 / 128.0), ..columns };
    // 200 samples a second, printed to 10 ms.
    let text = "0.00 1\n0.01 2\n0.01 3\n0.02 4\n0.02 5\n";
    let needed = "stated (`time_step`): times rounded to 0.01 s do not show it";
    assert_eq!(error_in(text, &columns), error_at(3, value("time step", "near 0.005 s", needed)));
    let expected = (0..200).map(|k| f64::from(k % 5));
    assert_file("rounded128.csv", &with_step, 1.0 / 128.0, expected);
}
