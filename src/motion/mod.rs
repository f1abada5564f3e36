//! Ground motions: records, and the free field that they stand for.

/// Motion of the ground surface without the structure.
pub trait FreeField: Send {
    /// Displacement `[horizontal, vertical up]` (m) at surface point `x` (m) and `time` (s); zero
    /// at and before t = 0.
    fn displacement(&self, x: f64, time: f64) -> [f64; 2];

    /// Velocity `[horizontal, vertical up]` (m/s) at surface point `x` and `time`.
    fn velocity(&self, x: f64, time: f64) -> [f64; 2];
}
