//! Points of a structure's base: nodes of a line in the plane, corners of faces in plan.

use super::DofCombination;
use crate::error::{Result, at_least, finite, in_bounds, require};
use crate::geometry::{COMPONENTS_IN_PLANE, COMPONENTS_IN_SPACE, span};

/// Relative difference of displacements, of heights, and of a distance from a line, that counts as rounding.
const FLATNESS_TOLERANCE: f64 = 1e-9;

/// A point of a structure's base, and its motion by the degrees of freedom.
///
/// Coordinates: x to the right, y away from the reader, z up. A node in the plane has no displacement along y.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct BaseNode {
    /// Coordinate to the right, m.
    pub x: f64,
    /// Coordinate away from the reader, m; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub y: f64,
    /// Coordinate upwards from the surface, m.
    #[cfg_attr(feature = "serde", serde(default))]
    pub z: f64,
    /// Displacement to the right as a weighted sum of degrees of freedom.
    pub horizontal: DofCombination,
    /// Displacement along y as a weighted sum of degrees of freedom; empty in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub across: DofCombination,
    /// Displacement upwards as a weighted sum of degrees of freedom.
    pub vertical: DofCombination,
}

impl BaseNode {
    /// A node in the plane with a horizontal and a vertical degree of freedom of its own.
    pub fn free(x: f64, horizontal: usize, vertical: usize) -> Self {
        Self { x, horizontal: horizontal.into(), vertical: vertical.into(), ..Self::default() }
    }

    /// A point of a rigid flat base in the plane.
    ///
    /// `dofs`: `[horizontal, vertical, rotation]` at `center`.
    pub fn rigid(x: f64, center: f64, dofs: [usize; 3]) -> Self {
        let vertical = [(dofs[1], 1.0), (dofs[2], x - center)].into();
        Self { x, horizontal: dofs[0].into(), vertical, ..Self::default() }
    }

    /// The two ends of a rigid flat base in the plane, from `left` to `right`.
    ///
    /// `dofs` as for [`BaseNode::rigid`], at the middle.
    pub fn rigid_base(left: f64, right: f64, dofs: [usize; 3]) -> Vec<Self> {
        let center = 0.5 * (left + right);
        vec![Self::rigid(left, center, dofs), Self::rigid(right, center, dofs)]
    }

    /// A node in plan, at `[x, y]` (m), with its own degrees of freedom.
    ///
    /// Displacements along x, along y and up.
    pub fn free_in_plan([x, y]: [f64; 2], [along, across, up]: [usize; 3]) -> Self {
        Self {
            x,
            y,
            z: 0.0,
            horizontal: along.into(),
            across: across.into(),
            vertical: up.into(),
        }
    }

    /// A point `[x, y]` (m) of a rigid flat base in plan.
    ///
    /// `dofs` at `center`: displacements along x, along y and up, and rotations about the same axes by the
    /// right-hand rule.
    pub fn rigid_in_plan([x, y]: [f64; 2], center: [f64; 2], dofs: [usize; 6]) -> Self {
        let [along, across, up, about_x, about_y, about_z] = dofs;
        let dx = x - center[0];
        let dy = y - center[1];
        Self {
            x,
            y,
            z: 0.0,
            horizontal: [(along, 1.0), (about_z, -dy)].into(),
            across: [(across, 1.0), (about_z, dx)].into(),
            vertical: [(up, 1.0), (about_x, dy), (about_y, -dx)].into(),
        }
    }

    /// The face of a rigid flat base in plan.
    ///
    /// `corners`: m from `center`. `dofs` as for [`BaseNode::rigid_in_plan`].
    pub fn rigid_face(corners: &[[f64; 2]], center: [f64; 2], dofs: [usize; 6]) -> Vec<Self> {
        let corner =
            |[x, y]: &[f64; 2]| Self::rigid_in_plan([center[0] + x, center[1] + y], center, dofs);
        corners.iter().map(corner).collect()
    }

    /// Rotations of the plane that fits the nodes best.
    ///
    /// Slope to the right, slope away from the reader, and turn about the vertical.
    #[doc(hidden)]
    pub fn mean_rotations(nodes: &[Self]) -> [DofCombination; 3] {
        let count = nodes.len() as f64;
        let x = nodes.iter().map(|node| node.x).sum::<f64>() / count;
        let y = nodes.iter().map(|node| node.y).sum::<f64>() / count;
        let xx = nodes.iter().map(|node| (node.x - x) * (node.x - x)).sum::<f64>() / count;
        let xy = nodes.iter().map(|node| (node.x - x) * (node.y - y)).sum::<f64>() / count;
        let yy = nodes.iter().map(|node| (node.y - y) * (node.y - y)).sum::<f64>() / count;
        let scale = count * (xx * yy - xy * xy);
        let polar = count * (xx + yy);
        let mut rotations: [DofCombination; 3] = Default::default();
        for node in nodes {
            let dx = node.x - x;
            let dy = node.y - y;
            rotations[0] += ((yy * dx - xy * dy) / scale) * node.vertical.clone();
            rotations[1] += ((xx * dy - xy * dx) / scale) * node.vertical.clone();
            rotations[2] += (dx / polar) * node.across.clone();
            rotations[2] += (-dy / polar) * node.horizontal.clone();
        }
        rotations
    }

    /// Displacements of a point along x, along y and up, as the nodes carry it.
    ///
    /// The point lies at `[x, y]` (m), `height` above the base, and moves with the plane that fits the nodes
    /// best.
    #[doc(hidden)]
    pub fn carried(nodes: &[Self], [x, y]: [f64; 2], height: f64) -> [DofCombination; 3] {
        let weight = 1.0 / nodes.len() as f64;
        let mut middle = [0.0; 2];
        let mut along = DofCombination::default();
        let mut across = DofCombination::default();
        let mut up = DofCombination::default();
        for node in nodes {
            middle[0] += weight * node.x;
            middle[1] += weight * node.y;
            along += weight * node.horizontal.clone();
            across += weight * node.across.clone();
            up += weight * node.vertical.clone();
        }
        let dx = x - middle[0];
        let dy = y - middle[1];
        let [slope_right, slope_away, turn] = Self::mean_rotations(nodes);
        [
            along - height * slope_right.clone() - dy * turn.clone(),
            across - height * slope_away.clone() + dx * turn,
            up + dx * slope_right + dy * slope_away,
        ]
    }

    /// Nodes at the lowest height, of a list along an outline: the base between the walls.
    ///
    /// All nodes, if only one is the lowest: a base without walls.
    #[doc(hidden)]
    pub fn floor(nodes: &[Self]) -> &[Self] {
        let heights = span(nodes.iter().map(|node| node.z));
        let limit = heights[0] + FLATNESS_TOLERANCE * (heights[1] - heights[0]);
        let first = nodes.iter().position(|node| node.z <= limit);
        let last = nodes.iter().rposition(|node| node.z <= limit);
        match (first, last) {
            (Some(first), Some(last)) if first < last => &nodes[first..=last],
            _ => nodes,
        }
    }

    /// Number of straight segments of a base in the plane.
    ///
    /// A node that cannot leave the line between its neighbours does not begin a new segment.
    #[doc(hidden)]
    pub fn segments(nodes: &[Self]) -> usize {
        1 + nodes.windows(3).filter(|three| !Self::are_flat(three)).count()
    }

    /// Whether the nodes stay a flat, uniformly strained body for any degrees of freedom.
    ///
    /// Their displacements are then linear in the coordinates, as on any rigid base. Nodes in the plane may have any
    /// heights.
    #[doc(hidden)]
    pub fn are_flat(nodes: &[Self]) -> bool {
        let Some(first) = nodes.first() else { return true };
        let in_plan = nodes.iter().any(|node| node.y != 0.0);
        let offsets: Vec<[f64; 2]> =
            nodes.iter().map(|node| node.offset_from(first, in_plan)).collect();
        let distances = offsets.iter().map(|offset| offset[0].hypot(offset[1]));
        let LargestValue { value: length, index: second } = largest_value(distances);
        if length == 0.0 {
            return nodes.iter().all(|node| node.rows() == first.rows());
        }
        let axis = offsets[second].map(|x| x / length);
        let LargestValue { value: width, index: third } =
            largest_value(offsets.iter().map(|offset| cross_product(axis, *offset).abs()));
        let is_line = width <= FLATNESS_TOLERANCE * length;
        let corners = [first, &nodes[second], &nodes[third]];
        nodes.iter().zip(&offsets).all(|(node, offset)| {
            let third_offset = offsets[third];
            let third_weight = if is_line {
                0.0
            } else {
                cross_product(axis, *offset) / cross_product(axis, third_offset)
            };
            let x = offset[0] - third_weight * third_offset[0];
            let y = offset[1] - third_weight * third_offset[1];
            let second_weight = (axis[0] * x + axis[1] * y) / length;
            let first_weight = 1.0 - second_weight - third_weight;
            node.is_interpolated(corners, [first_weight, second_weight, third_weight])
        })
    }

    /// Place relative to `first`: x and y in plan, x and z in the plane.
    fn offset_from(&self, first: &Self, in_plan: bool) -> [f64; 2] {
        let second = if in_plan { self.y - first.y } else { self.z - first.z };
        [self.x - first.x, second]
    }

    /// Whether the weighted sum of three corners' displacements gives the node's, up to rounding.
    fn is_interpolated(&self, corners: [&Self; 3], weights: [f64; 3]) -> bool {
        self.rows().into_iter().enumerate().all(|(k, row)| {
            let mut residual = row.clone();
            let mut scale = largest_weight(row);
            for (corner, weight) in corners.into_iter().zip(weights) {
                if weight != 0.0 {
                    residual -= weight * corner.rows()[k].clone();
                }
                scale = scale.max(largest_weight(corner.rows()[k]));
            }
            largest_weight(&residual) <= FLATNESS_TOLERANCE * scale
        })
    }

    /// Coordinates `[x, y]`, m.
    #[doc(hidden)]
    pub fn place(&self) -> [f64; 2] {
        [self.x, self.y]
    }

    /// Displacements to the right, upwards and away; the last is empty for a node of the plane.
    #[doc(hidden)]
    pub fn rows(&self) -> [&DofCombination; 3] {
        [&self.horizontal, &self.vertical, &self.across]
    }

    /// Maps the point's displacements to other degrees of freedom.
    #[doc(hidden)]
    pub fn map_rows(&mut self, map: impl Fn(&DofCombination) -> DofCombination) {
        for row in [&mut self.horizontal, &mut self.across, &mut self.vertical] {
            *row = map(row);
        }
    }

    /// Number of directions in which the node moves: two in the plane.
    #[doc(hidden)]
    pub fn directions(&self) -> usize {
        if self.across.is_empty() { COMPONENTS_IN_PLANE } else { COMPONENTS_IN_SPACE }
    }

    /// The degrees of freedom that move the node.
    #[doc(hidden)]
    pub fn dofs(&self) -> impl Iterator<Item = usize> {
        let terms = self.rows().into_iter().flatten();
        terms.filter(|(_, weight)| *weight != 0.0).map(|(dof, _)| *dof)
    }

    /// Error for a place or weight that is not finite, or a degree of freedom at `bound` or beyond.
    pub(super) fn check(&self, bound: usize) -> Result<()> {
        for coordinate in [self.x, self.y, self.z] {
            finite("coordinate of a contact node", coordinate)?;
        }
        for &(index, weight) in self.rows().into_iter().flatten() {
            finite("weight of a contact node", weight)?;
            in_bounds("degree of freedom of a contact node", index, bound)?;
        }
        Ok(())
    }
}

/// Largest of the values above zero and its index, the first of equals; (0, 0) without any.
fn largest_value(values: impl Iterator<Item = f64>) -> LargestValue {
    let mut largest = LargestValue { value: 0.0, index: 0 };
    for (index, value) in values.enumerate() {
        if value > largest.value {
            largest = LargestValue { value, index };
        }
    }
    largest
}

/// Largest of several values, and its place in their list.
struct LargestValue {
    value: f64,
    index: usize,
}

/// Component of the cross product of two vectors along the normal of their plane.
fn cross_product(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Largest size of a weight in a row.
fn largest_weight(row: &DofCombination) -> f64 {
    row.iter().fold(0.0_f64, |largest, (_, weight)| largest.max(weight.abs()))
}

/// Error unless a contact node at `x` lies to the right of the node before it, at `before`.
///
/// # Errors
/// [`Error::Input`](crate::Error::Input).
pub fn from_the_left(before: f64, x: f64) -> Result<()> {
    let needed = "to the right of the node before it: contact nodes are listed from left to right";
    require("coordinate of a contact node", x, x > before, needed).map(drop)
}

/// Error for a foundation in the plane of fewer than two contact nodes.
///
/// # Errors
/// [`Error::Size`](crate::Error::Size).
pub fn check_line(nodes: &[BaseNode]) -> Result<()> {
    at_least("list of contact nodes of a foundation", nodes.len(), 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rigid base is flat in the plane and in plan, wherever it lies; a node with its own degrees of
    /// freedom divides it.
    #[test]
    fn only_nodes_that_leave_the_flat_divide_a_base() {
        for far in [0.0, 4500.0] {
            let mut nodes: Vec<_> = [-3.0, -1.0, 0.5, 2.0, 3.0]
                .map(|x| BaseNode::rigid(far + x, far, [0, 1, 2]))
                .into();
            assert!(BaseNode::are_flat(&nodes));
            assert_eq!(BaseNode::segments(&nodes), 1);
            nodes[2].vertical = 7.into();
            assert!(!BaseNode::are_flat(&nodes));
            assert_eq!(BaseNode::segments(&nodes), 4);
            let dofs = [0, 1, 2, 3, 4, 5];
            let corner =
                |[x, y]: [f64; 2]| BaseNode::rigid_in_plan([far + x, y - far], [far, -far], dofs);
            let mut face: Vec<_> =
                [[0.0, 0.0], [4.0, 1.0], [5.0, 4.0], [1.0, 3.0], [0.0, 0.0]].map(corner).into();
            assert!(BaseNode::are_flat(&face));
            face[3].vertical = 7.into();
            assert!(!BaseNode::are_flat(&face));
        }
        // Nodes on the line through free ends move with the ends; free ends alone are one segment.
        let left = BaseNode::free(0.0, 0, 1);
        let right = BaseNode::free(4.0, 2, 3);
        let mut between = BaseNode::free(1.0, 0, 1);
        between.vertical = [(1, 0.75), (3, 0.25)].into();
        between.horizontal = [(0, 0.75), (2, 0.25)].into();
        let nodes = [left, between, right];
        assert_eq!(BaseNode::segments(&nodes), 1);
        assert_eq!(BaseNode::segments(&nodes[..1]), 1);
    }
}
