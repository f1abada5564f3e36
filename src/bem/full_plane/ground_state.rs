//! State of a full-plane ground between two steps.

use super::convolution::BoundaryHistory;
use super::{Boundary, BoundaryKernel, IncidentField};
use crate::error::{Result, same_length};
use crate::linalg::{DenseFactor, dense_multiply_add};

/// Convolutions and operators for one time step.
pub(super) struct Prepared {
    pub(super) history: BoundaryHistory,
    time_step: f64,
    /// H⁰.
    factor: DenseFactor,
    /// G⁰, where an incident field loads the boundary.
    first: Vec<f64>,
    /// Displacement of every element due to a unit traction on each contact component: 2Q columns of length
    /// 2E.
    pub(super) mobility: Vec<f64>,
    /// Displacements at the end of the next step if the contact tractions of that step are zero.
    pub(super) free: Vec<f64>,
    /// Whether `free` belongs to the next step.
    current: bool,
    pub(super) displacement: Vec<f64>,
    /// Tractions that cancel the tractions of the incident field, applied by the scattered field.
    scattering: Vec<f64>,
    traction: Vec<f64>,
}

impl Prepared {
    pub(super) fn new(
        boundary: &Boundary,
        kernel: Box<dyn BoundaryKernel>,
        time_step: f64,
        incident: bool,
    ) -> Result<Self> {
        let count = boundary.segments().len();
        let layout = boundary.layout();
        same_length("elements of the boundary kernel", kernel.segments().len(), count)?;
        let size = layout.len();
        let mut g = vec![0.0; layout.square()];
        let mut h = vec![0.0; layout.square()];
        kernel.coefficients(0, &mut g, &mut h)?;
        let (factor, mobility) = boundary.mobility(&g, &h)?;
        let mut loaded = vec![incident; size];
        boundary.places().for_each(|place| loaded[place] = true);
        Ok(Self {
            history: BoundaryHistory::new(kernel, &loaded),
            time_step,
            factor,
            first: if incident { g } else { Vec::new() },
            mobility,
            free: vec![0.0; size],
            current: false,
            displacement: vec![0.0; size],
            scattering: vec![0.0; size],
            traction: vec![0.0; size],
        })
    }

    /// Computes `free` for the next step.
    pub(super) fn advance(
        &mut self,
        boundary: &Boundary,
        incident: Option<&dyn IncidentField>,
    ) -> Result<()> {
        if self.current {
            return Ok(());
        }
        self.history.evaluate(&mut self.free)?;
        if let Some(field) = incident {
            let time = (self.history.steps() as f64 + 0.5) * self.time_step;
            scattering(boundary, field, time, &mut self.scattering);
            dense_multiply_add(&self.first, 1.0, &self.scattering, &mut self.free);
        }
        self.factor.solve(&mut self.free);
        self.current = true;
        Ok(())
    }

    pub(super) fn commit(&mut self, boundary: &Boundary, traction: &[f64]) {
        self.displacement.copy_from_slice(&self.free);
        self.traction.copy_from_slice(&self.scattering);
        let columns = self.mobility.chunks_exact(self.displacement.len()).zip(boundary.places());
        for (k, (column, place)) in columns.enumerate() {
            let value = traction.get(k).copied().unwrap_or(0.0);
            self.traction[place] += value;
            for (u, m) in self.displacement.iter_mut().zip(column) {
                *u += m * value;
            }
        }
        self.history.push(&self.displacement, &self.traction);
        self.current = false;
    }
}

/// Minus the tractions of the incident field at the midpoints.
fn scattering(boundary: &Boundary, field: &dyn IncidentField, time: f64, out: &mut [f64]) {
    let [along, down] = boundary.layout().split_mut(out);
    for ((segment, x), z) in boundary.segments().iter().zip(along).zip(down) {
        let [xx, zz, xz] = field.stress(segment.center(), time);
        let n = segment.normal();
        *x = -(xx * n[0] + xz * n[1]);
        *z = -(xz * n[0] + zz * n[1]);
    }
}
