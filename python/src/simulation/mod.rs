//! The simulation, its state and its runs.

mod build;
mod checkpoint;
mod class;
mod load;
mod scheme;
mod state;
mod steps;
mod watched;

pub(crate) use checkpoint::PyCheckpoint;
pub(crate) use class::PySimulation;
pub(crate) use load::PyLoad;
pub(crate) use scheme::PyTimeScheme;
pub(crate) use state::{PyFoundation, PyState};
pub(crate) use steps::PySteps;
