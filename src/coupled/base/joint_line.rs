//! Line of a joint: two lines of nodes, and the contact elements between them.

use std::ops::Range;

use crate::error::{Result, at_least, finite, require};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactElement, check_count};
use crate::structure::BaseNode;

/// Distance of a node from the line of its side that counts as rounding.
///
/// It is relative to the length of the upper side.
const STRAIGHTNESS_TOLERANCE: f64 = 1e-6;
/// Length of an element at an end of a joint below which its neighbour takes it, relative to the upper side.
const MIN_END_ELEMENT_FRACTION: f64 = 1e-6;

/// Two lines of nodes of a structure, and contact elements between them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointLine {
    /// Nodes of the upper side, then nodes of the lower side.
    sides: [Vec<BaseNode>; 2],
    /// Contact elements, in the order of the nodes.
    ///
    /// Their normals lead from the upper side into the lower side.
    elements: Vec<ContactElement>,
    /// Gap of the unloaded structure, m.
    pub(crate) gap: f64,
}

/// A joint of a base: its line, and its elements among all contact elements.
#[derive(Debug, Clone)]
pub(crate) struct PlacedJoint {
    pub(crate) line: JointLine,
    /// Indices of its elements among all contact elements.
    pub(crate) elements: Range<usize>,
}

impl JointLine {
    /// Equal elements over the length that both lines of nodes share.
    ///
    /// Returns an error for lines that are not straight, not parallel, or do not overlap.
    pub(crate) fn new(
        upper: Vec<BaseNode>,
        lower: Vec<BaseNode>,
        element_count: usize,
    ) -> Result<Self> {
        at_least("list of contact elements of a joint", element_count, 1)?;
        check_count(element_count, COMPONENTS_IN_PLANE)?;
        let sides = [upper, lower];
        let upper_element = checked_upper_element(&sides)?;
        let span = common_span(&sides, &upper_element)?;
        let ends = (0..=element_count).map(|k| {
            let fraction = k as f64 / element_count as f64;
            (1.0 - fraction) * span[0] + fraction * span[1]
        });
        Ok(Self::with_ends(sides, &upper_element, ends))
    }

    /// An element around each node of the lower side, over the length that both lines share.
    ///
    /// With elements between the nodes, every second node could move up and its neighbours down without a change of any
    /// mean. Returns an error as [`new`](Self::new).
    pub(crate) fn around_lower_nodes(upper: Vec<BaseNode>, lower: Vec<BaseNode>) -> Result<Self> {
        let sides = [upper, lower];
        let upper_element = checked_upper_element(&sides)?;
        let span = common_span(&sides, &upper_element)?;
        check_count(sides[1].len(), COMPONENTS_IN_PLANE)?;
        let min_length = MIN_END_ELEMENT_FRACTION * upper_element.length();
        let coordinate = |node: &BaseNode| upper_element.components([node.x, 0.0, node.z])[1];
        let mut ends = vec![span[0]];
        for pair in sides[1].windows(2) {
            let middle = 0.5 * (coordinate(&pair[0]) + coordinate(&pair[1]));
            if span[0] + min_length < middle && middle < span[1] - min_length {
                ends.push(middle);
            }
        }
        ends.push(span[1]);
        Ok(Self::with_ends(sides, &upper_element, ends.into_iter()))
    }

    /// Elements between these coordinates along `upper_element`, which lies over the upper side.
    fn with_ends(
        sides: [Vec<BaseNode>; 2],
        upper_element: &ContactElement,
        ends: impl Iterator<Item = f64>,
    ) -> Self {
        let [line_start, line_end] = upper_element.span();
        let first = &sides[0][0];
        let last = &sides[0][sides[0].len() - 1];
        let mut points = Vec::new();
        for coordinate in ends {
            let weight = (coordinate - line_start) / (line_end - line_start);
            points.push([
                (1.0 - weight) * first.x + weight * last.x,
                (1.0 - weight) * first.z + weight * last.z,
            ]);
        }
        let elements =
            points.windows(2).map(|ends| ContactElement::wall(ends[0], ends[1])).collect();
        Self { sides, elements, gap: 0.0 }
    }

    /// The contact elements.
    pub(crate) fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    /// Nodes of the upper and of the lower side.
    pub(crate) fn sides(&self) -> &[Vec<BaseNode>; 2] {
        &self.sides
    }

    /// Checks that the nodes' degrees of freedom exist in the structure, with finite weights.
    pub(crate) fn check(&self, dof_count: usize) -> Result<()> {
        for row in self.sides.iter().flatten().flat_map(BaseNode::rows) {
            row.check("degree of freedom of a contact node", dof_count)?;
        }
        Ok(())
    }

    /// Number of straight segments along the elements.
    ///
    /// It is that of the side with more segments, and 1 for rigid sides.
    pub(crate) fn segments(&self) -> usize {
        let first = &self.elements[0];
        let ends = [first.span()[0], first.span()[0] + self.length()];
        let is_inside = |node: &BaseNode| {
            let coordinate = first.components([node.x, 0.0, node.z])[1];
            ends[0] < coordinate && coordinate < ends[1]
        };
        let bends = |triple: &&[BaseNode]| is_inside(&triple[1]) && !BaseNode::are_flat(triple);
        let counts = self.sides.iter().map(|nodes| 1 + nodes.windows(3).filter(bends).count());
        counts.max().unwrap_or(1)
    }

    /// Length of all elements, m.
    fn length(&self) -> f64 {
        self.elements.iter().map(ContactElement::length).sum()
    }
}

/// Element over the whole upper side; an error for too few nodes, coordinates that are not finite, or no length.
fn checked_upper_element(sides: &[Vec<BaseNode>; 2]) -> Result<ContactElement> {
    for nodes in sides {
        at_least("list of contact nodes of a side of a joint", nodes.len(), 2)?;
        for node in nodes {
            finite("coordinate of a contact node", node.x)?;
            finite("coordinate of a contact node", node.z)?;
        }
    }
    let first = &sides[0][0];
    let last = &sides[0][sides[0].len() - 1];
    let length = (last.x - first.x).hypot(last.z - first.z);
    let quantity = "length of the upper side of a joint";
    require(quantity, length, length > 0.0 && length.is_finite(), "above zero")?;
    Ok(ContactElement::wall([first.x, first.z], [last.x, last.z]))
}

/// Span of the coordinates along `upper_element` that all sides share, m.
///
/// Returns an error for sides that are not straight, not parallel to `upper_element` (over the upper side), listed in
/// opposite order, or not opposite each other.
fn common_span(sides: &[Vec<BaseNode>; 2], upper_element: &ContactElement) -> Result<[f64; 2]> {
    let first = &sides[0][0];
    let last = &sides[0][sides[0].len() - 1];
    let length = (last.x - first.x).hypot(last.z - first.z);
    let mut span = [f64::NEG_INFINITY, f64::INFINITY];
    for nodes in sides {
        let place = |node: &BaseNode| upper_element.components([node.x, 0.0, node.z]);
        let places: Vec<[f64; 3]> = nodes.iter().map(place).collect();
        for pair in places.windows(2) {
            let distance = pair[1][1] - pair[0][1];
            let needed = "above zero: both sides are listed in one sense";
            let quantity = "distance between contact nodes along a joint";
            require(quantity, distance, distance > 0.0, needed)?;
        }
        for [depth, ..] in &places {
            let distance = depth - places[0][0];
            let quantity = "distance of a contact node from the line of its side of a joint, m";
            let is_straight = distance.abs() <= STRAIGHTNESS_TOLERANCE * length;
            require(quantity, distance, is_straight, "zero: both sides are straight and parallel")?;
        }
        span = [span[0].max(places[0][1]), span[1].min(places[places.len() - 1][1])];
    }
    let overlap = span[1] - span[0];
    let needed = "above zero: both sides must be opposite each other";
    require("common length of both sides of a joint", overlap, overlap > 0.0, needed)?;
    Ok(span)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_lie_around_the_nodes_of_the_lower_side() {
        let node = |x: f64| BaseNode { x, ..BaseNode::default() };
        let upper = vec![node(-2.5), node(3.0)];
        let lower: Vec<BaseNode> = [-3.0, -2.0, 0.0, 3.0].into_iter().map(node).collect();
        let line = JointLine::around_lower_nodes(upper.clone(), lower.clone()).unwrap();
        let ends: Vec<f64> = line.elements().iter().map(|element| element.span()[0]).collect();
        let expected_ends = [-2.5, -1.0, 1.5];
        assert_eq!(ends.len(), expected_ends.len(), "{ends:?}");
        for (end, expected) in ends.iter().zip(expected_ends) {
            assert!((end - expected).abs() < 1e-12, "{ends:?}");
        }
        assert!((line.length() - 5.5).abs() < 1e-12);
        assert!(JointLine::around_lower_nodes(upper, lower[..1].to_vec()).is_err());
    }
}
