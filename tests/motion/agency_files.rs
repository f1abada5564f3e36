//! GOAL: records are read as the agencies publish them: samples, interval and unit.
//! SCENE: small files in the layout of each agency, with samples of our own (`tests/data/records`).
//! REFERENCE: the samples and the interval that the file was made with, which its header states in several places.

use basemat::RecordError;
use basemat::motion::{CosmosFormat, Record, RecordFormat};

use super::refusal;

const GRAVITY: f64 = 9.80665;
/// Samples of the files of CESMD, repeated.
const SAMPLES: [f64; 8] = [0.0, 12.5, -30.25, 44.0, -8.75, 3.0, 1.5, 0.0];

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(basemat_problems::data_path(&format!("records/{name}"))).unwrap()
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

fn repeated(times: usize, factor: f64) -> impl Iterator<Item = f64> {
    std::iter::repeat_n(SAMPLES, times).flatten().map(move |value| value * factor)
}

#[test]
fn cosmos_files_have_the_interval_of_their_data() {
    let format = CosmosFormat::default();
    is_read("cosmos_interval_5ms.v2c", &format, 0.005, repeated(50, 0.01));
    let (line, reason) = refusal(&bytes("cosmos_counts.v0c"), &format);
    assert!(line == 44 && matches!(reason, RecordError::Unprocessed { .. }), "{reason}");
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
        assert!(matches!(reason, RecordError::Contradiction { .. }), "{to}: {reason}");
    }
}

#[test]
fn csmip_files_of_all_years_are_read() {
    let format = CosmosFormat::default();
    is_read("csmip_1984.v2", &format, 0.02, repeated(2, 0.01));
    is_read("csmip_v1.v1", &format, 0.005, repeated(2, GRAVITY * 1e-3));
}
