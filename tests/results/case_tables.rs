//! GOAL: tables of sweeps are right: shards and their merger, failed cases, the printed form.
//! SCENE: cases by formula, with errors, panics, NaN and infinities; blocks on springs.
//! REFERENCE: the whole table, to the last bit.

use std::path::{Path, PathBuf};

use basemat::prelude::*;
use basemat::sweep::CaseTable;
use basemat::sweep::{SweepCase, SweepError};
use basemat::{Error, FileError, FileFault, MemoryError, Result};
use basemat_problems::faults::value;

/// An empty folder.
pub(super) fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("case_tables").join(name);
    let _ = std::fs::remove_dir_all(&path);
    path
}

/// The number 0.1 + 0.2, which needs seventeen digits.
const SEVENTEEN_DIGITS: f64 = 0.300_000_000_000_000_04;
const RECORD_NAMES: [&str; 3] = ["El Centro, 1940", "the \"pulse\"", "two\nlines"];
pub(super) const RESULT_COLUMNS: [&str; 2] = ["ratio, -", "residual_slip_m"];

/// 4 × 3 × 2 cases.
pub(super) fn sweep() -> Sweep<'static> {
    Sweep::grid([
        Parameter::numbers("friction", [0.1, 0.2, SEVENTEEN_DIGITS, -0.0]),
        Parameter::texts("record", RECORD_NAMES),
        Parameter::numbers("width_m", [4.0, 1e300]),
    ])
    .unwrap()
}

/// Results of a case by a formula; some cases fail, panic or have results that are not finite.
pub(super) fn compute(case: &SweepCase<'_>) -> std::result::Result<[f64; 2], String> {
    let friction = case.value("friction").unwrap();
    let width = case.value("width_m").unwrap();
    match case.index {
        3 => Err("no, \"not\" this,\r\none; µ".to_owned()),
        8 => panic!("eight, and\nmore"),
        11 => Err(String::new()),
        5 => Ok([f64::NAN, f64::NEG_INFINITY]),
        6 => Ok([f64::INFINITY, -f64::NAN]),
        index => Ok([friction / width, (index as f64).sqrt() * friction.exp()]),
    }
}

pub(super) fn whole_table() -> CaseTable {
    sweep().table(RESULT_COLUMNS, compute).unwrap()
}

/// Files of all shards.
fn shard_files(folder: &Path, count: usize) -> Vec<PathBuf> {
    let mut paths = Vec::new();
    for index in 0..count {
        let path = folder.join(format!("shard_{index}_of_{count}.csv"));
        let shard = sweep().shard(index, count).unwrap();
        shard.table(RESULT_COLUMNS, compute).unwrap().csv().save(&path).unwrap();
        paths.push(path);
    }
    paths
}

pub(super) fn table_error(result: Result<CaseTable>) -> Error {
    match result {
        Err(error @ (Error::Sweep(_) | Error::File(_))) => error,
        other => panic!("{other:?}"),
    }
}

/// Fault of a whole file.
pub(super) fn file_error(file: &str, fault: FileFault) -> Error {
    Error::File(FileError { file: file.to_owned(), line: 0, fault })
}

#[test]
fn cases_are_numbered_by_their_place() {
    let table = whole_table();
    let mut index = 0;
    for (f, friction) in [0.1, 0.2, SEVENTEEN_DIGITS, -0.0].into_iter().enumerate() {
        for (r, record) in RECORD_NAMES.into_iter().enumerate() {
            for (w, width) in [4.0, 1e300].into_iter().enumerate() {
                let row = table.rows().nth(index).unwrap();
                assert_eq!(row.index, index);
                assert_eq!(row.value("friction").unwrap().to_bits(), f64::to_bits(friction));
                assert_eq!(
                    (row.text("record").unwrap(), row.value("width_m").unwrap()),
                    (record, width)
                );
                let places = ["friction", "record", "width_m"].map(|name| row.place(name).unwrap());
                assert_eq!(places, [f, r, w]);
                match index {
                    3 => assert_eq!(row.results, Err("no, \"not\" this,\r\none; µ")),
                    8 => assert_eq!(row.results, Err("the case panicked: eight, and\nmore")),
                    11 => assert_eq!(row.results, Err("failed")),
                    5 | 6 => assert!(row.results.unwrap().iter().any(|value| value.is_nan())),
                    _ => {
                        assert_eq!(row.results.unwrap()[0], friction / width);
                        assert_eq!(row.value("ratio, -").unwrap(), friction / width);
                    }
                }
                index += 1;
            }
        }
    }
    assert_eq!(table.rows().len(), index);
    assert_eq!(table.columns(), RESULT_COLUMNS);
    let row = table.rows().nth(3).unwrap();
    assert!(matches!(
        row.value("residual_slip_m"),
        Err(Error::Part { part, .. }) if part == "case 3 failed"
    ));
    for error in [
        row.value("record").err(),
        row.value("slip").err(),
        row.text("width_m").err(),
        row.place("ratio, -").err(),
    ] {
        assert!(matches!(error, Some(Error::Name { .. })), "{error:?}");
    }
    sweep().run(
        |case| {
            assert!(matches!(case.value("record"), Err(Error::Name { .. })));
            assert!(matches!(case.text("friction"), Err(Error::Name { .. })));
            assert!(matches!(case.place("slip"), Err(Error::Name { .. })));
            Ok::<_, Error>(())
        },
        |_, result| result.unwrap(),
    );
}

#[test]
fn merged_shards_are_the_whole() {
    let complete_table = whole_table();
    let folder = folder("merged");
    assert_eq!(complete_table, complete_table.clone());
    for count in [1, 2, 3, 5, 7, 24, 30] {
        let mut paths = shard_files(&folder, count);
        paths.reverse();
        let merged_table = sweep().merge(&paths).unwrap();
        assert_eq!(merged_table, complete_table, "{count} shards");
        assert_eq!(merged_table.csv(), complete_table.csv());
    }
    // Shards of a shard, merged to that shard.
    let half_sweep = sweep().shard(1, 2).unwrap();
    assert!(half_sweep.shard(2, 3).unwrap().cases().eq((0..24).filter(|case| case % 6 == 5)));
    let mut paths = Vec::new();
    for index in 0..3 {
        let path = folder.join(format!("half_{index}.csv"));
        let half_sweep = sweep().shard(1, 2).unwrap();
        let part = half_sweep.shard(index, 3).unwrap().table(RESULT_COLUMNS, compute).unwrap();
        part.csv().save(&path).unwrap();
        paths.push(path);
    }
    let half_sweep = sweep().shard(1, 2).unwrap();
    let merged_table = half_sweep.merge(&paths).unwrap();
    let half_sweep = sweep().shard(1, 2).unwrap();
    assert_eq!(merged_table, half_sweep.table(RESULT_COLUMNS, compute).unwrap());
    // A table that differs in one bit is not equal.
    let changed_table = sweep().table(RESULT_COLUMNS, |case| {
        let results = compute(case)?;
        let slip = results[1];
        Ok::<_, String>([results[0], if case.index == 2 { slip.next_up() } else { slip }])
    });
    assert_ne!(changed_table.unwrap(), complete_table);
}

#[test]
fn shards_have_bounds() {
    for (index, count) in [(0, 0), (2, 2), (7, 3)] {
        let fault = sweep().shard(index, count).unwrap_err();
        assert_eq!(fault, Error::Index { quantity: "shard", index, bound: count });
    }
    let last_shard = sweep().shard(usize::MAX - 1, usize::MAX).unwrap();
    assert_eq!(last_shard.cases().len(), 0);
    assert_eq!(last_shard.shard(usize::MAX - 1, usize::MAX).unwrap().cases().len(), 0);
    let first_shard = sweep().shard(0, usize::MAX).unwrap().shard(0, 2).unwrap();
    assert!(first_shard.cases().eq([0]));
}

/// Cases and shards that are missing from a merger of these files.
fn missing_parts(paths: &[&PathBuf]) -> (Vec<usize>, Vec<[usize; 2]>) {
    match table_error(sweep().merge(paths)) {
        Error::Sweep(SweepError::Missing { cases, shards }) => (cases, shards),
        other => panic!("{other}"),
    }
}

/// The grid of `sweep` with another third friction and another name of the width.
fn other_sweep(friction: f64, width: &str) -> Sweep<'static> {
    Sweep::grid([
        Parameter::numbers("friction", [0.1, 0.2, friction, -0.0]),
        Parameter::texts("record", RECORD_NAMES),
        Parameter::numbers(width, [4.0, 1e300]),
    ])
    .unwrap()
}

/// Fault of a merger of three shards and the fourth of another sweep.
fn fault_of_other_shard(shards: &[PathBuf], sweep: Sweep<'_>, columns: [&str; 2]) -> FileFault {
    let other_path = shards[0].with_file_name("other.csv");
    let shard = sweep.shard(3, 4).unwrap();
    shard
        .table(columns, |_| Ok::<_, Error>([0.0; 2]))
        .unwrap()
        .csv()
        .save(&other_path)
        .unwrap();
    match self::sweep().merge([&shards[0], &shards[1], &shards[2], &other_path]) {
        Err(Error::File(FileError { fault, file, .. })) => {
            assert_eq!(file, other_path.display().to_string());
            fault
        }
        result => panic!("{result:?}"),
    }
}

#[test]
fn wrong_sets_of_shards_are_errors() {
    let folder = folder("sets");
    let paths = shard_files(&folder, 4);
    let cases_of_third_shard: Vec<usize> = (0..24).filter(|case| case % 4 == 2).collect();
    assert_eq!(
        missing_parts(&[&paths[0], &paths[1], &paths[3]]),
        (cases_of_third_shard, vec![[2, 4]])
    );
    let missing_parts_of_two = missing_parts(&[&paths[1], &paths[3]]);
    assert_eq!((missing_parts_of_two.0.len(), missing_parts_of_two.1), (12, vec![[0, 4], [2, 4]]));
    assert_eq!(missing_parts(&[]), ((0..24).collect(), vec![]));
    let text = sweep().merge([&paths[0], &paths[1], &paths[3]]).unwrap_err().to_string();
    assert_eq!(text, "6 of the sweep's cases missing: 2, 6, 10, 14, 18, 22; shard 2/4");

    let name = paths[0].display().to_string();
    let places_text = format!("here and in {name}");
    assert_eq!(
        table_error(sweep().merge([&paths[0], &paths[1], &paths[0]])),
        file_error(&name, value("case 0", &places_text, "in one place"))
    );
    let missing_path = folder.join("not_there.csv");
    assert_eq!(
        table_error(sweep().merge([&missing_path])),
        file_error(
            &missing_path.display().to_string(),
            FileFault::Unreadable(std::io::ErrorKind::NotFound)
        )
    );

    // The shard of a sweep that differs in a value, a result column or the name of a parameter is an error.
    let fault = fault_of_other_shard(&paths, other_sweep(0.3, "width_m"), RESULT_COLUMNS);
    assert_eq!(fault, value("friction of case 15", "'0.3'", "'0.30000000000000004'"));
    let sweep_with_same_grid = other_sweep(SEVENTEEN_DIGITS, "width_m");
    let fault = fault_of_other_shard(&paths, sweep_with_same_grid, ["ratio, -", "slip"]);
    assert_eq!(fault, value("heading of column 6", "'slip'", "'residual_slip_m'"));
    let renamed_sweep = other_sweep(SEVENTEEN_DIGITS, "width");
    let fault = fault_of_other_shard(&paths, renamed_sweep, RESULT_COLUMNS);
    assert_eq!(fault, value("heading of column 4", "'width'", "'width_m'"));
}

fn parameter_error(parameter: &str, source: Error) -> Error {
    Error::Item { item: format!("parameter '{parameter}'"), source: Box::new(source) }
}

fn repeated_value(value: &str) -> Error {
    Error::DuplicateName { quantity: "value", name: value.to_owned() }
}

fn unnamed_column() -> Error {
    Error::Scene { quantity: "column", needed: "it must have a name" }
}

fn grid_error(parameters: Vec<Parameter>) -> Error {
    Sweep::grid(parameters).unwrap_err()
}

fn numbers(values: &[f64]) -> Parameter {
    Parameter::numbers("x", values.iter().copied())
}

fn is_too_large(error: &Error) -> bool {
    matches!(error, Error::Memory(MemoryError { asked, .. }) if *asked > 1e8)
}

/// Error of a table with these columns, of which no case is computed.
fn column_error(columns: [&str; 2]) -> Error {
    let table = sweep().table(columns, |_| -> Result<[f64; 2]> { unreachable!("columns") });
    table.unwrap_err()
}

#[test]
fn parameters_and_columns_are_checked() {
    let expected_error = Error::Size { quantity: "list of values", found: 0, needed: 1 };
    assert_eq!(grid_error(vec![numbers(&[])]), parameter_error("x", expected_error));
    assert_eq!(
        grid_error(vec![numbers(&[1.0, f64::NAN])]).to_string(),
        "parameter 'x': list of values is not finite: entry 1 is NaN"
    );
    for (repeated_values, value) in [([2.0, 2.0], "2"), ([0.0, -0.0], "-0")] {
        let expected_repetition = parameter_error("x", repeated_value(value));
        assert_eq!(grid_error(vec![numbers(&repeated_values)]), expected_repetition);
    }
    let expected_repetition = parameter_error("r", repeated_value("a"));
    assert_eq!(grid_error(vec![Parameter::texts("r", ["a", "a"])]), expected_repetition);
    let expected_error = Error::Scene { quantity: "value", needed: "it must not be an empty text" };
    assert_eq!(grid_error(vec![Parameter::texts("r", [""])]), parameter_error("r", expected_error));
    assert_eq!(grid_error(vec![Parameter::numbers("", [1.0])]), unnamed_column());
    for name in ["case", "error", "x"] {
        let fault = grid_error(vec![numbers(&[1.0]), Parameter::numbers(name, [1.0])]);
        assert_eq!(fault, Error::DuplicateName { quantity: "column", name: name.to_owned() });
    }
    let many_parameters =
        (0..16).map(|k| Parameter::numbers(format!("x{k}"), (0..16).map(f64::from)));
    assert!(is_too_large(&grid_error(many_parameters.collect())));
    // The number of these cases can be counted, but they exceed the memory.
    let large_parameters =
        ["a", "b"].map(|name| Parameter::numbers(name, (0..15_000).map(f64::from)));
    assert!(is_too_large(&grid_error(large_parameters.to_vec())));
    for columns in [["friction", "y"], ["y", "y"], ["y", "error"]] {
        assert!(matches!(column_error(columns), Error::DuplicateName { .. }), "{columns:?}");
    }
    assert_eq!(column_error(["y", ""]), unnamed_column());
    // Sweeps without parameters, cases or results have tables, too.
    assert_eq!(Sweep::grid([]).unwrap().cases().len(), 1);
    let table = Sweep::new(2).table([], |_| Ok::<_, Error>([])).unwrap();
    let lines: Vec<_> = table.csv().lines().map(str::to_owned).collect();
    assert!(
        lines[0].starts_with("# basemat sweep 1 check sum ")
            && lines[1..] == ["case,error", "0,", "1,"]
    );
    let empty_sweep = Sweep::new(0);
    assert_eq!(empty_sweep.merge([""; 0]).unwrap().csv().lines().nth(1), Some("case,error"));
    assert_eq!(
        empty_sweep.table(["y"], |_| Ok::<_, Error>([0.0])).unwrap().to_string(),
        "case  y\n-------"
    );
}

/// Characters of the longest line.
fn longest(text: &str) -> usize {
    text.lines().map(|line| line.chars().count()).max().unwrap_or(0)
}

#[test]
fn lines_stay_below_a_hundred_characters() {
    let text = whole_table().to_string();
    assert!(text.contains("\ncase 3 failed: no, \"not\" this, one; µ\n"), "{text}");
    assert!(text.lines().any(|line| line.starts_with("3 ") && line.ends_with("failed")), "{text}");

    let names: Vec<String> = (0..12).map(|k| format!("peak_contact_shear_{k}_n_per_m")).collect();
    let columns: [&str; 12] = std::array::from_fn(|k| names[k].as_str());
    let long_name = "a-record-with-a-name-that-goes-on-".repeat(6);
    let grid =
        [Parameter::texts("record", [long_name.as_str(), "short"]), Parameter::numbers("x", [1.5])];
    let table = Sweep::grid(grid).unwrap().table(columns, |case| match case.index {
        0 => Ok([1.25e7; 12]),
        _ => Err(format!("{} {long_name}", "words ".repeat(50))),
    });
    let text = table.unwrap().to_string();
    assert!((90..100).contains(&longest(&text)), "{text}");
    // Every block has the case's number and a part of the columns.
    assert!(text.matches("\ncase ").count() + 1 >= 6, "{text}");
    for name in &names {
        assert_eq!(text.matches(name.as_str()).count(), 1, "{text}");
    }

    // A comparison of twelve cases is printed in blocks.
    let mut simulation = crate::results::simulation();
    let run = simulation.run(50, |_| {}).unwrap();
    let cases = (0..12).map(|k| (format!("a case with friction 0.{k}"), run.clone()));
    let comparison: Comparison = cases.collect();
    let text = comparison.to_string();
    assert!((80..100).contains(&longest(&text)), "{text}");
    let blocks = text.split("\n\n").count();
    assert!(blocks > 1);
    assert_eq!(text.matches("\nbase shear ").count(), blocks);
    assert_eq!(text.matches("a case with").count(), 12);
}
