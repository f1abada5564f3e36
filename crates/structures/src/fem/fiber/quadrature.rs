//! Points along a beam at which its sections are integrated.

use crate::error::{Result, require};
use crate::linalg::gauss;

/// Rule of integration along a beam: sections at its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum BeamQuadrature {
    /// Gauss and Lobatto's rule with 2 to 5 points, two of them at the ends.
    Lobatto(usize),
    /// Gauss and Legendre's rule with 2 to 5 points, all inside.
    Legendre(usize),
}

/// Section along a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::fem) struct BeamPoint {
    /// Position along the beam, from 0 to 1.
    pub(in crate::fem) position: f64,
    /// Part of the beam's length.
    pub(in crate::fem) weight: f64,
}

impl BeamQuadrature {
    /// Points of the rule, from the first to the second node.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless there are 2 to 5 points.
    pub(in crate::fem) fn points(self) -> Result<Vec<BeamPoint>> {
        let (Self::Lobatto(count) | Self::Legendre(count)) = self;
        let is_available = (2..=5).contains(&count);
        require("number of sections along a beam", count as f64, is_available, "from 2 to 5")?;
        Ok(match self {
            Self::Lobatto(_) => lobatto_points(count),
            Self::Legendre(_) => gauss::rule(count)
                .points_on_unit_interval()
                .map(|(position, weight)| BeamPoint { position, weight })
                .collect(),
        })
    }
}

/// Gauss and Lobatto's rule of 2 to 5 points on [0, 1] (Abramowitz and Stegun, table 25.6).
fn lobatto_points(count: usize) -> Vec<BeamPoint> {
    // Points on [−1, 1] that are not negative, with their weights, whose sum over the rule is 2.
    let right_half: &[[f64; 2]] = match count {
        2 => &[[1.0, 1.0]],
        3 => &[[0.0, 4.0 / 3.0], [1.0, 1.0 / 3.0]],
        4 => &[[0.2, 5.0 / 6.0], [1.0, 1.0 / 6.0]],
        _ => &[[0.0, 32.0 / 45.0], [3.0 / 7.0, 49.0 / 90.0], [1.0, 0.1]],
    };
    let mut points = Vec::with_capacity(count);
    for &[squared_position, weight] in right_half {
        let x = squared_position.sqrt();
        points.push(BeamPoint { position: 0.5 * (1.0 + x), weight: 0.5 * weight });
        if x > 0.0 {
            points.push(BeamPoint { position: 0.5 * (1.0 - x), weight: 0.5 * weight });
        }
    }
    points.sort_by(|a, b| a.position.total_cmp(&b.position));
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lobatto's rule of n points is exact for polynomials of degree 2n − 3, Legendre's of degree 2n − 1.
    #[test]
    fn rules_integrate_polynomials() {
        for count in 2..=5 {
            for (rule, degree) in [
                (BeamQuadrature::Lobatto(count), 2 * count - 3),
                (BeamQuadrature::Legendre(count), 2 * count - 1),
            ] {
                let points = rule.points().unwrap();
                assert_eq!(points.len(), count);
                for power in 0..=degree {
                    let sum: f64 =
                        points.iter().map(|p| p.weight * p.position.powf(power as f64)).sum();
                    assert!((sum - 1.0 / (power as f64 + 1.0)).abs() < 1e-14, "{rule:?} {power}");
                }
                let power = degree + 1;
                let sum: f64 =
                    points.iter().map(|p| p.weight * p.position.powf(power as f64)).sum();
                assert!((sum - 1.0 / (power as f64 + 1.0)).abs() > 1e-6, "{rule:?} {power}");
            }
        }
        assert!(BeamQuadrature::Lobatto(1).points().is_err());
        assert!(BeamQuadrature::Legendre(6).points().is_err());
    }
}
