//! Motion and stress of waves from below, at any depth.

use crate::error::{Result, not_negative};
use crate::motion::FreeField;
use crate::soil::Soil;

/// Motion and stress of the half-plane without trench, canyon or foundation, at any depth.
///
/// Components are (x, z) with **z down**; the flat surface z = 0 is free of traction.
#[auto_impl::auto_impl(Box)]
pub trait IncidentField: Send {
    /// Displacement `[x, z]` (m) at the point (x, z), m, and `time`, s; zero at and before t = 0.
    fn displacement(&self, point: [f64; 2], time: f64) -> [f64; 2];

    /// Stress `[xx, zz, xz]` at the same point and time, Pa, tension positive.
    fn stress(&self, point: [f64; 2], time: f64) -> [f64; 3];
}

/// Vertically incident S and P waves and their reflections from the flat surface.
///
/// The field follows from the motion s of the surface: u(z,t) = ½[s(t−t₀+z/c) + s(t−t₀−z/c)], with c = c₂ for the
/// horizontal and c₁ for the vertical component. The surface moves t₀ later than its record, so that the soil down to
/// the depth c₂t₀ is at rest at t = 0.
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
    /// Delay t₀ of the surface relative to its record, s.
    delay: f64,
}

short_debug! { VerticalWaves; self; soil: self.soil, delay: self.delay }

impl VerticalWaves {
    /// Waves with this `surface` motion at x = 0, for points down to `depth` (m).
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

    /// Displacement component at a depth: mean of an upgoing and a downgoing wave.
    fn displacement_component(&self, component: usize, speed: f64, depth: f64, time: f64) -> f64 {
        let record_time = time - self.delay;
        let travel_time = depth / speed;
        let upgoing = self.surface.displacement(0.0, record_time + travel_time)[component];
        let downgoing = self.surface.displacement(0.0, record_time - travel_time)[component];
        0.5 * (upgoing + downgoing)
    }

    /// Derivative of a displacement component with respect to depth.
    fn depth_derivative(&self, component: usize, speed: f64, depth: f64, time: f64) -> f64 {
        let record_time = time - self.delay;
        let travel_time = depth / speed;
        let upgoing = self.surface.velocity(0.0, record_time + travel_time)[component];
        let downgoing = self.surface.velocity(0.0, record_time - travel_time)[component];
        0.5 * (upgoing - downgoing) / speed
    }
}

impl IncidentField for VerticalWaves {
    fn displacement(&self, point: [f64; 2], time: f64) -> [f64; 2] {
        let shear = self.soil.shear_wave_speed();
        let pressure = self.soil.pressure_wave_speed();
        let horizontal = self.displacement_component(0, shear, point[1], time);
        let vertical = self.displacement_component(1, pressure, point[1], time);
        // The record is positive up, z is positive down.
        [horizontal, -vertical]
    }

    fn stress(&self, point: [f64; 2], time: f64) -> [f64; 3] {
        let shear = self.soil.shear_wave_speed();
        let pressure = self.soil.pressure_wave_speed();
        let mu = self.soil.shear_modulus();
        let nu = self.soil.poisson();
        let lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
        let shear_strain = self.depth_derivative(0, shear, point[1], time);
        let vertical_strain = -self.depth_derivative(1, pressure, point[1], time);
        [lambda * vertical_strain, (lambda + 2.0 * mu) * vertical_strain, mu * shear_strain]
    }
}
