//! GOAL: values along lines are all read, or cause an error with a line; no column of them is taken for the record.
//! SCENE: eight values on a line with and without a lost value, cards of SHAKE, lists of samples, tables.
//! REFERENCE: the words of the files, counted and converted here one by one.

use std::fmt::Write;

use basemat::FileFault;
use basemat::motion::{
    AccelerationUnit, AlongLinesFormat, ColumnFormat, FortranFormat, Record, SlistFormat,
};
use basemat_problems::faults::{count, is_unprocessed};

use super::agency_files::{bytes, path};
use super::{GRAVITY_UNIT, STANDARD_GRAVITY, error_at, error_in, read};

/// Values along the lines, in g, every 10 ms.
fn along_lines_in_g() -> AlongLinesFormat {
    AlongLinesFormat::new(GRAVITY_UNIT, 0.01)
}

/// One column of accelerations, in g, every 10 ms.
fn column_in_g(column: usize) -> ColumnFormat {
    let columns = ColumnFormat::equally_spaced(GRAVITY_UNIT, 0.01);
    ColumnFormat { acceleration_column: Some(column), ..columns }
}

/// Words of a file in g, without its first lines and beyond `width` characters of a line.
fn words(name: &str, header_lines: usize, width: usize) -> Vec<f64> {
    let text = String::from_utf8(bytes(name)).unwrap();
    let lines = text.lines().skip(header_lines).map(|line| &line[..width.min(line.len())]);
    lines
        .flat_map(|line| {
            line.replace('-', " -")
                .split_whitespace()
                .map(|word| word.parse().unwrap())
                .collect::<Vec<f64>>()
        })
        .collect()
}

/// Asserts samples every 10 ms, `factor` times the expected ones.
#[track_caller]
fn assert_series(record: &Record, expected: &[f64], factor: f64) {
    assert_eq!((record.len(), record.time_step()), (expected.len(), 0.01));
    for (computed, expected) in record.accelerations().iter().zip(expected) {
        assert!((computed - expected * factor).abs() <= 1e-15, "{computed} {expected}");
    }
}

/// GOAL: all values of all lines are read, in whole and ragged lines and with any separator.
#[test]
fn all_values_of_a_line_are_read() {
    let record = read(&bytes("eight_per_line.txt"), &along_lines_in_g()).unwrap();
    assert_series(&record, &words("eight_per_line.txt", 0, 99), STANDARD_GRAVITY);
    assert_eq!((record.len(), record.duration()), (200, 1.99));
    let record = read(&bytes("eight_per_line_ragged.txt"), &along_lines_in_g()).unwrap();
    assert_series(&record, &words("eight_per_line_ragged.txt", 0, 99), STANDARD_GRAVITY);
    assert_eq!(record.len(), 27);
    // Separated by commas, semicolons and touching signs.
    for text in [
        "1.5,2.5,-3.5\n4.5,5.5,6.5\n7.5",
        "1.5; 2.5;-3.5;\n4.5;5.5;6.5;\n7.5\n",
        "1.5 2.5-3.5\n\n4.5 5.5 6.5\n# end\n7.5",
    ] {
        let record = read(text, &along_lines_in_g()).unwrap();
        assert_series(&record, &[1.5, 2.5, -3.5, 4.5, 5.5, 6.5, 7.5], STANDARD_GRAVITY);
    }
}

/// GOAL: a column of a series along lines, an eighth of the record, is an error.
#[test]
fn no_column_of_a_series_is_read() {
    for name in ["eight_per_line.txt", "shake91.acc"] {
        for number in [1, 2, 8] {
            let format = ColumnFormat { header_lines: 1, ..column_in_g(number) };
            assert!(read(&bytes(name), &format).is_err(), "{name} {number}");
        }
    }
    let error = error_in(&bytes("eight_per_line.txt"), &column_in_g(1));
    assert!(error.line == 1 && error.fault.to_string().contains("AlongLinesFormat"), "{error}");
    let single_column = ColumnFormat::equally_spaced(GRAVITY_UNIT, 0.01);
    let error = error_in(&bytes("eight_per_line.txt"), &single_column);
    assert!(error.fault.to_string().contains("AlongLinesFormat"), "{error}");
    // A sentence of eight words is no row of titles.
    let titled =
        [b"ground motion of a station in the hills\n", &bytes("eight_per_line.txt")[..]].concat();
    assert!(read(&titled, &column_in_g(1)).is_err());
    assert!(Record::read_all(path("eight_per_line.txt"), &single_column).is_err());
    // Lines of unequal length.
    for number in [1, 2, 3] {
        let error = error_in(&bytes("eight_per_line_ragged.txt"), &column_in_g(number));
        assert_eq!(error, error_at(4, count("columns", 3, "8, as before")), "{number}");
    }
    // A stated number of samples confirms columns.
    let counted = ColumnFormat { samples: Some(25), ..column_in_g(1) };
    assert_eq!(read(&bytes("eight_per_line.txt"), &counted).unwrap().len(), 25);
}

/// GOAL: columns without titles are recognised by the column of times beside them.
#[test]
fn columns_without_titles_are_read_beside_times() {
    let mut text = String::new();
    for k in 0..30 {
        let time = (f64::from(k) / 0.128).round() * 1e-3;
        let first = f64::from(k * k % 17);
        let second = f64::from(k * k % 13);
        writeln!(text, "{time:.3} {first:.4} {second:.4}").unwrap();
    }
    let record = read(&text, &column_in_g(2)).unwrap();
    assert_eq!((record.len(), record.accelerations()[3]), (30, 9.0 * STANDARD_GRAVITY));
    let error = error_in(&text, &along_lines_in_g());
    assert!(error.line == 1 && error.fault.to_string().contains("column 1"), "{error}");
    let counted = AlongLinesFormat { samples: Some(90), ..along_lines_in_g() };
    assert_eq!(read(&text, &counted).unwrap().len(), 90);
}

/// GOAL: three different components side by side, without titles and times, are columns.
#[test]
fn components_that_differ_are_columns() {
    let text = "0.1 0.2 0.3\n0.11 0.21 0.31\n0.12 0.22 0.32\n";
    let record = read(text, &column_in_g(2)).unwrap();
    assert_series(&record, &[0.2, 0.21, 0.22], STANDARD_GRAVITY);
    // Random numbers could be either.
    let random = "0.1 -0.7 0.4\n0.3 0.2 -0.6\n-0.2 0.5 0.1\n";
    assert!(read(random, &column_in_g(2)).is_err());
    let counted = ColumnFormat { samples: Some(3), ..column_in_g(2) };
    assert_eq!(read(random, &counted).unwrap().len(), 3);
}

/// GOAL: a missing or an additional value is found by its line.
#[test]
fn a_lost_value_is_found() {
    let text = String::from_utf8(bytes("eight_per_line.txt")).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    let short = lines[11].rsplit_once(' ').unwrap().0;
    lines[11] = short;
    assert_eq!(
        error_in(&lines.join("\n"), &along_lines_in_g()),
        error_at(12, count("columns", 7, "8, as before"))
    );
    let long = format!("{short} 0.1 0.2");
    lines[11] = &long;
    assert_eq!(
        error_in(&lines.join("\n"), &along_lines_in_g()),
        error_at(12, count("columns", 9, "8, as before"))
    );
    let one_more = AlongLinesFormat { samples: Some(201), ..along_lines_in_g() };
    assert_eq!(error_in(&text, &one_more), error_at(25, count("samples", 200, "201")));
}

/// GOAL: cards of SHAKE are read by their Fortran format, with the number of the card as ninth field.
#[test]
fn cards_are_read_by_their_fortran_format() {
    let layout: FortranFormat = "8F9.6".parse().unwrap();
    let with_header = AlongLinesFormat { header_lines: 1, ..along_lines_in_g() };
    let with_layout = AlongLinesFormat { layout: Some(layout), ..with_header };
    let expected = words("shake91.acc", 1, 72);
    assert_eq!(expected.len(), 200);
    for format in [with_header, with_layout] {
        let record = read(&bytes("shake91.acc"), &format).unwrap();
        assert_series(&record, &expected, STANDARD_GRAVITY);
    }
    // Without header and format, the number of the card would be taken for a value.
    let text = String::from_utf8(bytes("shake91.acc")).unwrap();
    let cards = text.split_once('\n').unwrap().1;
    let error = error_in(cards, &along_lines_in_g());
    assert!(error.line == 1 && error.fault.to_string().contains("column 9"), "{error}");
    let card_format = AlongLinesFormat { layout: Some(layout), ..along_lines_in_g() };
    assert_series(&read(cards, &card_format).unwrap(), &expected, STANDARD_GRAVITY);
    // Numbers ten wide, which touch: in columns of nine they are other numbers.
    let touching = words("shake_touch.acc", 1, 99);
    assert_eq!((touching.len(), touching[1]), (200, -10.055_655));
    let record = read(&bytes("shake_touch.acc"), &with_header).unwrap();
    assert_series(&record, &touching, STANDARD_GRAVITY);
    let error = error_in(&bytes("shake_touch.acc"), &with_layout);
    assert!(error.line == 2 && matches!(error.fault, FileFault::Format { .. }), "{error}");
    // Cards out of order, a value behind the columns, and a card of seven values among cards of eight.
    let mut swapped: Vec<&str> = cards.lines().collect();
    swapped.swap(3, 4);
    let with_ninth_value = cards.replacen("       2\n", " 0.12345\n", 1);
    let with_seven_values = cards.replacen("-0.079792       2", "                2", 1);
    for (text, line) in [(swapped.join("\n"), 5), (with_ninth_value, 2), (with_seven_values, 2)] {
        assert_eq!(error_in(&text, &card_format).line, line);
    }
    // Numbers without points, as Fortran reads them.
    let text = "    1    -2    30\n 12345     0";
    let format = AlongLinesFormat { layout: Some("3F6.3".parse().unwrap()), ..along_lines_in_g() };
    let record = read(text, &format).unwrap();
    assert_series(&record, &[0.001, -0.002, 0.03, 12.345, 0.0], STANDARD_GRAVITY);
}

/// GOAL: lists of samples are read with step and unit of their header, or a stated unit if it has none.
#[test]
fn lists_of_samples_have_their_headers_step_and_unit() {
    let list = SlistFormat::default();
    let record = read(&bytes("slist.txt"), &list).unwrap();
    assert_series(&record, &words_of_list(), 1.0);
    assert_eq!(record.len(), 200);
    let text = String::from_utf8(bytes("slist.txt")).unwrap();
    let two_lists = text.clone() + &text.replace("HNE", "HNN").replace("M/S**2", "cm/s2");
    let path = std::env::temp_dir().join("basemat_two_lists.txt");
    std::fs::write(&path, &two_lists).unwrap();
    let records = Record::read_all(&path, &list).unwrap();
    let names: Vec<&str> = records.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names[..2], ["XX_STA1_00_HNE_D", "XX_STA1_00_HNN_D"]);
    assert_series(&records[1].1, &words_of_list(), 0.01);
    let without_unit = text.replacen(", M/S**2", "", 1);
    let in_gal = SlistFormat { unit: Some(AccelerationUnit::Gal), ..list };
    assert_series(&read(&without_unit, &in_gal).unwrap(), &words_of_list(), 0.01);
    assert!(read(&without_unit, &list).is_err());
    // Another unit than the header's, counts, pairs, pieces, a wrong number of samples.
    assert!(read(&text, &in_gal).is_err());
    let error = error_in(&text.replacen("M/S**2", "Counts", 1), &list);
    assert!(error.line == 1 && is_unprocessed(&error.fault), "{error}");
    assert_eq!(error_in(&text.replacen("SLIST", "TSPAIR", 1), &list).line, 1);
    assert_eq!(error_in(&(text.clone() + &text), &list).line, 36);
    let error = error_in(&text.replacen("200 samples", "201 samples", 1), &list);
    assert_eq!(error, error_at(35, count("samples", 200, "201")));
}

/// Numbers of the list of samples.
fn words_of_list() -> Vec<f64> {
    let text = String::from_utf8(bytes("slist.txt")).unwrap();
    text.lines()
        .skip(1)
        .flat_map(str::split_whitespace)
        .map(|word| word.parse().unwrap())
        .collect()
}

/// GOAL: units of titles, lines of headers and words that are no numbers are checked.
#[test]
fn units_and_headers_are_checked() {
    for header in ["Acceleration (cm/s2)", "# unit: gal"] {
        let error =
            error_in(&format!("{header}\n0.1 0.2\n0.3 0.5\n0.1 0.6\n"), &along_lines_in_g());
        assert!(error.fault.to_string().contains("title"), "{header}: {error}");
    }
    let record =
        read("Acceleration (g)\n0.1 0.2\n0.3 0.5\n0.1 0.6\n", &along_lines_in_g()).unwrap();
    assert_eq!(record.len(), 6);
    let error = error_in("Station 7\n0.1 0.2\n0.3 0.5\n", &along_lines_in_g());
    assert_eq!(error.line, 1);
    assert!(error.fault.to_string().contains("header_lines"), "{error}");
    for text in
        ["0.1 nan\n0.3 0.5\n", "0.1,,0.2\n0.3,0.5,0.1\n", "0,1 0,2\n0,3 0,5\n", "0.1 0.2\n0.3 x\n"]
    {
        assert!(read(text, &along_lines_in_g()).is_err(), "{text}");
    }
}
