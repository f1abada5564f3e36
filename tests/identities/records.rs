//! GOAL: a record has the same samples from every format, and is written and read again.
//! SCENE: random samples in files of each format; the files of the agencies.
//! REFERENCE: the samples.

use basemat::motion::{
    AccelerationUnit, AfadFormat, AlongLinesFormat, ColumnFormat, CosmosFormat, EsmFormat,
    GeoNetFormat, KNetCsvFormat, KNetFormat, PeerFormat, Record, RecordFormat, SlistFormat,
    SmcFormat,
};
use basemat_problems::random::Random;

use super::compare::largest_difference;
use super::tally::{IdentityTally, scenes};

/// Names of all formats; `table.rs` compares them with the library's.
pub(crate) const FORMAT_NAMES: [&str; 11] = [
    "ColumnFormat",
    "AlongLinesFormat",
    "SlistFormat",
    "PeerFormat",
    "EsmFormat",
    "AfadFormat",
    "KNetFormat",
    "KNetCsvFormat",
    "CosmosFormat",
    "SmcFormat",
    "GeoNetFormat",
];

/// Standard gravity, m/s².
const STANDARD_GRAVITY: f64 = 9.80665;

/// One line of text for each sample.
fn lines(samples: &[f64], line: impl Fn(f64) -> String) -> String {
    samples.iter().map(|sample| line(*sample) + "\n").collect()
}

/// Eight samples on each line.
fn eight_on_a_line(samples: &[f64]) -> String {
    samples
        .chunks(8)
        .map(|row| {
            let numbers: Vec<String> = row.iter().map(|sample| format!("{sample:?}")).collect();
            numbers.join(" ") + "\n"
        })
        .collect()
}

/// Text of a file with these samples (gal) in a format, and its reader.
fn written(format: &str, step: f64, samples: &[f64]) -> Option<(String, Box<dyn RecordFormat>)> {
    let count = samples.len();
    Some(match format {
        "ColumnFormat" => {
            let times = samples.iter().enumerate();
            let text = times.map(|(k, sample)| format!("{} {sample:?}\n", k as f64 * step));
            (text.collect(), Box::new(ColumnFormat::new(AccelerationUnit::Gal)))
        }
        "AlongLinesFormat" => {
            let reader = AlongLinesFormat::new(AccelerationUnit::Gal, step);
            (eight_on_a_line(samples), Box::new(reader))
        }
        "SlistFormat" => {
            let rate = (1.0 / step).round();
            let head = format!(
                "TIMESERIES XX_STA1_00_HNE_D, {count} samples, {rate} sps, 2020-01-01T00:00:00.000000, \
                 SLIST, FLOAT, CM/S**2\n"
            );
            (head + &eight_on_a_line(samples), Box::new(SlistFormat::default()))
        }
        "PeerFormat" => {
            let title = "PEER NGA STRONG MOTION DATABASE RECORD\nNowhere, 1\n";
            let unit = "ACCELERATION TIME SERIES IN UNITS OF G\n";
            let head = format!("{title}{unit}NPTS= {count}, DT= {step} SEC\n");
            let in_gravity =
                lines(samples, |gal| format!(" {:?}", gal / (100.0 * STANDARD_GRAVITY)));
            (head + &in_gravity, Box::new(PeerFormat))
        }
        "EsmFormat" => {
            let head = format!(
                "EVENT_NAME: X\nEVENT_ID: 1\nSAMPLING_INTERVAL_S: {step}\nNDATA: {count}\n\
                 UNITS: cm/s^2\nUSER5:\n"
            );
            (head + &lines(samples, |gal| format!("{gal:?}")), Box::new(EsmFormat))
        }
        "AfadFormat" => {
            let head = format!(
                "STRONG GROUND MOTION RECORDS\nSTATION ID              : 0001\n\
                 NUMBER OF DATA          : {count}\nSAMPLING INTERVAL (sec) : {step}\n\
                 DISASTER AGENCY\n       N-S          E-W          U-D\n"
            );
            let rows = lines(samples, |gal| format!("{gal:?} {:?} {:?}", 0.5 * gal, 0.25 * gal));
            (head + &rows, Box::new(AfadFormat::default()))
        }
        "KNetCsvFormat" => {
            let head = format!(
                "#Origin Time,2024/01/01 12:00:00\n#Station Code,XXX001\n\
                 #Sampling Freq(Hz),{}\n#Time,NS,EW,UD\n",
                (1.0 / step).round()
            );
            let rows = samples.iter().enumerate().map(|(k, gal)| {
                let seconds = 15.0 + k as f64 * step;
                format!("12:00:{seconds:05.2},{gal:?},{:?},{:?}\n", 0.5 * gal, 0.25 * gal)
            });
            (head + &rows.collect::<String>(), Box::new(KNetCsvFormat::default()))
        }
        // Formats with counts and fixed widths are compared by the agencies' files below.
        _ => return None,
    })
}

/// GOAL: every format gives time step and samples of the file.
#[test]
fn every_format_holds_the_same_samples() {
    let mut tally = IdentityTally::new("records: the same samples from every format");
    let mut random = Random(141);
    for number in 0..scenes(20, 400) {
        let step = random.pick(&[0.01, 0.02, 0.05]);
        let count = random.pick(&[3, 17, 100, 250]);
        // The headers of some formats may state a peak or a duration; these do not.
        let samples: Vec<f64> = (0..count).map(|_| random.within(-300.0, 300.0)).collect();
        for format in FORMAT_NAMES {
            let Some((text, reader)) = written(format, step, &samples) else { continue };
            tally.scene(&[format]);
            let place = format!("{number}: {format}, {count} samples of {step} s");
            match Record::from_reader(format, text.as_bytes(), reader.as_ref()) {
                Ok(record) if record.len() == samples.len() => {
                    tally.within(&place, (record.time_step() / step - 1.0).abs(), 1e-12);
                    let expected: Vec<f64> = samples.iter().map(|gal| 0.01 * gal).collect();
                    let difference = largest_difference(record.accelerations(), &expected);
                    tally.within(&place, difference / 3.0, 1e-14);
                }
                Ok(record) => tally.fail(format!("{place}: {} samples", record.len())),
                Err(error) => tally.fail(format!("{place}: {error}")),
            }
        }
    }
    tally.close(1.0);
}

/// GOAL: records of all agencies, written as columns and read again, are the same to the last bit.
#[test]
fn records_are_read_again_as_they_were_written() {
    let mut tally = IdentityTally::new("records: written and read again");
    let files: [(&str, &'static str, Box<dyn RecordFormat>); 9] = [
        ("peer.at2", "PeerFormat", Box::new(PeerFormat)),
        ("esm_hne.asc", "EsmFormat", Box::new(EsmFormat)),
        ("afad_three.txt", "AfadFormat", Box::new(AfadFormat::default())),
        ("k_net.ns", "KNetFormat", Box::new(KNetFormat)),
        ("k_net.csv", "KNetCsvFormat", Box::new(KNetCsvFormat::default())),
        ("cosmos.v2c", "CosmosFormat", Box::new(CosmosFormat::default())),
        ("csmip.v2", "CosmosFormat", Box::new(CosmosFormat::default())),
        ("smc.smc", "SmcFormat", Box::new(SmcFormat)),
        ("geonet.v2a", "GeoNetFormat", Box::new(GeoNetFormat::default())),
    ];
    for (file, name, format) in files {
        tally.scene(&[name, "ColumnFormat"]);
        let path = basemat_problems::data_path(&format!("records/{file}"));
        let record = Record::read(path, format.as_ref()).unwrap();
        let columns = ColumnFormat::new(AccelerationUnit::MetrePerSecondSquared);
        match Record::from_reader(file, record.csv().as_bytes(), &columns) {
            Ok(read_again) if read_again == record => {}
            Ok(_) => tally.fail(format!("{file}: other samples")),
            Err(error) => tally.fail(format!("{file}: {error}")),
        }
    }
    tally.close(1.0);
}
