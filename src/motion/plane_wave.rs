//! Plane waves that meet the free surface at an angle, and the Rayleigh wave.
//!
//! | symbol | meaning |
//! |---|---|
//! | p | horizontal slowness, 1/apparent velocity |
//! | a = √(1/c₁² − p²), b = √(1/c₂² − p²) | vertical slownesses of P and S, imaginary part ≥ 0 |
//! | g = b² − p² | abbreviation |
//! | R = g² + 4p²ab | Rayleigh's function |
//!
//! All waves vary as e^{iω(px−t)}, z is down. An incident wave of unit displacement and its two reflected waves cause no
//! traction at the surface if the surface moves by
//!
//! * SV: u_x = 2bg/(c₂R), u_up = −4pab/(c₂R)
//! * P: u_x = 4pab c₁/(c₂²R), u_up = 2ag c₁/(c₂²R)
//! * SH: twice the incident wave, across the plane of incidence
//!
//! (Achenbach, *Wave Propagation in Elastic Solids*, 1973, § 5.6; Aki & Richards, *Quantitative
//! Seismology*, 2nd ed., § 5.2). Rayleigh's wave has R = 0 and u_up/u_x = −2pa/g. An imaginary part
//! is a delay of a quarter of a period: i is the Hilbert transform, which turns cos into sin.

use std::f64::consts::FRAC_PI_2;

use super::out_of_phase::OutOfPhase;
use super::{Record, TravellingWave, Triaxial, VerticalIncidence};
use crate::error::{Result, require};
use crate::fundamental::Rayleigh;
use crate::linalg::Complex;
use crate::soil::Soil;

/// Smallest ratio of a prescribed component to the larger component.
///
/// The other component grows without bound near the angles at which the prescribed one vanishes.
const MIN_PRESCRIBED_RATIO: f64 = 0.1;

/// Magnitude of Rayleigh's function, relative to 1/c₂⁴, below which it is zero up to rounding.
const RAYLEIGH_ZERO_TOLERANCE: f64 = 1e-14;

/// Plane wave that meets the surface of a half-plane, or Rayleigh wave, and the motion of this surface.
///
/// ```
/// use basemat::{Soil, motion::{FreeField, PlaneWave, el_centro_1940}};
/// let soil = Soil::new(80.0e6, 0.25, 1900.0)?;
/// // SV at 20° from the vertical, running to the right; horizontal motion is El Centro's.
/// let wave = PlaneWave::sv(soil, 20.0_f64.to_radians())?;
/// let field = wave.field_from_horizontal(&el_centro_1940(), -10.0)?;
/// let [horizontal, vertical] = field.displacement(-10.0, 5.0);
/// assert!((horizontal - el_centro_1940().at(5.0).displacement).abs() < 1e-15);
/// assert!((vertical / horizontal + 0.41535).abs() < 1e-5);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneWave {
    /// Horizontal slowness p, s/m.
    slowness: f64,
    /// Surface displacement u_x per displacement of the incident wave.
    horizontal: Complex,
    /// Surface displacement u_up per displacement of the incident wave.
    vertical: Complex,
    /// Displacement across the plane of incidence, per displacement of the incident wave.
    transverse: f64,
}

impl PlaneWave {
    /// SV wave from below, at `angle` (rad) from the vertical.
    ///
    /// The wave runs to the right if the angle is positive. Beyond the critical angle, sin θ = c₂/c₁, the two components
    /// are out of phase.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless |`angle`| < π/2, and at the critical angle of 45° for a soil
    /// with a Poisson's ratio of zero, where all amplitudes are 0/0.
    pub fn sv(soil: Soil, angle: f64) -> Result<Self> {
        let speed = soil.shear_wave_speed();
        let Slownesses { p, a, b, g, rayleigh } = Slownesses::new(soil, angle, speed)?;
        let scale = Complex::real(1.0 / speed) / rayleigh;
        Ok(Self {
            slowness: p,
            horizontal: b.scale(2.0 * g) * scale,
            vertical: (a * b).scale(-4.0 * p) * scale,
            transverse: 0.0,
        })
    }

    /// SH wave from below, as for [`PlaneWave::sv`], for a ground in plan.
    ///
    /// The surface moves only perpendicularly to the direction of the wave, in phase with the incident wave at all angles.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless |`angle`| < π/2.
    pub fn sh(soil: Soil, angle: f64) -> Result<Self> {
        let slowness = check_angle(angle)?.sin() / soil.shear_wave_speed();
        let zero = Complex::default();
        Ok(Self { slowness, horizontal: zero, vertical: zero, transverse: 2.0 })
    }

    /// P wave from below, as for [`PlaneWave::sv`].
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless |`angle`| < π/2.
    pub fn p(soil: Soil, angle: f64) -> Result<Self> {
        let speed = soil.pressure_wave_speed();
        let shear_speed = soil.shear_wave_speed();
        let Slownesses { p, a, b, g, rayleigh } = Slownesses::new(soil, angle, speed)?;
        let scale = Complex::real(speed / (shear_speed * shear_speed)) / rayleigh;
        Ok(Self {
            slowness: p,
            horizontal: (a * b).scale(4.0 * p) * scale,
            vertical: a.scale(2.0 * g) * scale,
            transverse: 0.0,
        })
    }

    /// Rayleigh wave that runs to the right, with unit horizontal displacement.
    pub fn rayleigh(soil: Soil) -> Self {
        let shear_speed = soil.shear_wave_speed();
        let slowness = Rayleigh::new(soil).arrival() / shear_speed;
        let decay = (slowness * slowness - soil.pressure_wave_speed().powi(-2)).sqrt();
        let g = shear_speed.powi(-2) - 2.0 * slowness * slowness;
        let vertical = Complex::new(0.0, -2.0 * slowness * decay / g);
        Self { slowness, horizontal: Complex::real(1.0), vertical, transverse: 0.0 }
    }

    /// This wave in the opposite direction.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self { slowness: -self.slowness, vertical: self.vertical.scale(-1.0), ..self }
    }

    /// Velocity (m/s) of the wave along the surface, positive to the right.
    ///
    /// Infinite at vertical incidence.
    pub fn apparent_velocity(&self) -> f64 {
        1.0 / self.slowness
    }

    /// Surface displacement per unit displacement of the incident wave, horizontal and up.
    ///
    /// Each component is `[in phase, a quarter of a period late]`. For a Rayleigh wave the numbers are per unit of its
    /// horizontal displacement.
    pub fn amplification(&self) -> [[f64; 2]; 2] {
        [self.horizontal, self.vertical].map(|c| [c.re, c.im])
    }

    /// Surface displacement across the wave's direction per unit of the incident wave.
    ///
    /// It is 2 for SH waves and 0 for other waves. The displacement is along y if the wave runs along x.
    pub fn amplification_across(&self) -> f64 {
        self.transverse
    }

    /// The free field in which `record` is the horizontal motion at `origin` (m).
    ///
    /// `origin` is the edge of the base that the wave reaches first. The vertical motion is computed from the record.
    ///
    /// If the components are out of phase, the vertical one contains the Hilbert transform of the horizontal one over all
    /// time. The vertical motion begins before the record and decays after it as 1/t (its displacement changes as ln t if
    /// the record has a residual displacement). Its displacement is set to zero at t = 0, but its velocity is not zero
    /// there ([`FreeField::velocity`](super::FreeField::velocity) returns it). This velocity acts as a jolt at the start
    /// of a run. Quiet time before the record makes the jolt small and changes nothing else: see [`Record::padded`]. The
    /// record must end at rest: see [`Baseline`](super::Baseline).
    ///
    /// ```
    /// use basemat::{Soil, motion::{Baseline, FreeField, PlaneWave, el_centro_1940}};
    /// let wave = PlaneWave::rayleigh(Soil::new(80.0e6, 1.0 / 3.0, 1900.0)?);
    /// let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 })?;
    /// let jolt = |quiet| -> basemat::Result<f64> {
    ///     Ok(wave.field_from_horizontal(&record.padded(quiet, 0.0)?, 0.0)?.velocity(0.0, 0.0)[1].abs())
    /// };
    /// assert!(jolt(20.0)? < 0.1 * jolt(0.0)?);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if the horizontal component is less than a tenth of the vertical one
    /// (SV near 45°, P near the vertical), or if it is out of phase and the record's last velocity is above 1 % of
    /// its peak; also if `origin` is not finite.
    pub fn field_from_horizontal(&self, record: &Record, origin: f64) -> Result<TravellingWave> {
        let quantity = "horizontal component of the wave over the other one";
        self.field(
            record,
            origin,
            false,
            component_ratio(quantity, self.vertical, self.horizontal)?,
        )
    }

    /// The free field in which `record` is the vertical motion at `origin`.
    ///
    /// As for [`PlaneWave::field_from_horizontal`].
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if the vertical component is less than a tenth of the horizontal one (SV
    /// near the vertical and the critical angle, P near grazing for ν = 0), and as for
    /// [`PlaneWave::field_from_horizontal`].
    pub fn field_from_vertical(&self, record: &Record, origin: f64) -> Result<TravellingWave> {
        let quantity = "vertical component of the wave over the other one";
        self.field(record, origin, true, component_ratio(quantity, self.horizontal, self.vertical)?)
    }

    /// The free field of a record, and of the other component by its ratio to the record.
    fn field(
        &self,
        record: &Record,
        origin: f64,
        is_record_vertical: bool,
        component_ratio: Complex,
    ) -> Result<TravellingWave> {
        if component_ratio.im != 0.0 {
            let field = OutOfPhase::new(record, is_record_vertical, component_ratio)?;
            return TravellingWave::new(field, self.apparent_velocity(), origin);
        }
        let prescribed_record = Some(record.clone());
        let other_record = Some(record.scaled(component_ratio.re)?);
        let field = if is_record_vertical {
            VerticalIncidence { horizontal: other_record, vertical: prescribed_record }
        } else {
            VerticalIncidence { horizontal: prescribed_record, vertical: other_record }
        };
        TravellingWave::new(field, self.apparent_velocity(), origin)
    }

    /// The free field in which `record` is the motion across an SH wave's direction.
    ///
    /// As for [`PlaneWave::field_from_horizontal`]; [`TravellingWave::with_azimuth`] rotates it.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for waves that do not move the ground across, and an origin that is not
    /// finite.
    pub fn field_from_across(&self, record: &Record, origin: f64) -> Result<TravellingWave> {
        let quantity = "component of the wave across its direction";
        check_prescribed(quantity, self.transverse, self.horizontal.abs() + self.vertical.abs())?;
        let field = Triaxial { y: Some(record.clone()), ..Triaxial::default() };
        TravellingWave::new(field, self.apparent_velocity(), origin)
    }
}

/// Returns `angle`, or an error unless it is an angle of incidence from below.
fn check_angle(angle: f64) -> Result<f64> {
    let needed = "between -pi/2 and pi/2";
    require("angle of incidence", angle, angle.abs() < FRAC_PI_2, needed)
}

/// Slownesses p, a and b (s/m), g and R of the table above, for one wave.
struct Slownesses {
    p: f64,
    a: Complex,
    b: Complex,
    g: f64,
    /// R, which is not zero.
    rayleigh: Complex,
}

impl Slownesses {
    /// Slownesses under a P or an S wave of this `speed` (m/s) at `angle` (rad) from the vertical.
    fn new(soil: Soil, angle: f64, speed: f64) -> Result<Self> {
        let p = check_angle(angle)?.sin() / speed;
        let a = vertical_slowness(soil.pressure_wave_speed(), p, angle, speed);
        let b = vertical_slowness(soil.shear_wave_speed(), p, angle, speed);
        let g = soil.shear_wave_speed().powi(-2) - 2.0 * p * p;
        let rayleigh = Complex::real(g * g) + (a * b).scale(4.0 * p * p);
        let zero_limit = RAYLEIGH_ZERO_TOLERANCE * soil.shear_wave_speed().powi(-4);
        require(
            "angle of incidence",
            angle,
            rayleigh.abs() > zero_limit,
            "not the critical angle",
        )?;
        Ok(Self { p, a, b, g, rayleigh })
    }
}

/// Vertical slowness of a wave of speed `wave_speed`, incident or reflected.
///
/// `angle` and `incident_speed`: of the incident wave.
fn vertical_slowness(wave_speed: f64, p: f64, angle: f64, incident_speed: f64) -> Complex {
    let is_incident = wave_speed == incident_speed;
    if is_incident {
        // This form avoids cancellation.
        Complex::real(angle.cos() / incident_speed)
    } else {
        Complex::real(wave_speed.powi(-2) - p * p).sqrt()
    }
}

/// Ratio of the other component to the prescribed one, or an error if the prescribed one is too small.
fn component_ratio(
    quantity: &'static str,
    other_component: Complex,
    prescribed_component: Complex,
) -> Result<Complex> {
    check_prescribed(quantity, prescribed_component.abs(), other_component.abs())?;
    Ok(other_component / prescribed_component)
}

/// Error if the prescribed component is too small beside the other one.
pub(crate) fn check_prescribed(
    quantity: &'static str,
    prescribed_magnitude: f64,
    other_magnitude: f64,
) -> Result<()> {
    let larger_magnitude = other_magnitude.max(prescribed_magnitude);
    let fraction =
        if larger_magnitude == 0.0 { 0.0 } else { prescribed_magnitude / larger_magnitude };
    let is_large_enough = fraction > MIN_PRESCRIBED_RATIO;
    require(quantity, fraction, is_large_enough, "above 0.1 to be prescribed").map(drop)
}
