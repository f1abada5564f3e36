//! Grounds.

mod base;
mod elastic;
mod impedance;
mod spring;
mod strip;

pub(crate) use base::PyGround;
pub(crate) use elastic::{PyElasticGround, PySharedKernels};
pub(crate) use impedance::PyImpedances;
pub(crate) use spring::PySpringGround;
pub(crate) use strip::PyStrip;
