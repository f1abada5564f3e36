//! The contact problem of a step, condensed to the tractions of the elements.
//!
//! | symbol | meaning |
//! |---|---|
//! | W | Delassus operator: jump (soil − structure, normal components down) per unit traction |
//! | j₀ | jump at the end of the step without changes of traction |
//! | τ | change of traction from the static state |
//!
//! jump = j₀ + W τ. Its normal components are gaps. The slip of the structure is minus its tangential
//! components.

use std::cell::Cell;

use super::delassus::Delassus;
use super::trial_line::TrialLine;
use crate::error::{Error, LawError};
use crate::geometry::ContactLayout;
use crate::interface::{
    Condition, ContactState, InterfaceLaw, Limits, Mode, PreviousContact, PreviousContacts,
    Tolerance, law_of,
};

/// Result of a function that calls interface laws.
pub(super) type LawResult<T> = Result<T, LawError>;

/// State of an element's bond in a search for modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bond {
    /// No bond, or the search treats the bond as part of the law.
    Free,
    /// The element stays in its mode of rest at any traction.
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
    /// Largest displacement in j₀, m; gaps below its rounding error are zero.
    pub(crate) length_scale: f64,
    /// Bonds, one per element; empty if all are free.
    pub(crate) bonds: &'a [Bond],
    /// Lines in place of the laws' curves, one per element.
    ///
    /// If empty, the tangents at a settlement of zero hold.
    pub(crate) trial_lines: &'a [Cell<TrialLine>],
    /// In space, whether laws act without friction and cohesion, as while the weight is applied.
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

    /// Start of the step for an element's law.
    ///
    /// A bond that breaks in the step is already broken.
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
    pub(super) fn limits(&self, element: usize, settlement: f64) -> LawResult<Limits> {
        let mut start = self.start.element(element);
        start.trial_settlement = settlement;
        let mode = start.mode.word();
        let limits = match self.law(element).limits(&start) {
            Ok(limits) if limits.are_valid() => limits,
            result => result.and_then(Limits::checked).map_err(|reason| LawError {
                element,
                mode,
                reason: Box::new(reason),
            })?,
        };
        Ok(if self.frictionless { limits.frictionless() } else { limits })
    }

    /// Modes allowed for an element.
    pub(super) fn modes(&self, element: usize) -> &[Mode] {
        let modes = self.law(element).modes();
        if self.bond(element) == Bond::Intact { &modes[..1] } else { modes }
    }

    /// Conditions of the element's law in `mode`, all finite.
    #[inline]
    pub(super) fn conditions(&self, element: usize, mode: Mode) -> LawResult<[Condition; 2]> {
        let law = self.law(element);
        let start = self.start_of(element);
        let mut conditions = law.conditions(mode, &start);
        if mode.is_yield()
            && let Some(line) = self.trial_lines.get(element)
        {
            line.get().replace_tangent(&mut conditions[0]);
        }
        // The sum also overflows for some finite values.
        if !(conditions[0].sum() + conditions[1].sum()).is_finite()
            && let Some((quantity, value)) = conditions.iter().find_map(Condition::not_finite)
        {
            return Err(match law.check_start(&start) {
                Ok(()) => LawError::not_finite(element, mode.word(), quantity, value),
                Err(reason) => LawError { element, mode: mode.word(), reason: Box::new(reason) },
            });
        }
        Ok(conditions)
    }

    /// Next mode from the element's law, which must be a mode of this law.
    pub(super) fn next_mode(
        &self,
        element: usize,
        mode: Mode,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> LawResult<Mode> {
        if self.bond(element) == Bond::Intact {
            return Ok(mode);
        }
        let law = self.law(element);
        let next = law.next_mode(mode, &self.start_of(element), trial, tolerance);
        if next == mode || law.modes().contains(&next) {
            return Ok(next);
        }
        let modes = law.modes().iter().map(|mode| mode.word());
        let reason = Box::new(Error::no_name("next mode in the law's `modes`", next.word(), modes));
        Err(LawError { element, mode: mode.word(), reason })
    }

    /// Traction by which a trial exceeds the strength of an element's bond.
    ///
    /// `None` without a bond.
    pub(super) fn overload(&self, element: usize, trial: &ContactState) -> LawResult<Option<f64>> {
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

/// Tractions of a trial or solution, with the jumps and states due to them.
pub(crate) struct ContactResponse {
    pub(super) layout: ContactLayout,
    /// Change of traction from the static state, Pa, for each contact component.
    pub(crate) traction: Vec<f64>,
    /// Jump, m, for each contact component.
    pub(super) jump: Vec<f64>,
    /// Opening and total traction of each element.
    pub(crate) states: Vec<ContactState>,
}

impl ContactResponse {
    /// Response without tractions.
    pub(super) fn new(layout: ContactLayout) -> Self {
        Self {
            layout,
            traction: vec![0.0; layout.len()],
            jump: vec![0.0; layout.len()],
            states: vec![ContactState::default(); layout.elements()],
        }
    }

    /// Computes the jump and the states for the present tractions.
    pub(super) fn evaluate(&mut self, input: &ContactInput<'_>) {
        self.jump.copy_from_slice(input.free_jump);
        input.delassus.multiply_add(&self.traction, &mut self.jump);
        self.update_states(input);
    }

    /// Computes the states for the present tractions and jump.
    pub(super) fn update_states(&mut self, input: &ContactInput<'_>) {
        let Self { layout, traction, jump, states } = self;
        let is_plan = layout.is_plan();
        for (e, state) in states.iter_mut().enumerate() {
            let total_traction = |component| {
                let i = layout.index_of(component, e);
                input.static_traction[i] + traction[i]
            };
            let jump = |component| jump[layout.index_of(component, e)];
            *state = ContactState::from_components(jump, total_traction, is_plan);
        }
    }
}
