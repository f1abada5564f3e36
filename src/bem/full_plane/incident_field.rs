//! Waves from below, at depth.

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
