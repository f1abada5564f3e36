//! Strength of drained soil, and the earth pressures on a wall that follow from it.

use std::f64::consts::FRAC_PI_2;

use crate::error::{Result, not_negative, require};

/// Strength of drained soil: friction angle φ, cohesion c, and friction angle δ between soil and a wall.
///
/// The bearing capacity of a [`ShallowFooting`](crate::soil::ShallowFooting) and the pressures on a wall follow from
/// this strength. The wall pressures are those of Coulomb's wedges with plane slip surfaces, beside a vertical wall
/// under level ground; without wall friction they are Rankine's. Strengths and stresses are effective values.
///
/// ```
/// use basemat::soil::SoilStrength;
/// let sand = SoilStrength::new(30.0_f64.to_radians())?;
/// let [active, passive] = sand.pressure_ratios();
/// assert!((active - 1.0 / 3.0).abs() < 1e-12 && (passive - 3.0).abs() < 1e-12);
/// // Under 40 kPa of soil.
/// let [active, passive] = sand.with_cohesion(2.0e3)?.pressures(40.0e3);
/// assert!((active - 11.024e3).abs() < 1.0 && (passive - 126.928e3).abs() < 1.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "SoilStrengthForm"))]
pub struct SoilStrength {
    friction_angle: f64,
    cohesion: f64,
    wall_friction_angle: f64,
}

validated! {
    SoilStrength as SoilStrengthForm {
        friction_angle: f64,
        cohesion: f64,
        wall_friction_angle: f64,
    }
    => SoilStrength::new(friction_angle)?.with_cohesion(cohesion)?.with_wall_friction(wall_friction_angle)
}

impl SoilStrength {
    /// Soil with a friction angle (rad), without cohesion, beside a frictionless wall.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for an angle below zero, or of π/2 and more.
    pub fn new(friction_angle: f64) -> Result<Self> {
        let is_in_range = (0.0..FRAC_PI_2).contains(&friction_angle);
        require(
            "friction angle of the soil (rad)",
            friction_angle,
            is_in_range,
            "from 0 to below π/2",
        )?;
        Ok(Self { friction_angle, cohesion: 0.0, wall_friction_angle: 0.0 })
    }

    /// Sets the cohesion, Pa; it does not act between soil and wall.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a cohesion below zero or not finite.
    pub fn with_cohesion(self, cohesion: f64) -> Result<Self> {
        Ok(Self { cohesion: not_negative("cohesion of the soil", cohesion)?, ..self })
    }

    /// Sets the friction angle (rad) between soil and wall, from 0 to the friction angle of the soil.
    ///
    /// If the angle is above about a third of the soil's angle, slip surfaces are curved, and plane wedges overestimate
    /// the passive pressure (Terzaghi 1943). Use no larger angle.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for an angle below zero, above the soil's, or so large that no plane wedge
    /// slides at the passive limit.
    pub fn with_wall_friction(self, wall_friction_angle: f64) -> Result<Self> {
        let quantity = "friction angle of the wall (rad)";
        let is_in_range = (0.0..=self.friction_angle).contains(&wall_friction_angle);
        let range_requirement = "from 0 to the friction angle of the soil";
        require(quantity, wall_friction_angle, is_in_range, range_requirement)?;
        let strength = Self { wall_friction_angle, ..self };
        let has_sliding_wedge = strength.coulomb_root() < 1.0;
        let wedge_requirement = "smaller: no plane wedge slides at the passive limit";
        require(quantity, wall_friction_angle, has_sliding_wedge, wedge_requirement)?;
        Ok(strength)
    }

    /// Friction angle φ, rad.
    pub fn friction_angle(&self) -> f64 {
        self.friction_angle
    }

    /// Cohesion c, Pa.
    pub fn cohesion(&self) -> f64 {
        self.cohesion
    }

    /// Root term of Coulomb's earth-pressure coefficients, √(sin(φ + δ) sin φ / cos δ).
    fn coulomb_root(&self) -> f64 {
        let Self { friction_angle: phi, wall_friction_angle: delta, .. } = *self;
        ((phi + delta).sin() * phi.sin() / delta.cos()).sqrt()
    }

    /// Active and passive horizontal pressure over the vertical pressure, without cohesion.
    ///
    /// K = (cos φ/(1 ± √(sin(φ + δ) sin φ/cos δ)))² is the component of Coulomb's thrust normal to the wall (1776, in the
    /// form of Müller-Breslau 1906). The thrust is inclined at δ, and larger by the factor 1/cos δ. Without wall friction
    /// K = tan²(π/4 ∓ φ/2) (Rankine 1857).
    pub fn pressure_ratios(&self) -> [f64; 2] {
        let coulomb_root = self.coulomb_root();
        [1.0 + coulomb_root, 1.0 - coulomb_root]
            .map(|denominator| (self.friction_angle.cos() / denominator).powi(2))
    }

    /// Active and passive pressure on a wall (Pa) under a `vertical` pressure of the soil, Pa.
    ///
    /// K σ_v ∓ 2c √K (EN 1997-1:2004, eqs. C.1 and C.2, without adhesion). The active pressure is below zero where the
    /// soil is stable without a wall because of its cohesion.
    pub fn pressures(&self, vertical: f64) -> [f64; 2] {
        let pressure_ratios = self.pressure_ratios();
        let cohesion_pressures = pressure_ratios.map(|ratio| 2.0 * self.cohesion * ratio.sqrt());
        [
            pressure_ratios[0] * vertical - cohesion_pressures[0],
            pressure_ratios[1] * vertical + cohesion_pressures[1],
        ]
    }

    /// Friction coefficient between soil and wall, tan δ.
    pub fn wall_friction(&self) -> f64 {
        self.wall_friction_angle.tan()
    }
}
