//! Finite-element models with rigid links, diaphragms and ties.

use super::rigid_links::{RigidLinkKind, RigidLinks};
use crate::error::Result;
use crate::structure::FemModel;

impl FemModel {
    /// Connects the nodes `followers` with `leader` so that they move as one rigid body.
    ///
    /// Uses are stiff joints, offsets of beams, a rigid slab or basemat. Followers lose their degrees of freedom, and
    /// the remaining ones are renumbered, node by node: for a follower [`dof`](FemModel::dof) returns `None` and
    /// [`row`](FemModel::row) its motion as a sum of the leader's degrees of freedom. Masses and stiffnesses still act
    /// at the followers. Contact nodes may be followers. The static forces of [`with_p_delta`](FemModel::with_p_delta)
    /// are computed again.
    ///
    /// ```
    /// use basemat::fem::{Beam, Direction, Mesh};
    /// use basemat::structure::{FemModel, Structure};
    ///
    /// // A column on the middle of a rigid basemat 4 m wide.
    /// let mut mesh = Mesh::new();
    /// let [left, foot, right] =
    ///     [mesh.add_node(-2.0, 0.0)?, mesh.add_node(0.0, 0.0)?, mesh.add_node(2.0, 0.0)?];
    /// let top = mesh.add_node(0.0, 6.0)?;
    /// for ends in [[left, foot], [foot, right], [foot, top]] {
    ///     mesh.add(Beam::new(ends, 30.0e9, 0.5, 0.01, 2400.0)?)?;
    /// }
    /// let model = FemModel::on_base(mesh)?.with_rigid_link(foot, &[left, right])?;
    /// assert_eq!(model.dofs(), 6);
    /// assert_eq!(model.dof(top, Direction::X), Some(3));
    /// // The right end rises with the foot and by 2 m times its rotation.
    /// assert_eq!(model.row(right, Direction::Y)?[..], [(1, 1.0), (2, 2.0)]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a node that does not exist; [`Error::Scene`](crate::Error::Scene) when
    /// the leader does not have all degrees of freedom of a node or follows another node, or when a follower is already
    /// a leader or a follower. After [`with_p_delta`](FemModel::with_p_delta) also its errors.
    pub fn with_rigid_link(self, leader: usize, followers: &[usize]) -> Result<Self> {
        self.with_link(RigidLinkKind::Body, leader, followers)
    }

    /// Ties the nodes `followers` to `leader` in a horizontal plane.
    ///
    /// An example is a floor that is rigid in its plane.
    ///
    /// The displacements along x and y and the rotation about z follow the leader; the displacement along z and the
    /// other two rotations remain free. All nodes lie at one height, so that the diaphragm resists no rigid motion.
    ///
    /// # Errors
    /// As for [`FemModel::with_rigid_link`], except that the leader needs three degrees of freedom only;
    /// [`Error::Scene`](crate::Error::Scene) for a mesh in the plane or for nodes at different heights.
    pub fn with_rigid_diaphragm(self, leader: usize, followers: &[usize]) -> Result<Self> {
        self.mesh.require_space("rigid diaphragm")?;
        self.with_link(RigidLinkKind::Diaphragm, leader, followers)
    }

    /// Gives the nodes `followers` the displacements of `leader`; their rotations remain free.
    ///
    /// Both sides of a soil column are tied at each height, so that it deforms as a soil of infinite width in
    /// vertically propagating waves. A tie resists the rotation of the structure as a whole, as the soil beside the
    /// column does.
    ///
    /// ```
    /// use basemat::fem::{Direction, Layer, Material, Mesh};
    /// use basemat::structure::{FemModel, Structure};
    ///
    /// // A soil column 1 m wide and 20 m high; node 2 k is on its left side, node 2 k + 1 on its right side.
    /// let soil = Material::new(120.0e6, 0.3, 1900.0)?;
    /// let mesh = Mesh::layered_block(0.0..1.0, 1, &[Layer::new(20.0, 20, soil)])?;
    /// let mut column = FemModel::on_base(mesh)?;
    /// for row in 1..=20 {
    ///     column = column.with_tied_nodes(2 * row, &[2 * row + 1])?;
    /// }
    /// assert_eq!(column.dofs(), 4 + 2 * 20);
    /// assert_eq!(column.row(41, Direction::X)?, column.row(40, Direction::X)?);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`FemModel::with_rigid_link`], except that the leader needs displacements only;
    /// [`Error::Scene`](crate::Error::Scene) also for nodes at different heights.
    pub fn with_tied_nodes(self, leader: usize, followers: &[usize]) -> Result<Self> {
        self.with_link(RigidLinkKind::Tie, leader, followers)
    }

    /// Adds a rigid link of one kind.
    fn with_link(
        mut self,
        kind: RigidLinkKind,
        leader: usize,
        followers: &[usize],
    ) -> Result<Self> {
        let existing_links = self.links.take();
        let mut links =
            existing_links.unwrap_or_else(|| RigidLinks::new(&self.mesh, &self.numbering));
        links.link(&self.mesh, &self.numbering, kind, leader, followers)?;
        self.with_links(links)
    }
}
