//! Weights of the corners of a face in the displacement of a point.

use crate::bem::plan::faces::side;

/// Largest number of Newton steps to the coordinates of a point in a quadrilateral; final step, relative to its
/// size.
const MAX_NEWTON_ITERATIONS: usize = 50;
const NEWTON_STEP_TOLERANCE: f64 = 1e-14;
pub(crate) type Point = [f64; 2];

/// Weights of the corners in the displacement of a point.
///
/// Linear over a triangle, bilinear over a quadrilateral, and continued beyond. If the bilinear displacement has
/// no continuation, the displacement of the nearest point within is continued by its slopes there; at a corner
/// without an angle, the displacement of the largest triangle is continued. On a rigid base all of these are
/// equal.
pub(crate) fn corner_weights(corners: &[Point], p: Point) -> Vec<f64> {
    let [a, b, c, d] = *corners else {
        return in_triangle([corners[0], corners[1], corners[2]], p).into();
    };
    // Relative to a corner, since coordinates of a site are far larger than a face.
    let from = |q: Point| [q[0] - a[0], q[1] - a[1]];
    let face = Quadrilateral([from(b), from(c), from(d)]);
    if let Some(place) = face.coordinates(from(p)) {
        return bilinear(place).into();
    }
    if let Some(corner_weights) = face.continued(from(nearest_within(corners, p)), from(p)) {
        return corner_weights.into();
    }
    let triangles = [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]];
    let area = |[i, j, k]: &[usize; 3]| side([corners[*i], corners[*j]], corners[*k]).abs();
    let largest = triangles.into_iter().max_by(|one, other| area(one).total_cmp(&area(other)));
    let places = largest.unwrap_or([0, 1, 2]);
    let mut all = vec![0.0; 4];
    for (place, weight) in places.into_iter().zip(in_triangle(places.map(|k| corners[k]), p)) {
        all[place] = weight;
    }
    all
}

fn in_triangle([a, b, c]: [Point; 3], p: Point) -> [f64; 3] {
    let area = side([a, b], c);
    let first = side([b, c], p) / area;
    let second = side([c, a], p) / area;
    [first, second, 1.0 - first - second]
}

/// Weights of the corners of a quadrilateral at coordinates s, t, which are from 0 to 1 within.
pub(crate) fn bilinear([s, t]: Point) -> [f64; 4] {
    [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t]
}

/// Quadrilateral by its last three corners; the first is the origin.
struct Quadrilateral([Point; 3]);

impl Quadrilateral {
    fn blend(&self, weights: [f64; 4], k: usize) -> f64 {
        let corners = &self.0;
        weights[1] * corners[0][k] + weights[2] * corners[1][k] + weights[3] * corners[2][k]
    }

    /// Newton's step from the coordinates `[s, t]` to a point.
    fn step(&self, [s, t]: Point, p: Point) -> Option<Point> {
        let weights = bilinear([s, t]);
        let rest = [0, 1].map(|k| p[k] - self.blend(weights, k));
        let slopes = slopes([s, t]);
        let by_s = [0, 1].map(|k| self.blend(slopes[0], k));
        let by_t = [0, 1].map(|k| self.blend(slopes[1], k));
        let determinant = by_s[0] * by_t[1] - by_s[1] * by_t[0];
        let ds = (rest[0] * by_t[1] - rest[1] * by_t[0]) / determinant;
        let dt = (by_s[0] * rest[1] - by_s[1] * rest[0]) / determinant;
        (ds.is_finite() && dt.is_finite()).then_some([ds, dt])
    }

    /// Coordinates of a point, by Newton's method from the middle.
    fn coordinates(&self, p: Point) -> Option<Point> {
        let mut s = 0.5_f64;
        let mut t = 0.5_f64;
        for _ in 0..MAX_NEWTON_ITERATIONS {
            let step = self.step([s, t], p)?;
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

    /// Weights at a point `p`, from the weights at the nearest point `within` and their slopes there.
    fn continued(&self, within: Point, p: Point) -> Option<[f64; 4]> {
        let place = self.coordinates_within(within)?;
        let step = self.step(place, p)?;
        let slopes = slopes(place);
        let weights = bilinear(place);
        Some([0, 1, 2, 3].map(|k| weights[k] + step[0] * slopes[0][k] + step[1] * slopes[1][k]))
    }

    /// Coordinates of a point within the quadrilateral, by the quadratic equation of t.
    fn coordinates_within(&self, p: Point) -> Option<Point> {
        let [b, c, d] = self.0;
        let twist = [0, 1].map(|k| c[k] - b[k] - d[k]);
        let square = -cross(d, twist);
        let linear = cross(p, twist) - cross(d, b);
        let constant = cross(p, b);
        let root = linear.mul_add(linear, -4.0 * square * constant).max(0.0).sqrt();
        let sum = -0.5 * (linear + root.copysign(linear));
        let places =
            [sum / square, constant / sum].into_iter().filter(|t| t.is_finite()).map(|t| {
                let along = [0, 1].map(|k| b[k] + t * twist[k]);
                let square = along[0] * along[0] + along[1] * along[1];
                let s = ((p[0] - t * d[0]) * along[0] + (p[1] - t * d[1]) * along[1]) / square;
                [s, t]
            });
        let beyond =
            |[s, t]: &Point| [s, t].into_iter().map(|x| (x - 0.5).abs()).fold(0.0, f64::max);
        let place = places.min_by(|one, other| beyond(one).total_cmp(&beyond(other)))?;
        place.iter().all(|x| x.is_finite()).then(|| place.map(|x| x.clamp(0.0, 1.0)))
    }
}

/// Cross product of two vectors in a plane.
fn cross(one: Point, other: Point) -> f64 {
    one[0] * other[1] - one[1] * other[0]
}

/// Slopes of [`bilinear`] along s and along t.
fn slopes([s, t]: Point) -> [[f64; 4]; 2] {
    [[t - 1.0, 1.0 - t, t, -t], [s - 1.0, -s, s, 1.0 - s]]
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Distance of a point from a convex polygon; zero within.
pub(crate) fn outside(corners: &[Point], p: Point) -> f64 {
    distance(p, nearest_within(corners, p))
}

/// The point of a convex polygon nearest to `p`.
fn nearest_within(corners: &[Point], p: Point) -> Point {
    let edges = (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]);
    let mut areas = edges.clone().map(|edge| side(edge, p));
    if areas.clone().all(|area| area >= 0.0) || areas.all(|area| area <= 0.0) {
        return p;
    }
    let mut nearest = [f64::INFINITY; 2];
    for edge in edges {
        let point = nearest_on_edge(edge, p);
        if distance(p, point) < distance(p, nearest) {
            nearest = point;
        }
    }
    nearest
}

/// The point of an edge nearest to `p`.
fn nearest_on_edge([a, b]: [Point; 2], p: Point) -> Point {
    let along = [b[0] - a[0], b[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let fraction = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / square;
    let fraction = fraction.clamp(0.0, 1.0);
    [a[0] + fraction * along[0], a[1] + fraction * along[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Convex quadrilaterals of all shapes, near the origin and at coordinates of a site: linear displacements are
    /// exact within and beyond, where bilinear ones often have no continuation.
    #[test]
    fn linear_displacements_are_exact_on_all_convex_faces() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut tried = 0;
        let mut without = 0;
        while tried < 2000 {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            let corners = corners.map(|[x, y]| [x + random() - 0.5, y + random() - 0.5]);
            let turns =
                (0..4).map(|k| side([corners[k], corners[(k + 1) % 4]], corners[(k + 2) % 4]));
            if turns.fold(f64::INFINITY, f64::min) < 1e-3 {
                continue;
            }
            tried += 1;
            for origin in [[0.0, 0.0], [128.0, -64.0], [4500.0, 3150.0]] {
                let face = corners.map(|[x, y]| [x + origin[0], y + origin[1]]);
                let point = [origin[0] + 1.6 * random() - 0.3, origin[1] + 1.6 * random() - 0.3];
                let local = [0, 1].map(|k| face.map(|corner| corner[k] - face[0][k]));
                let inner = [1, 2, 3].map(|k| [local[0][k], local[1][k]]);
                let from = [0, 1].map(|k| point[k] - face[0][k]);
                without += usize::from(Quadrilateral(inner).coordinates(from).is_none());
                let found = corner_weights(&face, point);
                let sum: f64 = found.iter().sum();
                assert!((sum - 1.0).abs() < 1e-9, "{face:?} {point:?} {found:?}");
                for k in 0..2 {
                    let place: f64 = found.iter().zip(local[k]).map(|(weight, x)| weight * x).sum();
                    assert!((place - from[k]).abs() < 1e-9, "{face:?} {point:?} {found:?}");
                }
            }
        }
        assert!(without > 20, "{without}");
    }

    /// Within, both methods give the same coordinates for any position of the face.
    #[test]
    fn coordinates_within_are_the_bilinear_ones() {
        let face = Quadrilateral([[4.0, -1.0], [5.0, 4.0], [1.0, 3.0]]);
        for place in [[0.0, 0.0], [0.25, 0.75], [1.0, 0.5], [0.9, 0.1], [1.0, 1.0]] {
            let point = [0, 1].map(|k| face.blend(bilinear(place), k));
            for found in [face.coordinates(point), face.coordinates_within(point)] {
                let found = found.unwrap();
                assert!((0..2).all(|k| (found[k] - place[k]).abs() < 1e-13), "{found:?}");
            }
        }
    }
}
