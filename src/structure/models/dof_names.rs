//! Names of degrees of freedom by nodes, for errors.

use std::fmt::Write;

use crate::error::in_brackets;
use crate::fem::{Direction, Mesh};
use crate::structure::detached::{NAMED, listed};

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
    let mut is_meant =
        vec![false; limit.saturating_add(1).min(mesh.directions().len() * mesh.nodes().len())];
    for &dof in dofs {
        *is_meant.get_mut(dof)? = true;
    }
    let meant = |dof: usize| is_meant.get(dof).copied().unwrap_or(false);
    let mut nodes = Vec::new();
    let mut texts = Vec::new();
    for (node, place) in mesh.nodes().iter().enumerate() {
        let own = || mesh.directions().iter().copied().filter(|d| number(node, *d).is_some());
        let these: Vec<_> = own().filter(|d| number(node, *d).is_some_and(meant)).collect();
        if these.is_empty() {
            continue;
        }
        nodes.push(node);
        if texts.len() < NAMED {
            let mut text = format!("node {node} at {}", in_brackets(place, mesh.nodes()));
            if these.len() < own().count() {
                for direction in these {
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
