//! Errors of sweeps and of their cases.

use std::any::Any;
use std::io::ErrorKind;

use crate::error::Error;

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
            CaseError::Panicked { message } => Self::part("the case panicked", message),
        }
    }
}

/// Fault of the table of a [`Sweep`](crate::sweep::Sweep).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
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
