//! Beam of fibres in space.

mod deformed;

use std::sync::Arc;

use super::axes::BeamAxes;
use super::basic_rows::{BASIC_COUNT, BasicRows, DOF_COUNT};
use super::local_matrices::{AxialForce, BarMatrix, Bending, bar_mass};
use super::space::{local_matrix, within_beam};
use crate::error::{Result, all_finite, finite, not_negative, positive, same_length};
use crate::fem::element::{Element, MassKind};
use crate::fem::element_matrix::add_transformed;
use crate::fem::fiber::{
    BasicBeam, BeamFormulation, BeamPoint, BeamQuadrature, FiberSection, SPACE_BENDING,
    SolutionMemo, space_strains,
};
use crate::fem::inelastic_force::{BeamSectionState, InelasticForce};
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::small_matrix::product;
use crate::fem::vector::{add_scaled, norm};
use crate::geometry::{Direction, SPACE_DIRECTIONS};
use crate::linalg::dot;

/// Bending of one plane for masses and geometric stiffness: without shear deformation its shapes have no stiffness in them.
const SLENDER_BENDING: Bending = Bending {
    flexural_rigidity: 0.0,
    shear_stiffness: None,
    section_inertia: 0.0,
    has_rotary_inertia: false,
};

/// Beam or column of fibres in space, rigidly connected to its two nodes.
///
/// As [`FiberBeam`](super::FiberBeam), with axial force and bending about both axes of its [`FiberSection`] together. Torsion
/// is elastic, by the [torsional stiffness](FiberSection::with_torsional_stiffness) of the section, and not coupled with
/// the fibres. Axes, signs and the P–Δ effect are those of a [`SpaceBeam`](super::SpaceBeam): x runs along the beam, y along
/// the component of the `orientation` normal to x, and z completes a right-handed system.
///
/// ```
/// use basemat::fem::{BeamQuadrature, BilinearSteel, Element, FiberSection, Mesh, SpaceFiberBeam};
///
/// // A square column of steel, 0.3 m wide.
/// let steel = BilinearSteel::new(355.0e6, 210.0e9, 0.005)?;
/// let section = FiberSection::new()
///     .with_rectangle([[-0.15, -0.15], [0.15, 0.15]], [10, 10], steel)?
///     .with_torsional_stiffness(81.0e9 * 0.141 * 0.3_f64.powi(4))?;
/// let mut mesh = Mesh::in_space();
/// let foot = mesh.add_node_at([0.0, 0.0, 0.0])?;
/// let top = mesh.add_node_at([0.0, 0.0, 3.0])?;
/// let quadrature = BeamQuadrature::Lobatto(5);
/// let column = SpaceFiberBeam::new([foot, top], &section, quadrature, 706.5, [1.0, 0.0, 0.0])?;
/// let mut stiffness = vec![0.0; 144];
/// column.stiffness(&[[0.0; 3], [0.0, 0.0, 3.0]], &mut stiffness);
/// let second_moment = 0.3_f64.powi(4) / 12.0 * 0.99; // ten fibres leave out 1 %
/// assert!((stiffness[0] / (12.0 * 210.0e9 * second_moment / 27.0) - 1.0).abs() < 1e-12);
/// mesh.add(column)?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SpaceFiberBeam {
    nodes: [usize; 2],
    section: Arc<FiberSection>,
    /// G J, N m².
    torsional_stiffness: f64,
    points: Arc<[BeamPoint]>,
    formulation: BeamFormulation,
    mass_per_length: f64,
    orientation: [f64; 3],
    axial_force: AxialForce,
    memo: SolutionMemo<3, BASIC_COUNT>,
}

impl SpaceFiberBeam {
    /// Beam of one section with a mass per length (kg/m) and an orientation.
    ///
    /// The y axis of the section lies in the plane of the beam and the `orientation`, a vector [x, y, z] of any length.
    ///
    /// # Errors
    /// [`Error::Size`] for a section of fewer than three fibres; [`Error::Input`] for fibres on a line, for shapes that are
    /// not divided along y and z, for a rule without 2 to 5 points, for an orientation without length, and unless the
    /// mass is finite and not negative; [`Error::NotFinite`] for the orientation; [`Error::Scene`] for a section without
    /// torsional stiffness. [`Mesh::add`](crate::fem::Mesh::add) returns an error for a beam without length or along its
    /// orientation. Each of these errors is in an [`Error::Item`] that names the nodes.
    ///
    /// [`Error::Size`]: crate::Error::Size
    /// [`Error::Input`]: crate::Error::Input
    /// [`Error::NotFinite`]: crate::Error::NotFinite
    /// [`Error::Scene`]: crate::Error::Scene
    /// [`Error::Item`]: crate::Error::Item
    pub fn new(
        nodes: [usize; 2],
        section: &FiberSection,
        quadrature: BeamQuadrature,
        mass_per_length: f64,
        orientation: [f64; 3],
    ) -> Result<Self> {
        Self::without_context(nodes, section, quadrature, mass_per_length, orientation)
            .map_err(|fault| within_beam(nodes, fault))
    }

    /// [`SpaceFiberBeam::new`] with errors that do not name the nodes.
    fn without_context(
        nodes: [usize; 2],
        section: &FiberSection,
        quadrature: BeamQuadrature,
        mass_per_length: f64,
        orientation: [f64; 3],
    ) -> Result<Self> {
        all_finite("orientation of the beam", &orientation)?;
        positive("length of the beam's orientation", norm(orientation))?;
        Ok(Self {
            nodes,
            section: Arc::new(section.clone()),
            torsional_stiffness: section.check_space()?,
            points: quadrature.points()?.into(),
            formulation: BeamFormulation::default(),
            mass_per_length: not_negative("mass per length of the beam", mass_per_length)?,
            orientation,
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
    /// As [`Beam::with_compression`](super::Beam::with_compression), in both planes. The force has no part in the stresses
    /// of the fibres.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite.
    pub fn with_compression(self, compression: f64) -> Result<Self> {
        let compression = finite("axial force of the beam", compression)
            .map_err(|fault| within_beam(self.nodes, fault))?;
        Ok(Self { axial_force: AxialForce::prescribed(compression), ..self })
    }

    /// Axes of the beam; `None` for a beam that [`check`](Element::check) does not accept.
    fn axes(&self, coordinates: &[[f64; 3]]) -> Option<BeamAxes> {
        BeamAxes::new(coordinates.try_into().ok()?, self.orientation).ok()
    }

    /// Stretching and bending of the beam without its rigid motions.
    fn basic_beam(&self, length: f64) -> BasicBeam<'_, 3, BASIC_COUNT> {
        BasicBeam {
            interpolation: &SPACE_BENDING,
            formulation: self.formulation,
            section: &self.section,
            points: &self.points,
            length,
            memo: &self.memo,
        }
    }

    /// Rotary inertia about the line of the nodes per length, kg m: of mass spread as the stiffness of the fibres.
    fn polar_inertia(&self) -> f64 {
        let [[axial, ..], [_, bending_y, _], [.., bending_z]] =
            self.section.elastic_stiffness(space_strains);
        self.mass_per_length * (bending_y + bending_z) / axial
    }
}

impl Element for SpaceFiberBeam {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        Some(Box::new(Self { nodes: nodes.try_into().ok()?, ..self.clone() }))
    }

    fn directions(&self) -> &[Direction] {
        SPACE_DIRECTIONS
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Some(axes) = self.axes(coordinates) else { return };
        if let Some(stiffness) = self.basic_beam(axes.length).elastic_stiffness() {
            let torsional_stiffness = self.torsional_stiffness / axes.length;
            BasicRows::new(&axes).add_stiffness(&stiffness, torsional_stiffness, matrix);
        }
    }

    fn inelastic(&self) -> Option<&dyn InelasticForce> {
        Some(self)
    }

    fn geometric_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Some(axes) = self.axes(coordinates).filter(|_| !self.axial_force.is_zero()) else {
            return;
        };
        let zero: BarMatrix = [[0.0; 2]; 2];
        let bending = SLENDER_BENDING.geometric_stiffness(&self.axial_force, axes.length);
        let local_stiffness = local_matrix(&zero, &zero, &[bending; 2]);
        add_transformed(&local_stiffness, &axes.to_local(&[[0.0; 3]; 2]), matrix);
    }

    fn in_static_state(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        gravity: f64,
    ) -> Option<Box<dyn Element>> {
        let axes = self.axes(coordinates)?;
        if self.axial_force.is_prescribed || displacement.len() != DOF_COUNT {
            return None;
        }
        let v = BasicRows::new(&axes).bending.map(|row| dot(&row, displacement));
        let stiffness = self.basic_beam(axes.length).elastic_stiffness()?;
        let height_difference = coordinates[1][2] - coordinates[0][2];
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

    /// As for [`SpaceBeam`](super::SpaceBeam), without rotary inertia of bending.
    ///
    /// The rotary inertia of torsion is that of a mass spread over the fibres as their stiffness.
    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let Some(axes) = self.axes(coordinates) else { return };
        let mass = self.mass_per_length * axes.length;
        let bending = SLENDER_BENDING.mass(kind, mass, axes.length);
        let torsion = bar_mass(kind, self.polar_inertia() * axes.length);
        let local_mass = local_matrix(&bar_mass(kind, mass), &torsion, &[bending; 2]);
        add_transformed(&local_mass, &axes.to_local(&[[0.0; 3]; 2]), matrix);
    }

    /// [`Error::Input`](crate::Error::Input) in an [`Error::Item`](crate::Error::Item) when the nodes coincide or the
    /// orientation lies along the beam.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length("coordinates of a beam", coordinates.len(), 2)?;
        let ends = [coordinates[0], coordinates[1]];
        let axes = BeamAxes::new(ends, self.orientation);
        axes.map(drop).map_err(|fault| within_beam(self.nodes, fault))
    }
}

impl InelasticForce for SpaceFiberBeam {
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
        self.deformed(coordinates, displacement, variables)?.add_tangent(matrix);
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
        deformed.add_tangent(matrix);
        Ok(())
    }

    fn energy(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<InternalEnergy> {
        let deformed = self.strained(coordinates, displacement, variables)?;
        let mut energy = deformed.beam.energy(&deformed.state, variables)?;
        energy.stored += deformed.torsion.energy();
        Ok(energy)
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
        let states = [&start.state, &midstep.state, &end.state];
        let bending = start.beam.remainder(states, &increment, variables)?;
        // Work of the torque at mid-step less that of the mean torque, which the torsion stores.
        let mean_twist = 0.5 * (start.torsion.twist + end.torsion.twist);
        let torque_difference = midstep.torsion.stiffness * (midstep.torsion.twist - mean_twist);
        Ok(bending + torque_difference * (end.torsion.twist - start.torsion.twist))
    }

    fn sections(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<Vec<BeamSectionState>> {
        let deformed = self.deformed(coordinates, displacement, variables)?;
        let states = deformed.beam.section_states(&deformed.state, variables)?;
        let &[first, second] = coordinates else { return Ok(Vec::new()) };
        let along = add_scaled(second, -1.0, first);
        let length = deformed.beam.length;
        let end_forces = deformed.state.forces;
        let sections = states.into_iter().map(|section| BeamSectionState {
            position: add_scaled(first, section.point.position, along),
            length: section.point.weight * length,
            axial_strain: section.deformations[0],
            curvature: section.deformations[1],
            curvature_about_y: section.deformations[2],
            twist_rate: deformed.torsion.twist / length,
            axial_force: section.forces[0],
            moment: section.forces[1],
            moment_about_y: section.forces[2],
            torque: deformed.torsion.torque(),
            shear: -(end_forces[1] + end_forces[2]) / length,
            shear_along_z: (end_forces[3] + end_forces[4]) / length,
            fibers: section.fibers,
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
