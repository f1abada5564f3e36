//! Points of a structure's base: nodes of a line in the plane, corners of faces in plan.

use super::DofCombination;
use crate::error::{Result, at_least, finite, in_bounds, require};
use crate::geometry::{COMPONENTS_IN_PLANE, COMPONENTS_IN_SPACE, span};

/// Relative difference of displacements, of heights, and of a distance from a line, that counts as rounding.
const FLAT: f64 = 1e-9;

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
        let (horizontal, vertical) = (horizontal.into(), vertical.into());
        Self { x, horizontal, vertical, ..Self::default() }
    }

    /// A point of a rigid flat base in the plane.
    ///
    /// `dofs`: `[horizontal, vertical, rotation]` at `center`.
    pub fn rigid(x: f64, center: f64, dofs: [usize; 3]) -> Self {
        let [horizontal, vertical, rotation] = dofs;
        let vertical = [(vertical, 1.0), (rotation, x - center)].into();
        Self { x, horizontal: horizontal.into(), vertical, ..Self::default() }
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
        let [horizontal, across, vertical] = [along, across, up].map(DofCombination::from);
        Self { x, y, z: 0.0, horizontal, across, vertical }
    }

    /// A point `[x, y]` (m) of a rigid flat base in plan.
    ///
    /// `dofs` at `center`: displacements along x, along y and up, and rotations about the same axes by the
    /// right-hand rule.
    pub fn rigid_in_plan([x, y]: [f64; 2], center: [f64; 2], dofs: [usize; 6]) -> Self {
        let [along, across, up, about_x, about_y, about_z] = dofs;
        let [dx, dy] = [x - center[0], y - center[1]];
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
    pub(crate) fn mean_rotations(nodes: &[Self]) -> [DofCombination; 3] {
        let count = nodes.len() as f64;
        let mean = |of: &dyn Fn(&Self) -> f64| nodes.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(&|node| node.x), mean(&|node| node.y));
        let product = |one: fn([f64; 2]) -> f64| mean(&|node| one([node.x - x, node.y - y]));
        let (xx, xy, yy) =
            (product(|d| d[0] * d[0]), product(|d| d[0] * d[1]), product(|d| d[1] * d[1]));
        let (scale, polar) = (count * (xx * yy - xy * xy), count * (xx + yy));
        let mut rotations: [DofCombination; 3] = Default::default();
        for node in nodes {
            let [dx, dy] = [node.x - x, node.y - y];
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
    pub(crate) fn carried(nodes: &[Self], [x, y]: [f64; 2], height: f64) -> [DofCombination; 3] {
        let share = 1.0 / nodes.len() as f64;
        let mut mean: [DofCombination; 3] = Default::default();
        let mut middle = [0.0; 2];
        for node in nodes {
            middle[0] += share * node.x;
            middle[1] += share * node.y;
            for (sum, row) in mean.iter_mut().zip([&node.horizontal, &node.across, &node.vertical])
            {
                *sum += share * row.clone();
            }
        }
        let [to_the_right, away, turn] = Self::mean_rotations(nodes);
        let ([dx, dy], [along, across, up]) = ([x - middle[0], y - middle[1]], mean);
        [
            along - height * to_the_right.clone() - dy * turn.clone(),
            across - height * away.clone() + dx * turn,
            up + dx * to_the_right + dy * away,
        ]
    }

    /// Nodes at the lowest height, of a list along an outline: the base between the walls.
    ///
    /// All nodes, if only one is the lowest: a base without walls.
    pub(crate) fn floor(nodes: &[Self]) -> &[Self] {
        let [lowest, highest] = span(nodes.iter().map(|node| node.z));
        let limit = lowest + FLAT * (highest - lowest);
        let is_low = |node: &Self| node.z <= limit;
        match [nodes.iter().position(is_low), nodes.iter().rposition(is_low)] {
            [Some(first), Some(last)] if first < last => &nodes[first..=last],
            _ => nodes,
        }
    }

    /// Number of straight segments of a base in the plane.
    ///
    /// A node that cannot leave the line between its neighbours does not begin a new segment.
    pub(crate) fn segments(nodes: &[Self]) -> usize {
        1 + nodes.windows(3).filter(|three| !Self::are_flat(three)).count()
    }

    /// Whether the nodes stay a flat, uniformly strained body for any degrees of freedom.
    ///
    /// Their displacements are then linear in the coordinates, as on any rigid base. Nodes in the plane may have any
    /// heights.
    pub(crate) fn are_flat(nodes: &[Self]) -> bool {
        let Some(first) = nodes.first() else { return true };
        let in_plan = nodes.iter().any(|node| node.y != 0.0);
        let second = |node: &Self| if in_plan { node.y } else { node.z };
        let from = |node: &Self| [node.x - first.x, second(node) - second(first)];
        let farthest = |distance: &dyn Fn([f64; 2]) -> f64| {
            let far = nodes.iter().map(|node| (distance(from(node)), node));
            far.fold((0.0, first), |most, own| if own.0 > most.0 { own } else { most })
        };
        let (length, second) = farthest(&|[x, y]| x.hypot(y));
        if length == 0.0 {
            return nodes.iter().all(|node| node.rows() == first.rows());
        }
        let axis = from(second).map(|x| x / length);
        let aside = |[x, y]: [f64; 2]| axis[0] * y - axis[1] * x;
        let (width, third) = farthest(&|place| aside(place).abs());
        let is_line = width <= FLAT * length;
        nodes.iter().all(|node| {
            let place = from(node);
            let off = if is_line { 0.0 } else { aside(place) / aside(from(third)) };
            let [x, y] = [0, 1].map(|k| place[k] - off * from(third)[k]);
            let along = (axis[0] * x + axis[1] * y) / length;
            let weighted = [(first, 1.0 - along - off), (second, along), (third, off)];
            node.rows().into_iter().enumerate().all(|(k, row)| {
                let mut rest = row.clone();
                for (own, weight) in weighted.into_iter().filter(|(_, weight)| *weight != 0.0) {
                    rest -= weight * own.rows()[k].clone();
                }
                let largest = |row: &DofCombination| {
                    row.iter().fold(0.0_f64, |most, (_, weight)| most.max(weight.abs()))
                };
                let scale = [row, first.rows()[k], second.rows()[k], third.rows()[k]];
                largest(&rest) <= FLAT * scale.into_iter().map(largest).fold(0.0, f64::max)
            })
        })
    }

    /// Coordinates `[x, y]`, m.
    pub(crate) fn place(&self) -> [f64; 2] {
        [self.x, self.y]
    }

    /// Displacements to the right, upwards and away; the last is empty for a node of the plane.
    pub(crate) fn rows(&self) -> [&DofCombination; 3] {
        [&self.horizontal, &self.vertical, &self.across]
    }

    /// Maps the point's displacements to other degrees of freedom.
    pub(crate) fn map_rows(&mut self, map: impl Fn(&DofCombination) -> DofCombination) {
        for row in [&mut self.horizontal, &mut self.across, &mut self.vertical] {
            *row = map(row);
        }
    }

    /// Number of directions in which the node moves: two in the plane.
    pub(crate) fn directions(&self) -> usize {
        if self.across.is_empty() { COMPONENTS_IN_PLANE } else { COMPONENTS_IN_SPACE }
    }

    /// The degrees of freedom that move the node.
    pub(crate) fn dofs(&self) -> impl Iterator<Item = usize> {
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

/// Error unless a contact node at `x` lies to the right of the node before it, at `before`.
pub(crate) fn from_the_left(before: f64, x: f64) -> Result<()> {
    let needed = "to the right of the node before it: contact nodes are listed from left to right";
    require("coordinate of a contact node", x, x > before, needed).map(drop)
}

/// Error for a foundation in the plane of fewer than two contact nodes.
pub(crate) fn check_line(nodes: &[BaseNode]) -> Result<()> {
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
            let rigid = |x: f64| BaseNode::rigid(far + x, far, [0, 1, 2]);
            let mut nodes: Vec<_> = [-3.0, -1.0, 0.5, 2.0, 3.0].map(rigid).into();
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
        let [left, right] = [BaseNode::free(0.0, 0, 1), BaseNode::free(4.0, 2, 3)];
        let mut between = BaseNode::free(1.0, 0, 1);
        between.vertical = [(1, 0.75), (3, 0.25)].into();
        between.horizontal = [(0, 0.75), (2, 0.25)].into();
        let nodes = [left, between, right];
        assert_eq!(BaseNode::segments(&nodes), 1);
        assert_eq!(BaseNode::segments(&nodes[..1]), 1);
    }
}
