//! A base in the plane: a line of nodes, its mean displacement over a contact element, and its chord.

use super::faces::GAUSS;
use super::transformation::{Terms, Weights, accumulate};
use super::{Base, BasePoint, Outline, check_covered, mean_settlement};
use crate::bem::ContactElement;
use crate::error::{Error, Result, short};
use crate::geometry::Patch;
use crate::structure::{FaceNode, foundation_nodes, from_the_left};

impl Base {
    /// Averages the piecewise straight base over each element.
    ///
    /// A foundation ends at each of `ends`, and at the last node.
    pub(crate) fn on_line(nodes: Vec<FaceNode>, ends: &[usize], elements: &Patch) -> Result<Self> {
        check_order(&nodes)?;
        let mut foundations = Vec::with_capacity(ends.len() + 1);
        let mut element = 0;
        for own in foundation_nodes(nodes.len(), ends)? {
            let last = own.end - 1;
            let end = nodes.get(own.end).map_or(elements.len(), |next| {
                let middle = 0.5 * (nodes[last].x + next.x);
                elements.partition_point(|element| element.center()[0] < middle)
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
        let mut points = Vec::new();
        for Outline { nodes: range, elements: under, .. } in &foundations {
            let own = &nodes[range.clone()];
            let numbered = |shares: Vec<(usize, f64)>| {
                shares.into_iter().map(|(k, share)| (range.start + k, share)).collect::<Vec<_>>()
            };
            let is_flexible = !FaceNode::are_flat(own);
            for e in under.clone() {
                check_overlap(own, &elements[e])?;
                weights.push(numbered(mean_weights(own, &elements[e])));
                let points_of = is_flexible.then(|| gauss_points(own, &elements[e]));
                points.extend(points_of.into_iter().flatten().map(|(area, shares)| BasePoint {
                    element: e,
                    area,
                    shares: numbered(shares),
                }));
            }
        }
        Ok(Self::from_weights(nodes, foundations, weights, elements, points))
    }
}

/// Error for nodes out of order.
fn check_order(nodes: &[FaceNode]) -> Result<()> {
    nodes.windows(2).try_for_each(|pair| from_the_left(pair[0].x, pair[1].x))
}

/// Error unless an element is wholly under the foundation with these nodes.
fn check_overlap(nodes: &[FaceNode], element: &ContactElement) -> Result<()> {
    let slack = 1e-9 * element.length();
    let (first, last) = (nodes[0].x, nodes[nodes.len() - 1].x);
    let [left, right] = element.ends()[0];
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

/// The pieces of `element` between neighbouring nodes: number of the segment, and both ends.
fn pieces(nodes: &[FaceNode], element: &ContactElement) -> impl Iterator<Item = (usize, [f64; 2])> {
    let segments = nodes.windows(2).enumerate().map(|(k, pair)| {
        // The outermost segments also include a part outside them by rounding.
        let from = if k == 0 { element.left() } else { element.left().max(pair[0].x) };
        let to =
            if k + 2 == nodes.len() { element.right() } else { element.right().min(pair[1].x) };
        (k, [from, to])
    });
    segments.filter(|(_, [from, to])| to > from)
}

/// (node, weight) of the mean over `element` of the piecewise linear interpolation.
fn mean_weights(nodes: &[FaceNode], element: &ContactElement) -> Vec<(usize, f64)> {
    let mut weights = Vec::new();
    for (k, [from, to]) in pieces(nodes, element) {
        let (x0, x1) = (nodes[k].x, nodes[k + 1].x);
        let middle = (0.5 * (from + to) - x0) / (x1 - x0);
        let share = (to - from) / element.length();
        weights.push((k, share * (1.0 - middle)));
        weights.push((k + 1, share * middle));
    }
    weights
}

/// Gauss points on each piece of `element`: length (m) and node weights of each point.
fn gauss_points(nodes: &[FaceNode], element: &ContactElement) -> Vec<(f64, Vec<(usize, f64)>)> {
    let points = pieces(nodes, element).flat_map(|(k, [from, to])| {
        let (x0, x1) = (nodes[k].x, nodes[k + 1].x);
        [-GAUSS, GAUSS].map(|place| {
            let x = 0.5 * (from + to) + place * (to - from);
            let share = (x - x0) / (x1 - x0);
            (0.5 * (to - from), vec![(k, 1.0 - share), (k + 1, share)])
        })
    });
    points.collect()
}
