//! GOAL: rows of a file of cases are used only as they were written; no row is lost without an error; a full disk ends
//! a sweep with the rows that were computed.
//! SCENE: tables of a formula, with every bit of their files flipped or a quotation mark inserted anywhere; files that
//! cannot grow.
//! REFERENCE: the table as it was computed; the check sum computed from the cells.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::sweep::SweepError;
use basemat::sweep::{CaseTable, Parameter, Sweep, SweepCase};
use basemat::{Error, FileError, FileFault, Result};

use basemat_problems::check_sum::{check_sum, text_words};

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("damaged_tables").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Writes a new file, since some systems flush a file that is truncated and written again.
fn write(path: &Path, content: &[u8]) {
    let _ = std::fs::remove_file(path);
    std::fs::write(path, content).unwrap();
}

const RESULT_COLUMNS: [&str; 2] = ["slip_m", "ratio"];

/// `count` × 2 cases.
fn sweep(count: u32) -> Sweep<'static> {
    Sweep::grid([
        Parameter::numbers("friction", (1..=count).map(|k| 0.1 * f64::from(k))),
        Parameter::texts("record", ["El Centro", "two\nlines"]),
    ])
    .unwrap()
}

fn compute(case: &SweepCase<'_>) -> std::result::Result<[f64; 2], String> {
    match case.index {
        3 => Err("of \"two\"\nlines".to_owned()),
        4 => Ok([f64::NAN, -0.0]),
        index => Ok([(index as f64).sqrt(), case.value("friction").unwrap() / 3.0]),
    }
}

type Compute = dyn Fn(&SweepCase<'_>) -> std::result::Result<[f64; 2], String> + Sync;

fn finished_table(count: u32) -> CaseTable {
    sweep(count).table(RESULT_COLUMNS, compute).unwrap()
}

#[test]
fn the_check_sum_is_that_of_all_values() {
    let table = finished_table(3);
    let text = table.csv();
    let mut reader = basemat_problems::csv::ReaderBuilder::new();
    let mut reader = reader.comment(Some(b'#')).from_reader(text.as_bytes());
    let mut words = reader.headers().unwrap().iter().map(text_words).collect::<Vec<_>>().concat();
    for (row, cells) in table.rows().zip(reader.records()) {
        let cells = cells.unwrap();
        words.push(row.index as u64);
        words.extend(text_words(&cells[1]));
        words.extend(text_words(&cells[2]));
        match row.results {
            Ok(results) => {
                words.push(results.len() as u64);
                words.extend(results.iter().map(|value| value.to_bits()));
            }
            Err(reason) => words.extend(text_words(reason)),
        }
    }
    let first = format!("# basemat sweep 1 check sum {:016x}", check_sum(&words));
    assert_eq!(text.lines().next(), Some(&*first));
}

#[test]
fn every_damaged_byte_is_an_error() {
    let table = finished_table(3);
    let path = folder("bytes").join("cases.csv");
    let text = table.csv().as_bytes().to_vec();
    let mut error_count = 0;
    for place in 0..text.len() {
        for bit in 0..8 {
            let mut damaged_text = text.clone();
            damaged_text[place] ^= 1 << bit;
            write(&path, &damaged_text);
            match sweep(3).merge([&path]) {
                Ok(merged) => assert_eq!(merged, table, "byte {place}, bit {bit}"),
                Err(Error::File(_) | Error::Sweep(_) | Error::DuplicateName { .. }) => {
                    error_count += 1;
                }
                Err(error) => panic!("byte {place}, bit {bit}: {error}"),
            }
        }
    }
    assert!(error_count > 7 * text.len(), "{error_count}");
}

/// Changed digits are damage that a parser of numbers cannot detect.
#[test]
fn edited_digits_are_errors() {
    let table = finished_table(4);
    let path = folder("digits").join("cases.csv");
    let text = table.csv();
    let mut damaged_count = 0;
    for case in [0, 2, 6] {
        let line = text.lines().find(|line| line.starts_with(&format!("{case},"))).unwrap();
        let line_start = text.find(line).unwrap();
        let results = line.find("El Centro").unwrap()..line.rfind(',').unwrap();
        let digits =
            results.map(|at| line_start + at).filter(|&at| text.as_bytes()[at].is_ascii_digit());
        for at in digits {
            let mut changed_bytes = text.as_bytes().to_vec();
            changed_bytes[at] = b'0' + (changed_bytes[at] - b'0' + 1) % 10;
            write(&path, &changed_bytes);
            match sweep(4).merge([&path]) {
                Err(Error::File(FileError { fault, .. })) => {
                    assert_eq!(fault, FileFault::Damaged { quantity: "the table".into() });
                    damaged_count += 1;
                }
                // Another seventeenth digit may give the same number.
                merged => assert_eq!(merged.unwrap(), table, "byte {at} of case {case}"),
            }
        }
    }
    assert!(damaged_count > 30, "{damaged_count}");
}

fn plain_sweep() -> Sweep<'static> {
    let friction = (0..50).map(|k| 0.1 * f64::from(k));
    Sweep::grid([Parameter::numbers("friction", friction)]).unwrap()
}

fn plain_results(case: &SweepCase<'_>) -> [f64; 2] {
    [1.0 / 3.0, case.index as f64]
}

/// The mark is in rows with quoted cells, which close it, and in rows without any, which do not.
#[test]
fn a_stray_quotation_mark_drops_no_rows() {
    for (name, sweep, compute) in [
        ("quoted", &(|| sweep(25)) as &dyn Fn() -> Sweep<'static>, &compute as &Compute),
        ("plain", &plain_sweep, &|case: &SweepCase<'_>| Ok::<_, String>(plain_results(case))),
    ] {
        let folder = folder(&format!("quotes_{name}"));
        let path = folder.join("cases.csv");
        let part = folder.join("cases.csv.part");
        let table = sweep().table(RESULT_COLUMNS, compute).unwrap();
        let text = table.csv();
        let runs = AtomicUsize::new(0);
        let mut accepted_count = 0;
        let mut error_count = 0;
        for at in (0..text.len()).filter(|&at| text.is_char_boundary(at)) {
            let damaged_text = format!("{}\"{}", &text[..at], &text[at..]);
            let _ = std::fs::remove_file(&path);
            write(&part, damaged_text.as_bytes());
            runs.store(0, Ordering::Relaxed);
            let computed = sweep().table_in(&path, RESULT_COLUMNS, |case| {
                runs.fetch_add(1, Ordering::Relaxed);
                compute(case)
            });
            match computed {
                Ok(computed) => {
                    assert_eq!(computed, table, "{name}, {at}");
                    assert_eq!(runs.load(Ordering::Relaxed), 0, "{name}, {at}");
                    accepted_count += 1;
                }
                Err(Error::File(_)) => {
                    assert_eq!(
                        std::fs::read_to_string(&part).unwrap(),
                        damaged_text,
                        "{name}, {at}"
                    );
                    error_count += 1;
                }
                Err(other) => panic!("{name}, {at}: {other}"),
            }
        }
        assert!(
            accepted_count < 100 && error_count > text.len() / 2,
            "{name}: {accepted_count} taken, {error_count} errors"
        );
    }
}

#[cfg(unix)]
fn index_results(case: &SweepCase<'_>) -> [f64; 2] {
    [case.index as f64, 0.5]
}

/// Runs in a separate process whose files are limited to 2 or 4 kB: `ulimit` counts in blocks.
#[cfg(unix)]
#[test]
fn a_full_disk_ends_the_sweep_with_its_rows() {
    const FRICTION_COUNT: u32 = 200;
    const TEST_NAME: &str = "results::damaged_tables::a_full_disk_ends_the_sweep_with_its_rows";
    let heading = "rows begin\n";
    let end = "rows end\n";
    if let Some(path) = std::env::var_os("BASEMAT_FULL_DISK") {
        let runs = AtomicUsize::new(0);
        let fault = sweep(FRICTION_COUNT).table_in(path, RESULT_COLUMNS, |case| {
            runs.fetch_add(1, Ordering::Relaxed);
            Result::Ok(index_results(case))
        });
        let Err(Error::Sweep(error)) = fault else { panic!("{fault:?}") };
        let SweepError::Unwritten { computed, left, rows, .. } = &error else {
            panic!("{error}")
        };
        assert_eq!((*computed, computed + left), (runs.load(Ordering::Relaxed), 400), "{error}");
        // No case starts after the first row that could not be written.
        assert!(*computed < 150, "{error}");
        assert!(!error.to_string().contains("El Centro"), "{error}");
        println!("{heading}{rows}{end}");
        return;
    }
    let folder = folder("full");
    let path = folder.join("cases.csv");
    let part = folder.join("cases.csv.part");
    let test = std::env::current_exe().unwrap();
    let output = std::process::Command::new("sh")
        .args(["-c", "trap '' XFSZ; ulimit -f 4; exec \"$0\" --exact \"$1\" --nocapture"])
        .arg(test)
        .arg(TEST_NAME)
        .env("BASEMAT_FULL_DISK", &path)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    let rows = text.split_once(heading).unwrap().1.split_once(end).unwrap().0;
    let complete_table = sweep(FRICTION_COUNT);
    let complete_table =
        complete_table.table(RESULT_COLUMNS, |case| Result::Ok(index_results(case))).unwrap();
    // The sweep continues from the truncated file, and from the rows in the error.
    for saved_rows in [std::fs::read_to_string(&part).unwrap(), rows.to_owned()] {
        let _ = std::fs::remove_file(&path);
        write(&part, saved_rows.as_bytes());
        let saved_count = saved_rows.matches("El Centro").count();
        let runs = AtomicUsize::new(0);
        let table = sweep(FRICTION_COUNT).table_in(&path, RESULT_COLUMNS, |case| {
            runs.fetch_add(1, Ordering::Relaxed);
            Result::Ok(index_results(case))
        });
        assert_eq!(table.unwrap(), complete_table);
        let runs = runs.load(Ordering::Relaxed);
        assert!(
            saved_count > 5 && runs <= 400 - 2 * saved_count + 2,
            "{runs} runs, {saved_count} saved"
        );
    }
}

#[test]
fn many_values_are_compared_quickly() {
    let clock = std::time::Instant::now();
    let count = 300_000;
    let numbers = Parameter::numbers("x", (0..count).map(f64::from));
    let texts = Parameter::texts("y", (0..count).map(|k| k.to_string()));
    assert_eq!(Sweep::grid([numbers]).unwrap().cases().len(), 300_000);
    assert!(Sweep::grid([texts]).is_ok());
    let repeated_parameter = Parameter::numbers("x", (0..count).map(f64::from).chain([7.0]));
    let expected_error = Error::DuplicateName { quantity: "value", name: "7".to_owned() };
    let item = "parameter 'x'".to_owned();
    assert_eq!(
        Sweep::grid([repeated_parameter]).unwrap_err(),
        Error::Item { item, source: Box::new(expected_error) }
    );
    // Comparing every pair of values would take 4.5e10 comparisons.
    assert!(clock.elapsed().as_secs_f64() < 3.0, "{:?}", clock.elapsed());
}
