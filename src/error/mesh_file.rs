//! Files of meshes.

/// What is wrong with a line of a mesh's file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileError {
    /// The file could not be read.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::ErrorKind),
    /// Something that is needed is not there.
    #[error("there is no {what}")]
    Missing {
        /// What is missing.
        what: String,
    },
    /// Something is there twice.
    #[error("{what} is given twice")]
    Twice {
        /// What is there twice.
        what: String,
    },
    /// A section has more or fewer things than it says.
    #[error("{found} {what}, but {announced} are announced")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many the section says.
        announced: u64,
    },
    /// A field is not what it must be.
    #[error("'{text}' is no {what}")]
    NotA {
        /// What it must be.
        what: &'static str,
        /// The field, cut to 40 characters.
        text: String,
    },
    /// Something that the crate does not read.
    #[error("cannot use {text}")]
    Unsupported {
        /// What it is.
        text: String,
    },
    /// A line is too long to be one of numbers.
    #[error("no line end in {bytes} bytes")]
    LineTooLong {
        /// Bytes read without a line end.
        bytes: usize,
    },
}
