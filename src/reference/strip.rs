//! Rigid strips: bonded and without tension on a half-plane, and on a bed of springs.

use std::f64::consts::PI;

use crate::Soil;
use crate::error::{Result, finite, positive, require};

/// Rigid flat strip on an elastic half-plane that may uplift under an eccentric load.
///
/// The strip is frictionless, or slides as a whole with Coulomb friction, so that the tractions follow from
/// the pressure alone. The pressure is that under an inclined punch, with exponents −1/2 ± γ at its ends, tan
/// πγ = −f (1−2ν)/(2(1−ν)), and zero pressure at an end where the strip lifts: Muskhelishvili, *Some Basic
/// Problems of the Mathematical Theory of Elasticity*, 1953, part VI; Johnson, *Contact Mechanics*, 1985,
/// §2.8. The tilt is small. The settlement has no datum in two dimensions, so only the tilt is returned.
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
    /// f > 0: the strip slides to the right and drags the soil to the right with f times the pressure; f < 0:
    /// to the left; f = 0: frictionless.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless B is finite and above zero, and f is finite.
    pub fn new(soil: Soil, half_width: f64, friction: f64) -> Result<Self> {
        positive("half width of the strip", half_width)?;
        finite("friction of the strip", friction)?;
        let ratio = (1.0 - 2.0 * soil.poisson()) / (2.0 * (1.0 - soil.poisson()));
        Ok(Self { soil, half_width, exponent: -(friction * ratio).atan() / PI })
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
        let (b, g) = (self.half_width, self.exponent);
        self.check(load, eccentricity)?;
        let unit = self.unit_tilt(load);
        if eccentricity > b * (0.5 + g) {
            let half = (b - eccentricity) / (0.5 - g);
            let tilt = -unit / (half * (1.0 + 2.0 * g));
            Ok(StripContact { left: b - 2.0 * half, right: b, tilt })
        } else if eccentricity < -b * (0.5 - g) {
            let half = (b + eccentricity) / (0.5 + g);
            let tilt = unit / (half * (1.0 - 2.0 * g));
            Ok(StripContact { left: -b, right: 2.0 * half - b, tilt })
        } else {
            Ok(StripContact { left: -b, right: b, tilt: -unit * self.slope(eccentricity) })
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
        let (b, g) = (self.half_width, self.exponent);
        let scale = load * (PI * g).cos() / PI;
        let half = contact.length() / 2.0;
        let (from_left, from_right) = (x - contact.left, contact.right - x);
        if contact.left > -b {
            let shape = from_left.powf(0.5 + g) * from_right.powf(-0.5 - g);
            return Ok(scale / (half * (1.0 + 2.0 * g)) * shape);
        }
        if contact.right < b {
            let shape = from_right.powf(0.5 - g) * from_left.powf(-0.5 + g);
            return Ok(scale / (half * (1.0 - 2.0 * g)) * shape);
        }
        let weight = from_left.powf(-0.5 + g) * from_right.powf(-0.5 - g);
        Ok(scale * (1.0 + self.slope(eccentricity) * (x - 2.0 * g * b)) * weight)
    }

    /// Moment about the middle that causes the `tilt`, N m/m, counter-clockwise, exerted by the load on the
    /// strip.
    ///
    /// `tilt` in rad, counter-clockwise; the load N in N/m, downwards. Without friction, with θ₀ =
    /// (1−ν)N/(πμB): M/(NB) = θ/(2θ₀) up to θ₀ and 1 − θ₀/(2θ) beyond.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless N is finite and above zero, and the tilt is finite.
    pub fn moment(&self, load: f64, tilt: f64) -> Result<f64> {
        let (b, g) = (self.half_width, self.exponent);
        self.check(load, 0.0)?;
        finite("tilt of the strip", tilt)?;
        let unit = self.unit_tilt(load);
        // the slope of the pressure's factor, as if in full contact
        let slope = -tilt / unit;
        let eccentricity = if slope * b * (1.0 + 2.0 * g) > 1.0 {
            b - (0.5 - g) / (slope * (1.0 + 2.0 * g))
        } else if slope * b * (1.0 - 2.0 * g) < -1.0 {
            -b - (0.5 + g) / (slope * (1.0 - 2.0 * g))
        } else {
            2.0 * g * b + slope * 2.0 * b * b * (0.25 - g * g)
        };
        Ok(-load * eccentricity)
    }

    /// c in p = N cos πγ/π · (1 + c (x − 2γB)) · weight, 1/m, in full contact.
    fn slope(&self, eccentricity: f64) -> f64 {
        let (b, g) = (self.half_width, self.exponent);
        (eccentricity - 2.0 * g * b) / (2.0 * b * b * (0.25 - g * g))
    }

    /// (1−ν)N/(πμ), m.
    fn unit_tilt(&self, load: f64) -> f64 {
        (1.0 - self.soil.poisson()) * load / (PI * self.soil.shear_modulus())
    }

    fn check(&self, load: f64, eccentricity: f64) -> Result<()> {
        positive("load on the strip", load)?;
        let is_inside = eccentricity.abs() < self.half_width;
        let needed = "smaller than the half width of the strip";
        require("eccentricity of the load", eccentricity, is_inside, needed).map(drop)
    }
}

// Limits of the dynamic stiffness of a rigid strip on a half-plane.

/// Massless rigid strip of width 2B on an elastic half-plane: limits of its dynamic stiffness.
///
/// Time factor e^(+iωt). Static: Muskhelishvili, *Some Basic Problems of the Mathematical Theory of
/// Elasticity*, 1953, part VI (bonded punch); its tractions oscillate with the exponent ε at the edges. High
/// frequency: each point radiates a plane wave, with force per area ρc times velocity. Low frequency: a 2-D
/// half-plane has no static stiffness in translation, but its quadrature compliance has a limit. Dynamic
/// tables: Luco & Westmann, "Dynamic response of a rigid footing bonded to an elastic half space", J. Appl.
/// Mech. 39 (1972), 527–534.
///
/// ```
/// use basemat::{Soil, reference::RigidStrip};
/// let strip = RigidStrip::new(Soil::new(8.0e7, 0.25, 2000.0)?, 2.0)?;
/// assert!((strip.horizontal_dashpot() - 2.0 * 2.0 * 2000.0 * 200.0).abs() < 1e-9);
/// assert!((strip.smooth_rocking_stiffness() / 8.0e7 - 8.0 / 3.0 * std::f64::consts::PI).abs() < 1e-14);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidStrip {
    soil: Soil,
    half_width: f64,
}

impl RigidStrip {
    /// Strip of half width B (m) on `soil`.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless B is finite and above zero.
    pub fn new(soil: Soil, half_width: f64) -> Result<Self> {
        positive("half width of the strip", half_width)?;
        Ok(Self { soil, half_width })
    }

    /// High-frequency limit `2Bρc_S` of the horizontal stiffness over iω, N s/m per metre.
    pub fn horizontal_dashpot(&self) -> f64 {
        2.0 * self.half_width * self.soil.density() * self.soil.shear_wave_speed()
    }

    /// High-frequency limit `2Bρc_P` of the vertical stiffness over iω, N s/m per metre.
    pub fn vertical_dashpot(&self) -> f64 {
        2.0 * self.half_width * self.soil.density() * self.soil.pressure_wave_speed()
    }

    /// High-frequency limit `(2/3)B³ρc_P` of the rocking stiffness over iω, N m s/rad per metre.
    pub fn rocking_dashpot(&self) -> f64 {
        self.vertical_dashpot() * self.half_width * self.half_width / 3.0
    }

    /// Static rocking stiffness πμB²/(2(1−ν)) of the frictionless strip, N m/rad per metre.
    pub fn smooth_rocking_stiffness(&self) -> f64 {
        let b = self.half_width;
        PI * self.soil.shear_modulus() * b * b / (2.0 * (1.0 - self.soil.poisson()))
    }

    /// Exponent ε = ln(3−4ν)/(2π) of the edge oscillation of the bonded strip.
    pub fn oscillation_exponent(&self) -> f64 {
        (3.0 - 4.0 * self.soil.poisson()).ln() / (2.0 * PI)
    }

    /// Static rocking stiffness of the bonded strip, N m/rad per metre.
    ///
    /// (1+4ε²) πμB²/(2(1−ν)) for a strip that is free to move horizontally: `K_rr − K_hr²/K_hh`, the inverse
    /// of the rocking compliance.
    pub fn bonded_rocking_stiffness(&self) -> f64 {
        self.smooth_rocking_stiffness() * (1.0 + 4.0 * self.oscillation_exponent().powi(2))
    }

    /// Static limit 2εB of `K_hr/K_hh` of the bonded strip, m.
    ///
    /// The rotation is positive counter-clockwise. A moment without horizontal force moves the bonded strip
    /// horizontally by −2εB times its rotation.
    pub fn bonded_coupling_length(&self) -> f64 {
        2.0 * self.oscillation_exponent() * self.half_width
    }

    /// Low-frequency limit −(1−ν)/(2μ) of the imaginary part of the translational compliances, 1/Pa.
    ///
    /// The vertical and the horizontal compliance have the same limit.
    pub fn quadrature_compliance(&self) -> f64 {
        -(1.0 - self.soil.poisson()) / (2.0 * self.soil.shear_modulus())
    }

    /// Growth (1−ν)/(πμ) of the real part of the translational compliances with ln(1/ω), 1/Pa.
    ///
    /// At low frequency, for the vertical and the horizontal compliance.
    pub fn logarithmic_compliance(&self) -> f64 {
        (1.0 - self.soil.poisson()) / (PI * self.soil.shear_modulus())
    }
}

// Rigid strip on a bed of springs without tension.

/// Rigid strip on a bed of independent springs that carry no tension.
///
/// Elementary statics of the eccentrically loaded footing, with full contact up to e = B/3, as in Psycharis &
/// Jennings, "Rocking of slender rigid bodies allowed to uplift", Earthquake Eng. Struct. Dyn. 11 (1983),
/// 57–76, and Chopra & Yim, "Simplified earthquake analysis of structures with foundation uplift", J. Struct.
/// Eng. ASCE 111 (1985), 906–930.
///
/// ```
/// let strip = basemat::reference::WinklerStrip::new(3.0e6, 2.0)?;
/// let uplift = strip.uplift_tilt(1.2e4)?;
/// assert!((uplift - 5.0e-4).abs() < 1e-18);
/// assert!((strip.moment(1.2e4, 4.0 * uplift)? - 1.2e4 * 2.0 * (2.0 / 3.0)).abs() < 1e-9);
/// assert!((strip.contact_length(1.2e4, 4.0 * uplift)? - 2.0).abs() < 1e-14);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WinklerStrip {
    stiffness: f64,
    half_width: f64,
}

impl WinklerStrip {
    /// Strip of half width B (m) on springs of `stiffness` k (Pa/m).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are finite and above zero.
    pub fn new(stiffness: f64, half_width: f64) -> Result<Self> {
        positive("stiffness of the spring bed", stiffness)?;
        positive("half width of the strip", half_width)?;
        Ok(Self { stiffness, half_width })
    }

    /// Tilt N/(2kB²) in either direction at which an edge lifts under `load` N (N/m, downwards), rad.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless N is finite and above zero.
    pub fn uplift_tilt(&self, load: f64) -> Result<f64> {
        positive("load on the strip", load)?;
        Ok(load / (2.0 * self.stiffness * self.half_width * self.half_width))
    }

    /// Moment about the middle at `tilt` (rad) under `load` N, N m/m.
    ///
    /// Tilt and moment are positive counter-clockwise.
    ///
    /// (2/3) k B³ θ in full contact, N B (1 − (2/3) √(θᵤ/θ)) beyond the uplift at θᵤ.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless N is finite and above zero, and the tilt is finite.
    pub fn moment(&self, load: f64, tilt: f64) -> Result<f64> {
        let share = self.contact_share(load, tilt)?;
        let b = self.half_width;
        if share == 1.0 {
            return Ok(2.0 / 3.0 * self.stiffness * b.powi(3) * tilt);
        }
        Ok((load * b * (1.0 - 2.0 / 3.0 * share)).copysign(tilt))
    }

    /// Length of the contact (m) at `tilt` (rad) under `load` N: 2B, then 2B √(θᵤ/|θ|).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless N is finite and above zero, and the tilt is finite.
    pub fn contact_length(&self, load: f64, tilt: f64) -> Result<f64> {
        Ok(2.0 * self.half_width * self.contact_share(load, tilt)?)
    }

    fn contact_share(&self, load: f64, tilt: f64) -> Result<f64> {
        finite("tilt of the strip", tilt)?;
        let uplift = self.uplift_tilt(load)?;
        Ok(if tilt.abs() <= uplift { 1.0 } else { (uplift / tilt.abs()).sqrt() })
    }
}
