//! Rigid motions of a finite-element model.

use crate::fem::Direction;
use crate::structure::{FemModel, Structure};

impl FemModel {
    /// Values of all degrees of freedom in a unit rigid motion.
    ///
    /// The motion is a displacement of 1 m, or a small rotation by 1 rad about `point` (z is zero in the plane). All
    /// values are zero for a direction that the mesh does not have.
    pub fn rigid_motion(&self, direction: Direction, point: [f64; 3]) -> Vec<f64> {
        let mut motion = vec![0.0; self.dofs()];
        self.fill_rigid_motion(direction, point, &mut motion, |node, axis| self.dof(node, axis));
        motion
    }

    /// Overwrites `motion` by a rigid motion of the mesh, for degrees of freedom numbered by `dof_of`.
    pub(super) fn fill_rigid_motion(
        &self,
        direction: Direction,
        point: [f64; 3],
        motion: &mut [f64],
        dof_of: impl Fn(usize, Direction) -> Option<usize>,
    ) {
        if !self.mesh.directions().contains(&direction) {
            return;
        }
        for (node, coordinates) in self.mesh.nodes().iter().enumerate() {
            let arm = [0, 1, 2].map(|axis| coordinates[axis] - point[axis]);
            for &component in self.mesh.directions() {
                if let Some(dof) = dof_of(node, component) {
                    motion[dof] = component.in_rigid_motion(direction, arm);
                }
            }
        }
    }
}
