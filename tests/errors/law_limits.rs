//! GOAL: a limit of an interface law that is not possible is named, with its value and the element.
//! SCENE: one limit of one element's law spoilt, from the start or once the block has moved; in the plane, by laws with
//! and without modes of their own, and in plan.
//! REFERENCE: the fields of the error, and the state before the step.

use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::coupled::{GravityStage, SimulationBuilder, StepError};
use basemat::interface::{InterfaceLaw, LawError, Limits, Mode, PreviousContact};
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Error, Result, Simulation};

use basemat_problems::scenes::{SI, scene};

/// Words of a quantity, the values that it cannot have, and the limits with such a value.
type Spoilt = (&'static str, &'static [f64], fn(f64) -> Limits);

const NEGATIVE: &[f64] = &[-1.0, f64::NEG_INFINITY, f64::NAN];
const NOT_A_STRENGTH: &[f64] = &[-1e3, -1e-9, f64::NAN, f64::INFINITY];

fn sound() -> Limits {
    Limits { friction: 0.4, ..Limits::default() }
}

const LIMITS: [Spoilt; 6] = [
    ("friction coefficient", NEGATIVE, |friction| Limits { friction, ..sound() }),
    ("greatest pressure", NEGATIVE, |pressure_cap| Limits { pressure_cap, ..sound() }),
    ("attraction", NOT_A_STRENGTH, |attraction| Limits { attraction, ..sound() }),
    ("shear strength", NOT_A_STRENGTH, |shear_strength| Limits { shear_strength, ..sound() }),
    ("tensile strength", NOT_A_STRENGTH, |tension| Limits { tension, ..sound() }),
    ("gap of a closed", &[f64::NAN, f64::INFINITY], |gap_offset| Limits { gap_offset, ..sound() }),
];

/// A law that gives limits, spoilt from a slip velocity on; with all modes or with its own.
#[derive(Clone, Copy)]
struct Law {
    limits: Limits,
    from: f64,
    has_modes: bool,
}

impl InterfaceLaw for Law {
    fn modes(&self) -> &[Mode] {
        if self.has_modes {
            &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
        } else {
            &[
                Mode::Stick,
                Mode::SlipLeft,
                Mode::SlipRight,
                Mode::Open,
                Mode::Yield,
                Mode::YieldLeft,
                Mode::YieldRight,
            ]
        }
    }

    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        Ok(if start.slip_rate.abs() >= self.from { self.limits } else { sound() })
    }
}

/// The element whose law is spoilt.
const ELEMENT: usize = 2;

fn with_laws(builder: SimulationBuilder, law: Law) -> SimulationBuilder {
    let sound = Law { limits: sound(), ..law };
    let law =
        |e: usize| -> Box<dyn InterfaceLaw> { Box::new(if e == ELEMENT { law } else { sound }) };
    builder.interfaces((0..4).map(law).collect())
}

fn in_the_plane(law: Law) -> SimulationBuilder {
    let ground = SpringGround::new(-2.0..2.0, 4, 5e7, 4e7).unwrap();
    let block = RigidBlock::new(4.0, 3.0, 2000.0).unwrap();
    let ground = ground.with_dashpots(4e5, 3e5).unwrap();
    with_laws(scene(SI, 2.0).structure(block).ground(ground), law)
}

fn in_plan(law: Law) -> SimulationBuilder {
    let plan = Plan::rectangle(-2.0..2.0, -2.0..2.0, 2).unwrap();
    let ground = SpringGround::in_plan(plan, [5e7, 4e7, 4e7]).unwrap();
    let body = RigidBody::cuboid([4.0, 4.0, 3.0], 2000.0).unwrap();
    let ground = ground.with_dashpots(4e5, 3e5).unwrap();
    with_laws(scene(SI, 2.0).structure(body).ground(ground), law)
}

fn assert_named(error: &LawError, name: &str, value: f64) {
    let Error::Input { quantity, value: found, .. } = &*error.reason else { panic!("{error:?}") };
    assert!(error.element == ELEMENT && quantity.contains(name), "{name} of {value}: {error}");
    assert!(*found == value || found.is_nan() && value.is_nan(), "{found} for {value}");
}

#[test]
fn impossible_limits_are_named() {
    for builder in [in_the_plane, in_plan] {
        for (name, values, limits) in LIMITS {
            for &value in values {
                for has_modes in [false, true] {
                    let law = Law { limits: limits(value), from: 0.0, has_modes };
                    for stage in [GravityStage::Frictionless, GravityStage::Frictional] {
                        let built = builder(law).gravity_stage(stage).build();
                        let error = built.and_then(|mut simulation| simulation.run(1, |_| {}));
                        match error {
                            Err(Error::Law(error)) => assert_named(&error, name, value),
                            Err(Error::Step { step: 1, source: StepError::Law(error), .. }) => {
                                assert_named(&error, name, value);
                            }
                            other => panic!("{name} of {value}: {other:?}"),
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn limits_that_become_impossible_are_named_and_nothing_is_committed() {
    for builder in [in_the_plane, in_plan] {
        for (name, values, limits) in LIMITS {
            let value = values[0];
            let law = Law { limits: limits(value), from: 0.02, has_modes: false };
            let mut simulation: Simulation = builder(law).build().unwrap();
            let error = loop {
                let before = simulation.state().clone();
                assert!(before.step < 600, "{name} of {value} was accepted");
                if let Err(error) = simulation.step() {
                    assert_eq!(*simulation.state(), before);
                    break error;
                }
            };
            let Error::Step { step, source: StepError::Law(error), .. } = error else {
                panic!("{name} of {value}: {error:?}");
            };
            assert!(step > 2, "{step}");
            assert_named(&error, name, value);
        }
    }
}
