//! One double for all traits but the structure's.

use basemat::bem::full_plane::{BoundaryKernel, IncidentField, Segment};
use basemat::bem::{ContactElement, DiagonalCompliance, Ground, GroundDescription};
use basemat::coupled::{Midpoint, SchemeCoefficients, TimeScheme};
use basemat::fem::{Direction, Element, ElementFace, MassKind};
use basemat::history::ConvolutionHistory;
use basemat::interface::{ContactState, Mode, PreviousContact, Tolerance};
use basemat::motion::{FreeField, Record, RecordFormat};
use basemat::structure::{Hysteresis, InternalEnergy, SpringResponse};
use basemat::{Error, Observer, Result, Soil};

use super::log::Log;

/// A number that no default returns.
pub(crate) const CORRECT: f64 = 0.625;

/// An error of the double's own.
pub(crate) fn refusal() -> Error {
    Error::part("double", "refuses")
}

pub(crate) fn soil() -> Soil {
    Soil::new(CORRECT, CORRECT / 2.0, CORRECT).unwrap()
}

pub(crate) fn start() -> PreviousContact<'static> {
    PreviousContact::new(ContactState::default(), Mode::Stick, 0.01)
}

pub(crate) fn tolerance() -> Tolerance {
    Tolerance::new(1e-9, 1e-3)
}

pub(crate) struct Double(pub(super) Log);

impl Double {
    pub(crate) fn new(log: &Log) -> Self {
        Self(log.clone())
    }
}

impl Hysteresis for Double {
    fn response(&self, deformation: f64) -> SpringResponse {
        self.0.asked("response");
        SpringResponse { force: deformation * CORRECT, tangent: CORRECT }
    }

    fn energy(&self, deformation: f64) -> InternalEnergy {
        self.0.asked("energy");
        InternalEnergy { stored: deformation * CORRECT, dissipated: 0.0 }
    }

    fn commit(&mut self, _: f64) {
        self.0.asked("commit");
    }

    fn save(&self) -> Vec<f64> {
        self.0.asked("save");
        vec![CORRECT]
    }

    fn restore(&mut self, _: &[f64]) -> Result<()> {
        self.0.asked("restore");
        Err(refusal())
    }

    fn clone_box(&self) -> Box<dyn Hysteresis> {
        self.0.asked("clone_box");
        Box::new(Self(self.0.clone()))
    }
}

impl Ground for Double {
    fn elements(&self) -> &[ContactElement] {
        self.0.asked("elements");
        &[const { ContactElement::new(0.0, 1.0) }]
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.0.asked("prepare");
        Err(refusal())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.0.asked("step_compliance");
        matrix.fill(CORRECT);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        self.0.asked("history");
        displacement.fill(2.0 * CORRECT);
        Ok(())
    }

    fn commit(&mut self, _: &[f64]) {
        self.0.asked("commit");
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.0.asked("static_compliance");
        matrix.fill(3.0 * CORRECT);
        Ok(())
    }

    fn diagonal_compliance(&self) -> Result<Option<DiagonalCompliance>> {
        self.0.asked("diagonal_compliance");
        Ok(Some(DiagonalCompliance { in_step: vec![CORRECT], at_rest: vec![] }))
    }

    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        self.0.asked("finer_compliance");
        Ok(Some(vec![CORRECT]))
    }

    fn description(&self) -> GroundDescription {
        self.0.asked("description");
        GroundDescription { soils: vec![soil()], ..Default::default() }
    }

    fn increment_error_bound(&self) -> f64 {
        self.0.asked("increment_error_bound");
        CORRECT
    }

    fn save(&self) -> Result<Vec<f64>> {
        self.0.asked("save");
        Ok(vec![CORRECT])
    }

    fn restore(&mut self, _: usize, _: &[f64]) -> Result<()> {
        self.0.asked("restore");
        Err(refusal())
    }

    fn free_field(&self, _: &dyn FreeField, _: f64, displacement: &mut [f64]) {
        self.0.asked("free_field");
        displacement.fill(4.0 * CORRECT);
    }
}

impl FreeField for Double {
    fn displacement(&self, x: f64, _: f64) -> [f64; 2] {
        self.0.asked("displacement");
        [x, CORRECT]
    }

    fn displacement_at(&self, [x, y]: [f64; 2], _: f64) -> [f64; 3] {
        self.0.asked("displacement_at");
        [x, y, CORRECT]
    }

    fn at_faces(
        &self,
        _: &[ContactElement],
        time: f64,
        displacement: &mut [f64],
        impulse: &mut [f64],
    ) -> bool {
        self.0.asked("at_faces");
        displacement.fill(time);
        impulse.fill(CORRECT);
        true
    }

    fn soils(&self) -> Option<&[f64]> {
        self.0.asked("soils");
        Some(&[CORRECT])
    }

    fn moves_across(&self) -> bool {
        self.0.asked("moves_across");
        true
    }

    fn records(&self) -> Vec<&Record> {
        self.0.asked("records");
        Vec::new()
    }

    fn velocity(&self, x: f64, _: f64) -> [f64; 2] {
        self.0.asked("velocity");
        [CORRECT, x]
    }
}

impl IncidentField for Double {
    fn displacement(&self, point: [f64; 2], _: f64) -> [f64; 2] {
        self.0.asked("displacement");
        [point[0], CORRECT]
    }

    fn stress(&self, point: [f64; 2], _: f64) -> [f64; 3] {
        self.0.asked("stress");
        [CORRECT, point[0], point[1]]
    }
}

impl ConvolutionHistory for Double {
    fn steps(&self) -> usize {
        self.0.asked("steps");
        7
    }

    fn memory(&self) -> usize {
        self.0.asked("memory");
        5
    }

    fn prepare(&mut self, _: usize, _: &mut Observer<'_>) -> Result<()> {
        self.0.asked("prepare");
        Err(refusal())
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        self.0.asked("evaluate");
        displacement.fill(CORRECT);
        Ok(())
    }

    fn push(&mut self, _: &[f64]) {
        self.0.asked("push");
    }

    fn increment_error_bound(&self) -> f64 {
        self.0.asked("increment_error_bound");
        CORRECT
    }

    fn save(&self) -> Result<Vec<f64>> {
        self.0.asked("save");
        Ok(vec![CORRECT])
    }

    fn restore(&mut self, _: usize, _: &[f64]) -> Result<()> {
        self.0.asked("restore");
        Err(refusal())
    }
}

impl TimeScheme for Double {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        self.0.asked("coefficients");
        SchemeCoefficients { load_fraction: time_step, ..Midpoint.coefficients(time_step) }
    }
}

impl Element for Double {
    fn nodes(&self) -> &[usize] {
        self.0.asked("nodes");
        &[5]
    }

    fn directions(&self) -> &[Direction] {
        self.0.asked("directions");
        &[Direction::X, Direction::Y]
    }

    fn stiffness(&self, _: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.asked("stiffness");
        matrix[0] += CORRECT;
    }

    fn geometric_stiffness(&self, _: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.asked("geometric_stiffness");
        matrix[0] += 4.0 * CORRECT;
    }

    fn in_static_state(&self, _: &[[f64; 3]], _: &[f64], _: f64) -> Option<Box<dyn Element>> {
        self.0.asked("in_static_state");
        Some(Box::new(Double(self.0.clone())))
    }

    fn compression(&self) -> Option<f64> {
        self.0.asked("compression");
        Some(CORRECT)
    }

    fn density(&self) -> Option<f64> {
        self.0.asked("density");
        Some(CORRECT)
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        self.0.asked("with_nodes");
        (nodes == [6]).then(|| Box::new(Self(self.0.clone())) as Box<dyn Element>)
    }

    fn mass(&self, _: &[[f64; 3]], _: MassKind, matrix: &mut [f64]) {
        self.0.asked("mass");
        matrix[0] += 2.0 * CORRECT;
    }

    fn damping(&self, _: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.asked("damping");
        matrix[0] += 3.0 * CORRECT;
    }

    fn faces(&self) -> Vec<ElementFace> {
        self.0.asked("faces");
        vec![ElementFace::side(&[7])]
    }

    fn is_plane(&self) -> bool {
        self.0.asked("is_plane");
        false
    }

    fn check(&self, _: &[[f64; 3]]) -> Result<()> {
        self.0.asked("check");
        Err(refusal())
    }

    fn order(&self) -> usize {
        self.0.asked("order");
        11
    }
}

impl BoundaryKernel for Double {
    fn segments(&self) -> &[Segment] {
        self.0.asked("segments");
        &[]
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        self.0.asked("coefficients");
        g.fill(lag as f64);
        h.fill(CORRECT);
        Ok(())
    }

    fn symbol(&self, _: [f64; 2], _: &mut [f64], _: &mut [f64]) -> Result<Option<[f64; 2]>> {
        self.0.asked("symbol");
        Ok(Some([CORRECT; 2]))
    }
}

impl RecordFormat for Double {
    fn parse(&self, _: &str, _: &mut dyn std::io::Read) -> Result<Record> {
        self.0.asked("parse");
        Err(refusal())
    }

    fn parse_all(&self, _: &str, _: &mut dyn std::io::Read) -> Result<Vec<(String, Record)>> {
        self.0.asked("parse_all");
        Err(refusal())
    }
}
