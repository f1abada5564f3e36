//! Released ends of a beam in space.

use super::axes::EndsMatrix;
use crate::error::{Result, in_bounds, require_part};
use crate::geometry::{Direction, SPACE_DIRECTIONS};

/// Local degrees of freedom of a beam whose end forces are zero, such as hinges.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Releases([bool; 12]);

impl Releases {
    /// These releases and `directions` at an `end`; an error if they leave a mechanism.
    pub(super) fn and(mut self, end: usize, directions: &[Direction]) -> Result<Self> {
        in_bounds("released end of the beam", end, 2)?;
        for &direction in directions {
            let place = SPACE_DIRECTIONS.iter().position(|&candidate| candidate == direction);
            let needed = "x, y, z, and rotations about x, y, z, in the axes of the beam";
            require_part("released direction of the beam", place.is_some(), needed)?;
            self.0[6 * end + place.unwrap_or_default()] = true;
        }
        let quantity = "releases of the beam";
        let at_both_ends = |place: usize| self.0[place] && self.0[place + 6];
        let slides = at_both_ends(0);
        require_part(quantity, !slides, "not both ends along x: the beam would slide off")?;
        let spins = at_both_ends(3);
        require_part(quantity, !spins, "not both ends about x: the beam would spin")?;
        for [side, turn] in [[1, 5], [2, 4]] {
            let released = [side, turn, side + 6, turn + 6].into_iter().filter(|&k| self.0[k]);
            let is_stable = released.count() < 3 && !at_both_ends(side);
            let needed = "at most two of the displacements along and rotations across one axis of \
                          the section, not both displacements: the beam would be a mechanism";
            require_part(quantity, is_stable, needed)?;
        }
        Ok(self)
    }

    /// Sets the released rows and columns of a local matrix to zero.
    pub(super) fn clear(&self, matrix: &mut EndsMatrix) {
        for (i, row) in matrix.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                if self.0[i] || self.0[j] {
                    *entry = 0.0;
                }
            }
        }
    }

    /// Expresses the released displacements in `to_local` by the others, such that their forces vanish.
    ///
    /// `stiffness`: local stiffness without releases.
    pub(super) fn apply(&self, mut stiffness: EndsMatrix, to_local: &mut EndsMatrix) {
        let released: Vec<usize> = (0..12).filter(|&place| self.0[place]).collect();
        let mut rows = Vec::with_capacity(released.len());
        for &place in &released {
            let pivot = stiffness[place][place];
            let mut row = stiffness[place].map(|k| -k / pivot);
            row[place] = 0.0;
            for i in 0..12 {
                let factor = stiffness[i][place];
                for j in 0..12 {
                    stiffness[i][j] += factor * row[j];
                }
            }
            for k in 0..12 {
                stiffness[k][place] = 0.0;
                stiffness[place][k] = 0.0;
            }
            rows.push((place, row));
        }
        // Earlier rows may refer to displacements that were released later.
        for (place, row) in rows.into_iter().rev() {
            to_local[place] = std::array::from_fn(|j| {
                row.iter().zip(to_local.iter()).map(|(factor, other)| factor * other[j]).sum()
            });
        }
    }
}
