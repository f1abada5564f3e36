//! Python classes of grounds, their outlines and their impedances.

mod elastic;
mod near_field;
mod plan;
mod spring;
mod strip;
mod superclass;
mod trench;
mod trench_ground;

pub(crate) use elastic::{PyElasticGround, PySharedKernels};
pub(crate) use near_field::PyNearField;
pub(crate) use plan::PyPlan;
pub(crate) use spring::PySpringGround;
pub(crate) use strip::{PyStrip, new_ground};
pub(crate) use superclass::{PyGround, PyImpedances};
pub(crate) use trench::{PyTrench, PyTrenchElements, is_base_element};
pub(crate) use trench_ground::{PyKinematicMotions, PyTrenchGround};
