//! A base in the plane: lines of nodes, its mean displacement over a contact element, and its chord.

use super::faces::GAUSS_POINT_OFFSET;
use super::transformation::{Terms, Weights, accumulate};
use super::{BasePoint, Outline, PlacedBase, check_covered};
use crate::bem::ContactElement;
use crate::error::{Error, Result, number_text};
use crate::geometry::Patch;
use crate::structure::{BaseNode, check_left_to_right, check_line};

/// Distance from an element's line and ends that counts as rounding, relative to its length.
const ON_ELEMENT_TOLERANCE: f64 = 1e-9;

impl PlacedBase {
    /// Averages the piecewise straight base over each element.
    ///
    /// Each line is a foundation.
    pub(crate) fn on_lines(lines: &[Vec<BaseNode>], elements: &Patch) -> Result<Self> {
        let nodes = lines.concat();
        check_order(&nodes)?;
        let mut foundations: Vec<Outline> = Vec::with_capacity(lines.len());
        let mut first = 0;
        let mut element = 0;
        for line in lines {
            check_line(line)?;
            check_left_to_right(line[0].x, line[line.len() - 1].x)?;
            let range = first..first + line.len();
            let floor = BaseNode::floor(line);
            let last = range.end - 1;
            let end = nodes.get(range.end).map_or(elements.len(), |next| {
                let middle = 0.5 * (nodes[last].x + next.x);
                elements.partition_point(|element| element.center()[0] < middle)
            });
            foundations.push(Outline {
                elements: element..end,
                settlement: Weights::Sparse(mean_settlement(floor)),
                rotations: vec![Weights::Sparse(chord_rotation(floor))],
                nodes: range,
                corners: Vec::new(),
            });
            first = last + 1;
            element = end;
        }
        check_covered(&foundations)?;
        let mut weights = Vec::with_capacity(elements.len());
        let mut points = Vec::new();
        for Outline { nodes: range, elements: under, .. } in &foundations {
            let line = &nodes[range.clone()];
            let numbered = |weights: Vec<(usize, f64)>| {
                weights.into_iter().map(|(k, weight)| (range.start + k, weight)).collect::<Vec<_>>()
            };
            let is_flexible = !BaseNode::are_flat(line);
            for e in under.clone() {
                let run = NodesOnElement::new(line, &elements[e])?;
                weights.push(numbered(run.mean_weights()));
                if !is_flexible {
                    continue;
                }
                for (area, corner_weights) in run.gauss_points() {
                    points.push(BasePoint {
                        element: e,
                        area,
                        corner_weights: numbered(corner_weights),
                    });
                }
            }
        }
        Ok(Self::from_weights(nodes, foundations, weights, elements, points))
    }
}

/// Error for nodes out of order.
///
/// Nodes of one height run from left to right.
fn check_order(nodes: &[BaseNode]) -> Result<()> {
    let mut level = nodes.windows(2).filter(|pair| pair[0].z == pair[1].z);
    level.try_for_each(|pair| check_left_to_right(pair[0].x, pair[1].x))
}

/// Mean displacement over the length between the first node and the last, downwards.
fn mean_settlement(nodes: &[BaseNode]) -> Terms {
    let length = nodes[nodes.len() - 1].x - nodes[0].x;
    let mut terms = Terms::new();
    for pair in nodes.windows(2) {
        // Half of each interval belongs to the node at each end of it.
        let weight = 0.5 * (pair[1].x - pair[0].x) / length;
        for node in pair {
            accumulate(&mut terms, &node.vertical, -weight);
        }
    }
    terms
}

/// Rise of the last node over the first, per distance.
fn chord_rotation(nodes: &[BaseNode]) -> Terms {
    let first = &nodes[0];
    let last = &nodes[nodes.len() - 1];
    let mut terms = Terms::new();
    accumulate(&mut terms, &last.vertical, 1.0 / (last.x - first.x));
    accumulate(&mut terms, &first.vertical, -1.0 / (last.x - first.x));
    terms
}

/// The nodes on the line of an element.
struct NodesOnElement {
    /// Number of the first node.
    first: usize,
    /// Places of the nodes along the element's tangent, m.
    places: Vec<f64>,
    /// Ends of the element, m.
    ends: [f64; 2],
}

impl NodesOnElement {
    /// Nodes on the line of an element; an error unless they reach from end to end.
    fn new(nodes: &[BaseNode], element: &ContactElement) -> Result<Self> {
        let place = |node: &BaseNode| element.components([node.x, node.y, node.z]);
        let depth = element.components(element.center())[0];
        let slack = ON_ELEMENT_TOLERANCE * element.length();
        let is_on = |node: &&BaseNode| (place(node)[0] - depth).abs() <= slack;
        let first = nodes.iter().position(|node| is_on(&node)).unwrap_or(nodes.len());
        let on = nodes[first..].iter().take_while(is_on);
        let run =
            Self { first, places: on.map(|node| place(node)[1]).collect(), ends: element.span() };
        let [start, .., end] = run.places[..] else {
            let center = element.center().map(number_text);
            let x = &center[0];
            let z = &center[2];
            let reason = format!(
                "its base does not lie along the ground's element at x = {x} m, z = {z} m: `WithWalls` and \
                 `FemModel::in_trench` put a base at the depth of a trench"
            );
            return Err(Error::part("structure", reason));
        };
        let left = run.ends[0];
        let right = run.ends[1];
        if start - left <= slack && right - end <= slack {
            return Ok(run);
        }
        let left = number_text(left);
        let right = number_text(right);
        let start = number_text(start);
        let end = number_text(end);
        Err(Error::part(
            "ground",
            format!(
                "its element from {left} to {right} m reaches beyond the structure's base, {start} to {end} m: `under` \
                 makes a ground of the base's width"
            ),
        ))
    }

    /// The pieces of the element between neighbouring nodes: places of both nodes, and both ends.
    fn pieces(&self) -> impl Iterator<Item = (usize, [f64; 2], [f64; 2])> {
        let left = self.ends[0];
        let right = self.ends[1];
        let segments = self.places.windows(2).enumerate().map(move |(k, pair)| {
            // The outermost segments also include a part outside them by rounding.
            let from = if k == 0 { left } else { left.max(pair[0]) };
            let to = if k + 2 == self.places.len() { right } else { right.min(pair[1]) };
            (self.first + k, [pair[0], pair[1]], [from, to])
        });
        segments.filter(|(.., [from, to])| to > from)
    }

    /// (node, weight) of the mean over the element of the piecewise linear interpolation.
    fn mean_weights(&self) -> Vec<(usize, f64)> {
        let length = self.ends[1] - self.ends[0];
        let weights = self.pieces().flat_map(|(k, [x0, x1], [from, to])| {
            let middle = (0.5 * (from + to) - x0) / (x1 - x0);
            let fraction = (to - from) / length;
            [(k, fraction * (1.0 - middle)), (k + 1, fraction * middle)]
        });
        weights.collect()
    }

    /// Gauss points on each piece of the element: length (m) and node weights of each point.
    fn gauss_points(&self) -> Vec<(f64, Vec<(usize, f64)>)> {
        let points = self.pieces().flat_map(|(k, [x0, x1], [from, to])| {
            [-GAUSS_POINT_OFFSET, GAUSS_POINT_OFFSET].map(|place| {
                let x = 0.5 * (from + to) + place * (to - from);
                let weight = (x - x0) / (x1 - x0);
                (0.5 * (to - from), vec![(k, 1.0 - weight), (k + 1, weight)])
            })
        });
        points.collect()
    }
}
