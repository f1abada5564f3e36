//! GOAL: an interface law of a user works as one of the crate.
//! SCENE: friction that is lost once an element has slid, and laws that give limits only, under a block.
//! REFERENCE: Coulomb's law, which slides less; the laws whose limits they are.

use basemat::interface::{
    Bonded, Condition, ContactState, Coulomb, InPlane, InterfaceLaw, Limits, Mode, PlaneLaw,
    PreviousContact, Tolerance, Yielding,
};
use basemat::results::Run;
use basemat::{Error, Result};

use super::scene::{CompletedRun, assert_same_motion, complete_run, shaken};
use basemat_problems::block_on_springs::{bed, block};

/// Friction that is lost in an element once it has slid.
pub(crate) struct GlazedFriction {
    pub(crate) coefficient: f64,
}

impl PlaneLaw for GlazedFriction {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let coefficient = if start.mode.is_slip() { 0.0 } else { self.coefficient };
        Coulomb::new(coefficient).unwrap().conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        let law = Coulomb::new(self.coefficient).unwrap();
        match law.next_mode(mode, start, trial, tolerance) {
            Mode::Stick if start.mode.is_slip() && mode.is_slip() => mode,
            next => next,
        }
    }
}

/// Run of a block on this many springs.
fn run_with_law(springs: usize, law: impl InterfaceLaw + 'static) -> CompletedRun {
    complete_run(shaken().structure(block()).ground(bed(springs)).interface(law))
}

#[test]
fn a_block_slides_farther_where_friction_is_lost() {
    let glazed = run_with_law(4, InPlane(GlazedFriction { coefficient: 0.3 })).run;
    let coulomb = run_with_law(4, Coulomb::new(0.3).unwrap()).run;
    let glazed_slip = glazed.whole.largest_slip.largest().value.abs();
    let coulomb_slip = coulomb.whole.largest_slip.largest().value.abs();
    assert!(coulomb_slip != 0.0, "{coulomb}");
    assert!(glazed_slip > coulomb_slip, "{glazed}\n{coulomb}");
}

/// The limits and the state variables of another law, without its modes.
struct OnlyLimits<L>(L);

impl<L: InterfaceLaw> InterfaceLaw for OnlyLimits<L> {
    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        self.0.limits(start)
    }

    fn state_variables(&self) -> usize {
        self.0.state_variables()
    }

    fn commit(
        &self,
        start: &PreviousContact,
        end: &ContactState,
        mode: Mode,
        variables: &mut [f64],
    ) {
        self.0.commit(start, end, mode, variables);
    }
}

/// Checks that the limits of a law alone give the same run, which is returned.
fn assert_limits_are_enough(law: impl InterfaceLaw + Copy + 'static, tolerance: f64) -> Run {
    let expected = run_with_law(6, law);
    let computed = run_with_law(6, OnlyLimits(law)).simulation;
    let expected_contact = &expected.simulation.state().contact;
    let max_pressure = expected_contact
        .iter()
        .fold(0.0, |max_pressure: f64, contact| contact.pressure.abs().max(max_pressure));
    for (a, b) in expected_contact.iter().zip(&computed.state().contact) {
        assert!((a.pressure - b.pressure).abs() <= tolerance * max_pressure, "{a:?} {b:?}");
        assert!((a.shear - b.shear).abs() <= tolerance * max_pressure, "{a:?} {b:?}");
    }
    assert_same_motion(&expected.simulation, &computed, tolerance);
    expected.run
}

#[test]
fn modes_follow_from_limits() {
    let sliding = assert_limits_are_enough(Coulomb::new(0.3).unwrap(), 0.0);
    assert!(sliding.whole.largest_slip.magnitude() > 0.0, "{sliding}");
    let rocking = assert_limits_are_enough(Coulomb::new(2.0).unwrap(), 0.0);
    assert!(rocking.largest_gap().value > 0.0, "{rocking}");
    assert_limits_are_enough(Coulomb::uplift_only(), 0.0);
    let with_tension = Coulomb::new(0.5).unwrap().with_tensile_strength(2e4).unwrap();
    assert_limits_are_enough(with_tension, 0.0);
    assert_limits_are_enough(Yielding::new(2.5e5, 0.3).unwrap(), 0.0);
    // A law with the mode stick alone is solved without iteration, with other roundings.
    assert_limits_are_enough(Bonded, 1e-12);
}

/// A law whose limits are unknown.
struct UnknownLimits;

impl InterfaceLaw for UnknownLimits {
    fn limits(&self, _: &PreviousContact) -> Result<Limits> {
        Err(Error::part("ice", "its strength is unknown"))
    }
}

/// A law with friction below zero.
struct NegativeFriction;

impl InterfaceLaw for NegativeFriction {
    fn limits(&self, _: &PreviousContact) -> Result<Limits> {
        Ok(Limits { friction: -0.1, ..Limits::default() })
    }
}

/// Error of a block with this law, with all its causes.
fn error_with_law(law: impl InterfaceLaw + 'static) -> String {
    let result = shaken().structure(block()).ground(bed(6)).interface(law).build();
    let error = result.and_then(|mut simulation| simulation.run(1, |_| {})).err();
    let error = error.expect("no law without limits");
    let causes =
        std::iter::successors(Some(&error as &dyn std::error::Error), |cause| cause.source());
    causes.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}

#[test]
fn laws_without_valid_limits_name_them() {
    let error = error_with_law(UnknownLimits);
    assert!(error.contains("its strength is unknown"), "{error}");
    let error = error_with_law(NegativeFriction);
    assert!(error.contains("friction coefficient"), "{error}");
}
