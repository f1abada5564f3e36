//! Free fields that travel along the surface.

use super::Record;
use super::free_field::{FreeField, difference_velocity};
#[cfg(feature = "embedded")]
use crate::error::require_part;
use crate::error::{Result, finite, require};

/// Free field that travels along the surface: u(x, t) = u₀(t − (x − x₀)/c).
///
/// The field may travel in any horizontal direction.
///
/// ```
/// use basemat::motion::{FreeField, TravellingWave, el_centro_1940};
/// // 800 m/s along x, from x = −5 m: 8 m further the motion is 10 ms later.
/// let wave = TravellingWave::new(el_centro_1940(), 800.0, -5.0)?;
/// let origin_motion = wave.displacement(-5.0, 2.0);
/// let distant_motion = wave.displacement(3.0, 2.01);
/// assert!((origin_motion[0] - distant_motion[0]).abs() < 1e-15 && origin_motion[0] != 0.0);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct TravellingWave {
    /// Motion at the origin.
    field: Box<dyn FreeField>,
    /// Slowness in the direction of the wave, s/m.
    slowness: f64,
    /// Coordinate (m) in the direction of the wave at which the surface has the motion of `field`.
    origin: f64,
    /// Cosine of the azimuth.
    cos: f64,
    /// Sine of the azimuth.
    sin: f64,
}

/// Slowness and origin of a wave that runs along x.
#[cfg(feature = "embedded")]
pub(crate) struct SlownessAndOrigin {
    /// Slowness along x, s/m.
    pub(crate) slowness: f64,
    /// The x at which the wave has the motion of its record, m.
    pub(crate) origin: f64,
}

short_debug! {
    TravellingWave; self; apparent_velocity: 1.0 / self.slowness, origin: self.origin
}

impl TravellingWave {
    /// Creates a wave along x, from its motion `field` at `origin` (m).
    ///
    /// `apparent_velocity`: c, m/s, to the right if positive; if it is infinite, all points move at once. Points that the
    /// wave reaches before `origin` move before t = 0, so that their motion starts with a jump: let `origin` be the edge of
    /// the base that the wave reaches first.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a velocity of zero or NaN, or an origin that is not finite.
    pub fn new(
        field: impl FreeField + 'static,
        apparent_velocity: f64,
        origin: f64,
    ) -> Result<Self> {
        let slowness = 1.0 / apparent_velocity;
        let needed = "not zero (infinite: everywhere at once)";
        require("apparent velocity", apparent_velocity, slowness.is_finite(), needed)?;
        let origin = finite("origin of a wave", origin)?;
        Ok(Self { field: Box::new(field), slowness, origin, cos: 1.0, sin: 0.0 })
    }

    /// Rotates this wave about the vertical axis, for a ground in plan.
    ///
    /// The wave runs in the direction `azimuth` (rad), counter-clockwise from x as seen from above. Its components
    /// along and across that direction rotate with it. `origin` is the distance from (0, 0) in that direction. A ground in
    /// the plane moves with the components along x and up, at y = 0.
    ///
    /// ```
    /// use basemat::motion::{FreeField, PlaneWave, el_centro_1940};
    /// use basemat::Soil;
    /// use std::f64::consts::FRAC_PI_2;
    /// // SH at 30° from the vertical, running away from the reader: it moves the ground to the left.
    /// let soil = Soil::from_shear_wave_speed(250.0, 0.3, 1900.0)?;
    /// let wave = PlaneWave::sh(soil, 30.0_f64.to_radians())?;
    /// let field = wave.field_from_across(&el_centro_1940(), -10.0)?.with_azimuth(FRAC_PI_2)?;
    /// let [x, y, up] = field.displacement_at([3.0, -10.0], 4.0);
    /// assert!((x + el_centro_1940().at(4.0).displacement).abs() < 1e-15);
    /// assert!(y.abs() < 1e-15 && up == 0.0);
    /// // The wave passes a mat of 20 m in 40 ms, and the mat twists.
    /// let later = field.displacement_at([3.0, 10.0], 4.04);
    /// assert!((x - later[0]).abs() < 1e-15);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `azimuth` is finite.
    pub fn with_azimuth(self, azimuth: f64) -> Result<Self> {
        finite("azimuth of a wave", azimuth)?;
        Ok(Self { cos: azimuth.cos(), sin: azimuth.sin(), ..self })
    }

    /// Slowness and origin of a wave that runs along x, or an error.
    #[cfg(feature = "embedded")]
    pub(crate) fn slowness_along_x(&self) -> Result<SlownessAndOrigin> {
        let needed =
            "none: waves of a ground in the plane run along x and move the ground along x and up";
        require_part("motion of a wave along y", !self.moves_across(), needed)?;
        Ok(SlownessAndOrigin { slowness: self.slowness * self.cos, origin: self.origin * self.cos })
    }

    /// Time (s) that the wave takes from the origin to a point.
    fn delay(&self, [x, y]: [f64; 2]) -> f64 {
        self.slowness * (self.cos * x + self.sin * y - self.origin)
    }
}

impl FreeField for TravellingWave {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        let displacement = self.displacement_at([x, 0.0], time);
        [displacement[0], displacement[2]]
    }

    fn displacement_at(&self, [x, y]: [f64; 2], time: f64) -> [f64; 3] {
        let Self { cos, sin, .. } = *self;
        let point_in_field = [self.origin, cos * y - sin * x];
        let [radial, transverse, up] =
            self.field.displacement_at(point_in_field, time - self.delay([x, y]));
        [cos * radial - sin * transverse, sin * radial + cos * transverse, up]
    }

    fn moves_across(&self) -> bool {
        // The sine of π is not exactly zero.
        self.sin.abs() > f64::EPSILON || self.field.moves_across()
    }

    fn records(&self) -> Vec<&Record> {
        self.field.records()
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        if self.cos == 1.0 && self.sin == 0.0 {
            self.field.velocity(self.origin, time - self.delay([x, 0.0]))
        } else {
            difference_velocity(self, x, time)
        }
    }
}
