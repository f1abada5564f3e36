//! A base in the plane: a line of nodes, the mean of its displacement over a contact element, and its chord.

use super::base::{Base, Outline, check_covered, mean_settlement};
use super::transformation::{Terms, Weights, accumulate};
use crate::bem::ContactElement;
use crate::error::{Error, Result, short};
use crate::geometry::Patch;
use crate::structure::{FaceNode, foundation_nodes, from_the_left};

impl Base {
    /// Averages the piecewise straight base over each element. A foundation ends at each of `ends`,
    /// and at the last node.
    pub(super) fn on_line(nodes: Vec<FaceNode>, ends: &[usize], elements: &Patch) -> Result<Self> {
        check_order(&nodes)?;
        let mut foundations = Vec::with_capacity(ends.len() + 1);
        let mut element = 0;
        for own in foundation_nodes(nodes.len(), ends)? {
            let last = own.end - 1;
            let end = nodes.get(own.end).map_or(elements.len(), |next| {
                let middle = 0.5 * (nodes[last].x + next.x);
                elements.partition_point(|element| element.center() < middle)
            });
            foundations.push(Outline {
                elements: element..end,
                settlement: mean_settlement(&nodes[own.clone()]),
                rotations: vec![Weights::Sparse(chord_rotation(&nodes[own.clone()]))],
                nodes: own,
                corners: Vec::new(),
            });
            element = end;
        }
        check_covered(&foundations)?;
        let mut weights = Vec::with_capacity(elements.len());
        for Outline { nodes: own, elements: range, .. } in &foundations {
            for element in &elements[range.clone()] {
                check_overlap(&nodes[own.clone()], element)?;
                let found = mean_weights(&nodes[own.clone()], element);
                weights
                    .push(found.into_iter().map(|(k, weight)| (own.start + k, weight)).collect());
            }
        }
        Ok(Self::from_weights(nodes, foundations, weights, elements))
    }
}

/// Returns [`Error::Input`] for nodes out of order.
fn check_order(nodes: &[FaceNode]) -> Result<()> {
    nodes.windows(2).try_for_each(|pair| from_the_left(pair[0].x, pair[1].x))
}

/// Refuses an element that is not wholly under the foundation with these nodes.
fn check_overlap(nodes: &[FaceNode], element: &ContactElement) -> Result<()> {
    let slack = 1e-9 * element.length();
    let (first, last) = (nodes[0].x, nodes[nodes.len() - 1].x);
    let ContactElement { left, right, .. } = *element;
    if first - left <= slack && right - last <= slack {
        return Ok(());
    }
    let [left, right, first, last] = [left, right, first, last].map(short);
    Err(Error::part(
        "ground",
        format!(
            "its element from {left} to {right} m reaches beyond the structure's base, {first} to {last} m: `under` makes \
             a ground of the base's width"
        ),
    ))
}

/// Rise of the last node over the first, per distance.
fn chord_rotation(nodes: &[FaceNode]) -> Terms {
    let (first, last) = (&nodes[0], &nodes[nodes.len() - 1]);
    let mut terms = Terms::new();
    accumulate(&mut terms, &last.vertical, 1.0 / (last.x - first.x));
    accumulate(&mut terms, &first.vertical, -1.0 / (last.x - first.x));
    terms
}

/// (node, weight) of the mean over `element` of the piecewise linear interpolation.
fn mean_weights(nodes: &[FaceNode], element: &ContactElement) -> Vec<(usize, f64)> {
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
