//! The double as an interface law, and as a law of the plane.

use basemat::Result;
use basemat::interface::{
    Condition, ContactScene, ContactState, Coulomb, InPlane, InterfaceLaw, Limits, Mode, PlaneLaw,
    PreviousContact, Tolerance,
};

use super::doubles::{CORRECT, Double, refusal};

/// Methods that both traits have.
macro_rules! common_methods {
    () => {
        fn modes(&self) -> &[Mode] {
            self.0.asked("modes");
            &[Mode::SlipLeft]
        }

        fn conditions(&self, _: Mode, _: &PreviousContact) -> [Condition; 2] {
            self.0.asked("conditions");
            [Condition::gap_is(0.0), Condition::slip_is(CORRECT)]
        }

        fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
            self.0.asked("next_mode");
            Mode::SlipRight
        }

        fn compliance(&self, _: Mode, _: &PreviousContact) -> [f64; 2] {
            self.0.asked("compliance");
            [CORRECT; 2]
        }

        fn state_variables(&self) -> usize {
            self.0.asked("state_variables");
            3
        }

        fn initial_state_variables(&self, _: &PreviousContact, memory: &mut [f64]) {
            self.0.asked("initial_state_variables");
            memory.fill(CORRECT);
        }

        fn commit(&self, _: &PreviousContact, _: &ContactState, _: Mode, memory: &mut [f64]) {
            self.0.asked("commit");
            memory.fill(2.0 * CORRECT);
        }

        fn friction_coefficient(&self) -> Option<f64> {
            self.0.asked("friction_coefficient");
            Some(CORRECT)
        }

        fn bond_overload(&self, _: &PreviousContact, _: &ContactState) -> Option<f64> {
            self.0.asked("bond_overload");
            Some(CORRECT)
        }

        fn check_start(&self, _: &PreviousContact) -> Result<()> {
            self.0.asked("check_start");
            Err(refusal())
        }

        /// Smooth contact whose only closed mode is another one than the default's first.
        fn frictionless(&self) -> Box<dyn InterfaceLaw> {
            struct Smooth(Coulomb);
            impl PlaneLaw for Smooth {
                fn modes(&self) -> &[Mode] {
                    &[Mode::SlipRight]
                }
                fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
                    self.0.conditions(mode, start)
                }
                fn next_mode(
                    &self,
                    _: Mode,
                    _: &PreviousContact,
                    _: &ContactState,
                    _: Tolerance,
                ) -> Mode {
                    Mode::SlipRight
                }
            }
            self.0.asked("frictionless");
            Box::new(InPlane(Smooth(Coulomb::uplift_only())))
        }

        fn check(&self, _: &ContactScene) -> Result<()> {
            self.0.asked("check");
            Err(refusal())
        }
    };
}

impl InterfaceLaw for Double {
    common_methods!();

    fn limits(&self, _: &PreviousContact) -> Result<Limits> {
        self.0.asked("limits");
        Ok(Limits { tension: CORRECT, ..Limits::default() })
    }
}

impl PlaneLaw for Double {
    common_methods!();
}
