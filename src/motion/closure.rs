//! A free field from two closures.

use super::FreeField;

type Field = Box<dyn Fn(f64, f64) -> [f64; 2] + Send>;

/// Free field from a closure for the displacement and one for the velocity.
///
/// Both take `(x, time)` (m, s) and return `[horizontal, vertical up]` (m, m/s). They are asked
/// only for time > 0; at and before t = 0 the field is zero. The velocity must be the time
/// derivative of the displacement, and the displacement should start from zero: what it is just
/// after t = 0 comes as a jump.
///
/// A wave that runs to the right at 1000 m/s:
/// ```
/// use basemat::motion::{FreeField, FreeFieldFn};
/// let phase = |x: f64, t: f64| (t - x / 1000.0).max(0.0);
/// let wave = FreeFieldFn::new(
///     move |x, t| [phase(x, t).powi(2), 0.0],
///     move |x, t| [2.0 * phase(x, t), 0.0],
/// );
/// assert_eq!(wave.displacement(500.0, 2.5), [4.0, 0.0]);
/// assert_eq!(wave.velocity(500.0, 2.5), [4.0, 0.0]);
/// assert_eq!(wave.displacement(-500.0, 0.0), [0.0, 0.0]);
/// ```
pub struct FreeFieldFn {
    displacement: Field,
    velocity: Field,
}

impl FreeFieldFn {
    /// Free field from its `displacement(x, time)` and `velocity(x, time)`.
    pub fn new(
        displacement: impl Fn(f64, f64) -> [f64; 2] + Send + 'static,
        velocity: impl Fn(f64, f64) -> [f64; 2] + Send + 'static,
    ) -> Self {
        Self { displacement: Box::new(displacement), velocity: Box::new(velocity) }
    }
}

impl std::fmt::Debug for FreeFieldFn {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("FreeFieldFn").finish_non_exhaustive()
    }
}

impl FreeField for FreeFieldFn {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        if time > 0.0 { (self.displacement)(x, time) } else { [0.0; 2] }
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        if time > 0.0 { (self.velocity)(x, time) } else { [0.0; 2] }
    }
}
