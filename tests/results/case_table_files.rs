//! GOAL: damaged files of sweeps are errors, a killed sweep continues, and every bit is read back.
//! SCENE: the cases by formula of `case_tables`; files that are cut, edited and deleted.
//! REFERENCE: the whole table, to the last bit; the `csv` crate; the cells that were written.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::prelude::*;
use basemat::sweep::CaseTable;
use basemat::{Error, FileError, FileFault, Result};
use basemat_problems::faults::{count, is_unwritable, is_value, value};
use proptest::prelude::*;

use super::case_tables::{
    RESULT_COLUMNS, compute, file_error, folder, sweep, table_error, whole_table,
};

/// Requirement of a case's number.
const NEEDED_CASE: &str = "one of this sweep, in digits";

/// The fault of a file with this text, and its line.
fn fault(name: &str, text: &str) -> (usize, FileFault) {
    let path = folder(name).join("cases.csv");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, text).unwrap();
    match table_error(sweep().merge([&path])) {
        Error::File(FileError { file, line, fault }) => {
            assert_eq!(file, path.display().to_string());
            (line, fault)
        }
        other => panic!("{other}"),
    }
}

/// Sweep of two numbers.
fn sweep_of_two() -> Sweep<'static> {
    Sweep::grid([Parameter::numbers("x", [0.5, 0.25])]).unwrap()
}

/// The fault of `text` with one of its parts changed, and its line.
fn edited_fault(text: &str, from: &str, to: &str) -> (usize, FileFault) {
    assert!(text.contains(from), "{from}");
    fault("edited", &text.replacen(from, to, 1))
}

#[test]
fn damaged_files_are_errors() {
    let text = whole_table().csv();
    // Cut anywhere: the check sum is that of all rows.
    let path = folder("cut").join("cases.csv");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    for end in (0..text.len() - 1).filter(|&end| text.is_char_boundary(end)) {
        std::fs::write(&path, &text[..end]).unwrap();
        assert!(matches!(table_error(sweep().merge([&path])), Error::File(_)), "{end}");
    }
    std::fs::write(&path, &text.as_bytes()[..=text.find('µ').unwrap()]).unwrap();
    assert!(matches!(
        table_error(sweep().merge([&path])),
        Error::File(FileError { fault: FileFault::Format { needed, .. }, .. }) if needed == "UTF-8"
    ));
    // A byte-order mark and line ends of Windows are accepted.
    std::fs::write(&path, format!("\u{feff}{text}")).unwrap();
    assert_eq!(sweep().merge([&path]).unwrap(), whole_table());
    let table_of_doubles =
        sweep_of_two().table(["y"], |case| Result::Ok([2.0 * case.value("x")?])).unwrap();
    std::fs::write(&path, table_of_doubles.csv().replace('\n', "\r\n")).unwrap();
    assert_eq!(sweep_of_two().merge([&path]).unwrap(), table_of_doubles);

    for (from, to, expected) in [
        ("\n1,0.1,", "\n24,0.1,", value("case", "'24'", NEEDED_CASE)),
        ("\n1,0.1,", "\n+1,0.1,", value("case", "'+1'", NEEDED_CASE)),
        ("\n1,0.1,", "\n1,0.11,", value("friction of case 1", "'0.11'", "'0.1'")),
        ("\n1,0.1,", "\n1,0.1,0,", count("cells", 8, "7")),
        (",-inf,", ",inf,", FileFault::Damaged { quantity: "the table".into() }),
        (
            ",failed",
            "0,failed",
            value("case 11", "a row with an error and results", "a row with either"),
        ),
        ("friction", "fric\"tion", value("heading of column 2", "'fric\"tion'", "'friction'")),
        ("case,", "", value("heading of column 1", "'friction'", "'case'")),
    ] {
        assert_eq!(edited_fault(&text, from, to).1, expected);
    }
    assert_eq!(edited_fault(&text, "\n1,0.1,", "\n24,0.1,").0, 4);
    let word = edited_fault(&text, ",-inf,", ",minus,").1;
    assert_eq!(word.to_string(), "residual_slip_m is 'minus', but must be a number");
    let short_text = "# basemat sweep 1 check sum\ncase\n";
    assert_eq!(fault("short", short_text).1, value("heading of column 2", "''", "'friction'"));
    let fault_of_the_sum = edited_fault(&text, "check sum ", "check sum x").1;
    assert!(is_value(&fault_of_the_sum, "check sum"), "{fault_of_the_sum}");
    // Another version, and files of something else.
    for (found, text) in [
        ("", String::new()),
        ("case,friction,record,width_m,y,error", "case,friction,record,width_m,y,error\n".into()),
        ("# basemat sweep 2 check sum", "# basemat sweep 2 check sum\n".into()),
    ] {
        let needed = "'# basemat sweep 1 check sum …'".to_owned();
        let format = FileFault::Format { found: found.into(), needed };
        assert_eq!(fault("other", &text), (1, format));
    }
}

/// A sweep whose rows are kept in a file, with a count of the cases that were run.
struct KeptSweep {
    path: PathBuf,
    /// The file of an unfinished sweep.
    part: PathBuf,
    runs: AtomicUsize,
}

impl KeptSweep {
    fn new(folder: &Path) -> Self {
        Self {
            path: folder.join("cases.csv"),
            part: folder.join("cases.csv.part"),
            runs: AtomicUsize::new(0),
        }
    }

    /// Table of the cases in the file and of the missing cases, which are run.
    fn table(&self) -> Result<CaseTable> {
        self.runs.store(0, Ordering::Relaxed);
        sweep().table_in(&self.path, RESULT_COLUMNS, |case| {
            self.runs.fetch_add(1, Ordering::Relaxed);
            compute(case)
        })
    }

    /// Number of cases that the last table ran.
    fn runs(&self) -> usize {
        self.runs.load(Ordering::Relaxed)
    }
}

#[test]
fn a_killed_sweep_continues() {
    let kept_sweep = KeptSweep::new(&folder("resumed"));
    let KeptSweep { path, part, .. } = &kept_sweep;
    // The table of all cases, and the same table from its file.
    assert_eq!(kept_sweep.table().unwrap(), whole_table());
    assert_eq!((kept_sweep.runs(), part.exists()), (24, false));
    assert_eq!(std::fs::read_to_string(path).unwrap(), *whole_table().csv());
    assert_eq!(kept_sweep.table().unwrap(), whole_table());
    assert_eq!(kept_sweep.runs(), 0);

    // The process was killed at any byte of a row, or between a row and its check sum; the earlier rows are kept.
    let text = whole_table().csv();
    std::fs::remove_file(path).unwrap();
    let states = Mutex::new(Vec::new());
    let table = sweep().table_in(path, RESULT_COLUMNS, |case| {
        states.lock().unwrap().push(std::fs::read(part).unwrap());
        compute(case)
    });
    assert_eq!(table.unwrap(), whole_table());
    let mut states = states.into_inner().unwrap();
    states.sort_by_key(Vec::len);
    states.dedup();
    for (count, pair) in states.windows(2).enumerate() {
        let row = &pair[1][pair[0].len()..];
        for end in (0..=row.len()).step_by(7).chain([row.len()]) {
            let _ = std::fs::remove_file(path);
            std::fs::write(part, [&pair[0], &row[..end]].concat()).unwrap();
            assert_eq!(kept_sweep.table().unwrap(), whole_table(), "{count}, {end}");
            assert!(!part.exists() && std::fs::read_to_string(path).unwrap() == *text);
            assert!(kept_sweep.runs() == 24 - count || cfg!(feature = "rayon"), "{count}, {end}");
        }
    }
    // The process was killed before the heading was written.
    for end in 0..=states[0].len() {
        let _ = std::fs::remove_file(path);
        std::fs::write(part, &states[0][..end]).unwrap();
        assert_eq!((kept_sweep.table().unwrap(), kept_sweep.runs()), (whole_table(), 24), "{end}");
    }
    // The process was killed between writing the table and removing the other file.
    std::fs::write(part, &text).unwrap();
    assert_eq!(kept_sweep.table().unwrap(), whole_table());
    assert_eq!((kept_sweep.runs(), part.exists()), (0, false));
}

/// A deleted row is run again; progress is reported for this row only.
#[test]
fn a_deleted_row_is_run_again() {
    let kept_sweep = KeptSweep::new(&folder("deleted_row"));
    let path = &kept_sweep.path;
    let text = kept_sweep.table().unwrap().csv();
    let row_start = text.find("\n3,").unwrap() + 1;
    let end = text.find("\n4,").unwrap() + 1;
    let failed_row = &text[row_start..end];
    assert!(
        failed_row.starts_with(
            "3,0.1,\"the \"\"pulse\"\"\",1e300,,,\"no, \"\"not\"\" this,\r\none; µ\"\n"
        )
    );
    std::fs::write(path, text.replace(failed_row, "")).unwrap();
    let damaged_table = FileFault::Damaged { quantity: "the table".into() };
    assert_eq!(
        table_error(kept_sweep.table()),
        file_error(&path.display().to_string(), damaged_table)
    );
    let rows = text.replace(failed_row, "").split_once('\n').unwrap().1.to_owned();
    std::fs::write(path, format!("# basemat sweep 1 check sum\n{rows}")).unwrap();
    let reports = AtomicUsize::new(0);
    let table_run_again = sweep().on_progress(|_, _| {
        reports.fetch_add(1, Ordering::Relaxed);
    });
    let table_run_again = table_run_again.table_in(path, RESULT_COLUMNS, |case| {
        assert_eq!(case.index, 3);
        compute(case)
    });
    assert_eq!((table_run_again.unwrap(), reports.load(Ordering::Relaxed)), (whole_table(), 1));
}

/// Files of another sweep are neither used nor overwritten; a file that cannot be written is an error before a case runs.
#[test]
fn files_that_a_sweep_cannot_use_are_errors() {
    let folder = folder("unusable");
    let kept_sweep = KeptSweep::new(&folder);
    let path = &kept_sweep.path;
    let text = kept_sweep.table().unwrap().csv();
    let error_of_another_shard =
        sweep().shard(0, 2).unwrap().table_in(path, RESULT_COLUMNS, compute);
    let Error::File(error) = table_error(error_of_another_shard) else {
        panic!("of another sweep")
    };
    assert!(is_value(&error.fault, "case"), "{error}");
    let error_of_another_shard = sweep().table_in(path, ["a", "b"], compute);
    let Error::File(error) = table_error(error_of_another_shard) else {
        panic!("of another sweep")
    };
    assert!(is_value(&error.fault, "heading of column 5"), "{error}");
    assert_eq!(std::fs::read_to_string(path).unwrap(), *text);
    std::fs::remove_file(path).unwrap();
    std::fs::write(&kept_sweep.part, text.replace("\n2,0.1", "\n1,0.1")).unwrap();
    assert!(table_error(kept_sweep.table()).to_string().contains("line 5"));
    let file = folder.join("a_file");
    std::fs::write(&file, "").unwrap();
    let impossible_path =
        sweep().table_in(file.join("cases.csv"), RESULT_COLUMNS, |_| -> Result<[f64; 2]> {
            unreachable!("the file cannot be written")
        });
    assert!(is_unwritable(&impossible_path), "{impossible_path:?}");
    assert!(is_unwritable(&whole_table().csv().save(file.join("cases.csv"))));
}

/// Two parameters, one of which has this name and these texts.
fn sweep_of_texts(name: &str, texts: &[String]) -> Sweep<'static> {
    let parameters = [Parameter::texts(name, texts), Parameter::numbers("x", [1.0, 2.0])];
    Sweep::grid(parameters).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Any texts and any bits are read back, and another reader reads the same cells.
    #[test]
    fn files_keep_every_bit(
        texts in proptest::collection::btree_set("[a-z,\"\n\r µ']{1,8}", 1..4),
        name in "[a-z,\"\n\r µ]{2,8}",
        numbers in proptest::collection::vec(any::<u64>(), 3),
        reason in "[ -~\n\r\"µ]{0,30}",
    ) {
        prop_assume!(!["case", "error", "y"].contains(&name.as_str()));
        let texts: Vec<_> = texts.into_iter().collect();
        let sweep = sweep_of_texts(&name, &texts);
        let table = sweep.table(["y", "z", "w"], |case| match case.index {
            1 => Err(reason.clone()),
            _ => Ok([0, 1, 2].map(|k| f64::from_bits(numbers[k]))),
        }).unwrap();
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("case_tables_of_any_bits.csv");
        table.csv().save(&path).unwrap();
        prop_assert_eq!(&sweep_of_texts(&name, &texts).merge([&path]).unwrap(), &table);

        let mut reader = basemat_problems::csv::ReaderBuilder::new();
        let mut reader = reader.comment(Some(b'#')).from_reader(table.csv().as_bytes().to_vec().leak() as &[u8]);
        let heading: Vec<_> = reader.headers().unwrap().iter().map(str::to_owned).collect();
        prop_assert_eq!(&heading, &["case", &*name, "x", "y", "z", "w", "error"]);
        for (record, row) in reader.records().zip(table.rows()) {
            let record = record.unwrap();
            prop_assert_eq!(&record[1], row.text(&name).unwrap());
            match row.results {
                Err(text) => prop_assert_eq!(&record[6], text),
                Ok(results) => for (cell, expected) in record.iter().skip(3).zip(results) {
                    let computed = if cell.is_empty() { f64::NAN } else { cell.parse::<f64>().unwrap() };
                    prop_assert_eq!(computed.to_bits(), expected.to_bits());
                },
            }
        }
    }
}
