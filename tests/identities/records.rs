//! A record is the same samples from every format, and written and read again.

use basemat::motion::{
    AccelerationUnit, AfadFormat, AlongLinesFormat, ColumnFormat, CosmosFormat, EsmFormat,
    GeoNetFormat, KNetCsvFormat, KNetFormat, PeerFormat, Record, RecordFormat, SlistFormat,
    SmcFormat,
};
use basemat_problems::random::Random;

use super::tally::{Tally, scenes};

/// Names of all formats; `table.rs` compares them with the library's.
pub(crate) const FORMATS: [&str; 11] = [
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
const GRAVITY: f64 = 9.80665;

/// Text of a file with these samples (gal) in a format, and its reader.
fn written(format: &str, step: f64, samples: &[f64]) -> Option<(String, Box<dyn RecordFormat>)> {
    let count = samples.len();
    let lines = |of: &dyn Fn(f64) -> String| {
        samples.iter().map(|sample| of(*sample) + "\n").collect::<String>()
    };
    let eight_a_line = || {
        let rows = samples.chunks(8).map(|row| {
            let numbers: Vec<String> = row.iter().map(|sample| format!("{sample:?}")).collect();
            numbers.join(" ") + "\n"
        });
        rows.collect::<String>()
    };
    Some(match format {
        "ColumnFormat" => {
            let times = samples.iter().enumerate();
            let text = times.map(|(k, sample)| format!("{} {sample:?}\n", k as f64 * step));
            (text.collect(), Box::new(ColumnFormat::new(AccelerationUnit::Gal)))
        }
        "AlongLinesFormat" => {
            (eight_a_line(), Box::new(AlongLinesFormat::new(AccelerationUnit::Gal, step)))
        }
        "SlistFormat" => {
            let rate = (1.0 / step).round();
            let head = format!(
                "TIMESERIES XX_STA1_00_HNE_D, {count} samples, {rate} sps, 2020-01-01T00:00:00.000000, \
                 SLIST, FLOAT, CM/S**2\n"
            );
            (head + &eight_a_line(), Box::new(SlistFormat::default()))
        }
        "PeerFormat" => {
            let title = "PEER NGA STRONG MOTION DATABASE RECORD\nNowhere, 1\n";
            let unit = "ACCELERATION TIME SERIES IN UNITS OF G\n";
            let head = format!("{title}{unit}NPTS= {count}, DT= {step} SEC\n");
            let in_gravity = |gal: f64| format!(" {:?}", gal / (100.0 * GRAVITY));
            (head + &lines(&in_gravity), Box::new(PeerFormat))
        }
        "EsmFormat" => {
            let head = format!(
                "EVENT_NAME: X\nEVENT_ID: 1\nSAMPLING_INTERVAL_S: {step}\nNDATA: {count}\n\
                 UNITS: cm/s^2\nUSER5:\n"
            );
            (head + &lines(&|gal| format!("{gal:?}")), Box::new(EsmFormat))
        }
        "AfadFormat" => {
            let head = format!(
                "STRONG GROUND MOTION RECORDS\nSTATION ID              : 0001\n\
                 NUMBER OF DATA          : {count}\nSAMPLING INTERVAL (sec) : {step}\n\
                 DISASTER AGENCY\n       N-S          E-W          U-D\n"
            );
            let row = |gal: f64| format!("{gal:?} {:?} {:?}", 0.5 * gal, 0.25 * gal);
            (head + &lines(&row), Box::new(AfadFormat::default()))
        }
        "KNetCsvFormat" => {
            let head = format!(
                "#Origin Time,2024/01/01 12:00:00\n#Station Code,XXX001\n\
                 #Sampling Freq(Hz),{}\n#Time,NS,EW,UD\n",
                (1.0 / step).round()
            );
            let row = |(k, gal): (usize, &f64)| {
                let seconds = 15.0 + k as f64 * step;
                format!("12:00:{seconds:05.2},{gal:?},{:?},{:?}\n", 0.5 * gal, 0.25 * gal)
            };
            let body: String = samples.iter().enumerate().map(row).collect();
            (head + &body, Box::new(KNetCsvFormat::default()))
        }
        // Counts and fixed widths: their files are read below.
        _ => return None,
    })
}

#[test]
fn every_format_holds_the_same_samples() {
    let mut tally = Tally::new("records: the same samples from every format");
    let mut random = Random(141);
    for number in 0..scenes(20, 400) {
        let step = random.pick(&[0.01, 0.02, 0.05]);
        let count = random.pick(&[3, 17, 100, 250]);
        // The headers of some formats say a peak or a duration; none is given here.
        let samples: Vec<f64> = (0..count).map(|_| random.within(-300.0, 300.0)).collect();
        for format in FORMATS {
            let Some((text, reader)) = written(format, step, &samples) else { continue };
            tally.scene(&[format]);
            let place = format!("{number}: {format}, {count} samples of {step} s");
            match Record::from_reader(format, text.as_bytes(), reader.as_ref()) {
                Ok(record) if record.len() == samples.len() => {
                    tally.within(&place, (record.time_step() / step - 1.0).abs(), 1e-12);
                    let pairs = record.accelerations().iter().zip(&samples);
                    let apart = pairs
                        .fold(0.0, |most: f64, (found, gal)| most.max((found - 0.01 * gal).abs()));
                    tally.within(&place, apart / 3.0, 1e-14);
                }
                Ok(record) => tally.fail(format!("{place}: {} samples", record.len())),
                Err(error) => tally.fail(format!("{place}: {error}")),
            }
        }
    }
    tally.close(1.0);
}

/// Files of all agencies, written as columns and read again, to the last bit.
#[test]
fn records_are_read_again_as_they_were_written() {
    let mut tally = Tally::new("records: written and read again");
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
            Ok(again) if again == record => {}
            Ok(_) => tally.fail(format!("{file}: other samples")),
            Err(error) => tally.fail(format!("{file}: {error}")),
        }
    }
    tally.close(1.0);
}
