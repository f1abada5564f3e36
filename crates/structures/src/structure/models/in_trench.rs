//! Embedded finite-element models.

use super::feet::Foot;
use crate::error::{Result, at_least, in_bounds, require_part};
use crate::fem::Mesh;
use crate::structure::FemModel;

impl FemModel {
    /// Structure in a trench, in contact with the soil at the nodes of its `outline`.
    ///
    /// The nodes are listed down the left wall, along the base to the right and up the right wall; each corner is
    /// listed once. y = 0 of the mesh is the surface: the base of a trench 5 m deep has y = −5. Walls and base bend
    /// with the elements at their nodes; [`with_rigid_link`](FemModel::with_rigid_link) makes them rigid. The ground is
    /// a `TrenchGround` of this width and depth. The outline must extend to the surface: if the roof is deeper, solids
    /// must fill the trench above it.
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
    /// for a node without horizontal and vertical degrees of freedom.
    pub fn in_trench(mesh: Mesh, outline: &[usize]) -> Result<Self> {
        let feet = outline_feet(&mesh, outline)?;
        Self::on_feet(mesh, vec![feet])
    }
}

/// Feet at the nodes of an outline.
fn outline_feet(mesh: &Mesh, outline: &[usize]) -> Result<Vec<Foot>> {
    mesh.require_plane("outline in a trench")?;
    at_least("contact nodes", outline.len(), 2)?;
    let mut feet = Vec::with_capacity(outline.len());
    for &node in outline {
        let coordinates = mesh.nodes()[in_bounds("contact node", node, mesh.nodes().len())?];
        feet.push(Foot { node, depth: 0.0, height: coordinates[1] });
    }
    let face_numbers: Option<Vec<usize>> =
        outline.windows(2).map(|ends| face_number(mesh, ends[0], ends[1])).collect();
    let is_in_order = face_numbers.is_some_and(|face_numbers| face_numbers.is_sorted());
    let needed = "nodes down a vertical left wall, along a level base to the right, and up a vertical right wall";
    require_part("outline in a trench", is_in_order, needed)?;
    Ok(feet)
}

/// Face between two nodes: 0 down the left wall, 1 along the base, 2 up the right wall.
fn face_number(mesh: &Mesh, start: usize, end: usize) -> Option<usize> {
    let edge = [0, 1].map(|axis| {
        let distance = mesh.nodes()[end][axis] - mesh.nodes()[start][axis];
        if distance.abs() > mesh.height_tolerance() { distance } else { 0.0 }
    });
    if edge[0] == 0.0 && edge[1] < 0.0 {
        Some(0)
    } else if edge[0] > 0.0 && edge[1] == 0.0 {
        Some(1)
    } else if edge[0] == 0.0 && edge[1] > 0.0 {
        Some(2)
    } else {
        None
    }
}
