//! GOAL: values along lines are all read, or refused with a line; no column of them passes for the record.
//! SCENE: eight values on a line with and without a lost value, cards of SHAKE, lists of samples, tables.
//! REFERENCE: the words of the files, counted and converted here one by one.

use std::fmt::Write;

use basemat::motion::{
    AccelerationUnit, AlongLinesFormat, ColumnFormat, FortranFormat, Record, SlistFormat,
};
use basemat::{Error, FileError, FileFault};
use basemat_problems::faults::{count, is_unprocessed};

use super::agency_files::bytes;
use super::refusal;

const G: AccelerationUnit = AccelerationUnit::StandardGravity;
const GRAVITY: f64 = 9.80665;

fn along() -> AlongLinesFormat {
    AlongLinesFormat::new(G, 0.01)
}

fn column(column: usize) -> ColumnFormat {
    ColumnFormat { acceleration_column: Some(column), ..ColumnFormat::equally_spaced(G, 0.01) }
}

/// Words of a file in g, without its first lines and what is behind `width` characters of a line.
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

#[track_caller]
fn is_series(record: &Record, wanted: &[f64], factor: f64) {
    assert_eq!((record.len(), record.time_step()), (wanted.len(), 0.01));
    for (found, wanted) in record.accelerations().iter().zip(wanted) {
        assert!((found - wanted * factor).abs() <= 1e-15, "{found} {wanted}");
    }
}

#[test]
fn all_values_of_a_line_are_read() {
    let record = Record::from_reader("a", &bytes("eight_per_line.txt")[..], &along()).unwrap();
    is_series(&record, &words("eight_per_line.txt", 0, 99), GRAVITY);
    assert_eq!((record.len(), record.duration()), (200, 1.99));
    let record =
        Record::from_reader("a", &bytes("eight_per_line_ragged.txt")[..], &along()).unwrap();
    is_series(&record, &words("eight_per_line_ragged.txt", 0, 99), GRAVITY);
    assert_eq!(record.len(), 27);
    // By commas, semicolons and touching signs.
    for text in [
        "1.5,2.5,-3.5\n4.5,5.5,6.5\n7.5",
        "1.5; 2.5;-3.5;\n4.5;5.5;6.5;\n7.5\n",
        "1.5 2.5-3.5\n\n4.5 5.5 6.5\n# end\n7.5",
    ] {
        let record = Record::from_reader("a", text.as_bytes(), &along()).unwrap();
        is_series(&record, &[1.5, 2.5, -3.5, 4.5, 5.5, 6.5, 7.5], GRAVITY);
    }
}

/// A column of a series would be an eighth of the record.
#[test]
fn no_column_of_a_series_is_read() {
    for name in ["eight_per_line.txt", "shake91.acc"] {
        for number in [1, 2, 8] {
            let format = ColumnFormat { header_lines: 1, ..column(number) };
            assert!(
                Record::from_reader("a", &bytes(name)[..], &format).is_err(),
                "{name} {number}"
            );
        }
    }
    let (line, reason) = refusal(&bytes("eight_per_line.txt"), &column(1));
    assert!(line == 1 && reason.to_string().contains("AlongLinesFormat"), "{line}: {reason}");
    let alone = ColumnFormat::equally_spaced(G, 0.01);
    let (_, reason) = refusal(&bytes("eight_per_line.txt"), &alone);
    assert!(reason.to_string().contains("AlongLinesFormat"), "{reason}");
    // A sentence of eight words is no row of titles.
    let titled =
        [b"ground motion of a station in the hills\n", &bytes("eight_per_line.txt")[..]].concat();
    assert!(Record::from_reader("a", &titled[..], &column(1)).is_err());
    assert!(Record::read_all(super::agency_files::path("eight_per_line.txt"), &alone).is_err());
    // Lines of unequal length.
    for number in [1, 2, 3] {
        let (line, reason) = refusal(&bytes("eight_per_line_ragged.txt"), &column(number));
        assert_eq!((line, reason), (4, count("columns", 3, "8, as before")), "{number}");
    }
    // A known number of lines confirms columns.
    let known = ColumnFormat { samples: Some(25), ..column(1) };
    assert_eq!(
        Record::from_reader("a", &bytes("eight_per_line.txt")[..], &known).unwrap().len(),
        25
    );
}

#[test]
fn columns_without_titles_are_read_beside_times() {
    let mut text = String::new();
    for k in 0..30 {
        let [time, one, other] =
            [(f64::from(k) / 0.128).round() * 1e-3, f64::from(k * k % 17), f64::from(k * k % 13)];
        writeln!(text, "{time:.3} {one:.4} {other:.4}").unwrap();
    }
    let record = Record::from_reader("a", text.as_bytes(), &column(2)).unwrap();
    assert_eq!((record.len(), record.accelerations()[3]), (30, 9.0 * GRAVITY));
    let (line, reason) = refusal(&text, &along());
    assert!(line == 1 && reason.to_string().contains("column 1"), "{reason}");
    let known = AlongLinesFormat { samples: Some(90), ..along() };
    assert_eq!(Record::from_reader("a", text.as_bytes(), &known).unwrap().len(), 90);
}

/// Three components side by side, without titles and times.
#[test]
fn components_that_differ_are_columns() {
    let text = "0.1 0.2 0.3\n0.11 0.21 0.31\n0.12 0.22 0.32\n";
    let record = Record::from_reader("a", text.as_bytes(), &column(2)).unwrap();
    is_series(&record, &[0.2, 0.21, 0.22], GRAVITY);
    // Numbers at random tell nothing.
    let random = "0.1 -0.7 0.4\n0.3 0.2 -0.6\n-0.2 0.5 0.1\n";
    assert!(Record::from_reader("a", random.as_bytes(), &column(2)).is_err());
    let known = ColumnFormat { samples: Some(3), ..column(2) };
    assert_eq!(Record::from_reader("a", random.as_bytes(), &known).unwrap().len(), 3);
}

#[test]
fn a_lost_value_is_found() {
    let text = String::from_utf8(bytes("eight_per_line.txt")).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    let short = lines[11].rsplit_once(' ').unwrap().0;
    lines[11] = short;
    assert_eq!(refusal(&lines.join("\n"), &along()), (12, count("columns", 7, "8, as before")));
    let long = format!("{short} 0.1 0.2");
    lines[11] = &long;
    assert_eq!(refusal(&lines.join("\n"), &along()), (12, count("columns", 9, "8, as before")));
    let needed = AlongLinesFormat { samples: Some(201), ..along() };
    assert_eq!(refusal(&text, &needed), (25, count("samples", 200, "201")));
}

#[test]
fn cards_are_read_by_their_fortran_format() {
    let layout: FortranFormat = "8F9.6".parse().unwrap();
    let headed = AlongLinesFormat { header_lines: 1, ..along() };
    let given = AlongLinesFormat { layout: Some(layout), ..headed };
    let wanted = words("shake91.acc", 1, 72);
    assert_eq!(wanted.len(), 200);
    for format in [headed, given] {
        is_series(
            &Record::from_reader("a", &bytes("shake91.acc")[..], &format).unwrap(),
            &wanted,
            GRAVITY,
        );
    }
    // The ninth field is the number of the card; without a format it would pass for a value.
    let text = String::from_utf8(bytes("shake91.acc")).unwrap();
    let bare = text.split_once('\n').unwrap().1;
    let (line, reason) = refusal(bare, &along());
    assert!(line == 1 && reason.to_string().contains("column 9"), "{reason}");
    let bare_in_columns = AlongLinesFormat { layout: Some(layout), ..along() };
    is_series(
        &Record::from_reader("a", bare.as_bytes(), &bare_in_columns).unwrap(),
        &wanted,
        GRAVITY,
    );
    // Numbers ten wide, which touch: in columns of nine they are other numbers.
    let touching = words("shake_touch.acc", 1, 99);
    assert_eq!((touching.len(), touching[1]), (200, -10.055_655));
    is_series(
        &Record::from_reader("a", &bytes("shake_touch.acc")[..], &headed).unwrap(),
        &touching,
        GRAVITY,
    );
    let (line, reason) = refusal(&bytes("shake_touch.acc"), &given);
    assert!(line == 2 && matches!(reason, FileFault::Format { .. }), "{line}: {reason}");
    // Cards out of order, a value behind the columns, and a card of seven values among cards of eight.
    let lines: Vec<&str> = bare.lines().collect();
    let mut swapped = lines.clone();
    swapped.swap(3, 4);
    let valued = bare.replacen("       2\n", " 0.12345\n", 1);
    let seven = bare.replacen("-0.079792       2", "                2", 1);
    for (text, number) in [(swapped.join("\n"), 5), (valued, 2), (seven, 2)] {
        let (line, _) = refusal(&text, &bare_in_columns);
        assert_eq!(line, number);
    }
    // Numbers without points, as Fortran reads them.
    let text = "    1    -2    30\n 12345     0";
    let format = AlongLinesFormat { layout: Some("3F6.3".parse().unwrap()), ..along() };
    let record = Record::from_reader("a", text.as_bytes(), &format).unwrap();
    is_series(&record, &[0.001, -0.002, 0.03, 12.345, 0.0], GRAVITY);
}

#[test]
fn lists_of_samples_have_their_headers_step_and_unit() {
    let list = SlistFormat::default();
    let record = Record::from_reader("a", &bytes("slist.txt")[..], &list).unwrap();
    is_series(&record, &words_of_list(), 1.0);
    assert_eq!(record.len(), 200);
    let text = String::from_utf8(bytes("slist.txt")).unwrap();
    let two = text.clone() + &text.replace("HNE", "HNN").replace("M/S**2", "cm/s2");
    let path = std::env::temp_dir().join("basemat_two_lists.txt");
    std::fs::write(&path, &two).unwrap();
    let all = Record::read_all(&path, &list).unwrap();
    assert_eq!((all[0].0.as_str(), all[1].0.as_str()), ("XX_STA1_00_HNE_D", "XX_STA1_00_HNN_D"));
    is_series(&all[1].1, &words_of_list(), 0.01);
    let unitless = text.replacen(", M/S**2", "", 1);
    let known = SlistFormat { unit: Some(AccelerationUnit::Gal), ..list };
    is_series(
        &Record::from_reader("a", unitless.as_bytes(), &known).unwrap(),
        &words_of_list(),
        0.01,
    );
    assert!(Record::from_reader("a", unitless.as_bytes(), &list).is_err());
    // Another unit than the header's, counts, pairs, pieces, a wrong number.
    assert!(Record::from_reader("a", text.as_bytes(), &known).is_err());
    let (line, reason) = refusal(&text.replacen("M/S**2", "Counts", 1), &list);
    assert!(line == 1 && is_unprocessed(&reason), "{reason}");
    assert_eq!(refusal(&text.replacen("SLIST", "TSPAIR", 1), &list).0, 1);
    assert_eq!(refusal(&(text.clone() + &text), &list).0, 36);
    let (line, reason) = refusal(&text.replacen("200 samples", "201 samples", 1), &list);
    assert_eq!((line, reason), (35, count("samples", 200, "201")));
}

fn words_of_list() -> Vec<f64> {
    let text = String::from_utf8(bytes("slist.txt")).unwrap();
    text.lines().skip(1).flat_map(str::split_whitespace).map(|word| word.parse().unwrap()).collect()
}

#[test]
fn units_and_headers_are_checked() {
    for header in ["Acceleration (cm/s2)", "# unit: gal"] {
        let (_, reason) = refusal(&format!("{header}\n0.1 0.2\n0.3 0.5\n0.1 0.6\n"), &along());
        assert!(reason.to_string().contains("title"), "{header}: {reason}");
    }
    let read = |text: &str| Record::from_reader("a", text.as_bytes(), &along());
    assert_eq!(read("Acceleration (g)\n0.1 0.2\n0.3 0.5\n0.1 0.6\n").unwrap().len(), 6);
    let Err(Error::File(FileError { line: 1, fault, .. })) = read("Station 7\n0.1 0.2\n0.3 0.5\n")
    else {
        panic!()
    };
    assert!(fault.to_string().contains("header_lines"), "{fault}");
    for bad in
        ["0.1 nan\n0.3 0.5\n", "0.1,,0.2\n0.3,0.5,0.1\n", "0,1 0,2\n0,3 0,5\n", "0.1 0.2\n0.3 x\n"]
    {
        assert!(read(bad).is_err(), "{bad}");
    }
}
