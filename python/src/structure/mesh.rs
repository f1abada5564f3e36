//! Meshes from arrays.

use basemat::fem::{
    Beam, Dashpot, Direction, Element, Layer, LumpedMass, Material, Mesh, Quad4, Quad8,
    QuadFormulation, Spring, Truss,
};
use pyo3::prelude::*;

use crate::array::{Count, Numbers, Pairs, Rows, Table, whole};
use crate::error::{OrRaise, WithGiven, refuse};
use crate::names::choice;
use crate::several::Several;

/// A direction by its name: "x", "y" or "rotation".
pub(super) fn direction(name: &str) -> PyResult<Direction> {
    let all = [("x", Direction::X), ("y", Direction::Y), ("rotation", Direction::Rotation)];
    choice("direction", name, &all)
}

/// Integration of four-node quadrilaterals by its name.
pub(super) fn formulation(name: &str, percent: usize) -> PyResult<QuadFormulation> {
    let percent = u8::try_from(percent).map_err(|_| {
        refuse(format!("hourglass_percent is {percent}, but must be {} or less", u8::MAX))
    })?;
    let all = [
        ("full", QuadFormulation::Full),
        ("incompatible_modes", QuadFormulation::IncompatibleModes),
        ("one_point", QuadFormulation::OnePoint),
        ("hourglass", QuadFormulation::Hourglass { percent }),
    ];
    choice("formulation", name, &all)
}

/// Elastic material in plane strain: Young's modulus ``young_modulus`` (Pa), Poisson's ratio ``poisson``,
/// ``density`` (kg/m³).
#[pyclass(name = "Material", module = "basemat", frozen, dict)]
pub(crate) struct PyMaterial(pub(super) Material);

#[pymethods]
impl PyMaterial {
    #[new]
    fn new(young_modulus: f64, poisson: f64, density: f64) -> PyResult<Self> {
        Ok(Self(Material::new(young_modulus, poisson, density).or_raise()?))
    }
}

/// Horizontal layer of a block of quadrilaterals: ``height`` (m), number of ``rows`` of elements,
/// ``material`` (:class:`Material`).
///
/// ``formulation`` of four-node quadrilaterals: "incompatible_modes" (the default: right in bending),
/// "full" (2 × 2 points), "one_point" (without stiffness against hourglass modes) or "hourglass" (one
/// point, stabilised with ``hourglass_percent``, 5 by default).
#[pyclass(name = "Layer", module = "basemat", frozen, dict)]
pub(crate) struct PyLayer(Layer);

#[pymethods]
impl PyLayer {
    #[pyo3(signature = (height, rows, material, *, formulation="incompatible_modes", hourglass_percent=5))]
    #[new]
    fn new(
        height: f64,
        #[pyo3(from_py_with = whole)] rows: usize,
        material: &PyMaterial,
        formulation: &str,
        #[pyo3(from_py_with = whole)] hourglass_percent: usize,
    ) -> PyResult<Self> {
        let formulation = self::formulation(formulation, hourglass_percent)?;
        Ok(Self(Layer { height, rows, material: material.0, formulation }))
    }
}

/// Nodes and finite elements; ``nodes``: array of shape (nodes, 2), m; none unless given. Its methods add
/// elements: all, or none if one of them is an error.
#[pyclass(name = "Mesh", module = "basemat", dict)]
pub(crate) struct PyMesh(pub(super) Mesh);

/// Number for all elements, or one each.
struct PerElement(Vec<f64>);

extracts!(PerElement, object => match object.extract::<f64>() {
    Ok(value) => Ok(Self(vec![value])),
    Err(_) => Ok(Self(object.extract::<Numbers>()?.0)),
});

impl PerElement {
    fn at(&self, index: usize, count: usize) -> PyResult<f64> {
        match self.0.len() {
            1 => Ok(self.0[0]),
            found if found == count => Ok(self.0[index]),
            found => Err(refuse(format!("{found} values are given for {count} elements"))),
        }
    }
}

/// Node numbers of elements: anything that numpy takes for an array of shape (elements, nodes each).
struct Connectivity {
    /// Nodes of an element.
    each: usize,
    rows: Vec<Vec<usize>>,
}

extracts!(Connectivity, object => {
    // Read as floats: as integers, numpy would truncate fractions.
    let Table { columns, rows } = Table::read(&object, "(elements, nodes of each)")?;
    let node = |value: &f64| {
        if *value < 0.0 || value.fract() != 0.0 {
            let needed = "must be a whole number of 0 or more";
            return Err(refuse(format!("node is {value}, but {needed}")));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        Ok(*value as usize)
    };
    let rows = rows.iter().map(|row| row.iter().map(node).collect());
    Ok(Self { each: columns, rows: rows.collect::<PyResult<_>>()? })
});

impl Connectivity {
    fn rows<const N: usize>(&self) -> PyResult<Vec<[usize; N]>> {
        let nodes = |row: &Vec<usize>| {
            <[usize; N]>::try_from(row.as_slice()).map_err(|_| {
                refuse(format!("elements have {} nodes, but must have {N}", self.each))
            })
        };
        self.rows.iter().map(nodes).collect()
    }
}

impl PyMesh {
    /// Adds all elements, or none if one of them is an error.
    fn add_all<E: Element + 'static>(
        &mut self,
        elements: impl Iterator<Item = PyResult<E>>,
    ) -> PyResult<()> {
        let elements = elements.collect::<PyResult<Vec<_>>>()?;
        if elements.len() < 2 {
            // A single element needs no copy of the mesh.
            return elements.into_iter().try_for_each(|own| self.0.add(own).or_raise().map(drop));
        }
        let mut mesh = self.0.clone();
        for element in elements {
            mesh.add(element).or_raise()?;
        }
        self.0 = mesh;
        Ok(())
    }

    /// Adds links between nodes in a direction.
    fn add_links<E: Element + 'static>(
        &mut self,
        nodes: &Connectivity,
        direction: &str,
        values: &PerElement,
        axial: fn([usize; 2], f64) -> basemat::Result<E>,
        along: fn([usize; 2], Direction, f64) -> basemat::Result<E>,
    ) -> PyResult<()> {
        let ends = nodes.rows::<2>()?;
        self.add_all(ends.iter().enumerate().map(|(k, own)| {
            let value = values.at(k, ends.len())?;
            match direction {
                "axial" => axial(*own, value).or_raise(),
                _ => along(*own, self::direction(direction)?, value).or_raise(),
            }
        }))
    }
}

/// The layers of a block.
fn layers(given: &[Bound<'_, PyLayer>]) -> Vec<Layer> {
    given.iter().map(|layer| layer.get().0).collect()
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
    /// :class:`Layer` from y = 0 upwards.
    #[staticmethod]
    fn layered_block(
        left: f64,
        right: f64,
        columns: Count,
        layers: Several<'_, PyLayer>,
    ) -> PyResult<Self> {
        Mesh::layered_block(left..right, columns.0, &self::layers(&layers)).or_raise().map(Self)
    }

    /// Block with columns between the lines of ``grid`` (array of shape (columns + 1,), x in m, ascending):
    /// ``layers`` is a list of :class:`Layer` from y = 0 upwards.
    #[staticmethod]
    fn graded_block(grid: Numbers, layers: Several<'_, PyLayer>) -> PyResult<Self> {
        Mesh::graded_block(&grid.0, &self::layers(&layers)).or_raise().map(Self)
    }

    /// Coordinates of the nodes: array of shape (nodes, 2), m.
    #[getter]
    fn nodes(&self) -> Rows {
        Rows(self.0.nodes().iter().map(|node| node[..2].to_vec()).collect())
    }

    /// Adds a node at (``x``, ``y``), m; returns its number.
    fn add_node(&mut self, x: f64, y: f64) -> PyResult<usize> {
        self.0.add_node(x, y).or_raise()
    }

    /// Adds beams on ``nodes`` (array of shape (beams, 2)): ``young_modulus`` (Pa), ``area`` (m²) and
    /// ``second_moment`` (m⁴) per metre of thickness, ``density`` (kg/m³), each one number or an array of
    /// one per beam. ``shear_stiffness`` (N per metre): of Timoshenko beams, infinite unless given;
    /// ``rotary_inertia``: whether sections have one, False by default; ``compression`` (N per metre):
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
    ) -> PyResult<()> {
        let ends = nodes.rows::<2>()?;
        self.add_all(ends.iter().enumerate().map(|(k, own)| {
            let at = |values: &PerElement| values.at(k, ends.len());
            let numbers = (at(&young_modulus)?, at(&area)?, at(&second_moment)?, at(&density)?);
            let beam = Beam::new(*own, numbers.0, numbers.1, numbers.2, numbers.3)
                .with(shear_stiffness.as_ref().map(at).transpose()?, Beam::with_shear_stiffness)
                .with(compression.as_ref().map(at).transpose()?, Beam::with_compression)
                .or_raise()?;
            Ok(if rotary_inertia { beam.with_rotary_inertia() } else { beam })
        }))
    }

    /// Adds trusses on ``nodes`` (array of shape (trusses, 2)): ``young_modulus`` (Pa), ``area`` (m² per
    /// metre of thickness), ``density`` (kg/m³), each one number or an array of one per truss.
    fn add_trusses(
        &mut self,
        nodes: Connectivity,
        young_modulus: PerElement,
        area: PerElement,
        density: PerElement,
    ) -> PyResult<()> {
        let ends = nodes.rows::<2>()?;
        self.add_all(ends.iter().enumerate().map(|(k, own)| {
            let at = |values: &PerElement| values.at(k, ends.len());
            let truss = Truss::new(*own, at(&young_modulus)?, at(&area)?, at(&density)?);
            truss.or_raise()
        }))
    }

    /// Adds springs between ``nodes`` (array of shape (springs, 2)) in a ``direction`` ("x", "y",
    /// "rotation" or "axial"), of ``stiffness`` (N/m, of rotations N·m).
    fn add_springs(
        &mut self,
        nodes: Connectivity,
        direction: &str,
        stiffness: PerElement,
    ) -> PyResult<()> {
        self.add_links(&nodes, direction, &stiffness, Spring::axial, Spring::new)
    }

    /// Adds dashpots between ``nodes`` (array of shape (dashpots, 2)) in a ``direction`` ("x", "y",
    /// "rotation" or "axial"), of a ``coefficient`` (N s/m, of rotations N·m s).
    fn add_dashpots(
        &mut self,
        nodes: Connectivity,
        direction: &str,
        coefficient: PerElement,
    ) -> PyResult<()> {
        self.add_links(&nodes, direction, &coefficient, Dashpot::axial, Dashpot::new)
    }

    /// Adds a ``mass`` (kg/m) at a ``node``, with a ``rotary_inertia`` (kg m²/m; none unless given).
    #[pyo3(signature = (node, mass, *, rotary_inertia=None))]
    fn add_mass(&mut self, node: Count, mass: f64, rotary_inertia: Option<f64>) -> PyResult<()> {
        let element = LumpedMass::new(node.0, mass)
            .with(rotary_inertia, LumpedMass::with_rotary_inertia)
            .or_raise()?;
        self.0.add(element).or_raise().map(|_| ())
    }

    /// Adds plane-strain quadrilaterals of a ``material`` on ``nodes``, counter-clockwise: array of shape
    /// (quads, 4), or (quads, 8) with the midside nodes last. ``formulation`` and ``hourglass_percent``,
    /// those of :class:`Layer`, are for four nodes.
    #[pyo3(signature = (nodes, material, *, formulation="incompatible_modes", hourglass_percent=5))]
    fn add_quads(
        &mut self,
        nodes: Connectivity,
        material: &PyMaterial,
        formulation: &str,
        #[pyo3(from_py_with = whole)] hourglass_percent: usize,
    ) -> PyResult<()> {
        let formulation = self::formulation(formulation, hourglass_percent)?;
        if nodes.each == 8 {
            let all = nodes.rows::<8>()?.into_iter();
            return self.add_all(all.map(|own| Ok(Quad8::new(own, material.0))));
        }
        let all = nodes.rows::<4>()?.into_iter();
        self.add_all(all.map(|own| Ok(Quad4::new(own, material.0, formulation))))
    }

    /// Number of the node at (``x``, ``y``), m, to a millionth of the mesh's size.
    fn node_at(&self, x: f64, y: f64) -> PyResult<usize> {
        self.0.node_at(x, y).or_raise()
    }

    /// Numbers of the nodes at a height ``y`` (m) within a ``tolerance`` (m; 1e-9 by default): list, from
    /// left to right.
    #[pyo3(signature = (y, tolerance=1e-9))]
    fn nodes_at_height(&self, y: f64, tolerance: f64) -> PyResult<Vec<usize>> {
        self.0.nodes_at_height(y, tolerance).or_raise()
    }

    fn __repr__(&self) -> String {
        format!("Mesh({} nodes, {} elements)", self.0.nodes().len(), self.0.elements().len())
    }
}
