//! Checkpoints.

use super::Error;

/// Why a run could not be saved or resumed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// A part of the scene cannot save its state.
    #[error("the {part} cannot save or restore its state")]
    Unsupported {
        /// The part.
        part: &'static str,
    },
    /// The checkpoint was made with another format than this version's.
    #[error("format {found}, but this version reads {needed}")]
    Format {
        /// Format of the checkpoint.
        found: u32,
        /// Format of this version.
        needed: u32,
    },
    /// The contents are not those that were saved: a file was damaged, or changed by hand.
    #[error("damaged: the contents do not agree with their check sum")]
    Damaged,
    /// The checkpoint belongs to another scene.
    #[error("made in another scene: the {quantity} differs")]
    OtherScene {
        /// Quantity that differs.
        quantity: &'static str,
    },
    /// Numbers are missing, too many or not finite.
    #[error("{quantity}: wrong number of values, or not finite")]
    Corrupt {
        /// Quantity that is impossible.
        quantity: &'static str,
    },
}

impl From<CheckpointError> for Error {
    fn from(error: CheckpointError) -> Self {
        Self::Checkpoint(error)
    }
}
