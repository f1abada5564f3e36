//! GOAL: what a file states twice must agree, and what it states once must be in the unit of its samples.
//! SCENE: the files of the agencies, changed in one place, so that only one other place speaks against it.
//! REFERENCE: the other place.

use basemat::motion::{
    AfadFormat, CosmosFormat, EsmFormat, GeoNetFormat, KNetCsvFormat, KNetFormat, Record,
    RecordFormat, SmcFormat,
};

use super::agency_files::bytes;
use super::refusal;

/// Changes of a file, and the text of the error.
type Change = (&'static [(&'static str, &'static str)], &'static str);

const PEAK: &str = "peak acceleration (m/s²) is …, as the file states elsewhere";
const DURATION: &str =
    "number of samples times the time step (s) is …, as the file states elsewhere";
const TITLE_UNIT: &str = "title is …, in which the column is read";
const NOT_ACCELERATION: &str = "'… instead of an acceleration in a known unit";

/// Each change is refused for its own reason.
#[track_caller]
fn are_refused(name: &str, format: &dyn RecordFormat, changes: &[Change]) {
    let text = String::from_utf8(bytes(name)).unwrap();
    assert!(Record::from_reader(name, text.as_bytes(), format).is_ok());
    for (pairs, wanted) in changes {
        let mut changed = text.clone();
        for (from, to) in *pairs {
            assert!(changed.contains(from), "{name}: {from}");
            changed = changed.replacen(from, to, 1);
        }
        let (line, reason) = refusal(&changed, format);
        let (begin, end) = wanted.split_once('…').unwrap_or((wanted, wanted));
        let text = reason.to_string();
        assert!(
            text.starts_with(begin) && text.ends_with(end),
            "{name}, line {line}, {pairs:?}: {text}, not {wanted}"
        );
    }
}

#[test]
fn csmip_files_agree_with_themselves() {
    let step = "time step of the title (s) is …, as the file states elsewhere";
    are_refused(
        "csmip.v2",
        &CosmosFormat::default(),
        &[
            (&[("equally spaced at  .010", "equally spaced at  .005")], step),
            (&[("intervals of    .010", "intervals of    .020")], step),
            (
                &[("100 points of instrument", " 99 points of instrument")],
                "number of points of the title is …, as the file states elsewhere",
            ),
            (&[("in cm/sec2", "in g     ")], PEAK),
            (&[("108.580    cm/sec/sec", "108.580    mm/sec/sec")], PEAK),
            (&[("108.580    cm/sec/sec", "108.580    mg        ")], NOT_ACCELERATION),
        ],
    );
}

#[test]
fn cosmos_files_agree_with_themselves() {
    are_refused(
        "cosmos.v2c",
        &CosmosFormat::default(),
        &[
            (&[("10.000000       1.000000", "20.000000       1.000000")], DURATION),
            (&[("10.000000       1.000000", "10.000000       3.000000")], DURATION),
            (&[("approx    1 secs", "approx    5 secs")], DURATION),
            (
                &[("       1       4     120", "       1       2     120")],
                "unit is …, but must be clear: all of it a known number, unit or word",
            ),
            (
                &[("cm/sec2(04)", "g      (02)")],
                "unit is …, but must be clear: all of it a known number, unit or word",
            ),
            (&[("cm/sec2(04)", "cm/sec2(02)")], NOT_ACCELERATION),
            (&[("108.580490       0.10", "  1.085805       0.10")], PEAK),
        ],
    );
}

#[test]
fn k_net_files_agree_with_themselves() {
    // Duration and frequency together are the number of samples.
    are_refused(
        "k_net.ns",
        &KNetFormat,
        &[
            (&[("100Hz", "200Hz")], "number of samples is 100, but must be 200"),
            (
                &[("Duration Time(s)  1", "Duration Time(s)  2")],
                "number of samples is 100, but must be 200",
            ),
            (&[("3920(gal)", "39.2(gal)")], PEAK),
            (&[("Max. Acc. (gal)", "Max. Acc. (g)  ")], TITLE_UNIT),
            (&[("Max. Acc. (gal)", "Max. Acc. (m/s2)")], TITLE_UNIT),
        ],
    );
    are_refused(
        "k_net.csv",
        &KNetCsvFormat::default(),
        &[
            (&[("Freq(Hz),100", "Freq(Hz),200")], "time is … with equal steps"),
            (&[("Freq(Hz),100", "Freq(Hz),50")], "time is … with equal steps"),
            (&[("00:00:00.10,", "00:00:00.20,")], "time is … with equal steps"),
            (&[("Duration Time(s),1", "Duration Time(s),2")], DURATION),
            (&[("Time,NS", "Time,NS(g)")], TITLE_UNIT),
            (&[("(gal),108.580", "(gal),1.086")], PEAK),
            (&[("Max. Acc. (gal)", "Max. Acc. (g)")], TITLE_UNIT),
        ],
    );
}

#[test]
fn esm_files_agree_with_themselves() {
    are_refused(
        "esm_hne.asc",
        &EsmFormat,
        &[
            (&[("SAMPLING_INTERVAL_S: 0.010", "SAMPLING_INTERVAL_S: 0.005")], DURATION),
            (&[("DURATION_S: 1.000", "DURATION_S: 2.000")], DURATION),
            (&[("NDATA: 100", "NDATA: 99")], "number of samples is 100, but must be 99"),
            (&[("UNITS: cm/s^2", "UNITS: m/s^2")], PEAK),
            (&[("PGA_CM/S^2", "PGA_M/S^2")], PEAK),
            (&[("UNITS: cm/s^2", "UNITS: cm/s")], NOT_ACCELERATION),
            (&[("DATA_TYPE: ACCELERATION", "DATA_TYPE: VELOCITY")], NOT_ACCELERATION),
        ],
    );
}

#[test]
fn afad_files_agree_with_themselves() {
    are_refused(
        "afad_three.txt",
        &AfadFormat::default(),
        &[
            (
                &[("NUMBER OF DATA          : 100", "NUMBER OF DATA          : 99")],
                "number of samples is 100, but must be 99",
            ),
            (&[("(E-W) 83.", "(E-W) 8.3")], PEAK),
            (
                &[("(E-W) 83.", "(E-W) 83,")],
                "peak acceleration is …, but must be clear: all of it a known number, unit or word",
            ),
            (
                &[("E-W          U-D\r\n ", "E-W\r\n ")],
                "number of columns is 3, but must be 2, as before",
            ),
            (&[("VALUES (gal)", "VALUES (mg)")], TITLE_UNIT),
            (&[("VALUES (gal)", "VALUES (g)")], TITLE_UNIT),
            (&[("VALUES (gal)", "VALUES (m/s2)")], TITLE_UNIT),
            (&[("       N-S ", "    N-S(g) ")], TITLE_UNIT),
            (&[("       N-S ", "    N-S (g) ")], TITLE_UNIT),
            (&[("       U-D\r", "  U-D (cm/s)\r")], TITLE_UNIT),
        ],
    );
    // The unit of the samples, in either place.
    let text = String::from_utf8(bytes("afad_three.txt")).unwrap();
    let wanted = Record::from_reader("", text.as_bytes(), &AfadFormat::default()).unwrap();
    for (from, to) in [
        ("VALUES (gal)", "VALUES (cm/s2)"),
        ("       N-S ", "  N-S (gal) "),
        ("VALUES (gal)", "VALUES      "),
    ] {
        let text = text.replacen(from, to, 1);
        let read = Record::from_reader("", text.as_bytes(), &AfadFormat::default());
        assert_eq!(read.unwrap(), wanted, "{to}");
    }
    let text = text.replacen("       N-S ", "  N-S (gal) ", 1).replace("(N-S) 108.", "(N-S) 10.8");
    let (_, reason) = refusal(&text, &AfadFormat::default());
    assert_eq!(
        reason.to_string(),
        "peak acceleration (m/s²) is 1.0858049, but must be 0.10858049, as the file states elsewhere"
    );
}

#[test]
fn smc_files_agree_with_themselves() {
    are_refused(
        "smc.smc",
        &SmcFormat,
        &[
            (
                &[("0.1000000E+03", "0.5000000E+02")],
                "time of the peak acceleration (s) is …, as the file states elsewhere",
            ),
            (&[("0.1085805E+03", "0.1085805E+02")], PEAK),
            (&[("-0.8889819E+02", "-0.8889819E+00")], PEAK),
            (&[("2 CORRECTED ACCELEROGRAM", "3 VELOCITY              ")], NOT_ACCELERATION),
            (
                &[("0.1000000E+03", "0.1700000E+39")],
                "'data in unequal steps' instead of corrected data: … (volume 2)",
            ),
        ],
    );
}

#[test]
fn geonet_files_agree_with_themselves() {
    are_refused(
        "geonet.v2a",
        &GeoNetFormat::default(),
        &[
            (
                &[("data at 0.010 sec", "data at 0.020 sec")],
                "time step (s) is …, as the file states elsewhere",
            ),
            (
                &[("points    100", "points     99")],
                "number of points is …, as the file states elsewhere",
            ),
            (&[("Duration   0.99", "Duration   1.99")], DURATION),
            (&[("peak  21716.1", "peak   2171.6")], PEAK),
            (
                &[(
                    "21716.1 mm/s/s at   0.10 sec     rms      2.2 mm/s/s",
                    "21716.1 cm/s/s at   0.10 sec",
                )],
                NOT_ACCELERATION,
            ),
        ],
    );
}
