//! Lines of limited length from text files, for all readers.

use std::borrow::Cow;
use std::io::{BufRead, BufReader, ErrorKind, Read};

use crate::error::RecordError;
#[cfg(feature = "io")]
use crate::error::{MatrixFileError, MeshFileError};

/// Longest line, bytes, so that a file without line ends does not fill the memory.
const LONGEST: u64 = 65_536;
/// UTF-8's byte-order mark.
const MARK: &[u8] = b"\xef\xbb\xbf";
/// The byte with which DOS ends a file.
const END_OF_FILE: u8 = 0x1a;

/// Reason why a line could not be read.
pub(crate) enum Unread {
    /// The source failed.
    Failed(ErrorKind),
    /// The line has more than this number of bytes.
    TooLong(usize),
}

/// The lines of a text, one at a time; a byte-order mark before the first line is skipped.
pub(crate) struct Lines<R> {
    source: BufReader<R>,
    bytes: Vec<u8>,
    /// Number of the present line, from 1.
    pub(crate) number: usize,
}

impl<R: Read> Lines<R> {
    pub(crate) fn new(source: R) -> Self {
        Self { source: BufReader::new(source), bytes: Vec::new(), number: 0 }
    }

    /// Goes to the next line; `false` at the end of the source.
    ///
    /// An error includes the line's number.
    pub(crate) fn advance<E: From<Unread>>(&mut self) -> Result<bool, (usize, E)> {
        let there = self.read().map_err(|unread| (self.number + 1, unread.into()))?;
        self.number += usize::from(there);
        if self.number == 1 && self.bytes.starts_with(MARK) {
            self.bytes.drain(..MARK.len());
        }
        Ok(there)
    }

    fn read(&mut self) -> Result<bool, Unread> {
        self.bytes.clear();
        match self.source.by_ref().take(LONGEST).read_until(b'\n', &mut self.bytes) {
            Err(error) => Err(Unread::Failed(error.kind())),
            Ok(count) if count as u64 == LONGEST && self.bytes.last() != Some(&b'\n') => {
                Err(Unread::TooLong(count))
            }
            Ok(count) => {
                if self.bytes.last() == Some(&END_OF_FILE) {
                    self.bytes.pop();
                }
                Ok(count > 0)
            }
        }
    }

    /// The next line without white space at its ends; `None` at the end of the source.
    pub(crate) fn next<E: From<Unread>>(&mut self) -> Result<Option<String>, (usize, E)> {
        Ok(self.next_columns()?.map(|line| line.trim_start().to_owned()))
    }

    /// The next line, including the white space at its beginning; `None` at the end of the source.
    pub(crate) fn next_columns<E: From<Unread>>(&mut self) -> Result<Option<String>, (usize, E)> {
        Ok(self.advance()?.then(|| self.text().trim_end().to_owned()))
    }

    /// An error with the number of the present line.
    pub(crate) fn refuse<E>(&self, reason: E) -> (usize, E) {
        (self.number, reason)
    }

    /// The present line with its line end.
    ///
    /// Bytes that are not UTF-8 become characters that no number contains; in comments they do not matter.
    pub(crate) fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.bytes)
    }
}

macro_rules! from_unread {
    ($error:ty) => {
        impl From<Unread> for $error {
            fn from(unread: Unread) -> Self {
                match unread {
                    Unread::Failed(kind) => Self::Unreadable(kind),
                    Unread::TooLong(bytes) => Self::LineTooLong { bytes },
                }
            }
        }
    };
}

from_unread!(RecordError);
#[cfg(feature = "io")]
from_unread!(MeshFileError);
#[cfg(feature = "io")]
from_unread!(MatrixFileError);
