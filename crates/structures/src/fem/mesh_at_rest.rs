//! Meshes whose elements begin at rest.

use super::element::Element;
use super::mesh::Mesh;
use super::stress_at_rest::StressAtRest;
use crate::error::{Error, Result, require};

impl Mesh {
    /// Makes all present elements soil that begins at rest, with these stresses.
    ///
    /// The elements are [`Quad4`](super::Quad4) and [`Quad8`](super::Quad8) below the surface y = 0; elements that are
    /// added later, such as a foundation on the soil, have their weight. Stresses at rest, the weight of the soil and the
    /// pressures at rest around it are in equilibrium. All three are left out of a run:
    ///
    /// * the force of such an element is ∫Bᵀ(σ − σ₀) with the stress at rest σ₀ at each integration point, so that the
    ///   soil does not move on any mesh, and layers may end within elements;
    /// * the soil has inertia, but no weight ([`Structure::mass_at_rest`](crate::structure::Structure::mass_at_rest));
    /// * tractions on the trench are **changes** from the state at rest. A ground's pressures at rest do not act.
    ///
    /// The material yields under the whole stress σ, which [`FemModel::solid_points`](crate::structure::FemModel::solid_points)
    /// returns: its strength is that of the material, the stress at rest included. The stored energy is relative to the
    /// state at rest, less the work σ₀ : ε of weight and pressures at rest. Linear elastic soil has no stresses at rest, and
    /// only its weight is left out.
    ///
    /// [`FemModel::on_soil_at_rest`](crate::structure::FemModel::on_soil_at_rest) takes such a mesh. The soil fills a trench:
    /// its sides touch the trench, the surface, or other soil at rest.
    ///
    /// ```
    /// use basemat::fem::{DruckerPrager, Material, Mesh, StressAtRest};
    /// use basemat::structure::FemModel;
    ///
    /// let sand = DruckerPrager::new(Material::new(80.0e6, 0.3, 1900.0)?, 1.0e3, 0.6, 0.6)?;
    /// let lines = [-4.0, -2.0, 0.0, 2.0, 4.0];
    /// let mesh = Mesh::quad8_block(&lines, &[-3.0, -1.5, 0.0], |_, _| sand.clone())?
    ///     .with_stress_at_rest(&StressAtRest::new(9.81, 1900.0, 0.5)?)?;
    /// let model = FemModel::on_soil_at_rest(mesh)?;
    /// let point = model.solid_points(0)?[0];
    /// assert!((point.stress[1] - 9.81 * 1900.0 * point.position[1]).abs() < 1e-6);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Item`] with the element: for one that is no quadrilateral, or lies above the surface; for a stress at rest
    /// outside the yield surface of its material, with the depth.
    pub fn with_stress_at_rest(mut self, stress: &StressAtRest) -> Result<Self> {
        let tolerance = self.height_tolerance();
        let mut elements_at_rest = Vec::with_capacity(self.elements().len());
        for (index, element) in self.elements().enumerate() {
            let element_at_rest = element_at_rest(&self, element, stress, tolerance)
                .map_err(|fault| fault.within(format!("element {index}")))?;
            elements_at_rest.push(element_at_rest);
        }
        let mut replacements = elements_at_rest.into_iter();
        self.replace_elements(|_, _| replacements.next())?;
        Ok(self)
    }
}

/// Copy of an element as soil at rest below the surface.
fn element_at_rest(
    mesh: &Mesh,
    element: &dyn Element,
    stress: &StressAtRest,
    tolerance: f64,
) -> Result<Box<dyn Element>> {
    let coordinates = mesh.coordinates(element.nodes());
    for [_, y, _] in &coordinates {
        let needed = "at most 0, the height of the surface";
        require("height of a node of soil at rest", *y, *y <= tolerance, needed)?;
    }
    let element_at_rest = element.with_stress_at_rest(stress).ok_or(Error::Scene {
        quantity: "soil at rest",
        needed: "must be four- or eight-node quadrilaterals: add other elements afterwards",
    })?;
    element_at_rest.check(&coordinates)?;
    Ok(element_at_rest)
}
