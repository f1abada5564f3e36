//! GOAL: every number and unit in the header of a record file is read completely, or is an error with its line.
//! SCENE: time steps, units and formats of PEER, CSMIP, COSMOS and K-NET files in usual and unclear spellings.
//! REFERENCE: the quantity that was printed; the typed error.

use basemat::FileFault;
use basemat::motion::{AccelerationUnit, CosmosFormat, KNetFormat, PeerFormat};
use basemat_problems::faults::{
    CLEAR_QUANTITY, is_missing, is_no_acceleration, is_no_number, is_off_columns, is_unclear, value,
};

use super::{SI_UNIT, STANDARD_GRAVITY, assert_record, error_at, error_in, read};

/// Spellings of time steps, and their values in s.
const CLEAR_TIME_STEPS: [(&str, f64); 16] = [
    (".005 SEC", 0.005),
    ("5.0D-03", 0.005),
    ("5.0d-03 sec", 0.005),
    ("5.0D-03SEC", 0.005),
    ("0.5E-2SEC.", 0.005),
    ("10 MSEC", 0.01),
    ("10MSEC", 0.01),
    ("5 msec", 0.005),
    ("5 ms", 0.005),
    ("20 milliseconds", 0.02),
    ("1/100 SEC", 0.01),
    ("1 / 200", 0.005),
    ("1/128 s", 1.0 / 128.0),
    (".01 (SEC)", 0.01),
    ("+.01 seconds", 0.01),
    ("1E1MS", 0.01),
];

/// Spellings of time steps that are errors.
const UNCLEAR_TIME_STEPS: [&str; 17] = [
    "1,5",
    "1,5 SEC",
    "0,005 SEC",
    "5.0X-03",
    "5.0 D-03",
    ".01E",
    "100 HZ",
    "200 SAMPLES/SEC",
    ".01 MIN",
    ".01 SEC X 2",
    ".01.2",
    "1/100/2",
    "1/0",
    "~.01",
    "NAN",
    "INF SEC",
    "********",
];

/// A PEER file of four samples.
fn peer(header: &str) -> String {
    format!("TITLE\nACCELERATION TIME SERIES IN UNITS OF G\n{header}\n.1 -.2 .3 .4\n")
}

/// A CSMIP file of four samples; the title ends with the time step, the unit and the format.
fn csmip(title: &str) -> String {
    format!(
        "Corrected accelerogram\n4 points of accel data equally spaced at {title}\n1. -2. 3. 4.\n"
    )
}

/// GOAL: time steps of PEER files are read with their unit, or are errors.
#[test]
fn time_steps_of_peer_files_are_whole_quantities() {
    let expected = [0.1, -0.2, 0.3, 0.4].map(|a| a * STANDARD_GRAVITY);
    for (text, step) in CLEAR_TIME_STEPS {
        for header in [
            format!("NPTS= 4, DT= {text}"),
            format!("NPTS=4,DT={text},"),
            format!("DT= {text}, NPTS= 4"),
            format!("NPTS: 4; DT: {text}; PGA=.4"),
            format!("  4  {text}  NPTS, DT"),
        ] {
            println!("{header}");
            assert_record(&read(&peer(&header), &PeerFormat).unwrap(), step, &expected);
        }
    }
    for text in UNCLEAR_TIME_STEPS {
        for header in [format!("NPTS= 4, DT= {text}"), format!("4  {text}  NPTS, DT")] {
            let error = error_in(&peer(&header), &PeerFormat);
            assert_eq!(error.line, 3, "{header}: {error}");
            assert!(
                is_unclear(&error.fault)
                    && matches!(&error.fault, FileFault::Value { found, .. }
                    if text.to_uppercase().contains(found.trim_matches('\''))),
                "{header}: {error}"
            );
        }
    }
}

/// GOAL: the error of an unclear time step or number of points shows the whole of it.
#[test]
fn unclear_quantities_of_peer_files_are_shown() {
    let error = error_in(&peer("NPTS= 4, DT= 1,5 SEC"), &PeerFormat);
    assert_eq!(error, error_at(3, value("time step", "'1,5 SEC'", CLEAR_QUANTITY)));
    let text = "time step is '1,5 SEC', but must be clear: all of it a known number, unit or word";
    assert_eq!(error.fault.to_string(), text);
    for (header, text) in [
        ("NPTS= 4,000, DT= .01", "4,000"),
        ("NPTS= 4 X, DT= .01", "4 X"),
        ("NPTS= 4;5, DT= .01", "4;5"),
        ("NPTS= 0X4, DT= .01", "0X4"),
    ] {
        let error = error_in(&peer(header), &PeerFormat);
        let fault = value("number of points", &format!("'{text}'"), CLEAR_QUANTITY);
        assert_eq!(error, error_at(3, fault), "{header}");
    }
}

/// GOAL: the time step of a PEER file is the one named DT, beside others.
#[test]
fn the_time_step_of_a_peer_file_is_the_one_called_dt() {
    let expected = [0.1, -0.2, 0.3, 0.4].map(|a| a * STANDARD_GRAVITY);
    for header in [
        "ORIGINAL DT= .02, NPTS= 4, DT= .005",
        "NPTS= 4, DT= .005, ORIGINAL DT= .02",
        "NPTS= 4, ORIGINAL NPTS= 8, DT= .005 SEC, OLD DT= .02",
        "WIDTH= 3, NPTS= 4, DT= .005",
        "NPTS= 4  DT= .005 SEC",
        "DT= .005 SEC NPTS= 4",
        "NPTS= 4, DT= .005, DT= 5 MSEC",
        "4 .005 NPTS, DT (SEC)",
        "4, 5 NPTS, DT (MSEC)",
    ] {
        println!("{header}");
        assert_record(&read(&peer(header), &PeerFormat).unwrap(), 0.005, &expected);
    }
    for header in [
        "NPTS= 4, ORIGINAL DT= .02",
        "NPTS= 4, DT= .005, DT= .02",
        "NPTS= 4, NPTS= 5, DT= .02",
        "NPTS= 4, WIDTH= .02",
        "4 5 .02 NPTS, DT",
        "4 .02 NPTS, DT, SCALE",
        "4 .02 DT, NPTS",
    ] {
        let error = error_in(&peer(header), &PeerFormat);
        let is_typed = is_missing(&error.fault) || is_unclear(&error.fault);
        assert!(error.line >= 3 && is_typed, "{header}: {error}");
    }
}

/// GOAL: a unit of g with any factor is an error.
#[test]
fn a_unit_of_g_with_a_factor_is_an_error() {
    for unit in [
        "ACCELERATION TIME SERIES IN UNITS OF G X 1000",
        "ACCELERATION TIME SERIES IN UNITS OF G*1000",
        "ACCELERATION TIME SERIES IN UNITS OF G * 1000",
        "ACCELERATION TIME SERIES IN UNITS OF G, X 1000",
        "ACCELERATION TIME SERIES IN UNITS OF G. TIMES 1000",
        "ACCELERATION TIME SERIES IN UNITS OF G/10",
        "ACCELERATION TIME SERIES IN UNITS OF G / 1000",
        "ACCELERATION TIME SERIES IN UNITS OF G E-3",
        "ACCELERATION TIME SERIES IN UNITS OF G TIMES A THOUSAND",
        "ACCELERATION TIME SERIES IN UNITS OF G, MULTIPLIED BY TEN",
        "ACCELERATION TIME SERIES IN UNITS OF G (X 1000)",
        "ACCELERATION TIME SERIES IN UNITS OF G (1000)",
        "ACCELERATION TIME SERIES IN UNITS OF G (10)",
        "ACCELERATION TIME SERIES IN UNITS OF 0.001 G",
        "ACCELERATION TIME SERIES IN UNITS OF MILLI G",
        "ACCELERATION TIME SERIES IN UNITS OF MG",
        "ACCELERATION TIME SERIES IN UNITS OF % G",
        "ACCELERATION TIME SERIES IN G X 1000",
        "ACCELERATION TIME SERIES (G) X 1000",
        "ACCELERATION TIME SERIES (G), 1000",
        "ACCELERATION TIME SERIES (G X 1000)",
        "ACCELERATION TIME SERIES (G/10)",
        "UNITS OF G X 1000",
        "ACCELERATION TIMES 1000 IN UNITS OF G",
        "1000 X ACCELERATION IN UNITS OF G",
        "1000*ACCELERATION IN UNITS OF G",
        "UNITS OF G, GAIN: 1000",
    ] {
        let text = format!("TITLE\n{unit}\nNPTS= 2, DT= .01 SEC\n1 2\n");
        let error = error_in(&text, &PeerFormat);
        let is_unit_error = is_no_acceleration(&error.fault) || is_missing(&error.fault);
        assert!((error.line == 2 || error.line == 3) && is_unit_error, "{unit}: {error}");
    }
    // In any line of the header.
    for rest in ["UNITS= CM/S/S, NPTS= 2, DT= .01", "NPTS= 2, DT= .01 SEC, UNITS: MG"] {
        let error = error_in(&format!("UNITS OF G\n{rest}\n1 2\n"), &PeerFormat);
        assert!(error.line == 2 && is_no_acceleration(&error.fault), "{error}");
    }
    for rest in ["NPTS= 2, DT= .01, SCALE FACTOR= 1000", "NPTS= 2, DT= .01 SEC, SCALE: 10"] {
        let error = error_in(&format!("UNITS OF G\n{rest}\n1 2\n"), &PeerFormat);
        assert!(error.line == 2 && is_unclear(&error.fault), "{error}");
    }
    for unit in [
        "UNITS OF G",
        "UNITS OF G.",
        "UNITS OF G, CORRECTED",
        "UNITS OF G (9.81)",
        "UNITS OF G (9.81 M/S/S)",
        "UNITS OF G (980.665)",
        "UNITS OF G. FILTER POINTS: HP=0.1 HZ LP=40.0 HZ",
        "ACCELERATION (G), CORRECTED",
        "**** ACCELERATION (G)",
        "1/3 SCALE MODEL, ACCELERATION (G)",
    ] {
        let text = format!("TITLE\n{unit}\nNPTS= 2, DT= .01 SEC\n1 2\n");
        assert_record(
            &read(&text, &PeerFormat).unwrap(),
            0.01,
            &[STANDARD_GRAVITY, 2.0 * STANDARD_GRAVITY],
        );
    }
}

/// GOAL: time steps of CSMIP files are read with their unit, or are errors.
#[test]
fn time_steps_of_csmip_files_are_whole_quantities() {
    let format = CosmosFormat { unit: Some(AccelerationUnit::Gal), ..CosmosFormat::default() };
    let expected = [0.01, -0.02, 0.03, 0.04];
    for (text, step) in CLEAR_TIME_STEPS {
        for rest in [" in cm/sec2. (8f10.3)", ", in cm/sec2. (8f10.3)", "", "  (8f10.3)"] {
            if !(text.contains('(') && rest.is_empty()) {
                println!("{text}{rest}");
                assert_record(
                    &read(&csmip(&format!("{text}{rest}")), &format).unwrap(),
                    step,
                    &expected,
                );
            }
        }
    }
    for text in UNCLEAR_TIME_STEPS {
        for rest in [", in cm/sec2. (8f10.3)", " in cm/sec2. (8f10.3)", " (8f10.3)", ""] {
            let error = error_in(&csmip(&format!("{text}{rest}")), &format);
            assert!(error.line == 2 && is_unclear(&error.fault), "{text}{rest}: {error}");
        }
    }
}

/// GOAL: units and Fortran formats of CSMIP and COSMOS files are read completely, or are errors.
#[test]
fn units_and_formats_of_csmip_and_cosmos_are_whole() {
    let format = CosmosFormat { unit: Some(SI_UNIT), ..CosmosFormat::default() };
    for title in [
        ".01 sec, in g X 1000. (8f10.3)",
        ".01 sec, in g*1000 (8f10.3)",
        ".01 sec, in g. x 1000 (8f10.3)",
        ".01 sec, in g, x 1000 (8f10.3)",
        ".01 sec, in g (x 1000) (8f10.3)",
        ".01 sec, in g (8f10.3) x 1000",
        ".01 sec, in cm/sec2 (50) (8f10.3)",
        ".01 sec, in g (4) (8f10.3)",
        ".01 sec, in g, (4) (8f10.3)",
        ".01 sec, in milli g (8f10.3)",
        ".01 sec, units=g, scale 1000, format=(8f10.3)",
        // A unit without `in` before it contradicts the one for files without a unit.
        ".01 sec, cm/sec2 (8f10.3)",
        ".01 sec. cm/sec/sec (8f10.3)",
        // Unsupported formats.
        ".01 sec, in g (8f10.3,2x)",
        ".01 sec, in g (2(4f10.3))",
        ".01 sec (8f10,3)",
    ] {
        let error = error_in(&csmip(title), &format);
        let is_typed = is_no_acceleration(&error.fault) || is_unclear(&error.fault);
        assert!(error.line == 2 && is_typed, "{title}: {error}");
    }
    for (title, factor) in [
        (".01 sec, in cm/sec2. (8f10.3)", 0.01),
        (".01 sec, units=cm/s^2,Format=(8F10.3)", 0.01),
        (".01 sec, units=cm/s^2 (4),Format=(1F15.6E)", 0.01),
        (".01 sec, in g. (*)", STANDARD_GRAVITY),
        (".01 sec, units=g , format=8f10.3", STANDARD_GRAVITY),
        (".01 SEC.  (UNITS: CM/SEC/SEC)", 0.01),
        (".01 SEC  (UNITS: CM/SEC/SEC)  (8F10.3)", 0.01),
        (".01 SEC.  (UNITS = G)", STANDARD_GRAVITY),
        (".01 SEC.  (UNITS ARE CM/SEC**2)", 0.01),
        (".01 sec, in units of g .  Format: (8f10.3)", STANDARD_GRAVITY),
        (".01 sec. (8f10.3)", 1.0),
    ] {
        let expected = [1.0, -2.0, 3.0, 4.0].map(|a| a * factor);
        assert_record(&read(&csmip(title), &format).unwrap(), 0.01, &expected);
    }
}

/// A CSMIP file of four samples in cm/s², with a Fortran format.
fn in_columns(format: &str, body: &str) -> String {
    format!("4 points of accel data equally spaced at .01 sec, in cm/sec2. ({format})\n{body}\n")
}

/// GOAL: a field without a point has the number of decimals of the format.
#[test]
fn fields_without_a_point_have_the_decimals_of_their_format() {
    let format = CosmosFormat::default();
    let expected = [0.123_45, -0.023_45, 0.03, 0.0];
    for (layout, body) in [
        ("8f10.3", "     12345     -2345      3000         0"),
        ("2f10.3", "     12345     -2345\n      3000         0"),
        ("8f10.3", "    12.345     -2345     3.000       000"),
        ("2f5.3", "12345-2345\n 3000    0"),
        ("8e10.3", "  12345E+0 -23450E-1   .3D+01         0"),
        ("4d10.3", "     12345     -2345    3.0D00      0.0"),
        // A scale factor divides what has no exponent.
        ("1p4f10.3", "    123450    -23450    30.000         0"),
        ("1p4e10.3", " 1.2345E01-2.345E+00 3.000E+00 0.000E+00"),
    ] {
        println!("{layout}: {body:?}");
        assert_record(&read(&in_columns(layout, body), &format).unwrap(), 0.01, &expected);
    }
    // The recorder's interval among the real header values, s.
    let mut values = vec!["      -999000"; 36];
    values[33] = "            5";
    let header: Vec<String> = values.chunks(6).map(<[_]>::concat).collect();
    let cosmos = format!(
        "36 Real-header values follow on   6 lines, Format= (6F13.3)\n{}\n\
         4 acceleration pts, approx 0 secs, units=cm/s^2 (4),Format=(10F8.3)\n   \
         12345   -2345    3000       0\n",
        header.join("\n")
    );
    assert_record(&read(&cosmos, &format).unwrap(), 0.005, &expected);
}

/// GOAL: whole numbers in and out of their columns, which would differ by a factor, are errors.
#[test]
fn fields_without_a_point_out_of_their_columns_are_errors() {
    let format = CosmosFormat::default();
    for body in ["     12345     -2345\n3000 1", "3000 1\n     12345     -2345", "12 13\n14\n15"] {
        let error = error_in(&in_columns("2f10.3", body), &format);
        assert!(error.line == 3 && is_off_columns(&error.fault), "{body}: {error}");
    }
    // A scale factor applies to fields of the format alone; these numbers are out of their fields.
    let error = error_in(&in_columns("1p4f10.3", "1. -2. 3. 4."), &format);
    assert!(error.line == 2 && is_off_columns(&error.fault), "{error}");
    // A column that ends within a number.
    assert_record(
        &read(&in_columns("4f4.2", "1.5 20.25\n3. 4."), &format).unwrap(),
        0.01,
        &[0.015, 0.2025, 0.03, 0.04],
    );
}

/// GOAL: Fortran's exponents of double precision are read in header and samples.
#[test]
fn double_precision_is_read_everywhere() {
    let expected = [0.1, -0.2, 0.3, 0.4].map(|a| a * STANDARD_GRAVITY);
    let text = "UNITS OF G\nNPTS= 4, DT= 1.D-2\n 1.0D-01-2.0d-01\n .3D0 4D-1\n";
    assert_record(&read(text, &PeerFormat).unwrap(), 0.01, &expected);
    for sample in
        ["1,0", "1D", "D1", "1D2D3", "1E2D3", "0x1", "1_0", "1e", "\u{2212}1", "١", "1 000,5"]
    {
        let text = format!("UNITS OF G\nNPTS= 2, DT= .01\n{sample}\n2\n");
        let error = error_in(&text, &PeerFormat);
        assert!(error.line == 3 && is_no_number(&error.fault), "{sample}: {error}");
    }
}

/// A K-NET file of four counts.
fn k_net(frequency: &str, duration: &str, scale: &str) -> String {
    format!(
        "Sampling Freq(Hz) {frequency}\nDuration Time(s)  {duration}\n\
         Scale Factor      {scale}\nMemo.\n 1 2 3 4\n"
    )
}

/// GOAL: frequency, duration and scale factor of K-NET files are read completely, or are errors.
#[test]
fn quantities_of_k_net_are_whole() {
    let expected = [0.01, 0.02, 0.03, 0.04];
    for (frequency, duration, scale) in [
        ("2Hz", "2", "2000(gal)/2000"),
        ("2 HZ", "2.0", " 2.0D3 (gal)/ 2000 "),
        ("2.0", "2 sec", "2000(gal)/2.0E+03"),
        ("2D0Hz", "2s", "1(gal)/1"),
    ] {
        let record = read(&k_net(frequency, duration, scale), &KNetFormat).unwrap();
        assert_record(&record, 0.5, &expected);
    }
    for (line, frequency, duration, scale) in [
        (1, "2,0Hz", "2", "1(gal)/1"),
        (1, "2kHz", "2", "1(gal)/1"),
        (1, "2Hz 4Hz", "2", "1(gal)/1"),
        (1, "2 x 1", "2", "1(gal)/1"),
        (2, "2Hz", "2,5", "1(gal)/1"),
        (2, "2Hz", "2 min", "1(gal)/1"),
        (2, "2Hz", "2 3", "1(gal)/1"),
        (3, "2Hz", "2", "1,5(gal)/1"),
        (3, "2Hz", "2", "1(gal)/1x"),
        (2, "2Hz\nSampling Freq(Hz) 4Hz", "2", "1(gal)/1"),
        (3, "2Hz", "2", "1(gal)/1/2"),
    ] {
        let error = error_in(&k_net(frequency, duration, scale), &KNetFormat);
        assert!(
            error.line == line && is_unclear(&error.fault),
            "{frequency} {duration} {scale}: {error}"
        );
    }
}
