//! Hysteretic springs: the trait, and laws for yielding storeys and base isolators.

mod bouc_wen;
mod lead_rubber;
mod springs;

pub use bouc_wen::BoucWen;
pub use lead_rubber::LeadRubber;
pub(super) use springs::Springs;
pub use springs::WithSprings;

use super::InternalEnergy;
use crate::error::{CheckpointError, Result, not_negative, positive, require};

/// Force of a spring and its slope.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpringResponse {
    /// Force, N per metre of thickness, positive against a positive deformation.
    pub force: f64,
    /// Slope of the force over the deformation, N/m per metre.
    pub tangent: f64,
}

/// A hysteretic spring: implement this for your own law.
///
/// Its force depends on its past deformation.
///
/// The spring stores the deformation of the last **committed** step and its internal variables there. From there
/// Newton's method evaluates trial deformations, on a straight path and any number of times, without changing the
/// spring. [`commit`](Hysteresis::commit) accepts a deformation.
///
/// ```
/// use basemat::structure::{Bilinear, Hysteresis};
///
/// // 10 MN/m up to 100 kN, a tenth of the stiffness beyond.
/// let mut columns = Bilinear::new(10.0e6, 100.0e3, 0.1)?;
/// assert_eq!(columns.response(0.005).force, 50.0e3);
/// assert_eq!(columns.response(0.03).force, 120.0e3);
/// columns.commit(0.03);
/// // On the way back it is elastic again, and 18 mm of slip stay.
/// assert_eq!(columns.response(0.025).tangent, 10.0e6);
/// assert!((columns.response(0.018).force).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[auto_impl::auto_impl(Box)]
pub trait Hysteresis: Send {
    /// Force and tangent at `deformation` (m), reached straight from the last committed one.
    fn response(&self, deformation: f64) -> SpringResponse;

    /// Stored and dissipated energy at `deformation`, on a straight path to it.
    ///
    /// Their sum is the work of the force along the path.
    fn energy(&self, deformation: f64) -> InternalEnergy;

    /// Accepts a step that ended with `deformation`.
    fn commit(&mut self, deformation: f64);

    /// The internal variables that [`commit`](Hysteresis::commit) changes; their number is constant.
    fn save(&self) -> Vec<f64>;

    /// Restores the variables that [`save`](Hysteresis::save) returned.
    ///
    /// All values are finite. On an error the spring stays unchanged.
    ///
    /// # Errors
    /// [`CheckpointError::Corrupt`] for impossible values.
    fn restore(&mut self, values: &[f64]) -> Result<()>;

    /// A copy with its internal variables: usually `Box::new(self.clone())`.
    fn clone_box(&self) -> Box<dyn Hysteresis>;
}

impl Clone for Box<dyn Hysteresis> {
    fn clone(&self) -> Self {
        self.as_ref().clone_box()
    }
}

/// The error for impossible internal variables.
fn corrupt() -> crate::Error {
    CheckpointError::Corrupt { quantity: "state of a hysteretic spring" }.into()
}

// An elastic slider parallel to a spring, and laws made of it: bilinear columns and friction pendulums.

/// Spring `parallel` to a spring `series` with a slider that yields at the force `limit`.
///
/// The return mapping is exact for straight paths: the force is kinematically hardening bilinear.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slider {
    pub(super) parallel: f64,
    pub(super) series: f64,
    pub(super) limit: f64,
    /// Displacement of the slider.
    slip: f64,
    dissipated: f64,
}

impl Slider {
    pub(super) fn new(parallel: f64, series: f64, limit: f64) -> Self {
        Self { parallel, series, limit, slip: 0.0, dissipated: 0.0 }
    }

    /// Force of the slider and its slip.
    fn slide(&self, deformation: f64) -> (f64, f64) {
        let trial = self.series * (deformation - self.slip);
        if trial.abs() <= self.limit {
            return (trial, self.slip);
        }
        let force = self.limit.copysign(trial);
        (force, deformation - force / self.series)
    }

    pub(super) fn response(&self, deformation: f64) -> SpringResponse {
        let (force, slip) = self.slide(deformation);
        let tangent = if slip == self.slip { self.series } else { 0.0 };
        SpringResponse {
            force: self.parallel * deformation + force,
            tangent: self.parallel + tangent,
        }
    }

    pub(super) fn energy(&self, deformation: f64) -> InternalEnergy {
        let (force, slip) = self.slide(deformation);
        InternalEnergy {
            stored: 0.5 * (self.parallel * deformation * deformation + force * force / self.series),
            dissipated: self.dissipated + self.limit * (slip - self.slip).abs(),
        }
    }

    pub(super) fn commit(&mut self, deformation: f64) {
        self.dissipated = self.energy(deformation).dissipated;
        self.slip = self.slide(deformation).1;
    }

    pub(super) fn save(&self) -> Vec<f64> {
        vec![self.slip, self.dissipated]
    }

    pub(super) fn restore(&mut self, values: &[f64]) -> Result<()> {
        match values {
            &[slip, dissipated]
                if slip.is_finite() && dissipated.is_finite() && dissipated >= 0.0 =>
            {
                (self.slip, self.dissipated) = (slip, dissipated);
                Ok(())
            }
            _ => Err(corrupt()),
        }
    }
}

/// Implements [`Hysteresis`](Hysteresis) for a type by its field `slider`.
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
use slider_law;

/// Bilinear force with kinematic hardening: yielding columns, braces, dampers of mild steel.
///
/// Elastic with stiffness k up to the yield force F_y, then with α k; after a reversal it is elastic over 2 F_y.
/// Energy stored by hardening counts as recoverable.
#[derive(Debug, Clone, PartialEq)]
pub struct Bilinear {
    slider: Slider,
}

impl Bilinear {
    /// Spring with stiffness k, yield force F_y and hardening α.
    ///
    /// `stiffness`: N/m. `yield_force`: N. `hardening`: ratio of the slope after yield to k. All per metre of
    /// thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless k and F_y are positive and 0 ≤ α < 1.
    pub fn new(stiffness: f64, yield_force: f64, hardening: f64) -> Result<Self> {
        positive("stiffness of the bilinear spring", stiffness)?;
        positive("yield force of the bilinear spring", yield_force)?;
        let share = elastic_share(hardening)?;
        let slider = Slider::new(
            hardening * stiffness,
            positive("stiffness of the bilinear spring", share * stiffness)?,
            positive("yield force of the bilinear spring", share * yield_force)?,
        );
        Ok(Self { slider })
    }
}

/// 1 − α for a hardening ratio 0 ≤ α < 1.
pub(super) fn elastic_share(hardening: f64) -> Result<f64> {
    let is_ratio = (0.0..1.0).contains(&hardening);
    Ok(1.0 - require("hardening ratio", hardening, is_ratio, "from 0 to below 1")?)
}

slider_law!(Bilinear);

/// Friction pendulum: a slider on a concave dish.
///
/// F = W d/R + friction · W · sgn(ḋ).
///
/// The weight W on the bearing and its coefficient of friction are constant. Before it slides, the bearing is
/// elastic up to a small displacement, which makes the tangent finite (Zayas, Low & Mahin 1990; Mokha,
/// Constantinou & Reinhorn 1991 use 0.1 to 0.5 mm).
///
/// ```
/// use basemat::structure::{FrictionPendulum, Hysteresis};
///
/// let bearing = FrictionPendulum::new(1.0e6, 2.0, 0.05)?;
/// // 0.05 W to slide, and W/R · 0.1 m to climb.
/// assert!((bearing.response(0.1).force - (50.0e3 + 50.0e3)).abs() < 1e-6);
/// assert_eq!(bearing.response(0.1).tangent, 0.5e6);
/// // 2π √(R/g), whatever the weight
/// assert!((bearing.sliding_period(9.81)? - 2.837).abs() < 1e-3);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionPendulum {
    slider: Slider,
    radius: f64,
}

impl FrictionPendulum {
    /// Displacement at which sliding begins by default, m.
    pub const YIELD_DISPLACEMENT: f64 = 0.5e-3;

    /// Bearings with the weight W on them, a dish of radius R, and friction.
    ///
    /// `weight`: N per metre of thickness. `radius`: effective radius of curvature, m. `friction`: coefficient of
    /// friction.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all are positive.
    pub fn new(weight: f64, radius: f64, friction: f64) -> Result<Self> {
        positive("weight on the friction pendulum", weight)?;
        positive("radius of the friction pendulum", radius)?;
        positive("coefficient of friction", friction)?;
        let climb = positive("stiffness of the friction pendulum", weight / radius)?;
        let limit = positive("friction of the friction pendulum", friction * weight)?;
        let series = positive("stiffness before sliding", limit / Self::YIELD_DISPLACEMENT)?;
        Ok(Self { slider: Slider::new(climb, series, limit), radius })
    }

    /// Sets the displacement at which sliding begins, m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is positive.
    pub fn with_yield_displacement(mut self, displacement: f64) -> Result<Self> {
        positive("displacement at which sliding begins", displacement)?;
        let series = self.slider.limit / displacement;
        self.slider.series = positive("stiffness before sliding", series)?;
        Ok(self)
    }

    /// Period 2π √(R/g) of free sliding on the dish without friction, s.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `gravity` (m/s²) is positive.
    pub fn sliding_period(&self, gravity: f64) -> Result<f64> {
        let square =
            not_negative("square of the period", self.radius / positive("gravity", gravity)?)?;
        Ok(std::f64::consts::TAU * square.sqrt())
    }
}

slider_law!(FrictionPendulum);
