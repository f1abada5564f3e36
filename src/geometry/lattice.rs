//! Cells of equal size in rows and columns, and the offsets between them.

use std::ops::Mul;

use super::{COMPONENTS_IN_SPACE, ContactElement};

/// Largest difference of a cell from its place, relative to its sides.
const EQUAL: f64 = 1e-9;
/// Largest number of cells of a lattice for each element.
const FEW: f64 = 4.0;

/// Number of series of an offset: zz, xx, yy, xy, zx and zy (zx: down at the receiver due to shear along x).
pub(crate) const SERIES_PER_OFFSET: usize = 6;

/// Lattice of equal cells. Compliances depend only on the offset between two cells.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lattice {
    /// Sides of a cell along x and y, m.
    pub(crate) pitch: [f64; 2],
    /// Cells along x and y.
    pub(crate) counts: [usize; 2],
}

impl Lattice {
    /// Diagonal of all cells, m.
    pub(crate) fn diagonal(&self) -> f64 {
        let [a, b] = self.sides();
        a.hypot(b)
    }

    /// Sides of all cells together, m.
    pub(crate) fn sides(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.pitch[axis] * self.counts[axis] as f64)
    }

    /// Shorter side of a cell, m.
    pub(crate) fn finest(&self) -> f64 {
        self.pitch[0].min(self.pitch[1])
    }

    /// Whether cells are square, so that x and y may be exchanged.
    fn is_square(&self) -> bool {
        self.pitch[0] == self.pitch[1]
    }

    /// Number of offsets along x and y that are integrated; the smaller number first if cells are square.
    pub(crate) fn extent(&self) -> [usize; 2] {
        let [i, j] = self.counts;
        if self.is_square() { [i.min(j), i.max(j)] } else { [i, j] }
    }

    /// Offsets whose compliances give all others by symmetry: none negative, and i ≤ j if cells are square.
    pub(crate) fn classes(&self) -> Vec<[usize; 2]> {
        let [columns, rows] = self.extent();
        let square = self.is_square();
        let all = (0..columns).flat_map(|i| (0..rows).map(move |j| [i, j]));
        all.filter(|[i, j]| !square || i <= j).collect()
    }

    /// Number of the class of an offset (absolute), and whether x and y are exchanged there.
    fn class(&self, [i, j]: [usize; 2]) -> (usize, bool) {
        let [_, rows] = self.extent();
        if !self.is_square() {
            return (i * rows + j, false);
        }
        let (i, j, exchanged) = if i <= j { (i, j, false) } else { (j, i, true) };
        // Rows of j = i, i + 1, …
        (i * rows - i * (i + 1) / 2 + j, exchanged)
    }

    /// Class of an offset, and the series and factor of each pair of components.
    ///
    /// Rows: components of the receiver's displacement (down, along x, along y). Columns: components of the
    /// source's traction. The receiver is `offset` cells from the source.
    pub(crate) fn terms(&self, offset: [isize; 2]) -> (usize, [[(usize, f64); 3]; 3]) {
        let (class, exchanged) = self.class(offset.map(isize::unsigned_abs));
        let [right, away] = offset.map(|n| if n < 0 { -1.0 } else { 1.0 });
        let [xx, yy, zx, zy] = if exchanged { [2, 1, 5, 4] } else { [1, 2, 4, 5] };
        let xy = (3, right * away);
        let zx = (zx, right);
        let zy = (zy, away);
        let back = |(series, factor): (usize, f64)| (series, -factor);
        let terms = [[(0, 1.0), zx, zy], [back(zx), (xx, 1.0), xy], [back(zy), xy, (yy, 1.0)]];
        (class, terms)
    }

    /// 3 × 3 values for a receiver `offset` cells from the source, taken from the values of all classes.
    pub(crate) fn block<T>(
        &self,
        values: &[[T; SERIES_PER_OFFSET]],
        offset: [isize; 2],
    ) -> [[T; 3]; 3]
    where
        T: Copy + Mul<f64, Output = T>,
    {
        let (class, terms) = self.terms(offset);
        terms.map(|row| row.map(|(series, factor)| values[class][series] * factor))
    }
}

/// Columns and rows from a source to a receiver.
pub(crate) fn offset(receiver: [usize; 2], source: [usize; 2]) -> [isize; 2] {
    [0, 1].map(|axis| receiver[axis].cast_signed() - source[axis].cast_signed())
}

/// Column and row of each element, if all are equal cells of a lattice that is mostly filled.
pub(crate) fn lattice_cells(elements: &[ContactElement]) -> Option<Vec<[usize; 2]>> {
    let first = elements.first().filter(|own| own.directions().len() == COMPONENTS_IN_SPACE)?;
    let pitch = first.sides();
    let corner = [0, 1]
        .map(|axis| elements.iter().map(|own| own.ends()[axis][0]).fold(f64::INFINITY, f64::min));
    let most = FEW * elements.len() as f64;
    let cell = |own: &ContactElement| {
        let near = |a: f64, b: f64| (a - b).abs() <= EQUAL;
        let sides = own.sides();
        let place = [0, 1].map(|axis| (own.ends()[axis][0] - corner[axis]) / pitch[axis]);
        let fits = (0..2).all(|axis| {
            near(sides[axis] / pitch[axis], 1.0) && near(place[axis], place[axis].round())
        });
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from zero to a few times the number of elements"
        )]
        (fits && place.iter().all(|place| *place < most))
            .then(|| place.map(|place| place.round() as usize))
    };
    let cells: Vec<[usize; 2]> = elements.iter().map(cell).collect::<Option<_>>()?;
    let [columns, rows] =
        [0, 1].map(|axis| cells.iter().map(|cell| cell[axis] + 1).fold(0, usize::max));
    ((columns * rows) as f64 <= most).then_some(cells)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Complex;

    #[test]
    fn classes_are_numbered_as_listed() {
        for (pitch, counts) in
            [([1.0, 1.0], [4, 4]), ([1.0, 1.0], [5, 3]), ([1.0, 1.0], [2, 6]), ([1.0, 1.5], [4, 3])]
        {
            let lattice = Lattice { pitch, counts };
            let classes = lattice.classes();
            let mut met = vec![false; classes.len()];
            for i in 0..counts[0] {
                for j in 0..counts[1] {
                    let (class, exchanged) = lattice.class([i, j]);
                    assert_eq!(classes[class], if exchanged { [j, i] } else { [i, j] });
                    met[class] = true;
                }
            }
            assert!(met.into_iter().all(|met| met), "{counts:?}");
        }
    }

    /// Betti: exchanging receiver and source transposes the block.
    #[test]
    fn blocks_are_reciprocal() {
        let lattice = Lattice { pitch: [1.0; 2], counts: [4, 5] };
        let number = |class: usize, series: usize| Complex::new(class as f64, 1.0 + series as f64);
        let values: Vec<[Complex; SERIES_PER_OFFSET]> = (0..lattice.classes().len())
            .map(|class| std::array::from_fn(|series| number(class, series)))
            .collect();
        for offset in [[0_isize, 3], [3, 1], [-2, 4], [-3, -1]] {
            let there = lattice.block(&values, offset);
            let back = lattice.block(&values, offset.map(|n| -n));
            for (row, column) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)] {
                if offset.contains(&0) && row != column {
                    continue;
                }
                assert_eq!(there[row][column], back[column][row], "{offset:?}");
                assert_eq!(there[column][row], back[row][column], "{offset:?}");
            }
        }
    }

    #[test]
    fn elements_find_their_cells() {
        let cells = [[0, 0], [1, 0], [2, 0], [0, 1], [2, 1], [1, 3]];
        let element = |[i, j]: [usize; 2]| {
            let x = i as f64;
            let y = j as f64;
            ContactElement::in_plan(
                [1.0 + 0.3 * x, 1.3 + 0.3 * x],
                [-2.0 + 0.7 * y, -1.3 + 0.7 * y],
            )
        };
        let elements: Vec<_> = cells.iter().map(|cell| element(*cell)).collect();
        assert_eq!(lattice_cells(&elements), Some(cells.to_vec()));
        let with = |other| lattice_cells(&[&elements[..], &[other]].concat());
        // Another size, another place, far away.
        let wide = 1.9 + 0.3 * 2.0;
        let beside = 1.9 + 0.3 * 1.0;
        assert_eq!(with(ContactElement::in_plan([1.9, wide], [-2.0, -1.3])), None);
        assert_eq!(with(ContactElement::in_plan([1.95, beside + 0.05], [-2.0, -1.3])), None);
        assert_eq!(with(element([9, 9])), None);
        assert_eq!(lattice_cells(&[ContactElement::new(0.0, 1.0)]), None);
    }
}
