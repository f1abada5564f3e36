//! Convex polygon about zero.

use super::convex_set::{BOUNDARY_ROUNDING, ClosestPoint, ConvexSet, curve_derivative};
use crate::geometry::cross_in_plane;

/// Convex polygon with its corners counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Polygon {
    pub(super) corners: Vec<[f64; 2]>,
}

impl Polygon {
    /// Both ends of each side.
    pub(super) fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        let next_corners = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next_corners).map(|(start, end)| [*start, *end])
    }
}

impl ConvexSet<2> for Polygon {
    fn closest_point(&self, trial: &[f64; 2]) -> Option<ClosestPoint<2>> {
        let size = self.corners.as_flattened().iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        let is_outside = self.sides().any(|[start, end]| {
            let along = difference(end, start);
            cross_in_plane(along, difference(*trial, start))
                < -BOUNDARY_ROUNDING * size * along[0].hypot(along[1])
        });
        if !is_outside {
            return None;
        }
        let mut min_distance = f64::INFINITY;
        let mut closest = ClosestPoint { point: [0.0; 2], derivative: [[0.0; 2]; 2] };
        for [start, end] in self.sides() {
            let along = difference(end, start);
            let length = along[0].hypot(along[1]);
            let tangent = along.map(|component| component / length);
            let from_start = difference(*trial, start);
            let position = from_start[0] * tangent[0] + from_start[1] * tangent[1];
            let candidate = if position <= 0.0 {
                ClosestPoint { point: start, derivative: [[0.0; 2]; 2] }
            } else if position >= length {
                ClosestPoint { point: end, derivative: [[0.0; 2]; 2] }
            } else {
                let point = [0, 1].map(|i| start[i] + position * tangent[i]);
                ClosestPoint { point, derivative: curve_derivative(tangent, 0.0) }
            };
            let outside = difference(*trial, candidate.point);
            let distance = outside[0].hypot(outside[1]);
            if distance < min_distance {
                min_distance = distance;
                closest = candidate;
            }
        }
        Some(closest)
    }
}

pub(super) fn difference(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
