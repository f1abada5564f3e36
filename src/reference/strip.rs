//! Rigid strip without tension on a half-plane.

use std::f64::consts::PI;

use crate::Soil;
use crate::error::{Result, finite, positive, require};

/// Rigid flat strip on an elastic half-plane that may uplift under an eccentric load.
///
/// The strip is frictionless, or slides as a whole with Coulomb friction, so that the pressure determines the shear
/// tractions. The pressure is that under an inclined punch, with exponents −1/2 ± γ at its ends,
/// tan πγ = −f (1−2ν)/(2(1−ν)), and zero pressure at an end that uplifts: Muskhelishvili, *Some Basic
/// Problems of the Mathematical Theory of Elasticity*, 1953, part VI; Johnson, *Contact Mechanics*, 1985,
/// §2.8. The tilt is small. A settlement has no datum in two dimensions, so only the tilt is returned.
///
/// The load acts at an eccentricity e from the middle, positive to the right, and tilts the strip clockwise.
/// `tilt` and moments are positive counter-clockwise, so they have the sign of −e.
///
/// ```
/// use basemat::{Soil, reference::NoTensionStrip};
/// let strip = NoTensionStrip::new(Soil::new(1.0, 0.25, 1.0)?, 1.0, 0.0)?;
/// // e = 3B/4: contact over 2a = 4(B − e) = B, half of the strip
/// let contact = strip.contact(1.0, 0.75)?;
/// assert_eq!([contact.left, contact.right], [0.0, 1.0]);
/// assert!((contact.tilt + 0.75 / (2.0 * std::f64::consts::PI * 0.25)).abs() < 1e-15);
/// assert!((strip.moment(1.0, contact.tilt)? + 0.75).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoTensionStrip {
    soil: Soil,
    half_width: f64,
    /// Shift γ of the exponents of the pressure.
    exponent: f64,
}

/// Contact of a tilted strip with the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StripContact {
    /// Left end of the contact, m from the middle of the strip.
    pub left: f64,
    /// Right end of the contact, m from the middle of the strip.
    pub right: f64,
    /// Rotation of the strip, rad, positive counter-clockwise.
    pub tilt: f64,
}

impl StripContact {
    /// Length of the contact, m.
    pub fn length(&self) -> f64 {
        self.right - self.left
    }
}

impl NoTensionStrip {
    /// Strip of half width B (m) on `soil`, sliding with `friction` f.
    ///
    /// If f > 0, the strip slides to the right, and the shear traction on the soil is f times the pressure to the right.
    /// If f < 0, the strip slides to the left. If f = 0, it is frictionless.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless B is finite and above zero, and f is finite.
    pub fn new(soil: Soil, half_width: f64, friction: f64) -> Result<Self> {
        positive("half width of the strip", half_width)?;
        finite("friction of the strip", friction)?;
        let coupling_ratio = (1.0 - 2.0 * soil.poisson()) / (2.0 * (1.0 - soil.poisson()));
        Ok(Self { soil, half_width, exponent: -(friction * coupling_ratio).atan() / PI })
    }

    /// Shift γ of the exponents of the pressure: −1/2 + γ at the left end, −1/2 − γ at the right end.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// Contact and tilt under `load` N (N/m, downwards) at `eccentricity` e (m).
    ///
    /// Contact is full for −B(1/2 − γ) ≤ e ≤ B(1/2 + γ). For a larger e, the contact length is 2(B−e)/(1/2−γ)
    /// at the right edge, and 2(B+e)/(1/2+γ) at the left edge for a smaller e.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless N is finite and above zero and |e| < B.
    pub fn contact(&self, load: f64, eccentricity: f64) -> Result<StripContact> {
        let b = self.half_width;
        let g = self.exponent;
        self.check(load, eccentricity)?;
        let unit_tilt = self.unit_tilt(load);
        if eccentricity > b * (0.5 + g) {
            let half_length = (b - eccentricity) / (0.5 - g);
            let tilt = -unit_tilt / (half_length * (1.0 + 2.0 * g));
            Ok(StripContact { left: b - 2.0 * half_length, right: b, tilt })
        } else if eccentricity < -b * (0.5 - g) {
            let half_length = (b + eccentricity) / (0.5 + g);
            let tilt = unit_tilt / (half_length * (1.0 - 2.0 * g));
            Ok(StripContact { left: -b, right: 2.0 * half_length - b, tilt })
        } else {
            Ok(StripContact { left: -b, right: b, tilt: -unit_tilt * self.slope(eccentricity) })
        }
    }

    /// Contact pressure at `x` from the middle of the strip (m), Pa.
    ///
    /// It is zero outside the contact, and infinite at an edge in contact.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) as for [`contact`](Self::contact), or if `x` is not finite.
    pub fn pressure(&self, load: f64, eccentricity: f64, x: f64) -> Result<f64> {
        let contact = self.contact(load, eccentricity)?;
        finite("position under the strip", x)?;
        if x < contact.left || x > contact.right {
            return Ok(0.0);
        }
        let b = self.half_width;
        let g = self.exponent;
        let scale = load * (PI * g).cos() / PI;
        let half_length = contact.length() / 2.0;
        let left_distance = x - contact.left;
        let right_distance = contact.right - x;
        if contact.left > -b {
            let shape = left_distance.powf(0.5 + g) * right_distance.powf(-0.5 - g);
            return Ok(scale / (half_length * (1.0 + 2.0 * g)) * shape);
        }
        if contact.right < b {
            let shape = right_distance.powf(0.5 - g) * left_distance.powf(-0.5 + g);
            return Ok(scale / (half_length * (1.0 - 2.0 * g)) * shape);
        }
        let weight = left_distance.powf(-0.5 + g) * right_distance.powf(-0.5 - g);
        Ok(scale * (1.0 + self.slope(eccentricity) * (x - 2.0 * g * b)) * weight)
    }

    /// Moment of the load about the middle that causes the `tilt`, N m/m, counter-clockwise.
    ///
    /// `tilt` θ in rad, counter-clockwise; load N in N/m, downwards. Without friction, with θ₀ =
    /// (1−ν)N/(πμB): M/(NB) = θ/(2θ₀) up to θ₀ and 1 − θ₀/(2θ) beyond.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless N is finite and above zero, and the tilt is finite.
    pub fn moment(&self, load: f64, tilt: f64) -> Result<f64> {
        let b = self.half_width;
        let g = self.exponent;
        self.check(load, 0.0)?;
        finite("tilt of the strip", tilt)?;
        // Slope c of the pressure in full contact.
        let slope = -tilt / self.unit_tilt(load);
        let eccentricity = if slope * b * (1.0 + 2.0 * g) > 1.0 {
            b - (0.5 - g) / (slope * (1.0 + 2.0 * g))
        } else if slope * b * (1.0 - 2.0 * g) < -1.0 {
            -b - (0.5 + g) / (slope * (1.0 - 2.0 * g))
        } else {
            2.0 * g * b + slope * 2.0 * b * b * (0.25 - g * g)
        };
        Ok(-load * eccentricity)
    }

    /// Slope c of the pressure in full contact, 1/m.
    ///
    /// The pressure is p = N cos πγ/π · (1 + c (x − 2γB)) · weight.
    fn slope(&self, eccentricity: f64) -> f64 {
        let b = self.half_width;
        let g = self.exponent;
        (eccentricity - 2.0 * g * b) / (2.0 * b * b * (0.25 - g * g))
    }

    /// Tilt times length (1−ν)N/(πμ) of a load N, m.
    fn unit_tilt(&self, load: f64) -> f64 {
        (1.0 - self.soil.poisson()) * load / (PI * self.soil.shear_modulus())
    }

    /// Returns an error unless the load has a contact under the strip.
    fn check(&self, load: f64, eccentricity: f64) -> Result<()> {
        positive("load on the strip", load)?;
        let is_inside = eccentricity.abs() < self.half_width;
        let needed = "smaller than the half width of the strip";
        require("eccentricity of the load", eccentricity, is_inside, needed).map(drop)
    }
}
