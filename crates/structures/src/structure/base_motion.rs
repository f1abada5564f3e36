//! Motions of a structure's base, and displacements relative to them.

use super::{Base, BaseNode, DofCombination, Structure};
use crate::error::{Result, at_least, finite, positive, require, require_part};
use crate::geometry::{middle, span};

impl DofCombination {
    /// Displacement to the right relative to the middle of the base.
    ///
    /// The translation of the base is subtracted, its rotation is not. The sum must refer to degrees of freedom of
    /// `structure`, whose base extends from its first to its last contact node. For a member of a group, call this
    /// method before [`StructureGroup::row`](super::StructureGroup::row).
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for a structure with fewer than two contact nodes,
    /// [`Error::Input`](crate::Error::Input) for contact nodes at one place, [`Error::Scene`](crate::Error::Scene) in
    /// space, where a sum does not distinguish x from y: subtract a displacement of [`DofCombination::of_base`] there.
    pub fn relative_to_base(&self, structure: &dyn Structure) -> Result<Self> {
        Ok(self.clone() - horizontal_in_the_plane(structure, 0.0)?)
    }

    /// Deformation of the structure at a point `height` (m) above the base, to the right.
    ///
    /// It is the displacement of the point less the part due to the base's rigid translation and rotation.
    ///
    /// ```
    /// use basemat::structure::{RigidBlock, DofCombination, ShearBuilding, Storey};
    ///
    /// // A rigid block does not deform.
    /// let block = RigidBlock::new(4.0, 10.0, 2000.0)?;
    /// let drift = block.horizontal_at(10.0).total_drift(&block, 10.0)?;
    /// assert!(drift.value(&[0.3, 0.1, 0.02]).abs() < 1e-15);
    ///
    /// // A roof at 6 m has moved by 0.1 m, its base by 0.02 m. The base has rotated by 0.01 to the left.
    /// let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &[Storey::new(3.0, 20.0e3, 40.0e6); 2])?;
    /// let roof = DofCombination::from(building.roof());
    /// let displacement = [0.02, 0.0, 0.01, 0.0, 0.1];
    /// assert!((roof.relative_to_base(&building)?.value(&displacement) - 0.08).abs() < 1e-15);
    /// assert!((roof.total_drift(&building, 6.0)?.value(&displacement) - 0.14).abs() < 1e-15);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for a structure with fewer than two contact nodes,
    /// [`Error::Input`](crate::Error::Input) for a height that is not finite or contact nodes at one place,
    /// [`Error::Scene`](crate::Error::Scene) in space, as for [`DofCombination::relative_to_base`].
    pub fn total_drift(&self, structure: &dyn Structure, height: f64) -> Result<Self> {
        Ok(self.clone() - horizontal_in_the_plane(structure, height)?)
    }

    /// Displacements of a point of the rigid base: along x, along y, up.
    ///
    /// `place`: `[x, y, height]` (m) from the middle of the base. A displacement less these is the displacement
    /// relative to the base. In the plane there is no displacement along y, and y is ignored.
    ///
    /// ```
    /// use basemat::structure::{DofCombination, PlanStorey, RigidBody, StoreyBuilding};
    ///
    /// let mat = RigidBody::cuboid([18.0, 12.0, 1.0], 2500.0)?;
    /// let storey = PlanStorey::new(3.2, 250.0e3, [18.0, 12.0], [4.0e8, 3.0e8, 2.0e10]);
    /// let tower = StoreyBuilding::new(mat, &[storey; 5])?;
    /// // Along y: a corner of the roof relative to the mat, and the deformation of the storeys there.
    /// let [_, corner, _] = tower.floor(4, [9.0, 6.0])?;
    /// let [_, base, _] = DofCombination::of_base(&tower, [0.0; 3])?;
    /// let [_, rigid_corner, _] = DofCombination::of_base(&tower, [9.0, 6.0, 16.0])?;
    /// let tilt = [0.0, 0.0, 0.0, 0.01, 0.0, 0.0];
    /// assert!(((corner.clone() - base).value(&tilt)).abs() < 1e-15);
    /// assert!(((corner - rigid_corner).value(&tilt) - 0.16).abs() < 1e-15);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for a structure with fewer than two contact nodes, or three corners in
    /// space; [`Error::Input`](crate::Error::Input) for a place that is not finite, or contact nodes at one place or
    /// in space on one line.
    pub fn of_base(structure: &dyn Structure, place: [f64; 3]) -> Result<[Self; 3]> {
        let [x, y, height] = place;
        finite("height above the base", height)?;
        finite("place from the middle of the base", x)?;
        finite("place from the middle of the base", y)?;
        let base = structure.base();
        if matches!(base, Base::Lines(_)) {
            let [translation, rotation, vertical] = base_motion(&base.into_nodes())?;
            let up = if x == 0.0 { vertical } else { vertical + x * rotation.clone() };
            return Ok([translation - height * rotation, Self::default(), up]);
        }
        base.check(structure.dofs())?;
        let nodes = base.into_nodes();
        let center = [0, 1].map(|axis| middle(span(nodes.iter().map(|node| node.place()[axis]))));
        let displacements =
            BaseNode::rigid_displacements(&nodes, [center[0] + x, center[1] + y], height);
        for &(_, weight) in displacements.iter().flatten() {
            let needed = "corners that are not on one line";
            require("rotation of the base", weight, weight.is_finite(), needed)?;
        }
        Ok(displacements)
    }
}

/// Displacement to the right of a point `height` above the middle of a rigid base in the plane.
fn horizontal_in_the_plane(structure: &dyn Structure, height: f64) -> Result<DofCombination> {
    let needed = "in space a sum does not distinguish x from y: subtract a displacement of `DofCombination::of_base`";
    require_part(
        "displacement relative to the base",
        matches!(structure.base(), Base::Lines(_)),
        needed,
    )?;
    let [horizontal, ..] = DofCombination::of_base(structure, [0.0, 0.0, height])?;
    Ok(horizontal)
}

/// Motion of a base in the plane: its middle to the right, rotation, and its middle upwards.
///
/// The line between its ends determines the rotation. Nodes of walls do not count.
fn base_motion(nodes: &[BaseNode]) -> Result<[DofCombination; 3]> {
    at_least("contact nodes", nodes.len(), 2)?;
    let floor_nodes = BaseNode::floor(nodes);
    let left_end = &floor_nodes[0];
    let right_end = &floor_nodes[floor_nodes.len() - 1];
    let inverse_width = 1.0 / positive("width of the base", right_end.x - left_end.x)?;
    let translation = 0.5 * left_end.horizontal.clone() + 0.5 * right_end.horizontal.clone();
    let rotation = inverse_width * (right_end.vertical.clone() - left_end.vertical.clone());
    let vertical = 0.5 * left_end.vertical.clone() + 0.5 * right_end.vertical.clone();
    Ok([translation, rotation, vertical])
}
