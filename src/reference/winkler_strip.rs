//! Rigid strip on a bed of springs without tension.

use crate::error::{Result, finite, positive};

/// Rigid strip on a bed of independent springs without tension.
///
/// Statics of a footing under an eccentric load, with full contact up to e = B/3, as in Psycharis &
/// Jennings, "Rocking of slender rigid bodies allowed to uplift", Earthquake Eng. Struct. Dyn. 11 (1983),
/// 57–76, and Chopra & Yim, "Simplified earthquake analysis of structures with foundation uplift", J. Struct.
/// Eng. ASCE 111 (1985), 906–930.
///
/// ```
/// let strip = basemat::reference::WinklerStrip::new(3.0e6, 2.0)?;
/// let uplift_tilt = strip.uplift_tilt(1.2e4)?;
/// assert!((uplift_tilt - 5.0e-4).abs() < 1e-18);
/// assert!((strip.moment(1.2e4, 4.0 * uplift_tilt)? - 1.2e4 * 2.0 * (2.0 / 3.0)).abs() < 1e-9);
/// assert!((strip.contact_length(1.2e4, 4.0 * uplift_tilt)? - 2.0).abs() < 1e-14);
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

    /// Tilt N/(2kB²) (rad) in either direction at which an edge uplifts under `load` N (N/m, downwards).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless N is finite and above zero.
    pub fn uplift_tilt(&self, load: f64) -> Result<f64> {
        positive("load on the strip", load)?;
        Ok(load / (2.0 * self.stiffness * self.half_width * self.half_width))
    }

    /// Moment about the middle (N m/m) at `tilt` (rad) under `load` N; both are positive counter-clockwise.
    ///
    /// (2/3) k B³ θ in full contact, N B (1 − (2/3) √(θᵤ/θ)) beyond the uplift at θᵤ.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless N is finite and above zero, and the tilt is finite.
    pub fn moment(&self, load: f64, tilt: f64) -> Result<f64> {
        let contact_ratio = self.contact_ratio(load, tilt)?;
        let b = self.half_width;
        if contact_ratio == 1.0 {
            return Ok(2.0 / 3.0 * self.stiffness * b.powi(3) * tilt);
        }
        Ok((load * b * (1.0 - 2.0 / 3.0 * contact_ratio)).copysign(tilt))
    }

    /// Length of the contact (m) at `tilt` (rad) under `load` N: 2B, then 2B √(θᵤ/|θ|).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless N is finite and above zero, and the tilt is finite.
    pub fn contact_length(&self, load: f64, tilt: f64) -> Result<f64> {
        Ok(2.0 * self.half_width * self.contact_ratio(load, tilt)?)
    }

    /// Fraction of the width in contact.
    fn contact_ratio(&self, load: f64, tilt: f64) -> Result<f64> {
        finite("tilt of the strip", tilt)?;
        let uplift_tilt = self.uplift_tilt(load)?;
        Ok(if tilt.abs() <= uplift_tilt { 1.0 } else { (uplift_tilt / tilt.abs()).sqrt() })
    }
}
