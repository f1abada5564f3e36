//! Responses of the base of a large yielding structure to unit tractions.
//!
//! The contact problem needs B K_eff⁻¹ BᵀA only. If the base is eliminated last, this matrix follows from a small dense
//! factor. The response to the tractions of the contact problem then needs one more solution with K_eff.

use crate::coupled::base::PlacedBase;
use crate::linalg::ChangingFactor;

/// Smallest number of degrees of freedom for which the base is eliminated last.
///
/// With fewer, all responses to unit tractions take little time.
pub(super) const MIN_BASE_LAST_DOFS: usize = 400;

/// Forces and mean displacements of the elements of a base, on its degrees of freedom.
pub(super) struct BaseResponses {
    /// The degrees of freedom of the base, ascending.
    pub(super) dofs: Vec<usize>,
    /// Forces BᵀA of unit tractions, one column after the other.
    unit_forces: Vec<f64>,
    /// Responses K_eff⁻¹ BᵀA on the base, one column after the other.
    responses: Vec<f64>,
    /// Entries of each row of B: index in `dofs`, and weight.
    mean_rows: Vec<Vec<(usize, f64)>>,
}

impl BaseResponses {
    /// Forces and means of a base of a structure with this number of degrees of freedom.
    pub(super) fn new(base: &PlacedBase, dof_count: usize) -> Self {
        let dofs = base.dofs();
        let order = base.layout().len();
        let mut unit_forces = Vec::with_capacity(order * dofs.len());
        let mut unit_traction = vec![0.0; order];
        for i in 0..order {
            let mut force = vec![0.0; dof_count];
            unit_traction[i] = 1.0;
            base.add_forces(1.0, &unit_traction, &mut force);
            unit_traction[i] = 0.0;
            unit_forces.extend(dofs.iter().map(|dof| force[*dof]));
        }
        let mut mean_rows = vec![Vec::new(); order];
        let mut displacement = vec![0.0; dof_count];
        let mut element_means = vec![0.0; order];
        for (k, dof) in dofs.iter().enumerate() {
            displacement[*dof] = 1.0;
            base.means(&displacement, &mut element_means);
            displacement[*dof] = 0.0;
            for (row, mean) in mean_rows.iter_mut().zip(&element_means) {
                if *mean != 0.0 {
                    row.push((k, *mean));
                }
            }
        }
        Self { dofs, responses: unit_forces.clone(), unit_forces, mean_rows }
    }

    /// Adds B K_eff⁻¹ BᵀA to the row-major `operator`, without allocating.
    pub(super) fn add_to(&mut self, factor: &mut ChangingFactor, operator: &mut [f64]) {
        let Self { dofs, unit_forces, responses, mean_rows } = self;
        responses.copy_from_slice(unit_forces);
        factor.solve_on_last_rows(responses);
        let order = mean_rows.len();
        for (mean_row, row) in mean_rows.iter().zip(operator.chunks_exact_mut(order)) {
            for (response, entry) in responses.chunks_exact(dofs.len()).zip(row) {
                *entry += mean_row.iter().map(|(k, weight)| weight * response[*k]).sum::<f64>();
            }
        }
    }
}
