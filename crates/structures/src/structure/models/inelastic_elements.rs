//! Nonlinear force of a model's elements with internal variables.

mod element;
mod scratch;

use std::cmp::Ordering;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use element::InelasticElement;
use scratch::Scratch;

use crate::error::{CheckpointError, Result, all_finite, same_length};
use crate::fem::{Direction, InelasticForce, Mesh, ReadStates, SolidState, read_points};
use crate::structure::{DofCombination, InternalEnergy, NonlinearForce, Triplets};

/// State of the point of an element that is nearest to failure, and the element's name.
struct NamedState {
    name: String,
    state: SolidState,
}

/// Order of states by mobilised strength, then by plastic strain.
fn by_strength(a: &SolidState, b: &SolidState) -> Ordering {
    let strengths = a.mobilised_strength.total_cmp(&b.mobilised_strength);
    strengths.then(a.plastic_strain.total_cmp(&b.plastic_strain))
}

/// Elements of a model that have internal variables, as its nonlinear force.
pub(super) struct InelasticElements {
    elements: Vec<InelasticElement>,
    dof_count: usize,
    /// Internal variables of all elements at the end of the last step.
    variables: Vec<f64>,
    /// Displacement of the model at the end of the last step, m and rad.
    committed_displacement: Vec<f64>,
    /// Energies of the undeformed model, which are subtracted from those of a deformed one.
    energy_at_rest: InternalEnergy,
    /// Whether forces act at zero displacement.
    has_initial_stress: bool,
    /// Buffers of evaluations, which do not allocate.
    scratch: Mutex<Scratch>,
}

short_debug! {
    InelasticElements; self; elements: self.elements.len(), variables: self.variables.len()
}

impl Clone for InelasticElements {
    fn clone(&self) -> Self {
        Self {
            elements: self.elements.clone(),
            dof_count: self.dof_count,
            variables: self.variables.clone(),
            committed_displacement: self.committed_displacement.clone(),
            energy_at_rest: self.energy_at_rest,
            has_initial_stress: self.has_initial_stress,
            scratch: Mutex::new(Scratch::new(&self.elements)),
        }
    }
}

impl InelasticElements {
    /// Elements of a mesh in their undeformed state; `None` if all are linear.
    ///
    /// `row` returns the motion of a node as a sum of the model's `dof_count` degrees of freedom.
    ///
    /// # Errors
    /// [`Error::Item`](crate::Error::Item) with the element and its error in the undeformed state.
    pub(super) fn new(
        mesh: &Mesh,
        dof_count: usize,
        row: impl Fn(usize, Direction) -> Result<DofCombination>,
    ) -> Result<Option<Self>> {
        let mut elements = Vec::new();
        let mut variables = Vec::new();
        for (index, element) in mesh.shared_elements().enumerate() {
            let Some(force) = element.inelastic() else { continue };
            let first_variable = variables.len();
            variables.resize(first_variable + force.variable_count(), 0.0);
            let mut inelastic = InelasticElement {
                index,
                element: Arc::clone(element),
                coordinates: mesh.coordinates(element.nodes()),
                terms: Vec::new(),
                rows: Vec::new(),
                dofs: None,
                variables: first_variable..variables.len(),
            };
            for &node in element.nodes() {
                for &direction in element.directions() {
                    let first_term = inelastic.terms.len();
                    inelastic.terms.extend(row(node, direction)?);
                    inelastic.rows.push(first_term..inelastic.terms.len());
                }
            }
            let element_variables = &mut variables[first_variable..];
            inelastic.dofs = inelastic.single_dofs();
            force
                .initialize(&inelastic.coordinates, element_variables)
                .and_then(|()| all_finite("internal variables", element_variables))
                .map_err(|fault| fault.within(inelastic.name()))?;
            inelastic.check_links(force)?;
            elements.push(inelastic);
        }
        if elements.is_empty() {
            return Ok(None);
        }
        let scratch = Mutex::new(Scratch::new(&elements));
        let mut model = Self {
            elements,
            dof_count,
            variables,
            committed_displacement: vec![0.0; dof_count],
            energy_at_rest: InternalEnergy::default(),
            has_initial_stress: false,
            scratch,
        };
        let mut force = vec![0.0; dof_count];
        model.force(&model.committed_displacement, &mut force)?;
        model.has_initial_stress = force.iter().any(|force| *force != 0.0);
        model.energy_at_rest = model.total_energy(&model.committed_displacement)?;
        Ok(Some(model))
    }

    /// Whether forces act at zero displacement.
    pub(super) fn has_initial_stress(&self) -> bool {
        self.has_initial_stress
    }

    /// States in an element at the end of the last step; `None` for a linear element.
    pub(super) fn states<T>(&self, index: usize, read: ReadStates<T>) -> Option<Result<Vec<T>>> {
        let position = self.elements.binary_search_by_key(&index, |e| e.index).ok()?;
        Some(self.states_at(&self.elements[position], &self.committed_displacement, read))
    }

    /// States in an element at a displacement of the model.
    fn states_at<T>(
        &self,
        element: &InelasticElement,
        displacement: &[f64],
        read: ReadStates<T>,
    ) -> Result<Vec<T>> {
        let Some(force) = element.element.inelastic() else { return Ok(Vec::new()) };
        let mut element_displacement = vec![0.0; element.rows.len()];
        element.gather(displacement, &mut element_displacement);
        let variables = &self.variables[element.variables.clone()];
        read(force, &element.coordinates, &element_displacement, variables)
    }

    fn scratch(&self) -> MutexGuard<'_, Scratch> {
        self.scratch.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The elements with their forces and internal variables.
    fn forces(&self) -> impl Iterator<Item = (&InelasticElement, &dyn InelasticForce, &[f64])> {
        self.elements.iter().filter_map(|element| {
            Some((
                element,
                element.element.inelastic()?,
                &self.variables[element.variables.clone()],
            ))
        })
    }

    /// Returns an error for a displacement of another length.
    fn check_length(&self, displacement: &[f64]) -> Result<()> {
        same_length("displacement of the model", displacement.len(), self.dof_count)
    }

    /// Energies of all elements.
    fn total_energy(&self, displacement: &[f64]) -> Result<InternalEnergy> {
        self.check_length(displacement)?;
        let mut scratch = self.scratch();
        let mut sum = InternalEnergy::default();
        for (element, force, variables) in self.forces() {
            let element_displacement = &mut scratch.displacements[0][..element.rows.len()];
            element.gather(displacement, element_displacement);
            let energy = force.energy(&element.coordinates, element_displacement, variables);
            sum = sum + energy.map_err(|fault| fault.within(element.name()))?;
        }
        Ok(sum)
    }

    /// Work of all elements' forces inside a step that is neither stored nor dissipated.
    ///
    /// Remainder, energy and commit need the same stresses. The remainder comes first: it takes those at mid-step from the last
    /// forces, and stores energies and stresses at the end for the other two.
    fn end_step(&self, midstep: &[f64], end: &[f64]) -> Result<f64> {
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
    fn commit_elements(&mut self, displacement: &[f64]) {
        let scratch = self.scratch.get_mut().unwrap_or_else(PoisonError::into_inner);
        let has_end_stresses = scratch.end_energy_at(displacement).is_some();
        scratch.discard_evaluations();
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

impl NonlinearForce for InelasticElements {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        self.check_length(displacement)?;
        same_length("nonlinear force of the model", force.len(), self.dof_count)?;
        let scratch = &mut *self.scratch();
        scratch.discard_evaluations();
        let mut tangent_start = 0;
        let mut stress_start = 0;
        for (element, inelastic_force, variables) in self.forces() {
            let order = element.rows.len();
            let u = &mut scratch.displacements[0][..order];
            let element_force = &mut scratch.force[..order];
            element.gather(displacement, u);
            element_force.fill(0.0);
            let coordinates = &element.coordinates;
            let result = if inelastic_force.has_shared_evaluation() {
                let matrix = &mut scratch.tangents[tangent_start..][..order * order];
                tangent_start += order * order;
                matrix.fill(0.0);
                let stress_count = inelastic_force.stress_count();
                let stresses = &mut scratch.stresses[stress_start..][..stress_count];
                stress_start += stress_count;
                let values = [element_force, matrix, stresses];
                inelastic_force.force_tangent_and_stresses(coordinates, u, variables, values)
            } else {
                inelastic_force.force(coordinates, u, variables, element_force)
            };
            result.map_err(|fault| fault.within(element.name()))?;
            element.scatter(&scratch.force[..order], force);
        }
        scratch.tangent_displacement.extend_from_slice(displacement);
        scratch.has_midstep_stresses = true;
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        self.check_length(displacement)?;
        let scratch = &mut *self.scratch();
        let has_tangents = scratch.tangent_displacement == displacement;
        let mut tangent_start = 0;
        for (element, inelastic_force, variables) in self.forces() {
            let order = element.rows.len();
            if has_tangents && inelastic_force.has_shared_evaluation() {
                let element_matrix = &scratch.tangents[tangent_start..][..order * order];
                tangent_start += order * order;
                element.scatter_matrix(element_matrix, matrix);
                continue;
            }
            let element_displacement = &mut scratch.displacements[0][..order];
            let element_matrix = &mut scratch.matrix[..order * order];
            element.gather(displacement, element_displacement);
            element_matrix.fill(0.0);
            inelastic_force
                .tangent(&element.coordinates, element_displacement, variables, element_matrix)
                .map_err(|fault| fault.within(element.name()))?;
            element.scatter_matrix(element_matrix, matrix);
        }
        Ok(())
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.forces().all(|(_, force, _)| force.has_symmetric_tangent())
    }

    /// Energies since the undeformed state; NaN for an element that returns an error.
    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        let unknown_energy = InternalEnergy { stored: f64::NAN, dissipated: f64::NAN };
        let end_energy = self.scratch().end_energy_at(displacement);
        let energy = match end_energy {
            Some(energy) => energy,
            None => self.total_energy(displacement).unwrap_or(unknown_energy),
        };
        Some(InternalEnergy {
            stored: energy.stored - self.energy_at_rest.stored,
            dissipated: energy.dissipated - self.energy_at_rest.dissipated,
        })
    }

    /// The remainder of all elements; NaN for an element that returns an error.
    fn remainder(&self, midstep: &[f64], end: &[f64]) -> Option<f64> {
        Some(self.end_step(midstep, end).unwrap_or(f64::NAN))
    }

    /// Text of the element of highest mobilised strength at the first of `dofs` with an inelastic element.
    fn describe_state(&self, displacement: &[f64], dofs: &[usize]) -> Option<String> {
        self.check_length(displacement).ok()?;
        dofs.iter().find_map(|dof| {
            let touching_elements = self
                .elements
                .iter()
                .filter(|element| element.terms.iter().any(|(term_dof, _)| term_dof == dof));
            let states = touching_elements.filter_map(|element| {
                let points = self.states_at(element, displacement, read_points).ok()?;
                let states = points.iter().map(|point| point.state);
                Some(NamedState { name: element.name(), state: states.max_by(by_strength)? })
            });
            let weakest_point = states.max_by(|a, b| by_strength(&a.state, &b.state))?;
            Some(format!(
                "{}: plastic strain {:.2e}, {:.0} % of its strength",
                weakest_point.name,
                weakest_point.state.plastic_strain,
                100.0 * weakest_point.state.mobilised_strength
            ))
        })
    }

    /// A displacement of another length changes nothing.
    fn commit(&mut self, displacement: &[f64]) {
        if self.check_length(displacement).is_err() {
            return;
        }
        self.commit_elements(displacement);
        self.committed_displacement.copy_from_slice(displacement);
    }

    /// Internal variables of all elements, then the displacement at the end of the last step.
    fn save(&self) -> Result<Vec<f64>> {
        Ok([self.variables.as_slice(), &self.committed_displacement].concat())
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let value_count = self.variables.len() + self.dof_count;
        if values.len() != value_count || values.iter().any(|value| !value.is_finite()) {
            return Err(CheckpointError::Corrupt { quantity: "state of the elements" }.into());
        }
        let scratch = self.scratch.get_mut().unwrap_or_else(PoisonError::into_inner);
        scratch.discard_evaluations();
        let variable_count = self.variables.len();
        self.variables.copy_from_slice(&values[..variable_count]);
        self.committed_displacement.copy_from_slice(&values[variable_count..]);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
