//! Convex set of forces that a hinge can carry, and its closest points.

/// Distance by which rounding may put a point of the boundary outside, relative to the size of the set.
pub(super) const BOUNDARY_ROUNDING: f64 = 1e-14;

/// A convex set with zero inside, in P coordinates of equal unit.
pub(super) trait ConvexSet<const P: usize> {
    /// Closest point of the set to `trial`; `None` for a point inside.
    fn closest_point(&self, trial: &[f64; P]) -> Option<ClosestPoint<P>>;
}

/// Closest point of a convex set to a point outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ClosestPoint<const P: usize> {
    pub(super) point: [f64; P],
    /// Derivative of the closest point with respect to the point outside, symmetric.
    pub(super) derivative: [[f64; P]; P],
}

/// Derivative of the closest point of a curve with this unit tangent.
///
/// `distance_ratio`: distance of the point outside, divided by the radius of curvature.
pub(super) fn curve_derivative(tangent: [f64; 2], distance_ratio: f64) -> [[f64; 2]; 2] {
    tangent.map(|a| tangent.map(|b| a * b / (1.0 + distance_ratio)))
}
