//! Earthquake response of flexible structures whose base can uplift and slide on elastic ground.
#![forbid(unsafe_code)]

pub mod bem;
pub mod coupled;
mod error;
pub mod fem;
pub mod fundamental;
pub mod history;
pub mod interface;
mod linalg;
pub mod motion;
pub mod reference;
mod soil;
pub mod structure;

pub use coupled::Simulation;
pub use error::{Error, RecordError, Result, StepError};
pub use soil::Soil;
