//! Ellipse, or ellipsoid, about zero.

use super::convex_set::{BOUNDARY_ROUNDING, ClosestPoint, ConvexSet};

/// Largest number of Newton's iterations, far above those that rounding needs.
const MAX_ITERATIONS: usize = 60;

/// Ellipse with these semi-axes along the coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ellipse<const P: usize> {
    pub(super) semi_axes: [f64; P],
}

/// The closest point s to t outside has s_i = a_i p_i with p_i = a_i t_i/(a_i² + λ), and |p| = 1.
///
/// Newton's method solves 1/|p| = 1 for λ ≥ 0; this function of λ is nearly linear, and linear for a circle.
impl<const P: usize> ConvexSet<P> for Ellipse<P> {
    fn closest_point(&self, trial: &[f64; P]) -> Option<ClosestPoint<P>> {
        let a = self.semi_axes;
        // All lengths relative to the largest semi-axis.
        let size = a.into_iter().fold(0.0, f64::max);
        let a = a.map(|semi_axis| semi_axis / size);
        let t = trial.map(|coordinate| coordinate / size);
        let scaled = |multiplier: f64| -> [f64; P] {
            std::array::from_fn(|i| a[i] * t[i] / (a[i] * a[i] + multiplier))
        };
        if norm(&scaled(0.0)) <= 1.0 + BOUNDARY_ROUNDING {
            return None;
        }
        let lower_bounds = a.iter().zip(t).map(|(a, t)| a * (t.abs() - a));
        let mut multiplier = lower_bounds.fold(0.0, f64::max);
        let mut p = scaled(multiplier);
        for _ in 0..MAX_ITERATIONS {
            let length = norm(&p);
            let slope: f64 = (0..P).map(|i| p[i] * p[i] / (a[i] * a[i] + multiplier)).sum();
            let next = multiplier + length * length * (length - 1.0) / slope;
            // The iterates grow to the solution; rounding ends the growth.
            if next.is_nan() || next <= multiplier {
                break;
            }
            multiplier = next;
            p = scaled(multiplier);
        }
        let length = norm(&p);
        let relative_point: [f64; P] = std::array::from_fn(|i| a[i] * p[i] / length);
        let point = relative_point.map(|coordinate| size * coordinate);
        let rates: [f64; P] =
            std::array::from_fn(|i| relative_point[i] / (a[i] * a[i] + multiplier));
        let total_rate: f64 = (0..P).map(|i| relative_point[i] / (a[i] * a[i]) * rates[i]).sum();
        let derivative = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let stretch = if i == j { a[i] * a[i] / (a[i] * a[i] + multiplier) } else { 0.0 };
                stretch - rates[i] * rates[j] / total_rate
            })
        });
        Some(ClosestPoint { point, derivative })
    }
}

/// Euclidean norm.
fn norm<const P: usize>(vector: &[f64; P]) -> f64 {
    vector.iter().map(|component| component * component).sum::<f64>().sqrt()
}
