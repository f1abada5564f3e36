//! Plane-strain elastodynamic fundamental solutions.
//!
//! A line load acts at the origin. The responses are displacements and tractions at an offset from the load. Components
//! are (x, z) with **z down**: index 0 is x, index 1 is z, and `u[i][j]` is component i due to a load in direction j.

pub(crate) mod branch;
#[cfg(feature = "full-plane")]
mod full_plane;
mod half_plane;
pub(crate) mod rayleigh;

#[cfg(feature = "full-plane")]
pub use full_plane::FullPlane;
pub use half_plane::{HalfPlane, Surface};
pub(crate) use rayleigh::Rayleigh;

use crate::error::Result;
use crate::soil::Soil;

/// Variation in time of the line load, of 1 N/m for [`Step`](Self::Step).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadHistory {
    /// δ(t): an impulse.
    Impulse,
    /// H(t): switched on at t = 0 and then constant.
    Step,
    /// t·H(t): growing linearly from t = 0.
    Ramp,
}

/// Response to line loads: `[i][j]` is component i due to a load in direction j.
pub(crate) type LoadResponse = [[f64; 2]; 2];

/// Displacements and tractions of an elastic plane or half-plane under a line load.
pub trait FundamentalSolution: Send + Sync {
    /// Soil of the plane or half-plane.
    fn soil(&self) -> Soil;

    /// Displacements (m for a step of 1 N/m) at `offset` (x, z; m) from the load, at `time` (s) after the start of the load.
    ///
    /// `u[i][j]` is displacement i due to a load in direction j; zero before the first arrival.
    ///
    /// # Errors
    /// [`crate::Error::Input`] if the offset is zero, not finite, or outside the domain of the solution.
    fn displacement(&self, offset: [f64; 2], time: f64, load: LoadHistory) -> Result<LoadResponse>;

    /// Tractions (Pa for a step of 1 N/m) at `offset` on the plane with the unit vector `normal`.
    ///
    /// `t[i][j]` is traction i due to a load in direction j.
    ///
    /// # Errors
    /// As for [`FundamentalSolution::displacement`], and if `normal` is not finite or outside the domain of the solution.
    fn traction(
        &self,
        offset: [f64; 2],
        normal: [f64; 2],
        time: f64,
        load: LoadHistory,
    ) -> Result<LoadResponse>;
}
