//! The solver of the contact problem of a step, in the plane and in space.

use super::cone::ForceSearch;
use super::delassus::Delassus;
use super::problem::{ContactInput, ContactResponse};
use super::search::ModeSearch;
use super::{ContactSearch, SearchMethod};
use crate::error::{LawError, StepError};
use crate::geometry::ContactLayout;
use crate::interface::{InterfaceLaw, Mode, PreviousContacts};

/// Solver of the contact problem of a step, with the solution of the last one.
pub(crate) enum ContactSolver {
    /// Search for modes in the plane.
    Plane(Box<ModeSearch>),
    /// Search for forces in space.
    Space(Box<ForceSearch>),
}

impl ContactSolver {
    /// Solver for elements with these areas (m²), under a structure that `is_linear` or not.
    ///
    /// `search` is the method in the plane.
    pub(crate) fn new(
        layout: ContactLayout,
        areas: &[f64],
        is_linear: bool,
        search: ContactSearch,
    ) -> Self {
        if layout.is_plan() {
            Self::Space(Box::new(ForceSearch::new(areas, is_linear)))
        } else {
            Self::Plane(Box::new(ModeSearch::new(layout.elements(), search)))
        }
    }

    /// Finds admissible `modes` from their present values; the response then stores the solution.
    ///
    /// Returns the number of trials and the method.
    pub(crate) fn solve(
        &mut self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<(usize, SearchMethod), StepError> {
        match self {
            Self::Plane(search) => search.solve(input, modes),
            Self::Space(search) => search.solve(input, modes),
        }
    }

    /// Tractions and states of the last solution.
    pub(crate) fn response(&self) -> &ContactResponse {
        match self {
            Self::Plane(search) => &search.solver.response,
            Self::Space(search) => &search.response,
        }
    }

    /// Smallest friction coefficient that replaced the law's larger one.
    ///
    /// On the sliding elements of the last solution; `None` if none was replaced.
    pub(crate) fn substituted_friction(&self) -> Option<f64> {
        match self {
            Self::Plane(_) => None,
            Self::Space(search) => search.substituted_friction(),
        }
    }

    /// Discards the factors of W; call this when W has changed.
    pub(crate) fn invalidate(&mut self) {
        match self {
            Self::Plane(search) => search.solver.invalidate(),
            Self::Space(search) => search.invalidate(),
        }
    }

    /// Condition number of the system with all elements in their modes of rest.
    ///
    /// It is infinite if the system is singular. In space it is the condition number of W.
    pub(crate) fn condition_number_at_rest(
        &mut self,
        delassus: &Delassus,
        static_traction: &[f64],
        start: &PreviousContacts,
        laws: &[Box<dyn InterfaceLaw>],
    ) -> Result<f64, LawError> {
        match self {
            Self::Plane(search) => {
                search.solver.condition_number_at_rest(delassus, static_traction, start, laws)
            }
            Self::Space(search) => Ok(delassus.condition(search.response.layout.len())),
        }
    }
}
