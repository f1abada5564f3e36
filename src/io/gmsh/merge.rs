//! New numbers of the nodes of a file of which some lie at the same place.

use std::collections::HashMap;

use super::cell::{MeshCell, sorted};
use super::raw::given_twice;
use crate::error::{Error, Result};
use crate::fem::first_coincident_points;

/// New index of each node.
pub(super) struct MergedNumbers {
    indices: Vec<usize>,
    /// Nodes that stay, by their old indices.
    kept_nodes: Vec<usize>,
}

impl MergedNumbers {
    pub(super) fn new(points: &[[f64; 3]], tolerance: f64) -> Result<Self> {
        let mut numbers =
            Self { indices: Vec::with_capacity(points.len()), kept_nodes: Vec::new() };
        for (node, first) in first_coincident_points(points, tolerance)?.into_iter().enumerate() {
            let index =
                if first == node { numbers.kept_nodes.len() } else { numbers.indices[first] };
            if first == node {
                numbers.kept_nodes.push(node);
            }
            numbers.indices.push(index);
        }
        Ok(numbers)
    }

    /// Error for an element with two nodes at one place, or on the nodes of another surface or solid.
    pub(super) fn check<'a>(
        &self,
        file: &str,
        cells: impl Iterator<Item = &'a MeshCell>,
    ) -> Result<()> {
        let mut tags_by_corners: HashMap<Vec<usize>, u64> = HashMap::new();
        for cell in cells {
            let mut nodes = cell.nodes.clone();
            self.renumber(&mut nodes);
            let corners = sorted(&nodes[..cell.kind.corners().min(nodes.len())]);
            if sorted(&nodes).windows(2).any(|pair| pair[0] == pair[1]) {
                let reason =
                    format!("{}: merging puts two of its nodes at one place", cell.kind.name());
                return Err(cell.unusable(file, Error::part("nodes", reason)));
            }
            if cell.kind.dimension() > 1
                && let Some(other) = tags_by_corners.insert(corners, cell.tag)
            {
                let item = format!("{} {} by element {other}", cell.kind.name(), cell.tag);
                return Err(given_twice(item).of(file, cell.line));
            }
        }
        Ok(())
    }

    /// Renumbers the nodes of an element.
    pub(super) fn renumber(&self, nodes: &mut [usize]) {
        for node in nodes {
            *node = self.indices[*node];
        }
    }

    /// The items of the nodes that stay.
    pub(super) fn kept_items<T: Copy>(&self, items: &[T]) -> Vec<T> {
        self.kept_nodes.iter().map(|&node| items[node]).collect()
    }
}
