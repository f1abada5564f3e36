//! GOAL: a file of cases that a program runs itself keeps its rows when the process ends, accepts new columns, and has
//! warnings.
//! SCENE: six cases by formula, one of which fails, in files that are closed, cut and opened again.
//! REFERENCE: the cells that were appended; the table of the same cases in one process.

use std::path::{Path, PathBuf};

use basemat::sweep::{CaseFile, CaseRow, CaseTable, Parameter, Sweep, SweepError};
use basemat::{Error, FileFault};

fn path(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("case_files").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    folder.join("cases.csv")
}

fn part_file(path: &Path) -> PathBuf {
    path.with_file_name("cases.csv.part")
}

fn sweep() -> Sweep<'static> {
    Sweep::grid([
        Parameter::numbers("friction", [0.1, 0.2, 0.3]),
        Parameter::texts("record", ["a, b", "two\nlines"]),
    ])
    .unwrap()
}

/// Appends a case; the fourth has a second result, the third fails and the sixth warns.
fn append(file: &mut CaseFile, case: usize) {
    let slip = case as f64 / 3.0;
    let names: &[&str] = match case {
        2 => &[],
        3 => &["gap_m", "slip_m"],
        _ => &["slip_m"],
    };
    let outcome = match case {
        2 => Err("no, \"not\"\nthis".to_owned()),
        3 => Ok(vec![1.0, slip]),
        _ => Ok(vec![slip]),
    };
    let warnings = if case == 5 { "slips, and\nwarns" } else { "" };
    file.append(case, names, outcome, warnings).unwrap();
}

fn finished_table(name: &str) -> CaseTable {
    let mut file = sweep().open(path(name)).unwrap();
    for case in 0..6 {
        append(&mut file, case);
    }
    file.finish().unwrap()
}

/// The bits of a result, if the case has it.
fn value_bits(row: &CaseRow<'_>, name: &str) -> Option<u64> {
    row.value(name).ok().map(f64::to_bits)
}

#[test]
fn interrupted_tables_continue_with_rows_in_any_order() {
    let expected = finished_table("expected");
    for first in [vec![], vec![2], vec![5, 0, 2], vec![0, 2, 1, 3], vec![5, 4, 3, 2, 1, 0]] {
        let path = path("resumed");
        let mut file = sweep().open(&path).unwrap();
        for &case in &first {
            append(&mut file, case);
        }
        drop(file);
        // The process was killed within this row.
        let text = std::fs::read_to_string(part_file(&path)).unwrap();
        std::fs::write(part_file(&path), format!("{text}4,0.3,\"a,")).unwrap();
        let mut file = sweep().open(&path).unwrap();
        let missing_cases: Vec<_> = (0..6).filter(|case| !first.contains(case)).collect();
        assert_eq!(file.missing(), missing_cases);
        assert_eq!(file.table().rows().len(), first.len());
        for case in missing_cases {
            append(&mut file, case);
        }
        let table = file.finish().unwrap();
        assert!(!part_file(&path).exists());
        // Columns are in the order of the results.
        for (row, other) in table.rows().zip(expected.rows()) {
            assert_eq!((row.index, row.warnings), (other.index, other.warnings));
            assert_eq!(row.results.err(), other.results.err());
            for name in ["slip_m", "gap_m"] {
                let name_of_case = format!("{name} of case {}", row.index);
                assert_eq!(value_bits(&row, name), value_bits(&other, name), "{name_of_case}");
            }
        }
        assert_eq!(table, sweep().merge([&path]).unwrap());
        let file_opened_again = sweep().open(&path).unwrap();
        assert_eq!(
            (file_opened_again.missing(), file_opened_again.finish().unwrap()),
            (vec![], table)
        );
    }
    let rows_with_warnings: Vec<_> =
        expected.rows().filter(|row| !row.warnings.is_empty()).collect();
    assert_eq!(
        (rows_with_warnings[0].index, rows_with_warnings[0].warnings, rows_with_warnings.len()),
        (5, "slips, and\nwarns", 1)
    );
    let text = expected.csv();
    assert!(text.contains("\ncase,friction,record,slip_m,gap_m,warnings,error\n"), "{text}");
    assert!(expected.to_string().contains("case 5 warns: slips, and"), "{expected}");
}

#[test]
fn a_case_twice_and_a_table_with_holes_are_errors() {
    let path = path("refused");
    let mut file = sweep().shard(1, 2).unwrap().open(&path).unwrap();
    append(&mut file, 3);
    for case in [3, 2, 6] {
        let error_of_a_second_row = file.append(case, &["slip_m"], Ok(vec![0.0]), "");
        assert!(
            matches!(error_of_a_second_row, Err(Error::Scene { quantity: "case", .. })),
            "{error_of_a_second_row:?}"
        );
    }
    let size = file.append(1, &["slip_m"], Ok(vec![]), "");
    assert!(matches!(size, Err(Error::Size { found: 0, needed: 1, .. })), "{size:?}");
    for name in ["friction", "case", "warnings", "error"] {
        let error_of_a_name = file.append(1, &[name], Ok(vec![0.0]), "");
        assert!(matches!(error_of_a_name, Err(Error::DuplicateName { .. })), "{error_of_a_name:?}");
    }
    let error_of_missing_cases = file.finish();
    assert!(
        matches!(&error_of_missing_cases, Err(Error::Sweep(SweepError::Missing { cases, .. })) if *cases == [1, 5])
    );
    // A sweep of another grid cannot use the rows.
    let other_sweep = Sweep::grid([Parameter::numbers("friction", [0.1, 0.2, 0.3])]).unwrap();
    assert!(matches!(other_sweep.open(&path), Err(Error::File(_))));
}

fn sweep_of_two() -> Sweep<'static> {
    Sweep::grid([Parameter::numbers("x", [1.0, 2.0])]).unwrap()
}

#[test]
fn a_shard_whose_cases_all_failed_merges_and_one_without_results_does_not() {
    let paths = [path("failed"), path("good")];
    for (index, outcome) in [Err("failed".to_owned()), Ok(vec![7.0])].into_iter().enumerate() {
        let mut file = sweep_of_two().shard(index, 2).unwrap().open(&paths[index]).unwrap();
        let names: &[&str] = if index == 0 { &[] } else { &["y"] };
        file.append(index, names, outcome, "").unwrap();
        file.finish().unwrap();
    }
    let merged_table = sweep_of_two().merge([&paths[0], &paths[1]]).unwrap();
    assert_eq!(merged_table, sweep_of_two().merge([&paths[1], &paths[0]]).unwrap());
    assert_eq!(
        (merged_table.columns(), merged_table.rows().nth(1).unwrap().value("y")),
        (&["y".to_owned()][..], Ok(7.0))
    );
    let bare_path = path("bare");
    let mut file = sweep_of_two().shard(0, 2).unwrap().open(&bare_path).unwrap();
    file.append::<&str>(0, &[], Ok(vec![]), "").unwrap();
    file.finish().unwrap();
    let Err(Error::File(error)) = sweep_of_two().merge([&bare_path, &paths[1]]) else {
        panic!()
    };
    assert!(matches!(error.fault, FileFault::Value { .. }), "{error}");
}
