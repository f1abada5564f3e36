//! Meshes in the plane: quadrilaterals of solids, and blocks of them.

use basemat::fem::{Material, Mesh, Quad4, Quad8};
use pyo3::prelude::*;

use super::connectivity::Connectivity;
use super::layer::formulation_of;
use super::mesh::PyMesh;
use super::solid_material::{BlockMaterials, PlaneTensors, SolidList};
use crate::array::{Numbers, whole_numbers};
use crate::error::OrRaise;

#[pymethods]
impl PyMesh {
    /// Block of eight-node quadrilaterals between the vertical lines at ``x`` and the horizontal lines at ``y`` (arrays of
    /// shape (columns + 1,) and (rows + 1,), m, ascending), such as a column or a box of soil.
    ///
    /// ``material``: `Material`, `Iwan`, `DruckerPrager` or `UserMaterial`; or a list of one per row from the bottom, whose
    /// entries may be lists of one per column from the left. Elements are numbered row by row from the bottom, each from left
    /// to right. ``initial_stress``: stress xx, yy, zz and xy of the undeformed elements (Pa; tension is positive), four
    /// numbers or an array of shape (elements, 4); none unless given. Integration is reduced (2 × 2 points).
    #[staticmethod]
    #[pyo3(signature = (x, y, material, *, initial_stress=None))]
    fn quad8_block(
        x: Numbers,
        y: Numbers,
        material: BlockMaterials,
        initial_stress: Option<PlaneTensors>,
    ) -> PyResult<Self> {
        let column_count = x.0.len().saturating_sub(1);
        let row_count = y.0.len().saturating_sub(1);
        if column_count > 0 && row_count > 0 {
            material.check(column_count, row_count)?;
        }
        let Some(stresses) = &initial_stress else {
            let block = Mesh::quad8_block(&x.0, &y.0, |column, row| material.at(column, row));
            return block.or_raise().map(Self);
        };
        // An elastic block has the nodes, and the numbers of the nodes of each element.
        let elastic = Material::new(1.0, 0.0, 0.0).or_raise()?;
        let block = Mesh::quad8_block(&x.0, &y.0, |_, _| elastic).or_raise()?;
        let mut mesh = Mesh::new();
        for &point in block.nodes() {
            mesh.add_node_at(point).or_raise()?;
        }
        let element_count = block.elements().len();
        for (index, element) in block.elements().enumerate() {
            let mut nodes = [0; 8];
            nodes.copy_from_slice(element.nodes());
            let quad = Quad8::new(nodes, material.at(index % column_count, index / column_count));
            let stress = stresses.at(index, element_count)?;
            mesh.add(quad.with_initial_stress(stress)).or_raise()?;
        }
        Ok(Self(mesh))
    }

    /// Adds plane-strain quadrilaterals of a ``material`` and returns their numbers.
    ///
    /// ``nodes``, counter-clockwise: array of shape (quads, 4), or (quads, 8) with the midside nodes last. ``material``:
    /// `Material`, `Iwan`, `DruckerPrager` or `UserMaterial`, or a list of one per quadrilateral. Quadrilaterals of four nodes
    /// take a ``formulation`` and ``hourglass_percent`` as `Layer` does. ``initial_stress``: stress xx, yy, zz and xy of the
    /// undeformed quadrilaterals (Pa; tension is positive), four numbers or an array of shape (quads, 4); none unless given.
    /// A linear elastic material has none.
    #[pyo3(signature = (nodes, material, *, formulation=None, hourglass_percent=5, initial_stress=None))]
    fn add_quads(
        &mut self,
        nodes: Connectivity,
        material: SolidList,
        formulation: Option<&str>,
        #[pyo3(from_py_with = whole_numbers)] hourglass_percent: usize,
        initial_stress: Option<PlaneTensors>,
    ) -> PyResult<Vec<usize>> {
        let zero_stress = PlaneTensors(vec![[0.0; 4]]);
        let stresses = initial_stress.as_ref().unwrap_or(&zero_stress);
        if nodes.nodes_each == 8 {
            let quads = nodes.rows::<8>()?;
            let quad_count = quads.len();
            return self.add_all(quads.into_iter().enumerate().map(|(index, quad_nodes)| {
                let quad = Quad8::new(quad_nodes, material.at(index, quad_count)?);
                Ok(quad.with_initial_stress(stresses.at(index, quad_count)?))
            }));
        }
        let quads = nodes.rows::<4>()?;
        let quad_count = quads.len();
        self.add_all(quads.into_iter().enumerate().map(|(index, quad_nodes)| {
            let material = material.at(index, quad_count)?;
            let formulation = formulation_of(&material, formulation, hourglass_percent)?;
            let quad = Quad4::new(quad_nodes, material, formulation);
            Ok(quad.with_initial_stress(stresses.at(index, quad_count)?))
        }))
    }
}
