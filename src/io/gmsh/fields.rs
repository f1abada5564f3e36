//! Fields of a `.msh` file, as text or as binary numbers.

use std::io::Read;
use std::str::FromStr;

use crate::error::FileFault;
use crate::text::bounded_line::Lines;
use crate::text::decimal::{finite, quoted};

/// The result of reading; the error holds the number of the line and its fault.
pub(super) type Reason<T> = Result<T, (usize, FileFault)>;

/// The fields of a file in order, as text or as binary numbers, with their line numbers.
pub(super) struct Fields<R: Read> {
    source: Lines<R>,
    text: String,
    /// Start of the next field in `text`.
    at: usize,
    /// Number of the line in `text`, from 1; in a binary section, the line of its heading.
    pub(super) line: usize,
    /// Whether numbers are binary.
    binary: bool,
}

impl<R: Read> Fields<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source: Lines::new(source), text: String::new(), at: 0, line: 0, binary: false }
    }

    /// Reads the number one that begins a binary file; all numbers have the same order of bytes.
    pub(super) fn begin_binary(&mut self) -> Reason<()> {
        let one = i32::from_le_bytes(self.bytes("number one in binary form")?);
        if one != 1 {
            let needed = "number one in binary form, the byte of the smallest power first";
            return Err(self.refuse(FileFault::missing(needed)));
        }
        self.binary = true;
        Ok(())
    }

    /// Whether numbers are binary.
    pub(super) fn is_binary(&self) -> bool {
        self.binary
    }

    /// The next bytes, which begin behind the present line.
    fn bytes<const N: usize>(&mut self, what: &'static str) -> Reason<[u8; N]> {
        self.at = self.text.len();
        let mut bytes = [0; N];
        let filled = self.source.fill(&mut bytes).map_err(|fault| (self.line, fault))?;
        if filled { Ok(bytes) } else { Err((self.line, FileFault::missing(what))) }
    }

    /// A whole number of four bytes, or of text.
    pub(super) fn int<T: TryFrom<i64>>(&mut self, what: &'static str) -> Reason<T> {
        let value = if self.binary {
            i64::from(i32::from_le_bytes(self.bytes(what)?))
        } else {
            self.text(what)?
        };
        T::try_from(value).map_err(|_| self.off(&value.to_string(), what))
    }

    /// A count or a tag of eight bytes, or of text.
    pub(super) fn size(&mut self, what: &'static str) -> Reason<u64> {
        if self.binary { Ok(u64::from_le_bytes(self.bytes(what)?)) } else { self.text(what) }
    }

    /// A number that may be infinite.
    pub(super) fn real(&mut self, what: &'static str) -> Reason<f64> {
        if self.binary { Ok(f64::from_le_bytes(self.bytes(what)?)) } else { self.text(what) }
    }

    /// A finite number.
    pub(super) fn number(&mut self) -> Reason<f64> {
        const WHAT: &str = "finite number";
        if !self.binary {
            return self.field_as(WHAT, finite);
        }
        let value = self.real(WHAT)?;
        if value.is_finite() { Ok(value) } else { Err(self.off(&value.to_string(), WHAT)) }
    }

    fn off(&self, found: &str, what: &'static str) -> (usize, FileFault) {
        self.refuse(FileFault::value("field", quoted(found), format!("a {what}")))
    }

    pub(super) fn refuse(&self, reason: FileFault) -> (usize, FileFault) {
        (self.line, reason)
    }

    /// Goes to the next line; `false` at the end.
    fn advance(&mut self) -> Reason<bool> {
        self.line += 1;
        if !self.source.advance()? {
            return Ok(false);
        }
        self.text.clear();
        self.text.push_str(&self.source.text());
        self.at = 0;
        Ok(true)
    }

    /// The next field unchanged; `None` at the end.
    fn field(&mut self) -> Reason<Option<&str>> {
        loop {
            let rest = &self.text[self.at..];
            let begin = self.at + (rest.len() - rest.trim_start().len());
            if begin < self.text.len() {
                let rest = &self.text[begin..];
                let end = begin + rest.find(char::is_whitespace).unwrap_or(rest.len());
                self.at = end;
                return Ok(Some(&self.text[begin..end]));
            }
            if !self.advance()? {
                return Ok(None);
            }
        }
    }

    /// The next field, converted by `parse`.
    fn field_as<T>(&mut self, what: &'static str, parse: impl Fn(&str) -> Option<T>) -> Reason<T> {
        let Some(field) = self.field()? else {
            return Err((self.line, FileFault::missing(what)));
        };
        let (parsed, found) = (parse(field), field.to_owned());
        parsed.ok_or_else(|| self.off(&found, what))
    }

    /// The next field of text, also in a binary file.
    pub(super) fn text<T: FromStr>(&mut self, what: &'static str) -> Reason<T> {
        self.field_as(what, |field| field.parse().ok())
    }

    /// Error if the number of items differs from the number announced.
    pub(super) fn agree(&self, what: &'static str, found: u64, announced: u64) -> Reason<()> {
        if found == announced {
            return Ok(());
        }
        Err(self.refuse(FileFault::value(
            format!("number of {what}"),
            found.to_string(),
            format!("{announced}, as announced"),
        )))
    }

    /// Text between quotation marks, on the present line.
    pub(super) fn quoted(&mut self) -> Reason<String> {
        let mut parts = self.text[self.at..].splitn(3, '"');
        let (before, name, after) = (parts.next(), parts.next(), parts.next());
        match (before, name, after) {
            (Some(before), Some(name), Some(after)) if before.trim().is_empty() => {
                let name = name.to_owned();
                self.at = self.text.len() - after.len();
                Ok(name)
            }
            _ => Err(self.refuse(FileFault::missing("name in quotation marks"))),
        }
    }

    /// Name of the section that begins next; `None` at the end.
    pub(super) fn section(&mut self) -> Reason<Option<String>> {
        let Some(field) = self.field()? else { return Ok(None) };
        if let Some(name) = field.strip_prefix('$') {
            return Ok(Some(name.to_owned()));
        }
        let found = quoted(field);
        Err(self.refuse(FileFault::value("field", found, "the beginning of a section")))
    }

    /// Reads the end of `section`.
    pub(super) fn end(&mut self, section: &str) -> Reason<()> {
        let end = self.field()?.map(|field| field.strip_prefix("$End") == Some(section));
        if end == Some(true) {
            return Ok(());
        }
        Err(self.refuse(FileFault::missing(format!("$End{section}"))))
    }

    /// Skips the rest of `section`.
    pub(super) fn pass_over(&mut self, section: &str) -> Reason<()> {
        if self.binary {
            self.at = self.text.len();
            let end = format!("$End{section}");
            return match self.source.skip_behind(end.as_bytes()) {
                Ok(true) => Ok(()),
                Ok(false) => Err(self.refuse(FileFault::missing(end))),
                Err(fault) => Err(self.refuse(fault)),
            };
        }
        while let Some(field) = self.field()? {
            if field.strip_prefix("$End") == Some(section) {
                return Ok(());
            }
        }
        Err(self.refuse(FileFault::missing(format!("$End{section}"))))
    }
}
