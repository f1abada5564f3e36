//! Faults of files: records, meshes, matrices, convolution weights, tables of cases.

use std::io::ErrorKind;

use super::{Error, MemoryError};

/// A file that cannot be read or written, or whose content cannot be right.
///
/// ```
/// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
/// use basemat::{Error, FileFault};
///
/// let format = ColumnFormat::new(AccelerationUnit::Gal);
/// let Err(Error::File(error)) = Record::read("no/such/file.txt", &format) else { panic!() };
/// assert!(matches!(error.fault, FileFault::Unreadable(std::io::ErrorKind::NotFound)));
/// assert_eq!(error.to_string(), "no/such/file.txt cannot be read: it does not exist");
///
/// let read = Record::from_reader("a.txt", "0 1\n0.01 1,5\n".as_bytes(), &format);
/// let Err(Error::File(error)) = read else { panic!() };
/// assert_eq!((error.file.as_str(), error.line), ("a.txt", 2));
/// assert!(matches!(&error.fault, FileFault::Value { found, .. } if found == "'1,5'"));
/// ```
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{fault}", message_start(.file, *.line, .fault))]
pub struct FileError {
    /// Name of the file, or of another source.
    pub file: String,
    /// Line number, from 1 (0: the file as a whole).
    pub line: usize,
    /// Fault of the line.
    pub fault: FileFault,
}

/// Kind of a fault of a file, with the quantity, what was found and what is needed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FileFault {
    /// The file cannot be opened or read.
    #[error("cannot be read: {}", system_message(*.0))]
    Unreadable(ErrorKind),
    /// The file cannot be written; a file of that name is as it was.
    #[error("cannot be written: {}", system_message(*.0))]
    Unwritable(ErrorKind),
    /// The file has another format than the one that is read, or uses a part of it that is not read.
    #[error("'{found}' instead of {needed}")]
    Format {
        /// Text of the file, cut to 80 characters, or a description of it.
        found: String,
        /// Requirement.
        needed: String,
    },
    /// The content differs from the content that was written.
    #[error(
        "{quantity} does not agree with its check sum: damaged or changed by hand (delete it to have it made anew)"
    )]
    Damaged {
        /// Damaged part of the file.
        quantity: String,
    },
    /// A quantity is not there, or has no value.
    #[error("there is no {quantity}")]
    Missing {
        /// Name of the quantity.
        quantity: String,
    },
    /// A value that cannot be right.
    #[error("{quantity} is {found}, but must be {needed}")]
    Value {
        /// Name of the quantity.
        quantity: String,
        /// The value with its unit; text of the file is in quotation marks, cut to 40 characters.
        found: String,
        /// Requirement.
        needed: String,
    },
    /// The content is too large for the memory.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// The numbers can be read, but a constructor does not accept them.
    #[error("{0}")]
    Unusable(Box<Error>),
}

impl FileFault {
    /// A value that cannot be right.
    #[doc(hidden)]
    pub fn value(
        quantity: impl Into<String>,
        found: impl Into<String>,
        needed: impl Into<String>,
    ) -> Self {
        Self::Value { quantity: quantity.into(), found: found.into(), needed: needed.into() }
    }

    /// A wrong number of items.
    #[doc(hidden)]
    pub fn count(items: &str, found: usize, needed: impl Into<String>) -> Self {
        Self::value(format!("number of {items}"), found.to_string(), needed)
    }

    /// A quantity that is not there.
    #[doc(hidden)]
    pub fn missing(quantity: impl Into<String>) -> Self {
        Self::Missing { quantity: quantity.into() }
    }

    /// Text that does not belong to the format.
    #[doc(hidden)]
    pub fn format(found: impl Into<String>, needed: impl Into<String>) -> Self {
        Self::Format { found: found.into(), needed: needed.into() }
    }

    /// The error for a line of a file, or for the file as a whole if `line` is 0.
    #[doc(hidden)]
    pub fn of(self, file: impl Into<String>, line: usize) -> Error {
        FileError { file: file.into(), line, fault: self }.into()
    }
}

/// Beginning of a message: the file, and the line if it is one line's fault.
fn message_start(file: &str, line: usize, fault: &FileFault) -> String {
    match (line, fault) {
        (0, FileFault::Unreadable(_) | FileFault::Unwritable(_)) => format!("{file} "),
        (0, _) => format!("{file}: "),
        _ => format!("{file}, line {line}: "),
    }
}

/// Message for an error of the file system.
fn system_message(kind: ErrorKind) -> String {
    match kind {
        ErrorKind::NotFound => "it does not exist".to_owned(),
        other => other.to_string(),
    }
}
