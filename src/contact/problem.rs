//! The contact problem of a step, condensed to the tractions of the elements.
//!
//! | symbol | meaning |
//! |---|---|
//! | W | Delassus operator: jump (soil − structure, normal components down) per unit traction |
//! | j₀ | jump at the end of the step if tractions stayed at their static values |
//! | τ | change of traction from the static state |
//!
//! jump = j₀ + W τ. Its normal components are gaps. The slip of the structure is minus its tangential
//! components.

use std::cell::Cell;

use super::delassus::Delassus;
use super::trial_line::TrialLine;
use crate::error::{Error, LawError};
use crate::interface::{
    Condition, ContactState, InterfaceLaw, Limits, Mode, PreviousContact, PreviousContacts,
    Tolerance, law_of,
};

/// State of an element's bond in the search for the modes of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bond {
    /// No bond, or the search does not distinguish bonds: the law decides.
    Free,
    /// The bond holds the element in its mode of rest at any traction.
    Intact,
    /// The bond has broken in this step.
    Broken,
}

/// Data of a step for the contact problem.
#[derive(Clone, Copy)]
pub(crate) struct ContactInput<'a> {
    /// W, square, row-major.
    pub(crate) delassus: &'a Delassus,
    /// j₀, one number for each contact component.
    pub(crate) free_jump: &'a [f64],
    /// Static tractions, Pa, one for each contact component.
    pub(crate) static_traction: &'a [f64],
    /// Contact of each element at the end of the previous step.
    pub(crate) start: &'a PreviousContacts,
    /// One law for all elements, or one each.
    pub(crate) laws: &'a [Box<dyn InterfaceLaw>],
    /// Largest displacement in j₀, m; its rounding limits the gaps that can be distinguished.
    pub(crate) length_scale: f64,
    /// Bonds, one per element; empty if all are free.
    pub(crate) bonds: &'a [Bond],
    /// Lines in place of the laws' curves, one per element; empty for the tangents at a settlement of zero.
    pub(crate) trial_lines: &'a [Cell<TrialLine>],
    /// In plan, whether friction and cohesion are left out, as while the weight comes on.
    pub(crate) frictionless: bool,
}

impl ContactInput<'_> {
    /// The law of an element.
    pub(crate) fn law(&self, element: usize) -> &dyn InterfaceLaw {
        law_of(self.laws, element)
    }

    /// Bond of an element.
    pub(super) fn bond(&self, element: usize) -> Bond {
        self.bonds.get(element).copied().unwrap_or(Bond::Free)
    }

    /// Start of the step as an element's law receives it: without a bond that breaks in the step.
    #[inline]
    pub(super) fn start_of(&self, element: usize) -> PreviousContact<'_> {
        let mut start = self.start.element(element);
        start.has_opened |= self.bond(element) == Bond::Broken;
        if let Some(line) = self.trial_lines.get(element) {
            start.trial_settlement = line.get().settlement;
        }
        start
    }

    /// Limits of an element's law, linearised at a settlement in the step (m), and checked.
    pub(super) fn limits(&self, element: usize, settlement: f64) -> Result<Limits, LawError> {
        let mut start = self.start.element(element);
        start.trial_settlement = settlement;
        let mode = start.mode.word();
        let limits = self
            .law(element)
            .limits(&start)
            .and_then(Limits::checked)
            .map_err(|reason| LawError { element, mode, reason: Box::new(reason) })?;
        Ok(if self.frictionless { limits.frictionless() } else { limits })
    }

    /// Modes allowed for an element.
    pub(super) fn modes(&self, element: usize) -> &[Mode] {
        let modes = self.law(element).modes();
        if self.bond(element) == Bond::Intact { &modes[..1] } else { modes }
    }

    /// Conditions of the element's law in `mode`, all finite.
    #[inline]
    pub(super) fn conditions(
        &self,
        element: usize,
        mode: Mode,
    ) -> Result<[Condition; 2], LawError> {
        let law = self.law(element);
        let start = self.start_of(element);
        let mut pair = law.conditions(mode, &start);
        if mode.is_yield()
            && let Some(line) = self.trial_lines.get(element)
        {
            line.get().replace_tangent(&mut pair[0]);
        }
        // A value is not finite, or the sum overflows.
        if !(pair[0].sum() + pair[1].sum()).is_finite()
            && let Some((quantity, value)) = pair.iter().find_map(Condition::not_finite)
        {
            return Err(match law.check_start(&start) {
                Ok(()) => LawError::not_finite(element, mode.word(), quantity, value),
                Err(reason) => LawError { element, mode: mode.word(), reason: Box::new(reason) },
            });
        }
        Ok(pair)
    }

    /// Next mode from the element's law, which must be a mode of this law.
    pub(super) fn next_mode(
        &self,
        element: usize,
        mode: Mode,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Result<Mode, LawError> {
        if self.bond(element) == Bond::Intact {
            return Ok(mode);
        }
        let law = self.law(element);
        let next = law.next_mode(mode, &self.start_of(element), trial, tolerance);
        if next == mode || law.modes().contains(&next) {
            return Ok(next);
        }
        let known = law.modes().iter().map(|mode| mode.word());
        let reason = Box::new(Error::no_name("next mode in the law's `modes`", next.word(), known));
        Err(LawError { element, mode: mode.word(), reason })
    }

    /// Traction by which a trial exceeds the strength of an element's bond; `None` without a bond.
    pub(super) fn overload(
        &self,
        element: usize,
        trial: &ContactState,
    ) -> Result<Option<f64>, LawError> {
        match self.law(element).bond_overload(&self.start_of(element), trial) {
            Some(value) if !value.is_finite() => {
                let mode = self.law(element).modes()[0];
                let quantity = "overload of the bond";
                Err(LawError::not_finite(element, mode.word(), quantity, value))
            }
            overload => Ok(overload),
        }
    }
}
