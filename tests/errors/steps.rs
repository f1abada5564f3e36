//! GOAL: a step that fails leaves the last accepted state.
//! SCENE: free fields and loads that become NaN in the middle of a run; laws without admissible modes.
//! REFERENCE: the state before the step, and the fields of the error.

use std::fmt::Debug;

use basemat::coupled::StepError;
use basemat::interface::{Coulomb, InPlane, InterfaceLaw, Mode, PreviousContact};
use basemat::motion::FreeFieldFn;
use basemat::{Error, Simulation};

use super::builder::complete_scene;
use super::defective_structure::DefectiveStructure;
use basemat_problems::wrapped::LawWithNextMode;

/// The first step of a simulation that fails.
struct FailedStep {
    error: Error,
    accepted_steps: usize,
    simulation: Simulation,
}

/// Steps until one fails, which must change nothing.
fn failed_step(mut simulation: Simulation) -> FailedStep {
    for accepted_steps in 0..1000 {
        let state = simulation.state().clone();
        if let Err(error) = simulation.step() {
            assert_eq!(*simulation.state(), state, "a failed step changes nothing");
            assert_eq!(state.step, accepted_steps);
            return FailedStep { error, accepted_steps, simulation };
        }
    }
    panic!("no step failed");
}

fn assert_not_finite(error: &Error, accepted_steps: usize, words: &str) {
    let Error::Step { step, time, source: StepError::NotFinite { quantity, index, value } } = error
    else {
        panic!("{error:?}");
    };
    assert_eq!(*step, accepted_steps + 1);
    assert!((time - *step as f64 * 1e-3).abs() < 1e-12);
    let message = error.to_string();
    assert!(quantity.contains(words) && *index < 8 && value.is_nan(), "{error}");
    assert!(message.contains(&format!("step {step} (t = ")) && message.contains("not finite"));
}

#[test]
fn a_free_field_that_fails_leaves_the_last_accepted_step() {
    let motion = FreeFieldFn::new(|_, t| [if t > 0.0105 { f64::NAN } else { t * t }, 0.0]);
    let law = Coulomb::new(0.3).unwrap();
    let builder = complete_scene().interface(law).motion(motion).gravity(9.81);
    let FailedStep { error, accepted_steps, mut simulation } =
        failed_step(builder.build().unwrap());
    assert_eq!(accepted_steps, 10);
    assert_not_finite(&error, accepted_steps, "free field");
    // A run from there has the same error and the same state.
    let state = simulation.state().clone();
    // NaN does not equal itself.
    assert_eq!(simulation.run(5, |_| {}).unwrap_err().to_string(), error.to_string());
    assert_eq!(*simulation.state(), state);
    assert!(state.absolute_displacement().iter().all(|u| u.is_finite()));
}

#[test]
fn a_load_that_fails_leaves_the_last_accepted_step() {
    for tangent in [None, Some((0, 0, 0.0))] {
        let intact_structure = DefectiveStructure::intact();
        let structure = DefectiveStructure { load_fails_at: 0.0101, tangent, ..intact_structure };
        let failed_step_of_structure = failed_step(structure.scene().build().unwrap());
        assert_not_finite(
            &failed_step_of_structure.error,
            failed_step_of_structure.accepted_steps,
            "load of the structure",
        );
        assert_eq!(failed_step_of_structure.accepted_steps, 10);
    }
}

#[test]
fn a_force_that_fails_leaves_the_last_accepted_step() {
    let structure = DefectiveStructure {
        commits_before_failure: 7,
        tangent: Some((0, 0, 0.0)),
        ..DefectiveStructure::intact()
    };
    let failed_step_of_structure = failed_step(structure.scene().build().unwrap());
    assert_not_finite(
        &failed_step_of_structure.error,
        failed_step_of_structure.accepted_steps,
        "nonlinear force of the structure",
    );
    // The first commit belongs to the static state.
    assert_eq!(failed_step_of_structure.accepted_steps, 6);
}

/// A law that accepts no mode of an element.
fn law_without_valid_mode() -> impl InterfaceLaw {
    InPlane(LawWithNextMode {
        law: Coulomb::uplift_only(),
        next: |mode: Mode, _: &PreviousContact, _: Mode| match mode {
            Mode::Stick => Mode::Open,
            _ => Mode::Stick,
        },
    })
}

#[test]
fn modes_that_are_not_found_are_an_error_with_residual_and_modes() {
    let builder = complete_scene().interface(law_without_valid_mode());
    let FailedStep { error, accepted_steps, .. } = failed_step(builder.build().unwrap());
    assert_eq!(accepted_steps, 0);
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
    for words in ["residual", "modes ", "0.001", "none of all 256 sets"] {
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn errors_implement_the_standard_traits() {
    fn is_error<T: std::error::Error + Send + Sync + Clone + Debug + 'static>() {}
    is_error::<Error>();
    is_error::<StepError>();
    let builder = complete_scene().interface(law_without_valid_mode());
    let error = failed_step(builder.build().unwrap()).error;
    // The text of the error is complete, and no source repeats it.
    assert!(std::error::Error::source(&error).is_none());
}
