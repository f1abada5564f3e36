//! Which search finds the contact of a step, and which method did.

/// Search for the contact modes of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum ContactSearch {
    /// Active set, then Gauss–Seidel, then path following, then, if there are no more than 65 536 sets
    /// of modes, all of them: finds what there is to find.
    #[default]
    Robust,
    /// The flow chart in the Appendix of Patel & Spyrakos alone: assume the modes of the step
    /// before, solve, ask every element, change modes, repeat until nothing changes. Where it
    /// comes back to modes it has tried, or needs more than `iterations` of them, the step is an
    /// error.
    FlowChart {
        /// Solves per step, at most; one or more.
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
    /// The solution was followed from a known one, or found among all sets of modes.
    Path,
    /// In plan: Newton's method was needed.
    Newton,
    /// In plan: the proximal point method was needed.
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
    /// One of its words, or an [`Error::Word`](crate::Error::Word).
    ///
    /// ```
    /// use basemat::contact::ContactSearch;
    /// assert_eq!("flow_chart(50)".parse(), Ok(ContactSearch::FlowChart { iterations: 50 }));
    /// assert!("flow_chart(0.5)".parse::<ContactSearch>().is_err());
    /// ```
    ContactSearch, "contact search", { Robust = "robust"; FlowChart { iterations } = "flow_chart" }
}
