//! Files of meshes.

use super::Error;

/// Fault of a line of a mesh's file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileError {
    /// The file could not be read.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::ErrorKind),
    /// Something that is needed is not there.
    #[error("there is no {what}")]
    Missing {
        /// Missing item.
        what: String,
    },
    /// Something is there twice.
    #[error("{what} is given twice")]
    Twice {
        /// Repeated item.
        what: String,
    },
    /// A section has more or fewer things than it says.
    #[error("{found} {what}, but {announced} are announced")]
    Count {
        /// Counted items.
        what: &'static str,
        /// Number found.
        found: usize,
        /// Number that the section states.
        announced: u64,
    },
    /// A field is not what it must be.
    #[error("'{text}' is no {what}")]
    NotA {
        /// Required value.
        what: &'static str,
        /// The field, cut to 40 characters.
        text: String,
    },
    /// Something that the crate does not read.
    #[error("cannot use {text}")]
    Unsupported {
        /// Value found.
        text: String,
    },
    /// An element that the mesh does not take.
    #[error("element {tag}: {source}")]
    Element {
        /// The element's tag in the file.
        tag: u64,
        /// Why.
        r#source: Box<Error>,
    },
    /// A line is too long to be one of numbers.
    #[error("no line end in {bytes} bytes")]
    LineTooLong {
        /// Bytes read without a line end.
        bytes: usize,
    },
}
