//! Places and areas of the cells and contact elements of a plan.

use std::collections::HashSet;

use super::Plan;
use crate::geometry::{ContactElement, Lattice, middle};

impl Plan {
    /// Ends of a cell's contact element along x and y, m.
    pub(in crate::bem::plan) fn ends(&self, cell: usize) -> [[f64; 2]; 2] {
        if let Some(cut) = self.cuts.get(cell) {
            return cut.ends;
        }
        [0, 1].map(|axis| {
            [0, 1].map(|end| {
                self.corner[axis] + self.lattice.pitch[axis] * (self.cells[cell][axis] + end) as f64
            })
        })
    }

    /// Centre of a cell's contact element from the middle of the plan, m.
    pub(in crate::bem::plan) fn arms(&self, cell: usize) -> [f64; 2] {
        if let Some(cut) = self.cuts.get(cell) {
            return [0, 1].map(|axis| middle(cut.ends[axis]) - self.middle()[axis]);
        }
        let Lattice { pitch, counts } = &self.lattice;
        let place = self.cells[cell];
        [0, 1].map(|axis| {
            let half_sides = 2.0 * place[axis] as f64 + 1.0 - counts[axis] as f64;
            0.5 * half_sides * pitch[axis]
        })
    }

    /// Compliance in series with a cell, relative to the cell's static compliance.
    pub(in crate::bem::plan) fn softness(&self, cell: usize) -> f64 {
        self.cuts.get(cell).map_or(0.0, |cut| cut.softness)
    }

    /// The contact elements.
    pub fn elements(&self) -> Vec<ContactElement> {
        let mut element_ends: Vec<[[f64; 2]; 2]> = vec![];
        for cell in 0..self.count() {
            let cell_ends = self.ends(cell);
            // Cells of a mat come row by row, and the first cell of an element before its others.
            match element_ends.get_mut(self.owner(cell)) {
                Some(ends) => {
                    for axis in 0..2 {
                        ends[axis][1] = ends[axis][1].max(cell_ends[axis][1]);
                    }
                }
                None => element_ends.push(cell_ends),
            }
        }
        let mut elements = Vec::with_capacity(element_ends.len());
        for ([along, across], [inside, whole]) in element_ends.into_iter().zip(self.areas()) {
            let fraction = (inside / whole).min(1.0);
            elements.push(ContactElement::in_plan(along, across).with_fraction_inside(fraction));
        }
        elements
    }

    /// Area of each contact element inside the outline, and of all its cells or parts of cells, m².
    pub(super) fn areas(&self) -> Vec<[f64; 2]> {
        let cell_area = self.cell_area();
        let mut sums: Vec<[f64; 2]> = vec![];
        for (cell, inside) in self.inside().into_iter().enumerate() {
            let owner = self.owner(cell);
            sums.resize(sums.len().max(owner + 1), [0.0; 2]);
            sums[owner][0] += inside;
            sums[owner][1] += cell_area * self.cuts.get(cell).map_or(1.0, |cut| cut.size);
        }
        sums
    }

    /// Area of a whole cell, m².
    fn cell_area(&self) -> f64 {
        self.lattice.pitch[0] * self.lattice.pitch[1]
    }

    /// Area of each cell that is inside the outline, m².
    pub(super) fn inside(&self) -> Vec<f64> {
        let cell_area = self.cell_area();
        if !self.cuts.is_empty() {
            return self.cuts.iter().map(|cut| cell_area * cut.size * cut.inside).collect();
        }
        let cells: HashSet<_> = self.cells.iter().copied().collect();
        let mut areas = Vec::with_capacity(self.cells.len());
        for &cell in &self.cells {
            areas.push(cell_area * self.fraction_of_whole_cell(&cells, cell));
        }
        areas
    }

    /// Fraction of a whole cell inside an outline along x and y, which the overhang cuts off at free sides.
    fn fraction_of_whole_cell(&self, cells: &HashSet<[usize; 2]>, [i, j]: [usize; 2]) -> f64 {
        let overhang = self.overhang;
        // Whether the neighbour is a cell; offsets 0, 1 and 2 are before, beside and after.
        let has = |right: usize, away: usize| {
            let column = (i + right).checked_sub(1);
            let row = (j + away).checked_sub(1);
            column.zip(row).is_some_and(|(column, row)| cells.contains(&[column, row]))
        };
        let cut_off = |has_neighbour: bool| if has_neighbour { 0.0 } else { overhang };
        let width = 1.0 - cut_off(has(0, 1)) - cut_off(has(2, 1));
        let depth = 1.0 - cut_off(has(1, 0)) - cut_off(has(1, 2));
        // Reentrant corners of the outline.
        let corners = [[0, 0], [0, 2], [2, 0], [2, 2]].into_iter();
        let notches = corners.filter(|[x, y]| has(*x, 1) && has(1, *y) && !has(*x, *y)).count();
        width * depth - overhang * overhang * notches as f64
    }
}
