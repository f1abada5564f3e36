//! GOAL: a limit of an interface law that is not possible is named, with its value and the element.
//! SCENE: one limit of one element's law is wrong, from the start or once the block has moved; in the plane and in space, by
//! laws with some modes or all.
//! REFERENCE: the fields of the error, and the state before the step.

use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::coupled::{GravityStage, SimulationBuilder, StepError};
use basemat::interface::{InterfaceLaw, LawError, Limits, Mode, PreviousContact};
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Error, Result};

use basemat_problems::scenes::{SI_UNITS, scene};

/// Words of a quantity, the values that it cannot have, and the limits with such a value.
type WrongLimit = (&'static str, &'static [f64], fn(f64) -> Limits);

const NOT_A_COEFFICIENT: &[f64] = &[-1.0, f64::NEG_INFINITY, f64::NAN];
const NOT_A_STRENGTH: &[f64] = &[-1e3, -1e-9, f64::NAN, f64::INFINITY];

fn valid_limits() -> Limits {
    Limits { friction: 0.4, ..Limits::default() }
}

const WRONG_LIMITS: [WrongLimit; 7] = [
    ("friction coefficient", NOT_A_COEFFICIENT, |friction| Limits {
        friction,
        ..valid_limits()
    }),
    ("greatest pressure", NOT_A_COEFFICIENT, |pressure_cap| Limits {
        pressure_cap,
        ..valid_limits()
    }),
    ("attraction", NOT_A_STRENGTH, |attraction| Limits { attraction, ..valid_limits() }),
    ("shear strength", NOT_A_STRENGTH, |shear_strength| Limits {
        shear_strength,
        ..valid_limits()
    }),
    ("tensile strength", NOT_A_STRENGTH, |tension| Limits { tension, ..valid_limits() }),
    ("hardening of the soil", NOT_A_STRENGTH, |hardening| Limits {
        hardening,
        ..valid_limits()
    }),
    ("gap of a closed", &[f64::NAN, f64::INFINITY], |gap_offset| Limits {
        gap_offset,
        ..valid_limits()
    }),
];

/// A law whose limits are wrong from a slip velocity on.
#[derive(Clone, Copy)]
struct LawWithWrongLimits {
    limits: Limits,
    /// Slip velocity from which the limits apply, m/s.
    min_slip_rate: f64,
    /// Whether it has the modes of friction only, or those of yielding, too.
    has_friction_modes: bool,
}

impl InterfaceLaw for LawWithWrongLimits {
    fn modes(&self) -> &[Mode] {
        if self.has_friction_modes {
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
        Ok(if start.slip_rate.abs() >= self.min_slip_rate {
            self.limits
        } else {
            valid_limits()
        })
    }
}

/// Index of the element whose law has wrong limits.
const DEFECTIVE_ELEMENT: usize = 2;

fn with_laws(builder: SimulationBuilder, law: LawWithWrongLimits) -> SimulationBuilder {
    let valid_law = LawWithWrongLimits { limits: valid_limits(), ..law };
    let mut laws: Vec<Box<dyn InterfaceLaw>> = Vec::new();
    for e in 0..4 {
        laws.push(Box::new(if e == DEFECTIVE_ELEMENT { law } else { valid_law }));
    }
    builder.interfaces(laws)
}

fn in_the_plane(law: LawWithWrongLimits) -> SimulationBuilder {
    let ground = SpringGround::new(-2.0..2.0, 4, 5e7, 4e7).unwrap();
    let block = RigidBlock::new(4.0, 3.0, 2000.0).unwrap();
    let ground = ground.with_dashpots(4e5, 3e5).unwrap();
    with_laws(scene(SI_UNITS, 2.0).structure(block).ground(ground), law)
}

fn in_space(law: LawWithWrongLimits) -> SimulationBuilder {
    let plan = Plan::rectangle(-2.0..2.0, -2.0..2.0, 2).unwrap();
    let ground = SpringGround::in_plan(plan, [5e7, 4e7, 4e7]).unwrap();
    let body = RigidBody::cuboid([4.0, 4.0, 3.0], 2000.0).unwrap();
    let ground = ground.with_dashpots(4e5, 3e5).unwrap();
    with_laws(scene(SI_UNITS, 2.0).structure(body).ground(ground), law)
}

fn assert_named(error: &LawError, name: &str, value: f64) {
    let Error::Input { quantity, value: reported, .. } = &*error.reason else {
        panic!("{error:?}")
    };
    assert_eq!(error.element, DEFECTIVE_ELEMENT, "{name} of {value}: {error}");
    assert!(quantity.contains(name), "{name} of {value}: {error}");
    assert!(*reported == value || reported.is_nan() && value.is_nan(), "{reported} for {value}");
}

/// Checks that a build or the first step names this limit.
fn assert_named_at_start(builder: SimulationBuilder, name: &str, value: f64) {
    let result = builder.build().and_then(|mut simulation| simulation.run(1, |_| {}));
    match result {
        Err(Error::Law(error) | Error::Step { step: 1, source: StepError::Law(error), .. }) => {
            assert_named(&error, name, value);
        }
        other => panic!("{name} of {value}: {other:?}"),
    }
}

#[test]
fn impossible_limits_are_named() {
    for scene in [in_the_plane, in_space] {
        for (name, values, limits) in WRONG_LIMITS {
            for &value in values {
                for has_friction_modes in [false, true] {
                    let limits = limits(value);
                    let law = LawWithWrongLimits { limits, min_slip_rate: 0.0, has_friction_modes };
                    for stage in [GravityStage::Frictionless, GravityStage::Frictional] {
                        assert_named_at_start(scene(law).gravity_stage(stage), name, value);
                    }
                }
            }
        }
    }
}

#[test]
fn limits_that_become_impossible_are_named_and_nothing_is_committed() {
    for scene in [in_the_plane, in_space] {
        for (name, values, limits) in WRONG_LIMITS {
            let value = values[0];
            let law = LawWithWrongLimits {
                limits: limits(value),
                min_slip_rate: 0.02,
                has_friction_modes: false,
            };
            let mut simulation = scene(law).build().unwrap();
            let error = loop {
                let state = simulation.state().clone();
                assert!(state.step < 600, "{name} of {value} was accepted");
                if let Err(error) = simulation.step() {
                    assert_eq!(*simulation.state(), state);
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
