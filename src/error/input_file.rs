//! Errors of meshes and matrices in files.

use super::{Error, MemoryError};

/// Fault of a line of a mesh's file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileError {
    /// The file could not be read.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::ErrorKind),
    /// Something that is needed is not there.
    #[error("there is no {what}")]
    Missing {
        /// Missing item.
        what: String,
    },
    /// Something is there twice.
    #[error("{what} is given twice")]
    Twice {
        /// Repeated item.
        what: String,
    },
    /// A section has more or fewer things than it says.
    #[error("{found} {what}, but {announced} are announced")]
    Count {
        /// Counted items.
        what: &'static str,
        /// Number found.
        found: usize,
        /// Number that the section states.
        announced: u64,
    },
    /// A field is not what it must be.
    #[error("'{text}' is no {what}")]
    NotA {
        /// Required value.
        what: &'static str,
        /// The field, cut to 40 characters.
        text: String,
    },
    /// Something that the crate does not read.
    #[error("cannot use {text}")]
    Unsupported {
        /// Value found.
        text: String,
    },
    /// An element that the mesh does not take.
    #[error("element {tag}: {source}")]
    Element {
        /// The element's tag in the file.
        tag: u64,
        /// Why.
        r#source: Box<Error>,
    },
    /// A line is too long to be one of numbers.
    #[error("no line end in {bytes} bytes")]
    LineTooLong {
        /// Bytes read without a line end.
        bytes: usize,
    },
}

// Files of matrices.

/// Fault of a Matrix Market file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MatrixFileError {
    /// The file could not be read.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::ErrorKind),
    /// The file could not be written.
    #[error("cannot be written: {0}")]
    Unwritable(std::io::ErrorKind),
    /// The file has no line.
    #[error("the file is empty")]
    Empty,
    /// The first line is no Matrix Market header.
    #[error("'{text}' is not '%%MatrixMarket matrix <format> <field> <symmetry>'")]
    Header {
        /// The line, cut to 80 characters.
        text: String,
    },
    /// The header asks for something that a structure's matrix cannot be.
    #[error("'{text}' is not supported: a real matrix, coordinate or array, general or symmetric")]
    Unsupported {
        /// The word of the header.
        text: String,
    },
    /// A line has too few or too many fields.
    #[error("{found} fields, but {needed} are needed")]
    Fields {
        /// Fields found.
        found: usize,
        /// Fields needed.
        needed: usize,
    },
    /// A field is no finite number, or no whole number where one is needed.
    #[error("'{text}' is not a number that can stand here")]
    NotANumber {
        /// The field, cut to 40 characters.
        text: String,
    },
    /// The matrix is not square.
    #[error("{rows} rows and {columns} columns: the matrix must be square")]
    NotSquare {
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
    },
    /// The matrix would not fit into memory.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// A row or column that the matrix does not have.
    #[error("index {index}, but the matrix has {order} rows and columns")]
    Index {
        /// The index, which counts from 1.
        index: usize,
        /// Rows and columns.
        order: usize,
    },
    /// A symmetric matrix is given by its lower triangle.
    #[error("entry ({row}, {column}) is above the diagonal of a symmetric matrix")]
    AboveDiagonal {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
    },
    /// There are fewer or more entries than the size line says.
    #[error("entry {found} of {needed}: the size line and the entries do not agree")]
    Entries {
        /// Entries found.
        found: usize,
        /// Entries announced.
        needed: usize,
    },
    /// A line is too long to be one of numbers.
    #[error("no line end in {bytes} bytes")]
    LineTooLong {
        /// Bytes read without a line end.
        bytes: usize,
    },
}
