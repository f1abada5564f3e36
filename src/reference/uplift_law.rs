//! Moment and contact of a rigid base that lifts, by a power of the rotation.

use crate::error::{Result, require};

/// Moment and contact of a rigid base that lifts under a growing rotation.
///
/// Up to the uplift at M₀ = N L/α and θ₀ the moment grows with the rotation. Beyond,
/// M/M₀ = α/2 − (α/2 − 1)(θ₀/θ)^(2/(α−2)), and the base is in contact over (θ₀/θ)^(2/(α−2)) of its area; N is the
/// weight, L the length along the motion. The law is a form of nuclear practice. It is exact on springs (α = 6,
/// [`WinklerStrip`](super::WinklerStrip)) and for a frictionless strip on a half-plane (α = 4,
/// [`NoTensionStrip`](super::NoTensionStrip)). α of mats on a half-space: docs/validation.md.
///
/// ```
/// use basemat::reference::UpliftLaw;
/// // Springs at four times the rotation of uplift: half of the base in contact, M = (3 − 2/2) M₀.
/// let springs = UpliftLaw::new(6.0)?;
/// assert!((springs.contact_ratio(4.0)? - 0.5).abs() < 1e-15);
/// assert!((springs.moment_ratio(4.0)? - 2.0).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UpliftLaw {
    alpha: f64,
}

impl UpliftLaw {
    /// Law with the coefficient α of the moment N L/α of uplift.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless α is finite and above 2, where uplift would begin with the
    /// base on its edge.
    pub fn new(alpha: f64) -> Result<Self> {
        let is_in_range = alpha > 2.0 && alpha < f64::INFINITY;
        require("coefficient of the moment of uplift", alpha, is_in_range, "finite and above 2")?;
        Ok(Self { alpha })
    }

    /// Fraction of the base in contact at `rotation` θ/θ₀: 1 up to the uplift.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the rotation is finite and not negative.
    pub fn contact_ratio(&self, rotation: f64) -> Result<f64> {
        let is_in_range = (0.0..f64::INFINITY).contains(&rotation);
        require(
            "rotation over the rotation of uplift",
            rotation,
            is_in_range,
            "finite and not negative",
        )?;
        Ok(rotation.max(1.0).powf(-2.0 / (self.alpha - 2.0)))
    }

    /// Moment M/M₀ at `rotation` θ/θ₀; α/2 in the limit, as of a base on its edge.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the rotation is finite and not negative.
    pub fn moment_ratio(&self, rotation: f64) -> Result<f64> {
        let contact = self.contact_ratio(rotation)?;
        let half = 0.5 * self.alpha;
        Ok(if rotation < 1.0 { rotation } else { half - (half - 1.0) * contact })
    }
}
