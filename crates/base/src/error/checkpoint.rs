//! Errors of checkpoints.

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
    /// The checkpoint has a format that this version does not read.
    #[error("format {found}, but this version reads {needed}")]
    Format {
        /// Format of the checkpoint.
        found: u32,
        /// Format of this version.
        needed: u32,
    },
    /// The checkpoint belongs to another scene.
    #[error("made in another scene: the {quantity} differs")]
    OtherScene {
        /// Quantity that differs.
        quantity: &'static str,
    },
    /// The contents are not as they were saved: damaged, or changed by hand.
    #[error(
        "{quantity}: damaged or changed by hand (wrong check sum, wrong number of values, or a value that is not finite)"
    )]
    Corrupt {
        /// Quantity that cannot be right; the contents as a whole if it is the check sum.
        quantity: &'static str,
    },
}
