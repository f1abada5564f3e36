//! GOAL: the files of the agencies are read however they were copied, or cause a clear error.
//! SCENE: other line ends, marks, blank lines, cases of letters, exponents, commas, bytes that are not UTF-8.
//! REFERENCE: the record in the original file.

use basemat::FileFault;
use basemat::motion::{
    AfadFormat, CosmosFormat, EsmFormat, GeoNetFormat, KNetCsvFormat, KNetFormat, PeerFormat,
    RecordFormat, SmcFormat,
};
use basemat_problems::faults::{count, is_no_number, value};

use super::agency_files::bytes;
use super::{error_at, error_in, read};

fn agencies() -> [(&'static str, Box<dyn RecordFormat>); 11] {
    [
        ("peer.at2", Box::new(PeerFormat)),
        ("cosmos.v2c", Box::new(CosmosFormat::default())),
        ("csmip.v2", Box::new(CosmosFormat::default())),
        ("csmip_1984.v2", Box::new(CosmosFormat::default())),
        ("csmip_v1.v1", Box::new(CosmosFormat::default())),
        ("k_net.ns", Box::new(KNetFormat)),
        ("k_net.csv", Box::new(KNetCsvFormat::default())),
        ("esm_hne.asc", Box::new(EsmFormat)),
        ("afad_three.txt", Box::new(AfadFormat::default())),
        ("smc.smc", Box::new(SmcFormat)),
        ("geonet.v2a", Box::new(GeoNetFormat::default())),
    ]
}

/// Text of a file, with line ends of Unix.
fn text_of(name: &str) -> String {
    String::from_utf8(bytes(name)).unwrap().replace("\r\n", "\n")
}

/// Whether a line has numbers with decimals and nothing else.
fn has_numbers_only(line: &str) -> bool {
    line.contains('.')
        && line.chars().all(|sign| sign.is_ascii_digit() || " +-.,:eEdD".contains(sign))
}

/// The text with a character replaced in its lines of numbers; headers may have no place for the other one.
fn replaced_in_numbers(text: &str, from: char, to: &str) -> String {
    let lines = text
        .lines()
        .map(|line| if has_numbers_only(line) { line.replace(from, to) } else { line.to_owned() });
    lines.map(|line| line + "\n").collect()
}

/// GOAL: changes that copying makes to a file do not change its record.
#[test]
fn copies_of_files_are_read() {
    for (name, format) in agencies() {
        let text = text_of(name);
        let expected = read(&text, format.as_ref()).unwrap();
        for (change, copy) in [
            ("line ends", text.replace('\n', "\r\n")),
            ("mark", format!("\u{feff}{text}")),
            ("no line end", text.trim_end().to_owned()),
            ("blank lines at the end", format!("{text}\n  \n\t\n")),
            ("blank line at the beginning", format!("\n{text}")),
            ("end of a file of DOS", format!("{text}\u{1a}")),
            ("lower case", text.to_lowercase()),
            ("upper case", text.to_uppercase()),
            ("tabs", text.replace("    ", "\t")),
            ("white space behind lines", text.replace('\n', "  \t\n")),
            ("exponents of Fortran", replaced_in_numbers(&text, 'E', "D")),
        ] {
            let record = read(&copy, format.as_ref());
            let record = record.unwrap_or_else(|error| panic!("{change}: {error}"));
            assert_eq!(record, expected, "{name}: {change}");
        }
        // Blank lines among the numbers, up to the last one.
        let lines: Vec<&str> = text.lines().collect();
        let first = lines.iter().position(|line| has_numbers_only(line));
        let first = first.unwrap_or(lines.len() - 1);
        for line in [first, first + 1, lines.len() - 1] {
            let mut lines = lines.clone();
            lines.insert(line, "");
            let record = read(&lines.join("\n"), format.as_ref()).unwrap();
            assert_eq!(record, expected, "{name}: blank line {line}");
        }
    }
}

/// GOAL: names of places in Latin-1 do no harm.
#[test]
fn bytes_that_are_not_utf_8_do_no_harm_in_comments() {
    for (name, place) in [
        ("peer.at2", "Invented Valley"),
        ("cosmos.v2c", "RcrdId"),
        ("csmip.v2", "Nowhere"),
        ("k_net.ns", "XXX001"),
        ("k_net.csv", "XXX001"),
        ("esm_hne.asc", "INVENTED"),
        ("esm_hne.asc", "Nowhere"),
        ("afad_three.txt", "NOWHERE"),
        ("afad_three.txt", "EARTHQUAKE DEPARTMENT"),
        ("smc.smc", "Invented"),
        ("geonet.v2a", "Nowhere District"),
    ] {
        let original = bytes(name);
        let text = String::from_utf8(original.clone()).unwrap();
        let index = text.find(place).unwrap_or_else(|| panic!("{name}: {place}"));
        let mut latin = original.clone();
        latin[index] = 0xc7;
        latin[index + 1] = 0xfd;
        let format = agencies().into_iter().find(|(other, _)| *other == name).unwrap().1;
        let computed = read(&latin, format.as_ref()).unwrap();
        let expected = read(&original, format.as_ref()).unwrap();
        assert_eq!(computed, expected, "{name}: {place}");
    }
}

/// GOAL: decimal commas in any format are errors, and the error shows the number.
#[test]
fn decimal_commas_are_named() {
    for (name, format) in agencies() {
        // The counts of K-NET have no decimals.
        if name != "k_net.ns" {
            let error = error_in(&replaced_in_numbers(&text_of(name), '.', ","), format.as_ref());
            let names_number = match &error.fault {
                FileFault::Value { quantity, .. } if quantity == "number of columns" => {
                    name == "k_net.csv"
                }
                FileFault::Value { found, .. } => is_no_number(&error.fault) && found.contains(','),
                _ => false,
            };
            assert!(names_number && error.line > 0, "{name}, {error}");
        }
    }
}

/// GOAL: empty cells that a spreadsheet adds are no columns; a missing sample is not one of them.
#[test]
fn empty_cells_at_the_end_of_lines_are_no_columns() {
    let format = KNetCsvFormat::default();
    let text = String::from_utf8(bytes("k_net.csv")).unwrap();
    let expected = format.parse_all("", &mut text.as_bytes()).unwrap();
    for cells in [",", ",,"] {
        let lines: Vec<String> =
            text.lines().map(|line| line.trim_end().to_owned() + cells).collect();
        let padded = format!("{}\n{cells}\n", lines.join("\n"));
        assert_eq!(format.parse_all("", &mut padded.as_bytes()).unwrap(), expected);
    }
    let missing = text.replacen(",18.357", ",", 1);
    let error = error_in(&missing, &format);
    assert_eq!(error, error_at(16, count("columns", 3, "4, as before")));
}

/// GOAL: files of velocity or displacement alone are errors with their title, in either layout of CESMD.
#[test]
fn files_without_acceleration_are_named() {
    let numbers = "    1.000     2.000     3.000\n";
    for title in [
        "3 points of veloc data equally spaced at  .010 sec, in cm/sec. (8f10.3)",
        "3 points of displ data equally spaced at  .010 sec, in cm. (8f10.3)",
        "3 velocity pts, approx  0 secs, units=cm/sec(05),Format=(8F10.3)",
        "3 displacement  pts, approx  0 secs, units=cm(06),Format=(8F10.3)",
    ] {
        let text = format!(
            "Corrected data\n{title}\n{numbers}3 points of displ data equally spaced at .01 sec\n"
        );
        for channel in [1, 2] {
            let error = error_in(&text, &CosmosFormat { channel, ..CosmosFormat::default() });
            let found = title.chars().take(60).collect();
            let needed = "an acceleration in a known unit".to_owned();
            assert_eq!(error, error_at(2, FileFault::Format { found, needed }));
        }
        let error = CosmosFormat::default().parse_all("", &mut text.as_bytes()).unwrap_err();
        assert!(
            error.to_string().contains("instead of an acceleration in a known unit"),
            "{error}"
        );
    }
    // A channel that does not exist, in a file with two.
    let text = String::from_utf8(bytes("cosmos.v2c")).unwrap();
    let error = error_in(&text, &CosmosFormat { channel: 3, ..CosmosFormat::default() });
    assert_eq!(error.fault, value("requested channel", "3", "from 1 to 2"));
}
