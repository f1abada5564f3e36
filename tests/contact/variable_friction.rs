//! GOAL: friction follows a coefficient that is a function of the contact at the start of the step.
//! SCENE: block on the half-plane that slides and uplifts.
//! REFERENCE: Coulomb's law itself for a constant coefficient; slips, pressures and shears of the
//! states.

use basemat::Error;
use basemat::coupled::State;
use basemat::coupled::StepError;
use basemat::interface::LawError;
use basemat::interface::{Coulomb, InterfaceLaw, UnilateralCondition, VariableFriction};

use basemat_problems::scenes::{SI_UNITS, TIME_STEP, block, friction, scene, states};

const RUN_STEPS: usize = 300;

fn run(law: impl InterfaceLaw + 'static) -> Vec<State> {
    let builder = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(law);
    states(&mut builder.build().unwrap(), RUN_STEPS)
}

/// GOAL: with a constant coefficient the law is Coulomb's, to the last bit.
#[test]
fn a_constant_coefficient_is_coulomb_s_law() {
    for coefficient in [0.3, 3.0, f64::INFINITY] {
        let coulomb = run(friction(coefficient));
        assert!(coulomb.iter().any(|state| state.uplifted_fraction > 0.0));
        let variable = VariableFriction::new(move |_| coefficient);
        assert_eq!(coulomb, run(variable), "{coefficient}");
        let with_tension = run(friction(coefficient).with_tensile_strength(2e4).unwrap());
        assert_ne!(with_tension, coulomb);
        let variable = VariableFriction::new(move |_| coefficient);
        let variable = variable.with_tensile_strength(2e4).unwrap();
        assert_eq!(with_tension, run(variable), "{coefficient}");
    }
    let rate = UnilateralCondition::Velocity { closed_below: 1e-6 };
    let by_velocity = run(friction(0.3).with_unilateral_condition(rate).unwrap());
    let variable = VariableFriction::new(|_| 0.3).with_unilateral_condition(rate).unwrap();
    assert_eq!(by_velocity, run(variable));
}

/// Without friction the two laws have different lists of modes, and the same solution.
#[test]
fn a_coefficient_of_zero_is_frictionless() {
    let coulomb = run(friction(0.0));
    let variable = run(VariableFriction::new(|_| 0.0));
    let sways = |states: &[State]| -> Vec<f64> {
        states.iter().map(|state| state.absolute_displacement()[0]).collect()
    };
    let expected = sways(&coulomb);
    let max_magnitude = expected.iter().fold(0.0_f64, |max, sway| max.max(sway.abs()));
    for (a, b) in expected.iter().zip(sways(&variable)) {
        assert!((a - b).abs() < 1e-9 * max_magnitude, "{a:e} {b:e} of {max_magnitude:e}");
    }
}

#[test]
fn wrong_settings_are_errors() {
    assert!(VariableFriction::new(|_| 0.3).with_tensile_strength(f64::NAN).is_err());
    let negative_gap = UnilateralCondition::Velocity { closed_below: -1.0 };
    assert!(VariableFriction::new(|_| 0.3).with_unilateral_condition(negative_gap).is_err());
}

#[test]
fn only_constant_friction_has_a_coefficient() {
    assert_eq!(VariableFriction::new(|_| 0.3).friction_coefficient(), None);
    assert_eq!(friction(0.3).friction_coefficient(), Some(0.3));
    assert_eq!(Coulomb::uplift_only().friction_coefficient(), Some(f64::INFINITY));
}

fn coefficient_at(speed: f64) -> f64 {
    0.15 + 0.2 * (-speed / 0.05).exp()
}

/// GOAL: an element that slides has the coefficient of its speed in the previous step.
/// REFERENCE: slips, pressures and shears of the states.
#[test]
fn sliding_elements_have_the_coefficient_of_their_speed() {
    let states = run(VariableFriction::new(|start| coefficient_at(start.slip_rate.abs())));
    let mut sliding_elements = 0;
    let mut min_coefficient = f64::INFINITY;
    let mut max_value = 0.0_f64;
    for steps in states.windows(3) {
        for (e, end) in steps[2].contact.iter().enumerate() {
            let increment = steps[1].contact[e].slip - steps[0].contact[e].slip;
            let coefficient = coefficient_at(increment.abs() / TIME_STEP);
            let tolerance = 1e-6 * end.pressure.max(1e4);
            assert!(end.shear.abs() <= coefficient * end.pressure.max(0.0) + tolerance);
            if steps[2].modes[e].is_slip() {
                assert!((end.shear.abs() - coefficient * end.pressure).abs() <= tolerance);
                sliding_elements += 1;
                min_coefficient = min_coefficient.min(coefficient);
                max_value = max_value.max(coefficient);
            }
        }
    }
    println!("{sliding_elements} sliding elements, coefficients {min_coefficient} to {max_value}");
    assert!(sliding_elements > 100 && max_value > min_coefficient + 0.05);
}

/// GOAL: an invalid coefficient ends the step with an error, and does not make the base stick.
#[test]
fn an_invalid_coefficient_is_an_error() {
    for invalid in [f64::NAN, -0.1, f64::NEG_INFINITY] {
        let law = VariableFriction::new(
            move |start| {
                if start.state.slip.abs() > 1e-4 { invalid } else { 0.2 }
            },
        );
        let builder = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(law);
        let mut simulation = builder.build().unwrap();
        let error = loop {
            let state = simulation.state().clone();
            assert!(state.step < RUN_STEPS, "no step failed with {invalid}");
            if let Err(error) = simulation.step() {
                assert_eq!(*simulation.state(), state);
                break error;
            }
        };
        println!("{error}");
        let Error::Step { source, .. } = error else { panic!("{error:?}") };
        let StepError::Law(error) = source else { panic!("{source:?}") };
        let LawError { element, reason, .. } = &error;
        let Error::Input { quantity: "friction coefficient", value, .. } = **reason else {
            panic!("{reason:?}")
        };
        assert!(*element < 8 && value.to_bits() == invalid.to_bits(), "{error}");
    }
}
