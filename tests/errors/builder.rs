//! GOAL: a builder names the part that is missing, does not fit, or fails.
//! SCENE: a complete scene with one part left out, replaced, or with a bad number.
//! REFERENCE: the fields of the error.

use basemat::bem::SpringGround;
use basemat::coupled::{Probe, SchemeCoefficients, SimulationBuilder, Theta, TimeScheme};
use basemat::interface::{
    Bonded, Condition, ContactState, InPlane, InterfaceLaw, Mode, PlaneLaw, PreviousContact,
    Tolerance,
};
use basemat::motion::FreeField;
use basemat::{Error, Result, Simulation};

use super::{NEGATIVE_OR_NOT_FINITE, NOT_FINITE, NOT_POSITIVE_FINITE, assert_errors, error_with};
use basemat_problems::block_on_springs::{bed, block};

/// A complete scene, in which a test may change one part.
pub(crate) fn complete_scene() -> SimulationBuilder {
    Simulation::builder(1e-3).structure(block()).ground(bed(4)).interface(Bonded)
}

/// Error of a scene, whose text must contain `words`.
#[track_caller]
pub(crate) fn build_error(words: &str, builder: SimulationBuilder) -> Error {
    error_with(words, builder.build())
}

/// Builds the complete scene with this time step.
fn build_with_time_step(time_step: f64) -> Result<()> {
    let builder = Simulation::builder(time_step).structure(block()).ground(bed(4));
    builder.interface(Bonded).build().map(drop)
}

#[test]
fn builders_return_errors_for_missing_parts_and_invalid_numbers() {
    assert!(complete_scene().build().is_ok());
    assert_errors("time step", &NOT_POSITIVE_FINITE, build_with_time_step);
    for time_step in [1e300, 1e155, 1e-300] {
        error_with("square of the time step", build_with_time_step(time_step));
    }
    assert_errors("gravity", &NEGATIVE_OR_NOT_FINITE, |x| {
        complete_scene().gravity(x).build().map(drop)
    });
    assert_errors("moment center", &NOT_FINITE, |x| {
        complete_scene().moment_center(x).build().map(drop)
    });

    let builder = Simulation::builder(1e-3);
    assert!(matches!(build_error("structure", builder), Error::Scene { .. }));
    let without_ground = Simulation::builder(1e-3).structure(block());
    assert!(matches!(build_error("ground", without_ground), Error::Scene { .. }));
    let without_law = Simulation::builder(1e-3).structure(block()).ground(bed(4));
    assert!(matches!(build_error("interface", without_law), Error::Scene { .. }));
}

fn bonded_laws(count: usize) -> Vec<Box<dyn InterfaceLaw>> {
    (0..count).map(|_| Box::new(Bonded) as Box<dyn InterfaceLaw>).collect()
}

#[test]
fn builders_return_errors_for_parts_that_do_not_fit() {
    assert!(complete_scene().interfaces(bonded_laws(4)).build().is_ok());
    for law_count in [2, 3, 5] {
        let error =
            build_error("interface laws", complete_scene().interfaces(bonded_laws(law_count)));
        assert_eq!(
            error,
            Error::Size { quantity: "list of interface laws", found: law_count, needed: 4 }
        );
    }
    assert!(matches!(
        build_error("interface law", complete_scene().interfaces(vec![])),
        Error::Scene { .. }
    ));

    let probe = Probe::velocity("far", 3);
    let error = build_error("probe", complete_scene().probe(probe));
    let source = Box::new(Error::Index { quantity: "degree of freedom", index: 3, bound: 3 });
    assert_eq!(error, Error::Item { item: "probe 'far'".to_owned(), source });
    for weight in NOT_FINITE {
        let probe = Probe::displacement("bad", (0, weight));
        let error = build_error(
            "probe 'bad': weight of a degree of freedom",
            complete_scene().probe(probe),
        );
        assert!(
            matches!(error, Error::Item { source, .. } if matches!(*source, Error::Input { .. }))
        );
    }

    // `Run::probe` could not distinguish two probes of one name.
    let probes = [Probe::displacement("u", 0), Probe::velocity("v", 0), Probe::velocity("u", 1)];
    let error = build_error("called 'u'", complete_scene().probes(probes.clone()));
    assert_eq!(error, Error::DuplicateName { quantity: "probe", name: "u".to_owned() });
    assert!(complete_scene().probes(probes[..2].to_vec()).build().is_ok());

    // Twice as wide as the block.
    let wide_bed = SpringGround::new(-4.0..4.0, 4, 1e7, 1e7).unwrap();
    let error = build_error(
        "extends beyond the structure's base, -2 to 2 m",
        complete_scene().ground(wide_bed),
    );
    assert!(matches!(error, Error::Part { .. }));
    assert_errors("free field at t = 0", &NOT_FINITE, |x| {
        complete_scene().motion(ConstantField(x)).build().map(drop)
    });
}

/// A free field with a constant horizontal displacement.
struct ConstantField(f64);

impl FreeField for ConstantField {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        [self.0, 0.0]
    }
}

/// A law with an empty list of modes.
struct LawWithoutModes;

impl PlaneLaw for LawWithoutModes {
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

/// A scheme with a coefficient that is NaN.
struct SchemeWithNan;

impl TimeScheme for SchemeWithNan {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        SchemeCoefficients {
            acceleration: [f64::NAN, 0.0, 0.0],
            ..Theta::new(0.5).unwrap().coefficients(time_step)
        }
    }
}

#[test]
fn builders_return_errors_for_defective_laws_and_schemes() {
    assert!(matches!(
        build_error("modes", complete_scene().interface(InPlane(LawWithoutModes))),
        Error::Scene { .. }
    ));
    let error =
        build_error("coefficient of the time scheme", complete_scene().scheme(SchemeWithNan));
    assert!(matches!(error, Error::Input { .. }), "{error:?}");
}
