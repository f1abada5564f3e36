//! Exact integration of a piecewise linear acceleration.

/// Motion of a [`Record`](super::Record) at one time, or its peaks.
///
/// See [`Record::at`](super::Record::at) and [`Record::peaks`](super::Record::peaks).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Motion {
    /// Acceleration, m/s².
    pub acceleration: f64,
    /// Velocity, m/s.
    pub velocity: f64,
    /// Displacement, m.
    pub displacement: f64,
}

impl Motion {
    /// Motion after a further time `elapsed`, with the acceleration changing at the rate `jerk`.
    pub(super) fn after(self, elapsed: f64, jerk: f64) -> Self {
        let Self { acceleration: a, velocity: v, displacement: u } = self;
        Self {
            acceleration: a + jerk * elapsed,
            velocity: v + elapsed * (a + elapsed * jerk / 2.0),
            displacement: u + elapsed * (v + elapsed * (a / 2.0 + elapsed * jerk / 6.0)),
        }
    }
}

/// Integrals of an acceleration at its samples, from rest.
pub(super) struct Integrals {
    pub(super) velocity: Vec<f64>,
    pub(super) displacement: Vec<f64>,
}

/// Velocity and displacement at the samples of an acceleration, from rest.
pub(super) fn integrate(step: f64, acceleration: &[f64]) -> Integrals {
    let mut velocity = Vec::with_capacity(acceleration.len());
    let mut displacement = Vec::with_capacity(acceleration.len());
    let mut v = 0.0;
    let mut u = 0.0;
    velocity.push(v);
    displacement.push(u);
    for pair in acceleration.windows(2) {
        u += step * v + step * step * (2.0 * pair[0] + pair[1]) / 6.0;
        v += step * (pair[0] + pair[1]) / 2.0;
        velocity.push(v);
        displacement.push(u);
    }
    Integrals { velocity, displacement }
}

/// Roots of c₀ + c₁ s + c₂ s² in the open interval (0, `end`), ascending.
///
/// Without cancellation: the larger root first, the other from their product.
#[doc(hidden)]
pub fn quadratic_roots_within(c0: f64, c1: f64, c2: f64, end: f64) -> [Option<f64>; 2] {
    let discriminant = c1 * c1 - 4.0 * c0 * c2;
    if discriminant < 0.0 {
        return [None, None];
    }
    let sum = -(c1 + discriminant.sqrt().copysign(c1)) / 2.0;
    // The sum is zero only if c₁ and c₀c₂ are. A division by zero gives no root within the interval.
    let larger = Some(sum / c2).filter(|&root| root > 0.0 && root < end);
    let smaller = Some(c0 / sum).filter(|&root| root > 0.0 && root < end);
    match (larger, smaller) {
        (Some(first), Some(second)) if first > second => [Some(second), Some(first)],
        (None, Some(second)) => [Some(second), None],
        (first, second) => [first, second],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadratic_roots_are_sorted_and_inside() {
        assert_eq!(quadratic_roots_within(2.0, -3.0, 1.0, 5.0), [Some(1.0), Some(2.0)]);
        assert_eq!(quadratic_roots_within(2.0, -3.0, 1.0, 1.5), [Some(1.0), None]);
        assert_eq!(quadratic_roots_within(-1.0, 2.0, 0.0, 5.0), [Some(0.5), None]);
        assert_eq!(quadratic_roots_within(1.0, -2e8, 1.0, 1.0), [Some(5e-9), None]);
        assert_eq!(quadratic_roots_within(0.0, -3.0, 1.0, 5.0), [Some(3.0), None]);
        assert_eq!(quadratic_roots_within(1.0, 0.0, 1.0, 5.0), [None, None]);
        assert_eq!(quadratic_roots_within(0.0, 0.0, 0.0, 5.0), [None, None]);
        assert_eq!(quadratic_roots_within(0.0, 0.0, 1.0, 5.0), [None, None]);
    }
}
