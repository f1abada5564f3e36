//! Lines of limited length from text files, for all readers.

use std::borrow::Cow;
use std::io::ErrorKind;
use std::io::{BufRead, BufReader, Read};

use crate::error::FileFault;

/// Largest length of a line, bytes, so that a file without line ends does not fill the memory.
const MAX_LINE_BYTES: u64 = 65_536;
/// UTF-8's byte-order mark.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// The byte with which DOS ends a file.
const DOS_END_OF_FILE: u8 = 0x1a;

/// Result of reading lines, or the number of a line and its fault.
pub type LineResult<T> = Result<T, (usize, FileFault)>;

/// The lines of a text, read one by one.
///
/// A byte-order mark before the first line is skipped.
pub struct Lines<R> {
    source: BufReader<R>,
    bytes: Vec<u8>,
    /// Number of the present line, from 1.
    pub number: usize,
}

impl<R: Read> Lines<R> {
    pub fn new(source: R) -> Self {
        Self { source: BufReader::new(source), bytes: Vec::new(), number: 0 }
    }

    /// Reads the next line; `false` at the end of the source.
    pub fn advance(&mut self) -> LineResult<bool> {
        let has_line = self.read().map_err(|fault| (self.number + 1, fault))?;
        self.number += usize::from(has_line);
        if self.number == 1 && self.bytes.starts_with(BYTE_ORDER_MARK) {
            self.bytes.drain(..BYTE_ORDER_MARK.len());
        }
        Ok(has_line)
    }

    /// Reads the bytes of the next line; `false` at the end of the source.
    fn read(&mut self) -> Result<bool, FileFault> {
        self.bytes.clear();
        match self.source.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut self.bytes) {
            Err(error) => Err(FileFault::Unreadable(error.kind())),
            Ok(count) if count as u64 == MAX_LINE_BYTES && self.bytes.last() != Some(&b'\n') => {
                Err(FileFault::value(
                    "length of the line",
                    format!("{count} bytes or more"),
                    "less",
                ))
            }
            Ok(count) => {
                if self.bytes.last() == Some(&DOS_END_OF_FILE) {
                    self.bytes.pop();
                }
                Ok(count > 0)
            }
        }
    }

    /// Fills `bytes` from behind the present line; `false` if the source ends before.
    pub fn fill(&mut self, bytes: &mut [u8]) -> Result<bool, FileFault> {
        match self.source.read_exact(bytes) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
            Err(error) => Err(FileFault::Unreadable(error.kind())),
        }
    }

    /// Skips all bytes up to and with `end`; `false` if the source does not contain it.
    ///
    /// `end` begins with its only `$`.
    pub fn skip_behind(&mut self, end: &[u8]) -> Result<bool, FileFault> {
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
    pub fn next(&mut self) -> LineResult<Option<String>> {
        Ok(self.next_indented()?.map(|line| line.trim_start().to_owned()))
    }

    /// The next line, including the white space at its beginning; `None` at the end of the source.
    pub fn next_indented(&mut self) -> LineResult<Option<String>> {
        Ok(self.advance()?.then(|| self.text().trim_end().to_owned()))
    }

    /// Fault of the present line, with its number.
    pub fn fault(&self, fault: FileFault) -> (usize, FileFault) {
        (self.number, fault)
    }

    /// Adds the number of the present line to the fault of a result.
    pub fn with_line_number<T>(&self, result: Result<T, FileFault>) -> LineResult<T> {
        result.map_err(|fault| self.fault(fault))
    }

    /// The present line with its line end.
    ///
    /// Bytes that are not UTF-8 become characters that no number contains; in comments they do not matter.
    pub fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.bytes)
    }
}
