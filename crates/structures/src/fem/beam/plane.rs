//! Straight beam or column in the plane.

use super::axes::EndFrame;
use super::local_matrices::{
    AxialForce, BarMatrix, Bending, BendingMatrix, bar_mass, bar_stiffness, copy_block,
};
use crate::error::{Result, finite, not_negative, positive};
use crate::fem::element::{Element, MassKind};
use crate::fem::line::ElementLine;
use crate::fem::vector::{add_scaled, cross, unit_vector};
use crate::geometry::{Direction, PLANE_DIRECTIONS};

/// Straight prismatic beam in the plane, rigidly connected to its two nodes.
///
/// Meshes in space have a [`SpaceBeam`](super::SpaceBeam).
///
/// It is an Euler–Bernoulli beam with axial deformation; [`with_shear_stiffness`](Beam::with_shear_stiffness) makes it
/// a Timoshenko beam. The displacements of the nodes are exact for loads at the nodes (Przemieniecki, Theory of Matrix
/// Structural Analysis, 1968, ch. 5). Rotary inertia of the cross-section is included only with
/// [`with_rotary_inertia`](Beam::with_rotary_inertia). The P–Δ effect of an axial force is included only if
/// [`with_compression`](Beam::with_compression) gives the force or
/// [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) computes it. Quadrilaterals do not restrain the
/// rotation of their nodes: a beam that ends on a quadrilateral is hinged there, unless it continues along the edge of
/// a second one.
///
/// ```
/// use basemat::fem::{Beam, Element};
///
/// let beam = Beam::new([0, 1], 30.0e9, 0.5, 0.01, 2400.0)?;
/// let mut stiffness = vec![0.0; 36];
/// beam.stiffness(&[[0.0; 3], [0.0, 10.0, 0.0]], &mut stiffness);
/// assert!((stiffness[0] - 12.0 * 30.0e9 * 0.01 / 1000.0).abs() < 1e-6); // 12 EI/L³ sideways
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Beam {
    nodes: [usize; 2],
    axial_stiffness: f64,
    bending: Bending,
    mass_per_length: f64,
    axial_force: AxialForce,
}

impl Beam {
    /// Beam of one material and cross-section.
    ///
    /// Young's modulus in Pa, area in m², second moment of area in m⁴, density in kg/m³. Area and second moment are per
    /// metre of thickness.
    ///
    /// A plate strip in plane strain has E/(1−ν²) in place of E.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all are positive; the density may be zero.
    pub fn new(
        nodes: [usize; 2],
        young_modulus: f64,
        area: f64,
        second_moment: f64,
        density: f64,
    ) -> Result<Self> {
        positive("Young's modulus of the beam", young_modulus)?;
        positive("area of the beam", area)?;
        positive("second moment of area of the beam", second_moment)?;
        not_negative("density of the beam", density)?;
        Ok(Self {
            nodes,
            axial_stiffness: positive("axial stiffness of the beam", young_modulus * area)?,
            bending: Bending {
                flexural_rigidity: positive("bending stiffness", young_modulus * second_moment)?,
                shear_stiffness: None,
                section_inertia: not_negative("inertia of the section", density * second_moment)?,
                has_rotary_inertia: false,
            },
            mass_per_length: not_negative("mass per length of the beam", density * area)?,
            axial_force: AxialForce::default(),
        })
    }

    /// Adds shear deformation; `shear_stiffness` is G times the shear area, N.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is positive.
    pub fn with_shear_stiffness(self, shear_stiffness: f64) -> Result<Self> {
        let shear_stiffness = Some(positive("shear stiffness of the beam", shear_stiffness)?);
        Ok(Self { bending: Bending { shear_stiffness, ..self.bending }, ..self })
    }

    /// Adds the rotary inertia ρ I of the cross-section.
    ///
    /// With shear stiffness the beam is then a complete Timoshenko beam.
    #[must_use]
    pub fn with_rotary_inertia(self) -> Self {
        Self { bending: Bending { has_rotary_inertia: true, ..self.bending }, ..self }
    }

    /// Makes the beam a beam–column with a constant axial force.
    ///
    /// `compression` is in N, negative for tension. The force P adds −½ P ∫ w′² dx to the potential energy, where w is
    /// the lateral displacement (P–Δ and P–δ). P is the force in the static state, for example the weight of the
    /// structure above the beam. [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) does not change a
    /// force from this method. In a rigid rotation the end forces of the beam form a couple, as in a real column.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite.
    pub fn with_compression(self, compression: f64) -> Result<Self> {
        let compression = finite("axial force of the beam", compression)?;
        Ok(Self { axial_force: AxialForce::prescribed(compression), ..self })
    }

    /// Axes of the beam, whose ends are at its nodes.
    #[expect(clippy::unused_self, reason = "the same signature as for beams in space")]
    pub(crate) fn end_frame(&self, coordinates: &[[f64; 3]]) -> Option<EndFrame> {
        let &[first, second] = coordinates else { return None };
        let tangent = unit_vector(add_scaled(second, -1.0, first));
        let out_of_plane = [0.0, 0.0, 1.0];
        let axes = [tangent, cross(out_of_plane, tangent), out_of_plane];
        Some(EndFrame { axes, offsets: [[0.0; 3]; 2] })
    }
}

impl Element for Beam {
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
        let Some(line) = ElementLine::between(coordinates) else {
            return;
        };
        let axial = bar_stiffness(self.axial_stiffness / line.length);
        let bending = self.bending.stiffness(line.length);
        line.add_rotated(&local_matrix(&axial, &bending), matrix);
    }

    fn geometric_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Some(line) = ElementLine::between(coordinates) else {
            return;
        };
        if !self.axial_force.is_zero() {
            let bending = self.bending.geometric_stiffness(&self.axial_force, line.length);
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
        let &[x0, y0, _, x1, y1, _] = displacement else { return None };
        if self.axial_force.is_prescribed {
            return None;
        }
        let elongation = line.elongation(&[x0, y0], &[x1, y1]);
        // Nodal displacements are exact. The compression computed from the elongation is therefore the mean over the
        // length. The compression varies between the nodes because of the element's weight.
        let height_difference = coordinates[1][1] - coordinates[0][1];
        let axial_force = AxialForce {
            compression: -self.axial_stiffness / line.length * elongation,
            end_difference: self.mass_per_length * gravity * height_difference,
            is_prescribed: false,
        };
        Some(Box::new(Self { axial_force, ..self.clone() }))
    }

    fn compression(&self) -> Option<f64> {
        Some(self.axial_force.compression)
    }

    /// Lumped: half the mass and the rotary inertia m L²/78 at each node.
    ///
    /// The rotary inertia has the ratio of the consistent diagonal (Hinton, Rock & Zienkiewicz 1976). With rotary
    /// inertia of the sections, each node gets half of it.
    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let Some(line) = ElementLine::between(coordinates) else {
            return;
        };
        let mass = self.mass_per_length * line.length;
        let bending = self.bending.mass(kind, mass, line.length);
        line.add_rotated(&local_matrix(&bar_mass(kind, mass), &bending), matrix);
    }

    /// [`Error::Input`](crate::Error::Input) when the two nodes coincide.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        ElementLine::check_length("length of the beam", coordinates)
    }
}

/// Local matrix: axial displacement, deflection and rotation, at both ends.
pub(super) fn local_matrix(axial: &BarMatrix, bending: &BendingMatrix) -> [[f64; 6]; 6] {
    let mut matrix = [[0.0; 6]; 6];
    copy_block(axial, [0, 3], &mut matrix);
    copy_block(bending, [1, 2, 4, 5], &mut matrix);
    matrix
}
