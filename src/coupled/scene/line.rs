//! A base in the plane: a line of nodes, the mean of its displacement over a contact element, and its chord.

use super::transformation::{Terms, accumulate};
use crate::bem::ContactElement;
use crate::error::{Result, require};
use crate::structure::FaceNode;

/// Refuses nodes out of order.
pub(super) fn check_order(nodes: &[FaceNode]) -> Result<()> {
    nodes.windows(2).try_for_each(|pair| {
        let (before, x) = (pair[0].x, pair[1].x);
        let needed = "to the right of the node before it";
        require("coordinate of a contact node", x, x > before, needed).map(drop)
    })
}

/// Refuses an element that is not wholly under the foundation with these nodes.
pub(super) fn check_overlap(nodes: &[FaceNode], element: &ContactElement) -> Result<()> {
    let slack = 1e-9 * element.length();
    let (first, last) = (nodes[0].x, nodes[nodes.len() - 1].x);
    for value in [first - element.left, element.right - last] {
        let quantity = "overhang of a contact element beyond the structure's base, m";
        let needed =
            "zero: all elements of the ground lie between the structure's outermost contact nodes";
        require(quantity, value, value <= slack, needed)?;
    }
    Ok(())
}

/// Rise of the last node over the first, per distance.
pub(super) fn chord_rotation(nodes: &[FaceNode]) -> Terms {
    let (first, last) = (&nodes[0], &nodes[nodes.len() - 1]);
    let mut terms = Terms::new();
    accumulate(&mut terms, &last.vertical, 1.0 / (last.x - first.x));
    accumulate(&mut terms, &first.vertical, -1.0 / (last.x - first.x));
    terms
}

/// (node, weight) of the mean over `element` of the piecewise linear interpolation.
pub(super) fn mean_weights(nodes: &[FaceNode], element: &ContactElement) -> Vec<(usize, f64)> {
    let mut weights = Vec::new();
    for (k, pair) in nodes.windows(2).enumerate() {
        let (x0, x1) = (pair[0].x, pair[1].x);
        // The outermost segments also carry what rounding leaves outside them.
        let from = if k == 0 { element.left } else { element.left.max(x0) };
        let to = if k + 2 == nodes.len() { element.right } else { element.right.min(x1) };
        if to > from {
            let middle = (0.5 * (from + to) - x0) / (x1 - x0);
            let share = (to - from) / element.length();
            weights.push((k, share * (1.0 - middle)));
            weights.push((k + 1, share * middle));
        }
    }
    weights
}
