//! Weights of the corners of a face in the displacement of a point.

use crate::bem::plan::faces::side;
use crate::geometry::cross_in_plane;

/// Largest number of Newton steps to the coordinates of a point in a quadrilateral.
///
/// A point with a solution needs fewer than ten.
const MAX_NEWTON_ITERATIONS: usize = 50;
/// Newton step at which the iteration ends, relative to the coordinates: near rounding.
const NEWTON_STEP_TOLERANCE: f64 = 1e-14;
/// Point `[x, y]`, m.
pub(crate) type Point = [f64; 2];

/// Weights of the corners in the displacement of a point.
///
/// The displacement is linear over a triangle, bilinear over a quadrilateral, and continued beyond the face. A bilinear
/// displacement may have no continuation. The displacement and the slopes at the nearest point of the face are then
/// continued linearly. At a corner of 180° the displacement of the largest triangle is continued. On a rigid base all of
/// these displacements are equal.
pub(crate) fn corner_weights(corners: &[Point], p: Point) -> Vec<f64> {
    let [a, b, c, d] = *corners else {
        return triangle_weights([corners[0], corners[1], corners[2]], p).into();
    };
    // Coordinates of a site are far larger than a face. Differences from a corner limit the rounding.
    let from_corner = |q: Point| [q[0] - a[0], q[1] - a[1]];
    let face = Quadrilateral([from_corner(b), from_corner(c), from_corner(d)]);
    if let Some(coordinates) = face.coordinates(from_corner(p)) {
        return bilinear_weights(coordinates).into();
    }
    let nearest_point = from_corner(nearest_within(corners, p));
    if let Some(weights) = face.continued_weights(nearest_point, from_corner(p)) {
        return weights.into();
    }
    let triangles = [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]];
    let area = |[i, j, k]: &[usize; 3]| side([corners[*i], corners[*j]], corners[*k]).abs();
    let largest_triangle = triangles.into_iter().max_by(|a, b| area(a).total_cmp(&area(b)));
    let triangle = largest_triangle.unwrap_or([0, 1, 2]);
    let mut weights = vec![0.0; 4];
    for (corner, weight) in
        triangle.into_iter().zip(triangle_weights(triangle.map(|k| corners[k]), p))
    {
        weights[corner] = weight;
    }
    weights
}

/// Barycentric coordinates of a point: weights of the corners of a triangle.
fn triangle_weights([a, b, c]: [Point; 3], p: Point) -> [f64; 3] {
    let area = side([a, b], c);
    let weight_a = side([b, c], p) / area;
    let weight_b = side([c, a], p) / area;
    [weight_a, weight_b, 1.0 - weight_a - weight_b]
}

/// Weights of the corners of a quadrilateral at coordinates s, t.
///
/// Inside, both coordinates are from 0 to 1.
pub(crate) fn bilinear_weights([s, t]: [f64; 2]) -> [f64; 4] {
    [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t]
}

/// Quadrilateral with its first corner at the origin, from its other three corners.
struct Quadrilateral([Point; 3]);

impl Quadrilateral {
    /// Weighted sum of coordinate `k` of the corners.
    fn weighted_sum(&self, weights: [f64; 4], k: usize) -> f64 {
        let corners = &self.0;
        weights[1] * corners[0][k] + weights[2] * corners[1][k] + weights[3] * corners[2][k]
    }

    /// Newton step from the coordinates `[s, t]` towards a point.
    ///
    /// `None` for a singular Jacobian.
    fn newton_step(&self, [s, t]: [f64; 2], p: Point) -> Option<[f64; 2]> {
        let weights = bilinear_weights([s, t]);
        let residual = [0, 1].map(|k| p[k] - self.weighted_sum(weights, k));
        let [s_derivatives, t_derivatives] = weight_derivatives([s, t]);
        let s_tangent = [0, 1].map(|k| self.weighted_sum(s_derivatives, k));
        let t_tangent = [0, 1].map(|k| self.weighted_sum(t_derivatives, k));
        let determinant = s_tangent[0] * t_tangent[1] - s_tangent[1] * t_tangent[0];
        let ds = (residual[0] * t_tangent[1] - residual[1] * t_tangent[0]) / determinant;
        let dt = (s_tangent[0] * residual[1] - s_tangent[1] * residual[0]) / determinant;
        (ds.is_finite() && dt.is_finite()).then_some([ds, dt])
    }

    /// Coordinates of a point, by Newton's method from the middle; `None` without convergence.
    fn coordinates(&self, p: Point) -> Option<[f64; 2]> {
        let mut s = 0.5_f64;
        let mut t = 0.5_f64;
        for _ in 0..MAX_NEWTON_ITERATIONS {
            let step = self.newton_step([s, t], p)?;
            s += step[0];
            t += step[1];
            if step[0].abs().max(step[1].abs())
                <= NEWTON_STEP_TOLERANCE * s.abs().max(t.abs()).max(1.0)
            {
                return Some([s, t]);
            }
        }
        None
    }

    /// Weights at a point `p` outside, continued linearly from the nearest point of the quadrilateral.
    fn continued_weights(&self, nearest_point: Point, p: Point) -> Option<[f64; 4]> {
        let coordinates = self.coordinates_within(nearest_point)?;
        let step = self.newton_step(coordinates, p)?;
        let [s_derivatives, t_derivatives] = weight_derivatives(coordinates);
        let weights = bilinear_weights(coordinates);
        Some(
            [0, 1, 2, 3]
                .map(|k| weights[k] + step[0] * s_derivatives[k] + step[1] * t_derivatives[k]),
        )
    }

    /// Coordinates of a point inside the quadrilateral, by the quadratic equation for t.
    fn coordinates_within(&self, p: Point) -> Option<[f64; 2]> {
        let [b, c, d] = self.0;
        let twist = [0, 1].map(|k| c[k] - b[k] - d[k]);
        // Coefficients of t², t and 1.
        let quadratic = -cross_in_plane(d, twist);
        let linear = cross_in_plane(p, twist) - cross_in_plane(d, b);
        let constant = cross_in_plane(p, b);
        let root = linear.mul_add(linear, -4.0 * quadratic * constant).max(0.0).sqrt();
        // The two roots are q/quadratic and constant/q, without cancellation (Press et al. 2007, § 5.6).
        let q = -0.5 * (linear + root.copysign(linear));
        let candidates =
            [q / quadratic, constant / q].into_iter().filter(|t| t.is_finite()).map(|t| {
                let s_tangent = [0, 1].map(|k| b[k] + t * twist[k]);
                let squared_length = s_tangent[0] * s_tangent[0] + s_tangent[1] * s_tangent[1];
                let s = ((p[0] - t * d[0]) * s_tangent[0] + (p[1] - t * d[1]) * s_tangent[1])
                    / squared_length;
                [s, t]
            });
        let distance_from_middle =
            |[s, t]: &[f64; 2]| [s, t].into_iter().map(|x| (x - 0.5).abs()).fold(0.0, f64::max);
        let coordinates = candidates
            .min_by(|a, b| distance_from_middle(a).total_cmp(&distance_from_middle(b)))?;
        let is_finite = coordinates.iter().all(|x| x.is_finite());
        is_finite.then(|| coordinates.map(|x| x.clamp(0.0, 1.0)))
    }
}

/// Derivatives of [`bilinear_weights`] with respect to s and to t.
fn weight_derivatives([s, t]: [f64; 2]) -> [[f64; 4]; 2] {
    [[t - 1.0, 1.0 - t, t, -t], [s - 1.0, -s, s, 1.0 - s]]
}

/// Distance of two points, m.
pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Distance of a point from a convex polygon, m; zero inside.
pub(crate) fn distance_outside(corners: &[Point], p: Point) -> f64 {
    distance(p, nearest_within(corners, p))
}

/// The point of a convex polygon nearest to `p`.
fn nearest_within(corners: &[Point], p: Point) -> Point {
    let edges = (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]);
    let mut areas = edges.clone().map(|edge| side(edge, p));
    if areas.clone().all(|area| area >= 0.0) || areas.all(|area| area <= 0.0) {
        return p;
    }
    let mut nearest_point = [f64::INFINITY; 2];
    for edge in edges {
        let point = nearest_on_edge(edge, p);
        if distance(p, point) < distance(p, nearest_point) {
            nearest_point = point;
        }
    }
    nearest_point
}

/// The point of an edge nearest to `p`.
fn nearest_on_edge([a, b]: [Point; 2], p: Point) -> Point {
    let edge = [b[0] - a[0], b[1] - a[1]];
    let squared_length = edge[0] * edge[0] + edge[1] * edge[1];
    let projection = ((p[0] - a[0]) * edge[0] + (p[1] - a[1]) * edge[1]) / squared_length;
    let fraction = projection.clamp(0.0, 1.0);
    [a[0] + fraction * edge[0], a[1] + fraction * edge[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear displacements are exact on convex quadrilaterals of all shapes, inside and outside.
    ///
    /// Outside, bilinear displacements often have no continuation. The faces are near the origin and at coordinates of a
    /// site.
    #[test]
    fn linear_displacements_are_exact_on_all_convex_faces() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut face_count = 0;
        let mut continuation_count = 0;
        while face_count < 2000 {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            let corners = corners.map(|[x, y]| [x + random() - 0.5, y + random() - 0.5]);
            let corner_turns =
                (0..4).map(|k| side([corners[k], corners[(k + 1) % 4]], corners[(k + 2) % 4]));
            if corner_turns.fold(f64::INFINITY, f64::min) < 1e-3 {
                continue;
            }
            face_count += 1;
            for origin in [[0.0, 0.0], [128.0, -64.0], [4500.0, 3150.0]] {
                let face = corners.map(|[x, y]| [x + origin[0], y + origin[1]]);
                let point = [origin[0] + 1.6 * random() - 0.3, origin[1] + 1.6 * random() - 0.3];
                let local_corners = [0, 1].map(|k| face.map(|corner| corner[k] - face[0][k]));
                let quadrilateral =
                    Quadrilateral([1, 2, 3].map(|k| [local_corners[0][k], local_corners[1][k]]));
                let local_point = [0, 1].map(|k| point[k] - face[0][k]);
                continuation_count += usize::from(quadrilateral.coordinates(local_point).is_none());
                let weights = corner_weights(&face, point);
                let sum: f64 = weights.iter().sum();
                assert!((sum - 1.0).abs() < 1e-9, "{face:?} {point:?} {weights:?}");
                for k in 0..2 {
                    let sum: f64 =
                        weights.iter().zip(local_corners[k]).map(|(weight, x)| weight * x).sum();
                    assert!((sum - local_point[k]).abs() < 1e-9, "{face:?} {point:?} {weights:?}");
                }
            }
        }
        assert!(continuation_count > 20, "{continuation_count}");
    }

    /// Inside, both methods give the same coordinates.
    #[test]
    fn coordinates_within_are_the_bilinear_ones() {
        let face = Quadrilateral([[4.0, -1.0], [5.0, 4.0], [1.0, 3.0]]);
        for expected in [[0.0, 0.0], [0.25, 0.75], [1.0, 0.5], [0.9, 0.1], [1.0, 1.0]] {
            let point = [0, 1].map(|k| face.weighted_sum(bilinear_weights(expected), k));
            for computed in [face.coordinates(point), face.coordinates_within(point)] {
                let computed = computed.unwrap();
                assert!((0..2).all(|k| (computed[k] - expected[k]).abs() < 1e-13), "{computed:?}");
            }
        }
    }
}
