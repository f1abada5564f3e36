//! Friction pendulum: a slider on a concave dish.

use super::biaxial::BiaxialSpring;
use super::coupled_slider::CoupledSlider;
use super::pendulum_bearing::PendulumBearing;
use super::slider::{Slider, slider_law};
use crate::error::{Result, not_negative, positive};

/// Friction pendulum: a slider on a concave dish.
///
/// F = W d/R + friction · W · sgn(ḋ).
///
/// The weight W on the bearing and its coefficient of friction are constant, and the structure does not rise with the
/// climb. Overturning under a rigid floor adds weight on one side as it removes weight on the other, and the sum of the
/// forces stays. Vertical motion changes all weights: with ±30 % at 0.4 to 3 Hz the force of a block under El Centro
/// differs by up to 30 %, its displacement by up to 17 %; with a record upwards by 13 % and 1 %. A bearing by
/// [`with_vertical_stiffness`](FrictionPendulum::with_vertical_stiffness) takes the vertical force on it as its weight.
///
/// Before it slides, the bearing is elastic up to a small displacement, which makes the tangent finite (Zayas, Low &
/// Mahin 1990; Mokha, Constantinou & Reinhorn 1991 use 0.1 to 0.5 mm).
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
    friction: f64,
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
        Ok(Self { slider: Slider::new(climb, series, limit), radius, friction })
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

    /// A new bearing with these numbers that slides in any direction of the plane.
    ///
    /// F = W d/R + friction · W · n, with the unit vector n along the sliding. The weight W is constant: neither the
    /// vertical motion nor the drift of the bearing changes it.
    pub fn coupled(&self) -> BiaxialSpring {
        CoupledSlider::new(&self.slider).into()
    }

    /// A new bearing with these numbers whose weight is the vertical force on it.
    ///
    /// It has a vertical `stiffness` (N/m). The weight W determines its stiffness before sliding, and its friction until
    /// the static state is known.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the stiffness is positive.
    pub fn with_vertical_stiffness(&self, stiffness: f64) -> Result<PendulumBearing> {
        positive("vertical stiffness of the friction pendulum", stiffness)?;
        let Slider { series, limit, .. } = self.slider;
        let slider = CoupledSlider::new(&Slider::new(0.0, series, limit));
        Ok(PendulumBearing::new(slider, self.radius, self.friction, stiffness))
    }
}

slider_law!(FrictionPendulum);
