//! Compliance of the faces of a trench at a Laplace variable.

use std::ops::Range;

use basemat_fourier::num_complex::Complex64;

use super::column::ElementColumn;
use super::element::{ColumnElement, ElementBasis};
use super::forms::Moduli;
use super::grid::{Interval, TrenchGrid};
use super::mesh::{ColumnMesh, MeshKey, MeshPlans};
use super::stack::{Stack, StackElement};
use crate::error::Result;
use crate::linalg::ComplexBlock;
use crate::soil::Soil;

/// Largest number of doublings.
///
/// 2⁴⁵ columns attenuate even waves that lose 1e-12 of their amplitude in a column.
const MAX_COLUMN_DOUBLINGS: usize = 45;
/// Largest stiffness between both sides of the doubled columns that counts as zero.
///
/// It is relative to the stiffness of a side.
const CROSS_STIFFNESS_TOLERANCE: f64 = 1e-13;
/// Angle of the complex height of stretched elements, relative to the argument of s.
const STRETCH_ANGLE_RATIO: f64 = 0.6;
/// Longest stretched element, in c/|s|; c is the speed of the waves that are left at its depth.
const MAX_STRETCHED_LENGTH: f64 = 12.0;
/// Depth in c/|s| below which shear waves of this speed c have decayed, so that only pressure waves are left.
const SHEAR_WAVE_DEPTH: f64 = 24.0;
/// Height of the first stretched element over that of the element above.
const FIRST_STRETCHED_RATIO: f64 = 0.5;
/// Height of each other stretched element over that of the element above.
const STRETCHED_GROWTH: f64 = 4.0;
/// Smallest degree of stretched elements.
///
/// With a high degree fewer elements suffice, which take less time. Heights depend on s, so that the compliance is analytic
/// only up to the error of these elements: below 1e-9, mostly 1e-11.
const MIN_STRETCHED_DEGREE: usize = 12;

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
    pub(super) plans: &'a MeshPlans,
    pub(super) degree: usize,
    pub(super) bottom: &'a Bottom,
    /// Elastic constants of the soils from the surface down, then of any backfill.
    pub(super) soils: &'a [Moduli],
}

impl TrenchModel<'_> {
    /// Compliances of the right half.
    ///
    /// `None` if the regular columns do not attenuate the waves.
    ///
    /// # Errors
    /// [`Error::Singular`](crate::Error::Singular).
    pub(super) fn compliances(&self) -> Result<Option<HalfCompliances>> {
        let stack = self.stack(false);
        let joined = stack.joined(&self.element_groups());
        let mesh = ColumnMesh { grid: self.grid, stack: &stack, joined: &joined };
        let key = MeshKey {
            degree: self.degree,
            stretched_degree: self.bottom.degree,
            stretched_count: self.bottom.heights.len(),
        };
        let plan = self.plans.plan(key, || mesh.plan(key));
        let width = self.grid.regular_column_width;
        let column = ElementColumn::new(&plan.basis, width, &joined.stack, self.soils)?;
        let Some(far_stiffness) = far_side_stiffness(column, joined.stack.node_count())? else {
            return Ok(None);
        };
        let mut matrices = self.element_matrices(&mesh, &plan.basis)?;
        matrices.push(far_stiffness);
        let matrix = plan.elimination.retained_matrix(matrices)?;
        let node_count = mesh.axis_node_count();
        // On the axis the horizontal displacement of symmetric fields is fixed, and the vertical one of others.
        Ok(Some(HalfCompliances {
            symmetric: compliance(&matrix, 2 * node_count, node_count..2 * node_count)?,
            antisymmetric: compliance(&matrix, 2 * node_count, 0..node_count)?,
        }))
    }

    /// Matrices of all elements between the axis and the regular columns.
    fn element_matrices(
        &self,
        mesh: &ColumnMesh,
        basis: &ElementBasis,
    ) -> Result<Vec<ComplexBlock>> {
        let filled_stack = self.stack(true);
        let filled_column_count = self.grid.backfilled_column_count;
        let mut matrices = vec![];
        for cell in mesh.cells() {
            let index = mesh.column_beyond_wall(cell.column);
            let is_filled = index.is_some_and(|index| index < filled_column_count);
            let stack = if is_filled { &filled_stack } else { mesh.stack };
            let StackElement { height, soil_index, degree } = stack.0[cell.row];
            let width = mesh.column_width(cell.column);
            let moduli = self.soils[soil_index];
            let element = ColumnElement { width, height, degree, moduli };
            let loaded_edge = mesh.load(cell).map(|(edge, _)| edge);
            let mut matrix = basis.stiffness(&element, loaded_edge)?;
            let place = &mesh.joined.places[cell.row];
            if let Some(interpolation) = &place.interpolation
                && mesh.is_outermost(cell.column)
            {
                interpolate_right_side(&mut matrix, interpolation, degree + 1);
            }
            matrices.push(matrix);
        }
        Ok(matrices)
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

    /// Groups of elements that are a single element in the regular columns.
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
}

/// Replaces the functions of an element's right side by those of a joined element.
///
/// `interpolation`: functions of the joined element at the nodes of the side, node by node.
fn interpolate_right_side(matrix: &mut ComplexBlock, interpolation: &[f64], node_count: usize) {
    let order = matrix.rows();
    for component in [2, 3] {
        let rows = component * node_count..(component + 1) * node_count;
        for column in 0..order {
            let values: Vec<_> = rows.clone().map(|row| matrix[(row, column)]).collect();
            for (function, row) in rows.clone().enumerate() {
                matrix[(row, column)] = interpolated(&values, interpolation, function);
            }
        }
        for row in 0..order {
            let values: Vec<_> = rows.clone().map(|column| matrix[(row, column)]).collect();
            for (function, column) in rows.clone().enumerate() {
                matrix[(row, column)] = interpolated(&values, interpolation, function);
            }
        }
    }
}

/// Sum of `values` at nodes times a function of a joined element there.
fn interpolated(values: &[Complex64], interpolation: &[f64], function: usize) -> Complex64 {
    let functions = interpolation.chunks_exact(values.len());
    values
        .iter()
        .zip(functions)
        .map(|(value, functions)| value * functions[function])
        .sum()
}

/// Displacements of the loaded edges due to unit loads.
///
/// On the axis, the `free` degrees of freedom are free and all others are fixed. `matrix`: of the degrees of freedom of
/// the axis, whose number is `axis_order`, and then of the loads.
fn compliance(
    matrix: &ComplexBlock,
    axis_order: usize,
    free: Range<usize>,
) -> Result<ComplexBlock> {
    let loads = axis_order..matrix.rows();
    let mut compliance = matrix.submatrix(loads.clone(), loads.clone());
    let pivot = matrix.submatrix(free.clone(), free.clone());
    compliance.eliminate(&pivot, &matrix.submatrix(free, loads))?;
    Ok(compliance.negated())
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
    /// `soil`: of the half-plane. `depth`: of all elements, in c/|s| of shear waves.
    pub(super) fn new(
        s: Complex64,
        upper_length: f64,
        soil: Soil,
        depth: f64,
        degree: usize,
    ) -> Self {
        let shear_length = soil.shear_wave_speed() / s.norm();
        let pressure_length = soil.pressure_wave_speed() / s.norm();
        let rotation = Complex64::from_polar(1.0, -STRETCH_ANGLE_RATIO * s.arg());
        let mut heights = vec![];
        let mut total_height = 0.0;
        let mut next_height = FIRST_STRETCHED_RATIO * upper_length;
        while total_height < depth * shear_length {
            let has_shear_waves = total_height < SHEAR_WAVE_DEPTH * shear_length;
            let length_unit = if has_shear_waves { shear_length } else { pressure_length };
            let height = next_height.min(MAX_STRETCHED_LENGTH * length_unit);
            heights.push(rotation * height);
            total_height += height;
            next_height = STRETCHED_GROWTH * height;
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
