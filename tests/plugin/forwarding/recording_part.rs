//! A part that records the calls of its methods, as a spring, a law, a ground and a history.

use basemat::bem::{ContactElement, DiagonalCompliance, Ground, GroundDescription};
use basemat::history::ConvolutionHistory;
use basemat::interface::{
    Condition, ContactScene, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PreviousContact,
    Tolerance,
};
use basemat::motion::FreeField;
use basemat::structure::{Hysteresis, InternalEnergy, SpringResponse};
use basemat::{Error, Observer, Result, Soil};

use super::log::CallLog;

/// A number that no default of a trait returns.
pub(crate) const MARKER_VALUE: f64 = 0.625;

/// The error that a recording part returns.
pub(crate) fn refusal() -> Error {
    Error::part("recording part", "refuses")
}

pub(crate) fn soil() -> Soil {
    Soil::new(MARKER_VALUE, MARKER_VALUE / 2.0, MARKER_VALUE).unwrap()
}

pub(crate) fn previous_contact() -> PreviousContact<'static> {
    PreviousContact::new(ContactState::default(), Mode::Stick, 0.01)
}

pub(crate) fn tolerance() -> Tolerance {
    Tolerance::new(1e-9, 1e-3)
}

/// Implements every trait, records the calls and returns the marker value.
pub(crate) struct RecordingPart(pub(super) CallLog);

impl RecordingPart {
    pub(crate) fn new(log: &CallLog) -> Self {
        Self(log.clone())
    }
}

impl Hysteresis for RecordingPart {
    fn response(&self, deformation: f64) -> SpringResponse {
        self.0.add("response");
        SpringResponse { force: deformation * MARKER_VALUE, tangent: MARKER_VALUE }
    }

    fn energy(&self, deformation: f64) -> InternalEnergy {
        self.0.add("energy");
        InternalEnergy { stored: deformation * MARKER_VALUE, dissipated: 0.0 }
    }

    fn commit(&mut self, _: f64) {
        self.0.add("commit");
    }

    fn save(&self) -> Vec<f64> {
        self.0.add("save");
        vec![MARKER_VALUE]
    }

    fn restore(&mut self, _: &[f64]) -> Result<()> {
        self.0.add("restore");
        Err(refusal())
    }

    fn clone_box(&self) -> Box<dyn Hysteresis> {
        self.0.add("clone_box");
        Box::new(Self(self.0.clone()))
    }
}

impl InterfaceLaw for RecordingPart {
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

    fn limits(&self, _: &PreviousContact) -> Result<Limits> {
        self.0.add("limits");
        Ok(Limits { tension: MARKER_VALUE, ..Limits::default() })
    }

    fn bond_overload(&self, _: &PreviousContact, _: &ContactState) -> Option<f64> {
        self.0.add("bond_overload");
        Some(MARKER_VALUE)
    }

    fn check_start(&self, _: &PreviousContact) -> Result<()> {
        self.0.add("check_start");
        Err(refusal())
    }

    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        self.0.add("frictionless");
        Box::new(AlwaysSlips(Coulomb::uplift_only()))
    }

    fn check(&self, _: &ContactScene) -> Result<()> {
        self.0.add("check");
        Err(refusal())
    }
}

/// Smooth contact whose only closed mode is another one than the default's first.
struct AlwaysSlips(Coulomb);

impl InterfaceLaw for AlwaysSlips {
    fn limits(&self, _: &PreviousContact) -> Result<Limits> {
        Limits::only_in_plane::<Self>()
    }

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

impl Ground for RecordingPart {
    fn elements(&self) -> &[ContactElement] {
        self.0.add("elements");
        &[const { ContactElement::new(0.0, 1.0) }]
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.0.add("prepare");
        Err(refusal())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.0.add("step_compliance");
        matrix.fill(MARKER_VALUE);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        self.0.add("history");
        displacement.fill(2.0 * MARKER_VALUE);
        Ok(())
    }

    fn commit(&mut self, _: &[f64]) {
        self.0.add("commit");
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.0.add("static_compliance");
        matrix.fill(3.0 * MARKER_VALUE);
        Ok(())
    }

    fn diagonal_compliance(&self) -> Result<Option<DiagonalCompliance>> {
        self.0.add("diagonal_compliance");
        Ok(Some(DiagonalCompliance { in_step: vec![MARKER_VALUE], at_rest: vec![] }))
    }

    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        self.0.add("finer_compliance");
        Ok(Some(vec![MARKER_VALUE]))
    }

    fn description(&self) -> GroundDescription {
        self.0.add("description");
        GroundDescription { soils: vec![soil()], ..Default::default() }
    }

    fn increment_error_bound(&self) -> f64 {
        self.0.add("increment_error_bound");
        MARKER_VALUE
    }

    fn save(&self) -> Result<Vec<f64>> {
        self.0.add("save");
        Ok(vec![MARKER_VALUE])
    }

    fn restore(&mut self, _: usize, _: &[f64]) -> Result<()> {
        self.0.add("restore");
        Err(refusal())
    }

    fn free_field(&self, _: &dyn FreeField, _: f64, displacement: &mut [f64]) {
        self.0.add("free_field");
        displacement.fill(4.0 * MARKER_VALUE);
    }
}

impl ConvolutionHistory for RecordingPart {
    fn steps(&self) -> usize {
        self.0.add("steps");
        7
    }

    fn memory(&self) -> usize {
        self.0.add("memory");
        5
    }

    fn prepare(&mut self, _: usize, _: &mut Observer<'_>) -> Result<()> {
        self.0.add("prepare");
        Err(refusal())
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        self.0.add("evaluate");
        displacement.fill(MARKER_VALUE);
        Ok(())
    }

    fn push(&mut self, _: &[f64]) {
        self.0.add("push");
    }

    fn increment_error_bound(&self) -> f64 {
        self.0.add("increment_error_bound");
        MARKER_VALUE
    }

    fn save(&self) -> Result<Vec<f64>> {
        self.0.add("save");
        Ok(vec![MARKER_VALUE])
    }

    fn restore(&mut self, _: usize, _: &[f64]) -> Result<()> {
        self.0.add("restore");
        Err(refusal())
    }
}
