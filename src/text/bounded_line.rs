//! Lines of limited length from text files, for all readers.

use std::borrow::Cow;
#[cfg(feature = "io")]
use std::io::ErrorKind;
use std::io::{BufRead, BufReader, Read};

use crate::error::FileFault;

/// Longest line, bytes, so that a file without line ends does not fill the memory.
const LONGEST: u64 = 65_536;
/// UTF-8's byte-order mark.
const MARK: &[u8] = b"\xef\xbb\xbf";
/// The byte with which DOS ends a file.
const END_OF_FILE: u8 = 0x1a;

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
    pub(crate) fn advance(&mut self) -> Result<bool, (usize, FileFault)> {
        let there = self.read().map_err(|fault| (self.number + 1, fault))?;
        self.number += usize::from(there);
        if self.number == 1 && self.bytes.starts_with(MARK) {
            self.bytes.drain(..MARK.len());
        }
        Ok(there)
    }

    fn read(&mut self) -> Result<bool, FileFault> {
        self.bytes.clear();
        match self.source.by_ref().take(LONGEST).read_until(b'\n', &mut self.bytes) {
            Err(error) => Err(FileFault::Unreadable(error.kind())),
            Ok(count) if count as u64 == LONGEST && self.bytes.last() != Some(&b'\n') => Err(
                FileFault::value("length of the line", format!("{count} bytes or more"), "less"),
            ),
            Ok(count) => {
                if self.bytes.last() == Some(&END_OF_FILE) {
                    self.bytes.pop();
                }
                Ok(count > 0)
            }
        }
    }

    /// Fills `bytes` with what follows the present line; `false` if the source ends before.
    #[cfg(feature = "io")]
    pub(crate) fn fill(&mut self, bytes: &mut [u8]) -> Result<bool, FileFault> {
        match self.source.read_exact(bytes) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
            Err(error) => Err(FileFault::Unreadable(error.kind())),
        }
    }

    /// Skips all bytes up to `end` and `end` itself, which begins with its only `$`; `false` if it is not there.
    #[cfg(feature = "io")]
    pub(crate) fn skip_behind(&mut self, end: &[u8]) -> Result<bool, FileFault> {
        let mut matched = 0;
        let mut byte = [0];
        while matched < end.len() {
            if !self.fill(&mut byte)? {
                return Ok(false);
            }
            matched =
                if byte[0] == end[matched] { matched + 1 } else { usize::from(byte[0] == end[0]) };
        }
        Ok(true)
    }

    /// The next line without white space at its ends; `None` at the end of the source.
    pub(crate) fn next(&mut self) -> Result<Option<String>, (usize, FileFault)> {
        Ok(self.next_columns()?.map(|line| line.trim_start().to_owned()))
    }

    /// The next line, including the white space at its beginning; `None` at the end of the source.
    pub(crate) fn next_columns(&mut self) -> Result<Option<String>, (usize, FileFault)> {
        Ok(self.advance()?.then(|| self.text().trim_end().to_owned()))
    }

    /// An error with the number of the present line.
    pub(crate) fn refuse(&self, fault: FileFault) -> (usize, FileFault) {
        (self.number, fault)
    }

    /// The present line with its line end.
    ///
    /// Bytes that are not UTF-8 become characters that no number contains; in comments they do not matter.
    pub(crate) fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.bytes)
    }
}
