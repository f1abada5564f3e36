//! Fields of a `.msh` file, as text or as binary numbers.

use std::io::Read;
use std::str::FromStr;

use crate::error::FileFault;
pub(super) use crate::text::bounded_line::LineResult;
use crate::text::bounded_line::Lines;
use crate::text::decimal::{finite, quoted};

/// The fields of a file in order, as text or as binary numbers, with their line numbers.
pub(super) struct MshFields<R: Read> {
    source: Lines<R>,
    text: String,
    /// Start of the next field in `text`.
    position: usize,
    /// Number of the line in `text`, from 1; in a binary section, the line of its heading.
    pub(super) line: usize,
    /// Whether numbers are binary.
    is_binary: bool,
}

impl<R: Read> MshFields<R> {
    pub(super) fn new(source: R) -> Self {
        Self {
            source: Lines::new(source),
            text: String::new(),
            position: 0,
            line: 0,
            is_binary: false,
        }
    }

    /// Reads the number one that begins a binary file; all numbers have the same order of bytes.
    pub(super) fn begin_binary(&mut self) -> LineResult<()> {
        let one = i32::from_le_bytes(self.bytes("number one in binary form")?);
        if one != 1 {
            let needed = "number one in binary form, the byte of the smallest power first";
            return Err(self.fault(FileFault::missing(needed)));
        }
        self.is_binary = true;
        Ok(())
    }

    /// Whether numbers are binary.
    pub(super) fn is_binary(&self) -> bool {
        self.is_binary
    }

    /// The next bytes, which begin behind the present line.
    fn bytes<const N: usize>(&mut self, item: &'static str) -> LineResult<[u8; N]> {
        self.position = self.text.len();
        let mut bytes = [0; N];
        let filled = self.source.fill(&mut bytes).map_err(|fault| (self.line, fault))?;
        if filled { Ok(bytes) } else { Err((self.line, FileFault::missing(item))) }
    }

    /// A whole number of four bytes, or of text.
    pub(super) fn int<T: TryFrom<i64>>(&mut self, item: &'static str) -> LineResult<T> {
        let value = if self.is_binary {
            i64::from(i32::from_le_bytes(self.bytes(item)?))
        } else {
            self.text(item)?
        };
        T::try_from(value).map_err(|_| self.wrong_field(&value.to_string(), item))
    }

    /// A count or a tag of eight bytes, or of text.
    pub(super) fn size(&mut self, item: &'static str) -> LineResult<u64> {
        if self.is_binary {
            Ok(u64::from_le_bytes(self.bytes(item)?))
        } else {
            self.text(item)
        }
    }

    /// A number that may be infinite.
    pub(super) fn real(&mut self, item: &'static str) -> LineResult<f64> {
        if self.is_binary {
            Ok(f64::from_le_bytes(self.bytes(item)?))
        } else {
            self.text(item)
        }
    }

    /// A finite number.
    pub(super) fn number(&mut self) -> LineResult<f64> {
        let item = "finite number";
        if !self.is_binary {
            return self.field_as(item, finite);
        }
        let value = self.real(item)?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.wrong_field(&value.to_string(), item))
        }
    }

    /// Fault of a field that is not an `item`.
    fn wrong_field(&self, found: &str, item: &'static str) -> (usize, FileFault) {
        self.fault(FileFault::value("field", quoted(found), format!("a {item}")))
    }

    /// Fault of the present line, with its number.
    pub(super) fn fault(&self, fault: FileFault) -> (usize, FileFault) {
        (self.line, fault)
    }

    /// Reads the next line; `false` at the end.
    fn advance(&mut self) -> LineResult<bool> {
        self.line += 1;
        if !self.source.advance()? {
            return Ok(false);
        }
        self.text.clear();
        self.text.push_str(&self.source.text());
        self.position = 0;
        Ok(true)
    }

    /// The next field unchanged; `None` at the end.
    fn field(&mut self) -> LineResult<Option<&str>> {
        loop {
            let rest = &self.text[self.position..];
            let begin = self.position + (rest.len() - rest.trim_start().len());
            if begin < self.text.len() {
                let rest = &self.text[begin..];
                let end = begin + rest.find(char::is_whitespace).unwrap_or(rest.len());
                self.position = end;
                return Ok(Some(&self.text[begin..end]));
            }
            if !self.advance()? {
                return Ok(None);
            }
        }
    }

    /// The next field, converted by `parse`.
    fn field_as<T>(
        &mut self,
        item: &'static str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> LineResult<T> {
        let Some(field) = self.field()? else {
            return Err((self.line, FileFault::missing(item)));
        };
        if let Some(parsed) = parse(field) {
            return Ok(parsed);
        }
        let found = field.to_owned();
        Err(self.wrong_field(&found, item))
    }

    /// The next field of text, also in a binary file.
    pub(super) fn text<T: FromStr>(&mut self, item: &'static str) -> LineResult<T> {
        self.field_as(item, |field| field.parse().ok())
    }

    /// Error if the number of items differs from the number announced.
    pub(super) fn check_count(
        &self,
        item: &'static str,
        found: u64,
        announced: u64,
    ) -> LineResult<()> {
        if found == announced {
            return Ok(());
        }
        Err(self.fault(FileFault::value(
            format!("number of {item}"),
            found.to_string(),
            format!("{announced}, as announced"),
        )))
    }

    /// Text between quotation marks, on the present line.
    pub(super) fn quoted(&mut self) -> LineResult<String> {
        let parts: Vec<&str> = self.text[self.position..].splitn(3, '"').collect();
        match parts[..] {
            [before, name, after] if before.trim().is_empty() => {
                let name = name.to_owned();
                self.position = self.text.len() - after.len();
                Ok(name)
            }
            _ => Err(self.fault(FileFault::missing("name in quotation marks"))),
        }
    }

    /// Name of the section that begins next; `None` at the end.
    pub(super) fn section(&mut self) -> LineResult<Option<String>> {
        let Some(field) = self.field()? else { return Ok(None) };
        if let Some(name) = field.strip_prefix('$') {
            return Ok(Some(name.to_owned()));
        }
        let found = quoted(field);
        Err(self.fault(FileFault::value("field", found, "the beginning of a section")))
    }

    /// Reads the end of `section`.
    pub(super) fn end(&mut self, section: &str) -> LineResult<()> {
        let end = self.field()?.map(|field| field.strip_prefix("$End") == Some(section));
        if end == Some(true) {
            return Ok(());
        }
        Err(self.fault(FileFault::missing(format!("$End{section}"))))
    }

    /// Skips the rest of `section`.
    pub(super) fn skip(&mut self, section: &str) -> LineResult<()> {
        if self.is_binary {
            self.position = self.text.len();
            let end = format!("$End{section}");
            return match self.source.skip_past(end.as_bytes()) {
                Ok(true) => Ok(()),
                Ok(false) => Err(self.fault(FileFault::missing(end))),
                Err(fault) => Err(self.fault(fault)),
            };
        }
        while let Some(field) = self.field()? {
            if field.strip_prefix("$End") == Some(section) {
                return Ok(());
            }
        }
        Err(self.fault(FileFault::missing(format!("$End{section}"))))
    }
}
