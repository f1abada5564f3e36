//! GOAL: records in columns are read in every usual layout, or cause an error with line and reason.
//! SCENE: layouts, units, printed time steps, bad lines, arbitrary bytes.
//! REFERENCE: the samples that were printed.

use approx::assert_relative_eq;
use basemat::motion::{AccelerationUnit, ColumnFormat, Record, el_centro_1940};
use basemat::{Error, FileError, FileFault};
use basemat_problems::faults::{count, is_value, not_a_number, value};
use proptest::prelude::*;

use super::{SI_UNIT, error_at, error_in, read};

/// Columns of time and acceleration in m/s².
fn metric() -> ColumnFormat {
    ColumnFormat::new(SI_UNIT)
}

fn columns(time_column: usize, acceleration: usize) -> ColumnFormat {
    ColumnFormat { time_column, acceleration_column: Some(acceleration), ..metric() }
}

/// Needed in place of a word before all numbers.
const NEEDED_HEADER_LINES: &str =
    "a finite number: with more than one line of header, give their number (`header_lines`)";

/// Needed of a file without times and without a chosen column.
const NEEDED_COLUMNS: &str = "1 (name the column of the acceleration, or read the values along the lines: \
    `AlongLinesFormat`, in Python `along_lines`)";

/// GOAL: columns are read with any usual separator, comment, title, column order and number format.
#[test]
fn reader_reads_every_usual_layout() {
    let expected = Record::new(0.02, vec![0.0, 1.5, -2.5e-1]).unwrap();
    for text in [
        "0,0\n0.02,1.5\n0.04,-0.25\n",
        "0 0\n0.02 1.5\n0.04 -.25",
        "  0\t0 \r\n\r\n 0.02\t+1.5\r\n0.04 \t -25E-2\r\n",
        "# a comment\ntime, acceleration\n# another\n0 , 0\n0.02 , 1.5\n0.04 , -0.25\n# end",
        "\u{feff}t a\n0 0 9 9\n0.02 1.5 x y\n0.04 -0.25\n",
        "5.00,0\n5.02,1.5\n5.04,-0.25\n",
        "time; acceleration\r\n0;0\r\n0.02 ; 1.5\r\n0.04;\t-0.25\r\n",
    ] {
        assert_eq!(read(text, &metric()).unwrap(), expected, "{text:?}");
    }
    let single_column = ColumnFormat::equally_spaced(SI_UNIT, 0.02);
    for text in ["0\n1.5\n-0.25", "# 0.02 s\nacceleration\n 0.0 \r\n\n+1.5\n-25e-2\n"] {
        assert_eq!(read(text, &single_column).unwrap(), expected);
    }
    let third = ColumnFormat { acceleration_column: Some(3), samples: Some(3), ..single_column };
    assert_eq!(read("9;9;0\n9;x;1.5\n8;9;-0.25\n", &third).unwrap(), expected);
    let swapped = ColumnFormat { samples: Some(3), ..columns(3, 2) };
    assert_eq!(read("1 0.0 0\n2 1.5 0.02\n3 -0.25 0.04\n", &swapped).unwrap(), expected);
    // Bytes that are not UTF-8 do no harm in comments.
    let latin = b"# S\xe9isme\n0 0\n0.02 1.5\n0.04 -0.25\n";
    assert_eq!(read(latin, &metric()).unwrap(), expected);
}

/// GOAL: the time step is the one that was printed, in spite of the rounding of the times.
#[test]
fn reader_rounds_the_time_step_of_printed_times() {
    // A third of a hundredth, printed with five digits.
    let lines: Vec<String> = (0..301).map(|k| format!("{:.5} 1", f64::from(k) / 300.0)).collect();
    let record = read(&lines.join("\n"), &metric()).unwrap();
    assert_relative_eq!(record.time_step(), 1.0 / 300.0, max_relative = 1e-11);
    let record = read("0 0\n0.1 0\n0.2 0\n0.3 0\n", &metric()).unwrap();
    assert_eq!(record.time_step(), 0.1);
}

/// GOAL: accelerations of all units are converted to m/s².
#[test]
fn units_are_converted() {
    for (unit, factor) in [
        (SI_UNIT, 1.0),
        (AccelerationUnit::MillimetrePerSecondSquared, 1e-3),
        (AccelerationUnit::StandardGravity, 9.80665),
        (AccelerationUnit::Gal, 0.01),
        (AccelerationUnit::FootPerSecondSquared, 0.3048),
        (AccelerationUnit::InchPerSecondSquared, 0.3048 / 12.0),
    ] {
        let record = read("0 2\n1 4\n", &ColumnFormat::new(unit)).unwrap();
        assert_relative_eq!(record.accelerations()[1], 4.0 * factor, max_relative = 1e-15);
    }
}

/// GOAL: lines that are no samples are errors with their number and the reason.
#[test]
fn errors_of_the_reader_have_line_and_reason() {
    let format = metric();
    let cases: [(&[u8], usize, FileFault); 20] = [
        (b"", 0, count("samples", 0, "at least 2")),
        (b"# only\n\ncomments\n", 0, count("samples", 0, "at least 2")),
        (b"0 1\n", 1, count("samples", 1, "at least 2")),
        (b"0 1\n1 nan\n", 2, not_a_number("nan")),
        (b"0 1\n1 -inf\n", 2, not_a_number("-inf")),
        (b"0 1\nNaN 1\n", 2, not_a_number("NaN")),
        (b"0 1\n1 1e999\n", 2, not_a_number("1e999")),
        (b"0 1\n1\n", 2, value("requested column", "2", "from 1 to 1")),
        (b"0,1\n1,\n", 2, not_a_number("")),
        (b"0,1\n,1\n", 2, not_a_number("")),
        (b"0;1\n1;;1\n", 2, not_a_number("")),
        // Decimal commas.
        (b"0;1\n0,02;1\n", 2, not_a_number("0,02")),
        (b"0;1\n1;1,5\n", 2, not_a_number("1,5")),
        (b"t a\nt a\n0 0\n1 1\n", 2, value("field", "'t'", NEEDED_HEADER_LINES)),
        (b"0 0\nt a\n1 1\n", 2, not_a_number("t")),
        (b"0 x\n1 1\n", 1, not_a_number("x")),
        (b"0 1\n\xff\xfe 1\n", 2, not_a_number("\u{fffd}\u{fffd}")),
        (b"0 1\n1 1\n1 1\n", 3, value("time step", "0 s", "above zero")),
        (b"0 1\n-1 1\n", 2, value("time step", "-1 s", "above zero")),
        (b"0 1\n1 1\n\n2.2 1\n", 4, value("time step", "1.2 s", "1 s, as before")),
    ];
    for (text, line, fault) in cases {
        let name = String::from_utf8_lossy(text);
        assert_eq!(error_in(text, &format), error_at(line, fault), "{name:?}");
    }
}

/// GOAL: requested columns that do not exist and wrong numbers of samples are errors.
#[test]
fn reader_returns_an_error_for_wrong_columns_and_counts() {
    let text = b"0 1\n1 1\n";
    let error = error_in(text, &columns(1, 3));
    assert_eq!(error, error_at(1, value("requested column", "3", "from 1 to 2")));
    let error = error_in(text, &columns(0, 1));
    assert_eq!(error, error_at(1, value("requested column", "0", "from 1 to 2")));
    let error = error_in(text, &ColumnFormat { samples: Some(3), ..metric() });
    assert_eq!(error, error_at(2, count("samples", 2, "3")));
    // The acceleration taken for the time.
    let error = error_in(b"0 1\n1 3\n2 9\n", &columns(2, 1));
    assert_eq!(error, error_at(3, value("time step", "6 s", "2 s, as before")));
}

/// GOAL: a file without times has one column, unless another one is chosen.
#[test]
fn a_single_column_is_single() {
    let single_column = ColumnFormat::equally_spaced(SI_UNIT, 0.02);
    let error = error_in(b"1\n2 3\n", &single_column);
    assert_eq!(error, error_at(2, count("columns", 2, NEEDED_COLUMNS)));
    let error = error_in(b"0.00,1\n0.02,2\n", &single_column);
    assert_eq!(error, error_at(1, count("columns", 2, NEEDED_COLUMNS)));
    let error = error_in(b"1\n2\n3\n", &ColumnFormat { samples: Some(2), ..single_column });
    assert_eq!(error, error_at(3, count("samples", 3, "2")));
    let second = ColumnFormat { acceleration_column: Some(2), ..single_column };
    let error = error_in(b"1\n2\n", &second);
    assert_eq!(error, error_at(1, value("requested column", "2", "from 1 to 1")));
    for time_step in [0.0, -0.02, f64::NAN, f64::INFINITY] {
        let format = ColumnFormat::equally_spaced(SI_UNIT, time_step);
        let error = error_in(b"1\n2\n", &format);
        assert!(error.line == 0 && matches!(error.fault, FileFault::Unusable(_)), "{error}");
    }
    // The same text with a column of times.
    let record = read(b"0 5\n1 6\n", &columns(1, 2)).unwrap();
    assert_eq!((record.time_step(), record.accelerations()), (1.0, &[5.0, 6.0][..]));
}

/// GOAL: finite numbers whose record overflows are errors with the file's name.
#[test]
fn errors_of_invalid_records_name_the_file() {
    let error = error_in(b"0 1e200\n1e200 1e200\n", &metric());
    assert_eq!(error.line, 0);
    let FileFault::Unusable(error) = error.fault else { panic!("{error}") };
    assert!(matches!(*error, Error::Input { quantity: "velocity of the record", .. }), "{error}");
}

/// GOAL: time steps that drift, and lines without an end, are errors.
#[test]
fn reader_returns_an_error_for_drifting_steps_and_endless_lines() {
    let mut time = 0.0;
    let mut lines = Vec::new();
    for k in 0..100 {
        lines.push(format!("{time} 0"));
        time += 1.0 + 5e-5 * f64::from(k);
    }
    let error = error_in(lines.join("\n").as_bytes(), &metric());
    assert!(is_value(&error.fault, "time"), "{error}");
    let endless = std::io::Read::take(std::io::repeat(b'1'), 1 << 40);
    let error = Record::from_reader("zeros", endless, &metric()).unwrap_err();
    let fault = value("length of the line", "65536 bytes or more", "less");
    assert_eq!(error, Error::File(FileError { file: "zeros".into(), line: 1, fault }));
}

/// GOAL: a record cut anywhere in its last line is an error, except within the digits of its last number.
#[test]
fn reader_returns_an_error_for_a_truncated_record() {
    let text = include_str!("../../crates/records/data/elcentro1940_NS_peknold_0319g.csv");
    let format = ColumnFormat {
        samples: Some(1560),
        ..ColumnFormat::new(AccelerationUnit::StandardGravity)
    };
    let complete_text = text.trim_end();
    assert_eq!(read(complete_text, &format).unwrap().len(), 1560);
    let line_count = complete_text.lines().count();
    let last_number = complete_text.len() - complete_text.rfind(',').unwrap() - 1;
    let last_line = complete_text.lines().last().unwrap().len();
    for cut in 1..=last_line {
        let truncated_text = &complete_text[..complete_text.len() - cut];
        // A number cut within its digits is still a number.
        if cut >= last_number {
            let error = error_in(truncated_text, &format);
            assert!(error.line + 1 >= line_count, "{error}");
        }
    }
}

/// GOAL: files that do not exist, and folders, are named in the error; other files are read.
#[test]
fn files_that_cannot_be_read_are_named() {
    let error = Record::read("/nowhere/record.csv", &metric()).unwrap_err();
    assert_eq!(error.to_string(), "/nowhere/record.csv cannot be read: it does not exist");
    let error = Record::read(basemat_problems::data_path(""), &metric()).unwrap_err();
    assert!(matches!(error, Error::File(FileError { fault: FileFault::Unreadable(_), .. })));
    let file =
        basemat_problems::data_path("../../crates/records/data/elcentro1940_NS_peknold_0319g.csv");
    let format = ColumnFormat::new(AccelerationUnit::StandardGravity);
    assert_eq!(Record::read(file, &format).unwrap(), el_centro_1940());
}

/// Text similar to columns of a record, so that inner parts of the reader are reached.
fn nearly_a_record() -> impl Strategy<Value = Vec<u8>> {
    let piece = prop_oneof![
        Just(" ".to_owned()),
        Just(",".to_owned()),
        Just("\n".to_owned()),
        Just("#".to_owned()),
        Just("nan".to_owned()),
        Just("\u{feff}".to_owned()),
        (0..40).prop_map(|k| format!("\n{} ", f64::from(k) * 0.5)),
        any::<f64>().prop_map(|value| format!("{value:e}")),
    ];
    prop::collection::vec(piece, 0..40).prop_map(|pieces| pieces.concat().into_bytes())
}

proptest! {
    /// GOAL: arbitrary and nearly valid bytes give a record or an error.
    #[test]
    fn reader_never_panics(
        bytes in prop_oneof![prop::collection::vec(any::<u8>(), 0..300), nearly_a_record()],
        time in 0..4_usize,
        acceleration in 0..4_usize,
    ) {
        let format = columns(time, acceleration);
        if let Ok(record) = Record::from_reader("bytes", &bytes[..], &format) {
            prop_assert!(record.len() >= 2 && record.time_step() > 0.0);
            prop_assert!(record.accelerations().iter().all(|a| a.is_finite()));
            prop_assert!(record.displacements().iter().all(|u| u.is_finite()));
        }
    }

    /// GOAL: printed records are read back.
    #[test]
    fn printed_records_are_read_back(
        step in 0.001..1.0_f64,
        values in prop::collection::vec(-10.0..10.0_f64, 2..60),
    ) {
        let lines: Vec<String> =
            values.iter().enumerate().map(|(k, a)| format!("{}, {a}", k as f64 * step)).collect();
        let record = read(&lines.join("\n"), &metric()).unwrap();
        prop_assert_eq!(record.accelerations(), &values[..]);
        prop_assert!((record.time_step() - step).abs() <= 1e-11 * step);
    }
}
