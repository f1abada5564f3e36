//! End of a step of elements with internal variables: remainder, energy and commit.
//!
//! The three need the same stresses. The remainder comes first: it takes those at mid-step from the last forces, and leaves
//! energy and stresses at the end to the other two.

use std::sync::PoisonError;

use super::InelasticElements;
use super::scratch::Scratch;
use crate::error::Result;
use crate::structure::InternalEnergy;

impl InelasticElements {
    /// Work of all elements' forces inside a step that is neither stored nor dissipated.
    ///
    /// It stores the energies at the end of the step.
    pub(super) fn end_step(&self, midstep: &[f64], end: &[f64]) -> Result<f64> {
        self.check_length(midstep)?;
        self.check_length(end)?;
        let scratch = &mut *self.scratch();
        scratch.end_displacement.clear();
        // From here on the stresses become those at the end.
        let has_midstep_stresses = std::mem::take(&mut scratch.has_midstep_stresses)
            && scratch.tangent_displacement == midstep;
        let mut remainder = 0.0;
        let mut energy = InternalEnergy::default();
        let mut stress_start = 0;
        for (element, force, variables) in self.forces() {
            let order = element.rows.len();
            let displacements = [&self.committed_displacement, midstep, end];
            for (buffer, displacement) in scratch.displacements.iter_mut().zip(displacements) {
                element.gather(displacement, &mut buffer[..order]);
            }
            let Scratch { displacements, force: element_force, matrix, stresses, .. } =
                &mut *scratch;
            let path = displacements.each_ref().map(|u| &u[..order]);
            let stress_count = force.stress_count();
            let stresses = &mut stresses[stress_start..][..stress_count];
            stress_start += stress_count;
            if stress_count > 0 && !has_midstep_stresses {
                let unused_force = &mut element_force[..order];
                let values = [unused_force, &mut matrix[..order * order], &mut *stresses];
                force
                    .force_tangent_and_stresses(&element.coordinates, path[1], variables, values)
                    .map_err(|fault| fault.within(element.name()))?;
            }
            let (element_remainder, element_energy) = force
                .end_step(&element.coordinates, path, variables, stresses)
                .map_err(|fault| fault.within(element.name()))?;
            remainder += element_remainder;
            energy = energy + element_energy;
        }
        scratch.end_displacement.extend_from_slice(end);
        scratch.end_energy = energy;
        Ok(remainder)
    }

    /// Commits all elements at a displacement, with their stresses if it ends the last step.
    pub(super) fn commit_elements(&mut self, displacement: &[f64]) {
        let scratch = self.scratch.get_mut().unwrap_or_else(PoisonError::into_inner);
        let has_end_stresses = scratch.end_energy_at(displacement).is_some();
        scratch.forget_evaluations();
        let mut stress_start = 0;
        for element in &self.elements {
            let Some(force) = element.element.inelastic() else { continue };
            let stress_count = force.stress_count();
            let stresses = &scratch.stresses[stress_start..][..stress_count];
            stress_start += stress_count;
            let stresses = if has_end_stresses { stresses } else { &[] };
            let element_displacement = &mut scratch.displacements[0][..element.rows.len()];
            element.gather(displacement, element_displacement);
            let variables = &mut self.variables[element.variables.clone()];
            let coordinates = &element.coordinates;
            force.commit_stresses(coordinates, element_displacement, stresses, variables);
        }
    }
}
