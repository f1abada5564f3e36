//! The recording part as a free field, an incident field, a scheme, an element, a kernel and a format.

use basemat::Result;
use basemat::bem::ContactElement;
use basemat::bem::full_plane::{BoundaryKernel, IncidentField, Segment};
use basemat::coupled::{Midpoint, SchemeCoefficients, TimeScheme};
use basemat::fem::{Direction, Element, ElementFace, InelasticForce, MassKind, StressAtRest};
use basemat::motion::{FreeField, Record, RecordFormat};

use super::recording_part::{MARKER_VALUE, RecordingPart, part_error};

impl FreeField for RecordingPart {
    fn displacement(&self, x: f64, _: f64) -> [f64; 2] {
        self.0.add("displacement");
        [x, MARKER_VALUE]
    }

    fn displacement_at(&self, [x, y]: [f64; 2], _: f64) -> [f64; 3] {
        self.0.add("displacement_at");
        [x, y, MARKER_VALUE]
    }

    fn at_faces(
        &self,
        _: &[ContactElement],
        time: f64,
        displacement: &mut [f64],
        impulse: &mut [f64],
    ) -> bool {
        self.0.add("at_faces");
        displacement.fill(time);
        impulse.fill(MARKER_VALUE);
        true
    }

    fn elements(&self) -> Option<&[ContactElement]> {
        self.0.add("elements");
        Some(&[])
    }

    fn soils(&self) -> Option<&[f64]> {
        self.0.add("soils");
        Some(&[MARKER_VALUE])
    }

    fn moves_across(&self) -> bool {
        self.0.add("moves_across");
        true
    }

    fn records(&self) -> Vec<&Record> {
        self.0.add("records");
        Vec::new()
    }

    fn velocity(&self, x: f64, _: f64) -> [f64; 2] {
        self.0.add("velocity");
        [MARKER_VALUE, x]
    }
}

impl IncidentField for RecordingPart {
    fn displacement(&self, point: [f64; 2], _: f64) -> [f64; 2] {
        self.0.add("displacement");
        [point[0], MARKER_VALUE]
    }

    fn stress(&self, point: [f64; 2], _: f64) -> [f64; 3] {
        self.0.add("stress");
        [MARKER_VALUE, point[0], point[1]]
    }
}

impl TimeScheme for RecordingPart {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        self.0.add("coefficients");
        SchemeCoefficients { load_fraction: time_step, ..Midpoint.coefficients(time_step) }
    }
}

impl Element for RecordingPart {
    fn nodes(&self) -> &[usize] {
        self.0.add("nodes");
        &[5]
    }

    fn directions(&self) -> &[Direction] {
        self.0.add("directions");
        &[Direction::X, Direction::Y]
    }

    fn stiffness(&self, _: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.add("stiffness");
        matrix[0] += MARKER_VALUE;
    }

    fn geometric_stiffness(&self, _: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.add("geometric_stiffness");
        matrix[0] += 4.0 * MARKER_VALUE;
    }

    fn in_static_state(&self, _: &[[f64; 3]], _: &[f64], _: f64) -> Option<Box<dyn Element>> {
        self.0.add("in_static_state");
        Some(Box::new(RecordingPart(self.0.clone())))
    }

    fn inelastic(&self) -> Option<&dyn InelasticForce> {
        self.0.add("inelastic");
        None
    }

    fn has_stiffness_damping(&self) -> bool {
        self.0.add("has_stiffness_damping");
        false
    }

    fn with_stress_at_rest(&self, _: &StressAtRest) -> Option<Box<dyn Element>> {
        self.0.add("with_stress_at_rest");
        Some(Box::new(RecordingPart(self.0.clone())))
    }

    fn is_at_rest(&self) -> bool {
        self.0.add("is_at_rest");
        true
    }

    fn compression(&self) -> Option<f64> {
        self.0.add("compression");
        Some(MARKER_VALUE)
    }

    fn density(&self) -> Option<f64> {
        self.0.add("density");
        Some(MARKER_VALUE)
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        self.0.add("with_nodes");
        (nodes == [6]).then(|| Box::new(Self(self.0.clone())) as Box<dyn Element>)
    }

    fn mass(&self, _: &[[f64; 3]], _: MassKind, matrix: &mut [f64]) {
        self.0.add("mass");
        matrix[0] += 2.0 * MARKER_VALUE;
    }

    fn damping(&self, _: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.add("damping");
        matrix[0] += 3.0 * MARKER_VALUE;
    }

    fn faces(&self) -> Vec<ElementFace> {
        self.0.add("faces");
        vec![ElementFace::side(&[7])]
    }

    fn is_plane(&self) -> bool {
        self.0.add("is_plane");
        false
    }

    fn check(&self, _: &[[f64; 3]]) -> Result<()> {
        self.0.add("check");
        Err(part_error())
    }

    fn order(&self) -> usize {
        self.0.add("order");
        11
    }
}

impl BoundaryKernel for RecordingPart {
    fn segments(&self) -> &[Segment] {
        self.0.add("segments");
        &[]
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        self.0.add("coefficients");
        g.fill(lag as f64);
        h.fill(MARKER_VALUE);
        Ok(())
    }

    fn symbol(&self, _: [f64; 2], _: &mut [f64], _: &mut [f64]) -> Result<Option<[f64; 2]>> {
        self.0.add("symbol");
        Ok(Some([MARKER_VALUE; 2]))
    }
}

impl RecordFormat for RecordingPart {
    fn parse(&self, _: &str, _: &mut dyn std::io::Read) -> Result<Record> {
        self.0.add("parse");
        Err(part_error())
    }

    fn parse_all(&self, _: &str, _: &mut dyn std::io::Read) -> Result<Vec<(String, Record)>> {
        self.0.add("parse_all");
        Err(part_error())
    }
}
