//! Forces of a beam of fibres without its rigid motions.
//!
//! | symbol | meaning |
//! |---|---|
//! | v | B basic deformations: elongation (m), rotations of both ends relative to the chord (rad) |
//! | q | basic forces conjugate to them: axial force (N), moments of both ends (N m) |
//! | e, s | N deformations and resultants of a section |
//! | a(x), b(x) | e = a v of the displacement-based element; s = b q in equilibrium |
//! | w | part of the length of a section |
//!
//! The **displacement-based** element interpolates e by a, and q = Σ w aᵀ s(e). The **force-based** element is in
//! `force_based.rs`; q and e at the end of the last step are among its internal variables.

use std::ops::Range;

use super::basic_state::{BasicState, LastState, MAX_SECTIONS, SectionState};
use super::interpolation::Interpolation;
use super::member_sections::StepEnd;
use super::quadrature::BeamPoint;
use super::section::FiberSection;
use super::section_response::SectionResponse;
use super::solution_memo::SolutionMemo;
use crate::error::Result;
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::small_matrix::{add_congruent, add_transposed, inverse, product};
use crate::linalg::dot;

/// How section deformations follow from those of the element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum BeamFormulation {
    /// Linear axial displacement and cubic deflection: divide members where they yield (OpenSees' `dispBeamColumn`).
    #[default]
    DisplacementBased,
    /// Exact equilibrium along the member, by iterations inside the element (OpenSees' `forceBeamColumn`).
    ForceBased,
}

/// A beam without rigid motions: sections at points along a length.
pub(in crate::fem) struct BasicBeam<'a, const N: usize, const B: usize> {
    pub(in crate::fem) interpolation: &'static Interpolation<N, B>,
    pub(in crate::fem) formulation: BeamFormulation,
    pub(in crate::fem) section: &'a FiberSection,
    pub(in crate::fem) points: &'a [BeamPoint],
    /// Length, m.
    pub(in crate::fem) length: f64,
    /// Last states of a beam by forces.
    pub(in crate::fem) memo: &'a SolutionMemo<N, B>,
}

impl<const N: usize, const B: usize> BasicBeam<'_, N, B> {
    /// Number of internal variables: those of all fibres, then e, q and v of a force-based element.
    pub(in crate::fem) fn variable_count(&self) -> usize {
        let state_count = match self.formulation {
            BeamFormulation::DisplacementBased => 0,
            BeamFormulation::ForceBased => N * self.points.len() + B + B,
        };
        self.points.len() * self.section.variable_count() + state_count
    }

    /// Overwrites `variables` by those of the undeformed beam.
    pub(in crate::fem) fn initialize(&self, variables: &mut [f64]) {
        variables.fill(0.0);
        for index in 0..self.points.len() {
            self.section.initialize(&mut variables[self.section_range(index)]);
        }
    }

    /// Range of a section's internal variables among those of the beam.
    fn section_range(&self, index: usize) -> Range<usize> {
        let count = self.section.variable_count();
        index * count..(index + 1) * count
    }

    /// Internal variables e, q and v of a force-based element at the end of the last step.
    pub(super) fn last_state(&self, variables: &[f64]) -> LastState<N, B> {
        let first = self.points.len() * self.section.variable_count();
        let mut values = variables[first..].iter().copied();
        let mut next = || values.next().unwrap_or(0.0);
        let mut deformations = [[0.0; N]; MAX_SECTIONS];
        for section in deformations.iter_mut().take(self.points.len()) {
            *section = std::array::from_fn(|_| next());
        }
        let forces = std::array::from_fn(|_| next());
        let basic_deformations = std::array::from_fn(|_| next());
        LastState { deformations, forces, basic_deformations }
    }

    /// Stiffness of small strains.
    pub(in crate::fem) fn elastic_stiffness(&self) -> Option<[[f64; B]; B]> {
        let section_stiffness = self.section.elastic_stiffness();
        match self.formulation {
            BeamFormulation::DisplacementBased => {
                let mut stiffness = [[0.0; B]; B];
                for point in self.points {
                    let a = (self.interpolation.deformations)(point.position);
                    let factor = point.weight / self.length;
                    add_congruent(factor, &a, &section_stiffness, &mut stiffness);
                }
                Some(stiffness)
            }
            BeamFormulation::ForceBased => {
                let section_flexibility = inverse(section_stiffness)?;
                let mut flexibility = [[0.0; B]; B];
                for point in self.points {
                    let b = (self.interpolation.forces)(point.position);
                    let factor = point.weight * self.length;
                    add_congruent(factor, &b, &section_flexibility, &mut flexibility);
                }
                inverse(flexibility)
            }
        }
    }

    /// Internal variables of all sections.
    fn section_variables<'v>(&self, variables: &'v [f64]) -> &'v [f64] {
        &variables[..self.points.len() * self.section.variable_count()]
    }

    /// Basic forces and tangent at basic deformations v.
    ///
    /// `stresses` becomes the stresses of the fibres of an element by displacements, unless it is empty.
    ///
    /// # Errors
    /// Errors of fibres, and [`Error::Scene`] for a force-based element whose iterations do not converge.
    pub(in crate::fem) fn state(
        &self,
        v: &[f64; B],
        variables: &[f64],
        stresses: &mut [f64],
    ) -> Result<BasicState<N, B>> {
        match self.formulation {
            BeamFormulation::DisplacementBased => {
                self.displacement_based_state(v, variables, stresses)
            }
            BeamFormulation::ForceBased => self.force_based_state(v, variables),
        }
    }

    /// Deformations of the sections at basic deformations v.
    ///
    /// Evaluates no fibre of an element by displacements, whose forces are then zero. The tangent may be zero.
    ///
    /// # Errors
    /// As for [`state`](BasicBeam::state).
    pub(in crate::fem) fn deformed_state(
        &self,
        v: &[f64; B],
        variables: &[f64],
        _stresses: &mut [f64],
    ) -> Result<BasicState<N, B>> {
        if self.formulation == BeamFormulation::ForceBased {
            let LastState { deformations, forces, basic_deformations } = self.last_state(variables);
            // At the end of the last step nothing has to be solved.
            if *v == basic_deformations {
                return Ok(BasicState { forces, deformations, ..BasicState::zero() });
            }
            return self.force_based_state(v, variables);
        }
        let mut state = BasicState::zero();
        for (deformations, point) in state.deformations.iter_mut().zip(self.points) {
            let a = (self.interpolation.deformations)(point.position);
            *deformations = self.interpolated(&a, v);
        }
        Ok(state)
    }

    /// Deformations e = a v of a section of an element by displacements.
    fn interpolated(&self, a: &[[f64; B]; N], v: &[f64; B]) -> [f64; N] {
        product(a, v).map(|deformation| deformation / self.length)
    }

    fn displacement_based_state(
        &self,
        v: &[f64; B],
        variables: &[f64],
        stresses: &mut [f64],
    ) -> Result<BasicState<N, B>> {
        let mut state = self.deformed_state(v, variables, &mut [])?;
        let responses = self.responses(&state.deformations, variables, stresses)?;
        for (point, response) in self.points.iter().zip(responses) {
            let a = (self.interpolation.deformations)(point.position);
            add_transposed(point.weight, &a, &response.forces, &mut state.forces);
            let factor = point.weight / self.length;
            add_congruent(factor, &a, &response.tangent, &mut state.stiffness);
        }
        Ok(state)
    }

    /// Responses of all sections, of which the first are in use; `stresses` is as for [`state`](BasicBeam::state).
    pub(super) fn responses(
        &self,
        deformations: &[[f64; N]; MAX_SECTIONS],
        variables: &[f64],
        stresses: &mut [f64],
    ) -> Result<[SectionResponse<N>; MAX_SECTIONS]> {
        let count = self.points.len();
        let mut responses = [SectionResponse::zero(); MAX_SECTIONS];
        let variables = self.section_variables(variables);
        let used_responses = &mut responses[..count];
        self.section.responses(&deformations[..count], variables, stresses, used_responses)?;
        Ok(responses)
    }

    /// Energy of a state, J.
    ///
    /// # Errors
    /// Errors of fibres.
    pub(in crate::fem) fn energy(
        &self,
        state: &BasicState<N, B>,
        variables: &[f64],
    ) -> Result<InternalEnergy> {
        let mut sum = InternalEnergy::default();
        for (index, point) in self.points.iter().enumerate() {
            let section_variables = &variables[self.section_range(index)];
            let deformations = &state.deformations[index];
            let energy = self.section.energy(deformations, section_variables)?;
            let length = point.weight * self.length;
            sum.stored += length * energy.stored;
            sum.dissipated += length * energy.dissipated;
        }
        Ok(sum)
    }

    /// Number of fibres of all sections.
    pub(in crate::fem) fn fiber_count(&self) -> usize {
        self.points.len() * self.section.fiber_count()
    }

    /// Work inside a step that is neither stored nor dissipated, and energy at its end, J.
    ///
    /// `states` at its start, mid-step and end; `increment`: change of the basic deformations from start to end. `stresses` of an
    /// element by displacements are those at mid-step; they become those for [`commit`](BasicBeam::commit).
    ///
    /// Sections of a force-based element do not follow straight paths. Its remainder is therefore computed from forces and
    /// energies of the whole element.
    ///
    /// # Errors
    /// Errors of fibres.
    pub(in crate::fem) fn end_step(
        &self,
        states: [&BasicState<N, B>; 3],
        increment: &[f64; B],
        variables: &[f64],
        stresses: &mut [f64],
    ) -> Result<StepEnd> {
        let count = self.points.len();
        let path = states.map(|state| &state.deformations[..count]);
        let mut ends = [StepEnd::default(); MAX_SECTIONS];
        let section_variables = self.section_variables(variables);
        self.section.end_step(path, section_variables, stresses, &mut ends[..count])?;
        let mut sum = StepEnd::default();
        for (point, end) in self.points.iter().zip(ends) {
            let length = point.weight * self.length;
            sum.remainder += length * end.remainder;
            sum.energy.stored += length * end.energy.stored;
            sum.energy.dissipated += length * end.energy.dissipated;
        }
        if self.formulation == BeamFormulation::ForceBased {
            let start = self.energy(states[0], variables)?;
            let end = sum.energy;
            let change = end.stored - start.stored + end.dissipated - start.dissipated;
            sum.remainder = dot(&states[1].forces, increment) - change;
        }
        Ok(sum)
    }

    /// Deformations, resultants and fibres of each section.
    ///
    /// # Errors
    /// Errors of fibres.
    pub(in crate::fem) fn section_states(
        &self,
        state: &BasicState<N, B>,
        variables: &[f64],
    ) -> Result<Vec<SectionState<N>>> {
        let responses = self.responses(&state.deformations, variables, &mut [])?;
        let mut states = Vec::with_capacity(self.points.len());
        for (index, point) in self.points.iter().enumerate() {
            let deformations = state.deformations[index];
            let section_variables = &variables[self.section_range(index)];
            states.push(SectionState {
                point: *point,
                deformations,
                forces: responses[index].forces,
                fibers: self.section.fiber_states(&deformations, section_variables)?,
            });
        }
        Ok(states)
    }

    /// Overwrites `variables` by those after a step that ended in a state with basic deformations v.
    ///
    /// `stresses`: stresses of the fibres after [`end_step`](BasicBeam::end_step); empty if they are not stored.
    pub(in crate::fem) fn commit(
        &self,
        state: &BasicState<N, B>,
        v: &[f64; B],
        stresses: &[f64],
        variables: &mut [f64],
    ) {
        let count = self.points.len();
        let (sections, last_state) = variables.split_at_mut(count * self.section.variable_count());
        self.section.commit(&state.deformations[..count], stresses, sections);
        if self.formulation == BeamFormulation::ForceBased {
            let deformations = state.deformations.iter().take(count).flatten();
            let values = deformations.chain(&state.forces).chain(v);
            for (variable, value) in last_state.iter_mut().zip(values) {
                *variable = *value;
            }
        }
    }
}
