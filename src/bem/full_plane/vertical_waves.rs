//! Vertically incident waves from below, at depth.

use super::IncidentField;
use crate::error::{Result, not_negative};
use crate::motion::FreeField;
use crate::soil::Soil;

/// Vertically incident S and P waves and their reflections from the flat surface.
///
/// They follow from the motion s of the surface: u(z,t) = ½[s(t−t₀+z/c) + s(t−t₀−z/c)], with c = c₂ for the
/// horizontal and c₁ for the vertical component. The surface moves t₀ later than its record, so that down to
/// the depth c₂t₀ nothing moves at t = 0.
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::full_plane::{IncidentField, VerticalWaves};
/// use basemat::motion::RickerDisplacement;
/// let soil = Soil::new(80.0e6, 0.25, 2000.0)?;
/// let pulse = RickerDisplacement::new(0.1, 0.2, 1.0)?;
/// // At a depth of 20 m the wave arrives 0.1 s before it reaches the surface.
/// let waves = VerticalWaves::new(soil, pulse, 20.0)?;
/// let surface = waves.displacement([3.0, 0.0], 1.1);
/// assert!((surface[0] - 0.1).abs() < 1e-8);
/// assert_eq!(waves.stress([3.0, 0.0], 1.1), [0.0; 3]);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct VerticalWaves {
    soil: Soil,
    surface: Box<dyn FreeField>,
    delay: f64,
}

short_debug! { VerticalWaves; self; soil: self.soil, delay: self.delay }

impl VerticalWaves {
    /// Waves whose `surface` motion (at x = 0) is given, for points down to `depth` (m).
    ///
    /// # Errors
    /// [`crate::Error::Input`] unless the depth is finite and not below zero.
    pub fn new(soil: Soil, surface: impl FreeField + 'static, depth: f64) -> Result<Self> {
        let delay = not_negative("depth of the incident waves", depth)? / soil.shear_wave_speed();
        Ok(Self { soil, surface: Box::new(surface), delay })
    }

    /// Delay of the surface relative to its record, s.
    pub fn delay(&self) -> f64 {
        self.delay
    }

    fn speeds(&self) -> [f64; 2] {
        [self.soil.shear_wave_speed(), self.soil.pressure_wave_speed()]
    }
}

impl IncidentField for VerticalWaves {
    fn displacement(&self, point: [f64; 2], time: f64) -> [f64; 2] {
        let now = time - self.delay;
        let at = |k: usize| {
            let lag = point[1] / self.speeds()[k];
            let s = |t: f64| self.surface.displacement(0.0, t)[k];
            0.5 * (s(now + lag) + s(now - lag))
        };
        // The record is positive up, z is positive down.
        [at(0), -at(1)]
    }

    fn stress(&self, point: [f64; 2], time: f64) -> [f64; 3] {
        let now = time - self.delay;
        let slope = |k: usize| {
            let c = self.speeds()[k];
            let lag = point[1] / c;
            let v = |t: f64| self.surface.velocity(0.0, t)[k];
            0.5 * (v(now + lag) - v(now - lag)) / c
        };
        let mu = self.soil.shear_modulus();
        let nu = self.soil.poisson();
        let lame = 2.0 * mu * nu / (1.0 - 2.0 * nu);
        let strain = -slope(1);
        [lame * strain, (lame + 2.0 * mu) * strain, mu * slope(0)]
    }
}
