//! Contact elements that are rectangles of cells, or parts of a cell.
//!
//! All cells of an element have the element's traction, and the element's displacement is the mean over its cells. With
//! the incidence matrix P of cells and elements, integrals over elements are PᵀFP, which is passive if F is. The traction
//! on a part of a cell is distributed over the whole cell, and the part has a spring in series.
//!
//! The traction τ(n) of a step is its mean, but the displacement refers to the end of the step. The displacement of a
//! spring with the compliance f is therefore f (3 τ(n) − τ(n−1))/2. This rule is of second order and passive: its work
//! f τ(n) (3 τ(n) − 4 τ(n−1) + τ(n−2))/2 has the symbol f (1 − cos θ)² ≥ 0.

use crate::error::{Error, Result, memory, require, same_length};
use crate::geometry::COMPONENTS_IN_SPACE;

/// Contact elements of several cells, or of a part of a cell.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::bem) struct Unions {
    /// Element of each cell.
    cell_elements: Vec<usize>,
    /// Number of cells of each element.
    cell_counts: Vec<f64>,
    /// Area of the element in each cell, relative to the cell.
    area_ratios: Vec<f64>,
    /// Compliance of the spring under each element, component by component, m/Pa; empty without springs.
    spring_compliances: Vec<f64>,
    /// Traction of each spring in the last step, component by component, Pa.
    pub(in crate::bem) last_traction: Vec<f64>,
    /// Contact vector of cells, overwritten in each step.
    cell_values: Vec<f64>,
}

/// Quarters of cells, and the quarter of an element to which each belongs.
pub(super) struct Quarters {
    /// Column and row of each quarter of a cell.
    pub(super) cells: Vec<[usize; 2]>,
    /// Index of the quarter of an element: four for each element.
    pub(super) elements: Vec<usize>,
}

/// Ratio of a spring's displacement at the end of a step, due to the step's traction, to its static displacement.
pub(in crate::bem) const STEP_END_SPRING_RATIO: f64 = 1.5;

impl Unions {
    /// Element of each cell of a lattice whose columns and rows are united.
    ///
    /// `widths`: numbers of columns and of rows to unite. Elements are in the order of their first cells.
    ///
    /// # Errors
    /// As for [`Plan::with_unions`](super::Plan::with_unions).
    pub(super) fn cell_elements(
        counts: [usize; 2],
        cells: &[[usize; 2]],
        widths: [&[usize]; 2],
    ) -> Result<Vec<usize>> {
        // Index of the union of each column, and of each row.
        let unions = [union_indices(widths[0], counts[0])?, union_indices(widths[1], counts[1])?];
        let union_of = |[i, j]: [usize; 2]| unions[1][j] * widths[0].len() + unions[0][i];
        let mut has_cell = vec![false; counts[0] * counts[1]];
        for [i, j] in cells {
            has_cell[j * counts[0] + i] = true;
        }
        let mut union_elements = vec![None; widths[0].len() * widths[1].len()];
        let mut element_count = 0;
        let mut cell_elements = vec![];
        for cell in cells {
            let element = *union_elements[union_of(*cell)].get_or_insert(element_count);
            element_count = element_count.max(element + 1);
            cell_elements.push(element);
        }
        for index in 0..has_cell.len() {
            let cell = [index % counts[0], index / counts[0]];
            if !has_cell[index] {
                let element = union_elements[union_of(cell)];
                if element.is_some() {
                    let quantity = "cells of the mat in a union with others";
                    let members = cell_elements.iter().filter(|member| Some(**member) == element);
                    let value = members.count() as f64;
                    let needed = "all of its rectangle, or none";
                    return Err(Error::Input { quantity, value, needed });
                }
                continue;
            }
            for (axis, step) in [1, counts[0]].into_iter().enumerate() {
                let is_outermost = cell[axis] == 0
                    || cell[axis] + 1 == counts[axis]
                    || !has_cell[index - step]
                    || !has_cell[index + step];
                let width = widths[axis][unions[axis][cell[axis]]];
                let quantity = "width of an outermost union, cells";
                require(quantity, width as f64, width == 1 || !is_outermost, "1")?;
            }
        }
        Ok(cell_elements)
    }

    /// Quarters of cells, to check whether a flexible base needs more elements; `element_of` returns a cell's element.
    ///
    /// Quarters of an element: left front, right front, left back, right back.
    pub(super) fn quarters(cells: &[[usize; 2]], element_of: impl Fn(usize) -> usize) -> Quarters {
        let element_count = (0..cells.len()).map(|cell| element_of(cell) + 1).max().unwrap_or(0);
        let mut element_ends = vec![[[usize::MAX, 0]; 2]; element_count];
        for (index, cell) in cells.iter().enumerate() {
            for (axis, [start, end]) in element_ends[element_of(index)].iter_mut().enumerate() {
                *start = (*start).min(cell[axis]);
                *end = (*end).max(cell[axis] + 1);
            }
        }
        let mut quarter_cells = Vec::with_capacity(4 * cells.len());
        let mut quarter_elements = Vec::with_capacity(4 * cells.len());
        for (index, [i, j]) in cells.iter().enumerate() {
            let element = element_of(index);
            // In half cells, the middle of an element is the sum of its ends.
            let middle = element_ends[element].map(|[start, end]| start + end);
            for [right, back] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                let cell = [2 * i + right, 2 * j + back];
                let right_half = usize::from(cell[0] >= middle[0]);
                let back_half = usize::from(cell[1] >= middle[1]);
                quarter_cells.push(cell);
                quarter_elements.push(4 * element + right_half + 2 * back_half);
            }
        }
        Quarters { cells: quarter_cells, elements: quarter_elements }
    }

    /// Unions from the element of each cell.
    pub(super) fn new(cell_elements: &[usize]) -> Self {
        let element_count = cell_elements.iter().max().map_or(0, |last| last + 1);
        let mut cell_counts = vec![0.0; element_count];
        for element in cell_elements {
            cell_counts[*element] += 1.0;
        }
        Self {
            cell_values: vec![0.0; COMPONENTS_IN_SPACE * cell_elements.len()],
            cell_elements: cell_elements.to_vec(),
            cell_counts,
            area_ratios: vec![1.0; cell_elements.len()],
            spring_compliances: vec![],
            last_traction: vec![],
        }
    }

    /// Adds cut cells, with a spring under each cell.
    ///
    /// `cut_cells`: area of the element in each cell relative to the cell, and compliance of the spring relative to
    /// `whole_cell_compliance` (m/Pa), the static compliance of a whole cell.
    pub(super) fn with_cut_cells(
        mut self,
        cut_cells: impl Iterator<Item = (f64, f64)>,
        whole_cell_compliance: [f64; COMPONENTS_IN_SPACE],
    ) -> Self {
        let element_count = self.cell_counts.len();
        self.spring_compliances = vec![0.0; COMPONENTS_IN_SPACE * element_count];
        self.last_traction = vec![0.0; COMPONENTS_IN_SPACE * element_count];
        for (cell, (area_ratio, spring_ratio)) in cut_cells.enumerate() {
            let element = self.cell_elements[cell];
            self.area_ratios[cell] = area_ratio;
            for (component, compliance) in whole_cell_compliance.into_iter().enumerate() {
                self.spring_compliances[component * element_count + element] +=
                    spring_ratio * compliance * area_ratio / self.cell_counts[element];
            }
        }
        self
    }

    /// Overwrites displacements of elements from displacements of cells, which `fill_cells` computes.
    pub(in crate::bem) fn gather(
        &mut self,
        element_values: &mut [f64],
        fill_cells: impl FnOnce(&mut [f64]) -> Result<()>,
    ) -> Result<()> {
        let element_count = self.cell_counts.len();
        let cell_count = self.cell_elements.len();
        same_length(
            "displacement of the history",
            element_values.len(),
            COMPONENTS_IN_SPACE * element_count,
        )?;
        fill_cells(&mut self.cell_values)?;
        element_values.fill(0.0);
        for (index, value) in self.cell_values.iter().enumerate() {
            let component = index / cell_count;
            let element = self.cell_elements[index % cell_count];
            element_values[component * element_count + element] +=
                value / self.cell_counts[element];
        }
        for (index, compliance) in self.spring_compliances.iter().enumerate() {
            element_values[index] +=
                (1.0 - STEP_END_SPRING_RATIO) * *compliance * self.last_traction[index];
        }
        Ok(())
    }

    /// Tractions of the cells from tractions of elements; missing values are zero.
    pub(in crate::bem) fn spread(&mut self, element_values: &[f64]) -> &[f64] {
        self.last_traction.fill(0.0);
        for (last_traction, traction) in self.last_traction.iter_mut().zip(element_values) {
            *last_traction = *traction;
        }
        for index in 0..self.cell_values.len() {
            let area_ratio = self.area_ratios[index % self.cell_elements.len()];
            let element_value = element_values.get(self.element_index(index)).copied();
            self.cell_values[index] = area_ratio * element_value.unwrap_or(0.0);
        }
        &self.cell_values
    }

    /// Overwrites the compliance of elements from the compliance of cells, which `fill_cells` computes.
    ///
    /// `spring_factor`: factor of the springs' static compliance, 1, or [`STEP_END_SPRING_RATIO`] for a step.
    pub(in crate::bem) fn reduce(
        &self,
        matrix: &mut [f64],
        spring_factor: f64,
        fill_cells: impl FnOnce(&mut [f64]) -> Result<()>,
    ) -> Result<()> {
        let cell_order = COMPONENTS_IN_SPACE * self.cell_elements.len();
        let order = COMPONENTS_IN_SPACE * self.cell_counts.len();
        same_length("compliance of elements", matrix.len(), order * order)?;
        let bytes = 8.0 * (cell_order as f64).powi(2);
        memory::check("cells of a mat", self.cell_elements.len() as f64, bytes)?;
        let mut cell_matrix = vec![0.0; cell_order * cell_order];
        fill_cells(&mut cell_matrix)?;
        matrix.fill(0.0);
        for (cell_row, row_values) in cell_matrix.chunks_exact(cell_order).enumerate() {
            let row = self.element_index(cell_row);
            let mean_weight = 1.0 / self.cell_counts[row % self.cell_counts.len()];
            for (cell_column, value) in row_values.iter().enumerate() {
                let column = self.element_index(cell_column);
                let area_ratio = self.area_ratios[cell_column % self.cell_elements.len()];
                matrix[row * order + column] += mean_weight * (area_ratio * value);
            }
        }
        for (index, compliance) in self.spring_compliances.iter().enumerate() {
            matrix[index * (order + 1)] += spring_factor * compliance;
        }
        Ok(())
    }

    /// Index in a contact vector of elements that corresponds to an index in a contact vector of cells.
    fn element_index(&self, cell_index: usize) -> usize {
        let component = cell_index / self.cell_elements.len();
        let cell = cell_index % self.cell_elements.len();
        component * self.cell_counts.len() + self.cell_elements[cell]
    }
}

/// Index of the union of each column (or row), from the numbers of columns to unite.
fn union_indices(widths: &[usize], column_count: usize) -> Result<Vec<usize>> {
    let width_sum = widths.iter().fold(0, |sum: usize, width| sum.saturating_add(*width));
    if width_sum != column_count {
        return Err(Error::Size {
            quantity: "cells in unions",
            found: width_sum,
            needed: column_count,
        });
    }
    require("cells in a union", 0.0, !widths.contains(&0), "1 or more")?;
    let mut union_indices = Vec::with_capacity(column_count);
    for (index, width) in widths.iter().enumerate() {
        union_indices.extend(vec![index; *width]);
    }
    Ok(union_indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tractions are the means over each step of a traction that grows linearly from zero at t = 0.
    #[test]
    fn springs_are_displaced_as_at_the_end_of_the_step() {
        let cut_cells = [(1.0, 0.0), (0.5, 0.8)].into_iter();
        let mut unions = Unions::new(&[0, 1]).with_cut_cells(cut_cells, [2.0, 3.0, 5.0]);
        let static_compliances = diagonal_compliances(&unions, 1.0);
        let step_compliances = diagonal_compliances(&unions, STEP_END_SPRING_RATIO);
        // Half of 0.8 of 2, 3 and 5.
        for (computed, expected) in static_compliances.iter().zip([0.0, 0.8, 0.0, 1.2, 0.0, 2.0]) {
            assert!((computed - expected).abs() < 1e-15);
        }
        for time in 1..9 {
            let mean_traction = f64::from(time) - 0.5;
            let mut history = vec![0.0; 6];
            unions.gather(&mut history, fill_zero).unwrap();
            for (index, history) in history.iter().enumerate().filter(|_| time > 1) {
                let computed = history + step_compliances[index] * mean_traction;
                let expected = static_compliances[index] * f64::from(time);
                assert!((computed - expected).abs() < 1e-14, "{time}");
            }
            unions.spread(&[mean_traction; 6]);
        }
    }

    #[allow(clippy::unnecessary_wraps, reason = "the type of `fill_cells`")]
    fn fill_zero(cell_values: &mut [f64]) -> Result<()> {
        cell_values.fill(0.0);
        Ok(())
    }

    /// Diagonal of the compliance of elements on rigid soil.
    fn diagonal_compliances(unions: &Unions, spring_factor: f64) -> [f64; 6] {
        let mut matrix = vec![0.0; 36];
        unions.reduce(&mut matrix, spring_factor, fill_zero).unwrap();
        [0, 1, 2, 3, 4, 5].map(|index| matrix[7 * index])
    }
}
