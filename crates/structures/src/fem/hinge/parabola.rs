//! Two parabolas that meet at corners on the first coordinate axis.

use super::convex_set::{BOUNDARY_ROUNDING, ClosestPoint, ConvexSet, curve_derivative};

/// Largest number of Newton's iterations, far above those that rounding needs.
const MAX_ITERATIONS: usize = 60;

/// The set |y|/B + (x/A)² ≤ 1 of points [x, y], with its semi-axes [A, B].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DoubleParabola {
    pub(super) semi_axes: [f64; 2],
}

/// The boundary in the quadrant of the trial point is [A ν, B (1 − ν²)] for 0 ≤ ν ≤ 1.
///
/// The distance from [x, y] is least where g(ν) = A (A ν − x) + 2 B ν (y − B (1 − ν²)) is zero. g is convex for ν ≥ 0 and not
/// positive at ν = 0, so that Newton's method from ν = 1 decreases to its only root. Without a root up to ν = 1 the
/// corner is the closest point.
impl ConvexSet<2> for DoubleParabola {
    fn closest_point(&self, trial: &[f64; 2]) -> Option<ClosestPoint<2>> {
        let [a, b] = self.semi_axes;
        let x = trial[0].abs();
        let y = trial[1].abs();
        if y / b + (x / a) * (x / a) <= 1.0 + BOUNDARY_ROUNDING {
            return None;
        }
        let signs = trial.map(|coordinate| 1.0_f64.copysign(coordinate));
        let distance_rate = |nu: f64| a * (a * nu - x) + 2.0 * b * nu * (y - b * (1.0 - nu * nu));
        if distance_rate(1.0) <= 0.0 {
            return Some(ClosestPoint { point: [signs[0] * a, 0.0], derivative: [[0.0; 2]; 2] });
        }
        let mut nu = 1.0_f64;
        for _ in 0..MAX_ITERATIONS {
            let slope = a * a + 2.0 * b * (y - b) + 6.0 * b * b * nu * nu;
            let next = (nu - distance_rate(nu) / slope).max(0.0);
            // The iterates decrease to the solution; rounding ends the decrease.
            if next.is_nan() || next >= nu {
                break;
            }
            nu = next;
        }
        let point = [a * nu, b * (1.0 - nu * nu)];
        let length = a.hypot(2.0 * b * nu);
        let tangent = [signs[0] * a / length, -signs[1] * 2.0 * b * nu / length];
        let curvature = 2.0 * a * b / (length * length * length);
        let distance = (x - point[0]).hypot(y - point[1]);
        Some(ClosestPoint {
            point: [signs[0] * point[0], signs[1] * point[1]],
            derivative: curve_derivative(tangent, curvature * distance),
        })
    }
}
