//! The method of Hilber, Hughes & Taylor.

use super::newmark::end_of_step;
use super::{SchemeCoefficients, TimeScheme};
use crate::error::{Error, Result};

/// HHT-α (Hilber, Hughes & Taylor 1977), **for comparison with papers**: second order, damps high
/// frequencies of the structure alone. For use take
/// [`DissipativeMidpoint`](super::DissipativeMidpoint), which is passive together with the soil.
///
/// Newmark's method with γ = ½ − α and β = (1−α)²/4, its damping and stiffness forces and loads
/// taken at t₁ + α Δt, its inertia at t₁. Contact tractions are constant over the step and enter in
/// full: what [`Newmark`](super::Newmark) says of the energy that its coupling makes holds here, less
/// what α takes. α = 0 is average acceleration; −⅓ damps most: the spectral radius tends to
/// (1+α)/(1−α) for steps that are long against the period, ½ at α = −⅓.
///
/// ```
/// use basemat::coupled::HhtAlpha;
/// assert!(HhtAlpha::new(-0.1).is_ok());
/// assert!(HhtAlpha::new(0.1).is_err() && HhtAlpha::new(-0.4).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "HhtAlphaForm"))]
pub struct HhtAlpha {
    alpha: f64,
}

validated! {
    HhtAlpha as HhtAlphaForm { alpha: f64 }
    => HhtAlpha::new(alpha)
}

impl HhtAlpha {
    /// Method with −⅓ ≤ α ≤ 0.
    ///
    /// # Errors
    /// [`Error::Input`] outside this range.
    pub fn new(alpha: f64) -> Result<Self> {
        if (-1.0 / 3.0..=0.0).contains(&alpha) {
            Ok(Self { alpha })
        } else {
            Err(Error::Input { quantity: "alpha", value: alpha, needed: "from -1/3 to 0" })
        }
    }
}

impl TimeScheme for HhtAlpha {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        let share = 1.0 + self.alpha;
        let (gamma, beta) = (0.5 - self.alpha, 0.25 * (1.0 - self.alpha).powi(2));
        let (acceleration, velocity) = end_of_step(gamma, beta, time_step);
        let [dv, v, a] = velocity;
        SchemeCoefficients {
            displacement: [share, 0.0, 0.0],
            velocity: [share * dv, share * v - self.alpha, share * a],
            acceleration,
            new_velocity: velocity,
            new_acceleration: acceleration,
            load_fraction: share,
        }
    }
}
