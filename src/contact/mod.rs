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
