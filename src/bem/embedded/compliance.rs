//! Compliance of the faces of a trench at a Laplace variable.

use std::ops::Range;

use basemat_fourier::num_complex::Complex64;

use super::grid::{Interval, TrenchGrid};
use super::polynomials::IntervalFunctions;
use super::stack::{EdgeLoads, ElementColumn, Elements, Moduli, Stack, StackElement};
use crate::error::Result;
use crate::linalg::ComplexBlock;

/// Largest number of doublings of the regular columns.
const MAX_COLUMN_DOUBLINGS: usize = 45;

/// Compliances of the right half of a trench, for fields that are symmetric or antisymmetric about its axis.
///
/// Rows and columns: elements of the base from the axis, then of the wall from the surface down; horizontal and then
/// vertical for each. Displacements are integrals over the elements, tractions are constant on them.
#[derive(Debug, Clone)]
pub(super) struct HalfCompliances {
    pub(super) symmetric: ComplexBlock,
    pub(super) antisymmetric: ComplexBlock,
}

impl HalfCompliances {
    /// Largest difference to `other` compliances, relative to the largest compliance.
    pub(super) fn difference(&self, other: &Self) -> f64 {
        relative_difference(&self.symmetric, &other.symmetric)
            .max(relative_difference(&self.antisymmetric, &other.antisymmetric))
    }
}

/// Largest difference of two matrices' entries, relative to the largest entry of the first.
fn relative_difference(one: &ComplexBlock, other: &ComplexBlock) -> f64 {
    let entries = one.values().iter().zip(other.values());
    entries.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / one.largest()
}

/// Finite elements around a trench at one Laplace variable.
pub(super) struct TrenchModel<'a> {
    pub(super) grid: &'a TrenchGrid,
    pub(super) degree: usize,
    pub(super) bottom: &'a Bottom,
    /// From the surface down; then the backfill, if there is any.
    pub(super) soils: &'a [Moduli],
}

impl TrenchModel<'_> {
    /// The compliances; `None` if waves do not come to rest in any number of regular columns.
    ///
    /// # Errors
    /// [`Error::Singular`](crate::Error::Singular).
    pub(super) fn compliances(&self) -> Result<Option<HalfCompliances>> {
        let Self { grid, degree, .. } = self;
        let elements = Elements::new(*degree, [*degree, self.bottom.degree]);
        let whole_stack = self.stack(false);
        let (coarse, coarse_values) = whole_stack.coarsened(&self.groups());
        let far_column = elements.column(grid.column, &coarse, self.soils, EdgeLoads::NO_LOADS)?;
        let Some(far) = far_columns(far_column, coarse.nodes())? else {
            return Ok(None);
        };
        let mut side = SideStiffness { matrix: far, nodes: coarse.nodes(), loads: 0 };
        let count = self.loads();
        let no_load_on_top = EdgeLoads { count, first: None };
        for (k, width) in grid.beside.iter().enumerate().rev() {
            let stack = self.stack(k < grid.backfilled);
            let column = elements.column(*width, &stack, self.soils, no_load_on_top)?;
            let is_outermost = k + 1 == grid.beside.len();
            let line_values = is_outermost.then_some(&coarse_values[..]);
            side = side.beside(&column, stack.nodes(), count, line_values)?;
        }
        self.load_wall(&mut side);
        let stack = Stack(whole_stack.0[grid.wall.len()..].to_vec());
        for (k, width) in grid.base.iter().enumerate().rev() {
            let loads = EdgeLoads { count, first: Some(2 * k) };
            let column = elements.column(*width, &stack, self.soils, loads)?;
            side = side.beside(&column, stack.nodes(), count, None)?;
        }
        let nodes = side.nodes;
        // On the axis the horizontal displacement is fixed, or the vertical one.
        Ok(Some(HalfCompliances {
            symmetric: side.compliance(nodes..2 * nodes)?,
            antisymmetric: side.compliance(0..nodes)?,
        }))
    }

    /// Number of loads: two for each element of the base and of a wall.
    fn loads(&self) -> usize {
        2 * (self.grid.base.len() + self.grid.walls())
    }

    /// Elements of a column from the surface to the fixed bottom.
    fn stack(&self, backfilled: bool) -> Stack {
        let grid = self.grid;
        let degree = self.degree;
        let fill = self.soils.len() - 1;
        let mut elements = vec![];
        for (interval, _) in &grid.wall {
            let soil = if backfilled { fill } else { interval.soil };
            elements.push(StackElement { height: Complex64::from(interval.length), soil, degree });
        }
        for Interval { length, soil } in &grid.below {
            elements.push(StackElement { height: Complex64::from(*length), soil: *soil, degree });
        }
        let Bottom { heights, degree } = self.bottom;
        // The half-plane is the last soil of the profile.
        let soil = fill - usize::from(grid.backfilled > 0);
        for height in heights {
            elements.push(StackElement { height: *height, soil, degree: *degree });
        }
        Stack(elements)
    }

    /// Elements that the regular columns join.
    fn groups(&self) -> Vec<Range<usize>> {
        let grid = self.grid;
        let intervals: Vec<_> =
            grid.wall.iter().map(|(interval, _)| interval).chain(&grid.below).collect();
        let mut groups = vec![];
        let mut begin = 0;
        while begin < intervals.len() {
            let mut end = begin + 1;
            let mut length = intervals[begin].length;
            while end < intervals.len()
                && intervals[end].soil == intervals[begin].soil
                && length + intervals[end].length <= grid.max_joined_length
            {
                length += intervals[end].length;
                end += 1;
            }
            groups.push(begin..end);
            begin = end;
        }
        // Stretched elements are not joined.
        for _ in &self.bottom.heights {
            groups.push(begin..begin + 1);
            begin += 1;
        }
        groups
    }

    /// Adds the loads on the wall to the matrix of the line of the wall.
    fn load_wall(&self, side: &mut SideStiffness) {
        let weights = IntervalFunctions::lagrange(self.degree).means();
        let mut node = 0;
        let base = self.grid.base.len();
        for (interval, element) in &self.grid.wall {
            for (j, weight) in weights.iter().enumerate().filter(|(j, _)| node + j < side.nodes) {
                for component in 0..2 {
                    let row = component * side.nodes + node + j;
                    let load = 2 * side.nodes + 2 * (base + element) + component;
                    side.matrix[(row, load)] -= weight * interval.length;
                    side.matrix[(load, row)] -= weight * interval.length;
                }
            }
            node += self.degree;
        }
    }
}

/// Stiffness of the soil beyond a vertical line, bordered by the loads there.
struct SideStiffness {
    matrix: ComplexBlock,
    nodes: usize,
    loads: usize,
}

impl SideStiffness {
    /// The soil beyond the left side of a column that is joined to this line.
    ///
    /// `nodes`: of the left side, which are the lowest of this one. `line_values`: node of the column, node of this line
    /// and value of the latter's function at the former; `None` if the nodes are the same.
    fn beside(
        self,
        column: &ElementColumn,
        nodes: usize,
        loads: usize,
        line_values: Option<&[(usize, usize, f64)]>,
    ) -> Result<Self> {
        let line_nodes = self.nodes;
        let line_order = 2 * line_nodes;
        let order = 2 * nodes + loads;
        let mut matrix = column.mean(1.0);
        let across = column.mean(-1.0);
        let mut pivot = self.matrix.submatrix(0..line_order, 0..line_order);
        let mut coupling = ComplexBlock::zeros(line_order, order);
        let same_nodes: Vec<_>;
        let node_values = if let Some(values) = line_values {
            values
        } else {
            same_nodes = (0..nodes).map(|node| (node, line_nodes - nodes + node, 1.0)).collect();
            &same_nodes
        };
        // The same for degrees of freedom: horizontal displacements, then vertical ones.
        let mut dof_values = Vec::with_capacity(2 * node_values.len());
        for component in 0..2 {
            for (node, line_node, value) in node_values {
                let row = component * nodes + node;
                dof_values.push((row, component * line_nodes + line_node, *value));
            }
        }
        for (row, place, value) in &dof_values {
            for column in 0..order {
                let stiffness = mirrored(*row, nodes, across[(*row, column)]);
                coupling[(*place, column)] += stiffness * *value;
            }
        }
        let mut column_stiffness = ComplexBlock::zeros(line_order, 2 * nodes);
        for (row, place, value) in &dof_values {
            for column in 0..2 * nodes {
                let stiffness =
                    mirrored(*row, nodes, mirrored(column, nodes, matrix[(*row, column)]));
                column_stiffness[(*place, column)] += stiffness * *value;
            }
        }
        for (column, place, value) in &dof_values {
            for row in 0..line_order {
                pivot[(row, *place)] += column_stiffness[(row, *column)] * *value;
            }
        }
        // Both triangles are the same to the last bit, whatever the order of the sums.
        for load in 0..self.loads {
            for row in 0..line_order {
                coupling[(row, 2 * nodes + load)] += self.matrix[(row, line_order + load)];
            }
            for other in 0..self.loads {
                matrix[(2 * nodes + load, 2 * nodes + other)] +=
                    self.matrix[(line_order + load, line_order + other)];
            }
        }
        matrix.eliminate(&pivot, &coupling)?;
        Ok(Self { matrix, nodes, loads })
    }

    /// Compliance of the loads if only the `free` degrees of freedom of this line are not fixed.
    fn compliance(&self, free: Range<usize>) -> Result<ComplexBlock> {
        let loads = 2 * self.nodes..2 * self.nodes + self.loads;
        let mut compliance = self.matrix.submatrix(loads.clone(), loads.clone());
        let pivot = self.matrix.submatrix(free.clone(), free.clone());
        compliance.eliminate(&pivot, &self.matrix.submatrix(free, loads))?;
        Ok(compliance.negated())
    }
}

/// A value of a degree of freedom on the other side of a mirror, which changes the sign of u_x.
fn mirrored(row: usize, nodes: usize, value: Complex64) -> Complex64 {
    if row < nodes { -value } else { value }
}

/// Stiffness of a side of infinitely many equal columns; `None` if waves do not come to rest in 2^45 of them.
fn far_columns(mut column: ElementColumn, nodes: usize) -> Result<Option<ComplexBlock>> {
    for _ in 0..MAX_COLUMN_DOUBLINGS {
        let stiffness = column.mean(1.0);
        let across = column.mean(-1.0);
        if across.largest() < FAR_STIFFNESS_TOLERANCE * stiffness.largest() {
            return Ok(Some(stiffness));
        }
        column = double_column(&stiffness, &across, nodes)?;
    }
    Ok(None)
}

/// Two equal columns as one, from the stiffness of a side of one, and between both sides.
fn double_column(
    stiffness: &ComplexBlock,
    across: &ComplexBlock,
    nodes: usize,
) -> Result<ElementColumn> {
    // In the middle one component is fixed, and the other one is free.
    Ok(ElementColumn {
        symmetric: with_free_middle(stiffness, across, nodes..2 * nodes)?,
        antisymmetric: with_free_middle(stiffness, across, 0..nodes)?,
    })
}

/// Stiffness of a side with the `free` degrees of freedom of the other side eliminated, all others fixed.
fn with_free_middle(
    stiffness: &ComplexBlock,
    across: &ComplexBlock,
    free: Range<usize>,
) -> Result<ComplexBlock> {
    let mut side = stiffness.clone();
    let pivot = stiffness.submatrix(free.clone(), free.clone());
    side.eliminate(&pivot, &across.submatrix(free, 0..stiffness.rows()))?;
    Ok(side)
}

/// Stiffness between both ends of a row of columns, relative to a side's, that counts as zero.
const FAR_STIFFNESS_TOLERANCE: f64 = 1e-13;

/// Heights of stretched elements, for all Laplace variables near one of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bottom {
    pub(super) heights: Vec<Complex64>,
    pub(super) degree: usize,
}

/// Angle of the stretched elements relative to the argument of s.
const STRETCH_ANGLE_RATIO: f64 = 0.6;
/// Longest stretched element, in c/|s|.
const MAX_STRETCHED_LENGTH: f64 = 8.0;
/// Smallest degree of stretched elements; few elements of a high degree take less time than many of a low one.
const MIN_STRETCHED_DEGREE: usize = 8;

impl Bottom {
    /// Elements for Laplace variables near `s`, below an interval of `last` metres.
    ///
    /// `speed`: of shear waves in the half-plane, m/s. `depth`: of all elements, in c/|s|.
    pub(super) fn new(s: Complex64, last: f64, speed: f64, depth: f64, degree: usize) -> Self {
        let wave_length = speed / s.norm();
        let rotation = Complex64::from_polar(1.0, -STRETCH_ANGLE_RATIO * s.arg());
        let mut heights = vec![];
        let mut total_height = 0.0;
        let mut next = 2.0 * last;
        while total_height < depth * wave_length {
            let height = next.min(MAX_STRETCHED_LENGTH * wave_length);
            heights.push(rotation * height);
            total_height += height;
            next = 2.0 * height;
        }
        Self { heights, degree: degree.max(MIN_STRETCHED_DEGREE) }
    }

    /// No elements: the near field ends on rigid bedrock.
    pub(super) fn rigid(degree: usize) -> Self {
        Self { heights: vec![], degree }
    }
}

#[cfg(test)]
mod tests;
