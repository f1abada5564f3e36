//! Rows of CSV (RFC 4180) as [`csv_cell`](crate::text::table::csv_cell) writes them, read back.
//!
//! A reader of our own: it must tell a file that was cut off from a whole one, and a quotation mark out
//! of place is a fault; general readers forgive both.

use crate::error::CaseFileError;

/// The number in a cell, as [`Cell`](crate::text::column::Cell) writes it or in any other decimal form.
pub(super) fn parsed(cell: &str) -> Option<f64> {
    match cell {
        "" => Some(f64::NAN),
        "inf" => Some(f64::INFINITY),
        "-inf" => Some(f64::NEG_INFINITY),
        cell => crate::text::number::finite(cell),
    }
}

/// A row of cells.
pub(super) struct Record {
    /// Number of its first line, from 1.
    pub(super) line: usize,
    pub(super) cells: Vec<String>,
    /// Bytes of the text up to its end.
    pub(super) end: usize,
}

/// The rows of a text, one after the other; a fault, which ends them, comes with its line.
pub(super) struct Records<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl<'a> Records<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0, line: 1 }
    }

    /// A cell and whether the row ends behind it. Moves behind the comma or line end.
    fn cell(&mut self) -> Result<(String, bool), CaseFileError> {
        let rest = &self.text[self.at..];
        let (cell, length) = if let Some(quoted) = rest.strip_prefix('"') {
            let (cell, length) = unquoted(quoted).ok_or(CaseFileError::Cut)?;
            (cell, length + 1)
        } else {
            let length = rest.find([',', '\n']).ok_or(CaseFileError::Cut)?;
            let (cell, behind) = rest.split_at(length);
            let windows = behind.starts_with('\n').then(|| cell.strip_suffix('\r')).flatten();
            let cell = windows.unwrap_or(cell);
            if cell.contains('"') {
                return Err(CaseFileError::Quote);
            }
            (cell.to_owned(), length)
        };
        let behind = &rest[length..];
        let (signs, ends) = match behind.as_bytes() {
            [b',', ..] => (1, false),
            [b'\n', ..] => (1, true),
            [b'\r', b'\n', ..] => (2, true),
            [] | [b'\r'] => return Err(CaseFileError::Cut),
            _ => return Err(CaseFileError::Quote),
        };
        self.at += length + signs;
        Ok((cell, ends))
    }
}

/// The text up to the closing quotation mark, doubled ones made single, and its bytes with that mark.
fn unquoted(text: &str) -> Option<(String, usize)> {
    let mut cell = String::new();
    let mut at = 0;
    loop {
        let length = text[at..].find('"')?;
        cell += &text[at..at + length];
        at += length + 1;
        if !text[at..].starts_with('"') {
            return Some((cell, at));
        }
        cell.push('"');
        at += 1;
    }
}

impl Iterator for Records<'_> {
    type Item = Result<Record, (usize, CaseFileError)>;

    fn next(&mut self) -> Option<Self::Item> {
        let (start, line) = (self.at, self.line);
        if start == self.text.len() {
            return None;
        }
        let mut cells = Vec::new();
        loop {
            match self.cell() {
                Ok((cell, ends)) => {
                    cells.push(cell);
                    if ends {
                        break;
                    }
                }
                Err(fault) => {
                    self.at = self.text.len();
                    return Some(Err((line, fault)));
                }
            }
        }
        self.line += self.text[start..self.at].matches('\n').count();
        Some(Ok(Record { line, cells, end: self.at }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::column::Cell;

    #[test]
    fn numbers_read_back() {
        for (value, text) in [
            (0.2, "0.2"),
            (4.0, "4.0"),
            (-0.0, "-0.0"),
            (1e300, "1e300"),
            (5e-324, "5e-324"),
            (f64::MAX, "1.7976931348623157e308"),
            (f64::INFINITY, "inf"),
            (f64::NEG_INFINITY, "-inf"),
            (f64::NAN, ""),
        ] {
            assert_eq!(Cell(value).to_string(), text);
            assert_eq!(parsed(text).map(f64::to_bits), Some(value.to_bits()));
        }
        assert_eq!(parsed("0.20"), Some(0.2));
        for text in ["nan", " ", "1 ", "0,2", "1e999", "infinity"] {
            assert_eq!(parsed(text), None, "{text}");
        }
    }

    #[test]
    fn rows_and_their_faults() {
        let rows = |text: &str| {
            Records::new(text).map(|r| r.map(|r| (r.line, r.cells))).collect::<Result<Vec<_>, _>>()
        };
        let found = rows("a,\"b\"\"c\r\n,\",\r\n1,,2\n").unwrap();
        assert_eq!(found[0], (1, ["a", "b\"c\r\n,", ""].map(str::to_owned).to_vec()));
        assert_eq!(found[1], (3, ["1", "", "2"].map(str::to_owned).to_vec()));
        assert_eq!(rows("").unwrap(), []);
        for (text, line, fault) in [
            ("a,b\n1", 2, CaseFileError::Cut),
            ("a,b\n1,2\r", 2, CaseFileError::Cut),
            ("a,b\n1,\"2", 2, CaseFileError::Cut),
            ("a,b\n1,\"2\"", 2, CaseFileError::Cut),
            ("\"x\ny\",b\n1,\"2\"3\n", 3, CaseFileError::Quote),
            ("a\"\n", 1, CaseFileError::Quote),
        ] {
            assert_eq!(rows(text).unwrap_err(), (line, fault), "{text:?}");
        }
    }
}
