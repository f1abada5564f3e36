//! Degrees of freedom of the mesh around a trench, and their elimination.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::cliques::EliminationPlan;
use super::element::{ElementBasis, LoadedEdge};
use super::forms::RetainedFunction;
use super::grid::TrenchGrid;
use super::stack::{JoinedStack, Stack};

/// Data that all meshes with the same [`MeshKey`] share.
#[derive(Debug)]
pub(super) struct MeshPlan {
    pub(super) basis: ElementBasis,
    pub(super) elimination: EliminationPlan,
}

/// Degrees of the elements of a mesh, and its number of stretched elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct MeshKey {
    /// Degree of the near field.
    pub(super) degree: usize,
    /// Degree of stretched elements along z.
    pub(super) stretched_degree: usize,
    /// Number of stretched elements in a column.
    pub(super) stretched_count: usize,
}

/// Plans of the meshes of one grid, each made at its first use.
#[derive(Debug, Clone, Default)]
pub(super) struct MeshPlans(Arc<Mutex<BTreeMap<MeshKey, Arc<MeshPlan>>>>);

impl MeshPlans {
    /// Plan of the meshes of a `key`; `make` computes it at its first use.
    pub(super) fn plan(&self, key: MeshKey, make: impl FnOnce() -> MeshPlan) -> Arc<MeshPlan> {
        let mut plans = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(plans.entry(key).or_insert_with(|| Arc::new(make())))
    }
}

/// Position of an element: its column from the axis, and its row from the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct ColumnCell {
    pub(super) column: usize,
    pub(super) row: usize,
}

/// Mesh between the axis and the regular columns.
pub(super) struct ColumnMesh<'a> {
    pub(super) grid: &'a TrenchGrid,
    /// Elements from the surface to the fixed bottom.
    pub(super) stack: &'a Stack,
    /// Joined elements on the line where the regular columns begin.
    pub(super) joined: &'a JoinedStack,
}

impl ColumnMesh<'_> {
    fn base_column_count(&self) -> usize {
        self.grid.base_lengths.len()
    }

    fn column_count(&self) -> usize {
        self.base_column_count() + self.grid.column_widths.len()
    }

    /// Number of rows beside the wall.
    fn wall_row_count(&self) -> usize {
        self.grid.wall_intervals.len()
    }

    /// Whether the regular columns follow a column.
    pub(super) fn is_outermost(&self, column: usize) -> bool {
        column + 1 == self.column_count()
    }

    /// Index of a column among those beyond the wall; `None` below the base.
    pub(super) fn column_beyond_wall(&self, column: usize) -> Option<usize> {
        column.checked_sub(self.base_column_count())
    }

    /// Width of a column, m.
    pub(super) fn column_width(&self, column: usize) -> f64 {
        match self.column_beyond_wall(column) {
            Some(index) => self.grid.column_widths[index],
            None => self.grid.base_lengths[column],
        }
    }

    /// All elements, column by column.
    pub(super) fn cells(&self) -> Vec<ColumnCell> {
        let mut cells = vec![];
        for column in 0..self.column_count() {
            let is_below_base = column < self.base_column_count();
            let first_row = if is_below_base { self.wall_row_count() } else { 0 };
            cells.extend((first_row..self.stack.0.len()).map(|row| ColumnCell { column, row }));
        }
        cells
    }

    /// Loaded edge of an element, with the index of its first load.
    ///
    /// The horizontal load comes first, then the vertical one.
    pub(super) fn load(&self, cell: ColumnCell) -> Option<(LoadedEdge, usize)> {
        let ColumnCell { column, row } = cell;
        if column < self.base_column_count() {
            return (row == self.wall_row_count()).then_some((LoadedEdge::Top, 2 * column));
        }
        let is_at_wall = column == self.base_column_count();
        let wall = self.grid.wall_intervals.get(row).filter(|_| is_at_wall)?;
        Some((LoadedEdge::Left, 2 * (self.base_column_count() + wall.element)))
    }

    /// Number of loads: two for each element of the base and of a wall.
    pub(super) fn load_count(&self) -> usize {
        2 * (self.base_column_count() + self.grid.wall_element_count())
    }

    /// Number of nodes on the axis.
    pub(super) fn axis_node_count(&self) -> usize {
        self.stack.node_count() - self.stack.top_node(self.wall_row_count())
    }

    /// Plan of all meshes with as many elements of these degrees.
    pub(super) fn plan(&self, key: MeshKey) -> MeshPlan {
        let basis = ElementBasis::new(key.degree, key.stretched_degree);
        let numbers = DofNumbers::new(self, &basis);
        let cells = self.cells().into_iter();
        let mut matrix_dofs: Vec<_> = cells.map(|cell| numbers.of_element(cell)).collect();
        let joined_node_count = self.joined.stack.node_count();
        let mut side_dofs = vec![];
        for component in 0..2 {
            let nodes = 0..joined_node_count;
            side_dofs.extend(nodes.map(|node| numbers.of_joined_node(component, node)));
        }
        matrix_dofs.push(side_dofs);
        let mut retained = vec![];
        let axis_nodes = self.stack.top_node(self.wall_row_count())..self.stack.node_count();
        for component in 0..2 {
            let nodes = axis_nodes.clone();
            retained.extend(nodes.filter_map(|node| numbers.of_node(0, component, node)));
        }
        retained.extend((0..self.load_count()).map(|load| numbers.first_load + load));
        let elimination = EliminationPlan::new(&matrix_dofs, &retained);
        MeshPlan { basis, elimination }
    }
}

/// Numbers of the degrees of freedom of a mesh.
struct DofNumbers<'a> {
    mesh: &'a ColumnMesh<'a>,
    basis: &'a ElementBasis,
    /// Number of nodes on a vertical line.
    node_count: usize,
    first_joined: usize,
    first_edge: usize,
    first_load: usize,
}

impl<'a> DofNumbers<'a> {
    fn new(mesh: &'a ColumnMesh<'a>, basis: &'a ElementBasis) -> Self {
        let node_count = mesh.stack.node_count();
        let first_joined = 2 * node_count * mesh.column_count();
        let first_edge = first_joined + 2 * mesh.joined.stack.node_count();
        let edge_function_count: usize = basis.edge_function_counts().iter().sum();
        let edge_count = mesh.column_count() * mesh.stack.0.len();
        let first_load = first_edge + edge_count * edge_function_count;
        Self { mesh, basis, node_count, first_joined, first_edge, first_load }
    }

    /// Number of a component at a node of a vertical line.
    ///
    /// `None` at the fixed bottom.
    fn of_node(&self, line: usize, component: usize, node: usize) -> Option<usize> {
        let number = (2 * line + component) * self.node_count + node;
        (node < self.node_count).then_some(number)
    }

    /// Number of a component at a node of the regular columns' line.
    ///
    /// `None` at the fixed bottom.
    fn of_joined_node(&self, component: usize, node: usize) -> Option<usize> {
        let node_count = self.mesh.joined.stack.node_count();
        let number = self.first_joined + component * node_count + node;
        (node < node_count).then_some(number)
    }

    /// Number of a function of the horizontal edge at the top of a row.
    ///
    /// `None` at the fixed bottom.
    fn of_edge(&self, column: usize, row: usize, parity: usize, function: usize) -> Option<usize> {
        let row_count = self.mesh.stack.0.len();
        let counts = self.basis.edge_function_counts();
        let edge = column * row_count + row;
        let first_function = if parity == 0 { 0 } else { counts[0] };
        let number = edge * (counts[0] + counts[1]) + first_function + function;
        (row < row_count).then_some(self.first_edge + number)
    }

    /// Numbers of the rows of an element's matrix.
    fn of_element(&self, cell: ColumnCell) -> Vec<Option<usize>> {
        let ColumnCell { column, row } = cell;
        let degree = self.mesh.stack.0[row].degree;
        let top_node = self.mesh.stack.top_node(row);
        let joined = &self.mesh.joined;
        let joined_top_node = joined.stack.top_node(joined.places[row].element);
        let mut numbers = vec![];
        for component in 0..2 {
            let levels = 0..=degree;
            numbers.extend(levels.map(|level| self.of_node(column, component, top_node + level)));
        }
        for component in 0..2 {
            for level in 0..=degree {
                numbers.push(if self.mesh.is_outermost(column) {
                    self.of_joined_node(component, joined_top_node + level)
                } else {
                    self.of_node(column + 1, component, top_node + level)
                });
            }
        }
        for parity in 0..2 {
            for function in self.basis.functions(parity, degree) {
                if let RetainedFunction::Edge { function, is_at_bottom } = *function {
                    let edge_row = row + usize::from(is_at_bottom);
                    numbers.push(self.of_edge(column, edge_row, parity, function));
                }
            }
        }
        if let Some((_, first_load)) = self.mesh.load(cell) {
            numbers.extend([0, 1].map(|component| Some(self.first_load + first_load + component)));
        }
        numbers
    }
}
