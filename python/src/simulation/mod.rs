//! The simulation, its state and its runs.

mod build;
mod class;
mod face;
mod foundation;
mod given;
mod load;
mod options;
mod scheme;
mod state;
mod watched;

pub(crate) use class::PySimulation;
pub(crate) use face::PyFaceForces;
pub(crate) use foundation::PyFoundation;
pub(crate) use load::PyLoad;
pub(crate) use options::{PyInitialConditions, PyResultOptions, PyServiceLimits, PySolverOptions};
pub(crate) use scheme::PyTimeScheme;
pub(crate) use state::{PyCheckpoint, PyState, PySteps};
