//! Faults of files: ground motions, meshes, matrices.

use super::Error;
#[cfg(feature = "io")]
use super::MemoryError;
use super::requirement::fault_of_file;

/// Fault of a line of a record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The file could not be read.
    #[error("cannot be read: {}", fault_of_file(*.0))]
    Unreadable(std::io::ErrorKind),
    /// Too few samples.
    #[error("{found} samples, at least {needed} needed")]
    TooShort {
        /// Samples found.
        found: usize,
        /// Samples needed.
        needed: usize,
    },
    /// A line has too few columns.
    #[error("{found} columns, but column {needed} was asked for")]
    Column {
        /// Columns found.
        found: usize,
        /// Requested column, from 1.
        needed: usize,
    },
    /// A field is not a finite number.
    #[error("'{text}' is not a finite number")]
    NotANumber {
        /// The field, cut to 40 characters.
        text: String,
    },
    /// The time column does not advance by equal steps.
    #[error("time advances by {found} s, but by {expected} s before")]
    UnequalStep {
        /// Step that was found, s.
        found: f64,
        /// The first step, s.
        expected: f64,
    },
    /// Steps of the time column that are nearly equal, but drift from equal steps.
    #[error("time is {found} s, but would be {expected} s with equal steps")]
    DriftingStep {
        /// Time that was found, s.
        found: f64,
        /// The time with equal steps, s.
        expected: f64,
    },
    /// The times are equally spaced, but rounded too coarsely to determine the time step.
    #[error(
        "times rounded to {resolution} s do not tell a time step near {step} s: give it (`time_step`)"
    )]
    RoundedTimes {
        /// Unit of the last digit of the times, s.
        resolution: f64,
        /// Mean of the steps, s.
        step: f64,
    },
    /// The time column does not increase.
    #[error("time advances by {found} s, but must advance")]
    TimeNotIncreasing {
        /// Step that was found, s.
        found: f64,
    },
    /// The number of samples differs from the given one.
    #[error("{found} samples, but {needed} asked for")]
    SampleCount {
        /// Samples found.
        found: usize,
        /// Given number of samples.
        needed: usize,
    },
    /// A quantity is missing in the header.
    #[error("the header has no {quantity}, or none that makes sense")]
    Missing {
        /// Missing quantity.
        quantity: &'static str,
    },
    /// A quantity of the header without a known number or unit.
    #[error("the {quantity} '{text}' is not understood")]
    Unclear {
        /// Name of the quantity.
        quantity: &'static str,
        /// The file's own words, cut to 40 characters.
        text: String,
    },
    /// A line does not match the columns of the file's Fortran format, which place the decimal points or scale the
    /// numbers; or it does, and previous lines did not.
    #[error("'{text}': not all lines keep to the file's format, which places the decimal points")]
    OffColumns {
        /// The line, cut to 40 characters.
        text: String,
    },
    /// A line with commas, or with two tabs together, has another number of fields than the previous lines.
    ///
    /// Its columns may have shifted.
    #[error("{found} columns, but {expected} before")]
    UnequalColumns {
        /// Columns found.
        found: usize,
        /// Columns of the lines before.
        expected: usize,
    },
    /// The file contains another quantity than acceleration, or an unknown unit.
    #[error("'{text}' is no acceleration in a known unit")]
    NotAcceleration {
        /// The file's own description of its numbers, cut to 60 characters.
        text: String,
    },
    /// Two places of the file state different values of a quantity.
    #[error("the {quantity} is {found}, but elsewhere the file states {stated}")]
    Contradiction {
        /// Name of the quantity, with its unit.
        quantity: &'static str,
        /// The value with which the samples would be read.
        found: f64,
        /// The value of the other place.
        stated: f64,
    },
    /// The file contains unprocessed data, which are no acceleration at equal steps.
    #[error("'{text}': {kind}; read the file of corrected data (volume 2)")]
    Unprocessed {
        /// Kind of the data.
        kind: &'static str,
        /// The file's own description of its numbers, cut to 60 characters.
        text: String,
    },
    /// A line before all numbers that contains neither numbers nor the column titles.
    #[error(
        "'{text}' is not a finite number: with more than one line of header, give their number (`header_lines`)"
    )]
    HeaderLine {
        /// The first field that is not a number, cut to 40 characters.
        text: String,
    },
    /// The title of a column names another unit than the given one.
    #[error("the title '{text}' names another unit than {unit}, in which the column is read")]
    TitleUnit {
        /// The title, cut to 40 characters.
        text: String,
        /// The unit of the column.
        unit: String,
    },
    /// There is no channel of this number.
    #[error("{found} channels, but channel {needed} was asked for (they count from 1)")]
    Channel {
        /// Channels found.
        found: usize,
        /// Requested channel.
        needed: usize,
    },
    /// A line has several columns where one was expected.
    #[error("{found} columns, but one was expected (name the one of the acceleration)")]
    SeveralColumns {
        /// Columns found.
        found: usize,
    },
    /// The numbers can be read, but form no valid record.
    #[error("{0}")]
    Unusable(Box<Error>),
    /// A line is too long for a line of numbers.
    #[error("no line end in {bytes} bytes")]
    LineTooLong {
        /// Bytes read without a line end.
        bytes: usize,
    },
}

// Files of meshes.

/// Fault of a line of a mesh's file.
#[cfg(feature = "io")]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileError {
    /// The file could not be read.
    #[error("cannot be read: {}", fault_of_file(*.0))]
    Unreadable(std::io::ErrorKind),
    /// A required item is missing.
    #[error("there is no {what}")]
    Missing {
        /// Missing item.
        what: String,
    },
    /// An item occurs twice.
    #[error("{what} is given twice")]
    Twice {
        /// Repeated item.
        what: String,
    },
    /// A section has more or fewer items than it states.
    #[error("{found} {what}, but {announced} are announced")]
    Count {
        /// Counted items.
        what: &'static str,
        /// Number found.
        found: usize,
        /// Number that the section states.
        announced: u64,
    },
    /// A field has an invalid value.
    #[error("'{text}' is no {what}")]
    NotA {
        /// Required value.
        what: &'static str,
        /// The field, cut to 40 characters.
        text: String,
    },
    /// A feature that the crate does not read.
    #[error("cannot use {text}")]
    Unsupported {
        /// Value found.
        text: String,
    },
    /// An element that the mesh rejects.
    #[error("element {tag}: {source}")]
    Element {
        /// The element's tag in the file.
        tag: u64,
        /// Reason.
        r#source: Box<Error>,
    },
    /// A line is too long for a line of numbers.
    #[error("no line end in {bytes} bytes")]
    LineTooLong {
        /// Bytes read without a line end.
        bytes: usize,
    },
}

// Files of matrices.

/// Fault of a Matrix Market file.
#[cfg(feature = "io")]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MatrixFileError {
    /// The file could not be read.
    #[error("cannot be read: {}", fault_of_file(*.0))]
    Unreadable(std::io::ErrorKind),
    /// The file could not be written.
    #[error("cannot be written: {}", fault_of_file(*.0))]
    Unwritable(std::io::ErrorKind),
    /// The file has no line.
    #[error("the file is empty")]
    Empty,
    /// The first line is not a Matrix Market header.
    #[error("'{text}' is not '%%MatrixMarket matrix <format> <field> <symmetry>'")]
    Header {
        /// The line, cut to 80 characters.
        text: String,
    },
    /// The header describes a matrix that a structure cannot have.
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
    /// A field is not a finite number, or not a whole number where one is needed.
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
    /// A row or column beyond the matrix.
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
    /// Fewer or more entries than the size line states.
    #[error("entry {found} of {needed}: the size line and the entries do not agree")]
    Entries {
        /// Entries found.
        found: usize,
        /// Entries announced.
        needed: usize,
    },
    /// A line is too long for a line of numbers.
    #[error("no line end in {bytes} bytes")]
    LineTooLong {
        /// Bytes read without a line end.
        bytes: usize,
    },
}
