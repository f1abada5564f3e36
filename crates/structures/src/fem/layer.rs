//! Meshes of rectangular quadrilaterals: horizontal layers on common grid lines.

use std::ops::Range;

use super::material::Material;
use super::mesh::Mesh;
use super::quad4::{Quad4, QuadFormulation};
use super::solid::SharedMaterial;
use crate::error::{MemoryError, Result, at_least, finite, memory, positive};

/// Horizontal layer of a block, with rows of elements of one material.
///
/// The material is a [`Material`], or a law of a solid that yields; a [`SharedMaterial`] where layers of a block have
/// materials of different types.
///
/// ```
/// use basemat::fem::{Iwan, Layer, Material, Mesh, SharedMaterial};
///
/// // Clay that yields below stiff elastic fill.
/// let clay = Iwan::hyperbolic(20.0e6, 40.0e3, 0.4, 0.49, 1800.0)?;
/// let fill = Material::new(200.0e6, 0.3, 2000.0)?;
/// let layers = [
///     Layer::new(4.0, 4, SharedMaterial::from(clay)),
///     Layer::new(1.0, 1, SharedMaterial::from(fill)),
/// ];
/// let mesh = Mesh::layered_block(0.0..2.0, 2, &layers)?;
/// assert_eq!(mesh.elements().filter(|element| element.inelastic().is_some()).count(), 8);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Layer<M = Material> {
    /// Height, m.
    pub height: f64,
    /// Rows of elements, of equal height.
    pub rows: usize,
    /// Material of the layer.
    pub material: M,
    /// Formulation of its quadrilaterals.
    pub formulation: QuadFormulation,
}

impl<M: Clone + Into<SharedMaterial>> Layer<M> {
    /// Layer of quadrilaterals with incompatible modes, or with the mean dilatation for a material that yields.
    ///
    /// Set [`formulation`](Layer::formulation) for others.
    pub fn new(height: f64, rows: usize, material: M) -> Self {
        let formulation = QuadFormulation::for_material(&material.clone().into());
        Self { height, rows, material, formulation }
    }
}

impl Mesh {
    /// Block of equal columns over the range `x` (m).
    ///
    /// Layers are listed upwards from y = 0. Nodes are numbered row by row from the base, left to right.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) or [`Error::Size`](crate::Error::Size) when the range is empty or not
    /// finite, when there are no columns, layers or rows, or when a height is not positive;
    /// [`Error::Memory`](crate::Error::Memory) when the elements would not fit into memory; as for [`Mesh::add`].
    pub fn layered_block<M: Clone + Into<SharedMaterial>>(
        x: Range<f64>,
        columns: usize,
        layers: &[Layer<M>],
    ) -> Result<Self> {
        finite("left end of the block", x.start)?;
        finite("right end of the block", x.end)?;
        positive("width of the block", x.end - x.start)?;
        check_memory(columns, layers)?;
        let mut grid_lines = Vec::with_capacity(columns + 1);
        for k in 0..=columns {
            // The weighted mean of both ends is exact at both; a sum of steps would not be.
            let fraction = k as f64 / columns.max(1) as f64;
            grid_lines.push(x.start * (1.0 - fraction) + x.end * fraction);
        }
        Self::graded_block(&grid_lines, layers)
    }

    /// Block of columns between `grid` lines (m, ascending), from y = 0 upwards.
    ///
    /// The edges of graded contact elements as `grid` match the mesh to these elements.
    ///
    /// ```
    /// use basemat::fem::{Layer, Material, Mesh};
    ///
    /// let layers = [Layer::new(1.0, 2, Material::new(1.0e9, 0.3, 2000.0)?)];
    /// let mesh = Mesh::graded_block(&[0.0, 0.1, 1.0], &layers)?;
    /// assert_eq!(mesh.nodes()[4], [0.1, 0.5, 0.0]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Mesh::layered_block`]; [`Error::Input`](crate::Error::Input) also when the grid does not ascend.
    pub fn graded_block<M: Clone + Into<SharedMaterial>>(
        grid: &[f64],
        layers: &[Layer<M>],
    ) -> Result<Self> {
        at_least("grid lines of the block", grid.len(), 2)?;
        at_least("layers of the block", layers.len(), 1)?;
        check_grid_lines(grid, "width of a column")?;
        check_memory(grid.len() - 1, layers)?;
        let mut mesh = Self::new();
        add_row(&mut mesh, grid, 0.0)?;
        let mut layer_bottom = 0.0;
        for layer in layers {
            positive("height of a layer", layer.height)?;
            at_least("rows of a layer", layer.rows, 1)?;
            let material: SharedMaterial = layer.material.clone().into();
            for row in 1..=layer.rows {
                let y = layer_bottom + layer.height * (row as f64 / layer.rows as f64);
                let first_node = add_row(&mut mesh, grid, y)?;
                for upper_left in first_node..first_node + grid.len() - 1 {
                    let lower_left = upper_left - grid.len();
                    let nodes = [lower_left, lower_left + 1, upper_left + 1, upper_left];
                    mesh.add(Quad4::new(nodes, material.clone(), layer.formulation))?;
                }
            }
            layer_bottom += layer.height;
        }
        Ok(mesh)
    }
}

/// Returns an error unless grid lines are finite and ascend.
///
/// `distance_name`: name of the distance between two lines in the error.
pub(super) fn check_grid_lines(lines: &[f64], distance_name: &'static str) -> Result<()> {
    for &line in lines {
        finite("grid line of the block", line)?;
    }
    for pair in lines.windows(2) {
        positive(distance_name, pair[1] - pair[0])?;
    }
    Ok(())
}

/// Bytes per quadrilateral: the element, one node, and its entry in the map of elements.
const BYTES_PER_QUADRILATERAL: f64 = 500.0;

/// Returns an error unless the quadrilaterals of a block fit into memory.
fn check_memory<M>(columns: usize, layers: &[Layer<M>]) -> std::result::Result<(), MemoryError> {
    let rows: f64 = layers.iter().map(|layer| layer.rows as f64).sum();
    // There is one more row of nodes than rows of elements.
    let node_count = columns as f64 * (rows + 1.0);
    memory::check(
        "columns times rows of the block",
        node_count,
        BYTES_PER_QUADRILATERAL * node_count,
    )
}

/// Adds a row of nodes at the height `y` (m) and returns the index of the first one.
fn add_row(mesh: &mut Mesh, grid: &[f64], y: f64) -> Result<usize> {
    let first_node = mesh.nodes().len();
    for &x in grid {
        mesh.add_node(x, y)?;
    }
    Ok(first_node)
}
