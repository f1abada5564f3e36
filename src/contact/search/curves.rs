//! Search for the modes of elements whose pressure is a curve over the settlement.

use super::ModeSearch;
use crate::contact::SearchMethod;
use crate::contact::linearisation::{Linearisation, TangentSolution, settlement_on_curve};
use crate::contact::problem::{ContactInput, ContactResponse};
use crate::error::{LawError, StepError};
use crate::interface::{Mode, Tolerance};
use crate::linalg::dot;

impl ModeSearch {
    /// Finds modes with other tangents until the pressures are on the curves of their laws.
    pub(super) fn follow_curves(
        &mut self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<SearchMethod, StepError> {
        self.predict_settlements(input, modes)?;
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

    /// Linearises the laws at the settlements that each element alone would have under its present tractions.
    ///
    /// Of elements that yielded in the step before.
    fn predict_settlements(
        &mut self,
        input: &ContactInput<'_>,
        modes: &[Mode],
    ) -> Result<(), LawError> {
        let size = self.solver.response.layout.len();
        let mut has_tractions = false;
        for (e, _) in modes.iter().enumerate().filter(|(_, mode)| mode.is_yield()) {
            let Ok(limits) = input.limits(e, 0.0) else { continue };
            let Some(trial_settlement) = input.trial_settlements.get(e) else { continue };
            if limits.hardening == 0.0 {
                continue;
            }
            if !has_tractions {
                self.set_present_tractions(input);
                has_tractions = true;
            }
            let row = &input.delassus[e * size..(e + 1) * size];
            let gap = input.free_jump[e] + dot(row, &self.solver.response.traction);
            let pressure = input.start.state(e).pressure;
            let layer = input.law(e).compliance(Mode::Stick, &input.start_of(e))[0];
            let settlement = limits.gap_offset - gap - layer * pressure;
            let solution = TangentSolution {
                element: e,
                pressure,
                settlement,
                yields: true,
                stiffness: (row[e] + layer).recip(),
                pressure_rounding: 0.0,
                settlement_rounding: 0.0,
            };
            trial_settlement.set(settlement_on_curve(input, &solution, limits, 0.0)?);
        }
        Ok(())
    }

    /// Sets the changes of traction from the static state to those at the start of the step.
    fn set_present_tractions(&mut self, input: &ContactInput<'_>) {
        let ContactResponse { layout, traction, .. } = &mut self.solver.response;
        for (i, traction) in traction.iter_mut().enumerate() {
            let [component, e] = layout.origin(i);
            *traction = input.start.state(e).traction()[component] - input.static_traction[i];
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
            if !self.solver.yields_with_hardening(e, *mode) && trial_settlement.get() == 0.0 {
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
