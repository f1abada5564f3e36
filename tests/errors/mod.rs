//! GOAL: soil, ground, interface, motion, builder and step return typed errors for bad input that name quantity, value
//! and need.
//! SCENE: one defect at a time.
//! REFERENCE: the fields of the error. Elements, record files and closed forms are tested in other files.

mod blame;
mod builder;
mod chains;
mod defective_structure;
mod law_limits;
mod law_numbers;
mod laws_and_motions;
mod layered;
mod named_parts;
mod reasons;
mod sizes;
mod soils_and_grounds;
mod steps;
mod structures;
mod words;

use basemat::{Error, Soil};

const NOT_POSITIVE_FINITE: [f64; 5] = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const NEGATIVE_OR_NOT_FINITE: [f64; 3] = [-1.0, f64::NAN, f64::INFINITY];

/// Checks that every value is an input error with the value in its fields and its message.
#[track_caller]
fn assert_errors<T>(name: &str, values: &[f64], build: impl Fn(f64) -> basemat::Result<T>) {
    for &value in values {
        let Err(error) = build(value) else { panic!("{name} of {value} was accepted") };
        let Error::Input { quantity, value: reported, needed } = &error else {
            panic!("{name} of {value}: {error:?}");
        };
        assert!(quantity.contains(name), "{quantity}, not {name}");
        assert!(*reported == value || !value.is_finite(), "{reported} for {value}");
        let message = error.to_string();
        for words in [*quantity, &reported.to_string(), *needed] {
            assert!(message.contains(words), "'{words}' is not in '{message}'");
        }
    }
}

/// The error, whose text must contain `words`.
#[track_caller]
fn error_with<T>(words: &str, result: basemat::Result<T>) -> Error {
    let Err(error) = result else { panic!("accepted: {words}") };
    assert!(error.to_string().contains(words), "'{words}' is not in '{error}'");
    error
}

fn soil() -> Soil {
    Soil::new(80.0e6, 0.33, 1900.0).unwrap()
}
