//! Beam of fibres in space.

use std::sync::Arc;

use super::axes::BeamAxes;
use super::deformed_fibers::{BasicRows, FiberElement, Torsion, fiber_element_force};
use super::local_matrices::{AxialForce, BarMatrix, Bending, bar_mass};
use super::space::{local_matrix, within_beam};
use crate::error::{Error, Result, all_finite, finite, not_negative, positive, same_length};
use crate::fem::element::{Element, MassKind};
use crate::fem::element_matrix::add_transformed;
use crate::fem::fiber::{
    BasicBeam, BeamFormulation, BeamPoint, BeamQuadrature, FiberSection, SPACE_BENDING,
    SolutionMemo,
};
use crate::fem::inelastic_force::{BeamSectionState, InelasticForce};
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::vector::norm;
use crate::geometry::{Direction, SPACE_DIRECTIONS};

/// Number of degrees of freedom.
const DOF_COUNT: usize = 12;
/// Number of basic deformations of stretching and bending.
const BASIC_COUNT: usize = 5;

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

    /// Rotary inertia about the line of the nodes per length, kg m: of mass spread as the stiffness of the fibres.
    fn polar_inertia(&self) -> f64 {
        let [[axial, ..], [_, bending_y, _], [.., bending_z]] = self.section.elastic_stiffness();
        self.mass_per_length * (bending_y + bending_z) / axial
    }
}

impl FiberElement<3, BASIC_COUNT, DOF_COUNT> for SpaceFiberBeam {
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

    /// Rotations relative to the chord are about z, then about y.
    fn basic_rows(&self, coordinates: &[[f64; 3]]) -> Result<BasicRows<BASIC_COUNT, DOF_COUNT>> {
        let needed = "two nodes at a distance, and an orientation that is not along the beam";
        let BeamAxes { axes: [x, y, z], length } = self
            .axes(coordinates)
            .ok_or(Error::Scene { quantity: "beam of fibres in space", needed })?;
        let mut rows = [[0.0; DOF_COUNT]; BASIC_COUNT];
        let mut twist = [0.0; DOF_COUNT];
        for k in 0..3 {
            rows[0][k] = -x[k];
            rows[0][6 + k] = x[k];
            // The chord turns about z by displacements along y, and about y by those against z.
            let about_z = y[k] / length;
            let about_y = -z[k] / length;
            for (first_row, chord_rotation, axis) in [(1, about_z, z), (3, about_y, y)] {
                for row in first_row..first_row + 2 {
                    rows[row][k] = chord_rotation;
                    rows[row][6 + k] = -chord_rotation;
                }
                rows[first_row][3 + k] = axis[k];
                rows[first_row + 1][9 + k] = axis[k];
            }
            twist[3 + k] = -x[k];
            twist[9 + k] = x[k];
        }
        let torsion = Torsion { row: twist, stiffness: self.torsional_stiffness / length };
        Ok(BasicRows { length, rows, torsion: Some(torsion) })
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
        let Ok(rows) = self.basic_rows(coordinates) else { return };
        if let Some(stiffness) = self.basic_beam(rows.length).elastic_stiffness() {
            rows.add_stiffness(&stiffness, matrix);
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
        if self.axial_force.is_prescribed {
            return None;
        }
        let &[first, second] = coordinates else { return None };
        let end_difference = self.mass_per_length * gravity * (second[2] - first[2]);
        let axial_force = self.static_axial_force(coordinates, displacement, end_difference)?;
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

fiber_element_force!(SpaceFiberBeam);

#[cfg(test)]
mod tests;
