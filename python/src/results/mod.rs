//! Results of a run.

mod energy_balance;
mod interaction;
mod joint;
mod peak;
mod push_over;
mod rocking;
mod run;
mod series;
mod shape;
mod summary;
mod weight;

pub(crate) use energy_balance::PyEnergyBalance;
pub(crate) use interaction::{PyInteraction, PySystemMode};
pub(crate) use joint::{PyJointResults, joint_results};
pub(crate) use peak::{PyExtremes, PyPeak};
pub(crate) use push_over::PyPushOver;
pub(crate) use rocking::equivalent_damping;
pub(crate) use run::PyRun;
pub(crate) use series::element_units;
pub(crate) use shape::PyDeformedShape;
pub(crate) use summary::{PyServiceCheck, PySummary};
