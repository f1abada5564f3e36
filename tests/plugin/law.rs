//! GOAL: an interface law of one's own.
//! SCENE: friction that is lost once an element has slid, and laws that give limits only, under a block.
//! REFERENCE: Coulomb's law, which slides less; the laws whose limits they are.

use basemat::Result;
use basemat::interface::{
    Bonded, Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PreviousContact,
    Tolerance, Yielding,
};

use super::scene::{run, shaken};
use basemat_problems::block_on_springs::{bed, block};

/// Sticks until it once slid; from then on there is no friction at all.
pub(crate) struct Glaze(pub(crate) f64);

impl InterfaceLaw for Glaze {
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
    let (own, _) = run(scene().interface(Glaze(0.3)));
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
    fn check(law: impl InterfaceLaw + Copy + 'static) -> [f64; 2] {
        let scene = || shaken().structure(block()).ground(bed(6));
        let (run, whole) = super::scene::run(scene().interface(law));
        let (_, limits) = super::scene::run(scene().interface(OnlyLimits(law)));
        assert_eq!(limits.state().displacement(), whole.state().displacement());
        assert_eq!(limits.state().contact, whole.state().contact);
        [run.whole.largest_slip.magnitude(), run.largest_gap().value]
    }
    let [slip, gap] = check(Coulomb::new(0.3).unwrap());
    assert!(slip > 0.0, "{slip} {gap}");
    let [_, gap] = check(Coulomb::new(2.0).unwrap());
    assert!(gap > 0.0);
    check(Coulomb::uplift_only());
    check(Coulomb::new(0.5).unwrap().with_tensile_strength(2e4).unwrap());
    check(Yielding::new(2.5e5, 0.3).unwrap());
    check(Bonded);

    /// No limits and no modes.
    struct Nothing;
    impl InterfaceLaw for Nothing {}
    let error = shaken().structure(block()).ground(bed(6)).interface(Nothing).build().err();
    assert!(error.unwrap().to_string().contains("`limits`"));

    /// Friction below zero.
    struct Wrong;
    impl InterfaceLaw for Wrong {
        fn limits(&self, _: &PreviousContact) -> Result<Limits> {
            Ok(Limits { friction: -0.1, ..Limits::default() })
        }
    }
    let built = shaken().structure(block()).ground(bed(6)).interface(Wrong).build();
    let error = built.map(|mut own| own.step().err().map(|own| own.to_string()));
    let text = error.map_or_else(|own| own.to_string(), Option::unwrap_or_default);
    assert!(text.contains("friction coefficient"), "{text}");
}
