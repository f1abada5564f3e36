//! Bilinear spring with kinematic hardening.

use super::biaxial::BiaxialSpring;
use super::coupled_slider::CoupledSlider;
use super::slider::{Slider, elastic_fraction, slider_law};
use crate::error::{Result, positive};

/// Bilinear force with kinematic hardening: yielding columns, braces, dampers of mild steel.
///
/// The spring is elastic with the stiffness k up to the yield force F_y, and has the stiffness α k beyond. After a
/// reversal it is elastic over a range of 2 F_y. Energy stored by hardening counts as recoverable.
#[derive(Debug, Clone, PartialEq)]
pub struct Bilinear {
    slider: Slider,
}

impl Bilinear {
    /// Spring with stiffness k, yield force F_y and hardening α.
    ///
    /// `stiffness`: N/m. `yield_force`: N. `hardening`: ratio of the slope after yield to k. All values are per metre
    /// of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless k and F_y are positive and 0 ≤ α < 1.
    pub fn new(stiffness: f64, yield_force: f64, hardening: f64) -> Result<Self> {
        positive("stiffness of the bilinear spring", stiffness)?;
        positive("yield force of the bilinear spring", yield_force)?;
        let elastic_ratio = elastic_fraction(hardening)?;
        let slider = Slider::new(
            hardening * stiffness,
            positive("stiffness of the bilinear spring", elastic_ratio * stiffness)?,
            positive("yield force of the bilinear spring", elastic_ratio * yield_force)?,
        );
        Ok(Self { slider })
    }

    /// A new spring with these parameters for two directions.
    ///
    /// The force F − α k d yields on a circle of the radius (1 − α) F_y, with radial return and kinematic hardening.
    pub fn coupled(&self) -> BiaxialSpring {
        CoupledSlider::new(&self.slider).into()
    }
}

slider_law!(Bilinear);
