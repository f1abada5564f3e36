//! Rectangular meshes of eight-node quadrilaterals between given lines.

use super::layer::check_grid_lines;
use super::mesh::Mesh;
use super::quad8::Quad8;
use super::solid::SharedMaterial;
use crate::error::{Result, at_least, memory};

/// Bytes per element: the quadrilateral, its three nodes, and its entry in the map of elements.
const BYTES_PER_ELEMENT: f64 = 900.0;

impl Mesh {
    /// Block of [`Quad8`] between vertical and horizontal lines.
    ///
    /// The vertical lines are at `x`, the horizontal lines at `y` (m, ascending). Uses are columns and boxes of soil,
    /// with narrow elements where stresses vary. `material(column, row)` returns the material of an element, a
    /// [`Material`](super::Material) or a [`SharedMaterial`]; columns count from the left and rows from the bottom.
    /// Elements are added row by row from the bottom, each from left to right, with reduced integration.
    /// [`node_at`](Mesh::node_at) and [`nodes_at_height`](Mesh::nodes_at_height) return the nodes.
    ///
    /// ```
    /// use basemat::fem::{Material, Mesh};
    ///
    /// // Soft soil 2 m thick on stiff soil.
    /// let soft = Material::new(50.0e6, 0.45, 1800.0)?;
    /// let stiff = Material::new(400.0e6, 0.4, 2000.0)?;
    /// let y_lines = [-6.0, -4.0, -2.0, -1.0, 0.0];
    /// let mesh = Mesh::quad8_block(&[-4.0, -1.0, 1.0, 4.0], &y_lines, |_, row| {
    ///     if row < 2 { stiff } else { soft }
    /// })?;
    /// assert_eq!(mesh.elements().len(), 3 * 4);
    /// // Nodes of the surface: four corners and three between them.
    /// assert_eq!(mesh.nodes_at_height(0.0, 1e-9)?.len(), 7);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for fewer than two lines, [`Error::Input`](crate::Error::Input) unless the
    /// lines are finite and ascend, [`Error::Memory`](crate::Error::Memory) when the elements would not fit into
    /// memory; as for [`Mesh::add`].
    pub fn quad8_block<M: Into<SharedMaterial>>(
        x: &[f64],
        y: &[f64],
        material: impl Fn(usize, usize) -> M,
    ) -> Result<Self> {
        for lines in [x, y] {
            at_least("grid lines of the block", lines.len(), 2)?;
            check_grid_lines(lines, "distance between grid lines")?;
        }
        let element_count = (x.len() - 1) as f64 * (y.len() - 1) as f64;
        memory::check("elements of the block", element_count, BYTES_PER_ELEMENT * element_count)?;
        let mut mesh = Self::new();
        let mut lower_nodes = mesh.add_corner_row(x, y[0])?;
        for (row, heights) in y.windows(2).enumerate() {
            let middle_height = 0.5 * (heights[0] + heights[1]);
            let mut side_nodes = Vec::with_capacity(x.len());
            for &line in x {
                side_nodes.push(mesh.add_node(line, middle_height)?);
            }
            let upper_nodes = mesh.add_corner_row(x, heights[1])?;
            for column in 0..x.len() - 1 {
                let left_corner = 2 * column;
                let nodes = [
                    lower_nodes[left_corner],
                    lower_nodes[left_corner + 2],
                    upper_nodes[left_corner + 2],
                    upper_nodes[left_corner],
                    lower_nodes[left_corner + 1],
                    side_nodes[column + 1],
                    upper_nodes[left_corner + 1],
                    side_nodes[column],
                ];
                mesh.add(Quad8::new(nodes, material(column, row)))?;
            }
            lower_nodes = upper_nodes;
        }
        Ok(mesh)
    }

    /// Adds nodes at the height `y` (m): corners at the lines `x`, and nodes in the middle between them.
    fn add_corner_row(&mut self, x: &[f64], y: f64) -> Result<Vec<usize>> {
        let mut nodes = vec![self.add_node(x[0], y)?];
        for ends in x.windows(2) {
            nodes.push(self.add_node(0.5 * (ends[0] + ends[1]), y)?);
            nodes.push(self.add_node(ends[1], y)?);
        }
        Ok(nodes)
    }
}
