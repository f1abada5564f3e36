//! Merging of coincident nodes of a mesh.

use super::coincident::first_coincident_points;
use super::element::Element;
use super::mesh::Mesh;
use crate::error::{Error, Result};

/// Result of [`Mesh::merge_nodes`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MergedNodes {
    /// Number of removed nodes.
    pub count: usize,
    /// Index in the merged mesh of each node of the original mesh.
    ///
    /// It converts lists of nodes from before the merging, such as the nodes of a base.
    pub indices: Vec<usize>,
}

impl Mesh {
    /// Merges coincident nodes, so that their elements act on each other.
    ///
    /// `tolerance`: largest distance of merged nodes, m.
    ///
    /// Merged nodes get the coordinates of the first of them. Nodes are renumbered in their order; elements keep their
    /// indices. A tolerance of a thousandth of the smallest distance of distinct nodes is far above rounding. The mesh
    /// does not change if there is an error. Where triangles meet quadrilaterals at merged nodes, call
    /// [`Shell::match_sides`](super::Shell::match_sides) with the merged indices before adding the shells, or merge
    /// the nodes of the file (`GmshSpaceMesh::merge_nodes`, with `io`).
    ///
    /// ```
    /// use basemat::fem::{Beam, Mesh};
    ///
    /// // Two beams that share no node.
    /// let mut mesh = Mesh::new();
    /// for [from, to] in [[0.0, 3.0], [3.0, 6.0]] {
    ///     let ends = [mesh.add_node(from, 0.0)?, mesh.add_node(to, 0.0)?];
    ///     mesh.add(Beam::new(ends, 30.0e9, 0.4, 0.01, 2400.0)?)?;
    /// }
    /// let merged = mesh.merge_nodes(1e-3)?;
    /// assert_eq!((merged.count, merged.indices), (1, vec![0, 1, 1, 2]));
    /// assert_eq!(mesh.elements().nth(1).map(|beam| beam.nodes().to_vec()), Some(vec![1, 2]));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] unless the tolerance is finite and not negative. [`Error::Part`] for a chain of nodes, of which
    /// neighbours are within the tolerance but the ends are not; for an element that two merged nodes would make
    /// degenerate; and for one that cannot be renumbered ([`Element::with_nodes`]). [`Error::Item`] with an element
    /// that would be a duplicate of another one ([`Mesh::add`]).
    pub fn merge_nodes(&mut self, tolerance: f64) -> Result<MergedNodes> {
        let first_nodes = first_coincident_points(self.nodes(), tolerance)?;
        let mut merged_mesh = self.empty_mesh();
        let mut new_indices: Vec<usize> = Vec::with_capacity(first_nodes.len());
        for (node, &first_node) in first_nodes.iter().enumerate() {
            let new_index = if first_node == node {
                merged_mesh.add_node_at(self.nodes()[node])?
            } else {
                new_indices[first_node]
            };
            new_indices.push(new_index);
        }
        let removed_count = self.nodes().len() - merged_mesh.nodes().len();
        for (index, element) in self.elements().enumerate() {
            let item = || format!("element {index} on nodes {:?}", element.nodes());
            let nodes: Vec<usize> = element.nodes().iter().map(|&node| new_indices[node]).collect();
            let repetition = (1..nodes.len()).find(|&k| nodes[..k].contains(&nodes[k]));
            if let Some(k) = repetition {
                let reason = format!(
                    "merging makes it degenerate: node {} coincides with another of its nodes",
                    element.nodes()[k]
                );
                return Err(Error::part(item(), reason));
            }
            let renumbered = element
                .with_nodes(&nodes)
                .filter(|renumbered| renumbered.nodes() == nodes.as_slice())
                .ok_or_else(|| {
                    Error::part(item(), "it cannot be renumbered (Element::with_nodes)")
                })?;
            merged_mesh.add(renumbered).map_err(|fault| fault.within(item()))?;
        }
        *self = merged_mesh;
        Ok(MergedNodes { count: removed_count, indices: new_indices })
    }
}
