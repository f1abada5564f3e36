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
    /// ground is a `TrenchGround` of this width and depth. The outline reaches
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
    let mut feet = Vec::with_capacity(outline.len());
    for &node in outline {
        let place = mesh.nodes()[in_bounds("contact node", node, mesh.nodes().len())?];
        feet.push(Foot { node, depth: 0.0, height: place[1] });
    }
    let faces: Option<Vec<usize>> =
        outline.windows(2).map(|ends| face_number(mesh, ends[0], ends[1])).collect();
    let in_order = faces.is_some_and(|faces| faces.is_sorted());
    let needed = "nodes down a vertical left wall, along a level base to the right, and up a vertical right wall";
    require_part("outline in a trench", in_order, needed)?;
    Ok(feet)
}

/// Face between two nodes: 0 down the left wall, 1 along the base, 2 up the right wall.
fn face_number(mesh: &Mesh, from: usize, to: usize) -> Option<usize> {
    let way = [0, 1].map(|axis| {
        let distance = mesh.nodes()[to][axis] - mesh.nodes()[from][axis];
        if distance.abs() > mesh.tolerance() { distance } else { 0.0 }
    });
    if way[0] == 0.0 && way[1] < 0.0 {
        Some(0)
    } else if way[0] > 0.0 && way[1] == 0.0 {
        Some(1)
    } else if way[0] == 0.0 && way[1] > 0.0 {
        Some(2)
    } else {
        None
    }
}
