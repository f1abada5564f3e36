//! GOAL: columns of numbers in unusual forms are read, or cause an error with their line.
//! SCENE: decimal commas, words, Fortran's exponents, control characters, empty fields, header lines, times of day.
//! REFERENCE: the samples of the text; the typed error.

use basemat::motion::ColumnFormat;
use basemat_problems::faults::{count, is_no_number, is_value, not_a_number, value};

use super::{SI_UNIT, error_at, error_in, read};

/// Columns of time and acceleration.
fn pairs() -> ColumnFormat {
    ColumnFormat::new(SI_UNIT)
}

/// One column of accelerations, every 20 ms.
fn single_column() -> ColumnFormat {
    ColumnFormat::equally_spaced(SI_UNIT, 0.02)
}

#[track_caller]
fn assert_samples(text: &str, format: &ColumnFormat, expected: &[f64]) {
    let record = read(text, format).unwrap();
    assert_eq!((record.time_step(), record.accelerations()), (0.02, expected), "{text:?}");
}

/// GOAL: decimal commas are errors, beside any separator.
#[test]
fn decimal_commas_are_errors() {
    for (text, field) in [
        ("0,00 1,5\n0,02 2,5\n", "0,00"),
        ("0,00\t1,5\n0,02\t2,5\n", "0,00"),
        ("  0,00   -1,5\n  1,00   2,5\n", "0,00"),
        ("0.00 1,5\n0.02 2,5\n", "1,5"),
        ("0,00 1.5\n0,02 2.5\n", "0,00"),
        ("1 1,5\n2 2,5\n3 3,5\n", "1,5"),
        ("0,00,1,5\n1,02,2,5\n", "0,00"),
        ("0,00, 1,5\n1,02, 2,5\n", "0,00"),
        ("t a\n0,00 1,5\n0,02 2,5\n", "0,00"),
        ("0,05;1\n0,10;2\n", "0,05"),
        ("0;1 000,5\n1;2\n", "1 000,5"),
        ("0;1 000.5\n1;2\n", "1 000.5"),
    ] {
        let line = if text.starts_with('t') { 2 } else { 1 };
        assert_eq!(error_in(text, &pairs()), error_at(line, not_a_number(field)), "{text:?}");
    }
    let first = ColumnFormat { acceleration_column: Some(1), ..single_column() };
    for (text, line, field) in [
        ("0,05\n0,15\n", 1, "0,05"),
        ("1,5\n-0,05\n", 2, "-0,05"),
        ("0,05 7\n0,15 8\n", 1, "0,05"),
        ("1,5\t7\n2,5\t8\n", 1, "1,5"),
    ] {
        assert_eq!(error_in(text, &first), error_at(line, not_a_number(field)), "{text:?}");
    }
    // Commas that group thousands change the number of columns.
    let error = error_in("0,999.5\n1,1,000.5\n", &pairs());
    assert_eq!(error, error_at(2, count("columns", 3, "2, as before")));
    // Similar text without decimal commas.
    assert_samples("0,1\n0.02,15\n", &pairs(), &[1.0, 15.0]);
    assert_samples("0.00, 1, at rest\n0.02, 2, hit by it\n", &pairs(), &[1.0, 2.0]);
    assert_samples("00.00,01.50\n00.02,02.50\n", &pairs(), &[1.5, 2.5]);
    assert_samples("0 ,1\n0.02 ,2\n", &pairs(), &[1.0, 2.0]);
}

/// GOAL: a first sample that is not a number is an error, as it would shift the record; a header is made of words.
#[test]
fn an_invalid_first_sample_is_no_header() {
    for sample in [
        "*****",
        "1,5",
        "1.5g",
        "0x10",
        "1_000",
        "1.0.0",
        "--1",
        "-",
        "?",
        "...",
        "nan",
        "NaN",
        "-inf",
        "Infinity",
        "1e999",
        "1D",
        "1D2D3",
        "\"0.5\"",
        "'0.5",
        "\u{2212}0.5",
        "٠٫٥",
        "NA",
        "n/a",
        "missing",
        "a=1",
        "null",
        "None",
        "#N/A",
        "#VALUE!",
        "#DIV/0!",
        "#NUM!",
        "1.0E+",
        "E-02",
        "$5",
        "(1.5)",
        "[0.5]",
        "0.5\0",
        "0.5\u{200b}",
    ] {
        for before in ["", "# m/s2\n\n"] {
            let line = before.lines().count() + 1;
            let error = error_in(&format!("{before}{sample}\n1\n2\n"), &single_column());
            assert_eq!(error.line, line, "{sample}: {error}");
            let error = error_in(&format!("{before}{sample} {sample}\n0 1\n0.02 2\n"), &pairs());
            assert_eq!(error.line, line, "{sample}: {error}");
        }
    }
    // Errors of spreadsheets between the samples.
    for sample in ["#N/A", "#REF!", "#NAME?", "#NULL!"] {
        let error = error_in(&format!("1\n{sample}\n2\n"), &single_column());
        assert_eq!(error, error_at(2, not_a_number(sample)));
    }
    for header in [
        "acceleration",
        "a",
        "Acc. (m/s^2)",
        "acc[m/s2]",
        "\"acceleration\"",
        "E-W",
        "D1",
        "Zeit",
        "加速度",
        "time - acc",
        "(m/s2)",
        "#N/A is no number",
    ] {
        assert_samples(&format!("{header}\n1\n2\n"), &single_column(), &[1.0, 2.0]);
    }
}

/// GOAL: Fortran's exponents of double precision are read.
#[test]
fn double_precision_is_read() {
    assert_samples("1.0D-2\n-2.5d+00\n3D0\n", &single_column(), &[0.01, -2.5, 3.0]);
    assert_samples("0.0D0 1\n2.0D-2 2\n", &pairs(), &[1.0, 2.0]);
}

/// GOAL: control characters do not separate numbers: a lost line end would lose a sample.
#[test]
fn control_characters_do_not_separate_numbers() {
    for text in ["0 0\r0.02 1\n0.04 2\n0.08 2\n", "0 0\u{b}0.02 1\n0.04 2\n", "0 0\u{c}1\n0.02 1\n"]
    {
        let error = error_in(text, &pairs());
        assert!(error.line == 1 && is_no_number(&error.fault), "{text:?}");
    }
}

/// GOAL: an empty field between two tabs, which would shift the columns, is an error.
#[test]
fn an_empty_field_between_tabs_is_not_skipped() {
    let text = "0.00\t1.5\t7\n0.02\t\t7\n0.04\t3.5\t7\n";
    let unequal = count("columns", 2, "3, as before");
    assert_eq!(error_in(text, &pairs()), error_at(2, unequal));
    // Tabs that align.
    assert_samples("0.00\t\t1\n0.02\t\t2\n", &pairs(), &[1.0, 2.0]);
}

/// Columns of time and acceleration after some lines of header.
fn pairs_after(header_lines: usize) -> ColumnFormat {
    ColumnFormat { header_lines, ..pairs() }
}

/// GOAL: stated numbers of header lines are skipped, and checked for titles.
#[test]
fn lines_of_header_are_skipped() {
    let text = "Station 7\n1 2 3\n\nt a\n0 1\n0.02 2\n";
    for lines in [2, 3, 4] {
        assert_samples(text, &pairs_after(lines), &[1.0, 2.0]);
    }
    for lines in [0, 1] {
        assert!(read(text, &pairs_after(lines)).is_err(), "{lines}");
    }
    // A number of the header in the column of the accelerations is not a sample.
    let second = ColumnFormat { acceleration_column: Some(2), ..single_column() };
    let without_times = "Station 7\nPGA 0.3\n9 1\n9 2\n";
    let needed =
        "a finite number: with more than one line of header, give their number (`header_lines`)";
    let error = error_in(without_times, &second);
    assert_eq!(error, error_at(1, value("field", "'Station'", needed)));
    assert_samples(without_times, &ColumnFormat { header_lines: 2, ..second }, &[1.0, 2.0]);
    let error = error_in(text, &pairs_after(9));
    assert_eq!(error.fault, count("samples", 0, "at least 2"));
    let error = error_in("one\nt (ms),a\n0,1\n0.02,2\n", &pairs_after(2));
    assert!(is_value(&error.fault, "title"), "{error}");
}

/// GOAL: times of day, with and without a date and over midnight, are read.
#[test]
fn times_of_day_are_read() {
    assert_samples("12:00:15.00,1\n12:00:15.02,2\n12:00:15.04,3\n", &pairs(), &[1.0, 2.0, 3.0]);
    assert_samples("23:59:59.98 1\n00:00:00.00 2\n00:00:00.02 3\n", &pairs(), &[1.0, 2.0, 3.0]);
    assert_samples("2000-01-01T12:00:15.00,1\n2000-01-01T12:00:15.02,2\n", &pairs(), &[1.0, 2.0]);
    assert_samples("2000/01/01 12:00:15.00,1\n2000/01/01 12:00:15.02,2\n", &pairs(), &[1.0, 2.0]);
    for text in ["12:00:15.00,1\n12:0x:15.02,2\n", "12:00:15.00,1\n12:00,2\n"] {
        let error = error_in(text, &pairs());
        assert!(error.line == 2 && is_no_number(&error.fault), "{error}");
    }
}
