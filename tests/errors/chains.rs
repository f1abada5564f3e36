//! GOAL: an error printed alone is complete, and printed with its sources it says nothing twice.
//! SCENE: a sample of every error that holds another one; files that are not there.
//! REFERENCE: the text of the error inside.

use std::error::Error as StandardError;

use basemat::bem::SpringGround;
use basemat::coupled::{CheckpointError, StabilityError, StepError};
use basemat::interface::VariableFriction;
use basemat::io::GmshMesh;
use basemat::motion::{AccelerationUnit, ColumnFormat, Record, el_centro_1940};
use basemat::structure::{RigidBlock, Triplets};
use basemat::sweep::CaseError;
use basemat::{Error, FileError, FileFault, MemoryError, Simulation};

/// `error` prints `inside` once, alone and with its sources.
#[track_caller]
fn says_once(error: &dyn StandardError, inside: &str) {
    let alone = error.to_string();
    assert!(alone.contains(inside), "'{inside}' is not in '{alone}'");
    let mut texts = vec![alone];
    let mut next = error.source();
    while let Some(source) = next {
        texts.push(source.to_string());
        next = source.source();
    }
    let chain = texts.join(": ");
    assert_eq!(chain.matches(inside).count(), 1, "{chain}");
}

fn part() -> Error {
    Error::part("my part", "has torn")
}

#[test]
fn errors_print_what_is_inside_them_once() {
    let torn = "my part: has torn";
    let step = |source| Error::Step { step: 3, time: 0.03, source };
    let in_structure = || StepError::Part { quantity: "load", source: Box::new(part()) };
    let record = FileFault::Unusable(Box::new(part()));
    let in_file = |line, fault| Error::File(FileError { file: "file".to_owned(), line, fault });
    for error in [
        Error::Item { item: "probe 'roof'".to_owned(), source: Box::new(part()) },
        step(StepError::Part { quantity: "history of the ground", source: Box::new(part()) }),
        step(in_structure()),
        // A probe inside a step inside a record.
        in_file(0, record.clone()),
        Error::Item { item: "probe 'roof'".to_owned(), source: Box::new(step(in_structure())) },
    ] {
        says_once(&error, torn);
        says_once(&CaseError::Failed(error), torn);
    }
    says_once(&in_structure(), torn);
    says_once(
        &StepError::Part { quantity: "history of the ground", source: Box::new(part()) },
        torn,
    );
    says_once(&record, torn);
    let checkpoint = CheckpointError::Unsupported { part: "roof" };
    says_once(&Error::from(checkpoint.clone()), &checkpoint.to_string());
    let standing = StabilityError::Uplift { ends: [0.0, 1.0], across: None, upward: 1.0 };
    says_once(&Error::Stability(Box::new(standing.clone())), &standing.to_string());
    let (quantity, remedy) = ("rows", "less");
    for fault in [
        FileFault::Missing { quantity: "header".to_owned() },
        FileFault::Unreadable(std::io::ErrorKind::NotFound),
        FileFault::Memory(MemoryError { quantity, asked: 1.0, needed: 2.0, limit: 1.0, remedy }),
    ] {
        says_once(&in_file(0, fault.clone()), &fault.to_string());
        says_once(&in_file(1, fault.clone()), &fault.to_string());
    }
}

/// Numbers of a law are errors of steps, and of the crate.
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
    let Error::Step { source: StepError::Law(law), .. } = &error else { panic!("{error:?}") };
    let text = law.to_string();
    for error in
        [&error as &dyn StandardError, &StepError::Law(law.clone()), &Error::Law(law.clone())]
    {
        says_once(error, &text);
    }
}

/// A file as a whole has no line.
#[test]
fn files_that_are_not_there_have_no_line() {
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
