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
/// The weight W on the bearing and its coefficient of friction are constant, and the structure does not rise when the
/// bearing climbs. Overturning of a rigid floor increases the weight on one side as much as it reduces the weight on
/// the other, so the sum of the horizontal forces does not change. Vertical motion changes all weights. If they vary by
/// ±30 % at 0.4 to 3 Hz, the force of a block under El Centro differs by up to 30 %, and its displacement by up to
/// 17 %. With a vertical record they differ by 13 % and 1 %. A bearing from
/// [`with_vertical_stiffness`](FrictionPendulum::with_vertical_stiffness) uses the vertical force on it as its weight.
///
/// Before it slides, the bearing is elastic up to a small displacement, which makes the tangent finite (Zayas, Low &
/// Mahin 1990; Mokha, Constantinou & Reinhorn 1991 use 0.1 to 0.5 mm).
///
/// ```
/// use basemat::structure::{FrictionPendulum, Hysteresis};
///
/// let bearing = FrictionPendulum::new(1.0e6, 2.0, 0.05)?;
/// // Friction 0.05 W, and W/R · 0.1 m by the climb.
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

    /// Bearing with the weight W on it, a dish of radius R, and friction.
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
        let dish_stiffness = positive("stiffness of the friction pendulum", weight / radius)?;
        let friction_force = positive("friction of the friction pendulum", friction * weight)?;
        let initial_stiffness =
            positive("stiffness before sliding", friction_force / Self::YIELD_DISPLACEMENT)?;
        Ok(Self {
            slider: Slider::new(dish_stiffness, initial_stiffness, friction_force),
            radius,
            friction,
        })
    }

    /// Sets the displacement at which sliding begins, m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is positive.
    pub fn with_yield_displacement(mut self, displacement: f64) -> Result<Self> {
        positive("displacement at which sliding begins", displacement)?;
        let initial_stiffness = self.slider.limit / displacement;
        self.slider.series_stiffness = positive("stiffness before sliding", initial_stiffness)?;
        Ok(self)
    }

    /// Period 2π √(R/g) of free sliding on the dish without friction, s.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `gravity` (m/s²) is positive.
    pub fn sliding_period(&self, gravity: f64) -> Result<f64> {
        // Square of the period over 2π, s².
        let squared_time =
            not_negative("square of the period", self.radius / positive("gravity", gravity)?)?;
        Ok(std::f64::consts::TAU * squared_time.sqrt())
    }

    /// A new bearing with these parameters that slides in any horizontal direction.
    ///
    /// F = W d/R + friction · W · n, with the unit vector n in the direction of sliding. The weight W is constant:
    /// neither vertical motion nor the displacement of the bearing changes it.
    pub fn coupled(&self) -> BiaxialSpring {
        CoupledSlider::new(&self.slider).into()
    }

    /// A new bearing with these parameters whose weight is the vertical force on it.
    ///
    /// It has a vertical `stiffness` (N/m). The weight W determines the stiffness before sliding, and the friction in
    /// the static state.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the stiffness is positive.
    pub fn with_vertical_stiffness(&self, stiffness: f64) -> Result<PendulumBearing> {
        positive("vertical stiffness of the friction pendulum", stiffness)?;
        let Slider { series_stiffness, limit, .. } = self.slider;
        let slider = CoupledSlider::new(&Slider::new(0.0, series_stiffness, limit));
        Ok(PendulumBearing::new(slider, self.radius, self.friction, stiffness))
    }
}

slider_law!(FrictionPendulum);
