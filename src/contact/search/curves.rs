//! Search for the modes of elements whose pressure is a curve over the settlement.

use super::ModeSearch;
use crate::contact::SearchMethod;
use crate::contact::linearisation::{Linearisation, TangentSolution};
use crate::contact::problem::ContactInput;
use crate::error::{LawError, StepError};
use crate::interface::{Mode, Tolerance};

impl ModeSearch {
    /// Finds modes with other tangents until the pressures are on the curves of their laws.
    pub(super) fn follow_curves(
        &mut self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<SearchMethod, StepError> {
        let mut last_method = SearchMethod::ActiveSet;
        let mut linearisation = Linearisation::new();
        loop {
            let mut bonds = std::mem::take(&mut self.bonds);
            let found = self.break_bonds(input, modes, &mut bonds);
            self.bonds = bonds;
            let Some(method) = found? else { return Err(self.failure(input, modes)) };
            last_method = last_method.max(method);
            // The active set itself ends on the curves.
            if method == SearchMethod::ActiveSet {
                return Ok(last_method);
            }
            self.move_tangents(input, modes, &mut linearisation)?;
            if linearisation.is_done()? {
                return Ok(last_method);
            }
        }
    }

    /// Compares the last trial with the curves of the laws, and moves the tangents; returns whether any has moved.
    pub(super) fn move_tangents(
        &mut self,
        input: &ContactInput<'_>,
        modes: &[Mode],
        linearisation: &mut Linearisation,
    ) -> Result<bool, LawError> {
        linearisation.begin();
        let mut tolerance = None;
        let mut has_moved = false;
        for (e, mode) in modes.iter().enumerate() {
            let Some(trial_settlement) = input.trial_settlements.get(e) else { continue };
            if !self.solver.hardens(e, *mode) && trial_settlement.get() == 0.0 {
                continue;
            }
            let tolerance = *tolerance.get_or_insert_with(|| self.solver.tolerance(input));
            let settlement = trial_settlement.get();
            let solution = self.tangent_solution(input, e, *mode, settlement, tolerance)?;
            if let Some(solution) = solution
                && let Some(next) = linearisation.compare(input, &solution, settlement)?
            {
                trial_settlement.set(next);
                has_moved = true;
            }
        }
        Ok(has_moved)
    }

    /// Solution of an element in a mode with the tangent at a trial settlement (m).
    ///
    /// `None` if the law has no limits that harden there.
    fn tangent_solution(
        &self,
        input: &ContactInput<'_>,
        element: usize,
        mode: Mode,
        trial_settlement: f64,
        tolerance: Tolerance,
    ) -> Result<Option<TangentSolution>, LawError> {
        let limits = match input.limits(element, trial_settlement) {
            Ok(limits) if trial_settlement > 0.0 || limits.hardening > 0.0 => limits,
            // A law of the plane may have conditions of its own, and no limits.
            Ok(_) => return Ok(None),
            Err(_) if trial_settlement == 0.0 => return Ok(None),
            Err(error) => return Err(error),
        };
        let layer = input.law(element).compliance(Mode::Stick, &input.start_of(element))[0];
        let size = self.solver.response.layout.len();
        let compliance = input.delassus.diagonal(size, element) + layer;
        let state = &self.solver.response.states[element];
        let Tolerance { length, traction } = tolerance;
        Ok(Some(TangentSolution {
            element,
            pressure: state.pressure,
            settlement: limits.gap_offset - state.gap - layer * state.pressure,
            yields: mode.is_yield(),
            stiffness: compliance.recip(),
            pressure_rounding: traction,
            settlement_rounding: length + traction * compliance,
        }))
    }
}
