//! Straight beam or column in space.

use super::axes::{BeamAxes, EndFrame, EndsMatrix};
use super::local_matrices::{
    AxialForce, BarMatrix, Bending, BendingMatrix, bar_mass, bar_stiffness, copy_block,
};
use super::releases::Releases;
use super::section::BeamSection;
use crate::error::{Error, Result, all_finite, finite, positive, same_length};
use crate::fem::element::{Element, MassKind};
use crate::fem::element_matrix::add_transformed;
use crate::fem::material::Material;
use crate::fem::vector::{add_scaled, dot, norm};
use crate::geometry::{Direction, SPACE_DIRECTIONS};

/// Straight prismatic beam in space, rigidly connected to its two nodes.
///
/// It stretches, twists (St Venant) and bends in two planes; shear areas of its
/// [section](BeamSection::with_shear_areas) make it a Timoshenko beam. The displacements of the nodes are exact for
/// loads at the nodes. The axis x runs along the beam, y along the component of its `orientation` normal to x, and z
/// completes a right-handed system.
///
/// Its lumped mass is diagonal in the axes of the beam. In other axes it couples the rotations of a node, and offsets
/// couple these to the displacements. As for [`Beam`](super::Beam), rotary inertia of bending and the P–Δ effect of
/// axial forces are options. Warping and the effect of axial forces on torsion are neglected. In the static state of
/// [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) shear forces, moments and torque rotate with
/// the beam, so that several beams along a girder can buckle laterally.
///
/// ```
/// use basemat::fem::{BeamSection, Element, Material, SpaceBeam};
///
/// let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
/// let section = BeamSection::new(0.12, [1.6e-3, 0.9e-3], 1.94e-3)?;
/// // A column with the y axis of its section along x.
/// let column = SpaceBeam::new([0, 1], concrete, section, [1.0, 0.0, 0.0])?;
/// let mut stiffness = vec![0.0; 144];
/// column.stiffness(&[[0.0; 3], [0.0, 0.0, 4.0]], &mut stiffness);
/// let along_x = 12.0 * 30.0e9 * 0.9e-3 / 64.0; // 12 E I_z/L³
/// assert!((stiffness[0] / along_x - 1.0).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceBeam {
    nodes: [usize; 2],
    orientation: [f64; 3],
    /// Vectors from the nodes to the ends, m.
    offsets: [[f64; 3]; 2],
    releases: Releases,
    /// E A, N.
    axial_stiffness: f64,
    /// G J, N m².
    torsional_stiffness: f64,
    /// Bending along y, then along z.
    bending: [Bending; 2],
    mass_per_length: f64,
    axial_force: AxialForce,
}

impl SpaceBeam {
    /// Beam of a material and a section.
    ///
    /// The section's y axis lies in the plane of the beam and the `orientation`.
    ///
    /// The orientation is a vector [x, y, z] of any length. Releases and forces refer to the axes of the section even
    /// if both second moments are equal.
    ///
    /// # Errors
    /// [`Error::NotFinite`] and [`Error::Input`] for an orientation that is not finite or has no length, and for
    /// stiffnesses that are too small or too large for a floating-point number. [`Mesh::add`](crate::fem::Mesh::add)
    /// returns an error for a beam without length or along its orientation. Each of these errors is in an
    /// [`Error::Item`] that names the nodes.
    pub fn new(
        nodes: [usize; 2],
        material: Material,
        section: BeamSection,
        orientation: [f64; 3],
    ) -> Result<Self> {
        Self::without_context(nodes, material, section, orientation)
            .map_err(|fault| within_beam(nodes, fault))
    }

    /// [`SpaceBeam::new`] with errors that do not name the nodes.
    fn without_context(
        nodes: [usize; 2],
        material: Material,
        section: BeamSection,
        orientation: [f64; 3],
    ) -> Result<Self> {
        all_finite("orientation of the beam", &orientation)?;
        positive("length of the beam's orientation", norm(orientation))?;
        let axial_stiffness = material.young_modulus() * section.area;
        let torsional_stiffness = material.shear_modulus() * section.torsion_constant;
        Ok(Self {
            nodes,
            orientation,
            offsets: [[0.0; 3]; 2],
            releases: Releases::default(),
            axial_stiffness: positive("axial stiffness of the beam", axial_stiffness)?,
            torsional_stiffness: positive("torsional stiffness of the beam", torsional_stiffness)?,
            bending: [
                Self::bending_along(&material, &section, 0)?,
                Self::bending_along(&material, &section, 1)?,
            ],
            mass_per_length: finite(
                "mass per length of the beam",
                material.density() * section.area,
            )?,
            axial_force: AxialForce::default(),
        })
    }

    /// Bending along y (`axis` 0, about z) or along z (`axis` 1, about y).
    fn bending_along(material: &Material, section: &BeamSection, axis: usize) -> Result<Bending> {
        let second_moment = section.second_moments[1 - axis];
        let shear_stiffness =
            section.shear_areas.map(|areas| material.shear_modulus() * areas[axis]);
        shear_stiffness.map(|k| positive("shear stiffness of the beam", k)).transpose()?;
        let flexural_rigidity = material.young_modulus() * second_moment;
        let section_inertia = material.density() * second_moment;
        Ok(Bending {
            flexural_rigidity: positive("bending stiffness of the beam", flexural_rigidity)?,
            shear_stiffness,
            section_inertia: finite("inertia of the section", section_inertia)?,
            has_rotary_inertia: false,
        })
    }

    /// Connects the ends of the beam to its nodes by rigid arms.
    ///
    /// `offsets`: from each node to its end along x, y and z, m.
    ///
    /// # Errors
    /// [`Error::NotFinite`] unless all are finite.
    pub fn with_offsets(self, offsets: [[f64; 3]; 2]) -> Result<Self> {
        all_finite("offsets of the beam", offsets.as_flattened())
            .map_err(|fault| within_beam(self.nodes, fault))?;
        Ok(Self { offsets, ..self })
    }

    /// Releases an end (0 or 1) in `directions`, in the axes of the beam.
    ///
    /// The beam exerts no force in these directions: [`RotationZ`](Direction::RotationZ) is a hinge for bending along
    /// y. The releases add to earlier ones. A lumped mass has no entries in released directions.
    ///
    /// # Errors
    /// [`Error::Index`] for another end; [`Error::Scene`] for [`Direction::Rotation`], and for releases that make the
    /// beam a mechanism: both ends along or about x, both ends along y or along z, or three of the four displacements
    /// and rotations of bending along y or along z. Each of these errors is in an [`Error::Item`] that names the nodes.
    pub fn with_releases(self, end: usize, directions: &[Direction]) -> Result<Self> {
        let releases = self
            .releases
            .with_end_releases(end, directions)
            .map_err(|fault| within_beam(self.nodes, fault))?;
        Ok(Self { releases, ..self })
    }

    /// Adds the rotary inertia ρ I of bending; the inertia of the torsion is always included.
    #[must_use]
    pub fn with_rotary_inertia(self) -> Self {
        let bending = self.bending.map(|plane| Bending { has_rotary_inertia: true, ..plane });
        Self { bending, ..self }
    }

    /// Makes the beam a beam–column with the constant axial force `compression`, N (negative for tension).
    ///
    /// As [`Beam::with_compression`](super::Beam::with_compression), in both planes. The force also acts at the rigid
    /// arms of offset ends.
    ///
    /// # Errors
    /// [`Error::Input`] unless it is finite.
    pub fn with_compression(self, compression: f64) -> Result<Self> {
        let compression = finite("axial force of the beam", compression)
            .map_err(|fault| within_beam(self.nodes, fault))?;
        Ok(Self { axial_force: AxialForce::prescribed(compression), ..self })
    }

    /// Coordinates of the ends, m; `None` unless there are two nodes.
    fn ends(&self, coordinates: &[[f64; 3]]) -> Option<[[f64; 3]; 2]> {
        let &[first, second] = coordinates else {
            return None;
        };
        Some([add_scaled(first, 1.0, self.offsets[0]), add_scaled(second, 1.0, self.offsets[1])])
    }

    /// Axes of the beam; `None` for a beam that [`check`](Element::check) does not accept.
    fn axes(&self, coordinates: &[[f64; 3]]) -> Option<BeamAxes> {
        BeamAxes::new(self.ends(coordinates)?, self.orientation).ok()
    }

    /// Axes and offsets of the ends.
    pub(crate) fn end_frame(&self, coordinates: &[[f64; 3]]) -> Option<EndFrame> {
        Some(EndFrame { axes: self.axes(coordinates)?.axes, offsets: self.offsets })
    }

    /// Local stiffness matrix without releases.
    fn local_stiffness(&self, length: f64) -> EndsMatrix {
        let axial = bar_stiffness(self.axial_stiffness / length);
        let torsion = bar_stiffness(self.torsional_stiffness / length);
        let bending = self.bending.map(|plane| plane.stiffness(length));
        local_matrix(&axial, &torsion, &bending)
    }

    /// Transformation of displacements of the nodes to local displacements of the ends, with releases.
    fn to_local(&self, axes: &BeamAxes) -> EndsMatrix {
        let mut to_local = axes.to_local(&self.offsets);
        self.releases.apply(self.local_stiffness(axes.length), &mut to_local);
        to_local
    }

    /// Local mass matrix without releases.
    fn local_mass(&self, kind: MassKind, length: f64) -> EndsMatrix {
        let mass = self.mass_per_length * length;
        let polar_inertia = self.bending[0].section_inertia + self.bending[1].section_inertia;
        let bending = self.bending.map(|plane| plane.mass(kind, mass, length));
        let torsion = bar_mass(kind, polar_inertia * length);
        local_matrix(&bar_mass(kind, mass), &torsion, &bending)
    }

    /// Adds the geometric stiffness of the rigid arms between nodes and ends.
    fn add_arm_stiffness(&self, axes: &BeamAxes, matrix: &mut [f64]) {
        let tangent = axes.axes[0];
        // Coordinate s = x/L of each end, and the sign of the beam's outward direction there.
        let ends = [(0.0, -1.0), (1.0, 1.0)];
        for (end, (arm, (s, sign))) in self.offsets.iter().zip(ends).enumerate() {
            let end_force = -self.axial_force.at(s) * sign;
            for i in 0..3 {
                for j in 0..3 {
                    let trace = if i == j { dot(tangent, *arm) } else { 0.0 };
                    let product = 0.5 * (tangent[i] * arm[j] + arm[i] * tangent[j]);
                    let entry_index = 12 * (6 * end + 3 + i) + 6 * end + 3 + j;
                    if let Some(entry) = matrix.get_mut(entry_index) {
                        *entry += end_force * (product - trace);
                    }
                }
            }
        }
    }
}

impl Element for SpaceBeam {
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
        if let Some(axes) = self.axes(coordinates) {
            add_transformed(&self.local_stiffness(axes.length), &self.to_local(&axes), matrix);
        }
    }

    fn geometric_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Some(axes) = self.axes(coordinates).filter(|_| !self.axial_force.is_zero()) else {
            return;
        };
        let zero: BarMatrix = [[0.0; 2]; 2];
        let bending =
            self.bending.map(|plane| plane.geometric_stiffness(&self.axial_force, axes.length));
        let local_stiffness = local_matrix(&zero, &zero, &bending);
        add_transformed(&local_stiffness, &self.to_local(&axes), matrix);
        self.add_arm_stiffness(&axes, matrix);
    }

    fn in_static_state(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        gravity: f64,
    ) -> Option<Box<dyn Element>> {
        let axes = self.axes(coordinates)?;
        let ends = self.ends(coordinates)?;
        if self.axial_force.is_prescribed || displacement.len() != 12 {
            return None;
        }
        let to_local = self.to_local(&axes);
        let axial_displacement = |end: usize| {
            let row = to_local[6 * end];
            row.iter().zip(displacement).map(|(a, b)| a * b).sum::<f64>()
        };
        // Displacements of the nodes are exact, so the compression that follows from the elongation is the mean over
        // the length. The compression varies between the ends because of the element's weight.
        let axial_force = AxialForce {
            compression: -self.axial_stiffness / axes.length
                * (axial_displacement(1) - axial_displacement(0)),
            end_difference: self.mass_per_length * gravity * (ends[1][2] - ends[0][2]),
            is_prescribed: false,
        };
        Some(Box::new(Self { axial_force, ..self.clone() }))
    }

    fn compression(&self) -> Option<f64> {
        Some(self.axial_force.compression)
    }

    /// Lumped: half the mass, half the polar inertia and the rotary inertia m L²/78 at each end.
    ///
    /// The lumped matrix is diagonal at the ends, in the axes of the beam.
    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let Some(axes) = self.axes(coordinates) else {
            return;
        };
        let mut local_mass = self.local_mass(kind, axes.length);
        let to_local = match kind {
            MassKind::Consistent => self.to_local(&axes),
            MassKind::Lumped => {
                self.releases.clear(&mut local_mass);
                axes.to_local(&self.offsets)
            }
        };
        add_transformed(&local_mass, &to_local, matrix);
    }

    /// [`Error::Input`] in an [`Error::Item`] when the ends coincide or the orientation lies along the beam.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length("coordinates of a beam", coordinates.len(), 2)?;
        let ends = self.ends(coordinates).unwrap_or_default();
        let axes = BeamAxes::new(ends, self.orientation);
        axes.map(drop).map_err(|fault| within_beam(self.nodes, fault))
    }
}

/// Adds the nodes of a beam to its error.
pub(super) fn within_beam([first, second]: [usize; 2], fault: Error) -> Error {
    fault.within(format!("beam between nodes {first} and {second}"))
}

/// Local matrix of axial displacements, torsion, and bending along y and along z.
pub(super) fn local_matrix(
    axial: &BarMatrix,
    torsion: &BarMatrix,
    bending: &[BendingMatrix; 2],
) -> EndsMatrix {
    let mut matrix = [[0.0; 12]; 12];
    copy_block(axial, [0, 6], &mut matrix);
    copy_block(torsion, [3, 9], &mut matrix);
    copy_block(&bending[0], [1, 5, 7, 11], &mut matrix);
    // The slope of a deflection along z is minus the rotation about y.
    let signs = [1.0, -1.0, 1.0, -1.0];
    let mut along_z = bending[1];
    for (i, row) in along_z.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value *= signs[i] * signs[j];
        }
    }
    copy_block(&along_z, [2, 4, 8, 10], &mut matrix);
    matrix
}
