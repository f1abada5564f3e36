//! State of a full-plane ground between two steps.

use super::boundary::Mobility;
use super::convolution::BoundaryHistory;
use super::{Boundary, BoundaryKernel, IncidentField};
use crate::error::{Result, same_length};
use crate::linalg::dense_multiply_add;

/// Convolutions and operators of a boundary for one time step.
pub(super) struct PreparedBoundary {
    pub(super) history: BoundaryHistory,
    time_step: f64,
    /// G⁰; empty without an incident field.
    g0: Vec<f64>,
    /// Displacements of all elements due to unit tractions on the contact elements.
    pub(super) mobility: Mobility,
    /// Displacements at the end of the next step if the contact tractions of that step are zero.
    pub(super) history_displacement: Vec<f64>,
    /// Whether `history_displacement` belongs to the next step.
    is_advanced: bool,
    pub(super) displacement: Vec<f64>,
    /// Tractions of the scattered field, which cancel those of the incident field.
    scattered_traction: Vec<f64>,
    traction: Vec<f64>,
}

impl PreparedBoundary {
    /// Boundary at rest.
    pub(super) fn new(
        boundary: &Boundary,
        kernel: Box<dyn BoundaryKernel>,
        time_step: f64,
        has_incident_field: bool,
    ) -> Result<Self> {
        let segment_count = boundary.segments().len();
        let layout = boundary.layout();
        same_length("elements of the boundary kernel", kernel.segments().len(), segment_count)?;
        let order = layout.len();
        let mut g = vec![0.0; layout.square()];
        let mut h = vec![0.0; layout.square()];
        kernel.coefficients(0, &mut g, &mut h)?;
        let mobility = boundary.mobility(&g, &h)?;
        let mut loaded = vec![has_incident_field; order];
        for row in boundary.contact_rows() {
            loaded[row] = true;
        }
        Ok(Self {
            history: BoundaryHistory::new(kernel, &loaded),
            time_step,
            g0: if has_incident_field { g } else { Vec::new() },
            mobility,
            history_displacement: vec![0.0; order],
            is_advanced: false,
            displacement: vec![0.0; order],
            scattered_traction: vec![0.0; order],
            traction: vec![0.0; order],
        })
    }

    /// Computes `history_displacement` for the next step.
    pub(super) fn advance(
        &mut self,
        boundary: &Boundary,
        incident: Option<&dyn IncidentField>,
    ) -> Result<()> {
        if self.is_advanced {
            return Ok(());
        }
        self.history.evaluate(&mut self.history_displacement)?;
        if let Some(field) = incident {
            let time = (self.history.steps() as f64 + 0.5) * self.time_step;
            fill_scattered_traction(boundary, field, time, &mut self.scattered_traction);
            let displacement = &mut self.history_displacement;
            dense_multiply_add(&self.g0, 1.0, &self.scattered_traction, displacement);
        }
        self.mobility.factor.solve(&mut self.history_displacement);
        self.is_advanced = true;
        Ok(())
    }

    /// Accepts the contact tractions (2Q, Pa) of a step.
    pub(super) fn commit(&mut self, boundary: &Boundary, traction: &[f64]) {
        self.displacement.copy_from_slice(&self.history_displacement);
        self.traction.copy_from_slice(&self.scattered_traction);
        let columns = self.mobility.columns.chunks_exact(self.displacement.len());
        for (k, (column, row)) in columns.zip(boundary.contact_rows()).enumerate() {
            let value = traction.get(k).copied().unwrap_or(0.0);
            self.traction[row] += value;
            for (u, m) in self.displacement.iter_mut().zip(column) {
                *u += m * value;
            }
        }
        self.history.push(&self.displacement, &self.traction);
        self.is_advanced = false;
    }
}

/// Overwrites `tractions` with minus the tractions of the incident field at the midpoints.
fn fill_scattered_traction(
    boundary: &Boundary,
    field: &dyn IncidentField,
    time: f64,
    tractions: &mut [f64],
) {
    let layout = boundary.layout();
    for (element, segment) in boundary.segments().iter().enumerate() {
        // σ_xx, σ_zz, σ_xz.
        let stress = field.stress(segment.center(), time);
        let n = segment.normal();
        tractions[layout.place(0, element)] = -(stress[0] * n[0] + stress[2] * n[1]);
        tractions[layout.place(1, element)] = -(stress[2] * n[0] + stress[1] * n[1]);
    }
}
