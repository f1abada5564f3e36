//! Estimate of a block's slip from a response spectrum.

use crate::error::{Result, at_least, not_negative, positive, require};
use crate::motion::SpectralOrdinate;

/// Slip of a rigid block in an earthquake, from the spectrum of the motion with 10 % damping.
///
/// ASCE/SEI 43-05 (2005), equations A-1 to A-3: δ = c/(2πf)² with c = 2 μₑ g and μₑ = μ (1 − 0.4 A/g), where A is the
/// largest vertical acceleration and f the lowest frequency at which the spectral acceleration equals c. The motion has
/// one horizontal component, so that the standard's factor for two components is one. docs/validation.md compares
/// estimates with computed slips.
///
/// ```
/// use basemat::motion::el_centro_1940;
/// use basemat::reference::SlidingEstimate;
/// let periods: Vec<f64> = (1..=400).map(|k| 0.01 * f64::from(k)).collect();
/// let spectrum = el_centro_1940().response_spectrum(&periods, 0.1, &mut basemat::unobserved)?;
/// let estimate = SlidingEstimate::new(0.15, 0.0, 9.81)?;
/// assert!((estimate.spectral_acceleration() - 2.943).abs() < 1e-12);
/// let slip = estimate.slip(&spectrum)?.ok_or("the spectrum stays below this acceleration")?;
/// assert!(slip > 0.02 && slip < 0.2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingEstimate {
    /// Spectral acceleration c, m/s².
    spectral_acceleration: f64,
}

/// Reduction of the friction coefficient per vertical acceleration in g (ASCE/SEI 43-05, eq. A-2).
const FRICTION_REDUCTION: f64 = 0.4;
/// Vertical acceleration in g at which the effective friction vanishes, 1/0.4.
const MAX_VERTICAL_RATIO: f64 = 2.5;

impl SlidingEstimate {
    /// Estimate for a friction coefficient μ, the largest vertical acceleration A (m/s²) and `gravity` g (m/s²).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless friction and gravity are finite and above zero, and A is at least
    /// zero and below 2.5 g, where μₑ vanishes.
    pub fn new(friction: f64, vertical_acceleration: f64, gravity: f64) -> Result<Self> {
        positive("friction of the block", friction)?;
        positive("gravity", gravity)?;
        not_negative("vertical acceleration", vertical_acceleration)?;
        let is_below_limit = vertical_acceleration < MAX_VERTICAL_RATIO * gravity;
        require("vertical acceleration", vertical_acceleration, is_below_limit, "below 2.5 g")?;
        let effective_friction =
            friction * (1.0 - FRICTION_REDUCTION * vertical_acceleration / gravity);
        let spectral_acceleration =
            positive("spectral acceleration of slip", 2.0 * effective_friction * gravity)?;
        Ok(Self { spectral_acceleration })
    }

    /// Spectral acceleration c = 2 μₑ g, m/s².
    pub fn spectral_acceleration(&self) -> f64 {
        self.spectral_acceleration
    }

    /// Estimate δ of the slip, m; `None` if the spectrum stays below c.
    ///
    /// Between two ordinates the pseudo-acceleration is interpolated as a power of the period.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for less than two ordinates; [`Error::Input`](crate::Error::Input) unless
    /// periods increase, accelerations are finite and above zero, and the last one is below c.
    pub fn slip(&self, spectrum: &[SpectralOrdinate]) -> Result<Option<f64>> {
        at_least("ordinates of the spectrum", spectrum.len(), 2)?;
        let slip_acceleration = self.spectral_acceleration;
        for ordinate in spectrum {
            positive("period of the spectrum", ordinate.period)?;
            positive("spectral acceleration", ordinate.pseudo_acceleration)?;
        }
        for pair in spectrum.windows(2) {
            let is_longer = pair[1].period > pair[0].period;
            let needed = "above the previous period";
            require("period of the spectrum", pair[1].period, is_longer, needed)?;
        }
        let last_acceleration = spectrum[spectrum.len() - 1].pseudo_acceleration;
        let needed = "below 2 μₑ g at the longest period: extend the periods";
        let is_below = last_acceleration < slip_acceleration;
        require("spectral acceleration", last_acceleration, is_below, needed)?;
        let crossing = spectrum
            .windows(2)
            .rev()
            .find(|pair| pair[0].pseudo_acceleration >= slip_acceleration);
        Ok(crossing.map(|pair| {
            let short_ordinate = pair[0];
            let long_ordinate = pair[1];
            let fraction = (slip_acceleration / long_ordinate.pseudo_acceleration).ln()
                / (short_ordinate.pseudo_acceleration / long_ordinate.pseudo_acceleration).ln();
            let period_ratio = short_ordinate.period / long_ordinate.period;
            let period = long_ordinate.period * period_ratio.powf(fraction);
            slip_acceleration * (period / std::f64::consts::TAU).powi(2)
        }))
    }
}
