//! GOAL: Coulomb friction whose coefficient is a function of the start of the step.
//! SCENE: block on the half-plane that slides and uplifts.
//! REFERENCE: Coulomb's law itself for a constant coefficient; slips, pressures and shears of the
//! states.

use basemat::Error;
use basemat::coupled::State;
use basemat::coupled::StepError;
use basemat::interface::LawError;
use basemat::interface::{Coulomb, InterfaceLaw, UnilateralCondition, VariableFriction};

use basemat_problems::scenes::{SI, TIME_STEP, block, friction, scene, states};

const STEPS: usize = 300;

fn run(law: impl InterfaceLaw + 'static) -> Vec<State> {
    let builder = scene(SI, 0.6).structure(block(SI)).interface(law);
    states(&mut builder.build().unwrap(), STEPS)
}

/// GOAL: with a coefficient that does not change it is Coulomb's law, to the last bit.
#[test]
fn a_constant_is_coulomb() {
    for coefficient in [0.3, 3.0, f64::INFINITY] {
        let variable = || VariableFriction::new(move |_| coefficient);
        let plain = run(friction(coefficient));
        assert!(plain.iter().any(|state| state.uplifted_fraction > 0.0));
        assert_eq!(plain, run(variable()), "{coefficient}");
        let stuck = run(friction(coefficient).with_tensile_strength(2e4).unwrap());
        assert_ne!(stuck, plain);
        assert_eq!(stuck, run(variable().with_tensile_strength(2e4).unwrap()), "{coefficient}");
    }
    let rate = UnilateralCondition::Velocity { closed_below: 1e-6 };
    let jumping = run(friction(0.3).with_unilateral_condition(rate).unwrap());
    let variable = VariableFriction::new(|_| 0.3).with_unilateral_condition(rate).unwrap();
    assert_eq!(jumping, run(variable));
    // Without friction the two have other lists of modes, and one solution.
    let (smooth, variable) = (run(friction(0.0)), run(VariableFriction::new(|_| 0.0)));
    let largest = smooth.iter().fold(0.0_f64, |m, s| m.max(s.absolute_displacement()[0].abs()));
    for (a, b) in smooth.iter().zip(&variable) {
        let apart = (a.absolute_displacement()[0] - b.absolute_displacement()[0]).abs();
        assert!(apart < 1e-9 * largest, "{apart:e} of {largest:e}");
    }
    assert!(VariableFriction::new(|_| 0.3).with_tensile_strength(f64::NAN).is_err());
    let refused = UnilateralCondition::Velocity { closed_below: -1.0 };
    assert!(VariableFriction::new(|_| 0.3).with_unilateral_condition(refused).is_err());
    assert_eq!(VariableFriction::new(|_| 0.3).friction_coefficient(), None);
    assert_eq!(friction(0.3).friction_coefficient(), Some(0.3));
    assert_eq!(Coulomb::uplift_only().friction_coefficient(), Some(f64::INFINITY));
}

/// GOAL: what slides has the coefficient of the speed at which it slid in the step before.
/// REFERENCE: slips, pressures and shears of the states.
#[test]
fn what_slides_has_the_coefficient_of_its_speed() {
    let of_speed = |speed: f64| 0.15 + 0.2 * (-speed / 0.05).exp();
    let law = VariableFriction::new(move |start| of_speed(start.slip_rate.abs()));
    let states = run(law);
    let (mut seen, mut range) = (0, [f64::INFINITY, 0.0_f64]);
    for three in states.windows(3) {
        for e in 0..three[0].contact.len() {
            let [before, start, end] = [0, 1, 2].map(|k| three[k].contact[e]);
            let speed = (start.slip - before.slip).abs() / TIME_STEP;
            let coefficient = of_speed(speed);
            let slack = 1e-6 * end.pressure.max(1e4);
            assert!(end.shear.abs() <= coefficient * end.pressure.max(0.0) + slack);
            if three[2].modes[e].is_slip() {
                assert!((end.shear.abs() - coefficient * end.pressure).abs() <= slack);
                seen += 1;
                range = [range[0].min(coefficient), range[1].max(coefficient)];
            }
        }
    }
    println!("{seen} sliding elements, coefficients {range:?}");
    assert!(seen > 100 && range[1] > range[0] + 0.05);
}

/// GOAL: an invalid coefficient ends the step with an error, not as a base that sticks.
#[test]
fn a_coefficient_that_is_none_is_an_error() {
    for bad in [f64::NAN, -0.1, f64::NEG_INFINITY] {
        let law = VariableFriction::new(
            move |start| {
                if start.state.slip.abs() > 1e-4 { bad } else { 0.2 }
            },
        );
        let builder = scene(SI, 0.6).structure(block(SI)).interface(law);
        let mut simulation = builder.build().unwrap();
        let error = loop {
            let before = simulation.state().clone();
            assert!(before.step < STEPS, "no step failed with {bad}");
            if let Err(error) = simulation.step() {
                assert_eq!(*simulation.state(), before);
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
        assert!(*element < 8 && value.to_bits() == bad.to_bits(), "{error}");
    }
}
