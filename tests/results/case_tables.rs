//! GOAL: tables of sweeps: shards and their merger, files, resuming, failed cases, the printed form.
//! SCENE: cases by formula, with errors, panics, NaN and infinities; blocks on springs.
//! REFERENCE: the whole table, to the last bit; the `csv` crate; the cells that were written.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::prelude::*;
use basemat::sweep::CaseTable;
use basemat::sweep::SweepError;
use basemat::{Error, FileError, FileFault, MemoryError, Result};
use basemat_problems::faults::{count, is_unwritable, is_value, value};
use proptest::prelude::*;

/// A folder of its own, empty.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("case_tables").join(name);
    let _ = std::fs::remove_dir_all(&path);
    path
}

/// 0.1 + 0.2: sixteen digits and one more.
const THIRD: f64 = 0.300_000_000_000_000_04;
const RECORDS: [&str; 3] = ["El Centro, 1940", "the \"pulse\"", "two\nlines"];
const COLUMNS: [&str; 2] = ["ratio, -", "residual_slip_m"];

/// 4 × 3 × 2 cases.
fn sweep() -> Sweep<'static> {
    Sweep::grid([
        Parameter::numbers("friction", [0.1, 0.2, THIRD, -0.0]),
        Parameter::texts("record", RECORDS),
        Parameter::numbers("width_m", [4.0, 1e300]),
    ])
    .unwrap()
}

/// Results that a formula gives, and every kind of trouble.
fn compute(case: &basemat::sweep::SweepCase<'_>) -> std::result::Result<[f64; 2], String> {
    let (friction, width) = (case.value("friction").unwrap(), case.value("width_m").unwrap());
    match case.index {
        3 => Err("no, \"not\" this,\r\none; µ".to_owned()),
        8 => panic!("eight, and\nmore"),
        11 => Err(String::new()),
        5 => Ok([f64::NAN, f64::NEG_INFINITY]),
        6 => Ok([f64::INFINITY, -f64::NAN]),
        index => Ok([friction / width, (index as f64).sqrt() * friction.exp()]),
    }
}

fn whole() -> CaseTable {
    sweep().table(COLUMNS, compute).unwrap()
}

/// Files of all shards.
fn shards(folder: &Path, of: usize) -> Vec<PathBuf> {
    let path = |index: usize| folder.join(format!("shard_{index}_of_{of}.csv"));
    (0..of)
        .map(|index| {
            let shard = sweep().shard(index, of).unwrap();
            shard.table(COLUMNS, compute).unwrap().csv().save(path(index)).unwrap();
            path(index)
        })
        .collect()
}

fn refused(result: Result<CaseTable>) -> Error {
    match result {
        Err(error @ (Error::Sweep(_) | Error::File(_))) => error,
        other => panic!("{other:?}"),
    }
}

/// Fault of a whole file.
fn file_error(file: &str, fault: FileFault) -> Error {
    Error::File(FileError { file: file.to_owned(), line: 0, fault })
}

/// Requirement of a case's number.
const OF_SWEEP: &str = "one of this sweep, in digits";

/// The fault of a file with this text, and its line.
fn fault(name: &str, text: &str) -> (usize, FileFault) {
    let path = folder(name).join("cases.csv");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, text).unwrap();
    match refused(sweep().merge([&path])) {
        Error::File(FileError { file, line, fault }) => {
            assert_eq!(file, path.display().to_string());
            (line, fault)
        }
        other => panic!("{other}"),
    }
}

#[test]
fn cases_are_numbered_by_their_place() {
    let table = whole();
    let mut index = 0;
    for (f, friction) in [0.1, 0.2, THIRD, -0.0].into_iter().enumerate() {
        for (r, record) in RECORDS.into_iter().enumerate() {
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
    assert_eq!(table.columns(), COLUMNS);
    let row = table.rows().nth(3).unwrap();
    assert!(matches!(
        row.value("residual_slip_m"),
        Err(Error::Part { part, .. }) if part == "case 3 failed"
    ));
    for wrong in [
        row.value("record").err(),
        row.value("slip").err(),
        row.text("width_m").err(),
        row.place("ratio, -").err(),
    ] {
        assert!(matches!(wrong, Some(Error::Name { .. })), "{wrong:?}");
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
    let (whole, folder) = (whole(), folder("merged"));
    assert_eq!(whole, whole.clone());
    for of in [1, 2, 3, 5, 7, 24, 30] {
        let mut paths = shards(&folder, of);
        paths.reverse();
        let merged = sweep().merge(&paths).unwrap();
        assert_eq!(merged, whole, "{of} shards");
        assert_eq!(merged.csv(), whole.csv());
    }
    // Shards of a shard, merged to that shard.
    let half = || sweep().shard(1, 2).unwrap();
    assert!(half().shard(2, 3).unwrap().cases().eq((0..24).filter(|case| case % 6 == 5)));
    let paths = [0, 1, 2].map(|index| {
        let path = folder.join(format!("half_{index}.csv"));
        half().shard(index, 3).unwrap().table(COLUMNS, compute).unwrap().csv().save(&path).unwrap();
        path
    });
    assert_eq!(half().merge(&paths).unwrap(), half().table(COLUMNS, compute).unwrap());
    // One bit less is another table.
    let other = sweep().table(COLUMNS, |case| {
        let [ratio, slip] = compute(case)?;
        Ok::<_, String>([ratio, if case.index == 2 { slip.next_up() } else { slip }])
    });
    assert_ne!(other.unwrap(), whole);
}

#[test]
fn shards_have_bounds() {
    for (index, of) in [(0, 0), (2, 2), (7, 3)] {
        let fault = sweep().shard(index, of).unwrap_err();
        assert_eq!(fault, Error::Index { quantity: "shard", index, bound: of });
    }
    let last = sweep().shard(usize::MAX - 1, usize::MAX).unwrap();
    assert_eq!(last.cases().len(), 0);
    assert_eq!(last.shard(usize::MAX - 1, usize::MAX).unwrap().cases().len(), 0);
    let first = sweep().shard(0, usize::MAX).unwrap().shard(0, 2).unwrap();
    assert!(first.cases().eq([0]));
}

#[test]
fn wrong_sets_of_shards_are_refused() {
    let folder = folder("sets");
    let paths = shards(&folder, 4);
    let missing = |paths: &[&PathBuf]| match refused(sweep().merge(paths)) {
        Error::Sweep(SweepError::Missing { cases, shards }) => (cases, shards),
        other => panic!("{other}"),
    };
    let class = |k: usize| (0..24).filter(|case| case % 4 == k).collect::<Vec<_>>();
    assert_eq!(missing(&[&paths[0], &paths[1], &paths[3]]), (class(2), vec![[2, 4]]));
    let (cases, lost) = missing(&[&paths[1], &paths[3]]);
    assert_eq!((cases.len(), lost), (12, vec![[0, 4], [2, 4]]));
    assert_eq!(missing(&[]), ((0..24).collect(), vec![]));
    let text = sweep().merge([&paths[0], &paths[1], &paths[3]]).unwrap_err().to_string();
    assert_eq!(text, "6 of the sweep's cases missing: 2, 6, 10, 14, 18, 22; shard 2/4");

    let name = paths[0].display().to_string();
    let found = format!("here and in {name}");
    assert_eq!(
        refused(sweep().merge([&paths[0], &paths[1], &paths[0]])),
        file_error(&name, value("case 0", &found, "in one place"))
    );
    let nowhere = folder.join("not_there.csv");
    assert_eq!(
        refused(sweep().merge([&nowhere])),
        file_error(
            &nowhere.display().to_string(),
            FileFault::Unreadable(std::io::ErrorKind::NotFound)
        )
    );

    // Of another study: values, parameters, results.
    let other = folder.join("other.csv");
    let reason = |sweep: Sweep<'_>, columns: [&str; 2]| {
        let shard = sweep.shard(3, 4).unwrap();
        shard.table(columns, |_| Ok::<_, Error>([0.0; 2])).unwrap().csv().save(&other).unwrap();
        let shards = [&paths[0], &paths[1], &paths[2], &other];
        match self::sweep().merge(shards) {
            Err(Error::File(FileError { fault, file, .. })) => {
                assert_eq!(file, other.display().to_string());
                fault
            }
            other => panic!("{other:?}"),
        }
    };
    let grid = |friction: f64, width: &str| {
        Sweep::grid([
            Parameter::numbers("friction", [0.1, 0.2, friction, -0.0]),
            Parameter::texts("record", RECORDS),
            Parameter::numbers(width, [4.0, 1e300]),
        ])
        .unwrap()
    };
    assert_eq!(
        reason(grid(0.3, "width_m"), COLUMNS),
        value("friction of case 15", "'0.3'", "'0.30000000000000004'")
    );
    let exact = grid(THIRD, "width_m");
    assert_eq!(
        reason(exact, ["ratio, -", "slip"]),
        value("heading of column 6", "'slip'", "'residual_slip_m'")
    );
    assert_eq!(
        reason(grid(THIRD, "width"), COLUMNS),
        value("heading of column 4", "'width'", "'width_m'")
    );
}

#[test]
fn spoilt_files_are_refused() {
    let text = whole().csv();
    // Cut anywhere: the check sum is that of all rows.
    let path = folder("cut").join("cases.csv");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    for end in (0..text.len() - 1).filter(|&end| text.is_char_boundary(end)) {
        std::fs::write(&path, &text[..end]).unwrap();
        assert!(matches!(refused(sweep().merge([&path])), Error::File(_)), "{end}");
    }
    std::fs::write(&path, &text.as_bytes()[..=text.find('µ').unwrap()]).unwrap();
    assert!(matches!(
        refused(sweep().merge([&path])),
        Error::File(FileError { fault: FileFault::Format { needed, .. }, .. }) if needed == "UTF-8"
    ));
    // A byte-order mark is passed over, and so are line ends of Windows.
    std::fs::write(&path, format!("\u{feff}{text}")).unwrap();
    assert_eq!(sweep().merge([&path]).unwrap(), whole());
    let simple = || Sweep::grid([Parameter::numbers("x", [0.5, 0.25])]).unwrap();
    let doubled = simple().table(["y"], |case| Result::Ok([2.0 * case.value("x")?])).unwrap();
    std::fs::write(&path, doubled.csv().replace('\n', "\r\n")).unwrap();
    assert_eq!(simple().merge([&path]).unwrap(), doubled);

    let spoilt = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        fault("spoilt", &text.replacen(from, to, 1))
    };
    let (line, reason) = spoilt("\n1,0.1,", "\n24,0.1,");
    assert_eq!((line, reason), (4, value("case", "'24'", OF_SWEEP)));
    assert_eq!(spoilt("\n1,0.1,", "\n+1,0.1,").1, value("case", "'+1'", OF_SWEEP));
    assert_eq!(spoilt("\n1,0.1,", "\n1,0.11,").1, value("friction of case 1", "'0.11'", "'0.1'"));
    assert_eq!(spoilt("\n1,0.1,", "\n1,0.1,0,").1, count("cells", 8, "7"));
    assert_eq!(spoilt(",-inf,", ",inf,").1, FileFault::Damaged { quantity: "the table".into() });
    let (_, fault_of_number) = spoilt(",-inf,", ",minus,");
    assert_eq!(fault_of_number.to_string(), "residual_slip_m is 'minus', but must be a number");
    let both = value("case 11", "a row with an error and results", "a row with either");
    assert_eq!(spoilt(",failed", "0,failed").1, both);
    let heading = spoilt("friction", "fric\"tion").1;
    assert_eq!(heading, value("heading of column 2", "'fric\"tion'", "'friction'"));
    assert_eq!(spoilt("case,", "").1, value("heading of column 1", "'friction'", "'case'"));
    let short = "# basemat sweep 1 check sum\ncase\n";
    assert_eq!(fault("short", short).1, value("heading of column 2", "''", "'friction'"));
    let wrong = spoilt("check sum ", "check sum x").1;
    assert!(is_value(&wrong, "check sum"), "{wrong}");
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

#[test]
fn a_killed_sweep_goes_on() {
    let folder = folder("resumed");
    let (path, part) = (folder.join("cases.csv"), folder.join("cases.csv.part"));
    let runs = AtomicUsize::new(0);
    let kept = || {
        runs.store(0, Ordering::Relaxed);
        let counted = |case: &basemat::sweep::SweepCase<'_>| {
            runs.fetch_add(1, Ordering::Relaxed);
            compute(case)
        };
        sweep().table_in(&path, COLUMNS, counted)
    };
    let ran = || runs.load(Ordering::Relaxed);
    // As a whole, and again.
    assert_eq!(kept().unwrap(), whole());
    assert_eq!((ran(), part.exists()), (24, false));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), *whole().csv());
    assert_eq!(kept().unwrap(), whole());
    assert_eq!(ran(), 0);

    // Killed at any byte of a row, or between a row and its check sum: the rows before are kept.
    let text = whole().csv();
    let begin = |case: usize| text.find(&format!("\n{case},")).unwrap() + 1;
    std::fs::remove_file(&path).unwrap();
    let states = Mutex::new(Vec::new());
    let table = sweep().table_in(&path, COLUMNS, |case| {
        states.lock().unwrap().push(std::fs::read(&part).unwrap());
        compute(case)
    });
    assert_eq!(table.unwrap(), whole());
    let mut states = states.into_inner().unwrap();
    states.sort_by_key(Vec::len);
    states.dedup();
    for (count, pair) in states.windows(2).enumerate() {
        let row = &pair[1][pair[0].len()..];
        for end in (0..=row.len()).step_by(7).chain([row.len()]) {
            let _ = std::fs::remove_file(&path);
            std::fs::write(&part, [&pair[0], &row[..end]].concat()).unwrap();
            assert_eq!(kept().unwrap(), whole(), "{count}, {end}");
            assert!(!part.exists() && std::fs::read_to_string(&path).unwrap() == *text);
            assert!(ran() == 24 - count || cfg!(feature = "rayon"), "{count}, {end}");
        }
    }
    // Killed before the heading was written.
    for end in 0..=states[0].len() {
        let _ = std::fs::remove_file(&path);
        std::fs::write(&part, &states[0][..end]).unwrap();
        assert_eq!((kept().unwrap(), ran()), (whole(), 24), "{end}");
    }
    // A row that is deleted is run again; progress tells of it alone.
    let failed = &text[begin(3)..begin(4)];
    assert!(
        failed.starts_with(
            "3,0.1,\"the \"\"pulse\"\"\",1e300,,,\"no, \"\"not\"\" this,\r\none; µ\"\n"
        )
    );
    std::fs::write(&path, text.replace(failed, "")).unwrap();
    let damaged = FileFault::Damaged { quantity: "the table".into() };
    assert_eq!(refused(kept()), file_error(&path.display().to_string(), damaged));
    let rows = text.replace(failed, "").split_once('\n').unwrap().1.to_owned();
    std::fs::write(&path, format!("# basemat sweep 1 check sum\n{rows}")).unwrap();
    let told = AtomicUsize::new(0);
    let again = sweep().on_progress(|_, _| {
        told.fetch_add(1, Ordering::Relaxed);
    });
    let again = again.table_in(&path, COLUMNS, |case| {
        assert_eq!(case.index, 3);
        compute(case)
    });
    assert_eq!((again.unwrap(), told.load(Ordering::Relaxed)), (whole(), 1));
    // The process was killed between writing the table and removing the other file.
    std::fs::write(&part, &text).unwrap();
    assert_eq!(kept().unwrap(), whole());
    assert_eq!((ran(), part.exists()), (0, false));
    // Files of another sweep are not taken, nor overwritten.
    let other = sweep().shard(0, 2).unwrap().table_in(&path, COLUMNS, compute);
    let Error::File(error) = refused(other) else { panic!("of another sweep") };
    assert!(is_value(&error.fault, "case"), "{error}");
    let other = sweep().table_in(&path, ["a", "b"], compute);
    let Error::File(error) = refused(other) else { panic!("of another sweep") };
    assert!(is_value(&error.fault, "heading of column 5"), "{error}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), *text);
    std::fs::remove_file(&path).unwrap();
    std::fs::write(&part, text.replace("\n2,0.1", "\n1,0.1")).unwrap();
    assert!(refused(kept()).to_string().contains("line 5"));
    // Nowhere to write: known before anything runs.
    let file = folder.join("a_file");
    std::fs::write(&file, "").unwrap();
    let nowhere = sweep().table_in(file.join("cases.csv"), COLUMNS, |_| -> Result<[f64; 2]> {
        unreachable!("the file cannot be written")
    });
    assert!(is_unwritable(&nowhere), "{nowhere:?}");
    assert!(is_unwritable(&whole().csv().save(file.join("cases.csv"))));
}

#[test]
fn parameters_and_columns_are_checked() {
    let of = |parameter: &str, source| {
        let item = format!("parameter '{parameter}'");
        Error::Item { item, source: Box::new(source) }
    };
    let repeated = |value: &str| Error::DuplicateName { quantity: "value", name: value.to_owned() };
    let unnamed = || Error::Scene { quantity: "column", needed: "it must have a name" };
    let grid = |parameters: Vec<Parameter>| Sweep::grid(parameters).unwrap_err();
    let numbers = |values: &[f64]| Parameter::numbers("x", values.iter().copied());
    let quantity = "list of values";
    assert_eq!(grid(vec![numbers(&[])]), of("x", Error::Size { quantity, found: 0, needed: 1 }));
    assert_eq!(
        grid(vec![numbers(&[1.0, f64::NAN])]).to_string(),
        "parameter 'x': list of values is not finite: entry 1 is NaN"
    );
    for (twice, value) in [([2.0, 2.0], "2"), ([0.0, -0.0], "-0")] {
        assert_eq!(grid(vec![numbers(&twice)]), of("x", repeated(value)));
    }
    assert_eq!(grid(vec![Parameter::texts("r", ["a", "a"])]), of("r", repeated("a")));
    let empty = Error::Scene { quantity: "value", needed: "it must not be an empty text" };
    assert_eq!(grid(vec![Parameter::texts("r", [""])]), of("r", empty));
    assert_eq!(grid(vec![Parameter::numbers("", [1.0])]), unnamed());
    for name in ["case", "error", "x"] {
        let fault = grid(vec![numbers(&[1.0]), Parameter::numbers(name, [1.0])]);
        assert_eq!(fault, Error::DuplicateName { quantity: "column", name: name.to_owned() });
    }
    let many = (0..16).map(|k| Parameter::numbers(format!("x{k}"), (0..16).map(f64::from)));
    let too_large =
        |error| matches!(error, Error::Memory(MemoryError { asked, .. }) if asked > 1e8);
    assert!(too_large(grid(many.collect())));
    // Countable, but not in memory.
    let large = ["a", "b"].map(|name| Parameter::numbers(name, (0..15_000).map(f64::from)));
    assert!(too_large(grid(large.to_vec())));
    let table =
        |columns| sweep().table(columns, |_| -> Result<[f64; 2]> { unreachable!("columns") });
    for columns in [["friction", "y"], ["y", "y"], ["y", "error"]] {
        assert!(matches!(table(columns), Err(Error::DuplicateName { .. })), "{columns:?}");
    }
    assert_eq!(table(["y", ""]).unwrap_err(), unnamed());

    // Without parameters, cases or results.
    assert_eq!(Sweep::grid([]).unwrap().cases().len(), 1);
    let table = Sweep::new(2).table([], |_| Ok::<_, Error>([])).unwrap();
    let lines: Vec<_> = table.csv().lines().map(str::to_owned).collect();
    assert!(
        lines[0].starts_with("# basemat sweep 1 check sum ")
            && lines[1..] == ["case,error", "0,", "1,"]
    );
    let none = Sweep::new(0);
    assert_eq!(none.merge([""; 0]).unwrap().csv().lines().nth(1), Some("case,error"));
    assert_eq!(
        none.table(["y"], |_| Ok::<_, Error>([0.0])).unwrap().to_string(),
        "case  y\n-------"
    );
}

/// Characters of the longest line.
fn longest(text: &str) -> usize {
    text.lines().map(|line| line.chars().count()).max().unwrap_or(0)
}

#[test]
fn lines_stay_below_a_hundred_characters() {
    let text = whole().to_string();
    assert!(text.contains("\ncase 3 failed: no, \"not\" this, one; µ\n"), "{text}");
    assert!(text.lines().any(|line| line.starts_with("3 ") && line.ends_with("failed")), "{text}");

    let names: Vec<String> = (0..12).map(|k| format!("peak_contact_shear_{k}_n_per_m")).collect();
    let columns: [&str; 12] = std::array::from_fn(|k| names[k].as_str());
    let long = "a-record-with-a-name-that-goes-on-".repeat(6);
    let grid =
        [Parameter::texts("record", [long.as_str(), "short"]), Parameter::numbers("x", [1.5])];
    let table = Sweep::grid(grid).unwrap().table(columns, |case| match case.index {
        0 => Ok([1.25e7; 12]),
        _ => Err(format!("{} {long}", "words ".repeat(50))),
    });
    let text = table.unwrap().to_string();
    assert!((90..100).contains(&longest(&text)), "{text}");
    // Every block has the case's number and a part of the columns.
    assert!(text.matches("\ncase ").count() + 1 >= 6, "{text}");
    for name in &names {
        assert_eq!(text.matches(name.as_str()).count(), 1, "{text}");
    }

    // Runs side by side: twelve cases.
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Any texts and any bits come back, and another reader sees the same cells.
    #[test]
    fn files_keep_every_bit(
        texts in proptest::collection::btree_set("[a-z,\"\n\r µ']{1,8}", 1..4),
        name in "[a-z,\"\n\r µ]{2,8}",
        numbers in proptest::collection::vec(any::<u64>(), 3),
        reason in "[ -~\n\r\"µ]{0,30}",
    ) {
        prop_assume!(!["case", "error", "y"].contains(&name.as_str()));
        let texts: Vec<_> = texts.into_iter().collect();
        let sweep = || {
            let parameters = [Parameter::texts(&*name, &texts), Parameter::numbers("x", [1.0, 2.0])];
            Sweep::grid(parameters).unwrap()
        };
        let table = sweep().table(["y", "z", "w"], |case| match case.index {
            1 => Err(reason.clone()),
            _ => Ok([0, 1, 2].map(|k| f64::from_bits(numbers[k]))),
        }).unwrap();
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("case_tables_of_any_bits.csv");
        table.csv().save(&path).unwrap();
        prop_assert_eq!(&sweep().merge([&path]).unwrap(), &table);

        let mut reader = basemat_problems::csv::ReaderBuilder::new();
        let mut reader = reader.comment(Some(b'#')).from_reader(table.csv().as_bytes().to_vec().leak() as &[u8]);
        let heading: Vec<_> = reader.headers().unwrap().iter().map(str::to_owned).collect();
        prop_assert_eq!(&heading, &["case", &*name, "x", "y", "z", "w", "error"]);
        for (record, row) in reader.records().zip(table.rows()) {
            let record = record.unwrap();
            prop_assert_eq!(&record[1], row.text(&name).unwrap());
            match row.results {
                Err(text) => prop_assert_eq!(&record[6], text),
                Ok(results) => for (cell, wanted) in record.iter().skip(3).zip(results) {
                    let found = if cell.is_empty() { f64::NAN } else { cell.parse::<f64>().unwrap() };
                    prop_assert_eq!(found.to_bits(), wanted.to_bits());
                },
            }
        }
    }
}
