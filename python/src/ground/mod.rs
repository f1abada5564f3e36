//! Grounds.

mod base;
mod elastic;
mod impedance;
mod plan;
mod spring;
mod strip;

pub(crate) use base::PyGround;
pub(crate) use elastic::{PyElasticGround, PySharedKernels};
pub(crate) use impedance::PyImpedances;
pub(crate) use plan::PyPlan;
pub(crate) use spring::PySpringGround;
pub(crate) use strip::PyStrip;
