//! Results of a run.

mod base;
mod ledger;
mod peak;
mod run;
mod series;

pub(crate) use base::{PyFoundationSummary, PyServiceCheck};
pub(crate) use ledger::PyLedger;
pub(crate) use peak::{PyExtremes, PyPeak};
pub(crate) use run::PyRun;
