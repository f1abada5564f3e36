//! Compliance of the faces of a trench at a Laplace variable.

use std::ops::Range;

use basemat_fourier::num_complex::Complex64;

use super::column::{EdgeLoads, ElementBasis, ElementColumn, Moduli};
use super::grid::{Interval, TrenchGrid, WallInterval};
use super::polynomials::IntervalFunctions;
use super::stack::{CoarseStack, InterpolationEntry, Stack, StackElement};
use crate::error::Result;
use crate::linalg::ComplexBlock;

/// Largest number of doublings.
///
/// 2⁴⁵ columns attenuate even waves that lose 1e-12 of their amplitude in a column.
const MAX_COLUMN_DOUBLINGS: usize = 45;
/// Largest stiffness between both ends of the doubled columns, relative to a side's, that counts as zero.
const CROSS_STIFFNESS_TOLERANCE: f64 = 1e-13;
/// Angle of the stretched elements relative to the argument of s.
const STRETCH_ANGLE_RATIO: f64 = 0.6;
/// Longest stretched element, in c/|s|.
const MAX_STRETCHED_LENGTH: f64 = 8.0;
/// Smallest degree of stretched elements: a high degree needs fewer elements and less time.
const MIN_STRETCHED_DEGREE: usize = 8;

/// Compliances of the right half of a trench, for symmetric and antisymmetric fields.
///
/// The fields are symmetric or antisymmetric about the axis. Rows and columns: elements of the base from the axis, then
/// of the wall from the surface down; horizontal and then vertical for each. Displacements are integrals over the
/// elements, tractions are constant on them.
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

/// Largest difference between entries of two matrices, relative to the largest entry of `matrix`.
fn relative_difference(matrix: &ComplexBlock, other_matrix: &ComplexBlock) -> f64 {
    let entries = matrix.values().iter().zip(other_matrix.values());
    entries.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / matrix.largest()
}

/// Finite elements around a trench at one Laplace variable.
pub(super) struct TrenchModel<'a> {
    pub(super) grid: &'a TrenchGrid,
    pub(super) degree: usize,
    pub(super) bottom: &'a Bottom,
    /// Elastic constants of the soils from the surface down, and then of the backfill if there is any.
    pub(super) soils: &'a [Moduli],
}

impl TrenchModel<'_> {
    /// Compliances of the right half; `None` if the regular columns do not attenuate the waves.
    ///
    /// # Errors
    /// [`Error::Singular`](crate::Error::Singular).
    pub(super) fn compliances(&self) -> Result<Option<HalfCompliances>> {
        let Self { grid, degree, .. } = self;
        let functions = ElementBasis::new(*degree, self.bottom.degree);
        let full_stack = self.stack(false);
        let CoarseStack { stack: coarse_stack, interpolation } =
            full_stack.coarsened(&self.element_groups());
        let regular_column = functions.column(
            grid.regular_column_width,
            &coarse_stack,
            self.soils,
            EdgeLoads::NO_LOADS,
        )?;
        let coarse_node_count = coarse_stack.node_count();
        let Some(far_stiffness) = far_side_stiffness(regular_column, coarse_node_count)? else {
            return Ok(None);
        };
        let mut side =
            SideStiffness { matrix: far_stiffness, node_count: coarse_node_count, load_count: 0 };
        let load_count = self.load_count();
        let no_edge_loads = EdgeLoads { count: load_count, first_load: None };
        for (k, width) in grid.column_widths.iter().enumerate().rev() {
            let stack = self.stack(k < grid.backfilled_column_count);
            let column = functions.column(*width, &stack, self.soils, no_edge_loads)?;
            let is_outermost = k + 1 == grid.column_widths.len();
            let line_interpolation = is_outermost.then_some(&interpolation[..]);
            side = side.with_column(&column, stack.node_count(), load_count, line_interpolation)?;
        }
        self.load_wall(&mut side);
        let stack_below_base = Stack(full_stack.0[grid.wall_intervals.len()..].to_vec());
        for (k, length) in grid.base_lengths.iter().enumerate().rev() {
            let loads = EdgeLoads { count: load_count, first_load: Some(2 * k) };
            let column = functions.column(*length, &stack_below_base, self.soils, loads)?;
            side = side.with_column(&column, stack_below_base.node_count(), load_count, None)?;
        }
        let node_count = side.node_count;
        // On the axis the horizontal displacement of symmetric fields is fixed, and the vertical one of others.
        Ok(Some(HalfCompliances {
            symmetric: side.compliance(node_count..2 * node_count)?,
            antisymmetric: side.compliance(0..node_count)?,
        }))
    }

    /// Number of loads: two for each element of the base and of a wall.
    fn load_count(&self) -> usize {
        2 * (self.grid.base_lengths.len() + self.grid.wall_element_count())
    }

    /// Elements of a column from the surface to the fixed bottom.
    fn stack(&self, is_backfilled: bool) -> Stack {
        let grid = self.grid;
        let degree = self.degree;
        let last_soil = self.soils.len() - 1;
        let mut elements = vec![];
        for wall in &grid.wall_intervals {
            let height = Complex64::from(wall.interval.length);
            let soil_index = if is_backfilled { last_soil } else { wall.interval.soil_index };
            elements.push(StackElement { height, soil_index, degree });
        }
        for Interval { length, soil_index } in &grid.lower_intervals {
            let height = Complex64::from(*length);
            elements.push(StackElement { height, soil_index: *soil_index, degree });
        }
        let Bottom { heights, degree } = self.bottom;
        // The half-plane is the last soil of the profile.
        let soil_index = last_soil - usize::from(grid.backfilled_column_count > 0);
        for height in heights {
            elements.push(StackElement { height: *height, soil_index, degree: *degree });
        }
        Stack(elements)
    }

    /// Groups of elements that the regular columns join to one element.
    fn element_groups(&self) -> Vec<Range<usize>> {
        let grid = self.grid;
        let wall_intervals = grid.wall_intervals.iter().map(|wall| &wall.interval);
        let intervals: Vec<_> = wall_intervals.chain(&grid.lower_intervals).collect();
        let mut groups = vec![];
        let mut begin = 0;
        while begin < intervals.len() {
            let mut end = begin + 1;
            let mut length = intervals[begin].length;
            while end < intervals.len()
                && intervals[end].soil_index == intervals[begin].soil_index
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
        let function_means = IntervalFunctions::lagrange(self.degree).means();
        let mut top_node = 0;
        let base_count = self.grid.base_lengths.len();
        for WallInterval { interval, element } in &self.grid.wall_intervals {
            for (j, mean) in function_means.iter().enumerate() {
                let node = top_node + j;
                if node >= side.node_count {
                    continue;
                }
                for component in 0..2 {
                    let row = component * side.node_count + node;
                    let load_row = 2 * side.node_count + 2 * (base_count + element) + component;
                    side.matrix[(row, load_row)] -= mean * interval.length;
                    side.matrix[(load_row, row)] -= mean * interval.length;
                }
            }
            top_node += self.degree;
        }
    }
}

/// Stiffness of the soil beyond a vertical line, bordered by the loads there.
struct SideStiffness {
    matrix: ComplexBlock,
    node_count: usize,
    load_count: usize,
}

impl SideStiffness {
    /// Stiffness beyond the left side of a column that is joined to this line.
    ///
    /// `node_count`: of the left side. `line_interpolation`: of the displacements of this line (coarse) at the nodes of
    /// the column (fine); `None` if the column has the lowest nodes of this line.
    fn with_column(
        self,
        column: &ElementColumn,
        node_count: usize,
        load_count: usize,
        line_interpolation: Option<&[InterpolationEntry]>,
    ) -> Result<Self> {
        let line_order = 2 * self.node_count;
        let order = 2 * node_count + load_count;
        let mut matrix = column.mean(1.0);
        let cross_stiffness = column.mean(-1.0);
        let mut pivot = self.matrix.submatrix(0..line_order, 0..line_order);
        let mut coupling = ComplexBlock::zeros(line_order, order);
        let interpolation = self.dof_interpolation(node_count, line_interpolation);
        for InterpolationEntry { fine_index: dof, coarse_index: line_dof, value } in &interpolation
        {
            for j in 0..order {
                let stiffness = mirrored(*dof, node_count, cross_stiffness[(*dof, j)]);
                coupling[(*line_dof, j)] += stiffness * *value;
            }
        }
        let mut column_stiffness = ComplexBlock::zeros(line_order, 2 * node_count);
        for InterpolationEntry { fine_index: dof, coarse_index: line_dof, value } in &interpolation
        {
            for j in 0..2 * node_count {
                let stiffness =
                    mirrored(*dof, node_count, mirrored(j, node_count, matrix[(*dof, j)]));
                column_stiffness[(*line_dof, j)] += stiffness * *value;
            }
        }
        for InterpolationEntry { fine_index: dof, coarse_index: line_dof, value } in &interpolation
        {
            for i in 0..line_order {
                pivot[(i, *line_dof)] += column_stiffness[(i, *dof)] * *value;
            }
        }
        // Both triangles are equal to the last bit for any order of the sums.
        for i in 0..self.load_count {
            for line_dof in 0..line_order {
                coupling[(line_dof, 2 * node_count + i)] += self.matrix[(line_dof, line_order + i)];
            }
            for j in 0..self.load_count {
                matrix[(2 * node_count + i, 2 * node_count + j)] +=
                    self.matrix[(line_order + i, line_order + j)];
            }
        }
        matrix.eliminate(&pivot, &coupling)?;
        Ok(Self { matrix, node_count, load_count })
    }

    /// Interpolation of this line's degrees of freedom: horizontal displacements, then vertical ones.
    fn dof_interpolation(
        &self,
        node_count: usize,
        line_interpolation: Option<&[InterpolationEntry]>,
    ) -> Vec<InterpolationEntry> {
        let line_node_count = self.node_count;
        let node_interpolation: Vec<_> = match line_interpolation {
            Some(entries) => entries.to_vec(),
            None => (0..node_count)
                .map(|node| InterpolationEntry {
                    fine_index: node,
                    coarse_index: line_node_count - node_count + node,
                    value: 1.0,
                })
                .collect(),
        };
        let mut dof_interpolation = Vec::with_capacity(2 * node_interpolation.len());
        for component in 0..2 {
            for entry in &node_interpolation {
                dof_interpolation.push(InterpolationEntry {
                    fine_index: component * node_count + entry.fine_index,
                    coarse_index: component * line_node_count + entry.coarse_index,
                    value: entry.value,
                });
            }
        }
        dof_interpolation
    }

    /// Compliance of the loads with the `free` degrees of freedom of this line.
    ///
    /// All other degrees of freedom are fixed.
    fn compliance(&self, free: Range<usize>) -> Result<ComplexBlock> {
        let loads = 2 * self.node_count..2 * self.node_count + self.load_count;
        let mut compliance = self.matrix.submatrix(loads.clone(), loads.clone());
        let pivot = self.matrix.submatrix(free.clone(), free.clone());
        compliance.eliminate(&pivot, &self.matrix.submatrix(free, loads))?;
        Ok(compliance.negated())
    }
}

/// Mirror image of a value of a degree of freedom: horizontal components change sign.
fn mirrored(dof: usize, node_count: usize, value: Complex64) -> Complex64 {
    if dof < node_count { -value } else { value }
}

/// Stiffness of a side of infinitely many equal columns.
///
/// `None` if 2⁴⁵ columns do not attenuate the waves.
fn far_side_stiffness(
    mut column: ElementColumn,
    node_count: usize,
) -> Result<Option<ComplexBlock>> {
    for _ in 0..MAX_COLUMN_DOUBLINGS {
        let stiffness = column.mean(1.0);
        let cross_stiffness = column.mean(-1.0);
        if cross_stiffness.largest() < CROSS_STIFFNESS_TOLERANCE * stiffness.largest() {
            return Ok(Some(stiffness));
        }
        column = double_column(&stiffness, &cross_stiffness, node_count)?;
    }
    Ok(None)
}

/// Joins two equal columns to one.
///
/// `stiffness`: of a side. `cross_stiffness`: between both sides.
fn double_column(
    stiffness: &ComplexBlock,
    cross_stiffness: &ComplexBlock,
    node_count: usize,
) -> Result<ElementColumn> {
    // In the middle one component is fixed, and the other one is free.
    Ok(ElementColumn {
        symmetric: with_free_dofs(stiffness, cross_stiffness, node_count..2 * node_count)?,
        antisymmetric: with_free_dofs(stiffness, cross_stiffness, 0..node_count)?,
    })
}

/// Stiffness of a side, with the other side free in some degrees of freedom.
///
/// The `free` degrees of freedom of the other side are eliminated, and all others of that side are fixed.
fn with_free_dofs(
    stiffness: &ComplexBlock,
    cross_stiffness: &ComplexBlock,
    free: Range<usize>,
) -> Result<ComplexBlock> {
    let mut side_stiffness = stiffness.clone();
    let pivot = stiffness.submatrix(free.clone(), free.clone());
    side_stiffness.eliminate(&pivot, &cross_stiffness.submatrix(free, 0..stiffness.rows()))?;
    Ok(side_stiffness)
}

/// Stretched elements below the near field, for all Laplace variables near one of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bottom {
    pub(super) heights: Vec<Complex64>,
    pub(super) degree: usize,
}

impl Bottom {
    /// Elements for Laplace variables near `s`, below an interval of `upper_length` metres.
    ///
    /// `speed`: of shear waves in the half-plane, m/s. `depth`: of all elements, in c/|s|.
    pub(super) fn new(
        s: Complex64,
        upper_length: f64,
        speed: f64,
        depth: f64,
        degree: usize,
    ) -> Self {
        let length_unit = speed / s.norm();
        let rotation = Complex64::from_polar(1.0, -STRETCH_ANGLE_RATIO * s.arg());
        let mut heights = vec![];
        let mut total_height = 0.0;
        let mut next_height = 2.0 * upper_length;
        while total_height < depth * length_unit {
            let height = next_height.min(MAX_STRETCHED_LENGTH * length_unit);
            heights.push(rotation * height);
            total_height += height;
            next_height = 2.0 * height;
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
