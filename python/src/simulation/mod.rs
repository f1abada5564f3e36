//! The simulation, its state and its runs.

mod build;
mod class;
mod foundation;
mod interaction;
mod joint;
mod load;
mod options;
mod parts;
mod push_over;
mod run_reporter;
mod scheme;
mod solids;
mod state;

pub(crate) use class::PySimulation;
pub(crate) use foundation::{PyFaceForces, PyFoundation};
pub(crate) use joint::PyJointState;
pub(crate) use load::PyLoad;
pub(crate) use options::{PyInitialConditions, PyResultOptions, PyServiceLimits, PySolverOptions};
pub(crate) use scheme::PyTimeScheme;
pub(crate) use state::{PyCheckpoint, PyState, PySteps};
