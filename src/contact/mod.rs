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

words_with_numbers! {
    /// One of its words, or an [`Error::Word`](crate::Error::Word).
    ///
    /// ```
    /// use basemat::coupled::ContactSearch;
    /// assert_eq!("flow_chart(50)".parse(), Ok(ContactSearch::FlowChart { iterations: 50 }));
    /// assert!("flow_chart(0.5)".parse::<ContactSearch>().is_err());
    /// ```
    ContactSearch, "contact search", { Robust = "robust"; FlowChart { iterations } = "flow_chart" }
}
