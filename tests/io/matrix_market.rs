//! GOAL: Matrix Market files keep every bit; invalid files are errors with line and cause.
//! SCENE: files of scipy, spellings in use, round trips, invalid files.
//! REFERENCE: numbers that scipy and numpy give for the same files.

use basemat::structure::Triplets;
use basemat::{Error, FileError, FileFault, MemoryError};

use basemat_problems::faults::{count, not_a_number, value};
use basemat_problems::random::Random;

/// All entries, row by row; repeated entries are summed.
fn dense(matrix: &Triplets) -> Vec<f64> {
    basemat_problems::dense::dense(matrix).concat()
}

fn data(name: &str) -> Triplets {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/matrix_market/");
    Triplets::read_matrix_market(format!("{folder}{name}.mtx")).unwrap()
}

fn fault(line: usize, fault: FileFault) -> Error {
    Error::File(FileError { file: "text".into(), line, fault })
}

fn parse(text: &str) -> basemat::Result<Triplets> {
    Triplets::from_matrix_market("text", text.as_bytes())
}

/// Files of scipy.io.mmwrite; results of scipy.io.mmread and numpy for them: number of
/// nonzero entries, two of them, and the sum of all logarithms.
#[test]
fn files_of_scipy_are_read_as_by_scipy() {
    // Order, count, entries above and below the diagonal, sum of logarithms.
    const GENERAL_MATRIX: (usize, usize, [f64; 2], f64) =
        (6, 21, [-255_566.503_131_418_17, 0.0], 98.743_898_183_749);
    const SYMMETRIC_MATRIX: (usize, usize, [f64; 2], f64) =
        (6, 30, [-255_566.505_151_404_3, 1.002_313_601_275_691_3e-9], 134.547_795_023_493_85);
    for (name, (order, count, [above, below], logarithms)) in [
        ("coordinate_general", GENERAL_MATRIX),
        ("array_general", GENERAL_MATRIX),
        ("coordinate_symmetric", SYMMETRIC_MATRIX),
        ("array_symmetric", SYMMETRIC_MATRIX),
        ("integer_symmetric", (3, 7, [-1.0, -1.0], 2.079_441_541_679_835_7)),
    ] {
        let values = dense(&data(name));
        assert_eq!(values.len(), order * order);
        let nonzero: Vec<f64> = values.iter().copied().filter(|value| *value != 0.0).collect();
        assert_eq!(nonzero.len(), count, "{name}");
        assert_eq!((values[1], values[order * order - 2]), (above, below), "{name}");
        let sum: f64 = nonzero.iter().map(|value| value.abs().ln()).sum();
        assert!((sum - logarithms).abs() < 1e-10, "{name}: {sum}");
    }
    assert_eq!(dense(&data("coordinate_general")), dense(&data("array_general")));
    assert_eq!(dense(&data("coordinate_symmetric")), dense(&data("array_symmetric")));
}

#[test]
fn round_trips_keep_every_bit() {
    let mut random = Random(5);
    for is_symmetric in [false, true] {
        let mut matrix = Triplets::new(40);
        for _ in 0..300 {
            let i = (random.bits() % 40) as usize;
            let j = (random.bits() % 40) as usize;
            let value = random.within(-1.0, 1.0) * random.log_within(1e-300, 1e300);
            matrix.add(i, j, value);
            if is_symmetric && i != j {
                matrix.add(j, i, value);
            }
        }
        matrix.add(0, 39, 0.0);
        let mut file = Vec::new();
        matrix.to_matrix_market("memory", &mut file).unwrap();
        let text = String::from_utf8(file).unwrap();
        assert_eq!(text.lines().next().unwrap().ends_with("symmetric"), is_symmetric);
        assert!(text.lines().all(|line| !line.ends_with(" 0e0")), "zeros in the file");
        let matrix_read = parse(&text).unwrap();
        assert_eq!(dense(&matrix_read), dense(&matrix));
        // The matrix that was read is written again, byte by byte.
        let mut text_written_again = Vec::new();
        matrix_read.to_matrix_market("memory", &mut text_written_again).unwrap();
        assert_eq!(text_written_again, text.as_bytes());
    }
}

#[test]
fn spellings_in_use_are_read() {
    let text = "%%matrixmarket MATRIX Coordinate Real General\r\n% c\r\n\r\n 2 2 3 \r\n\
                1 1 1.5D+3\r\n% between\r\n2  2\t-1e-3\r\n1 1 0.5\r\n\r\n";
    assert_eq!(dense(&parse(text).unwrap()), [1500.5, 0.0, 0.0, -1e-3]);
    let array = "%%MatrixMarket matrix array real symmetric\n2 2\n1\n2\n3\n";
    assert_eq!(dense(&parse(array).unwrap()), [1.0, 2.0, 2.0, 3.0]);
    assert_eq!(parse("%%MatrixMarket matrix array real general\n0 0").unwrap().order(), 0);
}

/// Editors may write a byte-order mark before the first line.
#[test]
fn a_byte_order_mark_is_skipped() {
    let text = "%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 2.0\n";
    let text_with_mark = format!("\u{feff}{text}");
    assert_eq!(parse(&text_with_mark).unwrap(), parse(text).unwrap());
    assert_eq!(parse(&text_with_mark.replace("2.0", "x")), Err(fault(3, not_a_number("x"))));
    assert!(parse(&text.replace("2.0", "\u{feff}2.0")).is_err());
}

/// File of one entry.
fn file_of_one(value: &str) -> String {
    format!("%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 {value}\n")
}

#[test]
fn numbers_are_read_completely_or_are_errors() {
    for two in ["2", "2.", "+2.0", "0.2e1", "2D0", "2.0d+00", ".2E+1"] {
        assert_eq!(dense(&parse(&file_of_one(two)).unwrap()), [2.0], "{two}");
    }
    for invalid_number in
        ["2,0", "2.0m", "2D", "0x2", "2_0", "1D999", "inf", "\u{2212}2", "2;", "**", "Dinf"]
    {
        let error = parse(&file_of_one(invalid_number)).unwrap_err();
        assert_eq!(error, fault(3, not_a_number(invalid_number)), "{invalid_number}");
    }
    for invalid_number in ["1,0", "1.0", "1D0", "-1", "1e0"] {
        let text = file_of_one("2").replace("1 1 2", &format!("{invalid_number} 1 2"));
        let not_whole = fault(3, not_whole(invalid_number));
        let not_index = fault(3, value("index", invalid_number, "from 1 to 1"));
        let error = parse(&text).unwrap_err();
        assert!([not_whole, not_index].contains(&error), "{invalid_number}: {error}");
    }
}

/// Coordinate file of a general matrix with these lines after the header.
fn coordinate(lines: &str) -> String {
    format!("%%MatrixMarket matrix coordinate real general\n{lines}")
}

/// Coordinate file of a symmetric matrix with these lines after the header.
fn symmetric(lines: &str) -> String {
    format!("%%MatrixMarket matrix coordinate real symmetric\n{lines}")
}

/// Array file of a general matrix with these lines after the header.
fn array(lines: &str) -> String {
    format!("%%MatrixMarket matrix array real general\n{lines}")
}

/// File of a matrix without entries whose header ends with `text`.
fn header(text: &str) -> String {
    format!("%%MatrixMarket {text}\n2 2 0\n")
}

fn not_whole(text: &str) -> FileFault {
    value("field", &format!("'{text}'"), "a whole number")
}

fn wrong_fields(found: usize, needed: &str) -> FileFault {
    count("fields", found, needed)
}

fn wrong_format(found: &str, needed: &str) -> FileFault {
    FileFault::Format { found: found.to_owned(), needed: needed.to_owned() }
}

fn wrong_header(found: &str) -> FileFault {
    wrong_format(found, "'%%MatrixMarket matrix <format> <field> <symmetry>'")
}

fn unsupported(text: &str) -> FileFault {
    wrong_format(text, "a real matrix, coordinate or array, general or symmetric")
}

fn wrong_index(found: &str) -> FileFault {
    value("index", found, "from 1 to 2")
}

fn wrong_entries(found: usize, needed: usize) -> FileFault {
    count("entries", found, &format!("{needed}, as the size line states"))
}

/// Fault of a matrix of `rows` rows that needs `bytes` bytes.
fn too_large(rows: f64, bytes: f64) -> FileFault {
    FileFault::Memory(MemoryError {
        quantity: "rows of the matrix",
        asked: rows,
        needed: bytes,
        limit: 8.0 * 1024.0_f64.powi(3),
        remedy: "for one part of a model",
    })
}

#[test]
fn invalid_files_are_errors_with_line_and_cause() {
    let long_word = "1".repeat(70_000);
    for (text, line, reason) in [
        (String::new(), 0, FileFault::Missing { quantity: "header".into() }),
        ("1 2 3\n".into(), 1, wrong_header("1 2 3")),
        (
            "%%MatrixMarket matrix coordinate real\n".into(),
            1,
            wrong_header("%%MatrixMarket matrix coordinate real"),
        ),
        (header("vector coordinate real general"), 1, unsupported("vector")),
        (header("matrix sparse real general"), 1, unsupported("sparse")),
        (header("matrix coordinate complex general"), 1, unsupported("complex")),
        (header("matrix coordinate pattern general"), 1, unsupported("pattern")),
        (header("matrix coordinate real hermitian"), 1, unsupported("hermitian")),
        (header("matrix coordinate real skew-symmetric"), 1, unsupported("skew-symmetric")),
        (coordinate("% only a comment\n"), 2, wrong_fields(0, "3")),
        (coordinate("2 2\n"), 2, wrong_fields(2, "3")),
        (coordinate("2 -2 1\n"), 2, not_whole("-2")),
        (coordinate("2 2 x\n"), 2, not_whole("x")),
        (coordinate("2 3 1\n"), 2, value("size of the matrix", "2 x 3", "square")),
        (coordinate("2 2 1\n1 1\n"), 3, wrong_fields(2, "3")),
        (coordinate("2 2 1\n1 1 1 0\n"), 3, wrong_fields(4, "3")),
        (coordinate("2 2 1\n1 1 nan\n"), 3, not_a_number("nan")),
        (coordinate("2 2 1\n1 1 1e999\n"), 3, not_a_number("1e999")),
        (coordinate("2 2 1\n1.5 1 1\n"), 3, not_whole("1.5")),
        (coordinate("2 2 1\n0 1 1\n"), 3, wrong_index("0")),
        (coordinate("2 2 1\n1 3 1\n"), 3, wrong_index("3")),
        (coordinate("2 2 3\n1 1 1\n%\n2 2 1\n"), 5, wrong_entries(2, 3)),
        (coordinate("2 2 1\n1 1 1\n\n2 2 1\n"), 5, wrong_entries(2, 1)),
        (coordinate("2 2 18446744073709551615\n1 1 1\n"), 3, wrong_entries(1, usize::MAX)),
        (
            coordinate("99999999999999 99999999999999 0\n"),
            2,
            too_large(99_999_999_999_999.0, 400.0 * 99_999_999_999_999.0),
        ),
        (coordinate("100000000 100000000 1\n1 1 1.0\n"), 2, too_large(1e8, 4e10)),
        (array("30000 30000\n1\n"), 2, too_large(3e4, 24.0 * 9e8)),
        (
            symmetric("2 2 1\n1 2 1.0\n"),
            3,
            value("entry", "(1, 2)", "on or below the diagonal of a symmetric matrix"),
        ),
        (array("2 2\n1\n2\n3\n"), 5, wrong_entries(3, 4)),
        (array("2 2\n1\n2\n3\n4\n5\n"), 7, wrong_entries(5, 4)),
        (array("2 2\n1 2\n"), 3, wrong_fields(2, "1")),
        (coordinate(&long_word), 2, value("length of the line", "65536 bytes or more", "less")),
        (coordinate("\u{fffd}\n"), 2, wrong_fields(1, "3")),
    ] {
        assert_eq!(
            parse(&text).unwrap_err(),
            fault(line, reason),
            "{}",
            &text[..text.len().min(90)]
        );
    }
    let error_of_a_missing_file = Triplets::read_matrix_market("/no/such/file.mtx").unwrap_err();
    assert!(error_of_a_missing_file.to_string().starts_with("/no/such/file.mtx cannot be read"));
    let error_of_a_missing_folder =
        Triplets::new(1).write_matrix_market("/no/such/file.mtx").unwrap_err();
    assert!(
        error_of_a_missing_folder.to_string().contains("cannot be written"),
        "{error_of_a_missing_folder}"
    );
    let mut invalid_matrix = Triplets::new(1);
    invalid_matrix.add(0, 0, f64::NAN);
    assert!(matches!(invalid_matrix.to_matrix_market("m", Vec::new()), Err(Error::Input { .. })));
    let mut invalid_matrix = Triplets::new(1);
    invalid_matrix.add(0, 1, 1.0);
    assert!(matches!(invalid_matrix.to_matrix_market("m", Vec::new()), Err(Error::Index { .. })));
}

#[test]
fn an_invalid_matrix_leaves_the_file_unchanged() {
    let path = std::env::temp_dir().join(format!("basemat_{}_kept.mtx", std::process::id()));
    let mut matrix = Triplets::new(2);
    matrix.add(0, 0, 1.0);
    matrix.write_matrix_market(&path).unwrap();
    let mut invalid_matrix = Triplets::new(2);
    invalid_matrix.add(0, 2, 1.0);
    assert!(matches!(invalid_matrix.write_matrix_market(&path), Err(Error::Index { .. })));
    let kept_matrix = Triplets::read_matrix_market(&path);
    std::fs::remove_file(&path).unwrap();
    assert_eq!(kept_matrix.unwrap(), matrix);
}

#[test]
fn orders_beyond_memory_are_errors() {
    for order in [100_000_001, usize::MAX - 1, usize::MAX] {
        let written = Triplets::new(order).to_matrix_market("huge", Vec::new());
        assert!(matches!(written, Err(Error::Memory(_))), "{order}");
    }
}
