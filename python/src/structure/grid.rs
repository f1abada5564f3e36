//! Grids of nodes on surfaces.

use basemat::fem::Grid;
use pyo3::prelude::*;

use super::mesh::PyMesh;
use crate::array::{Array, Count, Numbers, Pairs, PointGrid};
use crate::error::input_error;

/// Nodes of a surface in rows, and the cells between them: from `Mesh.add_grid` and `Mesh.revolve`.
#[pyclass(name = "Grid", module = "basemat", frozen)]
pub(crate) struct PyGrid(Grid);

#[pymethods]
impl PyGrid {
    /// Numbers of the nodes of the row ``index``, a list from the first column on; a pole is a row of one node.
    fn row(&self, index: Count) -> PyResult<Vec<usize>> {
        let row_count = self.0.rows();
        if index.0 < row_count {
            return Ok(self.0.row(index.0).to_vec());
        }
        Err(input_error(format!(
            "index is {}, but must be below {row_count}, the number of rows",
            index.0
        )))
    }

    /// Number of rows.
    fn __len__(&self) -> usize {
        self.0.rows()
    }

    /// Corner nodes of the cells between neighbouring rows, for `Mesh.add_shells`: a list of lists of four numbers, of
    /// three beside a pole, row after row. Corners are listed counter-clockwise, as seen with columns to the right and
    /// rows upwards; of a wall by `Mesh.revolve`, as seen from outside.
    #[getter]
    fn cells(&self) -> Vec<Vec<usize>> {
        self.0.cells().map(|(_, cell)| cell).collect()
    }

    /// Number of the lower row of each of `cells`: array of shape (cells,).
    #[getter]
    fn cell_rows(&self) -> Array<u64> {
        self.0.cells().map(|(row, _)| row as u64).collect()
    }

    /// Adds nodes to the ``mesh`` at ``heights`` (array of shape (layers,), m, ascending) above the grid, whose cells
    /// must be counter-clockwise seen from above. Returns the nodes of the bricks between the layers, a list for
    /// `Mesh.add_bricks`.
    fn extrude(
        &self,
        mut mesh: PyRefMut<'_, PyMesh>,
        heights: Numbers,
    ) -> PyResult<Vec<[usize; 8]>> {
        mesh.change(|mesh| self.0.extrude(mesh, &heights.0))
    }

    fn __repr__(&self) -> String {
        format!("Grid({} rows, {} cells)", self.0.rows(), self.0.cells().count())
    }
}

#[pymethods]
impl PyMesh {
    /// Adds the nodes of a surface at ``points`` (array of shape (rows, columns, 3), m); returns its `Grid`.
    fn add_grid(&mut self, points: PointGrid) -> PyResult<PyGrid> {
        let PointGrid { shape: [rows, columns], points } = points;
        let grid = self.change(|mesh| {
            mesh.add_grid(rows, columns, |row, column| points[row * columns + column])
        });
        grid.map(PyGrid)
    }

    /// Adds the nodes of a surface of revolution; returns its `Grid`.
    ///
    /// ``axis``: x and y (m) of the vertical axis. ``meridian``: radius and height (m) of each row of nodes, array of shape
    /// (rows, 2); a row on the axis is one node, a pole. ``sectors``: number of columns round the axis, from the direction of
    /// x towards y.
    fn revolve(&mut self, axis: [f64; 2], meridian: Pairs, sectors: Count) -> PyResult<PyGrid> {
        self.change(|mesh| mesh.revolve(axis, &meridian.0, sectors.0)).map(PyGrid)
    }
}
