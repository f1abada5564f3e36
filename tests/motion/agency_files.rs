//! GOAL: records are read as the agencies publish them: samples, interval and unit.
//! SCENE: small files in the layout of each agency, with samples of our own (`tests/data/records`).
//! REFERENCE: the samples and the interval that the file was made with, which its header states in several places.

use basemat::motion::{
    AccelerationUnit, AfadFormat, ColumnFormat, CosmosFormat, EsmFormat, GeoNetFormat,
    KNetCsvFormat, KNetFormat, PeerFormat, Record, RecordFormat, SmcFormat,
};
use basemat_problems::faults::{is_contradiction, is_unprocessed, value};

use super::refusal;

const GRAVITY: f64 = 9.80665;
/// Samples of the short files of CESMD, repeated.
const SAMPLES: [f64; 8] = [0.0, 12.5, -30.25, 44.0, -8.75, 3.0, 1.5, 0.0];

pub(super) fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(path(name)).unwrap()
}

#[track_caller]
fn is_read(name: &str, format: &dyn RecordFormat, step: f64, wanted: impl Iterator<Item = f64>) {
    let record = Record::from_reader(name, &bytes(name)[..], format).unwrap();
    let apart = (record.time_step() / step - 1.0).abs();
    assert!(apart < 1e-12, "{name}: {} s", record.time_step());
    let wanted: Vec<f64> = wanted.collect();
    assert_eq!(record.len(), wanted.len(), "{name}");
    for (found, wanted) in record.accelerations().iter().zip(wanted) {
        assert!((found - wanted).abs() <= 1e-12 * wanted.abs(), "{name}: {found} {wanted}");
    }
}

/// Components of the longer files (gal) at a time (s): decaying sines.
fn signal(component: usize, time: f64) -> f64 {
    let (amplitude, frequency) = [(120.0, 2.5), (90.0, 3.5), (60.0, 5.0)][component];
    amplitude * (std::f64::consts::TAU * frequency * time).sin() * (-time).exp()
}

/// Whether a record is a component of the longer files, to half of its last digit (gal) and a baseline.
#[track_caller]
fn is_signal(record: &Record, component: usize, times: f64, step: f64, digit: f64) {
    assert!((record.time_step() / step - 1.0).abs() < 1e-12, "{} s", record.time_step());
    let count = if step < 0.01 { 200 } else { 100 };
    assert_eq!(record.len(), count);
    let offset = record.accelerations()[0];
    for (k, found) in record.accelerations().iter().enumerate() {
        let wanted = 0.01 * times * signal(component, k as f64 * step);
        let apart = (found - offset - wanted).abs();
        assert!(apart <= 0.01 * digit, "sample {k}: {found} {wanted}");
    }
}

/// A file, its reader, the names of its components, the factor of the first, and half of the last digit, gal.
type Station = (&'static str, Box<dyn RecordFormat>, &'static [&'static str], f64, f64);

pub(super) fn path(name: &str) -> std::path::PathBuf {
    basemat_problems::data_path(&format!("records/{name}"))
}

#[test]
fn every_agency_is_read() {
    let one = |name, format: &dyn RecordFormat| Record::read(path(name), format).unwrap();
    is_signal(&one("peer.at2", &PeerFormat), 0, 1.0, 0.01, 1e-4);
    is_signal(&one("cosmos.v2c", &CosmosFormat::default()), 0, 1.0, 0.01, 5.1e-6);
    is_signal(&one("csmip.v2", &CosmosFormat::default()), 0, 1.0, 0.01, 5.1e-6);
    is_signal(&one("k_net.ns", &KNetFormat), 0, 1.0, 0.01, 7e-4);
    is_signal(&one("kik_net.ew2", &KNetFormat), 1, 1.0, 0.005, 3e-4);
    is_signal(&one("k_net.csv", &KNetCsvFormat::default()), 0, 1.0, 0.01, 5.1e-4);
    is_signal(&one("esm_hne.asc", &EsmFormat), 0, 1.0, 0.01, 5.1e-7);
    is_signal(&one("afad_three.txt", &AfadFormat::default()), 0, 1.0, 0.01, 5.1e-7);
    is_signal(&one("smc.smc", &SmcFormat), 0, 1.0, 0.01, 5.1e-3);
    is_signal(&one("geonet.v2a", &GeoNetFormat::default()), 0, 20.0, 0.01, 5.1e-3);
}

#[test]
fn components_of_a_station_are_read_at_once() {
    let all = |name, format: &dyn RecordFormat| Record::read_all(path(name), format).unwrap();
    let cases: [Station; 5] = [
        (
            "cosmos.v2c",
            Box::new(CosmosFormat::default()),
            &["Chan 1: 0 Deg", "Chan 2: 90 Deg"],
            1.0,
            5.1e-6,
        ),
        (
            "csmip.v2",
            Box::new(CosmosFormat::default()),
            &["Chan 1: 90 Deg", "Chan 2: 180 Deg", "Chan 3: Up"],
            1.0,
            5.1e-6,
        ),
        ("k_net.csv", Box::new(KNetCsvFormat::default()), &["NS", "EW", "UD"], 1.0, 5.1e-4),
        ("afad_three.txt", Box::new(AfadFormat::default()), &["N-S", "E-W", "U-D"], 1.0, 5.1e-7),
        ("geonet.v2a", Box::new(GeoNetFormat::default()), &["N10E", "N80W", "Up"], 20.0, 5.1e-3),
    ];
    for (name, format, names, times, digit) in cases {
        let station = all(name, format.as_ref());
        let found: Vec<&str> = station.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(found, names, "{name}");
        for (k, (_, record)) in station.iter().enumerate() {
            // The file of GeoNet has a first component large enough for its numbers to touch.
            is_signal(record, k, if k == 0 { times } else { 1.0 }, 0.01, digit);
        }
    }
    let second = Record::read(path("geonet.v2a"), &GeoNetFormat { component: 2 }).unwrap();
    assert_eq!(second, all("geonet.v2a", &GeoNetFormat::default())[1].1);
    let single = all("esm_hne.asc", &EsmFormat);
    assert_eq!((single.len(), single[0].0.as_str()), (1, "HNE"));
    for component in [0, 4] {
        let (_, reason) = refusal(&bytes("afad_three.txt"), &AfadFormat { component });
        assert_eq!(reason, value("requested channel", &component.to_string(), "from 1 to 3"));
    }
    let format = ColumnFormat::equally_spaced(AccelerationUnit::StandardGravity, 0.01);
    let columns = all("three_components.txt", &format);
    assert_eq!(columns[1].0, "column 2");
    assert_eq!(columns[1].1.accelerations(), [0.2, 0.21, 0.22].map(|a| a * GRAVITY));
}

fn repeated(times: usize, factor: f64) -> impl Iterator<Item = f64> {
    std::iter::repeat_n(SAMPLES, times).flatten().map(move |value| value * factor)
}

#[test]
fn cosmos_files_have_the_interval_of_their_data() {
    let format = CosmosFormat::default();
    is_read("cosmos_interval_5ms.v2c", &format, 0.005, repeated(50, 0.01));
    let (line, reason) = refusal(&bytes("cosmos_counts.v0c"), &format);
    assert!(line == 44 && is_unprocessed(&reason), "{reason}");
    assert!(reason.to_string().contains("raw counts"), "{reason}");

    // The interval of the data is unknown: the recorder's counts. Neither is right if the duration is another one.
    let text = String::from_utf8(bytes("cosmos_interval_5ms.v2c")).unwrap();
    let read = |text: &str| Record::from_reader("text", text.as_bytes(), &format);
    let recorder = text.replace("     5.000000  -999", "  -999.000000  -999");
    assert_eq!(read(&recorder).unwrap().time_step(), 0.005);
    for (from, to) in [
        ("     5.000000  -999", "    50.000000  -999"),
        ("     5.000000  -999", "     0.005000  -999"),
        ("approx    2 secs", "approx   20 secs"),
        ("     5.000000  -999.000000", "     5.000000     4.000000"),
    ] {
        assert!(text.contains(from));
        let (_, reason) = refusal(&text.replace(from, to), &format);
        assert!(is_contradiction(&reason), "{to}: {reason}");
    }
}

#[test]
fn csmip_files_of_all_years_are_read() {
    let format = CosmosFormat::default();
    is_read("csmip_1984.v2", &format, 0.02, repeated(2, 0.01));
    is_read("csmip_v1.v1", &format, 0.005, repeated(2, GRAVITY * 1e-3));
}

#[test]
fn short_files_of_other_agencies_are_read() {
    is_read(
        "at2_unitsare.at2",
        &PeerFormat,
        0.02,
        [0.1, -0.2, 0.3, 0.4].into_iter().map(|a| a * GRAVITY),
    );
    is_read("esm.asc", &EsmFormat, 0.005, [0.0, 0.01, -0.02, 0.005].into_iter());
    let (first, second) = ([0.001, 0.0011, 0.0012], [0.002, 0.0021, 0.0022]);
    is_read("afad.txt", &AfadFormat::default(), 0.01, first.into_iter());
    is_read("knet.csv", &KNetCsvFormat { component: 2 }, 0.01, second.into_iter());
    // By columns: times of day, and lines that are passed over.
    let columns = ColumnFormat::new(AccelerationUnit::Gal);
    is_read("knet.csv", &columns, 0.01, first.into_iter());
    let single = ColumnFormat::equally_spaced(AccelerationUnit::Gal, 0.005);
    let esm = ColumnFormat { header_lines: 7, ..single };
    is_read("esm.asc", &esm, 0.005, [0.0, 0.01, -0.02, 0.005].into_iter());
    let afad = ColumnFormat { header_lines: 6, acceleration_column: Some(2), ..single };
    is_read("afad.txt", &afad, 0.005, second.into_iter());
    for name in ["esm.asc", "afad.txt"] {
        for format in [columns, single] {
            let (line, reason) = refusal(&bytes(name), &format);
            assert!(line == 2 && reason.to_string().contains("more than one line of header"));
            assert!(reason.to_string().contains("header_lines"), "{reason}");
        }
    }
}

#[test]
fn times_that_are_rounded_too_coarsely_ask_for_the_step() {
    let columns = ColumnFormat::new(AccelerationUnit::MetrePerSecondSquared);
    let (line, reason) = refusal(&bytes("rounded128.csv"), &columns);
    assert!(line == 5 && reason.to_string().contains("`time_step`"), "{line}: {reason}");
    let given = ColumnFormat { time_step: Some(1.0 / 128.0), ..columns };
    // 200 samples a second, printed to 10 ms.
    let text = "0.00 1\n0.01 2\n0.01 3\n0.02 4\n0.02 5\n";
    let needed = "given (`time_step`): times rounded to 0.01 s do not tell it";
    assert_eq!(refusal(text, &columns), (3, value("time step", "near 0.005 s", needed)));
    let wanted = (0..200).map(|k| f64::from(k % 5));
    is_read("rounded128.csv", &given, 1.0 / 128.0, wanted);
}
