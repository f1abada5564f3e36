//! A base in the plane: lines of nodes, mean displacements over contact elements, and chords.

use super::faces::GAUSS_POINT_OFFSET;
use super::transformation::{SparseVector, Weights, accumulate};
use super::{BasePoint, PlacedBase, PlacedFoundation, check_covered};
use crate::bem::ContactElement;
use crate::error::{Error, Result, number_text};
use crate::geometry::Patch;
use crate::structure::{BaseNode, check_left_to_right, check_line};

/// Distance from an element's line or ends that counts as rounding, relative to its length.
const ON_ELEMENT_TOLERANCE: f64 = 1e-9;

impl PlacedBase {
    /// Places lines of nodes on elements; each line is a foundation.
    ///
    /// The displacement is linear between neighbouring nodes, and averaged over each element.
    pub(crate) fn on_lines(lines: &[Vec<BaseNode>], elements: &Patch) -> Result<Self> {
        let nodes = lines.concat();
        check_order(&nodes)?;
        let mut foundations: Vec<PlacedFoundation> = Vec::with_capacity(lines.len());
        let mut first_node = 0;
        let mut first_element = 0;
        for line in lines {
            check_line(line)?;
            check_left_to_right(line[0].x, line[line.len() - 1].x)?;
            let line_nodes = first_node..first_node + line.len();
            let floor = BaseNode::floor(line);
            let last_node = line_nodes.end - 1;
            // The elements end in the middle between this foundation and the next.
            let element_end = nodes.get(line_nodes.end).map_or(elements.len(), |next| {
                let middle = 0.5 * (nodes[last_node].x + next.x);
                elements.partition_point(|element| element.center()[0] < middle)
            });
            foundations.push(PlacedFoundation {
                elements: first_element..element_end,
                settlement: Weights::Sparse(mean_settlement(floor)),
                rotations: vec![Weights::Sparse(chord_rotation(floor))],
                nodes: line_nodes,
                corners: Vec::new(),
            });
            first_node = last_node + 1;
            first_element = element_end;
        }
        check_covered(&foundations)?;
        let mut weights = Vec::with_capacity(elements.len());
        let mut points = Vec::new();
        for PlacedFoundation { nodes: line_nodes, elements: foundation_elements, .. } in
            &foundations
        {
            let line = &nodes[line_nodes.clone()];
            // Converts indices in the line to indices in the base.
            let to_base_indices = |weights: Vec<(usize, f64)>| {
                weights
                    .into_iter()
                    .map(|(k, weight)| (line_nodes.start + k, weight))
                    .collect::<Vec<_>>()
            };
            let is_flexible = !BaseNode::are_flat(line);
            for e in foundation_elements.clone() {
                let nodes_on_element = NodesOnElement::new(line, &elements[e])?;
                weights.push(to_base_indices(nodes_on_element.mean_weights()));
                if !is_flexible {
                    continue;
                }
                for (area, corner_weights) in nodes_on_element.gauss_points() {
                    points.push(BasePoint {
                        element: e,
                        area,
                        corner_weights: to_base_indices(corner_weights),
                    });
                }
            }
        }
        Ok(Self::from_weights(nodes, foundations, weights, elements, points))
    }
}

/// Returns an error unless nodes of one height run from left to right.
fn check_order(nodes: &[BaseNode]) -> Result<()> {
    let mut level_pairs = nodes.windows(2).filter(|pair| pair[0].z == pair[1].z);
    level_pairs.try_for_each(|pair| check_left_to_right(pair[0].x, pair[1].x))
}

/// Mean displacement over the length between the first node and the last, downwards.
fn mean_settlement(nodes: &[BaseNode]) -> SparseVector {
    let length = nodes[nodes.len() - 1].x - nodes[0].x;
    let mut terms = SparseVector::new();
    for pair in nodes.windows(2) {
        // Half of each interval belongs to the node at each end of it.
        let weight = 0.5 * (pair[1].x - pair[0].x) / length;
        for node in pair {
            accumulate(&mut terms, &node.vertical, -weight);
        }
    }
    terms
}

/// Rotation of a chord: difference of the vertical displacements of its ends over their distance.
fn chord_rotation(nodes: &[BaseNode]) -> SparseVector {
    let first = &nodes[0];
    let last = &nodes[nodes.len() - 1];
    let mut terms = SparseVector::new();
    accumulate(&mut terms, &last.vertical, 1.0 / (last.x - first.x));
    accumulate(&mut terms, &first.vertical, -1.0 / (last.x - first.x));
    terms
}

/// The nodes on the line of an element.
pub(super) struct NodesOnElement {
    /// Index of the first node in its line.
    first_node: usize,
    /// Coordinates of the nodes along the element's tangent, m.
    coordinates: Vec<f64>,
    /// Coordinates of the element's ends along its tangent, m.
    ends: [f64; 2],
}

impl NodesOnElement {
    /// All nodes of a straight line parallel to an element, which they cover.
    pub(super) fn along(nodes: &[BaseNode], element: &ContactElement) -> Self {
        let coordinate = |node: &BaseNode| element.components([node.x, node.y, node.z])[1];
        let coordinates = nodes.iter().map(coordinate).collect();
        Self { first_node: 0, coordinates, ends: element.span() }
    }

    /// Selects the nodes on the line of an element.
    ///
    /// Returns an error unless the nodes cover the element.
    pub(super) fn new(nodes: &[BaseNode], element: &ContactElement) -> Result<Self> {
        // Coordinates along the element's normal and tangent.
        let local_coordinates = |node: &BaseNode| element.components([node.x, node.y, node.z]);
        let depth = element.components(element.center())[0];
        let tolerance = ON_ELEMENT_TOLERANCE * element.length();
        let is_on_line = |node: &&BaseNode| (local_coordinates(node)[0] - depth).abs() <= tolerance;
        let first_node = nodes.iter().position(|node| is_on_line(&node)).unwrap_or(nodes.len());
        let nodes_on_line = nodes[first_node..].iter().take_while(is_on_line);
        let coordinates = nodes_on_line.map(|node| local_coordinates(node)[1]).collect();
        let nodes_on_element = Self { first_node, coordinates, ends: element.span() };
        let [first, .., last] = nodes_on_element.coordinates[..] else {
            let [x, _, z] = element.center().map(number_text);
            let reason = format!(
                "its base does not lie along the ground's element at x = {x} m, z = {z} m: `WithWalls` and \
                 `FemModel::in_trench` put a base at the depth of a trench"
            );
            return Err(Error::part("structure", reason));
        };
        let [left, right] = nodes_on_element.ends;
        if first - left <= tolerance && right - last <= tolerance {
            return Ok(nodes_on_element);
        }
        let reason = format!(
            "its element from {} to {} m extends beyond the structure's base, {} to {} m: `under` makes a ground of the \
             base's width",
            number_text(left),
            number_text(right),
            number_text(first),
            number_text(last)
        );
        Err(Error::part("ground", reason))
    }

    /// Pieces of the element between neighbouring nodes.
    fn pieces(&self) -> impl Iterator<Item = ElementPiece> {
        let [left, right] = self.ends;
        let pieces = self.coordinates.windows(2).enumerate().map(move |(k, pair)| {
            // The outermost pieces also include the rounding between the base's end and the element's end.
            let start = if k == 0 { left } else { left.max(pair[0]) };
            let end = if k + 2 == self.coordinates.len() { right } else { right.min(pair[1]) };
            ElementPiece { node: self.first_node + k, x0: pair[0], x1: pair[1], start, end }
        });
        pieces.filter(|piece| piece.end > piece.start)
    }

    /// Indices and weights of nodes in the mean displacement of the element.
    pub(super) fn mean_weights(&self) -> Vec<(usize, f64)> {
        let length = self.ends[1] - self.ends[0];
        let mut weights = Vec::new();
        for ElementPiece { node, x0, x1, start, end } in self.pieces() {
            // Weight of the second node in the displacement of the piece's middle.
            let second_weight = (0.5 * (start + end) - x0) / (x1 - x0);
            let fraction = (end - start) / length;
            weights.extend([
                (node, fraction * (1.0 - second_weight)),
                (node + 1, fraction * second_weight),
            ]);
        }
        weights
    }

    /// Indices and weights of nodes in the integral of the displacement times a load on the element.
    ///
    /// `resultant`: sum of the load between two coordinates along the tangent, and the coordinate of its centroid.
    pub(super) fn integral_weights(
        &self,
        resultant: impl Fn([f64; 2]) -> (f64, f64),
    ) -> Vec<(usize, f64)> {
        let mut weights = Vec::new();
        for ElementPiece { node, x0, x1, start, end } in self.pieces() {
            let (force, centroid) = resultant([start, end]);
            // The displacement is linear over the piece.
            let second_weight = (centroid - x0) / (x1 - x0);
            weights
                .extend([(node, force * (1.0 - second_weight)), (node + 1, force * second_weight)]);
        }
        weights
    }

    /// Gauss points on each piece of the element.
    ///
    /// Each has a length (m), and the indices and weights of its nodes.
    fn gauss_points(&self) -> Vec<(f64, Vec<(usize, f64)>)> {
        let mut points = Vec::new();
        for ElementPiece { node, x0, x1, start, end } in self.pieces() {
            for offset in [-GAUSS_POINT_OFFSET, GAUSS_POINT_OFFSET] {
                let x = 0.5 * (start + end) + offset * (end - start);
                let weight = (x - x0) / (x1 - x0);
                points.push((0.5 * (end - start), vec![(node, 1.0 - weight), (node + 1, weight)]));
            }
        }
        points
    }
}

/// Piece of an element between two neighbouring nodes.
struct ElementPiece {
    /// Index of the first of the two nodes.
    node: usize,
    /// Coordinate of the first node along the element's tangent, m.
    x0: f64,
    /// Coordinate of the second node, m.
    x1: f64,
    /// Coordinate of the piece's first end along the element's tangent, m.
    start: f64,
    /// Coordinate of the second end, m.
    end: f64,
}
