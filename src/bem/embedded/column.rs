//! Columns of finite elements, reduced to the sides of a column.

use super::element::{ColumnElement, ElementBasis};
use super::forms::{Moduli, RetainedFunction};
use super::stack::Stack;
use crate::error::Result;
use crate::linalg::ComplexBlock;

/// Matrices of a column for symmetric and antisymmetric motions.
///
/// Both sides move as mirror images of each other, or as the negatives of these. Rows: horizontal and vertical
/// displacement of the nodes of one side. A matrix is half of the stiffness for such a motion.
pub(super) struct ElementColumn {
    pub(super) symmetric: ComplexBlock,
    pub(super) antisymmetric: ComplexBlock,
}

impl ElementColumn {
    /// Half of the sum (`sign` 1) or of the difference (−1) of both matrices.
    ///
    /// The sum is the stiffness of a side, and the difference the stiffness between a side and the mirrored other one.
    pub(super) fn mean(&self, sign: f64) -> ComplexBlock {
        let entries = self.symmetric.values().iter().zip(self.antisymmetric.values());
        let values =
            entries.map(|(symmetric, antisymmetric)| (symmetric + antisymmetric * sign) * 0.5);
        ComplexBlock::from_columns(self.symmetric.rows(), values.collect())
    }

    /// Matrices of a column of `width`, m.
    pub(super) fn new(
        basis: &ElementBasis,
        width: f64,
        stack: &Stack,
        soils: &[Moduli],
    ) -> Result<Self> {
        Ok(Self {
            symmetric: side_matrix(basis, 0, width, stack, soils)?,
            antisymmetric: side_matrix(basis, 1, width, stack, soils)?,
        })
    }
}

/// Matrix of a side, for symmetric (0) or antisymmetric (1) motions.
fn side_matrix(
    basis: &ElementBasis,
    parity: usize,
    width: f64,
    stack: &Stack,
    soils: &[Moduli],
) -> Result<ComplexBlock> {
    let node_count = stack.node_count();
    let edge_function_count = basis.edge_function_counts()[parity];
    let edge_order = stack.0.len() * edge_function_count;
    let mut matrices = ColumnMatrices {
        sides: ComplexBlock::zeros(2 * node_count, 2 * node_count),
        edges: ComplexBlock::zeros(edge_order, edge_order),
        coupling: ComplexBlock::zeros(edge_order, 2 * node_count),
    };
    for (k, element) in stack.0.iter().enumerate() {
        let top_node = stack.top_node(k);
        let moduli = soils[element.soil_index];
        let degree = element.degree;
        let matrix = basis.half_stiffness(
            parity,
            &ColumnElement { width, height: element.height, degree, moduli },
        )?;
        let functions = basis.functions(parity, degree);
        let mut rows = Vec::with_capacity(functions.len());
        for function in functions {
            rows.push(match *function {
                RetainedFunction::Side { component, level } => {
                    side_row(component, top_node + level, node_count)
                }
                RetainedFunction::Edge { function, is_at_bottom } => {
                    let edge = k + usize::from(is_at_bottom);
                    let is_free = edge < stack.0.len();
                    is_free.then_some(MatrixRow::Edge(edge * edge_function_count + function))
                }
            });
        }
        matrices.add(&matrix, &rows);
    }
    let ColumnMatrices { mut sides, edges, coupling } = matrices;
    sides.eliminate(&edges, &coupling)?;
    Ok(sides)
}

/// Row or column of an element's function in the matrices of a column.
enum MatrixRow {
    /// Among the nodes of a side.
    Side(usize),
    /// Among the functions of horizontal edges.
    Edge(usize),
}

/// Matrices of a column before the functions of edges are eliminated.
struct ColumnMatrices {
    sides: ComplexBlock,
    edges: ComplexBlock,
    /// Rows of edges, columns of sides.
    coupling: ComplexBlock,
}

impl ColumnMatrices {
    /// Adds the matrix of an element, whose functions have these `rows`.
    fn add(&mut self, matrix: &ComplexBlock, rows: &[Option<MatrixRow>]) {
        for (j, column) in rows.iter().enumerate() {
            for (i, row) in rows.iter().enumerate() {
                let value = matrix[(i, j)];
                match (row, column) {
                    (Some(MatrixRow::Side(row)), Some(MatrixRow::Side(column))) => {
                        self.sides[(*row, *column)] += value;
                    }
                    (Some(MatrixRow::Edge(row)), Some(MatrixRow::Edge(column))) => {
                        self.edges[(*row, *column)] += value;
                    }
                    (Some(MatrixRow::Edge(row)), Some(MatrixRow::Side(column))) => {
                        self.coupling[(*row, *column)] += value;
                    }
                    _ => {}
                }
            }
        }
    }
}

/// Row of a component at a node of a side.
///
/// `None` at the fixed bottom.
fn side_row(component: usize, node: usize, node_count: usize) -> Option<MatrixRow> {
    (node < node_count).then_some(MatrixRow::Side(component * node_count + node))
}
