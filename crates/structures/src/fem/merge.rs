//! Merging of the nodes of a mesh at the same place.

use super::coincident::first_at_place;
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
    /// For lists of nodes made before merging, such as the nodes of a base.
    pub indices: Vec<usize>,
}

impl Mesh {
    /// Merges nodes at the same place, so that their elements act on each other.
    ///
    /// `tolerance`: largest distance of merged nodes, m.
    ///
    /// The first node of a place stays where it is; nodes are renumbered in their order, elements keep their indices.
    /// A tolerance of a thousandth of the smallest distance of nodes is far above rounding. The mesh stays as it was
    /// if there is an error. Where triangles meet quadrilaterals at nodes that are merged, call
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
    /// [`Error::Input`] unless the tolerance is finite and not negative. [`Error::Part`] for nodes in a row that lie
    /// within the tolerance of each other, while its ends do not. [`Error::Item`] with the element that two merged
    /// nodes would make degenerate, that would be a duplicate of another one ([`Mesh::add`]), or that cannot be
    /// renumbered ([`Element::with_nodes`]).
    pub fn merge_nodes(&mut self, tolerance: f64) -> Result<MergedNodes> {
        let firsts = first_at_place(self.nodes(), tolerance)?;
        let mut merged = self.without_content();
        let mut indices: Vec<usize> = Vec::with_capacity(firsts.len());
        for (node, &first) in firsts.iter().enumerate() {
            let index = if first == node {
                merged.add_node_at(self.nodes()[node])?
            } else {
                indices[first]
            };
            indices.push(index);
        }
        let count = self.nodes().len() - merged.nodes().len();
        for (index, element) in self.elements().enumerate() {
            let item = || format!("element {index} on nodes {:?}", element.nodes());
            let nodes: Vec<usize> = element.nodes().iter().map(|&node| indices[node]).collect();
            let repeated = (1..nodes.len()).find(|&k| nodes[..k].contains(&nodes[k]));
            if let Some(k) = repeated {
                let reason = format!(
                    "merging leaves it without extent: node {} is at the place of another",
                    element.nodes()[k]
                );
                return Err(Error::part(item(), reason));
            }
            let changed = element.with_nodes(&nodes);
            let changed = changed.filter(|changed| changed.nodes() == nodes.as_slice());
            let changed = changed.ok_or_else(|| {
                Error::part(item(), "it cannot be renumbered (Element::with_nodes)")
            })?;
            merged.add(changed).map_err(|fault| fault.within(item()))?;
        }
        *self = merged;
        Ok(MergedNodes { count, indices })
    }
}
