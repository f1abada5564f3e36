//! Meshes in space: their nodes, shells, bricks and beams.

use basemat::fem::{Hex8, Mesh, Shell, SpaceBeam};
use pyo3::prelude::*;

use super::connectivity::{Cells, Connectivity, PerElement, Vectors, one_of};
use super::material::PyBeamSection;
use super::mesh::{PyMesh, direction};
use super::solid_material::{ElasticList, ElasticMaterial};
use crate::array::Points;
use crate::error::{OrRaise, WithOption, input_error};

#[pymethods]
impl PyMesh {
    /// Mesh in space; ``nodes``: array of shape (nodes, 3), x to the right, y away and z up, m; none unless given.
    #[pyo3(signature = (nodes=None))]
    #[staticmethod]
    fn in_space(nodes: Option<Points>) -> PyResult<Self> {
        let mut mesh = Mesh::in_space();
        for point in nodes.map_or_else(|| Ok(Vec::new()), Points::in_space)? {
            mesh.add_node_at(point).or_raise()?;
        }
        Ok(Self(mesh))
    }

    /// Adds shells of three or four ``nodes``, listed around each: array of shape (shells, 3) or (shells, 4), or a list of
    /// lists of 3 or 4 numbers. ``material``: `Material`, or a list of one per shell; ``thickness`` (m): one number
    /// or an array of one per shell.
    ///
    /// The nodes lie in the middle of the thickness. Triangles match the sides that they share with quadrilaterals of the
    /// same call, so that a uniform stress is exact. Quadrilaterals are better for curved shells.
    fn add_shells(
        &mut self,
        nodes: Cells,
        material: ElasticList,
        thickness: PerElement,
    ) -> PyResult<Vec<usize>> {
        let shell_count = nodes.0.len();
        let mut shells = Vec::with_capacity(shell_count);
        for (shell, shell_nodes) in nodes.0.iter().enumerate() {
            let shell_material = *one_of(&material.0, "material", shell, shell_count)?;
            let shell_thickness = thickness.at("thickness", shell, shell_count)?;
            shells.push(Shell::new(shell_nodes, shell_material, shell_thickness).or_raise()?);
        }
        Shell::match_sides(&mut shells);
        self.add_all(shells.into_iter().map(Ok))
    }

    /// Adds bricks of a ``material`` (`Material`) on ``nodes``, array of shape (bricks, 8): the lower face
    /// counter-clockwise seen from above, then the nodes above these.
    fn add_bricks(
        &mut self,
        nodes: Connectivity,
        material: ElasticMaterial,
    ) -> PyResult<Vec<usize>> {
        let bricks = nodes.rows::<8>()?.into_iter();
        self.add_all(bricks.map(|nodes| Ok(Hex8::new(nodes, material.0))))
    }

    /// Adds beams in space on ``nodes`` (array of shape (beams, 2)), of a ``material`` (`Material`) and a ``section``
    /// (`BeamSection`), whose y axis is the part of ``orientation`` perpendicular to the beam (x, y and z of a vector,
    /// or an array of shape (beams, 3)).
    ///
    /// ``offsets``: rigid arms from the first node to the first end and from the second node to the second end (array
    /// of shape (2, 3), m); none unless given. ``releases``: two lists of directions in the axes of the beam in which
    /// its first and its second end are free, such as ``([], ["rotation_z"])`` for a hinge; none unless given.
    /// ``rotary_inertia``: whether cross-sections have rotary inertia in bending, False by default; ``compression`` (N;
    /// one number or an array of one per beam): axial force of P–Δ, none unless given.
    #[pyo3(signature = (nodes, material, section, orientation, *, offsets=None, releases=None, rotary_inertia=false, compression=None))]
    fn add_space_beams(
        &mut self,
        nodes: Connectivity,
        material: ElasticMaterial,
        section: &PyBeamSection,
        orientation: Vectors,
        offsets: Option<Points>,
        releases: Option<[Vec<String>; 2]>,
        rotary_inertia: bool,
        compression: Option<PerElement>,
    ) -> PyResult<Vec<usize>> {
        let ends = nodes.rows::<2>()?;
        let offsets = offsets.map(two_arms).transpose()?;
        let mut end_releases = Vec::new();
        for (end, names) in releases.iter().flatten().enumerate() {
            let directions = names.iter().map(|name| direction(name));
            end_releases.push((end, directions.collect::<PyResult<Vec<_>>>()?));
        }
        let beam_count = ends.len();
        self.add_all(ends.iter().enumerate().map(|(beam_index, &beam_nodes)| {
            let beam_orientation = *one_of(&orientation.0, "orientation", beam_index, beam_count)?;
            let axial_force = match &compression {
                Some(compression) => Some(compression.at("compression", beam_index, beam_count)?),
                None => None,
            };
            let mut beam = SpaceBeam::new(beam_nodes, material.0, section.0, beam_orientation)
                .with(offsets, SpaceBeam::with_offsets)
                .with(axial_force, SpaceBeam::with_compression);
            for (end, directions) in &end_releases {
                beam = beam.and_then(|beam| beam.with_releases(*end, directions));
            }
            let beam = beam.or_raise()?;
            Ok(if rotary_inertia { beam.with_rotary_inertia() } else { beam })
        }))
    }
}

/// Rigid arms from the two nodes to the ends of a beam.
fn two_arms(points: Points) -> PyResult<[[f64; 3]; 2]> {
    let arms = points.in_space()?;
    let arm_count = arms.len();
    arms.try_into()
        .map_err(|_| input_error(format!("offsets has {arm_count} rows, but must have 2")))
}
