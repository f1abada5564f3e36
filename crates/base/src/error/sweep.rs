//! Errors of sweeps and of their cases.

use std::any::Any;
use std::io::ErrorKind;

use crate::error::Error;

/// Reason why a case of a `Sweep` has no result.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError<E> {
    /// The case failed with this error.
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
    /// The error for a panic with this payload.
    #[doc(hidden)]
    pub fn panicked(payload: &(dyn Any + Send)) -> Self {
        let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let message = text.or_else(|| payload.downcast_ref().cloned()).unwrap_or_default();
        Self::Panicked { message }
    }
}

impl From<CaseError<Error>> for Error {
    fn from(error: CaseError<Error>) -> Self {
        match error {
            CaseError::Failed(error) => error,
            CaseError::Panicked { message } => Self::part("the case panicked", message),
        }
    }
}

/// Fault in the table of a `Sweep`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A file of rows cannot be written, for example because the disk is full.
    ///
    /// No case was started after this fault.
    #[error("{file} cannot be written: {reason}; {computed} cases have rows, {left} cases remain")]
    Unwritten {
        /// The file.
        file: String,
        /// The reason that the system states.
        reason: ErrorKind,
        /// Cases with a row, including rows of earlier processes.
        computed: usize,
        /// Cases of the shard without a row.
        left: usize,
        /// All rows so far, as CSV.
        ///
        /// Write them to a file named like the table's with `.part` at the end;
        /// `Sweep::table_in` then continues from them.
        rows: String,
    },
    /// No file contains these cases.
    #[error("{} of the sweep's cases missing: {}", .cases.len(), missing_cases_text(.cases, .shards))]
    Missing {
        /// Numbers of the cases, ascending.
        cases: Vec<usize>,
        /// The missing shards, as `[index, count]`.
        ///
        /// Empty unless the files and the missing cases form equal shards.
        shards: Vec<[usize; 2]>,
    },
}

/// Largest number of cases and of shards in a message: more would hide the fault.
const MAX_LISTED_CASES: usize = 10;

/// Text of the first missing cases and of the first missing shards.
fn missing_cases_text(cases: &[usize], shards: &[[usize; 2]]) -> String {
    let cases_text = first_items(cases.iter().map(usize::to_string), cases.len());
    if shards.is_empty() {
        return cases_text;
    }
    let shard_names = shards.iter().map(|[index, count]| format!("{index}/{count}"));
    format!("{cases_text}; shard {}", first_items(shard_names, shards.len()))
}

/// The first of `count` items, with dots for the others.
fn first_items(items: impl Iterator<Item = String>, count: usize) -> String {
    let dots = if count > MAX_LISTED_CASES { ", …" } else { "" };
    format!("{}{dots}", items.take(MAX_LISTED_CASES).collect::<Vec<_>>().join(", "))
}
