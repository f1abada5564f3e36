//! Line of a joint: two lines of nodes, and the contact elements between them.

use std::ops::Range;

use crate::error::{Result, at_least, finite, require};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactElement, check_count};
use crate::structure::BaseNode;

/// Distance of a node from the line of its side that counts as rounding.
///
/// It is relative to the length of the line.
const STRAIGHTNESS_TOLERANCE: f64 = 1e-6;

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

/// A joint of a base: its elements, and its nodes among the contact nodes.
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
        for nodes in [&upper, &lower] {
            at_least("list of contact nodes of a side of a joint", nodes.len(), 2)?;
            for node in nodes {
                finite("coordinate of a contact node", node.x)?;
                finite("coordinate of a contact node", node.z)?;
            }
        }
        let first = &upper[0];
        let last = &upper[upper.len() - 1];
        let length = (last.x - first.x).hypot(last.z - first.z);
        let quantity = "length of the upper side of a joint";
        require(quantity, length, length > 0.0 && length.is_finite(), "above zero")?;
        let direction = ContactElement::wall([first.x, first.z], [last.x, last.z]);
        let common_span = common_span(&[&upper, &lower], &direction, length)?;
        let elements = equal_elements([first, last], &direction, common_span, element_count);
        Ok(Self { sides: [upper, lower], elements, gap: 0.0 })
    }

    /// The contact elements.
    pub(crate) fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    /// Nodes of the upper and of the lower side.
    pub(crate) fn sides(&self) -> &[Vec<BaseNode>; 2] {
        &self.sides
    }

    /// Checks that the weights are finite, and that the structure has the degrees of freedom.
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

/// Span of the coordinates along `direction` that all sides share, m.
///
/// Returns an error for sides that are not straight, not parallel to `direction` (an element of this `length`, m), listed
/// in the other sense, or not opposite each other.
fn common_span(
    sides: &[&Vec<BaseNode>; 2],
    direction: &ContactElement,
    length: f64,
) -> Result<[f64; 2]> {
    let mut span = [f64::NEG_INFINITY, f64::INFINITY];
    for nodes in sides {
        let place = |node: &BaseNode| direction.components([node.x, 0.0, node.z]);
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

/// Equal elements over a span of the line between two nodes, whose direction is `direction`.
fn equal_elements(
    [first, last]: [&BaseNode; 2],
    direction: &ContactElement,
    span: [f64; 2],
    element_count: usize,
) -> Vec<ContactElement> {
    let [line_start, line_end] = direction.span();
    let mut points = Vec::with_capacity(element_count + 1);
    for k in 0..=element_count {
        let fraction = k as f64 / element_count as f64;
        let coordinate = (1.0 - fraction) * span[0] + fraction * span[1];
        let weight = (coordinate - line_start) / (line_end - line_start);
        points.push([
            (1.0 - weight) * first.x + weight * last.x,
            (1.0 - weight) * first.z + weight * last.z,
        ]);
    }
    points.windows(2).map(|ends| ContactElement::wall(ends[0], ends[1])).collect()
}
