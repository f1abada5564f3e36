//! A part that records the calls of its methods, as a spring, a ground and a history.

use basemat::bem::{ContactElement, DiagonalCompliance, Ground, GroundDescription};
use basemat::history::ConvolutionHistory;
use basemat::interface::{ContactState, Mode, PreviousContact, Tolerance};
use basemat::motion::FreeField;
use basemat::structure::{Hysteresis, InternalEnergy, SpringResponse};
use basemat::{Error, Observer, Result, Soil};

use super::log::CallLog;

/// A number that no default of a trait returns.
pub(crate) const MARKER_VALUE: f64 = 0.625;

/// The error that a recording part returns.
pub(crate) fn part_error() -> Error {
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
        Err(part_error())
    }

    fn clone_box(&self) -> Box<dyn Hysteresis> {
        self.0.add("clone_box");
        Box::new(Self(self.0.clone()))
    }
}

impl Ground for RecordingPart {
    fn elements(&self) -> &[ContactElement] {
        self.0.add("elements");
        &[const { ContactElement::new(0.0, 1.0) }]
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.0.add("prepare");
        Err(part_error())
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
        Err(part_error())
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
        Err(part_error())
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
        Err(part_error())
    }
}
