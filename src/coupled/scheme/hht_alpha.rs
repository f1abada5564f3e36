//! Method of Hilber, Hughes & Taylor.

use super::newmark::{EndMotion, end_of_step};
use crate::coupled::scheme::{SchemeCoefficients, TimeScheme};
use crate::error::{Result, require};

/// HHT-α (Hilber, Hughes & Taylor 1977), for comparison with papers.
///
/// It is of second order and damps high frequencies of the structure alone. For other purposes use
/// [`DissipativeMidpoint`](super::DissipativeMidpoint), which is passive together with the soil.
///
/// It is Newmark's method with γ = ½ − α and β = (1−α)²/4. Damping forces, stiffness forces and loads are those at
/// t₁ + α Δt, inertia is that at t₁. Contact tractions are constant over the step and act with their full value. The
/// coupling creates energy as in [`Newmark`](super::Newmark), reduced by the dissipation of α. α = 0 is average
/// acceleration, and α = −⅓ has the largest damping. For steps much longer than the period the spectral radius tends to
/// (1+α)/(1−α), which is ½ at α = −⅓.
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
    /// [`Error::Input`](crate::Error::Input) outside this range.
    pub fn new(alpha: f64) -> Result<Self> {
        require("alpha", alpha, (-1.0 / 3.0..=0.0).contains(&alpha), "from -1/3 to 0")?;
        Ok(Self { alpha })
    }
}

impl TimeScheme for HhtAlpha {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        let end_fraction = 1.0 + self.alpha;
        let gamma = 0.5 - self.alpha;
        let beta = 0.25 * (1.0 - self.alpha).powi(2);
        let EndMotion { acceleration, velocity } = end_of_step(gamma, beta, time_step);
        SchemeCoefficients {
            displacement: [end_fraction, 0.0, 0.0],
            velocity: [
                end_fraction * velocity[0],
                end_fraction * velocity[1] - self.alpha,
                end_fraction * velocity[2],
            ],
            acceleration,
            new_velocity: velocity,
            new_acceleration: acceleration,
            load_fraction: end_fraction,
        }
    }
}
