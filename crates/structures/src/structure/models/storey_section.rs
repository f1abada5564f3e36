//! Resultants of the storeys of a building in space.

use super::section::SpaceSection;
use super::storey_building::StoreyBuilding;
use crate::error::{Result, finite, in_bounds};
use crate::structure::{DofCombination, SectionRows};

impl StoreyBuilding {
    /// Forces along x and y (N) of the floor on `storey`, and their torque.
    ///
    /// They act on the part below: for storey 0, on the mat. The torque (N m) is about the centre of stiffness. The
    /// resultants are computed from the inertia of the floors above, which is exact for any law; with the midpoint rule
    /// they are the mean over the step. [`section`](StoreyBuilding::section) has all six resultants.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey.
    pub fn shear(&self, storey: usize) -> Result<[SectionRows; 3]> {
        let center = self.storeys.get(storey).map_or([0.0; 2], |storey| storey.stiffness_center);
        let SpaceSection { shear: [x_force, y_force], torque, .. } =
            self.section(storey, center)?;
        Ok([x_force, y_force, torque])
    }

    /// Six resultants of the floors above on the part below the foot of `storey`.
    ///
    /// Storey 0 is the lowest, on the mat.
    ///
    /// Moments are about the point `reference` (m from the middle of the mat's base) at the foot of the storey. The
    /// height of the section is that above the mat's base. As in [`shear`](StoreyBuilding::shear), the resultants are
    /// computed from the inertia of the floors above. To include the weight, add the acceleration of gravity to the
    /// vertical accelerations.
    ///
    /// ```
    /// use basemat::structure::{PlanStorey, RigidBody, StoreyBuilding};
    ///
    /// let mat = RigidBody::cuboid([18.0, 12.0, 1.0], 2500.0)?;
    /// let storey = PlanStorey::new(3.0, 250.0e3, [18.0, 12.0], [4.0e8, 3.0e8, 2.0e10]);
    /// let building = StoreyBuilding::new(mat, &[storey; 2])?;
    /// let foot = building.section(0, [0.0, 0.0])?;
    /// // Both floors accelerate to the right: 3 m and 6 m above the foot.
    /// let mut acceleration = [0.0; 12];
    /// (acceleration[6], acceleration[9]) = (1.0, 1.0);
    /// assert_eq!(foot.shear[0].value(&[], &[], &acceleration), -500.0e3);
    /// assert_eq!(foot.moments[1].value(&[], &[], &acceleration), -250.0e3 * (3.0 + 6.0));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey, [`Error::Input`](crate::Error::Input) for a
    /// reference that is not finite.
    pub fn section(&self, storey: usize, reference: [f64; 2]) -> Result<SpaceSection> {
        in_bounds("storey", storey, self.storeys.len())?;
        for coordinate in reference {
            finite("reference point of the section", coordinate)?;
        }
        // Forces along x, y and z, and moments about these axes.
        let mut resultants: [DofCombination; 6] = Default::default();
        let mut floor_height = 0.0;
        for (floor_index, floor) in self.storeys.iter().enumerate().skip(storey) {
            floor_height += floor.height;
            let x = floor.mass_center[0] - reference[0];
            let y = floor.mass_center[1] - reference[1];
            let [x_row, y_row, vertical_row, x_rotation, y_rotation, z_rotation] =
                self.floor_motion(floor_index);
            resultants[3] -= floor.mass * (y * vertical_row.clone() - floor_height * y_row.clone());
            resultants[3] -= floor.inertia[0] * x_rotation;
            resultants[4] -= floor.mass * (floor_height * x_row.clone() - x * vertical_row.clone());
            resultants[4] -= floor.inertia[1] * y_rotation;
            resultants[5] -= floor.mass * (x * y_row.clone() - y * x_row.clone());
            resultants[5] -= floor.inertia[2] * z_rotation;
            for (resultant, row) in resultants.iter_mut().zip([x_row, y_row, vertical_row]) {
                *resultant -= floor.mass * row;
            }
        }
        let [x_force, y_force, z_force, x_moment, y_moment, torque] = resultants;
        Ok(SpaceSection {
            height: self.storeys[..storey].iter().map(|storey| storey.height).sum(),
            shear: [x_force, y_force].map(|row| inertia_rows("N", row)),
            compression: inertia_rows("N", -z_force),
            moments: [x_moment, y_moment].map(|row| inertia_rows("N·m", row)),
            torque: inertia_rows("N·m", torque),
        })
    }
}

/// Rows of a resultant that consists of inertia alone.
fn inertia_rows(unit: &'static str, acceleration: DofCombination) -> SectionRows {
    SectionRows { unit, acceleration, ..SectionRows::default() }
}
