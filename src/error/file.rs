//! Files of ground motions.

use super::Error;

/// Fault of a line of a record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The file could not be read.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::ErrorKind),
    /// There are too few samples.
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
        /// Column asked for, from 1.
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
        /// This step, s.
        found: f64,
        /// The first step, s.
        expected: f64,
    },
    /// The steps of the time column are nearly equal, but drift away from equal ones.
    #[error("time is {found} s, but would be {expected} s with equal steps")]
    DriftingStep {
        /// This time, s.
        found: f64,
        /// The time with equal steps, s.
        expected: f64,
    },
    /// The time column does not increase.
    #[error("time advances by {found} s, but must advance")]
    TimeNotIncreasing {
        /// This step, s.
        found: f64,
    },
    /// The number of samples is not the one that was asked for.
    #[error("{found} samples, but {needed} asked for")]
    SampleCount {
        /// Samples found.
        found: usize,
        /// Samples asked for.
        needed: usize,
    },
    /// The header lacks something.
    #[error("the header has no {quantity}, or none that makes sense")]
    Missing {
        /// Missing quantity.
        quantity: &'static str,
    },
    /// A quantity of the header is given, but not as a number and a unit that are known.
    #[error("the {quantity} '{text}' is not understood")]
    Unclear {
        /// Name of the quantity.
        quantity: &'static str,
        /// The file's own words, cut to 40 characters.
        text: String,
    },
    /// A line does not keep to the columns of the file's Fortran format, which place the decimal
    /// points or scale the numbers; or it does, and those before did not.
    #[error("'{text}': not all lines keep to the file's format, which places the decimal points")]
    OffColumns {
        /// The line, cut to 40 characters.
        text: String,
    },
    /// A line with commas, or with two tabs together, has another number of fields than those before:
    /// its columns may be others.
    #[error("{found} columns, but {expected} before")]
    UnequalColumns {
        /// Columns found.
        found: usize,
        /// Columns of the lines before.
        expected: usize,
    },
    /// The file holds something else than an acceleration, or in a unit that is not known.
    #[error("'{text}' is no acceleration in a known unit")]
    NotAcceleration {
        /// The file's own description of its numbers, cut to 60 characters.
        text: String,
    },
    /// There is no channel of this number.
    #[error("{found} channels, but channel {needed} was asked for (they count from 1)")]
    Channel {
        /// Channels found.
        found: usize,
        /// Channel asked for.
        needed: usize,
    },
    /// A line has several columns where one was expected.
    #[error("{found} columns, but one was expected (name the one of the acceleration)")]
    SeveralColumns {
        /// Columns found.
        found: usize,
    },
    /// The numbers can be read, but make no record.
    #[error("{0}")]
    Unusable(Box<Error>),
    /// A line is too long to be one of numbers.
    #[error("no line end in {bytes} bytes")]
    LineTooLong {
        /// Bytes read without a line end.
        bytes: usize,
    },
}
