//! Points of a structure's base: nodes of a line in the plane, corners of faces in space.

use super::DofCombination;
use crate::error::{Result, at_least, finite, in_bounds, require};
use crate::geometry::{COMPONENTS_IN_PLANE, COMPONENTS_IN_SPACE, cross_in_plane, span};

/// Largest relative difference of displacements, heights or distances from a line because of rounding.
const FLATNESS_TOLERANCE: f64 = 1e-9;

/// A point of a structure's base, and its displacements as sums of degrees of freedom.
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
    /// Displacement along y as a weighted sum of degrees of freedom.
    ///
    /// Empty in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub across: DofCombination,
    /// Displacement upwards as a weighted sum of degrees of freedom.
    pub vertical: DofCombination,
}

impl BaseNode {
    /// A node in the plane with its own horizontal and vertical degree of freedom.
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

    /// A node in space, at `[x, y]` (m), with its own degrees of freedom.
    ///
    /// The degrees of freedom are the displacements along x, along y and up.
    pub fn free_in_plan([x, y]: [f64; 2], [along_x, along_y, up]: [usize; 3]) -> Self {
        Self {
            x,
            y,
            z: 0.0,
            horizontal: along_x.into(),
            across: along_y.into(),
            vertical: up.into(),
        }
    }

    /// A point `[x, y]` (m) of a rigid flat base in space.
    ///
    /// `dofs` at `center`: displacements along x, along y and up, and rotations about the same axes by the
    /// right-hand rule.
    pub fn rigid_in_plan([x, y]: [f64; 2], center: [f64; 2], dofs: [usize; 6]) -> Self {
        let [along_x, along_y, up, about_x, about_y, about_z] = dofs;
        let dx = x - center[0];
        let dy = y - center[1];
        Self {
            x,
            y,
            z: 0.0,
            horizontal: [(along_x, 1.0), (about_z, -dy)].into(),
            across: [(along_y, 1.0), (about_z, dx)].into(),
            vertical: [(up, 1.0), (about_x, dy), (about_y, -dx)].into(),
        }
    }

    /// The face of a rigid flat base in space.
    ///
    /// `corners`: m from `center`. `dofs` as for [`BaseNode::rigid_in_plan`].
    pub fn rigid_face(corners: &[[f64; 2]], center: [f64; 2], dofs: [usize; 6]) -> Vec<Self> {
        corners
            .iter()
            .map(|[x, y]| Self::rigid_in_plan([center[0] + x, center[1] + y], center, dofs))
            .collect()
    }

    /// Mean rotations of a base in space: those of the plane that fits the nodes best.
    ///
    /// They are the slope to the right, the slope away from the reader, and the rotation about the vertical.
    #[doc(hidden)]
    pub fn mean_rotations(nodes: &[Self]) -> [DofCombination; 3] {
        let node_count = nodes.len() as f64;
        let mean_x = nodes.iter().map(|node| node.x).sum::<f64>() / node_count;
        let mean_y = nodes.iter().map(|node| node.y).sum::<f64>() / node_count;
        let xx = nodes.iter().map(|node| (node.x - mean_x) * (node.x - mean_x)).sum::<f64>()
            / node_count;
        let xy = nodes.iter().map(|node| (node.x - mean_x) * (node.y - mean_y)).sum::<f64>()
            / node_count;
        let yy = nodes.iter().map(|node| (node.y - mean_y) * (node.y - mean_y)).sum::<f64>()
            / node_count;
        let determinant = node_count * (xx * yy - xy * xy);
        let polar_sum = node_count * (xx + yy);
        let mut rotations: [DofCombination; 3] = Default::default();
        for node in nodes {
            let dx = node.x - mean_x;
            let dy = node.y - mean_y;
            rotations[0] += ((yy * dx - xy * dy) / determinant) * node.vertical.clone();
            rotations[1] += ((xx * dy - xy * dx) / determinant) * node.vertical.clone();
            rotations[2] += (dx / polar_sum) * node.across.clone();
            rotations[2] += (-dy / polar_sum) * node.horizontal.clone();
        }
        rotations
    }

    /// Displacements of a point that is rigidly connected to the base.
    ///
    /// They are along x, along y and up. The point lies at `[x, y]` (m), `height` above the base, and moves with the
    /// plane that fits the nodes best.
    #[doc(hidden)]
    pub fn rigid_displacements(
        nodes: &[Self],
        [x, y]: [f64; 2],
        height: f64,
    ) -> [DofCombination; 3] {
        let weight = 1.0 / nodes.len() as f64;
        let mut mean_point = [0.0; 2];
        let mut mean_x = DofCombination::default();
        let mut mean_y = DofCombination::default();
        let mut mean_up = DofCombination::default();
        for node in nodes {
            mean_point[0] += weight * node.x;
            mean_point[1] += weight * node.y;
            mean_x += weight * node.horizontal.clone();
            mean_y += weight * node.across.clone();
            mean_up += weight * node.vertical.clone();
        }
        let dx = x - mean_point[0];
        let dy = y - mean_point[1];
        let [slope_right, slope_away, vertical_rotation] = Self::mean_rotations(nodes);
        [
            mean_x - height * slope_right.clone() - dy * vertical_rotation.clone(),
            mean_y - height * slope_away.clone() + dx * vertical_rotation,
            mean_up + dx * slope_right + dy * slope_away,
        ]
    }

    /// Floor of a base between its walls: the nodes at the lowest height.
    ///
    /// `nodes` are listed along the outline of the base.
    ///
    /// If only one node has the lowest height, the base has no walls, and all nodes are returned.
    #[doc(hidden)]
    pub fn floor(nodes: &[Self]) -> &[Self] {
        let height_range = span(nodes.iter().map(|node| node.z));
        let max_floor_height =
            height_range[0] + FLATNESS_TOLERANCE * (height_range[1] - height_range[0]);
        let first_index = nodes.iter().position(|node| node.z <= max_floor_height);
        let last_index = nodes.iter().rposition(|node| node.z <= max_floor_height);
        match (first_index, last_index) {
            (Some(first_index), Some(last_index)) if first_index < last_index => {
                &nodes[first_index..=last_index]
            }
            _ => nodes,
        }
    }

    /// Number of straight segments of a base in the plane.
    ///
    /// A node that always lies on the line between its neighbours does not begin a new segment.
    #[doc(hidden)]
    pub fn segment_count(nodes: &[Self]) -> usize {
        1 + nodes.windows(3).filter(|triple| !Self::are_flat(triple)).count()
    }

    /// Whether the displacements of the nodes are linear in their coordinates, for any degrees of freedom.
    ///
    /// This holds for a rigid base, and for any flat, uniformly strained one. Nodes in the plane may have any heights.
    #[doc(hidden)]
    pub fn are_flat(nodes: &[Self]) -> bool {
        let Some(first_corner) = nodes.first() else { return true };
        let is_in_space = nodes.iter().any(|node| node.y != 0.0);
        let offsets: Vec<[f64; 2]> =
            nodes.iter().map(|node| node.offset_from(first_corner, is_in_space)).collect();
        let distances = offsets.iter().map(|offset| offset[0].hypot(offset[1]));
        let LargestValue { value: length, index: second } = largest_value(distances);
        if length == 0.0 {
            return nodes.iter().all(|node| node.rows() == first_corner.rows());
        }
        let axis = offsets[second].map(|x| x / length);
        let LargestValue { value: width, index: third } =
            largest_value(offsets.iter().map(|offset| cross_in_plane(axis, *offset).abs()));
        let is_line = width <= FLATNESS_TOLERANCE * length;
        let corners = [first_corner, &nodes[second], &nodes[third]];
        nodes.iter().zip(&offsets).all(|(node, offset)| {
            let third_offset = offsets[third];
            let third_weight = if is_line {
                0.0
            } else {
                cross_in_plane(axis, *offset) / cross_in_plane(axis, third_offset)
            };
            let x = offset[0] - third_weight * third_offset[0];
            let y = offset[1] - third_weight * third_offset[1];
            let second_weight = (axis[0] * x + axis[1] * y) / length;
            let first_weight = 1.0 - second_weight - third_weight;
            node.is_interpolated(corners, [first_weight, second_weight, third_weight])
        })
    }

    /// Position relative to `origin`, m: x and y in space, x and z in the plane.
    fn offset_from(&self, origin: &Self, is_in_space: bool) -> [f64; 2] {
        let second_offset = if is_in_space { self.y - origin.y } else { self.z - origin.z };
        [self.x - origin.x, second_offset]
    }

    /// Whether the weighted sum of three corners' displacements equals the node's, up to rounding.
    fn is_interpolated(&self, corners: [&Self; 3], weights: [f64; 3]) -> bool {
        self.rows().into_iter().enumerate().all(|(direction, row)| {
            let mut residual = row.clone();
            let mut max_weight = largest_weight(row);
            for (corner, weight) in corners.into_iter().zip(weights) {
                if weight != 0.0 {
                    residual -= weight * corner.rows()[direction].clone();
                }
                max_weight = max_weight.max(largest_weight(corner.rows()[direction]));
            }
            largest_weight(&residual) <= FLATNESS_TOLERANCE * max_weight
        })
    }

    /// Coordinates `[x, y]`, m.
    #[doc(hidden)]
    pub fn place(&self) -> [f64; 2] {
        [self.x, self.y]
    }

    /// Displacements to the right, upwards and away.
    ///
    /// The last one is empty for a node in the plane.
    #[doc(hidden)]
    pub fn rows(&self) -> [&DofCombination; 3] {
        [&self.horizontal, &self.vertical, &self.across]
    }

    /// Converts the point's displacements to other degrees of freedom.
    #[doc(hidden)]
    pub fn map_rows(&mut self, map: impl Fn(&DofCombination) -> DofCombination) {
        for row in [&mut self.horizontal, &mut self.across, &mut self.vertical] {
            *row = map(row);
        }
    }

    /// Number of directions in which the node moves: two in the plane.
    #[doc(hidden)]
    pub fn direction_count(&self) -> usize {
        if self.across.is_empty() { COMPONENTS_IN_PLANE } else { COMPONENTS_IN_SPACE }
    }

    /// Degrees of freedom on which the displacements of the node depend.
    #[doc(hidden)]
    pub fn dofs(&self) -> impl Iterator<Item = usize> {
        let terms = self.rows().into_iter().flatten();
        terms.filter(|(_, weight)| *weight != 0.0).map(|(dof, _)| *dof)
    }

    /// Returns an error for an invalid coordinate, weight or degree of freedom.
    ///
    /// Coordinates and weights must be finite, and degrees of freedom below `dof_count`.
    pub(super) fn check(&self, dof_count: usize) -> Result<()> {
        for coordinate in [self.x, self.y, self.z] {
            finite("coordinate of a contact node", coordinate)?;
        }
        for &(dof, weight) in self.rows().into_iter().flatten() {
            finite("weight of a contact node", weight)?;
            in_bounds("degree of freedom of a contact node", dof, dof_count)?;
        }
        Ok(())
    }
}

/// Largest positive value and its index, the first one of equal values.
///
/// Both are zero without a positive value.
fn largest_value(values: impl Iterator<Item = f64>) -> LargestValue {
    let mut largest_value = LargestValue { value: 0.0, index: 0 };
    for (index, value) in values.enumerate() {
        if value > largest_value.value {
            largest_value = LargestValue { value, index };
        }
    }
    largest_value
}

/// Largest of several values, and its index.
struct LargestValue {
    value: f64,
    index: usize,
}

/// Largest magnitude of a weight.
fn largest_weight(row: &DofCombination) -> f64 {
    row.iter().fold(0.0_f64, |max, (_, weight)| max.max(weight.abs()))
}

/// Returns an error unless a contact node lies to the right of the previous one.
///
/// The nodes are at `x` and at `previous_x`.
///
/// # Errors
/// [`Error::Input`](crate::Error::Input).
pub fn check_left_to_right(previous_x: f64, x: f64) -> Result<()> {
    let needed = "to the right of the previous node: contact nodes are listed from left to right";
    require("coordinate of a contact node", x, x > previous_x, needed).map(drop)
}

/// Returns an error for a foundation in the plane with fewer than two contact nodes.
///
/// # Errors
/// [`Error::Size`](crate::Error::Size).
pub fn check_line(nodes: &[BaseNode]) -> Result<()> {
    at_least("list of contact nodes of a foundation", nodes.len(), 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rigid base is flat in the plane and in space, also far from the origin. A node with its own degrees of freedom
    /// divides it into segments.
    #[test]
    fn only_nodes_that_can_leave_the_flat_base_divide_it() {
        for center in [0.0, 4500.0] {
            let mut nodes: Vec<_> = [-3.0, -1.0, 0.5, 2.0, 3.0]
                .map(|x| BaseNode::rigid(center + x, center, [0, 1, 2]))
                .into();
            assert!(BaseNode::are_flat(&nodes));
            assert_eq!(BaseNode::segment_count(&nodes), 1);
            nodes[2].vertical = 7.into();
            assert!(!BaseNode::are_flat(&nodes));
            assert_eq!(BaseNode::segment_count(&nodes), 4);
            let dofs = [0, 1, 2, 3, 4, 5];
            let corner = |[x, y]: [f64; 2]| {
                BaseNode::rigid_in_plan([center + x, y - center], [center, -center], dofs)
            };
            let mut face: Vec<_> =
                [[0.0, 0.0], [4.0, 1.0], [5.0, 4.0], [1.0, 3.0], [0.0, 0.0]].map(corner).into();
            assert!(BaseNode::are_flat(&face));
            face[3].vertical = 7.into();
            assert!(!BaseNode::are_flat(&face));
        }
        // A node between free ends that moves with them does not divide the base; free ends alone are one segment.
        let left_end = BaseNode::free(0.0, 0, 1);
        let right_end = BaseNode::free(4.0, 2, 3);
        let mut middle = BaseNode::free(1.0, 0, 1);
        middle.vertical = [(1, 0.75), (3, 0.25)].into();
        middle.horizontal = [(0, 0.75), (2, 0.25)].into();
        let nodes = [left_end, middle, right_end];
        assert_eq!(BaseNode::segment_count(&nodes), 1);
        assert_eq!(BaseNode::segment_count(&nodes[..1]), 1);
    }
}
