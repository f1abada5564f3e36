//! Earthquake response of flexible structures whose base can uplift and slide on elastic ground.
#![forbid(unsafe_code)]

pub mod bem;
mod error;
pub mod fem;
pub mod fundamental;
pub mod history;
pub mod interface;
pub mod motion;
mod soil;
pub mod structure;

pub use error::{Error, RecordError, Result, StepError};
pub use soil::Soil;
