//! Positions and areas of the cells and contact elements of a plan.

use std::collections::HashSet;

use super::Plan;
use crate::geometry::{ContactElement, Lattice, middle};

impl Plan {
    /// Ends of a cell's contact element along x and y, m.
    pub(in crate::bem::plan) fn ends(&self, cell: usize) -> [[f64; 2]; 2] {
        if let Some(cut_cell) = self.cut_cells.get(cell) {
            return cut_cell.ends;
        }
        [0, 1].map(|axis| {
            [0, 1].map(|end| {
                self.corner[axis] + self.lattice.pitch[axis] * (self.cells[cell][axis] + end) as f64
            })
        })
    }

    /// Lever arms along x and y: centre of a cell's contact element from the middle of the plan, m.
    pub(in crate::bem::plan) fn arms(&self, cell: usize) -> [f64; 2] {
        if let Some(cut_cell) = self.cut_cells.get(cell) {
            return [0, 1].map(|axis| middle(cut_cell.ends[axis]) - self.middle()[axis]);
        }
        let Lattice { pitch, counts } = &self.lattice;
        let column_and_row = self.cells[cell];
        [0, 1].map(|axis| {
            let half_side_count = 2.0 * column_and_row[axis] as f64 + 1.0 - counts[axis] as f64;
            0.5 * half_side_count * pitch[axis]
        })
    }

    /// Compliance of the spring in series with a cell, relative to the cell's static compliance.
    pub(in crate::bem::plan) fn spring_ratio(&self, cell: usize) -> f64 {
        self.cut_cells.get(cell).map_or(0.0, |cut_cell| cut_cell.spring_ratio)
    }

    /// Contact elements of the plan, for grounds and structures.
    pub fn elements(&self) -> Vec<ContactElement> {
        let mut element_ends: Vec<[[f64; 2]; 2]> = vec![];
        for cell in 0..self.count() {
            let cell_ends = self.ends(cell);
            // Cells of a mat are sorted row by row, so that the first cell of an element precedes its other cells.
            match element_ends.get_mut(self.element_of(cell)) {
                Some(ends) => {
                    for axis in 0..2 {
                        ends[axis][1] = ends[axis][1].max(cell_ends[axis][1]);
                    }
                }
                None => element_ends.push(cell_ends),
            }
        }
        let mut elements = Vec::with_capacity(element_ends.len());
        for ([x_ends, y_ends], [area_inside, total_area]) in
            element_ends.into_iter().zip(self.areas())
        {
            let fraction = (area_inside / total_area).min(1.0);
            elements.push(ContactElement::in_plan(x_ends, y_ends).with_fraction_inside(fraction));
        }
        elements
    }

    /// Areas of each contact element (m²): inside the outline, and in total.
    pub(super) fn areas(&self) -> Vec<[f64; 2]> {
        let cell_area = self.cell_area();
        let mut element_areas: Vec<[f64; 2]> = vec![];
        for (cell, area_inside) in self.areas_inside_outline().into_iter().enumerate() {
            let element = self.element_of(cell);
            let area_ratio = self.cut_cells.get(cell).map_or(1.0, |cut_cell| cut_cell.area_ratio);
            element_areas.resize(element_areas.len().max(element + 1), [0.0; 2]);
            element_areas[element][0] += area_inside;
            element_areas[element][1] += cell_area * area_ratio;
        }
        element_areas
    }

    /// Area of a whole cell, m².
    fn cell_area(&self) -> f64 {
        self.lattice.pitch[0] * self.lattice.pitch[1]
    }

    /// Area of each cell inside the outline, m².
    pub(super) fn areas_inside_outline(&self) -> Vec<f64> {
        let cell_area = self.cell_area();
        if !self.cut_cells.is_empty() {
            let cut_cells = self.cut_cells.iter();
            return cut_cells.map(|c| cell_area * c.area_ratio * c.inside_fraction).collect();
        }
        let cells: HashSet<_> = self.cells.iter().copied().collect();
        let mut areas = Vec::with_capacity(self.cells.len());
        for &cell in &self.cells {
            areas.push(cell_area * self.fraction_of_whole_cell(&cells, cell));
        }
        areas
    }

    /// Fraction of a cell inside an outline along x and y: all but the overhang at sides without a neighbour.
    fn fraction_of_whole_cell(&self, cells: &HashSet<[usize; 2]>, [i, j]: [usize; 2]) -> f64 {
        let overhang = self.overhang;
        // Column and row steps 0, 1 and 2 are before, at and after the cell.
        let has_cell = |column_step: usize, row_step: usize| {
            let column = (i + column_step).checked_sub(1);
            let row = (j + row_step).checked_sub(1);
            column.zip(row).is_some_and(|(column, row)| cells.contains(&[column, row]))
        };
        let side_overhang = |has_neighbour: bool| if has_neighbour { 0.0 } else { overhang };
        let x_fraction = 1.0 - side_overhang(has_cell(0, 1)) - side_overhang(has_cell(2, 1));
        let y_fraction = 1.0 - side_overhang(has_cell(1, 0)) - side_overhang(has_cell(1, 2));
        let reentrant_corner_count = [[0, 0], [0, 2], [2, 0], [2, 2]]
            .into_iter()
            .filter(|[x, y]| has_cell(*x, 1) && has_cell(1, *y) && !has_cell(*x, *y))
            .count();
        x_fraction * y_fraction - overhang * overhang * reentrant_corner_count as f64
    }
}
