//! Names of degrees of freedom by nodes, for errors.

use std::fmt::Write;

use crate::error::point_text;
use crate::fem::{Direction, Mesh};
use crate::structure::detached::{MAX_LISTED_ITEMS, listed};

/// Nodes of these degrees of freedom with their places, for an error.
///
/// The text also names a node at the same place that is not merged with one of them. `number` numbers the degrees
/// of freedom. `None` if no node has these degrees of freedom.
pub(super) fn describe(
    mesh: &Mesh,
    number: &dyn Fn(usize, Direction) -> Option<usize>,
    dofs: &[usize],
) -> Option<String> {
    let limit = dofs.iter().copied().max()?;
    let max_dofs = mesh.directions().len() * mesh.nodes().len();
    let mut is_wanted = vec![false; limit.saturating_add(1).min(max_dofs)];
    for &dof in dofs {
        *is_wanted.get_mut(dof)? = true;
    }
    let mut nodes = Vec::new();
    let mut texts = Vec::new();
    for (node, place) in mesh.nodes().iter().enumerate() {
        let mut node_dofs = 0;
        let mut wanted_directions = Vec::new();
        for &direction in mesh.directions() {
            let Some(dof) = number(node, direction) else { continue };
            node_dofs += 1;
            if is_wanted.get(dof).copied().unwrap_or(false) {
                wanted_directions.push(direction);
            }
        }
        if wanted_directions.is_empty() {
            continue;
        }
        nodes.push(node);
        if texts.len() < MAX_LISTED_ITEMS {
            let mut text = format!("node {node} at {}", point_text(place, mesh.nodes()));
            if wanted_directions.len() < node_dofs {
                for direction in wanted_directions {
                    let _ = write!(text, " in {direction:?}");
                }
            }
            texts.push(text);
        }
    }
    if nodes.is_empty() {
        return None;
    }
    let mut text = listed(&texts, nodes.len());
    let twin = nodes.iter().find_map(|&node| {
        let other = mesh.nodes_beside(node).find(|other| nodes.binary_search(other).is_err())?;
        Some((node, other))
    });
    if let Some((node, other)) = twin {
        let _ = write!(text, "; node {node} lies where node {other} is, but is not merged with it");
    }
    Some(text)
}
