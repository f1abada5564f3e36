//! Elastic slider parallel to a spring, in a plane.

use super::slider::Slider;
use super::{BiaxialResponse, corrupt};
use crate::error::Result;
use crate::structure::InternalEnergy;

/// Spring `parallel` to a spring `series` with a slider that yields at the force `limit`, in any direction.
///
/// The slider follows the deformation by the shortest way to the circle of its limit (radial return). Along a step
/// the force is the gradient of a convex energy, which is the sum of the stored and the dissipated energy.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CoupledSlider {
    parallel: f64,
    series: f64,
    pub(super) limit: f64,
    /// Displacement of the slider.
    slip: [f64; 2],
    dissipated: f64,
}

/// Motion of the slider in a step.
struct SliderMotion {
    /// Direction from the slider to the deformation.
    direction: [f64; 2],
    /// Force of the slider.
    force: f64,
    /// Distance by which it slides, m.
    way: f64,
}

impl CoupledSlider {
    /// A new spring with the numbers of `slider`.
    pub(super) fn new(slider: &Slider) -> Self {
        let Slider { parallel, series, limit, .. } = *slider;
        Self { parallel, series, limit, slip: [0.0; 2], dissipated: 0.0 }
    }

    /// Motion of the slider that the deformation causes.
    fn slide(&self, deformation: [f64; 2]) -> SliderMotion {
        let offset = [deformation[0] - self.slip[0], deformation[1] - self.slip[1]];
        let distance = offset[0].hypot(offset[1]);
        if distance == 0.0 {
            return SliderMotion { direction: [0.0; 2], force: 0.0, way: 0.0 };
        }
        let direction = offset.map(|part| part / distance);
        let trial = self.series * distance;
        if trial <= self.limit {
            return SliderMotion { direction, force: trial, way: 0.0 };
        }
        let way = distance - self.limit / self.series;
        SliderMotion { direction, force: self.limit, way }
    }

    pub(super) fn response(&self, deformation: [f64; 2]) -> BiaxialResponse {
        let SliderMotion { direction, force, way } = self.slide(deformation);
        // Across its direction the force turns with the deformation about the slider.
        let across = if way > 0.0 { force / (force / self.series + way) } else { self.series };
        let along = if way > 0.0 { 0.0 } else { self.series };
        let mut tangent = [[0.0; 2]; 2];
        for (i, row) in tangent.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let isotropic = if i == j { self.parallel + across } else { 0.0 };
                *entry = isotropic + (along - across) * (direction[i] * direction[j]);
            }
        }
        let force = [0, 1].map(|k| self.parallel * deformation[k] + force * direction[k]);
        BiaxialResponse { force, tangent }
    }

    pub(super) fn energy(&self, deformation: [f64; 2]) -> InternalEnergy {
        let SliderMotion { force, way, .. } = self.slide(deformation);
        let square: f64 = deformation.iter().map(|d| d * d).sum();
        InternalEnergy {
            stored: 0.5 * (self.parallel * square + force * force / self.series),
            dissipated: self.dissipated + self.limit * way,
        }
    }

    pub(super) fn commit(&mut self, deformation: [f64; 2]) {
        let SliderMotion { direction, way, .. } = self.slide(deformation);
        self.dissipated += self.limit * way;
        self.slip = [0, 1].map(|k| self.slip[k] + way * direction[k]);
    }

    /// Sets the limit after a commit of `deformation`. A force above it falls to it, and its energy becomes heat.
    pub(super) fn set_limit(&mut self, limit: f64, deformation: [f64; 2]) {
        let before = self.slide(deformation);
        self.limit = limit;
        let after = self.slide(deformation);
        let released = before.force * before.force - after.force * after.force;
        self.dissipated += 0.5 * released / self.series;
        self.slip = [0, 1].map(|k| self.slip[k] + after.way * before.direction[k]);
    }

    pub(super) fn save(&self) -> Vec<f64> {
        vec![self.slip[0], self.slip[1], self.dissipated]
    }

    pub(super) fn restore(&mut self, values: &[f64]) -> Result<()> {
        match values {
            &[x, y, dissipated]
                if values.iter().all(|value| value.is_finite()) && dissipated >= 0.0 =>
            {
                (self.slip, self.dissipated) = ([x, y], dissipated);
                Ok(())
            }
            _ => Err(corrupt()),
        }
    }
}
