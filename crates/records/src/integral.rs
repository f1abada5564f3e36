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
    /// Motion after `elapsed_time` (s), while the acceleration changes at the rate `jerk` (m/s³).
    pub(super) fn after(self, elapsed_time: f64, jerk: f64) -> Self {
        let Self { acceleration: a, velocity: v, displacement: u } = self;
        Self {
            acceleration: a + jerk * elapsed_time,
            velocity: v + elapsed_time * (a + elapsed_time * jerk / 2.0),
            displacement: u + elapsed_time
                * (v + elapsed_time * (a / 2.0 + elapsed_time * jerk / 6.0)),
        }
    }
}

/// Velocity (m/s) and displacement (m) at the samples of an acceleration.
pub(super) struct Integrals {
    pub(super) velocity: Vec<f64>,
    pub(super) displacement: Vec<f64>,
}

/// Integrates samples of acceleration (m/s²), linear in between, from rest.
pub(super) fn integrate(time_step: f64, acceleration: &[f64]) -> Integrals {
    let mut velocity = Vec::with_capacity(acceleration.len());
    let mut displacement = Vec::with_capacity(acceleration.len());
    let mut v = 0.0;
    let mut u = 0.0;
    velocity.push(v);
    displacement.push(u);
    for pair in acceleration.windows(2) {
        u += time_step * v + time_step * time_step * (2.0 * pair[0] + pair[1]) / 6.0;
        v += time_step * (pair[0] + pair[1]) / 2.0;
        velocity.push(v);
        displacement.push(u);
    }
    Integrals { velocity, displacement }
}

/// Roots of c₀ + c₁ s + c₂ s² in the open interval (0, `end`), ascending.
///
/// The root of larger magnitude is computed first, and the other from the product of both, without cancellation.
#[doc(hidden)]
pub fn quadratic_roots_within(c0: f64, c1: f64, c2: f64, end: f64) -> [Option<f64>; 2] {
    let discriminant = c1 * c1 - 4.0 * c0 * c2;
    if discriminant < 0.0 {
        return [None, None];
    }
    // q = c₂ times the root of larger magnitude. The other root is c₀/q, since the product of the roots is c₀/c₂.
    let q = -(c1 + discriminant.sqrt().copysign(c1)) / 2.0;
    // q is zero only if c₁ and c₀c₂ are zero. A division by zero gives no root within the interval.
    let root_from_sum = Some(q / c2).filter(|&root| root > 0.0 && root < end);
    let root_from_product = Some(c0 / q).filter(|&root| root > 0.0 && root < end);
    match (root_from_sum, root_from_product) {
        (Some(upper), Some(lower)) if upper > lower => [Some(lower), Some(upper)],
        (None, Some(root)) => [Some(root), None],
        sorted_roots => sorted_roots.into(),
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
