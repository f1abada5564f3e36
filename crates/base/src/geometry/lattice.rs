//! Lattice of equal cells in rows and columns, and the offsets between cells.

use std::ops::Mul;

use super::{COMPONENTS_IN_SPACE, ContactElement};

/// Largest distance of an element from its cell, relative to a cell's sides.
///
/// It is above rounding errors of coordinates.
const CELL_POSITION_TOLERANCE: f64 = 1e-9;
/// Largest number of cells per element: transforms over emptier lattices are slower than direct products.
const MAX_CELLS_PER_ELEMENT: f64 = 4.0;

/// Number of distinct compliances per offset.
///
/// In order: zz, xx, yy, xy, zx and zy (zx: down at the receiver due to shear along x).
pub const COMPLIANCES_PER_OFFSET: usize = 6;

/// Lattice of equal cells: compliances depend only on the offset between two cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    /// Sides of a cell along x and y, m.
    pub pitch: [f64; 2],
    /// Numbers of cells along x and y.
    pub counts: [usize; 2],
}

impl Lattice {
    /// Diagonal of the whole lattice, m.
    pub fn diagonal(&self) -> f64 {
        let sides = self.sides();
        sides[0].hypot(sides[1])
    }

    /// Sides of the whole lattice along x and y, m.
    pub fn sides(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.pitch[axis] * self.counts[axis] as f64)
    }

    /// Shorter side of a cell, m.
    pub fn shorter_side(&self) -> f64 {
        self.pitch[0].min(self.pitch[1])
    }

    /// Whether cells are square, so that x and y may be exchanged.
    fn is_square(&self) -> bool {
        self.pitch[0] == self.pitch[1]
    }

    /// Numbers of offsets in the two directions of [`Lattice::classes`].
    ///
    /// They are the numbers of cells along x and y. If cells are square, the smaller number comes first.
    pub fn offset_counts(&self) -> [usize; 2] {
        let counts = self.counts;
        if self.is_square() {
            [counts[0].min(counts[1]), counts[0].max(counts[1])]
        } else {
            counts
        }
    }

    /// Offsets whose compliances give all others by symmetry.
    ///
    /// Both numbers of an offset [i, j] are zero or more; i ≤ j if cells are square.
    pub fn classes(&self) -> Vec<[usize; 2]> {
        let offset_counts = self.offset_counts();
        let mut classes = vec![];
        for i in 0..offset_counts[0] {
            for j in 0..offset_counts[1] {
                if !self.is_square() || i <= j {
                    classes.push([i, j]);
                }
            }
        }
        classes
    }

    /// Class index of an absolute offset, and whether x and y are exchanged.
    fn class_index(&self, [i, j]: [usize; 2]) -> (usize, bool) {
        let row_length = self.offset_counts()[1];
        if !self.is_square() {
            return (i * row_length + j, false);
        }
        let smaller_index = i.min(j);
        let larger_index = i.max(j);
        // Row `smaller` of the triangle stores the columns from `smaller` on.
        (smaller_index * row_length - smaller_index * (smaller_index + 1) / 2 + larger_index, i > j)
    }

    /// Class index and compliance terms of an offset.
    ///
    /// The term of a pair of components is the index and the factor of its compliance. Rows: components of the
    /// receiver's displacement (down, along x, along y). Columns: components of the source's traction. The
    /// receiver is `offset` cells from the source.
    #[inline]
    pub fn compliance_terms(&self, offset: [isize; 2]) -> (usize, [[(usize, f64); 3]; 3]) {
        let (class_index, is_exchanged) = self.class_index(offset.map(isize::unsigned_abs));
        let signs = offset.map(|n| if n < 0 { -1.0 } else { 1.0 });
        let xx_index = if is_exchanged { 2 } else { 1 };
        let yy_index = if is_exchanged { 1 } else { 2 };
        let zx_index = if is_exchanged { 5 } else { 4 };
        let zy_index = if is_exchanged { 4 } else { 5 };
        let xx = (xx_index, 1.0);
        let yy = (yy_index, 1.0);
        let xy = (3, signs[0] * signs[1]);
        let zx = (zx_index, signs[0]);
        let zy = (zy_index, signs[1]);
        // The coupling of shear and pressure changes its sign when receiver and source are exchanged.
        let xz = (zx_index, -signs[0]);
        let yz = (zy_index, -signs[1]);
        (class_index, [[(0, 1.0), zx, zy], [xz, xx, xy], [yz, xy, yy]])
    }

    /// Compliances (3 × 3) between a source and a receiver.
    ///
    /// The receiver is `offset` cells from the source. `values` has the compliances of all classes.
    pub fn block<T>(
        &self,
        values: &[[T; COMPLIANCES_PER_OFFSET]],
        offset: [isize; 2],
    ) -> [[T; 3]; 3]
    where
        T: Copy + Mul<f64, Output = T>,
    {
        let (class_index, terms) = self.compliance_terms(offset);
        terms.map(|row| row.map(|(index, factor)| values[class_index][index] * factor))
    }
}

/// Numbers of columns and rows from a source to a receiver.
#[inline]
pub fn offset(receiver: [usize; 2], source: [usize; 2]) -> [isize; 2] {
    [0, 1].map(|axis| receiver[axis].cast_signed() - source[axis].cast_signed())
}

/// Lattice cells of the elements, if they fill a lattice.
///
/// A cell is its column and row. The cells are equal; there are at most `MAX_CELLS_PER_ELEMENT` for each element.
pub fn lattice_cells(elements: &[ContactElement]) -> Option<Vec<[usize; 2]>> {
    let first_element = elements.first()?;
    if first_element.directions().len() != COMPONENTS_IN_SPACE {
        return None;
    }
    let pitch = first_element.sides();
    let mut corner = [f64::INFINITY; 2];
    for element in elements {
        for (axis, [low, _]) in element.ends().into_iter().enumerate() {
            corner[axis] = corner[axis].min(low);
        }
    }
    let max_cell_count = MAX_CELLS_PER_ELEMENT * elements.len() as f64;
    let mut cells = Vec::with_capacity(elements.len());
    let mut cell_counts = [0; 2];
    for element in elements {
        let sides = element.sides();
        let mut cell = [0; 2];
        for axis in 0..2 {
            let position = (element.ends()[axis][0] - corner[axis]) / pitch[axis];
            let has_cell_size = (sides[axis] / pitch[axis] - 1.0).abs() <= CELL_POSITION_TOLERANCE;
            let is_on_grid = (position - position.round()).abs() <= CELL_POSITION_TOLERANCE;
            if !has_cell_size || !is_on_grid || position.is_nan() || position >= max_cell_count {
                return None;
            }
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "from zero to a few times the number of elements"
            )]
            let cell_index = position.round() as usize;
            cell[axis] = cell_index;
            cell_counts[axis] = cell_counts[axis].max(cell_index + 1);
        }
        cells.push(cell);
    }
    ((cell_counts[0] * cell_counts[1]) as f64 <= max_cell_count).then_some(cells)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_numbered_as_listed() {
        for (pitch, counts) in
            [([1.0, 1.0], [4, 4]), ([1.0, 1.0], [5, 3]), ([1.0, 1.0], [2, 6]), ([1.0, 1.5], [4, 3])]
        {
            let lattice = Lattice { pitch, counts };
            let classes = lattice.classes();
            let mut is_class_used = vec![false; classes.len()];
            for i in 0..counts[0] {
                for j in 0..counts[1] {
                    let (class_index, is_exchanged) = lattice.class_index([i, j]);
                    assert_eq!(classes[class_index], if is_exchanged { [j, i] } else { [i, j] });
                    is_class_used[class_index] = true;
                }
            }
            assert!(is_class_used.into_iter().all(|is_used| is_used), "{counts:?}");
        }
    }

    /// Betti: exchanging receiver and source transposes the block.
    #[test]
    fn blocks_are_reciprocal() {
        let lattice = Lattice { pitch: [1.0; 2], counts: [4, 5] };
        let values: Vec<[f64; COMPLIANCES_PER_OFFSET]> = (0..lattice.classes().len())
            .map(|class| {
                std::array::from_fn(|index| (COMPLIANCES_PER_OFFSET * class + index + 1) as f64)
            })
            .collect();
        for offset in [[0_isize, 3], [3, 1], [-2, 4], [-3, -1]] {
            let block = lattice.block(&values, offset);
            let reverse_block = lattice.block(&values, offset.map(|n| -n));
            for (row, column) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)] {
                if offset.contains(&0) && row != column {
                    continue;
                }
                assert_eq!(block[row][column], reverse_block[column][row], "{offset:?}");
                assert_eq!(block[column][row], reverse_block[row][column], "{offset:?}");
            }
        }
    }

    #[test]
    fn elements_find_their_cells() {
        let cells = [[0, 0], [1, 0], [2, 0], [0, 1], [2, 1], [1, 3]];
        let elements: Vec<_> = cells.iter().map(|cell| element(*cell)).collect();
        assert_eq!(lattice_cells(&elements), Some(cells.to_vec()));
        let wider_element = ContactElement::in_plan([1.9, 1.9 + 0.3 * 2.0], [-2.0, -1.3]);
        let displaced_element =
            ContactElement::in_plan([1.95, 1.9 + 0.3 * 1.0 + 0.05], [-2.0, -1.3]);
        let distant_element = element([9, 9]);
        for extra_element in [wider_element, displaced_element, distant_element] {
            assert_eq!(lattice_cells(&[&elements[..], &[extra_element]].concat()), None);
        }
        assert_eq!(lattice_cells(&[ContactElement::new(0.0, 1.0)]), None);
    }

    /// Element in this column and row of a lattice with cells of 0.3 m × 0.7 m.
    fn element([i, j]: [usize; 2]) -> ContactElement {
        let x = 0.3 * i as f64;
        let y = 0.7 * j as f64;
        ContactElement::in_plan([1.0 + x, 1.3 + x], [-2.0 + y, -1.3 + y])
    }
}
