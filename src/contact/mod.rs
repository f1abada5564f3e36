//! The contact problem of a step: tractions, openings and modes of all elements.
//!
//! A [`Simulation`](crate::Simulation) solves this problem in every step. Codes with their own integrator use
//! a [`Ground`](crate::bem::Ground) and a [`ContactProblem`].

mod cone;
mod contact_problem;
mod delassus;
mod element;
mod fixed_modes;
mod linearisation;
mod on_bed;
mod path;
mod problem;
mod reduced_row;
mod row_updates;
mod search;
mod solver;
mod trial_line;

pub use contact_problem::{ContactProblem, ContactSolution};
pub(crate) use delassus::{Delassus, MAX_STRUCTURE_RANK};
pub(crate) use on_bed::{OnBed, StructurePart};
pub(crate) use problem::ContactInput;
pub(crate) use solver::ContactSolver;

/// Search for the contact modes of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum ContactSearch {
    /// Active set, then Gauss–Seidel, then path following. The default.
    ///
    /// If there are at most 65 536 sets of modes, all sets follow.
    #[default]
    Robust,
    /// Only the flow chart in the Appendix of Patel & Spyrakos.
    ///
    /// Assume the modes of the previous step, solve, determine the next mode of every element, and repeat
    /// until no mode changes. The step returns an error if modes occur a second time, or if more than
    /// `iterations` solves are needed.
    FlowChart {
        /// Largest number of solves per step; one or more.
        iterations: usize,
    },
}

/// Method that found the modes of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum SearchMethod {
    /// The active set converged.
    ActiveSet,
    /// Gauss–Seidel with local enumeration was needed.
    GaussSeidel,
    /// The solution was followed from a known solution, or found among all sets of modes.
    Path,
    /// Newton's method, in space.
    Newton,
    /// Proximal point method, in space.
    Proximal,
}

words! { pub(crate) SearchMethod, "search method", {
    ActiveSet = "active_set",
    GaussSeidel = "gauss_seidel",
    Path = "path",
    Newton = "newton",
    Proximal = "proximal",
} }

words_with_numbers! {
    /// Parses one of its words, or returns [`Error::Name`](crate::Error::Name).
    ///
    /// ```
    /// use basemat::contact::ContactSearch;
    /// assert_eq!("flow_chart(50)".parse(), Ok(ContactSearch::FlowChart { iterations: 50 }));
    /// assert!("flow_chart(0.5)".parse::<ContactSearch>().is_err());
    /// ```
    ContactSearch, "contact search", { Robust = "robust"; FlowChart { iterations } = "flow_chart" }
}
