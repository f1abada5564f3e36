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
    /// Cells of each element.
    sizes: Vec<f64>,
    /// Ratio of the element's area in each cell to the cell.
    fractions: Vec<f64>,
    /// Compliance of the spring under each element, component by component, m/Pa; empty without springs.
    springs: Vec<f64>,
    /// Traction of each spring in the last step, component by component, Pa.
    pub(in crate::bem) last: Vec<f64>,
    /// A contact vector of cells.
    cells: Vec<f64>,
}

/// Displacement at the end of a step of a spring by the step's traction, relative to its static one.
pub(in crate::bem) const AT_END: f64 = 1.5;

impl Unions {
    /// Element of each cell of a lattice whose columns and rows are united.
    ///
    /// `along`, `across`: numbers of columns and rows to unite. Elements are in the order of their first cells.
    ///
    /// # Errors
    /// As for [`Plan::with_unions`](super::Plan::with_unions).
    pub(super) fn owners(
        counts: [usize; 2],
        cells: &[[usize; 2]],
        [along, across]: [&[usize]; 2],
    ) -> Result<Vec<usize>> {
        let mut lines = [vec![], vec![]];
        for ((sizes, count), lines) in [along, across].into_iter().zip(counts).zip(&mut lines) {
            let found = sizes.iter().fold(0, |sum: usize, size| sum.saturating_add(*size));
            if found != count {
                return Err(Error::Size { quantity: "cells in unions", found, needed: count });
            }
            let empty = sizes.contains(&0);
            require("cells in a union", 0.0, !empty, "1 or more")?;
            lines.extend(sizes.iter().enumerate().flat_map(|(n, size)| vec![n; *size]));
        }
        let mut on = vec![false; counts[0] * counts[1]];
        for [i, j] in cells {
            on[j * counts[0] + i] = true;
        }
        let block = |[i, j]: [usize; 2]| lines[1][j] * along.len() + lines[0][i];
        let mut numbers = vec![None; along.len() * across.len()];
        let mut owners = vec![];
        for cell in cells {
            let count = numbers.iter().flatten().count();
            owners.push(*numbers[block(*cell)].get_or_insert(count));
        }
        for (place, is_on) in on.iter().enumerate() {
            let cell = [place % counts[0], place / counts[0]];
            let union = numbers[block(cell)];
            if !is_on && union.is_some() {
                let quantity = "cells of the mat in a union with others";
                let value = owners.iter().filter(|owner| Some(**owner) == union).count() as f64;
                let needed = "all of its rectangle, or none";
                return Err(Error::Input { quantity, value, needed });
            }
            for (axis, step) in [1, counts[0]].into_iter().enumerate().filter(|_| *is_on) {
                let ends = [cell[axis] == 0, cell[axis] + 1 == counts[axis]];
                let outer = ends[0] || ends[1] || !on[place - step] || !on[place + step];
                let wide = [along, across][axis][lines[axis][cell[axis]]];
                let quantity = "width of an outermost union, cells";
                require(quantity, wide as f64, wide == 1 || !outer, "1")?;
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
        let mut ends = vec![[[usize::MAX, 0]; 2]; count];
        for (number, cell) in cells.iter().enumerate() {
            for (axis, [least, most]) in ends[owner(number)].iter_mut().enumerate() {
                (*least, *most) = ((*least).min(cell[axis]), (*most).max(cell[axis] + 1));
            }
        }
        let quarters = cells.iter().enumerate().flat_map(|(number, [i, j])| {
            let element = owner(number);
            let ends = ends[owner(number)];
            [[0, 0], [1, 0], [0, 1], [1, 1]].map(|part| {
                let cell = [2 * i + part[0], 2 * j + part[1]];
                // In half cells, the middle of an element is the sum of its ends.
                let beyond = |axis: usize| usize::from(cell[axis] >= ends[axis][0] + ends[axis][1]);
                (cell, 4 * element + beyond(0) + 2 * beyond(1))
            })
        });
        quarters.unzip()
    }

    /// Unions from the element of each cell.
    pub(super) fn new(owners: &[usize]) -> Self {
        let mut sizes = vec![0.0; owners.iter().max().map_or(0, |last| last + 1)];
        for owner in owners {
            sizes[*owner] += 1.0;
        }
        Self {
            cells: vec![0.0; COMPONENTS_IN_SPACE * owners.len()],
            owners: owners.to_vec(),
            sizes,
            fractions: vec![1.0; owners.len()],
            springs: vec![],
            last: vec![],
        }
    }

    /// Adds the ratio of each cell's element to the cell, and the compliance of a spring relative to the cell's `own`.
    pub(super) fn with_cuts(
        mut self,
        cuts: impl Iterator<Item = (f64, f64)>,
        own: [f64; COMPONENTS_IN_SPACE],
    ) -> Self {
        let count = self.sizes.len();
        [self.springs, self.last] = [(); 2].map(|()| vec![0.0; COMPONENTS_IN_SPACE * count]);
        for (cell, (fraction, softness)) in cuts.enumerate() {
            let owner = self.owners[cell];
            self.fractions[cell] = fraction;
            for (k, own) in own.into_iter().enumerate() {
                self.springs[k * count + owner] += softness * own * fraction / self.sizes[owner];
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
        let Self { owners, sizes, cells, springs, last, .. } = self;
        same_length(
            "displacement of the history",
            elements.len(),
            COMPONENTS_IN_SPACE * sizes.len(),
        )?;
        find(cells)?;
        elements.fill(0.0);
        let parts = elements.chunks_exact_mut(sizes.len()).zip(cells.chunks_exact(owners.len()));
        for (elements, cells) in parts {
            for (owner, value) in owners.iter().zip(cells) {
                elements[*owner] += value / sizes[*owner];
            }
        }
        let own = elements.iter_mut().zip(springs.iter().zip(last));
        own.for_each(|(value, (spring, last))| *value += (1.0 - AT_END) * spring * *last);
        Ok(())
    }

    /// Tractions of the cells; missing values of elements count as zero.
    pub(in crate::bem) fn spread(&mut self, elements: &[f64]) -> &[f64] {
        self.last.fill(0.0);
        self.last.iter_mut().zip(elements).for_each(|(last, value)| *last = *value);
        let parts = self.cells.chunks_exact_mut(self.owners.len());
        for (component, cells) in parts.enumerate() {
            for ((owner, fraction), value) in self.owners.iter().zip(&self.fractions).zip(cells) {
                let place = component * self.sizes.len() + owner;
                *value = fraction * elements.get(place).copied().unwrap_or(0.0);
            }
        }
        &self.cells
    }

    /// Calls `find` to fill the compliance of cells, and overwrites the compliance of elements.
    ///
    /// `spring_share` of the springs' static compliance: 1, or [`AT_END`] for a step.
    pub(in crate::bem) fn reduce(
        &self,
        matrix: &mut [f64],
        spring_share: f64,
        find: impl FnOnce(&mut [f64]) -> Result<()>,
    ) -> Result<()> {
        let width = COMPONENTS_IN_SPACE * self.owners.len();
        let size = COMPONENTS_IN_SPACE * self.sizes.len();
        same_length("compliance of elements", matrix.len(), size * size)?;
        let bytes = 8.0 * (width as f64).powi(2);
        memory::check("cells of a mat", self.owners.len() as f64, bytes)?;
        let mut cells = vec![0.0; width * width];
        find(&mut cells)?;
        matrix.fill(0.0);
        let place = |n: usize| {
            let component = n / self.owners.len();
            let cell = n % self.owners.len();
            component * self.sizes.len() + self.owners[cell]
        };
        for (row, values) in cells.chunks_exact(width).enumerate() {
            let to = place(row);
            let share = 1.0 / self.sizes[to % self.sizes.len()];
            for (column, value) in values.iter().enumerate() {
                let value = self.fractions[column % self.owners.len()] * value;
                matrix[to * size + place(column)] += share * value;
            }
        }
        let springs = self.springs.iter().enumerate();
        springs.for_each(|(place, spring)| matrix[place * (size + 1)] += spring_share * spring);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means over the steps of a traction that grows steadily, from rest at t = 0 on.
    #[test]
    fn springs_are_at_the_end_of_the_step() {
        let zero = |cells: &mut [f64]| {
            cells.fill(0.0);
            Ok(())
        };
        let cuts = [(1.0, 0.0), (0.5, 0.8)].into_iter();
        let mut unions = Unions::new(&[0, 1]).with_cuts(cuts, [2.0, 3.0, 5.0]);
        let [at_rest, step] = [1.0, AT_END].map(|share| {
            let mut matrix = vec![0.0; 36];
            unions.reduce(&mut matrix, share, zero).unwrap();
            [0, 1, 2, 3, 4, 5].map(|place| matrix[7 * place])
        });
        // Half of 0.8 of 2, 3 and 5.
        for (found, wanted) in at_rest.iter().zip([0.0, 0.8, 0.0, 1.2, 0.0, 2.0]) {
            assert!((found - wanted).abs() < 1e-15);
        }
        for time in 1..9 {
            let mean = f64::from(time) - 0.5;
            let mut displacement = vec![0.0; 6];
            unions.gather(&mut displacement, zero).unwrap();
            for (place, displacement) in displacement.iter().enumerate().filter(|_| time > 1) {
                let found = displacement + step[place] * mean;
                assert!((found - at_rest[place] * f64::from(time)).abs() < 1e-14, "{time}");
            }
            unions.spread(&[mean; 6]);
        }
    }
}
