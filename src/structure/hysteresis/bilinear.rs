//! Bilinear spring.

use super::slider::{Slider, slider_law};
use crate::error::{Error, Result, finite, positive};

/// Bilinear force with kinematic hardening: yielding columns, braces, dampers of mild steel.
///
/// Elastic with stiffness k up to the yield force F_y, then with α k; after a reversal it is
/// elastic over 2 F_y. What the hardening stores counts as recoverable.
#[derive(Debug, Clone, PartialEq)]
pub struct Bilinear {
    slider: Slider,
}

impl Bilinear {
    /// Spring with `stiffness` k (N/m), `yield_force` F_y (N) and `hardening` α, the ratio of the
    /// slope after yield to k; all per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`] unless k and F_y are positive and 0 ≤ α < 1.
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
    if (0.0..1.0).contains(&hardening) {
        return finite("hardening ratio", 1.0 - hardening);
    }
    let needed = "from 0 to below 1";
    Err(Error::Input { quantity: "hardening ratio", value: hardening, needed })
}

slider_law!(Bilinear);
