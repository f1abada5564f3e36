//! Shape of a foundation.
//!
//! It consists of an outline with outward edges, and of lever arms about the centre.

use std::f64::consts::TAU;
use std::ops::Range;

use super::{Patch, enclosing_interval, middle, span};

/// Number of corners of the polygon that replaces a circle.
///
/// More corners would only lengthen lists of edges.
const CIRCLE_CORNER_COUNT: usize = 32;

/// Corners of a regular polygon that replaces a circle about the origin.
///
/// The polygon has the area of a circle of this `radius`.
pub fn circle(radius: f64) -> impl Iterator<Item = [f64; 2]> {
    let sector_angle = TAU / CIRCLE_CORNER_COUNT as f64;
    let corner_radius = radius * (sector_angle / sector_angle.sin()).sqrt();
    (0..CIRCLE_CORNER_COUNT).map(move |k| {
        let corner_angle = (k as f64 + 0.5) * sector_angle;
        let sin = corner_angle.sin();
        let cos = corner_angle.cos();
        [corner_radius * cos, corner_radius * sin]
    })
}

/// Smallest ratio of an edge's normal components that counts as one: equal components differ by rounding.
const EQUAL_COMPONENT_RATIO: f64 = 1.0 - 1e-9;

/// Edge of a polygon whose corners go counter-clockwise.
#[derive(Debug)]
pub struct Edge {
    /// Corner at which the edge begins.
    start: [f64; 2],
    /// Outward normal, with the length of the edge.
    pub normal: [f64; 2],
}

impl Edge {
    /// Edges of the polygon with these corners; the last edge ends at the first corner.
    pub fn all(corners: &[[f64; 2]]) -> impl Iterator<Item = Self> {
        let edges = corners.iter().zip(corners.iter().cycle().skip(1));
        edges.map(|(&start, end)| Self { start, normal: [end[1] - start[1], start[0] - end[0]] })
    }

    /// Edges of a base: of its outline, or its two ends along x without an outline.
    pub fn of_base(outline: &[[f64; 2]], [left, right]: [f64; 2]) -> Vec<Self> {
        if outline.is_empty() {
            return vec![
                Self { start: [left, 0.0], normal: [-1.0, 0.0] },
                Self { start: [right, 0.0], normal: [1.0, 0.0] },
            ];
        }
        Self::all(outline).collect()
    }

    /// Component of a vector along the outward normal, times the length of the edge.
    pub fn outward(&self, vector: [f64; 2]) -> f64 {
        self.normal[0] * vector[0] + self.normal[1] * vector[1]
    }

    /// Distance of the edge from a point inside the polygon, times the length of the edge.
    pub fn reach(&self, point: [f64; 2]) -> f64 {
        self.outward([0, 1].map(|axis| self.start[axis] - point[axis]))
    }

    /// Whether the normal has its larger component, or two equal ones, along `axis`.
    fn faces_along(&self, axis: usize) -> bool {
        self.normal[axis].abs() >= EQUAL_COMPONENT_RATIO * self.normal[1 - axis].abs()
    }
}

/// Lever arms of a foundation about its centre.
///
/// The centre is the middle of its elements, in plan the middle of its outline.
#[derive(Debug)]
pub struct Footing {
    /// Left and right end, front and back end, m; in the plane both ends along y are zero.
    pub ends: [[f64; 2]; 2],
    /// Centre of the foundation relative to the point of the base moment, m.
    pub center: [f64; 2],
    /// Middle of each element relative to the foundation's centre, m.
    ///
    /// Heights are relative to the floor of the foundation.
    pub arms: Vec<[f64; 3]>,
    /// Sign of base moment and rotation relative to the right-hand rule about y.
    ///
    /// −1 in the plane, where both are positive counter-clockwise; 1 in plan.
    pub rotation_sign: f64,
    /// Edges that face along x, and edges that face along y.
    ///
    /// Each has its [reach](Edge::reach) from the centre.
    pub edges: [Vec<(Edge, f64)>; 2],
}

impl Footing {
    /// Footing of these elements of a patch.
    ///
    /// `outline`: corners of the convex outline, counter-clockwise; empty in the plane. `origin`: reference point of
    /// the base moment.
    pub fn new(
        patch: &Patch,
        elements: Range<usize>,
        outline: &[[f64; 2]],
        origin: [f64; 2],
    ) -> Self {
        let ends = if outline.is_empty() {
            let intervals = patch[elements.clone()].iter().map(|element| element.ends()[0]);
            [enclosing_interval(intervals), [0.0; 2]]
        } else {
            [0, 1].map(|axis| span(outline.iter().map(|corner| corner[axis])))
        };
        let center = ends.map(middle);
        let mut edges = [vec![], vec![]];
        for (axis, axis_edges) in edges.iter_mut().enumerate() {
            for edge in Edge::of_base(outline, ends[0]) {
                if edge.faces_along(axis) {
                    let reach = edge.reach(center);
                    axis_edges.push((edge, reach));
                }
            }
        }
        let floor_height = patch[patch.floor().start].center()[2];
        let mut arms = Vec::with_capacity(elements.len());
        for element in &patch[elements] {
            let position = element.center();
            arms.push([
                position[0] - center[0],
                position[1] - center[1],
                position[2] - floor_height,
            ]);
        }
        Self {
            ends,
            center: [0, 1].map(|axis| center[axis] - origin[axis]),
            arms,
            rotation_sign: patch.layout().rotation_sign(),
            edges,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle with sides of 3, 4 and 5.
    ///
    /// Its inscribed circle has the radius 1 about (1, 1).
    #[test]
    fn edges_by_hand() {
        let edges: Vec<Edge> = Edge::all(&[[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]).collect();
        let normals: Vec<_> = edges.iter().map(|edge| edge.normal).collect();
        assert_eq!(normals, [[0.0, -4.0], [3.0, 4.0], [-3.0, 0.0]]);
        let reaches: Vec<_> = edges.iter().map(|edge| edge.reach([1.0; 2])).collect();
        assert_eq!(reaches, [4.0, 5.0, 3.0]);
        let outward: Vec<_> = edges.iter().map(|edge| edge.outward([2.0, 1.0])).collect();
        assert_eq!(outward, [-4.0, 10.0, -6.0]);
    }
}
