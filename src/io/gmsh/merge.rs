//! New numbers of the nodes of a file of which some lie at the same place.

use std::collections::HashMap;

use super::cell::{Cell, sorted};
use super::raw::twice;
use crate::error::{Error, Result};
use crate::fem::first_at_place;

/// New index of each node.
pub(super) struct MergedNumbers {
    indices: Vec<usize>,
    /// Nodes that stay.
    kept: Vec<usize>,
}

impl MergedNumbers {
    pub(super) fn new(points: &[[f64; 3]], tolerance: f64) -> Result<Self> {
        let mut numbers = Self { indices: Vec::with_capacity(points.len()), kept: Vec::new() };
        for (node, first) in first_at_place(points, tolerance)?.into_iter().enumerate() {
            let index = if first == node { numbers.kept.len() } else { numbers.indices[first] };
            if first == node {
                numbers.kept.push(node);
            }
            numbers.indices.push(index);
        }
        Ok(numbers)
    }

    /// Error for an element with two nodes at one place, or on the nodes of another surface or solid.
    pub(super) fn check<'a>(
        &self,
        file: &str,
        cells: impl Iterator<Item = &'a Cell>,
    ) -> Result<()> {
        let mut before: HashMap<Vec<usize>, u64> = HashMap::new();
        for cell in cells {
            let mut nodes = cell.nodes.clone();
            self.apply(&mut nodes);
            let corners = sorted(&nodes[..cell.kind.corners().min(nodes.len())]);
            if sorted(&nodes).windows(2).any(|pair| pair[0] == pair[1]) {
                let reason =
                    format!("{}: merging puts two of its nodes at one place", cell.kind.name());
                return Err(cell.unusable(file, Error::part("nodes", reason)));
            }
            if cell.kind.dimension() > 1
                && let Some(other) = before.insert(corners, cell.tag)
            {
                let what = format!("{} {} by element {other}", cell.kind.name(), cell.tag);
                return Err(twice(what).of(file, cell.line));
            }
        }
        Ok(())
    }

    /// Renumbers the nodes of an element.
    pub(super) fn apply(&self, nodes: &mut [usize]) {
        for node in nodes {
            *node = self.indices[*node];
        }
    }

    /// The items of the nodes that stay.
    pub(super) fn kept<T: Copy>(&self, items: &[T]) -> Vec<T> {
        self.kept.iter().map(|&node| items[node]).collect()
    }
}
