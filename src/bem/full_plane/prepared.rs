//! A full-plane ground between two steps.

use super::convolution::BoundaryHistory;
use super::{Boundary, BoundaryKernel, IncidentField};
use crate::error::{Error, Result, same_length};
use crate::geometry::{COMPONENTS, ContactLayout};
use crate::linalg::{DenseFactor, dense_multiply_add};

/// Convolutions and operators for one time step.
pub(super) struct Prepared {
    pub(super) history: BoundaryHistory,
    time_step: f64,
    /// H⁰.
    factor: DenseFactor,
    /// G⁰, where an incident field loads the boundary.
    first: Vec<f64>,
    /// Displacement of every element per contact traction: 2Q columns of 2E.
    pub(super) mobility: Vec<f64>,
    /// Displacements at the end of the next step without tractions of that step on the contact.
    pub(super) free: Vec<f64>,
    /// Whether `free` belongs to the next step.
    current: bool,
    pub(super) displacement: Vec<f64>,
    /// Tractions that the incident field leaves for the scattered one to take away.
    scattering: Vec<f64>,
    traction: Vec<f64>,
}

/// Where component `k` of a contact vector (2Q, down first) is in vectors of the boundary
/// (2E, x first).
pub(super) fn component(contact: &[usize], boundary: ContactLayout, k: usize) -> usize {
    let [component, element] = ContactLayout::new(contact.len()).origin(k);
    boundary.place(1 - component, contact[element])
}

impl Prepared {
    pub(super) fn new(
        boundary: &Boundary,
        kernel: Box<dyn BoundaryKernel>,
        time_step: f64,
        incident: bool,
    ) -> Result<Self> {
        let (count, contact) = (boundary.segments().len(), boundary.contact());
        same_length("elements of the boundary kernel", kernel.segments().len(), count)?;
        let layout = ContactLayout::new(count);
        let size = layout.len();
        let (mut g, mut h) = (vec![0.0; layout.square()], vec![0.0; layout.square()]);
        kernel.coefficients(0, &mut g, &mut h)?;
        let mut factor = DenseFactor::with_capacity(size);
        if !factor.factor(&h, size) {
            return Err(Error::Singular { matrix: "boundary operator", order: size });
        }
        let mut mobility = vec![0.0; ContactLayout::new(contact.len()).len() * size];
        let mut loaded = vec![incident; size];
        for (k, column) in mobility.chunks_exact_mut(size).enumerate() {
            let source = component(contact, layout, k);
            loaded[source] = true;
            for (i, value) in column.iter_mut().enumerate() {
                *value = g[i * size + source];
            }
            factor.solve(column);
        }
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

    /// Makes `free` the one of the next step.
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

    pub(super) fn commit(&mut self, contact: &[usize], traction: &[f64]) {
        let size = self.displacement.len();
        let layout = ContactLayout::new(size / COMPONENTS);
        self.displacement.copy_from_slice(&self.free);
        self.traction.copy_from_slice(&self.scattering);
        for (k, column) in self.mobility.chunks_exact(size).enumerate() {
            let value = traction.get(k).copied().unwrap_or(0.0);
            self.traction[component(contact, layout, k)] += value;
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
    let [along, down] = ContactLayout::new(boundary.segments().len()).split_mut(out);
    for ((segment, x), z) in boundary.segments().iter().zip(along).zip(down) {
        let [xx, zz, xz] = field.stress(segment.center(), time);
        let n = segment.normal();
        *x = -(xx * n[0] + xz * n[1]);
        *z = -(xz * n[0] + zz * n[1]);
    }
}
