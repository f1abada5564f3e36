//! Texts that name degrees of freedom by their nodes, for errors.

use std::fmt::Write;

use crate::error::point_text;
use crate::fem::{Direction, Mesh};
use crate::structure::detached::{MAX_LISTED_ITEMS, joined_items};

/// Text that names the nodes of `dofs` with their coordinates, for an error.
///
/// The text also names a coincident node that is not merged with one of them. `dof_of` returns the degree of freedom of
/// a node in a direction. `None` if no node has these degrees of freedom.
pub(super) fn describe(
    mesh: &Mesh,
    dof_of: &dyn Fn(usize, Direction) -> Option<usize>,
    dofs: &[usize],
) -> Option<String> {
    let max_dof = dofs.iter().copied().max()?;
    let dof_count_bound = mesh.directions().len() * mesh.nodes().len();
    let mut is_requested = vec![false; max_dof.saturating_add(1).min(dof_count_bound)];
    for &dof in dofs {
        *is_requested.get_mut(dof)? = true;
    }
    let mut nodes = Vec::new();
    let mut texts = Vec::new();
    for (node, coordinates) in mesh.nodes().iter().enumerate() {
        let mut node_dof_count = 0;
        let mut requested_directions = Vec::new();
        for &direction in mesh.directions() {
            let Some(dof) = dof_of(node, direction) else { continue };
            node_dof_count += 1;
            if is_requested.get(dof).copied().unwrap_or(false) {
                requested_directions.push(direction);
            }
        }
        if requested_directions.is_empty() {
            continue;
        }
        nodes.push(node);
        if texts.len() < MAX_LISTED_ITEMS {
            let mut text = format!("node {node} at {}", point_text(coordinates, mesh.nodes()));
            if requested_directions.len() < node_dof_count {
                for direction in requested_directions {
                    let _ = write!(text, " in {direction:?}");
                }
            }
            texts.push(text);
        }
    }
    if nodes.is_empty() {
        return None;
    }
    let mut text = joined_items(&texts, nodes.len());
    let coincident_pair = nodes.iter().find_map(|&node| {
        let other_node = mesh
            .coincident_nodes(node)
            .find(|other_node| nodes.binary_search(other_node).is_err())?;
        Some((node, other_node))
    });
    if let Some((node, other_node)) = coincident_pair {
        let place = format!("; node {node} lies where node {other_node} is");
        let _ = write!(text, "{place}, but is not merged with it by `Mesh::merge_nodes`");
    }
    Some(text)
}
