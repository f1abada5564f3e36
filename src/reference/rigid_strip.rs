//! Limits of the dynamic stiffness of a rigid strip on a half-plane.

use std::f64::consts::PI;

use crate::Soil;
use crate::error::{Result, positive};

/// Limits of the dynamic stiffness of a massless rigid strip of width 2B on a half-plane.
///
/// The time factor is e^(+iωt).
///
/// * Static limits: Muskhelishvili, *Some Basic Problems of the Mathematical Theory of Elasticity*, 1953, part VI (bonded
///   punch). The tractions at the edges oscillate with the exponent ε.
/// * High-frequency limits: each point radiates a plane wave. The force per area is ρc times the velocity.
/// * Low-frequency limits: a half-plane has no static stiffness in translation, but the imaginary part of its compliance
///   has a limit.
/// * Tables for all frequencies: Luco & Westmann, "Dynamic response of a rigid footing bonded to an elastic half space",
///   J. Appl. Mech. 39 (1972), 527–534.
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

    /// Exponent ε = ln(3−4ν)/(2π) of the oscillation of tractions at the edges of the bonded strip.
    pub fn oscillation_exponent(&self) -> f64 {
        (3.0 - 4.0 * self.soil.poisson()).ln() / (2.0 * PI)
    }

    /// Static rocking stiffness of the bonded strip, N m/rad per metre.
    ///
    /// (1+4ε²) πμB²/(2(1−ν)) for a strip that moves freely in horizontal direction: `K_rr − K_hr²/K_hh`, the inverse of
    /// the rocking compliance.
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

    /// Slope (1−ν)/(πμ) of the real part of the translational compliances over ln(1/ω), 1/Pa.
    ///
    /// It is the limit at low frequency of the vertical and of the horizontal compliance.
    pub fn logarithmic_compliance(&self) -> f64 {
        (1.0 - self.soil.poisson()) / (PI * self.soil.shear_modulus())
    }
}
