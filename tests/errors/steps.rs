//! GOAL: a step that fails leaves the last accepted state.
//! SCENE: free fields and loads that break in the middle of a run; laws for which no modes are
//! found.
//! REFERENCE: the state before the step, and the fields of the error.

use std::fmt::Debug;

use basemat::coupled::StepError;
use basemat::interface::{Coulomb, InPlane, InterfaceLaw, Mode, PreviousContact};
use basemat::motion::FreeFieldFn;
use basemat::{Error, Simulation};

use super::builder::good;
use super::spoilt::Spoilt;
use basemat_problems::wrapped::Wayward;

/// The step that fails, with the state before and after the attempt.
fn failing_step(mut simulation: Simulation) -> (Error, usize, Simulation) {
    for accepted in 0..1000 {
        let before = simulation.state().clone();
        if let Err(error) = simulation.step() {
            assert_eq!(*simulation.state(), before, "a failed step changes nothing");
            assert_eq!(before.step, accepted);
            return (error, accepted, simulation);
        }
    }
    panic!("no step failed");
}

fn assert_not_finite(error: &Error, accepted: usize, part: &str) {
    let Error::Step { step, time, source: StepError::NotFinite { quantity, index, value } } = error
    else {
        panic!("{error:?}");
    };
    assert_eq!(*step, accepted + 1);
    assert!((time - *step as f64 * 1e-3).abs() < 1e-12);
    let message = error.to_string();
    assert!(quantity.contains(part) && *index < 8 && value.is_nan(), "{error}");
    assert!(message.contains(&format!("step {step} (t = ")) && message.contains("not finite"));
}

#[test]
fn a_free_field_that_breaks_leaves_the_last_accepted_step() {
    let broken = FreeFieldFn::new(|_, t| [if t > 0.0105 { f64::NAN } else { t * t }, 0.0]);
    let law = Coulomb::new(0.3).unwrap();
    let simulation = good().interface(law).motion(broken).gravity(9.81).build().unwrap();
    let (error, accepted, mut simulation) = failing_step(simulation);
    assert_eq!(accepted, 10);
    assert_not_finite(&error, accepted, "free field");
    // Again, and through `run`: the same error, the same state.
    let seen = simulation.state().clone();
    // NaN does not equal itself.
    assert_eq!(simulation.run(5, |_| {}).unwrap_err().to_string(), error.to_string());
    assert_eq!(*simulation.state(), seen);
    assert!(seen.absolute_displacement().iter().all(|u| u.is_finite()));
}

#[test]
fn a_load_that_breaks_leaves_the_last_accepted_step() {
    for tangent in [None, Some((0, 0, 0.0))] {
        let structure = Spoilt { load_from: 0.0101, tangent, ..Spoilt::sound() };
        let (error, accepted, _) = failing_step(structure.scene().build().unwrap());
        assert_not_finite(&error, accepted, "load of the structure");
        assert_eq!(accepted, 10);
    }
}

#[test]
fn a_force_that_breaks_leaves_the_last_accepted_step() {
    let structure = Spoilt { commits: 7, tangent: Some((0, 0, 0.0)), ..Spoilt::sound() };
    let (error, accepted, _) = failing_step(structure.scene().build().unwrap());
    assert_not_finite(&error, accepted, "nonlinear force of the structure");
    // The first commit belongs to the static state.
    assert_eq!(accepted, 6);
}

/// A law that is never content.
fn fickle() -> impl InterfaceLaw {
    let next = |mode: Mode, _: &PreviousContact, _: Mode| match mode {
        Mode::Stick => Mode::Open,
        _ => Mode::Stick,
    };
    InPlane(Wayward { law: Coulomb::uplift_only(), next })
}

#[test]
fn modes_that_are_not_found_are_an_error_with_residual_and_modes() {
    let (error, accepted, _) = failing_step(good().interface(fickle()).build().unwrap());
    assert_eq!(accepted, 0);
    let Error::Step {
        step: 1,
        source: StepError::Contact { iterations, residual, modes, sets },
        ..
    } = &error
    else {
        panic!("{error:?}");
    };
    assert!(*iterations > 0 && !residual.is_nan());
    assert_eq!((modes.len(), *sets), (4, Some(256)));
    let message = error.to_string();
    assert!(
        message.contains("residual")
            && message.contains("modes ")
            && message.contains("0.001")
            && message.contains("none of all 256 sets")
    );
}

#[test]
fn errors_are_ordinary_errors() {
    fn is_error<T: std::error::Error + Send + Sync + Clone + Debug + 'static>() {}
    is_error::<Error>();
    is_error::<StepError>();
    let (error, ..) = failing_step(good().interface(fickle()).build().unwrap());
    // Its text is complete, and no source repeats it.
    assert!(std::error::Error::source(&error).is_none());
}
