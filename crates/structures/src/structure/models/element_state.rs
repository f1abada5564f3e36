//! Displacements of a model's elements, and states of those with internal variables.

use super::inelastic_elements::InelasticElements;
use crate::error::{Error, Result, in_bounds, same_length};
use crate::fem::{
    BeamSectionState, Element, HingeState, ReadStates, SolidPoint, read_hinge, read_points,
    read_sections,
};
use crate::structure::{FemModel, Structure};

impl FemModel {
    /// Displacements of an element's degrees of freedom, in the order of its matrices.
    ///
    /// [`Shell::resultants`](crate::fem::Shell::resultants) and forces of other elements are computed from them.
    /// `displacement` holds all degrees of freedom of the model, such as `State::displacement`. A follower of a rigid
    /// link or a diaphragm moves with its leader. The element need not belong to the mesh.
    ///
    /// # Errors
    /// [`Error::Size`] for a displacement of another length; as for [`row`](FemModel::row).
    pub fn element_displacements(
        &self,
        element: &dyn Element,
        displacement: &[f64],
    ) -> Result<Vec<f64>> {
        same_length("displacement of the model", displacement.len(), self.dofs())?;
        let mut values = Vec::with_capacity(element.order());
        for &node in element.nodes() {
            for &direction in element.directions() {
                values.push(self.row(node, direction)?.value(displacement));
            }
        }
        Ok(values)
    }

    /// Elements with internal variables in their undeformed state, for the present degrees of freedom.
    pub(super) fn undeformed_inelastic_elements(&self) -> Result<Option<InelasticElements>> {
        let row = |node, direction| self.row(node, direction);
        InelasticElements::new(&self.mesh, self.dofs(), row)
    }

    /// Indices of the elements with internal variables, ascending.
    ///
    /// [`solid_points`](FemModel::solid_points) returns their states.
    pub fn inelastic_elements(&self) -> impl Iterator<Item = usize> + '_ {
        let elements = self.mesh().elements().enumerate();
        elements.filter(|(_, element)| element.inelastic().is_some()).map(|(index, _)| index)
    }

    /// Strain, stress, plastic strain and mobilised strength at the integration points of an element.
    ///
    /// They belong to the end of the last step, and contain the static state. During a run,
    /// `Simulation::structure()` returns the structure, which is downcast to its type. `element`: index of the element,
    /// from [`Mesh::add`](crate::fem::Mesh::add) or [`inelastic_elements`](FemModel::inelastic_elements).
    ///
    /// ```
    /// use basemat::fem::{Material, Mesh, Quad8, SolidMaterial};
    /// use basemat::structure::{FemModel, NonlinearForce, Structure};
    /// # use basemat::fem::StrainPath;
    /// # use basemat::structure::InternalEnergy;
    /// # #[derive(Debug, Clone, Copy)]
    /// # struct Clay(Material);
    /// # impl SolidMaterial for Clay {
    /// #     fn density(&self) -> f64 { self.0.density() }
    /// #     fn elasticity(&self) -> [[f64; 4]; 4] { SolidMaterial::elasticity(&self.0) }
    /// #     fn initialize(&self, stress: [f64; 4], v: &mut [f64]) -> basemat::Result<()> { self.0.initialize(stress, v) }
    /// #     fn stress(&self, e: [f64; 4], v: &[f64]) -> basemat::Result<[f64; 4]> { self.0.stress(e, v) }
    /// #     fn tangent(&self, e: [f64; 4], v: &[f64]) -> basemat::Result<[[f64; 4]; 4]> { self.0.tangent(e, v) }
    /// #     fn energy(&self, e: [f64; 4], v: &[f64]) -> basemat::Result<InternalEnergy> { self.0.energy(e, v) }
    /// #     fn commit(&self, _: [f64; 4], _: &mut [f64]) {}
    /// # }
    ///
    /// // A cube of clay, pressed by 1 mm per metre.
    /// let clay = Clay(Material::new(20.0e6, 0.0, 1900.0)?);
    /// let mesh = Mesh::quad8_block(&[0.0, 1.0], &[0.0, 1.0], |_, _| clay)?;
    /// let mut model = FemModel::on_base(mesh)?;
    /// let mut displacement = vec![0.0; model.dofs()];
    /// for (node, point) in model.mesh().nodes().to_vec().iter().enumerate() {
    ///     let dof = model.dof(node, basemat::fem::Direction::Y).unwrap();
    ///     displacement[dof] = -1e-3 * point[1];
    /// }
    /// model.nonlinear_mut().unwrap().commit(&displacement);
    /// let points = model.solid_points(0)?;
    /// assert_eq!(points.len(), 4);
    /// assert!((points[0].stress[1] + 20.0e3).abs() < 1e-6);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such element, [`Error::Part`] for an element without internal variables, and
    /// errors of its material.
    pub fn solid_points(&self, element: usize) -> Result<Vec<SolidPoint>> {
        self.element_states(element, read_points)
    }

    /// Deformations, resultants and fibre stresses of the sections along a beam of fibres.
    ///
    /// The beam is a [`FiberBeam`](crate::fem::FiberBeam) or a [`SpaceFiberBeam`](crate::fem::SpaceFiberBeam). The states
    /// belong to the end of the last step, as [`solid_points`](FemModel::solid_points). The list is empty for other elements
    /// with internal variables.
    ///
    /// # Errors
    /// As for [`solid_points`](FemModel::solid_points).
    pub fn beam_sections(&self, element: usize) -> Result<Vec<BeamSectionState>> {
        self.element_states(element, read_sections)
    }

    /// Deformation, forces and plastic deformation of a [`Hinge`](crate::fem::Hinge) or another kind of hinge.
    ///
    /// They belong to the end of the last step, as [`solid_points`](FemModel::solid_points).
    ///
    /// # Errors
    /// As for [`solid_points`](FemModel::solid_points); [`Error::Part`] also for an element that is no hinge.
    pub fn hinge_state(&self, element: usize) -> Result<HingeState> {
        let states = self.element_states(element, read_hinge)?;
        let not_a_hinge = || Error::part(format!("element {element}"), "it is no hinge");
        states.first().copied().ok_or_else(not_a_hinge)
    }

    /// States in an element at the end of the last step.
    fn element_states<T>(&self, element: usize, read: ReadStates<T>) -> Result<Vec<T>> {
        in_bounds("element", element, self.mesh().elements().len())?;
        let states = self.inelastic.as_ref().and_then(|elements| elements.states(element, read));
        states.unwrap_or_else(|| {
            let reason = "it is linear: points have states in elements with internal variables";
            Err(Error::part(format!("element {element}"), reason))
        })
    }
}
