//! Grids of nodes on surfaces, row by row.

use super::material::Material;
use super::mesh::Mesh;
use super::shell::Shell;
use crate::error::{Error, Result, at_least, finite, in_bounds, not_negative, require};

/// Nodes of a surface, row by row, and the cells between them.
///
/// ```
/// use basemat::fem::{Material, Mesh};
///
/// // A tank in 24 sectors: a flat bottom of radius 5 m, from the pole at its middle, and a wall 6 m high.
/// let steel = Material::new(210.0e9, 0.3, 7850.0)?;
/// let mut mesh = Mesh::in_space();
/// let radii = [0.0, 2.5, 5.0].map(|radius| [radius, 0.0]);
/// let heights = [2.0, 4.0, 6.0].map(|height| [5.0, height]);
/// let tank = mesh.revolve([0.0, 0.0], &[&radii[..], &heights].concat(), 24)?;
/// for shell in tank.shells(steel, |row| if row < 2 { 0.012 } else { 0.008 })? {
///     mesh.add(shell)?;
/// }
/// assert_eq!(mesh.nodes().len(), 1 + 5 * 24);
/// assert_eq!(mesh.elements().len(), 5 * 24);
/// assert_eq!(tank.row(0), [0]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid {
    rows: Vec<Vec<usize>>,
    /// Whether the last column is next to the first one.
    is_closed: bool,
}

impl Grid {
    /// Nodes of the row `index`, column by column; a pole is one node.
    ///
    /// Empty for a row that does not exist.
    pub fn row(&self, index: usize) -> &[usize] {
        self.rows.get(index).map_or(&[], Vec::as_slice)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Cells between neighbouring rows: the index of the lower row, and the corner nodes.
    ///
    /// A cell has four corners, or three beside a pole. They are listed counter-clockwise, seen from the side on which
    /// columns run to the right and rows upwards. For a wall from [`Mesh::revolve`] that side is the outside.
    pub fn cells(&self) -> impl Iterator<Item = (usize, Vec<usize>)> + '_ {
        let row_pairs = self.rows.windows(2).enumerate();
        row_pairs.flat_map(move |(row, row_pair)| {
            let node_count = row_pair[0].len().max(row_pair[1].len());
            let cell_count = if self.is_closed { node_count } else { node_count - 1 };
            (0..cell_count).map(move |column| (row, Self::cell(&row_pair[0], &row_pair[1], column)))
        })
    }

    /// Corner nodes of the cell between two rows and after a column.
    ///
    /// A pole counts as one corner.
    fn cell(lower_row: &[usize], upper_row: &[usize], column: usize) -> Vec<usize> {
        let next_column = column + 1;
        let mut corners = vec![
            lower_row[column % lower_row.len()],
            lower_row[next_column % lower_row.len()],
            upper_row[next_column % upper_row.len()],
            upper_row[column % upper_row.len()],
        ];
        corners.dedup();
        corners
    }

    /// Shells of all cells, in the order of [`cells`](Grid::cells).
    ///
    /// `thickness` returns the thickness (m) of a row of cells. Triangles at a pole are matched to the quadrilaterals
    /// beside them ([`Shell::match_sides`]).
    ///
    /// # Errors
    /// As for [`Shell::new`].
    pub fn shells(
        &self,
        material: Material,
        thickness: impl Fn(usize) -> f64,
    ) -> Result<Vec<Shell>> {
        let shells = self.cells().map(|(row, cell)| Shell::new(cell, material, thickness(row)));
        let mut shells = shells.collect::<Result<Vec<_>>>()?;
        Shell::match_sides(&mut shells);
        Ok(shells)
    }

    /// Adds nodes above the grid and returns the bricks between them, for [`Hex8`](super::Hex8).
    ///
    /// `heights`: distances of the layers of nodes above the grid, m, ascending. Bricks are listed layer by layer. The
    /// corners of the grid's cells must run counter-clockwise seen from above.
    ///
    /// # Errors
    /// [`Error::Scene`] for a grid with a pole, [`Error::Index`] for a mesh without the grid's nodes, [`Error::Input`]
    /// for a mesh in the plane, and unless the heights are finite and ascend from above zero.
    pub fn extrude(&self, mesh: &mut Mesh, heights: &[f64]) -> Result<Vec<[usize; 8]>> {
        let quads: Option<Vec<[usize; 4]>> =
            self.cells().map(|(_, cell)| cell.try_into().ok()).collect();
        let needed = "must have cells of four corners to be extruded";
        let quads = quads.ok_or(Error::Scene { quantity: "grid", needed })?;
        let grid_nodes: Vec<usize> = self.rows.concat();
        for &node in &grid_nodes {
            in_bounds("node of the grid", node, mesh.nodes().len())?;
        }
        let mut bricks = Vec::with_capacity(quads.len() * heights.len());
        let mut lower_height = 0.0;
        let mut lower_nodes = grid_nodes.clone();
        // Index of each node of the mesh among the nodes of the grid.
        let mut grid_index = vec![0; mesh.nodes().len()];
        grid_nodes.iter().enumerate().for_each(|(index, &node)| grid_index[node] = index);
        for &height in heights {
            finite("height of a layer", height)?;
            require(
                "height of a layer",
                height,
                height > lower_height,
                "more than that of the layer below",
            )?;
            let mut upper_nodes = Vec::with_capacity(grid_nodes.len());
            for &node in &grid_nodes {
                let mut point = mesh.nodes()[node];
                point[2] += height;
                upper_nodes.push(mesh.add_node_at(point)?);
            }
            for quad in &quads {
                let mut brick = [0; 8];
                for (corner, &node) in quad.iter().enumerate() {
                    brick[corner] = lower_nodes[grid_index[node]];
                    brick[4 + corner] = upper_nodes[grid_index[node]];
                }
                bricks.push(brick);
            }
            lower_nodes = upper_nodes;
            lower_height = height;
        }
        Ok(bricks)
    }
}

impl Mesh {
    /// Adds the nodes of a surface, row by row.
    ///
    /// `point(row, column)` returns the coordinates [x, y, z] of a node, m.
    ///
    /// ```
    /// use basemat::fem::{Hex8, Material, Mesh};
    ///
    /// // A block of 4 m × 2 m × 3 m from 4 × 2 × 3 bricks.
    /// let mut mesh = Mesh::in_space();
    /// let floor = mesh.add_grid(3, 5, |row, column| [column as f64, row as f64, 0.0])?;
    /// let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
    /// for brick in floor.extrude(&mut mesh, &[1.0, 2.0, 3.0])? {
    ///     mesh.add(Hex8::new(brick, concrete))?;
    /// }
    /// assert_eq!(mesh.elements().len(), 4 * 2 * 3);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than two rows or columns; as for [`Mesh::add_node_at`].
    pub fn add_grid(
        &mut self,
        rows: usize,
        columns: usize,
        point: impl Fn(usize, usize) -> [f64; 3],
    ) -> Result<Grid> {
        at_least("rows of the grid", rows, 2)?;
        at_least("columns of the grid", columns, 2)?;
        let mut node_rows = Vec::with_capacity(rows);
        for row in 0..rows {
            let row_nodes: Result<Vec<usize>> =
                (0..columns).map(|column| self.add_node_at(point(row, column))).collect();
            node_rows.push(row_nodes?);
        }
        Ok(Grid { rows: node_rows, is_closed: false })
    }

    /// Adds the nodes of a surface of revolution about a vertical axis.
    ///
    /// `axis`: [x, y] of the axis, m. `meridian`: [radius, height] of each row of nodes, m; a row on the axis is one
    /// node, a pole. `sectors`: number of columns around the axis, from the direction of x towards y. [`Grid`] has an
    /// example.
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than two rows or three sectors; [`Error::Input`] for a negative radius and numbers that are not finite;
    /// [`Error::Scene`] for a mesh in the plane, or for two neighbouring rows on the axis.
    pub fn revolve(
        &mut self,
        axis: [f64; 2],
        meridian: &[[f64; 2]],
        sectors: usize,
    ) -> Result<Grid> {
        at_least("rows of the meridian", meridian.len(), 2)?;
        at_least("sectors of the surface", sectors, 3)?;
        let quantity = "surface of revolution";
        self.require_space(quantity)?;
        if meridian.windows(2).any(|pair| pair[0][0] == 0.0 && pair[1][0] == 0.0) {
            return Err(Error::Scene { quantity, needed: "must not run along its axis" });
        }
        let mut node_rows = Vec::with_capacity(meridian.len());
        for &[radius, height] in meridian {
            not_negative("radius of the meridian", radius)?;
            let column_count = if radius == 0.0 { 1 } else { sectors };
            let mut row_nodes = Vec::with_capacity(column_count);
            for column in 0..column_count {
                let angle = std::f64::consts::TAU * column as f64 / sectors as f64;
                let x = axis[0] + radius * angle.cos();
                let y = axis[1] + radius * angle.sin();
                row_nodes.push(self.add_node_at([x, y, height])?);
            }
            node_rows.push(row_nodes);
        }
        Ok(Grid { rows: node_rows, is_closed: true })
    }
}
