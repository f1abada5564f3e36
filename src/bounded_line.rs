//! Lines of text files of bounded length, for all readers.

use std::io::{BufRead, ErrorKind, Read};

use crate::error::RecordError;
#[cfg(feature = "io")]
use crate::error::{MatrixFileError, MeshFileError};

/// Longest line, bytes: a file without line ends must not fill the memory.
const LONGEST: u64 = 65_536;

/// Why a line could not be read.
pub(crate) enum Unread {
    /// The source failed.
    Failed(ErrorKind),
    /// There was no line end in so many bytes.
    TooLong(usize),
}

/// Overwrites `bytes` with the next line, its end included; `false` at the end of the source.
pub(crate) fn read_line(
    source: &mut impl BufRead,
    bytes: &mut Vec<u8>,
) -> std::result::Result<bool, Unread> {
    bytes.clear();
    match source.by_ref().take(LONGEST).read_until(b'\n', bytes) {
        Err(error) => Err(Unread::Failed(error.kind())),
        Ok(count) if count as u64 == LONGEST && bytes.last() != Some(&b'\n') => {
            Err(Unread::TooLong(count))
        }
        Ok(count) => Ok(count > 0),
    }
}

impl From<Unread> for RecordError {
    fn from(unread: Unread) -> Self {
        match unread {
            Unread::Failed(kind) => Self::Unreadable(kind),
            Unread::TooLong(bytes) => Self::LineTooLong { bytes },
        }
    }
}

#[cfg(feature = "io")]
impl From<Unread> for MeshFileError {
    fn from(unread: Unread) -> Self {
        match unread {
            Unread::Failed(kind) => Self::Unreadable(kind),
            Unread::TooLong(bytes) => Self::LineTooLong { bytes },
        }
    }
}

#[cfg(feature = "io")]
impl From<Unread> for MatrixFileError {
    fn from(unread: Unread) -> Self {
        match unread {
            Unread::Failed(kind) => Self::Unreadable(kind),
            Unread::TooLong(bytes) => Self::LineTooLong { bytes },
        }
    }
}
