//! The recording part as an interface law, in space and in the plane only.

use basemat::Result;
use basemat::interface::{
    Condition, ContactScene, ContactState, Coulomb, InPlane, InterfaceLaw, Limits, Mode, PlaneLaw,
    PreviousContact, Tolerance,
};

use super::recording_part::{MARKER_VALUE, RecordingPart, part_error};

/// Methods that both traits have.
macro_rules! common_methods {
    () => {
        fn modes(&self) -> &[Mode] {
            self.0.add("modes");
            &[Mode::SlipLeft]
        }

        fn conditions(&self, _: Mode, _: &PreviousContact) -> [Condition; 2] {
            self.0.add("conditions");
            [Condition::gap_is(0.0), Condition::slip_is(MARKER_VALUE)]
        }

        fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
            self.0.add("next_mode");
            Mode::SlipRight
        }

        fn compliance(&self, _: Mode, _: &PreviousContact) -> [f64; 2] {
            self.0.add("compliance");
            [MARKER_VALUE; 2]
        }

        fn state_variables(&self) -> usize {
            self.0.add("state_variables");
            3
        }

        fn initial_state_variables(&self, _: &PreviousContact, variables: &mut [f64]) {
            self.0.add("initial_state_variables");
            variables.fill(MARKER_VALUE);
        }

        fn commit(&self, _: &PreviousContact, _: &ContactState, _: Mode, variables: &mut [f64]) {
            self.0.add("commit");
            variables.fill(2.0 * MARKER_VALUE);
        }

        fn friction_coefficient(&self) -> Option<f64> {
            self.0.add("friction_coefficient");
            Some(MARKER_VALUE)
        }

        fn bond_overload(&self, _: &PreviousContact, _: &ContactState) -> Option<f64> {
            self.0.add("bond_overload");
            Some(MARKER_VALUE)
        }

        fn check_start(&self, _: &PreviousContact) -> Result<()> {
            self.0.add("check_start");
            Err(part_error())
        }

        fn frictionless(&self) -> Box<dyn InterfaceLaw> {
            self.0.add("frictionless");
            Box::new(InPlane(AlwaysSlips(Coulomb::uplift_only())))
        }

        fn check(&self, _: &ContactScene) -> Result<()> {
            self.0.add("check");
            Err(part_error())
        }
    };
}

impl InterfaceLaw for RecordingPart {
    common_methods!();

    fn limits(&self, _: &PreviousContact) -> Result<Limits> {
        self.0.add("limits");
        Ok(Limits { tension: MARKER_VALUE, ..Limits::default() })
    }
}

impl PlaneLaw for RecordingPart {
    common_methods!();
}

/// Frictionless contact whose only mode is not the first one of the default.
struct AlwaysSlips(Coulomb);

impl PlaneLaw for AlwaysSlips {
    fn modes(&self) -> &[Mode] {
        &[Mode::SlipRight]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.0.conditions(mode, start)
    }

    fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
        Mode::SlipRight
    }
}
