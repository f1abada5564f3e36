//! Elastic slider parallel to a spring, with two deformations.

use super::slider::Slider;
use super::{BiaxialResponse, corrupt_state};
use crate::error::Result;
use crate::structure::InternalEnergy;

/// A [`Slider`] that yields in any direction of a plane.
///
/// The slider follows the deformation by the shortest path to the circle of its limit (radial return). In a step the
/// force is the gradient of a convex energy, the sum of the stored and the dissipated energy.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CoupledSlider {
    /// Stiffness of the parallel spring, N/m.
    parallel_stiffness: f64,
    /// Stiffness of the spring in series with the slider, N/m.
    series_stiffness: f64,
    /// Force at which the slider yields, N.
    pub(super) limit: f64,
    /// Displacement of the slider, m.
    slip: [f64; 2],
    /// Energy dissipated by the slider, J.
    dissipated_energy: f64,
}

/// Motion of the slider in a step.
struct SliderMotion {
    /// Unit vector from the displacement of the slider to the deformation.
    direction: [f64; 2],
    /// Force of the slider, N.
    force: f64,
    /// Distance by which the slider slides, m.
    distance: f64,
}

impl CoupledSlider {
    /// A new spring with the parameters of `slider`.
    pub(super) fn new(slider: &Slider) -> Self {
        let Slider { parallel_stiffness, series_stiffness, limit, .. } = *slider;
        Self {
            parallel_stiffness,
            series_stiffness,
            limit,
            slip: [0.0; 2],
            dissipated_energy: 0.0,
        }
    }

    /// Motion of the slider to a deformation.
    fn motion_to(&self, deformation: [f64; 2]) -> SliderMotion {
        let elongation = [deformation[0] - self.slip[0], deformation[1] - self.slip[1]];
        let length = elongation[0].hypot(elongation[1]);
        if length == 0.0 {
            return SliderMotion { direction: [0.0; 2], force: 0.0, distance: 0.0 };
        }
        let direction = elongation.map(|component| component / length);
        let trial_force = self.series_stiffness * length;
        if trial_force <= self.limit {
            return SliderMotion { direction, force: trial_force, distance: 0.0 };
        }
        let distance = length - self.limit / self.series_stiffness;
        SliderMotion { direction, force: self.limit, distance }
    }

    pub(super) fn response(&self, deformation: [f64; 2]) -> BiaxialResponse {
        let SliderMotion { direction, force, distance } = self.motion_to(deformation);
        // For a deformation at a right angle, the force rotates about the displacement of the slider.
        let normal_stiffness = if distance > 0.0 {
            force / (force / self.series_stiffness + distance)
        } else {
            self.series_stiffness
        };
        let tangent_stiffness = if distance > 0.0 { 0.0 } else { self.series_stiffness };
        let mut tangent = [[0.0; 2]; 2];
        for (i, row) in tangent.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let isotropic =
                    if i == j { self.parallel_stiffness + normal_stiffness } else { 0.0 };
                *entry = isotropic
                    + (tangent_stiffness - normal_stiffness) * (direction[i] * direction[j]);
            }
        }
        let total_force =
            [0, 1].map(|k| self.parallel_stiffness * deformation[k] + force * direction[k]);
        BiaxialResponse { force: total_force, tangent }
    }

    pub(super) fn energy(&self, deformation: [f64; 2]) -> InternalEnergy {
        let SliderMotion { force, distance, .. } = self.motion_to(deformation);
        let squared_deformation: f64 = deformation.iter().map(|d| d * d).sum();
        InternalEnergy {
            stored: 0.5
                * (self.parallel_stiffness * squared_deformation
                    + force * force / self.series_stiffness),
            dissipated: self.dissipated_energy + self.limit * distance,
        }
    }

    pub(super) fn commit(&mut self, deformation: [f64; 2]) {
        let SliderMotion { direction, distance, .. } = self.motion_to(deformation);
        self.dissipated_energy += self.limit * distance;
        self.slip = [0, 1].map(|k| self.slip[k] + distance * direction[k]);
    }

    /// Sets the limit after a commit of `deformation`.
    ///
    /// A force above the new limit is reduced to it; the stored energy that this releases is dissipated.
    pub(super) fn set_limit(&mut self, limit: f64, deformation: [f64; 2]) {
        let old_motion = self.motion_to(deformation);
        self.limit = limit;
        let new_motion = self.motion_to(deformation);
        let released_square =
            old_motion.force * old_motion.force - new_motion.force * new_motion.force;
        self.dissipated_energy += 0.5 * released_square / self.series_stiffness;
        self.slip = [0, 1].map(|k| self.slip[k] + new_motion.distance * old_motion.direction[k]);
    }

    pub(super) fn save(&self) -> Vec<f64> {
        vec![self.slip[0], self.slip[1], self.dissipated_energy]
    }

    pub(super) fn restore(&mut self, values: &[f64]) -> Result<()> {
        match values {
            &[x, y, dissipated_energy]
                if values.iter().all(|value| value.is_finite()) && dissipated_energy >= 0.0 =>
            {
                (self.slip, self.dissipated_energy) = ([x, y], dissipated_energy);
                Ok(())
            }
            _ => Err(corrupt_state()),
        }
    }
}
