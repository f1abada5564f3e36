//! Soil: elastic constants, damping laws, profiles of horizontal layers, strength and bearing capacity.

mod bearing_capacity;
mod bearing_factors;
#[cfg(feature = "serde")]
mod damping_form;
mod masing_curves;
mod maxwell;
mod nonnegative_least_squares;
mod profile;
mod profile_moduli;
mod published_curves;
mod relaxation;
mod strain_backbone;
mod strain_curves;
mod strength;
mod water_table;

#[doc(inline)]
pub use crate::error::SoilError;
pub use bearing_capacity::{FootingLoad, RockingCapacity, ShallowFooting};
pub use bearing_factors::BearingFactors;
pub use maxwell::GeneralizedMaxwell;
pub(crate) use profile::layer_name;
pub use profile::{Bedrock, SoilLayer, SoilProfile};
pub use relaxation::{Elastic, Hysteretic, KelvinVoigt, Kjartansson, Relaxation};
pub(crate) use strain_curves::ResolvedCurves;
pub use strain_curves::StrainCurves;
pub use strength::SoilStrength;
pub use water_table::WaterTable;

use crate::error::{Result, finite, positive, require};

/// Homogeneous, isotropic, linear elastic soil: shear modulus, Poisson's ratio, density.
///
/// ```
/// let soil = basemat::Soil::new(80.0e6, 0.25, 2000.0)?;
/// assert_eq!(soil.shear_wave_speed(), 200.0);
/// assert!((soil.pressure_wave_speed() - 200.0 * 3.0_f64.sqrt()).abs() < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "SoilForm"))]
pub struct Soil {
    shear_modulus: f64,
    poisson: f64,
    density: f64,
}

validated! {
    Soil as SoilForm { shear_modulus: f64, poisson: f64, density: f64 }
    => Soil::new(shear_modulus, poisson, density)
}

impl Soil {
    /// Soil from its shear modulus μ (Pa), Poisson's ratio ν and density ρ (kg/m³).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless μ and ρ are finite and above zero and −1 < ν < 0.5.
    pub fn new(shear_modulus: f64, poisson: f64, density: f64) -> Result<Self> {
        positive("shear modulus of the soil", shear_modulus)?;
        positive("density of the soil", density)?;
        let is_in_range = poisson > -1.0 && poisson < 0.5;
        require("Poisson's ratio of the soil", poisson, is_in_range, "above -1 and below 0.5")?;
        let soil = Self { shear_modulus, poisson, density };
        positive("shear wave speed of the soil", soil.shear_wave_speed())?;
        finite("pressure wave speed of the soil", soil.pressure_wave_speed())?;
        Ok(soil)
    }

    /// Soil from its shear wave speed `c_S` (m/s), Poisson's ratio ν and density ρ (kg/m³).
    ///
    /// ```
    /// let soil = basemat::Soil::from_shear_wave_speed(200.0, 0.25, 2000.0)?;
    /// assert_eq!(soil.shear_modulus(), 80.0e6);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) as for [`Soil::new`].
    pub fn from_shear_wave_speed(speed: f64, poisson: f64, density: f64) -> Result<Self> {
        positive("shear wave speed of the soil", speed)?;
        positive("density of the soil", density)?;
        Self::new(modulus_of_speed(density, speed)?, poisson, density)
    }

    /// Soil from its wave speeds `c_S`, `c_P` (m/s) and density ρ (kg/m³).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) as for [`Soil::new`]; −1 < ν < 0.5 means `c_P` > 2/√3 · `c_S`.
    pub fn from_wave_speeds(shear: f64, pressure: f64, density: f64) -> Result<Self> {
        positive("shear wave speed", shear)?;
        positive("pressure wave speed", pressure)?;
        positive("density of the soil", density)?;
        let speed_ratio_squared = (shear / pressure).powi(2);
        let poisson = (1.0 - 2.0 * speed_ratio_squared) / (2.0 * (1.0 - speed_ratio_squared));
        Self::new(modulus_of_speed(density, shear)?, poisson, density)
    }

    /// Shear modulus μ, Pa.
    pub fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    /// Poisson's ratio ν.
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// Density ρ, kg/m³.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// Shear (S) wave speed c₂ = √(μ/ρ), m/s.
    pub fn shear_wave_speed(&self) -> f64 {
        (self.shear_modulus / self.density).sqrt()
    }

    /// Pressure (P) wave speed c₁ = c₂/a, m/s.
    pub fn pressure_wave_speed(&self) -> f64 {
        self.shear_wave_speed() / self.speed_ratio_squared().sqrt()
    }

    /// a² = (c₂/c₁)² = (1−2ν)/(2(1−ν)), between 0 and 3/4.
    pub(crate) fn speed_ratio_squared(&self) -> f64 {
        (1.0 - 2.0 * self.poisson) / (2.0 * (1.0 - self.poisson))
    }
}

/// Shear modulus from density and shear wave speed, Pa.
fn modulus_of_speed(density: f64, speed: f64) -> Result<f64> {
    positive("shear modulus of the soil, by its density and speed", density * speed * speed)
}
