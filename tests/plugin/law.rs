//! GOAL: an interface law of one's own.
//! SCENE: friction that is lost once an element has slid, and laws that give limits only, under a block.
//! REFERENCE: Coulomb's law, which slides less; the laws whose limits they are.

use basemat::interface::{
    Bonded, Condition, ContactState, Coulomb, InPlane, InterfaceLaw, Limits, Mode, PlaneLaw,
    PreviousContact, Tolerance, Yielding,
};
use basemat::{Error, Result};

use super::scene::{assert_same_motion, run, shaken};
use basemat_problems::block_on_springs::{bed, block};

/// Sticks until it once slid; from then on there is no friction at all.
pub(crate) struct Glaze(pub(crate) f64);

impl PlaneLaw for Glaze {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let law = if start.mode.is_slip() { 0.0 } else { self.0 };
        Coulomb::new(law).unwrap().conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        let law = Coulomb::new(self.0).unwrap();
        match law.next_mode(mode, start, trial, tolerance) {
            Mode::Stick if start.mode.is_slip() && mode.is_slip() => mode,
            next => next,
        }
    }
}

#[test]
fn own_law() {
    let scene = || shaken().structure(block()).ground(bed(4));
    let (own, _) = run(scene().interface(InPlane(Glaze(0.3))));
    let (coulomb, _) = run(scene().interface(Coulomb::new(0.3).unwrap()));
    assert!(coulomb.whole.largest_slip.largest().value != 0.0, "{coulomb}");
    assert!(
        own.whole.largest_slip.largest().value.abs()
            > coulomb.whole.largest_slip.largest().value.abs(),
        "{own}\n{coulomb}"
    );
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

    fn commit(&self, start: &PreviousContact, end: &ContactState, mode: Mode, own: &mut [f64]) {
        self.0.commit(start, end, mode, own);
    }
}

#[test]
fn modes_follow_from_limits() {
    fn check(law: impl InterfaceLaw + Copy + 'static, tolerance: f64) -> [f64; 2] {
        let scene = || shaken().structure(block()).ground(bed(6));
        let (summary, whole) = run(scene().interface(law));
        let (_, limits) = run(scene().interface(OnlyLimits(law)));
        let states = [&whole, &limits].map(|own| own.state().contact.iter());
        let largest = states[0].clone().fold(0.0, |most: f64, own| own.pressure.abs().max(most));
        let [one, other] = states.map(|own| own.flat_map(|own| [own.pressure, own.shear]));
        assert!(one.zip(other).all(|(a, b)| (a - b).abs() <= tolerance * largest));
        assert_same_motion(&whole, &limits, tolerance);
        [summary.whole.largest_slip.magnitude(), summary.largest_gap().value]
    }
    let [slip, _] = check(Coulomb::new(0.3).unwrap(), 0.0);
    assert!(slip > 0.0, "{slip}");
    let [_, gap] = check(Coulomb::new(2.0).unwrap(), 0.0);
    assert!(gap > 0.0, "{gap}");
    check(Coulomb::uplift_only(), 0.0);
    check(Coulomb::new(0.5).unwrap().with_tensile_strength(2e4).unwrap(), 0.0);
    check(Yielding::new(2.5e5, 0.3).unwrap(), 0.0);
    // A law with the mode stick alone is solved at once, with other roundings.
    check(Bonded, 1e-12);
}

#[test]
fn laws_without_valid_limits_name_them() {
    /// Limits that are not known.
    struct Nothing;
    impl InterfaceLaw for Nothing {
        fn limits(&self, _: &PreviousContact) -> Result<Limits> {
            Err(Error::part("ice", "its strength is unknown"))
        }
    }
    /// Friction below zero.
    struct Wrong;
    impl InterfaceLaw for Wrong {
        fn limits(&self, _: &PreviousContact) -> Result<Limits> {
            Ok(Limits { friction: -0.1, ..Limits::default() })
        }
    }
    let refused = |law: Box<dyn InterfaceLaw>| {
        let built = shaken().structure(block()).ground(bed(6)).interface(law).build();
        let error = built.and_then(|mut simulation| simulation.run(1, |_| {})).err();
        let error = error.expect("no law without limits");
        let reasons =
            std::iter::successors(Some(&error as &dyn std::error::Error), |own| own.source());
        reasons.map(ToString::to_string).collect::<Vec<_>>().join(": ")
    };
    let text = refused(Box::new(Nothing));
    assert!(text.contains("its strength is unknown"), "{text}");
    let text = refused(Box::new(Wrong));
    assert!(text.contains("friction coefficient"), "{text}");
}
