//! Reduction of large structures to their contact nodes and a few modes.

mod craig_bampton;
mod dof_partition;
mod recovery;

pub use craig_bampton::{CraigBampton, ReducedModel};
pub use recovery::Recovery;
