//! Fibres of all sections along a beam, evaluated together.
//!
//! Lists of fibres have the first batch of each section, then the second batch of each section, and so on.

use std::ops::Range;

use super::basic_state::MAX_SECTIONS;
use super::section::{Batch, FiberSection, strain_row};
use super::section_response::SectionResponse;
use super::{MAX_MEMBER_FIBERS, UniaxialResponse};
use crate::error::Result;
use crate::fem::internal_energy::InternalEnergy;

/// Remainder of a step and energy at its end, J; of a section per length, J/m.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::fem) struct StepEnd {
    /// Work of the stresses at mid-step that is neither stored nor dissipated.
    pub(in crate::fem) remainder: f64,
    pub(in crate::fem) energy: InternalEnergy,
}

impl Batch<'_> {
    /// Writes the strains of the batch in each section.
    #[inline]
    fn member_strains<const N: usize>(&self, deformations: &[[f64; N]], strains: &mut [f64]) {
        for (strains, deformations) in strains.chunks_exact_mut(self.len()).zip(deformations) {
            self.strains(deformations, strains);
        }
    }

    /// Internal variables of the batch in each section, of which the first are in use.
    fn member_variables<'v>(
        &self,
        section_count: usize,
        variables: &'v [f64],
    ) -> [&'v [f64]; MAX_SECTIONS] {
        let count = variables.len() / section_count.max(1);
        std::array::from_fn(|index| {
            let section = variables.get(index * count..(index + 1) * count);
            section.map_or(&[][..], |section| &section[self.variables.clone()])
        })
    }

    /// Range of the batch in a list of the fibres of all sections.
    fn member_range(&self, section_count: usize) -> Range<usize> {
        self.first * section_count..(self.first + self.len()) * section_count
    }
}

impl FiberSection {
    /// Overwrites `responses` with the resultants and tangents of sections at their deformations.
    ///
    /// `variables`: those of all sections. `stresses` becomes the list of the fibres' stresses, unless it is empty.
    ///
    /// # Errors
    /// As for [`FiberSection::energy`].
    pub(super) fn responses<const N: usize>(
        &self,
        deformations: &[[f64; N]],
        variables: &[f64],
        stresses: &mut [f64],
        responses: &mut [SectionResponse<N>],
    ) -> Result<()> {
        let section_count = deformations.len();
        responses.fill(SectionResponse::zero());
        let mut strains = [0.0; MAX_MEMBER_FIBERS];
        let mut fiber_responses = [UniaxialResponse::default(); MAX_MEMBER_FIBERS];
        for batch in self.batches() {
            let count = batch.len() * section_count;
            batch.member_strains(deformations, &mut strains[..count]);
            let batch_variables = batch.member_variables(section_count, variables);
            let batch_variables = &batch_variables[..section_count];
            let fiber_responses = &mut fiber_responses[..count];
            batch
                .material
                .responses_of_sections(&strains[..count], batch_variables, fiber_responses)
                .map_err(|fault| batch.within_fiber(fault))?;
            let sections = fiber_responses.chunks_exact(batch.len());
            for (response, section) in responses.iter_mut().zip(sections) {
                for (fiber, fiber_response) in batch.fibers.iter().zip(section) {
                    response.add_fiber(fiber.area, &strain_row(fiber.position), fiber_response);
                }
            }
            if let Some(stresses) = stresses.get_mut(batch.member_range(section_count)) {
                for (stress, response) in stresses.iter_mut().zip(fiber_responses) {
                    *stress = response.stress;
                }
            }
        }
        responses.iter_mut().for_each(SectionResponse::complete_tangent);
        Ok(())
    }

    /// Overwrites `ends` with remainders of a step and energies at its end.
    ///
    /// `path`: deformations of the sections at the start, at mid-step and at the end. `stresses`: list of the fibres' stresses
    /// at mid-step; it becomes what [`commit`](FiberSection::commit) needs.
    ///
    /// # Errors
    /// As for [`FiberSection::energy`].
    pub(super) fn end_step<const N: usize>(
        &self,
        path: [&[[f64; N]]; 3],
        variables: &[f64],
        stresses: &mut [f64],
        ends: &mut [StepEnd],
    ) -> Result<()> {
        let section_count = ends.len();
        let mut strains = [[0.0; MAX_MEMBER_FIBERS]; 3];
        let mut remainders = [0.0; MAX_MEMBER_FIBERS];
        let mut energies = [InternalEnergy::default(); MAX_MEMBER_FIBERS];
        for batch in self.batches() {
            let count = batch.len() * section_count;
            for (strains, deformations) in strains.iter_mut().zip(path) {
                batch.member_strains(deformations, &mut strains[..count]);
            }
            let batch_variables = batch.member_variables(section_count, variables);
            let remainders = &mut remainders[..count];
            let energies = &mut energies[..count];
            batch
                .material
                .end_step(
                    strains.each_ref().map(|strains| &strains[..count]),
                    &batch_variables[..section_count],
                    &mut stresses[batch.member_range(section_count)],
                    remainders,
                    energies,
                )
                .map_err(|fault| batch.within_fiber(fault))?;
            let sections =
                remainders.chunks_exact(batch.len()).zip(energies.chunks_exact(batch.len()));
            for (end, (remainders, energies)) in ends.iter_mut().zip(sections) {
                let mut remainder = 0.0;
                let fibers = batch.fibers.iter().zip(remainders.iter().zip(energies));
                for (fiber, (fiber_remainder, energy)) in fibers {
                    remainder += fiber.area * fiber_remainder;
                    end.energy.stored += fiber.area * energy.stored;
                    end.energy.dissipated += fiber.area * energy.dissipated;
                }
                end.remainder += remainder;
            }
        }
        Ok(())
    }

    /// Commits the fibres at the deformations of the sections.
    ///
    /// `stresses`: stresses of the fibres after [`end_step`](FiberSection::end_step); empty if they are not stored.
    pub(super) fn commit<const N: usize>(
        &self,
        deformations: &[[f64; N]],
        stresses: &[f64],
        variables: &mut [f64],
    ) {
        let section_count = deformations.len();
        let mut strains = [0.0; MAX_MEMBER_FIBERS];
        for batch in self.batches() {
            let count = batch.len() * section_count;
            batch.member_strains(deformations, &mut strains[..count]);
            let stresses = stresses.get(batch.member_range(section_count));
            let sections = variables.chunks_exact_mut(self.variable_count().max(1));
            for (index, section) in sections.enumerate() {
                let fibers = index * batch.len()..(index + 1) * batch.len();
                let strains = &strains[fibers.clone()];
                let section = &mut section[batch.variables.clone()];
                match stresses {
                    Some(stresses) => {
                        batch.material.commit_stresses(strains, &stresses[fibers], section);
                    }
                    None => batch.material.commit_fibers(strains, section),
                }
            }
        }
    }
}
