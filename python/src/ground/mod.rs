//! Grounds.

mod base;
mod half_plane;
mod history;
mod impedance;
mod layered;
mod spring;
mod strip;

pub(crate) use base::PyGround;
pub(crate) use half_plane::PyHalfPlaneGround;
pub(crate) use history::PySharedKernels;
pub(crate) use impedance::PyImpedances;
pub(crate) use layered::PyLayeredGround;
pub(crate) use spring::PySpringGround;
pub(crate) use strip::PyStrip;
