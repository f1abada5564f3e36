//! GOAL: files of the strong-motion databases are read in every layout in use, or refused with line
//! and reason.
//! SCENE: variants of PEER, COSMOS, CSMIP and K-NET files, printed here after the layouts that `agency_files` reads;
//! any bytes.
//! REFERENCE: the samples that were printed.

use basemat::motion::{
    AccelerationUnit, CosmosFormat, KNetFormat, PeerFormat, Record, RecordFormat, el_centro_1940,
};
use basemat::{Error, FileFault};
use basemat_problems::faults::{
    count, is_contradiction, is_missing, is_no_acceleration, is_no_number, is_unprocessed,
    not_a_number, value,
};
use proptest::prelude::*;

use super::refusal;

const GRAVITY: f64 = 9.80665;

fn read(text: &str, format: &dyn RecordFormat) -> Result<Record, Error> {
    Record::from_reader("file", text.as_bytes(), format)
}

#[track_caller]
fn same(record: &Record, step: f64, wanted: &[f64]) {
    assert!((record.time_step() / step - 1.0).abs() < 1e-15);
    assert_eq!(record.len(), wanted.len());
    for (found, wanted) in record.accelerations().iter().zip(wanted) {
        assert!((found - wanted).abs() <= 1e-14 * wanted.abs(), "{found} {wanted}");
    }
}

const PEER_TITLE: &str = "PEER NGA STRONG MOTION DATABASE RECORD\nEl Centro, 180\n";

#[test]
fn peer_headers_vary() {
    let body = " .100E-02 -.2000E-02-.300E-02\r\n  .4\r\n";
    let wanted = [1e-3, -2e-3, -3e-3, 0.4].map(|a| a * GRAVITY);
    for header in [
        "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   4, DT=   .0100 SEC,\n",
        "ACCELERATION TIME HISTORY IN UNITS OF G.\nNPTS= 4, DT= .01000 SEC\n",
        "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=4, DT=.01\n",
        "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz\n\
         NPTS=   4, DT=  .01000 SEC\n",
        "Acceleration time series in units of g (9.81)\n4  .01  NPTS, DT\n",
        "ACCELERATION TIME SERIES (G)\nNPTS= 4, DT= .01\n",
        "UNITS OF G\nNPTS=      4  DT=  0.0100 SEC,\n",
        "ACCELERATION TIME SERIES IN UNITS OF G\n   4    .0100    NPTS, DT\n",
        "ACCELERATION TIME SERIES IN UNITS OF G\n 4, 0.0100, NPTS, DT\n",
        "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS =   4, DT =  1.0E-02SEC\n",
    ] {
        let record = read(&format!("{PEER_TITLE}{header}{body}"), &PeerFormat).unwrap();
        same(&record, 0.01, &wanted);
    }
}

#[test]
fn peer_files_that_do_not_hold_what_they_say_are_refused() {
    let title = format!("{PEER_TITLE}ACCELERATION TIME SERIES IN UNITS OF G\n");
    let with = |rest: &str| refusal(&format!("{title}{rest}"), &PeerFormat);
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2\n"), (5, counted(2, 3)));
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2\n3 4\n"), (6, counted(4, 3)));
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2 3\n\n4\n"), (7, counted(4, 3)));
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2 x3\n"), (5, not_a_number("x3")));
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2 ***\n"), (5, not_a_number("***")));
    for header in ["NPTS= 3, DT= 0 SEC", "NPTS= 1, DT= 1", "NPTS=, DT=", "NPTS= 1e99, DT=.1"] {
        let (line, reason) = with(&format!("{header}\n1 2 3\n"));
        assert!(line == 4 && is_missing(&reason), "{header}: {reason}");
    }
    let (_, reason) = refusal(&format!("{PEER_TITLE}no numbers\n"), &PeerFormat);
    assert!(is_missing(&reason));
    for other in [
        "VELOCITY TIME SERIES IN UNITS OF CM/S",
        "VELOCITY TIME SERIES (CM/S)",
        "VELOCITY TIME HISTORY",
        "DISPLACEMENT TIME SERIES IN UNITS OF CM",
        "ACCELERATION IN UNITS OF CM/S/S",
        "ACCELERATION TIME SERIES (CM/S/S)",
        "ACCELERATION TIME SERIES IN UNITS OF GAL",
    ] {
        let text = format!("{PEER_TITLE}{other}\nNPTS= 2, DT= .01 SEC\n1 2\n");
        let (line, reason) = refusal(&text, &PeerFormat);
        assert!(line == 3 && is_no_acceleration(&reason), "{reason}");
    }
}

#[test]
fn peer_files_must_name_their_unit() {
    for header in ["", "SAN FRANCISCO (G)\n", "ACCELERATION TIME SERIES\n"] {
        let text = format!("{PEER_TITLE}{header}NPTS= 2, DT= .01 SEC\n1 2\n");
        let (line, reason) = refusal(&text, &PeerFormat);
        assert_eq!(line, if header.is_empty() { 3 } else { 4 });
        let unit = "there is no unit (UNITS OF G) in the header, or none that makes sense";
        assert!(is_missing(&reason) && reason.to_string() == unit, "{reason}");
    }
    // A step that is a number, but no record's.
    let text = format!("{PEER_TITLE}UNITS OF G\nNPTS= 2, DT= 1e308 SEC\n1 2\n");
    assert!(matches!(refusal(&text, &PeerFormat), (0, FileFault::Unusable(_))));
}

fn counted(found: usize, needed: usize) -> FileFault {
    count("samples", found, &needed.to_string())
}

#[test]
fn k_net_counts_become_accelerations() {
    let header = "Origin Time       2011/03/11 14:46:00\nLat.              38.103\n\
        Station Code      MYG004\nSampling Freq(Hz) 100Hz\nDuration Time(s)  DUR\nDir.              N-S\n\
        Scale Factor      7845(gal)/8223790\nMax. Acc. (gal)   176.166\nMemo.\n";
    let two_seconds = header.replace("DUR", "2");
    let counts: Vec<i32> = (0..200).map(|k| 100 - 7 * k * k).collect();
    let lines: Vec<String> = counts
        .chunks(8)
        .map(|row| row.iter().map(|count| format!("{count:9}")).collect::<Vec<_>>().concat())
        .collect();
    let text = format!("{two_seconds}{}\n", lines.join("\n"));
    let wanted: Vec<f64> =
        counts.iter().map(|&count| f64::from(count) * 78.45 / 8_223_790.0).collect();
    same(&read(&text, &KNetFormat).unwrap(), 0.01, &wanted);

    // The last line lost, or a second too many.
    let short = format!("{two_seconds}{}\n", lines[..24].join("\n"));
    assert_eq!(refusal(&short, &KNetFormat), (33, counted(192, 200)));
    assert_eq!(refusal(&text.replace("(s)  2", "(s)  3"), &KNetFormat), (34, counted(200, 300)));
    for (key, other) in [
        ("Sampling Freq(Hz) 100Hz", "Sampling Freq(Hz) 0Hz"),
        ("Sampling Freq(Hz) 100Hz", "Sampling Freq(Hz)"),
        ("Duration Time(s)  2", "Duration"),
        ("7845(gal)/8223790", "7845(gal)/0"),
        ("7845(gal)/8223790", "7845(m)/8223790"),
        ("Memo.", "Remark"),
    ] {
        let (_, reason) = refusal(&text.replace(key, other), &KNetFormat);
        assert!(is_missing(&reason), "{other}: {reason}");
    }
}

const CSMIP: &str = "Corrected accelerogram from Chan  1\n\
    3 points of accel data equally spaced at  .020 sec, in cm/sec2. (8f10.3)\n\
    1.000-12345.678     3.000\n\
    3 points of veloc data equally spaced at  .020 sec, in cm/sec.  (8f10.3)\n\
    1.000     2.000     3.000\n/&  ---------- End of data for channel  1 ----------\n\
    Corrected accelerogram from Chan  2\n\
    2 points of accel data equally spaced at  .010 sec, in g. (8f10.3)\n   .5 -.5\n";

#[test]
fn csmip_files_hold_channels() {
    let format = CosmosFormat::default();
    same(&read(CSMIP, &format).unwrap(), 0.02, &[0.01, -123.45678, 0.03]);
    let second = CosmosFormat { channel: 2, ..format };
    same(&read(CSMIP, &second).unwrap(), 0.01, &[0.5 * GRAVITY, -0.5 * GRAVITY]);
    for needed in [0, 3] {
        let (_, reason) = refusal(CSMIP, &CosmosFormat { channel: needed, ..format });
        assert_eq!(reason, value("requested channel", &needed.to_string(), "from 1 to 2"));
    }
    let counts = CSMIP.replace("in g.", "in counts.");
    let (line, reason) = refusal(&counts, &second);
    assert!(line == 8 && is_unprocessed(&reason), "{reason}");
    let short = &CSMIP[..CSMIP.len() - 5];
    assert_eq!(refusal(short, &second), (9, counted(1, 2)));
}

/// A count that is too small must not cut a record.
#[test]
fn numbers_beyond_the_announced_count_are_refused() {
    let format = CosmosFormat::default();
    let long = CSMIP.replace("3 points of accel", "2 points of accel");
    assert_eq!(refusal(&long, &format), (3, counted(3, 2)));
    let more = CSMIP.replace("12345.678     3.000\n", "12345.678     3.000\n     4.000\n");
    assert_eq!(refusal(&more, &format), (4, counted(4, 3)));
    let blank = CSMIP.replace("12345.678     3.000\n", "12345.678     3.000\n\n     4.000\n");
    assert_eq!(refusal(&blank, &format), (5, counted(4, 3)));
    let second = CosmosFormat { channel: 2, ..format };
    assert_eq!(refusal(&format!("{CSMIP} .25\n"), &second), (10, counted(3, 2)));
    let cosmos = cosmos_text(5.0).replace("10 acceleration pts", "9 acceleration pts");
    assert_eq!(refusal(&cosmos, &format), (23, counted(10, 9)));
    let cosmos = cosmos_text(5.0).replace("End-of-data", " 1.25\nEnd-of-data");
    assert_eq!(refusal(&cosmos, &format), (24, counted(11, 10)));
}

/// Ten samples with the interval of the data (ms), −999 for unknown; the recorder's interval is 20 ms.
fn cosmos_text(interval: f64) -> String {
    let mut header = vec![-999.0; 100];
    (header[33], header[61]) = (0.02, interval);
    let rows: Vec<String> = header
        .chunks(6)
        .map(|row| row.iter().map(|value| format!("{value:13.6}")).collect::<Vec<_>>().concat())
        .collect();
    format!(
        "Corrected acceleration (Format v01.20 with 13 text lines)\n\
         100 Real-header values follow on  17 lines, Format= (6F13.6)\n{}\n\
         1 Comment line(s) follow, each starting with a \"|\":\n| 3 acceleration pts\n\
         10 acceleration pts, approx  0 secs, units=cm/s^2 (4),Format=(10F8.5)\n\
         -0.00003-0.00004-0.00004-0.00004-0.00004-0.00004-0.00004-0.00004-0.00004 9.99999\n\
         End-of-data for Chan  1 acceleration\n",
        rows.join("\n")
    )
}

#[test]
fn cosmos_takes_the_interval_from_its_real_header() {
    let text = cosmos_text(5.0);
    let format = CosmosFormat::default();
    let mut wanted = [-4e-7; 10];
    (wanted[0], wanted[9]) = (-3e-7, 0.0999_999);
    same(&read(&text, &format).unwrap(), 0.005, &wanted);
    // Only the recorder's interval is known.
    let recorder = cosmos_text(-999.0);
    same(&read(&recorder, &format).unwrap(), 0.02, &wanted);
    let (_, reason) = refusal(&recorder.replace("     0.020000", "  -999.000000"), &format);
    let interval = "there is no sampling interval in the header, or none that makes sense";
    assert!(is_missing(&reason) && reason.to_string() == interval, "{reason}");
    let counts = text.replace("cm/s^2 (4)", "counts (50)");
    assert!(is_unprocessed(&refusal(&counts, &format).1));
    let contradicted = text.replace("cm/s^2 (4)", "cm/s^2 (2)");
    assert!(is_no_acceleration(&refusal(&contradicted, &format).1));
    // The title's duration.
    for seconds in [3, 50, 1000] {
        let text = text.replace("approx  0 secs", &format!("approx  {seconds} secs"));
        let (line, reason) = refusal(&text, &format);
        assert!(line == 22 && is_contradiction(&reason), "{reason}");
    }
}

/// Numbers that Fortran prints without a space between.
#[test]
fn full_columns_may_touch() {
    let csmip = |format: &str, body: &str| {
        let title = "4 points of accel data equally spaced at  .020 sec, in cm/sec2.";
        format!("{title} {format}\n{body}\n")
    };
    let read = |format: &str, body: &str| read(&csmip(format, body), &CosmosFormat::default());
    let wanted = [0.091_234_5, 0.101_234_5, 0.111_234_5, 0.123_45];
    same(&read("(4F8.5)", " 9.1234510.1234511.1234512.34500").unwrap(), 0.02, &wanted);
    same(&read("(2F8.5)", " 9.1234510.12345\n11.1234512.345").unwrap(), 0.02, &wanted);
    same(&read(",Format=4F8.5", " 9.1234510.1234511.1234512.34500").unwrap(), 0.02, &wanted);
    same(&read("(2I4)", "12345678\n   1  -2").unwrap(), 0.02, &[12.34, 56.78, 0.01, -0.02]);
    same(
        &read("(4D9.2)", " 1.00D+02 2.00D+01-3.00D+00 4.00D-01").unwrap(),
        0.02,
        &[1.0, 0.2, -0.03, 0.004],
    );
    // Lines that do not keep to the format are read as they stand.
    same(&read("(8F10.5)", "1 -2.5\n3 4").unwrap(), 0.02, &[0.01, -0.025, 0.03, 0.04]);
    same(&read("", "1 -2.5 3-4").unwrap(), 0.02, &[0.01, -0.025, 0.03, -0.04]);
    for (format, body) in [
        // Too wide for its column, as Fortran marks it.
        ("(4F8.5)", " 1.00000******** 2.00000 3.00000"),
        // Without the format nothing tells where one number ends.
        ("", "9.1234510.1234511.1234512.34500"),
    ] {
        let (line, reason) = refusal(&csmip(format, body), &CosmosFormat::default());
        assert!(line == 2 && is_no_number(&reason), "{reason}");
    }
}

/// A thousandth of a gal is not a gal, and a gallery is not a unit.
#[test]
fn units_of_cosmos_files_are_words() {
    let with = |units: &str| {
        CSMIP.replace("in cm/sec2. (8f10.3)", units).replace("Corrected", "Galileo Street")
    };
    let unit = AccelerationUnit::MetrePerSecondSquared;
    for units in ["in mgal. (8f10.3)", "units=mgal", "in cm/sec. (8f10.3)", "units=mg (11)"] {
        for format in
            [CosmosFormat::default(), CosmosFormat { unit: Some(unit), ..CosmosFormat::default() }]
        {
            let (line, reason) = refusal(&with(units), &format);
            assert!(line == 2 && is_no_acceleration(&reason), "{units}");
        }
    }
    let values = [1.0, -12345.678, 3.0];
    for (units, factor) in
        [("in gal. (8f10.3)", 0.01), ("units=cm/s^2 (4)", 0.01), ("in G (8f10.3)", GRAVITY)]
    {
        let record =
            read(&with(units), &CosmosFormat { unit: Some(unit), ..CosmosFormat::default() })
                .unwrap();
        same(&record, 0.02, &values.map(|a| a * factor));
    }
    // Old files name no unit.
    let old = with("");
    let (line, reason) = refusal(&old, &CosmosFormat::default());
    assert!(line == 2 && is_no_acceleration(&reason), "{reason}");
    same(
        &read(&old, &CosmosFormat { unit: Some(unit), ..CosmosFormat::default() }).unwrap(),
        0.02,
        &values,
    );
}

/// El Centro, printed as each of the formats print, comes back to the digits printed.
#[test]
fn el_centro_survives_all_formats() {
    let record = el_centro_1940();
    let in_g: Vec<f64> = record.accelerations().iter().map(|a| a / GRAVITY).collect();
    let rows = |numbers: Vec<String>, columns: usize| {
        numbers.chunks(columns).map(|row| row.concat() + "\n").collect::<String>()
    };
    let count = in_g.len();
    let peer = format!(
        "{PEER_TITLE}ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  {count}, DT=   .0200 SEC\n{}",
        rows(in_g.iter().map(|a| format!("{a:15.7E}")).collect(), 5)
    );
    let csmip = format!(
        "{count} points of accel data equally spaced at  .020 sec, in cm/sec2. (8f10.3)\n{}",
        rows(in_g.iter().map(|a| format!("{:10.4}", a * 100.0 * GRAVITY)).collect(), 8)
    );
    let gal: Vec<f64> = record.accelerations().iter().map(|a| a * 100.0).collect();
    let mut header = vec![-999.0; 100];
    (header[33], header[61], header[62], header[63]) = (0.02, 20.0, 31.2, 312.655);
    let cosmos = format!(
        "Corrected acceleration (Format v01.20 with 13 text lines)\n\
         100 Real-header values follow on  17 lines, Format= (6F13.6)\n{}\
         {count} acceleration pts, approx  31 secs, units=cm/s^2 (4),Format=(10F9.4)\n{}\
         End-of-data for Chan  1 acceleration\n",
        rows(header.iter().map(|value| format!("{value:13.6}")).collect(), 6),
        rows(gal.iter().map(|a| format!("{a:9.4}")).collect(), 10)
    );
    // Counts of a ten-thousandth of a gal.
    let k_net = format!(
        "Origin Time       1940/05/19 13:36:00\nStation Code      ELC\nSampling Freq(Hz) 50Hz\n\
         Duration Time(s)  31.2\nDir.              N-S\nScale Factor      2000(gal)/20000000\n\
         Max. Acc. (gal)   312.655\nMemo.\n{}",
        rows(gal.iter().map(|a| format!("{:9.0}", a * 1e4)).collect(), 8)
    );
    let formats: [(String, &dyn RecordFormat); 4] = [
        (peer, &PeerFormat),
        (csmip, &CosmosFormat::default()),
        (cosmos, &CosmosFormat::default()),
        (k_net, &KNetFormat),
    ];
    for (text, format) in formats {
        let read = read(&text, format).unwrap();
        assert_eq!((read.len(), read.time_step()), (count, 0.02));
        for (found, wanted) in read.accelerations().iter().zip(record.accelerations()) {
            assert!((found - wanted).abs() < 0.51e-6, "{found} {wanted}");
        }
    }
    assert_eq!(AccelerationUnit::Gal.in_metres_per_second_squared(), 0.01);
}

/// Text much like a record's, so that inner parts are reached.
fn nearly_a_record() -> impl Strategy<Value = Vec<u8>> {
    let pieces = [
        "NPTS= 3, DT= .01 SEC\n",
        "UNITS OF G\n",
        "3 .01 NPTS, DT\n",
        "3 points of accel data equally spaced at .01 sec, in g.\n",
        "3 acceleration pts, units=cm/s^2\n",
        "3 Real-header values follow\n",
        "Sampling Freq(Hz) 3Hz\n",
        "Duration Time(s) 1\n",
        "Scale Factor 2(gal)/3\n",
        "Memo.\n",
        " 1",
        "-2.5E+3",
        "+",
        "E",
        "nan",
        "\n",
        "\u{feff}",
        "é",
        "1e308",
        " 99999999999",
    ];
    prop::collection::vec(prop::sample::select(pieces.to_vec()), 0..30)
        .prop_map(|pieces| pieces.concat().into_bytes())
}

proptest! {
    #[test]
    fn readers_never_panic(
        bytes in prop_oneof![prop::collection::vec(any::<u8>(), 0..300), nearly_a_record()],
        channel in 0..3_usize,
    ) {
        let cosmos = CosmosFormat { channel, ..CosmosFormat::default() };
        let formats: [&dyn RecordFormat; 3] = [&PeerFormat, &KNetFormat, &cosmos];
        for format in formats {
            if let Ok(record) = Record::from_reader("bytes", &bytes[..], format) {
                prop_assert!(record.len() >= 2 && record.time_step() > 0.0);
                prop_assert!(record.displacements().iter().all(|u| u.is_finite()));
            }
        }
    }
}
