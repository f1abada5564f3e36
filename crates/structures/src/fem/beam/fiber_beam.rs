//! Beam of fibres in the plane.

use std::sync::Arc;

use super::local_matrices::{AxialForce, Bending, bar_mass};
use super::plane::local_matrix;
use crate::error::{Error, Result, finite, not_negative, same_length};
use crate::fem::element::{Element, MassKind};
use crate::fem::element_matrix::add_matrix;
use crate::fem::fiber::{
    BasicBeam, BasicState, BeamFormulation, BeamPoint, BeamQuadrature, FiberSection, PLANE_BENDING,
    SolutionMemo, plane_strains,
};
use crate::fem::inelastic_force::{BeamSectionState, InelasticForce};
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::line::ElementLine;
use crate::fem::small_matrix::{add_congruent, product};
use crate::fem::vector::add_scaled;
use crate::geometry::{Direction, PLANE_DIRECTIONS};
use crate::linalg::dot;

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

/// Basic deformations (elongation, rotations relative to the chord) due to a unit displacement of each degree of freedom.
type BasicRows = [[f64; DOF_COUNT]; 3];

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

    /// The beam without its rigid motions.
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

    /// State at displacements of the nodes, with the beam and its basic deformations.
    fn deformed(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<DeformedBeam<'_>> {
        self.evaluated(coordinates, displacement, variables, BasicBeam::state)
    }

    /// As [`deformed`](FiberBeam::deformed), without forces and tangent in an element by displacements.
    fn strained(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<DeformedBeam<'_>> {
        self.evaluated(coordinates, displacement, variables, BasicBeam::deformed_state)
    }

    /// State by one of the methods of the basic beam.
    fn evaluated<'a>(
        &'a self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        evaluate: fn(&BasicBeam<'a, 2, 3>, &[f64; 3], &[f64]) -> Result<BasicState<2, 3>>,
    ) -> Result<DeformedBeam<'a>> {
        same_length("coordinates of a beam", coordinates.len(), 2)?;
        same_length("displacement of a beam", displacement.len(), DOF_COUNT)?;
        same_length("internal variables of a beam", variables.len(), self.variable_count())?;
        let needed = "two nodes at a distance";
        let line = ElementLine::between(coordinates)
            .ok_or(Error::Scene { quantity: "beam of fibres", needed })?;
        let rows = basic_rows(&line);
        let beam = self.basic_beam(line.length);
        let v = rows.map(|row| dot(&row, displacement));
        let state = evaluate(&beam, &v, variables)?;
        Ok(DeformedBeam { beam, rows, v, state })
    }

    /// Bending part, for masses and geometric stiffness.
    fn bending(&self) -> Bending {
        let [[axial, coupling], [_, bending]] = self.section.elastic_stiffness(plane_strains);
        Bending {
            flexural_rigidity: bending - coupling * coupling / axial,
            shear_stiffness: None,
            section_inertia: 0.0,
            has_rotary_inertia: false,
        }
    }
}

/// A beam in a deformed state.
struct DeformedBeam<'a> {
    beam: BasicBeam<'a, 2, 3>,
    rows: BasicRows,
    /// Basic deformations.
    v: [f64; 3],
    state: BasicState<2, 3>,
}

impl DeformedBeam<'_> {
    /// Adds the nodal forces to `force`.
    fn add_force(&self, force: &mut [f64]) {
        for (row, basic_force) in self.rows.iter().zip(self.state.forces) {
            for (nodal_force, entry) in force.iter_mut().zip(row) {
                *nodal_force += basic_force * entry;
            }
        }
    }
}

/// Rows of elongation and rotations relative to the chord, for displacements along x and y and rotations of the nodes.
fn basic_rows(line: &ElementLine) -> BasicRows {
    let [cosine, sine, _] = line.tangent();
    // Rotation of the chord due to displacements to its left.
    let x = sine / line.length;
    let y = cosine / line.length;
    [
        [-cosine, -sine, 0.0, cosine, sine, 0.0],
        [-x, y, 1.0, x, -y, 0.0],
        [-x, y, 0.0, x, -y, 1.0],
    ]
}

/// Adds Rᵀ k R to a row-major `matrix`.
fn add_stiffness(stiffness: &[[f64; 3]; 3], rows: &BasicRows, matrix: &mut [f64]) {
    let mut sum = [[0.0; DOF_COUNT]; DOF_COUNT];
    add_congruent(1.0, rows, stiffness, &mut sum);
    add_matrix(matrix, &sum);
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
        let Some(line) = ElementLine::between(coordinates) else { return };
        if let Some(stiffness) = self.basic_beam(line.length).elastic_stiffness() {
            add_stiffness(&stiffness, &basic_rows(&line), matrix);
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
        let line = ElementLine::between(coordinates)?;
        if self.axial_force.is_prescribed || displacement.len() != DOF_COUNT {
            return None;
        }
        let v = basic_rows(&line).map(|row| dot(&row, displacement));
        let stiffness = self.basic_beam(line.length).elastic_stiffness()?;
        let height_difference = coordinates[1][1] - coordinates[0][1];
        let axial_force = AxialForce {
            compression: -product(&stiffness, &v)[0],
            end_difference: self.mass_per_length * gravity * height_difference,
            is_prescribed: false,
        };
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

impl InelasticForce for FiberBeam {
    fn has_shared_evaluation(&self) -> bool {
        true
    }

    fn variable_count(&self) -> usize {
        self.basic_beam(1.0).variable_count()
    }

    fn initialize(&self, _coordinates: &[[f64; 3]], variables: &mut [f64]) -> Result<()> {
        same_length("internal variables of a beam", variables.len(), self.variable_count())?;
        self.basic_beam(1.0).initialize(variables);
        Ok(())
    }

    fn force(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        force: &mut [f64],
    ) -> Result<()> {
        self.deformed(coordinates, displacement, variables)?.add_force(force);
        Ok(())
    }

    fn tangent(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        matrix: &mut [f64],
    ) -> Result<()> {
        let deformed = self.deformed(coordinates, displacement, variables)?;
        add_stiffness(&deformed.state.stiffness, &deformed.rows, matrix);
        Ok(())
    }

    fn force_and_tangent(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        force: &mut [f64],
        matrix: &mut [f64],
    ) -> Result<()> {
        let deformed = self.deformed(coordinates, displacement, variables)?;
        deformed.add_force(force);
        add_stiffness(&deformed.state.stiffness, &deformed.rows, matrix);
        Ok(())
    }

    fn energy(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<InternalEnergy> {
        let deformed = self.strained(coordinates, displacement, variables)?;
        deformed.beam.energy(&deformed.state, variables)
    }

    fn remainder(
        &self,
        coordinates: &[[f64; 3]],
        displacements: [&[f64]; 3],
        variables: &[f64],
    ) -> Result<f64> {
        let start = self.strained(coordinates, displacements[0], variables)?;
        let midstep = self.strained(coordinates, displacements[1], variables)?;
        let end = self.strained(coordinates, displacements[2], variables)?;
        let increment = std::array::from_fn(|i| end.v[i] - start.v[i]);
        start
            .beam
            .remainder([&start.state, &midstep.state, &end.state], &increment, variables)
    }

    fn sections(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<Vec<BeamSectionState>> {
        let deformed = self.strained(coordinates, displacement, variables)?;
        let states = deformed.beam.section_states(&deformed.state, variables)?;
        let &[first, second] = coordinates else { return Ok(Vec::new()) };
        let along = add_scaled(second, -1.0, first);
        let end_moments = deformed.state.forces[1] + deformed.state.forces[2];
        let shear = -end_moments / deformed.beam.length;
        let sections = states.into_iter().map(|section| BeamSectionState {
            position: add_scaled(first, section.point.position, along),
            length: section.point.weight * deformed.beam.length,
            axial_strain: section.deformations[0],
            curvature: section.deformations[1],
            axial_force: section.forces[0],
            moment: section.forces[1],
            shear,
            fibers: section.fibers,
            ..BeamSectionState::default()
        });
        Ok(sections.collect())
    }

    /// Changes nothing in a state that a beam by forces cannot have.
    fn commit(&self, coordinates: &[[f64; 3]], displacement: &[f64], variables: &mut [f64]) {
        if let Ok(deformed) = self.strained(coordinates, displacement, variables) {
            deformed.beam.commit(&deformed.state, &deformed.v, variables);
        }
    }
}

#[cfg(test)]
mod tests;
