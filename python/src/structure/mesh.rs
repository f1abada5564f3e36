//! Meshes from arrays.

use basemat::fem::{
    Beam, Dashpot, Direction, Element, Layer, LumpedMass, Mesh, SharedMaterial, Spring, Truss,
};
use pyo3::prelude::*;

use super::connectivity::{Connectivity, PerElement};
use super::layer::PyLayer;
use crate::array::{Count, Numbers, Pairs, Points, Rows};
use crate::error::{OrRaise, WithOption, input_error};
use crate::list_arguments::ListOf;
use crate::names::choice;

/// A direction by its name: "x", "y" or "rotation" in the plane, one of six in space.
pub(super) fn direction(name: &str) -> PyResult<Direction> {
    let choices = [
        ("x", Direction::X),
        ("y", Direction::Y),
        ("rotation", Direction::Rotation),
        ("z", Direction::Z),
        ("rotation_x", Direction::RotationX),
        ("rotation_y", Direction::RotationY),
        ("rotation_z", Direction::RotationZ),
    ];
    choice("direction", name, &choices)
}

/// Nodes and finite elements in the plane, or in space (`in_space`).
///
/// ``nodes``: array of shape (nodes, 2), m; none unless given. Its methods add elements and return their numbers; after
/// an error they have added none.
///
/// In the plane x points to the right and y up, directions are "x", "y" and "rotation", and all quantities are per metre
/// of thickness. In space x points to the right, y away and z up; directions are "x", "y", "z", "rotation_x",
/// "rotation_y" and "rotation_z", rotations follow the right-hand rule.
#[pyclass(name = "Mesh", module = "basemat", dict)]
pub(crate) struct PyMesh(pub(crate) Mesh);

/// Constructor of a link along the line between two nodes.
type AxialConstructor<E> = fn([usize; 2], f64) -> basemat::Result<E>;

impl PyMesh {
    /// Whether the mesh lies in space.
    pub(super) fn has_depth(&self) -> bool {
        self.0.directions().contains(&Direction::Z)
    }

    /// Changes the mesh; after an error the mesh is unchanged.
    pub(super) fn change<T>(
        &mut self,
        change: impl FnOnce(&mut Mesh) -> basemat::Result<T>,
    ) -> PyResult<T> {
        let mut mesh = self.0.clone();
        let result = change(&mut mesh).or_raise()?;
        self.0 = mesh;
        Ok(result)
    }

    /// Adds elements, none after an error; returns their numbers.
    pub(super) fn add_all<E: Element + 'static>(
        &mut self,
        elements: impl Iterator<Item = PyResult<E>>,
    ) -> PyResult<Vec<usize>> {
        let elements = elements.collect::<PyResult<Vec<_>>>()?;
        if elements.len() < 2 {
            // A single element needs no copy of the mesh.
            return elements.into_iter().map(|element| self.0.add(element).or_raise()).collect();
        }
        self.change(|mesh| elements.into_iter().map(|element| mesh.add(element)).collect())
    }

    /// Adds links between nodes in a direction; the direction "axial" is that of the line between the nodes.
    fn add_links<E: Element + 'static>(
        &mut self,
        nodes: &Connectivity,
        direction: &str,
        (property_name, values): (&str, &PerElement),
        axial_constructors: [AxialConstructor<E>; 2],
        new_in_direction: fn([usize; 2], Direction, f64) -> basemat::Result<E>,
    ) -> PyResult<Vec<usize>> {
        let ends = nodes.rows::<2>()?;
        let new_axial = axial_constructors[usize::from(self.has_depth())];
        self.add_all(ends.iter().enumerate().map(|(link, &link_nodes)| {
            let value = values.at(property_name, link, ends.len())?;
            match direction {
                "axial" => new_axial(link_nodes, value).or_raise(),
                _ => new_in_direction(link_nodes, self::direction(direction)?, value).or_raise(),
            }
        }))
    }
}

/// Rotary inertia of a mass.
enum RotaryInertia {
    InPlane(f64),
    AboutAxes([f64; 3]),
}

extracts!(RotaryInertia, object => match object.extract() {
    Ok(inertia) => Ok(Self::InPlane(inertia)),
    Err(_) => Ok(Self::AboutAxes(object.extract()?)),
});

/// The layers of a block.
fn layers(layers: &[Bound<'_, PyLayer>]) -> Vec<Layer<SharedMaterial>> {
    layers.iter().map(|layer| layer.get().0.clone()).collect()
}

#[pymethods]
impl PyMesh {
    #[pyo3(signature = (nodes=None))]
    #[new]
    fn new(nodes: Option<Pairs>) -> PyResult<Self> {
        let mut mesh = Mesh::new();
        for [x, y] in nodes.map_or_else(Vec::new, |nodes| nodes.0) {
            mesh.add_node(x, y).or_raise()?;
        }
        Ok(Self(mesh))
    }

    /// Block of ``columns`` of equal width from ``left`` to ``right`` (m): ``layers`` is a list of
    /// `Layer` from y = 0 upwards.
    #[staticmethod]
    fn layered_block(
        left: f64,
        right: f64,
        columns: Count,
        layers: ListOf<'_, PyLayer>,
    ) -> PyResult<Self> {
        Mesh::layered_block(left..right, columns.0, &self::layers(&layers))
            .or_raise()
            .map(Self)
    }

    /// Block with columns between the lines of ``grid`` (array of shape (columns + 1,), x in m, ascending):
    /// ``layers`` is a list of `Layer` from y = 0 upwards.
    #[staticmethod]
    fn graded_block(grid: Numbers, layers: ListOf<'_, PyLayer>) -> PyResult<Self> {
        Mesh::graded_block(&grid.0, &self::layers(&layers)).or_raise().map(Self)
    }

    /// Merges nodes at the same position within ``tolerance`` (m), so that their elements act on each other. It returns
    /// the number of removed nodes, and the list of the new numbers of all former nodes. Elements keep their numbers.
    ///
    /// If an element would have the same node twice, or two elements the same nodes, it raises an error and the mesh is
    /// unchanged.
    fn merge_nodes(&mut self, tolerance: f64) -> PyResult<(usize, Vec<usize>)> {
        let merge_result = self.0.merge_nodes(tolerance).or_raise()?;
        Ok((merge_result.count, merge_result.indices))
    }

    /// Coordinates of the nodes: array of shape (nodes, 2), in space (nodes, 3), m.
    #[getter]
    fn nodes(&self) -> Rows {
        let axis_count = if self.has_depth() { 3 } else { 2 };
        Rows(self.0.nodes().iter().map(|node| node[..axis_count].to_vec()).collect())
    }

    /// Adds a node at (``x``, ``y``), in space at (``x``, ``y``, ``z``), m; returns its number. ``z`` is 0 by default.
    #[pyo3(signature = (x, y, z=0.0))]
    fn add_node(&mut self, x: f64, y: f64, z: f64) -> PyResult<usize> {
        self.0.add_node_at([x, y, z]).or_raise()
    }

    /// Adds nodes at ``points`` (array of shape (n, 2), in space (n, 3), m); returns the list of their numbers.
    fn add_nodes(&mut self, points: Points) -> PyResult<Vec<usize>> {
        let points = if self.has_depth() { points.in_space()? } else { points.coordinates() };
        self.change(|mesh| points.into_iter().map(|point| mesh.add_node_at(point)).collect())
    }

    /// Adds beams on ``nodes`` (array of shape (beams, 2)): ``young_modulus`` (Pa), ``area`` (m²) and ``second_moment``
    /// (m⁴) per metre of thickness, ``density`` (kg/m³), each one number or an array of one per beam.
    /// ``shear_stiffness`` (N per metre): shear stiffness of Timoshenko beams, infinite unless given;
    /// ``rotary_inertia``: whether cross-sections have rotary inertia, False by default; ``compression`` (N per metre):
    /// axial force of P–Δ, none unless given.
    #[pyo3(signature = (nodes, young_modulus, area, second_moment, density, *, shear_stiffness=None, rotary_inertia=false, compression=None))]
    fn add_beams(
        &mut self,
        nodes: Connectivity,
        young_modulus: PerElement,
        area: PerElement,
        second_moment: PerElement,
        density: PerElement,
        shear_stiffness: Option<PerElement>,
        rotary_inertia: bool,
        compression: Option<PerElement>,
    ) -> PyResult<Vec<usize>> {
        let ends = nodes.rows::<2>()?;
        let beam_count = ends.len();
        self.add_all(ends.iter().enumerate().map(|(beam_index, &beam_nodes)| {
            let beam_modulus = young_modulus.at("young_modulus", beam_index, beam_count)?;
            let beam_area = area.at("area", beam_index, beam_count)?;
            let beam_moment = second_moment.at("second_moment", beam_index, beam_count)?;
            let beam_density = density.at("density", beam_index, beam_count)?;
            let beam_shear_stiffness = match &shear_stiffness {
                Some(shear_stiffness) => {
                    Some(shear_stiffness.at("shear_stiffness", beam_index, beam_count)?)
                }
                None => None,
            };
            let axial_force = match &compression {
                Some(compression) => Some(compression.at("compression", beam_index, beam_count)?),
                None => None,
            };
            let beam = Beam::new(beam_nodes, beam_modulus, beam_area, beam_moment, beam_density)
                .with(beam_shear_stiffness, Beam::with_shear_stiffness)
                .with(axial_force, Beam::with_compression)
                .or_raise()?;
            Ok(if rotary_inertia { beam.with_rotary_inertia() } else { beam })
        }))
    }

    /// Adds trusses on ``nodes`` (array of shape (trusses, 2)): ``young_modulus`` (Pa), ``area`` (m² per
    /// metre of thickness, in space m²), ``density`` (kg/m³), each one number or an array of one per truss.
    fn add_trusses(
        &mut self,
        nodes: Connectivity,
        young_modulus: PerElement,
        area: PerElement,
        density: PerElement,
    ) -> PyResult<Vec<usize>> {
        let ends = nodes.rows::<2>()?;
        let truss_count = ends.len();
        let new_truss = if self.has_depth() { Truss::in_space } else { Truss::new };
        self.add_all(ends.iter().enumerate().map(|(truss, &truss_nodes)| {
            let truss_modulus = young_modulus.at("young_modulus", truss, truss_count)?;
            let truss_area = area.at("area", truss, truss_count)?;
            new_truss(
                truss_nodes,
                truss_modulus,
                truss_area,
                density.at("density", truss, truss_count)?,
            )
            .or_raise()
        }))
    }

    /// Adds springs between ``nodes`` (array of shape (springs, 2)) in a ``direction`` of the mesh, such as "x", or
    /// "axial", of ``stiffness`` (N/m, of rotations N·m): one number or an array of one per spring.
    fn add_springs(
        &mut self,
        nodes: Connectivity,
        direction: &str,
        stiffness: PerElement,
    ) -> PyResult<Vec<usize>> {
        let axial_constructors = [Spring::axial, Spring::axial_in_space];
        self.add_links(
            &nodes,
            direction,
            ("stiffness", &stiffness),
            axial_constructors,
            Spring::new,
        )
    }

    /// Adds dashpots between ``nodes`` (array of shape (dashpots, 2)) in a ``direction`` of the mesh, such as "x", or
    /// "axial", of a ``coefficient`` (N s/m, of rotations N·m s): one number or an array of one per dashpot.
    fn add_dashpots(
        &mut self,
        nodes: Connectivity,
        direction: &str,
        coefficient: PerElement,
    ) -> PyResult<Vec<usize>> {
        let axial_constructors = [Dashpot::axial, Dashpot::axial_in_space];
        self.add_links(
            &nodes,
            direction,
            ("coefficient", &coefficient),
            axial_constructors,
            Dashpot::new,
        )
    }

    /// Adds a ``mass`` (kg/m, in space kg) at a ``node``, with a ``rotary_inertia`` (kg m²/m; in space three numbers
    /// about x, y and z, kg m²; none unless given).
    #[pyo3(signature = (node, mass, *, rotary_inertia=None))]
    fn add_mass(
        &mut self,
        node: Count,
        mass: f64,
        rotary_inertia: Option<RotaryInertia>,
    ) -> PyResult<usize> {
        let node = node.0;
        let has_depth = self.has_depth();
        let element = match rotary_inertia {
            None if has_depth => LumpedMass::in_space(node, mass, [0.0; 3]),
            None => LumpedMass::new(node, mass),
            Some(RotaryInertia::AboutAxes(inertia)) if has_depth => {
                LumpedMass::in_space(node, mass, inertia)
            }
            Some(RotaryInertia::InPlane(inertia)) if !has_depth => {
                LumpedMass::new(node, mass).with(Some(inertia), LumpedMass::with_rotary_inertia)
            }
            Some(_) => {
                let requirement =
                    if has_depth { "three numbers in space" } else { "one number in the plane" };
                return Err(input_error(format!("rotary_inertia must be {requirement}")));
            }
        };
        self.0.add(element.or_raise()?).or_raise()
    }

    /// Numbers of the nodes of each element, in the order of the elements' numbers: a list of lists.
    #[getter]
    fn elements(&self) -> Vec<&[usize]> {
        self.0.elements().map(Element::nodes).collect()
    }

    /// Stiffness matrix of an ``element`` (its number) at small displacements: array of shape (n, n) for its n degrees of
    /// freedom, node by node in the directions that it has; N/m, N and N·m.
    fn element_stiffness(&self, element: Count) -> PyResult<Rows> {
        let element_count = self.0.elements().len();
        let element_entry = self.0.elements().nth(element.0).ok_or_else(|| {
            let number = element.0;
            input_error(format!("there is no element {number} among {element_count} of the mesh"))
        })?;
        let order = element_entry.order();
        let mut matrix = vec![0.0; order * order];
        let coordinates: Vec<_> =
            element_entry.nodes().iter().map(|&node| self.0.nodes()[node]).collect();
        element_entry.stiffness(&coordinates, &mut matrix);
        Ok(Rows(matrix.chunks_exact(order).map(<[f64]>::to_vec).collect()))
    }

    /// Number of the node at (``x``, ``y``), in space at (``x``, ``y``, ``z``), m, within a millionth of the extent of
    /// the mesh. ``z`` is 0 by default.
    #[pyo3(signature = (x, y, z=0.0))]
    fn node_at(&self, x: f64, y: f64, z: f64) -> PyResult<usize> {
        self.0.node_at_point([x, y, z]).or_raise()
    }

    /// Numbers of the nodes at a height (``y`` in the plane, in space z; m) within a ``tolerance`` (m; 1e-9 by
    /// default): list, from left to right, in space at each x from front to back.
    #[pyo3(signature = (y, tolerance=1e-9))]
    fn nodes_at_height(&self, y: f64, tolerance: f64) -> PyResult<Vec<usize>> {
        self.0.nodes_at_height(y, tolerance).or_raise()
    }

    fn __repr__(&self) -> String {
        format!("Mesh({} nodes, {} elements)", self.0.nodes().len(), self.0.elements().len())
    }
}
