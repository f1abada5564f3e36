//! GOAL: files of the strong-motion databases are read in every layout in use, or cause an error with line and reason.
//! SCENE: variants of PEER, COSMOS, CSMIP and K-NET files, printed here in the layouts that `agency_files` reads;
//! arbitrary bytes.
//! REFERENCE: the samples that were printed.

use basemat::motion::{
    AccelerationUnit, CosmosFormat, KNetFormat, PeerFormat, Record, RecordFormat, el_centro_1940,
};
use basemat::{FileError, FileFault};
use basemat_problems::faults::{
    count, is_contradiction, is_missing, is_no_acceleration, is_no_number, is_unprocessed,
    not_a_number, value,
};
use proptest::prelude::*;

use super::{SI_UNIT, STANDARD_GRAVITY, assert_record, error_at, error_in, read};

const PEER_TITLE: &str = "PEER NGA STRONG MOTION DATABASE RECORD\nEl Centro, 180\n";

/// GOAL: all spellings of PEER headers are read.
#[test]
fn peer_headers_vary() {
    let body = " .100E-02 -.2000E-02-.300E-02\r\n  .4\r\n";
    let expected = [1e-3, -2e-3, -3e-3, 0.4].map(|a| a * STANDARD_GRAVITY);
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
        assert_record(&record, 0.01, &expected);
    }
}

/// Error of a PEER file after its title and unit.
#[track_caller]
fn peer_error(text: &str) -> FileError {
    error_in(&format!("{PEER_TITLE}ACCELERATION TIME SERIES IN UNITS OF G\n{text}"), &PeerFormat)
}

/// GOAL: PEER files with another number of samples or another quantity than stated are errors.
#[test]
fn peer_files_that_contradict_their_header_are_errors() {
    for (samples, line, fault) in [
        ("1 2", 5, wrong_count(2, 3)),
        ("1 2\n3 4", 6, wrong_count(4, 3)),
        ("1 2 3\n\n4", 7, wrong_count(4, 3)),
        ("1 2 x3", 5, not_a_number("x3")),
        ("1 2 ***", 5, not_a_number("***")),
    ] {
        let error = peer_error(&format!("NPTS= 3, DT= .01 SEC\n{samples}\n"));
        assert_eq!(error, error_at(line, fault));
    }
    for header in ["NPTS= 3, DT= 0 SEC", "NPTS= 1, DT= 1", "NPTS=, DT=", "NPTS= 1e99, DT=.1"] {
        let error = peer_error(&format!("{header}\n1 2 3\n"));
        assert!(error.line == 4 && is_missing(&error.fault), "{header}: {error}");
    }
    let error = error_in(&format!("{PEER_TITLE}no numbers\n"), &PeerFormat);
    assert!(is_missing(&error.fault));
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
        let error = error_in(&text, &PeerFormat);
        assert!(error.line == 3 && is_no_acceleration(&error.fault), "{error}");
    }
}

/// GOAL: PEER files without a unit, or with a time step out of range, are errors.
#[test]
fn peer_files_must_name_their_unit() {
    for header in ["", "SAN FRANCISCO (G)\n", "ACCELERATION TIME SERIES\n"] {
        let text = format!("{PEER_TITLE}{header}NPTS= 2, DT= .01 SEC\n1 2\n");
        let error = error_in(&text, &PeerFormat);
        assert_eq!(error.line, if header.is_empty() { 3 } else { 4 });
        let unit = "there is no unit (UNITS OF G) in the header, or none that makes sense";
        assert!(is_missing(&error.fault) && error.fault.to_string() == unit, "{error}");
    }
    // A time step whose record would overflow.
    let text = format!("{PEER_TITLE}UNITS OF G\nNPTS= 2, DT= 1e308 SEC\n1 2\n");
    let error = error_in(&text, &PeerFormat);
    assert!(error.line == 0 && matches!(error.fault, FileFault::Unusable(_)), "{error}");
}

/// Fault of a wrong number of samples.
fn wrong_count(found: usize, needed: usize) -> FileFault {
    count("samples", found, &needed.to_string())
}

/// Numbers in rows, each in a field of this many characters.
fn rows_of_fields(fields: &[String], columns: usize) -> String {
    fields.chunks(columns).map(|row| row.concat() + "\n").collect()
}

/// GOAL: counts of K-NET files become accelerations; wrong numbers of samples and header lines are errors.
#[test]
fn k_net_counts_become_accelerations() {
    let header = "Origin Time       2011/03/11 14:46:00\nLat.              38.103\n\
        Station Code      MYG004\nSampling Freq(Hz) 100Hz\nDuration Time(s)  DUR\nDir.              N-S\n\
        Scale Factor      7845(gal)/8223790\nMax. Acc. (gal)   176.166\nMemo.\n";
    let two_seconds = header.replace("DUR", "2");
    let counts: Vec<i32> = (0..200).map(|k| 100 - 7 * k * k).collect();
    let fields: Vec<String> = counts.iter().map(|count| format!("{count:9}")).collect();
    let text = format!("{two_seconds}{}", rows_of_fields(&fields, 8));
    let expected: Vec<f64> =
        counts.iter().map(|&count| f64::from(count) * 78.45 / 8_223_790.0).collect();
    assert_record(&read(&text, &KNetFormat).unwrap(), 0.01, &expected);

    // The last line lost, or a second too many.
    let short = format!("{two_seconds}{}", rows_of_fields(&fields[..192], 8));
    assert_eq!(error_in(&short, &KNetFormat), error_at(33, wrong_count(192, 200)));
    let three_seconds = text.replace("(s)  2", "(s)  3");
    assert_eq!(error_in(&three_seconds, &KNetFormat), error_at(34, wrong_count(200, 300)));
    for (key, other) in [
        ("Sampling Freq(Hz) 100Hz", "Sampling Freq(Hz) 0Hz"),
        ("Sampling Freq(Hz) 100Hz", "Sampling Freq(Hz)"),
        ("Duration Time(s)  2", "Duration"),
        ("7845(gal)/8223790", "7845(gal)/0"),
        ("7845(gal)/8223790", "7845(m)/8223790"),
        ("Memo.", "Remark"),
    ] {
        let error = error_in(&text.replace(key, other), &KNetFormat);
        assert!(is_missing(&error.fault), "{other}: {error}");
    }
}

/// A CSMIP file of two channels.
const CSMIP_TEXT: &str = "Corrected accelerogram from Chan  1\n\
    3 points of accel data equally spaced at  .020 sec, in cm/sec2. (8f10.3)\n\
    1.000-12345.678     3.000\n\
    3 points of veloc data equally spaced at  .020 sec, in cm/sec.  (8f10.3)\n\
    1.000     2.000     3.000\n/&  ---------- End of data for channel  1 ----------\n\
    Corrected accelerogram from Chan  2\n\
    2 points of accel data equally spaced at  .010 sec, in g. (8f10.3)\n   .5 -.5\n";

/// GOAL: the requested channel of a CSMIP file is read; other numbers of channels are errors.
#[test]
fn csmip_files_have_channels() {
    let format = CosmosFormat::default();
    assert_record(&read(CSMIP_TEXT, &format).unwrap(), 0.02, &[0.01, -123.45678, 0.03]);
    let second = CosmosFormat { channel: 2, ..format };
    assert_record(
        &read(CSMIP_TEXT, &second).unwrap(),
        0.01,
        &[0.5 * STANDARD_GRAVITY, -0.5 * STANDARD_GRAVITY],
    );
    for needed in [0, 3] {
        let error = error_in(CSMIP_TEXT, &CosmosFormat { channel: needed, ..format });
        assert_eq!(error.fault, value("requested channel", &needed.to_string(), "from 1 to 2"));
    }
    let counts = CSMIP_TEXT.replace("in g.", "in counts.");
    let error = error_in(&counts, &second);
    assert!(error.line == 8 && is_unprocessed(&error.fault), "{error}");
    let short = &CSMIP_TEXT[..CSMIP_TEXT.len() - 5];
    assert_eq!(error_in(short, &second), error_at(9, wrong_count(1, 2)));
}

/// GOAL: a count that is too small is an error and does not cut the record.
#[test]
fn numbers_beyond_the_announced_count_are_errors() {
    let format = CosmosFormat::default();
    let long = CSMIP_TEXT.replace("3 points of accel", "2 points of accel");
    assert_eq!(error_in(&long, &format), error_at(3, wrong_count(3, 2)));
    let more = CSMIP_TEXT.replace("12345.678     3.000\n", "12345.678     3.000\n     4.000\n");
    assert_eq!(error_in(&more, &format), error_at(4, wrong_count(4, 3)));
    let blank = CSMIP_TEXT.replace("12345.678     3.000\n", "12345.678     3.000\n\n     4.000\n");
    assert_eq!(error_in(&blank, &format), error_at(5, wrong_count(4, 3)));
    let second = CosmosFormat { channel: 2, ..format };
    assert_eq!(error_in(&format!("{CSMIP_TEXT} .25\n"), &second), error_at(10, wrong_count(3, 2)));
    let cosmos = cosmos_text(5.0).replace("10 acceleration pts", "9 acceleration pts");
    assert_eq!(error_in(&cosmos, &format), error_at(23, wrong_count(10, 9)));
    let cosmos = cosmos_text(5.0).replace("End-of-data", " 1.25\nEnd-of-data");
    assert_eq!(error_in(&cosmos, &format), error_at(24, wrong_count(11, 10)));
}

/// Ten samples with the interval of the data (ms), −999 for unknown; the recorder's interval is 20 ms.
fn cosmos_text(interval: f64) -> String {
    let mut header = vec![-999.0; 100];
    header[33] = 0.02;
    header[61] = interval;
    let fields: Vec<String> = header.iter().map(|value| format!("{value:13.6}")).collect();
    format!(
        "Corrected acceleration (Format v01.20 with 13 text lines)\n\
         100 Real-header values follow on  17 lines, Format= (6F13.6)\n{}\
         1 Comment line(s) follow, each starting with a \"|\":\n| 3 acceleration pts\n\
         10 acceleration pts, approx  0 secs, units=cm/s^2 (4),Format=(10F8.5)\n\
         -0.00003-0.00004-0.00004-0.00004-0.00004-0.00004-0.00004-0.00004-0.00004 9.99999\n\
         End-of-data for Chan  1 acceleration\n",
        rows_of_fields(&fields, 6)
    )
}

/// GOAL: the interval of a COSMOS file is in its real header: the data's, or else the recorder's.
#[test]
fn the_interval_of_cosmos_files_is_in_the_real_header() {
    let text = cosmos_text(5.0);
    let format = CosmosFormat::default();
    let mut expected = [-4e-7; 10];
    expected[0] = -3e-7;
    expected[9] = 0.0999_999;
    assert_record(&read(&text, &format).unwrap(), 0.005, &expected);
    // The recorder's interval alone.
    let recorder = cosmos_text(-999.0);
    assert_record(&read(&recorder, &format).unwrap(), 0.02, &expected);
    let error = error_in(&recorder.replace("     0.020000", "  -999.000000"), &format);
    let interval = "there is no sampling interval in the header, or none that makes sense";
    assert!(is_missing(&error.fault) && error.fault.to_string() == interval, "{error}");
    let counts = text.replace("cm/s^2 (4)", "counts (50)");
    assert!(is_unprocessed(&error_in(&counts, &format).fault));
    let contradicted = text.replace("cm/s^2 (4)", "cm/s^2 (2)");
    assert!(is_no_acceleration(&error_in(&contradicted, &format).fault));
    // The title's duration.
    for seconds in [3, 50, 1000] {
        let text = text.replace("approx  0 secs", &format!("approx  {seconds} secs"));
        let error = error_in(&text, &format);
        assert!(error.line == 22 && is_contradiction(&error.fault), "{error}");
    }
}

/// A CSMIP file of four samples in cm/s², with a Fortran format.
fn csmip_in_columns(format: &str, body: &str) -> String {
    let title = "4 points of accel data equally spaced at  .020 sec, in cm/sec2.";
    format!("{title} {format}\n{body}\n")
}

/// GOAL: numbers that Fortran prints without a space between them are read by their format.
#[test]
fn full_columns_may_touch() {
    let touching = [0.091_234_5, 0.101_234_5, 0.111_234_5, 0.123_45];
    for (format, body, expected) in [
        ("(4F8.5)", " 9.1234510.1234511.1234512.34500", touching),
        ("(2F8.5)", " 9.1234510.12345\n11.1234512.345", touching),
        (",Format=4F8.5", " 9.1234510.1234511.1234512.34500", touching),
        ("(2I4)", "12345678\n   1  -2", [12.34, 56.78, 0.01, -0.02]),
        ("(4D9.2)", " 1.00D+02 2.00D+01-3.00D+00 4.00D-01", [1.0, 0.2, -0.03, 0.004]),
        // Lines out of the columns of the format are read by their spaces and signs.
        ("(8F10.5)", "1 -2.5\n3 4", [0.01, -0.025, 0.03, 0.04]),
        ("", "1 -2.5 3-4", [0.01, -0.025, 0.03, -0.04]),
    ] {
        let record = read(&csmip_in_columns(format, body), &CosmosFormat::default()).unwrap();
        assert_record(&record, 0.02, &expected);
    }
    for (format, body) in [
        // Too wide for its column, as Fortran marks it.
        ("(4F8.5)", " 1.00000******** 2.00000 3.00000"),
        // Without the format the ends of the numbers are unknown.
        ("", "9.1234510.1234511.1234512.34500"),
    ] {
        let error = error_in(&csmip_in_columns(format, body), &CosmosFormat::default());
        assert!(error.line == 2 && is_no_number(&error.fault), "{error}");
    }
}

/// The CSMIP file with these words in place of its unit and format, and a misleading title.
fn csmip_with_units(units: &str) -> String {
    let text = CSMIP_TEXT.replace("in cm/sec2. (8f10.3)", units);
    text.replace("Corrected", "Galileo Street")
}

/// GOAL: units of COSMOS files are whole words: a thousandth of a gal is not a gal, and a gallery is not a unit.
#[test]
fn units_of_cosmos_files_are_words() {
    let without_unit = CosmosFormat::default();
    let with_unit = CosmosFormat { unit: Some(SI_UNIT), ..CosmosFormat::default() };
    for units in ["in mgal. (8f10.3)", "units=mgal", "in cm/sec. (8f10.3)", "units=mg (11)"] {
        for format in [&without_unit, &with_unit] {
            let error = error_in(&csmip_with_units(units), format);
            assert!(error.line == 2 && is_no_acceleration(&error.fault), "{units}");
        }
    }
    let values = [1.0, -12345.678, 3.0];
    for (units, factor) in [
        ("in gal. (8f10.3)", 0.01),
        ("units=cm/s^2 (4)", 0.01),
        ("in G (8f10.3)", STANDARD_GRAVITY),
    ] {
        let record = read(&csmip_with_units(units), &with_unit).unwrap();
        assert_record(&record, 0.02, &values.map(|a| a * factor));
    }
    // Old files name no unit.
    let old = csmip_with_units("");
    let error = error_in(&old, &without_unit);
    assert!(error.line == 2 && is_no_acceleration(&error.fault), "{error}");
    assert_record(&read(&old, &with_unit).unwrap(), 0.02, &values);
}

/// GOAL: El Centro, printed in each of the formats, is read back to the digits printed.
#[test]
fn el_centro_is_read_back_from_all_formats() {
    let record = el_centro_1940();
    let in_g: Vec<f64> = record.accelerations().iter().map(|a| a / STANDARD_GRAVITY).collect();
    let in_gal: Vec<f64> = record.accelerations().iter().map(|a| a * 100.0).collect();
    let count = in_g.len();
    let g_fields: Vec<String> = in_g.iter().map(|a| format!("{a:15.7E}")).collect();
    let peer = format!(
        "{PEER_TITLE}ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  {count}, DT=   .0200 SEC\n{}",
        rows_of_fields(&g_fields, 5)
    );
    let gal_fields: Vec<String> =
        in_g.iter().map(|a| format!("{:10.4}", a * 100.0 * STANDARD_GRAVITY)).collect();
    let csmip = format!(
        "{count} points of accel data equally spaced at  .020 sec, in cm/sec2. (8f10.3)\n{}",
        rows_of_fields(&gal_fields, 8)
    );
    let mut header = vec![-999.0; 100];
    header[33] = 0.02;
    header[61..64].copy_from_slice(&[20.0, 31.2, 312.655]);
    let header_fields: Vec<String> = header.iter().map(|value| format!("{value:13.6}")).collect();
    let narrow_fields: Vec<String> = in_gal.iter().map(|a| format!("{a:9.4}")).collect();
    let cosmos = format!(
        "Corrected acceleration (Format v01.20 with 13 text lines)\n\
         100 Real-header values follow on  17 lines, Format= (6F13.6)\n{}\
         {count} acceleration pts, approx  31 secs, units=cm/s^2 (4),Format=(10F9.4)\n{}\
         End-of-data for Chan  1 acceleration\n",
        rows_of_fields(&header_fields, 6),
        rows_of_fields(&narrow_fields, 10)
    );
    // Counts of a ten-thousandth of a gal.
    let count_fields: Vec<String> = in_gal.iter().map(|a| format!("{:9.0}", a * 1e4)).collect();
    let k_net = format!(
        "Origin Time       1940/05/19 13:36:00\nStation Code      ELC\nSampling Freq(Hz) 50Hz\n\
         Duration Time(s)  31.2\nDir.              N-S\nScale Factor      2000(gal)/20000000\n\
         Max. Acc. (gal)   312.655\nMemo.\n{}",
        rows_of_fields(&count_fields, 8)
    );
    let formats: [(String, &dyn RecordFormat); 4] = [
        (peer, &PeerFormat),
        (csmip, &CosmosFormat::default()),
        (cosmos, &CosmosFormat::default()),
        (k_net, &KNetFormat),
    ];
    for (text, format) in formats {
        let computed = read(&text, format).unwrap();
        assert_eq!((computed.len(), computed.time_step()), (count, 0.02));
        for (computed, expected) in computed.accelerations().iter().zip(record.accelerations()) {
            assert!((computed - expected).abs() < 0.51e-6, "{computed} {expected}");
        }
    }
    assert_eq!(AccelerationUnit::Gal.in_metres_per_second_squared(), 0.01);
}

/// Text similar to a record file, so that inner parts of the readers are reached.
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
    /// GOAL: arbitrary and nearly valid bytes give a record or an error.
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
