//! GOAL: an error printed alone is complete; printed with its sources it repeats nothing.
//! SCENE: a sample of every error that contains another one; files that do not exist.
//! REFERENCE: the text of the inner error.

use std::error::Error as StandardError;

use basemat::bem::SpringGround;
use basemat::coupled::{CheckpointError, StabilityError, StepError};
use basemat::interface::VariableFriction;
use basemat::io::GmshMesh;
use basemat::motion::{AccelerationUnit, ColumnFormat, Record, el_centro_1940};
use basemat::structure::{RigidBlock, Triplets};
use basemat::sweep::CaseError;
use basemat::{Error, FileError, FileFault, MemoryError, Simulation};

/// Checks that `error` prints `inner_text` once, both alone and with its sources.
#[track_caller]
fn assert_printed_once(error: &dyn StandardError, inner_text: &str) {
    let error_text = error.to_string();
    assert!(error_text.contains(inner_text), "'{inner_text}' is not in '{error_text}'");
    let mut texts = vec![error_text];
    let mut next_source = error.source();
    while let Some(source) = next_source {
        texts.push(source.to_string());
        next_source = source.source();
    }
    let chain = texts.join(": ");
    assert_eq!(chain.matches(inner_text).count(), 1, "{chain}");
}

fn inner_error() -> Error {
    Error::part("my part", "has torn")
}

fn load_error() -> StepError {
    StepError::Part { quantity: "load", source: Box::new(inner_error()) }
}

fn history_error() -> StepError {
    StepError::Part { quantity: "history of the ground", source: Box::new(inner_error()) }
}

fn error_in_step(source: StepError) -> Error {
    Error::Step { step: 3, time: 0.03, source }
}

fn error_in_file(line: usize, fault: FileFault) -> Error {
    Error::File(FileError { file: "file".to_owned(), line, fault })
}

fn error_of_probe(source: Error) -> Error {
    Error::Item { item: "probe 'roof'".to_owned(), source: Box::new(source) }
}

#[test]
fn errors_print_what_is_inside_them_once() {
    let text = "my part: has torn";
    let unusable = FileFault::Unusable(Box::new(inner_error()));
    for error in [
        error_of_probe(inner_error()),
        error_in_step(history_error()),
        error_in_step(load_error()),
        error_in_file(0, unusable.clone()),
        error_of_probe(error_in_step(load_error())),
    ] {
        assert_printed_once(&error, text);
        assert_printed_once(&CaseError::Failed(error), text);
    }
    assert_printed_once(&load_error(), text);
    assert_printed_once(&history_error(), text);
    assert_printed_once(&unusable, text);
    let checkpoint = CheckpointError::Unsupported { part: "roof" };
    assert_printed_once(&Error::from(checkpoint.clone()), &checkpoint.to_string());
    let uplift =
        StabilityError::Uplift { ends: [0.0, 1.0], across: None, upward: 1.0, buoyancy: 0.0 };
    assert_printed_once(&Error::Stability(Box::new(uplift.clone())), &uplift.to_string());
    let quantity = "rows";
    let remedy = "less";
    for fault in [
        FileFault::Missing { quantity: "header".to_owned() },
        FileFault::Unreadable(std::io::ErrorKind::NotFound),
        FileFault::Memory(MemoryError { quantity, asked: 1.0, needed: 2.0, limit: 1.0, remedy }),
    ] {
        assert_printed_once(&error_in_file(0, fault.clone()), &fault.to_string());
        assert_printed_once(&error_in_file(1, fault.clone()), &fault.to_string());
    }
}

/// Errors of laws are errors of steps, and of the crate.
#[test]
fn errors_of_laws_are_printed_once() {
    let mut simulation = Simulation::builder(0.01)
        .structure(RigidBlock::new(4.0, 6.0, 2000.0).unwrap())
        .ground(SpringGround::new(-2.0..2.0, 4, 2e7, 1e7).unwrap())
        .interface(VariableFriction::new(
            |start| if start.slip_rate == 0.0 { 0.1 } else { f64::NAN },
        ))
        .motion(el_centro_1940())
        .build()
        .unwrap();
    let Err(error) = simulation.run(100, |_| {}) else { panic!("no step failed") };
    let Error::Step { source: StepError::Law(law), .. } = &error else {
        panic!("{error:?}")
    };
    let text = law.to_string();
    for error in
        [&error as &dyn StandardError, &StepError::Law(law.clone()), &Error::Law(law.clone())]
    {
        assert_printed_once(error, &text);
    }
}

/// An error of a whole file has no line.
#[test]
fn errors_of_missing_files_have_no_line() {
    let name = "there/is/no.file";
    let format = ColumnFormat::new(AccelerationUnit::Gal);
    for error in [
        Record::read(name, &format).unwrap_err(),
        GmshMesh::read(name).unwrap_err(),
        Triplets::read_matrix_market(name).unwrap_err(),
        Triplets::new(1).write_matrix_market(name).unwrap_err(),
    ] {
        let text = error.to_string();
        assert!(text.starts_with("there/is/no.file cannot be "), "{text}");
        assert!(!text.contains("line"), "{text}");
    }
    let error = Triplets::from_matrix_market("m", &b"%%MatrixMarket matrix x"[..]).unwrap_err();
    assert!(error.to_string().starts_with("m, line 1: "), "{error}");
}
