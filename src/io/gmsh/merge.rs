//! Merges nodes of a file that lie at the same point.

use std::collections::HashMap;

use super::cell::{MeshCell, sorted_nodes};
use super::raw::duplicate_fault;
use crate::error::{Error, Result};
use crate::fem::first_coincident_points;

/// New indices of nodes after nodes at the same point were merged.
pub(super) struct NodeMerge {
    /// New index of each node.
    new_indices: Vec<usize>,
    /// Old indices of the remaining nodes.
    kept_nodes: Vec<usize>,
}

impl NodeMerge {
    /// Merges `points` (m) within a `tolerance` (m).
    pub(super) fn new(points: &[[f64; 3]], tolerance: f64) -> Result<Self> {
        let mut merge =
            Self { new_indices: Vec::with_capacity(points.len()), kept_nodes: Vec::new() };
        for (node, first_node) in
            first_coincident_points(points, tolerance)?.into_iter().enumerate()
        {
            let index = if first_node == node {
                merge.kept_nodes.len()
            } else {
                merge.new_indices[first_node]
            };
            if first_node == node {
                merge.kept_nodes.push(node);
            }
            merge.new_indices.push(index);
        }
        Ok(merge)
    }

    /// Error for an element that merging makes degenerate or equal to another one.
    pub(super) fn check<'a>(
        &self,
        file: &str,
        cells: impl Iterator<Item = &'a MeshCell>,
    ) -> Result<()> {
        let mut tags_by_corners: HashMap<Vec<usize>, u64> = HashMap::new();
        for cell in cells {
            let mut nodes = cell.nodes.clone();
            self.renumber(&mut nodes);
            let corners = sorted_nodes(&nodes[..cell.kind.corner_count().min(nodes.len())]);
            if sorted_nodes(&nodes).windows(2).any(|pair| pair[0] == pair[1]) {
                let reason =
                    format!("{}: merging moves two of its nodes to one point", cell.kind.name());
                return Err(cell.unusable(file, Error::part("nodes", reason)));
            }
            if cell.kind.dimension() > 1
                && let Some(other_tag) = tags_by_corners.insert(corners, cell.tag)
            {
                let item = format!("{} {} by element {other_tag}", cell.kind.name(), cell.tag);
                return Err(duplicate_fault(item).of(file, cell.line));
            }
        }
        Ok(())
    }

    /// Renumbers the nodes of an element.
    pub(super) fn renumber(&self, nodes: &mut [usize]) {
        for node in nodes {
            *node = self.new_indices[*node];
        }
    }

    /// Selects the items of the remaining nodes; `items` has one for each node before the merge.
    pub(super) fn kept_items<T: Copy>(&self, items: &[T]) -> Vec<T> {
        self.kept_nodes.iter().map(|&node| items[node]).collect()
    }
}
