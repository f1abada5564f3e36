//! Beam of fibres in the plane.

use std::sync::Arc;

use super::deformed_fibers::{BasicRows, FiberElement, fiber_element_force};
use super::local_matrices::{AxialForce, Bending, bar_mass};
use super::plane::local_matrix;
use crate::error::{Error, Result, finite, not_negative, same_length};
use crate::fem::element::{Element, MassKind};
use crate::fem::fiber::{
    BasicBeam, BeamFormulation, BeamPoint, BeamQuadrature, FiberSection, PLANE_BENDING,
    SolutionMemo,
};
use crate::fem::inelastic_force::{BeamSectionState, InelasticForce};
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::line::ElementLine;
use crate::geometry::{Direction, PLANE_DIRECTIONS};

/// Number of degrees of freedom.
const DOF_COUNT: usize = 6;

/// Beam or column of fibres in the plane, rigidly connected to its two nodes.
///
/// Meshes in space have a [`SpaceFiberBeam`](super::SpaceFiberBeam).
///
/// An Euler–Bernoulli beam whose [`FiberSection`] is integrated at the points of a [`BeamQuadrature`]. With the
/// [`BeamFormulation`] by displacements (the default) the curvature varies linearly along the element: divide a member
/// where it yields into several elements. With that by forces one element is a member: forces are in equilibrium at
/// each section, and a hinge is as long as the part of the length of its section. Sections stay plane, and shear does not
/// deform them. The P–Δ effect is as for a [`Beam`](super::Beam); it is a stiffness beside the fibres.
///
/// ```
/// use basemat::fem::{BeamQuadrature, BilinearSteel, Element, FiberBeam, FiberSection, Mesh};
/// use basemat::structure::FemModel;
///
/// let steel = BilinearSteel::new(355.0e6, 210.0e9, 0.005)?;
/// let section = FiberSection::new().with_i_section([0.3, 0.15], [7.1e-3, 10.7e-3], [2, 8], steel)?;
/// let mut mesh = Mesh::new();
/// let base = mesh.add_node(0.0, 0.0)?;
/// let mut below = base;
/// for i in 1..=4 {
///     let above = mesh.add_node(0.0, 0.75 * i as f64)?;
///     mesh.add(FiberBeam::new([below, above], &section, BeamQuadrature::Lobatto(4), 42.2)?)?;
///     below = above;
/// }
/// assert_eq!(mesh.elements().filter(|column| column.inelastic().is_some()).count(), 4);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct FiberBeam {
    nodes: [usize; 2],
    section: Arc<FiberSection>,
    points: Arc<[BeamPoint]>,
    formulation: BeamFormulation,
    mass_per_length: f64,
    axial_force: AxialForce,
    memo: SolutionMemo<2, 3>,
}

impl FiberBeam {
    /// Beam of one section and a mass per length, kg/m (in the plane per metre of thickness).
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for a section of fewer than two fibres and
    /// [`Error::Input`](crate::Error::Input) for fibres at one y, for a rule without 2 to 5 points, and unless the mass is
    /// finite and not negative.
    pub fn new(
        nodes: [usize; 2],
        section: &FiberSection,
        quadrature: BeamQuadrature,
        mass_per_length: f64,
    ) -> Result<Self> {
        section.check_plane()?;
        Ok(Self {
            nodes,
            section: Arc::new(section.clone()),
            points: quadrature.points()?.into(),
            formulation: BeamFormulation::default(),
            mass_per_length: not_negative("mass per length of the beam", mass_per_length)?,
            axial_force: AxialForce::default(),
            memo: SolutionMemo::default(),
        })
    }

    /// Sets how deformations of sections follow from those of the element.
    #[must_use]
    pub fn with_formulation(self, formulation: BeamFormulation) -> Self {
        Self { formulation, ..self }
    }

    /// Makes the beam a beam–column with a constant axial force for its P–Δ effect.
    ///
    /// As [`Beam::with_compression`](super::Beam::with_compression). The force has no part in the stresses of the fibres.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite.
    pub fn with_compression(self, compression: f64) -> Result<Self> {
        let compression = finite("axial force of the beam", compression)?;
        Ok(Self { axial_force: AxialForce::prescribed(compression), ..self })
    }

    /// Bending part, for masses and geometric stiffness.
    fn bending(&self) -> Bending {
        let [[axial, coupling], [_, bending]] = self.section.elastic_stiffness();
        Bending {
            flexural_rigidity: bending - coupling * coupling / axial,
            shear_stiffness: None,
            section_inertia: 0.0,
            has_rotary_inertia: false,
        }
    }
}

impl FiberElement<2, 3, DOF_COUNT> for FiberBeam {
    fn basic_beam(&self, length: f64) -> BasicBeam<'_, 2, 3> {
        BasicBeam {
            interpolation: &PLANE_BENDING,
            formulation: self.formulation,
            section: &self.section,
            points: &self.points,
            length,
            memo: &self.memo,
        }
    }

    fn basic_rows(&self, coordinates: &[[f64; 3]]) -> Result<BasicRows<3, DOF_COUNT>> {
        let needed = "two nodes at a distance";
        let line = ElementLine::between(coordinates)
            .ok_or(Error::Scene { quantity: "beam of fibres", needed })?;
        let [cosine, sine, _] = line.tangent();
        // Rotation of the chord due to displacements to its left.
        let x = sine / line.length;
        let y = cosine / line.length;
        let rows = [
            [-cosine, -sine, 0.0, cosine, sine, 0.0],
            [-x, y, 1.0, x, -y, 0.0],
            [-x, y, 0.0, x, -y, 1.0],
        ];
        Ok(BasicRows { length: line.length, rows, torsion: None })
    }
}

impl Element for FiberBeam {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        Some(Box::new(Self { nodes: nodes.try_into().ok()?, ..self.clone() }))
    }

    fn directions(&self) -> &[Direction] {
        PLANE_DIRECTIONS
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Ok(rows) = self.basic_rows(coordinates) else { return };
        if let Some(stiffness) = self.basic_beam(rows.length).elastic_stiffness() {
            rows.add_stiffness(&stiffness, matrix);
        }
    }

    fn inelastic(&self) -> Option<&dyn InelasticForce> {
        Some(self)
    }

    fn geometric_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Some(line) = ElementLine::between(coordinates) else { return };
        if !self.axial_force.is_zero() {
            let bending = self.bending().geometric_stiffness(&self.axial_force, line.length);
            line.add_rotated(&local_matrix(&[[0.0; 2]; 2], &bending), matrix);
        }
    }

    fn in_static_state(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        gravity: f64,
    ) -> Option<Box<dyn Element>> {
        if self.axial_force.is_prescribed {
            return None;
        }
        let &[first, second] = coordinates else { return None };
        let end_difference = self.mass_per_length * gravity * (second[1] - first[1]);
        let axial_force = self.static_axial_force(coordinates, displacement, end_difference)?;
        Some(Box::new(Self { axial_force, ..self.clone() }))
    }

    fn compression(&self) -> Option<f64> {
        Some(self.axial_force.compression)
    }

    /// As for [`Beam`](super::Beam), without rotary inertia of the sections.
    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let Some(line) = ElementLine::between(coordinates) else { return };
        let mass = self.mass_per_length * line.length;
        let bending = self.bending().mass(kind, mass, line.length);
        line.add_rotated(&local_matrix(&bar_mass(kind, mass), &bending), matrix);
    }

    /// [`Error::Input`](crate::Error::Input) when the two nodes coincide.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        ElementLine::check_length("length of the beam", coordinates)
    }
}

fiber_element_force!(FiberBeam);

#[cfg(test)]
mod tests;
