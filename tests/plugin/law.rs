//! GOAL: an interface law of one's own.
//! SCENE: friction that is lost once an element has slid, under a block.
//! REFERENCE: Coulomb's law, which slides less.

use basemat::interface::{
    Condition, ContactState, Coulomb, InterfaceLaw, Mode, PreviousContact, Tolerance,
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
