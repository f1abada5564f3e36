//! Finite-element models with walls in the ground.

use super::feet::Foot;
use crate::error::{Result, at_least, in_bounds, require_part};
use crate::fem::Mesh;
use crate::structure::FemModel;

impl FemModel {
    /// Structure in a trench that touches the soil with the nodes of its `outline`.
    ///
    /// The nodes are listed down the left wall, along the base to the right and up the right wall, corners once. y of
    /// the mesh counts from the surface: the base of a trench 5 m deep has y = −5. Walls and base bend like the
    /// elements at their nodes; [`with_rigid_link`](FemModel::with_rigid_link) makes some or all of them rigid. The
    /// ground is a [`TrenchGround`](crate::bem::embedded::TrenchGround) of this width and depth. The outline reaches
    /// the surface: solids fill the trench above a roof that lies deeper.
    ///
    /// ```
    /// use basemat::fem::{Beam, Mesh};
    /// use basemat::structure::{FemModel, Structure};
    ///
    /// // A box of slab, walls and roof, 8 m wide and 5 m deep.
    /// let mut mesh = Mesh::new();
    /// let outline = [[-4.0, 0.0], [-4.0, -5.0], [4.0, -5.0], [4.0, 0.0]];
    /// let outline = outline.map(|[x, y]| mesh.add_node(x, y).unwrap());
    /// for k in 0..4 {
    ///     mesh.add(Beam::new([outline[k], outline[(k + 1) % 4]], 30.0e9, 0.5, 0.01, 2400.0)?)?;
    /// }
    /// let model = FemModel::in_trench(mesh, &outline)?;
    /// let heights: Vec<f64> = model.base().nodes().map(|node| node.z).collect();
    /// assert_eq!(heights, [0.0, -5.0, -5.0, 0.0]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for fewer than two nodes, [`Error::Index`](crate::Error::Index) for a node
    /// that does not exist, [`Error::Scene`](crate::Error::Scene) for a mesh in space, for nodes in another order, or
    /// when no element displaces one of them.
    pub fn in_trench(mesh: Mesh, outline: &[usize]) -> Result<Self> {
        let feet = feet(&mesh, outline)?;
        Self::standing(mesh, vec![feet])
    }
}

/// Feet at the nodes of an outline.
fn feet(mesh: &Mesh, outline: &[usize]) -> Result<Vec<Foot>> {
    require_part("outline in a trench", !mesh.has_depth(), "nodes of a mesh in the plane")?;
    at_least("contact nodes", outline.len(), 2)?;
    let foot = |&node: &usize| {
        let [_, height, _] = mesh.nodes()[in_bounds("contact node", node, mesh.nodes().len())?];
        Ok(Foot { node, depth: 0.0, height })
    };
    let feet = outline.iter().map(foot).collect::<Result<Vec<_>>>()?;
    // Number of the face from one node to the next.
    let face = |ends: &[Foot]| {
        let [from, to] = [0, 1].map(|k| mesh.nodes()[ends[k].node]);
        let way = [0, 1].map(|axis| to[axis] - from[axis]);
        let [along, up] = way.map(|part| if part.abs() > mesh.tolerance() { part } else { 0.0 });
        [along == 0.0 && up < 0.0, along > 0.0 && up == 0.0, along == 0.0 && up > 0.0]
            .into_iter()
            .position(|leads| leads)
    };
    let faces: Option<Vec<usize>> = feet.windows(2).map(face).collect();
    let in_order = faces.is_some_and(|faces| faces.is_sorted());
    let needed = "nodes down a vertical left wall, along a level base to the right, and up a vertical right wall";
    require_part("outline in a trench", in_order, needed)?;
    Ok(feet)
}
