//! Released ends of a beam in space.

use super::axes::EndsMatrix;
use crate::error::{Result, in_bounds, require_part};
use crate::geometry::{Direction, SPACE_DIRECTIONS};

/// Local degrees of freedom of a beam whose end forces are zero, such as hinges.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Releases([bool; 12]);

impl Releases {
    /// Adds releases in `directions` at an `end`; returns an error for a mechanism.
    pub(super) fn with_end_releases(
        mut self,
        end: usize,
        directions: &[Direction],
    ) -> Result<Self> {
        in_bounds("released end of the beam", end, 2)?;
        for &direction in directions {
            let index = SPACE_DIRECTIONS.iter().position(|&candidate| candidate == direction);
            let needed = "x, y, z, and rotations about x, y, z, in the axes of the beam";
            require_part("released direction of the beam", index.is_some(), needed)?;
            self.0[6 * end + index.unwrap_or_default()] = true;
        }
        let quantity = "releases of the beam";
        let at_both_ends = |dof: usize| self.0[dof] && self.0[dof + 6];
        let can_slide = at_both_ends(0);
        require_part(quantity, !can_slide, "not both ends along x: the beam would slide off")?;
        let can_spin = at_both_ends(3);
        require_part(quantity, !can_spin, "not both ends about x: the beam would spin")?;
        // Deflection and rotation of bending along y and along z.
        for [deflection, rotation] in [[1, 5], [2, 4]] {
            let bending_dofs = [deflection, rotation, deflection + 6, rotation + 6];
            let release_count = bending_dofs.into_iter().filter(|&dof| self.0[dof]).count();
            let is_stable = release_count < 3 && !at_both_ends(deflection);
            let needed = "at most two of the four displacements and rotations of bending along one axis, not both \
                          displacements: the beam would be a mechanism";
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

    /// Expresses released end displacements by the others, such that their forces vanish.
    ///
    /// `to_local`: transformation to local end displacements, which is changed. `stiffness`: local stiffness without
    /// releases.
    pub(super) fn apply(&self, mut stiffness: EndsMatrix, to_local: &mut EndsMatrix) {
        let released_dofs: Vec<usize> = (0..12).filter(|&dof| self.0[dof]).collect();
        let mut release_rows = Vec::with_capacity(released_dofs.len());
        for &dof in &released_dofs {
            let pivot = stiffness[dof][dof];
            let mut row = stiffness[dof].map(|k| -k / pivot);
            row[dof] = 0.0;
            for i in 0..12 {
                let factor = stiffness[i][dof];
                for j in 0..12 {
                    stiffness[i][j] += factor * row[j];
                }
            }
            for k in 0..12 {
                stiffness[k][dof] = 0.0;
                stiffness[dof][k] = 0.0;
            }
            release_rows.push((dof, row));
        }
        // A row may contain displacements whose rows come later in the list.
        for (dof, row) in release_rows.into_iter().rev() {
            to_local[dof] = std::array::from_fn(|j| {
                row.iter()
                    .zip(to_local.iter())
                    .map(|(factor, displacement_row)| factor * displacement_row[j])
                    .sum()
            });
        }
    }
}
