//! GOAL: the files of the agencies are read however they were copied, or refused with a clear word.
//! SCENE: other line ends, marks, blank lines, cases of letters, exponents, commas, bytes that are not UTF-8.
//! REFERENCE: the record in the file as it was.

use basemat::FileFault;
use basemat::motion::{
    AfadFormat, CosmosFormat, EsmFormat, GeoNetFormat, KNetCsvFormat, KNetFormat, PeerFormat,
    Record, RecordFormat, SmcFormat,
};
use basemat_problems::faults::{count, is_no_number, value};

use super::agency_files::bytes;
use super::refusal;

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

/// Whether a line has numbers with decimals and nothing else.
fn is_of_numbers(line: &str) -> bool {
    line.contains('.')
        && line.chars().all(|sign| sign.is_ascii_digit() || " +-.,:eEdD".contains(sign))
}

#[test]
fn copies_of_files_are_read() {
    let by_line = |text: &str, change: &dyn Fn(&str) -> String| {
        text.lines().map(|line| change(line) + "\n").collect::<String>()
    };
    for (name, format) in agencies() {
        let text = String::from_utf8(bytes(name)).unwrap().replace("\r\n", "\n");
        let wanted = Record::from_reader(name, text.as_bytes(), format.as_ref()).unwrap();
        // Numbers of the header may have no place for an exponent, a blank line or a comma.
        let exponent =
            |line: &str| if is_of_numbers(line) { line.replace('E', "D") } else { line.into() };
        for (what, copy) in [
            ("line ends", text.replace('\n', "\r\n")),
            ("mark", format!("\u{feff}{text}")),
            ("no line end", text.trim_end().to_owned()),
            ("blank lines at the end", format!("{text}\n  \n\t\n")),
            ("blank line at the beginning", format!("\n{text}")),
            ("end of a file of DOS", format!("{text}\u{1a}")),
            ("lower case", text.to_lowercase()),
            ("upper case", text.to_uppercase()),
            ("tabs", text.replace("    ", "\t")),
            ("white space behind lines", by_line(&text, &|line| format!("{line}  \t"))),
            ("exponents of Fortran", by_line(&text, &exponent)),
        ] {
            let read = Record::from_reader(name, copy.as_bytes(), format.as_ref());
            let read = read.unwrap_or_else(|error| panic!("{what}: {error}"));
            assert_eq!(read, wanted, "{name}: {what}");
        }
        // Blank lines among the numbers, up to the last one.
        let lines: Vec<&str> = text.lines().collect();
        let first = lines.iter().position(|line| is_of_numbers(line)).unwrap_or(lines.len() - 1);
        for at in [first, first + 1, lines.len() - 1] {
            let mut lines = lines.clone();
            lines.insert(at, "");
            let read = Record::from_reader(name, lines.join("\n").as_bytes(), format.as_ref());
            assert_eq!(read.unwrap(), wanted, "{name}: blank line {at}");
        }
    }
}

/// Names of places in Latin-1.
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
        let whole = bytes(name);
        let text = String::from_utf8(whole.clone()).unwrap();
        let at = text.find(place).unwrap_or_else(|| panic!("{name}: {place}"));
        let mut latin = whole.clone();
        latin[at] = 0xc7;
        latin[at + 1] = 0xfd;
        let format = agencies().into_iter().find(|(other, _)| *other == name).unwrap().1;
        let read = |bytes: &[u8]| Record::from_reader(name, bytes, format.as_ref());
        assert_eq!(read(&latin).unwrap(), read(&whole).unwrap(), "{name}: {place}");
    }
}

#[test]
fn decimal_commas_are_named() {
    for (name, format) in agencies() {
        let text = String::from_utf8(bytes(name)).unwrap();
        let commas =
            |line: &str| if is_of_numbers(line) { line.replace('.', ",") } else { line.into() };
        let text: String = text.lines().map(|line| commas(line) + "\n").collect();
        // The counts of K-NET have no decimals.
        if name != "k_net.ns" {
            let (line, reason) = refusal(&text, format.as_ref());
            let clear = match &reason {
                FileFault::Value { quantity, .. } if quantity == "number of columns" => {
                    name == "k_net.csv"
                }
                FileFault::Value { found, .. } => is_no_number(&reason) && found.contains(','),
                _ => false,
            };
            assert!(clear && line > 0, "{name}, line {line}: {reason}");
        }
    }
}

/// Cells that a spreadsheet adds.
#[test]
fn empty_cells_at_the_end_of_lines_are_no_columns() {
    let format = KNetCsvFormat::default();
    let text = String::from_utf8(bytes("k_net.csv")).unwrap();
    let wanted = format.parse_all("", &mut text.as_bytes()).unwrap();
    for cells in [",", ",,"] {
        let lines: Vec<String> =
            text.lines().map(|line| line.trim_end().to_owned() + cells).collect();
        let padded = lines.join("\n");
        let padded = format!("{padded}\n{cells}\n");
        assert_eq!(format.parse_all("", &mut padded.as_bytes()).unwrap(), wanted);
    }
    // A missing sample is not an empty cell.
    let lost = text.replacen(",18.357", ",", 1);
    let (line, reason) = refusal(&lost, &format);
    assert_eq!((line, reason), (16, count("columns", 3, "4, as before")));
}

/// Files of velocity or displacement alone say so, in either layout of CESMD.
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
            let (line, reason) =
                refusal(&text, &CosmosFormat { channel, ..CosmosFormat::default() });
            let found = title.chars().take(60).collect();
            let needed = "an acceleration in a known unit".to_owned();
            assert_eq!((line, reason), (2, FileFault::Format { found, needed }));
        }
        let all = CosmosFormat::default().parse_all("", &mut text.as_bytes()).unwrap_err();
        assert!(all.to_string().contains("instead of an acceleration in a known unit"), "{all}");
    }
    // A channel that is not there, beside one that is.
    let text = String::from_utf8(bytes("cosmos.v2c")).unwrap();
    let (_, reason) = refusal(&text, &CosmosFormat { channel: 3, ..CosmosFormat::default() });
    assert_eq!(reason, value("requested channel", "3", "from 1 to 2"));
}
