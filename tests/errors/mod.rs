//! GOAL: soil, ground, interface, motion, builder and step refuse bad input with a typed error that
//! names quantity, value and need.
//! SCENE: one quantity spoilt at a time.
//! REFERENCE: the fields of the error. Elements, record files and closed forms are tested in their
//! own files.

mod blame;
mod builder;
mod chains;
mod law_limits;
mod law_numbers;
mod laws_and_motions;
mod layered;
mod reasons;
mod sizes;
mod soils_and_grounds;
mod spoilt;
mod steps;
mod structures;
mod words;

use basemat::{Error, Soil};

const BAD: [f64; 5] = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const NEGATIVE: [f64; 3] = [-1.0, f64::NAN, f64::INFINITY];

/// Every value is refused by an input error that carries it and says so in its message.
#[track_caller]
fn refused<T>(name: &str, bad: &[f64], build: impl Fn(f64) -> basemat::Result<T>) {
    for &value in bad {
        let Err(error) = build(value) else { panic!("{name} of {value} was accepted") };
        let Error::Input { quantity, value: reported, needed } = &error else {
            panic!("{name} of {value}: {error:?}");
        };
        assert!(quantity.contains(name), "{quantity}, not {name}");
        assert!(*reported == value || !value.is_finite(), "{reported} for {value}");
        let message = error.to_string();
        for part in [*quantity, &reported.to_string(), *needed] {
            assert!(message.contains(part), "'{part}' is not in '{message}'");
        }
    }
}

/// The error, which also must say `part`.
#[track_caller]
fn error_with<T>(part: &str, outcome: basemat::Result<T>) -> Error {
    let Err(error) = outcome else { panic!("accepted: {part}") };
    assert!(error.to_string().contains(part), "'{part}' is not in '{error}'");
    error
}

fn soil() -> Soil {
    Soil::new(80.0e6, 0.33, 1900.0).unwrap()
}
