//! Backbones in simple shear, and their elastic–perfectly plastic components.

use std::f64::consts::SQRT_2;

use super::tensor::{Deviator, contraction, difference, scaled};
use crate::error::{Result, at_least, positive, require};

/// Number of points of a hyperbolic backbone.
const HYPERBOLIC_POINT_COUNT: usize = 12;
/// First strain of a hyperbolic backbone over τ_s/G; up to this strain the backbone is straight.
const FIRST_STRAIN_RATIO: f64 = 0.02;
/// Smallest limit strain over τ_s/G.
///
/// With a smaller one, the backbone would be convex at the second of the 12 points.
const MIN_LIMIT_STRAIN_RATIO: f64 = 5.0;
/// Largest difference of two slopes because of rounding, relative to the first slope.
///
/// At a point with a smaller difference the backbone counts as straight.
const SLOPE_ROUNDING: f64 = 1e-12;

/// Elastic–perfectly plastic component.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Component {
    /// Shear modulus G_j, Pa.
    pub(super) shear_modulus: f64,
    /// Radius r_j of the yield surface, Pa.
    pub(super) radius: f64,
}

impl Component {
    /// Norm of the strain deviator at which the virgin component yields.
    pub(super) fn yield_strain_norm(&self) -> f64 {
        0.5 * self.radius / self.shear_modulus
    }

    /// Elastic stress that the component would have without yielding.
    #[inline]
    pub(super) fn trial_stress(
        &self,
        strain_deviator: Deviator,
        stress_free_strain: Deviator,
    ) -> Deviator {
        scaled(difference(strain_deviator, stress_free_strain), 2.0 * self.shear_modulus)
    }

    /// Whether a trial stress with this square of its norm lies outside the yield surface.
    #[inline]
    pub(super) fn yields(&self, squared_norm: f64) -> bool {
        squared_norm > self.radius * self.radius
    }

    /// Factor that brings the trial stress back to the yield surface.
    #[inline]
    pub(super) fn return_factor(&self, squared_norm: f64) -> f64 {
        if self.yields(squared_norm) { self.radius / squared_norm.sqrt() } else { 1.0 }
    }

    /// Stress at a strain.
    #[inline]
    pub(super) fn stress(
        &self,
        strain_deviator: Deviator,
        stress_free_strain: Deviator,
    ) -> Deviator {
        let trial = self.trial_stress(strain_deviator, stress_free_strain);
        scaled(trial, self.return_factor(contraction(trial, trial)))
    }

    /// Energy s_j : Δe_j^p that the return from a trial stress dissipates, J/m³.
    #[inline]
    pub(super) fn dissipation(&self, squared_norm: f64) -> f64 {
        if self.yields(squared_norm) {
            0.5 * self.radius * (squared_norm.sqrt() - self.radius) / self.shear_modulus
        } else {
            0.0
        }
    }
}

/// Components of a backbone, in the order of their yield strains.
///
/// A point at which the backbone is straight has no component.
pub(super) fn backbone_components(points: &[[f64; 2]]) -> Result<Vec<Component>> {
    at_least("points of the backbone", points.len(), 1)?;
    let mut slopes = Vec::with_capacity(points.len() + 1);
    let mut previous_point = [0.0; 2];
    let mut previous_slope = f64::INFINITY;
    for (index, &point) in points.iter().enumerate() {
        let slope = checked_slope(previous_point, point, previous_slope)
            .map_err(|fault| fault.within(format!("point {} of the backbone", index + 1)))?;
        slopes.push(slope);
        previous_point = point;
        previous_slope = slope;
    }
    slopes.push(0.0);
    let min_modulus = SLOPE_ROUNDING * slopes[0];
    let mut components = Vec::with_capacity(points.len());
    for (point, slope_pair) in points.iter().zip(slopes.windows(2)) {
        let shear_modulus = slope_pair[0] - slope_pair[1];
        if shear_modulus > min_modulus {
            components.push(Component { shear_modulus, radius: SQRT_2 * shear_modulus * point[0] });
        }
    }
    Ok(components)
}

/// Slope of the backbone from one point to the next.
fn checked_slope(previous_point: [f64; 2], point: [f64; 2], previous_slope: f64) -> Result<f64> {
    let strain = point[0];
    let stress = point[1];
    let strain_ascends = strain.is_finite() && strain > previous_point[0];
    let needed = "finite, and above zero and the strain of the point before";
    require("shear strain", strain, strain_ascends, needed)?;
    let stress_ascends = stress.is_finite() && stress > 0.0 && stress >= previous_point[1];
    let needed = "finite, above zero, and not below the stress of the point before";
    require("shear stress (Pa)", stress, stress_ascends, needed)?;
    let slope = (stress - previous_point[1]) / (strain - previous_point[0]);
    let is_concave = slope <= previous_slope * (1.0 + SLOPE_ROUNDING);
    let needed = "at most the slope before it (the backbone must be concave)";
    require("slope up to the point (Pa)", slope, slope.is_finite() && is_concave, needed)
}

/// Points of a hyperbolic backbone: [`Iwan::hyperbolic`](super::Iwan::hyperbolic) has the formula.
pub(super) fn hyperbolic_points(
    shear_modulus: f64,
    strength: f64,
    limit_strain: f64,
) -> Result<[[f64; 2]; HYPERBOLIC_POINT_COUNT]> {
    positive("shear modulus of the soil (Pa)", shear_modulus)?;
    positive("shear strength of the soil (Pa)", strength)?;
    let reference_strain = positive("strength over shear modulus", strength / shear_modulus)?;
    let is_in_range =
        limit_strain.is_finite() && limit_strain >= MIN_LIMIT_STRAIN_RATIO * reference_strain;
    let needed = "finite, and at least 5 times strength over shear modulus";
    require("strain at which the soil has its strength", limit_strain, is_in_range, needed)?;
    let asymptote = 1.0 / (1.0 / strength - 1.0 / (limit_strain * shear_modulus));
    let first_strain = FIRST_STRAIN_RATIO * reference_strain;
    let last_index = HYPERBOLIC_POINT_COUNT - 1;
    let strain_ratio = limit_strain / first_strain;
    let mut points = [[0.0; 2]; HYPERBOLIC_POINT_COUNT];
    for (index, point) in points.iter_mut().enumerate() {
        let strain = first_strain * strain_ratio.powf(index as f64 / last_index as f64);
        let elastic_stress = shear_modulus * strain;
        *point = [strain, elastic_stress / (1.0 + elastic_stress / asymptote)];
    }
    points[0] = [first_strain, shear_modulus * first_strain];
    points[last_index] = [limit_strain, strength];
    Ok(points)
}

/// Norm of the strain deviator of the virgin material under a stress.
///
/// `stress_norm`: norm of the stress, Pa.
///
/// The norm |e| of the strain follows from Σ min(2 G_j |e|, r_j) = `stress_norm`.
pub(super) fn virgin_strain_norm(components: &[Component], stress_norm: f64) -> f64 {
    let mut yielded_stress = 0.0;
    let mut strain_norm = 0.0;
    for (index, component) in components.iter().enumerate() {
        let elastic_components = &components[index..];
        let elastic_modulus: f64 =
            elastic_components.iter().map(|elastic| 2.0 * elastic.shear_modulus).sum();
        strain_norm = (stress_norm - yielded_stress) / elastic_modulus;
        if strain_norm <= component.yield_strain_norm() {
            return strain_norm;
        }
        strain_norm = component.yield_strain_norm();
        yielded_stress += component.radius;
    }
    strain_norm
}
