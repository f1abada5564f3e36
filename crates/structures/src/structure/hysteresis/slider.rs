//! Elastic slider parallel to a spring, and laws that consist of it.

use super::{SpringResponse, corrupt_state};
use crate::error::{Result, require};
use crate::structure::InternalEnergy;

/// A spring, and parallel to it a spring in series with a slider.
///
/// This is a bilinear law with kinematic hardening.
///
/// The return mapping is exact for straight paths.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slider {
    /// Stiffness of the parallel spring, N/m.
    pub(super) parallel_stiffness: f64,
    /// Stiffness of the spring in series with the slider, N/m.
    pub(super) series_stiffness: f64,
    /// Force at which the slider yields, N.
    pub(super) limit: f64,
    /// Displacement of the slider, m.
    slip: f64,
    /// Energy dissipated by the slider, J.
    dissipated_energy: f64,
}

/// Force (N) and displacement (m) of a slider.
struct SliderState {
    force: f64,
    slip: f64,
}

impl Slider {
    pub(super) fn new(parallel_stiffness: f64, series_stiffness: f64, limit: f64) -> Self {
        Self { parallel_stiffness, series_stiffness, limit, slip: 0.0, dissipated_energy: 0.0 }
    }

    /// State of the slider at a deformation.
    fn state_at(&self, deformation: f64) -> SliderState {
        let trial_force = self.series_stiffness * (deformation - self.slip);
        if trial_force.abs() <= self.limit {
            return SliderState { force: trial_force, slip: self.slip };
        }
        let force = self.limit.copysign(trial_force);
        SliderState { force, slip: deformation - force / self.series_stiffness }
    }

    pub(super) fn response(&self, deformation: f64) -> SpringResponse {
        let SliderState { force, slip } = self.state_at(deformation);
        let series_tangent = if slip == self.slip { self.series_stiffness } else { 0.0 };
        SpringResponse {
            force: self.parallel_stiffness * deformation + force,
            tangent: self.parallel_stiffness + series_tangent,
        }
    }

    pub(super) fn energy(&self, deformation: f64) -> InternalEnergy {
        let SliderState { force, slip } = self.state_at(deformation);
        InternalEnergy {
            stored: 0.5
                * (self.parallel_stiffness * deformation * deformation
                    + force * force / self.series_stiffness),
            dissipated: self.dissipated_energy + self.limit * (slip - self.slip).abs(),
        }
    }

    pub(super) fn commit(&mut self, deformation: f64) {
        self.dissipated_energy = self.energy(deformation).dissipated;
        self.slip = self.state_at(deformation).slip;
    }

    pub(super) fn save(&self) -> Vec<f64> {
        vec![self.slip, self.dissipated_energy]
    }

    pub(super) fn restore(&mut self, values: &[f64]) -> Result<()> {
        match values {
            &[slip, dissipated_energy]
                if slip.is_finite()
                    && dissipated_energy.is_finite()
                    && dissipated_energy >= 0.0 =>
            {
                (self.slip, self.dissipated_energy) = (slip, dissipated_energy);
                Ok(())
            }
            _ => Err(corrupt_state()),
        }
    }
}

/// Implements [`Hysteresis`](super::Hysteresis) for a type by its field `slider`.
macro_rules! slider_law {
    ($law:ty) => {
        impl crate::structure::Hysteresis for $law {
            fn response(&self, deformation: f64) -> crate::structure::SpringResponse {
                self.slider.response(deformation)
            }

            fn energy(&self, deformation: f64) -> crate::structure::InternalEnergy {
                self.slider.energy(deformation)
            }

            fn commit(&mut self, deformation: f64) {
                self.slider.commit(deformation);
            }

            fn save(&self) -> Vec<f64> {
                self.slider.save()
            }

            fn restore(&mut self, values: &[f64]) -> crate::error::Result<()> {
                self.slider.restore(values)
            }

            fn clone_box(&self) -> Box<dyn crate::structure::Hysteresis> {
                Box::new(self.clone())
            }
        }
    };
}
pub(super) use slider_law;

/// Elastic fraction 1 − α for a hardening ratio 0 ≤ α < 1.
pub(super) fn elastic_fraction(hardening: f64) -> Result<f64> {
    let is_ratio = (0.0..1.0).contains(&hardening);
    Ok(1.0 - require("hardening ratio", hardening, is_ratio, "from 0 to below 1")?)
}
