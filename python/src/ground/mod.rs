//! Grounds.

mod base;
mod half_plane;
mod history;
mod spring;
mod strip;

pub(crate) use base::PyGround;
pub(crate) use half_plane::PyHalfPlaneGround;
pub(crate) use history::PySharedKernels;
pub(crate) use spring::PySpringGround;
pub(crate) use strip::PyStrip;
