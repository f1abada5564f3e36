//! The free field that does not move.

use super::FreeField;

/// Ground that stays at rest, for structures driven by forces only.
///
/// ```
/// use basemat::motion::{AtRest, FreeField};
/// assert_eq!(AtRest.displacement(3.0, 1.0), [0.0, 0.0]);
/// assert_eq!(AtRest.velocity(3.0, 1.0), [0.0, 0.0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AtRest;

impl FreeField for AtRest {
    fn displacement(&self, _x: f64, _time: f64) -> [f64; 2] {
        [0.0; 2]
    }

    fn velocity(&self, _x: f64, _time: f64) -> [f64; 2] {
        [0.0; 2]
    }
}
