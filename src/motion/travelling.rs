//! Motions that run along the surface.

use super::FreeField;
use crate::error::{Error, Result, finite};

/// A free field that arrives later the farther along: u(x, t) = u₀(t − (x − x₀)/c).
///
/// ```
/// use basemat::motion::{FreeField, TravellingWave, el_centro_1940};
/// // 800 m/s along x, first at x = −5 m.
/// let wave = TravellingWave::new(el_centro_1940(), 800.0, -5.0)?;
/// let first = wave.displacement(-5.0, 2.0);
/// let later = wave.displacement(3.0, 2.01);
/// assert!((first[0] - later[0]).abs() < 1e-15 && first[0] != 0.0);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct TravellingWave {
    field: Box<dyn FreeField>,
    slowness: f64,
    origin: f64,
}

short_debug! {
    TravellingWave; self; apparent_velocity: 1.0 / self.slowness, origin: self.origin
}

impl TravellingWave {
    /// `field` as it is at `origin` (m), running along x with the apparent velocity c
    /// (`apparent_velocity`, m/s): to the right if positive, everywhere at once if infinite.
    ///
    /// Points that the wave reaches before `origin` would have moved before t = 0, and start with
    /// a jump: let `origin` be the edge of the base that is reached first.
    ///
    /// # Errors
    /// [`Error::Input`] for a velocity of zero or NaN, or an origin that is not finite.
    pub fn new(
        field: impl FreeField + 'static,
        apparent_velocity: f64,
        origin: f64,
    ) -> Result<Self> {
        let slowness = 1.0 / apparent_velocity;
        if !slowness.is_finite() {
            return Err(Error::Input {
                quantity: "apparent velocity",
                value: apparent_velocity,
                needed: "not zero (infinite: everywhere at once)",
            });
        }
        Ok(Self { field: Box::new(field), slowness, origin: finite("origin of a wave", origin)? })
    }

    /// Time (s) at which the motion of `origin` reaches `x`.
    pub fn delay(&self, x: f64) -> f64 {
        self.slowness * (x - self.origin)
    }
}

impl FreeField for TravellingWave {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        self.field.displacement(self.origin, time - self.delay(x))
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        self.field.velocity(self.origin, time - self.delay(x))
    }
}
