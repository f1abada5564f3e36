//! Columns of numbers in unusual forms.

use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
use basemat::{Error, FileError, FileFault};
use basemat_problems::faults::{count, is_no_number, is_value, not_a_number, value};

const METRIC: AccelerationUnit = AccelerationUnit::MetrePerSecondSquared;

fn pairs() -> ColumnFormat {
    ColumnFormat::new(METRIC)
}

fn alone() -> ColumnFormat {
    ColumnFormat::equally_spaced(METRIC, 0.02)
}

/// Line and reason of the refusal.
#[track_caller]
fn refusal(text: &str, format: &ColumnFormat) -> (usize, FileFault) {
    match Record::from_reader("text", text.as_bytes(), format) {
        Err(Error::File(FileError { line, fault, .. })) => (line, fault),
        other => panic!("{text:?}: {other:?}"),
    }
}

#[track_caller]
fn is_read(text: &str, format: &ColumnFormat, wanted: &[f64]) {
    let record = Record::from_reader("text", text.as_bytes(), format).unwrap();
    assert_eq!((record.time_step(), record.accelerations()), (0.02, wanted), "{text:?}");
}

#[test]
fn decimal_commas_are_refused() {
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
        assert_eq!(refusal(text, &pairs()), (line, not_a_number(field)), "{text:?}");
    }
    let first = ColumnFormat { acceleration_column: Some(1), ..alone() };
    for (text, line, field) in [
        ("0,05\n0,15\n", 1, "0,05"),
        ("1,5\n-0,05\n", 2, "-0,05"),
        ("0,05 7\n0,15 8\n", 1, "0,05"),
        ("1,5\t7\n2,5\t8\n", 1, "1,5"),
    ] {
        assert_eq!(refusal(text, &first), (line, not_a_number(field)), "{text:?}");
    }
    // Commas that group thousands change the number of columns.
    let (line, reason) = refusal("0,999.5\n1,1,000.5\n", &pairs());
    assert_eq!((line, reason), (2, count("columns", 3, "2, as before")));
    // Text that looks alike and is something else.
    is_read("0,1\n0.02,15\n", &pairs(), &[1.0, 15.0]);
    is_read("0.00, 1, at rest\n0.02, 2, hit by it\n", &pairs(), &[1.0, 2.0]);
    is_read("00.00,01.50\n00.02,02.50\n", &pairs(), &[1.5, 2.5]);
    is_read("0 ,1\n0.02 ,2\n", &pairs(), &[1.0, 2.0]);
}

/// A header is made of words: a first sample that is not a number would shift the record.
#[test]
fn a_bad_first_sample_is_no_header() {
    for bad in [
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
        for text in [format!("{bad}\n1\n2\n"), format!("# m/s2\n\n{bad}\n1\n2\n")] {
            let line = text.lines().count() - 2;
            let (found, reason) = refusal(&text, &alone());
            assert_eq!(found, line, "{bad}: {reason}");
            let both = format!("{}{bad} {bad}\n0 1\n0.02 2\n", &text[..text.find(bad).unwrap()]);
            let (found, reason) = refusal(&both, &pairs());
            assert_eq!(found, line, "{bad}: {reason}");
        }
    }
    // In the midst, too.
    for bad in ["#N/A", "#REF!", "#NAME?", "#NULL!"] {
        assert_eq!(refusal(&format!("1\n{bad}\n2\n"), &alone()), (2, not_a_number(bad)));
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
        is_read(&format!("{header}\n1\n2\n"), &alone(), &[1.0, 2.0]);
    }
}

#[test]
fn double_precision_is_read() {
    is_read("1.0D-2\n-2.5d+00\n3D0\n", &alone(), &[0.01, -2.5, 3.0]);
    is_read("0.0D0 1\n2.0D-2 2\n", &pairs(), &[1.0, 2.0]);
}

/// A lost line end must not lose a sample.
#[test]
fn control_characters_do_not_part_numbers() {
    for text in ["0 0\r0.02 1\n0.04 2\n0.08 2\n", "0 0\u{b}0.02 1\n0.04 2\n", "0 0\u{c}1\n0.02 1\n"]
    {
        let (line, reason) = refusal(text, &pairs());
        assert!(line == 1 && is_no_number(&reason), "{text:?}");
    }
}

/// Two tabs may enclose an empty field: then the columns behind it are others.
#[test]
fn an_empty_field_between_tabs_is_not_passed_over() {
    let text = "0.00\t1.5\t7\n0.02\t\t7\n0.04\t3.5\t7\n";
    let unequal = count("columns", 2, "3, as before");
    assert_eq!(refusal(text, &pairs()), (2, unequal));
    // Tabs that align.
    is_read("0.00\t\t1\n0.02\t\t2\n", &pairs(), &[1.0, 2.0]);
}

#[test]
fn lines_of_header_are_passed_over() {
    let after = |header_lines| ColumnFormat { header_lines, ..pairs() };
    let text = "Station 7\n1 2 3\n\nt a\n0 1\n0.02 2\n";
    for lines in [2, 3, 4] {
        is_read(text, &after(lines), &[1.0, 2.0]);
    }
    for lines in [0, 1] {
        assert!(Record::from_reader("text", text.as_bytes(), &after(lines)).is_err(), "{lines}");
    }
    // A number of the header in the column of the accelerations is not a sample.
    let second = ColumnFormat { acceleration_column: Some(2), ..alone() };
    let text_alone = "Station 7\nPGA 0.3\n9 1\n9 2\n";
    assert_eq!(
        refusal(text_alone, &second),
        (
            1,
            value(
                "field",
                "'Station'",
                "a finite number: with more than one line of header, give their number (`header_lines`)"
            )
        )
    );
    is_read(text_alone, &ColumnFormat { header_lines: 2, ..second }, &[1.0, 2.0]);
    let (_, reason) = refusal(text, &after(9));
    assert_eq!(reason, count("samples", 0, "at least 2"));
    let (_, reason) = refusal("one\nt (ms),a\n0,1\n0.02,2\n", &after(2));
    assert!(is_value(&reason, "title"), "{reason}");
}

#[test]
fn times_of_day_are_read() {
    is_read("12:00:15.00,1\n12:00:15.02,2\n12:00:15.04,3\n", &pairs(), &[1.0, 2.0, 3.0]);
    is_read("23:59:59.98 1\n00:00:00.00 2\n00:00:00.02 3\n", &pairs(), &[1.0, 2.0, 3.0]);
    is_read("2000-01-01T12:00:15.00,1\n2000-01-01T12:00:15.02,2\n", &pairs(), &[1.0, 2.0]);
    is_read("2000/01/01 12:00:15.00,1\n2000/01/01 12:00:15.02,2\n", &pairs(), &[1.0, 2.0]);
    for bad in ["12:00:15.00,1\n12:0x:15.02,2\n", "12:00:15.00,1\n12:00,2\n"] {
        let (line, reason) = refusal(bad, &pairs());
        assert!(line == 2 && is_no_number(&reason), "{reason}");
    }
}
