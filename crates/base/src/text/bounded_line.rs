//! Lines of limited length from text files, for all readers.

use std::borrow::Cow;
use std::io::ErrorKind;
use std::io::{BufRead, BufReader, Read};

use crate::error::FileFault;

/// Largest length of a line, bytes.
///
/// A file without line ends therefore does not fill the memory.
const MAX_LINE_BYTES: u64 = 65_536;
/// UTF-8's byte-order mark.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// End-of-file byte that DOS programs write.
const DOS_END_OF_FILE: u8 = 0x1a;

/// Result of reading lines; the error is a line's number and its fault.
pub type LineResult<T> = Result<T, (usize, FileFault)>;

/// The lines of a text, read one by one.
///
/// A byte-order mark before the first line is skipped.
pub struct Lines<R> {
    source: BufReader<R>,
    /// Bytes of the current line, with its line end.
    line_bytes: Vec<u8>,
    /// Number of the current line, from 1.
    pub number: usize,
}

impl<R: Read> Lines<R> {
    /// Lines of a source; the first [`Lines::advance`] reads the first one.
    pub fn new(source: R) -> Self {
        Self { source: BufReader::new(source), line_bytes: Vec::new(), number: 0 }
    }

    /// Reads the next line; `false` at the end of the source.
    pub fn advance(&mut self) -> LineResult<bool> {
        let has_line = self.read().map_err(|fault| (self.number + 1, fault))?;
        self.number += usize::from(has_line);
        if self.number == 1 && self.line_bytes.starts_with(BYTE_ORDER_MARK) {
            self.line_bytes.drain(..BYTE_ORDER_MARK.len());
        }
        Ok(has_line)
    }

    /// Reads the bytes of the next line; `false` at the end of the source.
    fn read(&mut self) -> Result<bool, FileFault> {
        self.line_bytes.clear();
        match self.source.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut self.line_bytes) {
            Err(error) => Err(FileFault::Unreadable(error.kind())),
            Ok(byte_count)
                if byte_count as u64 == MAX_LINE_BYTES
                    && self.line_bytes.last() != Some(&b'\n') =>
            {
                Err(FileFault::value(
                    "length of the line",
                    format!("{byte_count} bytes or more"),
                    "less",
                ))
            }
            Ok(byte_count) => {
                if self.line_bytes.last() == Some(&DOS_END_OF_FILE) {
                    self.line_bytes.pop();
                }
                Ok(byte_count > 0)
            }
        }
    }

    /// Fills `bytes` with the next bytes that have not been read.
    ///
    /// `false` if the source has fewer bytes.
    pub fn fill(&mut self, bytes: &mut [u8]) -> Result<bool, FileFault> {
        match self.source.read_exact(bytes) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
            Err(error) => Err(FileFault::Unreadable(error.kind())),
        }
    }

    /// Skips all bytes up to the end of `marker`.
    ///
    /// Returns `false` if the source does not contain the marker. `marker`: begins with `$`, which occurs in it only once.
    pub fn skip_past(&mut self, marker: &[u8]) -> Result<bool, FileFault> {
        let mut matched_count = 0;
        let mut byte = [0];
        while matched_count < marker.len() {
            if !self.fill(&mut byte)? {
                return Ok(false);
            }
            matched_count = if byte[0] == marker[matched_count] {
                matched_count + 1
            } else {
                usize::from(byte[0] == marker[0])
            };
        }
        Ok(true)
    }

    /// The next line without white space at its ends.
    ///
    /// `None` at the end of the source.
    pub fn next(&mut self) -> LineResult<Option<String>> {
        Ok(self.next_indented()?.map(|line| line.trim_start().to_owned()))
    }

    /// The next line without white space at its end, but with that at its beginning.
    ///
    /// `None` at the end of the source.
    pub fn next_indented(&mut self) -> LineResult<Option<String>> {
        Ok(self.advance()?.then(|| self.text().trim_end().to_owned()))
    }

    /// A fault with the number of the current line.
    pub fn fault(&self, fault: FileFault) -> (usize, FileFault) {
        (self.number, fault)
    }

    /// Adds the number of the current line to the fault of a result.
    pub fn with_line_number<T>(&self, result: Result<T, FileFault>) -> LineResult<T> {
        result.map_err(|fault| self.fault(fault))
    }

    /// The current line with its line end.
    ///
    /// Bytes that are not UTF-8 become a replacement character. Numbers with this character are rejected; comments may
    /// contain it.
    pub fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.line_bytes)
    }
}
