//! The contact problem of a step: tractions, openings and modes of all elements.

mod path;
mod problem;
mod search;

pub(crate) use problem::{ContactInput, ContactSolver};
pub(crate) use search::ModeSearch;
pub use search::{ContactSearch, SearchMethod};
