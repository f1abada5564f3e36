//! States of solids during a simulation.

use std::any::Any;

use basemat::Simulation;
use basemat::structure::{
    FemModel, Structure, StructureGroup, WithModalDamping, WithSprings, WithWalls,
};
use pyo3::prelude::*;

use super::PySimulation;
use crate::array::{Array, Count};
use crate::error::{OrRaise, input_error};
use crate::names::choice;
use crate::structure::PySolidPoints;

/// The model of a simulation whose structure, or a ``member`` of its group, is a `FemModel`.
///
/// Springs, modal damping or walls may be around the group and around its members.
fn inelastic_model(simulation: &Simulation, member: Option<Count>) -> PyResult<&FemModel> {
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
    structure.downcast_ref().ok_or_else(|| {
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
    /// stresses, plastic strains and mobilised strengths at its integration points. The structure is a `FemModel`, also
    /// one inside `WithSprings`, `WithModalDamping` or `WithWalls`, or the structure ``member`` (0: the first; none unless
    /// given) of a `StructureGroup`. While `run` calls ``observe``, this method raises an `Error`: use a loop over `steps`
    /// instead.
    #[pyo3(signature = (element, *, member=None))]
    fn solid_points(&self, element: Count, member: Option<Count>) -> PyResult<PySolidPoints> {
        PySolidPoints::of_element(inelastic_model(&*self.lock()?, member)?, element.0)
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
        let elements: Vec<usize> = model.inelastic_elements().collect();
        let values = elements
            .iter()
            .map(|&element| Ok(element_value(&PySolidPoints::of_element(model, element)?)))
            .collect::<PyResult<Array>>()?;
        Ok((elements, values))
    }
}
