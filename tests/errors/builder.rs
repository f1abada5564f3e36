//! GOAL: a builder names the part that is missing, does not fit, or breaks.
//! SCENE: a complete scene with one part left out, given a bad number, or replaced.
//! REFERENCE: the fields of the error.

use basemat::bem::SpringGround;
use basemat::coupled::{Probe, SchemeCoefficients, SimulationBuilder, Theta, TimeScheme};
use basemat::interface::{
    Bonded, Condition, ContactState, InPlane, InterfaceLaw, Mode, PlaneLaw, PreviousContact,
    Tolerance,
};
use basemat::motion::FreeField;
use basemat::{Error, Simulation};

use super::{BAD, NEGATIVE, NOT_FINITE, error_with, refused};
use basemat_problems::block_on_springs::{bed, block};

/// A scene that is complete, for one thing to be spoilt.
pub(crate) fn good() -> SimulationBuilder {
    Simulation::builder(1e-3).structure(block()).ground(bed(4)).interface(Bonded)
}

#[track_caller]
pub(crate) fn unbuilt(part: &str, builder: SimulationBuilder) -> Error {
    error_with(part, builder.build())
}

#[test]
fn builders_refuse_missing_parts_and_bad_numbers() {
    assert!(good().build().is_ok());
    let step = |x| {
        Simulation::builder(x).structure(block()).ground(bed(4)).interface(Bonded).build().map(drop)
    };
    refused("time step", &BAD, step);
    for x in [1e300, 1e155, 1e-300] {
        error_with("square of the time step", step(x));
    }
    refused("gravity", &NEGATIVE, |x| good().gravity(x).build().map(drop));
    refused("moment center", &NOT_FINITE, |x| good().moment_center(x).build().map(drop));

    let empty = Simulation::builder(1e-3);
    assert!(matches!(unbuilt("structure", empty), Error::Scene { .. }));
    let groundless = Simulation::builder(1e-3).structure(block());
    assert!(matches!(unbuilt("ground", groundless), Error::Scene { .. }));
    let lawless = Simulation::builder(1e-3).structure(block()).ground(bed(4));
    assert!(matches!(unbuilt("interface", lawless), Error::Scene { .. }));
}

#[test]
fn builders_refuse_parts_that_do_not_fit() {
    let laws = |count: usize| -> Vec<Box<dyn InterfaceLaw>> {
        (0..count).map(|_| Box::new(Bonded) as Box<dyn InterfaceLaw>).collect()
    };
    assert!(good().interfaces(laws(4)).build().is_ok());
    for found in [2, 3, 5] {
        let error = unbuilt("interface laws", good().interfaces(laws(found)));
        assert_eq!(error, Error::Size { quantity: "list of interface laws", found, needed: 4 });
    }
    assert!(matches!(unbuilt("interface law", good().interfaces(vec![])), Error::Scene { .. }));

    let probe = Probe::velocity("far", 3);
    let error = unbuilt("probe", good().probe(probe));
    let source = Box::new(Error::Index { quantity: "degree of freedom", index: 3, bound: 3 });
    assert_eq!(error, Error::Item { item: "probe 'far'".to_owned(), source });
    for bad in NOT_FINITE {
        let probe = Probe::displacement("bad", (0, bad));
        let error = unbuilt("probe 'bad': weight of a degree of freedom", good().probe(probe));
        assert!(
            matches!(error, Error::Item { source, .. } if matches!(*source, Error::Input { .. }))
        );
    }

    // Two probes of one name: which would `Run::probe` tell of?
    let probes = [Probe::displacement("u", 0), Probe::velocity("v", 0), Probe::velocity("u", 1)];
    let error = unbuilt("called 'u'", good().probes(probes.clone()));
    assert_eq!(error, Error::DuplicateName { quantity: "probe", name: "u".to_owned() });
    assert!(good().probes(probes[..2].to_vec()).build().is_ok());

    // Twice as wide as the block.
    let wide = SpringGround::new(-4.0..4.0, 4, 1e7, 1e7).unwrap();
    let error = unbuilt("reaches beyond the structure's base, -2 to 2 m", good().ground(wide));
    assert!(matches!(error, Error::Part { .. }));
    refused("free field at t = 0", &NOT_FINITE, |x| good().motion(Standing(x)).build().map(drop));
}

/// A free field that never moves, wherever it stands.
struct Standing(f64);

impl FreeField for Standing {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        [self.0, 0.0]
    }
}

struct NoModes;

impl PlaneLaw for NoModes {
    fn modes(&self) -> &[Mode] {
        &[]
    }

    fn conditions(&self, _: Mode, start: &PreviousContact) -> [Condition; 2] {
        Bonded.conditions(Mode::Stick, start)
    }

    fn next_mode(&self, mode: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
        mode
    }
}

struct NotANumber;

impl TimeScheme for NotANumber {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        SchemeCoefficients {
            acceleration: [f64::NAN, 0.0, 0.0],
            ..Theta::new(0.5).unwrap().coefficients(time_step)
        }
    }
}

#[test]
fn builders_refuse_broken_plugins() {
    assert!(matches!(unbuilt("modes", good().interface(InPlane(NoModes))), Error::Scene { .. }));
    let error = unbuilt("coefficient of the time scheme", good().scheme(NotANumber));
    assert!(matches!(error, Error::Input { .. }), "{error:?}");
}
