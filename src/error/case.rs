//! Cases of a sweep, their parameters and their files.

use std::any::Any;
use std::io::ErrorKind;

use super::Error;
use super::requirement::fault_of_file;

/// Why a case of a [`Sweep`](crate::sweep::Sweep) has no result.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError<E> {
    /// The case failed with an error of its own.
    #[error("{0}")]
    Failed(E),
    /// The case panicked.
    #[error("the case panicked: {message}")]
    Panicked {
        /// Message of the panic; empty if the panic has no text.
        message: String,
    },
}

impl<E> CaseError<E> {
    /// A panic with its payload.
    pub(crate) fn panicked(payload: &(dyn Any + Send)) -> Self {
        let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let message = text.or_else(|| payload.downcast_ref().cloned()).unwrap_or_default();
        Self::Panicked { message }
    }
}

impl From<CaseError<Error>> for Error {
    fn from(error: CaseError<Error>) -> Self {
        match error {
            CaseError::Failed(error) => error,
            CaseError::Panicked { message } => SweepError::Panicked { message }.into(),
        }
    }
}

/// Fault of a [`Sweep`](crate::sweep::Sweep)'s parameters, of its table or of the table's files.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A parameter without values.
    #[error("parameter '{parameter}' has no values")]
    NoValues {
        /// Name of the parameter.
        parameter: String,
    },
    /// A column without a name, or an empty text as a value.
    #[error("a {quantity} has an empty name")]
    Unnamed {
        /// Item without a name.
        quantity: &'static str,
    },
    /// A value of a parameter that is NaN or infinite.
    #[error("parameter '{parameter}' has the value {value}, but values must be finite")]
    NotFinite {
        /// Name of the parameter.
        parameter: String,
        /// The value.
        value: f64,
    },
    /// A value that occurs twice in a parameter.
    #[error("parameter '{parameter}' has the value {value} twice")]
    RepeatedValue {
        /// Name of the parameter.
        parameter: String,
        /// The value, printed.
        value: String,
    },
    /// A case that panicked, where its result was needed.
    #[error("the case panicked: {message}")]
    Panicked {
        /// Message of the panic.
        message: String,
    },
    /// The result of a case that failed.
    #[error("case {case} failed: {reason}")]
    Failed {
        /// Number of the case.
        case: usize,
        /// Error of the case, printed.
        reason: String,
    },
    /// A file that cannot be opened or read.
    #[error("{file} cannot be read: {}", fault_of_file(*.reason))]
    Unreadable {
        /// The file.
        file: String,
        /// The system's own message.
        reason: ErrorKind,
    },
    /// A file of rows that cannot be written, for example because the disk is full.
    ///
    /// No case was started after that.
    #[error("{file} cannot be written: {reason}; {computed} cases have rows, {left} are left")]
    Unwritten {
        /// The file.
        file: String,
        /// The system's own message.
        reason: ErrorKind,
        /// Cases with a row, including rows of earlier processes.
        computed: usize,
        /// Cases of the shard without a row.
        left: usize,
        /// All rows so far, as CSV.
        ///
        /// Write them to a file named like the table's with `.part` at the end;
        /// [`Sweep::table_in`](crate::sweep::Sweep::table_in) then continues from them.
        rows: String,
    },
    /// A file that does not hold rows of this sweep.
    #[error("{file}, line {line}: {reason}")]
    File {
        /// The file.
        file: String,
        /// Line number, from 1.
        line: usize,
        /// Fault of the line.
        reason: CaseFileError,
    },
    /// A case that occurs twice.
    #[error("case {case} is in {first} and again in {second}")]
    Twice {
        /// Number of the case.
        case: usize,
        /// File that has it.
        first: String,
        /// File that has it again.
        second: String,
    },
    /// Cases that are in no file.
    #[error("{} of the sweep's cases missing: {}", .cases.len(), missing(.cases, .shards))]
    Missing {
        /// Numbers of the cases, ascending.
        cases: Vec<usize>,
        /// The missing shards, `[index, of]`, if the files and these form equal shards; empty otherwise.
        shards: Vec<[usize; 2]>,
    },
}

/// Text of the missing shards and the first few missing cases.
fn missing(cases: &[usize], shards: &[[usize; 2]]) -> String {
    const SHOWN: usize = 10;
    let dots = |count: usize| if count > SHOWN { ", …" } else { "" };
    let list = cases.iter().take(SHOWN).map(usize::to_string).collect::<Vec<_>>().join(", ");
    let cases = format!("{list}{}", dots(cases.len()));
    if shards.is_empty() {
        return cases;
    }
    let names = shards.iter().take(SHOWN).map(|[index, of]| format!("{index}/{of}"));
    let names = names.collect::<Vec<_>>().join(", ");
    format!("{cases}; shard {names}{}", dots(shards.len()))
}

/// Fault of a line in a file of cases.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CaseFileError {
    /// The file ends within a line: writing was interrupted.
    #[error("the file ends within this line")]
    Cut,
    /// Bytes that are not UTF-8.
    #[error("it is not UTF-8")]
    NotText,
    /// A quotation mark within a cell without quotes, or text behind a cell with them.
    #[error("a quotation mark out of place")]
    Quote,
    /// A line with too few cells, or too many.
    #[error("{found} cells, but {needed} needed")]
    Cells {
        /// Cells found.
        found: usize,
        /// Cells needed.
        needed: usize,
    },
    /// A heading that differs from the sweep's or from the other files'.
    #[error("column {column} is called '{found}', but must be '{needed}'")]
    Heading {
        /// Column, from 1.
        column: usize,
        /// Heading found.
        found: String,
        /// Heading needed.
        needed: String,
    },
    /// A number of a case that the sweep does not have.
    #[error("'{text}' is no case of this sweep")]
    Case {
        /// The cell, cut to 40 characters.
        text: String,
    },
    /// A value that the parameter does not have in this case.
    #[error("{parameter} is '{found}' in case {case}, but must be '{needed}'")]
    Parameter {
        /// Number of the case.
        case: usize,
        /// Name of the parameter.
        parameter: String,
        /// The cell, cut to 40 characters.
        found: String,
        /// Value in this sweep, printed.
        needed: String,
    },
    /// A result that is not a number.
    #[error("{column} is '{text}', which is no number")]
    NotANumber {
        /// Name of the column.
        column: String,
        /// The cell, cut to 40 characters.
        text: String,
    },
    /// A row with a wrong check sum: it differs from the row written.
    #[error(
        "case {case} does not agree with its check sum: the row was damaged or changed by hand"
    )]
    Damaged {
        /// Number of the case.
        case: usize,
    },
    /// A case with both an error and results.
    #[error("case {case} has an error and results")]
    ErrorAndResults {
        /// Number of the case.
        case: usize,
    },
}
