//! Contact elements that are rectangles of cells, or parts of a cell.
//!
//! All cells of an element have its traction, and the element's displacement is the mean of its cells. With the
//! incidence P of cells and elements, integrals over elements are PᵀFP, so they are passive too. The traction of a part
//! of a cell is spread over the cell, and the part has a spring in series.
//!
//! A step has one traction, its mean τ(n), but the displacement belongs to its end. The spring with the compliance f moves
//! by f (3 τ(n) − τ(n−1))/2, which is of second order and passive: its work f τ(n) (3 τ(n) − 4 τ(n−1) + τ(n−2))/2 has the
//! symbol f (1 − cos θ)² ≥ 0.

use crate::error::{Error, Result, memory, require, same_length};
use crate::geometry::COMPONENTS_IN_SPACE;

/// Cells of each element.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::bem) struct Unions {
    /// Element of each cell.
    owners: Vec<usize>,
    /// Number of cells of each element.
    cell_counts: Vec<f64>,
    /// Ratio of the element's area in each cell to the cell.
    fractions: Vec<f64>,
    /// Compliance of the spring under each element, component by component, m/Pa; empty without springs.
    springs: Vec<f64>,
    /// Traction of each spring in the last step, component by component, Pa.
    pub(in crate::bem) last_traction: Vec<f64>,
    /// A contact vector of cells.
    cells: Vec<f64>,
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
    pub(super) fn owners(
        counts: [usize; 2],
        cells: &[[usize; 2]],
        widths: [&[usize]; 2],
    ) -> Result<Vec<usize>> {
        // Number of the union along x of each column, and along y of each row.
        let mut union_numbers = [vec![], vec![]];
        for axis in 0..2 {
            let widths = widths[axis];
            let found = widths.iter().fold(0, |sum: usize, width| sum.saturating_add(*width));
            let needed = counts[axis];
            if found != needed {
                return Err(Error::Size { quantity: "cells in unions", found, needed });
            }
            require("cells in a union", 0.0, !widths.contains(&0), "1 or more")?;
            for (number, width) in widths.iter().enumerate() {
                union_numbers[axis].extend(vec![number; *width]);
            }
        }
        let mut is_cell = vec![false; counts[0] * counts[1]];
        for [i, j] in cells {
            is_cell[j * counts[0] + i] = true;
        }
        let union_of =
            |[i, j]: [usize; 2]| union_numbers[1][j] * widths[0].len() + union_numbers[0][i];
        let mut elements = vec![None; widths[0].len() * widths[1].len()];
        let mut owners = vec![];
        for cell in cells {
            let count = elements.iter().flatten().count();
            owners.push(*elements[union_of(*cell)].get_or_insert(count));
        }
        for place in 0..is_cell.len() {
            let cell = [place % counts[0], place / counts[0]];
            if !is_cell[place] {
                let element = elements[union_of(cell)];
                if element.is_some() {
                    let quantity = "cells of the mat in a union with others";
                    let members = owners.iter().filter(|owner| Some(**owner) == element);
                    let value = members.count() as f64;
                    let needed = "all of its rectangle, or none";
                    return Err(Error::Input { quantity, value, needed });
                }
                continue;
            }
            for (axis, step) in [1, counts[0]].into_iter().enumerate() {
                let is_outermost = cell[axis] == 0
                    || cell[axis] + 1 == counts[axis]
                    || !is_cell[place - step]
                    || !is_cell[place + step];
                let width = widths[axis][union_numbers[axis][cell[axis]]];
                let quantity = "width of an outermost union, cells";
                require(quantity, width as f64, width == 1 || !is_outermost, "1")?;
            }
        }
        Ok(owners)
    }

    /// Column and row of each quarter of some cells, and the quarter of an element to which it belongs.
    ///
    /// Quarters of an element: left front, right front, left back, right back.
    pub(super) fn quarters(
        cells: &[[usize; 2]],
        owner: impl Fn(usize) -> usize,
    ) -> (Vec<[usize; 2]>, Vec<usize>) {
        let count = (0..cells.len()).map(|cell| owner(cell) + 1).max().unwrap_or(0);
        let mut element_ends = vec![[[usize::MAX, 0]; 2]; count];
        for (number, cell) in cells.iter().enumerate() {
            for (axis, [low, high]) in element_ends[owner(number)].iter_mut().enumerate() {
                *low = (*low).min(cell[axis]);
                *high = (*high).max(cell[axis] + 1);
            }
        }
        let mut quarter_cells = Vec::with_capacity(4 * cells.len());
        let mut quarter_owners = Vec::with_capacity(4 * cells.len());
        for (number, [i, j]) in cells.iter().enumerate() {
            let element = owner(number);
            // In half cells, the middle of an element is the sum of its ends.
            let middle = element_ends[element].map(|[low, high]| low + high);
            for [right, back] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                let cell = [2 * i + right, 2 * j + back];
                let is_right = usize::from(cell[0] >= middle[0]);
                let is_back = usize::from(cell[1] >= middle[1]);
                quarter_cells.push(cell);
                quarter_owners.push(4 * element + is_right + 2 * is_back);
            }
        }
        (quarter_cells, quarter_owners)
    }

    /// Unions from the element of each cell.
    pub(super) fn new(owners: &[usize]) -> Self {
        let mut cell_counts = vec![0.0; owners.iter().max().map_or(0, |last| last + 1)];
        for owner in owners {
            cell_counts[*owner] += 1.0;
        }
        Self {
            cells: vec![0.0; COMPONENTS_IN_SPACE * owners.len()],
            owners: owners.to_vec(),
            cell_counts,
            fractions: vec![1.0; owners.len()],
            springs: vec![],
            last_traction: vec![],
        }
    }

    /// Adds cut cells, with a spring under each.
    ///
    /// `cuts`: ratio of the element's area in each cell to the cell, and compliance of the spring relative to the
    /// static compliance of a whole cell, `cell_compliance` (m/Pa).
    pub(super) fn with_cuts(
        mut self,
        cuts: impl Iterator<Item = (f64, f64)>,
        cell_compliance: [f64; COMPONENTS_IN_SPACE],
    ) -> Self {
        let count = self.cell_counts.len();
        self.springs = vec![0.0; COMPONENTS_IN_SPACE * count];
        self.last_traction = vec![0.0; COMPONENTS_IN_SPACE * count];
        for (cell, (fraction, softness)) in cuts.enumerate() {
            let owner = self.owners[cell];
            self.fractions[cell] = fraction;
            for (component, compliance) in cell_compliance.into_iter().enumerate() {
                self.springs[component * count + owner] +=
                    softness * compliance * fraction / self.cell_counts[owner];
            }
        }
        self
    }

    /// Calls `find` to fill a contact vector of cells, and overwrites the vector of elements.
    pub(in crate::bem) fn gather(
        &mut self,
        elements: &mut [f64],
        find: impl FnOnce(&mut [f64]) -> Result<()>,
    ) -> Result<()> {
        let Self { owners, cell_counts, cells, springs, last_traction, .. } = self;
        same_length(
            "displacement of the history",
            elements.len(),
            COMPONENTS_IN_SPACE * cell_counts.len(),
        )?;
        find(cells)?;
        elements.fill(0.0);
        let parts =
            elements.chunks_exact_mut(cell_counts.len()).zip(cells.chunks_exact(owners.len()));
        for (elements, cells) in parts {
            for (owner, value) in owners.iter().zip(cells) {
                elements[*owner] += value / cell_counts[*owner];
            }
        }
        for ((value, spring), traction) in elements.iter_mut().zip(springs).zip(last_traction) {
            *value += (1.0 - STEP_END_SPRING_RATIO) * *spring * *traction;
        }
        Ok(())
    }

    /// Tractions of the cells; missing values of elements count as zero.
    pub(in crate::bem) fn spread(&mut self, elements: &[f64]) -> &[f64] {
        self.last_traction.fill(0.0);
        for (last, traction) in self.last_traction.iter_mut().zip(elements) {
            *last = *traction;
        }
        let parts = self.cells.chunks_exact_mut(self.owners.len());
        for (component, cells) in parts.enumerate() {
            for ((owner, fraction), value) in self.owners.iter().zip(&self.fractions).zip(cells) {
                let place = component * self.cell_counts.len() + owner;
                *value = fraction * elements.get(place).copied().unwrap_or(0.0);
            }
        }
        &self.cells
    }

    /// Calls `find` to fill the compliance of cells, and overwrites the compliance of elements.
    ///
    /// `spring_ratio`: factor of the springs' static compliance, 1, or [`STEP_END_SPRING_RATIO`] for a step.
    pub(in crate::bem) fn reduce(
        &self,
        matrix: &mut [f64],
        spring_ratio: f64,
        find: impl FnOnce(&mut [f64]) -> Result<()>,
    ) -> Result<()> {
        let width = COMPONENTS_IN_SPACE * self.owners.len();
        let size = COMPONENTS_IN_SPACE * self.cell_counts.len();
        same_length("compliance of elements", matrix.len(), size * size)?;
        let bytes = 8.0 * (width as f64).powi(2);
        memory::check("cells of a mat", self.owners.len() as f64, bytes)?;
        let mut cells = vec![0.0; width * width];
        find(&mut cells)?;
        matrix.fill(0.0);
        for (cell_row, values) in cells.chunks_exact(width).enumerate() {
            let row = self.element_place(cell_row);
            let fraction = 1.0 / self.cell_counts[row % self.cell_counts.len()];
            for (cell_column, value) in values.iter().enumerate() {
                let column = self.element_place(cell_column);
                let value = self.fractions[cell_column % self.owners.len()] * value;
                matrix[row * size + column] += fraction * value;
            }
        }
        for (place, spring) in self.springs.iter().enumerate() {
            matrix[place * (size + 1)] += spring_ratio * spring;
        }
        Ok(())
    }

    /// Place in a contact vector of elements to which a place in one of cells belongs.
    fn element_place(&self, cell_place: usize) -> usize {
        let component = cell_place / self.owners.len();
        let cell = cell_place % self.owners.len();
        component * self.cell_counts.len() + self.owners[cell]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means over the steps of a traction that grows steadily, from rest at t = 0 on.
    #[test]
    fn springs_are_at_the_end_of_the_step() {
        let cuts = [(1.0, 0.0), (0.5, 0.8)].into_iter();
        let mut unions = Unions::new(&[0, 1]).with_cuts(cuts, [2.0, 3.0, 5.0]);
        let at_rest = spring_compliances(&unions, 1.0);
        let step = spring_compliances(&unions, STEP_END_SPRING_RATIO);
        // Half of 0.8 of 2, 3 and 5.
        for (found, wanted) in at_rest.iter().zip([0.0, 0.8, 0.0, 1.2, 0.0, 2.0]) {
            assert!((found - wanted).abs() < 1e-15);
        }
        for time in 1..9 {
            let mean = f64::from(time) - 0.5;
            let mut displacement = vec![0.0; 6];
            unions.gather(&mut displacement, fill_zero).unwrap();
            for (place, displacement) in displacement.iter().enumerate().filter(|_| time > 1) {
                let found = displacement + step[place] * mean;
                assert!((found - at_rest[place] * f64::from(time)).abs() < 1e-14, "{time}");
            }
            unions.spread(&[mean; 6]);
        }
    }

    #[allow(clippy::unnecessary_wraps, reason = "the type of the function that it stands for")]
    fn fill_zero(cells: &mut [f64]) -> Result<()> {
        cells.fill(0.0);
        Ok(())
    }

    /// Diagonal of the compliance of elements on rigid soil.
    fn spring_compliances(unions: &Unions, spring_ratio: f64) -> [f64; 6] {
        let mut matrix = vec![0.0; 36];
        unions.reduce(&mut matrix, spring_ratio, fill_zero).unwrap();
        [0, 1, 2, 3, 4, 5].map(|place| matrix[7 * place])
    }
}
