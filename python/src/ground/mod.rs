//! Grounds.

mod elastic;
mod plan;
mod spring;
mod strip;
mod superclass;

pub(crate) use elastic::{PyElasticGround, PySharedKernels};
pub(crate) use plan::PyPlan;
pub(crate) use spring::PySpringGround;
pub(crate) use strip::PyStrip;
pub(crate) use superclass::{PyGround, PyImpedances};
