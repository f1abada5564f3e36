//! The contact problem of a step: tractions, openings and modes of all elements.
//!
//! A [`Simulation`](crate::Simulation) solves it in every step. Codes with an integrator of their own
//! take a [`Ground`](crate::bem::Ground) and a [`ContactProblem`].

mod delassus;
mod element;
mod host;
mod path;
mod problem;
mod search;

pub(crate) use delassus::Delassus;
pub use host::{ContactProblem, ContactSolution};
pub(crate) use problem::{ContactInput, ContactSolver};
pub(crate) use search::ModeSearch;
pub use search::{ContactSearch, SearchMethod};

use std::fmt;
use std::str::FromStr;

use crate::error::{Error, Result};
use crate::text::words::{count, unknown, with_number};

/// The words that `FromStr` reads: `robust`, `flow_chart(50)`.
impl fmt::Display for ContactSearch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robust => f.pad("robust"),
            Self::FlowChart { iterations } => f.pad(&format!("flow_chart({iterations})")),
        }
    }
}

/// ```
/// use basemat::coupled::ContactSearch;
/// assert_eq!("flow_chart(50)".parse(), Ok(ContactSearch::FlowChart { iterations: 50 }));
/// assert!("flow_chart(0.5)".parse::<ContactSearch>().is_err());
/// ```
impl FromStr for ContactSearch {
    type Err = Error;

    /// # Errors
    /// [`Error::Word`] with those that are known.
    fn from_str(text: &str) -> Result<Self> {
        let known = &["robust", "flow_chart(iterations)"];
        let read = with_number(text);
        read.and_then(|(word, number)| match (&word[..], number) {
            ("robust", None) => Some(Self::Robust),
            ("flow_chart", Some(number)) => {
                count(number).map(|iterations| Self::FlowChart { iterations })
            }
            _ => None,
        })
        .ok_or_else(|| unknown("contact search", text, known))
    }
}
