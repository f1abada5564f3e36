//! Text of CSV files.

use std::borrow::Cow;
use std::fmt;
use std::ops::Deref;
use std::path::Path;

use crate::error::Result;
use crate::text::file::write_file;

/// Text of a CSV file (RFC 4180): a heading, and a line for each row.
///
/// It dereferences to `str`, for searching, printing or writing to any writer.
///
/// ```
/// use basemat::motion::Record;
/// let text = Record::new(0.5, vec![0.0, 0.1, -2.5])?.csv();
/// assert_eq!(&*text, "time_s,acceleration_m_per_s2\n0.0,0.0\n0.5,0.1\n1.0,-2.5\n");
/// let path = std::env::temp_dir().join("basemat-record.csv");
/// text.save(&path)?;
/// # std::fs::remove_file(path).unwrap();
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Csv(#[doc(hidden)] pub String);

impl Csv {
    /// Saves the text as a file, and creates its folder if necessary.
    ///
    /// The file is written under another name and renamed, so an existing file is either replaced or unchanged.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        write_file(path.as_ref(), self)
    }
}

impl Deref for Csv {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

impl AsRef<[u8]> for Csv {
    fn as_ref(&self) -> &[u8] {
        self.0.as_bytes()
    }
}

impl fmt::Display for Csv {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Text of a CSV cell (RFC 4180), in quotation marks if necessary.
pub fn csv_cell(cell: &str) -> Cow<'_, str> {
    if cell.contains([',', '"', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", cell.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(cell)
    }
}

/// Line of CSV with these cells, with its line end.
pub fn csv_line(cells: &[String]) -> String {
    cells.iter().map(|cell| csv_cell(cell)).collect::<Vec<_>>().join(",") + "\n"
}
