//! Grounds.

mod base;
mod elastic;
mod plan;
mod spring;
mod strip;

pub(crate) use base::{PyGround, PyImpedances};
pub(crate) use elastic::{PyElasticGround, PySharedKernels};
pub(crate) use plan::PyPlan;
pub(crate) use spring::PySpringGround;
pub(crate) use strip::PyStrip;
