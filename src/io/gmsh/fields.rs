//! Fields of a `.msh` file, as text or as binary numbers.

use std::io::Read;
use std::str::FromStr;

use crate::error::FileFault;
pub(super) use crate::text::bounded_line::LineResult;
use crate::text::bounded_line::Lines;
use crate::text::decimal::{finite, quoted};

/// Reads the fields of a file in their order, as text or as binary numbers.
pub(super) struct MshFields<R: Read> {
    /// Lines of the file.
    source: Lines<R>,
    /// Text of the present line.
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

    /// Reads the number one at the beginning of a binary file, by which its byte order is checked.
    pub(super) fn begin_binary(&mut self) -> LineResult<()> {
        let byte_order_number = i32::from_le_bytes(self.bytes("number one in binary form")?);
        if byte_order_number != 1 {
            let needed = "number one in binary form, the least significant byte first";
            return Err(self.fault(FileFault::missing(needed)));
        }
        self.is_binary = true;
        Ok(())
    }

    /// Whether numbers are binary.
    pub(super) fn is_binary(&self) -> bool {
        self.is_binary
    }

    /// Reads the next `N` bytes after the present line; the rest of this line is skipped.
    fn bytes<const N: usize>(&mut self, item: &'static str) -> LineResult<[u8; N]> {
        self.position = self.text.len();
        let mut bytes = [0; N];
        let is_complete = self.source.fill(&mut bytes).map_err(|fault| (self.line, fault))?;
        if is_complete { Ok(bytes) } else { Err((self.line, FileFault::missing(item))) }
    }

    /// Reads a whole number: four bytes in a binary file, otherwise text.
    pub(super) fn whole_number<T: TryFrom<i64>>(&mut self, item: &'static str) -> LineResult<T> {
        let value = if self.is_binary {
            i64::from(i32::from_le_bytes(self.bytes(item)?))
        } else {
            self.parsed_field(item)?
        };
        T::try_from(value).map_err(|_| self.wrong_field(&value.to_string(), item))
    }

    /// Reads a count or a tag: eight bytes in a binary file, otherwise text.
    pub(super) fn count_or_tag(&mut self, item: &'static str) -> LineResult<u64> {
        if self.is_binary {
            Ok(u64::from_le_bytes(self.bytes(item)?))
        } else {
            self.parsed_field(item)
        }
    }

    /// Reads a number, which may be infinite or NaN.
    pub(super) fn real(&mut self, item: &'static str) -> LineResult<f64> {
        if self.is_binary {
            Ok(f64::from_le_bytes(self.bytes(item)?))
        } else {
            self.parsed_field(item)
        }
    }

    /// Reads a finite number.
    pub(super) fn finite_number(&mut self) -> LineResult<f64> {
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
    fn wrong_field(&self, field_text: &str, item: &'static str) -> (usize, FileFault) {
        self.fault(FileFault::value("field", quoted(field_text), format!("a {item}")))
    }

    /// Fault of the present line, with its number.
    pub(super) fn fault(&self, fault: FileFault) -> (usize, FileFault) {
        (self.line, fault)
    }

    /// Reads the next line; `false` at the end of the file.
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

    /// Reads the next field as text; `None` at the end of the file.
    fn field(&mut self) -> LineResult<Option<&str>> {
        loop {
            let remaining_text = &self.text[self.position..];
            let white_space_length = remaining_text.len() - remaining_text.trim_start().len();
            let begin_position = self.position + white_space_length;
            if begin_position < self.text.len() {
                let field_and_more = &self.text[begin_position..];
                let field_length =
                    field_and_more.find(char::is_whitespace).unwrap_or(field_and_more.len());
                let end = begin_position + field_length;
                self.position = end;
                return Ok(Some(&self.text[begin_position..end]));
            }
            if !self.advance()? {
                return Ok(None);
            }
        }
    }

    /// Reads the next field and converts it by `parse`.
    fn field_as<T>(
        &mut self,
        item: &'static str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> LineResult<T> {
        let Some(field) = self.field()? else {
            return Err((self.line, FileFault::missing(item)));
        };
        if let Some(value) = parse(field) {
            return Ok(value);
        }
        let field_text = field.to_owned();
        Err(self.wrong_field(&field_text, item))
    }

    /// Reads the next field, which is text also in a binary file, and parses it.
    pub(super) fn parsed_field<T: FromStr>(&mut self, item: &'static str) -> LineResult<T> {
        self.field_as(item, |field| field.parse().ok())
    }

    /// Error unless the number of items is the announced one.
    pub(super) fn check_count(
        &self,
        items: &'static str,
        count: u64,
        announced_count: u64,
    ) -> LineResult<()> {
        if count == announced_count {
            return Ok(());
        }
        Err(self.fault(FileFault::value(
            format!("number of {items}"),
            count.to_string(),
            format!("{announced_count}, as announced"),
        )))
    }

    /// Reads text between quotation marks on the present line.
    pub(super) fn quoted_text(&mut self) -> LineResult<String> {
        let parts: Vec<&str> = self.text[self.position..].splitn(3, '"').collect();
        match parts[..] {
            [text_before, name, text_after] if text_before.trim().is_empty() => {
                let name = name.to_owned();
                self.position = self.text.len() - text_after.len();
                Ok(name)
            }
            _ => Err(self.fault(FileFault::missing("name in quotation marks"))),
        }
    }

    /// Reads the heading of the next section; `None` at the end of the file.
    pub(super) fn next_section(&mut self) -> LineResult<Option<String>> {
        let Some(field) = self.field()? else { return Ok(None) };
        if let Some(name) = field.strip_prefix('$') {
            return Ok(Some(name.to_owned()));
        }
        let field_text = quoted(field);
        Err(self.fault(FileFault::value("field", field_text, "the beginning of a section")))
    }

    /// Reads the end of `section`.
    pub(super) fn end_section(&mut self, section: &str) -> LineResult<()> {
        let is_section_end = self.field()?.map(|field| field.strip_prefix("$End") == Some(section));
        if is_section_end == Some(true) {
            return Ok(());
        }
        Err(self.fault(FileFault::missing(format!("$End{section}"))))
    }

    /// Skips the content and the end of a section.
    pub(super) fn skip_section(&mut self, section: &str) -> LineResult<()> {
        if self.is_binary {
            self.position = self.text.len();
            let section_end = format!("$End{section}");
            return match self.source.skip_past(section_end.as_bytes()) {
                Ok(true) => Ok(()),
                Ok(false) => Err(self.fault(FileFault::missing(section_end))),
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
