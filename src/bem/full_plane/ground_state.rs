//! State of a full-plane ground between two steps.

use super::boundary::ContactCompliance;
use super::convolution::BoundaryHistory;
use super::{Boundary, BoundaryKernel, IncidentField};
use crate::error::{Result, same_length};
use crate::linalg::dense_multiply_add;

/// Convolutions and operators of a boundary for a fixed time-step length.
pub(super) struct PreparedBoundary {
    pub(super) history: BoundaryHistory,
    /// Time step, s.
    time_step: f64,
    /// Weight matrix G⁰ (m/Pa); empty without an incident field.
    g0: Vec<f64>,
    /// Displacements of all elements due to unit tractions on the contact elements.
    pub(super) contact_compliance: ContactCompliance,
    /// Displacements at the end of the next step without contact tractions, m.
    pub(super) history_displacement: Vec<f64>,
    /// Whether `history_displacement` belongs to the next step.
    is_history_current: bool,
    /// Displacements at the end of the last step, relative to the incident field, m.
    pub(super) displacement: Vec<f64>,
    /// Tractions of the scattered field, which cancel those of the incident field, Pa.
    scattered_traction: Vec<f64>,
    /// Total tractions of the last step, Pa.
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
        let mut g = vec![0.0; layout.matrix_len()];
        let mut h = vec![0.0; layout.matrix_len()];
        kernel.coefficients(0, &mut g, &mut h)?;
        let contact_compliance = boundary.contact_compliance(&g, &h)?;
        let mut has_traction = vec![has_incident_field; order];
        for row in boundary.contact_rows() {
            has_traction[row] = true;
        }
        Ok(Self {
            history: BoundaryHistory::new(kernel, &has_traction),
            time_step,
            g0: if has_incident_field { g } else { Vec::new() },
            contact_compliance,
            history_displacement: vec![0.0; order],
            is_history_current: false,
            displacement: vec![0.0; order],
            scattered_traction: vec![0.0; order],
            traction: vec![0.0; order],
        })
    }

    /// Computes `history_displacement` for the next step.
    pub(super) fn update_history_displacement(
        &mut self,
        boundary: &Boundary,
        incident: Option<&dyn IncidentField>,
    ) -> Result<()> {
        if self.is_history_current {
            return Ok(());
        }
        self.history.evaluate(&mut self.history_displacement)?;
        if let Some(field) = incident {
            // Tractions are constant over a step: use its midpoint.
            let time = (self.history.steps() as f64 + 0.5) * self.time_step;
            fill_scattered_traction(boundary, field, time, &mut self.scattered_traction);
            let displacement = &mut self.history_displacement;
            dense_multiply_add(&self.g0, 1.0, &self.scattered_traction, displacement);
        }
        self.contact_compliance.factor.solve(&mut self.history_displacement);
        self.is_history_current = true;
        Ok(())
    }

    /// Accepts the contact tractions (2Q, Pa) of a step.
    pub(super) fn commit(&mut self, boundary: &Boundary, traction: &[f64]) {
        self.displacement.copy_from_slice(&self.history_displacement);
        self.traction.copy_from_slice(&self.scattered_traction);
        let columns = self.contact_compliance.columns.chunks_exact(self.displacement.len());
        for (k, (column, row)) in columns.zip(boundary.contact_rows()).enumerate() {
            let contact_traction = traction.get(k).copied().unwrap_or(0.0);
            self.traction[row] += contact_traction;
            for (u, m) in self.displacement.iter_mut().zip(column) {
                *u += m * contact_traction;
            }
        }
        self.history.push(&self.displacement, &self.traction);
        self.is_history_current = false;
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
        tractions[layout.index_of(0, element)] = -(stress[0] * n[0] + stress[2] * n[1]);
        tractions[layout.index_of(1, element)] = -(stress[2] * n[0] + stress[1] * n[1]);
    }
}
