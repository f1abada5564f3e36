//! A free field from closures.

use super::{FreeField, differenced};

type Field = Box<dyn Fn(f64, f64) -> [f64; 2] + Send>;

/// Free field from a closure for the displacement, and one for the velocity if it is known.
///
/// Both take `(x, time)` (m, s) and return `[horizontal, vertical up]` (m, m/s). They are asked
/// only for time > 0; at and before t = 0 the field is zero. The displacement should start from
/// zero: what it is just after t = 0 comes as a jump.
///
/// A wave that runs to the right at 1000 m/s:
/// ```
/// use basemat::motion::{FreeField, FreeFieldFn};
/// let phase = |x: f64, t: f64| (t - x / 1000.0).max(0.0);
/// let wave = FreeFieldFn::new(move |x, t| [phase(x, t).powi(2), 0.0]);
/// assert_eq!(wave.displacement(500.0, 2.5), [4.0, 0.0]);
/// assert_eq!(wave.displacement(-500.0, 0.0), [0.0, 0.0]);
/// assert!((wave.velocity(500.0, 2.5)[0] - 4.0).abs() < 1e-9);
/// let exact = wave.with_velocity(move |x, t| [2.0 * phase(x, t), 0.0]);
/// assert_eq!(exact.velocity(500.0, 2.5), [4.0, 0.0]);
/// ```
pub struct FreeFieldFn {
    displacement: Field,
    velocity: Option<Field>,
}

impl FreeFieldFn {
    /// Free field from its `displacement(x, time)`; its velocity is that of
    /// [`FreeField::velocity`] by default, a difference.
    pub fn new(displacement: impl Fn(f64, f64) -> [f64; 2] + Send + 'static) -> Self {
        Self { displacement: Box::new(displacement), velocity: None }
    }

    /// With its `velocity(x, time)`, the time derivative of the displacement.
    #[must_use]
    pub fn with_velocity(self, velocity: impl Fn(f64, f64) -> [f64; 2] + Send + 'static) -> Self {
        Self { velocity: Some(Box::new(velocity)), ..self }
    }
}

short_debug! { FreeFieldFn; self; exact_velocity: self.velocity.is_some() }

impl FreeField for FreeFieldFn {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        if time > 0.0 { (self.displacement)(x, time) } else { [0.0; 2] }
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        match &self.velocity {
            None => differenced(self, x, time),
            Some(velocity) if time > 0.0 => velocity(x, time),
            Some(_) => [0.0; 2],
        }
    }
}
