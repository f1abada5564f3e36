//! Resultants of the storeys of a building in plan.

use super::space_section::SpaceSection;
use super::storey_building::StoreyBuilding;
use crate::error::{Result, finite, in_bounds};
use crate::structure::{DofCombination, SectionRows};

impl StoreyBuilding {
    /// Forces along x and y (N) of the floor on `storey`, and their torque.
    ///
    /// They act on the part below: for storey 0, on the mat. The torque (N m) is about the centre of stiffness.
    /// They are computed from the inertia of the floors above, which is exact for any law; with the midpoint rule
    /// they are the mean over the step. [`section`](StoreyBuilding::section) has all six resultants.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) when there is no such storey.
    pub fn shear(&self, storey: usize) -> Result<[SectionRows; 3]> {
        let center = self.storeys.get(storey).map_or([0.0; 2], |storey| storey.stiffness_center);
        let SpaceSection { shear: [along, across], torque, .. } = self.section(storey, center)?;
        Ok([along, across, torque])
    }

    /// Six resultants of the floors above on the part below the foot of `storey` (0: the lowest, on the mat).
    ///
    /// Moments are about the point `reference` (m from the middle of the mat's base) at the foot of the storey, whose
    /// height is above the mat's base. Like [`shear`](StoreyBuilding::shear) they are computed from the inertia of the
    /// floors above. To include the weight, add the acceleration of gravity to the vertical accelerations.
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
        for place in reference {
            finite("reference point of the section", place)?;
        }
        // Forces along x, y and z, and moments about these axes.
        let mut sums: [DofCombination; 6] = Default::default();
        let mut height = 0.0;
        for (index, floor) in self.storeys.iter().enumerate().skip(storey) {
            height += floor.height;
            let x = floor.mass_center[0] - reference[0];
            let y = floor.mass_center[1] - reference[1];
            let [along, across, up, about_x, about_y, twist] = self.floor_motion(index);
            sums[3] -= floor.mass * (y * up.clone() - height * across.clone());
            sums[3] -= floor.inertia[0] * about_x;
            sums[4] -= floor.mass * (height * along.clone() - x * up.clone());
            sums[4] -= floor.inertia[1] * about_y;
            sums[5] -= floor.mass * (x * across.clone() - y * along.clone());
            sums[5] -= floor.inertia[2] * twist;
            for (sum, row) in sums.iter_mut().zip([along, across, up]) {
                *sum -= floor.mass * row;
            }
        }
        let [along, across, up, about_x, about_y, about_z] = sums;
        Ok(SpaceSection {
            height: self.storeys[..storey].iter().map(|storey| storey.height).sum(),
            shear: [along, across].map(|row| inertia_rows("N", row)),
            compression: inertia_rows("N", -up),
            moments: [about_x, about_y].map(|row| inertia_rows("N·m", row)),
            torque: inertia_rows("N·m", about_z),
        })
    }
}

/// A resultant of inertia alone, by accelerations.
fn inertia_rows(unit: &'static str, acceleration: DofCombination) -> SectionRows {
    SectionRows { unit, acceleration, ..SectionRows::default() }
}
