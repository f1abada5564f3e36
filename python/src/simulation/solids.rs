//! States of solids, beams of fibres and hinges during a simulation.

use std::any::Any;

use basemat::Simulation;
use basemat::fem::{BeamSectionState, HingeState, SolidPoint};
use basemat::structure::{
    FemModel, Structure, StructureGroup, WithElements, WithModalDamping, WithSprings, WithWalls,
};
use pyo3::prelude::*;

use super::PySimulation;
use crate::array::{Array, Count};
use crate::error::{OrRaise, input_error};
use crate::names::choice;
use crate::structure::{PyBeamSections, PyHingeState, PySolidPoints};

/// A structure whose elements may yield.
#[derive(Clone, Copy)]
enum InelasticModel<'a> {
    Fem(&'a FemModel),
    Elements(&'a WithElements),
}

impl InelasticModel<'_> {
    fn solid_points(self, element: usize) -> basemat::Result<Vec<SolidPoint>> {
        match self {
            Self::Fem(model) => model.solid_points(element),
            Self::Elements(model) => model.solid_points(element),
        }
    }

    fn beam_sections(self, element: usize) -> basemat::Result<Vec<BeamSectionState>> {
        match self {
            Self::Fem(model) => model.beam_sections(element),
            Self::Elements(model) => model.beam_sections(element),
        }
    }

    fn hinge_state(self, element: usize) -> basemat::Result<HingeState> {
        match self {
            Self::Fem(model) => model.hinge_state(element),
            Self::Elements(model) => model.hinge_state(element),
        }
    }

    /// Numbers of the elements that yield.
    fn elements(self) -> Vec<usize> {
        match self {
            Self::Fem(model) => model.inelastic_elements().collect(),
            Self::Elements(model) => (0..model.mesh().elements().len()).collect(),
        }
    }
}

/// The model of a simulation whose structure, or a ``member`` of its group, is a `FemModel` or `WithElements`.
///
/// Springs, modal damping or walls may be around the group and around its members.
fn inelastic_model(simulation: &Simulation, member: Option<Count>) -> PyResult<InelasticModel<'_>> {
    let mut structure: &dyn Any = simulation.structure();
    let mut remaining_member = member.map(|member| member.0);
    loop {
        if let Some(group) = structure.downcast_ref::<StructureGroup>() {
            let Some(index) = remaining_member.take() else {
                return Err(input_error(
                    "the structure of the simulation is a StructureGroup: member must be the number of one of its \
                     structures, 0 for the first",
                ));
            };
            structure = group.structure(index).or_raise()?;
        } else if let Some(inner) = inner_structure(structure) {
            structure = inner;
        } else {
            break;
        }
    }
    if remaining_member.is_some() {
        return Err(input_error("member is for a StructureGroup, but the simulation has none"));
    }
    if let Some(model) = structure.downcast_ref() {
        return Ok(InelasticModel::Fem(model));
    }
    structure.downcast_ref().map(InelasticModel::Elements).ok_or_else(|| {
        input_error(
            "the structure of the simulation must be a FemModel with materials that yield, alone or with springs, modal \
             damping or walls",
        )
    })
}

/// The structure inside a box or a wrapper.
fn inner_structure(structure: &dyn Any) -> Option<&dyn Structure> {
    if let Some(boxed) = structure.downcast_ref::<Box<dyn Structure>>() {
        return Some(boxed.as_ref());
    }
    if let Some(with_springs) = structure.downcast_ref::<WithSprings>() {
        return Some(with_springs.structure());
    }
    if let Some(with_damping) = structure.downcast_ref::<WithModalDamping>() {
        return Some(with_damping.structure());
    }
    structure.downcast_ref::<WithWalls>().map(WithWalls::structure)
}

/// Function that computes a value of an element from the states of its points.
type ElementValue = fn(&PySolidPoints) -> f64;

#[pymethods]
impl PySimulation {
    /// The `SolidPoints` of an ``element`` (its number in the mesh) at the end of the last accepted step: strains,
    /// stresses, plastic strains and mobilised strengths at its integration points. The structure is a `FemModel` or
    /// `WithElements`, also one inside `WithSprings`, `WithModalDamping` or `WithWalls`, or the structure ``member`` (0: the first; none unless
    /// given) of a `StructureGroup`. While `run` calls ``observe``, this method raises an `Error`: use a loop over `steps`
    /// instead.
    #[pyo3(signature = (element, *, member=None))]
    fn solid_points(&self, element: Count, member: Option<Count>) -> PyResult<PySolidPoints> {
        let simulation = self.lock()?;
        let model = inelastic_model(&simulation, member)?;
        PySolidPoints::of_element(element.0, |index| model.solid_points(index))
    }

    /// The `BeamSections` of a beam of fibres with the number ``element`` at the end of the last accepted step: curvatures,
    /// axial forces, moments, and strains and stresses of all fibres. Structure and ``member`` (none unless given) are as for
    /// `solid_points`.
    #[pyo3(signature = (element, *, member=None))]
    fn beam_sections(&self, element: Count, member: Option<Count>) -> PyResult<PyBeamSections> {
        let simulation = self.lock()?;
        let model = inelastic_model(&simulation, member)?;
        PyBeamSections::of_element(element.0, |index| model.beam_sections(index))
    }

    /// The `HingeState` of a hinge with the number ``element`` at the end of the last accepted step: rotation, moment, and what
    /// of the deformations is plastic. Structure and ``member`` (none unless given) are as for `solid_points`.
    #[pyo3(signature = (element, *, member=None))]
    fn hinge_state(&self, element: Count, member: Option<Count>) -> PyResult<PyHingeState> {
        let simulation = self.lock()?;
        let model = inelastic_model(&simulation, member)?;
        PyHingeState::of_element(element.0, |index| model.hinge_state(index))
    }

    /// One value for each element whose material yields, at the end of the last accepted step: the list of their numbers, and
    /// an array of shape (elements,), for `Mesh.plot_solids`. Structure and ``member`` (none unless given) are as for
    /// `solid_points`.
    ///
    /// ``quantity``: "plastic_strain", the mean plastic shear strain of the element, or "mobilised_strength", the largest
    /// ratio of shear stress to shear strength at its points.
    #[pyo3(signature = (quantity, *, member=None))]
    fn solid_values(&self, quantity: &str, member: Option<Count>) -> PyResult<(Vec<usize>, Array)> {
        let choices: [(&str, ElementValue); 2] = [
            ("plastic_strain", PySolidPoints::mean_plastic),
            ("mobilised_strength", PySolidPoints::largest_mobilised),
        ];
        let element_value = choice("quantity", quantity, &choices)?;
        let simulation = self.lock()?;
        let model = inelastic_model(&simulation, member)?;
        let mut elements = Vec::new();
        let mut values = Vec::new();
        for element in model.elements() {
            let points = PySolidPoints::of_element(element, |index| model.solid_points(index))?;
            // Beams have no points.
            if !points.is_empty() {
                elements.push(element);
                values.push(element_value(&points));
            }
        }
        Ok((elements, values.into()))
    }
}
