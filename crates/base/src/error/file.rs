//! Errors of files (records, meshes, matrices, convolution weights, tables of cases) and of checkpoints.

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

/// Fault of a file, with the quantity, its value and the requirement.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FileFault {
    /// The file cannot be opened or read.
    #[error("cannot be read: {}", system_message(*.0))]
    Unreadable(ErrorKind),
    /// The file cannot be written; an existing file is unchanged.
    #[error("cannot be written: {}", system_message(*.0))]
    Unwritable(ErrorKind),
    /// The file has another format, or uses a part of the format that is not supported.
    #[error("'{found}' instead of {needed}")]
    Format {
        /// Text of the file, cut to 80 characters, or a description of it.
        found: String,
        /// Requirement.
        needed: String,
    },
    /// The content differs from the content that was written.
    #[error(
        "{quantity} does not agree with its check sum: damaged or changed by hand (delete the file to compute it again)"
    )]
    Damaged {
        /// Damaged part of the file.
        quantity: String,
    },
    /// A quantity is missing, or has no value.
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
        /// The value with its unit.
        ///
        /// Text of the file is in quotation marks, cut to 40 characters.
        found: String,
        /// Requirement.
        needed: String,
    },
    /// The content is too large for the memory.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// The numbers can be read, but a constructor rejects them.
    #[error("{0}")]
    Unusable(Box<Error>),
}

/// Reason why a run could not be saved or resumed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// A part of the scene cannot save its state.
    #[error("the {part} cannot save or restore its state")]
    Unsupported {
        /// The part.
        part: &'static str,
    },
    /// The checkpoint has a format that this version does not read.
    #[error("format {found}, but this version reads {needed}")]
    Format {
        /// Format of the checkpoint.
        found: u32,
        /// Format of this version.
        needed: u32,
    },
    /// The checkpoint belongs to another scene.
    #[error("made in another scene: the {quantity} differs")]
    OtherScene {
        /// The quantity that differs.
        quantity: &'static str,
    },
    /// The contents are damaged, or were changed by hand.
    #[error(
        "{quantity}: damaged or changed by hand (wrong check sum, wrong number of values, or a value that is not finite)"
    )]
    Corrupt {
        /// Quantity with the fault; the contents as a whole if the check sum is wrong.
        quantity: &'static str,
    },
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

    /// A missing quantity.
    #[doc(hidden)]
    pub fn missing(quantity: impl Into<String>) -> Self {
        Self::Missing { quantity: quantity.into() }
    }

    /// Text that does not belong to the format.
    #[doc(hidden)]
    pub fn format(found: impl Into<String>, needed: impl Into<String>) -> Self {
        Self::Format { found: found.into(), needed: needed.into() }
    }

    /// The error for a line of a file.
    ///
    /// If `line` is 0, it is an error of the file as a whole.
    #[doc(hidden)]
    pub fn of(self, file: impl Into<String>, line: usize) -> Error {
        FileError { file: file.into(), line, fault: self }.into()
    }
}

/// Beginning of a message: the file, and the line unless `line` is 0.
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
        kind => kind.to_string(),
    }
}
