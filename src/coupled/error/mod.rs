//! Errors of runs: structures that cannot stand, steps that fail, checkpoints that cannot be resumed.

mod checkpoint;
mod stability;
mod step;

pub use checkpoint::CheckpointError;
pub(crate) use stability::along;
pub use stability::{CoarseBaseError, StabilityError};
pub use step::StepError;
