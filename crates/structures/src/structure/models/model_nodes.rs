//! Nodes of a finite-element model as contact nodes, for joints.

use crate::error::{Error, Result, in_bounds, require_part};
use crate::fem::Direction;
use crate::structure::{BaseNode, FemModel};

impl FemModel {
    /// Nodes of the mesh as contact nodes, for a joint with another structure or part.
    ///
    /// Heights refer to the base, which has z = 0 unless the structure is in a trench.
    ///
    /// ```
    /// use basemat::fem::{Layer, Material, Mesh};
    /// use basemat::structure::FemModel;
    ///
    /// let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
    /// let model = FemModel::on_base(Mesh::layered_block(-5.0..5.0, 2, &[Layer::new(20.0, 4, concrete)])?)?;
    /// let top = [-5.0, 0.0, 5.0].map(|x| model.mesh().node_at(x, 20.0));
    /// let top = model.contact_nodes(&top.into_iter().collect::<Result<Vec<_>, _>>()?)?;
    /// assert_eq!([top[2].x, top[2].z], [5.0, 20.0]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`] for a node that does not exist; [`Error::Scene`] for a mesh in space, or a node without
    /// horizontal and vertical degrees of freedom.
    pub fn contact_nodes(&self, nodes: &[usize]) -> Result<Vec<BaseNode>> {
        require_part(
            "line of contact nodes",
            !self.mesh.has_depth(),
            "must be in a mesh in the plane, but this one is in space",
        )?;
        let surface_height = self.surface_height();
        let mut contact_nodes = Vec::with_capacity(nodes.len());
        for &node in nodes {
            let coordinates =
                self.mesh.nodes()[in_bounds("contact node", node, self.mesh.nodes().len())?];
            let row = |direction| {
                self.row(node, direction).map_err(|_| Error::Scene {
                    quantity: "contact node",
                    needed: "must have horizontal and vertical degrees of freedom from some element",
                })
            };
            contact_nodes.push(BaseNode {
                x: coordinates[0],
                z: coordinates[1] - surface_height,
                horizontal: row(Direction::X)?,
                vertical: row(Direction::Y)?,
                ..BaseNode::default()
            });
        }
        Ok(contact_nodes)
    }
}
