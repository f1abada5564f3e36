//! GOAL: quantities that a file states twice must agree, and all must be in the unit of its samples.
//! SCENE: the files of the agencies, changed in one place, so that one other place contradicts it.
//! REFERENCE: the other place.

use basemat::motion::{
    AfadFormat, CosmosFormat, EsmFormat, GeoNetFormat, KNetCsvFormat, KNetFormat, RecordFormat,
    SmcFormat,
};

use super::agency_files::bytes;
use super::{error_in, read};

/// Changes of a file, and the beginning and end of the error's text.
type FileChange = (&'static [(&'static str, &'static str)], &'static str);

const OTHER_PEAK: &str = "peak acceleration (m/s²) is …, as the file states elsewhere";
const OTHER_DURATION: &str =
    "number of samples times the time step (s) is …, as the file states elsewhere";
const OTHER_UNIT: &str = "title is …, in which the column is read";
const NOT_ACCELERATION: &str = "'… instead of an acceleration in a known unit";

/// Asserts the error of each change.
#[track_caller]
fn assert_errors(name: &str, format: &dyn RecordFormat, changes: &[FileChange]) {
    let text = String::from_utf8(bytes(name)).unwrap();
    assert!(read(&text, format).is_ok());
    for (replacements, expected) in changes {
        let mut changed = text.clone();
        for (from, to) in *replacements {
            assert!(changed.contains(from), "{name}: {from}");
            changed = changed.replacen(from, to, 1);
        }
        let error = error_in(&changed, format);
        let fault = error.fault.to_string();
        let (start, end) = expected.split_once('…').unwrap_or((expected, expected));
        assert!(
            fault.starts_with(start) && fault.ends_with(end),
            "{name}, {replacements:?}: {error}, not {expected}"
        );
    }
}

/// GOAL: the time step, number of points and peak of a CSMIP file agree.
#[test]
fn contradictions_in_csmip_files_are_errors() {
    let step = "time step of the title (s) is …, as the file states elsewhere";
    assert_errors(
        "csmip.v2",
        &CosmosFormat::default(),
        &[
            (&[("equally spaced at  .010", "equally spaced at  .005")], step),
            (&[("intervals of    .010", "intervals of    .020")], step),
            (
                &[("100 points of instrument", " 99 points of instrument")],
                "number of points of the title is …, as the file states elsewhere",
            ),
            (&[("in cm/sec2", "in g     ")], OTHER_PEAK),
            (&[("108.580    cm/sec/sec", "108.580    mm/sec/sec")], OTHER_PEAK),
            (&[("108.580    cm/sec/sec", "108.580    mg        ")], NOT_ACCELERATION),
        ],
    );
}

/// GOAL: interval, duration, unit and peak of a COSMOS file agree.
#[test]
fn contradictions_in_cosmos_files_are_errors() {
    assert_errors(
        "cosmos.v2c",
        &CosmosFormat::default(),
        &[
            (&[("10.000000       1.000000", "20.000000       1.000000")], OTHER_DURATION),
            (&[("10.000000       1.000000", "10.000000       3.000000")], OTHER_DURATION),
            (&[("approx    1 secs", "approx    5 secs")], OTHER_DURATION),
            (
                &[("       1       4     120", "       1       2     120")],
                "unit is …, but must be clear: all of it a known number, unit or word",
            ),
            (
                &[("cm/sec2(04)", "g      (02)")],
                "unit is …, but must be clear: all of it a known number, unit or word",
            ),
            (&[("cm/sec2(04)", "cm/sec2(02)")], NOT_ACCELERATION),
            (&[("108.580490       0.10", "  1.085805       0.10")], OTHER_PEAK),
        ],
    );
}

/// GOAL: frequency, duration, unit and peak of K-NET files agree; duration and frequency give the number of samples.
#[test]
fn contradictions_in_k_net_files_are_errors() {
    assert_errors(
        "k_net.ns",
        &KNetFormat,
        &[
            (&[("100Hz", "200Hz")], "number of samples is 100, but must be 200"),
            (
                &[("Duration Time(s)  1", "Duration Time(s)  2")],
                "number of samples is 100, but must be 200",
            ),
            (&[("3920(gal)", "39.2(gal)")], OTHER_PEAK),
            (&[("Max. Acc. (gal)", "Max. Acc. (g)  ")], OTHER_UNIT),
            (&[("Max. Acc. (gal)", "Max. Acc. (m/s2)")], OTHER_UNIT),
        ],
    );
    assert_errors(
        "k_net.csv",
        &KNetCsvFormat::default(),
        &[
            (&[("Freq(Hz),100", "Freq(Hz),200")], "time is … with equal steps"),
            (&[("Freq(Hz),100", "Freq(Hz),50")], "time is … with equal steps"),
            (&[("00:00:00.10,", "00:00:00.20,")], "time is … with equal steps"),
            (&[("Duration Time(s),1", "Duration Time(s),2")], OTHER_DURATION),
            (&[("Time,NS", "Time,NS(g)")], OTHER_UNIT),
            (&[("(gal),108.580", "(gal),1.086")], OTHER_PEAK),
            (&[("Max. Acc. (gal)", "Max. Acc. (g)")], OTHER_UNIT),
        ],
    );
}

/// GOAL: interval, duration, number of samples, unit and peak of an ESM file agree.
#[test]
fn contradictions_in_esm_files_are_errors() {
    assert_errors(
        "esm_hne.asc",
        &EsmFormat,
        &[
            (&[("SAMPLING_INTERVAL_S: 0.010", "SAMPLING_INTERVAL_S: 0.005")], OTHER_DURATION),
            (&[("DURATION_S: 1.000", "DURATION_S: 2.000")], OTHER_DURATION),
            (&[("NDATA: 100", "NDATA: 99")], "number of samples is 100, but must be 99"),
            (&[("UNITS: cm/s^2", "UNITS: m/s^2")], OTHER_PEAK),
            (&[("PGA_CM/S^2", "PGA_M/S^2")], OTHER_PEAK),
            (&[("UNITS: cm/s^2", "UNITS: cm/s")], NOT_ACCELERATION),
            (&[("DATA_TYPE: ACCELERATION", "DATA_TYPE: VELOCITY")], NOT_ACCELERATION),
        ],
    );
}

/// GOAL: number of samples, peaks, columns and units of an AFAD file agree; the unit may be in either title.
#[test]
fn contradictions_in_afad_files_are_errors() {
    assert_errors(
        "afad_three.txt",
        &AfadFormat::default(),
        &[
            (
                &[("NUMBER OF DATA          : 100", "NUMBER OF DATA          : 99")],
                "number of samples is 100, but must be 99",
            ),
            (&[("(E-W) 83.", "(E-W) 8.3")], OTHER_PEAK),
            (
                &[("(E-W) 83.", "(E-W) 83,")],
                "peak acceleration is …, but must be clear: all of it a known number, unit or word",
            ),
            (
                &[("E-W          U-D\r\n ", "E-W\r\n ")],
                "number of columns is 3, but must be 2, as before",
            ),
            (&[("VALUES (gal)", "VALUES (mg)")], OTHER_UNIT),
            (&[("VALUES (gal)", "VALUES (g)")], OTHER_UNIT),
            (&[("VALUES (gal)", "VALUES (m/s2)")], OTHER_UNIT),
            (&[("       N-S ", "    N-S(g) ")], OTHER_UNIT),
            (&[("       N-S ", "    N-S (g) ")], OTHER_UNIT),
            (&[("       U-D\r", "  U-D (cm/s)\r")], OTHER_UNIT),
        ],
    );
    // The unit of the samples, in either place.
    let text = String::from_utf8(bytes("afad_three.txt")).unwrap();
    let expected = read(&text, &AfadFormat::default()).unwrap();
    for (from, to) in [
        ("VALUES (gal)", "VALUES (cm/s2)"),
        ("       N-S ", "  N-S (gal) "),
        ("VALUES (gal)", "VALUES      "),
    ] {
        let text = text.replacen(from, to, 1);
        assert_eq!(read(&text, &AfadFormat::default()).unwrap(), expected, "{to}");
    }
    let text = text.replacen("       N-S ", "  N-S (gal) ", 1).replace("(N-S) 108.", "(N-S) 10.8");
    let error = error_in(&text, &AfadFormat::default());
    assert_eq!(
        error.fault.to_string(),
        "peak acceleration (m/s²) is 1.0858049, but must be 0.10858049, as the file states elsewhere"
    );
}

/// GOAL: peaks, their time and the kind of data of an SMC file agree.
#[test]
fn contradictions_in_smc_files_are_errors() {
    assert_errors(
        "smc.smc",
        &SmcFormat,
        &[
            (
                &[("0.1000000E+03", "0.5000000E+02")],
                "time of the peak acceleration (s) is …, as the file states elsewhere",
            ),
            (&[("0.1085805E+03", "0.1085805E+02")], OTHER_PEAK),
            (&[("-0.8889819E+02", "-0.8889819E+00")], OTHER_PEAK),
            (&[("2 CORRECTED ACCELEROGRAM", "3 VELOCITY              ")], NOT_ACCELERATION),
            (
                &[("0.1000000E+03", "0.1700000E+39")],
                "'data in unequal steps' instead of corrected data: … (volume 2)",
            ),
        ],
    );
}

/// GOAL: time step, number of points, duration, peak and unit of a GeoNet file agree.
#[test]
fn contradictions_in_geonet_files_are_errors() {
    assert_errors(
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
            (&[("Duration   0.99", "Duration   1.99")], OTHER_DURATION),
            (&[("peak  21716.1", "peak   2171.6")], OTHER_PEAK),
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
