//! Moment and contact of a rigid base during uplift, as powers of the rotation.

use crate::error::{Result, require};

/// Moment and contact of a rigid base as functions of its rotation, with uplift.
///
/// Uplift begins at the rotation θ₀ with the moment M₀ = N L/α, where N is the weight and L the length of the base in
/// the direction of the motion. Up to θ₀ the moment is proportional to the rotation. Beyond,
/// M/M₀ = α/2 − (α/2 − 1)(θ₀/θ)^(2/(α−2)), and the fraction (θ₀/θ)^(2/(α−2)) of the base is in contact. The law is used
/// for nuclear structures. It is exact on springs (α = 6, [`WinklerStrip`](super::WinklerStrip)) and for a frictionless
/// strip on a half-plane (α = 4, [`NoTensionStrip`](super::NoTensionStrip)). docs/validation.md has α for mats on a
/// half-space.
///
/// ```
/// use basemat::reference::UpliftLaw;
/// // Springs at θ = 4 θ₀: half of the base is in contact, M = (3 − 2/2) M₀.
/// let law = UpliftLaw::new(6.0)?;
/// assert!((law.contact_ratio(4.0)? - 0.5).abs() < 1e-15);
/// assert!((law.moment_ratio(4.0)? - 2.0).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UpliftLaw {
    /// Coefficient α of the moment M₀ = N L/α.
    alpha: f64,
}

impl UpliftLaw {
    /// Law with the coefficient α of the moment M₀ = N L/α.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless α is finite and above 2; with α = 2 uplift would begin when the base
    /// stands on its edge.
    pub fn new(alpha: f64) -> Result<Self> {
        let is_in_range = alpha > 2.0 && alpha < f64::INFINITY;
        require("coefficient of the moment of uplift", alpha, is_in_range, "finite and above 2")?;
        Ok(Self { alpha })
    }

    /// Fraction of the base in contact at the relative `rotation` θ/θ₀; 1 before uplift.
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

    /// Relative moment M/M₀ at the relative `rotation` θ/θ₀; its limit is α/2, for a base on its edge.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the rotation is finite and not negative.
    pub fn moment_ratio(&self, rotation: f64) -> Result<f64> {
        let contact_ratio = self.contact_ratio(rotation)?;
        let limit = 0.5 * self.alpha;
        Ok(if rotation < 1.0 { rotation } else { limit - (limit - 1.0) * contact_ratio })
    }
}
