//! Embedded finite-element models.

use super::feet::Foot;
use super::soil_at_rest;
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
    /// for a node without horizontal and vertical degrees of freedom. [`Error::Part`](crate::Error::Part) for
    /// [soil at rest](Mesh::with_stress_at_rest) with a side that touches neither the outline, nor the surface, nor other
    /// soil at rest, and for nodes of the outline that do not belong to the soil at rest.
    pub fn in_trench(mesh: Mesh, outline: &[usize]) -> Result<Self> {
        let feet = vec![outline_feet(&mesh, outline)?];
        soil_at_rest::check(&mesh, &feet)?;
        Self::on_feet(mesh, feet)
    }
}

impl FemModel {
    /// Structure on [soil at rest](Mesh::with_stress_at_rest) that fills a trench.
    ///
    /// The leftmost, lowest and rightmost nodes of the soil at rest are the outline of the trench. As for
    /// [`in_trench`](FemModel::in_trench), y = 0 is the surface.
    ///
    /// ```
    /// use basemat::fem::{Material, Mesh, StressAtRest};
    /// use basemat::structure::{FemModel, Structure};
    ///
    /// let soil = Material::new(80.0e6, 0.3, 1900.0)?;
    /// let mesh = Mesh::quad8_block(&[-4.0, 0.0, 4.0], &[-3.0, 0.0], |_, _| soil)?
    ///     .with_stress_at_rest(&StressAtRest::new(9.81, 1900.0, 0.5)?)?;
    /// let model = FemModel::on_soil_at_rest(mesh)?;
    /// let places: Vec<_> = model.base().nodes().map(|node| [node.x, node.z]).collect();
    /// assert_eq!(places[..4], [[-4.0, 0.0], [-4.0, -1.5], [-4.0, -3.0], [-2.0, -3.0]]);
    /// // The mass of all soil weighs nothing.
    /// let masses = model.mass_at_rest()?.expect("soil at rest");
    /// assert!((masses.iter().sum::<f64>() - 1900.0 * 24.0).abs() < 1e-9);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) without soil at rest, and as for [`in_trench`](FemModel::in_trench).
    pub fn on_soil_at_rest(mesh: Mesh) -> Result<Self> {
        let outline = soil_at_rest::outline(&mesh);
        at_least("nodes of soil at rest", outline.len(), 2)?;
        Self::in_trench(mesh, &outline)
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
